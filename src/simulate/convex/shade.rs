//! The inner loop: a few pixels of a row at once, in arithmetic that the compiler turns into vector instructions.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use super::lighting::Rays;
use super::lobe::Lobe;
use super::scene::{Colours, Scene};
use super::sphere::Sphere;
use crate::simulate::vector::{dot, minus};
use crate::terms::Denominator;

/// Pixels at once.
pub(super) const LANES: usize = 8;
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
    /// Square of the cosine of phi beyond which the lobe is not seen; 2 where it is never seen, 0 where it may be everywhere.
    cut2: f64,
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
        self.frame.fill(self.row, self.out);
    }
}

impl<R: Rays> Frame<R> {
    pub(super) fn new(scene: &Scene, rays: R, lobe: Lobe, colours: &Colours) -> Self {
        let (base, denominator) = (colours.base(), scene.specular.denominator);
        let shine = colours.specular.map(|value| scene.specular.intensity * value);
        // F and G are 1 at most, and the cosines STEEPEST at least; the strength of the light is that of the diffuse terms, too.
        let divided = if denominator == Denominator::CosICosV { STEEPEST * STEEPEST } else { STEEPEST };
        let bound = |c: usize| {
            let seen = if base[c] == 0.0 { NOTHING } else { QUARTER_UNIT * STEEPEST * base[c].abs() };
            // Without a colour no bound: nothing is seen of it.
            seen * divided / shine[c].abs()
        };
        let bound = bound(0).min(bound(1)).min(bound(2));
        let has_lobe = shine != [0.0; 3];
        let cut = if !has_lobe { 2.0 } else { lobe.cosine_where_below(bound).max(0.0) };
        Self { sphere: scene.sphere, rays, base, shine, lobe, denominator, has_lobe, cut2: cut * cut }
    }

    /// Writes a row, all of it: the film may hold another image.
    #[inline(always)]
    fn fill(&self, row: usize, out: &mut [f32]) {
        let width = out.len() / 3;
        let (red, rest) = out.split_at_mut(width);
        let (green, blue) = rest.split_at_mut(width);
        let columns = self.sphere.columns(row, width);
        for plane in [&mut *red, &mut *green, &mut *blue] {
            plane[..columns.start].fill(0.0);
            plane[columns.end..].fill(0.0);
        }
        let mut first = columns.start;
        while first + LANES <= columns.end {
            let [r, g, b] = self.pixels(row, first);
            red[first..first + LANES].copy_from_slice(&r);
            green[first..first + LANES].copy_from_slice(&g);
            blue[first..first + LANES].copy_from_slice(&b);
            first += LANES;
        }
        if first < columns.end {
            let last = self.pixels(row, first);
            let left = columns.end - first;
            for (plane, values) in [red, green, blue].into_iter().zip(&last) {
                plane[first..columns.end].copy_from_slice(&values[..left]);
            }
        }
    }

    /// Pixels from a column on. Those beside the sphere are black.
    #[inline(always)]
    fn pixels(&self, row: usize, first: usize) -> [[f32; LANES]; 3] {
        let (up, from) = (self.sphere.up(row), self.sphere.right(first));
        let (cos_i, lit, is_shining) = self.cosines(up, from);
        let mut out = [[0.0; LANES]; 3];
        if !is_shining {
            for c in 0..3 {
                for lane in 0..LANES {
                    out[c][lane] = (lit[lane] * self.base[c]) as f32;
                }
            }
            return out;
        }
        let shine = self.lobe(up, from, &cos_i);
        for c in 0..3 {
            for lane in 0..LANES {
                out[c][lane] = (lit[lane] * self.base[c] + shine[lane] * self.shine[c]) as f32;
            }
        }
        out
    }

    /// What the diffuse terms and the specular term without its intensity are multiplied by, from a column on.
    #[inline(always)]
    pub(super) fn shares(&self, row: usize, first: usize) -> [Lanes; 2] {
        let (up, from) = (self.sphere.up(row), self.sphere.right(first));
        let (cos_i, lit, is_shining) = self.cosines(up, from);
        [lit, if is_shining { self.lobe(up, from, &cos_i) } else { [0.0; LANES] }]
    }

    /// cos(theta_i), -1 where no light falls or no sphere is; that times the strength of the light, 0 there; and whether the lobe
    /// may be seen at one of the pixels.
    #[inline(always)]
    fn cosines(&self, up: f64, from: f64) -> (Lanes, Lanes, bool) {
        let (mut cos_i, mut lit, mut shining) = ([0.0; LANES], [0.0; LANES], 0);
        for lane in 0..LANES {
            let normal = self.sphere.normal(from + lane as f64, up);
            let beam = self.rays.beam(normal);
            let (cosine, cos_v) = (dot(normal, beam.towards), normal[2]);
            let is_lit = (cosine >= 0.0) & (cos_v > 0.0);
            cos_i[lane] = if is_lit { cosine } else { -1.0 };
            lit[lane] = if is_lit { cosine * beam.strength } else { 0.0 };
            // N.Q = (N.L + N.V) / |L + V|, compared without the root.
            let sum = cosine + cos_v;
            let is_near = sum * sum >= self.cut2 * self.rays.length2(&beam);
            let is_steep = (cosine < STEEPEST) | (cos_v < STEEPEST);
            shining += u64::from(is_lit & (is_near | is_steep & self.has_lobe));
        }
        (cos_i, lit, shining > 0)
    }

    /// D F G over the denominator; 0 where `cos_i` is below 0.
    #[inline(always)]
    fn lobe(&self, up: f64, from: f64, cos_i: &Lanes) -> Lanes {
        let mut shine = [0.0; LANES];
        for lane in 0..LANES {
            let normal = self.sphere.normal(from + lane as f64, up);
            let beam = self.rays.beam(normal);
            let half = self.rays.half(&beam);
            let (cos_i, cos_v) = (cos_i[lane], normal[2]);
            let cos_phi = (cos_i + cos_v) * half.inverse;
            let apart = minus(normal, half.q);
            let d = self.lobe.value(0.25 * dot(apart, apart), cos_phi);
            let angular = self.angular(cos_i, cos_v, 2.0 * cos_phi / half.cos_q);
            let value = d * half.fresnel * angular * beam.strength;
            shine[lane] = if cos_i >= 0.0 { value } else { 0.0 };
        }
        shine
    }

    /// G over the denominator, in a form that keeps its one-sided limit where light grazes: a division by 0 gives an infinite
    /// number, and the other is taken.
    #[inline(always)]
    fn angular(&self, cos_i: f64, cos_v: f64, twice_ratio: f64) -> f64 {
        let over = |cosine: f64, other: f64| {
            let inverse = 1.0 / cosine;
            inverse.min(twice_ratio * (other * inverse).min(1.0))
        };
        match self.denominator {
            Denominator::CosThetaI => over(cos_i, cos_v),
            Denominator::CosThetaV => over(cos_v, cos_i),
            Denominator::CosICosV => (1.0 / (cos_i * cos_v)).min(twice_ratio / cos_i.max(cos_v)),
        }
    }
}
