//! `bbrf donaldson`: bispectral matrices.

mod light_source;
mod material;
mod predict;

use crate::cli::exit::CommandResult;
pub(crate) use predict::PredictResult;

/// Bispectral (Donaldson) matrices: what they make of a light
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Predict(Box<predict::Arguments>),
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    match &arguments.command {
        Command::Predict(arguments) => predict::run(arguments),
    }
}
