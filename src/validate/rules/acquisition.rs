//! Are the rows acquisitions: in time, in order, of something?

use std::collections::HashSet;

use jiff::Timestamp;

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Acquisition, Place};

/// Reports the first row of each measurement that a test objects to.
fn first(
    context: &Context<'_>,
    found: &mut Finder,
    dataset: &str,
    expected: &str,
    objects: impl Fn(&Acquisition) -> Option<String>,
) {
    for (path, measurement) in context.measurements() {
        let rows = measurement.acquisitions.iter().enumerate();
        if let Some((row, what)) = rows.filter_map(|(row, at)| objects(at).map(|what| (row, what))).next() {
            found.add(Place::path(format!("{path}/{dataset}")).at_index([row]), what, expected);
        }
    }
}

pub(in super::super) fn time_form(context: &Context<'_>, found: &mut Finder) {
    first(context, found, name::TIME, "a time as in 2026-11-22T10:00:00+09:00 (RFC 3339)", |row| {
        let text = row.time.as_ref()?;
        text.parse::<Timestamp>().err().map(|_| format!("`{text}`"))
    });
}

pub(in super::super) fn time_order(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let mut rows: Vec<(u32, Timestamp, usize)> = (0..)
            .zip(&measurement.acquisitions)
            .filter_map(|(index, row)| Some((row.order, row.time.as_ref()?.parse().ok()?, index)))
            .collect();
        rows.sort_by_key(|(order, _, index)| (*order, *index));
        if let Some([before, after]) = rows.windows(2).find(|pair| pair[0].0 < pair[1].0 && pair[0].1 > pair[1].1) {
            let place = Place::path(format!("{path}/{}", name::TIME)).at_index([after.2]);
            let expected = format!("not before {}, the time of what is earlier in the order", before.1);
            found.add(place, after.1.to_string(), expected);
        }
    }
}

pub(in super::super) fn order_unique(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let mut seen = HashSet::new();
        if let Some(row) = measurement.acquisitions.iter().position(|row| !seen.insert(row.order)) {
            let place = Place::path(format!("{path}/{}", name::ORDER)).at_index([row]);
            let order = measurement.acquisitions[row].order;
            found.add(place, format!("{order} a second time"), "a number of its own for each row");
        }
    }
}

pub(in super::super) fn exposure(context: &Context<'_>, found: &mut Finder) {
    first(context, found, name::EXPOSURE, "a positive time", |row| {
        let exposure = row.exposure_ms?;
        (!(exposure.is_finite() && exposure > 0.0)).then(|| format!("{exposure} ms"))
    });
}

pub(in super::super) fn repeats(context: &Context<'_>, found: &mut Finder) {
    first(context, found, name::REPEATS, "1 or more readings", |row| (row.repeats == 0).then(|| "0".to_owned()));
}

pub(in super::super) fn derivation(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements() {
        let Some(derivation) = &measurement.derivation else { continue };
        let rows_of = |id: &str| document.measurement(id).map(|m| m.acquisitions.len());
        let groups = derivation.reference_group.iter().copied().max().map_or(0, |last| i64::from(last) + 1);
        let lists = [
            (
                name::NUMERATOR_ROW,
                &derivation.numerator_row,
                measurement.acquisitions.len() as i64,
                rows_of(derivation.numerator.as_str()),
            ),
            (name::REFERENCE_GROUP, &derivation.reference_group, i64::MAX, rows_of(derivation.reference.as_str())),
            (name::ROW_REFERENCE, &derivation.row_reference, groups, Some(measurement.acquisitions.len())),
        ];
        for (list, indices, below, length) in lists {
            let place = Place::path(format!("{path}/{}/{list}", name::DERIVATION));
            if let Some(at) = indices.iter().position(|index| !(-1..below).contains(&i64::from(*index))) {
                found.add(
                    place.clone().at_index([at]),
                    indices[at].to_string(),
                    format!("-1, or an index below {below}"),
                );
            }
            if length.is_some_and(|length| length != indices.len()) {
                let expected = length.map_or(String::new(), |length| format!("{length}, one for each row"));
                found.add(place, format!("{} indices", indices.len()), expected);
            }
        }
    }
}
