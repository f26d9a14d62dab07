//! Opening the file of a command; that it is of a later version of the standard is said.

use std::path::Path;

use miette::miette;

use super::output::print_message;
use crate::container::{self, Opened, ReadError, layout::VERSION};

/// A file whose content has its digests.
pub(crate) fn open(path: &Path) -> Result<Opened, miette::Report> {
    said(path, container::open(path))
}

/// The same, to write the document again.
pub(crate) fn open_to_rewrite(path: &Path) -> Result<Opened, miette::Report> {
    said(path, container::open_to_rewrite(path))
}

/// A file whether or not its content has its digests.
pub(crate) fn open_whatever(path: &Path) -> Result<Opened, miette::Report> {
    said(path, container::read_file(path))
}

fn said(path: &Path, opened: Result<Opened, ReadError>) -> Result<Opened, miette::Report> {
    let opened = opened.map_err(|error| miette!("{error}"))?;
    if let Some(version) = &opened.later_version {
        say_later(path, version);
    }
    Ok(opened)
}

/// Warns of a version that this program does not know.
pub(crate) fn say_later(path: &Path, version: &str) {
    print_message(&format!(
        "bbrf: warning: {}: version {version} of the standard is newer than {VERSION}, which this program knows; it can be \
         read, and what it adds is passed over",
        path.display()
    ));
}
