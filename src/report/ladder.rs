//! A ladder as a figure: error over time, both logarithmic; of files their size over time.

use super::trade::draw;
use super::{CurveText, Figure, Knob, ReportError, Setting};
use crate::cost::{Ladder, Rung, Task};

/// Draws a ladder, one colour for what is turned; `*` marks the rungs that no other beats.
///
/// # Errors
/// [`ReportError::Empty`] where no rung has a time and an error.
pub fn ladder_figure(ladder: &Ladder) -> Result<Figure, ReportError> {
    let is_file = ladder.task == Task::Storage;
    let height = |rung: &Rung| match rung.bytes {
        Some(bytes) if is_file => Some(bytes as f64),
        _ => rung.error,
    };
    // A logarithmic scale has no 0: what has no error stands a decade below the smallest that there is.
    let least = ladder.rungs.iter().filter_map(height).filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
    let floor = if least.is_finite() { least / 10.0 } else { 1e-16 };
    let mut knobs: Vec<Knob> = Vec::new();
    for rung in &ladder.rungs {
        let Some(result) = height(rung).map(|value| value.max(floor)) else { continue };
        let mark = if rung.is_best { "* " } else { "" };
        let setting = Setting { cost: rung.seconds(), result, bound: result, label: format!("{mark}{}", rung.name) };
        match knobs.iter_mut().find(|knob| knob.name == rung.knob) {
            Some(knob) => knob.settings.push(setting),
            None => knobs.push(Knob { name: rung.knob.clone(), settings: vec![setting] }),
        }
    }
    let has_zero = !is_file && ladder.rungs.iter().any(|rung| rung.error == Some(0.0));
    let zero = if has_zero { format!(" Drawn at {floor:.0e}: an error of 0.") } else { String::new() };
    let text = CurveText {
        name: format!("cost-{}", ladder.task),
        title: format!("What accuracy costs: {} of {}", ladder.task, ladder.subject),
        subtitle: format!(
            "{}; medians. * no other rung is as good in every respect and better in one.{zero}",
            ladder.machine
        ),
        x: if is_file { "time to write and to read (s)" } else { "time (s)" }.to_owned(),
        y: if is_file { "bytes".to_owned() } else { ladder.meaning.axis.clone() },
        caption: format!(
            "Error: {}. Reference: {}. Time: {}.",
            ladder.meaning.error, ladder.meaning.reference, ladder.meaning.time
        ),
    };
    draw(&knobs, None, &text)
}
