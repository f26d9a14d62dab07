//! Where the fitted files go: each input to a place of its own, decided before any work is done.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use miette::miette;

use crate::cli::overwrite::is_same_file;

/// The file to write for each input, in their order; makes the folder that several inputs go to.
///
/// # Errors
/// Where two inputs would go to one file, or an output would replace another input.
pub(super) fn outputs(inputs: &[PathBuf], output: Option<&Path>) -> Result<Vec<Option<PathBuf>>, miette::Report> {
    let Some(output) = output else { return Ok(vec![None; inputs.len()]) };
    if inputs.len() < 2 {
        refuse_folder(output)?;
        return Ok(vec![Some(output.to_owned()); inputs.len()]);
    }
    if output.exists() && !output.is_dir() {
        return Err(miette!(
            help = "name a folder, or fit one FILE at a time",
            "{}: is a file; expected a folder, because {} FILEs are fitted and each is written under its own name",
            output.display(),
            inputs.len()
        ));
    }
    let targets: Vec<PathBuf> = inputs.iter().map(|input| target(input, output)).collect::<Result<_, _>>()?;
    refuse_shared(inputs, &targets)?;
    refuse_crossed(inputs, &targets)?;
    std::fs::create_dir_all(output)
        .map_err(|error| miette!("{}: cannot be made: {error}; with several FILEs -o is a folder", output.display()))?;
    Ok(targets.into_iter().map(Some).collect())
}

fn refuse_folder(output: &Path) -> Result<(), miette::Report> {
    if output.is_dir() {
        return Err(miette!("{}: is a folder; with one FILE -o names the file to write", output.display()));
    }
    Ok(())
}

fn target(input: &Path, folder: &Path) -> Result<PathBuf, miette::Report> {
    let name = input.file_name().ok_or_else(|| miette!("{}: does not name a file", input.display()))?;
    Ok(folder.join(name))
}

/// Two inputs of one base name would go to one file, and one of the results would be lost.
fn refuse_shared(inputs: &[PathBuf], targets: &[PathBuf]) -> Result<(), miette::Report> {
    let mut known: HashMap<&Path, &Path> = HashMap::new();
    for (input, target) in inputs.iter().zip(targets) {
        if let Some(first) = known.insert(target, input) {
            return Err(miette!(
                help = "fit them in separate calls, each with an -o of its own, or rename one",
                "{} and {} would both be written to {}",
                first.display(),
                input.display(),
                target.display()
            ));
        }
    }
    Ok(())
}

/// An input may be replaced by its own fitted document, never by that of another.
fn refuse_crossed(inputs: &[PathBuf], targets: &[PathBuf]) -> Result<(), miette::Report> {
    for (input, target) in inputs.iter().zip(targets).filter(|(_, target)| target.exists()) {
        let other = inputs.iter().find(|other| *other != input && is_same_file(other, target));
        if let Some(other) = other.filter(|other| !is_same_file(other, input)) {
            return Err(miette!(
                help = "name another folder after -o",
                "{}: the fit of {} would replace the input {}",
                target.display(),
                input.display(),
                other.display()
            ));
        }
    }
    Ok(())
}
