//! Bodies, and where a ray meets them.
//!
//! All surfaces are opaque and have the same material on either side. A ray that starts on a body is never thrown back by rounding: a
//! convex body is asked only where the ray goes into it.

mod cuboid;
mod mesh;
mod plane;
mod sphere;
mod tree;

pub use cuboid::Cuboid;
pub use mesh::{Mesh, NoMesh};
pub use plane::{Plane, Rectangle};
pub use sphere::Ball;

pub(super) use tree::{Item, Tree};

use super::vector::{Vector, dot, length, minus, plus};

/// A ray that enters a sphere no deeper than the root of this, over its radius, does not meet it: rounding alone would say so at a pixel
/// that looks exactly along its edge.
pub(in crate::simulate) const GRAZING: f64 = 1e-14;

/// A half line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub(super) from: Vector,
    /// Of length 1.
    pub(super) towards: Vector,
    /// Where it starts on a surface.
    pub(super) start: Option<Start>,
}

/// A place on a surface that a ray leaves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    pub(super) body: usize,
    /// The part of the body: a triangle of a mesh, a face.
    pub(super) part: usize,
    /// The normal out of the body there.
    pub(super) outward: Vector,
}

/// Where a ray meets a shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub(super) distance: f64,
    /// Where: it may have digits that the distance from afar has not.
    pub(super) place: Vector,
    /// Normal out of the body.
    pub(super) outward: Vector,
    pub(super) part: usize,
}

/// The form of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere(Ball),
    /// A plane without end, or a rectangle of it.
    Plane(Plane),
    /// A box, turned in any way.
    Box(Cuboid),
    /// Triangles.
    Mesh(Mesh),
}

impl Shape {
    /// The first meeting nearer than `limit`; `own` says where the ray leaves this body.
    #[inline]
    pub(super) fn meet(&self, ray: &Ray, own: Option<&Start>, limit: f64) -> Option<Meeting> {
        match self {
            Self::Sphere(ball) => ball.meet(ray, own, limit),
            Self::Plane(plane) => {
                if own.is_some() {
                    None
                } else {
                    plane.meet(ray, limit)
                }
            }
            Self::Box(cuboid) => cuboid.meet(ray, own, limit),
            Self::Mesh(mesh) => mesh.meet(ray, own, limit),
        }
    }

    /// A sphere around it, (centre, radius); `None` where it has no end.
    #[must_use]
    pub fn around(&self) -> Option<(Vector, f64)> {
        match self {
            Self::Sphere(ball) => Some((ball.centre, ball.radius)),
            Self::Plane(plane) => plane.around(),
            Self::Box(cuboid) => Some((cuboid.centre, length(cuboid.half))),
            Self::Mesh(mesh) => Some(mesh.around()),
        }
    }

    /// Its least and its greatest coordinates; `None` where it has no end.
    pub(super) fn ends(&self) -> Option<(Vector, Vector)> {
        let about = |centre: Vector, reach: Vector| (minus(centre, reach), plus(centre, reach));
        let reach = |axes: &[Vector], half: &[f64]| {
            [0, 1, 2].map(|k| axes.iter().zip(half).map(|(axis, half)| (axis[k] * half).abs()).sum())
        };
        match self {
            Self::Sphere(ball) => Some(about(ball.centre, [ball.radius; 3])),
            Self::Plane(plane) => plane.rectangle.map(|ends| about(plane.point, reach(&ends.axes, &ends.half))),
            Self::Box(cuboid) => Some(about(cuboid.centre, reach(&cuboid.axes, &cuboid.half))),
            Self::Mesh(mesh) => Some(mesh.ends()),
        }
    }

    /// True where no part of it can be seen from another part, from outside.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        match self {
            Self::Sphere(_) | Self::Plane(_) | Self::Box(_) => true,
            Self::Mesh(mesh) => mesh.is_convex(),
        }
    }

    /// True where a place lies inside: what is there sees it from within.
    #[must_use]
    pub fn holds(&self, place: Vector) -> bool {
        match self {
            Self::Sphere(ball) => length(minus(place, ball.centre)) <= ball.radius,
            Self::Plane(_) => false,
            Self::Box(cuboid) => cuboid.holds(place),
            // Of a mesh nobody knows what is inside: what is within the sphere around it may be.
            Self::Mesh(mesh) => {
                let (centre, radius) = mesh.around();
                length(minus(place, centre)) <= radius
            }
        }
    }

    /// Least and greatest height of it above a plane through `place` with this normal.
    pub(super) fn heights(&self, place: Vector, normal: Vector) -> (f64, f64) {
        match self {
            Self::Plane(plane) if plane.rectangle.is_none() => {
                let is_parallel = dot(plane.normal, normal).abs() == 1.0;
                let height = dot(minus(plane.point, place), normal);
                if is_parallel { (height, height) } else { (f64::NEG_INFINITY, f64::INFINITY) }
            }
            Self::Box(cuboid) => {
                let height = dot(minus(cuboid.centre, place), normal);
                let reach: f64 = (0..3).map(|k| (cuboid.half[k] * dot(cuboid.axes[k], normal)).abs()).sum();
                (height - reach, height + reach)
            }
            other => {
                let (centre, radius) = other.around().unwrap_or(([0.0; 3], f64::INFINITY));
                let height = dot(minus(centre, place), normal);
                (height - radius, height + radius)
            }
        }
    }
}
