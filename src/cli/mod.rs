//! The command: parses, calls one function of the library, prints.
//!
//! *May use:* every room.
//!
//! *Invariant:* results on stdout, messages and progress on stderr; exit status 0, 1 or 2 and nothing else.

mod command;
mod exit;
mod model_source;
mod opened;
mod output;
mod overwrite;
mod progress;
mod references;
mod scene_source;

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
    Design(Box<command::design::Arguments>),
    Donaldson(Box<command::donaldson::Arguments>),
    Cost(command::cost::Arguments),
    Plan(command::plan::Arguments),
    Render(command::render::Arguments),
    Report(command::report::Arguments),
    Info(command::info::Arguments),
    Validate(command::validate::Arguments),
    Export(command::export::Arguments),
    Convert(command::convert::Arguments),
    Migrate(command::migrate::Arguments),
    Rules(command::rules::Arguments),
    Explain(command::rules::ExplainArguments),
    Schema(command::schema::Arguments),
}

/// Every JSON Schema by name: the document, and what each `--json` prints.
#[must_use]
pub fn schemas() -> Vec<(&'static str, schemars::Schema)> {
    command::schema::all()
}

/// Runs the command with the arguments of the process.
#[must_use]
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        // A wrong call goes to stderr with status 2; help and version are results like others.
        Err(error) if error.use_stderr() => error.exit(),
        Err(error) => return exit::code(output::arrived(error.print()).map(|()| exit::Outcome::Done)),
    };
    exit::code(match arguments.command {
        Command::Import(arguments) => command::import::run(&arguments),
        Command::Fit(arguments) => command::fit::run(&arguments),
        Command::Eval(arguments) => command::eval::run(&arguments),
        Command::Design(arguments) => command::design::run(&arguments),
        Command::Donaldson(arguments) => command::donaldson::run(&arguments),
        Command::Cost(arguments) => command::cost::run(&arguments),
        Command::Plan(arguments) => command::plan::run(&arguments),
        Command::Render(arguments) => command::render::run(&arguments),
        Command::Report(arguments) => command::report::run(&arguments),
        Command::Info(arguments) => command::info::run(&arguments),
        Command::Validate(arguments) => command::validate::run(&arguments),
        Command::Export(arguments) => command::export::run(&arguments),
        Command::Convert(arguments) => command::convert::run(&arguments),
        Command::Migrate(arguments) => command::migrate::run(&arguments),
        Command::Rules(arguments) => command::rules::run(&arguments),
        Command::Explain(arguments) => command::rules::explain(&arguments),
        Command::Schema(arguments) => command::schema::run(&arguments),
    })
}
