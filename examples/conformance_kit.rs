//! Writes the conformance kit, and scores readers and validators with it.
//!
//! ```text
//! cargo run --example conformance_kit -- write FOLDER
//! cargo run --example conformance_kit -- score FOLDER -- bbrf validate --json {}
//! ```
//!
//! `write` makes `FOLDER/clean.bbrf`, a file for each fault, named `RULE=FAULT.bbrf`, and `FOLDER/kit.csv` (file, rule,
//! severity, what the clean file has there). Files in other encodings are made from the clean one by
//! `conformance/encodings.py`, because one HDF5 library should not judge itself.
//!
//! `score` runs a command on every file; `{}` stands for the file. A validator is right where it names the rule, a
//! reader where it refuses what is an error (status other than 0). Crashes and time-outs count apart.
#![allow(clippy::print_stdout, reason = "a program")]

#[path = "../conformance/mod.rs"]
mod conformance;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use bbrf::validate::{Severity, rule};
use conformance::{FAULTS, clean_bytes};

/// A file that takes longer has hung the program.
const PATIENCE: Duration = Duration::from_secs(20);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["write", folder] => write(Path::new(folder)),
        ["score", folder, "--", command @ ..] if !command.is_empty() => score(Path::new(folder), command),
        _ => Err("expected `write FOLDER` or `score FOLDER -- COMMAND {}`".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn write(folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("clean.bbrf"), clean_bytes())?;
    let mut table = String::from("file,rule,severity\nclean.bbrf,,\n");
    for fault in FAULTS {
        fs::write(folder.join(fault.file_name()), fault.bytes())?;
        let severity = rule(fault.rule).ok_or("a fault of no rule")?.severity.name();
        table.push_str(&format!("{},bbrf:1.0:{},{severity}\n", fault.file_name(), fault.rule));
    }
    fs::write(folder.join("kit.csv"), table)?;
    println!("{}: 1 clean file, {} faults", folder.display(), FAULTS.len());
    Ok(())
}

/// What a program made of a file.
enum Answer {
    Ended { status: i32, named: bool },
    Crashed,
    Hung,
}

fn score(folder: &Path, command: &[&str]) -> Result<(), Box<dyn Error>> {
    let clean = ask(command, &folder.join("clean.bbrf"), "")?;
    let accepted = matches!(clean, Answer::Ended { status: 0, .. });
    println!("clean file: {}", if accepted { "accepted" } else { "NOT accepted" });
    // Rows: severities; columns: named by its rule, refused for another reason, passed, crashed, hung.
    let mut counts = [[0_usize; 5]; 3];
    for fault in FAULTS {
        let severity = rule(fault.rule).ok_or("a fault of no rule")?.severity;
        let column = match ask(command, &folder.join(fault.file_name()), fault.rule)? {
            Answer::Ended { named: true, .. } => 0,
            Answer::Ended { status, .. } if status != 0 => 1,
            Answer::Ended { .. } => 2,
            Answer::Crashed => 3,
            Answer::Hung => 4,
        };
        if column > 1 || (column == 1 && severity == Severity::Error) {
            println!("  {} {}", ["", "other rule:", "passed:", "CRASHED:", "HUNG:"][column], fault.file_name());
        }
        counts[severity as usize][column] += 1;
    }
    println!(
        "{:<10} {:>8} {:>12} {:>8} {:>8} {:>8}",
        "fault of", "by rule", "other reason", "passed", "crashed", "hung"
    );
    for severity in [Severity::Error, Severity::Warning, Severity::Info] {
        let [named, refused, passed, crashed, hung] = counts[severity as usize];
        println!("{:<10} {named:>8} {refused:>12} {passed:>8} {crashed:>8} {hung:>8}", severity.name());
    }
    Ok(())
}

fn ask(command: &[&str], file: &Path, rule: &str) -> Result<Answer, Box<dyn Error>> {
    let file = file.display().to_string();
    let arguments = command.iter().skip(1).map(|word| word.replace("{}", &file));
    let output = std::env::temp_dir().join(format!("conformance-{}.txt", std::process::id()));
    let mut child = Command::new(command[0])
        .args(arguments)
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
            return Ok(Answer::Hung);
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let said = String::from_utf8_lossy(&fs::read(&output)?).into_owned();
    fs::remove_file(&output)?;
    let named = !rule.is_empty() && said.contains(rule);
    Ok(status.code().map_or(Answer::Crashed, |status| Answer::Ended { status, named }))
}
