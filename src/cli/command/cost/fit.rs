//! `bbrf cost fit`: nodes, tolerances and bands.

use std::path::PathBuf;

use miette::miette;

use super::{Common, words};
use crate::cli::command::fit::question::{Question, hint};
use crate::cli::exit::CommandResult;
use crate::cli::opened::open;
use crate::cli::progress::watched;
use crate::cost::fit_ladder;

/// What the search and the tolerance of a fit cost, on your own scan
///
/// All options of `bbrf fit` that say what is fitted are taken; its effort is turned. The reference is the fit of the same numbers
/// with four times the nodes. With `--reduce none` bands are rungs, too.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    #[command(flatten)]
    question: Question,
    #[command(flatten)]
    common: Common,
}

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { file, question, common } = arguments;
    common.check([file.clone()])?;
    let document = open(file)?.document;
    let measurement = question.choose(&document, file)?;
    let mut ladder = watched("measuring", || {
        fit_ladder(&document, measurement, &question.options(String::new()), common.patience())
    })
    .map_err(|error| miette!("{}: {error}{}", file.display(), hint(&error)))?;
    ladder.command = words(&["bbrf", "fit", &file.display().to_string()]);
    ladder.command.extend(question.words());
    common.finish(ladder)
}
