//! The command: parses, calls one function of the library, prints.
//!
//! *May use:* every room.
//!
//! *Invariant:* results on stdout, messages and progress on stderr; exit status 0, 1 or 2 and nothing else.

mod command;
mod exit;
mod output;
mod progress;

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
    Import(Box<command::import::Arguments>),
    Fit(command::fit::Arguments),
    Eval(command::eval::Arguments),
    Report(command::report::Arguments),
}

/// Runs the command with the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    exit::code(match Arguments::parse().command {
        Command::Import(arguments) => command::import::run(&arguments),
        Command::Fit(arguments) => command::fit::run(&arguments),
        Command::Eval(arguments) => command::eval::run(&arguments),
        Command::Report(arguments) => command::report::run(&arguments),
    })
}
