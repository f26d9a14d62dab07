//! `bbrf cost eval`: steps, factors and single precision, of a matrix or a complete model.

use std::path::{Path, PathBuf};

use miette::miette;

use super::{Common, words};
use crate::cli::command::donaldson::light_source::Lights;
use crate::cli::command::donaldson::material;
use crate::cli::exit::CommandResult;
use crate::cli::model_source::load_complete;
use crate::cli::output::print_message;
use crate::cli::progress::watched;
use crate::cost::{EvalLadder, ModelLadder, eval_ladder, model_ladder};
use crate::donaldson::{Luminescence, Observer};
use crate::import::read_geometries;
use crate::quantity::Geometry;

/// What exact integrals, steps, factors and single precision cost, on your own matrix or model
///
/// Of a matrix the reference is `bbrf donaldson predict` as it is; the rungs are its `--by`, `--step`, `--rank` and `--single`. Of a
/// complete model (`--model`) it is `bbrf eval --light`; the rungs are its `--values`, `--by` and `--step`, with a light of its own for
/// each geometry, or one for all. Times are of `--count` predictions whose lights are samples at the step of the rung already; errors
/// contain what sampling loses.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The matrix: FILE.bbrf#ID (FILE.bbrf where it holds one); with `--model` the file of the model
    file: String,
    /// A complete model of the file (`bbrf fit --donaldson`), under one light
    #[arg(long, value_name = "ID", requires = "geometry", conflicts_with_all = ["observer", "luminescence"])]
    model: Option<String>,
    /// Of a model: the geometries, as `bbrf eval` takes them
    #[arg(long, value_name = "FILE.csv", requires = "model")]
    geometry: Option<PathBuf>,
    #[command(flatten)]
    lights: Lights,
    /// Degrees of the CIE observer: 2 (1931) or 10 (1964)
    #[arg(long, default_value = "2")]
    observer: Observer,
    /// Which luminescence: full, stokes, factors
    #[arg(long, default_value = "full")]
    luminescence: Luminescence,
    /// How many predictions the time is of
    #[arg(long, default_value_t = 1_000_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    #[command(flatten)]
    common: Common,
}

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { file, lights, common, geometry, .. } = arguments;
    let named = lights.names.iter().chain([file]).map(|name| PathBuf::from(material::split(name).0));
    common.check(named.chain(geometry.clone()))?;
    match (&arguments.model, geometry) {
        (Some(id), Some(geometry)) => of_model(arguments, &format!("{file}#{id}"), geometry),
        _ => of_matrix(arguments),
    }
}

fn of_matrix(arguments: &Arguments) -> CommandResult {
    let Arguments { file, lights, observer, luminescence, count, common, .. } = arguments;
    let loaded = lights.load()?;
    let material = material::load_with_remark(file, None)?;
    let asked = EvalLadder {
        subject: file.clone(),
        matrix: &material.matrix,
        separated: &material.separated,
        luminescence: *luminescence,
        lights: &loaded,
        extend: lights.extend,
        observer: *observer,
        count: *count as f64,
    };
    let mut ladder =
        watched("measuring", || eval_ladder(&asked, common.patience())).map_err(|error| miette!("{file}: {error}"))?;
    ladder.command = words(&["bbrf", "donaldson", "predict", file]);
    ladder.command.extend(lights.words());
    if *observer != Observer::Two {
        ladder.command.extend(["--observer".to_owned(), observer.to_string()]);
    }
    if *luminescence != Luminescence::Full {
        ladder.command.extend(["--luminescence".to_owned(), luminescence.to_string()]);
    }
    common.finish(ladder)
}

fn of_model(arguments: &Arguments, name: &str, geometry: &Path) -> CommandResult {
    let Arguments { lights, count, common, .. } = arguments;
    let model = load_complete(name)?;
    for finding in model.findings() {
        print_message(&format!("bbrf: {name}: {finding}"));
    }
    let geometries = read_geometries(geometry).map_err(|error| miette!("{error}"))?;
    let geometries: Vec<Geometry> = geometries.iter().map(|row| row.geometry).collect();
    let loaded = lights.load()?;
    let [light] = loaded.as_slice() else {
        return Err(miette!("--light: found {} lights; expected one: `bbrf eval` takes one", loaded.len()));
    };
    let asked = ModelLadder {
        subject: name.to_owned(),
        model: &model,
        light,
        extend: lights.extend,
        geometries: &geometries,
        count: *count as f64,
    };
    let mut ladder =
        watched("measuring", || model_ladder(&asked, common.patience())).map_err(|error| miette!("{name}: {error}"))?;
    ladder.command = words(&["bbrf", "eval", "--model", name, "--geometry", &geometry.display().to_string()]);
    ladder.command.extend(lights.words());
    common.finish(ladder)
}
