//! The spectrum of a surface that a command is given: a text of columns or any other spectrum that `bbrf import` reads, or a
//! measurement of a file.

use std::path::{Path, PathBuf};

use miette::miette;

use super::material::{or_none, split};
use crate::cli::opened::open;
use crate::dataset::{Document, Measurement, Role};
use crate::donaldson::estimate::Spectrum;
use crate::import::{Options, Settings, import};
use crate::quantity::{EmissionAxis, Flag, QuantityKind};

/// Reads a spectrum; `kind` is what its numbers are where it does not say, `noise` their relative standard uncertainty where it
/// has none. Remarks say how it was read.
pub(in crate::cli) fn load(
    name: &str,
    kind: Option<QuantityKind>,
    noise: Option<f64>,
) -> Result<(Spectrum, Vec<String>), miette::Report> {
    let (path, id) = split(name);
    if Path::new(path).extension().is_some_and(|extension| extension == "bbrf") {
        let document = open(path.as_ref())?.document;
        return of_measurement(name, pick(&document, path, id)?, kind, noise);
    }
    let settings = Settings { quantity: kind, ..Settings::default() };
    let options = Options { role: Some(Role::Sample), allow_partial_grid: true, settings, ..Options::default() };
    let document = import(&[PathBuf::from(name)], &options).map_err(|error| miette!("{error}"))?;
    of_measurement(name, pick(&document, name, None)?, kind, noise)
}

fn pick<'a>(document: &'a Document, path: &str, id: Option<&str>) -> Result<&'a Measurement, miette::Report> {
    let ids = || or_none(document.measurements.iter().map(|one| one.id.to_string()).collect::<Vec<_>>().join(", "));
    match (id, document.measurements.as_slice()) {
        (Some(id), _) => {
            document.measurement(id).ok_or_else(|| miette!("{path}: no measurement `{id}`; the file has: {}", ids()))
        }
        (None, [one]) => Ok(one),
        (None, _) => Err(miette!("{path}: expected one measurement, found: {}; name one as {path}#ID", ids())),
    }
}

fn of_measurement(
    name: &str,
    measurement: &Measurement,
    kind: Option<QuantityKind>,
    noise: Option<f64>,
) -> Result<(Spectrum, Vec<String>), miette::Report> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else {
        return Err(miette!("{name}: measurement `{}` has no wavelengths; expected a spectrum", measurement.id));
    };
    let mut remarks = Vec::new();
    let kind = match (measurement.quantity.kind, kind) {
        (QuantityKind::Unstated, Some(kind)) => kind,
        (QuantityKind::Unstated, None) => {
            return Err(miette!(
                help = "say it with `--quantity radiance-factor` or `--quantity spectral-radiance`",
                "{name}: does not say what its numbers are; expected a radiance factor or a spectral radiance"
            ));
        }
        (stated, _) => stated,
    };
    let excluded = Flag::ALL.iter().filter(|flag| flag.excludes_from_fit()).fold(0, |mask, flag| mask | flag.bit());
    let rows = measurement.values.nrows();
    if rows > 1 {
        remarks.push(format!("{name}: the mean of {rows} rows"));
    }
    let sigmas = measurement.uncertainty.standard.as_ref();
    if sigmas.is_none() && noise.is_none() {
        return Err(miette!(
            help = "say it with `--noise 0.01` for 1 %",
            "{name}: has no standard uncertainty; without one nothing says what fits"
        ));
    }
    let most = measurement.values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    let column = |column: usize| {
        let usable: Vec<usize> = (0..rows).filter(|row| measurement.flags[(*row, column)] & excluded == 0).collect();
        let count = usable.len() as f64;
        let value = usable.iter().map(|row| measurement.values[(*row, column)]).sum::<f64>() / count;
        let stated =
            sigmas.map(|sigmas| usable.iter().map(|row| sigmas[(*row, column)].powi(2)).sum::<f64>().sqrt() / count);
        // A relative uncertainty of what is next to nothing would be of a weight that nothing has.
        let relative = noise.map(|noise| noise * value.abs().max(1e-3 * most));
        (value, stated.filter(|sigma| *sigma > 0.0).or(relative).unwrap_or(f64::NAN))
    };
    let (values, sigma) = (0..measurement.values.ncols()).map(column).unzip();
    let nm = if axis.actual_nm.len() == axis.nm.len() { axis.actual_nm.clone() } else { axis.nm.clone() };
    Ok((Spectrum { kind, nm, values, sigma }, remarks))
}
