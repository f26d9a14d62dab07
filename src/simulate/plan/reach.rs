//! How much light may reach a body, and which bodies may stand in each other's light or see each other.

use super::super::interface::{Interface, surrounded};
use super::super::scene::Scene;
use super::super::shape::Shape;
use super::super::source::{Place, Source};
use super::super::vector::{dot, length, minus, scaled};
use super::rings::{Ring, distance, rings};

/// The light from all around at an interface is tabulated; its largest value may lie between two of the table, and beside its sum: by
/// half a per cent at most, which a test of the table holds below one.
const TABLE: f64 = 1.01;

/// How much of each light there may be on each body.
pub(super) struct Reach {
    /// \[body\]\[light\]: largest cos(theta_i) times the strength.
    pub(super) lit: Vec<Vec<f64>>,
    /// \[body\]\[light\]: largest D F G / den times the strength.
    pub(super) shining: Vec<Vec<f64>>,
    /// \[body\]\[light\]: the same in rings about the brightest place.
    pub(super) rings: Vec<Vec<Vec<Ring>>>,
    /// \[body\]\[light\]: whether a body may stand in between.
    pub(super) shaded: Vec<Vec<bool>>,
    /// \[body\]\[other\]: share of the hemisphere.
    pub(super) seen: Vec<Vec<f64>>,
    /// Whether each body's material has an interface that reflects.
    pub(super) has_interface: Vec<bool>,
}

impl Reach {
    pub(super) fn new(scene: &Scene) -> Self {
        let bodies = 0..scene.bodies.len();
        let interfaces: Vec<Option<Interface>> =
            scene.materials.iter().map(|one| one.interface().as_ref().map(Interface::new)).collect();
        let interface = |body: usize| interfaces[scene.bodies[body].material].as_ref();
        let rings_of = |body: usize, source: &Source| match interface(body) {
            Some(one) if !source.is_surround() => rings(scene, &scene.bodies[body], source, one),
            _ => Vec::new(),
        };
        let lights = |body: usize, of: &dyn Fn(usize, &Source) -> f64| {
            scene.sources.iter().map(|source| of(body, source)).collect::<Vec<f64>>()
        };
        let lit = |body: usize, source: &Source| most_lit(&scene.bodies[body].shape, source);
        let shining = |body: usize, source: &Source| match interface(body) {
            Some(_) if source.is_surround() => mirror(scene, body),
            _ => rings_of(body, source).iter().map(|ring| ring.shining).fold(0.0, f64::max),
        };
        let shades = |body: usize| {
            scene
                .sources
                .iter()
                .map(|source| {
                    let other = |caster: usize| {
                        let shapes = [caster, body].map(|number| &scene.bodies[number].shape);
                        caster != body && may_shade(shapes[0], shapes[1], source)
                    };
                    may_shade_itself(scene, body, source) || bodies.clone().any(other)
                })
                .collect()
        };
        let seen: Vec<Vec<f64>> =
            bodies.clone().map(|from| bodies.clone().map(|other| most_seen(scene, from, other)).collect()).collect();
        Self {
            lit: bodies.clone().map(|body| lights(body, &lit)).collect(),
            shining: bodies.clone().map(|body| lights(body, &shining)).collect(),
            rings: bodies
                .clone()
                .map(|body| scene.sources.iter().map(|source| rings_of(body, source)).collect())
                .collect(),
            shaded: bodies.clone().map(shades).collect(),
            has_interface: bodies.clone().map(|body| interface(body).is_some()).collect(),
            seen,
        }
    }

    /// True where no light goes from one body to another, or from one part of a body to another.
    pub(super) fn is_open(&self) -> bool {
        self.seen.iter().flatten().all(|share| *share == 0.0)
    }

    /// True where every body that can be seen from another has no interface.
    pub(super) fn is_matte(&self) -> bool {
        (0..self.seen.len()).all(|of| !self.has_interface[of] || self.seen.iter().all(|list| list[of] == 0.0))
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

/// True unless a body provably casts no shadow of a light on itself.
pub(super) fn may_shade_itself(scene: &Scene, body: usize, source: &Source) -> bool {
    let body = &scene.bodies[body];
    !(source.is_surround() || body.shape.is_convex() && scene.is_seen_from_outside(body))
}

/// True unless a body provably casts no shadow of a light on another.
pub(super) fn may_shade(one: &Shape, other: &Shape, source: &Source) -> bool {
    if source.is_surround() {
        return false;
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
        let is_out = one.shape.is_convex() && scene.is_seen_from_outside(one);
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

/// The share of light from all around that the interface of a body sends on at most.
pub(super) fn mirror(scene: &Scene, body: usize) -> f64 {
    let term = scene.materials[scene.bodies[body].material].interface();
    term.map_or(0.0, |term| TABLE * surrounded(&term).iter().copied().fold(0.0, f64::max))
}
