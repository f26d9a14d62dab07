//! A fitted model in another width or norm of the Gaussian: the same function of the angles, and so no new fit.
//!
//! With w the width in rad, k the ratio of the two roughness units and N(w) the norm ([`gaussian_integral`]):
//! r' = k r, and c_s' = c_s N' / N, where N is 1 for a form without a norm. The Jacobian follows exactly, with
//! L = d(ln N'/N)/d(ln w): dc'/dc = N'/N, dc'/dr = c' L / r, dr'/dr = k.

use ndarray::{Array2, ArrayView2, Axis};

use super::{FittedTerm, Id, Model};
use crate::terms::{Distribution, INTENSITY, ROUGHNESS, TermKind, gaussian_integral};

/// Why a model has no exact twin.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoTwin {
    /// Another function of the angles.
    #[error(
        "`{into}` is another function of the angles than `{from}`, and no roughness makes them equal: refit with \
         `bbrf fit --distribution {into}`; exact twins are gaussian-half-height, gaussian, torrance-sparrow-1967 and \
         gaussian-normalised"
    )]
    OtherFunction {
        /// The form of the model.
        from: Distribution,
        /// The form asked for.
        into: Distribution,
    },
    /// There is nothing to convert.
    #[error("it has no torrance-sparrow term, and so no distribution to convert")]
    NoSpecularTerm,
    /// It has that form already.
    #[error("its distribution is `{0}` already")]
    Same(Distribution),
    /// A parameter is missing or out of range.
    #[error("its torrance-sparrow term has no `{0}` that can be converted")]
    Parameter(&'static str),
}

/// How intensity and roughness of one term change.
#[derive(Debug, Clone, Copy)]
struct Change {
    /// c' / c.
    intensity: f64,
    /// r' / r.
    roughness: f64,
    /// d(ln c') / dr at constant c.
    by_roughness: f64,
}

impl Change {
    fn new(from: Distribution, into: Distribution, roughness: f64) -> Result<Self, NoTwin> {
        let other = NoTwin::OtherFunction { from, into };
        let width = from.gaussian_width(roughness).ok_or_else(|| other.clone())?;
        let unit = into.gaussian_width(1.0).ok_or(other)?;
        if roughness.is_nan() {
            // A term that was not seen: an intensity of 0 stays one, and a shape that is undefined, too.
            let ratio = from.gaussian_width(1.0).map_or(f64::NAN, |old| old / unit);
            return Ok(Self { intensity: 1.0, roughness: ratio, by_roughness: 0.0 });
        }
        let norm = gaussian_integral(width);
        let (intensity, slope) = match (from, into) {
            (Distribution::GaussianNormalised, Distribution::GaussianNormalised) => (1.0, 0.0),
            (_, Distribution::GaussianNormalised) => (norm.value, norm.by_log_width),
            (Distribution::GaussianNormalised, _) => (norm.value.recip(), -norm.by_log_width),
            _ => (1.0, 0.0),
        };
        let change = Self { intensity, roughness: width / unit / roughness, by_roughness: slope / roughness };
        let is_usable =
            roughness > 0.0 && intensity > 0.0 && [intensity, change.roughness].iter().all(|x| x.is_finite());
        if is_usable { Ok(change) } else { Err(NoTwin::Parameter(ROUGHNESS.name)) }
    }
}

/// The model with every specular term in another form of the same function, with its covariance, under an id of its own.
///
/// Predictions and residuals stay. Where the norm changes, the intensity has no interval any more; and no standard
/// uncertainty where the model does not hold its covariance with the roughness, on which the norm depends.
///
/// # Errors
/// [`NoTwin`] where the form asked for is another function, or there is nothing to convert.
pub fn with_distribution(model: &Model, into: Distribution) -> Result<Model, NoTwin> {
    let mut twin = model.clone();
    let emissions = model.covariance.len_of(Axis(0));
    let mut jacobians = vec![Array2::<f64>::eye(model.covariance_parameters.len()); emissions];
    let (mut specular, mut lost, mut from) = (0, false, into);
    let terms = twin.terms.iter_mut().enumerate();
    for (position, term) in terms.filter(|(_, term)| term.kind == TermKind::TorranceSparrow) {
        specular += 1;
        let before = term.distribution.unwrap_or(Distribution::GaussianHalfHeight);
        from = if before == into { from } else { before };
        let changes = changes(term, before, into)?;
        convert_term(term, into, &changes);
        let row = |parameter: &str| {
            let name = model.covariance_name(position, parameter);
            model.covariance_parameters.iter().position(|one| *one == name)
        };
        let (c, r) = (row(INTENSITY.name), row(ROUGHNESS.name));
        for (emission, jacobian) in jacobians.iter_mut().enumerate() {
            let change = of(&changes, emission).ok_or(NoTwin::Parameter(ROUGHNESS.name))?;
            r.iter().for_each(|r| jacobian[(*r, *r)] = change.roughness);
            c.iter().for_each(|c| jacobian[(*c, *c)] = change.intensity);
            if let (Some(c), Some(r)) = (c, r) {
                let intensity = term.parameter_at(INTENSITY.name, emission);
                jacobian[(c, r)] = intensity.ok_or(NoTwin::Parameter(INTENSITY.name))? * change.by_roughness;
            }
        }
        lost |= c.zip(r).is_none() && changes.iter().any(|change| change.by_roughness != 0.0);
    }
    if specular == 0 {
        return Err(NoTwin::NoSpecularTerm);
    }
    if from == into {
        return Err(NoTwin::Same(into));
    }
    for (emission, jacobian) in jacobians.iter().enumerate() {
        let converted = propagated(jacobian, model.covariance.index_axis(Axis(0), emission));
        twin.covariance.index_axis_mut(Axis(0), emission).assign(&converted);
    }
    fill_uncertainties(&mut twin, lost);
    twin.id = Id::from_title(&format!("{}-{into}", model.id));
    twin.method = format!("{}; `{from}` converted exactly to `{into}` from model `{}`", model.method, model.id);
    twin.identifiability.push(format!(
        "converted exactly from model `{}` (distribution `{from}`): sentences that name a roughness or an intensity speak of \
         that model's",
        model.id
    ));
    if lost {
        twin.identifiability.push(
            "the model does not hold the covariance of its intensities with the roughness, and the norm depends on it: their \
             standard uncertainties are not known here"
                .to_owned(),
        );
    }
    Ok(twin)
}

/// The one that serves all emission values, or that of one.
fn of<T>(list: &[T], emission: usize) -> Option<&T> {
    if list.len() == 1 { list.first() } else { list.get(emission) }
}

/// How each value of a term changes: one change where one roughness serves all, else one for each emission value.
fn changes(term: &FittedTerm, before: Distribution, into: Distribution) -> Result<Vec<Change>, NoTwin> {
    let missing = || NoTwin::Parameter(ROUGHNESS.name);
    let roughness = term.parameters.iter().find(|one| one.name == ROUGHNESS.name).ok_or_else(missing)?;
    let intensity = term.parameters.iter().find(|one| one.name == INTENSITY.name).ok_or_else(missing)?;
    match (roughness.value.len(), intensity.value.len()) {
        (1, _) => {}
        (several, intensities) if several > 1 && several == intensities => {}
        _ => return Err(missing()),
    }
    roughness.value.iter().map(|roughness| Change::new(before, into, *roughness)).collect()
}

/// Converts the numbers of a term.
fn convert_term(term: &mut FittedTerm, into: Distribution, changes: &[Change]) {
    term.distribution = Some(into);
    let scale = |values: &mut Vec<f64>, factor: fn(&Change) -> f64| {
        values.iter_mut().enumerate().for_each(|(k, value)| *value *= of(changes, k).map_or(f64::NAN, factor));
    };
    for parameter in &mut term.parameters {
        if parameter.name == ROUGHNESS.name {
            scale(&mut parameter.value, |change| change.roughness);
            scale(&mut parameter.standard_uncertainty, |change| change.roughness);
            scale(&mut parameter.interval_low, |change| change.roughness);
            scale(&mut parameter.interval_high, |change| change.roughness);
            into.roughness_unit().clone_into(&mut parameter.unit);
        } else if parameter.name == INTENSITY.name {
            scale(&mut parameter.value, |change| change.intensity);
            scale(&mut parameter.standard_uncertainty, |change| change.intensity);
            if changes.iter().any(|change| change.by_roughness != 0.0) {
                // The profile of a product is not the product of a profile: only a new fit has it.
                parameter.interval_low.clear();
                parameter.interval_high.clear();
            }
        }
    }
}

/// J C J^T, where an entry of J that is 0 hides an unknown of C.
fn propagated(jacobian: &Array2<f64>, covariance: ArrayView2<'_, f64>) -> Array2<f64> {
    let count = jacobian.nrows();
    let known = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * b };
    Array2::from_shape_fn((count, count), |(i, j)| {
        let pairs = (0..count).flat_map(|k| (0..count).map(move |l| (k, l)));
        pairs.map(|(k, l)| known(jacobian[(i, k)] * jacobian[(j, l)], covariance[(k, l)])).sum()
    })
}

/// The standard uncertainties of the intensities are those of the covariance, or not known.
fn fill_uncertainties(twin: &mut Model, lost: bool) {
    let names: Vec<String> = (0..twin.terms.len()).map(|term| twin.covariance_name(term, INTENSITY.name)).collect();
    let terms = twin.terms.iter_mut().zip(&names).filter(|(term, _)| term.kind == TermKind::TorranceSparrow);
    for (term, name) in terms {
        let row = twin.covariance_parameters.iter().position(|one| one == name);
        for parameter in term.parameters.iter_mut().filter(|one| one.name == INTENSITY.name) {
            for (emission, sigma) in parameter.standard_uncertainty.iter_mut().enumerate() {
                *sigma = match row.and_then(|row| twin.covariance.get((emission, row, row))) {
                    _ if lost => f64::NAN,
                    Some(variance) => variance.sqrt(),
                    None => *sigma,
                };
            }
        }
    }
}
