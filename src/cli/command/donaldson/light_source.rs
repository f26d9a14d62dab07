//! The light that a command is given: a name of the CIE, a light or a lamp measurement of a file, or a text of two columns.

use std::path::{Path, PathBuf};

use miette::miette;

use super::material::{or_none, split};
use crate::cli::opened::open;
use crate::cli::output::print_message;
use crate::dataset::{Document, Measurement, Role};
use crate::donaldson::{Extend, Light};
use crate::import::{Options, import};
use crate::quantity::{EmissionAxis, Flag, QuantityKind, WavelengthAxis};

/// Lights as commands are told them.
#[derive(Debug, clap::Args)]
pub(in crate::cli::command) struct Lights {
    /// A light: D65, A, C, E, FL2, LED-B1, ... of the CIE; a text of two columns (nm, value) or another spectrum that `bbrf import`
    /// reads; FILE.bbrf#ID. Of `predict` the second and further are compared with the first
    #[arg(long = "light", default_value = "D65", value_name = "LIGHT")]
    pub(in crate::cli::command) names: Vec<String>,
    /// What a light does where it has no value: zero, or flat: it goes on at its first and last
    #[arg(long, default_value = "zero")]
    pub(in crate::cli::command) extend: Extend,
}

impl Lights {
    /// Reads them, with remarks on standard error.
    pub(in crate::cli::command) fn load(&self) -> Result<Vec<Light>, miette::Report> {
        let one = |name: &String| {
            let loaded = load(name)?;
            loaded.remarks.iter().for_each(|remark| print_message(&format!("bbrf: {remark}")));
            Ok(loaded.light)
        };
        self.names.iter().map(one).collect()
    }

    /// The words that tell a command the same.
    pub(in crate::cli::command) fn words(&self) -> Vec<String> {
        let mut words: Vec<String> = self.names.iter().flat_map(|name| ["--light".to_owned(), name.clone()]).collect();
        if self.extend != Extend::Zero {
            words.extend(["--extend".to_owned(), self.extend.to_string()]);
        }
        words
    }
}

/// A light, with remarks on how it was read.
pub(in crate::cli) struct Loaded {
    pub(in crate::cli) light: Light,
    pub(in crate::cli) remarks: Vec<String>,
}

/// Reads a light.
pub(in crate::cli) fn load(name: &str) -> Result<Loaded, miette::Report> {
    if let Some(light) = Light::named(name) {
        return Ok(Loaded { light, remarks: Vec::new() });
    }
    let (path, id) = split(name);
    if Path::new(path).extension().is_some_and(|extension| extension == "bbrf") {
        return of_document(name, path, id, &open(path.as_ref())?.document);
    }
    if !Path::new(name).is_file() {
        return Err(miette!(
            help = "name a light of the CIE, or a file: two columns (nm, value), a spectrum that `bbrf import` reads, FILE.bbrf#ID",
            "light {name}: found neither a file nor a light of the CIE; expected one of {}, or another daylight as D60",
            Light::names().join(", ")
        ));
    }
    let options = Options { role: Some(Role::Lamp), allow_partial_grid: true, ..Options::default() };
    let document = import(&[PathBuf::from(name)], &options).map_err(|error| miette!("{error}"))?;
    let records: u64 = document.provenance.receipts.iter().flat_map(|one| &one.inputs).map(|one| one.records).sum();
    if records > 1 {
        return Err(miette!(
            help = "keep the column or the record that is the light",
            "light {name}: found {records} spectra; expected one: two columns (nm, value), or one record"
        ));
    }
    of_document(name, name, None, &document)
}

/// What a document may offer as a light.
enum Offer<'a> {
    Light(&'a crate::dataset::Light, &'a crate::dataset::LightSpectrum),
    Measurement(&'a Measurement),
}

impl Offer<'_> {
    fn id(&self) -> &str {
        match self {
            Self::Light(light, _) => light.id.as_str(),
            Self::Measurement(measurement) => measurement.id.as_str(),
        }
    }
}

fn of_document(name: &str, path: &str, id: Option<&str>, document: &Document) -> Result<Loaded, miette::Report> {
    let lights = document.lights.iter().filter_map(|light| Some(Offer::Light(light, light.spectrum.as_ref()?)));
    let lamps = document.measurements.iter().filter(|one| id.is_some() || one.role == Role::Lamp);
    let offers: Vec<Offer<'_>> = lights.chain(lamps.map(Offer::Measurement)).collect();
    let names = || or_none(offers.iter().map(|offer| offer.id().to_owned()).collect::<Vec<_>>().join(", "));
    let offer = match (id, offers.as_slice()) {
        (Some(id), all) => all
            .iter()
            .find(|offer| offer.id() == id)
            .ok_or_else(|| miette!("light {name}: no light or measurement `{id}`; the file has: {}", names()))?,
        (None, [one]) => one,
        (None, []) => {
            return Err(miette!("light {name}: found no light with a spectrum and no lamp measurement; expected one"));
        }
        (None, _) => return Err(miette!("light {name}: holds several lights ({}); name one as {path}#ID", names())),
    };
    match offer {
        Offer::Light(_, spectrum) => {
            let values = spectrum.values.iter().zip(&spectrum.flags);
            let values = values.map(|(value, flags)| (*value, *flags)).collect();
            finish(name, spectrum.quantity.kind, &spectrum.axis, values, Vec::new())
        }
        Offer::Measurement(measurement) => of_measurement(name, measurement),
    }
}

/// The mean of its rows.
fn of_measurement(name: &str, measurement: &Measurement) -> Result<Loaded, miette::Report> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else {
        return Err(miette!("light {name}: measurement `{}` has no wavelengths; expected a spectrum", measurement.id));
    };
    let rows = measurement.values.nrows();
    let mean = |column: usize| {
        let usable = || (0..rows).filter(|row| measurement.flags[(*row, column)] & excluded() == 0);
        let sum: f64 = usable().map(|row| measurement.values[(row, column)]).sum();
        (sum / usable().count() as f64, 0)
    };
    let values = (0..measurement.values.ncols()).map(mean).collect();
    let remarks = if rows > 1 { vec![format!("{name}: the mean of {rows} rows")] } else { Vec::new() };
    finish(name, measurement.quantity.kind, axis, values, remarks)
}

fn excluded() -> u16 {
    Flag::ALL.iter().filter(|flag| flag.excludes_from_fit()).fold(0, |mask, flag| mask | flag.bit())
}

fn finish(
    name: &str,
    kind: QuantityKind,
    axis: &WavelengthAxis,
    values: Vec<(f64, u16)>,
    mut remarks: Vec<String>,
) -> Result<Loaded, miette::Report> {
    let (light, more) = Light::of_values(name, kind, axis, &values).map_err(|error| miette!("{name}: {error}"))?;
    remarks.extend(more);
    Ok(Loaded { light, remarks })
}
