//! One evaluation of the reduced problem: amplitudes, chi-square, gradient and curvature in ln r and ln(n-1).
//!
//! The amplitudes are eliminated one after the other: first the diffuse one of each emission value, then the specular
//! one, of each emission value or common to all.

use super::descent::Slope;
use super::linear::{Amplitudes, Gram};
use super::products::Products;

/// What the emission values of one fit have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Share {
    /// Roughness and index.
    #[default]
    Shape,
    /// Roughness, index and the amplitude of the specular term.
    ShapeAndIntensity,
}

/// An amplitude that is held at a value while the others are fitted: a point of its profile.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Held {
    /// None.
    #[default]
    Nothing,
    /// The diffuse one.
    Diffuse(f64),
    /// The specular one.
    Specular(f64),
}

/// Half the chi-square's gradient and Gauss-Newton curvature (Kaufman's form), summed over bands.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Curvature {
    pub(super) chi_square: f64,
    pub(super) gradient: [f64; 2],
    pub(super) hessian: [[f64; 2]; 2],
    /// Rounding error of the chi-square.
    pub(super) noise: f64,
}

/// Inner products of the specular column, its derivatives and the data, without their parts along a diffuse column.
#[derive(Debug, Clone, Copy, Default)]
struct Left {
    ss: f64,
    sr: f64,
    sm: f64,
    sy: f64,
    rr: f64,
    rm: f64,
    mm: f64,
    ry: f64,
    my: f64,
}

impl Left {
    /// What the diffuse column leaves; all of it where its amplitude is not free but `diffuse`.
    #[inline(always)]
    fn of(p: &Products, free: bool, diffuse: f64) -> Self {
        let k = if free { p.gram.s11.recip() } else { 0.0 };
        let fixed = if free { 0.0 } else { diffuse };
        let (s1, y1) = (p.gram.s12, p.gram.s1y);
        Self {
            ss: p.gram.s22 - k * s1 * s1,
            sr: p.r2 - k * p.r1 * s1,
            sm: p.m2 - k * p.m1 * s1,
            sy: p.gram.s2y - k * s1 * y1 - fixed * s1,
            rr: p.rr - k * p.r1 * p.r1,
            rm: p.rm - k * p.r1 * p.m1,
            mm: p.mm - k * p.m1 * p.m1,
            ry: p.ry - k * p.r1 * y1 - fixed * p.r1,
            my: p.my - k * p.m1 * y1 - fixed * p.m1,
        }
    }

    fn add(&mut self, other: &Self) {
        self.ss += other.ss;
        self.sr += other.sr;
        self.sm += other.sm;
        self.sy += other.sy;
        self.rr += other.rr;
        self.rm += other.rm;
        self.mm += other.mm;
        self.ry += other.ry;
        self.my += other.my;
    }

    /// Adds the curvature that is left beside a specular amplitude, which is free or not.
    #[inline(always)]
    fn into_curvature(self, amplitude: f64, free: bool, sum: &mut Curvature) {
        let (s, square) = (amplitude, amplitude * amplitude);
        let k = if free { self.ss.recip() } else { 0.0 };
        let rm = square * (self.rm - k * self.sr * self.sm);
        sum.hessian[0][0] += square * (self.rr - k * self.sr * self.sr).max(0.0);
        sum.hessian[1][1] += square * (self.mm - k * self.sm * self.sm).max(0.0);
        sum.hessian[0][1] += rm;
        sum.hessian[1][0] += rm;
        sum.gradient[0] -= s * (self.ry - s * self.sr);
        sum.gradient[1] -= s * (self.my - s * self.sm);
    }
}

/// Evaluates the reduced problem from its inner products.
#[inline(always)]
pub(super) fn curvature(bands: &[Products], share: Share, held: Held) -> Curvature {
    let mut sum = Curvature::default();
    if share == Share::ShapeAndIntensity && bands.len() > 1 {
        let amplitudes = common_intensity(bands.iter().map(|band| band.gram));
        let mut left = Left::default();
        for (band, amplitudes) in bands.iter().zip(&amplitudes) {
            left.add(&Left::of(band, amplitudes.diffuse > 0.0, 0.0));
            sum.chi_square += amplitudes.chi_square;
            sum.noise += band.gram.noise();
        }
        let specular = amplitudes.first().map_or(0.0, |amplitudes| amplitudes.specular);
        if specular > 0.0 {
            left.into_curvature(specular, true, &mut sum);
        }
        return sum;
    }
    for band in bands {
        let amplitudes = band.gram.solve_held(held);
        sum.chi_square += amplitudes.chi_square;
        sum.noise += band.gram.noise();
        if amplitudes.specular > 0.0 {
            let diffuse_free = !matches!(held, Held::Diffuse(_)) && amplitudes.diffuse > 0.0;
            let left = Left::of(band, diffuse_free, amplitudes.diffuse);
            left.into_curvature(amplitudes.specular, !matches!(held, Held::Specular(_)), &mut sum);
        }
    }
    sum
}

/// The amplitudes of each emission value.
pub(super) fn amplitudes(grams: &[Gram], share: Share) -> Vec<Amplitudes> {
    match share {
        Share::ShapeAndIntensity if grams.len() > 1 => common_intensity(grams.iter().copied()),
        _ => grams.iter().map(Gram::solve).collect(),
    }
}

/// Non-negative amplitudes with one specular amplitude for all. A diffuse amplitude that would be negative is held at 0
/// and the others are solved again; each round holds one more, or ends.
fn common_intensity(grams: impl Iterator<Item = Gram> + Clone) -> Vec<Amplitudes> {
    let mut free: Vec<bool> = grams.clone().map(|gram| gram.s11 > 0.0).collect();
    loop {
        let (mut ss, mut sy) = (0.0, 0.0);
        for (gram, &free) in grams.clone().zip(&free) {
            let k = if free { gram.s12 / gram.s11 } else { 0.0 };
            ss += gram.s22 - k * gram.s12;
            sy += gram.s2y - k * gram.s1y;
        }
        let specular = if ss > 0.0 { (sy / ss).max(0.0) } else { 0.0 };
        let diffuse = |gram: &Gram| (gram.s1y - specular * gram.s12) / gram.s11;
        let mut changed = false;
        for (gram, free) in grams.clone().zip(&mut free) {
            if *free && diffuse(&gram) < 0.0 {
                (*free, changed) = (false, true);
            }
        }
        if !changed {
            let of = |(gram, free): (Gram, &bool)| gram.amplitudes(if *free { diffuse(&gram) } else { 0.0 }, specular);
            return grams.zip(&free).map(of).collect();
        }
    }
}

impl Slope for Curvature {
    fn gradient(&self) -> &[f64] {
        &self.gradient
    }

    fn step(&self, pinned: &[Option<f64>], damping: f64, step: &mut [f64]) {
        let ([[a, b], [_, c]], [g, h]) = (self.hessian, self.gradient);
        let (a, c) = (a * (1.0 + damping), c * (1.0 + damping));
        let determinant = a * c - b * b;
        let alone = |curvature: f64, gradient: f64| if curvature > 0.0 { -gradient / curvature } else { 0.0 };
        let [first, second] = match [pinned[0], pinned[1]] {
            [None, None] if determinant > 1e-14 * a * c => {
                [(b * h - c * g) / determinant, (b * g - a * h) / determinant]
            }
            // Columns that agree to rounding: each goes its own way, and the loop sees whether that is down.
            [None, None] => [alone(a, g), alone(c, h)],
            [None, Some(second)] => [alone(a, g + b * second), second],
            [Some(first), None] => [first, alone(c, h + b * first)],
            [Some(first), Some(second)] => [first, second],
        };
        step[0] = first;
        step[1] = second;
    }

    fn decrease(&self, step: &[f64]) -> f64 {
        let ([[a, b], [_, c]], [g, h]) = (self.hessian, self.gradient);
        let (x, y) = (step[0], step[1]);
        -(2.0 * (g * x + h * y) + a * x * x + 2.0 * b * x * y + c * y * y)
    }
}
