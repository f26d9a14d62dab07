//! The uncertainty beside a value of `bbrf eval`.

use std::collections::BTreeSet;

use super::EvalRow;
use crate::cli::output::print_message;
use crate::dataset::{ParameterCovariance, PredictionUncertainty};
use crate::import::GeometryRow;
use crate::quantity::Reference;
use crate::terms::{Term, TermKind};

/// Values without an uncertainty, and what of the covariance they lack.
#[derive(Default)]
pub(super) struct Unknown {
    count: usize,
    parameters: BTreeSet<String>,
}

impl Unknown {
    fn take(&mut self, uncertainty: Option<PredictionUncertainty>) -> Option<PredictionUncertainty> {
        if let Some(uncertainty) = uncertainty.as_ref().filter(|uncertainty| uncertainty.standard.is_none()) {
            self.count += 1;
            self.parameters.extend(uncertainty.unknown.iter().cloned());
        }
        uncertainty
    }

    /// Says so on standard error, if there are any.
    pub(super) fn print(&self, model: &str) {
        if self.count > 0 {
            let parameters = self.parameters.iter().cloned().collect::<Vec<_>>().join(", ");
            print_message(&format!(
                "bbrf: {model}: {} values have no standard uncertainty, because the model holds no covariance of {parameters}",
                self.count
            ));
        }
    }
}

/// The uncertainty of the elastic sum, and of the luminescent one where there is one.
pub(super) fn add(
    result: &mut EvalRow,
    row: &GeometryRow,
    terms: &[Term],
    covariance: &ParameterCovariance,
    unknown: &mut Unknown,
) {
    let is_luminescent = |kind: TermKind| kind == TermKind::Luminescent;
    let of = |counts: &dyn Fn(TermKind) -> bool| {
        covariance.of_prediction(terms, &row.geometry, &Reference::None, counts).ok()
    };
    // What has no value has no uncertainty either, and the reason was given.
    let has_elastic = terms.iter().any(|term| !is_luminescent(term.kind()));
    let elastic = unknown.take(of(&|kind| !is_luminescent(kind)).filter(|_| result.value.is_some()));
    let luminescent = unknown.take(of(&is_luminescent).filter(|_| result.luminescent.is_some()));
    result.standard_uncertainty = Some(elastic.as_ref().and_then(|one| one.standard));
    if result.luminescent.is_some() {
        result.luminescent_standard_uncertainty = Some(luminescent.as_ref().and_then(|one| one.standard));
    }
    let shared = if has_elastic { elastic } else { luminescent };
    result.shared_relative_uncertainty = shared.and_then(|one| one.shared_relative);
}
