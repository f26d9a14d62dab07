//! Scan manifests: which record of which file is which look.
//!
//! CSV: `# key: value` lines as in a table CSV, then
//! `file,record,role,theta_i_deg,theta_v_deg` (or the four angles) and optionally
//! `excitation_nm` (also `lambda_i_nm`), `light`, `repeat`, `time`, `exposure_ms`. TOML: the same keys at the top, and
//! one `[[record]]` per row. Paths are relative to the manifest. `record` counts from 1 and may be left out where a
//! file holds one; `role` is `sample` where it is left out.
//!
//! Signed angles need a declared convention, which is checked against the empty diagonal. Files that are listed and
//! missing are an error that names all of them; files of the same kind in the same folders that are not listed are a
//! notice.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use super::error::{ImportError, fault, quoted};
use super::keys::Settings;
use super::plan::{Entry, Plan};
use super::receipt::{Notes, listed};
use super::record::Record;
use super::rows::{Row, Rows};
use super::source::Source;
use super::{Format, Options, spectra};
use crate::dataset::{Place, Role};

const COLUMNS: &[&str] = &[
    "file",
    "record",
    "role",
    "theta_i_deg",
    "phi_i_deg",
    "theta_v_deg",
    "phi_v_deg",
    "excitation_nm",
    "light",
    "repeat",
    "time",
    "exposure_ms",
];

/// Reads a manifest and all the files that it lists.
///
/// # Errors
/// [`ImportError`] with the line for what the manifest says wrongly, for missing files, and of the files' parsers.
pub(super) fn plan(source: &Source, path: &Path, options: &Options, notes: &mut Notes) -> Result<Plan, ImportError> {
    let mut stated = Settings::default();
    let toml = options.format.unwrap_or_else(|| spectra::sniff(source)) == Format::ManifestToml;
    let mut rows = if toml {
        super::manifest_toml::rows(source, &mut stated, COLUMNS)?
    } else {
        Rows::from_csv(source, &mut stated, COLUMNS)?
    };
    if !rows.has("file") {
        return Err(ImportError::Malformed(fault(
            source.at_line(rows.header),
            "no column `file`",
            format!("columns of: {}", COLUMNS.join(", ")),
            "name the files",
        )));
    }
    let mut input = source.input.clone();
    input.dialect = match (toml, rows.semicolons) {
        (true, _) => "manifest-toml",
        (false, false) => "manifest-csv",
        (false, true) => "manifest-csv, semicolons, decimal comma",
    }
    .to_owned();
    notes.input(input);
    note_overridden(source, &options.settings, &stated, notes);
    let settings = options.settings.clone().or(&stated);
    super::refuse_rows(&settings)?;
    if settings.coverage_factor.is_some() {
        return Err(ImportError::Call(fault(
            settings.place_of("coverage-factor", source.at_line(1)),
            "the key `coverage-factor`",
            "a manifest without it: uncertainties come from the spread of readings",
            "take the line out; it belongs to a table with a column `sigma`",
        )));
    }
    let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
    // Paths from another system: tried only where the name as spelled is no file.
    rows.rewrite("file", |name| {
        let slashes = name.contains('\\') && !name.contains('\0') && !folder.join(name).is_file();
        slashes.then(|| name.replace('\\', "/"))
    });
    check_files(source, path, &folder, &rows, notes)?;
    let options = Options { settings: settings.clone(), format: None, ..options.clone() };
    let mut reader = Files { folder, options, records: BTreeMap::new() };
    let mut plan = Plan::new(settings, true, source.at_line(1));
    for row in rows.iter() {
        let entry = entry(&row, &mut plan, &mut reader, notes)?;
        plan.entries.push(entry);
    }
    Ok(plan)
}

/// What the call states goes before what the file states: says so where the two differ.
pub(super) fn note_overridden(source: &Source, call: &Settings, file: &Settings, notes: &mut Notes) {
    for (key, in_call, in_file) in call.contradicts(file) {
        let key = key.replace('_', "-");
        let text = format!("`{key}` is {in_call}, as the call states, and not {in_file}, as the file states");
        notes.assume(Place::file(source.name.as_str()), text);
    }
}

/// The files of a manifest, each read once.
struct Files {
    folder: PathBuf,
    options: Options,
    records: BTreeMap<String, Vec<Record>>,
}

impl Files {
    fn records(&mut self, name: &str, notes: &mut Notes) -> Result<&[Record], ImportError> {
        if !self.records.contains_key(name) {
            let path = beside(&self.folder, name);
            let source = Source::read(&path, &path.display().to_string())?;
            let records = spectra::read(&source, &self.options, notes)?;
            self.records.insert(name.to_owned(), records);
        }
        Ok(self.records.get(name).map_or(&[], Vec::as_slice))
    }
}

/// A file that a manifest names, as the user can open it from where the command runs.
pub(super) fn beside(folder: &Path, name: &str) -> PathBuf {
    folder.join(name).components().filter(|part| *part != Component::CurDir).collect()
}

fn entry(row: &Row<'_>, plan: &mut Plan, files: &mut Files, notes: &mut Notes) -> Result<Entry, ImportError> {
    let name = row.text("file").ok_or_else(|| row.bad("file", "", "the name of a file"))?;
    let role = match row.text("role") {
        None => Role::Sample,
        Some(text) => {
            text.parse().map_err(|error: crate::quantity::UnknownName| row.bad("role", text, &error.expected))?
        }
    };
    let records = files.records(name, notes)?;
    let record = pick(row, name, records)?.clone();
    let written = row.angles()?;
    let mut entry = Entry::new(record, role);
    entry.place = row.place();
    entry.geometry = written.map(|angles| angles.geometry(plan.settings.angles, &entry.place)).transpose()?;
    entry.light = row.text("light").map(str::to_owned).or_else(|| plan.settings.light.clone());
    let nm = row.positive("excitation_nm")?;
    entry.excitation = plan.excitations.find(nm, row.text("light"));
    entry.repeat = row.whole("repeat")?;
    entry.exposure_ms = row.positive("exposure_ms")?;
    entry.time = row.time(plan.settings.time_zone.as_deref())?;
    if role == Role::Sample && entry.geometry.is_none() {
        notes.notice(entry.place.clone(), format!("{name}: a sample row without angles; its geometry is unknown"));
    }
    Ok(entry)
}

fn pick<'a>(row: &Row<'_>, name: &str, records: &'a [Record]) -> Result<&'a Record, ImportError> {
    let number = row.whole("record")?;
    match number {
        None if records.len() > 1 => Err(ImportError::Ambiguous(fault(
            row.place(),
            format!("no record number for {} with {} records", quoted(name), records.len()),
            "the number of one record, from 1: a file with several records needs it",
            "the manifest must name the record in a column `record`",
        ))),
        number => {
            let index = number.unwrap_or(1);
            let found = index.checked_sub(1).and_then(|index| records.get(index as usize));
            found.ok_or_else(|| row.bad("record", &index.to_string(), &format!("1 to {} for {name}", records.len())))
        }
    }
}

/// Lists what is missing and what is there without being listed.
fn check_files(
    source: &Source,
    manifest: &Path,
    folder: &Path,
    rows: &Rows,
    notes: &mut Notes,
) -> Result<(), ImportError> {
    let mut names: BTreeMap<&str, u64> = BTreeMap::new();
    for row in rows.iter() {
        if let Some(name) = row.text("file") {
            if name.contains('\0') {
                return Err(row.bad("file", name, "a file name"));
            }
            names.entry(name).or_insert(row.line);
        }
    }
    let missing: Vec<String> = names
        .iter()
        .filter(|(name, _)| !folder.join(name).is_file())
        .map(|(name, line)| format!("{} (line {line})", beside(folder, name).display()))
        .collect();
    let unlisted = unlisted(manifest, folder, &names);
    if !missing.is_empty() {
        let manifest = source.name.clone();
        let unlisted = unlisted.iter().map(|name| beside(folder, name).display().to_string()).collect();
        return Err(ImportError::MissingFiles { manifest, listed: names.len(), missing, unlisted });
    }
    if !unlisted.is_empty() {
        let text = format!(
            "{} files of the same kind lie beside the listed ones and are not listed: {}",
            unlisted.len(),
            listed(&unlisted)
        );
        notes.notice(Place::file(source.name.as_str()), text);
    }
    Ok(())
}

/// Files with the extension of a listed one in its folder, in natural order.
fn unlisted(manifest: &Path, folder: &Path, names: &BTreeMap<&str, u64>) -> Vec<String> {
    let listed: BTreeSet<PathBuf> = names.keys().map(|name| folder.join(name)).collect();
    let kinds: BTreeSet<(PathBuf, Option<std::ffi::OsString>)> = listed
        .iter()
        .filter_map(|path| Some((path.parent()?.to_path_buf(), path.extension().map(std::ffi::OsStr::to_os_string))))
        .collect();
    let mut found = Vec::new();
    for (parent, extension) in kinds {
        let inside = if parent.as_os_str().is_empty() { Path::new(".") } else { parent.as_path() };
        let Ok(entries) = std::fs::read_dir(inside) else { continue };
        for entry in entries.flatten() {
            let path = parent.join(entry.file_name());
            let same_kind = path.extension().map(std::ffi::OsStr::to_os_string) == extension;
            if same_kind && path != manifest && path.is_file() && !listed.contains(&path) {
                let name = path.strip_prefix(folder).unwrap_or(&path);
                found.push(name.display().to_string());
            }
        }
    }
    alphanumeric_sort::sort_str_slice(&mut found);
    found
}
