//! A bound on the light that comes by way of other bodies.
//!
//! Each patch sees another in a share of its hemisphere that is bounded by the cones of their normals, the distance and the area, all
//! patches of a body together in the share of a ball about it, and all bodies in the whole of it at most. So the largest radiances of one
//! order bound the irradiances of the next, wavelength by wavelength. The bound of an order is monotone and homogeneous in that of the
//! one before: once all of it falls by a factor r in two orders, what follows is at most r / (1 - r) of them.

use std::sync::OnceLock;

use rayon::prelude::*;

use super::super::material::OnGrid;
use super::super::scene::{Bounces, Scene};
use super::detail::Detail;
use super::patch::{Patch, cut, planes};
use super::share::{Whole, share};

/// Orders after which no bound was found.
const MOST_ORDERS: usize = 3000;
/// Numbers of all orders that are kept at most.
const MOST_KEPT: usize = 6_000_000;
/// What falls by less than this in every order is not bounded.
const FALLS: f64 = 0.999;
/// The rest over the first order that is not looked at any closer.
const SMALL: f64 = 1e-2;
/// Ways of one order at most.
const MOST_WAYS: usize = 32;
/// Patches from which on the work is worth threads.
const WORTH_THREADS: usize = 64;

/// Patches of a scene as light goes between them.
pub(super) struct Exchange {
    pub(super) patches: Vec<Patch>,
    /// Whether the camera may see each.
    pub(super) is_seen: Vec<bool>,
    /// Made where shares are asked for.
    sights: OnceLock<Vec<Sight>>,
    /// \[patch\]\[light\]: largest irradiance over that of its spectrum.
    lit: Vec<Vec<f64>>,
    bodies: Vec<Whole>,
    /// \[plane without end\]\[patch\]: the side on which it is.
    sides: Vec<Vec<i8>>,
}

/// What a patch may see at most.
pub(super) struct Sight {
    /// Of each patch the share of the hemisphere.
    shares: Vec<f64>,
    /// The same of each body.
    most: Vec<f64>,
}

/// Light that comes from a light over bodies of these materials, the last first; those that send on all wavelengths alike are not told
/// apart.
pub(super) struct Way {
    pub(super) light: usize,
    pub(super) order: u32,
    pub(super) materials: Vec<usize>,
    /// Its largest share at each patch.
    pub(super) most: Vec<f64>,
    /// What it is sent by: patches and the values of each, the brightest first.
    sent: Vec<Vec<(usize, f64)>>,
}

/// Largest irradiances of the patches by light that has gone from body to body, once, twice and so on.
pub(super) struct Orders {
    each: Vec<Vec<Vec<f64>>>,
    /// All that follows on them; `None` where nothing was looked for.
    rest: Option<Vec<Vec<f64>>>,
}

/// The share of all wavelengths alike that a material sends on, if it does.
pub(super) fn grey(material: &OnGrid) -> Option<f64> {
    let first = *material.elastic.first()?;
    let is_level = first >= 0.0 && material.elastic.iter().all(|rho| *rho == first);
    (material.luminescence.is_none() && is_level).then_some(first)
}

/// pi times the radiance of a material under an irradiance; noise below 0 counts in full.
pub(super) fn radiated(material: &OnGrid, incident: &[f64]) -> Vec<f64> {
    let mut out: Vec<f64> = material.elastic.iter().zip(incident).map(|(rho, e)| rho.abs() * e).collect();
    if let Some(matrix) = &material.luminescence {
        for (out, row) in out.iter_mut().zip(matrix.outer_iter()) {
            *out += row.iter().zip(incident).map(|(value, e)| value.abs() * e).sum::<f64>();
        }
    }
    out
}

impl Exchange {
    pub(super) fn new(scene: &Scene, detail: &Detail) -> Self {
        let patches = cut(scene, detail.patches);
        let mut all = Self {
            is_seen: patches.iter().map(|patch| patch.may_be_seen(scene)).collect(),
            lit: Vec::new(),
            sights: OnceLock::new(),
            bodies: scene.bodies.iter().map(|body| Whole::of(&body.shape)).collect(),
            sides: planes(scene)
                .map(|(number, plane)| patches.iter().map(|patch| patch.side(number, plane)).collect())
                .collect(),
            patches,
        };
        all.lit = all.patches.iter().map(|patch| lit(scene, patch)).collect();
        all
    }

    fn sights(&self, scene: &Scene) -> &[Sight] {
        self.sights.get_or_init(|| self.for_each_patch(|patch| self.sight(scene, &self.patches[patch])))
    }

    fn for_each_patch<A: Send>(&self, of: impl Fn(usize) -> A + Sync + Send) -> Vec<A> {
        let count = self.patches.len();
        if count < WORTH_THREADS { (0..count).map(of).collect() } else { (0..count).into_par_iter().map(of).collect() }
    }

    /// What a patch sees, of these or another.
    pub(super) fn sight(&self, scene: &Scene, from: &Patch) -> Sight {
        let sides: Vec<i8> = planes(scene).map(|(number, plane)| from.side(number, plane)).collect();
        let is_apart = |of: usize| sides.iter().zip(&self.sides).any(|(own, all)| own * all[of] < 0);
        let share_of = |(number, of): (usize, &Patch)| if is_apart(number) { 0.0 } else { share(from, of) };
        let shares = self.patches.iter().enumerate().map(share_of).collect();
        let most = |(number, body): (usize, &Whole)| if number == from.body { 1.0 } else { body.most_seen(from) };
        Sight { shares, most: self.bodies.iter().enumerate().map(most).collect() }
    }

    /// False where a light stands on a body.
    pub(super) fn is_finite(&self) -> bool {
        self.lit.iter().flatten().all(|value| value.is_finite())
    }

    /// The largest sum that a patch gets of what others send.
    fn gathered(&self, sight: &Sight, sent: &[(usize, f64)]) -> f64 {
        let (mut left, mut of_body) = (1.0_f64, sight.most.clone());
        let mut sum = 0.0;
        // The brightest first, until the share of its body or the hemisphere is full.
        for (of, value) in sent {
            let body = &mut of_body[self.patches[*of].body];
            let taken = sight.shares[*of].min(*body).min(left);
            left -= taken;
            *body -= taken;
            sum += taken * value;
            if left <= 0.0 {
                break;
            }
        }
        sum
    }

    /// The largest share of a way at a patch that sees this.
    pub(super) fn by_way(&self, sight: &Sight, way: &Way) -> f64 {
        way.sent.iter().map(|sent| self.gathered(sight, sent)).sum()
    }

    /// The ways of the first orders, and how many orders they are.
    pub(super) fn ways(&self, scene: &Scene, materials: &[OnGrid], most: u32) -> (Vec<Way>, u32) {
        let direct = |light: usize| self.lit.iter().map(|list| list[light]).collect();
        let none = |light: usize| Way { light, order: 0, materials: Vec::new(), most: direct(light), sent: Vec::new() };
        let mut last: Vec<Way> = (0..scene.sources.len()).map(none).collect();
        let (mut all, mut orders) = (Vec::new(), 0);
        let has_grey = materials.iter().any(|one| grey(one).is_some());
        let coloured: Vec<usize> = (0..materials.len()).filter(|one| grey(&materials[*one]).is_none()).collect();
        while orders < most && last.len() * (coloured.len() + usize::from(has_grey)) <= MOST_WAYS {
            let mut next: Vec<Way> = Vec::new();
            let mut send = |way: &Way, last: Option<usize>| {
                let sent = self.sent(way, |patch| {
                    let material = scene.bodies[self.patches[patch].body].material;
                    match last {
                        None => grey(&materials[material]).unwrap_or(0.0),
                        Some(one) => f64::from(u8::from(one == material)),
                    }
                });
                let over = last.into_iter().chain(way.materials.iter().copied()).collect();
                add(&mut next, way.light, orders + 1, over, sent);
            };
            for way in &last {
                send(way, None);
                coloured.iter().for_each(|material| send(way, Some(*material)));
            }
            for way in &mut next {
                way.most = self.for_each_patch(|patch| self.by_way(&self.sights(scene)[patch], way));
            }
            next.retain(|way| way.most.iter().any(|most| *most > 0.0));
            all.append(&mut last);
            last = next;
            orders += 1;
        }
        all.append(&mut last);
        all.retain(|way| way.order > 0);
        (all, orders)
    }

    /// What the patches send on of a way, the brightest first.
    fn sent(&self, way: &Way, part: impl Fn(usize) -> f64) -> Vec<(usize, f64)> {
        let mut sent: Vec<(usize, f64)> =
            way.most.iter().enumerate().map(|(patch, most)| (patch, most * part(patch))).collect();
        sent.retain(|(_, value)| *value > 0.0);
        sent.sort_by(|a, b| b.1.total_cmp(&a.1));
        sent
    }

    /// The orders of a scene that asks for so many; `None` where they do not fall.
    pub(super) fn orders(
        &self,
        scene: &Scene,
        materials: &[OnGrid],
        lights: &[Vec<f64>],
        bounces: Bounces,
        most: usize,
    ) -> Option<Orders> {
        let count = lights.first().map_or(0, Vec::len);
        let direct = |lit: &Vec<f64>| -> Vec<f64> {
            (0..count).map(|j| lit.iter().zip(lights).map(|(lit, light)| lit * light[j].abs()).sum()).collect()
        };
        let mut last: Vec<Vec<f64>> = self.lit.iter().map(direct).collect();
        let mut each: Vec<Vec<Vec<f64>>> = Vec::new();
        let most = most.min((MOST_KEPT / (1 + self.patches.len() * count)).max(1));
        let asked = match bounces {
            Bounces::All => usize::MAX,
            Bounces::Most(most) => most as usize,
        };
        let is_used = |number: &usize| scene.bodies.iter().any(|body| body.material == *number);
        let used: Vec<&OnGrid> = (0..materials.len()).filter(is_used).map(|number| &materials[number]).collect();
        if most == 0 {
            // The brightest anywhere, for all patches alike.
            let order = brightest(&used, &brightest_of(&last));
            let each = vec![vec![order; last.len()]];
            let rest = if asked > 1 { Some(rest_anywhere(&used, &each[0])?) } else { None };
            return Some(Orders { each, rest });
        }
        let of: Vec<&OnGrid> = scene.bodies.iter().map(|body| &materials[body.material]).collect();
        while each.len() < most.min(asked) {
            last = self.next(self.sights(scene), &of, &last);
            each.push(last.clone());
            if let Some(rest) = rest(&each).filter(|rest| largest(rest) <= SMALL * largest(&each[0])) {
                return Some(Orders { each, rest: Some(rest) });
            }
        }
        if each.len() >= asked {
            return Some(Orders { each, rest: None });
        }
        // The sizes of single patches grow with what is not known of them; that of all has the energy as its limit.
        let rest = match (rest(&each), rest_anywhere(&used, &last)) {
            (Some(mut rest), Some(anywhere)) => {
                rest.iter_mut().flatten().zip(anywhere.iter().flatten()).for_each(|(a, b)| *a = a.min(*b));
                rest
            }
            (one, other) => one.or(other)?,
        };
        Some(Orders { each, rest: Some(rest) })
    }

    fn next(&self, sights: &[Sight], materials: &[&OnGrid], incident: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let sent: Vec<Vec<f64>> =
            self.for_each_patch(|patch| radiated(materials[self.patches[patch].body], &incident[patch]));
        let at = |j: usize| {
            let mut sent: Vec<(usize, f64)> = sent.iter().map(|list| list[j]).enumerate().collect();
            sent.retain(|(_, value)| *value > 0.0);
            sent.sort_by(|a, b| b.1.total_cmp(&a.1));
            sent
        };
        let at_each: Vec<Vec<(usize, f64)>> = (0..incident.first().map_or(0, Vec::len)).map(at).collect();
        self.for_each_patch(|patch| at_each.iter().map(|sent| self.gathered(&sights[patch], sent)).collect())
    }
}

/// Largest irradiances of a patch by each light.
fn lit(scene: &Scene, patch: &Patch) -> Vec<f64> {
    let one = |source| if patch.is_dark(scene, source) { 0.0 } else { patch.lit(source) };
    scene.sources.iter().map(one).collect()
}

/// Adds what is sent to the way over these materials.
fn add(ways: &mut Vec<Way>, light: usize, order: u32, materials: Vec<usize>, sent: Vec<(usize, f64)>) {
    if sent.is_empty() {
        return;
    }
    match ways.iter_mut().find(|way| way.light == light && way.materials == materials) {
        Some(way) => way.sent.push(sent),
        None => ways.push(Way { light, order, materials, most: Vec::new(), sent: vec![sent] }),
    }
}

fn largest(order: &[Vec<f64>]) -> f64 {
    order.iter().flatten().copied().fold(0.0, f64::max)
}

/// By what one order lies below another at least; infinite where it does not.
fn ratio<'a>(new: impl Iterator<Item = &'a f64>, old: impl Iterator<Item = &'a f64>) -> f64 {
    let falls = new.zip(old).map(|(new, old)| match (*new, *old) {
        (0.0, _) => 0.0,
        (_, 0.0) => f64::INFINITY,
        (new, old) => new / old,
    });
    falls.fold(0.0, f64::max)
}

/// What follows on the last of these orders. Over two orders, for between two bodies the light goes to and fro: where every value has
/// fallen by r in two, what follows on the last two is at most r / (1 - r) of both.
fn rest(each: &[Vec<Vec<f64>>]) -> Option<Vec<Vec<f64>>> {
    let [.., before, middle, last] = each else { return None };
    let falls = ratio(last.iter().flatten(), before.iter().flatten());
    (falls < FALLS).then(|| {
        let factor = falls / (1.0 - falls);
        let sum = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| factor * (a + b)).collect();
        middle.iter().zip(last).map(sum).collect()
    })
}

/// The same by the brightest patch of each order alone, which no material makes brighter: for scenes where some part of the light
/// goes on for long at a place and dies soon at another.
fn rest_anywhere(materials: &[&OnGrid], last: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let mut order = brightest_of(last);
    let mut sum = vec![0.0; order.len()];
    for _ in 0..MOST_ORDERS {
        let next = brightest(materials, &order);
        let falls = ratio(next.iter(), order.iter());
        order = next;
        sum.iter_mut().zip(&order).for_each(|(sum, value)| *sum += value);
        if falls < FALLS {
            sum.iter_mut().zip(&order).for_each(|(sum, value)| *sum += falls / (1.0 - falls) * value);
            return Some(vec![sum; last.len()]);
        }
    }
    None
}

/// The largest that any of these materials radiates at each wavelength.
fn brightest(materials: &[&OnGrid], incident: &[f64]) -> Vec<f64> {
    let all: Vec<Vec<f64>> = materials.iter().map(|material| radiated(material, incident)).collect();
    brightest_of(&all)
}

/// The largest of these lists at each wavelength.
pub(super) fn brightest_of(lists: &[Vec<f64>]) -> Vec<f64> {
    let count = lists.first().map_or(0, Vec::len);
    (0..count).map(|j| lists.iter().map(|list| list[j]).fold(0.0, f64::max)).collect()
}

impl Orders {
    /// The sum of all that has gone from body to body more than `after` times and at most `most` times, and not more often than the
    /// scene asks for.
    pub(super) fn between(&self, after: u32, most: Bounces, bounces: Bounces) -> Vec<Vec<f64>> {
        let number = |bounces: Bounces| match bounces {
            Bounces::All => usize::MAX,
            Bounces::Most(most) => most as usize,
        };
        let (after, most, stored) = (after as usize, number(most).min(number(bounces)), self.each.len());
        let mut sum: Vec<Vec<f64>> =
            self.each.first().into_iter().flatten().map(|list| vec![0.0; list.len()]).collect();
        let mut add = |order: &[Vec<f64>]| {
            for (sum, order) in sum.iter_mut().flatten().zip(order.iter().flatten()) {
                *sum += order;
            }
        };
        for order in self.each.iter().take(most.min(stored)).skip(after) {
            add(order);
        }
        if let Some(rest) = self.rest.as_ref().filter(|_| most > stored.max(after)) {
            add(rest);
        }
        sum
    }
}
