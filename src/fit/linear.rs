//! The linear part: non-negative amplitudes of at most two columns, from their Gram matrix.

use super::curvature::Held;

/// Inner products of the diffuse column (1), the specular column (2) and the data (y), each weighted with 1/sigma^2.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gram {
    pub(super) s11: f64,
    pub(super) s12: f64,
    pub(super) s22: f64,
    pub(super) s1y: f64,
    pub(super) s2y: f64,
    pub(super) syy: f64,
}

/// Amplitudes with the chi-square they leave.
#[derive(Debug, Clone, Copy)]
pub(super) struct Amplitudes {
    pub(super) diffuse: f64,
    pub(super) specular: f64,
    pub(super) chi_square: f64,
}

impl Gram {
    #[inline(always)]
    /// The non-negative amplitudes of least chi-square. A column without weight gets 0.
    pub(super) fn solve(&self) -> Amplitudes {
        let determinant = self.s11 * self.s22 - self.s12 * self.s12;
        // Columns that agree to rounding have no amplitudes of their own; then one of them carries both.
        if determinant > 1e-15 * self.s11 * self.s22 {
            let diffuse = (self.s22 * self.s1y - self.s12 * self.s2y) / determinant;
            let specular = (self.s11 * self.s2y - self.s12 * self.s1y) / determinant;
            if diffuse >= 0.0 && specular >= 0.0 {
                return self.amplitudes(diffuse, specular);
            }
        }
        let alone = |sy: f64, s: f64| if s > 0.0 { (sy / s).max(0.0) } else { 0.0 };
        let first = self.amplitudes(alone(self.s1y, self.s11), 0.0);
        let second = self.amplitudes(0.0, alone(self.s2y, self.s22));
        if second.chi_square < first.chi_square { second } else { first }
    }

    /// The same with one amplitude held at a value.
    #[inline(always)]
    pub(super) fn solve_held(&self, held: Held) -> Amplitudes {
        let alone = |sy: f64, s: f64| if s > 0.0 { (sy / s).max(0.0) } else { 0.0 };
        match held {
            Held::Nothing => self.solve(),
            Held::Diffuse(diffuse) => self.amplitudes(diffuse, alone(self.s2y - diffuse * self.s12, self.s22)),
            Held::Specular(specular) => self.amplitudes(alone(self.s1y - specular * self.s12, self.s11), specular),
        }
    }

    #[inline(always)]
    pub(super) fn amplitudes(&self, diffuse: f64, specular: f64) -> Amplitudes {
        let linear = diffuse * self.s1y + specular * self.s2y;
        let quadratic =
            diffuse * diffuse * self.s11 + 2.0 * diffuse * specular * self.s12 + specular * specular * self.s22;
        Amplitudes { diffuse, specular, chi_square: self.syy - 2.0 * linear + quadratic }
    }

    /// Rounding error of a chi-square formed from these sums: what is below it means nothing.
    pub(super) fn noise(&self) -> f64 {
        4.0 * f64::EPSILON * self.syy
    }
}
