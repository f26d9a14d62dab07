//! The specular term's columns at a point of the reduced problem.

use super::geometry_set::GeometrySet;
use crate::terms::fresnel;

/// A point of the reduced problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// \[ln r, ln(n - 1)\].
    pub(super) log: [f64; 2],
}

impl Point {
    pub(super) fn roughness(&self) -> f64 {
        self.log[0].exp()
    }

    pub(super) fn index_minus_one(&self) -> f64 {
        self.log[1].exp()
    }
}

/// D F G over the denominator without its amplitude, and its derivatives by ln r and ln(n - 1), per sorted and padded
/// point.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns {
    pub(super) specular: Vec<f64>,
    pub(super) by_r: Vec<f64>,
    pub(super) by_m: Vec<f64>,
    fresnel: Vec<(f64, f64)>,
}

impl Columns {
    #[inline(always)]
    pub(super) fn update(&mut self, set: &GeometrySet, point: &Point) {
        let (roughness, m) = (point.roughness(), point.index_minus_one());
        self.fresnel.clear();
        for half in &set.halves {
            let value = fresnel(half, m);
            self.fresnel.push((value.value, value.by_index * m));
        }
        for column in [&mut self.specular, &mut self.by_r, &mut self.by_m] {
            column.resize(set.points(), 0.0);
        }
        let lobe = set.distribution.lobe(roughness);
        for segment in &set.segments {
            let d = lobe.evaluate(&segment.half);
            let range = segment.start..segment.end;
            let points = set.masked[range.clone()].iter().zip(&set.half_of[range.clone()]);
            let columns =
                self.specular[range.clone()].iter_mut().zip(&mut self.by_r[range.clone()]).zip(&mut self.by_m[range]);
            for ((masked, &half), ((specular, by_r), by_m)) in points.zip(columns) {
                let (value, by_index) = self.fresnel[half as usize];
                let factor = masked * value;
                *specular = d.value * factor;
                *by_r = d.by_log_roughness * factor;
                *by_m = d.value * (masked * by_index);
            }
        }
    }
}
