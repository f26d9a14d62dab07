//! One body: what is left out of it, as colours with factors that lie between a least and a largest value.

use std::f64::consts::FRAC_1_PI;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::interface::Interface;
use super::super::picture::{Kept, Prepared};
use super::super::transport::{Act, Spectra};
use super::bound::Bound;
use super::exchange::radiated;
use super::full::{Full, Indirect};
use super::lab::{Factor, Largest, largest};
use super::reach::TABLE;

/// Lights that a body may be in the shade of or not, all combinations of which are looked at.
const MOST_SHADES: usize = 6;

/// Colours of an act of a material under each light, with the spectrum of each.
struct Acts {
    xyz: Vec<[f64; 3]>,
    spectra: Vec<Vec<f64>>,
}

/// A factor with the spectrum that is left out.
struct Part {
    factor: Factor,
    peak: Vec<f64>,
}

impl Full<'_> {
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

    /// What no pixel of a body changes by more than.
    pub(super) fn of_body(&self, body: usize, plan: &Choice, planned: &Prepared, indirect: Option<&Indirect>) -> Bound {
        let material = self.scene.bodies[body].material;
        let all = |prepared: &Prepared| {
            [Act::Luminescent, Act::Diffuse, Act::Specular].map(|act| self.acts(prepared, act, material))
        };
        let (full, less) = (all(&self.prepared), all(planned));
        let has = |act: usize, surround: bool| {
            plan.has([Effect::Luminescence, Effect::Diffuse, Effect::Specular][act])
                && (!surround || plan.has(Effect::Surround))
        };
        let mut parts: Vec<Part> = Vec::new();
        let mut shades: Vec<(usize, Factor, Vec<f64>)> = Vec::new();
        // Where the factors of a light stand: cos(theta_i), and the lobe.
        let mut pairs: Vec<(usize, [Option<usize>; 2])> = Vec::new();
        for (light, source) in self.scene.sources.iter().enumerate() {
            pairs.push((light, [None; 2]));
            for acts in [vec![0, 1], vec![2]] {
                let most = if acts[0] == 2 { self.reach.shining[body][light] } else { self.reach.lit[body][light] };
                let sum = |from: &[Acts; 3], counts: &dyn Fn(usize) -> bool| {
                    let mut xyz = [0.0; 3];
                    for act in acts.iter().filter(|act| counts(**act)) {
                        (0..3).for_each(|c| xyz[c] += from[*act].xyz[light][c]);
                    }
                    xyz
                };
                let kept = sum(&less, &|act| has(act, source.is_surround()));
                let whole = sum(&full, &|_| true);
                let exact = |act: usize| has(act, source.is_surround()) && plan.step_nm == self.choice.step_nm;
                // What is kept as it is cancels exactly.
                let left_out = if acts.iter().all(|act| exact(*act)) {
                    [0.0; 3]
                } else if plan.step_nm == self.choice.step_nm {
                    sum(&full, &|act| !has(act, source.is_surround()))
                } else {
                    [0, 1, 2].map(|c| whole[c] - kept[c])
                };
                let spectrum = |j: usize| -> f64 {
                    acts.iter().filter(|act| !exact(**act)).map(|act| full[*act].spectra[light][j].abs()).sum()
                };
                let lost: Vec<f64> = (0..full[0].spectra[light].len()).map(spectrum).collect();
                if whole == [0.0; 3] && kept == [0.0; 3] && lost.iter().all(|value| *value == 0.0) {
                    continue;
                }
                if !plan.has(Effect::Shadow) && self.reach.shaded[body][light] {
                    let shadow: Vec<f64> = (0..lost.len())
                        .map(|j| acts.iter().map(|act| full[*act].spectra[light][j].abs()).sum())
                        .collect();
                    shades.push((
                        parts.len(),
                        Factor { least: 0.0, most, kept, left_out: kept.map(|value| -value) },
                        shadow,
                    ));
                }
                if let Some((_, at)) = pairs.last_mut() {
                    at[usize::from(acts[0] == 2)] = Some(parts.len());
                }
                parts.push(Part { factor: Factor { least: 0.0, most, kept, left_out }, peak: lost });
            }
        }
        if let Some(indirect) = indirect {
            if indirect.has_first {
                parts.extend(self.by_one(body, material));
            }
            parts.extend(self.by_others(body, material, indirect));
        }
        self.over_shades(body, plan, &parts, &shades, &pairs)
    }

    fn over_white(&self, xyz: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| xyz[c] / self.prepared.white[c])
    }

    /// Light that has come from the lights by one other body: for each light and material its own colour.
    fn by_one(&self, body: usize, material: usize) -> Vec<Part> {
        let spectra = [Kept::Colour, Kept::Spectra].map(|kept| self.prepared.spectra(self.scene, &self.choice, kept));
        let here = [0, 1].map(|k| {
            let spectra: &Spectra<'_> = &spectra[k];
            spectra.before(&spectra.channels.concat(), Act::Body, material)
        });
        let exchange = &self.between().exchange;
        let mut parts: Vec<Part> = Vec::new();
        for other in 0..self.scene.materials.len() {
            let is_of = |body: usize| self.scene.bodies[body].material == other;
            let [colours, lists] = [0, 1].map(|k| spectra[k].through(&spectra[k].before(&here[k], Act::Body, other)));
            let count = spectra[1].channels.len();
            for light in 0..self.scene.sources.len() {
                let xyz = &colours[3 * light..3 * light + 3];
                let own = |number: &usize| exchange.patches[*number].body == body && exchange.is_seen[*number];
                let most = (0..exchange.patches.len()).filter(own).map(|patch| exchange.first(patch, light, is_of));
                let factor = Factor {
                    least: 0.0,
                    most: most.fold(0.0, f64::max),
                    kept: [0.0; 3],
                    left_out: self.over_white([xyz[0], xyz[1], xyz[2]]),
                };
                if factor.most > 0.0 && factor.left_out != [0.0; 3] {
                    let list = &lists[light * count..(light + 1) * count];
                    merge(&mut parts, Part { factor, peak: list.iter().map(|value| value.abs()).collect() });
                }
            }
        }
        parts
    }

    /// Light from other bodies beyond that: three factors, each of X, Y and Z for itself.
    fn by_others(&self, body: usize, material: usize, indirect: &Indirect) -> Vec<Part> {
        let on_grid = &self.prepared.materials[material];
        let mut sent = radiated(on_grid, &indirect.seen[body]);
        if self.reach.has_interface[body] {
            // The brightest that this interface may mirror.
            let bodies = self.scene.bodies.iter().enumerate();
            let incident = self.lit();
            for (other, one) in bodies.filter(|(other, _)| self.reach.seen[body][*other] > 0.0) {
                let all: Vec<f64> = incident[other].iter().zip(&indirect.anywhere[other]).map(|(a, b)| a + b).collect();
                let mirrored = radiated(&self.prepared.materials[one.material], &all);
                for ((sum, value), c) in sent.iter_mut().zip(mirrored).zip(&on_grid.intensity) {
                    *sum += c * value * self.mirror(body);
                }
            }
        }
        let sum =
            |c: usize| self.prepared.weights[c].iter().zip(&sent).map(|(weight, value)| weight * value).sum::<f64>();
        let most = self.over_white([sum(0), sum(1), sum(2)]);
        let unit = |c: usize| [0, 1, 2].map(|k| if k == c { most[c] } else { 0.0 });
        let nothing = vec![0.0; sent.len()];
        let peak: Vec<f64> = sent.iter().map(|value| value * FRAC_1_PI).collect();
        (0..3)
            .map(|c| Part {
                factor: Factor { least: 0.0, most: 1.0, kept: [0.0; 3], left_out: unit(c) },
                peak: if c == 0 { peak.clone() } else { nothing.clone() },
            })
            .collect()
    }

    /// The share of light from all around that an interface sends on at most.
    fn mirror(&self, body: usize) -> f64 {
        if self.reach.mirrored[body] > 0.0 {
            return self.reach.mirrored[body];
        }
        let term = self.scene.materials[self.scene.bodies[body].material].specular;
        term.map_or(0.0, |term| TABLE * Interface::new(&term).surrounded().into_iter().fold(0.0, f64::max))
    }

    fn over_shades(
        &self,
        body: usize,
        plan: &Choice,
        parts: &[Part],
        shades: &[(usize, Factor, Vec<f64>)],
        pairs: &[(usize, [Option<usize>; 2])],
    ) -> Bound {
        let lights = shades.len();
        if lights > MOST_SHADES {
            return Bound::UNKNOWN;
        }
        // A lobe shines where its light falls in steeply: its brightest rings are never without diffuse light.
        let brightest = |(light, at): &&(usize, [Option<usize>; 2])| {
            at[1].map_or(0.0, |at| parts[at].factor.left_out[1].abs() * self.reach.shining[body][*light])
        };
        let has_rings = |light: usize| !self.reach.rings[body][light].is_empty();
        let lobe = pairs
            .iter()
            .filter(|pair| has_rings(pair.0) && brightest(pair) > 0.0)
            .max_by(|a, b| brightest(a).total_cmp(&brightest(b)));
        let lobe = lobe.filter(|_| !plan.has(Effect::Specular));
        let mut all = Bound::ZERO;
        for which in 0..1_usize << lights {
            let mut factors: Vec<Factor> = parts.iter().map(|part| part.factor).collect();
            let mut spectra: Vec<&Vec<f64>> = parts.iter().map(|part| &part.peak).collect();
            for (_, (at, factor, shadow)) in shades.iter().enumerate().filter(|(k, _)| which >> k & 1 == 1) {
                factors[*at] = *factor;
                spectra[*at] = shadow;
            }
            let Some((light, [base, Some(lobe)])) = lobe else {
                all = all.larger(self.found(&factors, &spectra));
                continue;
            };
            // In the shade of this light there is neither; the rings are of places that it reaches.
            let hidden = Factor { least: 0.0, most: 0.0, ..factors[*lobe] };
            let rings = self.reach.rings[body][*light].iter().map(|ring| (ring.shining, ring.least_lit));
            for (shining, least) in rings.chain([(hidden.most, 0.0)]) {
                let mut factors = factors.clone();
                factors[*lobe].most = shining;
                if let Some(base) = base {
                    factors[*base].least = least.min(factors[*base].most);
                }
                all = all.larger(self.found(&factors, &spectra));
            }
        }
        all
    }

    fn found(&self, factors: &[Factor], spectra: &[&Vec<f64>]) -> Bound {
        let count = spectra.first().map_or(0, |list| list.len());
        let at = |j: usize| {
            let part = |(factor, list): (&Factor, &&Vec<f64>)| if list[j] == 0.0 { 0.0 } else { factor.most * list[j] };
            factors.iter().zip(spectra).map(part).sum::<f64>()
        };
        let radiance = (0..count).map(at).fold(0.0, f64::max) * std::f64::consts::PI / self.brightest;
        let luminance = {
            let sides = factors.iter().map(|one| if one.left_out[1] == 0.0 { 0.0 } else { one.most * one.left_out[1] });
            let (low, high) =
                sides.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low + value.min(0.0), high + value.max(0.0)));
            high.max(-low)
        };
        let Largest { bound, at } = largest(factors);
        Bound { radiance, luminance, delta_e: bound, ciede2000_there: self.ciede2000(at) }
    }

    fn ciede2000(&self, at: [[f64; 3]; 2]) -> Option<f64> {
        if at[0] == at[1] {
            return None;
        }
        let white = self.prepared.white.map(|value| 100.0 * value);
        let colour = |xyz: [f64; 3]| crate::donaldson::Colour {
            observer: self.scene.observer,
            xyz: [0, 1, 2].map(|c| xyz[c] * white[c]),
            white,
        };
        colour(at[0]).difference(&colour(at[1])).map(|difference| difference.de2000)
    }
}

/// Adds a part; one of the same colour makes one with another.
fn merge(parts: &mut Vec<Part>, part: Part) {
    let sum = |one: &Factor| one.left_out.map(|value| one.most * value);
    let new = sum(&part.factor);
    let is_same = |old: &&mut Part| {
        let old = sum(&old.factor);
        let ratio = new[1] / old[1];
        ratio > 0.0 && ratio.is_finite() && (0..3).all(|c| (old[c] * ratio - new[c]).abs() <= 1e-12 * new[c].abs())
    };
    match parts.iter_mut().find(is_same) {
        Some(old) => {
            let xyz = sum(&old.factor);
            old.peak =
                old.peak.iter().zip(&part.peak).map(|(a, b)| old.factor.most * a + part.factor.most * b).collect();
            old.factor = Factor {
                least: 0.0,
                most: 1.0,
                kept: [0.0; 3],
                left_out: [0, 1, 2].map(|c| (xyz[c] + new[c]) * (1.0 + 1e-12)),
            };
        }
        None => parts.push(part),
    }
}
