//! `bbrf eval`: forward values of a model over a list of geometries.

mod complete;
mod uncertainty;

use std::path::PathBuf;

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::model_source::{Loaded, ValueMeaning, load};
use crate::cli::output::{print_json, print_message, print_text};
use crate::dataset::predict;
use crate::donaldson::{By, Extend};
use crate::import::{GeometryRow, read_geometries};
use crate::quantity::Reference;
use crate::terms::{Factors, Term, TermKind, TorranceSparrow};

const EXAMPLES: &str = "\
Examples:
  bbrf eval --model fitted.bbrf --geometry g.csv --uncertainty
  bbrf eval --model whole.bbrf#scan-auto --geometry g.csv --light D65
  bbrf eval --model whole.bbrf --geometry g.csv --light lamp.csv --json
  bbrf eval --model whole.bbrf --geometry g.csv --excitation 375 --excitation 450";

/// Evaluate a model: Y/E of its elastic terms, one row per geometry
///
/// The column `value` is the sum of the elastic terms (lambertian, torrance-sparrow) without a reference: a Lambertian term
/// of albedo a gives a cos(theta_i), exactly 0 at 90 degrees. It is Y/E (pi times the radiance over the irradiance of a
/// surface across the beam) where the model was fitted to a factor, and in the unit of the fitted number where it was
/// fitted to a radiance. For the factor against a reference divide by what that received: cos(theta_i) in the same
/// geometry, cos(theta_ref) in a fixed one. A model of a band gives the value of that band; one of many wavelengths gives
/// a row for each that has a model (`emission_nm`), and those without are named on standard error. Luminescent terms have
/// a column of their own.
///
/// A complete model (`bbrf fit --donaldson`) also says what a surface radiates at every emission: with `--light` pi times the
/// radiance Y = luminescent + diffuse + specular under that light across the beam, with `--excitation` the luminescence as a
/// density (nm-1) and reflection as a line (a radiance factor), each with its standard uncertainty.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The model: FILE.bbrf#ID (FILE.bbrf where it holds one model), or a JSON file {"terms": [...]}
    #[arg(long)]
    model: String,
    /// CSV with the columns theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg, or, under a line
    /// `# angles: signed, mirror-at-equal`, theta_i_deg,theta_v_deg
    #[arg(long)]
    geometry: PathBuf,
    /// Add phi_rad, D, G, F of the specular term
    #[arg(long)]
    factors: bool,
    /// Add the standard uncertainty (k = 1) of `value` from the covariance of the model's parameters
    ///
    /// `standard_uncertainty` is what the independent errors of the data leave; `shared_relative_uncertainty`, where the model
    /// has it, is relative, the same for all values of the model (white reference, certificate) and not contained in the
    /// other. An entry is empty where the model has no covariance for a parameter that the value depends on; which, is said on
    /// standard error.
    #[arg(long)]
    uncertainty: bool,
    /// Of a complete model: pi times the radiance under this light, D65, A, FL11, ... of the CIE, a text of two columns (nm, value),
    /// or FILE.bbrf#ID
    #[arg(long, conflicts_with_all = ["factors", "uncertainty", "excitation"], value_name = "LIGHT")]
    light: Option<String>,
    /// Of a complete model: what light of this wavelength becomes, nm; repeat for several
    #[arg(long, conflicts_with_all = ["factors", "uncertainty"], value_name = "NM")]
    excitation: Vec<f64>,
    /// What the light does where it has no value: zero, or flat: it goes on at its first and last
    #[arg(long, default_value = "zero", requires = "light")]
    extend: Extend,
    /// With `--light`: values alone, without their uncertainties
    #[arg(long, requires = "light")]
    values: bool,
    /// With `--values`: how the light is brought in, integrals (exact) or product (samples of a step times a table);
    /// `bbrf cost eval --model` measures what that loses
    #[arg(long, default_value = "integrals", requires = "values")]
    by: By,
    /// Step of the samples, nm, from 0.5 to 50
    #[arg(long, default_value_t = 5.0, value_name = "NM", requires = "values")]
    step: f64,
    /// Print JSON instead of CSV
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct EvalResult {
    /// What `value` is.
    value: ValueMeaning,
    rows: Vec<EvalRow>,
}

/// One geometry and emission value.
#[derive(Debug, Serialize, JsonSchema)]
struct EvalRow {
    /// Incidence: angle from the normal, degrees.
    theta_i_deg: f64,
    phi_i_deg: f64,
    theta_v_deg: f64,
    phi_v_deg: f64,
    /// Emission wavelength, where the model has several.
    emission_nm: Option<f64>,
    /// Sum of the elastic terms, as `value` beside `rows` says; `null` where a term has no value.
    value: Option<f64>,
    /// Sum of the luminescent terms likewise, where the model has any.
    luminescent: Option<f64>,
    /// With `--uncertainty`: standard uncertainty of `value` from the independent errors; `null` where it cannot be formed.
    #[serde(skip_serializing_if = "Option::is_none")]
    standard_uncertainty: Option<Option<f64>>,
    /// With `--uncertainty`: that of `luminescent`.
    #[serde(skip_serializing_if = "Option::is_none")]
    luminescent_standard_uncertainty: Option<Option<f64>>,
    /// With `--uncertainty`: relative standard uncertainty that all values of the model share, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    shared_relative_uncertainty: Option<f64>,
    #[serde(rename = "phi_rad")]
    phi: Option<f64>,
    #[serde(rename = "D")]
    d: Option<f64>,
    #[serde(rename = "G")]
    g: Option<f64>,
    #[serde(rename = "F")]
    f: Option<f64>,
    #[serde(skip)]
    signed: Option<(f64, f64)>,
}

pub(crate) use complete::EvalCompleteResult;

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if arguments.light.is_some() || !arguments.excitation.is_empty() {
        return complete::run(arguments);
    }
    let Loaded { bands, value, covariance, .. } = load(&arguments.model)?;
    let specular = match (arguments.factors, bands.first()) {
        (true, Some((_, terms))) => Some(only_specular(terms)?),
        _ => None,
    };
    let geometries = read_geometries(&arguments.geometry).map_err(|error| miette!("{error}"))?;
    let mut rows = Vec::with_capacity(geometries.len() * bands.len());
    let mut undefined = 0_usize;
    if let [first, .., last] | [first @ last] = value.without_model_nm[..] {
        let count = value.without_model_nm.len();
        print_message(&format!(
            "bbrf: {}: no row for {count} wavelengths of the measurement from {first} to {last} nm, which have no model",
            arguments.model
        ));
    }
    let mut unknown = uncertainty::Unknown::default();
    for geometry in &geometries {
        for ((emission_nm, terms), covariance) in bands.iter().zip(&covariance) {
            let mut row = evaluate(geometry, *emission_nm, terms, specular);
            if arguments.uncertainty {
                uncertainty::add(&mut row.0, geometry, terms, covariance, &mut unknown);
            }
            if let Err(problem) = &row.1 {
                let file = arguments.geometry.display();
                print_message(&format!("bbrf: {file}, line {}: {problem}", geometry.line));
                undefined += 1;
            }
            rows.push(row.0);
        }
    }
    unknown.print(&arguments.model);
    if arguments.json {
        print_json("bbrf:eval:1", &EvalResult { value, rows })?;
    } else {
        print_text(&csv(&rows, arguments.factors, arguments.uncertainty))?;
    }
    Ok(if undefined == 0 { Outcome::Done } else { Outcome::Failed })
}

fn only_specular(terms: &[Term]) -> Result<TorranceSparrow, miette::Report> {
    let mut specular = terms.iter().filter_map(|term| match term {
        Term::TorranceSparrow(term) => Some(*term),
        _ => None,
    });
    match (specular.next(), specular.next()) {
        (Some(one), None) => Ok(one),
        (None, _) => Err(miette!("--factors: the model has no torrance-sparrow term, so there is no D, G or F")),
        (Some(_), Some(_)) => {
            Err(miette!("--factors: the model has several torrance-sparrow terms; give one of them alone"))
        }
    }
}

fn evaluate(
    row: &GeometryRow,
    emission_nm: Option<f64>,
    terms: &[Term],
    specular: Option<TorranceSparrow>,
) -> (EvalRow, Result<(), String>) {
    let geometry = &row.geometry;
    let prediction = predict(terms, geometry, &Reference::None);
    let factors: Option<Factors> = specular.and_then(|term| term.factors(geometry).ok());
    let has_luminescent = terms.iter().any(|term| term.kind() == TermKind::Luminescent);
    let value = prediction.as_ref().ok();
    let result = EvalRow {
        theta_i_deg: geometry.incidence.theta_deg(),
        phi_i_deg: geometry.incidence.phi_deg(),
        theta_v_deg: geometry.viewing.theta_deg(),
        phi_v_deg: geometry.viewing.phi_deg(),
        emission_nm,
        value: value.map(|p| p.elastic),
        luminescent: value.filter(|_| has_luminescent).map(|p| p.luminescent),
        standard_uncertainty: None,
        luminescent_standard_uncertainty: None,
        shared_relative_uncertainty: None,
        phi: factors.map(|f| f.phi_rad),
        d: factors.map(|f| f.d),
        g: factors.map(|f| f.g),
        f: factors.map(|f| f.f),
        signed: row.signed,
    };
    (result, prediction.map(|_| ()).map_err(|undefined| undefined.to_string()))
}

/// CSV: the angle columns as they came, then the values, numbers in their shortest form that reads back.
fn csv(rows: &[EvalRow], factors: bool, uncertainty: bool) -> String {
    let signed = rows.first().is_some_and(|row| row.signed.is_some());
    let spectral = rows.iter().any(|row| row.emission_nm.is_some());
    let luminescent = rows.iter().any(|row| row.luminescent.is_some());
    let shared = rows.iter().any(|row| row.shared_relative_uncertainty.is_some());
    let mut header =
        if signed { "theta_i_deg,theta_v_deg" } else { "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg" }.to_owned();
    header.push_str(if spectral { ",emission_nm" } else { "" });
    header.push_str(",value");
    header.push_str(if luminescent { ",luminescent" } else { "" });
    if uncertainty {
        header.push_str(",standard_uncertainty");
        header.push_str(if luminescent { ",luminescent_standard_uncertainty" } else { "" });
        header.push_str(if shared { ",shared_relative_uncertainty" } else { "" });
    }
    header.push_str(if factors { ",phi_rad,D,G,F" } else { "" });
    let mut lines = vec![header];
    for row in rows {
        let mut fields: Vec<String> = match row.signed {
            Some((i, v)) => vec![i, v],
            None => vec![row.theta_i_deg, row.phi_i_deg, row.theta_v_deg, row.phi_v_deg],
        }
        .into_iter()
        .map(|angle| angle.to_string())
        .collect();
        let optional = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
        fields.extend(spectral.then(|| optional(row.emission_nm)));
        fields.push(optional(row.value));
        fields.extend(luminescent.then(|| optional(row.luminescent)));
        if uncertainty {
            fields.push(optional(row.standard_uncertainty.flatten()));
            fields.extend(luminescent.then(|| optional(row.luminescent_standard_uncertainty.flatten())));
            fields.extend(shared.then(|| optional(row.shared_relative_uncertainty)));
        }
        if factors {
            fields.extend([row.phi, row.d, row.g, row.f].map(optional));
        }
        lines.push(fields.join(","));
    }
    lines.join("\n")
}
