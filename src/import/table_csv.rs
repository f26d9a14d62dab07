//! Table CSV: what a lab without an importer writes, and what `export --to csv` writes.
//!
//! # The format
//!
//! A text in UTF-8 (other encodings are read as well) of three parts:
//!
//! 1. **Keys**, one per line: `# key: value`. In a key, `_` and `-` are the same. An unknown key is an error. The keys:
//!
//!    | key | value |
//!    |---|---|
//!    | `quantity`, `part`, `normalised-at`, `basis`, `reference`, `reference-light` | as the standard spells them |
//!    | `certified-factor`, `certified-relative-uncertainty`, `certificate` | of the reference; the values are already multiplied |
//!    | `angles` | `full`; `signed, mirror-at-equal`; `signed, retro-at-equal` |
//!    | `excitation_nm`, `excitation_fwhm_nm`, `light`, `filter` | for all rows; `excitation_nm` also as a column |
//!    | `bandpass_nm` | full width at half maximum of the instrument, nm |
//!    | `band_nm` | the band of values without a wavelength, as `500-620` |
//!    | `title`, `sample`, `material`, `mark`, `license`, `citation`, `id`, `instrument`, `serial` | text |
//!    | `simulated` | `true` or `false` |
//!    | `coverage-factor` | k of the column `sigma`, which is divided by it; 1 where it is not stated |
//!
//! 2. **A header** with the names of the columns, in any order:
//!
//!    | column | meaning |
//!    |---|---|
//!    | `theta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg` | geometry, degrees; or, under signed angles, `theta_i_deg,theta_v_deg`; empty or absent: unknown |
//!    | `excitation_nm` | optional, nm |
//!    | `emission_nm` | optional, nm; without it every value is one of a band |
//!    | `value` | empty only where `flag` says why |
//!    | `sigma` | optional: standard uncertainty (k = 1, or the key `coverage-factor`); an empty field is unknown |
//!    | `flag` | optional: names joined by `\|` or blanks, as `below-detection\|noisy` |
//!    | `order`, `repeat`, `time`, `exposure_ms` | optional, of the acquisition |
//!
//! 3. **Rows**, in any order. Rows of one geometry, excitation, `order` and `repeat` are one acquisition. A wavelength
//!    that other acquisitions have and one lacks is missing there (NaN, `not-measured`).
//!
//! Acquisitions keep the order of their first row, or that of `order` where it is given. Nothing is assumed: what no
//! key states is `unstated` and listed in the receipt. The measurement is called `scan` unless `id` says otherwise.

use std::collections::BTreeMap;

use ndarray::Array2;

use super::angles::{Angles, check_habit};
use super::details;
use super::error::{ImportError, fault, fault_of, quoted};
use super::keys::Settings;
use super::manifest::note_overridden;
use super::number::value;
use super::parts;
use super::receipt::Notes;
use super::rows::{Row, Rows};
use super::source::Source;
use super::{Options, scan};
use crate::dataset::{Acquisition, Conditions, Document, Id, Measurement, Place, Role};
use crate::quantity::{EmissionAxis, Finite, Flag, Flags, Statement, Uncertainty, WavelengthAxis};

pub(super) const COLUMNS: &[&str] = &[
    "theta_i_deg",
    "phi_i_deg",
    "theta_v_deg",
    "phi_v_deg",
    "excitation_nm",
    "emission_nm",
    "value",
    "sigma",
    "flag",
    "order",
    "repeat",
    "time",
    "exposure_ms",
];

/// One value with its place in the table.
struct Cell {
    acquisition: usize,
    emission_nm: Option<f64>,
    value: f64,
    sigma: f64,
    flags: Flags,
    line: u64,
}

/// What makes rows one acquisition: angles, excitation, order and repeat.
type Key = ([Option<u64>; 4], Option<u64>, Option<u32>, Option<u32>);

/// Reads a table as a document with one measurement.
///
/// # Errors
/// [`ImportError`] with the line for unknown keys and columns, values that are none, and doubled cells.
pub(super) fn document(source: &Source, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    let mut settings = Settings::default();
    let rows = Rows::from_csv(source, &mut settings, COLUMNS)?;
    note_overridden(source, &options.settings, &settings, notes);
    let settings = options.settings.clone().or(&settings);
    super::refuse_rows(&settings)?;
    if !rows.has("value") {
        return Err(ImportError::Malformed(fault(
            source.at_line(rows.header),
            "no column `value`",
            format!("columns of: {}", COLUMNS.join(", ")),
            "name the column of the numbers `value`",
        )));
    }
    let mut table = Table::new(&settings, rows.has("emission_nm"));
    for row in rows.iter() {
        table.row(&row, &settings)?;
    }
    table.put_in_order();
    let mut input = source.input.clone();
    input.dialect = if rows.semicolons { "table-csv, semicolons, decimal comma" } else { "table-csv" }.to_owned();
    input.records = table.acquisitions.len() as u64;
    notes.input(input);
    table.check_angles(source, &settings, notes)?;
    let measurement = table.measurement(source, &settings, rows.has("sigma"))?;
    note_percent(source, &measurement, notes);
    let mut document = finish(measurement, &settings, notes);
    details::fill(&mut document, &settings.details)?;
    Ok(document)
}

/// A fluorescent sheet radiates a few times what the perfect diffuser does, not tens of times.
pub(super) fn note_percent(source: &Source, measurement: &Measurement, notes: &mut Notes) {
    const IMPLAUSIBLE: f64 = 10.0;
    let mut values: Vec<f64> = measurement.values.iter().copied().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    if let Some(middle) = values.get(values.len() / 2).filter(|middle| **middle > IMPLAUSIBLE)
        && measurement.quantity.kind.is_factor()
    {
        let text =
            format!("half of the factors are above {middle}, so many times the perfect diffuser: is it per cent?");
        notes.notice(source.at_line(1), text);
    }
}

fn finish(mut measurement: Measurement, settings: &Settings, notes: &mut Notes) -> Document {
    let mut document = parts::document(settings);
    parts::attach_sample(&mut document, &mut measurement, settings, notes);
    parts::attach_instrument(&mut document, &mut measurement, None, settings, notes);
    parts::attach_lights(&mut document, &measurement, settings);
    parts::list_unfilled(&measurement, notes);
    document.measurements.push(measurement);
    document
}

struct Table {
    excitations: parts::Excitations,
    acquisitions: Vec<Acquisition>,
    stated_order: bool,
    index: BTreeMap<Key, usize>,
    cells: Vec<Cell>,
    has_emission: bool,
}

impl Table {
    fn new(settings: &Settings, has_emission: bool) -> Self {
        Self {
            excitations: parts::Excitations::new(settings),
            acquisitions: Vec::new(),
            stated_order: false,
            index: BTreeMap::new(),
            cells: Vec::new(),
            has_emission,
        }
    }

    fn row(&mut self, row: &Row<'_>, settings: &Settings) -> Result<(), ImportError> {
        let acquisition = self.acquisition(row, settings)?;
        let emission_nm = row.positive("emission_nm")?;
        if self.has_emission && emission_nm.is_none() {
            return Err(row.bad("emission_nm", "", "a wavelength in nm"));
        }
        let flags = flags(row)?;
        let value = match row.text("value") {
            None if flags.explains_absence() => f64::NAN,
            Some(text) if flags.explains_absence() && is_missing(text) => f64::NAN,
            None => return Err(row.bad("value", "", "a number, or a flag that says why there is none")),
            Some(text) => value(text).ok_or_else(|| row.bad("value", text, "a finite number with a decimal point"))?,
        };
        let sigma = row.number("sigma")?.unwrap_or(f64::NAN);
        if sigma < 0.0 {
            return Err(row.bad("sigma", &sigma.to_string(), "a standard uncertainty, not negative"));
        }
        self.cells.push(Cell { acquisition, emission_nm, value, sigma, flags, line: row.line });
        Ok(())
    }

    /// The index of the row's acquisition, made where it is new.
    fn acquisition(&mut self, row: &Row<'_>, settings: &Settings) -> Result<usize, ImportError> {
        let written = row.angles()?;
        let geometry = written.map(|angles| angles.geometry(settings.angles, &row.place())).transpose()?;
        let (order, repeat) = (row.whole("order")?, row.whole("repeat")?);
        let excitation = self.excitations.find(row.positive("excitation_nm")?, None);
        let angles = geometry
            .map(|g| [g.incidence.theta_deg(), g.incidence.phi_deg(), g.viewing.theta_deg(), g.viewing.phi_deg()]);
        let bits = std::array::from_fn(|angle| angles.map(|angles| (angles[angle] + 0.0).to_bits()));
        let key = (bits, excitation.map(u64::from), order, repeat);
        if let Some(known) = self.index.get(&key) {
            return Ok(*known);
        }
        let next = self.acquisitions.len();
        let position = u32::try_from(next).unwrap_or(u32::MAX);
        self.stated_order |= order.is_some();
        let mut acquisition = Acquisition::at(geometry, order.unwrap_or(position));
        acquisition.excitation = excitation;
        acquisition.time = row.time(settings.time_zone.as_deref())?;
        acquisition.exposure_ms = row.positive("exposure_ms")?;
        self.acquisitions.push(acquisition);
        self.index.insert(key, next);
        Ok(next)
    }

    /// Sorts the acquisitions by their stated order; equal orders keep the order of the file.
    fn put_in_order(&mut self) {
        if !self.stated_order {
            return;
        }
        let mut by_order: Vec<usize> = (0..self.acquisitions.len()).collect();
        by_order.sort_by_key(|index| self.acquisitions[*index].order);
        let mut position = vec![0; by_order.len()];
        for (new, old) in by_order.iter().enumerate() {
            position[*old] = new;
        }
        self.acquisitions = by_order.iter().map(|old| self.acquisitions[*old].clone()).collect();
        for cell in &mut self.cells {
            cell.acquisition = position[cell.acquisition];
        }
    }

    fn check_angles(&self, source: &Source, settings: &Settings, notes: &mut Notes) -> Result<(), ImportError> {
        let geometries: Vec<_> = self.acquisitions.iter().filter_map(|acquisition| acquisition.geometry).collect();
        if let Some(Angles::Signed(habit)) = settings.angles {
            check_habit(&geometries, habit, settings.place_of("angles", source.at_line(1)))?;
        }
        scan::note_coverage(&geometries, source.at_line(1), notes);
        Ok(())
    }

    fn emission(&self, source: &Source, settings: &Settings) -> Result<EmissionAxis, ImportError> {
        if !self.has_emission {
            return Ok(EmissionAxis::Band { band: settings.band });
        }
        let mut nm: Vec<f64> = self.cells.iter().filter_map(|cell| cell.emission_nm).collect();
        nm.sort_by(f64::total_cmp);
        nm.dedup();
        let cells = nm.len().saturating_mul(self.acquisitions.len());
        // Every acquisition with wavelengths of its own would fill a square with NaN.
        if cells > 1_000_000 && cells / 64 > self.cells.len() {
            return Err(ImportError::Malformed(fault(
                source.at_line(1),
                format!(
                    "{} rows on {} wavelengths x {} acquisitions",
                    self.cells.len(),
                    nm.len(),
                    self.acquisitions.len()
                ),
                "acquisitions that share their wavelengths",
                "put acquisitions with other wavelengths into a table of their own",
            )));
        }
        let axis = WavelengthAxis::new(nm, parts::bandpass(settings, None));
        axis.map(EmissionAxis::Wavelengths)
            .map_err(|error| ImportError::Malformed(fault_of(source.at_line(1), &error, "correct it")))
    }

    fn measurement(self, source: &Source, settings: &Settings, has_sigma: bool) -> Result<Measurement, ImportError> {
        let emission = self.emission(source, settings)?;
        let shape = (self.acquisitions.len(), emission.len());
        let mut values = Array2::from_elem(shape, f64::NAN);
        let mut sigma = Array2::from_elem(shape, f64::NAN);
        let mut flags = Array2::from_elem(shape, Flag::NotMeasured.bit());
        let mut lines: BTreeMap<(usize, usize), u64> = BTreeMap::new();
        for cell in &self.cells {
            let column = match (emission.wavelengths(), cell.emission_nm) {
                (Some(axis), Some(nm)) => axis.partition_point(|known| *known < nm),
                _ => 0,
            };
            let at = (cell.acquisition, column);
            if let Some(before) = lines.insert(at, cell.line) {
                return Err(doubled(source, cell.line, before));
            }
            values[at] = cell.value;
            sigma[at] = cell.sigma;
            flags[at] = cell.flags.0;
        }
        let mut quantity = settings.quantity();
        quantity.certified_factor = certified(settings, &source.at_line(1))?;
        let expanded = settings.coverage_factor.filter(|factor| *factor != 1.0);
        if let Some(factor) = expanded {
            sigma.mapv_inplace(|sigma| sigma / factor);
        }
        let coverage_factor = expanded.and_then(|factor| Finite::try_from(factor).ok());
        let statement = Statement { coverage_factor, ..Statement::default() };
        let id = settings.id.as_deref().map_or_else(|| Id::from_title("scan"), Id::from_title);
        Ok(Measurement {
            id,
            title: settings.title.clone(),
            quantity,
            role: Role::Sample,
            sample: None,
            instrument: None,
            white_reference: None,
            emission,
            excitations: self.excitations.list,
            acquisitions: self.acquisitions,
            values: values.into_shared(),
            flags: flags.into_shared(),
            uncertainty: Uncertainty {
                standard: has_sigma.then(|| sigma.into_shared()),
                statement,
                ..Uncertainty::default()
            },
            conditions: Conditions::default(),
            direction_tests: Vec::new(),
            derivation: None,
        })
    }
}

/// How spreadsheets and statistics programs write a missing number.
fn is_missing(text: &str) -> bool {
    ["nan", "na", "n/a"].iter().any(|name| text.eq_ignore_ascii_case(name))
}

fn doubled(source: &Source, line: u64, before: u64) -> ImportError {
    ImportError::Contradiction(fault(
        source.at_line(line),
        format!("a second value for the cell of line {before}"),
        "one value per geometry, excitation and emission wavelength",
        "number repeats in a column `repeat`",
    ))
}

/// The certified factor as the one number that finished values can have; `place` where it is not stated.
pub(super) fn certified(settings: &Settings, place: &Place) -> Result<Vec<f64>, ImportError> {
    let Some(text) = &settings.certified_factor else { return Ok(Vec::new()) };
    value(text).map(|factor| vec![factor]).ok_or_else(|| {
        ImportError::Call(fault(
            settings.place_of("certified-factor", place.clone()),
            format!("{} as the certified factor of finished values", quoted(text)),
            "one number",
            "state one number, or leave the key out",
        ))
    })
}

fn flags(row: &Row<'_>) -> Result<Flags, ImportError> {
    let Some(text) = row.text("flag") else { return Ok(Flags::NONE) };
    let names = text.split(|c: char| c == '|' || c.is_whitespace()).filter(|name| !name.is_empty());
    names.into_iter().try_fold(Flags::NONE, |flags, name| {
        Flag::from_name(name).map(|flag| flags.with(flag)).ok_or_else(|| {
            let known = Flag::ALL.iter().map(|flag| flag.name()).collect::<Vec<_>>().join(", ");
            row.bad("flag", name, &format!("names of: {known}"))
        })
    })
}
