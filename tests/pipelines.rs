//! The pre-commit hook in a git repository, and the steps of the GitHub action as a runner takes them. Run by
//! `make test-ecosystem`; needs git and the packages of `tests/python/ecosystem.txt`.
#![cfg(all(feature = "write", unix))]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use conformance::{FAULTS, clean_bytes};
use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn python() -> PathBuf {
    let python = std::env::var_os("BBRF_PYTHON").map(PathBuf::from);
    python.unwrap_or_else(|| panic!("BBRF_PYTHON does not name a Python interpreter; make test-ecosystem does"))
}

fn yaml(path: &Path) -> Value {
    let script = "import json, sys, yaml; print(json.dumps(yaml.safe_load(open(sys.argv[1]))))";
    let output = Command::new(python()).args(["-c", script]).arg(path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn damaged_bytes() -> Vec<u8> {
    FAULTS.iter().find(|fault| fault.rule == "digest.object").unwrap().bytes()
}

/// The command's folder before all others.
fn path_with(first: &Path) -> String {
    format!("{}:{}", first.display(), std::env::var("PATH").unwrap())
}

fn program() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_bbrf"))
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// A repository with the hook of this project. Its environment would be built by cargo for minutes and from a network;
/// so the definition is taken as it is, except that the command is the one that was built already.
struct Repository(tempfile::TempDir);

impl Repository {
    fn new() -> Self {
        let repository = Self(tempfile::tempdir().unwrap());
        let hooks = yaml(&root().join(".pre-commit-hooks.yaml"));
        let mut hook = hooks[0].clone();
        assert_eq!(hook["entry"], "bbrf validate");
        hook["language"] = "system".into();
        let config = serde_json::json!({ "repos": [{ "repo": "local", "hooks": [hook] }] });
        // JSON is YAML.
        fs::write(repository.0.path().join(".pre-commit-config.yaml"), config.to_string()).unwrap();
        for arguments in [
            &["init", "--quiet"][..],
            &["config", "user.name", "A. Person"],
            &["config", "user.email", "a.person@example.org"],
            &["config", "commit.gpgsign", "false"],
            &["add", ".pre-commit-config.yaml"],
        ] {
            let output = repository.git(arguments);
            assert!(output.status.success(), "{}", said(&output));
        }
        let output = repository.command(python(), &["-m", "pre_commit", "install"]);
        assert!(output.status.success(), "{}", said(&output));
        repository
    }

    fn command(&self, program_path: impl AsRef<std::ffi::OsStr>, arguments: &[&str]) -> Output {
        let mut command = Command::new(program_path);
        command.current_dir(self.0.path()).args(arguments).env("PATH", path_with(program().parent().unwrap()));
        for inherited in ["GIT_DIR", "GIT_INDEX_FILE", "GIT_WORK_TREE", "SKIP"] {
            command.env_remove(inherited);
        }
        command.env("PRE_COMMIT_HOME", self.0.path().join(".git/pre-commit-home")).output().unwrap()
    }

    fn git(&self, arguments: &[&str]) -> Output {
        self.command("git", arguments)
    }

    fn commit(&self, name: &str, bytes: &[u8]) -> Output {
        fs::write(self.0.path().join(name), bytes).unwrap();
        assert!(self.git(&["add", name]).status.success());
        self.git(&["commit", "-m", name])
    }
}

#[test]
#[ignore = "needs git and pre-commit; make test-ecosystem"]
fn the_hook_lets_valid_files_pass_and_stops_a_damaged_one() {
    let manifest = root().join(".pre-commit-hooks.yaml");
    let valid = Command::new(python()).args(["-m", "pre_commit", "validate-manifest"]).arg(&manifest).output().unwrap();
    assert!(valid.status.success(), "{}", said(&valid));

    let repository = Repository::new();
    let clean = repository.commit("clean file.bbrf", &clean_bytes());
    assert!(clean.status.success() && said(&clean).contains("Passed"), "{}", said(&clean));
    let damaged = repository.commit("damaged.bbrf", &damaged_bytes());
    assert!(!damaged.status.success(), "{}", said(&damaged));
    assert!(said(&damaged).contains("digest.object") && said(&damaged).contains("damaged.bbrf"), "{}", said(&damaged));
    assert!(!said(&damaged).contains("clean file.bbrf"), "only what is committed is validated: {}", said(&damaged));
    assert!(repository.git(&["rm", "--quiet", "-f", "damaged.bbrf"]).status.success());
    let other = repository.commit("notes.txt", b"no bbrf file");
    assert!(other.status.success() && said(&other).contains("Skipped"), "{}", said(&other));
}

/// A runner of the action in a folder: the steps of `action.yml` with their environment, as GitHub's `bash` runs them.
struct Runner {
    folder: tempfile::TempDir,
    action: Value,
}

impl Runner {
    fn new() -> Self {
        let runner = Self { folder: tempfile::tempdir().unwrap(), action: yaml(&root().join("action.yml")) };
        for folder in ["temporary/bbrf/bin", "work/data", "stub"] {
            fs::create_dir_all(runner.at(folder)).unwrap();
        }
        runner
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Text with `${{ inputs.NAME }}` and `${{ github.action_path }}` put in.
    fn expanded(&self, text: &str, inputs: &BTreeMap<&str, &str>) -> String {
        let mut text = text.to_owned();
        for (name, input) in self.action["inputs"].as_object().unwrap() {
            let value = inputs.get(name.as_str()).copied().or(input["default"].as_str()).unwrap();
            text = text.replace(&format!("${{{{ inputs.{name} }}}}"), value);
        }
        let text = text.replace("${{ github.action_path }}", &root().display().to_string());
        assert!(!text.contains("${{"), "an expression that the test does not know: {text}");
        text
    }

    /// Runs a step; its outputs are what it wrote for them.
    fn step(&self, name: &str, inputs: &[(&str, &str)]) -> (Output, BTreeMap<String, String>) {
        let inputs: BTreeMap<&str, &str> = inputs.iter().copied().collect();
        let steps = self.action["runs"]["steps"].as_array().unwrap();
        let step = steps.iter().find(|step| step["name"] == name).unwrap();
        assert_eq!(step["shell"], "bash");
        let outputs = self.at("outputs");
        fs::write(&outputs, "").unwrap();
        fs::write(self.at("step.sh"), step["run"].as_str().unwrap()).unwrap();
        let mut command = Command::new("bash");
        command.args(["--noprofile", "--norc", "-eo", "pipefail"]).arg(self.at("step.sh"));
        command.current_dir(self.at("work")).env("RUNNER_TEMP", self.at("temporary")).env("GITHUB_OUTPUT", &outputs);
        command.env("PATH", path_with(&self.at("stub")));
        for (key, value) in step["env"].as_object().unwrap() {
            command.env(key, self.expanded(value.as_str().unwrap(), &inputs));
        }
        let output = command.output().unwrap();
        let written = fs::read_to_string(&outputs).unwrap();
        let pairs = written.lines().filter_map(|line| line.split_once('='));
        (output, pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).collect())
    }

    fn script(&self, name: &str, text: &str) {
        fs::write(self.at(name), text).unwrap();
        fs::set_permissions(self.at(name), fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// The command where the step `install` would put it.
    fn installed(self) -> Self {
        fs::copy(program(), self.at("temporary/bbrf/bin/bbrf")).unwrap();
        self
    }

    fn with(self, name: &str, bytes: &[u8]) -> Self {
        fs::write(self.at("work/data").join(name), bytes).unwrap();
        self
    }
}

#[test]
#[ignore = "needs PyYAML; make test-ecosystem"]
fn the_action_validates_what_the_pattern_matches_and_hands_over_its_report() {
    let runner = Runner::new().installed().with("a clean.bbrf", &clean_bytes());
    let (output, outputs) = runner.step("validate", &[]);
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(outputs["status"], "0");
    let sarif: Value = serde_json::from_slice(&fs::read(runner.at("work").join(&outputs["sarif"])).unwrap()).unwrap();
    assert_eq!(sarif["version"], "2.1.0");

    let runner = runner.with("damaged.bbrf", &damaged_bytes());
    let (output, outputs) = runner.step("validate", &[("sarif", "out.sarif"), ("arguments", "--profile archive")]);
    assert_eq!((output.status.code(), outputs["status"].as_str()), (Some(1), "1"));
    let sarif = fs::read_to_string(runner.at("work/out.sarif")).unwrap();
    assert!(sarif.contains("digest.object") && sarif.contains("damaged.bbrf"), "{sarif}");

    let runner = runner.with("broken.bbrf", b"no HDF5");
    let (output, outputs) = runner.step("validate", &[]);
    assert_eq!((output.status.code(), outputs["status"].as_str()), (Some(2), "2"));
}

#[test]
#[ignore = "needs PyYAML; make test-ecosystem"]
fn an_action_without_files_says_so_and_passes() {
    let runner = Runner::new().installed();
    let (output, outputs) = runner.step("validate", &[("files", "nowhere/*.bbrf")]);
    assert!(output.status.success() && said(&output).contains("no file matches nowhere/*.bbrf"), "{}", said(&output));
    assert_eq!(outputs.get("status").map(String::as_str), Some("0"));
    assert!(!outputs.contains_key("sarif"));
}

/// What a user writes into the inputs is data and never a command.
#[test]
#[ignore = "needs PyYAML; make test-ecosystem"]
fn inputs_of_the_action_are_never_run() {
    let runner = Runner::new().installed().with("clean.bbrf", &clean_bytes());
    for input in ["files", "arguments", "sarif"] {
        runner.step("validate", &[(input, "$(touch run-by-input); `touch run-by-input` && touch run-by-input")]);
        assert!(!runner.at("work/run-by-input").exists(), "{input}");
    }
}

/// The build itself takes minutes and a network: a `cargo` and a `python3` that write down what they are asked.
#[test]
#[ignore = "needs PyYAML; make test-ecosystem"]
fn the_action_builds_the_locked_command_of_its_own_version_with_a_new_cmake() {
    let runner = Runner::new();
    runner.script("stub/python3", "#!/bin/bash\nmkdir -p \"$3/bin\"\ncp \"$(dirname \"$0\")/pip\" \"$3/bin/pip\"\n");
    runner.script("stub/pip", "#!/bin/bash\necho \"$@\" > \"$RUNNER_TEMP/pip.txt\"\n");
    let copy = format!("cp {} \"$RUNNER_TEMP/bbrf/bin/bbrf\"", program().display());
    let cargo = format!("#!/bin/bash\necho \"$CMAKE|$@\" > \"$RUNNER_TEMP/cargo.txt\"\n{copy}\n");
    runner.script("stub/cargo", &cargo);
    let (output, _) = runner.step("install", &[]);
    assert!(output.status.success(), "{}", said(&output));
    let temporary = runner.at("temporary");
    let cargo = fs::read_to_string(temporary.join("cargo.txt")).unwrap();
    let (cmake, arguments) = cargo.trim().split_once('|').unwrap();
    assert_eq!(Path::new(cmake), temporary.join("bbrf-tools/bin/cmake"));
    let into = temporary.join("bbrf");
    assert_eq!(arguments, format!("install --locked --path {} --root {}", root().display(), into.display()));
    assert!(fs::read_to_string(temporary.join("pip.txt")).unwrap().contains("cmake>=3.26"));
    let runner = runner.with("clean.bbrf", &clean_bytes());
    let (output, outputs) = runner.step("validate", &[]);
    assert!(output.status.success() && outputs["status"] == "0", "{}", said(&output));
}
