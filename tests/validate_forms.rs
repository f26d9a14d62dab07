//! What pipelines read and steer: SARIF against its official schema, JUnit read back, Markdown to the letter, profiles,
//! grades, baselines, repairs, and many files of which one is broken.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use bbrf::container::tree::{Array, Data, Dataset, Group};
use bbrf::container::{document_bytes, document_tree, sign_tree, tree_bytes};
use bbrf::dataset::Document;
use bbrf::quantity::Basis;
use bbrf::validate::{RULES, validate_bytes};
use conformance::{FAULTS, clean, clean_bytes, tree_of};
use serde_json::Value;

/// A folder of files, and the command in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn with(self, name: &str, bytes: Vec<u8>) -> Self {
        fs::write(self.at(name), bytes).unwrap();
        self
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn validate(&self, arguments: &[&str]) -> Output {
        let mut command = assert_cmd::Command::cargo_bin("bbrf").unwrap();
        command.current_dir(self.0.path()).arg("validate").args(arguments).output().unwrap()
    }

    fn status(&self, arguments: &[&str]) -> i32 {
        self.validate(arguments).status.code().unwrap()
    }

    fn said(&self, arguments: &[&str]) -> String {
        String::from_utf8(self.validate(arguments).stdout).unwrap()
    }

    fn reported(&self, arguments: &[&str]) -> String {
        String::from_utf8(self.validate(arguments).stderr).unwrap()
    }
}

fn fault(rule: &str, what: &str) -> Vec<u8> {
    FAULTS.iter().find(|fault| fault.rule == rule && fault.what == what).unwrap().bytes()
}

fn changed(change: impl FnOnce(&mut Document)) -> Vec<u8> {
    let mut document = clean();
    change(&mut document);
    document_bytes(&document).unwrap().0
}

/// The clean file without its basis, which is a warning.
fn warned() -> Vec<u8> {
    changed(|document| document.measurements[0].quantity.basis = Basis::Unstated)
}

/// A clean file, one with a warning, one with an error, one that is none.
fn four() -> Folder {
    Folder::new()
        .with("a clean.bbrf", clean_bytes())
        .with("warned.bbrf", warned())
        .with("changed.bbrf", fault("digest.object", "one-value"))
        .with("broken.bbrf", b"not HDF5 | <b>".to_vec())
}

const FOUR: [&str; 4] = ["a clean.bbrf", "warned.bbrf", "changed.bbrf", "broken.bbrf"];

fn with(first: &[&'static str], rest: &[&'static str]) -> Vec<&'static str> {
    first.iter().chain(rest).copied().collect()
}

/// The official schema, as the package that SARIF is written with brings it.
fn sarif_schema() -> Option<Value> {
    let arguments = ["metadata", "--format-version", "1", "--offline", "--locked"];
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut command = std::process::Command::new(cargo);
    let output = command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    let metadata: Value = serde_json::from_slice(&output.stdout).ok()?;
    let package = metadata["packages"].as_array()?.iter().find(|package| package["name"] == "serde-sarif")?;
    let folder = Path::new(package["manifest_path"].as_str()?).parent()?;
    serde_json::from_str(&fs::read_to_string(folder.join("src/schema.json")).ok()?).ok()
}

#[test]
fn sarif_follows_the_official_schema() {
    let Some(mut schema) = sarif_schema() else {
        eprintln!("skipped: the package serde-sarif has no src/schema.json here");
        return;
    };
    // Their pattern of a language has a bracket too many and is no regular expression.
    for place in ["run", "toolComponent"] {
        let language = schema.pointer_mut(&format!("/definitions/{place}/properties/language")).unwrap();
        language.as_object_mut().unwrap().remove("pattern").unwrap();
    }
    let validator = jsonschema::validator_for(&schema).unwrap();
    assert!(!validator.is_valid(&serde_json::json!({ "version": "2.1.0" })), "the schema asks for runs");
    let mut folder = four();
    for fault in FAULTS {
        folder = folder.with(&fault.file_name(), fault.bytes());
    }
    let faulty: Vec<String> = FAULTS.iter().map(conformance::Fault::file_name).collect();
    folder = folder.with("#1 50% é&.bbrf", b"not HDF5".to_vec());
    let mut arguments = vec!["--output", "sarif", "#1 50% é&.bbrf"];
    arguments.extend(FOUR);
    arguments.extend(faulty.iter().map(String::as_str));
    let sarif: Value = serde_json::from_str(&folder.said(&arguments)).unwrap();
    let errors: Vec<String> = validator.iter_errors(&sarif).map(|error| error.to_string()).take(5).collect();
    assert!(errors.is_empty(), "{errors:#?}");
    let run = &sarif["runs"][0];
    let odd = &run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
    assert_eq!(odd, "%231%2050%25%20%C3%A9%26.bbrf", "RFC 3986");
    let results = run["results"].as_array().unwrap();
    assert!(results.len() > FAULTS.len());
    for result in results {
        let index = usize::try_from(result["ruleIndex"].as_u64().unwrap()).unwrap();
        assert_eq!(run["tool"]["driver"]["rules"][index]["id"], result["ruleId"]);
        let physical = &result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
        assert!(physical.as_str().is_some_and(|uri| !uri.is_empty() && !uri.contains(' ')), "{result}");
        assert!(result["partialFingerprints"]["bbrf/v1"].is_string());
    }
}

#[test]
fn junit_reads_back_with_its_counts() {
    let folder = four();
    let text = folder.said(&with(&["--output", "junit"], &FOUR));
    let report = quick_junit::Report::deserialize_from_str(&text).unwrap();
    assert_eq!(report.test_suites.len(), 4);
    assert_eq!(report.tests, 4 * RULES.len());
    let failures: Vec<usize> = report.test_suites.iter().map(|suite| suite.failures).collect();
    assert_eq!((failures[0], failures[1], failures[3]), (0, 0, 1), "a warning is no failure");
    assert!(failures[2] > 0);
    assert_eq!(report.failures, failures.iter().sum::<usize>());
    for suite in &report.test_suites {
        let failed = suite
            .test_cases
            .iter()
            .filter(|case| matches!(case.status, quick_junit::TestCaseStatus::NonSuccess { .. }));
        assert_eq!((suite.tests, suite.failures), (suite.test_cases.len(), failed.count()));
    }
    let warned = &report.test_suites[1].test_cases;
    let case = warned.iter().find(|case| case.name.as_str() == "quantity.unstated").unwrap();
    assert!(case.system_out.as_ref().unwrap().as_str().contains("the basis of the values"));
}

#[test]
fn markdown_to_the_letter() {
    let folder = Folder::new()
        .with("clean.bbrf", clean_bytes())
        .with("warned.bbrf", warned())
        .with("bad|<name>.bbrf", b"text".to_vec());
    let said = folder.said(&["--output", "markdown", "clean.bbrf", "warned.bbrf", "bad|<name>.bbrf"]);
    let rule = RULES.iter().find(|rule| rule.name() == "quantity.unstated").unwrap();
    let expected = format!(
        "# bbrf validate\n\
         \n## clean.bbrf\n\nclean.bbrf: valid (0 errors, 0 warnings, 0 notes)\n\
         \n## warned.bbrf\n\nwarned.bbrf: valid (0 errors, 1 warning, 0 notes)\n\
         \n| severity | rule | place | found | expected | what to do |\n|---|---|---|---|---|---|\n\
         | warning | {} `{}` | `/measurement/{}/value@basis` | `unstated` | the basis of the values | {} |\n\
         \n## bad\\|&lt;name>.bbrf\n\nbad\\|&lt;name>.bbrf: NOT READABLE (1 error, 0 warnings, 0 notes)\n",
        rule.alias,
        rule.id,
        clean().measurements[0].id,
        rule.repair
    );
    assert!(said.starts_with(&expected), "{said}\n---\n{expected}");
}

#[test]
fn profiles_and_grades_decide_the_status() {
    let folder = four();
    assert_eq!(folder.status(&["a clean.bbrf", "warned.bbrf"]), 0);
    assert_eq!(folder.status(&["--profile", "raw", "warned.bbrf"]), 0);
    assert_eq!(folder.status(&["--profile", "archive", "warned.bbrf"]), 1);
    assert_eq!(folder.status(&["--profile", "archive", "--allow", "quantity.unstated", "warned.bbrf"]), 0);
    assert_eq!(folder.status(&["--deny", "warnings", "warned.bbrf"]), 1);
    assert_eq!(folder.status(&["--deny", "quantity", "warned.bbrf"]), 1, "a group");
    assert_eq!(folder.status(&["--deny", "physics", "warned.bbrf"]), 0, "another group");
    assert_eq!(folder.status(&["--allow", "structure", "broken.bbrf"]), 2, "never left out");
    for wrong in [["--deny", "quantity.unstatd"], ["--profile", "museum"], ["--allow", "BB9999"]] {
        let mut arguments = wrong.to_vec();
        arguments.push("a clean.bbrf");
        assert_eq!(folder.status(&arguments), 2, "{wrong:?}");
        assert!(folder.reported(&arguments).contains("expected"), "{wrong:?}");
    }
}

#[test]
fn one_broken_file_leaves_the_others_their_reports() {
    let folder = four();
    let arguments = with(&["--json"], &FOUR);
    assert_eq!(folder.status(&arguments), 2, "the worst of all");
    let json: Value = serde_json::from_str(&folder.said(&arguments)).unwrap();
    let status = |index: usize| json["files"][index]["status"].as_str().unwrap().to_owned();
    assert_eq!([status(0), status(1), status(2), status(3)], ["valid", "valid", "invalid", "unreadable"]);
    assert_eq!(folder.status(&FOUR[..3]), 1);
}

#[test]
fn a_baseline_leaves_out_what_is_known_and_nothing_new() {
    let folder = four();
    assert_eq!(folder.status(&["--write-baseline", "known.json", "changed.bbrf", "warned.bbrf"]), 1);
    assert_eq!(folder.status(&["--baseline", "known.json", "changed.bbrf"]), 0);
    let said = folder.said(&["--baseline", "known.json", "warned.bbrf"]);
    assert!(said.contains("valid (0 errors, 0 warnings") && said.contains("1 known finding left out"), "{said}");
    // Accepted as a warning, and now an error.
    assert_eq!(folder.status(&["--baseline", "known.json", "--deny", "warnings", "warned.bbrf"]), 1);
    assert_eq!(folder.status(&["--deny", "warnings", "--write-baseline", "errors.json", "warned.bbrf"]), 1);
    assert_eq!(folder.status(&["--baseline", "errors.json", "--deny", "warnings", "warned.bbrf"]), 0);
    let known: Value = serde_json::from_slice(&fs::read(folder.at("known.json")).unwrap()).unwrap();
    let of_warned: Vec<&Value> =
        known["known"].as_array().unwrap().iter().filter(|known| known["place"]["file"] == "warned.bbrf").collect();
    assert_eq!(of_warned.len(), 1, "{known}");
    let finding = of_warned[0];
    assert_eq!(finding["severity"], "warning");
    assert!(finding["rule"].as_str().unwrap().starts_with("bbrf:1.0:") && finding["found"].is_string(), "{finding}");
    for (form, says) in [
        ("json", "\"known\": 1"),
        ("sarif", "\"knownFindingsLeftOut\": 1"),
        ("junit", "1 known finding left out"),
        ("markdown", "1 known finding left out"),
    ] {
        let output = folder.validate(&["--baseline", "known.json", "--output", form, "warned.bbrf"]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.contains(says), "{form}: {text}");
    }
    let moved = folder.at("sub");
    fs::create_dir(&moved).unwrap();
    fs::copy(folder.at("changed.bbrf"), moved.join("changed.bbrf")).unwrap();
    assert_eq!(folder.status(&["--baseline", "known.json", "sub/changed.bbrf"]), 0, "another folder");
    fs::write(folder.at("warned.bbrf"), fault("digest.object", "one-angle")).unwrap();
    assert_eq!(folder.status(&["--baseline", "known.json", "warned.bbrf"]), 1, "new");
    fs::write(folder.at("changed.bbrf"), fault("digest.document", "one-value")).unwrap();
    assert_eq!(folder.status(&["--baseline", "known.json", "changed.bbrf"]), 1, "another change of the same dataset");
    fs::write(folder.at("bad.json"), "{}").unwrap();
    assert_eq!(folder.status(&["--baseline", "bad.json", "a clean.bbrf"]), 2);
    assert!(folder.reported(&["--baseline", "bad.json", "a clean.bbrf"]).contains("--write-baseline"));
}

/// Behind an error that ends the reading anything may change.
#[test]
fn no_baseline_accepts_a_document_that_cannot_be_read() {
    let folder = four();
    let undecodable = FAULTS.iter().map(conformance::Fault::bytes).find(|bytes| {
        let report = validate_bytes(bytes.as_slice());
        report.digest.is_none() && report.status() == bbrf::validate::Status::Invalid
    });
    fs::write(folder.at("no document.bbrf"), undecodable.unwrap()).unwrap();
    assert_eq!(folder.status(&["--write-baseline", "all.json", "no document.bbrf", "changed.bbrf"]), 1);
    assert_eq!(folder.status(&["--baseline", "all.json", "changed.bbrf"]), 0);
    assert_eq!(folder.status(&["--baseline", "all.json", "no document.bbrf"]), 1);
}

#[test]
fn what_is_known_of_one_file_says_nothing_of_another_of_its_name() {
    let folder = Folder::new();
    for sample in ["a", "b"] {
        fs::create_dir(folder.at(sample)).unwrap();
        fs::write(folder.at(sample).join("scan.bbrf"), warned()).unwrap();
    }
    let deny = |arguments: &[&'static str]| folder.status(&with(&["--deny", "warnings"], arguments));
    assert_eq!(deny(&["--write-baseline", "known.json", "a/scan.bbrf"]), 1);
    assert_eq!(deny(&["--baseline", "known.json", "a/scan.bbrf"]), 0);
    assert_eq!(deny(&["--baseline", "known.json", "./a/scan.bbrf"]), 0);
    assert_eq!(deny(&["--baseline", "known.json", "b/scan.bbrf"]), 1);
}

/// Without the check before reading, memory for the whole of it is asked for, and the program ends in an abort.
#[test]
fn a_file_of_a_terabyte_is_refused_and_the_next_is_checked() {
    let folder = Folder::new().with("clean.bbrf", clean_bytes());
    fs::File::create(folder.at("huge.bbrf")).unwrap().set_len(1 << 40).unwrap();
    assert_eq!(folder.status(&["huge.bbrf", "clean.bbrf"]), 2);
    let said = folder.said(&["huge.bbrf", "clean.bbrf"]);
    assert!(said.contains("more than the 17179869184 bytes") && said.contains("clean.bbrf: valid"), "{said}");
    let info =
        assert_cmd::Command::cargo_bin("bbrf").unwrap().arg("info").arg(folder.at("huge.bbrf")).output().unwrap();
    assert_eq!(info.status.code(), Some(2));
    if cfg!(unix) {
        assert!(folder.said(&["/dev/zero"]).contains("a device and no file"));
    }
}

/// The clean file as somebody else wrote it: without digests, and with content of their own.
fn without_digests() -> Vec<u8> {
    let mut tree: Group = document_tree(&clean()).unwrap();
    sign_tree(&mut tree);
    tree.attributes.remove("digest");
    tree.attributes.insert("institution".to_owned(), Array::text("a hall"));
    let notes = Dataset::new(Array::vector(Data::F64(vec![1.0, 2.0].into())));
    tree.datasets.push(("notes".to_owned(), notes));
    tree_bytes(&tree).unwrap()
}

#[test]
fn a_repair_adds_what_is_missing_and_keeps_the_rest() {
    let folder = Folder::new().with("unsigned.bbrf", without_digests());
    let before = fs::read(folder.at("unsigned.bbrf")).unwrap();
    let digest = validate_bytes(&before).digest;
    let said = folder.reported(&["--fix", "--dry-run", "unsigned.bbrf"]);
    assert!(said.contains("would mend digest.missing"), "{said}");
    assert_eq!(fs::read(folder.at("unsigned.bbrf")).unwrap(), before, "a dry run writes nothing");
    let said = folder.reported(&["--fix", "unsigned.bbrf"]);
    assert!(said.contains("mended digest.missing"), "{said}");
    let after = fs::read(folder.at("unsigned.bbrf")).unwrap();
    let report = validate_bytes(&after);
    assert_eq!(report.digest, digest, "the content is what it was");
    assert!(report.findings.iter().all(|finding| !finding.rule.ends_with("digest.missing")));
    let tree = tree_of(&after);
    assert_eq!(tree.attributes.get("institution").and_then(Array::as_text), Some("a hall"));
    assert_eq!(tree.dataset("notes").unwrap().array.data, Data::F64(vec![1.0, 2.0].into()));
    assert!(folder.reported(&["--fix", "unsigned.bbrf"]).contains("nothing that writing it again would mend"));
}

#[test]
fn a_repair_refuses_content_that_has_another_digest() {
    let mut tree: Group = document_tree(&clean()).unwrap();
    sign_tree(&mut tree);
    conformance::numbers(tree.at_mut("measurement/scan").unwrap(), "value")[0] += 1.0;
    tree.at_mut("sample/paint").unwrap().attributes.remove("sha256");
    let folder = Folder::new().with("changed.bbrf", tree_bytes(&tree).unwrap());
    let before = fs::read(folder.at("changed.bbrf")).unwrap();
    let output = folder.validate(&["--fix", "changed.bbrf"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("not repaired") && said.contains("nobody knows what it was"), "{said}");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read(folder.at("changed.bbrf")).unwrap(), before);
    assert!(folder.with("none.bbrf", b"text".to_vec()).reported(&["--fix", "none.bbrf"]).contains("none.bbrf"));
}

/// Needs `BBRF_PYTHON` with h5py, which `make test` brings.
#[test]
fn a_repair_makes_an_unusual_encoding_portable() {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return;
    };
    let folder = Folder::new().with("clean.bbrf", clean_bytes());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/encodings.py");
    let mut command = std::process::Command::new(python);
    assert!(command.arg(script).arg(folder.at("clean.bbrf")).arg(folder.0.path()).output().unwrap().status.success());
    let digest = validate_bytes(clean_bytes()).digest;
    for name in ["big-endian", "variable-strings", "no-creation-order", "user-block", "no-scales", "fill-value"] {
        let file = format!("{name}.bbrf");
        assert_eq!(folder.status(&["--deny", "portability", &file]), 1, "{name}");
        let said = folder.reported(&["--fix", "--deny", "portability", &file]);
        assert!(said.contains("mended portability."), "{name}: {said}");
        assert_eq!(folder.status(&["--deny", "portability", &file]), 0, "{name}");
        assert_eq!(validate_bytes(fs::read(folder.at(&file)).unwrap()).digest, digest, "{name}");
    }
}
