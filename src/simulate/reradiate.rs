//! What a surface sends out under many incident spectra at once, one per pixel: a product of matrices.
//!
//! One incident spectrum needs no more than three numbers per term ([`super::convex`]); this is for scenes where each pixel has its
//! own, as between surfaces that light each other. Sums are made in the order of the excitations, so that threads change no bit; a processor
//! that multiplies and adds in one instruction rounds once and not twice.

use ndarray::{ArrayView2, LinalgScalar};
use pulp::Simd;
use rayon::prelude::*;

/// Pixels that one task takes.
const PIXELS_AT_ONCE: usize = 1024;
/// Pixels whose sums over one or two vectors of emissions stay in registers.
const ROWS: usize = 4;

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

/// A precision that vectors have: f32 or f64.
pub trait Real: LinalgScalar + Send + Sync {
    /// As many numbers as a register holds.
    type Lanes<S: Simd>: Copy + Send + Sync;

    #[doc(hidden)]
    fn splat<S: Simd>(simd: S, value: Self) -> Self::Lanes<S>;
    /// a b + c, in one instruction and with one rounding where the processor has it.
    #[doc(hidden)]
    fn add_product<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>, c: Self::Lanes<S>) -> Self::Lanes<S>;
    #[doc(hidden)]
    fn lanes<S: Simd>(numbers: &[Self]) -> &[Self::Lanes<S>];
    #[doc(hidden)]
    fn numbers<S: Simd>(lanes: &[Self::Lanes<S>]) -> &[Self];
}

macro_rules! real {
    ($type:ty, $lanes:ident, $splat:ident, $fused:ident, $as:ident) => {
        impl Real for $type {
            type Lanes<S: Simd> = S::$lanes;

            #[inline(always)]
            fn splat<S: Simd>(simd: S, value: Self) -> S::$lanes {
                simd.$splat(value)
            }

            #[inline(always)]
            fn add_product<S: Simd>(simd: S, a: S::$lanes, b: S::$lanes, c: S::$lanes) -> S::$lanes {
                simd.$fused(a, b, c)
            }

            #[inline(always)]
            fn lanes<S: Simd>(numbers: &[Self]) -> &[S::$lanes] {
                S::$as(numbers).0
            }

            #[inline(always)]
            fn numbers<S: Simd>(lanes: &[S::$lanes]) -> &[Self] {
                bytemuck::cast_slice(lanes)
            }
        }
    };
}

real!(f64, f64s, splat_f64s, mul_add_e_f64s, as_simd_f64s);
real!(f32, f32s, splat_f32s, mul_add_e_f32s, as_simd_f32s);

/// Writes `incident`, pixel after pixel, times `matrix` \[excitation, emission\] to `out`, pixel after pixel, in the precision of the
/// numbers and on the threads of the current `rayon` pool. The matrix holds the width of each excitation.
///
/// # Errors
/// [`NoProduct`] where the three do not fit; `out` is then as it was.
pub fn reradiate<A: Real>(incident: &[A], matrix: ArrayView2<A>, out: &mut [A]) -> Result<(), NoProduct> {
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
    pulp::Arch::new().dispatch(Product { incident, matrix, out });
    Ok(())
}

struct Product<'a, A> {
    incident: &'a [A],
    matrix: ArrayView2<'a, A>,
    out: &'a mut [A],
}

impl<A: Real> pulp::WithSimd for Product<'_, A> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (excitation, emission) = self.matrix.dim();
        let width = size_of::<A::Lanes<S>>() / size_of::<A>();
        // Columns in groups of a vector, each with its rows one after another; what is missing of the last is 0.
        let mut panels = vec![A::zero(); emission.div_ceil(width) * excitation * width];
        for (panel, numbers) in panels.chunks_exact_mut(excitation * width).enumerate() {
            for (row, numbers) in numbers.chunks_exact_mut(width).enumerate() {
                for (column, number) in (panel * width..emission).zip(numbers) {
                    *number = self.matrix[[row, column]];
                }
            }
        }
        let panels: Vec<&[A::Lanes<S>]> = panels.chunks_exact(excitation * width).map(A::lanes::<S>).collect();
        let outs = self.out.par_chunks_mut(PIXELS_AT_ONCE * emission);
        outs.zip(self.incident.par_chunks(PIXELS_AT_ONCE * excitation)).for_each(|(out, incident)| {
            simd.vectorize(Task { simd, incident, panels: &panels, emission, out });
        });
    }
}

struct Task<'a, S: Simd, A: Real> {
    simd: S,
    incident: &'a [A],
    panels: &'a [&'a [A::Lanes<S>]],
    emission: usize,
    out: &'a mut [A],
}

impl<S: Simd, A: Real> pulp::NullaryFnOnce for Task<'_, S, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (simd, emission, excitation) = (self.simd, self.emission, self.panels[0].len());
        let spectra = self.incident.chunks(ROWS * excitation);
        for (out, spectra) in self.out.chunks_mut(ROWS * emission).zip(spectra) {
            // Where fewer are left the last stands for those that are missing; what it makes of them is not written.
            let last = spectra.len() / excitation - 1;
            let spectra: [&[A]; ROWS] = std::array::from_fn(|row| &spectra[row.min(last) * excitation..][..excitation]);
            let mut first = 0;
            // Two at once make more sums than additions are under way.
            let (pairs, last) = self.panels.as_chunks::<2>();
            for pair in pairs {
                first = write::<S, A, 2>(product(simd, spectra, *pair), first, emission, out);
            }
            for panel in last {
                first = write::<S, A, 1>(product(simd, spectra, [*panel]), first, emission, out);
            }
        }
    }
}

/// Writes the sums of some columns from the first on; the column after them.
#[inline(always)]
fn write<S: Simd, A: Real, const V: usize>(
    sums: [[A::Lanes<S>; V]; ROWS],
    first: usize,
    emission: usize,
    out: &mut [A],
) -> usize {
    let count = V * size_of::<A::Lanes<S>>() / size_of::<A>();
    let last = emission.min(first + count);
    for (out, sums) in out.chunks_exact_mut(emission).zip(&sums) {
        let (out, numbers) = (&mut out[first..last], A::numbers::<S>(sums));
        // Of a length that the compiler knows this is a store or two, of any other a call.
        if out.len() == count {
            out[..count].copy_from_slice(&numbers[..count]);
        } else {
            out.iter_mut().zip(numbers).for_each(|(out, number)| *out = *number);
        }
    }
    last
}

/// Some spectra times one group of columns or two.
#[inline(always)]
fn product<S: Simd, A: Real, const V: usize>(
    simd: S,
    spectra: [&[A]; ROWS],
    panels: [&[A::Lanes<S>]; V],
) -> [[A::Lanes<S>; V]; ROWS] {
    let mut sums = [[A::splat(simd, A::zero()); V]; ROWS];
    // All of one length, so that one look at a place serves for all.
    let count = spectra[0].len();
    let (spectra, panels) = (spectra.map(|spectrum| &spectrum[..count]), panels.map(|panel| &panel[..count]));
    for k in 0..count {
        for (sums, spectrum) in sums.iter_mut().zip(spectra) {
            let incident = A::splat(simd, spectrum[k]);
            for (sum, panel) in sums.iter_mut().zip(panels) {
                *sum = A::add_product(simd, incident, panel[k], *sum);
            }
        }
    }
    sums
}
