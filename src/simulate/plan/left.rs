//! What is left out of a body, as colours and spectra under each light.

use std::f64::consts::FRAC_1_PI;
use std::rc::Rc;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::scene::Bounces;
use super::exchange::radiated;
use super::full::{Full, Indirect};
use super::reach::mirror;
use super::stepped::{Acts, Stepped, done};

/// What follows one factor of the geometry: cos(theta_i) of a light, or its lobe. XYZ are over those of white.
pub(super) struct Direct {
    pub(super) light: usize,
    pub(super) is_lobe: bool,
    /// In the picture as planned.
    pub(super) kept: [f64; 3],
    /// What the full picture has more of.
    pub(super) left_out: [f64; 3],
    /// Spectrum of what is left out.
    pub(super) lost: Rc<Vec<f64>>,
    /// Spectrum of all: what a shadow takes that is not drawn.
    pub(super) all: Rc<Vec<f64>>,
}

/// Light of the same colours by some ways, by their numbers.
pub(super) struct ByWays {
    pub(super) ways: Vec<usize>,
    is_drawn: bool,
    pub(super) kept: [f64; 3],
    pub(super) left_out: [f64; 3],
    pub(super) lost: Rc<Vec<f64>>,
}

/// What is left out of a body.
pub(super) struct LeftOut {
    pub(super) direct: Vec<Direct>,
    pub(super) by_ways: Vec<ByWays>,
    /// What the interface mirrors of other bodies at most.
    pub(super) mirrored: Option<([f64; 3], Rc<Vec<f64>>)>,
}

impl Full<'_> {
    pub(super) fn left_out(
        &self,
        body: usize,
        plan: &Choice,
        planned: &Stepped,
        indirect: Option<&Indirect>,
    ) -> LeftOut {
        let material = self.scene.bodies[body].material;
        LeftOut {
            direct: self.direct(material, plan, planned),
            by_ways: indirect.map_or_else(Vec::new, |_| self.by_ways(material, plan, planned)),
            mirrored: indirect
                .and_then(|indirect| self.mirrored(body, indirect))
                .map(|(xyz, spectrum)| (xyz, Rc::new(spectrum))),
        }
    }

    fn direct(&self, material: usize, plan: &Choice, planned: &Stepped) -> Vec<Direct> {
        let (full, less) = (self.whole.acts(material), planned.acts(material));
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
                let (kept, whole) = (sum(less, &has), sum(full, &|_| true));
                // What is kept as it is cancels exactly.
                let is_exact = |act: usize| has(act) && !is_stepped;
                let left_out = match is_stepped {
                    _ if acts.iter().all(|act| is_exact(*act)) => [0.0; 3],
                    true => [0, 1, 2].map(|c| whole[c] - kept[c]),
                    false => sum(full, &|act| !has(act)),
                };
                let spectrum = |counts: &dyn Fn(usize) -> bool| -> Vec<f64> {
                    let counted: Vec<&Vec<f64>> =
                        acts.iter().filter(|act| counts(**act)).map(|act| &full[*act].spectra[light]).collect();
                    (0..full[0].spectra[light].len()).map(|j| counted.iter().map(|list| list[j].abs()).sum()).collect()
                };
                let (mut lost, all) = (spectrum(&|act| !is_exact(act)), spectrum(&|_| true));
                for act in acts.iter().filter(|act| is_stepped && has(**act)) {
                    let drawn = planned.beside(&less[*act].spectra[light], self.whole.prepared.grid.nm());
                    lost.iter_mut().zip(drawn).for_each(|(lost, value)| *lost += value);
                }
                if whole != [0.0; 3] || kept != [0.0; 3] || lost.iter().any(|value| *value != 0.0) {
                    let (lost, all) = (Rc::new(lost), Rc::new(all));
                    list.push(Direct { light, is_lobe: acts == [2], kept, left_out, lost, all });
                }
            }
        }
        list
    }

    /// Colours of each way: what light does on it depends on the materials alone, with what is planned as in full.
    fn by_ways(&self, material: usize, plan: &Choice, planned: &Stepped) -> Vec<ByWays> {
        let Some(between) = self.between() else { return Vec::new() };
        let ways = &between.ways;
        let full = self.whole.by_ways(ways, true);
        let less = planned.by_ways(ways, plan.has(Effect::Luminescence));
        let acts = [plan.has(Effect::Luminescence), plan.has(Effect::Diffuse), false];
        let is_stepped = plan.step_nm != self.choice.step_nm;
        let mut all: Vec<ByWays> = Vec::new();
        for (number, way) in ways.iter().enumerate().filter(|(_, way)| is_within(way.order, self.choice.bounces)) {
            let is_drawn = is_within(way.order, plan.bounces_drawn())
                && (plan.has(Effect::Surround) || !self.scene.sources[way.light].is_surround());
            let is_same = |other: &&mut ByWays| {
                let first = &ways[other.ways[0]];
                (first.light, &first.materials) == (way.light, &way.materials) && other.is_drawn == is_drawn
            };
            if let Some(same) = all.iter_mut().find(is_same) {
                same.ways.push(number);
                continue;
            }
            let whole = done(&self.whole.prepared.materials[material], &full[number], [true, true, false]);
            let xyz = self.whole.colour(&whole);
            let is_exact = is_drawn && !is_stepped && acts == [true, true, false];
            let drawn = match is_drawn {
                true => done(&planned.prepared.materials[material], &less[number], acts),
                false => vec![0.0; planned.prepared.grid.nm().len()],
            };
            let kept = planned.colour(&drawn);
            let left_out = if is_exact { [0.0; 3] } else { [0, 1, 2].map(|c| xyz[c] - kept[c]) };
            let lost: Vec<f64> = match is_stepped {
                _ if is_exact => Vec::new(),
                true => {
                    let beside = planned.beside(&drawn, self.whole.prepared.grid.nm());
                    whole.iter().zip(beside).map(|(whole, drawn)| (whole.abs() + drawn) * FRAC_1_PI).collect()
                }
                false => whole.iter().zip(&drawn).map(|(whole, drawn)| (whole - drawn).abs() * FRAC_1_PI).collect(),
            };
            if xyz != [0.0; 3] || kept != [0.0; 3] || lost.iter().any(|value| *value != 0.0) {
                all.push(ByWays { ways: vec![number], is_drawn, kept, left_out, lost: Rc::new(lost) });
            }
        }
        all
    }

    /// X, Y, Z and the spectrum of radiance that an irradiance by others makes at most.
    pub(super) fn by_others(stepped: &Stepped, material: usize, incident: &[f64]) -> ([f64; 3], Vec<f64>) {
        at_most(stepped, &radiated(&stepped.prepared.materials[material], incident))
    }

    /// The brightest that the interface of a body may mirror of others.
    fn mirrored(&self, body: usize, indirect: &Indirect) -> Option<([f64; 3], Vec<f64>)> {
        if !self.reach.has_interface[body] {
            return None;
        }
        let mirror = mirror(self.scene, body);
        let intensity = &self.whole.prepared.materials[self.scene.bodies[body].material].intensity;
        let mut sum = vec![0.0; intensity.len()];
        let bodies = self.scene.bodies.iter().enumerate();
        for (other, one) in bodies.filter(|(other, _)| self.reach.seen[body][*other] > 0.0) {
            let sent = radiated(&self.whole.prepared.materials[one.material], &indirect.all[other]);
            sum.iter_mut().zip(sent).zip(intensity).for_each(|((sum, value), c)| *sum += c * value * mirror);
        }
        sum.iter().any(|value| *value > 0.0).then(|| at_most(&self.whole, &sum))
    }
}

fn at_most(stepped: &Stepped, sent: &[f64]) -> ([f64; 3], Vec<f64>) {
    (stepped.colour(sent), sent.iter().map(|value| value * FRAC_1_PI).collect())
}

/// True where light that has gone from body to body so often is asked for.
pub(super) fn is_within(order: u32, bounces: Bounces) -> bool {
    match bounces {
        Bounces::All => true,
        Bounces::Most(most) => order <= most,
    }
}
