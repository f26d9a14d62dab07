//! Is there an uncertainty, and can it be one?

use super::super::Context;
use super::super::census::Census;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Measurement, Place, Role};
use crate::quantity::{ErrorDistribution, Finite, Flags, Statement};

pub(in super::super) fn missing(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        if measurement.uncertainty.standard.is_none() {
            found.add(Place::path(format!("{path}/{}", name::VALUE_U)), "nothing", "the standard uncertainty");
        }
    }
}

pub(in super::super) fn negative(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement, _) in context.counted().filter(|(_, _, census)| census.sigma.negative) {
        let Some(standard) = &measurement.uncertainty.standard else { continue };
        if let Some(((row, column), value)) = standard.indexed_iter().find(|(_, value)| **value < 0.0) {
            let place = Place::path(format!("{path}/{}", name::VALUE_U)).at_index([row, column]);
            found.add(place, value.to_string(), "zero or more, or NaN where it is unknown");
        }
    }
}

pub(in super::super) fn shared(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        for (position, component) in measurement.uncertainty.components.iter().enumerate() {
            let place = || Place::path(format!("{path}/{}{position}", name::COMPONENT));
            if let Some(index) = component.relative.iter().position(|value| *value < 0.0) {
                found.add(place().at_index([index]), component.relative[index].to_string(), "zero or more");
            }
            let (count, emission) = (component.relative.len(), measurement.emission.len());
            if count != 1 && count != emission {
                found.add(place(), format!("{count} values"), format!("one, or {emission}"));
            }
        }
    }
}

/// Every statement about an uncertainty, with the path of its dataset.
fn statements<'a>(context: &Context<'a>) -> Vec<(String, &'a Statement)> {
    let mut statements = Vec::new();
    for (path, measurement) in context.measurements() {
        let uncertainty = &measurement.uncertainty;
        statements.push((format!("{path}/{}", name::VALUE_U), &uncertainty.statement));
        let components = uncertainty.components.iter().enumerate();
        statements.extend(components.map(|(k, c)| (format!("{path}/{}{k}", name::COMPONENT), &c.statement)));
    }
    statements
}

pub(in super::super) fn coverage(context: &Context<'_>, found: &mut Finder) {
    for (path, statement) in statements(context) {
        let fields = [
            ("coverage_factor", statement.coverage_factor, 0.0, f64::INFINITY),
            ("coverage_probability", statement.coverage_probability, 0.0, 1.0),
            ("degrees_of_freedom", statement.degrees_of_freedom, 0.0, f64::INFINITY),
        ];
        for (field, number, above, below) in fields {
            if let Some(number) = number.map(Finite::get).filter(|number| !(*number > above && *number < below)) {
                let expected = if below == 1.0 { "between 0 and 1" } else { "more than 0" };
                found.add(Place::path(format!("{path}@{field}")), number.to_string(), expected);
            }
        }
    }
}

pub(in super::super) fn student(context: &Context<'_>, found: &mut Finder) {
    for (path, statement) in statements(context) {
        if statement.distribution == Some(ErrorDistribution::StudentT) && statement.degrees_of_freedom.is_none() {
            found.add(Place::path(format!("{path}@degrees_of_freedom")), "nothing", "the degrees of freedom of its t");
        }
    }
}

pub(in super::super) fn expanded(context: &Context<'_>, found: &mut Finder) {
    for (path, statement) in statements(context) {
        if statement.coverage_probability.is_some() && statement.coverage_factor.is_none() {
            let place = Place::path(format!("{path}@coverage_factor"));
            found.add(place, "a coverage probability alone", "the factor that was divided out");
        }
    }
}

/// Reports the first value of each measurement whose uncertainty a test objects to.
fn each_value(
    context: &Context<'_>,
    found: &mut Finder,
    expected: &str,
    possible: impl Fn(&Census) -> bool,
    objects: impl Fn(&Measurement, f64, f64) -> Option<String>,
) {
    for (path, measurement, census) in context.counted() {
        let Some(standard) = &measurement.uncertainty.standard else { continue };
        if standard.dim() != measurement.values.dim() || !possible(&census) {
            continue;
        }
        let columns = measurement.emission.len().max(1);
        let cells = measurement.values.iter().zip(standard).zip(&measurement.flags).enumerate();
        let first = cells.into_iter().find_map(|(k, ((value, sigma), flags))| {
            let usable = value.is_finite() && !Flags(*flags).explains_absence();
            let what = if usable { objects(measurement, *value, *sigma) } else { None };
            what.map(|what| ((k / columns, k % columns), what))
        });
        if let Some(((row, column), what)) = first {
            found.add(Place::path(format!("{path}/{}", name::VALUE_U)).at_index([row, column]), what, expected);
        }
    }
}

pub(in super::super) fn of_value(context: &Context<'_>, found: &mut Finder) {
    each_value(
        context,
        found,
        "the uncertainty of the value, or a flag that it is not to be used",
        |census| census.sigma.not_finite,
        |_, value, sigma| sigma.is_nan().then(|| format!("NaN for the value {value}")),
    );
}

pub(in super::super) fn zero(context: &Context<'_>, found: &mut Finder) {
    let expected = "more than 0: no measurement is exact";
    let possible = |census: &Census| census.sigma.zero;
    each_value(context, found, expected, possible, |measurement, value, sigma| {
        (sigma == 0.0 && measurement.uncertainty.components.is_empty()).then(|| format!("0 for the value {value}"))
    });
}

pub(in super::super) fn infinite(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement, _) in context.counted().filter(|(_, _, census)| census.sigma.not_finite) {
        let Some(standard) = &measurement.uncertainty.standard else { continue };
        if let Some(((row, column), _)) = standard.indexed_iter().find(|(_, value)| value.is_infinite()) {
            let place = Place::path(format!("{path}/{}", name::VALUE_U)).at_index([row, column]);
            found.add(place, "infinity", "a finite number, or NaN where it is unknown");
        }
    }
}
