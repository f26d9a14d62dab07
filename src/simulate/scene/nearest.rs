//! The bodies of a scene as rays meet them: one by one, or where there are many through a tree of boxes. Either gives the same, to the
//! last bit.

use super::{Scene, Spot};
use crate::simulate::shape::{Item, Meeting, Ray, Start, Tree};
use crate::simulate::vector::{dot, length, minus, plus, scaled};

/// From so many bodies with an end on there is a tree: fewer are asked sooner than their boxes.
const MANY: usize = 8;

/// The bodies of a scene.
#[derive(Debug)]
pub(in crate::simulate) struct Bodies<'a> {
    scene: &'a Scene,
    /// Asked of every ray.
    listed: Vec<usize>,
    /// The others, in the order of the tree.
    ordered: Vec<usize>,
    tree: Option<Tree>,
}

impl<'a> Bodies<'a> {
    pub(in crate::simulate) fn new(scene: &'a Scene) -> Self {
        Self::with(scene, MANY)
    }

    fn with(scene: &'a Scene, many: usize) -> Self {
        let bodies = scene.bodies.iter().enumerate();
        let items: Vec<Item> = bodies
            .filter_map(|(number, body)| {
                let (low, high) = body.shape.ends()?;
                Some(Item { number, low, high, middle: scaled(plus(low, high), 0.5) })
            })
            .collect();
        if items.len() < many.max(1) {
            return Self { scene, listed: (0..scene.bodies.len()).collect(), ordered: Vec::new(), tree: None };
        }
        let has_no_end = |number: &usize| scene.bodies[*number].shape.ends().is_none();
        let listed = (0..scene.bodies.len()).filter(has_no_end).collect();
        // Of the whole scene: what the tests of bodies round.
        let near = items.iter().map(|item| 1e-12 * length(minus(item.high, item.low)) + 1e-14 * length(item.middle));
        let near = near.fold(0.0, f64::max);
        let (tree, ordered) = Tree::new(items, near);
        Self { scene, listed, ordered, tree: Some(tree) }
    }

    /// Where a body is met nearer than so far.
    #[inline]
    fn meet(&self, body: usize, ray: &Ray, limit: f64) -> Option<Meeting> {
        let own = ray.start.as_ref().filter(|start| start.body == body);
        self.scene.bodies[body].shape.meet(ray, own, limit)
    }

    /// The first body on a ray; of two at one distance that of the lower number.
    #[inline]
    pub(in crate::simulate) fn spot(&self, ray: &Ray) -> Option<Spot> {
        let mut nearest: Option<(Meeting, usize)> = None;
        let mut ask = |body: usize| {
            let limit = match &nearest {
                Some((meeting, found)) if body < *found => meeting.distance.next_up(),
                Some((meeting, _)) => meeting.distance,
                None => f64::INFINITY,
            };
            if let Some(meeting) = self.meet(body, ray, limit) {
                nearest = Some((meeting, body));
            }
            nearest.as_ref().map_or(f64::INFINITY, |(meeting, _)| meeting.distance)
        };
        let limit = self.listed.iter().fold(f64::INFINITY, |_, body| ask(*body));
        if let Some(tree) = &self.tree {
            tree.walk(ray, limit, |places| places.fold(f64::INFINITY, |_, place| ask(self.ordered[place])));
        }
        let (meeting, body) = nearest?;
        let is_outside = dot(meeting.outward, ray.towards) <= 0.0;
        Some(Spot {
            place: meeting.place,
            normal: if is_outside { meeting.outward } else { scaled(meeting.outward, -1.0) },
            start: Start { body, part: meeting.part, outward: meeting.outward },
            material: self.scene.bodies[body].material,
        })
    }

    /// True where a body stands between a spot and what is so far away.
    #[inline]
    pub(in crate::simulate) fn is_hidden(&self, spot: &Spot, towards: [f64; 3], distance: f64) -> bool {
        let ray = Ray { from: spot.place, towards, start: Some(spot.start) };
        // What touches the source itself does not hide it.
        let limit = distance * (1.0 - 1e-12);
        let stands = |body: usize| self.meet(body, &ray, limit).is_some();
        if self.listed.iter().any(|body| stands(*body)) {
            return true;
        }
        let mut is_hidden = false;
        if let Some(tree) = &self.tree {
            tree.walk(&ray, limit, |mut places| {
                is_hidden = places.any(|place| stands(self.ordered[place]));
                // Nothing is nearer than this: the walk ends.
                if is_hidden { f64::NEG_INFINITY } else { limit }
            });
        }
        is_hidden
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;
    use crate::donaldson::{Light, Observer, Reradiation};
    use crate::quantity::QuantityKind;
    use crate::simulate::random::Stream;
    use crate::simulate::vector::{Vector, unit};
    use crate::simulate::{
        Ball, Body, Bounces, Camera, Cuboid, Effect, Grid, Material, Mesh, Place, Plane, Projection, Rectangle, Shape,
        Source,
    };

    fn shape(random: &mut Stream, size: f64) -> Shape {
        let mut between = |low: f64, high: f64| low + (high - low) * random.uniform();
        let centre = [0; 3].map(|_| between(-size, size));
        let (sin, cos) = between(0.0, 6.0).sin_cos();
        let axes = [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]];
        match between(0.0, 5.0) as usize {
            0 | 1 => Shape::Sphere(Ball { centre, radius: between(0.01, 0.8) }),
            2 => Shape::Box(Cuboid { centre, axes, half: [0; 3].map(|_| between(0.05, 0.6)) }),
            3 => {
                let rectangle =
                    (between(0.0, 1.0) < 0.9).then(|| Rectangle { axes: [axes[0], axes[2]], half: [0.5, 0.3] });
                Shape::Plane(Plane { point: centre, normal: axes[1], rectangle })
            }
            _ => {
                let corners: Vec<Vector> = (0..5).map(|_| centre.map(|x| x + between(-0.6, 0.6))).collect();
                Shape::Mesh(Mesh::new(&corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 2, 4]]).unwrap())
            }
        }
    }

    fn scene(shapes: Vec<Shape>) -> Scene {
        let nm = vec![300.0, 780.0];
        let light = Light::new("sun", QuantityKind::SpectralIrradiance, nm.clone(), vec![1.0; 2], None).unwrap();
        let surface = Reradiation::from_parts(nm.clone(), nm, vec![0.5; 2], ndarray::Array2::zeros((2, 2))).unwrap();
        let projection = Projection::Orthographic { width: 4.0 };
        let body = |(k, shape)| Body { name: format!("body {k}"), shape, material: 0 };
        Scene {
            bodies: shapes.into_iter().enumerate().map(body).collect(),
            materials: vec![Material { name: "grey".to_owned(), surface, specular: None, intensity: Vec::new() }],
            sources: vec![Source { name: "sun".to_owned(), light, place: Place::Directional([0.0, 0.0, 1.0]) }],
            camera: Camera::new([0.0, -10.0, 4.0], [0.0; 3], [0.0, 0.0, 1.0], projection).unwrap(),
            size: (4, 4),
            grid: Grid::new(300.0, 780.0, 20.0).unwrap(),
            observer: Observer::Two,
            samples: 1,
            bounces: Bounces::All,
            seed: 1,
        }
    }

    /// A spot to the last bit.
    fn bits(spot: &Option<Spot>) -> Option<([u64; 6], usize, usize)> {
        let bits = |v: Vector| v.map(f64::to_bits);
        spot.as_ref().map(|spot| {
            let ([a, b, c], [d, e, f]) = (bits(spot.place), bits(spot.normal));
            ([a, b, c, d, e, f], spot.start.body, spot.start.part)
        })
    }

    #[test]
    fn a_tree_finds_what_the_list_finds_to_the_last_bit() {
        let (mut met, mut hidden, mut tied) = (0, 0, 0);
        for case in 0..200 {
            let mut random = Stream::new(17, case, 0, Effect::Shadow);
            let count = 1 + (random.uniform() * 60.0) as usize;
            let size = 10.0_f64.powf(-1.0 + 3.0 * random.uniform());
            let mut shapes: Vec<Shape> = (0..count).map(|_| shape(&mut random, size)).collect();
            // Bodies that are the same: of two at one distance the first counts.
            let twice: Vec<Shape> = shapes.iter().step_by(3).cloned().collect();
            shapes.extend(twice);
            let scene = scene(shapes);
            let (list, tree) = (Bodies::with(&scene, usize::MAX), Bodies::with(&scene, 1));
            for _ in 0..300 {
                let mut between = |low: f64, high: f64| low + (high - low) * random.uniform();
                let far = if between(0.0, 1.0) < 0.2 { 1e4 } else { 1.0 };
                let from = [0; 3].map(|_| far * between(-size, size));
                let at = [0; 3].map(|_| between(-size, size));
                // Some along a coordinate.
                let towards = if between(0.0, 1.0) < 0.1 { Some([0.0, 1.0, 0.0]) } else { unit(minus(at, from)) };
                let ray = Ray { from, towards: towards.unwrap(), start: None };
                let found = list.spot(&ray);
                assert_eq!(bits(&found), bits(&tree.spot(&ray)), "case {case}");
                let Some(spot) = found else { continue };
                met += 1;
                tied += usize::from(spot.start.body % 3 == 0);
                let out = unit([0; 3].map(|_| between(-1.0, 1.0))).unwrap();
                let distance = if between(0.0, 1.0) < 0.5 { f64::INFINITY } else { between(0.0, size) };
                let is_hidden = list.is_hidden(&spot, out, distance);
                assert_eq!(is_hidden, tree.is_hidden(&spot, out, distance), "case {case}");
                hidden += usize::from(is_hidden);
                let next = Ray { from: spot.place, towards: out, start: Some(spot.start) };
                assert_eq!(bits(&list.spot(&next)), bits(&tree.spot(&next)), "case {case}");
            }
        }
        assert!(met > 5000 && hidden > 1000 && tied > 1000, "{met} met, {hidden} hidden, {tied} that are there twice");
    }
}
