//! Triangles, found through a tree of boxes.
//!
//! The tree is our own because the maintained ones count in single precision or ask for another version of the linear algebra; its boxes
//! are split at the median of the longest side.

use std::collections::HashMap;

use super::{Meeting, Ray, Start};
use crate::simulate::vector::{Vector, along, cross, dot, length, minus, plus, scaled, unit};

/// Triangles in a leaf.
const LEAF: usize = 4;
/// Triangles of which it is proven that they are convex: the proof takes triangles times corners.
const PROVEN: usize = 2000;

/// Triangles with their tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    around: (Vector, f64),
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
    corner: Vector,
    sides: [Vector; 2],
    normal: Vector,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    low: Vector,
    high: Vector,
    /// First triangle and how many, or 0 and the node of the second half; the first half is the next node.
    first: usize,
    count: usize,
    second: usize,
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
        let mut named = Vec::with_capacity(triangles.len());
        for (triangle, at) in triangles.iter().enumerate() {
            if let Some(corner) = at.iter().find(|corner| **corner >= corners.len()) {
                return Err(NoMesh::Corner { triangle, corner: *corner, corners: corners.len() });
            }
            let [a, b, c] = at.map(|corner| corners[corner]);
            let sides = [minus(b, a), minus(c, a)];
            if let Some(normal) = unit(cross(sides[0], sides[1])) {
                all.push(Triangle { corner: a, sides, normal });
                named.push([a, b, c]);
            }
        }
        if all.is_empty() {
            return Err(NoMesh::Empty);
        }
        let (low, high) = ends(&all);
        let centre = scaled(plus(low, high), 0.5);
        let used = all.iter().flat_map(Triangle::corners);
        let radius = used.map(|at| length(minus(at, centre))).fold(0.0, f64::max);
        let is_closed = all.len() <= PROVEN && is_closed(&named);
        // An open bowl sees itself from within; what is flat does not.
        let is_convex =
            all.len() <= PROVEN && is_below(&all, radius, 1.0) && (is_closed || is_below(&all, radius, -1.0));
        let mut nodes = Vec::new();
        let count = all.len();
        split(&mut all, 0, count, &mut nodes);
        Ok(Self { triangles: all, nodes, around: (centre, radius), is_convex, is_closed })
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
        let inverse = ray.towards.map(|speed| 1.0 / speed);
        // What starts on a triangle meets its neighbours no nearer than this.
        let least = if own.is_some() { 1e-12 * self.around.1 } else { 0.0 };
        let (mut found, mut nearest) = (None, limit);
        let mut waiting = [0_usize; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let at = waiting[depth];
            let node = &self.nodes[at];
            if !node.is_met(ray.from, inverse, nearest) {
                continue;
            }
            if node.count == 0 {
                waiting[depth] = node.second;
                waiting[depth + 1] = at + 1;
                depth += 2;
                continue;
            }
            for part in node.first..node.first + node.count {
                if own.is_some_and(|start| start.part == part) {
                    continue;
                }
                if let Some(distance) = self.triangles[part].meet(ray).filter(|t| *t > least && *t < nearest) {
                    nearest = distance;
                    found = Some(Meeting { distance, outward: self.triangles[part].normal, part });
                }
            }
        }
        found
    }
}

impl Piece {
    fn of(triangles: &[Triangle]) -> Self {
        let (low, high) = ends(triangles);
        let centre = scaled(plus(low, high), 0.5);
        let far = triangles.iter().flat_map(Triangle::corners).map(|at| length(minus(at, centre)));
        let twice = |one: &Triangle| length(cross(one.sides[0], one.sides[1]));
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
        let half = self.sides.map(|side| scaled(side, 0.5));
        let of = |corner: Vector| Self { corner, sides: half, normal: self.normal };
        let across = plus(plus(self.corner, half[0]), half[1]);
        let middle = Self { corner: across, sides: half.map(|side| scaled(side, -1.0)), normal: self.normal };
        [of(self.corner), of(plus(self.corner, half[0])), of(plus(self.corner, half[1])), middle]
    }

    fn corners(&self) -> [Vector; 3] {
        [self.corner, plus(self.corner, self.sides[0]), plus(self.corner, self.sides[1])]
    }

    fn middle(&self) -> Vector {
        along(along(self.corner, self.sides[0], 1.0 / 3.0), self.sides[1], 1.0 / 3.0)
    }

    /// Möller and Trumbore 1997.
    fn meet(&self, ray: &Ray) -> Option<f64> {
        let across = cross(ray.towards, self.sides[1]);
        let determinant = dot(self.sides[0], across);
        if determinant == 0.0 {
            return None;
        }
        let inverse = 1.0 / determinant;
        let from = minus(ray.from, self.corner);
        let u = dot(from, across) * inverse;
        let other = cross(from, self.sides[0]);
        let v = dot(ray.towards, other) * inverse;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| dot(self.sides[1], other) * inverse)
    }
}

impl Node {
    #[inline]
    fn is_met(&self, from: Vector, inverse: Vector, limit: f64) -> bool {
        let (mut enter, mut leave) = (0.0_f64, limit);
        for k in 0..3 {
            let (a, b) = ((self.low[k] - from[k]) * inverse[k], (self.high[k] - from[k]) * inverse[k]);
            // Of a number and none, min and max take the number: a ray in the plane of a side is not lost.
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave * (1.0 + 1e-12)
    }
}

fn ends(triangles: &[Triangle]) -> (Vector, Vector) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for at in triangles.iter().flat_map(Triangle::corners) {
        for k in 0..3 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    (low, high)
}

fn split(all: &mut [Triangle], first: usize, last: usize, nodes: &mut Vec<Node>) {
    let (low, high) = ends(&all[first..last]);
    let at = nodes.len();
    nodes.push(Node { low, high, first, count: last - first, second: 0 });
    if last - first <= LEAF {
        return;
    }
    let size = minus(high, low);
    let side = (0..3).fold(0, |most, k| if size[k] > size[most] { k } else { most });
    let middle = (first + last) / 2;
    all[first..last].select_nth_unstable_by(middle - first, |a, b| a.middle()[side].total_cmp(&b.middle()[side]));
    split(all, first, middle, nodes);
    let second = nodes.len();
    split(all, middle, last, nodes);
    nodes[at].count = 0;
    nodes[at].second = second;
}

/// True where no corner lies above any triangle, on the side of its normal or on the other: normals point outwards.
fn is_below(triangles: &[Triangle], size: f64, sign: f64) -> bool {
    let corners: Vec<Vector> = triangles.iter().flat_map(Triangle::corners).collect();
    triangles.iter().all(|triangle| {
        corners.iter().all(|at| sign * dot(triangle.normal, minus(*at, triangle.corner)) <= 1e-12 * size)
    })
}

fn is_closed(triangles: &[[Vector; 3]]) -> bool {
    let mut sides: HashMap<[[u64; 3]; 2], usize> = HashMap::new();
    for corners in triangles {
        // 0 and -0 are one place.
        let [a, b, c] = corners.map(|at| at.map(|x| (x + 0.0).to_bits()));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *sides.entry(if from < to { [from, to] } else { [to, from] }).or_default() += 1;
        }
    }
    sides.values().all(|count| *count == 2)
}
