//! Labsphere BFC-450 matrix files (`.BFC`): a Donaldson matrix with what the operator typed about it.
//!
//! ```text
//! VEC_01  5167
//! BFC-450 Matrix File
//! ;file  ;sample  ;operator  ;remark  ;two lines of settings  ;MM/DD/YYYY  ;HH:MM:SS      one comment per line
//! 380  780  10  49  300  10          emission start, end, step; number, start and step of the excitation
//! r:c:  300  310  ...                excitation wavelengths
//! 380  0.000401615  ...              one row per emission wavelength
//! EOD
//! ```
//!
//! Fields are divided by tabs; blank lines are passed over wherever they stand; the number of comments is not fixed.
//! Negative values are kept. Wavelengths and counts of the table are checked against the line of ranges.
//! What such a file does not say (reference, basis, bandpass, geometry) is `unstated`.

mod table;

use jiff::civil::DateTime;

use super::bispectral::{self, Said};
use super::error::{ImportError, quoted};
use super::receipt::Notes;
use super::record::Details;
use super::source::Source;
use super::text::Line;
use super::{Options, times};
use crate::dataset::{Document, Id, Place};
use crate::quantity::{NormalisedAt, Part, Quantity, QuantityKind};
use table::Parser;

const NAME: &str = "BFC-450 Matrix File";
const MODEL: &str = "Labsphere BFC-450";
/// What the instrument writes where the operator typed nothing.
const EMPTY: &str = "<none>";

/// True where a text begins as these files do.
pub(super) fn is_one(source: &Source) -> bool {
    let starts = |line: Line<'_>| is_start(line.text);
    source.text.lines().take(2).any(starts)
}

fn is_start(text: &str) -> bool {
    let text = text.trim_start();
    text.starts_with("VEC_") || text.starts_with(NAME)
}

/// Reads a file as a document with one measurement, called `matrix` unless a setting names it.
///
/// # Errors
/// [`ImportError`] with the line for counts and wavelengths that contradict each other, text where numbers should be,
/// and a table that does not end with `EOD` or is followed by another.
pub(super) fn document(source: &Source, options: &Options, notes: &mut Notes) -> Result<Document, ImportError> {
    let base = Quantity {
        part: Part::Total,
        normalised_at: NormalisedAt::Excitation,
        ..Quantity::unstated(QuantityKind::DonaldsonMatrix)
    };
    bispectral::refuse_settings(source, &options.settings, "a BFC matrix")?;
    bispectral::refuse_quantity(source, &options.settings, &base)?;
    let mut parser = Parser::new(source);
    let grid = parser.grid(notes)?;
    let mut input = source.input.clone();
    input.dialect = format!("bfc, {}", source.text.encoding.name());
    input.records = grid.excitation_nm.len() as u64;
    notes.input(input);
    let text = "a Donaldson matrix relative to the light at the excitation wavelength, its diagonal the total of what is \
                reflected and emitted there: what the instrument's name says, not the file";
    notes.assume(source.at_line(1), text);
    let comments = Comments::of(&parser.comments, source, notes);
    let settings = &options.settings;
    let instrument = Details { model: Some(MODEL.to_owned()), accessories: comments.accessories, ..Details::default() };
    let time = comments.time.and_then(|(time, place)| {
        let known = times::rfc3339(&time.to_string(), settings.time_zone.as_deref());
        if known.is_none() {
            notes.notice(place, format!("measured {time}, without a zone: `--set time-zone=+HH:MM` makes it the time"));
        }
        known
    });
    let said = Said {
        id: settings.id.as_deref().map_or_else(|| Id::from_title("matrix"), Id::from_title),
        title: settings.title.clone().or(comments.file),
        quantity: bispectral::stated(settings, base),
        time,
        operator: comments.operator,
        place: source.at_line(1),
    };
    let measurement = bispectral::measurement(grid, said, options)?;
    bispectral::document(vec![(measurement, comments.sample)], &instrument, settings, notes)
}

/// What the comments say, by their order.
#[derive(Debug, Default)]
struct Comments {
    file: Option<String>,
    sample: Option<String>,
    operator: Option<String>,
    accessories: Option<String>,
    time: Option<(DateTime, Place)>,
}

impl Comments {
    /// File, sample, operator, remark, settings of the instrument, date and time: the last two are known by their form,
    /// settings by their `mod=`, the rest by its order. What is left has no place and goes into the receipt.
    fn of(lines: &[Line<'_>], source: &Source, notes: &mut Notes) -> Self {
        let mut texts: Vec<(u64, &str)> =
            lines.iter().map(|line| (line.number, line.text.trim().trim_start_matches(';').trim())).collect();
        let mut comments = Self::default();
        if let [.., (_, date), (line, time)] = texts.as_slice()
            && let Ok(time) = DateTime::strptime("%m/%d/%Y %H:%M:%S", format!("{date} {time}"))
        {
            comments.time = Some((time, source.at_line(*line)));
            texts.truncate(texts.len() - 2);
        }
        let (settings, texts): (Vec<_>, Vec<_>) = texts.into_iter().partition(|(_, text)| text.contains("mod="));
        let settings: Vec<&str> = settings.iter().map(|(_, text)| *text).collect();
        comments.accessories = Some(settings.join("; ")).filter(|text| !text.is_empty());
        let known = |text: &str| Some(text.to_owned()).filter(|text| text != EMPTY && !text.is_empty());
        let mut left = texts.as_slice();
        if let [(_, file), (_, sample), (line, operator), rest @ ..] = left {
            (comments.file, comments.sample, comments.operator) = (known(file), known(sample), known(operator));
            notes.assume(source.at_line(*line), "the first three comments are file, sample and operator");
            left = rest;
        }
        for (line, text) in left.iter().filter(|(_, text)| known(text).is_some()) {
            notes.notice(source.at_line(*line), format!("a comment without a place in the document: {}", quoted(text)));
        }
        comments
    }
}
