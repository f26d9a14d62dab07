//! How much light may reach a body, and which bodies may stand in each other's light or see each other.

use std::f64::consts::FRAC_PI_2;

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

/// Least and largest irradiance across the beam.
fn strengths(shape: &Shape, source: &Source) -> (f64, f64) {
    let Place::Point(place, reference) = source.place else { return (1.0, 1.0) };
    let far = shape.around().map_or(f64::INFINITY, |(centre, radius)| length(minus(place, centre)) + radius);
    ((reference / far).powi(2), (reference / distance(shape, place)).powi(2))
}

/// Directions from a body to a place.
fn to_place(shape: &Shape, place: Vector) -> Option<Cone> {
    let (centre, radius) = shape.around()?;
    let way = minus(place, centre);
    let far = length(way);
    (far > radius).then(|| Cone { axis: scaled(way, 1.0 / far), half: (radius / far).asin() })
}

/// Places of a body whose normal stands between two angles from the half vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    /// Largest D F G / den there, times the strength of the light; infinite where nothing bounds it.
    pub(super) shining: f64,
    /// Least cos(theta_i) times the strength, where the light is not hidden.
    pub(super) least_lit: f64,
}

/// Edges of the rings, in half widths of a lobe about as wide as it is.
const EDGES: [f64; 12] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0];

/// The rings of a body that a light may shine in; one without an end where nothing bounds it.
pub(super) fn rings(scene: &Scene, body: &Body, source: &Source, interface: &Interface) -> Vec<Ring> {
    let unknown = vec![Ring { shining: f64::INFINITY, least_lit: 0.0 }];
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
    let (Some(light), Some(view)) = (light, view) else { return unknown };
    let sum = plus(light.axis, view.axis);
    let (long, spread) = (length(sum), light.half + view.half);
    // The half vector of directions that are off by angles a and b is off by at most asin((a + b) / |L + V|).
    let Some(half) = unit(sum).filter(|_| spread < long) else { return unknown };
    let off = (spread / long).min(1.0).asin();
    let angle = |a: Vector, b: Vector| 2.0 * (0.5 * length(minus(a, b))).min(1.0).asin();
    let theta_q = (0.5 * (angle(light.axis, view.axis) + spread)).min(FRAC_PI_2);
    let seen = |normal: Vector| {
        let faces = |cone: &Cone| dot(normal, cone.axis) > -cone.half.sin() || cone.half > 1.5;
        (faces(&light) && faces(&view)).then(|| (angle(normal, half) - off - 1e-9).max(0.0))
    };
    let both =
        |normal: Vector| [seen(normal), seen(scaled(normal, -1.0))].into_iter().flatten().fold(f64::INFINITY, f64::min);
    let nearest = match shape {
        Shape::Sphere(_) => 0.0,
        Shape::Plane(plane) => both(plane.normal),
        Shape::Box(cuboid) => cuboid.axes.iter().map(|axis| both(*axis)).fold(f64::INFINITY, f64::min),
        Shape::Mesh(mesh) => mesh.normals().map(both).fold(f64::INFINITY, f64::min),
    };
    let (least, most) = strengths(shape, source);
    let mut edges: Vec<f64> =
        EDGES.iter().map(|edge| edge * interface.half_width()).filter(|edge| *edge < FRAC_PI_2).collect();
    edges.push(FRAC_PI_2);
    let ring = |(from, to): (f64, f64)| {
        let value = interface.most(from.max(nearest), to, theta_q.cos().max(0.0));
        Ring {
            shining: if value == 0.0 { 0.0 } else { value * most },
            least_lit: (theta_q + to).min(FRAC_PI_2).cos().max(0.0) * least,
        }
    };
    edges.windows(2).map(|pair| (pair[0], pair[1])).filter(|(_, to)| *to >= nearest).map(ring).collect()
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
