//! Draws from a normal distribution inside of linear bounds, exact: paths that turn in phase space and bounce off the bounds
//! (Pakman and Paninski, J. Comput. Graph. Stat. 23 (2014) 518). No step size, nothing rejected.

use nalgebra::{DMatrix, DVector};

use super::random::Random;

/// A path that has bounced so often ends there: bounds so tight that it would go on for ever.
const BOUNCES: usize = 2000;

/// A normal distribution of mean `m` and curvature `A` where every row of `bounds` times z plus `offset` is at least 0.
pub(super) struct Truncated {
    mean: DVector<f64>,
    /// L of A = L L'.
    factor: DMatrix<f64>,
    /// The bounds for u = L'(z - m), and their squared lengths.
    walls: DMatrix<f64>,
    lengths: DVector<f64>,
    offset: DVector<f64>,
    at: DVector<f64>,
}

impl Truncated {
    /// Starts at a point inside the bounds; `None` where the curvature is not positive definite.
    pub(super) fn new(
        curvature: &DMatrix<f64>,
        gradient: &DVector<f64>,
        bounds: &DMatrix<f64>,
        offset: &DVector<f64>,
        start: &DVector<f64>,
    ) -> Option<Self> {
        let solver = curvature.clone().cholesky()?;
        let mean = solver.solve(gradient);
        let factor = solver.l();
        // bounds z + offset = bounds L^-T u + (bounds m + offset).
        let walls = factor.solve_lower_triangular(&bounds.transpose())?.transpose();
        let lengths = DVector::from_iterator(walls.nrows(), walls.row_iter().map(|row| row.norm_squared()));
        let at = factor.tr_mul(&(start - &mean));
        let offset = bounds * &mean + offset;
        Some(Self { mean, factor, walls, lengths, offset, at })
    }

    /// The next draw.
    pub(super) fn draw(&mut self, random: &mut Random) -> DVector<f64> {
        let mut speed = DVector::from_fn(self.at.len(), |_, _| random.normal());
        let mut left = std::f64::consts::FRAC_PI_2;
        let mut last = None;
        for _ in 0..BOUNCES {
            let (time, wall) = self.next_wall(&speed, last);
            let step = time.min(left);
            let (sin, cos) = step.sin_cos();
            let at = &self.at * cos + &speed * sin;
            speed = speed * cos - &self.at * sin;
            self.at = at;
            if time >= left {
                break;
            }
            left -= time;
            last = Some(wall);
            let toward = self.walls.row(wall).transpose();
            let reflect = 2.0 * toward.dot(&speed) / self.lengths[wall];
            speed.axpy(-reflect, &toward, 1.0);
        }
        // Rounding alone can have left it outside.
        let back = self.factor.tr_solve_lower_triangular(&self.at).unwrap_or_else(|| DVector::zeros(self.at.len()));
        &self.mean + back
    }

    /// When a wall is reached, and which: b cos t + a sin t falls to -c.
    fn next_wall(&self, speed: &DVector<f64>, last: Option<usize>) -> (f64, usize) {
        let (a, b) = (&self.walls * speed, &self.walls * &self.at);
        let mut first = (f64::INFINITY, 0);
        for wall in 0..self.offset.len() {
            let amplitude = a[wall].hypot(b[wall]);
            let cosine = -self.offset[wall] / amplitude;
            if cosine.is_nan() || cosine.abs() >= 1.0 {
                continue;
            }
            let time = (cosine.acos() - (-a[wall]).atan2(b[wall])).rem_euclid(std::f64::consts::TAU);
            // It has just left this one.
            let is_left = last == Some(wall) && !(1e-9..=std::f64::consts::TAU - 1e-9).contains(&time);
            if time < first.0 && !is_left {
                first = (time, wall);
            }
        }
        first
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_spreads_are_those_of_the_cut_distribution() {
        // Correlated by 0.9, the peak outside: compared with a fine sum over the quadrant.
        let curvature = DMatrix::from_row_slice(2, 2, &[200.0, 180.0, 180.0, 200.0]);
        let mean = DVector::from_vec(vec![-0.05, 0.2]);
        let gradient = &curvature * &mean;
        let (mut mass, mut first, mut second) = (0.0, [0.0; 2], [0.0; 2]);
        for i in 0..1000 {
            for j in 0..1000 {
                let z = DVector::from_vec(vec![(f64::from(i) + 0.5) * 6e-4, (f64::from(j) + 0.5) * 6e-4]);
                let away = &z - &mean;
                let weight = (-0.5 * away.dot(&(&curvature * &away))).exp();
                mass += weight;
                for k in 0..2 {
                    first[k] += weight * z[k];
                    second[k] += weight * z[k] * z[k];
                }
            }
        }
        let start = DVector::from_vec(vec![0.1, 0.1]);
        let bounds = DMatrix::identity(2, 2);
        let mut draws = Truncated::new(&curvature, &gradient, &bounds, &DVector::zeros(2), &start).unwrap();
        let mut random = Random::new(4);
        let count = 40_000;
        let (mut mean, mut square) = ([0.0; 2], [0.0; 2]);
        for _ in 0..count {
            let z = draws.draw(&mut random);
            for k in 0..2 {
                assert!(z[k] > -1e-12);
                mean[k] += z[k] / f64::from(count);
                square[k] += z[k] * z[k] / f64::from(count);
            }
        }
        for k in 0..2 {
            let expected = first[k] / mass;
            let spread = (second[k] / mass - expected * expected).sqrt();
            assert!((mean[k] - expected).abs() < 0.03 * spread, "{k}: {} {expected}", mean[k]);
            let found = (square[k] - mean[k] * mean[k]).sqrt();
            assert!((found / spread - 1.0).abs() < 0.03, "{k}: {found} {spread}");
        }
    }
}
