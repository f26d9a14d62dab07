//! `bbrf cost image`: tolerances and samples.

use std::path::PathBuf;

use super::{Common, words};
use crate::cli::exit::CommandResult;
use crate::cli::progress::watched;
use crate::cli::scene_source::{self, no_picture};
use crate::cost::image_ladder;

/// What a tolerance and samples cost, on your own scene
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    #[command(flatten)]
    common: Common,
}

pub(super) fn run(arguments: &Arguments) -> CommandResult {
    let Arguments { scene, common } = arguments;
    let loaded = scene_source::load(scene)?;
    common.check(loaded.read.clone())?;
    let name = scene.display().to_string();
    let mut ladder = watched("measuring", || image_ladder(&loaded.resolved.scene, name.clone(), common.patience()))
        .map_err(|why| no_picture(&name, &loaded.resolved, &why))?;
    let output = scene.with_extension("").display().to_string();
    ladder.command = words(&["bbrf", "render", &name, "-o", &output]);
    common.finish(ladder)
}
