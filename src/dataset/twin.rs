//! A fitted model in another width or norm of the Gaussian: the same function of the angles, and so no new fit.
//!
//! With w the width in rad, k the ratio of the two roughness units and N(w) the norm ([`gaussian_integral`]):
//! r' = k r, and c_s' = c_s N' / N, where N is 1 for a form without a norm. The Jacobian follows exactly, with
//! L = d(ln N'/N)/d(ln w): dc'/dc = N'/N, dc'/dr = c' L / r, dr'/dr = k.

use ndarray::Array2;

use super::{FittedParameter, FittedTerm, Id, Model};
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
/// Predictions and residuals stay. Where the norm changes, the intensity has no interval any more. Where amplitudes of several emission values were fitted, a file does not hold their
/// covariance with the roughness; then, if the norm changes, their standard uncertainties are not known and are NaN.
///
/// # Errors
/// [`NoTwin`] where the form asked for is another function, or there is nothing to convert.
pub fn with_distribution(model: &Model, into: Distribution) -> Result<Model, NoTwin> {
    let mut terms = model.terms.clone();
    let count = model.covariance_parameters.len();
    let mut jacobian = Array2::<f64>::eye(count);
    let (mut specular, mut lost, mut from) = (0, false, into);
    for (position, term) in terms.iter_mut().enumerate().filter(|(_, term)| term.kind == TermKind::TorranceSparrow) {
        specular += 1;
        let before = term.distribution.unwrap_or(Distribution::GaussianHalfHeight);
        from = if before == into { from } else { before };
        let changes = changes(term, before, into)?;
        let index = |parameter: &str| {
            let name = model.covariance_name(position, parameter);
            model.covariance_parameters.iter().position(|one| *one == name)
        };
        let (c, r) = (index(INTENSITY.name), index(ROUGHNESS.name));
        lost |= convert_term(term, into, &changes, c.zip(r).is_some())?;
        // A covariance is that of one number each.
        let [change, ..] = changes[..] else { return Err(NoTwin::Parameter(ROUGHNESS.name)) };
        if let Some(r) = r {
            jacobian[(r, r)] = change.roughness;
        }
        if let Some(c) = c {
            jacobian[(c, c)] = change.intensity;
            let converted = term.parameter_at(INTENSITY.name, 0).ok_or(NoTwin::Parameter(INTENSITY.name))?;
            r.iter().for_each(|r| jacobian[(c, *r)] = converted * change.by_roughness);
        }
    }
    if specular == 0 {
        return Err(NoTwin::NoSpecularTerm);
    }
    if from == into {
        return Err(NoTwin::Same(into));
    }
    let covariance = propagated(&jacobian, model.covariance.view());
    fill_uncertainties(&mut terms, model, &covariance);
    let mut twin = Model {
        id: Id::from_title(&format!("{}-{into}", model.id)),
        terms,
        covariance: covariance.into_shared(),
        method: format!("{}; `{from}` converted exactly to `{into}` from model `{}`", model.method, model.id),
        ..model.clone()
    };
    twin.identifiability.push(format!(
        "converted exactly from model `{}` (distribution `{from}`): sentences that name a roughness or an intensity speak of \
         that model's",
        model.id
    ));
    if lost {
        twin.identifiability.push(
            "the intensities of several wavelengths are stored without their covariance with the roughness, and the norm \
             depends on it: their standard uncertainties are not known here"
                .to_owned(),
        );
    }
    Ok(twin)
}

/// How each value of a term changes: one change where one roughness serves all, else one for each emission value.
fn changes(term: &FittedTerm, before: Distribution, into: Distribution) -> Result<Vec<Change>, NoTwin> {
    let count = |name: &'static str| {
        let parameter = term.parameters.iter().find(|one| one.name == name).ok_or(NoTwin::Parameter(name))?;
        Ok(parameter.value.len())
    };
    let (roughnesses, intensities) = (count(ROUGHNESS.name)?, count(INTENSITY.name)?);
    if roughnesses == 0 || (roughnesses > 1 && intensities != roughnesses) {
        return Err(NoTwin::Parameter(ROUGHNESS.name));
    }
    let of = |emission: usize| {
        let roughness = term.parameter_at(ROUGHNESS.name, emission).ok_or(NoTwin::Parameter(ROUGHNESS.name))?;
        Change::new(before, into, roughness)
    };
    (0..roughnesses).map(of).collect()
}

/// Converts the numbers of a term; true where uncertainties of its intensities are lost.
fn convert_term(term: &mut FittedTerm, into: Distribution, changes: &[Change], tied: bool) -> Result<bool, NoTwin> {
    term.distribution = Some(into);
    let find = |parameters: &mut Vec<FittedParameter>, name: &'static str| {
        parameters.iter().position(|one| one.name == name).ok_or(NoTwin::Parameter(name))
    };
    let scale = |values: &mut Vec<f64>, factor: fn(&Change) -> f64| {
        let each = |k: usize| changes.get(k).or(changes.first()).map_or(f64::NAN, factor);
        values.iter_mut().enumerate().for_each(|(k, value)| *value *= each(k));
    };
    let roughness = find(&mut term.parameters, ROUGHNESS.name)?;
    let roughness = &mut term.parameters[roughness];
    for numbers in [
        &mut roughness.value,
        &mut roughness.standard_uncertainty,
        &mut roughness.interval_low,
        &mut roughness.interval_high,
    ] {
        scale(numbers, |change| change.roughness);
    }
    roughness.unit = into.roughness_unit().to_owned();
    let intensity = find(&mut term.parameters, INTENSITY.name)?;
    let intensity = &mut term.parameters[intensity];
    scale(&mut intensity.value, |change| change.intensity);
    scale(&mut intensity.standard_uncertainty, |change| change.intensity);
    let depends = changes.iter().any(|change| change.by_roughness != 0.0);
    if depends {
        // The profile of a product is not the product of a profile: only a new fit has it.
        intensity.interval_low.clear();
        intensity.interval_high.clear();
    }
    let lost = depends && !tied;
    if lost {
        intensity.standard_uncertainty.iter_mut().for_each(|sigma| *sigma = f64::NAN);
    }
    Ok(lost)
}

/// J C J^T, where an entry of J that is 0 hides an unknown of C.
fn propagated(jacobian: &Array2<f64>, covariance: ndarray::ArrayView2<'_, f64>) -> Array2<f64> {
    let count = jacobian.nrows();
    let known = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a * b };
    Array2::from_shape_fn((count, count), |(i, j)| {
        let pairs = (0..count).flat_map(|k| (0..count).map(move |l| (k, l)));
        pairs.map(|(k, l)| known(jacobian[(i, k)] * jacobian[(j, l)], covariance[(k, l)])).sum()
    })
}

/// The standard uncertainties of single intensities are those of the covariance.
fn fill_uncertainties(terms: &mut [FittedTerm], model: &Model, covariance: &Array2<f64>) {
    for (position, term) in terms.iter_mut().enumerate().filter(|(_, term)| term.kind == TermKind::TorranceSparrow) {
        let name = model.covariance_name(position, INTENSITY.name);
        let Some(k) = model.covariance_parameters.iter().position(|one| *one == name) else { continue };
        for parameter in term.parameters.iter_mut().filter(|one| one.name == INTENSITY.name) {
            parameter.standard_uncertainty = vec![covariance[(k, k)].sqrt(); parameter.value.len()];
        }
    }
}
