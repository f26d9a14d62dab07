//! The inner loop: a few pixels of a row at once, in arithmetic that the compiler turns into vector instructions.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use std::ops::Range;

use super::lighting::{Beam, Rays};
use super::lobe::Lobe;
use super::scene::{Colours, Scene};
use super::sphere::Sphere;
use super::stretch::Stretches;
use crate::simulate::vector::{Vector, dot, minus};
use crate::terms::Denominator;

/// Pixels at once: so many that the compiler sees a loop, and makes vectors of it, and does not write it out.
pub(super) const LANES: usize = 32;
/// Columns from the first: a table, for whole numbers wider than 32 bits become floating ones slowly.
const STEPS: Lanes = {
    let mut steps = [0.0; LANES];
    let mut lane = 0;
    while lane < LANES {
        steps[lane] = lane as f64;
        lane += 1;
    }
    steps
};
pub(super) type Lanes = [f64; LANES];

/// Below this cosine of incidence or viewing the lobe is never left out: what G over the denominator may grow to is bounded
/// above it only.
const STEEPEST: f64 = 1.0 / 256.0;
/// A quarter of a unit in the last place of single precision.
const QUARTER_UNIT: f64 = 1.0 / (1 << 26) as f64;
/// Rounded to 0 in single precision, whose smallest number is 1.4e-45, even next to a point light, where the light is up to 1e18
/// times as strong.
const NOTHING: f64 = 1e-64;

/// All that the pixels of one image have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<R> {
    sphere: Sphere,
    rays: R,
    base: [f64; 3],
    /// The specular colour with the intensity; all 0 where there is no lobe.
    shine: [f64; 3],
    lobe: Lobe,
    denominator: Denominator,
    has_lobe: bool,
    /// Cosine of phi beyond which the lobe is not seen; 2 where it is never seen, 0 where it may be everywhere.
    cut: f64,
}

/// A point of the surface.
struct Point {
    normal: Vector,
    beam: Beam,
    /// cos(theta_i).
    cos_i: f64,
    /// Light falls on it, and it is seen.
    is_lit: bool,
}

impl Point {
    /// cos(theta_i) times the strength of the light.
    #[inline(always)]
    fn lit(&self) -> f64 {
        if self.is_lit { self.cos_i * self.beam.strength } else { 0.0 }
    }
}

/// The three planes of a row.
struct Planes<'a> {
    planes: [&'a mut [f32]; 3],
}

impl Planes<'_> {
    fn part(&mut self, columns: Range<usize>) -> [&mut [f32]; 3] {
        self.planes.each_mut().map(|plane| &mut plane[columns.clone()])
    }

    fn black(&mut self, columns: Range<usize>) {
        self.part(columns).into_iter().for_each(|plane| plane.fill(0.0));
    }
}

/// One row of an image, as what is compiled for several kinds of processor.
pub(super) struct Row<'a, R> {
    pub(super) frame: &'a Frame<R>,
    pub(super) row: usize,
    /// Three planes.
    pub(super) out: &'a mut [f32],
}

impl<R: Rays> pulp::WithSimd for Row<'_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.frame.fill::<S>(self.row, self.out);
    }
}

impl<R: Rays> Frame<R> {
    pub(super) fn new(scene: &Scene, rays: R, lobe: Lobe, colours: &Colours) -> Self {
        let (base, denominator) = (colours.base(), scene.specular.denominator);
        let shine = colours.specular.map(|value| scene.specular.intensity * value);
        let has_lobe = shine != [0.0; 3];
        let (theta_q, fresnel) = rays.most();
        // The lobe is not seen where D is so small, if neither cosine is below `least`. G is 1 at most; the strength of the light is
        // that of the diffuse terms, too.
        let unseen = |least: f64| {
            let divided = if denominator == Denominator::CosICosV { least * least } else { least };
            let bound = |c: usize| {
                let seen = if base[c] == 0.0 { NOTHING } else { QUARTER_UNIT * least * base[c].abs() };
                // Without a colour no bound: nothing is seen of it.
                seen * divided / (fresnel * shine[c].abs())
            };
            lobe.cosine_where_below(bound(0).min(bound(1)).min(bound(2))).max(0.0)
        };
        // Within phi of the half vector both cosines are that of theta_Q + phi at least, by which phi grows smaller.
        let closer = |cut: f64| unseen((theta_q + cut.acos()).cos().max(STEEPEST));
        let cut = if has_lobe { (0..4).fold(unseen(STEEPEST), |cut, _| closer(cut)) } else { 2.0 };
        Self { sphere: scene.sphere, rays, base, shine, lobe, denominator, has_lobe, cut }
    }

    /// Writes a row, all of it: the film may hold another image.
    #[inline(always)]
    fn fill<S: pulp::Simd>(&self, row: usize, out: &mut [f32]) {
        let width = out.len() / 3;
        let (red, rest) = out.split_at_mut(width);
        let (green, blue) = rest.split_at_mut(width);
        let mut planes = Planes { planes: [red, green, blue] };
        let columns = self.sphere.columns(row, width);
        let Stretches { lit, calm, shining } = self.rays.stretches(&self.sphere, row, columns, [self.cut, STEEPEST]);
        let up = self.sphere.up(row);
        planes.black(0..lit.start);
        self.looked_at::<S>(up, lit.start, planes.part(lit.start..calm.start));
        self.calm(up, calm.start, planes.part(calm.start..shining.start));
        self.shining::<S>(up, shining.start, planes.part(shining.clone()));
        self.calm(up, shining.end, planes.part(shining.end..calm.end));
        self.looked_at::<S>(up, calm.end, planes.part(calm.end..lit.end));
        planes.black(lit.end..width);
    }

    /// Pixels that light falls on and where no lobe is seen.
    #[inline(always)]
    fn calm(&self, up: f64, first: usize, [red, green, blue]: [&mut [f32]; 3]) {
        let middle = first as f64 + 0.5;
        for (lane, ((red, green), blue)) in red.iter_mut().zip(green).zip(blue).enumerate() {
            let point = self.point(middle + f64::from(lane as i32), up);
            let lit = point.cos_i * point.beam.strength;
            *red = (lit * self.base[0]) as f32;
            *green = (lit * self.base[1]) as f32;
            *blue = (lit * self.base[2]) as f32;
        }
    }

    /// Pixels that are asked whether light falls on them and whether the lobe is seen.
    #[inline(always)]
    fn looked_at<S: pulp::Simd>(&self, up: f64, first: usize, planes: [&mut [f32]; 3]) {
        let mut middle = first as f64 + 0.5;
        let [mut red, mut green, mut blue] = planes.map(|plane| plane.chunks_exact_mut(LANES));
        for ((red, green), blue) in (&mut red).zip(&mut green).zip(&mut blue) {
            let mut cos_v = [0.0; LANES];
            if self.diffuse(up, middle, [red, green, blue], &mut cos_v) {
                self.lobes::<S>(up, middle, &cos_v, [red, green, blue]);
            }
            middle += LANES as f64;
        }
        let mut rest = [red, green, blue].map(|plane| plane.into_remainder());
        let mut cos_v = [0.0; LANES];
        let [red, green, blue] = &mut rest;
        if self.diffuse(up, middle, [red, green, blue], &mut cos_v) {
            self.few_lobes::<S>(up, middle, &cos_v, rest);
        }
    }

    /// The diffuse terms of `LANES` pixels at most, and the cosines of viewing. True where the lobe may be seen at one of them.
    #[inline(always)]
    fn diffuse(&self, up: f64, middle: f64, [red, green, blue]: [&mut [f32]; 3], cos_v: &mut Lanes) -> bool {
        let mut shining = 0;
        let pixels = red.iter_mut().zip(green).zip(blue).zip(cos_v).zip(&STEPS);
        for ((((red, green), blue), cos_v), step) in pixels {
            let point = self.point(middle + step, up);
            let lit = point.lit();
            *red = (lit * self.base[0]) as f32;
            *green = (lit * self.base[1]) as f32;
            *blue = (lit * self.base[2]) as f32;
            *cos_v = point.normal[2];
            shining += u64::from(self.may_shine(&point));
        }
        self.has_lobe & (shining > 0)
    }

    /// Pixels where the lobe may be seen.
    #[inline(always)]
    fn shining<S: pulp::Simd>(&self, up: f64, first: usize, planes: [&mut [f32]; 3]) {
        let mut middle = first as f64 + 0.5;
        let [mut red, mut green, mut blue] = planes.map(|plane| plane.chunks_exact_mut(LANES));
        for ((red, green), blue) in (&mut red).zip(&mut green).zip(&mut blue) {
            self.lobes::<S>(up, middle, &self.cosines(up, middle), [red, green, blue]);
            middle += LANES as f64;
        }
        let rest = [red, green, blue].map(|plane| plane.into_remainder());
        if !rest[0].is_empty() {
            self.few_lobes::<S>(up, middle, &self.cosines(up, middle), rest);
        }
    }

    /// Fewer than `LANES` pixels with all terms.
    #[inline(always)]
    fn few_lobes<S: pulp::Simd>(&self, up: f64, middle: f64, cos_v: &Lanes, planes: [&mut [f32]; 3]) {
        let mut all = [[0.0; LANES]; 3];
        let [red, green, blue] = &mut all;
        self.lobes::<S>(up, middle, cos_v, [red, green, blue]);
        for (plane, all) in planes.into_iter().zip(&all) {
            plane.copy_from_slice(&all[..plane.len()]);
        }
    }

    /// `LANES` pixels with all terms. Those beside the sphere are black.
    #[inline(always)]
    fn lobes<S: pulp::Simd>(&self, up: f64, middle: f64, cos_v: &Lanes, planes: [&mut [f32]; 3]) {
        let [lit, shine] = self.lobe::<S>(up, middle, cos_v);
        for (c, plane) in planes.into_iter().enumerate() {
            for (lane, value) in plane.iter_mut().enumerate().take(LANES) {
                *value = (lit[lane] * self.base[c] + shine[lane] * self.shine[c]) as f32;
            }
        }
    }

    /// What the diffuse terms and the specular term without its intensity are multiplied by, from a column on.
    #[inline(always)]
    pub(super) fn shares<S: pulp::Simd>(&self, row: usize, first: usize) -> [Lanes; 2] {
        let (up, middle) = (self.sphere.up(row), first as f64 + 0.5);
        self.lobe::<S>(up, middle, &self.cosines(up, middle))
    }

    /// The cosines of viewing.
    #[inline(always)]
    fn cosines(&self, up: f64, middle: f64) -> Lanes {
        let mut cos_v = [0.0; LANES];
        for lane in 0..LANES {
            cos_v[lane] = self.point(middle + STEPS[lane], up).normal[2];
        }
        cos_v
    }

    /// The surface at the middle of a pixel, by its place on the film.
    #[inline(always)]
    fn point(&self, middle: f64, up: f64) -> Point {
        self.seen(self.sphere.normal(self.sphere.right(middle), up))
    }

    #[inline(always)]
    fn seen(&self, normal: Vector) -> Point {
        let beam = self.rays.beam(normal);
        let cos_i = dot(normal, beam.towards);
        Point { normal, beam, cos_i, is_lit: (cos_i >= 0.0) & (normal[2] > 0.0) }
    }

    /// Whether the lobe may be seen at a point, in a scene that has one.
    #[inline(always)]
    fn may_shine(&self, point: &Point) -> bool {
        // N.Q = (N.L + N.V) / |L + V|, compared without the root.
        let (cos_i, cos_v) = (point.cos_i, point.normal[2]);
        let sum = cos_i + cos_v;
        let is_near = sum * sum >= self.cut * self.cut * self.rays.length2(&point.beam);
        point.is_lit & (is_near | (cos_i < STEEPEST) | (cos_v < STEEPEST))
    }

    /// cos(theta_i) and D F G over the denominator, both times the strength of the light; 0 where no light falls or no sphere is.
    /// In passes without a choice inside, which would keep the compiler from making vectors of them.
    #[inline(always)]
    fn lobe<S: pulp::Simd>(&self, up: f64, middle: f64, cos_v: &Lanes) -> [Lanes; 2] {
        let (mut s, mut cos_phi, mut cos_i) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut twice_ratio, mut factor, mut lit) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let normal = self.sphere.normal_with(self.sphere.right(middle + STEPS[lane]), up, cos_v[lane]);
            let point = self.seen(normal);
            let half = self.rays.half(&point.beam);
            let apart = minus(normal, half.q);
            s[lane] = 0.25 * dot(apart, apart);
            lit[lane] = point.lit();
            cos_i[lane] = if point.is_lit { point.cos_i } else { -1.0 };
            cos_phi[lane] = (cos_i[lane] + cos_v[lane]) * half.inverse;
            // cos_q is half of |L + V|.
            twice_ratio[lane] = 4.0 * cos_phi[lane] * half.inverse;
            factor[lane] = half.fresnel * point.beam.strength;
        }
        let angular = self.angular(&cos_i, cos_v, &twice_ratio);
        let d = self.lobe.values::<S, LANES>(&s, &cos_phi);
        let mut shine = [0.0; LANES];
        for lane in 0..LANES {
            let value = d[lane] * factor[lane] * angular[lane];
            shine[lane] = if cos_i[lane] >= 0.0 { value } else { 0.0 };
        }
        [lit, shine]
    }

    /// G over the denominator, in a form that keeps its one-sided limit where light grazes: a division by 0 gives an infinite
    /// number, and the other is taken.
    #[inline(always)]
    fn angular(&self, cos_i: &Lanes, cos_v: &Lanes, twice_ratio: &Lanes) -> Lanes {
        match self.denominator {
            Denominator::CosThetaI => over_one(cos_i, cos_v, twice_ratio),
            Denominator::CosThetaV => over_one(cos_v, cos_i, twice_ratio),
            Denominator::CosICosV => {
                let mut over = [0.0; LANES];
                for lane in 0..LANES {
                    let (cos_i, cos_v) = (cos_i[lane], cos_v[lane]);
                    over[lane] = (1.0 / (cos_i * cos_v)).min(twice_ratio[lane] / cos_i.max(cos_v));
                }
                over
            }
        }
    }
}

/// G over one cosine.
#[inline(always)]
fn over_one(cosine: &Lanes, other: &Lanes, twice_ratio: &Lanes) -> Lanes {
    let mut over = [0.0; LANES];
    for lane in 0..LANES {
        let inverse = 1.0 / cosine[lane];
        over[lane] = inverse.min(twice_ratio[lane] * (other[lane] * inverse).min(1.0));
    }
    over
}
