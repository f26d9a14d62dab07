//! The table of a BFC file, against what its line of ranges says.

use super::super::bispectral::Grid;
use super::super::error::{ImportError, fault, quoted};
use super::super::number::value;
use super::super::receipt::Notes;
use super::super::source::Source;
use super::super::text::Line;
use super::{NAME, is_start};

const END: &str = "EOD";

/// Start, end and step of the emission; number, start and step of the excitation.
struct Ranges {
    line: u64,
    emission: Vec<f64>,
    excitation: Vec<f64>,
}

/// Reads the lines of a file.
pub(super) struct Parser<'a> {
    source: &'a Source,
    lines: Vec<Line<'a>>,
    at: usize,
    /// The lines that begin with a semicolon, so far.
    pub(super) comments: Vec<Line<'a>>,
}

impl<'a> Parser<'a> {
    /// A parser at the beginning of a file.
    pub(super) fn new(source: &'a Source) -> Self {
        Self { source, lines: source.text.lines().collect(), at: 0, comments: Vec::new() }
    }

    /// The whole file.
    ///
    /// # Errors
    /// [`ImportError::Malformed`] with the line.
    pub(super) fn grid(&mut self, notes: &mut Notes) -> Result<Grid, ImportError> {
        self.preamble(notes);
        let ranges = self.ranges()?;
        self.excitation_line(&ranges)?;
        let mut values = Vec::new();
        for (row, nm) in ranges.emission.iter().enumerate() {
            self.row(row, *nm, &ranges, &mut values)?;
        }
        self.end(&ranges)?;
        let grid = Grid::from_rows(true, ranges.emission, ranges.excitation, values);
        grid.ok_or_else(|| self.malformed(ranges.line, "another number of values", "one per cell", "export it again"))
    }

    /// The next line that is no comment; comments are collected.
    fn next(&mut self) -> Option<Line<'a>> {
        while let Some(line) = self.lines.get(self.at).copied() {
            self.at += 1;
            if !line.text.trim_start().starts_with(';') {
                return Some(line);
            }
            self.comments.push(line);
        }
        None
    }

    fn preamble(&mut self, notes: &mut Notes) {
        while let Some(line) = self.next() {
            let text = line.text.trim();
            if !is_start(text) {
                self.at -= 1;
                return;
            }
            if text != NAME {
                let text = format!("the first line says {}, which has no place in the document", quoted(text));
                notes.notice(self.source.at_line(line.number), text);
            }
        }
    }

    fn ranges(&mut self) -> Result<Ranges, ImportError> {
        const EXPECTED: &str = "six numbers: emission start, end and step, number, start and step of the excitation";
        const ADVICE: &str = "export the matrix again";
        let Some(line) = self.next() else {
            return Err(self.malformed(self.last(), "no line of ranges", EXPECTED, ADVICE));
        };
        let bad = || self.malformed(line.number, quoted(line.text.trim()), EXPECTED, ADVICE);
        let numbers: Vec<f64> = line.text.split_whitespace().map(value).collect::<Option<_>>().ok_or_else(bad)?;
        let &[start, end, step, count, excitation, by] = numbers.as_slice() else { return Err(bad()) };
        let emissions = (end - start) / step + 1.0;
        let whole = |number: f64| (number - number.round()).abs() < 1e-3 && number.round() >= 1.0;
        if !(start > 0.0 && step > 0.0 && excitation > 0.0 && by > 0.0 && whole(emissions) && whole(count)) {
            return Err(bad());
        }
        // More cells than the file has bytes cannot follow; nothing is made room for.
        let limit = self.source.input.bytes as f64;
        if emissions * count > limit {
            let found = format!("{} x {count} values in a file of {limit} bytes", emissions.round());
            return Err(self.malformed(line.number, found, "at least two bytes for each value", ADVICE));
        }
        let axis = |from: f64, by: f64, count: f64| {
            (0_u32..).take_while(|k| f64::from(*k) < count.round()).map(|k| from + by * f64::from(k)).collect()
        };
        let (emission, excitation) = (axis(start, step, emissions), axis(excitation, by, count));
        Ok(Ranges { line: line.number, emission, excitation })
    }

    fn excitation_line(&mut self, ranges: &Ranges) -> Result<(), ImportError> {
        let declared =
            format!("`r:c:` and the {} excitation wavelengths of line {}", ranges.excitation.len(), ranges.line);
        let advice = "the line of ranges and the table are of different matrices; export it again";
        let Some(line) = self.next() else {
            return Err(self.malformed(
                self.last(),
                "the end of the file",
                declared,
                "the file is cut; export it again",
            ));
        };
        let mut fields = line.text.split_whitespace();
        if fields.next() != Some("r:c:") {
            return Err(self.malformed(line.number, quoted(line.text.trim()), declared, advice));
        }
        let fields: Vec<&str> = fields.collect();
        if fields.len() != ranges.excitation.len() {
            return Err(self.malformed(
                line.number,
                format!("{} excitation wavelengths", fields.len()),
                declared,
                advice,
            ));
        }
        for (field, nm) in fields.iter().zip(&ranges.excitation) {
            if !value(field).is_some_and(|found| same(found, *nm)) {
                let found = format!("the excitation wavelength {}", quoted(field));
                return Err(self.malformed(
                    line.number,
                    found,
                    format!("{nm} nm, as line {} says", ranges.line),
                    advice,
                ));
            }
        }
        Ok(())
    }

    fn row(&mut self, row: usize, nm: f64, ranges: &Ranges, values: &mut Vec<f64>) -> Result<(), ImportError> {
        let (rows, columns) = (ranges.emission.len(), ranges.excitation.len());
        let expected = format!("{rows} rows of emission, as line {} says", ranges.line);
        let Some(line) = self.next() else {
            let found = format!("the end of the file after {row} rows, without `{END}`");
            return Err(self.malformed(self.last(), found, expected, "the file is cut; export it again"));
        };
        if line.text.trim() == END {
            let found = format!("`{END}` after {row} rows");
            return Err(self.malformed(line.number, found, expected, "rows are missing; export it again"));
        }
        self.refuse_second(line)?;
        let mut fields = line.text.split_whitespace();
        let first = fields.next().unwrap_or("");
        if !value(first).is_some_and(|found| same(found, nm)) {
            let found = format!("a row that begins with {}", quoted(first));
            let expected = format!("the emission wavelength {nm} nm, as line {} says", ranges.line);
            return Err(self.malformed(line.number, found, expected, "look for a lost, doubled or damaged row"));
        }
        let before = values.len();
        for (field, excitation) in fields.zip(ranges.excitation.iter().map(Some).chain(std::iter::repeat(None))) {
            let Some(excitation) = excitation else { continue };
            values.push(value(field).ok_or_else(|| {
                let found = format!("{} at emission {nm} nm, excitation {excitation} nm", quoted(field));
                let expected = "a finite number with a decimal point";
                self.malformed(
                    line.number,
                    found,
                    expected,
                    "the instrument writes a number in every cell; export it again",
                )
            })?);
        }
        let found = line.text.split_whitespace().count() - 1;
        if found != columns {
            values.truncate(before);
            let found = format!("{found} values at emission {nm} nm");
            let expected = format!("{columns}, one for each excitation wavelength");
            return Err(self.malformed(
                line.number,
                found,
                expected,
                "the line is cut, or two are one; export it again",
            ));
        }
        Ok(())
    }

    fn end(&mut self, ranges: &Ranges) -> Result<(), ImportError> {
        let expected = format!("`{END}` after the {} rows that line {} says", ranges.emission.len(), ranges.line);
        let Some(line) = self.next() else {
            let advice = "the file is cut or has another number of rows; export it again";
            return Err(self.malformed(self.last(), format!("the end of the file without `{END}`"), expected, advice));
        };
        if line.text.trim() != END {
            self.refuse_second(line)?;
            let advice = "the line of ranges and the table are of different matrices; export it again";
            return Err(self.malformed(line.number, quoted(line.text.trim()), expected, advice));
        }
        let Some(line) = self.next() else { return Ok(()) };
        self.refuse_second(line)?;
        Err(self.malformed(
            line.number,
            quoted(line.text.trim()),
            format!("nothing after `{END}`"),
            "take the line out",
        ))
    }

    fn refuse_second(&self, line: Line<'_>) -> Result<(), ImportError> {
        if !(is_start(line.text) || line.text.trim_start().starts_with("r:c:")) {
            return Ok(());
        }
        let found = format!("a second matrix, with {}", quoted(line.text.trim()));
        Err(self.malformed(line.number, found, "one matrix in a file", "split the file, and import each on its own"))
    }

    fn last(&self) -> u64 {
        self.lines.last().map_or(1, |line| line.number)
    }

    fn malformed(&self, line: u64, found: impl Into<String>, expected: impl Into<String>, advice: &str) -> ImportError {
        ImportError::Malformed(fault(self.source.at_line(line), found, expected, advice))
    }
}

/// The same wavelength, to the digits that a table prints.
fn same(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-6 * expected
}
