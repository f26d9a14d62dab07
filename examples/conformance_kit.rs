//! Writes the conformance kit, and scores readers and validators with it.
//!
//! ```text
//! cargo run --example conformance_kit -- write FOLDER [PYTHON]
//! cargo run --example conformance_kit -- score FOLDER -- bbrf validate --json {}
//! cargo run --example conformance_kit -- score-reader FOLDER -- python examples/read_bbrf.py {}
//! cargo run --example conformance_kit -- golden testdata/golden PYTHON
//! ```
//!
//! `write` makes `FOLDER/clean.bbrf`, a file for each fault, named `RULE=FAULT.bbrf`, and `FOLDER/kit.csv` (file, rule,
//! severity). With a Python that has h5py it makes the clean file in other encodings, too (`FOLDER/encodings`), by
//! `conformance/encodings.py`, because one HDF5 library should not judge itself.
//!
//! `score` runs a command on every file; `{}` stands for the file. A validator finds a fault where its output names the
//! rule; another rule, or a status other than 0 without one, is the wrong rule. Of a reader (`score-reader`) no rule is
//! expected: it refuses (status other than 0) what no reader may take, and reads what is valid. An encoding is read right
//! where the output has the digest of the clean file. Crashes and time-outs count apart. `--page PAGE` before the `--` puts
//! the tables into a page, between the lines `<!-- validator -->` or `<!-- reader -->` and their ends.
//!
//! `golden` adds the files of this version of the standard to the golden set; it never replaces one.
#![allow(clippy::print_stdout, reason = "a program")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use bbrf::container::{document_bytes, layout};
use bbrf::validate::rule;
use conformance::score::{Answer, Encoding, Kind, encodings, into_section, table};
use conformance::{FAULTS, clean, clean_bytes, golden};

/// A file that takes longer has hung the program.
const PATIENCE: Duration = Duration::from_secs(20);

type Done = Result<(), Box<dyn Error>>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["write", folder, python @ ..] if python.len() < 2 => write(Path::new(folder), python.first().copied()),
        ["score", folder, rest @ ..] => score(Kind::Validator, Path::new(folder), rest),
        ["score-reader", folder, rest @ ..] => score(Kind::Reader, Path::new(folder), rest),
        ["golden", folder, python] => golden(Path::new(folder), python),
        _ => Err("expected `write FOLDER [PYTHON]`, `score FOLDER [--page PAGE] -- COMMAND {}`, the same with \
                  `score-reader`, or `golden FOLDER PYTHON`"
            .into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn write(folder: &Path, python: Option<&str>) -> Done {
    fs::create_dir_all(folder)?;
    let clean = folder.join("clean.bbrf");
    fs::write(&clean, clean_bytes())?;
    let mut table = String::from("file,rule,severity\nclean.bbrf,,\n");
    for fault in FAULTS {
        fs::write(folder.join(fault.file_name()), fault.bytes())?;
        let severity = rule(fault.rule).ok_or("a fault of no rule")?.severity.name();
        table.push_str(&format!("{},bbrf:1.0:{},{severity}\n", fault.file_name(), fault.rule));
    }
    fs::write(folder.join("kit.csv"), table)?;
    println!("{}: 1 clean file, {} faults", folder.display(), FAULTS.len());
    if let Some(python) = python {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance/encodings.py");
        let made = Command::new(python).arg(script).arg(&clean).arg(folder.join("encodings")).output()?;
        if !made.status.success() {
            return Err(String::from_utf8_lossy(&made.stderr).into());
        }
        fs::write(folder.join("encodings.txt"), &made.stdout)?;
        println!("{} encodings", String::from_utf8(made.stdout)?.lines().count());
    }
    Ok(())
}

fn golden(folder: &Path, python: &str) -> Done {
    let name = format!("bbrf-{}", layout::VERSION);
    let (bytes, digest) = document_bytes(&clean())?;
    golden::add_values(folder, &name, &clean())?;
    golden::add(folder, &format!("{name}-every-part"), &bytes, digest.as_str(), &name)?;
    let encodings = tempfile::tempdir()?;
    write(encodings.path(), Some(python))?;
    let bytes = fs::read(encodings.path().join("encodings/variable-strings.bbrf"))?;
    Ok(golden::add(folder, &format!("{name}-by-h5py"), &bytes, digest.as_str(), &name)?)
}

fn score(kind: Kind, folder: &Path, rest: &[&str]) -> Done {
    let (page, command) = match rest {
        ["--page", page, "--", command @ ..] => (Some(*page), command),
        ["--", command @ ..] => (None, command),
        _ => return Err("expected -- COMMAND {}".into()),
    };
    let (clean, said) = ask(command, &folder.join("clean.bbrf"))?;
    let accepted = matches!(clean, Answer::Ended { accepted: true, .. });
    let digest = digest_in(&said).map(str::to_owned);
    let mut answers = BTreeMap::new();
    for fault in FAULTS {
        answers.insert(fault.file_name(), ask(command, &folder.join(fault.file_name()))?.0);
    }
    let mut text = format!("The clean file is {}.\n\n", if accepted { "accepted" } else { "NOT accepted" });
    text += &table(kind, &answers);
    if let Ok(listed) = fs::read_to_string(folder.join("encodings.txt")) {
        let mut asked = Vec::new();
        for line in listed.lines() {
            let [name, same, rule] = line.split(' ').collect::<Vec<_>>().try_into().map_err(|_| "encodings.txt")?;
            let (answer, said) = ask(command, &folder.join(format!("encodings/{name}.bbrf")))?;
            asked.push(Encoding {
                name: name.to_owned(),
                rule: (rule != "-").then(|| rule.to_owned()),
                same: same == "same",
                read_right: digest.is_some() && digest_in(&said) == digest.as_deref(),
                answer,
            });
        }
        text += "\n";
        text += &encodings(kind, &asked);
    }
    match page {
        None => println!("{text}"),
        Some(page) => {
            let name = if kind == Kind::Validator { "validator" } else { "reader" };
            fs::write(page, into_section(&fs::read_to_string(page)?, name, &text)?)?;
        }
    }
    Ok(())
}

/// The first digest of a document in an output.
fn digest_in(said: &str) -> Option<&str> {
    let from = said.find("sha256:")?;
    said.get(from..from + "sha256:".len() + 64)
}

/// The rules named in an output, without their version.
fn rules_in(said: &str) -> Vec<String> {
    let is_of_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '.' || c == '-';
    let named = said.split("bbrf:1.0:").skip(1);
    let names = named.map(|rest| rest.chars().take_while(|c| is_of_name(*c)).collect::<String>());
    let mut names: Vec<String> = names.filter(|name| rule(name).is_some()).collect();
    names.sort();
    names.dedup();
    names
}

/// What a command made of a file, and what it said on stdout.
fn ask(command: &[&str], file: &Path) -> Result<(Answer, String), Box<dyn Error>> {
    let (program, arguments) = command.split_first().ok_or("expected a command")?;
    let file = file.display().to_string();
    let output = std::env::temp_dir().join(format!("conformance-{}.txt", std::process::id()));
    let mut child = Command::new(program)
        .args(arguments.iter().map(|word| word.replace("{}", &file)))
        .stdin(Stdio::null())
        .stdout(fs::File::create(&output)?)
        .stderr(Stdio::null())
        .spawn()?;
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if begun.elapsed() > PATIENCE {
            child.kill()?;
            child.wait()?;
            return Ok((Answer::Hung, String::new()));
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let said = String::from_utf8_lossy(&fs::read(&output)?).into_owned();
    fs::remove_file(&output)?;
    let ended = |status: i32| Answer::Ended { accepted: status == 0, named: rules_in(&said) };
    Ok((status.code().map_or(Answer::Crashed, ended), said))
}
