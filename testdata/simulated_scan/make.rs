//! Makes a simulated goniometer scan in the raw form of a PR-650: `cargo run --example simulate_scan -- OUTDIR
//! [--object N|NAME|all]`. See `README.md` beside this file. Nothing here was measured.
//!
//! The optics are written out once more, without `bbrf::terms`, so that a fit of this scan is checked against an
//! independent forward model.

mod scan;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use scan::lamp::DIODES;
use scan::objects::{OBJECTS, Object};
use scan::{Scan, Setup};

/// Makes simulated PR-650 scans of the paper's twelve fluorescent objects and of a matte white.
#[derive(Debug, Parser)]
struct Arguments {
    /// Folder to write to; with `--object all` each object gets a folder of its own below it.
    outdir: PathBuf,
    /// Number (from 0) or name of the object, or `all`.
    #[arg(long, default_value = "fluorescence-sheet-yellow")]
    object: String,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let chosen = choose(&arguments.object);
    if chosen.is_empty() {
        eprintln!("no object `{}`; expected `all`, or a number or name of:", arguments.object);
        for (number, object) in OBJECTS.iter().enumerate() {
            eprintln!("  {number:2}  {}", object.name);
        }
        return ExitCode::from(2);
    }
    for (number, object) in &chosen {
        let folder =
            if arguments.object == "all" { arguments.outdir.join(object.name) } else { arguments.outdir.clone() };
        if let Err(error) = Scan::simulate(&Setup::whole(&DIODES), *number, object).write(&folder) {
            eprintln!("{}: {error}", folder.display());
            return ExitCode::from(2);
        }
        println!("{}: {}", folder.display(), object.title);
    }
    ExitCode::SUCCESS
}

fn choose(wanted: &str) -> Vec<(usize, &'static Object)> {
    let is_wanted =
        |(number, object): &(usize, &Object)| wanted == "all" || wanted == object.name || wanted.parse() == Ok(*number);
    OBJECTS.iter().enumerate().filter(is_wanted).collect()
}
