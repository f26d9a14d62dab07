//! A separation as it is stored, taken up again.

use super::factors::Factors;
use super::overlap::{Floor, Overlap};
use super::separate::{known, separated_by};
use super::{Matrix, Separated};
use crate::dataset::Factorisation;

/// The separation that a factorisation of this matrix stands for: its factors and its elastic part, and what the cells of the matrix
/// say beside them. `None` where its arrays do not fit the matrix; whether the matrix is still the one that was factorised, its digest
/// says.
#[must_use]
pub fn restored(matrix: &Matrix, part: &Factorisation) -> Option<Separated> {
    let is_aligned = part.excitation_nm == matrix.excitation_nm && part.emission.nm.len() == matrix.emission_nm.len();
    if !is_aligned || part.misfit().is_some() {
        return None;
    }
    let mut overlap = Overlap::of(matrix);
    let reach = overlap.reach_nm.iter().copied().fold(0.0, f64::max);
    if (reach - part.reach_nm).abs() > 1e-9 {
        // Another program found it elsewhere; what it took for luminescence is what its factors are of.
        overlap.reach_nm.fill(part.reach_nm);
    }
    let floor = Floor::of(matrix, &overlap);
    let known = known(matrix, &overlap, floor);
    let factors = Factors::given(&known, &part.excitation.to_owned(), &part.emission_factor.to_owned())?;
    let tried = vec![(factors.rank(), factors.rms)];
    let mut separated = separated_by(matrix, overlap, floor, factors, tried);
    separated.elastic.clone_from(&part.elastic);
    separated.elastic_sigma.clone_from(&part.elastic_u);
    Some(separated)
}
