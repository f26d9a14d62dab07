//! The one function from outcome to exit status.

use std::process::ExitCode;

/// How a command ended when nothing stood in its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Done; valid. Exit status 0.
    Done,
    /// The input was read and fails: a finding of severity error, a fit that did not converge. Exit status 1.
    Failed,
}

/// What a command returns; an error is "could not be read, or the call is wrong", exit status 2.
pub(crate) type CommandResult = Result<Outcome, miette::Report>;

/// The exit status of a result; prints an error to stderr.
pub(crate) fn code(result: CommandResult) -> ExitCode {
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Err(report) => {
            eprintln!("bbrf: error: {report}");
            for cause in report.chain().skip(1) {
                eprintln!("  because: {cause}");
            }
            if let Some(help) = report.help() {
                eprintln!("  help: {help}");
            }
            ExitCode::from(2)
        }
    }
}
