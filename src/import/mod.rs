//! Other people's formats, one file each: texts of the PR-650, PR-655 and PR-670, SpectraWin exports, texts of columns,
//! spectra in SPDX and CGATS.17, bispectral colours in iccMAX XML, the table CSV, Universal BRDF JSON, Donaldson matrices of the BFC-450, texts of matrices, and scans described by a manifest, a name pattern or a scan order. Every import writes a receipt:
//! what was read, what was assumed, what could not be filled, what is worth a look.
//!
//! *May use:* `dataset`, `quantity`. Not `container`: an import makes a document, and who asked for it writes it.
//!
//! *Invariant:* nothing is assumed in silence, nothing is dropped in silence, and no value is changed. What the
//! instrument refused is a row of missing values with the reason; what the source does not say is `unstated`; what can
//! be read in two ways is an error that says which option decides.
//!
//! Whatever bytes come in, a parser ends in time and memory proportional to them (files are limited to
//! [`MAX_FILE_BYTES`]) and answers with a document or an error with its place.
//!
//! ```no_run
//! use bbrf::import::{Options, import};
//!
//! let document = import(&["scan/manifest.csv".into()], &Options::default())?;
//! for notice in &document.provenance.receipts[0].notices {
//!     println!("{}: {}", notice.place, notice.text);
//! }
//! # Ok::<(), bbrf::import::ImportError>(())
//! ```

mod angles;
mod bfc;
mod bispectral;
mod certificate;
mod cgats;
mod columns;
mod details;
mod dialect;
mod error;
mod factor;
mod floor;
mod floor_scale;
mod gather;
mod geometry_csv;
mod icc_xml;
mod keys;
mod manifest;
mod manifest_form;
mod manifest_toml;
mod matrix;
mod mean;
mod names;
mod noise;
mod number;
mod particulars;
mod parts;
mod pattern;
mod plan;
mod pr650;
mod pr650_line;
mod quality;
mod raw;
mod receipt;
mod record;
mod reference;
mod repeats;
mod rows;
mod scan;
mod scan_order;
mod source;
mod spdx;
mod spectra;
mod spectrawin;
pub mod table_csv;
mod text;
mod times;
mod unique;
pub mod universal_brdf;
mod xml;

use std::path::{Path, PathBuf};

pub use angles::Angles;
pub use dialect::Dialect;
pub use error::{Fault, ImportError};
pub use geometry_csv::{GeometryRow, read_geometries};
pub use keys::{KEYS, MatrixRows, Settings};
pub use manifest_form::scan_manifest;
pub use source::MAX_FILE_BYTES;

use crate::dataset::{Document, Measurement, Place, Role};
use crate::quantity::{Geometry, named};
use error::fault;
use receipt::Notes;
use source::Source;

named! {
    /// A format that is read.
    Format, "format" {
        /// Raw texts of the PR-650 (D5), PR-655 and PR-670 (M5).
        Pr650 = "pr650",
        /// SpectraWin exports, full or spectral-only.
        SpectraWin = "spectrawin",
        /// Texts of columns.
        Columns = "columns",
        /// Table CSV.
        TableCsv = "table",
        /// Scan manifest in CSV.
        Manifest = "manifest",
        /// Scan manifest in TOML.
        ManifestToml = "manifest-toml",
        /// Universal BRDF JSON.
        UniversalBrdf = "universal-brdf",
        /// Labsphere BFC-450 matrix files.
        Bfc = "bfc",
        /// Texts of matrices over excitation and emission.
        Matrix = "matrix",
        /// iccMAX profiles as XML, with bispectral colours.
        IccXml = "icc-xml",
        /// Spectra in the XML of IES TM-27.
        Spdx = "spdx",
        /// Texts of CGATS.17 with spectra.
        Cgats = "cgats",
    }
}

impl Format {
    /// True for files that hold spectra and nothing about a scan.
    fn is_spectra(self) -> bool {
        matches!(self, Self::Pr650 | Self::SpectraWin | Self::Columns | Self::Spdx | Self::Cgats)
    }
}

/// How to import. The default decides by content and states nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Force a format instead of finding it by content.
    pub format: Option<Format>,
    /// Force the dialect of texts of columns.
    pub dialect: Option<Dialect>,
    /// What the caller states; it goes before what a table or manifest states.
    pub settings: Settings,
    /// The role of spectra without a manifest.
    pub role: Option<Role>,
    /// Their geometry.
    pub geometry: Option<Geometry>,
    /// File names that say the geometry, as `ti{theta_i}_tv{theta_v}.txt`.
    pub pattern: Option<String>,
    /// The order of a scan, as `theta_i=-80:80:10; theta_v=-80:80:10; skip=retro`.
    pub scan_order: Option<String>,
    /// Files or wildcards of the white reference.
    pub white: Vec<String>,
    /// Files or wildcards of dark signals.
    pub dark: Vec<String>,
    /// Files or wildcards of the light source.
    pub lamp: Vec<String>,
    /// The sample's records are repeats of one look.
    pub repeats: bool,
    /// Take records that the instrument calls uncalibrated.
    pub allow_uncalibrated: bool,
    /// Take texts of columns that cover a part of the PR-650's grid.
    pub allow_partial_grid: bool,
}

/// Reads the inputs and makes one document of them, with one receipt.
///
/// The inputs are one manifest, one table, or any number of files of spectra (and folders of them, with a pattern or a
/// scan order).
///
/// # Errors
/// [`ImportError`] with file and line or byte, what was found, what was expected and what to do.
pub fn import(inputs: &[PathBuf], options: &Options) -> Result<Document, ImportError> {
    let mut notes = Notes::default();
    let mut document = match inputs {
        [] => {
            return Err(ImportError::Call(fault(Place::file("the call"), "no input", "at least one file", "name it")));
        }
        [one] if !one.is_dir() => import_one(one, options, &mut notes)?,
        several => {
            refuse_rows(&options.settings)?;
            refuse_descriptions(several, options)?;
            scan::assemble(gather::plan(several, None, options, &mut notes)?, options, &mut notes)?
        }
    };
    let mut receipt = notes.finish();
    let is_described = receipt.inputs.first().is_some_and(|input| input.dialect.starts_with("manifest"));
    names::make_relative(&mut receipt, inputs, is_described);
    document.provenance.receipts.push(receipt);
    document.measurements.iter_mut().for_each(Measurement::state_directions);
    document.check()?;
    Ok(document)
}

fn import_one(path: &Path, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    let source = Source::read(path, &path.display().to_string())?;
    let format = options.format.unwrap_or_else(|| spectra::sniff(&source));
    if format != Format::Matrix {
        refuse_rows(&options.settings)?;
    }
    match format {
        Format::TableCsv => {
            refuse_file_options(options, "a table", false)?;
            table_csv::document(&source, options, notes)
        }
        Format::UniversalBrdf => {
            refuse_file_options(options, "a Universal BRDF file", false)?;
            universal_brdf::document(&source, options, notes)
        }
        Format::Bfc => {
            refuse_file_options(options, "a matrix", true)?;
            bfc::document(&source, options, notes)
        }
        Format::IccXml => {
            refuse_file_options(options, "a matrix", true)?;
            icc_xml::document(&source, options, notes)
        }
        Format::Matrix => {
            refuse_file_options(options, "a matrix", true)?;
            matrix::document(&source, options, notes)
        }
        Format::Manifest | Format::ManifestToml => {
            refuse_file_options(options, "a manifest", false)?;
            scan::assemble(manifest::plan(&source, path, options, notes)?, options, notes)
        }
        _ => scan::assemble(gather::plan(&[path.to_path_buf()], Some(&source), options, notes)?, options, notes),
    }
}

/// A manifest says which files have which role: naming some in the call as well would be two truths. So do a table and a
/// file of points; a matrix has `one_geometry` for all its values, which the call may say.
fn refuse_file_options(options: &Options, what: &str, one_geometry: bool) -> Result<(), ImportError> {
    let given = [
        ("--pattern", options.pattern.is_some()),
        ("--scan-order", options.scan_order.is_some()),
        ("--white", !options.white.is_empty()),
        ("--dark", !options.dark.is_empty()),
        ("--lamp", !options.lamp.is_empty()),
        ("--role", options.role.is_some()),
        ("--geometry", options.geometry.is_some() && !one_geometry),
        ("--repeats", options.repeats),
    ];
    let Some((option, _)) = given.into_iter().find(|(_, given)| *given) else { return Ok(()) };
    Err(ImportError::Call(fault(
        Place::file("the call"),
        format!("{option} with {what}"),
        "roles and geometries in one place",
        "say it in the file",
    )))
}

/// Which wavelengths stand down the first column is a question of matrices alone; elsewhere the answer would be dropped.
fn refuse_rows(settings: &Settings) -> Result<(), ImportError> {
    if settings.rows.is_none() {
        return Ok(());
    }
    Err(ImportError::Call(fault(
        settings.place_of("rows", Place::file("the call")),
        "the key `rows` without a matrix",
        "a text with wavelengths along its first row and first column",
        "leave it out, or force `--format matrix`",
    )))
}

/// A manifest or a table is an import of its own.
fn refuse_descriptions(inputs: &[PathBuf], options: &Options) -> Result<(), ImportError> {
    if options.format.is_some_and(Format::is_spectra) {
        return Ok(());
    }
    for path in inputs.iter().filter(|path| path.is_file()) {
        let source = Source::read(path, &path.display().to_string())?;
        let format = options.format.unwrap_or_else(|| spectra::sniff(&source));
        if !format.is_spectra() {
            return Err(ImportError::Call(fault(
                source.at_line(1),
                format!("a {format} beside other inputs"),
                "one manifest, one table, or files of spectra",
                "import it on its own",
            )));
        }
    }
    Ok(())
}
