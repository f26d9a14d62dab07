//! Bodies in patches: what is said of a patch holds at each of its places, and says more than what holds on all of a body.

use std::f64::consts::{FRAC_PI_4, TAU};

use super::super::camera::Projection;
use super::super::scene::{Body, Scene};
use super::super::shape::{Ball, Cuboid, Mesh, Plane, Rectangle, Shape};
use super::super::source::{Place, Source};
use super::super::vector::{Vector, across, along, cross, dot, length, minus, plus, scaled, unit};
use super::cone::{Cone, angle};
use super::hidden::hides;
use super::reach::{may_shade, may_shade_itself};

/// How far a patch goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Extent {
    /// It is held by a ball of this radius about its centre.
    Within(f64),
    /// All of a plane that is at least so far from its centre.
    Beyond(f64),
}

/// One side of a part of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Patch {
    pub(super) body: usize,
    pub(super) centre: Vector,
    pub(super) extent: Extent,
    /// Normals, on the side that it is a patch of.
    pub(super) normals: Cone,
    pub(super) area: f64,
    /// It sees no other patch of its body that is so, too.
    pub(super) is_convex: bool,
    form: Form,
}

/// What a patch is a part of, where it can be cut further.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    /// A field on a sphere.
    Round(Field),
    /// A rectangle.
    Flat(Rectangle),
    /// Anything.
    Whole,
}

/// A part of a sphere as seen from its centre through one side of a cube, between angles along the two axes of that side.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Field {
    ball: Ball,
    side: Vector,
    axes: [Vector; 2],
    low: [f64; 2],
    high: [f64; 2],
    is_within: bool,
}

/// How finely bodies are cut: as many patches as a scene of so many bodies leaves time for, and about so many at most.
fn fineness(bodies: usize, most: usize) -> usize {
    let by_bodies = match bodies {
        0..=3 => 6,
        4..=6 => 4,
        7..=16 => 2,
        17..=60 => 1,
        _ => 0,
    };
    (0..=by_bodies).rev().find(|fine| 8 * fine * fine * bodies <= most).unwrap_or(0)
}

/// Half the angle of normals, rad, from which on a patch is not taken for flat.
const NOT_FLAT: f64 = 1e-9;

/// Edges of the parts of a plane without end, in radii of what else there is.
const EDGES: [&[f64]; 5] = [&[2.0], &[1.0, 4.0], &[0.6, 2.0, 8.0], &[0.3, 0.8, 2.0, 8.0], &[0.25, 0.5, 1.0, 2.5, 10.0]];

/// Cuts all bodies, in about so many patches at most.
pub(super) fn cut(scene: &Scene, most: usize) -> Vec<Patch> {
    let fine = fineness(scene.bodies.len(), most);
    let middle = middle(scene);
    let mut all = Vec::new();
    for (number, body) in scene.bodies.iter().enumerate() {
        let mut cutter = Cutter { body: number, all: &mut all };
        // Where the camera is in a body, its inner side is what there is.
        let is_within = !scene.is_seen_from_outside(body);
        if fine == 0 && !matches!(body.shape, Shape::Plane(_)) {
            cutter.whole(body, body.shape.is_convex() && !is_within);
            continue;
        }
        match &body.shape {
            Shape::Sphere(ball) => cutter.ball(ball, fine, is_within),
            Shape::Box(cuboid) => cutter.cuboid(cuboid, fine, is_within),
            Shape::Plane(plane) => match (plane.rectangle, middle) {
                (Some(ends), _) => cutter.rectangle(plane, &ends, 2 * fine.max(1)),
                (None, Some(middle)) => cutter.plane(plane, middle, EDGES[fine.min(EDGES.len() - 1)]),
                (None, None) => cutter.beyond(plane, plane.point, 0.0),
            },
            Shape::Mesh(mesh) => cutter.mesh(mesh, 16 * fine, is_within),
        }
    }
    all
}

/// A ball about all bodies that end.
fn middle(scene: &Scene) -> Option<(Vector, f64)> {
    let balls: Vec<(Vector, f64)> = scene.bodies.iter().filter_map(|body| body.shape.around()).collect();
    let first = balls.first()?;
    let ends = balls.iter().fold((first.0, first.0), |(low, high), (centre, radius)| {
        (
            [0, 1, 2].map(|k| f64::min(low[k], centre[k] - radius)),
            [0, 1, 2].map(|k| f64::max(high[k], centre[k] + radius)),
        )
    });
    let centre = scaled(plus(ends.0, ends.1), 0.5);
    let radius = balls.iter().map(|(at, radius)| length(minus(*at, centre)) + radius).fold(0.0, f64::max);
    Some((centre, radius))
}

struct Cutter<'a> {
    body: usize,
    all: &'a mut Vec<Patch>,
}

impl Cutter<'_> {
    fn add(&mut self, centre: Vector, extent: Extent, normals: Cone, area: f64, is_convex: bool) {
        self.all.push(Patch { body: self.body, centre, extent, normals, area, is_convex, form: Form::Whole });
    }

    /// In one piece.
    fn whole(&mut self, body: &Body, is_convex: bool) {
        let (centre, radius) = body.shape.around().unwrap_or(([0.0; 3], f64::INFINITY));
        self.add(centre, Extent::Within(radius), Cone::ALL, f64::INFINITY, is_convex);
    }

    /// A sphere by the six sides of a cube about it, each in fields of equal angles.
    fn ball(&mut self, ball: &Ball, fine: usize, is_within: bool) {
        for (side, axes) in sides() {
            let at = |k: usize| FRAC_PI_4 * (2.0 * k as f64 / fine as f64 - 1.0);
            for (i, j) in (0..fine).flat_map(|i| (0..fine).map(move |j| (i, j))) {
                let (low, high) = ([at(i), at(j)], [at(i + 1), at(j + 1)]);
                let field = Field { ball: *ball, side, axes, low, high, is_within };
                self.all.push(Patch::round(self.body, field));
            }
        }
    }

    fn cuboid(&mut self, cuboid: &Cuboid, fine: usize, is_within: bool) {
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let ends = Rectangle { axes: [cuboid.axes[a], cuboid.axes[b]], half: [cuboid.half[a], cuboid.half[b]] };
            for sign in [1.0, -1.0] {
                let outward = scaled(cuboid.axes[k], sign);
                let point = along(cuboid.centre, outward, cuboid.half[k]);
                let normal = if is_within { scaled(outward, -1.0) } else { outward };
                self.fields(point, normal, &ends, fine, !is_within);
            }
        }
    }

    fn rectangle(&mut self, plane: &Plane, ends: &Rectangle, fine: usize) {
        for normal in [plane.normal, scaled(plane.normal, -1.0)] {
            self.fields(plane.point, normal, ends, fine, true);
        }
    }

    fn fields(&mut self, point: Vector, normal: Vector, ends: &Rectangle, fine: usize, is_convex: bool) {
        let half = ends.half.map(|half| half / fine as f64);
        for (i, j) in (0..fine).flat_map(|i| (0..fine).map(move |j| (i, j))) {
            let middle = |axis: usize, k: usize| half[axis] * (2 * k + 1) as f64 - ends.half[axis];
            let centre = along(along(point, ends.axes[0], middle(0, i)), ends.axes[1], middle(1, j));
            let ends = Rectangle { axes: ends.axes, half };
            self.all.push(Patch::flat(self.body, centre, normal, ends, is_convex));
        }
    }

    /// A plane without end: finely where the rest of the scene is near, and what is far in one piece.
    fn plane(&mut self, plane: &Plane, (middle, radius): (Vector, f64), edges: &[f64]) {
        let foot = along(middle, plane.normal, dot(minus(plane.point, middle), plane.normal));
        let axes = across(plane.normal);
        let mut places: Vec<f64> = edges.iter().rev().map(|edge| -edge * radius).collect();
        places.push(0.0);
        places.extend(edges.iter().map(|edge| edge * radius));
        let fields: Vec<(f64, f64)> =
            places.windows(2).map(|pair| ((pair[0] + pair[1]) / 2.0, (pair[1] - pair[0]) / 2.0)).collect();
        for normal in [plane.normal, scaled(plane.normal, -1.0)] {
            for (x, wide) in &fields {
                for (y, high) in &fields {
                    let centre = along(along(foot, axes[0], *x), axes[1], *y);
                    let ends = Rectangle { axes, half: [*wide, *high] };
                    self.all.push(Patch::flat(self.body, centre, normal, ends, true));
                }
            }
        }
        self.beyond(plane, foot, places.last().copied().unwrap_or(0.0));
    }

    fn beyond(&mut self, plane: &Plane, foot: Vector, hole: f64) {
        for normal in [plane.normal, scaled(plane.normal, -1.0)] {
            self.add(foot, Extent::Beyond(hole), Cone::of(normal), f64::INFINITY, true);
        }
    }

    /// A mesh in so many pieces of triangles that are near each other.
    fn mesh(&mut self, mesh: &Mesh, pieces: usize, is_within: bool) {
        let is_convex = mesh.is_convex() && !is_within;
        for piece in mesh.pieces(pieces) {
            // The middle of a piece need not lie in its plane: it is never taken for flat.
            let half = piece.normals.iter().map(|normal| angle(piece.normal, *normal)).fold(NOT_FLAT, f64::max);
            let normals = Cone { axis: piece.normal, half };
            let extent = Extent::Within(piece.radius);
            self.add(piece.centre, extent, normals, piece.area, is_convex);
            if !(is_convex && mesh.is_closed()) {
                self.add(piece.centre, extent, normals.reversed(), piece.area, is_convex);
            }
        }
    }
}

/// Planes without end, with the numbers of their bodies: nothing goes from one side to the other.
pub(super) fn planes(scene: &Scene) -> impl Iterator<Item = (usize, &Plane)> {
    scene.bodies.iter().enumerate().filter_map(|(number, body)| match &body.shape {
        Shape::Plane(plane) if plane.rectangle.is_none() => Some((number, plane)),
        _ => None,
    })
}

/// The six sides of a cube: the direction of each, and two across it.
fn sides() -> [(Vector, [Vector; 2]); 6] {
    let axis = |k: usize, sign: f64| [0, 1, 2].map(|c| if c == k { sign } else { 0.0 });
    [0, 1, 2, 3, 4, 5].map(|side| {
        let k = side % 3;
        (axis(k, if side < 3 { 1.0 } else { -1.0 }), [axis((k + 1) % 3, 1.0), axis((k + 2) % 3, 1.0)])
    })
}

/// The solid angle of a triangle (Van Oosterom and Strackee 1983).
fn triangle(a: Vector, b: Vector, c: Vector) -> f64 {
    let volume = dot(a, cross(b, c)).abs();
    let half = volume.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
    if half < 0.0 { 2.0 * half + TAU } else { 2.0 * half }
}

impl Patch {
    fn flat(body: usize, centre: Vector, normal: Vector, ends: Rectangle, is_convex: bool) -> Self {
        Self {
            body,
            centre,
            extent: Extent::Within(ends.half[0].hypot(ends.half[1])),
            normals: Cone::of(normal),
            area: 4.0 * ends.half[0] * ends.half[1],
            is_convex,
            form: Form::Flat(ends),
        }
    }

    fn round(body: usize, field: Field) -> Self {
        let Field { ball, side, axes: [a, b], low, high, is_within } = field;
        let at = |u: f64, v: f64| unit(along(along(side, a, u.tan()), b, v.tan())).unwrap_or(side);
        let corners = [at(low[0], low[1]), at(high[0], low[1]), at(high[0], high[1]), at(low[0], high[1])];
        let sum = corners.iter().fold([0.0; 3], |sum, corner| plus(sum, *corner));
        let towards = unit(sum).unwrap_or(side);
        // A cap that holds the corners holds all between them.
        let half = corners.iter().map(|corner| angle(towards, *corner)).fold(0.0, f64::max);
        let solid = triangle(corners[0], corners[1], corners[2]) + triangle(corners[0], corners[2], corners[3]);
        let normals = Cone { axis: towards, half };
        Self {
            body,
            centre: along(ball.centre, towards, ball.radius * half.cos()),
            extent: Extent::Within(ball.radius * half.sin()),
            normals: if is_within { normals.reversed() } else { normals },
            area: solid * ball.radius * ball.radius,
            is_convex: !is_within,
            form: Form::Round(field),
        }
    }

    /// The same in four parts; nothing where it cannot be cut.
    pub(super) fn quarters(&self) -> Vec<Self> {
        let quarters = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter();
        match self.form {
            Form::Whole => Vec::new(),
            Form::Flat(ends) => {
                let half = ends.half.map(|half| half / 2.0);
                let beside = |k: usize, which: u8| if which == 0 { -half[k] } else { half[k] };
                let part = |(i, j): (u8, u8)| {
                    let centre = along(along(self.centre, ends.axes[0], beside(0, i)), ends.axes[1], beside(1, j));
                    Self::flat(self.body, centre, self.normals.axis, Rectangle { half, ..ends }, self.is_convex)
                };
                quarters.map(part).collect()
            }
            Form::Round(field) => {
                let middle = [0, 1].map(|k| f64::midpoint(field.low[k], field.high[k]));
                let ends = |k: usize, which: u8| match which {
                    0 => (field.low[k], middle[k]),
                    _ => (middle[k], field.high[k]),
                };
                let part = |(i, j): (u8, u8)| {
                    let ((a, b), (c, d)) = (ends(0, i), ends(1, j));
                    Self::round(self.body, Field { low: [a, c], high: [b, d], ..field })
                };
                quarters.map(part).collect()
            }
        }
    }

    /// How far it goes beyond its centre in a direction.
    pub(super) fn reach(&self, direction: Vector) -> f64 {
        let Extent::Within(radius) = self.extent else { return f64::INFINITY };
        if self.normals.half > 0.0 {
            return radius;
        }
        let cosine = dot(self.normals.axis, direction);
        radius * (1.0 - cosine * cosine).max(0.0).sqrt()
    }

    /// Largest irradiance by a light that nothing hides, over that of its spectrum.
    pub(super) fn lit(&self, source: &Source) -> f64 {
        match (source.place, self.extent) {
            (Place::Surround, _) => 1.0,
            (Place::Directional(towards), _) => self.normals.most_cosine(&Cone::of(towards)),
            (Place::Point(place, reference), Extent::Within(radius)) => {
                let cosine = self.normals.most_cosine(&Cone::between(self.centre, place, radius));
                let way = minus(place, self.centre);
                // Above a flat patch it is as far at least as it is high, and behind it it lights the other side.
                let is_flat = self.normals.half == 0.0;
                let height = if is_flat { dot(way, self.normals.axis) } else { 0.0 };
                let nearest = height.max(length(way) - radius);
                match (cosine, nearest) {
                    _ if is_flat && height <= 0.0 => 0.0,
                    (0.0, _) => 0.0,
                    (_, nearest) if nearest <= 0.0 => f64::INFINITY,
                    (cosine, nearest) => cosine * (reference / nearest).powi(2),
                }
            }
            (Place::Point(place, reference), Extent::Beyond(hole)) => {
                let (height, aside) = self.above_plane(place);
                let far = (hole - aside).max(0.0);
                if height <= 0.0 { 0.0 } else { reference * reference * height / height.hypot(far).powi(3) }
            }
        }
    }

    /// Least irradiance by a light that nothing hides.
    pub(super) fn least_lit(&self, source: &Source) -> f64 {
        let Extent::Within(radius) = self.extent else { return 0.0 };
        match source.place {
            Place::Surround => 0.0,
            Place::Directional(towards) => self.normals.least_cosine(&Cone::of(towards)),
            Place::Point(place, reference) => {
                let farthest = length(minus(place, self.centre)) + radius;
                self.normals.least_cosine(&Cone::between(self.centre, place, radius)) * (reference / farthest).powi(2)
            }
        }
    }

    /// True unless provably nothing stands before a light.
    pub(super) fn is_shaded(&self, scene: &Scene, source: &Source) -> bool {
        let Extent::Within(radius) = self.extent else { return true };
        let ball = Shape::Sphere(Ball { centre: self.centre, radius });
        let other = |(number, body): (usize, &Body)| number != self.body && may_shade(&body.shape, &ball, source);
        may_shade_itself(scene, self.body, source) || scene.bodies.iter().enumerate().any(other)
    }

    /// On which side of a plane without end all of it is: 1 or -1, and 0 where it may be on both.
    pub(super) fn side(&self, number: usize, plane: &Plane) -> i8 {
        if self.body == number {
            return if dot(self.normals.axis, plane.normal) > 0.0 { 1 } else { -1 };
        }
        let height = dot(minus(self.centre, plane.point), plane.normal);
        match self.reach(plane.normal) * (1.0 + 1e-9) {
            reach if height > reach => 1,
            reach if height < -reach => -1,
            _ => 0,
        }
    }

    /// True where a body provably stands between all of it and a light.
    pub(super) fn is_dark(&self, scene: &Scene, source: &Source) -> bool {
        let Extent::Within(radius) = self.extent else { return self.is_behind_plane(scene, source) };
        let other = |(_, body): &(usize, &Body)| hides(&body.shape, self.centre, radius * (1.0 + 1e-9), source);
        self.is_behind_plane(scene, source)
            || scene.bodies.iter().enumerate().filter(|(number, _)| *number != self.body).any(|one| other(&one))
    }

    fn is_behind_plane(&self, scene: &Scene, source: &Source) -> bool {
        planes(scene).any(|(number, plane)| {
            let light = match source.place {
                Place::Directional(towards) => dot(towards, plane.normal),
                Place::Point(place, _) => dot(minus(place, plane.point), plane.normal),
                Place::Surround => 0.0,
            };
            f64::from(self.side(number, plane)) * light < 0.0
        })
    }

    /// How high a place is above the plane of a flat patch, and how far from its centre along the plane.
    pub(super) fn above_plane(&self, place: Vector) -> (f64, f64) {
        let from = minus(place, self.centre);
        let height = dot(from, self.normals.axis);
        (height, length(along(from, self.normals.axis, -height)))
    }

    /// False where the camera sees nothing of it.
    pub(super) fn may_be_seen(&self, scene: &Scene) -> bool {
        let camera = &scene.camera;
        let [right, up, forward] = camera.axes;
        let tall = scene.size.1 as f64 / scene.size.0 as f64;
        let is_behind = |(number, plane): (usize, &Plane)| {
            let corners = [(-1.0, -tall), (1.0, -tall), (1.0, tall), (-1.0, tall)].into_iter();
            let side = f64::from(self.side(number, plane));
            corners
                .map(|(x, y)| side * dot(minus(scene.camera.ray(x, y).0, plane.point), plane.normal))
                .all(|height| height < 0.0)
        };
        if planes(scene).any(is_behind) {
            return false;
        }
        let Extent::Within(radius) = self.extent else { return self.plane_may_be_seen(scene) };
        let from = minus(self.centre, camera.place);
        match camera.projection {
            Projection::Orthographic { width } => {
                let is_near = |axis: Vector, half: f64| dot(from, axis).abs() <= half + radius * (1.0 + 1e-9);
                self.normals.most_cosine(&Cone::of(scaled(forward, -1.0))) > 0.0
                    && is_near(right, width / 2.0)
                    && is_near(up, width / 2.0 * tall)
            }
            Projection::Perspective { width_deg } => {
                let to_camera = Cone::between(self.centre, camera.place, radius);
                let corner = ((width_deg / 2.0).to_radians().tan() * 1.0_f64.hypot(tall)).atan();
                self.normals.most_cosine(&to_camera) > 0.0
                    && to_camera.reversed().most_cosine(&Cone { axis: forward, half: corner }) > 0.0
                    && (to_camera.half >= 1.5
                        || angle(to_camera.reversed().axis, forward) <= corner + to_camera.half + 1e-9)
            }
        }
    }

    /// The rest of a plane is not seen where the four corners of the film all look into its hole.
    fn plane_may_be_seen(&self, scene: &Scene) -> bool {
        let Extent::Beyond(hole) = self.extent else { return true };
        let tall = scene.size.1 as f64 / scene.size.0 as f64;
        let is_in_hole = |(x, y): (f64, f64)| {
            let (from, towards) = scene.camera.ray(x, y);
            let (height, _) = self.above_plane(from);
            let slope = dot(towards, self.normals.axis);
            if height * slope >= 0.0 {
                return false;
            }
            let (_, aside) = self.above_plane(along(from, towards, -height / slope));
            aside < hole
        };
        ![(-1.0, -tall), (1.0, -tall), (1.0, tall), (-1.0, tall)].into_iter().all(is_in_hole)
    }
}
