//! Where the polish starts: a coarse grid over roughness and index, whose tables belong to the geometry set.

use super::columns::Point;
use super::geometry_set::GeometrySet;
use super::samples::Samples;

/// The best nodes of the grid that differ in roughness, among those with a specular amplitude, for the first emission
/// value of the samples: as many as the set's effort has starts, the best one first.
#[inline(always)]
pub(super) fn starts(set: &GeometrySet, samples: &Samples) -> Vec<Point> {
    let grid = &set.grid;
    let mut chosen = vec![(f64::INFINITY, 0_usize); grid.roughness.len()];
    let mut sums = Vec::with_capacity(set.segments.len());
    for index_node in 0..grid.index_minus_one.len() {
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
    let mut nodes: Vec<usize> = (0..chosen.len()).filter(|&node| chosen[node].0.is_finite()).collect();
    nodes.sort_by(|&a, &b| chosen[a].0.total_cmp(&chosen[b].0));
    nodes.truncate(set.effort.starts);
    let point = |node: usize| [grid.roughness[node], grid.index_minus_one[chosen[node].1]].map(f64::ln);
    nodes.into_iter().map(|node| Point { log: point(node) }).collect()
}

/// Per segment the inner products of F G/den at an index node with itself, the diffuse column and the data.
#[inline(always)]
fn segment_sums(set: &GeometrySet, samples: &Samples, index_node: usize, into: &mut Vec<[f64; 3]>) {
    let specular = set.grid.specular.row(index_node);
    let sample = samples.sample(0);
    into.clear();
    for segment in &set.segments {
        let (mut ff, mut f1, mut fy) = (0.0, 0.0, 0.0);
        for point in segment.start..segment.end {
            let f = specular[point];
            let weighted = sample.weight[point] * f;
            ff += weighted * f;
            f1 += weighted * sample.diffuse[point];
            fy += sample.weighted_value[point] * f;
        }
        into.push([ff, f1, fy]);
    }
}
