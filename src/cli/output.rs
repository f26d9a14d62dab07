//! Printing results: JSON with its schema's name first, and text.

use std::io::Write;

use serde::Serialize;

/// A result with the name of its JSON Schema, `bbrf:NAME:VERSION`.
#[derive(Debug, Serialize)]
pub(crate) struct Versioned<'a, T: Serialize> {
    schema: &'a str,
    #[serde(flatten)]
    result: &'a T,
}

/// Prints a result as JSON on stdout. A closed pipe is the reader's decision and not an error.
pub(crate) fn print_json<T: Serialize>(schema: &str, result: &T) -> Result<(), miette::Report> {
    let text = serde_json::to_string_pretty(&Versioned { schema, result })
        .map_err(|error| miette::miette!("the result cannot be written as JSON: {error}"))?;
    print_text(&text);
    Ok(())
}

/// Prints text and a line break on stdout; a closed pipe is the reader's decision and not an error.
pub(crate) fn print_text(text: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// Prints an error on stderr: what, why, and what to do.
pub(crate) fn report_error(report: &miette::Report) {
    eprintln!("bbrf: error: {report}");
    for cause in report.chain().skip(1) {
        eprintln!("  because: {cause}");
    }
    if let Some(help) = report.help() {
        eprintln!("  help: {help}");
    }
}
