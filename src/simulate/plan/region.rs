//! A body, or a patch of it: the factors that light has there, and the largest difference that they make with what is left out.

use std::f64::consts::PI;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::picture::Prepared;
use super::bound::Bound;
use super::full::{Between, Full, Indirect};
use super::lab::{Factor, Interest, Largest, largest};
use super::left::LeftOut;

/// Lights that a place may be in the shade of or not, all combinations of which are looked at.
const MOST_SHADES: usize = 6;

/// How much light there may be at a place of a body.
struct Region<'a> {
    body: usize,
    /// Least and largest cos(theta_i) times the strength of each light.
    lit: Vec<[f64; 2]>,
    /// Whether a body may stand before each.
    shaded: Vec<bool>,
    /// Largest share of each way that is not drawn.
    by_ways: Vec<f64>,
    /// XYZ over white, and the spectrum, of light by others beyond that.
    further: Option<([f64; 3], Vec<f64>)>,
    left: &'a LeftOut,
}

/// A factor with the spectrum that is left out.
struct Part {
    factor: Factor,
    peak: Vec<f64>,
}

/// The parts of a region, and what of them is as it is in the shade.
struct Parts {
    all: Vec<Part>,
    /// Light, and the parts that stand for cos(theta_i) and for the lobe.
    pairs: Vec<(usize, [Option<usize>; 2])>,
    /// The part that it takes the place of, in the shade of a light of which no shadow is drawn.
    shades: Vec<(usize, Part)>,
}

impl Full<'_> {
    /// What no pixel of a body changes by more than.
    pub(super) fn of_body(
        &self,
        body: usize,
        plan: &Choice,
        planned: &Prepared,
        indirect: Option<&Indirect>,
        interest: Interest,
    ) -> Bound {
        let left = self.left_out(body, plan, planned, indirect.map_or(0..0, |indirect| indirect.known.clone()));
        let mut regions = match indirect {
            None => vec![self.whole(body, &left)],
            Some(indirect) => self.patches(body, &left, indirect),
        };
        // The brightest first: most of the others are then seen at once to change by less.
        let size = |region: &Region<'_>| region.further.as_ref().map_or(0.0, |(xyz, _)| xyz[1]);
        regions.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let mut all = Bound::ZERO;
        for region in &regions {
            if all.delta_e > interest.ceiling {
                break;
            }
            all = all.larger(self.over_shades(region, plan, interest.above(all.delta_e)));
        }
        all
    }

    fn whole<'a>(&self, body: usize, left: &'a LeftOut) -> Region<'a> {
        Region {
            body,
            lit: self.reach.lit[body].iter().map(|most| [0.0, *most]).collect(),
            shaded: self.reach.shaded[body].clone(),
            by_ways: Vec::new(),
            further: None,
            left,
        }
    }

    fn patches<'a>(&self, body: usize, left: &'a LeftOut, indirect: &Indirect) -> Vec<Region<'a>> {
        let Some(Between { exchange, ways, .. }) = self.between() else { return Vec::new() };
        let lights = 0..self.scene.sources.len();
        exchange
            .patches
            .iter()
            .enumerate()
            .filter(|(number, patch)| patch.body == body && exchange.is_seen[*number])
            .map(|(number, patch)| {
                let lit = |light: usize| {
                    let source = &self.scene.sources[light];
                    let most = patch.lit(source).min(self.reach.lit[body][light]);
                    let least = if patch.is_shaded(self.scene, source) { 0.0 } else { patch.least_lit(source) };
                    [least.min(most), most]
                };
                Region {
                    body,
                    lit: lights.clone().map(lit).collect(),
                    shaded: lights
                        .clone()
                        .map(|light| {
                            self.reach.shaded[body][light] && patch.is_shaded(self.scene, &self.scene.sources[light])
                        })
                        .collect(),
                    by_ways: left.by_ways.iter().map(|one| ways[one.way].most[number]).collect(),
                    further: Some(self.by_others(body, &indirect.by_patch[number], &indirect.anywhere)),
                    left,
                }
            })
            .collect()
    }

    fn parts(&self, region: &Region<'_>, plan: &Choice) -> Parts {
        let mut parts = Parts { all: Vec::new(), pairs: Vec::new(), shades: Vec::new() };
        for one in &region.left.direct {
            let light = one.light;
            let [least, most] =
                if one.is_lobe { [0.0, self.reach.shining[region.body][light]] } else { region.lit[light] };
            if parts.pairs.last().is_none_or(|(last, _)| *last != light) {
                parts.pairs.push((light, [None; 2]));
            }
            if let Some((_, at)) = parts.pairs.last_mut() {
                at[usize::from(one.is_lobe)] = Some(parts.all.len());
            }
            if !plan.has(Effect::Shadow) && region.shaded[light] {
                let factor = Factor { least: 0.0, most, kept: one.kept, left_out: one.kept.map(|value| -value) };
                parts.shades.push((parts.all.len(), Part { factor, peak: one.all.clone() }));
            }
            let factor = Factor { least, most, kept: one.kept, left_out: one.left_out };
            parts.all.push(Part { factor, peak: one.lost.clone() });
        }
        for (one, most) in region.left.by_ways.iter().zip(&region.by_ways) {
            if *most > 0.0 {
                let factor = Factor { least: 0.0, most: *most, kept: [0.0; 3], left_out: one.xyz };
                merge(&mut parts.all, Part { factor, peak: one.peak.clone() });
            }
        }
        if let Some((most, peak)) = &region.further {
            // Each of X, Y and Z for itself.
            for (c, value) in most.iter().enumerate() {
                let left_out = [0, 1, 2].map(|k| if k == c { *value } else { 0.0 });
                let factor = Factor { least: 0.0, most: 1.0, kept: [0.0; 3], left_out };
                parts.all.push(Part { factor, peak: if c == 0 { peak.clone() } else { vec![0.0; peak.len()] } });
            }
        }
        parts
    }

    /// The largest difference of a region.
    fn over_shades(&self, region: &Region<'_>, plan: &Choice, interest: Interest) -> Bound {
        let Parts { all: parts, pairs, shades } = self.parts(region, plan);
        let (body, lights) = (region.body, shades.len());
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
            for (_, (at, shadow)) in shades.iter().enumerate().filter(|(k, _)| which >> k & 1 == 1) {
                factors[*at] = shadow.factor;
                spectra[*at] = &shadow.peak;
            }
            let Some((light, [base, Some(lobe)])) = lobe else {
                all = all.larger(self.found(&factors, &spectra, interest.above(all.delta_e)));
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
                all = all.larger(self.found(&factors, &spectra, interest.above(all.delta_e)));
            }
        }
        all
    }

    fn found(&self, factors: &[Factor], spectra: &[&Vec<f64>], interest: Interest) -> Bound {
        let count = spectra.first().map_or(0, |list| list.len());
        let at = |j: usize| {
            let part = |(factor, list): (&Factor, &&Vec<f64>)| if list[j] == 0.0 { 0.0 } else { factor.most * list[j] };
            factors.iter().zip(spectra).map(part).sum::<f64>()
        };
        let radiance = (0..count).map(at).fold(0.0, f64::max) * PI / self.brightest;
        let luminance = {
            let sides = factors.iter().map(|one| if one.left_out[1] == 0.0 { 0.0 } else { one.most * one.left_out[1] });
            let (low, high) =
                sides.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low + value.min(0.0), high + value.max(0.0)));
            high.max(-low)
        };
        let Largest { bound, at } = largest(factors, interest);
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
