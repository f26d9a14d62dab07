//! A tree of boxes over what has an end: triangles of a mesh, bodies of a scene.
//!
//! It is our own because the maintained ones count in single precision or ask for another version of the linear algebra; its boxes
//! are split at the median of the longest side.

use std::ops::Range;

use super::Ray;
use crate::simulate::vector::{Vector, minus};

/// How many in a leaf.
const LEAF: usize = 4;

/// Boxes within boxes.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::simulate) struct Tree {
    nodes: Vec<Node>,
    /// By so much boxes are met that are not.
    near: f64,
}

/// What a tree holds, by its number.
#[derive(Debug, Clone, Copy)]
pub(in crate::simulate) struct Item {
    pub(in crate::simulate) number: usize,
    pub(in crate::simulate) low: Vector,
    pub(in crate::simulate) high: Vector,
    /// By which they are put in order.
    pub(in crate::simulate) middle: Vector,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    low: Vector,
    high: Vector,
    /// The first and how many, or 0 and the node of the second half; the first half is the next node.
    first: usize,
    count: usize,
    second: usize,
}

/// The boxes of the tree as one ray meets them: a little larger than they are, by what the test of what is in them may round.
struct Boxes {
    /// Where the ray starts, moved out of each box on either side of it.
    low: Vector,
    high: Vector,
    inverse: Vector,
}

impl Boxes {
    fn new(ray: &Ray, near: f64) -> Self {
        let slack = near + 16.0 * f64::EPSILON * largest(ray.from);
        let moved = |by: f64| ray.from.map(|x| x + by);
        Self { low: moved(slack), high: moved(-slack), inverse: ray.towards.map(|speed| 1.0 / speed) }
    }

    #[inline]
    fn meet(&self, node: &Node, limit: f64) -> bool {
        let (mut enter, mut leave) = (0.0_f64, limit);
        for k in 0..3 {
            let a = (node.low[k] - self.low[k]) * self.inverse[k];
            let b = (node.high[k] - self.high[k]) * self.inverse[k];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        // Three roundings of either (Ize 2013, Robust BVH ray traversal).
        enter <= leave * (1.0 + 4.0 * f64::EPSILON)
    }
}

impl Tree {
    /// The tree, and the numbers of what it holds in its order.
    pub(in crate::simulate) fn new(mut items: Vec<Item>, near: f64) -> (Self, Vec<usize>) {
        let (mut nodes, count) = (Vec::new(), items.len());
        split(&mut items, 0, count, &mut nodes);
        (Self { nodes, near }, items.into_iter().map(|item| item.number).collect())
    }

    /// Visits what may be met nearer than a limit, as places in the order of the tree; a visit tells the limit from then on.
    #[inline]
    pub(in crate::simulate) fn walk(&self, ray: &Ray, limit: f64, mut visit: impl FnMut(Range<usize>) -> f64) {
        let (boxes, mut limit) = (Boxes::new(ray, self.near), limit);
        let mut waiting = [0_usize; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let at = waiting[depth];
            let node = &self.nodes[at];
            if !boxes.meet(node, limit) {
                continue;
            }
            if node.count == 0 {
                waiting[depth] = node.second;
                waiting[depth + 1] = at + 1;
                depth += 2;
            } else {
                limit = visit(node.first..node.first + node.count);
            }
        }
    }
}

fn split(all: &mut [Item], first: usize, last: usize, nodes: &mut Vec<Node>) {
    let items = &all[first..last];
    let fold = |start: f64, of: fn(f64, f64) -> f64, end: fn(&Item) -> Vector| {
        [0, 1, 2].map(|k| items.iter().map(|item| end(item)[k]).fold(start, of))
    };
    let low = fold(f64::INFINITY, f64::min, |item| item.low);
    let high = fold(f64::NEG_INFINITY, f64::max, |item| item.high);
    let at = nodes.len();
    nodes.push(Node { low, high, first, count: last - first, second: 0 });
    if last - first <= LEAF {
        return;
    }
    let size = minus(high, low);
    let side = (0..3).fold(0, |most, k| if size[k] > size[most] { k } else { most });
    let middle = (first + last) / 2;
    all[first..last].select_nth_unstable_by(middle - first, |a, b| a.middle[side].total_cmp(&b.middle[side]));
    split(all, first, middle, nodes);
    let second = nodes.len();
    split(all, middle, last, nodes);
    nodes[at].count = 0;
    nodes[at].second = second;
}

/// The largest coordinate of a place.
pub(super) fn largest(place: Vector) -> f64 {
    place.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}
