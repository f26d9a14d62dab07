//! Triangles, found through a tree of boxes.
//!
//! No ray passes between two triangles that share a side: the test is that of Woop, Benthin and Wald (Watertight ray/triangle
//! intersection, JCGT 2013), which looks at every side by its two corners alone, and so alike from either triangle.

use std::collections::HashMap;

use super::tree::{Item, Tree, largest};
use super::{Meeting, Ray, Start};
use crate::simulate::vector::{Vector, along, cross, dot, length, minus, plus, scaled, unit};

/// The next coordinate, and the one after it.
const NEXT: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// Triangles of which it is proven that they are convex: the proof takes triangles times corners.
const PROVEN: usize = 2000;

/// Triangles with their tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    triangles: Vec<Triangle>,
    tree: Tree,
    around: (Vector, f64),
    /// What is no farther from a place on it may be that place, by rounding.
    near: f64,
    is_convex: bool,
    /// Every side of a triangle is that of another, too, and of no third: a surface without an edge.
    is_closed: bool,
}

/// Triangles that are near each other.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::simulate) struct Piece {
    /// A ball that holds them.
    pub(in crate::simulate) centre: Vector,
    pub(in crate::simulate) radius: f64,
    /// Their normals, and one about the middle of them.
    pub(in crate::simulate) normals: Vec<Vector>,
    pub(in crate::simulate) normal: Vector,
    pub(in crate::simulate) area: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Triangle {
    /// As they were given: those of neighbours are the same to the last bit.
    corners: [Vector; 3],
    normal: Vector,
}

/// What the triangles of a mesh are asked of one ray: it is sheared until it runs along a coordinate.
struct Sheared {
    from: Vector,
    /// The coordinate it runs along, and the two others.
    axes: [usize; 3],
    /// Slopes in the two others, and the inverse of the speed along the first.
    slopes: [f64; 3],
}

/// Numbers that make no mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoMesh {
    /// Nothing there.
    #[error("no triangle with an area; expected at least one")]
    Empty,
    /// A corner that is none.
    #[error("triangle {triangle} names corner {corner} of {corners}; expected one below that number")]
    Corner {
        /// Which triangle, from 0.
        triangle: usize,
        /// What it names.
        corner: usize,
        /// How many there are.
        corners: usize,
    },
    /// Not a number.
    #[error("corner {0} is no place; expected three finite numbers below 1e12")]
    Place(usize),
}

impl Mesh {
    /// A mesh from its corners and, three for each triangle, their numbers. Triangles without an area are left out.
    ///
    /// # Errors
    /// [`NoMesh`].
    pub fn new(corners: &[Vector], triangles: &[[usize; 3]]) -> Result<Self, NoMesh> {
        if let Some(wrong) = corners.iter().position(|at| at.iter().any(|x| x.is_nan() || x.abs() > 1e12)) {
            return Err(NoMesh::Place(wrong));
        }
        let mut all = Vec::with_capacity(triangles.len());
        for (triangle, at) in triangles.iter().enumerate() {
            if let Some(corner) = at.iter().find(|corner| **corner >= corners.len()) {
                return Err(NoMesh::Corner { triangle, corner: *corner, corners: corners.len() });
            }
            let corners = at.map(|corner| corners[corner]);
            if let Some(normal) = unit(twice_area(&corners)) {
                all.push(Triangle { corners, normal });
            }
        }
        if all.is_empty() {
            return Err(NoMesh::Empty);
        }
        let (low, high) = ends(&all);
        let centre = scaled(plus(low, high), 0.5);
        let used = all.iter().flat_map(|one| one.corners);
        let radius = used.map(|at| length(minus(at, centre))).fold(0.0, f64::max);
        let near = 1e-12 * radius + 8.0 * f64::EPSILON * largest(centre);
        let is_closed = all.len() <= PROVEN && is_closed(&all);
        // An open bowl sees itself from within; what is flat does not.
        let is_convex =
            all.len() <= PROVEN && is_below(&all, radius, 1.0) && (is_closed || is_below(&all, radius, -1.0));
        let item = |(number, one): (usize, &Triangle)| {
            let (low, high) = ends(std::slice::from_ref(one));
            Item { number, low, high, middle: one.middle() }
        };
        let (tree, order) = Tree::new(all.iter().enumerate().map(item).collect(), near);
        let all = order.into_iter().map(|number| all[number]).collect();
        Ok(Self { triangles: all, tree, around: (centre, radius), near, is_convex, is_closed })
    }

    /// Its least and its greatest coordinates.
    pub(super) fn ends(&self) -> (Vector, Vector) {
        ends(&self.triangles)
    }

    pub(super) fn around(&self) -> (Vector, f64) {
        self.around
    }

    pub(in crate::simulate) fn is_convex(&self) -> bool {
        self.is_convex
    }

    /// True where it has no edge: from outside nothing is seen of its inner side.
    pub(in crate::simulate) fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// All of it in so many pieces at most; a few large triangles in parts.
    pub(in crate::simulate) fn pieces(&self, most: usize) -> Vec<Piece> {
        let mut triangles = self.triangles.clone();
        while 4 * triangles.len() <= most {
            triangles = triangles.iter().flat_map(Triangle::quarters).collect();
        }
        // The tree has put together what is near.
        triangles.chunks(triangles.len().div_ceil(most.max(1))).map(Piece::of).collect()
    }

    /// Normals of the triangles.
    pub(in crate::simulate) fn normals(&self) -> impl Iterator<Item = Vector> {
        self.triangles.iter().map(|triangle| triangle.normal)
    }

    pub(in crate::simulate) fn meet(&self, ray: &Ray, own: Option<&Start>, limit: f64) -> Option<Meeting> {
        if self.is_convex && own.is_some_and(|start| dot(start.outward, ray.towards) >= 0.0) {
            return None;
        }
        let lifted = Ray { from: own.map_or(ray.from, |start| self.lifted(ray, start)), ..*ray };
        let sheared = Sheared::new(&lifted);
        let (mut found, mut nearest) = (None, limit);
        self.tree.walk(&lifted, limit, |parts| {
            for part in parts {
                let Some(t) = self.triangles[part].meet(&sheared) else { continue };
                let distance = self.beyond(ray, own, part, t);
                if let Some(distance) = distance.filter(|t| *t > 0.0 && *t < nearest) {
                    nearest = distance;
                    // On the triangle, also where that is behind the start by rounding.
                    let place = along(lifted.from, ray.towards, t);
                    found = Some(Meeting { distance, place, outward: self.triangles[part].normal, part });
                }
            }
            nearest
        });
        found
    }

    /// Where a ray that starts on a triangle is looked at from: by less than a picture shows off the triangle to the side that it leaves
    /// to, and away from its sides. At the very edge of two walls rounding would put it behind either.
    fn lifted(&self, ray: &Ray, start: &Start) -> Vector {
        let triangle = &self.triangles[start.part];
        let up = self.near.copysign(dot(triangle.normal, ray.towards));
        along(along(ray.from, triangle.normal, up), minus(triangle.middle(), ray.from), 1e-12)
    }

    /// How far from its start a ray that starts on this mesh meets a triangle. Where the start lies in the plane of the triangle, they are
    /// neighbours, and rounding alone would say that they meet; but not where the neighbour stands up on the side that the ray leaves to,
    /// and the ray goes into it: there it ends, or it would leave through a corner of a room.
    fn beyond(&self, ray: &Ray, own: Option<&Start>, part: usize, distance: f64) -> Option<f64> {
        let Some(start) = own else { return Some(distance) };
        let (from, other, close) = (&self.triangles[start.part], &self.triangles[part], 4.0 * self.near);
        let height = distance * dot(other.normal, ray.towards).abs();
        if start.part == part || height < -close {
            return None;
        }
        if height > close {
            return Some(distance);
        }
        let side = 1.0_f64.copysign(dot(from.normal, ray.towards));
        let rises = other.heights_over(from).iter().any(|height| side * height > close);
        let [low, high] = from.heights_over(other);
        // A triangle that the other cuts lies on neither side of it.
        let goes_in = match (low < -close, high > close) {
            (false, true) => dot(other.normal, ray.towards) < 0.0,
            (true, false) => dot(other.normal, ray.towards) > 0.0,
            _ => false,
        };
        (rises && goes_in).then(|| distance.max(f64::MIN_POSITIVE))
    }
}

impl Piece {
    fn of(triangles: &[Triangle]) -> Self {
        let (low, high) = ends(triangles);
        let centre = scaled(plus(low, high), 0.5);
        let far = triangles.iter().flat_map(|one| one.corners).map(|at| length(minus(at, centre)));
        let twice = |one: &Triangle| length(twice_area(&one.corners));
        let sum = triangles.iter().fold([0.0; 3], |sum, one| along(sum, one.normal, twice(one)));
        Self {
            centre,
            radius: far.fold(0.0, f64::max),
            normals: triangles.iter().map(|one| one.normal).collect(),
            normal: unit(sum).unwrap_or(triangles[0].normal),
            area: triangles.iter().map(twice).sum::<f64>() / 2.0,
        }
    }
}

impl Triangle {
    /// Four of half the size.
    fn quarters(&self) -> [Self; 4] {
        let [a, b, c] = self.corners;
        let between = |a: Vector, b: Vector| scaled(plus(a, b), 0.5);
        let middles = [between(a, b), between(b, c), between(c, a)];
        let [ab, bc, ca] = middles;
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], middles].map(|corners| Self { corners, normal: self.normal })
    }

    fn middle(&self) -> Vector {
        let [a, b, c] = self.corners;
        scaled(plus(plus(a, b), c), 1.0 / 3.0)
    }

    /// Least and greatest height of its corners over the plane of another.
    fn heights_over(&self, other: &Self) -> [f64; 2] {
        let heights = self.corners.map(|at| dot(other.normal, minus(at, other.corners[0])));
        [heights.into_iter().fold(f64::INFINITY, f64::min), heights.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// How far along the ray; on a side or a corner it is met.
    fn meet(&self, ray: &Sheared) -> Option<f64> {
        let [a, b, c] = self.corners.map(|corner| ray.seen(corner));
        let shares = [side(b, c), side(c, a), side(a, b)];
        if shares.iter().any(|share| *share < 0.0) && shares.iter().any(|share| *share > 0.0) {
            return None;
        }
        let all = shares[0] + shares[1] + shares[2];
        // Seen along its plane it has no extent; its neighbours are met in its place.
        if all == 0.0 {
            return None;
        }
        let depth = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2];
        Some(depth / all * ray.slopes[2])
    }
}

impl Sheared {
    fn new(ray: &Ray) -> Self {
        let speed = ray.towards.map(f64::abs);
        let main = (0..3).fold(0, |most, k| if speed[k] > speed[most] { k } else { most });
        let [first, second] = NEXT[main];
        let inverse = 1.0 / ray.towards[main];
        let slopes = [ray.towards[first] * inverse, ray.towards[second] * inverse, inverse];
        Self { from: ray.from, axes: [main, first, second], slopes }
    }

    /// A corner: aside of the ray in two coordinates, and ahead. It depends on nothing but the corner and the ray.
    #[inline]
    fn seen(&self, corner: Vector) -> Vector {
        let way = minus(corner, self.from);
        let [main, first, second] = self.axes;
        [way[first] - self.slopes[0] * way[main], way[second] - self.slopes[1] * way[main], way[main]]
    }
}

/// On which side of a side of a triangle the ray runs: twice the area that both span. From the other end of the side it is the same
/// number with the other sign. A product is rounded without being thrown past another, so that the sign of the difference is right or the
/// difference is 0; then it is taken from the digits that the products have lost.
#[inline]
fn side(a: Vector, b: Vector) -> f64 {
    let difference = a[0] * b[1] - a[1] * b[0];
    if difference == 0.0 { side_exactly(a, b) } else { difference }
}

/// The same by Kahan's difference of products, which has the right sign (Jeannerod, Louvet, Muller 2013).
#[cold]
fn side_exactly(a: Vector, b: Vector) -> f64 {
    let product = a[1] * b[0];
    let lost = (-a[1]).mul_add(b[0], product);
    a[0].mul_add(b[1], -product) + lost
}

/// The normal of a triangle, as long as twice its area.
fn twice_area(corners: &[Vector; 3]) -> Vector {
    cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]))
}

fn ends(triangles: &[Triangle]) -> (Vector, Vector) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for at in triangles.iter().flat_map(|one| one.corners) {
        for k in 0..3 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    (low, high)
}

/// True where no corner lies above any triangle, on the side of its normal or on the other: normals point outwards.
fn is_below(triangles: &[Triangle], size: f64, sign: f64) -> bool {
    let corners: Vec<Vector> = triangles.iter().flat_map(|one| one.corners).collect();
    triangles.iter().all(|triangle| {
        corners.iter().all(|at| sign * dot(triangle.normal, minus(*at, triangle.corners[0])) <= 1e-12 * size)
    })
}

fn is_closed(triangles: &[Triangle]) -> bool {
    let mut sides: HashMap<[[u64; 3]; 2], usize> = HashMap::new();
    for Triangle { corners, .. } in triangles {
        // 0 and -0 are one place.
        let [a, b, c] = corners.map(|at| at.map(|x| (x + 0.0).to_bits()));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *sides.entry(if from < to { [from, to] } else { [to, from] }).or_default() += 1;
        }
    }
    sides.values().all(|count| *count == 2)
}
