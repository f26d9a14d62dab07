//! From a plan to a document: raw measurements by role, lights, and the factor where there is a white reference.

use ndarray::Array2;

use super::angles::{Angles, check_habit, coverage};
use super::error::{ImportError, fault};
use super::keys::Settings;
use super::noise::{Noise, RECORD_SCALE};
use super::plan::{Entry, Plan};
use super::receipt::{Notes, listed};
use super::record::Record;
use super::{Options, factor, floor, parts, spectra, times};
use crate::dataset::{Acquisition, Document, Id, Light, LightSpectrum, Measurement, Place, Role};
use crate::quantity::{
    Component, CorrelatedOver, EmissionAxis, Flag, Flags, Geometry, Part, Quantity, QuantityKind, Uncertainty,
    WavelengthAxis,
};

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
    for (light, entry) in lights(&plan, notes) {
        if document.lights.iter().any(|known| known.id == light.id) {
            let text =
                format!("{}: a second spectrum of the light `{}`; the first is kept", entry.record.label(), light.id);
            notes.notice(entry.place.clone(), text);
        } else {
            document.lights.push(light);
        }
    }
    let noise = noise(&plan, notes);
    let mut measurements = raw_measurements(&plan, noise.as_ref());
    if plan.of(Role::White).next().is_some() && plan.of(Role::Sample).next().is_some() {
        let (reference, derived) = factor::derive(&plan, &measurements, noise.as_ref(), options, notes)?;
        for raw in measurements.iter_mut().filter(|raw| raw.role == Role::White) {
            raw.white_reference = Some(reference.id.clone());
        }
        document.white_references.push(reference);
        measurements.push(derived);
    } else if plan.scan && plan.of(Role::Sample).next().is_some() {
        notes.notice(plan.place.clone(), "no white reference: the scan stays radiance, no factor is derived");
    }
    attach(&mut document, measurements, &plan, notes);
    Ok(document)
}

fn attach(document: &mut Document, measurements: Vec<Measurement>, plan: &Plan, notes: &mut Notes) {
    let details = plan.entries.iter().find(|entry| entry.record.rejection.is_none()).map(|entry| &entry.record.details);
    for mut measurement in measurements {
        if measurement.role == Role::Sample {
            parts::attach_sample(document, &mut measurement, &plan.settings, notes);
        }
        parts::attach_instrument(document, &mut measurement, details, &plan.settings, notes);
        parts::attach_lights(document, &measurement);
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

/// The first record with data among entries.
fn first_record<'a>(mut entries: impl Iterator<Item = &'a Entry>) -> Option<&'a Record> {
    entries.find(|entry| entry.record.rejection.is_none()).map(|entry| &entry.record)
}

/// Samples, whites and darks share one axis and one quantity; a lamp may have its own.
fn require_one_axis_and_kind(plan: &Plan) -> Result<(), ImportError> {
    let measured = || plan.entries.iter().filter(|entry| entry.role != Role::Lamp && entry.record.rejection.is_none());
    let Some(first) = first_record(measured()) else { return Ok(()) };
    for entry in measured() {
        let record = &entry.record;
        if record.kind != first.kind {
            return Err(ImportError::Contradiction(fault(
                record.place(),
                format!("a mixed quantity: {} in {}, {} in {}", record.kind, record.label(), first.kind, first.label()),
                "one quantity in a set",
                "import the sets apart, or give irradiance of the lamp the role `lamp`",
            )));
        }
        if record.nm != first.nm {
            return Err(ImportError::Contradiction(fault(
                record.place(),
                format!("{} in {} where {} has {}", range(record), record.label(), first.label(), range(first)),
                "one wavelength axis in a set",
                "import the sets apart, or look for lost rows",
            )));
        }
    }
    Ok(())
}

fn range(record: &Record) -> String {
    match (record.nm.first(), record.nm.last()) {
        (Some(first), Some(last)) => format!("{} wavelengths from {first} to {last} nm", record.nm.len()),
        _ => "no wavelengths".to_owned(),
    }
}

fn note_floor(plan: &mut Plan, notes: &mut Notes) {
    // Lamps have an axis and a range of their own.
    let (lamps, mut measured): (Vec<Entry>, Vec<Entry>) =
        std::mem::take(&mut plan.entries).into_iter().partition(|entry| entry.role == Role::Lamp);
    let found = floor::flag_floor(&mut measured);
    let instrument = measured.iter().any(|entry| entry.record.is_pr650_like());
    plan.entries = measured;
    plan.entries.extend(lamps);
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
         (at most 5e-6 and a thousandth of the largest value, four wavelengths shared by two records): known at {} \
         wavelengths; {} samples of {} records within 1 % of it are flagged below-detection, their values kept",
        found.wavelengths, found.samples, found.records
    );
    notes.assume(plan.place.clone(), text);
}

fn note_stale(plan: &mut Plan, notes: &mut Notes) {
    for index in floor::flag_stale(&mut plan.entries) {
        let (before, copy) = (&plan.entries[index - 1], &plan.entries[index]);
        let text = format!(
            "{} is bit for bit equal to {} before it: the instrument may have repeated an old buffer; flagged stale-buffer",
            copy.record.label(),
            before.record.label()
        );
        notes.notice(copy.record.place(), text);
    }
}

fn check_scan(plan: &Plan, notes: &mut Notes) -> Result<(), ImportError> {
    let geometries: Vec<Geometry> = plan.of(Role::Sample).filter_map(|entry| entry.geometry).collect();
    if let Some(Angles::Signed(habit)) = plan.settings.angles {
        check_habit(&geometries, habit, plan.place.clone())?;
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

fn lights<'a>(plan: &'a Plan, notes: &mut Notes) -> Vec<(Light, &'a Entry)> {
    let mut lights = Vec::new();
    for entry in plan.of(Role::Lamp) {
        let record = &entry.record;
        let name = entry.light.as_deref().or(record.title.as_deref()).unwrap_or("lamp");
        let axis = WavelengthAxis::new(record.nm.clone(), parts::bandpass(&plan.settings, record.details.bandpass_nm));
        let spectrum = axis.ok().filter(|_| record.rejection.is_none()).map(|axis| LightSpectrum {
            quantity: quantity(record, &plan.settings),
            axis,
            values: record.values.clone(),
            flags: record.flags.iter().map(|flags| flags.0).collect(),
        });
        let id = Id::from_title(name);
        if let Some(spectrum) = &spectrum {
            for field in spectrum.quantity.unstated_fields() {
                notes.unfilled(format!("lights/{id}/spectrum/quantity/{field}"));
            }
        }
        lights.push((Light { id, title: Some(name.to_owned()), spectrum }, entry));
    }
    lights
}

/// What the numbers of a record are.
pub(super) fn quantity(record: &Record, settings: &Settings) -> Quantity {
    if record.dialect == "columns" || record.kind == QuantityKind::Unstated {
        return Quantity {
            kind: record.kind,
            ..Settings { quantity: Some(record.kind), ..settings.clone() }.quantity()
        };
    }
    // An instrument sees all the light that comes: a total.
    Quantity::absolute(record.kind, settings.part.unwrap_or(Part::Total))
}

/// The noise model, for radiances of the PR-6xx family.
fn noise(plan: &Plan, notes: &mut Notes) -> Option<Noise> {
    let measured: Vec<Entry> = plan.entries.iter().filter(|entry| entry.role != Role::Lamp).cloned().collect();
    let record = first_record(measured.iter())?;
    let ratio_asked = measured.iter().any(|entry| entry.role == Role::White) && record.kind == QuantityKind::Unstated;
    if !record.is_pr650_like() || !(record.kind == QuantityKind::SpectralRadiance || ratio_asked) {
        return None;
    }
    notes.assume(plan.place.clone(), Noise::describe());
    Some(Noise::of(&measured))
}

/// The raw measurements: one per role in a scan or where there is a reference, else one per file.
fn raw_measurements(plan: &Plan, noise: Option<&Noise>) -> Vec<Measurement> {
    let mut raw = Vec::new();
    let together = plan.scan || plan.of(Role::White).next().is_some();
    for (role, id) in [(Role::Sample, ""), (Role::White, "white"), (Role::Dark, "dark")] {
        let entries: Vec<(usize, &Entry)> =
            plan.entries.iter().enumerate().filter(|(_, entry)| entry.role == role).collect();
        if entries.is_empty() {
            continue;
        }
        if together || role != Role::Sample {
            let id = if role == Role::Sample { sample_id(&entries) } else { id };
            raw.extend(measurement(plan, Id::from_title(id), role, &entries, noise));
        } else {
            for (id, entries) in by_file(&entries) {
                raw.extend(measurement(plan, id, role, &entries, noise));
            }
        }
    }
    raw
}

fn sample_id(entries: &[(usize, &Entry)]) -> &'static str {
    match first_record(entries.iter().map(|(_, entry)| *entry)).map(|record| record.kind) {
        Some(QuantityKind::SpectralRadiance) => "radiance",
        Some(QuantityKind::SpectralIrradiance) => "irradiance",
        _ => "spectra",
    }
}

/// Records of one file and name, with their positions in the plan.
type Named<'a> = (&'a str, Option<&'a str>, Vec<(usize, &'a Entry)>);

/// Groups of records: those of one file together, records with a name of their own apart. Ids from the names.
fn by_file<'a>(entries: &[(usize, &'a Entry)]) -> Vec<(Id, Vec<(usize, &'a Entry)>)> {
    let mut groups: Vec<Named<'_>> = Vec::new();
    for (index, entry) in entries {
        let (file, title) = (entry.record.file.as_str(), entry.record.title.as_deref());
        match groups.iter_mut().find(|(known, name, _)| (*known, *name) == (file, title)) {
            Some((_, _, group)) => group.push((*index, *entry)),
            None => groups.push((file, title, vec![(*index, *entry)])),
        }
    }
    let mut taken = std::collections::BTreeSet::new();
    let unique = |file: &str, title: Option<&str>| {
        let stem =
            std::path::Path::new(file).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        let base = title.map_or_else(|| Id::from_title(&stem), Id::from_title);
        let mut id = base.clone();
        for number in 2_u32.. {
            if taken.insert(id.clone()) {
                break;
            }
            let short: String = base.as_str().chars().take(52).collect();
            id = Id::from_title(&format!("{short}-{number}"));
        }
        id
    };
    let mut unique = unique;
    groups.into_iter().map(|(file, title, group)| (unique(file, title), group)).collect()
}

/// The raw measurement of some entries; `None` where none of them holds data and so no axis is known.
fn measurement(
    plan: &Plan,
    id: Id,
    role: Role,
    entries: &[(usize, &Entry)],
    noise: Option<&Noise>,
) -> Option<Measurement> {
    let all = plan.entries.iter().filter(|entry| entry.role != Role::Lamp);
    let record = first_record(entries.iter().map(|(_, entry)| *entry)).or_else(|| first_record(all))?;
    let axis =
        WavelengthAxis::new(record.nm.clone(), parts::bandpass(&plan.settings, record.details.bandpass_nm)).ok()?;
    let shape = (entries.len(), axis.nm.len());
    let mut values = Array2::from_elem(shape, f64::NAN);
    let mut flags = Array2::from_elem(shape, 0_u16);
    let mut sigma = Array2::from_elem(shape, f64::NAN);
    for (row, (_, entry)) in entries.iter().enumerate() {
        let rejected = entry.record.rejection.as_ref().map(|(flag, _)| *flag);
        for column in 0..shape.1 {
            let at = (row, column);
            if let Some(flag) = rejected {
                flags[at] = flag.bit();
                continue;
            }
            let mask = entry.record.flags.get(column).copied().unwrap_or(Flags::NONE.with(Flag::NotMeasured));
            values[at] = entry.record.values.get(column).copied().unwrap_or(f64::NAN);
            flags[at] = mask.0;
            let step = entry.record.steps.get(column).copied().unwrap_or(0.0);
            sigma[at] = noise.map_or(f64::NAN, |noise| noise.sigma(values[at], step, mask, column));
        }
    }
    let components = noise.map(|_| record_scale(RECORD_SCALE)).into_iter().collect();
    Some(Measurement {
        id,
        title: record.title.clone().filter(|_| !plan.scan).or_else(|| plan.settings.title.clone()),
        quantity: quantity(record, &plan.settings),
        role,
        sample: None,
        instrument: None,
        white_reference: None,
        emission: EmissionAxis::Wavelengths(axis),
        excitations: plan.excitations.list.clone(),
        acquisitions: entries.iter().map(|(order, entry)| acquisition(plan, *order, entry)).collect(),
        values,
        flags,
        uncertainty: Uncertainty { standard: noise.map(|_| sigma), components },
        derivation: None,
    })
}

/// The scale error of a record, shared by its wavelengths.
pub(super) fn record_scale(relative: f64) -> Component {
    Component {
        name: "record scale".to_owned(),
        relative: vec![relative],
        correlated_over: CorrelatedOver::Wavelengths,
    }
}

fn acquisition(plan: &Plan, order: usize, entry: &Entry) -> Acquisition {
    let details = &entry.record.details;
    let zone = plan.settings.time_zone.as_deref();
    let printed = || details.local_time.as_deref().and_then(|text| times::rfc3339(text, zone));
    Acquisition {
        geometry: entry.geometry,
        excitation: entry.excitation,
        order: u32::try_from(order).unwrap_or(u32::MAX),
        repeats: 1,
        time: entry.time.clone().or_else(printed),
        exposure_ms: entry.exposure_ms.or(details.exposure_ms),
        quality_code: entry.record.quality,
    }
}

/// Says once for a list of spectra what a scan would have said in its manifest.
pub(super) fn note_plain_list(plan: &Plan, notes: &mut Notes) {
    let unknown: Vec<(Place, String)> = plan
        .of(Role::Sample)
        .filter(|entry| entry.geometry.is_none())
        .map(|entry| (entry.record.place(), format!("{}: its geometry is unknown", entry.record.label())))
        .collect();
    spectra::note_each(notes, unknown, "records without a geometry");
}
