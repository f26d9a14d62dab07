//! From the inputs of a call to a plan: a list of spectra, a folder with a name pattern, or a scan order; and the
//! files that the call gives another role.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::angles::{Angles, Written};
use super::error::{ImportError, fault, quoted};
use super::pattern::{Named, Pattern};
use super::plan::{Entry, Plan};
use super::receipt::{Notes, listed};
use super::record::Record;
use super::scan_order;
use super::source::Source;
use super::{Format, Options, scan, spectra};
use crate::dataset::{Place, Role};
use crate::quantity::Geometry;

/// A plan from files and folders of spectra. `known` is the only input where it was read already: a pipe gives its
/// text once.
///
/// # Errors
/// [`ImportError`] of the parsers, and where names, order and files do not fit together.
pub(super) fn plan(
    inputs: &[PathBuf],
    known: Option<&Source>,
    options: &Options,
    notes: &mut Notes,
) -> Result<Plan, ImportError> {
    let others = others(options)?;
    let taken: BTreeSet<&PathBuf> = others.iter().map(|(_, path)| path).collect();
    let files: Vec<PathBuf> = files(inputs, options)?.into_iter().filter(|path| !taken.contains(path)).collect();
    let place = inputs.first().map_or_else(Place::default, |input| Place::file(input.display().to_string()));
    let declared = options.pattern.is_some() || options.scan_order.is_some();
    let mut plan = Plan::new(options.settings.clone(), declared, place);
    match (&options.pattern, &options.scan_order) {
        (Some(_), Some(_)) => return Err(call("--pattern with --scan-order", "one of them", "leave one out")),
        (Some(pattern), None) => by_pattern(&mut plan, &Pattern::new(pattern)?, &files, options, notes)?,
        (None, Some(order)) => by_order(&mut plan, order, &files, options, notes)?,
        (None, None) => as_list(&mut plan, &files, known, options, notes)?,
    }
    for (role, path) in &others {
        for record in read(path, options, notes)? {
            push(&mut plan, record, *role, None, None);
        }
    }
    if !declared {
        scan::note_plain_list(&plan, notes);
    }
    Ok(plan)
}

/// The files that the call gives a role of their own, by name or by wildcard.
fn others(options: &Options) -> Result<Vec<(Role, PathBuf)>, ImportError> {
    let mut found = Vec::new();
    for (role, names) in [(Role::White, &options.white), (Role::Dark, &options.dark), (Role::Lamp, &options.lamp)] {
        for name in names {
            if Path::new(name).is_file() {
                found.push((role, PathBuf::from(name)));
                continue;
            }
            let wildcard = glob::glob(name).map_err(|error| {
                call(&format!("{} ({error})", quoted(name)), "a file or a wildcard", "correct the name")
            })?;
            let mut paths: Vec<PathBuf> = wildcard.flatten().filter(|path| path.is_file()).collect();
            if paths.is_empty() {
                let advice = format!("correct `--{role}`");
                return Err(call(&format!("no file for {}", quoted(name)), "a file or a wildcard", &advice));
            }
            natural_sort(&mut paths);
            found.extend(paths.into_iter().map(|path| (role, path)));
        }
    }
    Ok(found)
}

fn natural_sort(paths: &mut [PathBuf]) {
    paths.sort_by(|a, b| alphanumeric_sort::compare_str(a.to_string_lossy(), b.to_string_lossy()));
}

/// All files of the inputs. A folder gives its files in natural order; files given one by one keep the given order
/// unless they are to be put in a scan order.
fn files(inputs: &[PathBuf], options: &Options) -> Result<Vec<PathBuf>, ImportError> {
    let mut files = Vec::new();
    for input in inputs {
        if !input.is_dir() {
            files.push(input.clone());
            continue;
        }
        if options.pattern.is_none() && options.scan_order.is_none() {
            return Err(ImportError::Ambiguous(fault(
                Place::file(input.display().to_string()),
                "a folder",
                "a manifest, or a folder with `--pattern` or `--scan-order`",
                advice_for_folder(input),
            )));
        }
        let name = input.display().to_string();
        let unreadable = |source| ImportError::Unreadable { file: name.clone(), source };
        let mut inside: Vec<PathBuf> = Vec::new();
        for entry in std::fs::read_dir(input).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?;
            let hidden = entry.file_name().to_string_lossy().starts_with('.');
            if entry.path().is_file() && !hidden {
                inside.push(entry.path());
            }
        }
        natural_sort(&mut inside);
        files.extend(inside);
    }
    if options.scan_order.is_some() {
        natural_sort(&mut files);
    }
    Ok(files)
}

/// A folder with one manifest in it is most likely meant by that.
fn advice_for_folder(folder: &Path) -> String {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let tables = entries.filter(|path| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        path.is_file() && matches!(extension.as_deref(), Some("csv" | "toml"))
    });
    let is_manifest = |path: &PathBuf| {
        let source = Source::read(path, &path.display().to_string());
        source.is_ok_and(|source| matches!(spectra::sniff(&source), Format::Manifest | Format::ManifestToml))
    };
    let manifests: Vec<PathBuf> = tables.filter(is_manifest).take(2).collect();
    match manifests.as_slice() {
        [one] => format!("import the manifest in it: {}", one.display()),
        _ => "say how its files are named or ordered, or name the files".to_owned(),
    }
}

fn read(path: &Path, options: &Options, notes: &mut Notes) -> Result<Vec<Record>, ImportError> {
    let source = Source::read(path, &path.display().to_string())?;
    spectra::read(&source, options, notes)
}

fn push(plan: &mut Plan, record: Record, role: Role, geometry: Option<Geometry>, repeat: Option<u32>) {
    let mut entry = Entry::new(record, role);
    entry.geometry = geometry;
    entry.repeat = repeat;
    entry.light.clone_from(&plan.settings.light);
    entry.excitation = if role == Role::Lamp { None } else { plan.excitations.find(None, None) };
    plan.entries.push(entry);
}

fn as_list(
    plan: &mut Plan,
    files: &[PathBuf],
    known: Option<&Source>,
    options: &Options,
    notes: &mut Notes,
) -> Result<(), ImportError> {
    for path in files {
        let records = match known {
            Some(source) => spectra::read(source, options, notes)?,
            None => read(path, options, notes)?,
        };
        for record in records {
            let role = options.role.or(record.role).unwrap_or(Role::Sample);
            push(plan, record, role, options.geometry, None);
        }
    }
    Ok(())
}

fn by_pattern(
    plan: &mut Plan,
    pattern: &Pattern,
    files: &[PathBuf],
    options: &Options,
    notes: &mut Notes,
) -> Result<(), ImportError> {
    let mut fitting: Vec<(Named, &PathBuf)> = Vec::new();
    let mut unlisted = Vec::new();
    for path in files {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        match pattern.read(&name) {
            Some(named) => fitting.push((named, path)),
            None => unlisted.push(name),
        }
    }
    if fitting.is_empty() {
        let found = format!("{} files of which none fits: {}", unlisted.len(), listed(&unlisted));
        return Err(call(&found, "file names as in `--pattern`", "correct the pattern"));
    }
    if !unlisted.is_empty() {
        let text = format!("{} files do not fit the pattern and are not read: {}", unlisted.len(), listed(&unlisted));
        notes.notice(plan.place.clone(), text);
    }
    for (named, path) in fitting {
        let records = read(path, options, notes)?;
        let place = Place::file(path.display().to_string());
        let [record] = <[Record; 1]>::try_from(records).map_err(|records| several(&place, records.len()))?;
        let geometry = named.angles.map(|angles| angles.geometry(plan.settings.angles, &place)).transpose()?;
        push(plan, record, named.role.unwrap_or(Role::Sample), geometry, named.repeat);
    }
    Ok(())
}

fn several(place: &Place, count: usize) -> ImportError {
    ImportError::Ambiguous(fault(
        place.clone(),
        format!("{count} records in a file whose name gives one geometry"),
        "one record per file",
        "write a manifest that names the record, or split the file",
    ))
}

fn by_order(
    plan: &mut Plan,
    order: &str,
    files: &[PathBuf],
    options: &Options,
    notes: &mut Notes,
) -> Result<(), ImportError> {
    let Some(Angles::Signed(habit)) = plan.settings.angles else {
        let place = Place::file("--scan-order");
        return Written::Signed(0.0, 0.0).geometry(None, &place).map(|_| ());
    };
    let looks = scan_order::looks(order, habit)?;
    let mut records = Vec::new();
    let (mut others, mut first_error) = (Vec::new(), None);
    for path in files {
        match read(path, options, notes) {
            Ok(found) => records.extend(found),
            Err(error @ (ImportError::Malformed(_) | ImportError::Ambiguous(_))) => {
                others.push(path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()));
                first_error.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    // Notes beside the spectra are left out where the spectra are complete without them.
    if let Some(error) = first_error {
        if records.len() != looks.len() {
            return Err(error);
        }
        let text = format!("no spectra and left out: {}", listed(&others));
        notes.notice(plan.place.clone(), text);
    }
    if records.len() != looks.len() {
        return Err(ImportError::Contradiction(fault(
            plan.place.clone(),
            format!("{} records in {} files for a scan order of {} looks", records.len(), files.len(), looks.len()),
            format!("exactly {} records", looks.len()),
            "look for missing or additional files, or correct `--scan-order`; white, dark and lamp files are named apart",
        )));
    }
    let text = "the scan order is assigned to the files in the natural order of their names";
    notes.assume(plan.place.clone(), text);
    for (look, record) in looks.iter().zip(records) {
        let geometry = look.angles.geometry(plan.settings.angles, &record.place())?;
        push(plan, record, Role::Sample, Some(geometry), look.repeat);
    }
    Ok(())
}

fn call(found: &str, expected: &str, advice: &str) -> ImportError {
    ImportError::Call(fault(Place::file("the call"), found, expected, advice))
}
