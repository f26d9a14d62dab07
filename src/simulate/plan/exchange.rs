//! A bound on the light that comes by way of other bodies.
//!
//! Each patch sees another in a share of its hemisphere that is bounded by the cones of their normals, the distance and the area, and
//! all together in the whole of it at most. So the largest radiances of one order bound the irradiances of the next, wavelength by
//! wavelength. The bound of an order is monotone and homogeneous in that of the one before: once all of it falls by a factor r in two
//! orders, what follows is at most r / (1 - r) of them.

use std::f64::consts::FRAC_1_PI;

use super::super::material::OnGrid;
use super::super::scene::{Bounces, Scene};
use super::super::vector::{dot, length, minus, scaled};
use super::cone::Cone;
use super::patch::{Extent, Patch, cut};

/// Orders after which no bound was found.
const MOST_ORDERS: usize = 3000;
/// Orders that are kept before the rest is bounded: at most, and numbers of all of them.
const ORDERS: usize = 64;
const MOST_KEPT: usize = 6_000_000;
/// What falls by less than this in every order is not bounded.
const FALLS: f64 = 0.999;
/// The rest over the first order that is not looked at any closer.
const SMALL: f64 = 1e-2;
/// Orders whose colours are told apart, and ways at most.
const WAYS_OF_ORDERS: u32 = 4;
const MOST_WAYS: usize = 32;
/// What roundings may take from a share.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Patches of a scene as light goes between them.
pub(super) struct Exchange {
    pub(super) patches: Vec<Patch>,
    /// Whether the camera may see each.
    pub(super) is_seen: Vec<bool>,
    /// Of each patch those that it sees, and the share of its hemisphere that each may take up.
    shares: Vec<Vec<(usize, f64)>>,
    /// \[patch\]\[light\]: largest irradiance over that of its spectrum.
    lit: Vec<Vec<f64>>,
}

/// Light that comes from a light over bodies of these materials, the last first.
#[derive(Clone)]
pub(super) struct Way {
    pub(super) materials: Vec<usize>,
    pub(super) light: usize,
    /// Its largest share at each patch.
    pub(super) most: Vec<f64>,
}

/// Largest irradiances of the patches by light that has gone from body to body, once, twice and so on.
pub(super) struct Orders {
    each: Vec<Vec<Vec<f64>>>,
    /// All that follows on them; `None` where nothing was looked for.
    rest: Option<Vec<Vec<f64>>>,
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

/// The largest share of the hemisphere, weighed by cosines, of any place of one patch that another takes up.
fn share(from: &Patch, of: &Patch) -> f64 {
    if from.body == of.body && from.is_convex && of.is_convex {
        return 0.0;
    }
    match (from.extent, of.extent) {
        (Extent::Within(near), Extent::Within(radius)) => {
            let way = minus(of.centre, from.centre);
            // Of what lies below a plane nothing is seen from it.
            let is_below = |one: &Patch, other: &Patch, way: [f64; 3]| {
                one.normals.half == 0.0 && dot(way, one.normals.axis) + other.reach(one.normals.axis) <= 0.0
            };
            if is_below(from, of, way) || is_below(of, from, scaled(way, -1.0)) {
                return 0.0;
            }
            let towards = Cone::between(from.centre, of.centre, near + radius);
            let cosines = [from.normals.most_cosine(&towards), of.normals.most_cosine(&towards.reversed())];
            if cosines.contains(&0.0) {
                return 0.0;
            }
            let nearest = length(way) - near;
            // A flat patch lies in the part of the hemisphere that its plane cuts off.
            let tilt = if of.normals.half == 0.0 {
                ROUNDING * f64::midpoint(1.0, from.normals.most_cosine_of_any(&of.normals.reversed()))
            } else {
                1.0
            };
            if nearest <= radius {
                return tilt.min(1.0);
            }
            let by_area = cosines[0] * cosines[1] * of.area * FRAC_1_PI / (nearest - radius).powi(2);
            of_ball(radius / nearest, cosines[0]).min(by_area * ROUNDING).min(tilt)
        }
        (Extent::Within(_), Extent::Beyond(hole)) => {
            let (height, aside) = of.above_plane(from.centre);
            let Extent::Within(radius) = from.extent else { return 1.0 };
            let (height, far) = (height + from.reach(of.normals.axis), hole - aside - radius);
            if height <= 0.0 {
                return 0.0;
            }
            if far <= 0.0 {
                return 1.0;
            }
            let down = from.normals.most_cosine(&Cone::of(scaled(of.normals.axis, -1.0)));
            let along = if from.normals.half > 0.0 {
                1.0
            } else {
                (1.0 - dot(from.normals.axis, of.normals.axis).powi(2)).max(0.0).sqrt()
            };
            // What looks straight down sees of the plane beyond a circle h^2 / (h^2 + L^2), what looks along it the other part.
            let square = height * height + far * far;
            let beside = FRAC_1_PI * (far * height / square + (height / far).atan());
            (ROUNDING * (down * height * height / square + along * beside)).min(1.0)
        }
        (Extent::Beyond(hole), Extent::Within(radius)) => {
            let (height, aside) = from.above_plane(of.centre);
            let (top, far) = (height + of.reach(from.normals.axis), hole - aside);
            if top <= 0.0 {
                return 0.0;
            }
            if far <= radius {
                return 1.0;
            }
            of_ball(radius / far, (top / (far - radius)).min(1.0))
        }
        (Extent::Beyond(_), Extent::Beyond(_)) => 1.0,
    }
}

/// The share of a ball of this radius over its distance, no part of which stands at a greater cosine.
fn of_ball(sine: f64, cosine: f64) -> f64 {
    let square = sine * sine;
    // 2 (1 - cos), without the difference.
    let solid = 2.0 * square / (1.0 + (1.0 - square).max(0.0).sqrt());
    (ROUNDING * square.min(cosine * solid)).min(1.0)
}

impl Exchange {
    pub(super) fn new(scene: &Scene, most: usize) -> Self {
        let patches = cut(scene, most);
        let sees = |from: &Patch| {
            let all = patches.iter().enumerate().map(|(number, of)| (number, share(from, of)));
            all.filter(|(_, share)| *share > 0.0).collect()
        };
        Self {
            is_seen: patches.iter().map(|patch| patch.may_be_seen(scene)).collect(),
            shares: patches.iter().map(sees).collect(),
            lit: patches.iter().map(|patch| scene.sources.iter().map(|source| patch.lit(source)).collect()).collect(),
            patches,
        }
    }

    /// False where a light stands on a body.
    pub(super) fn is_finite(&self) -> bool {
        self.lit.iter().flatten().all(|value| value.is_finite())
    }

    /// The largest sum that a patch gets of what others send, from those patches that are asked for.
    fn gathered(&self, patch: usize, sent: &[f64], is_of: impl Fn(usize) -> bool) -> f64 {
        let seen = self.shares[patch].iter().filter(|(of, _)| sent[*of] > 0.0 && is_of(self.patches[*of].body));
        let mut seen: Vec<(f64, f64)> = seen.map(|(of, share)| (sent[*of], *share)).collect();
        seen.sort_by(|a, b| b.0.total_cmp(&a.0));
        // The brightest first, until the hemisphere is full.
        let mut left = 1.0_f64;
        seen.into_iter().fold(0.0, |sum, (value, share)| {
            let taken = share.min(left);
            left -= taken;
            sum + taken * value
        })
    }

    /// The ways of the first orders, and how many orders they are.
    pub(super) fn ways(&self, scene: &Scene) -> (Vec<Way>, u32) {
        let materials = scene.materials.len();
        let lit = |light: usize| self.lit.iter().map(|list| list[light]).collect();
        let mut last: Vec<Way> =
            (0..scene.sources.len()).map(|light| Way { materials: Vec::new(), light, most: lit(light) }).collect();
        let (mut all, mut orders) = (Vec::new(), 0);
        while orders < WAYS_OF_ORDERS && last.len() * materials <= MOST_WAYS {
            let further = |way: &Way, material: usize| {
                let is_of = |body: usize| scene.bodies[body].material == material;
                let most = (0..self.patches.len()).map(|patch| self.gathered(patch, &way.most, is_of)).collect();
                Way { materials: [&[material][..], &way.materials].concat(), light: way.light, most }
            };
            last = last.iter().flat_map(|way| (0..materials).map(move |material| further(way, material))).collect();
            last.retain(|way| way.most.iter().any(|most| *most > 0.0));
            all.extend(last.iter().cloned());
            orders += 1;
        }
        (all, orders)
    }

    /// The orders of a scene that asks for so many; `None` where they do not fall.
    pub(super) fn orders(&self, materials: &[&OnGrid], lights: &[Vec<f64>], bounces: Bounces) -> Option<Orders> {
        let count = lights.first().map_or(0, Vec::len);
        let direct = |lit: &Vec<f64>| -> Vec<f64> {
            (0..count).map(|j| lit.iter().zip(lights).map(|(lit, light)| lit * light[j].abs()).sum()).collect()
        };
        let mut last: Vec<Vec<f64>> = self.lit.iter().map(direct).collect();
        let mut each: Vec<Vec<Vec<f64>>> = Vec::new();
        let most = (MOST_KEPT / (1 + self.patches.len() * count)).clamp(4, ORDERS);
        let asked = match bounces {
            Bounces::All => usize::MAX,
            Bounces::Most(most) => most as usize,
        };
        while each.len() < most.min(asked) {
            last = self.next(materials, &last);
            each.push(last.clone());
            if let Some(rest) = rest(&each).filter(|rest| largest(rest) <= SMALL * largest(&each[0])) {
                return Some(Orders { each, rest: Some(rest) });
            }
        }
        if each.len() >= asked {
            return Some(Orders { each, rest: None });
        }
        let rest = rest(&each).or_else(|| rest_anywhere(materials, &last))?;
        Some(Orders { each, rest: Some(rest) })
    }

    fn next(&self, materials: &[&OnGrid], incident: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let sent: Vec<Vec<f64>> =
            self.patches.iter().zip(incident).map(|(patch, e)| radiated(materials[patch.body], e)).collect();
        let rank: Vec<f64> = sent.iter().map(|list| list.iter().sum()).collect();
        let count = incident.first().map_or(0, Vec::len);
        let one = |seen: &Vec<(usize, f64)>| {
            // The largest sum of shares times radiances, with shares that fill one hemisphere, is at most t plus the sum of what is
            // above t, for any t of each wavelength: that of the patch with which the brightest have filled it is nearly the best.
            let mut sum = vec![0.0; count];
            if seen.iter().map(|(_, share)| share).sum::<f64>() > 1.0 {
                let mut order = seen.clone();
                order.sort_by(|a, b| rank[b.0].total_cmp(&rank[a.0]));
                let mut full = 0.0;
                let last = order.into_iter().find(|(_, share)| {
                    full += share;
                    full >= 1.0
                });
                if let Some((last, _)) = last {
                    sum.clone_from(&sent[last]);
                }
            }
            let level = sum.clone();
            for (of, share) in seen {
                for ((sum, value), level) in sum.iter_mut().zip(&sent[*of]).zip(&level) {
                    *sum += share * (value - level).max(0.0);
                }
            }
            sum
        };
        self.shares.iter().map(one).collect()
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
    let count = last.first().map_or(0, Vec::len);
    let mut order: Vec<f64> = (0..count).map(|j| last.iter().map(|list| list[j]).fold(0.0, f64::max)).collect();
    let mut sum = vec![0.0; count];
    for _ in 0..MOST_ORDERS {
        let mut next = vec![0.0; count];
        for material in materials {
            next.iter_mut().zip(radiated(material, &order)).for_each(|(most, value)| *most = f64::max(*most, value));
        }
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

impl Orders {
    /// The sum of all that has gone from body to body more than `kept` times, and not more often than the scene asks for.
    pub(super) fn beyond(&self, kept: u32, bounces: Bounces) -> Vec<Vec<f64>> {
        let (kept, stored) = (kept as usize, self.each.len());
        let most = match bounces {
            Bounces::All => usize::MAX,
            Bounces::Most(most) => most as usize,
        };
        let mut sum: Vec<Vec<f64>> =
            self.each.first().into_iter().flatten().map(|list| vec![0.0; list.len()]).collect();
        let mut add = |order: &[Vec<f64>]| {
            for (sum, order) in sum.iter_mut().flatten().zip(order.iter().flatten()) {
                *sum += order;
            }
        };
        for order in self.each.iter().take(most.min(stored)).skip(kept) {
            add(order);
        }
        if let Some(rest) = self.rest.as_ref().filter(|_| most > stored.max(kept)) {
            add(rest);
        }
        sum
    }
}
