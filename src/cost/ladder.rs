//! What a ladder says: words for its reference, its error and its time, and a rung for each setting.

use schemars::JsonSchema;
use serde::Serialize;

use super::Timing;
use crate::quantity::named;

named! {
    /// What is done.
    Task, "task" {
        /// Terms are fitted to a scan.
        Fit = "fit",
        /// Radiance and colour under lights.
        Eval = "eval",
        /// A scene is rendered.
        Image = "image",
        /// A file is written and read.
        Storage = "storage",
    }
}

/// What the numbers of a ladder are, in words.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Meaning {
    /// What errors are measured against.
    pub reference: String,
    /// What `error` is.
    pub error: String,
    /// The same in a few words, for the axis of a figure.
    pub axis: String,
    /// What `second_error` is, where there is one.
    pub second_error: Option<String>,
    /// What takes `time`.
    pub time: String,
    /// What takes `read_time`, where there is one.
    pub read_time: Option<String>,
}

/// One setting.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Rung {
    /// Its name, short.
    pub name: String,
    /// What is turned from rung to rung.
    pub knob: String,
    /// What the command is told.
    pub options: Vec<String>,
    /// Error against the reference; `null` where the two cannot be compared.
    pub error: Option<f64>,
    /// Another error, where there is one.
    pub second_error: Option<f64>,
    /// What it takes.
    pub time: Timing,
    /// What it takes to read, where that is another matter.
    pub read_time: Option<Timing>,
    /// Bytes of the result, where they count.
    pub bytes: Option<u64>,
    /// True where no other rung is as good in every respect and better in one.
    pub is_best: bool,
    /// What to know about it.
    pub note: Option<String>,
}

impl Rung {
    /// Median seconds of all that it takes.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.time.median + self.read_time.map_or(0.0, |time| time.median)
    }
}

/// Settings of one task with their errors and times.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Ladder {
    /// What is done.
    pub task: Task,
    /// What it is done to.
    pub subject: String,
    /// The machine, as far as it says so.
    pub machine: String,
    /// The command that the options of a rung are given to, word by word.
    pub command: Vec<String>,
    /// What the numbers are.
    pub meaning: Meaning,
    /// The settings.
    pub rungs: Vec<Rung>,
}

impl Ladder {
    /// The command line that runs a rung, ready for a shell.
    #[must_use]
    pub fn command_line(&self, rung: &Rung) -> String {
        let words = self.command.iter().chain(&rung.options);
        words.map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// The number that a choice among rungs of the same error makes small: bytes of a file, seconds of all else.
    #[must_use]
    pub fn price(&self, rung: &Rung) -> f64 {
        match (self.task, rung.bytes) {
            (Task::Storage, Some(bytes)) => bytes as f64,
            _ => rung.seconds(),
        }
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@#%".contains(c);
    // A shell takes what follows # for a comment only where a word begins with it.
    if !word.is_empty() && !word.starts_with('#') && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_word_reaches_the_command_as_it_is() {
        assert_eq!(quoted("a.bbrf#scan"), "a.bbrf#scan");
        assert_eq!(quoted("my scan's.bbrf"), "'my scan'\\''s.bbrf'");
        assert_eq!([quoted(""), quoted("theta-i>80")], ["''", "'theta-i>80'"]);
    }
}
