//! `bbrf report`: one HTML page about a file, and its figures as PNG and SVG.

use std::path::{Path, PathBuf};

use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::open;
use crate::cli::output::{print_json, print_message, print_text, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::report::{Figure, Pictures, page};

/// Draw a file: one HTML page, and its figures as PNG and SVG.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// Write the page here [default: the file's name with .html, unless --figures is given]
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Write each figure into this folder, as PNG and SVG, drawn without the system's fonts
    #[arg(long, value_name = "DIR")]
    figures: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ReportResult {
    /// The page, if one was written.
    page: Option<String>,
    /// Every figure file.
    figures: Vec<String>,
    /// What could not be drawn, one sentence each.
    not_drawn: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let page_path = page_path(arguments);
    if let Some(path) = &page_path {
        refuse_overwriting(path, [arguments.file.clone()])?;
    }
    let document = open(&arguments.file)?.document;
    let pictures = Pictures::of(&document);
    let mut result = ReportResult { page: None, figures: Vec::new(), not_drawn: not_drawn(&pictures) };
    if let Some(folder) = &arguments.figures {
        result.figures = write_figures(folder, &arguments.file, &pictures)?;
    }
    if let Some(path) = page_path {
        write_output(&path, page(&document, &pictures).as_bytes())?;
        result.page = Some(path.display().to_string());
    }
    print_result(arguments, &result)?;
    Ok(Outcome::Done)
}

/// Where the page goes; nowhere where only figures are asked for.
fn page_path(arguments: &Arguments) -> Option<PathBuf> {
    let default = || arguments.figures.is_none().then(|| arguments.file.with_extension("html"));
    arguments.output.clone().or_else(default)
}

fn not_drawn(pictures: &Pictures) -> Vec<String> {
    pictures.all().flat_map(|drawn| drawn.not_drawn.clone()).collect()
}

fn write_figures(folder: &Path, input: &Path, pictures: &Pictures) -> Result<Vec<String>, miette::Report> {
    std::fs::create_dir_all(folder).map_err(|error| miette!("{}: cannot be made: {error}", folder.display()))?;
    let mut written = Vec::new();
    for figure in pictures.figures() {
        for (extension, bytes) in forms(figure)? {
            let path = folder.join(format!("{}.{extension}", figure.name()));
            refuse_overwriting(&path, [input.to_owned()])?;
            write_output(&path, &bytes)?;
            written.push(path.display().to_string());
        }
    }
    Ok(written)
}

fn forms(figure: &Figure) -> Result<[(&'static str, Vec<u8>); 2], miette::Report> {
    let png = figure.to_png().map_err(|error| miette!("{error}"))?;
    let svg = figure.to_svg_outlined().map_err(|error| miette!("{error}"))?;
    Ok([("png", png), ("svg", svg.into_bytes())])
}

fn print_result(arguments: &Arguments, result: &ReportResult) -> Result<(), miette::Report> {
    if arguments.json {
        return print_json("bbrf:report:1", result);
    }
    for path in result.page.iter().chain(&result.figures) {
        print_text(path)?;
    }
    for reason in &result.not_drawn {
        print_message(&format!("not drawn: {reason}"));
    }
    Ok(())
}
