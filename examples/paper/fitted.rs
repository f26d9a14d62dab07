//! What `bbrf fit --json` printed, beside what was put in.

use std::error::Error;
use std::path::Path;

use serde_json::Value;

use crate::scan::objects::{OBJECTS, Object};

/// A parameter as it was found and as it was put in.
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) found: f64,
    /// Stated standard uncertainty, with what all values share.
    pub(crate) uncertainty: f64,
    pub(crate) truth: f64,
}

/// A fit of one object.
#[derive(Debug)]
pub(crate) struct Fitted {
    pub(crate) object: &'static Object,
    /// The band that was fitted, nm.
    pub(crate) band_nm: (f64, f64),
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) reduced_chi_square: f64,
    /// R.m.s. departure of the average over viewing from a cosine, relative to its amplitude.
    pub(crate) from_cosine: f64,
    /// R.m.s. departure of the average over incidence from a constant, relative.
    pub(crate) from_constant: f64,
}

impl Parameter {
    /// How far the found is from the truth, in its stated standard uncertainties.
    pub(crate) fn deviation(&self) -> f64 {
        (self.found - self.truth) / self.uncertainty
    }
}

/// The fits in the folders below `folder`, in the paper's order of objects.
///
/// # Errors
/// When a file cannot be read or lacks what is looked for.
pub(crate) fn read_all(folder: &Path) -> Result<Vec<Fitted>, Box<dyn Error>> {
    let present = OBJECTS.iter().filter(|object| folder.join(object.name).is_dir());
    present.map(|object| read(&folder.join(object.name), object)).collect()
}

fn read(folder: &Path, object: &'static Object) -> Result<Fitted, Box<dyn Error>> {
    let fit = json(&folder.join("fit.json"))?;
    let truth = json(&folder.join("truth.json"))?;
    let model = &fit["models"][0];
    let reduction = model["reduction"].as_str().and_then(|text| text.strip_prefix("band:"));
    let (from, to) = reduction.and_then(|band| band.split_once('-')).ok_or("fit.json: no band")?;
    let band_nm = (from.parse()?, to.parse()?);
    let mut parameters = Vec::new();
    for term in model["terms"].as_array().ok_or("fit.json: no terms")? {
        for (name, parameter) in term["parameters"].as_object().ok_or("fit.json: no parameters")? {
            let found = number(&parameter["value"])?;
            let shared = parameter["shared_relative_uncertainty"].as_f64().unwrap_or(0.0);
            let uncertainty = number(&parameter["standard_uncertainty"])?.hypot(shared * found);
            let truth = match name.as_str() {
                "albedo" if parameter["unit"] == "1" => albedo(&truth, band_nm)?,
                "albedo" => radiance(&truth, band_nm)?,
                _ => number(&truth["torrance-sparrow"][name])?,
            };
            parameters.push(Parameter { name: name.clone(), found, uncertainty, truth });
        }
    }
    let check = &model["separability"];
    Ok(Fitted {
        object,
        band_nm,
        parameters,
        reduced_chi_square: number(&model["residual"]["reduced_chi_square"])?,
        from_cosine: number(&check["cosine_relative_rms"])?,
        from_constant: number(&check["constancy_relative_rms"])?,
    })
}

/// Reflected and luminescent light in the band over what falls in there.
fn albedo(truth: &Value, band_nm: (f64, f64)) -> Result<f64, Box<dyn Error>> {
    let irradiance = in_band(truth, "irradiance", band_nm)?;
    let leaving = in_band(truth, "albedo", band_nm)?.iter().zip(&irradiance).map(|(y, e)| y * e).sum::<f64>();
    Ok(leaving / irradiance.iter().sum::<f64>())
}

/// Luminescent radiance in the band at normal incidence, W m-2 sr-1: the values are 4 nm apart.
fn radiance(truth: &Value, band_nm: (f64, f64)) -> Result<f64, Box<dyn Error>> {
    Ok(4.0 * in_band(truth, "luminescent_radiance_at_normal_incidence", band_nm)?.iter().sum::<f64>())
}

fn in_band(truth: &Value, name: &str, (from, to): (f64, f64)) -> Result<Vec<f64>, Box<dyn Error>> {
    let list = |name: &str| truth[name].as_array().ok_or(format!("truth.json: no {name}"));
    let inside = list("emission_nm")?.iter().zip(list(name)?).filter(|(nm, _)| {
        let nm = nm.as_f64().unwrap_or(f64::NAN);
        (from..=to).contains(&nm)
    });
    inside.map(|(_, value)| number(value)).collect()
}

/// A number of a result.
///
/// # Errors
/// When it is none.
pub(crate) fn number(value: &Value) -> Result<f64, Box<dyn Error>> {
    value.as_f64().ok_or_else(|| format!("expected a number, found {value}").into())
}

/// A file of JSON.
///
/// # Errors
/// With its name, when it cannot be read.
pub(crate) fn json(path: &Path) -> Result<Value, Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()).into())
}
