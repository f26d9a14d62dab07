//! `bbrf import`: other people's files to one file of the standard.

use std::path::{Path, PathBuf};

use clap::Args;
use miette::miette;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::exit::{CommandResult, Outcome};
use super::super::output;
use super::super::overwrite::refuse_overwriting;
use crate::container;
use crate::dataset::{Document, Place, Receipt, Role};
use crate::import::{Angles, Dialect, Format, Options, Settings, import};
use crate::quantity::{Geometry, Part, QuantityKind, Reference, ReferenceLight};

/// Import spectra, scans and tables into one .bbrf file
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A manifest (CSV or TOML), a table CSV, a Universal BRDF, a matrix (BFC, text, iccMAX XML), files of spectra, or a folder with --pattern or --scan-order
    #[arg(required = true, value_name = "INPUT")]
    inputs: Vec<PathBuf>,
    /// The file to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Print the receipt as JSON
    #[arg(long)]
    json: bool,
    /// Print every assumption and everything that is not stated
    #[arg(long, short, conflicts_with = "json")]
    verbose: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    scan: Scan,
    #[command(flatten)]
    statements: Statements,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "How the files are read")]
struct Reading {
    /// Force the format: pr650, spectrawin, columns, table, manifest, manifest-toml, universal-brdf, bfc, matrix,
    /// icc-xml, spdx, cgats
    #[arg(long)]
    format: Option<Format>,
    /// Force the dialect of texts of columns, as semicolon-decimal-comma
    #[arg(long)]
    dialect: Option<Dialect>,
    /// Take records that the instrument calls uncalibrated (unit code 2)
    #[arg(long)]
    allow_uncalibrated: bool,
    /// Take texts that cover a part of the PR-650's grid
    #[arg(long)]
    allow_partial_grid: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Scans and roles")]
struct Scan {
    /// Role of spectra without a manifest: sample, white, dark, lamp
    #[arg(long)]
    role: Option<Role>,
    /// Geometry of spectra without a manifest: theta_i,phi_i,theta_v,phi_v in degrees
    #[arg(long, value_parser = geometry, allow_hyphen_values = true)]
    geometry: Option<Geometry>,
    /// Convention of angles: full; signed,mirror-at-equal; signed,retro-at-equal
    #[arg(long)]
    angles: Option<Angles>,
    /// File names that say the geometry, as ti{theta_i}_tv{theta_v}.txt
    #[arg(long)]
    pattern: Option<String>,
    /// Order of the files, as "theta_i=-80:80:10; theta_v=-80:80:10; skip=retro; serpentine"
    #[arg(long)]
    scan_order: Option<String>,
    /// White reference: a file or a wildcard; may come again
    #[arg(long, value_name = "FILE")]
    white: Vec<String>,
    /// Dark signal: a file or a wildcard; may come again
    #[arg(long, value_name = "FILE")]
    dark: Vec<String>,
    /// Light source: a file or a wildcard; may come again
    #[arg(long, value_name = "FILE")]
    lamp: Vec<String>,
    /// The sample's spectra are repeats of one look: average them
    #[arg(long)]
    repeats: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "What the files do not say")]
struct Statements {
    /// What the numbers are, as spectral-radiance
    #[arg(long)]
    quantity: Option<QuantityKind>,
    /// Which part: elastic, luminescent, total
    #[arg(long)]
    part: Option<Part>,
    /// Geometry of the reference: same-geometry, fixed-geometry(theta_i,theta_v), none
    #[arg(long, value_parser = reference)]
    reference: Option<Reference>,
    /// Light of the reference: same, or the name of a light
    #[arg(long, value_parser = reference_light)]
    reference_light: Option<ReferenceLight>,
    /// Certified radiance factor of the reference: a number or a two-column file
    #[arg(long, value_name = "NUMBER|FILE")]
    certified_factor: Option<String>,
    /// Any key of a table CSV or manifest, as title="Sample A"; may come again
    #[arg(long = "set", value_name = "KEY=VALUE")]
    keys: Vec<String>,
}

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ImportResult<'a> {
    /// The file written.
    file: String,
    /// What it holds.
    measurements: Vec<Summary<'a>>,
    /// Ids of its lights.
    lights: Vec<&'a str>,
    /// What was read, assumed and not found.
    receipts: &'a [Receipt],
}

/// One measurement in a line.
#[derive(Debug, Serialize, JsonSchema)]
struct Summary<'a> {
    id: &'a str,
    quantity: QuantityKind,
    role: Role,
    rows: usize,
    /// Emission values per row.
    wavelengths: usize,
}

/// Imports, writes the file, prints the receipt.
pub(crate) fn run(arguments: &Arguments) -> CommandResult {
    let options = options(arguments)?;
    refuse_overwriting(&arguments.output, arguments.inputs.iter().cloned())?;
    let document = import(&arguments.inputs, &options).map_err(|error| miette!("{error}"))?;
    refuse_overwriting(&arguments.output, files_read(&document, &arguments.inputs))?;
    save(&document, &arguments.output)?;
    if arguments.json {
        output::print_json("bbrf:import:1", &report(&document, &arguments.output))?;
    } else {
        output::print_text(&text(&document, &arguments.output, arguments.verbose))?;
    }
    Ok(Outcome::Done)
}

/// The paths that the receipts' names may stand for: from here, or from a folder above an input.
fn files_read<'a>(document: &'a Document, inputs: &'a [PathBuf]) -> impl Iterator<Item = PathBuf> {
    let names = document.provenance.receipts.iter().flat_map(|receipt| &receipt.inputs).map(|input| &input.name);
    let absolute = inputs.iter().filter_map(|input| input.canonicalize().ok());
    let folders: Vec<PathBuf> =
        absolute.flat_map(|path| path.ancestors().map(Path::to_path_buf).collect::<Vec<_>>()).collect();
    names.flat_map(move |name| {
        let above: Vec<PathBuf> = folders.iter().map(|folder| folder.join(name)).collect();
        std::iter::once(PathBuf::from(name)).chain(above)
    })
}

fn save(document: &Document, path: &Path) -> Result<(), miette::Report> {
    container::write_file(document, path).map_err(|error| output::not_written(&error))?;
    Ok(())
}

fn options(arguments: &Arguments) -> Result<Options, miette::Report> {
    let (reading, scan, said) = (&arguments.reading, &arguments.scan, &arguments.statements);
    let mut settings = Settings {
        quantity: said.quantity,
        part: said.part,
        reference: said.reference,
        reference_light: said.reference_light.clone(),
        certified_factor: said.certified_factor.clone(),
        angles: scan.angles,
        ..Settings::default()
    };
    for pair in &said.keys {
        let (key, value) = pair.split_once('=').ok_or_else(|| miette!("--set {pair}: expected KEY=VALUE"))?;
        settings.state(key, value).map_err(|error| miette!("{error}"))?;
    }
    Ok(Options {
        format: reading.format,
        dialect: reading.dialect,
        settings,
        role: scan.role,
        geometry: scan.geometry,
        pattern: scan.pattern.clone(),
        scan_order: scan.scan_order.clone(),
        white: scan.white.clone(),
        dark: scan.dark.clone(),
        lamp: scan.lamp.clone(),
        repeats: scan.repeats,
        allow_uncalibrated: reading.allow_uncalibrated,
        allow_partial_grid: reading.allow_partial_grid,
    })
}

fn reference(text: &str) -> Result<Reference, String> {
    text.parse().map_err(|error: crate::quantity::UnknownName| error.to_string())
}

fn reference_light(text: &str) -> Result<ReferenceLight, String> {
    text.parse().map_err(|error: crate::quantity::UnknownName| error.to_string())
}

pub(super) fn geometry(text: &str) -> Result<Geometry, String> {
    let angles: Vec<f64> = text.split(',').map_while(|angle| angle.trim().parse().ok()).collect();
    let &[theta_i, phi_i, theta_v, phi_v] = angles.as_slice() else {
        return Err("expected four angles in degrees: theta_i,phi_i,theta_v,phi_v".to_owned());
    };
    if theta_i > 90.0 || theta_v > 90.0 {
        return Err("a measured direction lies above the surface: theta from 0 to 90 degrees".to_owned());
    }
    Geometry::from_degrees(theta_i, phi_i, theta_v, phi_v).map_err(|error| error.to_string())
}

fn summaries(document: &Document) -> Vec<Summary<'_>> {
    document
        .measurements
        .iter()
        .map(|measurement| Summary {
            id: measurement.id.as_str(),
            quantity: measurement.quantity.kind,
            role: measurement.role,
            rows: measurement.acquisitions.len(),
            wavelengths: measurement.emission.len(),
        })
        .collect()
}

fn report<'a>(document: &'a Document, path: &Path) -> ImportResult<'a> {
    ImportResult {
        file: path.display().to_string(),
        measurements: summaries(document),
        lights: document.lights.iter().map(|light| light.id.as_str()).collect(),
        receipts: &document.provenance.receipts,
    }
}

fn text(document: &Document, path: &Path, verbose: bool) -> String {
    let mut lines = vec![format!("wrote {}", path.display())];
    for summary in summaries(document) {
        let Summary { id, quantity, role, rows, wavelengths } = summary;
        lines.push(format!("  {id}: {quantity} of the {role}, {rows} rows x {wavelengths}"));
    }
    lines.extend(document.lights.iter().map(|light| format!("  light {}", light.id)));
    for receipt in &document.provenance.receipts {
        let records: u64 = receipt.inputs.iter().map(|input| input.records).sum();
        let plural = |count: u64, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        lines.push(format!("read {}, {}", plural(receipt.inputs.len() as u64, "file"), plural(records, "record")));
        lines.extend(assumptions(receipt, verbose));
        lines.extend(notices(receipt));
        lines.extend(unfilled(receipt, verbose));
    }
    lines.join("\n")
}

/// The first words of so many assumptions are shown.
const SHOWN: usize = 3;
/// So many characters of each.
const FIRST_WORDS: usize = 60;

/// What was assumed: in one line, or every sentence.
fn assumptions(receipt: &Receipt, verbose: bool) -> Vec<String> {
    let texts = receipt.assumptions.iter().map(|assumption| assumption.text.as_str());
    if verbose || receipt.assumptions.len() < 2 {
        return texts.map(|text| format!("assumed: {text}")).collect();
    }
    let shown: Vec<String> = texts.clone().take(SHOWN).map(first_words).collect();
    let more = if texts.len() > SHOWN { "; ..." } else { "" };
    vec![format!(
        "assumed: {} things: {}{more} (all with --verbose, and in `/provenance/receipts` of the file)",
        texts.len(),
        shown.join("; ")
    )]
}

/// The first clause, or as many whole words of it as there is room for.
fn first_words(text: &str) -> String {
    let clause = text.split([';', ':']).next().unwrap_or(text).trim();
    let Some((room, _)) = clause.char_indices().nth(FIRST_WORDS) else { return clause.to_owned() };
    let end = clause[..room].rfind(' ').unwrap_or(room);
    format!("{} ...", clause[..end].trim_end())
}

/// What the source does not say: how many fields, or all of them.
fn unfilled(receipt: &Receipt, verbose: bool) -> Option<String> {
    let paths = &receipt.unfilled;
    match paths.len() {
        0 => None,
        1 => Some(format!("not stated: {}", paths[0])),
        _ if verbose => Some(format!("not stated: {}", paths.join(", "))),
        count => {
            let names: Vec<&str> =
                paths.iter().take(SHOWN).map(|path| path.rsplit('/').next().unwrap_or(path)).collect();
            let more = if count > SHOWN { ", ..." } else { "" };
            let names = names.join(", ");
            Some(format!(
                "not stated: {count} fields: {names}{more} (all with --verbose, and in `/provenance/receipts` of the file)"
            ))
        }
    }
}

/// One line per kind of notice: what applies in many places is said once, with the first of them.
fn notices(receipt: &Receipt) -> Vec<String> {
    let mut kinds: Vec<(&str, Vec<&Place>)> = Vec::new();
    for notice in &receipt.notices {
        match kinds.iter_mut().find(|(text, _)| *text == notice.text) {
            Some((_, places)) => places.push(&notice.place),
            None => kinds.push((&notice.text, vec![&notice.place])),
        }
    }
    kinds
        .into_iter()
        .map(|(text, places)| match places.as_slice() {
            [first, _, ..] => format!("note: {text} ({} places, the first {first}; all with --json)", places.len()),
            [one] if **one != Place::default() => format!("note: {one}: {text}"),
            _ => format!("note: {text}"),
        })
        .collect()
}
