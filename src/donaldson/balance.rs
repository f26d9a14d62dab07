//! What comes out over what falls in, for each excitation: as a diffuser would radiate it, which is what a radiance factor
//! compares with. Neither photons nor energy are made.

use super::Matrix;
use super::matrix::steps;

/// Out over in, with its standard uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Out over in.
    pub value: f64,
    /// Its standard uncertainty; from independent errors where the matrix states them, else with what the errors of a row have in common.
    pub sigma: f64,
}

/// The balance of one excitation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// The excitation, nm.
    pub excitation_nm: f64,
    /// Luminescent photons over photons that fell in.
    pub photons: Share,
    /// Luminescent energy over energy that fell in.
    pub luminescent_energy: Share,
    /// Luminescent and reflected energy over energy that fell in; without the reflected part where it is not known.
    pub energy: Share,
}

/// The balance of each excitation: the luminescence \[excitation, emission\] with its uncertainty, over the widths that it holds,
/// times the steps of the emission axis, and the reflectance at the excitation; `together` is how much larger the uncertainty of a sum is
/// than that of independent errors. With photons, each cell times emission over
/// excitation wavelength; values are taken as energy.
pub(super) fn balance(
    matrix: &Matrix,
    luminescent: impl Fn(usize, usize) -> (f64, f64),
    together: f64,
    reflectance: impl Fn(f64) -> Option<(f64, f64)>,
) -> Vec<Balance> {
    let (steps, widths) = (steps(&matrix.emission_nm), matrix.emission_width_nm());
    let of = |row: usize| {
        let excited = matrix.excitation_nm[row];
        let sum = |power: i32| {
            let (mut value, mut variance) = (0.0, 0.0);
            for (column, emitted) in matrix.emission_nm.iter().enumerate() {
                let (cell, sigma) = luminescent(row, column);
                let weight = steps[column] / widths[column] * (emitted / excited).powi(power);
                if cell.is_finite() {
                    value += cell * weight;
                    variance += (sigma * weight).powi(2);
                }
            }
            Share { value, sigma: together * variance.sqrt() }
        };
        let (photons, luminescent_energy) = (sum(1), sum(0));
        let (reflected, reflected_sigma) = reflectance(excited).unwrap_or((0.0, 0.0));
        let energy = Share {
            value: luminescent_energy.value + reflected,
            sigma: luminescent_energy.sigma.hypot(reflected_sigma),
        };
        Balance { excitation_nm: excited, photons, luminescent_energy, energy }
    };
    (0..matrix.excitation_nm.len()).map(of).collect()
}
