//! Names that do not depend on how a path was typed: in a document, files are named relative to the folder that the
//! inputs share, and those of a manifest as it names them. Messages of errors keep the path as typed, for whoever reads
//! them wants to open the file.

use std::path::{Component, Path, PathBuf};

use crate::dataset::{Place, Receipt};

/// Renames the files of a receipt. With `alone`, the input is a manifest, which names all others.
pub(super) fn make_relative(receipt: &mut Receipt, inputs: &[PathBuf], alone: bool) {
    let mut table = match inputs {
        [manifest] if alone => beside_manifest(receipt, manifest),
        inputs => in_common_folder(receipt, inputs),
    };
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

/// The files of a manifest, as it names them: with or without the folder in which it lies.
fn beside_manifest(receipt: &Receipt, manifest: &Path) -> Vec<(String, String)> {
    let folder = manifest.parent().unwrap_or(Path::new(""));
    let short = |name: &str| {
        let inside = Path::new(name).strip_prefix(folder).ok().filter(|inside| inside.is_relative())?;
        Some(inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/"))
    };
    receipt.inputs.iter().filter_map(|input| Some((input.name.clone(), short(&input.name)?))).collect()
}

/// All files, relative to the folder that they share.
fn in_common_folder(receipt: &Receipt, inputs: &[PathBuf]) -> Vec<(String, String)> {
    let typed = inputs.iter().map(|input| input.display().to_string());
    let names: Vec<String> = typed.chain(receipt.inputs.iter().map(|input| input.name.clone())).collect();
    let Some(folder) = common_folder(&names) else { return Vec::new() };
    names.into_iter().filter_map(|name| relative(&name, &folder).map(|short| (name, short))).collect()
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
