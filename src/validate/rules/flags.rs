//! Does every missing value say why, and every flag mean something?

use super::super::Context;
use super::super::census::Census;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Measurement, Place, Role};
use crate::quantity::{Flag, Flags};

/// Reports the first value of each measurement that the rule objects to, with how many there are.
fn each(
    context: &Context<'_>,
    found: &mut Finder,
    dataset: &str,
    expected: &str,
    possible: impl Fn(&Census) -> bool,
    objects: impl Fn(f64, Flags) -> Option<String>,
) {
    for (path, measurement, _) in context.counted().filter(|(_, _, census)| possible(census)) {
        let objections = all(measurement, &objects);
        if let Some(((row, column), what)) = objections.first() {
            let more = match objections.len() {
                1 => String::new(),
                count => format!(" (and {} more)", count - 1),
            };
            let place = Place::path(format!("{path}/{dataset}")).at_index([*row, *column]);
            found.add(place, format!("{what}{more}"), expected);
        }
    }
}

type Objection = ((usize, usize), String);

fn all(measurement: &Measurement, objects: &impl Fn(f64, Flags) -> Option<String>) -> Vec<Objection> {
    let columns = measurement.emission.len().max(1);
    let cells = measurement.values.iter().zip(&measurement.flags).enumerate();
    let objecting = cells.filter_map(|(k, (value, flags))| objects(*value, Flags(*flags)).map(|what| (k, what)));
    objecting.map(|(k, what)| ((k / columns, k % columns), what)).collect()
}

pub(in super::super) fn unknown_bits(context: &Context<'_>, found: &mut Finder) {
    each(
        context,
        found,
        name::VALUE_FLAG,
        "the bits in `flag_masks`",
        |census| census.flagged,
        |_, flags| (flags.unknown_bits() != 0).then(|| format!("bits {:#06x}", flags.unknown_bits())),
    );
}

pub(in super::super) fn nan_without_reason(context: &Context<'_>, found: &mut Finder) {
    each(
        context,
        found,
        name::VALUE,
        "a flag that says why there is no value",
        |census| census.values.not_finite,
        |value, flags| (value.is_nan() && !flags.explains_absence()).then(|| "NaN without a reason".to_owned()),
    );
}

pub(in super::super) fn infinite(context: &Context<'_>, found: &mut Finder) {
    each(
        context,
        found,
        name::VALUE,
        "a finite number, or NaN with a reason",
        |census| census.values.not_finite,
        |value, _| value.is_infinite().then(|| value.to_string()),
    );
}

pub(in super::super) fn value_not_measured(context: &Context<'_>, found: &mut Finder) {
    each(
        context,
        found,
        name::VALUE,
        "NaN",
        |census| census.flagged,
        |value, flags| {
            let absent = [Flag::NotMeasured, Flag::NotMeasuredByDesign].into_iter().find(|flag| flags.contains(*flag));
            absent.filter(|_| !value.is_nan()).map(|flag| format!("{value} although `{}`", flag.name()))
        },
    );
}

pub(in super::super) fn no_value(context: &Context<'_>, found: &mut Finder) {
    // A dark signal may well lie on the floor throughout.
    let lit = [Role::Sample, Role::White];
    for (path, measurement, census) in context.counted().filter(|(_, measurement, _)| lit.contains(&measurement.role)) {
        let usable = |(value, flags): (&f64, &u16)| value.is_finite() && !Flags(*flags).explains_absence();
        let ordinary = !census.values.not_finite && !census.flagged;
        if ordinary || measurement.values.is_empty() {
            continue;
        }
        if !measurement.values.iter().zip(&measurement.flags).any(usable) {
            let what = format!("{} values, of which none is usable", measurement.values.len());
            found.add(Place::path(format!("{path}/{}", name::VALUE)), what, "at least one usable value");
        }
    }
}
