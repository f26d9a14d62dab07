//! Raw measurements and lights, as the records give them.

use std::collections::BTreeMap;
use std::path::Path;

use ndarray::Array2;

use super::keys::Settings;
use super::noise::{Noise, RECORD_SCALE, kept};
use super::parts;
use super::plan::{Entry, Plan, first_record};
use super::receipt::Notes;
use super::record::Record;
use super::times;
use super::unique::UniqueIds;
use crate::dataset::{Acquisition, Conditions, Id, Light, LightSpectrum, Measurement, Role};
use crate::quantity::{
    Component, CorrelatedOver, EmissionAxis, Flag, Flags, Part, Quantity, QuantityKind, Uncertainty, WavelengthAxis,
};

/// The lights that lamp records give, with their entries.
pub(super) fn lights<'a>(plan: &'a Plan, notes: &mut Notes) -> Vec<(Light, &'a Entry)> {
    let mut lights = Vec::new();
    for entry in plan.of(Role::Lamp) {
        let record = &entry.record;
        let name = entry.light.as_deref().or(record.title.as_deref()).unwrap_or("lamp");
        let axis = WavelengthAxis::new(record.nm.clone(), parts::bandpass(&plan.settings, Some(&record.details)));
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
        let make = record.details.make.clone();
        lights.push((Light { id, title: Some(name.to_owned()), make, spectrum, ..Light::default() }, entry));
    }
    lights
}

/// What the numbers of a record are.
pub(super) fn quantity(record: &Record, settings: &Settings) -> Quantity {
    use QuantityKind::{RelativeSpectrum, Unstated};
    if record.dialect == "columns" || matches!(record.kind, Unstated | RelativeSpectrum) {
        return Quantity {
            kind: record.kind,
            ..Settings { quantity: Some(record.kind), ..settings.clone() }.quantity()
        };
    }
    // An instrument sees all the light that comes: a total.
    Quantity::absolute(record.kind, settings.part.unwrap_or(Part::Total))
}

/// The noise model, for radiances of the PR-6xx family.
pub(super) fn noise(plan: &Plan, notes: &mut Notes) -> Option<Noise> {
    let measured: Vec<Entry> = plan.entries.iter().filter(|entry| entry.role != Role::Lamp).cloned().collect();
    let record = first_record(measured.iter())?;
    let ratio_asked = measured.iter().any(|entry| entry.role == Role::White) && record.kind == QuantityKind::Unstated;
    if !record.is_pr650_like() || !(record.kind == QuantityKind::SpectralRadiance || ratio_asked) {
        return None;
    }
    notes.assume(plan.place.clone(), Noise::describe());
    Some(Noise::of(&measured))
}

/// The raw measurements: one per role in a scan, of repeats, and where there is a reference; else one per file.
pub(super) fn measurements(plan: &Plan, repeats: bool, noise: Option<&Noise>) -> Vec<Measurement> {
    let mut raw = Vec::new();
    let together = repeats || plan.scan || plan.of(Role::White).next().is_some();
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
    let mut known = BTreeMap::new();
    for (index, entry) in entries {
        let name = (entry.record.file.as_str(), entry.record.title.as_deref());
        let at = *known.entry(name).or_insert(groups.len());
        match groups.get_mut(at) {
            Some((_, _, group)) => group.push((*index, *entry)),
            None => groups.push((name.0, name.1, vec![(*index, *entry)])),
        }
    }
    let mut ids = UniqueIds::default();
    let mut id = |file: &str, title: Option<&str>| {
        let stem = Path::new(file).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
        ids.of(title.unwrap_or(&stem))
    };
    groups.into_iter().map(|(file, title, group)| (id(file, title), group)).collect()
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
    let axis = WavelengthAxis::new(record.nm.clone(), parts::bandpass(&plan.settings, Some(&record.details))).ok()?;
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
            sigma[at] = noise.map_or(f64::NAN, |noise| kept(noise.sigma(entry, column)));
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
        values: values.into_shared(),
        flags: flags.into_shared(),
        uncertainty: Uncertainty { standard: noise.map(|_| sigma.into_shared()), components, ..Uncertainty::default() },
        conditions: Conditions::default(),
        direction_tests: Vec::new(),
        derivation: None,
    })
}

/// The scale error of a record, shared by its wavelengths.
pub(super) fn record_scale(relative: f64) -> Component {
    Component::new("record scale", vec![relative], CorrelatedOver::Wavelengths)
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
