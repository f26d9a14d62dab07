//! The experiment of Tominaga, Hirai and Horiuchi once more, on simulated objects. Nothing here was measured.
//!
//! `paper simulate DIR` writes what a PR-650 would have given, `scripts/paper.sh` runs the commands of bbrf on it, and
//! `paper page DIR DOCS` writes the page from what they printed. `make paper` does all three.

mod directions;
mod experiments;
mod fitted;
mod lamps;
mod matrix;
mod page;
mod picture;
#[path = "../../testdata/simulated_scan/scan/mod.rs"]
mod scan;
mod sheet;
mod sphere;
mod yellow_paint;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

/// Simulates the experiment of the paper, and writes the page about what bbrf makes of it.
#[derive(Debug, Parser)]
enum Command {
    /// Write the raw records of every object to a folder
    Simulate {
        /// The folder
        folder: PathBuf,
    },
    /// Write `paper.md`, and the figures that it shows below `images/paper`
    Page {
        /// The folder in which `scripts/paper.sh` has worked
        folder: PathBuf,
        /// Where the page goes
        docs: PathBuf,
    },
}

fn main() -> ExitCode {
    let done: Result<(), Box<dyn Error>> = match Command::parse() {
        Command::Simulate { folder } => experiments::simulate(&folder, &experiments::of(|_| true)).map_err(Into::into),
        Command::Page { folder, docs } => page::write(&folder, &docs),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}
