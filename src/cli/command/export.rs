//! `bbrf export`: a file in another format.

use std::ops::Range;
use std::path::PathBuf;

use miette::{IntoDiagnostic, miette};

use super::import::geometry;
use crate::cli::exit::{CommandResult, Outcome};
use crate::cli::opened::{open, say_later};
use crate::cli::output::{print_bytes, print_message, write_output};
use crate::cli::overwrite::refuse_overwriting;
use crate::container::{self, Part};
use crate::dataset::{Document, Measurement};
use crate::export::{bfc, json, matrix, table_csv, universal_brdf};
use crate::quantity::{Geometry, QuantityKind};

/// Write a file in another format.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The .bbrf file
    file: PathBuf,
    /// The format
    #[arg(long, value_enum)]
    to: Format,
    /// The measurement, by id [default: the only one, or the only factor that is no part of a matrix; a matrix: the only Donaldson matrix]
    #[arg(long, value_name = "ID")]
    measurement: Option<String>,
    /// Only the rows of this geometry: theta_i,phi_i,theta_v,phi_v in degrees; the rest of the file is not read
    #[arg(long, value_parser = geometry, allow_hyphen_values = true, requires = "measurement")]
    geometry: Option<Geometry>,
    /// Only these rows, from 0, the last one left out: 10..20; the rest of the file is not read
    #[arg(long, value_name = "FROM..TO", value_parser = rows, requires = "measurement", conflicts_with = "geometry")]
    rows: Option<Range<usize>>,
    /// Write here instead of to stdout
    #[arg(short, long)]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// One measurement as a table
    Csv,
    /// The whole document
    Json,
    /// One measurement as Universal BRDF JSON
    UniversalBrdf,
    /// One measurement over excitation and emission as a text of a matrix
    Matrix,
    /// One Donaldson matrix as a file of the Labsphere BFC-450
    Bfc,
}

impl Format {
    /// What is written, in a message.
    fn noun(self) -> &'static str {
        if self == Self::Csv { "table" } else { "file" }
    }
}

pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    if let Some(output) = &arguments.output {
        refuse_overwriting(output, [arguments.file.clone()])?;
    }
    let (document, unknown) = match chosen_rows(arguments)? {
        Some(part) => (part, Vec::new()),
        None => {
            let opened = open(&arguments.file)?;
            (opened.document, opened.unknown)
        }
    };
    let mut bytes = Vec::new();
    let lost = match arguments.to {
        Format::Csv => {
            let measurement = chosen(&document, arguments.measurement.as_deref())?;
            table_csv::write(&document, measurement, &mut bytes).into_diagnostic()?
        }
        Format::UniversalBrdf => {
            let measurement = chosen(&document, arguments.measurement.as_deref())?;
            universal_brdf::write(&document, measurement, &mut bytes).map_err(|error| miette!("{error}"))?
        }
        Format::Matrix => {
            let measurement = chosen_matrix(&document, arguments.measurement.as_deref())?;
            matrix::write(&document, measurement, &mut bytes).map_err(|error| miette!("{error}"))?
        }
        Format::Bfc => {
            let measurement = chosen_matrix(&document, arguments.measurement.as_deref())?;
            bfc::write(&document, measurement, &mut bytes).map_err(|error| miette!("{error}"))?
        }
        Format::Json => {
            let digest = container::digest(&document).map_err(|error| miette!("{error}"))?;
            json::write(&document, digest.as_str(), &mut bytes).into_diagnostic()?;
            unknown.into_iter().map(|path| format!("{path}, which the standard does not know")).collect()
        }
    };
    for what in lost {
        print_message(&format!("bbrf: not in the {}: {what}", arguments.to.noun()));
    }
    match &arguments.output {
        Some(path) => write_output(path, &bytes)?,
        None => print_bytes(&bytes)?,
    }
    Ok(Outcome::Done)
}

/// A document of nothing but the rows that are asked for; `None` where all are.
fn chosen_rows(arguments: &Arguments) -> Result<Option<Document>, miette::Report> {
    let Some(id) = arguments.measurement.as_deref() else { return Ok(None) };
    let part = match (arguments.geometry, &arguments.rows) {
        (Some(geometry), _) => container::read_part(&arguments.file, id, |_, row| row.geometry == Some(geometry)),
        (None, Some(rows)) => container::read_part(&arguments.file, id, |row, _| rows.contains(&row)),
        (None, None) => return Ok(None),
    };
    let Part { measurement, later_version, bytes_read, file_bytes } = part.map_err(|error| miette!("{error}"))?;
    if let Some(version) = &later_version {
        say_later(&arguments.file, version);
    }
    if measurement.acquisitions.is_empty() {
        return Err(miette!(help = "see `bbrf info`", "measurement `{id}` has no such row"));
    }
    print_message(&format!(
        "bbrf: {bytes_read} of {file_bytes} bytes read: the digests, which are of the whole file, were not checked; \
         `bbrf validate` checks them"
    ));
    Ok(Some(Document { measurements: vec![measurement], ..Document::default() }))
}

fn rows(text: &str) -> Result<Range<usize>, String> {
    let ends = text.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    ends.filter(|range: &Range<usize>| !range.is_empty()).ok_or_else(|| {
        format!("`{text}` is no range of rows; expected the first row and the one after the last, as in 10..20")
    })
}

/// The measurement by id, the only Donaldson matrix, or the only measurement.
fn chosen_matrix<'a>(document: &'a Document, id: Option<&str>) -> Result<&'a Measurement, miette::Report> {
    let is_matrix = |measurement: &&Measurement| measurement.quantity.kind == QuantityKind::DonaldsonMatrix;
    let mut matrices = document.measurements.iter().filter(is_matrix);
    match (id, matrices.next(), matrices.next()) {
        (None, Some(only), None) => Ok(only),
        _ => chosen(document, id),
    }
}

pub(super) fn chosen<'a>(document: &'a Document, id: Option<&str>) -> Result<&'a Measurement, miette::Report> {
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    let listed = ids.join(", ");
    if let Some(id) = id {
        return document
            .measurement(id)
            .ok_or_else(|| miette!("there is no measurement `{id}`; expected one of: {listed}"));
    }
    let factors = document.measurements.iter().filter(|one| one.quantity.kind.is_factor());
    // What a separation stores beside a matrix is a part of the complete model, and not what a file is about.
    let attachments = || document.models.iter().filter_map(|model| model.donaldson.as_ref());
    let whole = factors.clone().filter(|one| attachments().all(|attached| attached.elastic != one.id));
    match (
        document.measurements.as_slice(),
        factors.collect::<Vec<_>>().as_slice(),
        whole.collect::<Vec<_>>().as_slice(),
    ) {
        ([only], ..) => Ok(only),
        (_, [only], _) | (_, _, [only]) => Ok(only),
        ([], ..) => Err(miette!("the file holds no measurement")),
        _ => Err(miette!(help = "name one with --measurement", "the file holds several measurements: {listed}")),
    }
}
