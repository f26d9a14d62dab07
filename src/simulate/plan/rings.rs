//! Where on a body a lobe may shine, and how brightly.

use std::f64::consts::FRAC_PI_2;

use super::super::camera::Projection;
use super::super::interface::Interface;
use super::super::scene::{Body, Scene};
use super::super::shape::Shape;
use super::super::source::{Place, Source};
use super::super::vector::{Vector, dot, length, minus, plus, scaled, unit};
use super::cone::{Cone, angle};

/// Least distance of a place from a body; a lower bound of it.
pub(super) fn distance(shape: &Shape, place: Vector) -> f64 {
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

/// Least and largest irradiance across the beam.
fn strengths(shape: &Shape, source: &Source) -> (f64, f64) {
    let Place::Point(place, reference) = source.place else { return (1.0, 1.0) };
    let far = shape.around().map_or(f64::INFINITY, |(centre, radius)| length(minus(place, centre)) + radius);
    ((reference / far).powi(2), (reference / distance(shape, place)).powi(2))
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
    let to_place = |place: Vector| {
        let (centre, radius) = shape.around()?;
        Some(Cone::between(centre, place, radius)).filter(|cone| *cone != Cone::ALL)
    };
    let light = match source.place {
        Place::Directional(towards) => Some(Cone::of(towards)),
        Place::Point(place, _) => to_place(place),
        Place::Surround => None,
    };
    let view = match scene.camera.projection {
        Projection::Orthographic { .. } => Some(Cone::of(scaled(scene.camera.axes[2], -1.0))),
        Projection::Perspective { .. } => to_place(scene.camera.place),
    };
    let (Some(light), Some(view)) = (light, view) else { return unknown };
    let sum = plus(light.axis, view.axis);
    let (long, spread) = (length(sum), light.half + view.half);
    // The half vector of directions that are off by angles a and b is off by at most asin((a + b) / |L + V|).
    let Some(half) = unit(sum).filter(|_| spread < long) else { return unknown };
    let off = (spread / long).min(1.0).asin();
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
