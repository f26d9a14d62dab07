//! Does the chain of calibrations hold?

use jiff::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;

use super::super::Context;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Calibration, Measurement, Place};

/// Every link of a chain with its path.
fn links<'a>(context: &Context<'a>) -> Vec<(String, &'a Calibration)> {
    let Some(document) = context.document() else { return Vec::new() };
    let mut links = Vec::new();
    let mut take = |list: &str, id: &str, chain: &'a [Calibration]| {
        links.extend(chain.iter().enumerate().map(|(k, link)| (format!("/{list}/{id}/calibration_{k}"), link)));
    };
    document.instruments.iter().for_each(|part| take(name::INSTRUMENT, part.id.as_str(), &part.calibration));
    document.lights.iter().for_each(|part| take(name::LIGHT, part.id.as_str(), &part.calibration));
    document.white_references.iter().for_each(|part| take(name::WHITE_REFERENCE, part.id.as_str(), &part.calibration));
    links
}

fn date(text: Option<&String>) -> Option<Date> {
    text?.parse().ok()
}

pub(in super::super) fn date_form(context: &Context<'_>, found: &mut Finder) {
    for (path, link) in links(context) {
        for (field, text) in [("date", &link.date), ("expires", &link.expires)] {
            if let Some(text) = text.as_ref().filter(|text| text.parse::<Date>().is_err()) {
                found.add(Place::path(format!("{path}@{field}")), format!("`{text}`"), "a day as in 2026-11-22");
            }
        }
    }
}

pub(in super::super) fn order(context: &Context<'_>, found: &mut Finder) {
    for (path, link) in links(context) {
        if let (Some(date), Some(expires)) = (date(link.date.as_ref()), date(link.expires.as_ref()))
            && expires < date
        {
            found.add(Place::path(format!("{path}@expires")), expires.to_string(), format!("a day after {date}"));
        }
    }
}

/// The last day on which a row of the measurement was taken, in UTC.
fn last_day(measurement: &Measurement) -> Option<Date> {
    let times = measurement.acquisitions.iter().filter_map(|row| row.time.as_ref()?.parse::<Timestamp>().ok());
    times.max().map(|time| time.to_zoned(TimeZone::UTC).date())
}

pub(in super::super) fn expired(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements() {
        let Some(day) = last_day(measurement) else { continue };
        let uses = [
            (name::INSTRUMENT, measurement.instrument.as_ref()),
            (name::WHITE_REFERENCE, measurement.white_reference.as_ref()),
        ];
        for (list, id) in uses.into_iter().filter_map(|(list, id)| Some((list, id?.as_str()))) {
            let chain = match list {
                name::INSTRUMENT => {
                    document.instruments.iter().find(|part| part.id.as_str() == id).map(|part| &part.calibration)
                }
                _ => document.white_references.iter().find(|part| part.id.as_str() == id).map(|part| &part.calibration),
            };
            for (k, link) in chain.into_iter().flatten().enumerate() {
                if let Some(expires) = date(link.expires.as_ref()).filter(|expires| *expires < day) {
                    let place = Place::path(format!("/{list}/{id}/calibration_{k}@expires"));
                    found.add(place, expires.to_string(), format!("{day} or later, when {path} was measured"));
                }
            }
        }
    }
}

pub(in super::super) fn missing(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for instrument in document.instruments.iter().filter(|instrument| instrument.calibration.is_empty()) {
        let place = Place::path(format!("/{}/{}", name::INSTRUMENT, instrument.id));
        found.add(place, "no calibration", "artefact, certificate, day and expiry of its calibration");
    }
    for reference in document
        .white_references
        .iter()
        .filter(|reference| reference.calibration.is_empty() && reference.certificate.is_none())
    {
        let place = Place::path(format!("/{}/{}", name::WHITE_REFERENCE, reference.id));
        found.add(place, "no certificate", "the certificate that its factor rests on");
    }
}
