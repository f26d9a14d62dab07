//! The one function from outcome to exit status.

use std::process::ExitCode;

use super::output::report_error;

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

/// The exit status of a result; an error goes to stderr.
pub(crate) fn code(result: CommandResult) -> ExitCode {
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Failed) => ExitCode::from(1),
        Err(report) => {
            report_error(&report);
            ExitCode::from(2)
        }
    }
}
