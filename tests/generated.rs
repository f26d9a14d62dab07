//! Generated files are in step with the code; `BBRF_UPDATE=1` writes them. The text of the specification names for every
//! demand the rule that checks it.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;
mod spec;

use std::path::Path;

use bbrf::container::tree::{Data, Object};
use bbrf::container::{digest, document_bytes, document_tree};
use bbrf::validate::{CLAUSES, Status, validate_bytes};

/// Compares files of a folder with what the code gives, or writes them.
fn in_step(folder: &Path, extension: &str, files: &[(&str, String)]) {
    let update = std::env::var_os("BBRF_UPDATE").is_some();
    for (name, text) in files {
        let path = folder.join(format!("{name}.{extension}"));
        if update {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(&path, text).unwrap();
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(stored == *text, "{} is not what the code gives; run with BBRF_UPDATE=1", path.display());
    }
    let found = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(found, files.len(), "{}: a file that nothing makes", folder.display());
}

#[test]
fn schemas_are_in_step() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema");
    let schemas = bbrf::cli::schemas();
    let text = |schema| serde_json::to_string_pretty(schema).unwrap() + "\n";
    let files: Vec<_> = schemas.iter().map(|(name, schema)| (*name, text(schema))).collect();
    in_step(&folder, "json", &files);
}

#[test]
fn tables_of_the_specification_are_in_step() {
    in_step(&spec::folder().join("tables"), "md", &spec::tables());
}

#[test]
fn the_table_of_the_layout_has_every_path() {
    assert_eq!(spec::layout::missing(), Vec::<String>::new());
    for document in [spec::full::full(), spec::full::minimal()] {
        let report = validate_bytes(&document_bytes(&document).unwrap().0);
        let errors = report.findings.iter().filter(|finding| finding.severity.name() == "error");
        // What they lack in sense, they have in form.
        let form = errors.filter(|finding| finding.rule.contains("structure.") || finding.rule.contains("digest."));
        assert_eq!(form.collect::<Vec<_>>(), Vec::<&bbrf::validate::Finding>::new());
        assert_ne!(report.status(), Status::Unreadable);
    }
}

#[test]
fn the_worked_digest_is_the_digest() {
    let (_, worked) = spec::digest_example::digests();
    assert_eq!(digest(&spec::digest_example::document()).unwrap().as_str(), worked);
}

#[test]
fn a_demand_without_its_rule_is_found() {
    let wrong = [
        "A file MUST be blue.",
        "A file MUST be blue [BB9999].",
        "It is so [BB0001]. A file MUST be blue, and\nso on. It is [not machine-checkable].",
        "- A file MUST NOT be red [BB0010].",
        "A file SHOULD be blue [BB0001].",
    ];
    for text in wrong {
        assert_eq!(spec::text::faults(text).len(), 1, "{text}: {:?}", spec::text::faults(text));
    }
    let right =
        "A file MUST be\nblue [BB0001, BB0010]. It SHOULD be bright [BB0010]; it MUST shine [not machine-checkable].";
    assert_eq!(spec::text::faults(right), Vec::<String>::new());
    assert!(spec::text::uncovered(right).iter().all(|rule| !rule.starts_with("BB0001")));
}

#[test]
fn every_demand_names_its_rule_and_every_rule_is_in_the_text() {
    let text = std::fs::read_to_string(spec::folder().join("bbrf-1.0.md")).unwrap();
    let faults = spec::text::faults(&text);
    assert!(faults.is_empty(), "{faults:#?}");
    let uncovered = spec::text::uncovered(&text);
    assert!(uncovered.is_empty(), "rules that the specification does not mention: {uncovered:#?}");
    for (number, _, title) in CLAUSES {
        let heading = format!("## {number}. {title}\n");
        assert!(text.contains(&heading), "no heading `{}`", heading.trim());
    }
    for (name, _) in spec::tables() {
        assert!(text.contains(&format!("tables/{name}.md")), "tables/{name}.md is not referred to");
    }
}

/// Who opens a file in a viewer sees of every array what it is, and of numbers in which unit.
#[test]
fn every_dataset_says_what_it_is_and_in_which_unit() {
    let tree = document_tree(&spec::full::full()).unwrap();
    let mut silent = Vec::new();
    tree.visit("", &mut |path, object| {
        let Object::Dataset(dataset) = object else { return };
        let has = |attribute: &str| dataset.attributes.contains_key(attribute);
        // Bit masks have no unit, and each element of a covariance has another.
        let number =
            !matches!(dataset.array.data, Data::Text(_)) && !has("flag_masks") && !path.ends_with("/covariance");
        if !path.starts_with("/extension/") && (!has("long_name") || number && !has("units")) {
            silent.push(path.to_owned());
        }
    });
    assert_eq!(silent, Vec::<String>::new());
}
