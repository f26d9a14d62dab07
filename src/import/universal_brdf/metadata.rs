//! What `metadata` says, as far as our document has a place for it; the rest stays in the tree.

use super::file::File;
use super::json::Json;
use super::quantities::{CELSIUS, MILLIMETRES, NANOMETRES, PER_CENT, STERADIANS, take_quantity};
use crate::dataset::{Conditions, Document, Id, Measurement, Step, Symmetry, WhiteReference};
use crate::import::error::{ImportError, quoted};
use crate::import::keys::Settings;
use crate::import::receipt::Notes;
use crate::quantity::Finite;

const INSTRUMENT: [&str; 2] = ["metadata", "instrumentation"];
const LIGHTING: [&str; 3] = ["metadata", "instrumentation", "illumination_system"];
const DETECTION: [&str; 3] = ["metadata", "instrumentation", "detection_system"];

/// What no settings hold.
#[derive(Debug, Default)]
pub(super) struct Particulars {
    contact: Option<String>,
    conditions: Conditions,
    sample: SampleParticulars,
    aperture: Option<String>,
    distance_mm: Option<Finite>,
    solid_angle_sr: Option<Finite>,
    light_make: Option<String>,
    reference: Option<WhiteReference>,
    step: Option<Step>,
}

#[derive(Debug, Default)]
struct SampleParticulars {
    holder: Option<String>,
    width_mm: Option<Finite>,
    height_mm: Option<Finite>,
    thickness_mm: Option<Finite>,
    symmetry: Option<Symmetry>,
}

/// A path below another.
fn below<'a>(base: &[&'a str], rest: &[&'a str]) -> Vec<&'a str> {
    base.iter().chain(rest).copied().collect()
}

/// Checks that the file is what it says, and takes out the name of its schema.
///
/// # Errors
/// [`ImportError::Malformed`] where the type is another.
pub(super) fn identity(file: &mut File, notes: &mut Notes) -> Result<String, ImportError> {
    let kind = file.tree.take_text(&["metadata", "type"]);
    match kind.as_deref() {
        Some("BRDF") => {}
        None => {
            notes.notice(file.at("metadata.type"), "no type, which the schema of the format requires: read as BRDF")
        }
        Some(other) => {
            let advice = "only reflectance distribution functions are defined by the format";
            return Err(file.malformed("metadata.type", None, quoted(other), "`BRDF`", advice));
        }
    }
    let schema = file.tree.take_text(&["metadata", "schema"]);
    if schema.is_none() {
        let text = "no schema, which the schema of the format requires: read as version 1.0";
        notes.notice(file.at("metadata.schema"), text);
    }
    let version = schema.map_or("no schema named".to_owned(), |schema| schema.chars().take(160).collect());
    Ok(format!("universal-brdf, {version}"))
}

/// Takes out what the keys of a table can say.
pub(super) fn settings(file: &mut File) -> Settings {
    let tree = &mut file.tree;
    let mut settings = Settings {
        title: tree.take_text(&["metadata", "description"]),
        license: tree.take_text(&["metadata", "license", "type"]),
        sample: tree.take_text(&["metadata", "sample", "name"]),
        mark: tree.take_text(&["metadata", "sample", "zero_azimuth_location"]),
        material: only_material(tree),
        serial: tree.take_text(&below(&INSTRUMENT, &["serial_number"])),
        light: tree.take_text(&below(&LIGHTING, &["source", "name"])),
        bandpass_nm: only_bandpass(tree, &DETECTION),
        excitation_fwhm_nm: only_bandpass(tree, &LIGHTING),
        ..Settings::default()
    };
    // A model says more than the name of a set-up, which then stays in the extension.
    settings.instrument =
        tree.take_text(&below(&INSTRUMENT, &["model"])).or_else(|| tree.take_text(&below(&INSTRUMENT, &["name"])));
    // Names that repeat another say nothing of their own.
    for (system, known) in [(&LIGHTING, &settings.light), (&DETECTION, &settings.instrument)] {
        let repeated = |json: &mut Json| matches!((&*json, known), (Json::Text(a), Some(b)) if a == b).then_some(());
        tree.take(&below(system, &["name"]), repeated);
    }
    settings.simulated = tree.take(&["metadata", "method"], |json| match json {
        Json::Text(text) if text == "simulation" => Some(true),
        Json::Text(text) if text == "measurement" => Some(false),
        _ => None,
    });
    for section in ["instrumentation", "software", "environment"] {
        tree.take(&["metadata", section], |json| (*json == Json::Text("NA".to_owned())).then_some(()));
    }
    settings
}

/// The name of the material, where there is one and only its name is told.
fn only_material(tree: &mut Json) -> Option<String> {
    tree.take(&["metadata", "sample", "materials"], |json| match json {
        Json::List(list) => match list.as_mut_slice() {
            [Json::Object(one)] if one.len() == 1 => match one.get("name") {
                Some(Json::Text(name)) if !name.contains('\0') => Some(name.clone()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    })
}

/// The bandpass of a monochromator with one setting.
fn only_bandpass(tree: &mut Json, system: &[&str]) -> Option<f64> {
    let path = below(system, &["wavelength_selectors", "monochromator", "settings"]);
    let width = tree.take(&path, |json| match json {
        Json::List(list) => match list.as_mut_slice() {
            [one @ Json::Object(_)] => {
                let width = take_quantity(one, &["bandpass_FWHM"], NANOMETRES)?;
                Some((width.get(), std::mem::take(list)))
            }
            _ => None,
        },
        _ => None,
    });
    let (width, rest) = width?;
    // What else the setting says stays.
    if rest.iter().any(|setting| !setting.is_empty()) {
        tree.put(&path, Json::List(rest));
    }
    (width > 0.0).then_some(width)
}

impl Particulars {
    /// Takes out what only the document itself can say.
    pub(super) fn take(file: &mut File) -> Self {
        let tree = &mut file.tree;
        let mut text = |path: &[&str]| tree.take_text(path);
        let person = text(&["metadata", "provenance", "contact_person"]);
        let email = text(&["metadata", "provenance", "email"]);
        let contact = match (person, email) {
            (Some(person), Some(email)) => Some(format!("{person} <{email}>")),
            (person, email) => person.or(email),
        };
        let conditions = Conditions {
            operator: text(&below(&INSTRUMENT, &["operator_name"])),
            laboratory: text(&["metadata", "provenance", "organization"]),
            environment: text(&["metadata", "environment", "comments"]),
            ..Conditions::default()
        };
        let aperture = text(&below(&DETECTION, &["aperture", "name"]));
        let make = ["manufacturer", "model", "type"].map(|key| text(&below(&LIGHTING, &["source", key])));
        let make: Vec<String> = make.into_iter().flatten().collect();
        Self {
            contact,
            conditions: Conditions {
                temperature_celsius: take_quantity(tree, &["metadata", "environment", "temperature"], CELSIUS),
                humidity_percent: take_quantity(tree, &["metadata", "environment", "relative_humidity"], PER_CENT),
                ..conditions
            },
            sample: SampleParticulars::take(tree),
            aperture,
            distance_mm: take_quantity(tree, &below(&DETECTION, &["distance_from_sample"]), MILLIMETRES),
            solid_angle_sr: take_quantity(tree, &below(&DETECTION, &["solid_angle"]), STERADIANS),
            light_make: (!make.is_empty()).then(|| make.join(", ")),
            reference: reference(tree),
            step: step(tree),
        }
    }

    /// Puts them where they belong.
    pub(super) fn attach(self, document: &mut Document) {
        document.contact = self.contact;
        if let Some(sample) = document.samples.first_mut() {
            sample.holder = self.sample.holder;
            sample.width_mm = self.sample.width_mm;
            sample.height_mm = self.sample.height_mm;
            sample.thickness_mm = self.sample.thickness_mm;
            sample.symmetry = self.sample.symmetry;
        }
        if let Some(instrument) = document.instruments.first_mut() {
            instrument.aperture = self.aperture;
            instrument.distance_mm = self.distance_mm;
            instrument.solid_angle_sr = self.solid_angle_sr;
        }
        if let Some(light) = document.lights.first_mut() {
            light.make = self.light_make;
        }
        for measurement in &mut document.measurements {
            measurement.conditions = Conditions {
                viewing_polarisation: measurement.conditions.viewing_polarisation.take(),
                ..self.conditions.clone()
            };
            measurement.white_reference = self.reference.as_ref().map(|reference| reference.id.clone());
        }
        document.white_references.extend(self.reference);
        document.provenance.steps.extend(self.step);
    }
}

impl SampleParticulars {
    fn take(tree: &mut Json) -> Self {
        let size = ["metadata", "sample", "dimensions"];
        // A length and a width do not say which of them is along the mark.
        let named = tree.at(&below(&size, &["length"])).is_none();
        let mut side = |name| {
            let path = below(&size, &[name]);
            (named || name == "thickness").then(|| take_quantity(tree, &path, MILLIMETRES)).flatten()
        };
        Self {
            width_mm: side("width"),
            height_mm: side("height"),
            thickness_mm: side("thickness"),
            holder: tree.take_text(&["metadata", "sample", "adhoc_section", "holder"]),
            symmetry: tree.take(&["metadata", "sample", "properties_symmetry"], |json| match json {
                Json::Text(text) => text.parse().ok(),
                _ => None,
            }),
        }
    }
}

fn reference(tree: &mut Json) -> Option<WhiteReference> {
    let title = tree.take_text(&below(&INSTRUMENT, &["reference_info", "name"]))?;
    let material = tree.take_text(&below(&INSTRUMENT, &["reference_info", "material"]));
    Some(WhiteReference { id: Id::from_title(&title), title: Some(title), material, ..WhiteReference::default() })
}

/// The program that made the data.
fn step(tree: &mut Json) -> Option<Step> {
    let name = tree.take_text(&["metadata", "software", "name"])?;
    let version = tree.take_text(&["metadata", "software", "version"]);
    let tool = version.map_or_else(|| name.clone(), |version| format!("{name} {version}"));
    let action = tree.take_text(&["metadata", "software", "description"]);
    let time = None;
    Some(Step { tool, action: action.unwrap_or_else(|| "made the data that were imported".to_owned()), time })
}

/// What the measurement rests on that the format does not say.
pub(super) fn assume(file: &File, measurement: &Measurement, notes: &mut Notes) {
    let place = |path: &str| file.at(path);
    notes.assume(
        place("data.phi_i"),
        "azimuths are counted counter-clockwise as seen looking down on the surface: the format names their origin and \
         not their sense",
    );
    notes.assume(
        place("data.theta_i"),
        "the direction of incidence points from the surface to the source: the format does not say",
    );
    if measurement.uncertainty.standard.is_some() && measurement.uncertainty.statement == Default::default() {
        notes.assume(
            place("data.uBRDF"),
            "uncertainties are standard uncertainties (k = 1), independent between values: the format has no coverage \
             factor, distribution or correlation",
        );
    }
}
