//! D, G, F, the term and its derivatives against 60-digit arithmetic (`testdata/terms_60_digits/make.py`): at the points of
//! the committed table, and at as many others as `BBRF_POINTS` asks for, made while the test runs by `BBRF_PYTHON`.
#![allow(clippy::unwrap_used)]

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use bbrf::quantity::{Geometry, Reference};
use bbrf::terms::{Term, TorranceSparrow};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/testdata/terms_60_digits");
/// Relative error promised of values, times 1 + |ln D|: D multiplies the relative error of its argument by that.
const VALUE: f64 = 2e-14;
/// Error promised of derivatives, over the sum of the absolute values of their terms: they cross zero.
const DERIVATIVE: f64 = 1e-12;
/// Where D is below this it is subnormal or zero and has no relative error; everything made of it follows.
const SMALLEST_NORMAL: f64 = 2.3e-308;

/// What was compared, as [`Worst`] lists it.
const NAMES: [&str; 7] = ["phi", "D", "G", "F", "term", "by roughness", "by index"];

/// The largest errors so far in units of what is promised, with the row that has them.
#[derive(Debug, Clone, Default)]
struct Worst {
    share: [f64; 7],
    row: [String; 7],
    count: usize,
}

impl Worst {
    fn of(rows: impl BufRead) -> Self {
        let mut worst = Self::default();
        for line in rows.lines().map(Result::unwrap).skip(2) {
            worst.add(&line);
        }
        worst
    }

    fn add(&mut self, line: &str) {
        let row = Row::read(line);
        let Some(shares) = row.shares() else {
            // What overflows is refused; `laws.rs` holds that to be the only reason.
            assert!(row.overflows(), "refused without need\n{line}");
            return;
        };
        self.count += 1;
        for (k, share) in shares.into_iter().enumerate() {
            assert!(!share.is_nan(), "{} is NaN\n{line}", NAMES[k]);
            if share > self.share[k] {
                (self.share[k], self.row[k]) = (share, line.to_owned());
            }
        }
    }

    fn join(mut self, other: Self) -> Self {
        self.count += other.count;
        for (k, row) in other.row.into_iter().enumerate() {
            if other.share[k] > self.share[k] {
                (self.share[k], self.row[k]) = (other.share[k], row);
            }
        }
        self
    }

    fn assert_promised(&self) {
        println!("{} points; largest error over the one promised:", self.count);
        for (name, share) in NAMES.iter().zip(self.share) {
            println!("  {name:12} {share:.3}");
        }
        for (k, share) in self.share.into_iter().enumerate() {
            assert!(share <= 1.0, "{}: {share:.3} times the error promised at\n{}", NAMES[k], self.row[k]);
        }
    }
}

struct Row {
    geometry: Geometry,
    reference: Reference,
    term: TorranceSparrow,
    /// phi, D, G, F.
    factors: [f64; 4],
    over: f64,
    value: f64,
    /// Derivative, and the sum of the absolute values of its terms over the term itself.
    by_roughness: (f64, f64),
    by_index: (f64, f64),
}

impl Row {
    fn read(line: &str) -> Self {
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
        let fields = reader.records().next().unwrap().unwrap();
        let number = |i: usize| fields[i].parse::<f64>().unwrap();
        Self {
            geometry: Geometry::from_degrees(number(0), number(1), number(2), number(3)).unwrap(),
            term: TorranceSparrow {
                intensity: 1.0,
                distribution: fields[4].parse().unwrap(),
                denominator: fields[5].parse().unwrap(),
                roughness: number(7),
                refractive_index: number(8),
            },
            reference: fields[6].parse().unwrap(),
            factors: [9, 10, 11, 12].map(number),
            over: number(13),
            value: number(14),
            by_roughness: (number(15), number(16)),
            by_index: (number(17), number(18)),
        }
    }

    fn overflows(&self) -> bool {
        !(self.by_roughness.0.is_finite() && self.by_index.0.is_finite() && self.value.is_finite())
    }

    /// Errors over those promised; `None` where the library refuses.
    fn shares(&self) -> Option<[f64; 7]> {
        let factors = self.term.factors(&self.geometry).ok()?;
        let found = Term::TorranceSparrow(self.term).evaluate(&self.geometry, &self.reference).ok()?;
        let [phi, d, g, f] = self.factors;
        let steepness = 1.0 + d.max(f64::MIN_POSITIVE).ln().abs();
        // What a D of the smallest normal number would make of the term.
        let least = SMALLEST_NORMAL * self.over.max(1.0);
        let share = |found: f64, expected: f64, scale: f64, promised: f64| match (found - expected).abs() {
            0.0 => 0.0,
            error => error / (promised * scale),
        };
        let value = |found: f64, expected: f64, least: f64, promised: f64| {
            share(found, expected, expected.max(least), promised)
        };
        let derivative = |found: f64, (expected, terms): (f64, f64)| {
            share(found, expected, (self.value.max(least) * terms).max(SMALLEST_NORMAL), DERIVATIVE)
        };
        Some([
            value(factors.phi_rad, phi, SMALLEST_NORMAL, VALUE),
            value(factors.d, d, SMALLEST_NORMAL, VALUE * steepness),
            value(factors.g, g, SMALLEST_NORMAL, VALUE),
            value(factors.f, f, SMALLEST_NORMAL, VALUE),
            value(found.value, self.value, least, VALUE * steepness),
            derivative(found.by[1], self.by_roughness),
            derivative(found.by[2], self.by_index),
        ])
    }
}

#[test]
fn every_digit_promised_is_there_at_the_points_of_the_table() {
    let table = std::fs::read(format!("{FOLDER}/table.csv")).unwrap();
    Worst::of(table.as_slice()).assert_promised();
}

/// A long run: on every core a generator of its own.
#[test]
fn every_digit_promised_is_there_at_as_many_points_as_are_asked_for() {
    let (Ok(points), Ok(python)) = (std::env::var("BBRF_POINTS"), std::env::var("BBRF_PYTHON")) else { return };
    let cores = std::thread::available_parallelism().unwrap().get();
    let share = points.parse::<usize>().unwrap().div_ceil(cores);
    let streams: Vec<_> = (0..cores)
        .map(|core| {
            let arguments = [format!("{FOLDER}/make.py"), (20_270_000 + core).to_string(), share.to_string()];
            let mut made = Command::new(&python).args(arguments).stdout(Stdio::piped()).spawn().unwrap();
            std::thread::spawn(move || {
                let worst = Worst::of(BufReader::new(made.stdout.take().unwrap()));
                assert!(made.wait().unwrap().success(), "the generator failed; it needs mpmath");
                worst
            })
        })
        .collect();
    let worst = streams.into_iter().map(|stream| stream.join().unwrap()).reduce(Worst::join).unwrap();
    assert!(worst.count > share, "{} points came", worst.count);
    worst.assert_promised();
    // What was committed is what the generator makes.
    let mut made = String::new();
    let mut child = Command::new(&python).arg(format!("{FOLDER}/make.py")).stdout(Stdio::piped()).spawn().unwrap();
    child.stdout.take().unwrap().read_to_string(&mut made).unwrap();
    child.wait().unwrap();
    assert!(made == std::fs::read_to_string(format!("{FOLDER}/table.csv")).unwrap(), "the table is another");
}
