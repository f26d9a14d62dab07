//! `bbrf design`: what a scan will tell, before anyone measures, and what to measure besides.

mod result;

use std::path::{Path, PathBuf};

use miette::miette;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::model_source::{Loaded, load};
use crate::cli::output::{print_json, print_text, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::fit::design::{CandidateGrid, Goal, Guess, Noise, Sensitivities, choose, in_plane_grid, predict};
use crate::import::{read_geometries, scan_manifest};
use crate::quantity::{Geometry, Reference};
use crate::report::{DesignPicture, design_figure};
use crate::terms::Term;
pub(crate) use result::DesignResult;

/// What is offered where `--add` is given alone.
const OFFERED: CandidateGrid = CandidateGrid { step: 5.0, max: 85.0, azimuths: 2 };
/// How many are added where `--candidates` is given alone.
const ADDED: usize = 10;

/// Predict the uncertainty that a scan will give, and choose the geometries that help most
///
/// The material is guessed: a model in JSON, or a fitted one. The predicted uncertainty of a parameter is the Cramer-Rao
/// bound of independent errors of the given noise; what the geometries leave undetermined is said in words. Candidates are
/// added one by one and exchanged until no exchange helps; each is added at most once. The criterion alone is regularised,
/// so that a list which determines nothing can be added to; the uncertainties contain nothing of that.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The material: FILE.bbrf#ID (FILE.bbrf where it holds one model), or a JSON file {"terms": [...]}
    #[arg(long)]
    model: String,
    /// Geometries that are planned: a CSV as `bbrf eval` reads it
    #[arg(long)]
    geometry: Option<PathBuf>,
    /// Geometries that are planned: signed in-plane angles, step=10,max=80 (the paper's)
    #[arg(long)]
    grid: Option<CandidateGrid>,
    /// Geometries that may be added: step=5,max=85, and with ,azimuths=7 in other planes [default with --add: step=5,max=85]
    #[arg(long)]
    candidates: Option<CandidateGrid>,
    /// How many to add [default with --candidates: 10]
    #[arg(long, value_name = "N")]
    add: Option<usize>,
    /// What to make small: d for all parameters together, or albedo, intensity, roughness, refractive-index
    #[arg(long, default_value = "d")]
    optimise: Goal,
    /// Standard deviation of one value, relative to it
    #[arg(long, default_value_t = 0.01)]
    noise: f64,
    /// Standard deviation of one value, absolute; added in squares
    #[arg(long, default_value_t = 0.0)]
    floor: f64,
    /// Directions closer to the source than this are blocked by it, degrees; 0 for none
    #[arg(long, default_value_t = 10.0, value_name = "DEGREES")]
    retro_gap: f64,
    /// What values are relative to: same-geometry, fixed-geometry(THETA_I,THETA_V), none
    /// [default: as the model was fitted; same-geometry for a model in JSON]
    #[arg(long)]
    reference: Option<Reference>,
    /// Draw it: FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    figure: Option<PathBuf>,
    /// Write a scan manifest of all geometries, planned and added, for `bbrf import`
    #[arg(long, value_name = "FILE.csv")]
    manifest: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    refuse_inputs(arguments)?;
    let Loaded { bands, reference, .. } = load(&arguments.model)?;
    let (nm, terms) = strongest(bands).ok_or_else(|| miette!("{}: holds no value", arguments.model))?;
    let reference = arguments.reference.or(reference).unwrap_or(Reference::SameGeometry);
    if reference == Reference::Unstated {
        return Err(miette!("{}: its reference is unstated; pass --reference", arguments.model));
    }
    let guess = Guess::new(terms, reference).map_err(|error| miette!("{}: {error}", arguments.model))?;
    let noise = Noise::new(arguments.noise, arguments.floor).map_err(|error| miette!("--noise, --floor: {error}"))?;
    let planned = planned(arguments)?;
    let known = Sensitivities::new(&guess, &noise, &planned);
    let before = predict(&guess, &planned, &known);
    let offered = offered(arguments);
    let sensitivities = Sensitivities::new(&guess, &noise, &offered);
    let count = arguments.add.unwrap_or(if arguments.candidates.is_some() { ADDED } else { 0 });
    let added = choose(&guess, (&planned, &known), (&offered, &sensitivities), &arguments.optimise, count)
        .map_err(|error| miette!("--optimise: {error}"))?;
    let chosen: Vec<usize> = added.iter().map(|one| one.candidate).collect();
    let extra: Vec<Geometry> = chosen.iter().map(|index| offered[*index]).collect();
    let all: Vec<Geometry> = planned.iter().chain(&extra).copied().collect();
    let after = predict(&guess, &all, &known.with(&sensitivities, &chosen));
    let mut result = DesignResult::new(&guess, &noise, &arguments.optimise, nm);
    result.describe(&arguments.model, offered.len(), (&planned, &known, &before), (&extra, &added, &after));
    if let Some(path) = &arguments.manifest {
        write_output(path, scan_manifest(&all, &reference).as_bytes())?;
        result.wrote(path);
    }
    if let Some(path) = &arguments.figure {
        draw(path, &result, planned, extra)?;
        result.wrote(path);
    }
    if arguments.json {
        print_json("bbrf:design:1", &result)?;
    } else {
        print_text(&result.text())?;
    }
    Ok(Outcome::Done)
}

fn refuse_inputs(arguments: &Arguments) -> Result<(), miette::Report> {
    if !(0.0..=180.0).contains(&arguments.retro_gap) {
        return Err(miette!("--retro-gap: {} degrees; expected 0 to 180", arguments.retro_gap));
    }
    let model = arguments.model.rsplit_once('#').map_or(arguments.model.as_str(), |(path, _)| path);
    let inputs = || [PathBuf::from(model)].into_iter().chain(arguments.geometry.clone());
    arguments.manifest.iter().chain(&arguments.figure).try_for_each(|output| refuse_overwriting(output, inputs()))?;
    let form = arguments.figure.as_ref().map(|path| extension(path));
    match form.as_deref() {
        None | Some("svg" | "png") => Ok(()),
        Some(other) => Err(miette!("--figure: a file name that ends in `{other}`; expected .svg or .png")),
    }
}

fn extension(path: &Path) -> String {
    path.extension().map_or(String::new(), |extension| extension.to_string_lossy().to_lowercase())
}

/// The emission value of the largest amplitudes: of a spectrum, it has most to tell.
fn strongest(bands: Vec<(Option<f64>, Vec<Term>)>) -> Option<(Option<f64>, Vec<Term>)> {
    let size = |terms: &[Term]| terms.iter().map(|term| term.values()[0]).sum::<f64>();
    bands.into_iter().max_by(|a, b| size(&a.1).total_cmp(&size(&b.1)))
}

fn planned(arguments: &Arguments) -> Result<Vec<Geometry>, miette::Report> {
    let mut list: Vec<Geometry> = match &arguments.geometry {
        Some(path) => {
            let rows = read_geometries(path).map_err(|error| miette!("{error}"))?;
            rows.iter().map(|row| row.geometry).collect()
        }
        None => Vec::new(),
    };
    list.extend(arguments.grid.iter().flat_map(|grid| in_plane_grid(grid, arguments.retro_gap)));
    if list.is_empty() && arguments.add.is_none() && arguments.candidates.is_none() {
        return Err(miette!(
            "no geometries; give those planned as --geometry FILE.csv or --grid step=10,max=80, or let some be chosen with \
             --add N"
        ));
    }
    Ok(list)
}

fn offered(arguments: &Arguments) -> Vec<Geometry> {
    let grid = arguments.candidates.or(arguments.add.map(|_| OFFERED));
    grid.map_or(Vec::new(), |grid| grid.geometries(arguments.retro_gap))
}

fn draw(
    path: &Path,
    result: &DesignResult,
    planned: Vec<Geometry>,
    added: Vec<Geometry>,
) -> Result<(), miette::Report> {
    let picture = DesignPicture {
        title: format!("What {} + {} geometries will tell", planned.len(), added.len()),
        subtitle: result.subtitle(),
        uncertainties: result.curves(),
        planned,
        added,
    };
    let figure = design_figure(&picture).map_err(|error| miette!("{error}"))?;
    let bytes = if extension(path) == "png" {
        figure.to_png().map_err(|error| miette!("{error}"))?
    } else {
        figure.to_svg_outlined().map_err(|error| miette!("{error}"))?.into_bytes()
    };
    write_output(path, &bytes)
}
