//! Printing: results on stdout, as JSON with its schema's name first or as text; messages on stderr. And files.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use miette::miette;
use serde::Serialize;

use crate::container::WriteError;
use crate::container::replace::write_whole;

/// A result with the name of its JSON Schema, `bbrf:NAME:VERSION`.
#[derive(Debug, Serialize)]
pub(crate) struct Versioned<'a, T: Serialize> {
    schema: &'a str,
    #[serde(flatten)]
    result: &'a T,
}

/// Prints a result as JSON on stdout.
///
/// # Errors
/// As [`print_bytes`].
pub(crate) fn print_json<T: Serialize>(schema: &str, result: &T) -> Result<(), miette::Report> {
    print_text(&json_text(schema, result)?)
}

/// A result as JSON.
///
/// # Errors
/// When a value of it has no form in JSON.
pub(crate) fn json_text<T: Serialize>(schema: &str, result: &T) -> Result<String, miette::Report> {
    serde_json::to_string_pretty(&Versioned { schema, result })
        .map_err(|error| miette!("the result cannot be written as JSON: {error}"))
}

/// Prints text and a line break on stdout.
///
/// # Errors
/// As [`print_bytes`].
pub(crate) fn print_text(text: &str) -> Result<(), miette::Report> {
    print_bytes(format!("{text}\n").as_bytes())
}

/// Prints bytes on stdout. A closed pipe is the reader's decision and no error.
///
/// # Errors
/// Everything else, a full disk first: a result that did not arrive is no success.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), miette::Report> {
    arrived(io::stdout().write_all(bytes))
}

/// Flushes what was written to stdout, and says what became of it.
///
/// # Errors
/// As [`print_bytes`].
pub(crate) fn arrived(written: io::Result<()>) -> Result<(), miette::Report> {
    match written.and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(miette!(
            help = "make room or send the output elsewhere, and run the command again",
            "standard output: the result could not be written: {error}"
        )),
        _ => Ok(()),
    }
}

/// Writes a file, whole or not at all.
///
/// # Errors
/// As [`not_written`].
pub(crate) fn write_output(path: &Path, bytes: &[u8]) -> Result<(), miette::Report> {
    write_whole(path, |file| file.write_all(bytes))
        .map_err(|source| not_written(&WriteError::Io { path: path.to_owned(), source }))
}

/// The error of a file that was not written, with what to do where the disk has no room.
pub(crate) fn not_written(error: &WriteError) -> miette::Report {
    let full = [ErrorKind::StorageFull, ErrorKind::QuotaExceeded, ErrorKind::FileTooLarge];
    match error {
        WriteError::Io { source, .. } if full.contains(&source.kind()) => {
            miette!(help = "make room or write elsewhere, and run the command again", "{error}")
        }
        _ => miette!("{error}"),
    }
}

/// Prints a message on stderr. Where stderr takes nothing there is no other place to say so.
pub(crate) fn print_message(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Prints an error on stderr: what, why, and what to do.
pub(crate) fn report_error(report: &miette::Report) {
    print_message(&format!("bbrf: error: {report}"));
    for cause in report.chain().skip(1) {
        print_message(&format!("  because: {cause}"));
    }
    if let Some(help) = report.help() {
        print_message(&format!("  help: {help}"));
    }
}
