//! `bbrf donaldson estimate`: a matrix from spectra under a few known lights.

mod result;
mod shape;

use std::path::PathBuf;

use miette::miette;

pub(crate) use self::result::EstimateResult;
use super::{light_source, material, spectrum_source};
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_message, print_text};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::{self, measurement_digest};
use crate::dataset::{Document, Id, Step};
use crate::donaldson::estimate::{self, Axes, Estimate, Excitation, Lit, Seen, third_light};
use crate::donaldson::{Light, Parts};
use crate::quantity::QuantityKind;

/// Estimate a matrix from spectra under two or more known broadband lights
///
/// Each spectrum is reflected light and luminescence: r(em) E(em) + m(em) x (what the excitation spectrum takes of the light below).
/// With `--excitation` two lights tell the two apart, except in the bands that are named. Without it what fits is a set of excitation
/// spectra: the intervals are over all of them. All intervals are of 95 %, the printed prior included. A spectrum is a
/// radiance factor, or a spectral radiance under a light in W m-2 nm-1.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  bbrf donaldson estimate --under A=a.csv --under D65=d65.csv --noise 0.01 --quantity radiance-factor
  bbrf donaldson estimate --under lamp.csv=x.bbrf#x-1 --under D65=x.bbrf#x-2 --excitation dye.bbrf -o matrix.bbrf")]
pub(crate) struct Arguments {
    /// A light and the spectrum of the surface under it; the light as `donaldson predict` takes it; two times or more
    #[arg(long = "under", required = true, value_name = "LIGHT=SPECTRUM", value_parser = pair)]
    under: Vec<(String, String)>,
    /// The excitation spectrum, where it is known: a file with a factorisation (FILE.bbrf or FILE.bbrf#ID), or two columns (nm, value)
    #[arg(long, value_name = "FILE")]
    excitation: Option<String>,
    /// Relative standard uncertainty of spectra that state none
    #[arg(long, value_name = "SHARE", value_parser = share)]
    noise: Option<f64>,
    /// What the numbers of spectra are that do not say it: radiance-factor or spectral-radiance
    #[arg(long)]
    quantity: Option<QuantityKind>,
    /// Emission and excitation step, and the emission width, nm
    #[arg(long, default_value = "10", value_name = "NM", value_parser = positive)]
    step: f64,
    /// Emission wavelengths, nm
    #[arg(long, default_value = "400:700", value_name = "FROM:TO", value_parser = range)]
    emission: (f64, f64),
    /// The shortest excitation, nm
    #[arg(long, default_value = "300", value_name = "NM", value_parser = positive)]
    excitation_from: f64,
    /// Lights of which the one that would help most is named [default: those of the CIE]
    #[arg(long = "candidate", value_name = "LIGHT")]
    candidates: Vec<String>,
    /// The id of the matrix
    #[arg(long, default_value = "estimate")]
    id: String,
    /// Write the matrix, its parts and its factors
    #[arg(short, long, value_name = "FILE.bbrf")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// So many excitations take a minute, and no broadband light tells more.
const MOST: usize = 250;

fn pair(text: &str) -> Result<(String, String), String> {
    let (light, spectrum) = text.split_once('=').ok_or("expected LIGHT=SPECTRUM, as D65=under_d65.csv")?;
    if light.is_empty() || spectrum.is_empty() {
        return Err("expected LIGHT=SPECTRUM, as D65=under_d65.csv".to_owned());
    }
    Ok((light.to_owned(), spectrum.to_owned()))
}

fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "expected a positive number".to_owned())
}

fn share(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok().filter(|x| (1e-6..=1.0).contains(x));
    number.ok_or_else(|| "expected a share from 0.000001 to 1, as 0.01 for 1 %".to_owned())
}

fn range(text: &str) -> Result<(f64, f64), String> {
    let expected = || "expected FROM:TO in nm, as 400:700".to_owned();
    let (from, to) = text.split_once(':').ok_or_else(expected)?;
    let (from, to) = (positive(from).map_err(|_| expected())?, positive(to).map_err(|_| expected())?);
    if from < to { Ok((from, to)) } else { Err(expected()) }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if let Some(output) = &arguments.output {
        let under = arguments.under.iter().flat_map(|(light, spectrum)| [light, spectrum]);
        let read = under.chain(&arguments.excitation).chain(&arguments.candidates);
        refuse_overwriting(output, read.map(|name| PathBuf::from(material::split(name).0)))?;
    }
    let axes = axes(arguments)?;
    let (mut lights, mut seen) = (Vec::new(), Vec::new());
    for (light, spectrum) in &arguments.under {
        let loaded = light_source::load(light)?;
        let (spectrum, remarks) = spectrum_source::load(spectrum, arguments.quantity, arguments.noise)?;
        loaded.remarks.iter().chain(&remarks).for_each(|remark| print_message(&format!("bbrf: {remark}")));
        warn_unlit(&loaded.light, &axes);
        seen.push(Seen::of(&loaded.light, &spectrum, &axes).map_err(|error| miette!("{error}"))?);
        lights.push(loaded.light);
    }
    let known = match &arguments.excitation {
        Some(name) => Some(shape::load(name, &axes)?),
        None => None,
    };
    let excitation = known.as_deref().map_or(Excitation::Unknown, Excitation::Known);
    let found = estimate::estimate(&axes, &seen, excitation).map_err(|error| miette!("{error}"))?;
    if let Some(contradiction) = found.contradiction() {
        print_message(&format!("bbrf: warning: {contradiction}"));
    }
    let candidates = candidates(arguments, &lights, &axes)?;
    let (helpful, now) = third_light(&axes, &found, &seen, &candidates).map_err(|error| miette!("{error}"))?;
    let names: Vec<String> = lights.iter().map(|light| light.name().to_owned()).collect();
    let mut result = EstimateResult::new(&arguments.id, &names, &axes, &found, known.is_some(), (&helpful, now));
    if let Some(output) = &arguments.output {
        let document = document(arguments, &axes, &found, &names)?;
        container::write_file(&document, output).map_err(|error| miette!("{error}"))?;
        result.file = Some(output.display().to_string());
    }
    if arguments.json {
        print_json("bbrf:donaldson-estimate:1", &result)?;
    } else {
        print_text(&result.text())?;
    }
    Ok(Outcome::Done)
}

/// Emissions, and excitations on the same raster, so that reflected light has cells of its own.
fn axes(arguments: &Arguments) -> Result<Axes, miette::Report> {
    let (step, (from, to)) = (arguments.step, arguments.emission);
    let first = arguments.excitation_from;
    let count = ((to - from) / step + 1e-9).floor() as usize + 1;
    if first > from {
        return Err(miette!(
            "--excitation-from {first}, --emission {from}:{to}: expected excitations that begin at {from} nm or below: what is excited at the \
             wavelength of its emission or below counts"
        ));
    }
    let below = ((from - first) / step + 1e-9).floor() as usize;
    if count < 3 || count + below > MOST {
        return Err(miette!(
            "--step {step}, --emission {from}:{to}, --excitation-from {first}: {count} emissions and {} excitations; expected 3 to {MOST}",
            count + below
        ));
    }
    let at = |k: usize| from + step * k as f64;
    let excitation_nm = (0..below).rev().map(|k| from - step * (k + 1) as f64).chain((0..count).map(at)).collect();
    Ok(Axes { excitation_nm, emission_nm: (0..count).map(at).collect(), width_nm: step })
}

/// A light that has no value where the surface may be excited counts as dark there, which it was not.
fn warn_unlit(light: &Light, axes: &Axes) {
    let (from, to) = light.range_nm();
    let (first, last) = (axes.excitation_nm[0], axes.emission_nm[axes.emission_nm.len() - 1]);
    if from > first || to < last {
        print_message(&format!(
            "bbrf: warning: light `{}` has values from {from} to {to} nm; the matrix is asked for from {first} to {last} nm. It is \
             taken as dark elsewhere: what it excites there counts as excited elsewhere",
            light.name()
        ));
    }
}

/// Lights that are not in use already.
fn candidates(arguments: &Arguments, lights: &[Light], axes: &Axes) -> Result<Vec<Lit>, miette::Report> {
    let offered: Vec<Light> = if arguments.candidates.is_empty() {
        Light::names().into_iter().filter_map(Light::named).collect()
    } else {
        let load = |name: &String| Ok(light_source::load(name)?.light);
        arguments.candidates.iter().map(load).collect::<Result<_, miette::Report>>()?
    };
    let is_new = |light: &&Light| lights.iter().all(|used| used.name() != light.name());
    // Candidates are as bright as the lights in use.
    let mean = |lit: &Lit| lit.emission.iter().sum::<f64>() / lit.emission.len() as f64;
    let bright = lights.first().map_or(1.0, |light| mean(&Lit::of(light, axes)));
    let scaled = |light: &Light| {
        let own = mean(&Lit::of(light, axes));
        if own > 0.0 { Some(Lit::of(&light.scaled(bright / own), axes)) } else { None }
    };
    Ok(offered.iter().filter(is_new).filter_map(scaled).collect())
}

fn document(
    arguments: &Arguments,
    axes: &Axes,
    found: &Estimate,
    lights: &[String],
) -> Result<Document, miette::Report> {
    let id = Id::from_title(&arguments.id);
    let measurement = estimate::matrix(axes, found, id).map_err(|error| miette!("{error}"))?;
    let digest = measurement_digest(&measurement).map_err(|error| miette!("{error}"))?;
    let parts = estimate::parts(&measurement, axes, found, lights, &digest)
        .ok_or_else(|| miette!("the estimate has no emission wavelengths"))?;
    let Parts { elastic, luminescent, factorisation } = parts;
    let mut document = Document::default();
    let spectra: Vec<String> =
        arguments.under.iter().map(|(light, spectrum)| format!("{spectrum} under {light}")).collect();
    document.provenance.steps.push(Step::by_this_program(format!(
        "`{}` estimated from {}; its numbers are the best of what fits, its uncertainties hold the prior: {}",
        measurement.id,
        spectra.join(", "),
        found.prior
    )));
    document.measurements.extend([measurement, elastic, luminescent]);
    document.factorisations.push(factorisation);
    Ok(document)
}
