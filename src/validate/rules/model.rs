//! Do the fitted models hold together with the data?

use ndarray::{ArrayView2, Axis};

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::container::measurement_digest;
use crate::dataset::{FittedParameter, FittedTerm, Mask, Model, NotComplete, Place, Reduction, reduce};

fn models<'a>(context: &Context<'a>) -> impl Iterator<Item = (String, &'a Model)> {
    let models = context.document().map_or(&[][..], |document| &document.models);
    models.iter().map(|model| (format!("/{}/{}", name::MODEL, model.id), model))
}

pub(in super::super) fn data_changed(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let measurement = context.document().and_then(|document| document.measurement(model.measurement.as_str()));
        let Some(now) = measurement.and_then(|measurement| measurement_digest(measurement).ok()) else { continue };
        if now != model.data_digest {
            found.add(Place::path(format!("{path}@{}", name::DATA_DIGEST)), now, model.data_digest.as_str());
        }
    }
    for (path, model) in models(context) {
        let Some(attached) = context.document().and_then(|document| document.attached(model).ok()) else { continue };
        for (attribute, part, then) in [
            (name::ELASTIC_DIGEST, attached.elastic, &attached.attachment.elastic_digest),
            (name::LUMINESCENT_DIGEST, attached.luminescent, &attached.attachment.luminescent_digest),
        ] {
            let now = measurement_digest(part).unwrap_or_default();
            if now != *then {
                found.add(Place::path(format!("{path}/{}@{attribute}", name::DONALDSON)), now, then.as_str());
            }
        }
    }
}

pub(in super::super) fn donaldson(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let attached = context.document().map(|document| document.attached(model));
        if let Some(Err(NotComplete::Unfit { attribute, found: there, expected, .. })) = attached {
            found.add(Place::path(format!("{path}/{}@{attribute}", name::DONALDSON)), there, expected);
        }
    }
}

/// The first element of a covariance that is wrong: its table and its place there.
fn find_in_covariance(
    model: &Model,
    wrong: impl Fn(ArrayView2<'_, f64>, usize, usize, f64) -> bool,
) -> Option<[usize; 3]> {
    model.covariance.outer_iter().enumerate().find_map(|(table, covariance)| {
        let mut elements = covariance.indexed_iter();
        elements.find(|((i, j), value)| wrong(covariance, *i, *j, **value)).map(|((i, j), _)| [table, i, j])
    })
}

/// An element as the file has it: one table is a matrix.
fn element(path: &str, model: &Model, [table, i, j]: [usize; 3]) -> Place {
    let place = Place::path(format!("{path}/{}", name::COVARIANCE));
    if model.covariance.len_of(Axis(0)) == 1 { place.at_index([i, j]) } else { place.at_index([table, i, j]) }
}

pub(in super::super) fn covariance_symmetric(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        if !is_square(model) {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE));
            found.add(place, format!("shape {:?}", model.covariance.shape()), "as many rows as columns");
            continue;
        }
        // Rounding of a product in another order, relative to the two variances.
        let asymmetric = find_in_covariance(model, |covariance, i, j, value| {
            let scale = covariance[[i, i]].abs().max(covariance[[j, j]].abs());
            (value - covariance[[j, i]]).abs() > 1e-12 * scale.max(value.abs())
        });
        if let Some([emission, i, j]) = asymmetric {
            let (value, other) = (model.covariance[[emission, i, j]], model.covariance[[emission, j, i]]);
            found.add(element(&path, model, [emission, i, j]), value.to_string(), other.to_string());
        }
    }
}

fn is_square(model: &Model) -> bool {
    model.covariance.len_of(Axis(1)) == model.covariance.len_of(Axis(2))
}

pub(in super::super) fn covariance_diagonal(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        if let Some(index) = find_in_covariance(model, |_, i, j, variance| i == j && variance < 0.0) {
            found.add(
                element(&path, model, index),
                model.covariance[index].to_string(),
                "a variance of zero or more, or NaN",
            );
        }
    }
}

pub(in super::super) fn covariance_parameters(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let (tables, rows, _) = model.covariance.dim();
        let (names, emissions) = (model.covariance_parameters.len(), model.emission.len());
        if names != rows {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE_PARAMETERS));
            found.add(place, format!("{names} names"), format!("{rows}, one for each row of the covariance"));
        } else if tables != 1 && tables != emissions {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE));
            found.add(place, format!("{tables} tables"), format!("one, or {emissions}: one for each emission value"));
        }
    }
}

pub(in super::super) fn covariance_names(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let of_term = |(position, term): (usize, &FittedTerm)| {
            let names = term.parameters.iter().map(move |parameter| model.covariance_name(position, &parameter.name));
            names.collect::<Vec<_>>()
        };
        let declared: Vec<String> = model.terms.iter().enumerate().flat_map(of_term).collect();
        let names = &model.covariance_parameters;
        let wrong = names.iter().enumerate().find(|(index, name)| {
            let once = declared.iter().filter(|declared| declared == name).count() == 1;
            !once || names[..*index].contains(name)
        });
        if let Some((index, name)) = wrong {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE_PARAMETERS)).at_index([index]);
            found.add(place, format!("`{name}`"), format!("each once, of: {}", declared.join(", ")));
        }
    }
}

pub(in super::super) fn parameter_bounds(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        for (term_index, term) in model.terms.iter().enumerate() {
            for (index, fitted) in term.parameters.iter().enumerate() {
                let declared = term.kind.parameters().iter().find(|parameter| parameter.name == fitted.name);
                let outside = |value: &f64| declared.is_some_and(|declared| !declared.allows(*value));
                if let Some(at) = fitted.value.iter().position(|value| !value.is_nan() && outside(value)) {
                    let dataset = format!("{path}/{}{term_index}/{}{index}", name::TERM, name::PARAMETER);
                    let expected = declared.map_or(String::new(), |declared| {
                        let relation = if declared.lower_excluded { "more than" } else { "at least" };
                        format!("{relation} {}", declared.lower)
                    });
                    let value = fitted.value[at];
                    found.add(Place::path(dataset).at_index([at]), format!("{} = {value}", fitted.name), expected);
                }
            }
        }
    }
}

pub(in super::super) fn not_converged(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context).filter(|(_, model)| !model.converged) {
        found.add(Place::path(format!("{path}@{}", name::CONVERGED)), model.method.as_str(), "a fit that converged");
    }
}

/// Numbers of a model computed elsewhere agree to this: another order of sums, another cosine.
const RECOMPUTED: f64 = 1e-6;

pub(in super::super) fn residuals(context: &Context<'_>, found: &mut Finder) {
    // A reduction asks for arrays that fit together.
    let Some(document) = context.document().filter(|document| document.check().is_ok()) else { return };
    for (path, model) in models(context) {
        let Some(measurement) = document.measurement(model.measurement.as_str()) else { continue };
        // Another reduction than the standard's, or data that cannot be reduced, leave nothing to compare.
        let Ok(reduction) = model.reduction.parse::<Reduction>() else { continue };
        let Ok(mut data) = reduce(document, measurement, reduction) else { continue };
        // So does a mask that only another program knows.
        let Ok(mask) = model.mask.as_deref().unwrap_or_default().parse::<Mask>() else { continue };
        data.apply(&mask);
        if data.emission != model.emission {
            continue;
        }
        let stored = &model.residuals;
        let fitted = model.fitted_parameters();
        let Ok((_, computed)) = crate::dataset::residuals(model, &data, fitted) else { continue };
        let differs = |a: f64, b: f64| {
            let near = (a - b).abs() <= RECOMPUTED * b.abs().max(f64::MIN_POSITIVE);
            !(near || a.is_nan() && b.is_nan())
        };
        let numbers = [
            (name::RESIDUAL_RMS, stored.rms, computed.rms),
            (name::REDUCED_CHI_SQUARE, stored.reduced_chi_square, computed.reduced_chi_square),
            (name::RESIDUAL_COUNT, stored.count as f64, computed.count as f64),
        ];
        for (attribute, stored, computed) in numbers {
            if differs(stored, computed) {
                let place = Place::path(format!("{path}@{attribute}"));
                found.add(
                    place,
                    stored.to_string(),
                    format!("{computed}, which the stored terms leave on the stored data"),
                );
            }
        }
    }
}

pub(in super::super) fn complete(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        for emission in 0..model.emission.len() {
            if let Err(error) = model.terms_at(emission) {
                found.add(Place::path(&path), error.to_string(), "every parameter of every term");
                break;
            }
        }
    }
}

pub(in super::super) fn uncertainty(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        for (t, term) in model.terms.iter().enumerate() {
            for (p, fitted) in term.parameters.iter().enumerate() {
                let place = Place::path(format!("{path}/{}{t}/{}{p}{}", name::TERM, name::PARAMETER, name::SUFFIX_U));
                let (found_u, expected) = (fitted.standard_uncertainty.len(), fitted.value.len());
                if found_u != expected {
                    found.add(place, format!("{found_u} uncertainties"), format!("{expected}, one for each value"));
                } else if let Some((suffix, at)) = wrong_interval(fitted) {
                    let place = Place::path(format!("{path}/{}{t}/{}{p}{suffix}", name::TERM, name::PARAMETER));
                    let (low, high) = (fitted.interval_low.get(at), fitted.interval_high.get(at));
                    let shown = |end: Option<&f64>| end.map_or("none".to_owned(), f64::to_string);
                    let expected = "one end for each value, the value between them, NaN at an open end";
                    found.add(place.at_index([at]), format!("from {} to {}", shown(low), shown(high)), expected);
                } else if let Some(at) = fitted.standard_uncertainty.iter().position(|u| *u < 0.0 || u.is_infinite()) {
                    let value = fitted.standard_uncertainty[at];
                    found.add(
                        place.at_index([at]),
                        value.to_string(),
                        "zero or more, or NaN where the data cannot tell",
                    );
                }
            }
        }
    }
}

/// Where the interval of a parameter is none: an end without a value, or a value beyond an end.
fn wrong_interval(fitted: &FittedParameter) -> Option<(&'static str, usize)> {
    let (low, high) = (&fitted.interval_low, &fitted.interval_high);
    if low.is_empty() && high.is_empty() {
        return None;
    }
    for (suffix, ends) in [(name::SUFFIX_LOW, low), (name::SUFFIX_HIGH, high)] {
        if ends.len() != fitted.value.len() {
            return Some((suffix, ends.len().min(fitted.value.len())));
        }
    }
    // NaN compares false: an open end excludes nothing.
    let below = fitted.value.iter().zip(low).position(|(value, low)| value < low);
    let above = fitted.value.iter().zip(high).position(|(value, high)| value > high);
    below.map(|at| (name::SUFFIX_LOW, at)).or(above.map(|at| (name::SUFFIX_HIGH, at)))
}

pub(in super::super) fn correlation(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context).filter(|(_, model)| is_square(model)) {
        let beyond = find_in_covariance(model, |covariance, i, j, value| {
            let bound = (covariance[[i, i]] * covariance[[j, j]]).sqrt();
            i < j && value.abs() > bound * (1.0 + 1e-9)
        });
        if let Some(index) = beyond {
            let value = model.covariance[index].to_string();
            found.add(
                element(&path, model, index),
                value,
                "at most the geometric mean of the two variances in magnitude",
            );
        }
    }
}
