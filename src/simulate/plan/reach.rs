//! How much light may reach a body, and which bodies may stand in each other's light or see each other.

use super::super::camera::Projection;
use super::super::interface::Interface;
use super::super::scene::{Body, Scene};
use super::super::shape::Shape;
use super::super::source::{Place, Source};
use super::super::vector::{Vector, dot, length, minus, plus, scaled, unit};

/// Directions around an axis.
#[derive(Debug, Clone, Copy)]
struct Cone {
    axis: Vector,
    half: f64,
}

/// Least distance of a place from a body; a lower bound of it.
fn distance(shape: &Shape, place: Vector) -> f64 {
    match shape {
        Shape::Sphere(ball) => (length(minus(place, ball.centre)) - ball.radius).abs(),
        Shape::Plane(plane) => dot(minus(place, plane.point), plane.normal).abs(),
        Shape::Box(cuboid) => {
            let from = minus(place, cuboid.centre);
            length([0, 1, 2].map(|k| (dot(from, cuboid.axes[k]).abs() - cuboid.half[k]).max(0.0)))
        }
        Shape::Mesh(_) => {
            shape.around().map_or(0.0, |(centre, radius)| (length(minus(place, centre)) - radius).max(0.0))
        }
    }
}

/// Largest irradiance of a body by a light, over that of its spectrum.
pub(super) fn most_lit(shape: &Shape, source: &Source) -> f64 {
    match source.place {
        Place::Surround => 1.0,
        Place::Point(place, reference) => (reference / distance(shape, place)).powi(2),
        Place::Directional(towards) => match shape {
            Shape::Plane(plane) => dot(plane.normal, towards).abs(),
            Shape::Box(cuboid) => cuboid.axes.iter().map(|axis| dot(*axis, towards).abs()).fold(0.0, f64::max),
            Shape::Mesh(mesh) => mesh.normals().map(|normal| dot(normal, towards).abs()).fold(0.0, f64::max),
            Shape::Sphere(_) => 1.0,
        },
    }
}

/// Largest irradiance across the beam.
fn strength(shape: &Shape, source: &Source) -> f64 {
    match source.place {
        Place::Point(place, reference) => (reference / distance(shape, place)).powi(2),
        Place::Directional(_) | Place::Surround => 1.0,
    }
}

/// Directions from a body to a place.
fn to_place(shape: &Shape, place: Vector) -> Option<Cone> {
    let (centre, radius) = shape.around()?;
    let way = minus(place, centre);
    let far = length(way);
    (far > radius).then(|| Cone { axis: scaled(way, 1.0 / far), half: (radius / far).asin() })
}

/// Largest D F G / den on a body under a light, times the strength of the light; infinite where nothing bounds it.
pub(super) fn most_shining(scene: &Scene, body: &Body, source: &Source, interface: &Interface) -> f64 {
    let shape = &body.shape;
    let light = match source.place {
        Place::Directional(towards) => Some(Cone { axis: towards, half: 0.0 }),
        Place::Point(place, _) => to_place(shape, place),
        Place::Surround => None,
    };
    let view = match scene.camera.projection {
        Projection::Orthographic { .. } => Some(Cone { axis: scaled(scene.camera.axes[2], -1.0), half: 0.0 }),
        Projection::Perspective { .. } => to_place(shape, scene.camera.place),
    };
    let (Some(light), Some(view)) = (light, view) else { return f64::INFINITY };
    let sum = plus(light.axis, view.axis);
    let long = length(sum);
    let spread = light.half + view.half;
    // The half vector of directions that are off by angles a and b is off by at most asin((a + b) / |L + V|).
    let Some(half) = unit(sum).filter(|_| spread < long) else { return f64::INFINITY };
    let off = (spread / long).min(1.0).asin();
    let apart = 2.0 * (0.5 * length(minus(light.axis, view.axis))).min(1.0).asin();
    let least_cos_q = (0.5 * (apart + spread)).min(std::f64::consts::FRAC_PI_2).cos();
    let seen = |normal: Vector| {
        let faces = |cone: &Cone| dot(normal, cone.axis) > -cone.half.sin() || cone.half > 1.5;
        if !(faces(&light) && faces(&view)) {
            return 0.0;
        }
        let phi = 2.0 * (0.5 * length(minus(normal, half))).min(1.0).asin();
        interface.most((phi - off - 1e-9).max(0.0), least_cos_q)
    };
    let both = |normal: Vector| seen(normal).max(seen(scaled(normal, -1.0)));
    let most = match shape {
        Shape::Sphere(_) => interface.most(0.0, least_cos_q),
        Shape::Plane(plane) => both(plane.normal),
        Shape::Box(cuboid) => cuboid.axes.iter().map(|axis| both(*axis)).fold(0.0, f64::max),
        Shape::Mesh(mesh) => mesh.normals().map(both).fold(0.0, f64::max),
    };
    if most == 0.0 { 0.0 } else { most * strength(shape, source) }
}

/// True where all of a body is looked at from outside.
pub(super) fn is_seen_from_outside(scene: &Scene, body: &Body) -> bool {
    let camera = &scene.camera;
    match (&body.shape, camera.projection) {
        (Shape::Plane(_), _) => true,
        (shape, Projection::Perspective { .. }) => !shape.holds(camera.place),
        (shape, Projection::Orthographic { .. }) => shape.heights(camera.place, camera.axes[2]).0 > 0.0,
    }
}

/// True unless a body provably casts no shadow of a light on another, or on itself.
pub(super) fn may_shade(scene: &Scene, caster: usize, receiver: usize, source: &Source) -> bool {
    let (one, other) = (&scene.bodies[caster].shape, &scene.bodies[receiver].shape);
    if source.is_surround() {
        return false;
    }
    if caster == receiver {
        return !(one.is_convex() && is_seen_from_outside(scene, &scene.bodies[caster]));
    }
    if let Shape::Plane(plane) = one {
        // A plane is between a light and a body only where they are on either side of it.
        let (low, high) = other.heights(plane.point, plane.normal);
        let side = match source.place {
            Place::Directional(towards) => dot(towards, plane.normal),
            Place::Point(place, _) => dot(minus(place, plane.point), plane.normal),
            Place::Surround => 0.0,
        };
        return !((low >= 0.0 && side >= 0.0) || (high <= 0.0 && side <= 0.0));
    }
    let (Some((centre, radius)), receiver) = (one.around(), other.around()) else { return true };
    match (source.place, receiver) {
        (Place::Directional(towards), _) if other.heights(centre, towards).0 > radius => false,
        (Place::Directional(towards), Some((at, wide))) => {
            let way = minus(centre, at);
            let ahead = dot(way, towards);
            let aside = length(minus(way, scaled(towards, ahead)));
            ahead > -(radius + wide) && aside < radius + wide
        }
        (Place::Directional(_), None) => true,
        (Place::Point(place, _), Some((at, wide))) => {
            let way = minus(place, centre);
            let far = length(way);
            // Beyond the light, or outside the cone that it throws the shadow in.
            let (to, from) = (minus(at, place), scaled(way, -1.0));
            let (to_far, from_far) = (length(to), far);
            if from_far <= radius || to_far <= wide {
                return true;
            }
            let between = (dot(to, from) / (to_far * from_far)).clamp(-1.0, 1.0).acos();
            let touches = between <= (radius / from_far).asin() + (wide / to_far).asin();
            touches && to_far + wide > from_far - radius
        }
        (Place::Point(..), None) => true,
        (Place::Surround, _) => false,
    }
}

/// The largest share of a hemisphere, weighed by cosines, that one body may take up as seen from another.
pub(super) fn most_seen(scene: &Scene, from: usize, of: usize) -> f64 {
    let (one, other) = (&scene.bodies[from], &scene.bodies[of]);
    if from == of {
        let is_out = one.shape.is_convex() && is_seen_from_outside(scene, one);
        return if is_out { 0.0 } else { 1.0 };
    }
    if let Shape::Plane(plane) = &one.shape {
        // What lies in the plane is seen from it nowhere.
        let (low, high) = other.shape.heights(plane.point, plane.normal);
        if low == 0.0 && high == 0.0 {
            return 0.0;
        }
    }
    let Some((centre, radius)) = other.shape.around() else { return 1.0 };
    let nearest = match &one.shape {
        Shape::Sphere(ball) => length(minus(centre, ball.centre)) - ball.radius,
        Shape::Plane(plane) => dot(minus(centre, plane.point), plane.normal).abs(),
        shape => shape.around().map_or(0.0, |(at, wide)| length(minus(centre, at)) - wide),
    };
    // A sphere straight ahead takes up the square of the sine of its half width.
    if nearest > radius { (radius / nearest).powi(2) } else { 1.0 }
}
