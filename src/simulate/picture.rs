//! The picture of a scene: its sum and the parts of it.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::alone;
use super::choice::Choice;
use super::effect::Effect;
use super::grid::{Grid, NoGrid};
use super::interface::most_albedo;
use super::material::OnGrid;
use super::scene::{NotDrawn, Scene};
use super::trace::{Pixel, Tracer};
use super::transport::{Spectra, Ways};
use crate::quantity::named;

named! {
    /// A part of a picture.
    Layer, "layer" {
        /// The sum of luminescent, diffuse and specular.
        Total = "total",
        /// Emitted at other wavelengths than it came in.
        Luminescent = "luminescent",
        /// Reflected into all directions.
        Diffuse = "diffuse",
        /// Reflected at the interface.
        Specular = "specular",
        /// What of the total came by way of another body, or of the same.
        Interreflection = "interreflection",
    }
}

named! {
    /// What a pixel holds.
    Kept, "kept" {
        /// X, Y and Z; white has a Y of 1.
        Colour = "colour",
        /// Spectral radiance at every wavelength of the scene, in the unit of the lights (sr-1).
        Spectra = "spectra",
    }
}

/// A picture: planes of single precision, row by row from the upper left.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What a pixel holds.
    pub kept: Kept,
    /// Wavelengths, nm, of spectra.
    pub nm: Vec<f64>,
    /// X, Y and Z of white, Y being 1; the weights of spectra make the same of a perfect diffuser.
    pub white: [f64; 3],
    /// Planes of each layer.
    pub layers: Vec<(Layer, Vec<Vec<f32>>)>,
    /// Standard error of the Y of each pixel, from the scatter of its samples; empty where nothing was drawn at random.
    pub noise: Vec<f32>,
}

/// Told of the work, and asked whether it goes on.
#[derive(Debug, Default)]
pub struct Watch {
    /// Rows that are done.
    pub rows: AtomicUsize,
    /// Set to end the work.
    pub is_cancelled: AtomicBool,
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoPicture {
    /// The scene.
    #[error(transparent)]
    Scene(#[from] NotDrawn),
    /// The wavelengths.
    #[error(transparent)]
    Grid(#[from] NoGrid),
    /// It was asked to.
    #[error("interrupted after {0} rows; nothing was written")]
    Cancelled(usize),
}

/// Materials, lights and channels of a scene on wavelengths.
pub(super) struct Prepared {
    pub(super) grid: Grid,
    pub(super) materials: Vec<OnGrid>,
    pub(super) white: [f64; 3],
    /// X, Y and Z as weights of spectral radiance times pi; white has a Y of 1.
    pub(super) weights: [Vec<f64>; 3],
}

impl Prepared {
    pub(super) fn new(scene: &Scene, step_nm: f64) -> Result<Self, NoGrid> {
        let grid = if step_nm == scene.grid.step() { scene.grid.clone() } else { scene.grid.in_steps_of(step_nm)? };
        // White is that of the scene, whatever the steps of a plan.
        let white = scene.white().xyz;
        let scale = 1.0 / white[1];
        let weights = grid.weights(scene.observer).map(|list| list.into_iter().map(|weight| weight * scale).collect());
        let materials = scene.materials.iter().map(|material| material.on(&grid)).collect();
        Ok(Self { materials, white: white.map(|value| value * scale), weights, grid })
    }

    pub(super) fn lights(&self, scene: &Scene) -> Vec<Vec<f64>> {
        scene.sources.iter().map(|source| self.grid.spectrum(&source.light)).collect()
    }

    pub(super) fn spectra(&self, scene: &Scene, choice: &Choice, kept: Kept) -> Spectra<'_> {
        let count = self.grid.nm().len();
        // Radiance is what is radiated over pi.
        let one = |k: usize| (0..count).map(|j| if j == k { std::f64::consts::FRAC_1_PI } else { 0.0 }).collect();
        let channels = match kept {
            Kept::Colour => self.weights.to_vec(),
            Kept::Spectra => (0..count).map(one).collect(),
        };
        Spectra {
            materials: &self.materials,
            lights: self.lights(scene),
            channels,
            has_luminescence: choice.has(Effect::Luminescence),
        }
    }
}

impl Picture {
    /// Draws a scene with the threads of the current `rayon` pool; the picture depends on the seed, and not on their number.
    ///
    /// # Errors
    /// [`NoPicture`].
    pub fn draw(
        scene: &Scene,
        choice: &Choice,
        kept: Kept,
        layers: &[Layer],
        watch: &Watch,
    ) -> Result<Self, NoPicture> {
        scene.check()?;
        let prepared = Prepared::new(scene, choice.step_nm)?;
        may_bounce(scene, choice, &prepared)?;
        let spectra = prepared.spectra(scene, choice, kept);
        let eye = match kept {
            Kept::Colour => vec![0.0, 1.0, 0.0],
            Kept::Spectra => prepared.weights[1].iter().map(|weight| weight * std::f64::consts::PI).collect(),
        };
        let (width, height) = scene.size;
        let picture = |planes: Vec<Vec<Vec<f32>>>, noise: Vec<f32>| Self {
            width,
            height,
            kept,
            nm: prepared.grid.nm().to_vec(),
            white: prepared.white,
            layers: layers.iter().copied().zip(planes).collect(),
            noise,
        };
        if kept == Kept::Colour
            && let Some(planes) = alone::draw(scene, choice, &mut Ways::new(&spectra), layers)
        {
            watch.rows.store(height, Ordering::Relaxed);
            return Ok(picture(planes, Vec::new()));
        }
        let tracer = Tracer::new(scene, *choice, &prepared.grid, &spectra, eye);
        let channels = spectra.channels.len();
        // A row at a time in one piece: layer by layer, in each channel by channel; the noise last.
        let length = (layers.len() * channels + 1) * width;
        let rows: Vec<Vec<f32>> = (0..height)
            .into_par_iter()
            .map_init(
                || (Ways::new(&spectra), Pixel::default(), Pixel::default()),
                |(ways, pixel, sample), row| {
                    let mut out = vec![0.0_f32; length];
                    if watch.is_cancelled.load(Ordering::Relaxed) {
                        return out;
                    }
                    for column in 0..width {
                        let (x, y) = film_place(scene, column, row);
                        let (from, towards) = scene.camera.ray(x, y);
                        tracer.pixel((row * width + column) as u64, from, towards, ways, pixel, sample);
                        for (l, layer) in layers.iter().enumerate() {
                            for c in 0..channels {
                                out[(l * channels + c) * width + column] = single(value(pixel, *layer, c));
                            }
                        }
                        out[layers.len() * channels * width + column] = pixel.variance.sqrt() as f32;
                    }
                    watch.rows.fetch_add(1, Ordering::Relaxed);
                    out
                },
            )
            .collect();
        if watch.is_cancelled.load(Ordering::Relaxed) {
            return Err(NoPicture::Cancelled(watch.rows.load(Ordering::Relaxed)));
        }
        let plane = |k: usize| {
            rows.iter().flat_map(|row| row[k * width..(k + 1) * width].iter().copied()).collect::<Vec<f32>>()
        };
        let planes = |l: usize| (0..channels).map(|c| plane(l * channels + c)).collect::<Vec<_>>();
        let noise = plane(layers.len() * channels);
        let noise = if noise.iter().any(|value| *value != 0.0) { noise } else { Vec::new() };
        Ok(picture((0..layers.len()).map(planes).collect(), noise))
    }

    /// The planes of a layer, if it was asked for.
    #[must_use]
    pub fn layer(&self, layer: Layer) -> Option<&[Vec<f32>]> {
        self.layers.iter().find(|(one, _)| *one == layer).map(|(_, planes)| planes.as_slice())
    }
}

/// The largest number of a pixel: of three of them another colour space makes numbers, too.
pub(super) const LARGEST: f32 = 1e36;

/// In single precision.
fn single(value: f64) -> f32 {
    if value.is_nan() { 0.0 } else { (value as f32).clamp(-LARGEST, LARGEST) }
}

fn value(pixel: &Pixel, layer: Layer, channel: usize) -> f64 {
    match layer {
        Layer::Total => pixel.luminescent[channel] + pixel.diffuse[channel] + pixel.specular[channel],
        Layer::Luminescent => pixel.luminescent[channel],
        Layer::Diffuse => pixel.diffuse[channel],
        Layer::Specular => pixel.specular[channel],
        Layer::Interreflection => pixel.indirect[channel],
    }
}

/// The middle of a pixel on the film, from -1 to 1 over its width.
pub(super) fn film_place(scene: &Scene, column: usize, row: usize) -> (f64, f64) {
    let (width, height) = (scene.size.0 as f64, scene.size.1 as f64);
    ((2.0 * (column as f64 + 0.5) - width) / width, (height - 2.0 * (row as f64 + 0.5)) / width)
}

/// More light than falls in may be shown, but must not go round.
pub(super) fn may_bounce(scene: &Scene, choice: &Choice, prepared: &Prepared) -> Result<(), NotDrawn> {
    let bounces = choice.has(Effect::Interreflection) && choice.bounces != super::scene::Bounces::Most(0);
    if !bounces
        || matches!(scene.bodies.as_slice(), [only] if only.shape.is_convex() && scene.is_seen_from_outside(only))
    {
        return Ok(());
    }
    for body in &scene.bodies {
        let (material, on_grid) = (&scene.materials[body.material], &prepared.materials[body.material]);
        let interface = material.interface().map_or(0.0, |term| most_albedo(&term));
        let shares = [
            (on_grid.energy(&prepared.grid, interface), "the energy of a wavelength"),
            (on_grid.photons(&prepared.grid, interface), "the photons of a wavelength"),
        ];
        if let Some((albedo, what)) = shares.into_iter().find(|(albedo, _)| *albedo > 1.0 + 1e-9) {
            return Err(NotDrawn::Brighter { material: material.name.clone(), albedo, what });
        }
    }
    Ok(())
}
