//! What was drawn, beside the images and for `--json`.

use std::fmt::Write;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use super::{LAYERS, RECORD};
use crate::simulate::document::Resolved;
use crate::simulate::image::{Gamut, OutOfGamut};
use crate::simulate::{Bounces, Kept, Layer, Picture, Plan, Scene, WhiteOf};

/// What `render.json` and `--json` hold: the same for the same scene, seed and samples.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct RenderResult {
    /// The program's version.
    program_version: &'static str,
    /// The scene as it was named.
    scene: String,
    /// Pixels in a row.
    width: usize,
    /// Rows.
    height: usize,
    /// Wavelengths, nm: first, last and step.
    wavelengths_nm: [f64; 3],
    /// Degrees of the CIE observer.
    observer: String,
    /// What the EXR holds of each pixel.
    kept: Kept,
    /// Samples of each pixel for what has no closed form.
    samples: u32,
    /// Where random numbers began.
    seed: u64,
    /// Bounces.
    bounces: Bounces,
    /// What of the scene was simulated, why the rest need not be, and what that changes at most; `null` where everything was simulated
    /// in full.
    plan: Option<Plan>,
    /// What the PNGs multiply the light with.
    exposure: f64,
    /// X, Y and Z of white: what all colours here are in, Y being 1.
    white: [f64; 3],
    /// What white is.
    white_of: WhiteOf,
    /// The layers.
    layers: Vec<Drawn>,
    /// The file with all layers in single precision: linear light in the primaries of sRGB, white being 1, without the exposure; the
    /// spectral radiance in the unit of the lights per sr where spectra are kept.
    exr: &'static str,
    /// Standard error of what was drawn at random; `null` where nothing was.
    noise: Option<Noise>,
    /// What is missing, one sentence each.
    warnings: Vec<String>,
    /// How things were read, one sentence each.
    remarks: Vec<String>,
}

/// A layer.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Drawn {
    /// Which.
    layer: Layer,
    /// Its PNG.
    file: String,
    /// Mean X, Y and Z of all pixels.
    mean: [f64; 3],
    /// The pixel with the greatest Y.
    brightest: Brightest,
    /// What of it a display of sRGB cannot show.
    out_of_gamut: Outside,
}

/// A pixel.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Brightest {
    /// From the left, from 0.
    pub(crate) column: usize,
    /// From the top, from 0.
    pub(crate) row: usize,
    /// Its colour.
    pub(crate) xyz: [f32; 3],
}

/// Colours outside sRGB.
#[derive(Debug, Serialize, JsonSchema)]
struct Outside {
    /// What the PNG does with them.
    gamut: Gamut,
    /// How many pixels.
    pixels: usize,
    /// Of these with a channel above 1: a lower exposure shows them.
    brighter: usize,
    /// Of these with a channel below 0: purer than the display's primaries, at any exposure.
    purer: usize,
    /// The exposure at which no channel lies above 1.
    exposure_for_all: f64,
    /// Most by which a linear channel lies below 0; white is 1.
    below: f64,
    /// Most by which a linear channel lies above 1.
    above: f64,
    /// Pixels without a colour, which are black.
    undefined: usize,
}

/// Standard error (k = 1) of the Y of the pixels, from the scatter of their samples; white has a Y of 1.
#[derive(Debug, Serialize, JsonSchema)]
struct Noise {
    /// Half of the pixels that have any have less; `null` of one sample, which says nothing about its scatter.
    median: Option<f32>,
    /// None has more.
    largest: Option<f32>,
}

impl Noise {
    fn of(picture: &Picture) -> Option<Self> {
        let mut sorted: Vec<f32> = picture.noise.iter().copied().filter(|value| *value != 0.0).collect();
        sorted.sort_by(f32::total_cmp);
        let known = |value: f32| Some(value).filter(|value| value.is_finite());
        Some(Self { median: known(*sorted.get(sorted.len() / 2)?), largest: known(*sorted.last()?) })
    }
}

impl Drawn {
    pub(super) fn new(
        layer: Layer,
        file: String,
        (outside, exposure): (&OutOfGamut, f64),
        mean: [f64; 3],
        brightest: Brightest,
    ) -> Self {
        let OutOfGamut { gamut, pixels, brighter, purer, below, above, undefined, .. } = *outside;
        // To two digits, and not above.
        let exact = exposure / (1.0 + above);
        let place = 10.0_f64.powf(1.0 - exact.log10().floor());
        let exposure_for_all = if above > 0.0 { (exact * place).floor() / place } else { exposure };
        let out_of_gamut = Outside { gamut, pixels, brighter, purer, exposure_for_all, below, above, undefined };
        Self { layer, file, mean, brightest, out_of_gamut }
    }
}

/// Why there may be nothing to see.
fn black(scene: &Scene, layers: &[Drawn]) -> Option<String> {
    let total = layers.iter().find(|one| one.layer == Layer::Total)?;
    if total.brightest.xyz[1] > 0.0 {
        return None;
    }
    let around = scene.bodies.iter().find(|body| body.shape.holds(scene.camera.place()));
    let why = match around {
        Some(body) => format!("the camera is inside `{}`", body.name),
        None => "no body is in view, or no light falls on what is".to_owned(),
    };
    Some(format!(
        "the picture is black: {why}; look at `from`, `at` and `width` of the camera, and where the lights are"
    ))
}

impl RenderResult {
    pub(super) fn new(
        place: &str,
        resolved: &Resolved,
        plan: Option<Plan>,
        picture: &Picture,
        layers: Vec<Drawn>,
    ) -> Self {
        let scene = &resolved.scene;
        let nm = &picture.nm;
        let mut warnings = resolved.warnings.clone();
        warnings.extend(black(scene, &layers));
        let (first, last) = (nm.first().copied().unwrap_or_default(), nm.last().copied().unwrap_or_default());
        Self {
            program_version: env!("CARGO_PKG_VERSION"),
            scene: place.to_owned(),
            width: picture.width,
            height: picture.height,
            wavelengths_nm: [first, last, nm.get(1).map_or(0.0, |second| second - first)],
            observer: scene.observer.to_string(),
            kept: picture.kept,
            samples: scene.samples,
            seed: scene.seed,
            bounces: scene.bounces,
            plan,
            exposure: resolved.exposure,
            white: picture.white,
            white_of: scene.white_of(),
            layers,
            exr: LAYERS,
            noise: Noise::of(picture),
            warnings,
            remarks: resolved.remarks.clone(),
        }
    }

    /// Warnings that were not there when the scene was read.
    pub(super) fn said_after(&self, before: &[String]) -> impl Iterator<Item = &String> {
        self.warnings.iter().skip(before.len())
    }

    pub(super) fn text(&self, folder: &Path) -> String {
        let mut text = String::new();
        for one in &self.layers {
            let path = folder.join(&one.file);
            let outside = &one.out_of_gamut;
            // Writing into a text cannot fail.
            let _ = write!(text, "{}: mean Y {:.6}", path.display(), one.mean[1]);
            let Brightest { column, row, xyz } = one.brightest;
            let _ = match xyz[1] {
                0.0 => write!(text, ", black"),
                most => write!(text, ", brightest {most:.4} at column {column}, row {row}"),
            };
            let done = if outside.gamut == Gamut::Clip { "clipped" } else { "paler than they are" };
            let many = |count: usize, what: &str| (count > 0).then(|| format!("{count} {what}"));
            let brighter = format!("too bright for sRGB (exposure {} shows them)", outside.exposure_for_all);
            let parts = [many(outside.brighter, &brighter), many(outside.purer, "purer than sRGB")];
            let parts = parts.into_iter().flatten().collect::<Vec<_>>().join(", ");
            let _ = match parts.as_str() {
                "" => writeln!(text),
                _ => writeln!(text, "; of {} pixels {parts}: {done}", self.width * self.height),
            };
        }
        let _ = write!(text, "{}", folder.join(self.exr).display());
        if let Some(plan) = &self.plan {
            let skipped = plan.effects.iter().filter(|one| !one.simulate).map(|one| one.effect.name());
            let skipped = skipped.collect::<Vec<_>>().join(", ");
            let _ = match skipped.as_str() {
                "" => write!(text, "\nno effect was left out"),
                _ => write!(text, "\nleft out: {skipped}"),
            };
            let _ = match plan.bound.is_zero() {
                true => write!(text, "; no pixel changes"),
                false => write!(
                    text,
                    "; a pixel changes by at most {:.3} CIELAB (`plan` in {RECORD} says how)",
                    plan.bound.delta_e
                ),
            };
        }
        if let Some(noise) = &self.noise {
            let _ = match (noise.median, noise.largest) {
                (Some(median), Some(largest)) => write!(
                    text,
                    "\nstandard error of Y where light was drawn at random: {median:.2e} in the median, {largest:.2e} at most (white is 1)"
                ),
                _ => write!(text, "\nstandard error of Y: unknown from one sample; --samples 2 or more tell"),
            };
        }
        text
    }
}
