//! What a surface sends out under many incident spectra at once, one per pixel: a product of matrices.
//!
//! One incident spectrum needs no more than three numbers per term ([`super::convex`]); this is for scenes where each pixel has its
//! own, as between surfaces that light each other. Products and sums are rounded one by one and in the order of the excitations, so
//! that neither the processor nor the threads change a bit.
#![allow(clippy::needless_range_loop, reason = "a lane is an index into several arrays, and is told to be one")]

use ndarray::{ArrayView2, LinalgScalar};
use rayon::prelude::*;

/// Pixels that one task takes.
const PIXELS_AT_ONCE: usize = 1024;
/// Pixels and bytes of emission whose sums stay in registers.
const ROWS: usize = 4;
const BYTES: usize = 64;

/// Spectra that do not fit the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "{incident} incident and {out} outgoing numbers for a matrix of {excitation} excitations x {emission} emissions; expected as many \
     whole spectra of each, and a matrix that is not empty"
)]
pub struct NoProduct {
    /// Incident numbers.
    pub incident: usize,
    /// Outgoing ones.
    pub out: usize,
    /// Rows of the matrix.
    pub excitation: usize,
    /// Columns of the matrix.
    pub emission: usize,
}

/// Writes `incident`, pixel after pixel, times `matrix` \[excitation, emission\] to `out`, pixel after pixel, in the precision of the
/// numbers and on the threads of the current `rayon` pool. The matrix holds the width of each excitation.
///
/// # Errors
/// [`NoProduct`] where the three do not fit; `out` is then as it was.
pub fn reradiate<A>(incident: &[A], matrix: ArrayView2<A>, out: &mut [A]) -> Result<(), NoProduct>
where
    A: LinalgScalar + Send + Sync,
{
    let (excitation, emission) = matrix.dim();
    let refused = NoProduct { incident: incident.len(), out: out.len(), excitation, emission };
    if excitation == 0
        || emission == 0
        || !incident.len().is_multiple_of(excitation)
        || !out.len().is_multiple_of(emission)
    {
        return Err(refused);
    }
    if incident.len() / excitation != out.len() / emission {
        return Err(refused);
    }
    // A compiler makes vectors of a number of lanes that it knows.
    if size_of::<A>() <= 4 {
        shared::<A, { BYTES / 4 }>(incident, matrix, out)
    } else {
        shared::<A, { BYTES / 8 }>(incident, matrix, out)
    }
    Ok(())
}

fn shared<A: LinalgScalar + Send + Sync, const N: usize>(incident: &[A], matrix: ArrayView2<A>, out: &mut [A]) {
    let (excitation, emission) = matrix.dim();
    // Columns in groups, each with its rows one after another; what is missing of the last is 0.
    let panels: Vec<[A; N]> = (0..emission.div_ceil(N))
        .flat_map(|panel| (0..excitation).map(move |row| (panel * N, row)))
        .map(|(first, row)| std::array::from_fn(|lane| matrix.get([row, first + lane]).copied().unwrap_or(A::zero())))
        .collect();
    let arch = pulp::Arch::new();
    let tasks = out.par_chunks_mut(PIXELS_AT_ONCE * emission).zip(incident.par_chunks(PIXELS_AT_ONCE * excitation));
    tasks.for_each(|(out, incident)| {
        arch.dispatch(Task { incident, panels: &panels, excitation, emission, out });
    });
}

struct Task<'a, A, const N: usize> {
    incident: &'a [A],
    panels: &'a [[A; N]],
    excitation: usize,
    emission: usize,
    out: &'a mut [A],
}

impl<A: LinalgScalar, const N: usize> pulp::WithSimd for Task<'_, A, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let spectra = self.incident.chunks(ROWS * self.excitation);
        for (out, spectra) in self.out.chunks_mut(ROWS * self.emission).zip(spectra) {
            for (panel, matrix) in self.panels.chunks_exact(self.excitation).enumerate() {
                let first = panel * N;
                let count = N.min(self.emission - first);
                if spectra.len() == ROWS * self.excitation {
                    let sums = product::<A, N, ROWS>(spectra, matrix);
                    for (out, sums) in out.chunks_exact_mut(self.emission).zip(&sums) {
                        out[first..first + count].copy_from_slice(&sums[..count]);
                    }
                } else {
                    for (out, spectrum) in
                        out.chunks_exact_mut(self.emission).zip(spectra.chunks_exact(self.excitation))
                    {
                        let [sums] = product::<A, N, 1>(spectrum, matrix);
                        out[first..first + count].copy_from_slice(&sums[..count]);
                    }
                }
            }
        }
    }
}

/// Some spectra times one group of columns.
#[inline(always)]
fn product<A: LinalgScalar, const N: usize, const R: usize>(spectra: &[A], matrix: &[[A; N]]) -> [[A; N]; R] {
    let mut sums = [[A::zero(); N]; R];
    let spectra: [&[A]; R] = std::array::from_fn(|row| &spectra[row * matrix.len()..(row + 1) * matrix.len()]);
    for (k, columns) in matrix.iter().enumerate() {
        for row in 0..R {
            let incident = spectra[row][k];
            for lane in 0..N {
                sums[row][lane] = sums[row][lane] + incident * columns[lane];
            }
        }
    }
    sums
}
