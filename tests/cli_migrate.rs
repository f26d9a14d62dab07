//! `bbrf migrate`: versions of the standard, and names of people.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::tree::{Array, Data, Dataset, Group};
use bbrf::container::{
    ReadError, digest, document_tree, open_to_rewrite, open_verified, read_file, rewrite, sign_tree, tree_bytes,
};
use bbrf::validate::{Severity, Status, validate_bytes};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn clean_file(folder: &Path) -> PathBuf {
    let path = folder.join("clean.bbrf");
    std::fs::write(&path, conformance::clean_bytes()).unwrap();
    path
}

/// The clean file as a program of version 1.7 would write it, with what a test adds.
fn later(folder: &Path, add: impl FnOnce(&mut Group)) -> PathBuf {
    let mut tree = document_tree(&conformance::clean()).unwrap();
    tree.attributes.insert("bbrf_version".into(), Array::text("1.7"));
    tree.attributes.insert("Conventions".into(), Array::text("CF-1.11 BBRF-1.7"));
    add(&mut tree);
    sign_tree(&mut tree);
    let path = folder.join("later.bbrf");
    std::fs::write(&path, tree_bytes(&tree).unwrap()).unwrap();
    path
}

fn scan(tree: &mut Group) -> &mut Group {
    tree.at_mut("measurement/scan").unwrap()
}

fn found(path: &Path) -> Vec<String> {
    let report = validate_bytes(std::fs::read(path).unwrap());
    let grave = report.findings.iter().filter(|finding| finding.severity > Severity::Info);
    grave.map(|finding| format!("{} {}", finding.alias, finding.place)).collect()
}

#[test]
fn a_current_file_is_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (clean_file(folder.path()), folder.path().join("out.bbrf"));
    let before = std::fs::read(&file).unwrap();
    bbrf().arg("migrate").arg(&file).arg("-o").arg(&output).assert().success().stdout(contains("nothing to do"));
    assert!(!output.exists());
    assert_eq!(std::fs::read(&file).unwrap(), before);
    bbrf().arg("migrate").arg(folder.path().join("none.bbrf")).assert().code(2).stderr(contains("none.bbrf"));
}

#[test]
fn a_later_minor_version_is_a_warning_and_no_damage() {
    let folder = tempfile::tempdir().unwrap();
    let file = later(folder.path(), |_| {});
    assert_eq!(found(&file), ["BB0004 /@bbrf_version"]);
    let output = folder.path().join("out.bbrf");
    let warned = || contains("1.7").and(contains("newer"));
    bbrf().arg("migrate").arg(&file).assert().success().stderr(warned());
    let (model, geometry) = (format!("{}#fit", file.display()), folder.path().join("geometry.csv"));
    std::fs::write(&geometry, "theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg\n30,180,10,0\n").unwrap();
    bbrf().args(["eval", "--model", &model, "--geometry"]).arg(&geometry).assert().success().stderr(warned());
    let (page, converted) = (folder.path().join("page.html"), folder.path().join("converted.bbrf"));
    let (page, converted) = (page.to_str().unwrap(), converted.to_str().unwrap());
    for arguments in [
        &["info"][..],
        &["fit", "--measurement", "scan"],
        &["convert", "--measurement", "scan", "--to", "brdf", "-o", converted],
        &["export", "--measurement", "scan", "--to", "csv"],
        &["report", "-o", page],
    ] {
        bbrf().args(arguments).arg(&file).assert().success().stderr(warned());
    }
    bbrf().arg("migrate").arg(&file).arg("-o").arg(&output).assert().success();
    // Nothing was added, so nothing is lost.
    assert_eq!(digest(&open_verified(&output).unwrap()).unwrap(), digest(&conformance::clean()).unwrap());
    assert_eq!(found(&output), Vec::<String>::new());
}

#[test]
fn what_a_later_version_adds_is_read_over_and_never_dropped() {
    type Add = fn(&mut Group);
    let additions: [(&str, Add); 3] = [
        ("scan@colour", |tree| {
            scan(tree).attributes.insert("colour".into(), Array::text("red"));
        }),
        ("scan/hue", |tree| {
            scan(tree).datasets.push(("hue".into(), Dataset::new(Array::vector(Data::F64(vec![1.0, 2.0].into())))));
        }),
        ("receipts", |tree| {
            let provenance = tree.group_mut("provenance").unwrap();
            let steps = provenance.dataset_mut("steps").unwrap();
            steps.array = Array::text(r#"[{"tool":"hand","action":"made","place":"here"}]"#);
        }),
    ];
    for (what, add) in additions {
        let folder = tempfile::tempdir().unwrap();
        let file = later(folder.path(), add);
        assert_eq!(found(&file), ["BB0004 /@bbrf_version"], "{what}");
        assert!(open_verified(&file).is_ok(), "{what}: it can be read");
        if let Some((_, name)) = what.split_once(['@', '/']) {
            let mut json = bbrf();
            json.args(["export", "--to", "json"]).arg(&file).assert().success().stderr(contains(name));
        }
        assert!(matches!(open_to_rewrite(&file), Err(ReadError::Later { .. })), "{what}");
        let output = folder.path().join("out.bbrf");
        let refused = bbrf().arg("migrate").arg(&file).arg("-o").arg(&output).assert().code(1);
        refused.stderr(contains(what).and(contains("later version")));
        assert!(!output.exists());
    }
}

#[test]
fn damage_in_a_later_version_is_damage() {
    let folder = tempfile::tempdir().unwrap();
    for at in ["value", "hue"] {
        let mut tree = document_tree(&conformance::clean()).unwrap();
        tree.attributes.insert("bbrf_version".into(), Array::text("1.7"));
        scan(&mut tree).datasets.push(("hue".into(), Dataset::new(Array::vector(Data::F64(vec![1.0, 2.0].into())))));
        sign_tree(&mut tree);
        conformance::numbers(scan(&mut tree), at)[0] += 1e-9;
        let path = folder.path().join("changed.bbrf");
        std::fs::write(&path, tree_bytes(&tree).unwrap()).unwrap();
        assert!(found(&path).contains(&format!("BB0101 /measurement/scan/{at}")), "{:?}", found(&path));
        assert!(open_verified(&path).is_err());
    }
}

#[test]
fn another_major_version_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = later(folder.path(), |tree| drop(tree.attributes.insert("bbrf_version".into(), Array::text("2.0"))));
    bbrf().arg("migrate").arg(&file).assert().code(2).stderr(contains("2.0"));
}

#[test]
fn a_better_description_is_no_change() {
    let mut tree = document_tree(&conformance::clean()).unwrap();
    sign_tree(&mut tree);
    let value = scan(&mut tree).dataset_mut("value").unwrap();
    value.attributes.insert("long_name".into(), Array::text("what the sheet sends back, over what a white plate does"));
    scan(&mut tree).dataset_mut("theta_i").unwrap().attributes.remove("long_name");
    let report = validate_bytes(tree_bytes(&tree).unwrap());
    // It is said, because no digest would tell it from damage.
    let found: Vec<_> = report.findings.iter().map(|finding| (finding.alias, finding.severity)).collect();
    assert_eq!(found, [("BB0013", Severity::Info)], "{:#?}", report.findings);
    assert_eq!(report.status(), Status::Valid);
}

#[test]
fn names_of_people_are_taken_out_and_everything_else_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = conformance::clean();
    document.provenance.receipts[0].inputs[0].name = "/home/person/scan.txt".to_owned();
    let (file, output) = (folder.path().join("in.bbrf"), folder.path().join("out.bbrf"));
    let mut tree = document_tree(&document).unwrap();
    sign_tree(&mut tree);
    tree.attributes.insert("history".into(), Array::text("appended"));
    std::fs::write(&file, tree_bytes(&tree).unwrap()).unwrap();

    bbrf().args(["migrate", "--anonymise"]).arg(&file).assert().code(2).stderr(contains("--output"));
    bbrf().args(["migrate", "--anonymise"]).arg(&file).arg("-o").arg(&file).assert().code(2);
    let run = bbrf().args(["migrate", "--anonymise", "--json"]).arg(&file).arg("-o").arg(&output).assert().success();
    let result: Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema/migrate.json");
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(schema).unwrap()).unwrap();
    assert!(jsonschema::is_valid(&schema, &result), "{result}");
    assert_eq!(result["removed"], serde_json::json!(["/@contact", "/measurement/scan@operator"]));
    let suspects: Vec<&str> =
        result["suspects"].as_array().unwrap().iter().filter_map(|s| s["path"].as_str()).collect();
    assert_eq!(suspects, ["/citation", "/provenance/receipts/0/inputs/0/name", "/@history"]);

    let opened = read_file(&output).unwrap();
    assert_eq!((opened.mismatched, opened.unknown), (vec![], vec!["/@history".to_owned()]));
    assert_eq!(opened.document.contact, None);
    let bytes = std::fs::read(&output).unwrap();
    let holds = |name: &str| bytes.windows(name.len()).any(|window| window == name.as_bytes());
    assert!(!holds("a.person@example.org"));
    // The model is still one of the measurement, which only lost a name.
    assert_eq!(found(&output), Vec::<String>::new());
    let mut expected = document;
    expected.anonymise();
    expected.models[0].data_digest.clone_from(&opened.document.models[0].data_digest);
    expected.provenance.steps.push(opened.document.provenance.steps[1].clone());
    let kept = rewrite(&expected, &opened.foreign).unwrap();
    assert!(kept == bytes, "something else changed");
}
