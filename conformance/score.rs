//! What a reader or validator made of the kit, as tables.

use std::collections::BTreeMap;
use std::fmt::Write;

use bbrf::validate::{RULES, Rule, Severity};

use super::{FAULTS, Fault};

/// What a program is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// To name the rule of every fault.
    Validator,
    /// To refuse what no reader may take, and to read what is valid.
    Reader,
}

/// What a program made of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// It ended.
    Ended {
        /// Its exit status was 0.
        accepted: bool,
        /// The rules that it named, without their version.
        named: Vec<String>,
    },
    /// It was ended by a signal.
    Crashed,
    /// It did not end.
    Hung,
}

/// The rules of faults that every reader must refuse: it would otherwise give out numbers that mean something else. What
/// else is not valid a reader may refuse or not, by what it looks at.
const REFUSED_BY_READERS: [&str; 5] =
    ["structure.hdf5", "structure.version-stated", "structure.major-version", "digest.object", "digest.document"];

/// True for a fault that leaves the file valid, so that a reader must take it.
fn is_valid(rule: &Rule) -> bool {
    rule.severity != Severity::Error
}

fn name(rule: &Rule) -> &'static str {
    rule.id.rsplit(':').next().unwrap_or(rule.id)
}

/// The columns of a kind of program after `rule` and `severity`.
fn columns(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Validator => &["faults", "found", "wrong rule", "not found", "crashed or hung"],
        Kind::Reader => &["faults", "expected", "refused", "read", "crashed or hung", "not as expected"],
    }
}

/// Which column of the counts (after `faults`) an answer belongs to.
fn column(kind: Kind, fault: &Fault, answer: &Answer) -> usize {
    match (kind, answer) {
        (Kind::Validator, Answer::Ended { named, .. }) if named.iter().any(|name| name == fault.rule) => 0,
        (Kind::Validator, Answer::Ended { accepted, named }) => usize::from(named.is_empty() && *accepted) + 1,
        (Kind::Validator, _) => 3,
        (Kind::Reader, Answer::Ended { accepted, .. }) => usize::from(*accepted),
        (Kind::Reader, _) => 2,
    }
}

fn expected(rule: &Rule) -> &'static str {
    match rule {
        rule if REFUSED_BY_READERS.contains(&name(rule)) => "refuse",
        rule if is_valid(rule) => "read",
        _ => "either",
    }
}

/// The table of all rules that have faults, with a row of sums, and a line for each answer that is not as expected.
pub fn table(kind: Kind, answers: &BTreeMap<String, Answer>) -> String {
    let mut text = format!("| rule | severity | {} |\n", columns(kind).join(" | "));
    text += &format!("|---|---|{}\n", "---|".repeat(columns(kind).len()));
    let mut wrong = Vec::new();
    let mut sums = [0; 6];
    for rule in RULES {
        let faults: Vec<&Fault> = FAULTS.iter().filter(|fault| fault.rule == name(rule)).collect();
        let mut counts = [0; 6];
        for fault in &faults {
            let answer = &answers[&fault.file_name()];
            let column = column(kind, fault, answer);
            let right = match (kind, expected(rule)) {
                (Kind::Validator, _) => column == 0,
                (Kind::Reader, "refuse") => column == 0,
                (Kind::Reader, "read") => column == 1,
                (Kind::Reader, _) => column < 2,
            };
            counts[column] += 1;
            if !right {
                counts[4] += 1;
                wrong.push(format!("- {}: {answer:?}", fault.file_name()));
            }
        }
        if !faults.is_empty() {
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
            sums[5] += faults.len();
            row(&mut text, kind, (name(rule), rule.severity.name(), expected(rule)), faults.len(), counts);
        }
    }
    row(&mut text, kind, ("all", "", ""), sums[5], sums);
    text + "\n" + &wrong.join("\n") + if wrong.is_empty() { "" } else { "\n" }
}

fn row(
    text: &mut String,
    kind: Kind,
    (name, severity, expected): (&str, &str, &str),
    faults: usize,
    counts: [usize; 6],
) {
    let [a, b, c, d, wrong, _] = counts;
    let _ = match kind {
        Kind::Validator => writeln!(text, "| `{name}` | {severity} | {faults} | {a} | {b} | {c} | {d} |"),
        Kind::Reader => writeln!(text, "| `{name}` | {severity} | {faults} | {expected} | {a} | {b} | {c} | {wrong} |"),
    };
}

/// What was expected of an encoding and what became of it.
#[derive(Debug, Clone)]
pub struct Encoding {
    /// Name of the encoding.
    pub name: String,
    /// The rule that names it, if one does.
    pub rule: Option<String>,
    /// True where the document is the same.
    pub same: bool,
    /// True where the program gave the digest of the clean file.
    pub read_right: bool,
    /// What the program made of it.
    pub answer: Answer,
}

/// The table of the encodings.
pub fn encodings(kind: Kind, encodings: &[Encoding]) -> String {
    let mut text = "| encoding | document | rule | digest read | rule named |\n|---|---|---|---|---|\n".to_owned();
    for Encoding { name, rule, same, read_right, answer } in encodings {
        let document = if *same { "the same" } else { "another" };
        let digest = match (answer, read_right) {
            (_, true) => "that of the clean file",
            (Answer::Ended { accepted: true, .. }, false) => "another",
            (Answer::Ended { .. }, false) => "none: refused",
            (Answer::Crashed, _) => "crashed",
            (Answer::Hung, _) => "hung",
        };
        let named = match (kind, rule, answer) {
            (Kind::Validator, Some(rule), Answer::Ended { named, .. }) => {
                ["no", "yes"][usize::from(named.contains(rule))]
            }
            _ => "",
        };
        let rule = rule.as_ref().map_or(String::new(), |rule| format!("`{rule}`"));
        let _ = writeln!(text, "| {name} | {document} | {rule} | {digest} | {named} |");
    }
    let same = encodings.iter().filter(|encoding| encoding.same);
    let right = same.clone().filter(|encoding| encoding.read_right).count();
    text + &format!("\nOf {} encodings of the same document {right} are read with its digest.\n", same.count())
}

/// Puts text between the lines `<!-- NAME -->` and `<!-- /NAME -->` of a page.
///
/// # Errors
/// A sentence where the page has no such lines.
pub fn into_section(page: &str, section: &str, text: &str) -> Result<String, String> {
    let (before, after) = around(page, section)?;
    Ok(format!("{before}{text}{after}"))
}

/// The text between those lines.
///
/// # Errors
/// As [`into_section`].
pub fn section<'a>(page: &'a str, section: &str) -> Result<&'a str, String> {
    let (before, after) = around(page, section)?;
    Ok(&page[before.len()..page.len() - after.len()])
}

fn around<'a>(page: &'a str, section: &str) -> Result<(&'a str, &'a str), String> {
    let (begin, end) = (format!("<!-- {section} -->\n"), format!("<!-- /{section} -->"));
    let from = page.find(&begin).map(|at| at + begin.len());
    match (from, page.find(&end)) {
        (Some(from), Some(to)) if from <= to => Ok((&page[..from], &page[to..])),
        _ => Err(format!("the page has no lines `{}` and `{end}`", begin.trim_end())),
    }
}
