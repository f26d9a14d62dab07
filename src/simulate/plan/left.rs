//! What is left out of a body, as colours and spectra under each light.

use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::picture::{Kept, Prepared};
use super::super::transport::{Act, Spectra};
use super::exchange::{Way, radiated};
use super::full::Full;
use super::reach::mirror;

/// What follows one factor of the geometry: cos(theta_i) of a light, or its lobe. XYZ are over those of white.
pub(super) struct Direct {
    pub(super) light: usize,
    pub(super) is_lobe: bool,
    /// In the picture as planned.
    pub(super) kept: [f64; 3],
    /// What the full picture has more of.
    pub(super) left_out: [f64; 3],
    /// Spectrum of what is left out.
    pub(super) lost: Vec<f64>,
    /// Spectrum of all: what a shadow takes that is not drawn.
    pub(super) all: Vec<f64>,
}

/// Light that comes by a way, by its number.
pub(super) struct ByWay {
    pub(super) way: usize,
    pub(super) xyz: [f64; 3],
    pub(super) peak: Vec<f64>,
}

/// What is left out of a body.
pub(super) struct LeftOut {
    pub(super) direct: Vec<Direct>,
    /// Those ways that are not drawn.
    pub(super) by_ways: Vec<ByWay>,
}

/// Colours of an act of a material under each light, with the spectrum of each.
struct Acts {
    xyz: Vec<[f64; 3]>,
    spectra: Vec<Vec<f64>>,
}

impl Full<'_> {
    pub(super) fn left_out(&self, body: usize, plan: &Choice, planned: &Prepared, known: Range<usize>) -> LeftOut {
        let material = self.scene.bodies[body].material;
        LeftOut {
            direct: self.direct(material, plan, planned),
            by_ways: if known.is_empty() { Vec::new() } else { self.by_ways(material, &known) },
        }
    }

    fn direct(&self, material: usize, plan: &Choice, planned: &Prepared) -> Vec<Direct> {
        let all = |prepared: &Prepared| {
            [Act::Luminescent, Act::Diffuse, Act::Specular].map(|act| self.acts(prepared, act, material))
        };
        let (full, less) = (all(&self.prepared), all(planned));
        let is_stepped = plan.step_nm != self.choice.step_nm;
        let mut list = Vec::new();
        for (light, source) in self.scene.sources.iter().enumerate() {
            let has = |act: usize| {
                plan.has([Effect::Luminescence, Effect::Diffuse, Effect::Specular][act])
                    && (!source.is_surround() || plan.has(Effect::Surround))
            };
            for acts in [&[0, 1][..], &[2]] {
                let sum = |from: &[Acts; 3], counts: &dyn Fn(usize) -> bool| {
                    let mut xyz = [0.0; 3];
                    for act in acts.iter().filter(|act| counts(**act)) {
                        (0..3).for_each(|c| xyz[c] += from[*act].xyz[light][c]);
                    }
                    xyz
                };
                let (kept, whole) = (sum(&less, &has), sum(&full, &|_| true));
                // What is kept as it is cancels exactly.
                let is_exact = |act: usize| has(act) && !is_stepped;
                let left_out = match is_stepped {
                    _ if acts.iter().all(|act| is_exact(*act)) => [0.0; 3],
                    true => [0, 1, 2].map(|c| whole[c] - kept[c]),
                    false => sum(&full, &|act| !has(act)),
                };
                let spectrum = |counts: &dyn Fn(usize) -> bool| -> Vec<f64> {
                    let counted: Vec<&Vec<f64>> =
                        acts.iter().filter(|act| counts(**act)).map(|act| &full[*act].spectra[light]).collect();
                    (0..full[0].spectra[light].len()).map(|j| counted.iter().map(|list| list[j].abs()).sum()).collect()
                };
                let (lost, all) = (spectrum(&|act| !is_exact(act)), spectrum(&|_| true));
                if whole != [0.0; 3] || kept != [0.0; 3] || lost.iter().any(|value| *value != 0.0) {
                    list.push(Direct { light, is_lobe: acts == [2], kept, left_out, lost, all });
                }
            }
        }
        list
    }

    fn acts(&self, prepared: &Prepared, act: Act, material: usize) -> Acts {
        let choice = self.choice;
        let of = |kept: Kept| -> (Vec<f64>, usize) {
            let spectra: Spectra<'_> = prepared.spectra(self.scene, &choice, kept);
            let rows = spectra.before(&spectra.channels.concat(), act, material);
            (spectra.through(&rows), spectra.channels.len())
        };
        let (colours, _) = of(Kept::Colour);
        let (spectra, count) = of(Kept::Spectra);
        Acts {
            xyz: colours.chunks_exact(3).map(|xyz| self.over_white([xyz[0], xyz[1], xyz[2]])).collect(),
            spectra: spectra.chunks_exact(count).map(<[f64]>::to_vec).collect(),
        }
    }

    /// For each way its own colour.
    fn by_ways(&self, material: usize, known: &Range<usize>) -> Vec<ByWay> {
        let spectra = [Kept::Colour, Kept::Spectra].map(|kept| self.prepared.spectra(self.scene, &self.choice, kept));
        let count = spectra[1].channels.len();
        let ways = self.between().into_iter().flat_map(|between| &between.ways).enumerate();
        let left = ways.filter(|(_, way)| known.contains(&(way.materials.len() - 1)));
        let by_way = |(number, way): (usize, &Way)| {
            let through = |spectra: &Spectra<'_>| {
                let film = spectra.channels.concat();
                let bodies = [&[material][..], &way.materials].concat();
                let rows = bodies.iter().fold(film, |rows, material| spectra.before(&rows, Act::Body, *material));
                spectra.through(&rows)
            };
            let [colours, lists] = [through(&spectra[0]), through(&spectra[1])];
            let xyz = self.over_white([0, 1, 2].map(|c| colours[3 * way.light + c]));
            let peak = lists[way.light * count..(way.light + 1) * count].iter().map(|value| value.abs()).collect();
            ByWay { way: number, xyz, peak }
        };
        left.map(by_way).filter(|one| one.xyz != [0.0; 3]).collect()
    }

    /// The spectrum of radiance, and XYZ, that an irradiance by others makes at most.
    pub(super) fn by_others(&self, body: usize, incident: &[f64], anywhere: &[Vec<f64>]) -> ([f64; 3], Vec<f64>) {
        let on_grid = &self.prepared.materials[self.scene.bodies[body].material];
        let mut sent = radiated(on_grid, incident);
        if self.reach.has_interface[body] {
            // The brightest that this interface may mirror.
            let bodies = self.scene.bodies.iter().enumerate();
            let lit = self.lit();
            let mirror = mirror(self.scene, body);
            for (other, one) in bodies.filter(|(other, _)| self.reach.seen[body][*other] > 0.0) {
                let all: Vec<f64> = lit[other].iter().zip(&anywhere[other]).map(|(a, b)| a + b).collect();
                let mirrored = radiated(&self.prepared.materials[one.material], &all);
                for ((sum, value), c) in sent.iter_mut().zip(mirrored).zip(&on_grid.intensity) {
                    *sum += c * value * mirror;
                }
            }
        }
        let weights = &self.prepared.weights;
        let sum = |c: usize| weights[c].iter().zip(&sent).map(|(weight, value)| weight * value).sum::<f64>();
        (self.over_white([sum(0), sum(1), sum(2)]), sent.iter().map(|value| value * FRAC_1_PI).collect())
    }

    fn over_white(&self, xyz: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| xyz[c] / self.prepared.white[c])
    }
}
