//! `bbrf cost storage`: levels, chunks and single precision.

use std::path::PathBuf;

use miette::miette;

use super::{Common, words};
use crate::cli::exit::CommandResult;
use crate::cli::opened::open_to_rewrite;
use crate::container::Opened;
use crate::cost::storage_ladder;

/// What levels of compression, chunks and single precision cost, on your own file
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    #[command(flatten)]
    common: Common,
}

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { file, common } = arguments;
    common.check([file.clone()])?;
    let Opened { document, foreign, .. } = open_to_rewrite(file)?;
    let name = file.display().to_string();
    let mut ladder = storage_ladder(&document, &foreign, name.clone(), common.patience())
        .map_err(|error| miette!("{name}: {error}"))?;
    let output = file.with_extension("stored.bbrf").display().to_string();
    ladder.command = words(&["bbrf", "migrate", &name, "-o", &output]);
    common.finish(ladder)
}
