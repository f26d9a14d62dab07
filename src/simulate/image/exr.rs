//! Layers in single precision as OpenEXR: colours, and one channel per wavelength.
//!
//! Spectra are in the layout of A. Fichet, R. Pacanowski and A. Wilkie, "An OpenEXR Layout for Spectral Images", Journal of Computer
//! Graphics Techniques 10 (3), 2021: channels `S0.550,000000nm`, the attribute `spectralLayoutVersion` "1.0" and, with what emits,
//! `emissiveUnits`, both texts. Its public tools look for the channels by these names and nothing before them, so that a layer is
//! a part of the file and not a prefix; tools that know one part take the first.

use std::io::{Seek, Write};

use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds, LineOrder, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, ImageAttributes, LayerAttributes, Vec2,
    WritableImage,
};

use super::Notes;
use crate::quantity::named;

named! {
    /// What spectra are in: the attribute `emissiveUnits`.
    Radiance, "radiance" {
        /// The unit that the public tools know; radiance is per nanometre nowhere in the layout.
        Absolute = "W.m^-2.sr^-1",
        /// That of lights of which only the form is known.
        Relative = "relative",
    }
}

named! {
    /// What R, G and B of all layers are.
    Primaries, "primaries" {
        /// CIE X, Y and Z, told by the attribute `chromaticities`.
        Xyz = "XYZ",
        /// Linear light in the primaries of sRGB, which programs take what tells nothing for.
        Srgb = "sRGB",
    }
}

/// A plane of a layer, row after row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// `R`, `G`, `B`, a spectral one ([`spectral_channel`]), or another.
    pub name: String,
    /// One per pixel.
    pub values: Vec<f32>,
}

/// A part of the file: the whole image or one effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// `total`, `luminescent`, `diffuse`, `specular` or another; once in a file.
    pub name: String,
    /// In any order; they are stored by name.
    pub channels: Vec<Channel>,
}

/// Why there is no EXR.
#[derive(Debug, thiserror::Error)]
pub enum NoExr {
    /// Nothing to write.
    #[error("{0}; expected at least one layer, each with a channel, on an image of 1 x 1 pixels or more")]
    Empty(String),
    /// A name that is there already, or none.
    #[error("{0}; expected names of ASCII letters, each once")]
    Name(String),
    /// A plane of another size.
    #[error("channel `{channel}` of layer `{layer}` has {found} values; expected {expected}, one per pixel")]
    Size {
        /// The layer.
        layer: String,
        /// The channel.
        channel: String,
        /// Its values.
        found: usize,
        /// Width times height.
        expected: usize,
    },
    /// The encoder's or the disk's.
    #[error("the image cannot be written as EXR: {0}")]
    Encoding(#[from] exr::error::Error),
}

/// The name of the channel of unpolarised radiance at a wavelength in nm, with six decimals behind a comma: a point would end the
/// name of a layer.
#[must_use]
pub fn spectral_channel(nm: f64) -> String {
    format!("S0.{}nm", format!("{nm:.6}").replace('.', ","))
}

/// Writes layers of one size. The notes stand in the attribute `comments`, as an object of JSON.
///
/// # Errors
/// [`NoExr`].
pub fn write_exr(
    (width, height): (usize, usize),
    layers: &[Layer],
    (primaries, radiance): (Primaries, Radiance),
    notes: &Notes,
    out: impl Write + Seek,
) -> Result<(), NoExr> {
    check(width, height, layers)?;
    let size = Vec2(width, height);
    let parts: Vec<Part> = layers.iter().map(|layer| part(size, layer, radiance, notes)).collect();
    let mut attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    attributes.chromaticities = match primaries {
        Primaries::Xyz => Some(Chromaticities {
            red: Vec2(1.0, 0.0),
            green: Vec2(0.0, 1.0),
            blue: Vec2(0.0, 0.0),
            white: Vec2(1.0 / 3.0, 1.0 / 3.0),
        }),
        Primaries::Srgb => Some(Chromaticities {
            red: Vec2(0.64, 0.33),
            green: Vec2(0.30, 0.60),
            blue: Vec2(0.15, 0.06),
            white: Vec2(0.3127, 0.3290),
        }),
    };
    if layers.iter().any(is_spectral) {
        attributes.other.insert(Text::from("spectralLayoutVersion"), AttributeValue::Text(Text::from("1.0")));
    }
    Ok(Image::from_layers(attributes, parts).write().to_buffered(out)?)
}

type Part = exr::prelude::Layer<AnyChannels<FlatSamples>>;

fn part(size: Vec2<usize>, layer: &Layer, radiance: Radiance, notes: &Notes) -> Part {
    let mut attributes = LayerAttributes::named(layer.name.as_str());
    attributes.software_name = Some(Text::from("bbrf"));
    if !notes.is_empty() {
        let object: serde_json::Map<_, _> =
            notes.iter().map(|(name, text)| (name.clone(), serde_json::Value::from(text.clone()))).collect();
        attributes.comments = Some(Text::from(serde_json::Value::from(object).to_string().as_str()));
    }
    // The encoder keeps attributes that it does not know in the order of a table with random seeds: one at most in a table, or
    // the same image would not have the same bytes.
    if is_spectral(layer) {
        attributes.other.insert(Text::from("emissiveUnits"), AttributeValue::Text(Text::from(radiance.name())));
    }
    let channels = layer
        .channels
        .iter()
        .map(|channel| AnyChannel::new(channel.name.as_str(), FlatSamples::F32(channel.values.clone())));
    let encoding =
        Encoding { compression: Compression::ZIP16, line_order: LineOrder::Increasing, ..Encoding::FAST_LOSSLESS };
    let encoding = Encoding { blocks: exr::image::Blocks::ScanLines, ..encoding };
    exr::prelude::Layer::new(size, attributes, encoding, AnyChannels::sort(channels.collect()))
}

fn is_spectral(layer: &Layer) -> bool {
    layer.channels.iter().any(|channel| channel.name.starts_with("S0.") && channel.name.ends_with("nm"))
}

fn check(width: usize, height: usize, layers: &[Layer]) -> Result<(), NoExr> {
    if layers.is_empty() || width == 0 || height == 0 {
        return Err(NoExr::Empty(format!("{} layers of {width} x {height} pixels", layers.len())));
    }
    for (k, layer) in layers.iter().enumerate() {
        if layer.channels.is_empty() {
            return Err(NoExr::Empty(format!("layer `{}` without a channel", layer.name)));
        }
        is_new_name("layer", &layer.name, layers[..k].iter().map(|other| other.name.as_str()))?;
        for (k, channel) in layer.channels.iter().enumerate() {
            let others = layer.channels[..k].iter().map(|other| other.name.as_str());
            is_new_name(&format!("channel of layer `{}`", layer.name), &channel.name, others)?;
            if Some(channel.values.len()) != width.checked_mul(height) {
                return Err(NoExr::Size {
                    layer: layer.name.clone(),
                    channel: channel.name.clone(),
                    found: channel.values.len(),
                    expected: width.saturating_mul(height),
                });
            }
        }
    }
    Ok(())
}

fn is_new_name<'a>(what: &str, name: &str, mut others: impl Iterator<Item = &'a str>) -> Result<(), NoExr> {
    if name.is_empty() || !name.is_ascii() || name.contains('\0') || name.len() > 255 {
        return Err(NoExr::Name(format!("a {what} named `{name}`")));
    }
    if others.any(|other| other == name) {
        return Err(NoExr::Name(format!("a second {what} named `{name}`")));
    }
    Ok(())
}
