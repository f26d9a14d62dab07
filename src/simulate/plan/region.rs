//! A body, or a patch of it: the factors that light has there, and the largest difference that they make with what is left out.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use std::f64::consts::PI;
use std::rc::Rc;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::source::Source;
use super::bound::Bound;
use super::full::{Full, Indirect};
use super::lab::{Factor, Interest, Largest, Look, largest};
use super::left::LeftOut;
use super::patch::Patch;
use super::stepped::Stepped;

/// Lights that a place may be in the shade of or not, all combinations of which are looked at.
const MOST_SHADES: usize = 6;
/// A bound that is so many times what is allowed is not looked at any closer.
const HOPELESS: f64 = 4.0;

/// How much of a light there may be at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lit {
    /// Least and largest cos(theta_i) times the strength, the largest where nothing hides it.
    least: f64,
    most: f64,
    /// Whether a body stands before it everywhere.
    is_dark: bool,
    /// Whether a body may stand before it.
    is_shaded: bool,
}

/// How much light there may be at a place of a body.
struct Region {
    body: usize,
    /// Its patch, of those that light goes between or a part of one, and the number of that.
    patch: Option<(usize, Patch)>,
    /// How often it has been cut.
    depth: u32,
    /// How much of each light there may be.
    lit: Vec<Lit>,
    /// Largest shares of the ways of the same colours.
    by_ways: Vec<f64>,
    /// What is kept, and what is left out, of the light by others beyond that, each of X, Y and Z for itself.
    further: Rc<Further>,
    left: Rc<LeftOut>,
}

/// XYZ over white of light by others, and the spectrum of what is left out of it.
#[derive(Default)]
struct Further {
    kept: Vec<[f64; 3]>,
    /// What is drawn that is no part of the full picture.
    drawn: Vec<([f64; 3], Rc<Vec<f64>>)>,
    lost: Vec<([f64; 3], Rc<Vec<f64>>)>,
}

/// A region with what it changes by at most.
struct Bounded {
    bound: Bound,
    /// Whether boxes of factors were looked at, and not only all of them as one.
    is_close: bool,
    region: Region,
}

impl Lit {
    fn ends(self, has_shadow: bool) -> [f64; 2] {
        [self.least, if self.is_dark && has_shadow { 0.0 } else { self.most }]
    }
}

impl Ord for Bounded {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.delta_e.total_cmp(&other.bound.delta_e)
    }
}

impl PartialOrd for Bounded {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Bounded {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Bounded {}

/// A factor with the spectrum that is left out.
struct Part {
    factor: Factor,
    peak: Rc<Vec<f64>>,
    is_by_way: bool,
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
    /// What no pixel changes by more than. Where the largest change may be, places are looked at ever more closely.
    pub(super) fn of_bodies(
        &self,
        plan: &Choice,
        planned: &Stepped,
        indirect: Option<&Indirect>,
        interest: Interest,
    ) -> Bound {
        // What is alike on all bodies of a material is made once.
        let mut known: HashMap<usize, (Rc<LeftOut>, Option<Rc<Further>>)> = HashMap::new();
        let mut all = Vec::new();
        for (body, one) in self.scene.bodies.iter().enumerate() {
            let make = || {
                let left = Rc::new(self.left_out(body, plan, planned, indirect));
                let further = indirect.filter(|indirect| indirect.lost.len() <= 1 && indirect.kept.len() <= 1);
                let further = further.map(|indirect| Rc::new(self.further(body, 0, &left, indirect)));
                (left, further)
            };
            // What an interface mirrors depends on its place.
            let (left, further) = match self.reach.has_interface[body] && indirect.is_some() {
                true => make(),
                false => known.entry(one.material).or_insert_with(make).clone(),
            };
            all.extend(self.regions(body, &left, further.as_ref(), indirect));
        }
        let is_unknown = indirect.is_none() && self.goes_round();
        let bounded = |region: Region, is_close: bool| {
            let boxes = if is_close { self.detail.boxes } else { 0 };
            let look = Look { interest, boxes, has_more: is_unknown };
            Bounded { bound: self.over_shades(&region, plan, look), is_close, region }
        };
        let mut heap: BinaryHeap<Bounded> = all.into_iter().map(|region| bounded(region, false)).collect();
        let (mut splits, mut closer) = (self.detail.splits, self.detail.closer);
        while let Some(first) = heap.peek() {
            let delta_e = first.bound.delta_e;
            let is_hopeless = first.is_close && (delta_e > HOPELESS * interest.ceiling || !delta_e.is_finite());
            if delta_e <= interest.floor || is_hopeless || closer == 0 {
                break;
            }
            let parts = Some(&first.region).filter(|_| first.is_close && splits > 0);
            let parts = parts.and_then(|region| self.parts_of(region));
            if first.is_close && parts.is_none() {
                break;
            }
            let Some(first) = heap.pop() else { break };
            if let Some(parts) = parts {
                splits -= 1;
                heap.extend(parts.into_iter().map(|region| bounded(region, false)));
            } else {
                closer -= 1;
                heap.push(bounded(first.region, true));
            }
        }
        heap.into_iter().fold(Bound::ZERO, |all, one| all.larger(one.bound))
    }

    fn regions(
        &self,
        body: usize,
        left: &Rc<LeftOut>,
        further: Option<&Rc<Further>>,
        indirect: Option<&Indirect>,
    ) -> Vec<Region> {
        let (Some(indirect), Some(between)) = (indirect, self.between()) else { return vec![self.whole(body, left)] };
        let patches = between.exchange.patches.iter().enumerate();
        let seen = patches.filter(|(number, patch)| patch.body == body && between.exchange.is_seen[*number]);
        seen.map(|(number, patch)| {
            let further = further.map_or_else(|| Rc::new(self.further(body, number, left, indirect)), Rc::clone);
            let lit = between.lit[number].clone();
            Self::region((number, *patch), 0, lit, left, &further, |way| between.ways[way].most[number])
        })
        .collect()
    }

    /// All of a body.
    fn whole(&self, body: usize, left: &Rc<LeftOut>) -> Region {
        Region {
            body,
            patch: None,
            depth: 0,
            lit: self.reach.lit[body]
                .iter()
                .zip(&self.reach.shaded[body])
                .map(|(most, is_shaded)| Lit { least: 0.0, most: *most, is_dark: false, is_shaded: *is_shaded })
                .collect(),
            by_ways: Vec::new(),
            further: Rc::default(),
            left: Rc::clone(left),
        }
    }

    pub(super) fn lit_at(&self, patch: &Patch) -> Vec<Lit> {
        let one = |(light, source): (usize, &Source)| {
            let is_dark = patch.is_dark(self.scene, source);
            let is_shaded = is_dark || self.reach.shaded[patch.body][light] && patch.is_shaded(self.scene, source);
            let most = patch.lit(source).min(self.reach.lit[patch.body][light]);
            let least = if is_shaded { 0.0 } else { patch.least_lit(source) };
            Lit { least: least.min(most), most, is_dark, is_shaded }
        };
        self.scene.sources.iter().enumerate().map(one).collect()
    }

    fn region(
        (number, patch): (usize, Patch),
        depth: u32,
        lit: Vec<Lit>,
        left: &Rc<LeftOut>,
        further: &Rc<Further>,
        most_of: impl Fn(usize) -> f64,
    ) -> Region {
        Region {
            body: patch.body,
            patch: Some((number, patch)),
            depth,
            lit,
            by_ways: left.by_ways.iter().map(|one| one.ways.iter().map(|way| most_of(*way)).sum()).collect(),
            further: Rc::clone(further),
            left: Rc::clone(left),
        }
    }

    /// The parts of a region that the camera may see; `None` where it cannot be cut, or has been often enough.
    fn parts_of(&self, region: &Region) -> Option<Vec<Region>> {
        let ((number, patch), between) = (region.patch?, self.between()?);
        let parts = patch.quarters();
        if region.depth >= self.detail.depth || parts.is_empty() {
            return None;
        }
        let part = |patch: Patch| {
            let sight = between.exchange.sight(self.scene, &patch);
            let most_of = |way: usize| between.exchange.by_way(&sight, &between.ways[way]);
            let lit = self.lit_at(&patch);
            Self::region((number, patch), region.depth + 1, lit, &region.left, &region.further, most_of)
        };
        Some(parts.into_iter().filter(|part| part.may_be_seen(self.scene)).map(part).collect())
    }

    /// Light by others beyond the ways whose colours are known.
    fn further(&self, body: usize, patch: usize, left: &LeftOut, indirect: &Indirect) -> Further {
        let material = self.scene.bodies[body].material;
        let mut all = Further::default();
        if let Some(incident) = indirect.kept.get(patch) {
            let (xyz, spectrum) = Self::by_others(&indirect.planned, material, incident);
            if indirect.is_stepped {
                let beside = indirect.planned.beside(&spectrum, self.whole.prepared.grid.nm());
                all.drawn.push((xyz, Rc::new(beside)));
            } else {
                all.kept.push(xyz);
            }
        }
        let of = |incident: &Vec<f64>| Self::by_others(&self.whole, material, incident);
        all.lost.extend(indirect.lost.get(patch).map(of).map(|(xyz, spectrum)| (xyz, Rc::new(spectrum))));
        if let Some((xyz, spectrum)) = &left.mirrored {
            all.kept.push(*xyz);
            all.lost.extend(indirect.is_mirror_lost.then(|| (*xyz, Rc::clone(spectrum))));
        }
        all
    }

    fn parts(&self, region: &Region, plan: &Choice) -> Parts {
        let mut parts = Parts { all: Vec::new(), pairs: Vec::new(), shades: Vec::new() };
        for one in &region.left.direct {
            let light = one.light;
            let [least, most] = if one.is_lobe {
                [0.0, self.reach.shining[region.body][light]]
            } else {
                region.lit[light].ends(plan.has(Effect::Shadow))
            };
            if parts.pairs.last().is_none_or(|(last, _)| *last != light) {
                parts.pairs.push((light, [None; 2]));
            }
            if let Some((_, at)) = parts.pairs.last_mut() {
                at[usize::from(one.is_lobe)] = Some(parts.all.len());
            }
            if !plan.has(Effect::Shadow) && region.lit[light].is_shaded {
                let factor = Factor { least: 0.0, most, kept: one.kept, left_out: one.kept.map(|value| -value) };
                parts.shades.push((parts.all.len(), Part { factor, peak: Rc::clone(&one.all), is_by_way: false }));
            }
            let factor = Factor { least, most, kept: one.kept, left_out: one.left_out };
            parts.all.push(Part { factor, peak: Rc::clone(&one.lost), is_by_way: false });
        }
        for (one, most) in region.left.by_ways.iter().zip(&region.by_ways).filter(|(_, most)| **most > 0.0) {
            let factor = Factor { least: 0.0, most: *most, kept: one.kept, left_out: one.left_out };
            merge(&mut parts.all, Part { factor, peak: Rc::clone(&one.lost), is_by_way: true });
        }
        region.further.add_to(&mut parts.all);
        parts
    }

    /// The largest difference of a region.
    fn over_shades(&self, region: &Region, plan: &Choice, look: Look) -> Bound {
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
            let mut spectra: Vec<&Vec<f64>> = parts.iter().map(|part| &*part.peak).collect();
            for (_, (at, shadow)) in shades.iter().enumerate().filter(|(k, _)| which >> k & 1 == 1) {
                factors[*at] = shadow.factor;
                spectra[*at] = &shadow.peak;
            }
            let Some((light, [base, Some(lobe)])) = lobe else {
                all = all.larger(self.found(&factors, &spectra, look.above(all.delta_e)));
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
                all = all.larger(self.found(&factors, &spectra, look.above(all.delta_e)));
            }
        }
        all
    }

    fn found(&self, factors: &[Factor], spectra: &[&Vec<f64>], look: Look) -> Bound {
        let count = spectra.iter().map(|list| list.len()).max().unwrap_or(0);
        let at = |j: usize| {
            let part = |(factor, list): (&Factor, &&Vec<f64>)| match list.get(j) {
                None | Some(0.0) => 0.0,
                Some(value) => factor.most * value,
            };
            factors.iter().zip(spectra).map(part).sum::<f64>()
        };
        let radiance = (0..count).map(at).fold(0.0, f64::max) * PI / self.brightest;
        let luminance = {
            let sides = factors.iter().map(|one| if one.left_out[1] == 0.0 { 0.0 } else { one.most * one.left_out[1] });
            let (low, high) =
                sides.fold((0.0, 0.0), |(low, high): (f64, f64), value| (low + value.min(0.0), high + value.max(0.0)));
            high.max(-low)
        };
        let Largest { bound, at } = largest(factors, look);
        Bound { radiance, luminance, delta_e: bound, ciede2000_there: self.ciede2000(at) }
    }

    fn ciede2000(&self, at: [[f64; 3]; 2]) -> Option<f64> {
        if at[0] == at[1] {
            return None;
        }
        let white = self.whole.prepared.white.map(|value| 100.0 * value);
        let colour = |xyz: [f64; 3]| crate::donaldson::Colour {
            observer: self.scene.observer,
            xyz: [0, 1, 2].map(|c| xyz[c] * white[c]),
            white,
        };
        colour(at[0]).difference(&colour(at[1])).map(|difference| difference.de2000)
    }
}

impl Further {
    /// Each of X, Y and Z for itself.
    fn add_to(&self, parts: &mut Vec<Part>) {
        let alone = |xyz: &[f64; 3], c: usize| [0, 1, 2].map(|k| if k == c { xyz[c] } else { 0.0 });
        let mut add = |kept: [f64; 3], left_out: [f64; 3], peak: Rc<Vec<f64>>| {
            if kept != [0.0; 3] || left_out != [0.0; 3] || !peak.is_empty() {
                let factor = Factor { least: 0.0, most: 1.0, kept, left_out };
                parts.push(Part { factor, peak, is_by_way: false });
            }
        };
        for c in 0..3 {
            self.kept.iter().for_each(|xyz| add(alone(xyz, c), [0.0; 3], Rc::default()));
            // The spectrum is that of all three.
            let peak = |spectrum: &Rc<Vec<f64>>| if c == 1 { Rc::clone(spectrum) } else { Rc::default() };
            for (xyz, spectrum) in &self.drawn {
                add(alone(xyz, c), alone(xyz, c).map(|value| -value), peak(spectrum));
            }
            for (xyz, spectrum) in &self.lost {
                add([0.0; 3], alone(xyz, c), peak(spectrum));
            }
        }
    }
}

/// Adds a part that may be missing; one of the same colours makes one with another.
fn merge(parts: &mut Vec<Part>, part: Part) {
    let both = |one: &Factor| {
        let [[a, b, c], [d, e, f]] = [one.kept, one.left_out].map(|xyz| xyz.map(|value| one.most * value));
        [a, b, c, d, e, f]
    };
    let new = both(&part.factor);
    let is_same = |old: &&mut Part| {
        let scale = both(&old.factor);
        let ratio = (new[1] + new[4]) / (scale[1] + scale[4]);
        let is_near = |k: usize| (scale[k] * ratio - new[k]).abs() <= 1e-12 * new[k].abs();
        old.is_by_way && ratio > 0.0 && ratio.is_finite() && (0..6).all(is_near)
    };
    match parts.iter_mut().find(is_same) {
        Some(old) => {
            let xyz = both(&old.factor);
            let peak = (0..old.peak.len().max(part.peak.len()))
                .map(|j| {
                    let at = |part: &Part| part.peak.get(j).map_or(0.0, |value| part.factor.most * value);
                    at(old) + at(&part)
                })
                .collect();
            old.peak = Rc::new(peak);
            let sum = |k: usize| (xyz[k] + new[k]) * (1.0 + 1e-12);
            let [kept, left_out] = [[0, 1, 2].map(sum), [3, 4, 5].map(sum)];
            old.factor = Factor { least: 0.0, most: 1.0, kept, left_out };
        }
        None => parts.push(part),
    }
}
