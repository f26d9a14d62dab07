//! The object under `metadata`: what the document states, and nothing else.

use serde_json::{Map, Value, json};

use super::convert::Conversion;
use super::{DOMAIN, SCHEMA};
use crate::dataset::{Calibration, Document, Id, Instrument, Light, Measurement, Sample, WhiteReference};
use crate::quantity::{Band, Bandpass, EmissionAxis, Finite, Quantity, QuantityKind};

/// The object, and what the schema of the format requires of it and the document does not say.
pub(super) fn metadata(
    document: &Document,
    measurement: &Measurement,
    conversion: &Conversion,
) -> (Value, Vec<&'static str>) {
    let parts = Parts::of(document, measurement);
    let mut metadata = json!({
        "schema": SCHEMA,
        "type": "BRDF",
        "description": document.title.as_ref().or(measurement.title.as_ref()),
        "method": parts.sample.map(|sample| if sample.simulated { "simulation" } else { "measurement" }),
        "license": { "type": document.license },
        "provenance": provenance(document, measurement),
        "instrumentation": instrumentation(measurement, &parts),
        "software": "NA",
        "sample": parts.sample.map(sample),
        "environment": {
            "temperature": number(measurement.conditions.temperature_celsius, "°C"),
            "relative_humidity": number(measurement.conditions.humidity_percent, "%"),
            "comments": measurement.conditions.environment,
        },
        "adhoc_section": { "bbrf": ours(document, measurement, conversion) },
    });
    prune(&mut metadata);
    if let Value::Object(members) = &mut metadata {
        merge(members, kept(document, "metadata"));
        name_systems(members, &parts);
        if let Some(time) = measurement.acquisitions.iter().find_map(|row| row.time.as_ref()) {
            members.entry("timestamp").or_insert_with(|| Value::from(time.as_str()));
        }
    }
    let missing = REQUIRED.iter().filter(|path| metadata.pointer(&format!("/{}", path.replace('.', "/"))).is_none());
    let missing = missing.copied().collect();
    (metadata, missing)
}

/// The schema requires names of the two systems: those of the light and the instrument, where an import left no other.
fn name_systems(metadata: &mut Map<String, Value>, parts: &Parts<'_>) {
    let light = parts.light.map(|part| named(&part.id, part.title.as_deref()));
    let instrument = parts.instrument.map(|part| named(&part.id, part.model.as_deref()));
    for (system, name) in [("illumination_system", light), ("detection_system", instrument)] {
        let system = metadata.get_mut("instrumentation").and_then(|part| part.get_mut(system));
        if let (Some(Value::Object(system)), Some(name)) = (system, name) {
            system.entry("name").or_insert_with(|| Value::from(name));
        }
    }
}

/// What the schema requires, as far as it is not there by itself.
const REQUIRED: &[&str] = &[
    "id",
    "timestamp",
    "description",
    "method",
    "provenance.organization",
    "provenance.location",
    "provenance.email",
    "provenance.contact_person",
    "license.rights_holder",
    "instrumentation.name",
    "instrumentation.illumination_system.source.power",
    "instrumentation.illumination_system.beam",
    "instrumentation.detection_system.sensors",
    "instrumentation.detection_system.solid_angle",
    "sample.name",
    "sample.type",
    "sample.shape",
    "sample.dimensions",
    "sample.zero_azimuth_location",
    "environment.temperature",
];

/// The parts of the document that the measurement names.
struct Parts<'a> {
    sample: Option<&'a Sample>,
    instrument: Option<&'a Instrument>,
    light: Option<&'a Light>,
    white: Option<&'a WhiteReference>,
}

impl<'a> Parts<'a> {
    fn of(document: &'a Document, measurement: &'a Measurement) -> Self {
        let light = measurement.excitations.iter().find_map(|state| state.light.as_ref());
        Self {
            sample: document.samples.iter().find(|part| Some(&part.id) == measurement.sample.as_ref()),
            instrument: document.instruments.iter().find(|part| Some(&part.id) == measurement.instrument.as_ref()),
            light: document.lights.iter().find(|part| Some(&part.id) == light),
            white: document.white_references.iter().find(|part| Some(&part.id) == measurement.white_reference.as_ref()),
        }
    }
}

fn provenance(document: &Document, measurement: &Measurement) -> Value {
    // As the import joins them: `person <address>`.
    let contact = document.contact.as_deref();
    let split = contact.and_then(|contact| contact.strip_suffix('>')?.rsplit_once(" <"));
    let (person, email) = split.map_or((contact, None), |(person, email)| (Some(person), Some(email)));
    json!({ "organization": measurement.conditions.laboratory, "contact_person": person, "email": email })
}

fn instrumentation(measurement: &Measurement, parts: &Parts<'_>) -> Value {
    let (instrument, light) = (parts.instrument, parts.light);
    let fwhm = measurement.excitations.first().and_then(|state| state.fwhm_nm);
    json!({
        "name": instrument.map(|part| named(&part.id, part.model.as_deref())),
        "serial_number": instrument.and_then(|part| part.serial.as_ref()),
        "operator_name": measurement.conditions.operator,
        "illumination_system": {
            "source": {
                "name": light.map(|part| named(&part.id, part.title.as_deref())),
                "type": light.and_then(|part| part.make.as_ref()),
            },
            "wavelength_selectors": selectors(fwhm),
        },
        "detection_system": {
            "aperture": { "name": instrument.and_then(|part| part.aperture.as_ref()) },
            "distance_from_sample": number(instrument.and_then(|part| part.distance_mm), "mm"),
            "solid_angle": number(instrument.and_then(|part| part.solid_angle_sr), "sr"),
            "wavelength_selectors": selectors(one_bandpass(measurement)),
        },
        "reference_info": {
            "name": parts.white.map(|part| named(&part.id, part.title.as_deref())),
            "material": parts.white.and_then(|part| part.material.as_ref()),
        },
    })
}

fn selectors(fwhm_nm: Option<f64>) -> Value {
    fwhm_nm.map_or(
        Value::Null,
        |fwhm| json!({ "monochromator": { "settings": [{ "bandpass_FWHM": { "value": fwhm, "unit": "nm" } }] } }),
    )
}

/// The bandpass, where it is one number.
pub(super) fn one_bandpass(measurement: &Measurement) -> Option<f64> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else { return None };
    match &axis.bandpass {
        Bandpass::Stated { fwhm_nm, .. } if fwhm_nm.len() == 1 => fwhm_nm.first().copied(),
        _ => None,
    }
}

fn sample(sample: &Sample) -> Value {
    json!({
        "name": named(&sample.id, sample.title.as_deref()),
        "materials": sample.material.as_ref().map(|name| json!([{ "name": name }])),
        "zero_azimuth_location": sample.mark,
        "properties_symmetry": sample.symmetry,
        "dimensions": {
            "width": number(sample.width_mm, "mm"),
            "height": number(sample.height_mm, "mm"),
            "thickness": number(sample.thickness_mm, "mm"),
        },
        "adhoc_section": { "holder": sample.holder },
    })
}

/// What the format has no words for, in its place for additions.
fn ours(document: &Document, measurement: &Measurement, conversion: &Conversion) -> Value {
    let quantity = match conversion {
        Conversion::None => measurement.quantity.clone(),
        // The certified factor is inside the values, and a BRDF has no reference.
        Conversion::Factor(_) => Quantity {
            kind: QuantityKind::Brdf,
            reference: crate::quantity::Reference::None,
            certified_factor: Vec::new(),
            ..measurement.quantity.clone()
        },
    };
    let band: Option<Band> = match &measurement.emission {
        EmissionAxis::Band { band } => *band,
        EmissionAxis::Wavelengths(_) => None,
    };
    let uncertain = measurement.uncertainty.standard.is_some();
    json!({
        "note": "What bbrf says beside the format. Uncertainties are standard uncertainties (k = 1), independent between \
                 values; `components` are relative and shared. Azimuths are counter-clockwise seen from outside.",
        "measurement": measurement.id,
        "title": measurement.title,
        "citation": document.citation,
        "quantity": quantity,
        "band": band,
        "statement": uncertain.then_some(measurement.uncertainty.statement),
        "components": measurement.uncertainty.components,
    })
}

/// The name of a part from which the importer makes the same id: its title where that does, else the id.
fn named(id: &Id, title: Option<&str>) -> String {
    title.filter(|title| Id::from_title(title) == *id).map_or_else(|| id.to_string(), str::to_owned)
}

fn number(number: Option<Finite>, unit: &str) -> Value {
    number.map_or(Value::Null, |number| json!({ "value": number, "unit": unit }))
}

/// Takes out what is null, and objects that hold nothing else; `{"k": {}}` in our own section says something.
fn prune(value: &mut Value) {
    if let Value::Object(members) = value {
        members.values_mut().for_each(prune);
        members.retain(|name, member| {
            let empty = member.as_object().is_some_and(Map::is_empty) && name != "statement";
            !(member.is_null() || empty)
        });
    }
}

/// What an import of the format had no place for, of one of its two sections.
pub(super) fn kept(document: &Document, section: &str) -> Map<String, Value> {
    let extension = document.extensions.iter().find(|part| part.domain.as_str() == DOMAIN);
    let text = extension.and_then(|part| part.content.dataset(section)).and_then(|dataset| dataset.array.as_text());
    match text.and_then(|text| serde_json::from_str(text).ok()) {
        Some(Value::Object(members)) => members,
        _ => Map::new(),
    }
}

/// Adds what is not there; what is there stays.
pub(super) fn merge(into: &mut Map<String, Value>, from: Map<String, Value>) {
    for (name, value) in from {
        match (into.get_mut(&name), value) {
            (Some(Value::Object(here)), Value::Object(there)) => merge(here, there),
            (Some(Value::Array(here)), Value::Array(there)) => merge_lists(here, there),
            (Some(_), _) => {}
            (None, value) => drop(into.insert(name, value)),
        }
    }
}

/// Lists of objects are merged entry by entry: a setting of a monochromator without the bandpass that was taken out.
fn merge_lists(here: &mut [Value], there: Vec<Value>) {
    for (here, there) in here.iter_mut().zip(there) {
        if let (Value::Object(here), Value::Object(there)) = (here, there) {
            merge(here, there);
        }
    }
}

/// True where calibrations are stated, for which the format has no place.
pub(super) fn has_calibration(document: &Document, measurement: &Measurement) -> bool {
    let parts = Parts::of(document, measurement);
    let lists: [&[Calibration]; 3] = [
        parts.instrument.map_or(&[], |part| &part.calibration),
        parts.light.map_or(&[], |part| &part.calibration),
        parts.white.map_or(&[], |part| &part.calibration),
    ];
    lists.iter().any(|list| !list.is_empty())
}
