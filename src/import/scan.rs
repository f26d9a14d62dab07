//! From a plan to a document: raw measurements by role, lights, and the factor where there is a white reference.

use super::angles::{Angles, check_habit, coverage};
use super::details;
use super::error::{ImportError, fault};
use super::plan::{Entry, Plan, first_record};
use super::receipt::{Notes, listed};
use super::record::Record;
use super::{Options, factor, floor, parts, raw, repeats, spectra, times};
use crate::dataset::{Document, Measurement, Place, Role};
use crate::quantity::{Geometry, QuantityKind};

/// Assembles the document of a plan.
///
/// # Errors
/// [`ImportError`] where no record holds data, where records contradict each other, and where the declared sign
/// convention contradicts the empty diagonal.
pub(super) fn assemble(mut plan: Plan, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    plan.check_repeats()?;
    require_data(&plan)?;
    require_one_axis_and_kind(&plan)?;
    note_floor(&mut plan, notes);
    note_stale(&mut plan, notes);
    check_scan(&plan, notes)?;
    note_times(&plan, notes);
    let mut document = parts::document(&plan.settings);
    for (light, entry) in raw::lights(&plan, notes) {
        if document.lights.iter().any(|known| known.id == light.id) {
            let text = format!("a second spectrum of the light `{}`; the first is kept", light.id);
            notes.notice(entry.record.place(), text);
        } else {
            document.lights.push(light);
        }
    }
    let noise = raw::noise(&plan, notes);
    let mut measurements = raw::measurements(&plan, options.repeats, noise.as_ref());
    if plan.of(Role::White).next().is_some() && plan.of(Role::Sample).next().is_some() {
        let (reference, derived) = factor::derive(&plan, &measurements, noise.as_ref(), options, notes)?;
        for white in measurements.iter_mut().filter(|raw| raw.role == Role::White) {
            white.white_reference = Some(reference.id.clone());
        }
        document.white_references.push(reference);
        measurements.push(derived);
    } else {
        if plan.scan && plan.of(Role::Sample).next().is_some() {
            notes.notice(plan.place.clone(), "no white reference: the scan stays radiance, no factor is derived");
        }
        let means = repeats::average(&plan, &measurements, noise.as_ref(), options.repeats, notes);
        measurements.extend(means);
    }
    attach(&mut document, measurements, &plan, notes);
    details::fill(&mut document, &plan.settings.details)?;
    Ok(document)
}

fn attach(document: &mut Document, measurements: Vec<Measurement>, plan: &Plan, notes: &mut Notes) {
    let details = plan.entries.iter().find(|entry| entry.record.rejection.is_none()).map(|entry| &entry.record.details);
    for mut measurement in measurements {
        if measurement.role == Role::Sample {
            parts::attach_sample(document, &mut measurement, &plan.settings, notes);
        }
        parts::attach_instrument(document, &mut measurement, details, &plan.settings, notes);
        parts::attach_lights(document, &measurement, &plan.settings);
        parts::list_unfilled(&measurement, notes);
        document.measurements.push(measurement);
    }
}

fn require_data(plan: &Plan) -> Result<(), ImportError> {
    let rejected = plan.entries.iter().find_map(|entry| entry.record.rejection.as_ref().map(|why| (entry, why)));
    match rejected {
        Some((entry, (_, why))) if plan.entries.iter().all(|entry| entry.record.rejection.is_some()) => {
            Err(ImportError::Refused(fault(
                entry.record.place(),
                format!("{why}, no data"),
                "at least one spectrum that the instrument calls a measurement",
                "measure again (overload: a shorter exposure or less light; weak light: more of it)",
            )))
        }
        None if plan.entries.is_empty() => Err(ImportError::Call(fault(
            plan.place.clone(),
            "no records",
            "at least one spectrum",
            "name files with spectra",
        ))),
        _ => Ok(()),
    }
}

/// Samples, whites and darks share one axis and one quantity; a lamp may have its own.
fn require_one_axis_and_kind(plan: &Plan) -> Result<(), ImportError> {
    let measured = || plan.entries.iter().filter(|entry| entry.role != Role::Lamp && entry.record.rejection.is_none());
    let Some(first) = first_record(measured()) else { return Ok(()) };
    require_stated_kind(plan, first)?;
    for entry in measured() {
        let record = &entry.record;
        if record.kind != first.kind {
            return Err(ImportError::Contradiction(fault(
                record.place(),
                format!("a mixed quantity: {} where {} holds {}", record.kind, first.label(), first.kind),
                "one quantity in a set",
                "import the sets apart, or give irradiance of the lamp the role `lamp`",
            )));
        }
        if record.nm != first.nm {
            return Err(ImportError::Contradiction(fault(
                record.place(),
                format!("{} where {} has {}", range(record), first.label(), range(first)),
                "one wavelength axis in a set",
                "import the sets apart, or look for lost rows",
            )));
        }
    }
    Ok(())
}

/// A stated quantity that the records' unit code contradicts is two truths. A ratio is stated of what is derived.
fn require_stated_kind(plan: &Plan, first: &Record) -> Result<(), ImportError> {
    use QuantityKind::{SpectralIrradiance, SpectralRadiance};
    let Some(stated) = plan.settings.quantity else { return Ok(()) };
    let is_raw = |kind: QuantityKind| matches!(kind, SpectralRadiance | SpectralIrradiance);
    if stated == first.kind || !is_raw(stated) || !is_raw(first.kind) {
        return Ok(());
    }
    Err(ImportError::Contradiction(fault(
        plan.place.clone(),
        format!("a mixed quantity: {stated} is stated, {} in {}", first.kind, first.label()),
        "one quantity",
        "correct the statement; the instrument's unit code says what a record is",
    )))
}

fn range(record: &Record) -> String {
    match (record.nm.first(), record.nm.last()) {
        (Some(first), Some(last)) => format!("{} wavelengths from {first} to {last} nm", record.nm.len()),
        _ => "no wavelengths".to_owned(),
    }
}

fn note_floor(plan: &mut Plan, notes: &mut Notes) {
    let found = floor::flag_floor(&mut plan.entries);
    let mut measured = plan.entries.iter().filter(|entry| entry.role != Role::Lamp);
    let instrument = measured.any(|entry| entry.record.is_pr650_like());
    if !instrument {
        return;
    }
    if found.wavelengths == 0 {
        let text = "no shared floor of the instrument was seen in this set; samples on it, if any, are not flagged";
        notes.assume(plan.place.clone(), text);
        return;
    }
    let text = format!(
        "the instrument's floor is the smallest value of the set where two or more records print it with the same digits \
         (at most 5e-6 and a thousandth of the largest value, four wavelengths shared by two records), times a scale of \
         each record (its exposure lifts it) that four wavelengths agree on, alone or with records of the same scale or \
         of the same product of scale and exposure: known at {} wavelengths; {} samples of {} records within 1 % of it \
         are flagged below-detection, their values kept",
        found.wavelengths, found.samples, found.records
    );
    notes.assume(plan.place.clone(), text);
}

fn note_stale(plan: &mut Plan, notes: &mut Notes) {
    for index in floor::flag_stale(&mut plan.entries) {
        let (before, copy) = (&plan.entries[index - 1], &plan.entries[index]);
        let text = format!(
            "bit for bit equal to {} before it: the instrument may have repeated an old buffer; flagged stale-buffer",
            before.record.label()
        );
        notes.notice(copy.record.place(), text);
    }
}

fn check_scan(plan: &Plan, notes: &mut Notes) -> Result<(), ImportError> {
    let geometries: Vec<Geometry> = plan.of(Role::Sample).filter_map(|entry| entry.geometry).collect();
    if let Some(Angles::Signed(habit)) = plan.settings.angles {
        check_habit(&geometries, habit, plan.settings.place_of("angles", plan.place.clone()))?;
    }
    note_coverage(&geometries, plan.place.clone(), notes);
    Ok(())
}

/// Says how much of the grid is there, and what is missing: by design on the retro diagonal, as gaps elsewhere.
pub(super) fn note_coverage(geometries: &[Geometry], place: Place, notes: &mut Notes) {
    let Some(coverage) = coverage(geometries) else { return };
    let mut text = format!("coverage: {} of {} cells of the grid of in-plane angles", coverage.present, coverage.cells);
    if coverage.retro_gap > 0 {
        text += &format!("; {} cells of the retro diagonal not measured by design", coverage.retro_gap);
    }
    if coverage.gaps.is_empty() {
        text += "; no other gap";
    } else {
        let gaps: Vec<String> = coverage.gaps.iter().map(|(i, v)| format!("({i}, {v})")).collect();
        text += &format!("; {} gaps (theta_i, theta_v; mirror at equal): {}", gaps.len(), listed(&gaps));
    }
    notes.notice(place, text);
}

fn note_times(plan: &Plan, notes: &mut Notes) {
    let zone = plan.settings.time_zone.as_deref();
    let untold = |entry: &&Entry| {
        let local = entry.record.details.local_time.as_deref();
        entry.time.is_none() && local.is_some_and(|text| times::rfc3339(text, zone).is_none())
    };
    let unplaced: Vec<String> = plan
        .entries
        .iter()
        .filter(untold)
        .map(|entry| format!("{}: {}", entry.record.label(), entry.record.details.local_time.as_deref().unwrap_or("")))
        .collect();
    if !unplaced.is_empty() {
        let text = format!("times without a zone are not filled (state `time-zone`): {}", listed(&unplaced));
        notes.notice(plan.place.clone(), text);
    }
}

/// Says once for a list of spectra what a scan would have said in its manifest.
pub(super) fn note_plain_list(plan: &Plan, notes: &mut Notes) {
    let unknown = plan.of(Role::Sample).filter(|entry| entry.geometry.is_none());
    spectra::note_each(notes, unknown.map(|entry| entry.record.place()).collect(), "the geometry is unknown");
}
