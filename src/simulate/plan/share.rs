//! How much of the hemisphere of a patch another, or a body, takes up at most: weighed by cosines, as an irradiance is.

use std::f64::consts::{FRAC_1_PI, PI};

use super::super::shape::{Plane, Shape};
use super::super::vector::{dot, length, minus, scaled};
use super::cone::{Cone, angle};
use super::patch::{Extent, Patch};

/// What roundings may take from a share.
const ROUNDING: f64 = 1.0 + 1e-9;

/// What is said of a body as others see it.
pub(super) enum Whole {
    /// It is held by a ball.
    Ball([f64; 3], f64),
    /// It is held by a ball, and its normals are these two.
    Flat([f64; 3], f64, [f64; 3]),
    Plane(Plane),
}

impl Whole {
    pub(super) fn of(shape: &Shape) -> Self {
        let (centre, radius) = shape.around().unwrap_or(([0.0; 3], f64::INFINITY));
        match shape {
            Shape::Plane(plane) if plane.rectangle.is_none() => Self::Plane(*plane),
            Shape::Plane(plane) => Self::Flat(centre, radius, plane.normal),
            _ => Self::Ball(centre, radius),
        }
    }

    /// The largest share of the hemisphere of any place of a patch that it takes up.
    pub(super) fn most_seen(&self, from: &Patch) -> f64 {
        let Extent::Within(near) = from.extent else { return 1.0 };
        // A flat one lies in the part of the hemisphere that its plane cuts off.
        let tilt = |normal: [f64; 3], point: [f64; 3]| {
            let height = dot(minus(from.centre, point), normal);
            if height.abs() <= from.reach(normal) {
                return 1.0;
            }
            let down = scaled(normal, -height.signum());
            ROUNDING * f64::midpoint(1.0, from.normals.most_cosine_of_any(&Cone::of(down)))
        };
        match self {
            Self::Plane(plane) => tilt(plane.normal, plane.point),
            Self::Flat(centre, radius, normal) => ball_seen(from, near, *centre, *radius).min(tilt(*normal, *centre)),
            Self::Ball(centre, radius) => ball_seen(from, near, *centre, *radius),
        }
        .min(1.0)
    }
}

/// The largest share that a ball takes up as seen from a patch.
fn ball_seen(from: &Patch, near: f64, centre: [f64; 3], radius: f64) -> f64 {
    let way = minus(centre, from.centre);
    let far = length(way);
    if far - near <= radius {
        return 1.0;
    }
    let off = angle(from.normals.axis, scaled(way, 1.0 / far));
    let least = off - from.normals.half - (near / far).min(1.0).asin() - 1e-9;
    of_ball(radius / (far - near), least.clamp(0.0, PI))
}

/// The largest share of the hemisphere, weighed by cosines, of any place of one patch that another takes up.
pub(super) fn share(from: &Patch, of: &Patch) -> f64 {
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
            ball_seen(from, near, of.centre, radius).min(by_area * ROUNDING).min(tilt)
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
            of_ball(radius / far, (top / (far - radius)).min(1.0).acos())
        }
        (Extent::Beyond(_), Extent::Beyond(_)) => 1.0,
    }
}

/// The share of a ball of this radius over its distance, the middle of which stands at this angle from the normal (Snyder 1969). It
/// grows with the ball, and falls with the angle.
fn of_ball(sine: f64, theta: f64) -> f64 {
    let square = sine * sine;
    let (sin, cos) = theta.sin_cos();
    if cos >= sine {
        return (ROUNDING * square * cos).min(1.0);
    }
    if cos <= -sine {
        return 0.0;
    }
    // Part of it is below the horizon.
    let cotangent = (1.0 - square).max(0.0).sqrt();
    let y = (-cotangent / sine * cos / sin).clamp(-1.0, 1.0);
    let across = sin * (1.0 - y * y).sqrt();
    let above = square * (cos * y.acos() - cotangent / sine * across) + (across * sine / cotangent).atan();
    (ROUNDING * FRAC_1_PI * above + 1e-12).clamp(0.0, 1.0)
}
