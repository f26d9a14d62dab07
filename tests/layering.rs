//! Each room uses only the rooms it may.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

use std::path::{Path, PathBuf};

/// Room and what it may use; `cli` may use all.
const ARROWS: &[(&str, &[&str])] = &[
    ("quantity", &[]),
    ("terms", &["quantity"]),
    ("dataset", &["terms", "quantity"]),
    ("container", &["dataset", "quantity"]),
    ("import", &["dataset", "quantity"]),
    ("export", &["dataset", "quantity"]),
    ("validate", &["container", "dataset", "terms", "quantity"]),
    ("fit", &["dataset", "terms", "quantity"]),
    ("donaldson", &["dataset", "terms", "quantity"]),
    ("simulate", &["donaldson", "dataset", "terms", "quantity"]),
    ("cost", &["fit", "donaldson", "simulate", "container", "dataset", "quantity"]),
    // Drawings of fitted terms name what terms and quantities name.
    ("report", &["dataset", "fit", "simulate", "cost", "validate", "donaldson", "terms", "quantity"]),
];

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// The rooms that a line of code names, in `use crate::room` or `crate::room::`.
fn rooms_named(line: &str) -> Vec<String> {
    if line.trim_start().starts_with("//") {
        return Vec::new();
    }
    let after = line.split("crate::").skip(1);
    after.map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()).collect()
}

#[test]
fn every_arrow_is_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in std::fs::read_dir(&root).unwrap() {
        let folder = entry.unwrap().path();
        let room = folder.file_name().unwrap().to_str().unwrap().to_owned();
        if !folder.is_dir() || room == "cli" {
            continue;
        }
        let (_, allowed) = ARROWS.iter().find(|(name, _)| *name == room).unwrap_or_else(|| panic!("new room {room}"));
        let mut files = Vec::new();
        sources(&folder, &mut files);
        for file in files {
            for (number, line) in std::fs::read_to_string(&file).unwrap().lines().enumerate() {
                for named in rooms_named(line) {
                    let is_room = ARROWS.iter().any(|(name, _)| *name == named) || named == "cli";
                    let fine = !is_room || named == room || allowed.contains(&named.as_str());
                    assert!(fine, "{}:{}: {room} uses {named}", file.display(), number + 1);
                }
            }
        }
    }
}
