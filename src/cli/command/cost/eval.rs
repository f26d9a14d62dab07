//! `bbrf cost eval`: steps, factors and single precision.

use std::path::PathBuf;

use miette::miette;

use super::{Common, words};
use crate::cli::command::donaldson::light_source::Lights;
use crate::cli::command::donaldson::material;
use crate::cli::exit::CommandResult;
use crate::cli::output::print_message;
use crate::cost::{EvalLadder, eval_ladder};
use crate::donaldson::{Luminescence, Observer};

/// What exact integrals, steps, factors and single precision cost, on your own matrix
///
/// The reference is `bbrf donaldson predict` as it is; the rungs are its `--by`, `--step`, `--rank` and `--single`. Times are of
/// `--count` predictions whose lights are samples at the step of the rung already; errors contain what sampling loses.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The matrix: FILE.bbrf#ID (FILE.bbrf where it holds one)
    file: String,
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
    let Arguments { file, lights, observer, luminescence, count, common } = arguments;
    let read = lights.names.iter().chain([file]).map(|name| PathBuf::from(material::split(name).0));
    common.check(read)?;
    let loaded = lights.load()?;
    let material = material::load(file, None)?;
    let remark = material.separation.remark.as_ref();
    remark.iter().for_each(|remark| print_message(&format!("bbrf: warning: {}: {remark}", material.name)));
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
    let mut ladder = eval_ladder(&asked, common.patience()).map_err(|error| miette!("{file}: {error}"))?;
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
