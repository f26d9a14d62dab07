//! Which model: every form of the terms fitted to the same numbers, and what tells them apart.
//!
//! Cross-validation by geometry decides: each geometry is predicted by a fit to the others. It asks what a model is for,
//! and stays honest where the stated uncertainties are wrong or the model is; AICc and BIC beside it rest on both being
//! right. Repeats of a geometry, and its mirror image, are left out together: a fit that has seen one predicts no other.
//! Among the models within one standard error of the best, that of fewest parameters is preferred.

mod apart;
mod folds;
mod shape;
mod verdict;

use rayon::prelude::*;

use super::error::DataError;
use super::geometry_set::{GeometrySet, SetError};
use super::measurement::{Prepared, prepared};
use super::options::{FitError, FitOptions};
use super::outcome::Fit;
use super::solve::Fitter;
use crate::dataset::{Document, Measurement, Reduced};
use crate::quantity::{Geometry, Reference};
use crate::terms::{Denominator, TermKind, Undefined, diffuse_factor, specular_factor};
pub use apart::Difference;
use folds::Folds;
pub use shape::Shape;
pub use verdict::{Criterion, Indistinguishable};

/// One model of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Its terms.
    pub shape: Shape,
    /// The fit to all values.
    pub fit: Fit,
    /// False where the fit found no specular term in the data: then it is the model without one, and no model of its own.
    pub is_own: bool,
    /// Number of fitted parameters.
    pub parameters: usize,
    /// Chi-square; the sum of squared residuals where no value has an uncertainty.
    pub chi_square: f64,
    /// Akaike's criterion corrected for few values; NaN where there are too few for it.
    pub aicc: f64,
    /// The Bayesian criterion.
    pub bic: f64,
    /// Mean squared error of the values that were left out, in units of their variance (of the values' own unit squared,
    /// where there is none); infinite where a fold could not be fitted.
    pub cross_validation: f64,
    /// How much that is above the best model's, and the standard error of the difference over the geometries.
    pub behind: (f64, f64),
    /// Squared errors summed over each geometry.
    scores: Vec<f64>,
}

/// The models, the best first.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// How a spectrum became the fitted number.
    pub reduction: String,
    /// The reference of the numbers.
    pub reference: Reference,
    /// What a diffuse term is called.
    pub diffuse: TermKind,
    /// Values that take part: those at which every model has a value.
    pub values: usize,
    /// Different geometries, and the number of fits of each cross-validation.
    pub geometries: usize,
    /// How many sets of geometries are left out in turn.
    pub folds: usize,
    /// True where values have standard uncertainties.
    pub has_sigma: bool,
    /// All models, by cross-validation.
    pub models: Vec<Compared>,
    /// Position of the preferred one.
    pub preferred: usize,
    /// Models that the data cannot tell from it.
    pub indistinguishable: Vec<Indistinguishable>,
}

/// Fits every form of the terms to a measurement and compares them.
///
/// # Errors
/// As [`super::fit_measurement`]; [`FitError::Data`] where there are too few values for the largest model.
pub fn compare_measurement(
    document: &Document,
    measurement: &Measurement,
    options: &FitOptions,
) -> Result<Comparison, FitError> {
    let name = || measurement.id.to_string();
    let Prepared { choice, mut data, reference, .. } = prepared(document, measurement, options)?;
    leave_out_undefined(&mut data, &reference);
    let diffuse = choice.diffuse.unwrap_or(TermKind::Lambertian);
    let folds = Folds::new(&data.geometry, data.values.nrows());
    let models: Result<Vec<Compared>, Failed> =
        Shape::all().into_par_iter().map(|shape| compared(shape, &data, &reference, diffuse, &folds)).collect();
    let mut models = models.map_err(|failed| match failed {
        Failed::Geometry(source) => FitError::Geometry { measurement: name(), source },
        Failed::Data(source) => FitError::Data { measurement: name(), source },
    })?;
    let preferred = verdict::rank(&mut models);
    let indistinguishable = verdict::indistinguishable(&models, preferred, &data, &reference, diffuse);
    Ok(Comparison {
        reduction: data.reduction.clone(),
        reference,
        diffuse,
        values: models[preferred].fit.bands.iter().map(|band| band.count).sum(),
        geometries: folds.groups,
        folds: folds.count(),
        has_sigma: data.sigma.is_some(),
        models,
        preferred,
        indistinguishable,
    })
}

enum Failed {
    Geometry(SetError),
    Data(DataError),
}

/// All models are compared on the same values: where one has none, none is compared.
fn leave_out_undefined(data: &mut Reduced, reference: &Reference) {
    let is_defined = |geometry: &Geometry| -> Result<(), Undefined> {
        diffuse_factor(geometry, reference)?;
        let half = geometry.half_angles();
        Denominator::ALL
            .iter()
            .try_for_each(|denominator| specular_factor(*denominator, geometry, &half, reference).map(|_| ()))
    };
    for (row, geometry) in data.geometry.iter().enumerate() {
        match is_defined(geometry) {
            // Said by the fit itself.
            Ok(()) | Err(Undefined::Reference(_)) => {}
            Err(_) => data.values.column_mut(row).fill(f64::NAN),
        }
    }
}

fn compared(
    shape: Shape,
    data: &Reduced,
    reference: &Reference,
    diffuse: TermKind,
    folds: &Folds,
) -> Result<Compared, Failed> {
    let set = match shape.specular {
        Some((distribution, denominator)) => GeometrySet::new(&data.geometry, reference, distribution, denominator),
        None => GeometrySet::diffuse(&data.geometry, reference),
    };
    let set = set.map_err(Failed::Geometry)?;
    let fitter = Fitter::new(&set, shape.terms());
    let sigma = data.sigma.as_ref().map(|sigma| sigma.view());
    let fit = fitter.fit_bands(data.values.view(), sigma).map_err(Failed::Data)?;
    let count: usize = fit.bands.iter().map(|band| band.count).sum();
    let scores = folds.scores(&fitter, data, |fit| shape.predictions(fit, data, reference, diffuse));
    let parameters = count - fit.degrees_of_freedom as usize;
    let criterion = Criterion::of(fit.chi_square, count, parameters, data.sigma.is_some());
    Ok(Compared {
        is_own: shape.specular.is_none() || fit.has_specular(),
        parameters,
        chi_square: fit.chi_square,
        aicc: criterion.aicc,
        bic: criterion.bic,
        cross_validation: scores.iter().sum::<f64>() / count as f64,
        behind: (f64::NAN, f64::NAN),
        scores,
        shape,
        fit,
    })
}
