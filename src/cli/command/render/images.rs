//! A picture as files: a PNG for each layer, one EXR for all.

use std::io::Cursor;

use miette::miette;
use rayon::prelude::*;

use super::LAYERS;
use super::result::{Brightest, Drawn};
use crate::quantity::QuantityKind;
use crate::simulate::document::Resolved;
use crate::simulate::image::{
    Channel, Depth, Gamut, Layer as Part, Png, Primaries, Radiance, Srgb, spectral_channel, write_exr,
};
use crate::simulate::{Film, Kept, Layer, Picture, Source};

/// Files by name.
pub(super) type Files = Vec<(String, Vec<u8>)>;

/// The layer of the EXR that holds the standard error of Y.
const NOISE: &str = "noise";

/// The bytes of all files, and what is to be said of each layer.
pub(super) fn encode(
    picture: &Picture,
    resolved: &Resolved,
    gamut: Gamut,
    depth: Depth,
) -> Result<(Files, Vec<Drawn>), miette::Report> {
    let scene = &resolved.scene;
    let notes: Vec<(String, String)> = vec![
        ("bbrf-version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("seed".to_owned(), scene.seed.to_string()),
        ("samples".to_owned(), scene.samples.to_string()),
    ];
    let display = Srgb::new(picture.white, resolved.exposure).map_err(|error| miette!("{error}"))?;
    let linear = Srgb::new(picture.white, 1.0).map_err(|error| miette!("{error}"))?;
    let png = Png { display, gamut, depth };
    // Compressing takes longer than drawing: all layers at once.
    let encoded = picture.layers.par_iter().map(|(layer, planes)| {
        let film = picture.film(scene, *layer).map_err(|error| miette!("{error}"))?;
        let (bytes, out_of_gamut) = png.encode(&film, &notes).map_err(|error| miette!("{error}"))?;
        let name = format!("{layer}.png");
        let outside = (&out_of_gamut, resolved.exposure);
        let drawn = Drawn::new(*layer, name.clone(), outside, mean(&film), brightest(&film));
        Ok(((name, bytes), drawn, part(picture, *layer, planes, &film, &linear)))
    });
    let (mut files, mut drawn, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    for (file, one, part) in encoded.collect::<Result<Vec<_>, miette::Report>>()? {
        files.push(file);
        drawn.push(one);
        parts.push(part);
    }
    if !picture.noise.is_empty() {
        let channels = vec![Channel { name: "Y".to_owned(), values: picture.noise.clone() }];
        parts.push(Part { name: NOISE.to_owned(), channels });
    }
    let is_absolute = |source: &Source| source.light.kind() == QuantityKind::SpectralIrradiance;
    let radiance = if scene.sources.iter().all(is_absolute) { Radiance::Absolute } else { Radiance::Relative };
    let mut exr = Cursor::new(Vec::new());
    write_exr((picture.width, picture.height), &parts, (Primaries::Srgb, radiance), &notes, &mut exr)
        .map_err(|error| miette!("{error}"))?;
    files.push((LAYERS.to_owned(), exr.into_inner()));
    Ok((files, drawn))
}

/// A layer as linear light of sRGB, for programs that look at it, and its spectra where they are kept.
fn part(picture: &Picture, layer: Layer, planes: &[Vec<f32>], film: &Film, linear: &Srgb) -> Part {
    let mut colours = ["R", "G", "B"]
        .map(|name| Channel { name: name.to_owned(), values: Vec::with_capacity(film.width() * film.height()) });
    for pixel in pixels(film) {
        let rgb = linear.linear(pixel.map(f64::from));
        colours.iter_mut().zip(rgb).for_each(|(channel, value)| channel.values.push(value as f32));
    }
    let mut channels = colours.to_vec();
    if picture.kept == Kept::Spectra {
        let spectra = picture.nm.iter().zip(planes);
        channels.extend(spectra.map(|(nm, plane)| Channel { name: spectral_channel(*nm), values: plane.clone() }));
    }
    Part { name: layer.to_string(), channels }
}

/// X, Y and Z of all pixels, row by row.
fn pixels(film: &Film) -> impl Iterator<Item = [f32; 3]> {
    (0..film.height()).flat_map(move |row| {
        let planes = [0, 1, 2].map(|plane| film.row(row, plane));
        (0..film.width()).map(move |column| planes.map(|plane| plane[column]))
    })
}

fn mean(film: &Film) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pixel in pixels(film) {
        sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += f64::from(value));
    }
    sum.map(|sum| sum / (film.width() * film.height()) as f64)
}

fn brightest(film: &Film) -> Brightest {
    let mut found = Brightest { column: 0, row: 0, xyz: film.pixel(0, 0).unwrap_or_default() };
    for (at, xyz) in pixels(film).enumerate() {
        if xyz[1] > found.xyz[1] {
            found = Brightest { column: at % film.width(), row: at / film.width(), xyz };
        }
    }
    found
}
