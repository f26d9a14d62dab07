//! Texts of matrices, as spreadsheets and fluorimeters write them (excitation-emission matrices among them): a corner
//! cell, the wavelengths of one axis along the first row, those of the other along the first column.
//!
//! ```text
//! # quantity: donaldson-matrix      `# key: value` lines as in a table CSV, and `rows`
//! # rows: emission
//! em_nm\ex_nm,300,310,320
//! 380,0.0012,0.0004,-0.0002
//! ```
//!
//! Fields are divided by tabs, semicolons (then also with decimal commas), commas or blanks. Which axis is which is
//! never guessed: the corner says it (`em_nm\ex_nm`: emission down the first column, excitation along the first row;
//! `ex/em`), or the key `rows` (what the first column holds). An empty cell, or `nan`, is `not-measured`.
//! What the numbers are is `unstated` unless the key `quantity` says it.

mod table;

use super::bispectral::{self, Grid, Said};
use super::error::{ImportError, fault, quoted};
use super::keys::{MatrixRows, Settings, key_line};
use super::manifest::note_overridden;
use super::receipt::Notes;
use super::record::Details;
use super::rows::{header_line, keys_above};
use super::source::Source;
use super::{Options, table_csv};
use crate::dataset::{Document, Id};
use crate::quantity::QuantityKind;
use table::{Table, delimiter_of, either, split};

/// Shorter wavelengths are no optical ones, and numbers of samples rather.
const SHORTEST_NM: f64 = 100.0;

/// True for a text whose header is a word and wavelengths, over rows that begin with one; or which has the key `rows`.
pub(super) fn is_one(source: &Source) -> bool {
    let mut comments = source.text.lines().map_while(|line| key_line(line.text));
    if comments.any(|(key, text)| key.eq_ignore_ascii_case("rows") && text.parse::<MatrixRows>().is_ok()) {
        return true;
    }
    let Some((first, header)) = header_line(source) else { return false };
    let delimiter = delimiter_of(header);
    let header = split(header, delimiter);
    let row =
        source.text.lines().find(|line| line.number > first).map_or(Vec::new(), |line| split(line.text, delimiter));
    let wavelength = |field: &&str| either(field).filter(|nm| *nm >= SHORTEST_NM);
    let nm: Vec<Option<f64>> = header.iter().skip(1).map(wavelength).collect();
    let ascending = nm.windows(2).all(|pair| pair[0] < pair[1]) || nm.windows(2).all(|pair| pair[0] > pair[1]);
    let words = header.first().is_some_and(|corner| either(corner).is_none());
    words
        && nm.len() >= 2
        && nm.iter().all(Option::is_some)
        && ascending
        && row.len() == header.len()
        && row.first().is_some_and(|field| wavelength(field).is_some())
}

/// Reads a text as a document with one measurement, called `matrix` unless a setting names it.
///
/// # Errors
/// [`ImportError`] with the line for axes that nothing names, rows of another length, and cells that are no numbers.
pub(super) fn document(source: &Source, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    let mut stated = Settings::default();
    keys_above(source, &mut stated)?;
    note_overridden(source, &options.settings, &stated, notes);
    let settings = options.settings.clone().or(&stated);
    bispectral::refuse_settings(source, &settings, "a matrix")?;
    refuse_band(source, &settings)?;
    let table = Table::read(source, options, notes)?;
    let rows = rows(source, &table, &settings, notes)?;
    let mut input = source.input.clone();
    input.dialect = format!("matrix, {}, {}, rows of {rows}", table.dialect, source.text.encoding.name());
    input.records = table.rows_nm.len() as u64;
    notes.input(input);
    let place = source.at_line(table.header);
    let grid = Grid::from_rows(rows == MatrixRows::Emission, table.rows_nm, table.columns_nm, table.values);
    let grid = grid.ok_or_else(|| {
        ImportError::Malformed(fault(place.clone(), "another number of values", "one per cell", "export it again"))
    })?;
    let said = Said {
        id: settings.id.as_deref().map_or_else(|| Id::from_title("matrix"), Id::from_title),
        title: settings.title.clone(),
        quantity: settings.quantity(),
        time: None,
        operator: None,
        place,
    };
    let options = Options { settings, ..options.clone() };
    let measurement = bispectral::measurement(grid, said, &options)?;
    table_csv::note_percent(source, &measurement, notes);
    bispectral::document(vec![(measurement, None)], &Details::default(), &options.settings, notes)
}

/// A value of a band has no place over wavelengths.
fn refuse_band(source: &Source, settings: &Settings) -> Result<(), ImportError> {
    use QuantityKind::{BandRadiance, BandRadianceFactor, Luminance, LuminanceFactor};
    let of_band = [BandRadiance, BandRadianceFactor, Luminance, LuminanceFactor];
    let Some(kind) = settings.quantity.filter(|kind| of_band.contains(kind)) else { return Ok(()) };
    Err(ImportError::Contradiction(fault(
        settings.place_of("quantity", source.at_line(1)),
        format!("the quantity {kind} over emission wavelengths"),
        "a quantity of each wavelength, as donaldson-matrix or relative-spectrum",
        "state another quantity, or import a table CSV",
    )))
}

/// What the first column holds: as stated, else as the corner says.
fn rows(source: &Source, table: &Table, settings: &Settings, notes: &mut Notes) -> Result<MatrixRows, ImportError> {
    let place = source.at_line(table.header);
    match (settings.rows, corner(&table.corner)) {
        (Some(stated), Some(said)) if stated != said => Err(ImportError::Contradiction(fault(
            settings.place_of("rows", place),
            format!("`rows` is {stated} where the corner {} says {said}", quoted(&table.corner)),
            "one of them, or both the same",
            "correct the key or the corner",
        ))),
        (Some(rows), _) => Ok(rows),
        (None, Some(rows)) => {
            let text =
                format!("the corner {} says that the first column holds {rows} wavelengths", quoted(&table.corner));
            notes.assume(place, text);
            Ok(rows)
        }
        (None, None) => Err(ImportError::Ambiguous(fault(
            place,
            format!("wavelengths along the first row and the first column, and the corner {}", quoted(&table.corner)),
            r"a corner as `em\ex` (emission down the first column) or `ex\em`, or the key `# rows: emission` or `excitation`",
            "`--set rows=emission` or `--set rows=excitation` says what the first column holds; `--format columns` reads \
             a spectrum in every column",
        ))),
    }
}

/// `em_nm\ex_nm`, `Ex/Em`, or the name of the first column alone.
fn corner(text: &str) -> Option<MatrixRows> {
    let text = text.to_ascii_lowercase();
    let mut parts = text.split(['\\', '/', '|']).map(|part| {
        let word = part.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
        let is = |long: &str, short: &str| {
            let rest = word.strip_prefix(short);
            word.starts_with(long) || rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_alphabetic()))
        };
        match () {
            () if is("emission", "em") => Some(MatrixRows::Emission),
            () if is("excitation", "ex") => Some(MatrixRows::Excitation),
            () => None,
        }
    });
    match (parts.next().flatten(), parts.next(), parts.next()) {
        (Some(first), None, _) => Some(first),
        (Some(first), Some(second), None) if second.is_none_or(|second| second != first) => Some(first),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_names_the_first_column_first() {
        use MatrixRows::{Emission, Excitation};
        for (text, expected) in [
            (r"em_nm\ex_nm", Some(Emission)),
            ("ex/em", Some(Excitation)),
            ("Ex (nm) | Em (nm)", Some(Excitation)),
            ("Emission wavelength", Some(Emission)),
            ("em/em", None),
            ("wavelength", None),
            ("embedded", None),
            ("example", None),
            ("", None),
            ("a/ex", None),
        ] {
            assert_eq!(corner(text), expected, "{text}");
        }
    }
}
