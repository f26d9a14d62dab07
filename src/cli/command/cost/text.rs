//! A ladder as a table.

use crate::cost::{Answer, Ladder, Rung, Timing};

pub(super) fn text(ladder: &Ladder, answer: Option<&Answer>) -> String {
    let meaning = &ladder.meaning;
    let mut lines = vec![format!("{}: {}, on {}", ladder.task, ladder.subject, ladder.machine)];
    lines.push(format!("  reference: {}", meaning.reference));
    lines.push(format!("  error: {}", meaning.error));
    lines.extend(meaning.second_error.iter().map(|words| format!("  second: {words}")));
    lines.push(format!("  time: {}", meaning.time));
    lines.extend(meaning.read_time.iter().map(|words| format!("  read: {words}")));
    let header = columns(ladder).map(|(title, _)| title.to_owned());
    let rows: Vec<Vec<String>> =
        ladder.rungs.iter().map(|rung| columns(ladder).map(|(_, of)| of(rung)).collect()).collect();
    lines.extend(aligned(header.collect(), rows));
    lines.push(
        "  * no other rung is as good in every respect and better in one; times: median (quartiles), ? not settled"
            .to_owned(),
    );
    if let Some(answer) = answer {
        lines.push(answer.sentence.clone());
        lines.extend(answer.command.iter().map(|command| format!("  {command}")));
    }
    lines.join("\n")
}

type Column = (&'static str, fn(&Rung) -> String);

/// The columns that the ladder has numbers for.
fn columns(ladder: &Ladder) -> impl Iterator<Item = Column> {
    let all: [(bool, Column); 7] = [
        (true, ("", |rung| if rung.is_best { "*" } else { "" }.to_owned())),
        (true, ("rung", |rung| rung.name.clone())),
        (true, ("error", |rung| number(rung.error))),
        (ladder.meaning.second_error.is_some(), ("second", |rung| number(rung.second_error))),
        (true, ("time", |rung| time(&rung.time))),
        (ladder.meaning.read_time.is_some(), ("read", |rung| rung.read_time.as_ref().map_or(String::new(), time))),
        (
            ladder.rungs.iter().any(|rung| rung.bytes.is_some()),
            ("bytes", |rung| rung.bytes.map_or(String::new(), |bytes| bytes.to_string())),
        ),
    ];
    let note: (bool, Column) =
        (ladder.rungs.iter().any(|rung| rung.note.is_some()), ("note", |rung| rung.note.clone().unwrap_or_default()));
    all.into_iter().chain([note]).filter(|(is_there, _)| *is_there).map(|(_, column)| column)
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(value) => format!("{value:.2e}"),
    }
}

fn time(timing: &Timing) -> String {
    let (unit, scale) = match timing.median {
        seconds if seconds < 1e-3 => ("us", 1e6),
        seconds if seconds < 1.0 => ("ms", 1e3),
        _ => ("s", 1.0),
    };
    let digits = |seconds: f64| format!("{:.3}", seconds * scale);
    let unsettled = if timing.settled { "" } else { " ?" };
    format!(
        "{} {unit} ({}..{}){unsettled}",
        digits(timing.median),
        digits(timing.first_quartile),
        digits(timing.third_quartile)
    )
}

/// Lines with their columns beneath each other.
fn aligned(header: Vec<String>, rows: Vec<Vec<String>>) -> Vec<String> {
    let width = |column: usize| rows.iter().chain([&header]).map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
    };
    [&header].into_iter().chain(&rows).map(line).collect()
}
