//! Lights without extent: parallel rays, and a point.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use super::sphere::Sphere;
use super::stretch::Stretches;
use crate::quantity::HalfAngles;
use crate::simulate::vector::{Vector, dot, length, minus, scaled};
use crate::terms::fresnel;

/// What rounding may add to an angle, radians, and to F.
const ROUNDING: f64 = 1e-7;

/// Where the light comes from. x points to the right, y up, z to the camera; the sphere has radius 1 and its centre at 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lighting {
    /// Parallel rays from this direction (of any length).
    Directional([f64; 3]),
    /// A point at this place, outside the sphere. Its irradiance across the beam is that of the scene's colours at a distance
    /// of one radius, and falls with the square of the distance.
    Point([f64; 3]),
}

/// What reaches a point of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beam {
    /// Unit vector to the source.
    pub(super) towards: Vector,
    /// Irradiance across the beam over that of the scene's colours.
    pub(super) strength: f64,
}

/// The half vector of a beam and the direction to the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Half {
    /// Q.
    pub(super) q: Vector,
    /// 1/|L + V|, of which L.Q = V.Q is half the inverse.
    pub(super) inverse: f64,
    /// F.
    pub(super) fresnel: f64,
}

/// One kind of light, as what the inner loop is compiled for.
pub(super) trait Rays: Sync + Copy {
    /// What is known of a row before its pixels are looked at; `cuts` as in [`Stretches::of`].
    fn stretches(&self, sphere: &Sphere, row: usize, columns: Range<usize>, cuts: [f64; 2]) -> Stretches;
    /// The largest theta_Q, radians, and the largest F.
    fn most(&self) -> (f64, f64);
    fn beam(&self, normal: Vector) -> Beam;
    /// |L + V|^2.
    fn length2(&self, beam: &Beam) -> f64;
    fn half(&self, beam: &Beam) -> Half;
}

/// The same beam everywhere, and seen from afar the same half vector: F, too, is found once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parallel {
    beam: Beam,
    length2: f64,
    half: Half,
}

/// A beam for every point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    place: Vector,
    index_minus_one: f64,
}

/// L + V and its square, V being z.
#[inline(always)]
fn sum(towards: Vector) -> (Vector, f64) {
    let sum = [towards[0], towards[1], towards[2] + 1.0];
    (sum, dot(sum, sum))
}

/// The half vector. The sine is that of half of L - V, which keeps its digits where L and V are nearly one.
#[inline(always)]
fn half(towards: Vector, index_minus_one: f64) -> Half {
    let (sum, length2) = sum(towards);
    let length = length2.sqrt();
    let inverse = 1.0 / length;
    let apart = minus(towards, [0.0, 0.0, 1.0]);
    let (cos_q, sin2_q) = (0.5 * length, 0.25 * dot(apart, apart));
    Half { q: scaled(sum, inverse), inverse, fresnel: reflectance(cos_q, sin2_q, index_minus_one) }
}

/// F, which needs nothing of the normal.
#[inline(always)]
fn reflectance(cos_q: f64, sin2_q: f64, index_minus_one: f64) -> f64 {
    fresnel(&HalfAngles { phi: 0.0, sin_phi: 0.0, cos_phi: 1.0, cos_q, sin2_q }, index_minus_one).value
}

impl Parallel {
    /// `direction` of length above 0.
    pub(super) fn new(direction: Vector, index_minus_one: f64) -> Self {
        let towards = scaled(direction, 1.0 / length(direction));
        let beam = Beam { towards, strength: 1.0 };
        Self { beam, length2: sum(towards).1, half: half(towards, index_minus_one) }
    }
}

impl Point {
    pub(super) fn new(place: Vector, index_minus_one: f64) -> Self {
        Self { place, index_minus_one }
    }
}

impl Rays for Parallel {
    fn stretches(&self, sphere: &Sphere, row: usize, columns: Range<usize>, cuts: [f64; 2]) -> Stretches {
        Stretches::of(sphere, row, columns, [self.beam.towards, self.half.q], cuts)
    }

    fn most(&self) -> (f64, f64) {
        (ROUNDING + (0.5 * self.length2.sqrt()).min(1.0).acos(), self.half.fresnel * (1.0 + ROUNDING))
    }

    #[inline(always)]
    fn beam(&self, _: Vector) -> Beam {
        // A number that the compiler knows: it leaves out the products.
        Beam { strength: 1.0, ..self.beam }
    }

    #[inline(always)]
    fn length2(&self, _: &Beam) -> f64 {
        self.length2
    }

    #[inline(always)]
    fn half(&self, _: &Beam) -> Half {
        self.half
    }
}

impl Rays for Point {
    fn stretches(&self, _: &Sphere, _: usize, columns: Range<usize>, _: [f64; 2]) -> Stretches {
        Stretches::unknown(columns)
    }

    fn most(&self) -> (f64, f64) {
        // Seen from the sphere the light stands within a cone about the direction of its place.
        let away = length(self.place);
        let apart = (self.place[2] / away).clamp(-1.0, 1.0).acos() + (1.0 / away).min(1.0).asin();
        let theta_q = (ROUNDING + 0.5 * apart).min(FRAC_PI_2);
        // F grows with the angle where n is below 2 + sqrt(3); beyond it falls first.
        let grows = self.index_minus_one < 2.7;
        let fresnel = reflectance(theta_q.cos(), theta_q.sin().powi(2), self.index_minus_one);
        (theta_q, if grows { fresnel * (1.0 + ROUNDING) } else { 1.0 })
    }

    #[inline(always)]
    fn beam(&self, normal: Vector) -> Beam {
        let way = minus(self.place, normal);
        let inverse = 1.0 / dot(way, way).sqrt();
        Beam { towards: scaled(way, inverse), strength: inverse * inverse }
    }

    #[inline(always)]
    fn length2(&self, beam: &Beam) -> f64 {
        sum(beam.towards).1
    }

    #[inline(always)]
    fn half(&self, beam: &Beam) -> Half {
        half(beam.towards, self.index_minus_one)
    }
}
