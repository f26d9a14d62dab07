//! A page in Markdown as it is written, and how its numbers are spelled.

use std::error::Error;
use std::path::Path;

use crate::matrix::Covered;
use crate::picture::{find, halve};

/// Where lines of text end.
const COLUMNS: usize = 130;

/// A page that is being written.
#[derive(Debug)]
pub(crate) struct Sheet<'a> {
    text: String,
    /// Where results are.
    pub(crate) folder: &'a Path,
    images: &'a Path,
}

impl<'a> Sheet<'a> {
    pub(crate) fn new(introduction: &str, folder: &'a Path, images: &'a Path) -> Self {
        Self { text: introduction.to_owned(), folder, images }
    }

    pub(crate) fn finish(self) -> String {
        self.text
    }

    pub(crate) fn heading(&mut self, title: &str) {
        self.text.push_str(&format!("\n## {title}\n\n"));
    }

    /// A line as it is: a row of a table, a figure.
    pub(crate) fn row(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Text, in lines of readable length.
    pub(crate) fn say(&mut self, text: &str) {
        for line in text.split('\n') {
            let mut length = 0;
            for word in line.split(' ') {
                let next = word.chars().count();
                if length > 0 && length + 1 + next > COLUMNS {
                    self.text.push('\n');
                    length = 0;
                } else if length > 0 {
                    self.text.push(' ');
                    length += 1;
                }
                self.text.push_str(word);
                length += next;
            }
            self.text.push('\n');
        }
    }

    /// Takes the figure of a folder whose file name ends so, and shows it under a name.
    pub(crate) fn show(&mut self, from: &str, ending: &str, name: &str, words: &str) -> Result<(), Box<dyn Error>> {
        let image = self.image(from, ending, name, words)?;
        self.row(&image);
        Ok(())
    }

    /// The two averages of a scan, side by side.
    pub(crate) fn averages(
        &mut self,
        group: &str,
        name: &str,
        prefix: &str,
        title: &str,
    ) -> Result<(), Box<dyn Error>> {
        let figures = format!("{group}/{name}/figures");
        let average = |over: &str| {
            let words = format!("{title}: averaged over {over}");
            self.image(&figures, &format!("mean-over-{over}.png"), &format!("{prefix}-{name}-over-{over}"), &words)
        };
        let (viewing, incidence) = (average("viewing")?, average("incidence")?);
        self.row(&format!(
            "| {title}: averaged over viewing | averaged over incidence |\n|---|---|\n| {viewing} | {incidence} |\n"
        ));
        Ok(())
    }

    fn image(&self, from: &str, ending: &str, name: &str, words: &str) -> Result<String, Box<dyn Error>> {
        halve(&find(&self.folder.join(from), ending)?, &self.images.join(format!("{name}.png")))?;
        Ok(format!("![{words}](images/paper/{name}.png)"))
    }
}

pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

pub(crate) fn covered(covered: &Covered) -> String {
    format!("{} of {}", covered.held, covered.of)
}

pub(crate) fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

pub(crate) fn range(values: impl Iterator<Item = f64>) -> String {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    format!("{low:.2} to {high:.2}")
}

/// A value to the second digit of its uncertainty.
pub(crate) fn with_uncertainty(value: f64, uncertainty: f64) -> String {
    let digits = (1.0 - uncertainty.log10().floor()).clamp(0.0, 8.0) as usize;
    format!("{value:.digits$} ± {uncertainty:.digits$}")
}
