//! No command writes over what it reads: an input may be the only copy of what the output does not hold.

use std::path::{Path, PathBuf};

use miette::miette;

/// Refuses to write `output` where it is one of the files read, whatever the spelling, links included.
pub(crate) fn refuse_overwriting(output: &Path, read: impl IntoIterator<Item = PathBuf>) -> Result<(), miette::Report> {
    match read.into_iter().find(|input| input.is_file() && is_same_file(input, output)) {
        None => Ok(()),
        Some(input) => Err(miette!(
            help = "give the output another name",
            "{}: found an input file ({}), which would be overwritten; expected a file that is not read",
            output.display(),
            input.display()
        )),
    }
}

/// True for two names of one existing file, symbolic and hard links included.
pub(crate) fn is_same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b || is_one_inode(&a, &b),
        _ => false,
    }
}

/// Two names of one file, as a hard link gives.
#[cfg(unix)]
fn is_one_inode(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |path: &Path| path.metadata().ok().map(|metadata| (metadata.dev(), metadata.ino()));
    identity(a).is_some_and(|a| Some(a) == identity(b))
}

/// Other systems are compared by name alone.
#[cfg(not(unix))]
fn is_one_inode(_: &Path, _: &Path) -> bool {
    false
}
