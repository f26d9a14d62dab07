//! `bbrf render`: draws a scene.

mod draw;
mod images;
mod result;

use std::path::{Path, PathBuf};

use miette::miette;

use crate::cli::command::plan::Tolerance;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{json_text, print_json, print_message, print_text, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::cli::scene_source;
use crate::simulate::image::{Depth, Gamut};
use crate::simulate::{Bounces, Choice, Kept, Layer};
pub(crate) use result::RenderResult;

const EXAMPLES: &str = "\
Examples:
  bbrf render sphere.toml -o sphere
  bbrf render room.toml -o room --samples 256 --seed 7 --threads 8
  bbrf render room.toml -o room --spectra --layers total,luminescent --json";

/// The schema of what is printed.
const SCHEMA: &str = "bbrf:render:1";
/// What describes the images.
const RECORD: &str = "render.json";
/// All layers in single precision.
const LAYERS: &str = "layers.exr";

/// Draw a scene: the total and its parts, as PNG and EXR
///
/// SCENE is a description in TOML (`bbrf schema scene`): film, camera, wavelengths, materials from .bbrf files or made up, lights,
/// objects. Written are a PNG in sRGB for each layer, one EXR with all layers in single precision, and `render.json`, which says what
/// was drawn and with which error. The same scene, seed and samples give the same bytes, whatever the number of threads. Ctrl-C
/// ends the work, and nothing is written.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    /// Write the images into this folder
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Layers: total, luminescent, diffuse, specular, interreflection [default: all; those that are black throughout leave out
    /// interreflection]
    #[arg(long, value_delimiter = ',', value_name = "LAYERS")]
    layers: Vec<Layer>,
    /// Keep spectra in the EXR, one channel per wavelength, whatever the scene says
    #[arg(long)]
    spectra: bool,
    /// Samples of each pixel for what has no closed form [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_048_576))]
    samples: Option<u32>,
    /// How often light may go from body to body: all, or a number [default: the scene's]
    #[arg(long, value_name = "N", value_parser = bounces)]
    bounces: Option<Bounces>,
    /// Steps of the wavelength, nm [default: the scene's]
    #[arg(long, value_name = "NM")]
    step: Option<f64>,
    /// Where random numbers begin [default: the scene's]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// How many threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// What the PNG does with colours that a display has not: desaturate or clip
    #[arg(long, default_value = "desaturate")]
    gamut: Gamut,
    #[command(flatten)]
    tolerance: Tolerance,
    /// Simulate everything in full, with the whole product at every pixel: what plans are held against
    #[arg(long, conflicts_with = "max_delta_e")]
    everything: bool,
    /// Make the whole product of matrix and incident spectrum at every pixel, as renderers without a plan do; skip what the plan skips
    #[arg(long, conflicts_with = "everything")]
    by_pixel: bool,
    /// Bits per channel of the PNGs: 8 or 16
    #[arg(long, default_value = "8")]
    depth: Depth,
    /// Print what `render.json` holds
    #[arg(long)]
    json: bool,
}

fn bounces(text: &str) -> Result<Bounces, String> {
    let number =
        || text.parse().map(Bounces::Most).map_err(|_| "expected `all` or a whole number, 0 or more".to_owned());
    if text == "all" { Ok(Bounces::All) } else { number() }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let mut loaded = scene_source::load(&arguments.scene)?;
    let resolved = &mut loaded.resolved;
    resolved.scene.samples = arguments.samples.unwrap_or(resolved.scene.samples);
    resolved.scene.bounces = arguments.bounces.unwrap_or(resolved.scene.bounces);
    if let Some(step) = arguments.step {
        resolved.scene.grid = resolved.scene.grid.in_steps_of(step).map_err(|error| miette!("--step: {error}"))?;
    }
    resolved.scene.seed = arguments.seed.unwrap_or(resolved.scene.seed);
    if arguments.spectra {
        resolved.kept = Kept::Spectra;
    }
    let layers = if arguments.layers.is_empty() { Layer::ALL.to_vec() } else { each_once(&arguments.layers) };
    let names = layers.iter().map(|layer| format!("{layer}.png")).chain([LAYERS.to_owned(), RECORD.to_owned()]);
    for name in names {
        refuse_overwriting(&arguments.output.join(name), loaded.read.clone())?;
    }
    let resolved = &loaded.resolved;
    let place = arguments.scene.display().to_string();
    let plan = match arguments.everything {
        true => None,
        false => {
            let plan = arguments.tolerance.plan(&place, resolved)?;
            Some(if arguments.by_pixel { plan.by_pixel() } else { plan })
        }
    };
    let choice = match &plan {
        Some(plan) => plan.choice,
        None => Choice::everything(resolved.scene.bounces, resolved.scene.grid.step()),
    };
    may_be_written(&arguments.output)?;
    let mut picture = draw::draw(&place, resolved, &choice, &layers, arguments.threads)?;
    if arguments.layers.is_empty() {
        // Nothing to see, and nothing that was asked for.
        picture.layers.retain(|(layer, planes)| {
            *layer != Layer::Interreflection || planes.iter().flatten().any(|value| *value != 0.0)
        });
    }
    let (files, drawn) = images::encode(&picture, resolved, arguments.gamut, arguments.depth)?;
    let result = RenderResult::new(&place, resolved, plan, &picture, drawn);
    result.said_after(&resolved.warnings).for_each(|warning| print_message(&format!("bbrf: warning: {warning}")));
    write(&arguments.output, &files, &result)?;
    if arguments.json {
        print_json(SCHEMA, &result)?;
    } else {
        print_text(&result.text(&arguments.output))?;
    }
    Ok(Outcome::Done)
}

/// Looks before the work whether there is, or may be, such a folder.
fn may_be_written(folder: &Path) -> Result<(), miette::Report> {
    if folder.is_dir() {
        // A file that is gone at once: a folder may be there and take none.
        return tempfile::tempfile_in(folder)
            .map(drop)
            .map_err(|error| miette!("{}: expected a folder that files can be written to: {error}", folder.display()));
    }
    // Made and taken away again: nothing stays of a work that is interrupted.
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::remove_dir(folder))
        .map_err(|error| miette!("{}: expected a folder, or a place where one can be made: {error}", folder.display()))
}

fn each_once(layers: &[Layer]) -> Vec<Layer> {
    Layer::ALL.iter().copied().filter(|layer| layers.contains(layer)).collect()
}

/// The record goes first and comes last: where it is, it is of the images beside it.
fn write(folder: &Path, files: &[(String, Vec<u8>)], result: &RenderResult) -> Result<(), miette::Report> {
    let refused = |path: &Path, error: &std::io::Error| miette!("{}: cannot be written: {error}", path.display());
    std::fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    let record = folder.join(RECORD);
    // Of an earlier image with other layers none may be taken for one of this.
    let stale =
        Layer::ALL.iter().map(|layer| format!("{layer}.png")).filter(|name| files.iter().all(|(one, _)| one != name));
    let stale = stale.map(|name| folder.join(name)).filter(|_| record.is_file());
    for path in stale.chain([record.clone()]).filter(|path| path.is_file()).collect::<Vec<_>>() {
        std::fs::remove_file(&path).map_err(|error| refused(&path, &error))?;
    }
    for (name, bytes) in files {
        write_output(&folder.join(name), bytes)?;
    }
    write_output(&record, (json_text(SCHEMA, result)? + "\n").as_bytes())?;
    print_message(&format!("bbrf: wrote {} images to {}", files.len(), folder.display()));
    Ok(())
}
