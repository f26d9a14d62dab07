//! The command: parses, calls one function of the library, prints.
//!
//! *May use:* every room.
//!
//! *Invariant:* results on stdout, messages and progress on stderr; exit status 0, 1 or 2 and nothing else.

mod command;
mod exit;
mod output;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Bispectral bidirectional measurements of fluorescent surfaces: import, fit, validate, draw.
#[derive(Debug, Parser)]
#[command(name = "bbrf", version, about, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Import(command::import::Arguments),
}

/// Runs the command with the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Command::Import(arguments) => command::import::run(&arguments),
    };
    exit::code(outcome)
}
