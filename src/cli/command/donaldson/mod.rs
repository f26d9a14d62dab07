//! `bbrf donaldson`: bispectral matrices, one file per step.

pub(crate) mod estimate;
pub(in crate::cli) mod light_source;
pub(in crate::cli) mod material;
pub(crate) mod predict;
pub(crate) mod separate;
pub(in crate::cli) mod spectrum_source;

use clap::Subcommand;

use crate::cli::exit::CommandResult;

/// Bispectral matrices: separate, estimate, predict
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    step: Step,
}

#[derive(Debug, Subcommand)]
enum Step {
    Separate(separate::Arguments),
    Estimate(Box<estimate::Arguments>),
    Predict(Box<predict::Arguments>),
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    match &arguments.step {
        Step::Separate(arguments) => separate::run(arguments),
        Step::Estimate(arguments) => estimate::run(arguments),
        Step::Predict(arguments) => predict::run(arguments),
    }
}
