//! `bbrf fit --diagnose`: the page on what a fit rests on.

use std::path::{Path, PathBuf};

use miette::miette;

use crate::cli::output::write_output;
use crate::cli::overwrite::{is_same_file, refuse_overwriting};
use crate::dataset::{Document, Model};
use crate::fit::{FitOptions, diagnose_measurement};
use crate::report::diagnosis_page;

/// Refuses what cannot be meant before any work is done.
pub(super) fn check(page: &Path, files: &[PathBuf], output: Option<&Path>) -> Result<(), miette::Report> {
    if files.len() > 1 {
        return Err(miette!(
            help = "diagnose one FILE at a time",
            "--diagnose writes one page, and {} FILEs are fitted",
            files.len()
        ));
    }
    if output.is_some_and(|output| output == page || is_same_file(output, page)) {
        return Err(miette!("{}: named for the page and for the fitted file; name two files", page.display()));
    }
    refuse_overwriting(page, files.iter().cloned())
}

/// Diagnoses the fit and writes the page, whole or not at all.
pub(super) fn write(
    page: &Path,
    document: &Document,
    model: &Model,
    options: &FitOptions,
) -> Result<(), miette::Report> {
    let missing = || miette!("no measurement `{}`", model.measurement);
    let measurement = document.measurement(model.measurement.as_str()).ok_or_else(missing)?;
    let diagnosis = diagnose_measurement(document, measurement, options).map_err(|error| miette!("{error}"))?;
    write_output(page, diagnosis_page(document, model, &diagnosis).as_bytes())
}
