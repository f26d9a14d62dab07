//! One pixel: what is lit directly in closed form, what comes by way of other bodies by random paths.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::choice::Choice;
use super::effect::Effect;
use super::grid::Grid;
use super::interface::{self, Interface};
use super::material::OnGrid;
use super::random::Stream;
use super::scene::{Bodies, Bounces, Scene, Spot};
use super::shape::{Ray, Shape};
use super::transport::{Act, FILM, Spectra, Way, Ways};
use super::vector::{Vector, across, along, dot, scaled};

/// Bounces after which a path may end at random.
const CERTAIN: u32 = 3;
/// A path is cut here even where nothing is absorbed.
const LONGEST_PATH: u32 = 10_000;
/// No light is stronger at a place, and no lobe brighter: beside a lamp there is no limit to either, and a sum must stay a number.
pub(super) const BRIGHTEST: f64 = 1e60;
/// How often a path at a body with an interface follows the interface.
const BY_INTERFACE: f64 = 0.5;

/// The sums of a pixel, for each channel.
#[derive(Debug, Clone, Default)]
pub(super) struct Pixel {
    pub(super) luminescent: Vec<f64>,
    pub(super) diffuse: Vec<f64>,
    pub(super) specular: Vec<f64>,
    /// What of the three came by way of another body.
    pub(super) indirect: Vec<f64>,
    /// Variance of the mean of the sum that the eye weighs.
    pub(super) variance: f64,
}

/// What does not change from pixel to pixel.
#[derive(Debug)]
pub(super) struct Tracer<'a> {
    pub(super) scene: &'a Scene,
    bodies: Bodies<'a>,
    pub(super) choice: Choice,
    pub(super) spectra: &'a Spectra<'a>,
    interfaces: Vec<Option<Interface>>,
    /// Light from all around at the interface of each material.
    surrounded: Vec<Option<Arc<Vec<f64>>>>,
    /// The share of energy that each material sends on at most.
    albedo: Vec<f64>,
    /// Weights of the channels in the sum whose noise is said.
    eye: Vec<f64>,
    /// No body sees any other, or itself.
    is_open: bool,
}

/// A part of a path's light.
#[derive(Debug, Clone, Copy)]
struct Held {
    act: Act,
    way: Way,
}

impl Pixel {
    pub(super) fn clear(&mut self, channels: usize) {
        for sum in [&mut self.luminescent, &mut self.diffuse, &mut self.specular, &mut self.indirect] {
            sum.clear();
            sum.resize(channels, 0.0);
        }
        self.variance = 0.0;
    }

    fn of(&mut self, act: Act) -> &mut [f64] {
        match act {
            Act::Luminescent => &mut self.luminescent,
            Act::Diffuse | Act::Body => &mut self.diffuse,
            Act::Specular => &mut self.specular,
        }
    }

    fn add(&mut self, act: Act, weight: f64, channels: &[f64]) {
        self.of(act).iter_mut().zip(channels).for_each(|(sum, value)| *sum += weight * value);
    }
}

impl<'a> Tracer<'a> {
    pub(super) fn new(scene: &'a Scene, choice: Choice, grid: &Grid, spectra: &'a Spectra<'a>, eye: Vec<f64>) -> Self {
        let of_material = |material: &super::material::Material| {
            material.interface().filter(|_| choice.has(Effect::Specular)).as_ref().map(Interface::new)
        };
        let interfaces: Vec<Option<Interface>> = scene.materials.iter().map(of_material).collect();
        let is_surrounded =
            choice.has(Effect::Surround) && scene.sources.iter().any(super::source::Source::is_surround);
        let table = |material: &super::material::Material| {
            material
                .interface()
                .filter(|_| is_surrounded && choice.has(Effect::Specular))
                .as_ref()
                .map(interface::surrounded)
        };
        Self {
            surrounded: scene.materials.iter().map(table).collect(),
            albedo: spectra.materials.iter().map(|material: &OnGrid| material.albedo(grid)).collect(),
            interfaces,
            bodies: Bodies::new(scene),
            scene,
            choice,
            spectra,
            eye,
            is_open: matches!(scene.bodies.as_slice(), [only] if only.shape.is_convex()),
        }
    }

    /// The pixel of that number, looked at from a place.
    pub(super) fn pixel(
        &self,
        number: u64,
        from: Vector,
        towards: Vector,
        ways: &mut Ways<'_>,
        out: &mut Pixel,
        sample: &mut Pixel,
    ) {
        let channels = self.spectra.channels.len();
        out.clear(channels);
        ways.tidy();
        let Some(spot) = self.bodies.spot(&Ray { from, towards, start: None }) else { return };
        let view = scaled(towards, -1.0);
        self.direct(&spot, view, ways, out);
        // What is looked at from within is never open; a plane has no inside.
        let is_flat = matches!(self.scene.bodies[spot.start.body].shape, Shape::Plane(_));
        let is_open = self.is_open && (is_flat || dot(spot.start.outward, towards) <= 0.0);
        let surrounds =
            self.choice.has(Effect::Surround) && self.scene.sources.iter().any(super::source::Source::is_surround);
        if surrounds && is_open {
            self.surround(&spot, view, 1.0, ways, out);
        } else if surrounds {
            self.mean(number, Effect::Surround, ways, out, sample, |stream, ways, sample| {
                self.glimpse(&spot, view, stream, ways, sample)
            });
        }
        if self.choice.has(Effect::Interreflection) && self.choice.bounces != Bounces::Most(0) && !is_open {
            self.mean(number, Effect::Interreflection, ways, out, sample, |stream, ways, sample| {
                self.path(&spot, view, stream, ways, sample)
            });
        }
    }

    /// Light of the sources that have a direction.
    fn direct(&self, spot: &Spot, view: Vector, ways: &mut Ways<'_>, out: &mut Pixel) {
        if self.choice.by_pixel {
            self.direct_in_full(spot, view, out);
            return;
        }
        let [luminescent, diffuse, specular] = self.first(spot.material, ways);
        for light in 0..self.scene.sources.len() {
            let Some((lit, shining)) = self.lit(spot, view, light, self.choice.has(Effect::Shadow)) else { continue };
            if self.choice.has(Effect::Luminescence) {
                out.add(Act::Luminescent, lit, ways.lit(luminescent, light));
            }
            if self.choice.has(Effect::Diffuse) {
                out.add(Act::Diffuse, lit, ways.lit(diffuse, light));
            }
            if shining != 0.0 {
                out.add(Act::Specular, shining, ways.lit(specular, light));
            }
        }
    }

    /// The whole product at this pixel.
    fn direct_in_full(&self, spot: &Spot, view: Vector, out: &mut Pixel) {
        let count = self.spectra.channels[0].len();
        let (mut incident, mut shine, mut is_lit) = (vec![0.0; count], vec![0.0; count], false);
        for (light, spectrum) in self.spectra.lights.iter().enumerate() {
            let Some((lit, shining)) = self.lit(spot, view, light, self.choice.has(Effect::Shadow)) else { continue };
            is_lit = true;
            for ((incident, shine), e) in incident.iter_mut().zip(&mut shine).zip(spectrum) {
                *incident += lit * e;
                *shine += shining * e;
            }
        }
        if !is_lit {
            return;
        }
        let material = &self.spectra.materials[spot.material];
        let emitted: Vec<f64> = match material.luminescence.as_ref().filter(|_| self.choice.has(Effect::Luminescence)) {
            Some(matrix) => {
                matrix.outer_iter().map(|row| row.iter().zip(&incident).map(|(a, b)| a * b).sum()).collect()
            }
            None => Vec::new(),
        };
        let has_diffuse = self.choice.has(Effect::Diffuse);
        for (c, weights) in self.spectra.channels.iter().enumerate() {
            out.luminescent[c] += weights.iter().zip(&emitted).map(|(weight, value)| weight * value).sum::<f64>();
            for (j, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                if has_diffuse {
                    out.diffuse[c] += weight * (material.elastic[j] * incident[j]);
                }
                out.specular[c] += weight * (material.intensity[j] * shine[j]);
            }
        }
    }

    /// cos(theta_i) and D F G / den of a light at a spot, times its strength; `None` where it does not reach it.
    #[inline]
    fn lit(&self, spot: &Spot, view: Vector, light: usize, has_shadow: bool) -> Option<(f64, f64)> {
        let beam = self.scene.sources[light].beam(spot.place)?;
        let cosine = dot(spot.normal, beam.towards);
        // Nor where a lamp is so near that it has no direction.
        if cosine.is_nan() || cosine <= 0.0 || (has_shadow && self.bodies.is_hidden(spot, beam.towards, beam.distance))
        {
            return None;
        }
        let shining =
            self.interfaces[spot.material].as_ref().map_or(0.0, |one| one.value(spot.normal, beam.towards, view));
        let bounded = |value: f64| if value.is_nan() { 0.0 } else { value.min(BRIGHTEST) };
        Some((bounded(cosine * beam.strength), bounded(shining * beam.strength)))
    }

    fn first(&self, material: usize, ways: &mut Ways<'_>) -> [Way; 3] {
        [Act::Luminescent, Act::Diffuse, Act::Specular].map(|act| ways.further(FILM, act, material))
    }

    /// So much of the light from all around.
    fn surround(&self, spot: &Spot, view: Vector, part: f64, ways: &mut Ways<'_>, out: &mut Pixel) {
        let [luminescent, diffuse, specular] = self.first(spot.material, ways);
        let shining =
            self.surrounded[spot.material].as_ref().map_or(0.0, |table| interface::at(table, dot(spot.normal, view)));
        for (light, _) in self.scene.sources.iter().enumerate().filter(|(_, source)| source.is_surround()) {
            self.gather(light, part, [luminescent, diffuse], ways, out);
            out.add(Act::Specular, part * shining, ways.lit(specular, light));
        }
    }

    fn gather(&self, light: usize, part: f64, [luminescent, diffuse]: [Way; 2], ways: &Ways<'_>, out: &mut Pixel) {
        if self.choice.has(Effect::Luminescence) {
            out.add(Act::Luminescent, part, ways.lit(luminescent, light));
        }
        if self.choice.has(Effect::Diffuse) {
            out.add(Act::Diffuse, part, ways.lit(diffuse, light));
        }
    }

    /// The mean of the samples of an effect, with its variance.
    fn mean(
        &self,
        number: u64,
        effect: Effect,
        ways: &mut Ways<'_>,
        out: &mut Pixel,
        sample: &mut Pixel,
        draw: impl Fn(&mut Stream, &mut Ways<'_>, &mut Pixel),
    ) {
        let (count, channels) = (self.scene.samples.max(1), self.spectra.channels.len());
        let (mut mean, mut squares) = (0.0, 0.0);
        let part = 1.0 / f64::from(count);
        for k in 0..count {
            sample.clear(channels);
            draw(&mut Stream::new(self.scene.seed, number, u64::from(k), effect), ways, sample);
            let mut seen = 0.0;
            for c in 0..channels {
                let all = sample.luminescent[c] + sample.diffuse[c] + sample.specular[c];
                seen += self.eye[c] * all;
                out.luminescent[c] += part * sample.luminescent[c];
                out.diffuse[c] += part * sample.diffuse[c];
                out.specular[c] += part * sample.specular[c];
                if effect == Effect::Interreflection {
                    out.indirect[c] += part * all;
                }
            }
            // Welford 1962.
            let apart = seen - mean;
            mean += apart / f64::from(k + 1);
            squares += apart * (seen - mean);
        }
        let variance = if count > 1 { squares / f64::from(count - 1) } else { f64::INFINITY };
        out.variance += variance * part;
    }

    /// Whether light from all around reaches a spot from one direction.
    fn glimpse(&self, spot: &Spot, view: Vector, stream: &mut Stream, ways: &mut Ways<'_>, out: &mut Pixel) {
        let [luminescent, diffuse, specular] = self.first(spot.material, ways);
        let numbers = [stream.uniform(), stream.uniform()];
        let towards = cosine_direction(spot.normal, numbers);
        let is_free = !self.bodies.is_hidden(spot, towards, f64::INFINITY);
        let shine = self.interfaces[spot.material].as_ref().and_then(|one| one.draw(spot.normal, view, numbers));
        let shine = shine.filter(|(towards, _)| !self.bodies.is_hidden(spot, *towards, f64::INFINITY));
        for (light, _) in self.scene.sources.iter().enumerate().filter(|(_, source)| source.is_surround()) {
            if is_free {
                self.gather(light, 1.0, [luminescent, diffuse], ways, out);
            }
            if let Some((_, weight)) = shine {
                out.add(Act::Specular, weight, ways.lit(specular, light));
            }
        }
    }

    /// A path from a spot over other bodies to the lights.
    fn path(&self, spot: &Spot, view: Vector, stream: &mut Stream, ways: &mut Ways<'_>, out: &mut Pixel) {
        let most = match self.choice.bounces {
            Bounces::Most(most) => most,
            Bounces::All => LONGEST_PATH,
        };
        let [luminescent, diffuse, specular] = self.first(spot.material, ways);
        let by_body = [Held { act: Act::Luminescent, way: luminescent }, Held { act: Act::Diffuse, way: diffuse }];
        let is_counted = |held: &Held| match held.act {
            Act::Luminescent => self.choice.has(Effect::Luminescence),
            Act::Diffuse => self.choice.has(Effect::Diffuse),
            Act::Body | Act::Specular => true,
        };
        let mut next = (
            by_body.into_iter().filter(is_counted).collect::<Vec<_>>(),
            vec![Held { act: Act::Specular, way: specular }],
        );
        let (mut spot, mut view, mut weight) = (*spot, view, 1.0);
        for bounce in 1..=most.saturating_add(1) {
            let numbers = [stream.uniform(), stream.uniform(), stream.uniform()];
            let interface = self.interfaces[spot.material].as_ref();
            let drawn = match interface {
                Some(one) if numbers[2] < BY_INTERFACE => one
                    .draw(spot.normal, view, [numbers[0], numbers[1]])
                    .map(|(to, factor)| (to, factor / BY_INTERFACE, next.1)),
                Some(_) => {
                    Some((cosine_direction(spot.normal, [numbers[0], numbers[1]]), 1.0 / (1.0 - BY_INTERFACE), next.0))
                }
                None => Some((cosine_direction(spot.normal, [numbers[0], numbers[1]]), 1.0, next.0)),
            };
            let Some((towards, factor, held)) = drawn else { return };
            weight *= factor;
            let Some(hit) = self.bodies.spot(&Ray { from: spot.place, towards, start: Some(spot.start) }) else {
                if bounce > 1 {
                    self.escaped(&held, weight, ways, out);
                }
                return;
            };
            if bounce > most || weight == 0.0 {
                return;
            }
            (spot, view) = (hit, scaled(towards, -1.0));
            let further = |act: Act, ways: &mut Ways<'_>| -> Vec<Held> {
                held.iter().map(|one| Held { act: one.act, way: ways.further(one.way, act, spot.material) }).collect()
            };
            next = (
                further(Act::Body, ways),
                if self.interfaces[spot.material].is_some() { further(Act::Specular, ways) } else { Vec::new() },
            );
            for light in 0..self.scene.sources.len() {
                let Some((lit, shining)) = self.lit(&spot, view, light, true) else { continue };
                for (held, factor) in next.0.iter().map(|one| (one, lit)).chain(next.1.iter().map(|one| (one, shining)))
                {
                    out.add(held.act, weight * factor, ways.lit(held.way, light));
                }
            }
            // With fewer bounces, too: a path of few is that of all, cut off.
            if bounce >= CERTAIN {
                // A body that takes nothing away ends no path; an interface may give more than it gets on the way.
                let most = if self.interfaces[spot.material].is_some() { 0.95 } else { 1.0 };
                let stays = self.albedo[spot.material].clamp(0.05, most);
                if stream.uniform() >= stays {
                    return;
                }
                weight /= stays;
            }
        }
    }

    /// A path that has left the scene meets the light from all around.
    fn escaped(&self, held: &[Held], weight: f64, ways: &Ways<'_>, out: &mut Pixel) {
        if !self.choice.has(Effect::Surround) {
            return;
        }
        for (light, _) in self.scene.sources.iter().enumerate().filter(|(_, source)| source.is_surround()) {
            held.iter().for_each(|one| out.add(one.act, weight, ways.lit(one.way, light)));
        }
    }
}

/// A direction above a surface, with a density of its cosine over pi.
#[inline]
fn cosine_direction(normal: Vector, numbers: [f64; 2]) -> Vector {
    let [a, b] = across(normal);
    let (sin, cos) = (TAU * numbers[1]).sin_cos();
    let radius = numbers[0].sqrt();
    along(along(scaled(normal, (1.0 - numbers[0]).max(0.0).sqrt()), a, radius * cos), b, radius * sin)
}
