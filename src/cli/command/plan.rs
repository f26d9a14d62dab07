//! `bbrf plan`: what of a scene is simulated, and why the rest need not be.

use std::path::PathBuf;

use miette::miette;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_text};
use crate::cli::progress::watched;
use crate::cli::scene_source::{self, no_picture};
use crate::simulate::document::Resolved;
use crate::simulate::{Plan, plan};

const EXAMPLES: &str = "\
Examples:
  bbrf plan sphere.toml
  bbrf plan room.toml --max-delta-e 0.5
  bbrf plan room.toml --json";

/// Say what of a scene is simulated, and what leaving out the rest may change
///
/// For each effect (luminescence, diffuse and specular reflection, shadows, light from body to body, light from all around): whether it
/// is simulated, why, and by how much at most a pixel changes without it, as a CIELAB distance of 1976, proven from the scene. Without
/// a tolerance only what is provably nothing is left out. The noise of random paths is no part of the bound; the picture states it.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    #[command(flatten)]
    tolerance: Tolerance,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// How much may be missing.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct Tolerance {
    /// Take the cheapest plan by which no pixel changes by more than this CIELAB distance of 1976
    #[arg(long, default_value_t = 0.0, value_name = "DE", allow_negative_numbers = true)]
    max_delta_e: f64,
}

impl Tolerance {
    /// The plan of a scene.
    pub(crate) fn plan(self, place: &str, resolved: &Resolved) -> Result<Plan, miette::Report> {
        if !(self.max_delta_e >= 0.0 && self.max_delta_e.is_finite()) {
            return Err(miette!("--max-delta-e {}: expected a number of 0 or more", self.max_delta_e));
        }
        watched("planning", || plan(&resolved.scene, resolved.kept, self.max_delta_e))
            .map_err(|why| no_picture(place, resolved, &why))
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let loaded = scene_source::load(&arguments.scene)?;
    let found = arguments.tolerance.plan(&arguments.scene.display().to_string(), &loaded.resolved)?;
    if arguments.json {
        print_json("bbrf:plan:1", &found)?;
    } else {
        print_text(&found.text())?;
    }
    Ok(Outcome::Done)
}
