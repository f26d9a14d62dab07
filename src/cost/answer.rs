//! Which rung to take.

use schemars::JsonSchema;
use serde::Serialize;

use super::ladder::{Ladder, Rung, Task};

/// What is asked of a rung; nothing where both are `None`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Wish {
    /// The error may be so large.
    pub max_error: Option<f64>,
    /// All that it takes may take so many seconds, in the median.
    pub budget: Option<f64>,
}

/// The rung to take, or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Answer {
    /// Its place among the rungs, from 0; `null` where none does.
    pub rung: Option<usize>,
    /// The command line that runs it.
    pub command: Option<String>,
    /// The answer in a sentence.
    pub sentence: String,
}

impl Ladder {
    /// The rung that a wish takes: with a largest error the cheapest that keeps it (the smallest, of files); with a budget alone the
    /// most accurate within it, and of those the cheapest. `None` where nothing is wished.
    #[must_use]
    pub fn answer(&self, wish: Wish) -> Option<Answer> {
        if wish == Wish::default() {
            return None;
        }
        let error = |rung: &Rung| rung.error.unwrap_or(f64::INFINITY);
        let fits = |rung: &Rung| {
            rung.error.is_some()
                && wish.max_error.is_none_or(|most| error(rung) <= most)
                && wish.budget.is_none_or(|most| rung.seconds() <= most)
        };
        let order = |a: &Rung, b: &Rung| {
            let price = self.price(a).total_cmp(&self.price(b)).then(a.seconds().total_cmp(&b.seconds()));
            match wish.max_error {
                Some(_) => price,
                None => error(a).total_cmp(&error(b)).then(price),
            }
        };
        let fitting = self.rungs.iter().enumerate().filter(|(_, rung)| fits(rung));
        let found = fitting.min_by(|a, b| order(a.1, b.1));
        Some(match found {
            Some((place, rung)) => {
                let command = self.command_line(rung);
                let why = match (wish.max_error, self.task) {
                    (None, _) => "the most accurate within the time",
                    (_, Task::Storage) => "the smallest file within the error",
                    _ => "the quickest within the error",
                };
                let sentence = format!("take `{}`, {why}: {}", rung.name, self.figures(rung));
                Answer { rung: Some(place), command: Some(command), sentence }
            }
            None => Answer { rung: None, command: None, sentence: self.why_none(wish) },
        })
    }

    fn figures(&self, rung: &Rung) -> String {
        let error = rung.error.map_or("no error known".to_owned(), |error| format!("error {error:.2e}"));
        let bytes = rung.bytes.map_or(String::new(), |bytes| format!(", {bytes} bytes"));
        let what = if rung.read_time.is_some() { " to write and to read" } else { "" };
        format!("{error}, {:.3e} s{what}{bytes}", rung.seconds())
    }

    /// What stands in the way, with the nearest rung on either side.
    fn why_none(&self, wish: Wish) -> String {
        let known = || self.rungs.iter().filter(|rung| rung.error.is_some());
        let error = |rung: &&Rung| rung.error.unwrap_or(f64::INFINITY);
        let least = known().min_by(|a, b| error(a).total_cmp(&error(b)));
        let quickest = known().min_by(|a, b| a.seconds().total_cmp(&b.seconds()));
        let (Some(least), Some(quickest)) = (least, quickest) else {
            return "no rung has an error that can be compared with the reference".to_owned();
        };
        let asked = match (wish.max_error, wish.budget) {
            (Some(error), Some(budget)) => format!("an error of {error:e} or less within {budget} s"),
            (Some(error), None) => format!("an error of {error:e} or less"),
            (None, budget) => format!("{} s or less", budget.unwrap_or(f64::INFINITY)),
        };
        let what = if self.task == Task::Storage { "to write and to read" } else { "in time" };
        format!(
            "no rung has {asked} {what}; the most accurate is `{}` ({}), the quickest `{}` ({})",
            least.name,
            self.figures(least),
            quickest.name,
            self.figures(quickest)
        )
    }
}
