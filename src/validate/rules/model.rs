//! Do the fitted models hold together with the data?

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::container::measurement_digest;
use crate::dataset::{Model, Place};

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
}

pub(in super::super) fn covariance_symmetric(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let covariance = &model.covariance;
        let asymmetric = covariance.indexed_iter().find(|((row, column), value)| {
            covariance.get((*column, *row)).is_none_or(|other| {
                // Rounding of a product in another order, relative to the two variances.
                let scale = covariance[[*row, *row]].abs().max(covariance[[*column, *column]].abs());
                (**value - other).abs() > 1e-12 * scale.max(value.abs())
            })
        });
        if !covariance.is_square() {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE));
            found.add(place, format!("shape {:?}", covariance.shape()), "as many rows as columns");
        } else if let Some(((row, column), value)) = asymmetric {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE)).at_index([row, column]);
            found.add(place, value.to_string(), covariance[[column, row]].to_string());
        }
    }
}

pub(in super::super) fn covariance_diagonal(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let diagonal = model.covariance.diag();
        if let Some(index) = diagonal.iter().position(|variance| *variance < 0.0) {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE)).at_index([index, index]);
            found.add(place, diagonal[index].to_string(), "a variance of zero or more, or NaN");
        }
    }
}

pub(in super::super) fn covariance_parameters(context: &Context<'_>, found: &mut Finder) {
    for (path, model) in models(context) {
        let (names, rows) = (model.covariance_parameters.len(), model.covariance.nrows());
        if names != rows {
            let place = Place::path(format!("{path}/{}", name::COVARIANCE_PARAMETERS));
            found.add(place, format!("{names} names"), format!("{rows}, one for each row of the covariance"));
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
