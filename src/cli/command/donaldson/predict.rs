//! `bbrf donaldson predict`: what surfaces look like under any light.

mod result;
mod sampled;

use std::path::PathBuf;

use super::light_source::Lights;
use super::material;
use super::material::Material;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_message, print_text, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::donaldson::{By, Extend, Light, Luminescence, Observer, Prediction, Reradiation};
pub(crate) use result::PredictResult;
pub(crate) use sampled::SampledResult;

const EXAMPLES: &str = "\
Examples:
  bbrf donaldson predict postit.bbrf --light D65 --light A --light FL11
  bbrf donaldson predict paint.bbrf#orange --light lamp.csv -o spectrum.csv
  bbrf donaldson predict new.bbrf faded.bbrf --light scan.bbrf#sun --observer 10 --json
  bbrf donaldson predict postit.bbrf --compare";

/// Predict spectrum and colour of a matrix under any light
///
/// The matrix is separated into its elastic and luminescent part first (as `bbrf donaldson separate` does), unless the file has its
/// separation stored beside it and the matrix is still the same. Light is shared out
/// between the excitations by exact integrals, so that no line of a lamp is lost and no step matters. Numbers are pi times the
/// radiance: of the perfect diffuser they equal what falls in. A light that has no value where the matrix is excited or emits is a
/// warning on standard error, with what is lost. Nothing is clipped: a fluorescent colour may be brighter than white.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Matrices: FILE.bbrf#ID (FILE.bbrf where it holds one); the second and further are compared with the first
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    #[command(flatten)]
    lights: Lights,
    /// Degrees of the CIE observer: 2 (1931) or 10 (1964)
    #[arg(long, default_value = "2")]
    observer: Observer,
    /// Which luminescence: full, as it was measured; stokes, without the noise far below the excitation; factors
    #[arg(long, default_value = "full")]
    luminescence: Luminescence,
    /// How many factors [default: those stored beside the matrix, else as few as leave no more than noise]
    #[arg(long, value_name = "K")]
    rank: Option<usize>,
    /// Also predict with the factors, and without what lies below the excitation, and compare
    #[arg(long)]
    compare: bool,
    /// How: integrals (exact, with uncertainties), product, factors or colour: samples of a step times tables, colours and spectra only;
    /// `bbrf cost eval` measures what that loses
    #[arg(long, default_value = "integrals", conflicts_with = "compare")]
    by: By,
    /// Step of the samples, nm, from 0.5 to 50
    #[arg(long, default_value_t = 5.0, value_name = "NM")]
    step: f64,
    /// Single precision
    #[arg(long)]
    single: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Write the spectra as CSV, one row per matrix, light and emission
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
}

/// One prediction, with what it is of.
struct Predicted<'a> {
    material: &'a Material,
    luminescence: Luminescence,
    surface_findings: Vec<String>,
    prediction: Prediction,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if let Some(output) = &arguments.output {
        let inputs =
            arguments.files.iter().chain(&arguments.lights.names).map(|name| PathBuf::from(material::split(name).0));
        refuse_overwriting(output, inputs)?;
    }
    let lights = arguments.lights.load()?;
    let materials = arguments
        .files
        .iter()
        .map(|name| material::load_with_remark(name, arguments.rank))
        .collect::<Result<Vec<Material>, miette::Report>>()?;
    if arguments.by != By::Integrals {
        return sampled::run(arguments, &materials, &lights);
    }
    let predicted = predict(arguments, &materials, &lights);
    for one in &predicted {
        let warnings = one.prediction.unlit.iter().map(|unlit| unlit.sentence(&one.prediction.light));
        let is_first = one.luminescence == arguments.luminescence;
        for warning in warnings.filter(|_| is_first) {
            let level = if arguments.lights.extend == Extend::Flat { "the light goes on flat" } else { "warning" };
            print_message(&format!("bbrf: {level}: {}: {warning}", one.material.name));
        }
    }
    let result = PredictResult::new(&predicted, arguments.observer, arguments.lights.extend);
    if let Some(path) = &arguments.output {
        write_output(path, result.csv().as_bytes())?;
        print_message(&format!("bbrf: wrote {}", path.display()));
    }
    if arguments.json {
        print_json("bbrf:donaldson-predict:1", &result)?;
    } else {
        print_text(&result.text())?;
    }
    Ok(Outcome::Done)
}

fn predict<'a>(arguments: &Arguments, materials: &'a [Material], lights: &[Light]) -> Vec<Predicted<'a>> {
    let mut kinds = vec![arguments.luminescence];
    if arguments.compare {
        kinds.extend(Luminescence::ALL.iter().filter(|kind| **kind != arguments.luminescence));
    }
    let mut all = Vec::new();
    for material in materials {
        for luminescence in &kinds {
            let surface = Reradiation::of(&material.matrix, &material.separated, *luminescence);
            for light in lights {
                all.push(Predicted {
                    material,
                    luminescence: *luminescence,
                    surface_findings: surface.findings.clone(),
                    prediction: surface.under(light, arguments.lights.extend),
                });
            }
        }
    }
    all
}
