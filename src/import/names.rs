//! Names that do not depend on how a path was typed: in a document, files are named relative to the folder that the
//! inputs share, and a manifest by itself. Messages of errors keep the path as typed.

use std::path::{Component, Path, PathBuf};

use crate::dataset::{Place, Receipt};

/// Renames the files of a receipt. With `alone`, only the input itself was named by the caller (a manifest).
pub(super) fn make_relative(receipt: &mut Receipt, inputs: &[PathBuf], alone: bool) {
    let typed: Vec<String> = inputs.iter().map(|input| input.display().to_string()).collect();
    let read = receipt.inputs.iter().map(|input| input.name.clone()).filter(|_| !alone);
    let names: Vec<String> = typed.into_iter().chain(read).collect();
    let Some(folder) = common_folder(&names) else { return };
    let mut table: Vec<(String, String)> =
        names.into_iter().filter_map(|name| relative(&name, &folder).map(|short| (name, short))).collect();
    table.retain(|(name, short)| name != short);
    // The longest first: a name may begin with another.
    table.sort_by(|a, b| b.0.len().cmp(&a.0.len()).then_with(|| a.0.cmp(&b.0)));
    table.dedup();
    let place = |place: &mut Place| {
        if let Some(file) = &mut place.file
            && let Some((_, short)) = table.iter().find(|(name, _)| name == file)
        {
            file.clone_from(short);
        }
    };
    for input in &mut receipt.inputs {
        if let Some((_, short)) = table.iter().find(|(name, _)| *name == input.name) {
            input.name.clone_from(short);
        }
    }
    for assumption in &mut receipt.assumptions {
        place(&mut assumption.place);
        assumption.text = renamed(&assumption.text, &table);
    }
    for notice in &mut receipt.notices {
        place(&mut notice.place);
        notice.text = renamed(&notice.text, &table);
    }
}

/// The folder that all the files lie in.
fn common_folder(names: &[String]) -> Option<PathBuf> {
    let folders = names.iter().filter_map(|name| {
        let path = Path::new(name).canonicalize().ok()?;
        if path.is_dir() { Some(path) } else { path.parent().map(Path::to_path_buf) }
    });
    folders.reduce(|common, folder| {
        let shared = common.components().zip(folder.components()).take_while(|(a, b)| a == b).map(|(a, _)| a);
        shared.collect()
    })
}

/// A name relative to a folder, with `/` on every system.
fn relative(name: &str, folder: &Path) -> Option<String> {
    let path = Path::new(name).canonicalize().ok()?;
    let inside = path.strip_prefix(folder).ok()?;
    let parts: Vec<String> = inside
        .components()
        .filter(|part| matches!(part, Component::Normal(_)))
        .map(|part| part.as_os_str().to_string_lossy().into_owned())
        .collect();
    Some(if parts.is_empty() { ".".to_owned() } else { parts.join("/") })
}

/// A text with whole names replaced.
fn renamed(text: &str, table: &[(String, String)]) -> String {
    let inside = |c: char| c.is_alphanumeric() || matches!(c, '/' | '\\' | '_' | '-');
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    let mut before = ' ';
    while let Some(next) = rest.chars().next() {
        let found = table.iter().find(|(name, _)| {
            rest.strip_prefix(name.as_str()).is_some_and(|after| !after.starts_with(inside)) && !inside(before)
        });
        let (taken, written) = found.map_or((next.len_utf8(), None), |(name, short)| (name.len(), Some(short)));
        match written {
            Some(short) => result.push_str(short),
            None => result.push(next),
        }
        before = rest[..taken].chars().next_back().unwrap_or(next);
        rest = &rest[taken..];
    }
    result
}
