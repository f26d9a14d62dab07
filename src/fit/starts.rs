//! Where the polish starts: a coarse grid over roughness and index, whose tables belong to the geometry set.

use super::columns::Point;
use super::geometry_set::{GeometrySet, INDEX_NODES, ROUGHNESS_NODES};
use super::samples::Samples;

/// The best node of the grid and the best with another roughness, among those with a specular amplitude, for the first
/// emission value of the samples.
#[inline(always)]
pub(super) fn starts(set: &GeometrySet, samples: &Samples) -> [Option<Point>; 2] {
    let grid = &set.grid;
    let mut chosen = [(f64::INFINITY, 0_usize); ROUGHNESS_NODES];
    let mut sums = Vec::with_capacity(set.segments.len());
    for index_node in 0..INDEX_NODES.len() {
        segment_sums(set, samples, index_node, &mut sums);
        for (best, distribution) in chosen.iter_mut().zip(grid.distribution.rows()) {
            let mut gram = samples.gram[0];
            for (&d, &[ff, f1, fy]) in distribution.iter().zip(&sums) {
                gram.s22 += d * d * ff;
                gram.s12 += d * f1;
                gram.s2y += d * fy;
            }
            let amplitudes = gram.solve();
            if amplitudes.specular > 0.0 && amplitudes.chi_square < best.0 {
                *best = (amplitudes.chi_square, index_node);
            }
        }
    }
    let point = |node: usize| {
        let (chi_square, index_node) = chosen[node];
        chi_square.is_finite().then(|| Point { log: [grid.roughness[node].ln(), INDEX_NODES[index_node].ln()] })
    };
    let best_but = |other: Option<usize>| {
        let nodes = (0..ROUGHNESS_NODES).filter(|&node| Some(node) != other);
        nodes.min_by(|&a, &b| chosen[a].0.total_cmp(&chosen[b].0))
    };
    let first = best_but(None);
    [first.and_then(point), best_but(first).and_then(point)]
}

/// Per segment the inner products of F G/den at an index node with itself, the diffuse column and the data.
#[inline(always)]
fn segment_sums(set: &GeometrySet, samples: &Samples, index_node: usize, into: &mut Vec<[f64; 3]>) {
    let specular = set.grid.specular.row(index_node);
    let sample = samples.sample(0);
    into.clear();
    for segment in &set.segments {
        let mut sums = [0.0; 3];
        for point in segment.start..segment.end {
            let f = specular[point];
            sums[0] += sample.weight[point] * f * f;
            sums[1] += sample.weighted_diffuse[point] * f;
            sums[2] += sample.weighted_value[point] * f;
        }
        into.push(sums);
    }
}
