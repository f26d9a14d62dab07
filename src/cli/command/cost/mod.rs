//! `bbrf cost`: what accuracy costs in time, measured on the user's own file.

mod eval;
mod fit;
mod image;
mod storage;
mod text;

use std::path::{Path, PathBuf};

use clap::Subcommand;
use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::output::{print_json, print_message, print_text, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::cost::{Answer, Ladder, Patience, Wish};
use crate::report::ladder_figure;

const EXAMPLES: &str = "\
Examples:
  bbrf cost fit scan.bbrf
  bbrf cost fit scan.bbrf --reduce none --max-error 0.1
  bbrf cost eval postit.bbrf --light D65 --light FL11 --budget 0.5 -o eval.svg
  bbrf cost eval whole.bbrf --model scan-auto --geometry g.csv --max-error 0.01
  bbrf cost image room.toml --max-error 1
  bbrf cost storage scan.bbrf --max-error 0 --json";

/// Measure what accuracy costs in time, and take a setting
///
/// A ladder has a rung for each setting that another command can be told: its error against a stated reference, and its time, the
/// median of repeats that take turns, with quartiles. `*` marks the rungs that no other beats in every respect. With `--max-error` or
/// `--budget` the answer is the rung to take with its command line; exit status 1 where none does.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    Fit(Box<fit::Arguments>),
    Eval(Box<eval::Arguments>),
    Image(image::Arguments),
    Storage(storage::Arguments),
}

/// What all ladders are asked.
#[derive(Debug, clap::Args)]
struct Common {
    /// Answer with the cheapest rung whose error is at most this
    #[arg(long, value_name = "ERROR", value_parser = not_negative, allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// Answer with the most accurate rung that takes at most so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = not_negative, allow_negative_numbers = true)]
    budget: Option<f64>,
    /// Seconds that the repeats of a rung may take; fewer where the median is known earlier
    #[arg(long, value_name = "SECONDS", default_value_t = Patience::default().seconds, value_parser = not_negative)]
    patience: f64,
    /// Draw the ladder: FILE.svg or FILE.png
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| x.is_finite() && *x >= 0.0);
    number.ok_or_else(|| "expected a number, 0 or more".to_owned())
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct CostResult {
    #[serde(flatten)]
    ladder: Ladder,
    /// With `--max-error` or `--budget`: the rung to take, or why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    answer: Option<Answer>,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    match &arguments.task {
        Task::Fit(arguments) => fit::run(arguments),
        Task::Eval(arguments) => eval::run(arguments),
        Task::Image(arguments) => image::run(arguments),
        Task::Storage(arguments) => storage::run(arguments),
    }
}

impl Common {
    fn patience(&self) -> Patience {
        Patience { seconds: self.patience, ..Patience::default() }
    }

    /// Before anything is measured: the figure can be written.
    fn check(&self, read: impl IntoIterator<Item = PathBuf>) -> Result<(), miette::Report> {
        let Some(output) = &self.output else { return Ok(()) };
        refuse_overwriting(output, read)?;
        match extension(output).as_str() {
            "svg" | "png" => {}
            other => return Err(miette!("-o: a file name that ends in `{other}`; expected .svg or .png")),
        }
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        tempfile::tempfile_in(folder)
            .map(drop)
            .map_err(|error| miette!("{}: no file can be written there: {error}", output.display()))
    }

    /// Prints and draws a ladder, and answers.
    fn finish(&self, ladder: Ladder) -> CommandResult {
        if let Some(output) = &self.output {
            draw(output, &ladder)?;
            print_message(&format!("bbrf: wrote {}", output.display()));
        }
        let answer = ladder.answer(Wish { max_error: self.max_error, budget: self.budget });
        let outcome = match &answer {
            Some(Answer { rung: None, .. }) => Outcome::Failed,
            _ => Outcome::Done,
        };
        if self.json {
            print_json("bbrf:cost:1", &CostResult { ladder, answer })?;
        } else {
            print_text(&text::text(&ladder, answer.as_ref()))?;
        }
        Ok(outcome)
    }
}

fn extension(path: &Path) -> String {
    path.extension().map_or(String::new(), |extension| extension.to_string_lossy().to_lowercase())
}

fn draw(path: &Path, ladder: &Ladder) -> Result<(), miette::Report> {
    let figure = ladder_figure(ladder).map_err(|error| miette!("{error}"))?;
    let bytes = if extension(path) == "png" {
        figure.to_png().map_err(|error| miette!("{error}"))?
    } else {
        figure.to_svg_outlined().map_err(|error| miette!("{error}"))?.into_bytes()
    };
    write_output(path, &bytes)
}

fn words(list: &[&str]) -> Vec<String> {
    list.iter().map(|word| (*word).to_owned()).collect()
}
