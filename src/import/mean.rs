//! Repeats: their mean, and their spread as its uncertainty.
//!
//! Two or three repeats say little about their own spread, so that it is pooled: each record is compared with the mean
//! of its repeats, first by a common scale (the error that all its wavelengths share), then by what is left. What is
//! left, in units of the noise model, is pooled over all repeats at a wavelength where they have at least
//! [`ENOUGH`] degrees of freedom together, else over all wavelengths. Without a noise model each group has its own
//! standard error, and one record alone has none.

use super::noise::RECORD_SCALE;
use crate::dataset::Measurement;
use crate::quantity::{Flag, Flags};

/// Degrees of freedom from which a pooled standard deviation is good to 16 %.
const ENOUGH: f64 = 20.0;
/// A handful of repeats tells a scale error to 30 % only; the noise model's counts as this many degrees of freedom.
const MODEL_FREEDOM: f64 = 10.0;

/// How much repeats spread.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spread {
    /// Variance of what is left after the scale, over that of the noise model, per wavelength.
    excess: Vec<f64>,
    scale: Option<f64>,
    freedom: usize,
    modelled: bool,
}

impl Spread {
    /// The spread over all groups of repeats.
    pub(super) fn of<'a>(groups: impl Iterator<Item = (&'a Measurement, &'a Vec<usize>)>, modelled: bool) -> Self {
        let mut pool = Pool::default();
        for (measurement, rows) in groups {
            pool.add(measurement, &usable_rows(measurement, rows));
        }
        let all = (pool.sum.iter().sum::<f64>(), pool.freedom.iter().sum::<f64>());
        // Repeats without any spread are copies and tell nothing: the model stands.
        let overall = if all.1 > 0.0 && all.0 > 0.0 { all.0 / all.1 } else { 1.0 };
        let excess = pool
            .sum
            .iter()
            .zip(&pool.freedom)
            .map(|(sum, freedom)| if *freedom >= ENOUGH && *sum > 0.0 { sum / freedom } else { overall })
            .collect();
        let prior = if modelled { MODEL_FREEDOM } else { 0.0 };
        let scale = (pool.scale_freedom > 0 && prior + pool.scale_freedom as f64 >= 3.0).then(|| {
            let sum = prior * RECORD_SCALE * RECORD_SCALE + pool.scale_sum;
            (sum / (prior + pool.scale_freedom as f64)).sqrt()
        });
        Self { excess, scale, freedom: pool.scale_freedom, modelled }
    }

    /// True where an uncertainty can be given.
    pub(super) fn known(&self) -> bool {
        self.modelled || self.freedom > 0
    }

    /// The relative scale error of a record as the repeats show it.
    pub(super) fn record_scale(&self) -> Option<f64> {
        self.scale
    }

    /// In words, for the receipt.
    pub(super) fn describe(&self) -> String {
        if self.freedom == 0 && self.modelled {
            return "no repeats: the uncertainty is that of the noise model".to_owned();
        }
        if !self.modelled {
            return format!(
                "no noise model for this instrument: the uncertainty is the standard error of repeats ({} degrees of \
                 freedom), and unknown for single records",
                self.freedom
            );
        }
        let scale = self.scale.map_or_else(
            || format!("{RECORD_SCALE} (the noise model's)"),
            |scale| format!("{scale:.2e} (repeats, with the noise model's {RECORD_SCALE} as ten degrees of freedom)"),
        );
        format!(
            "repeats are averaged; their spread ({} degrees of freedom) is pooled in units of the noise model, apart \
             from a scale error per record of {scale}",
            self.freedom
        )
    }
}

#[derive(Debug, Default)]
struct Pool {
    sum: Vec<f64>,
    freedom: Vec<f64>,
    scale_sum: f64,
    scale_freedom: usize,
}

impl Pool {
    fn add(&mut self, measurement: &Measurement, rows: &[usize]) {
        let width = measurement.emission.len();
        self.sum.resize(width.max(self.sum.len()), 0.0);
        self.freedom.resize(width.max(self.freedom.len()), 0.0);
        if rows.len() < 2 {
            return;
        }
        let columns: Vec<usize> = (0..width).filter(|column| all_usable(measurement, rows, *column)).collect();
        let mean: Vec<f64> = columns.iter().map(|column| mean_at(measurement, rows, *column)).collect();
        let norm: f64 = mean.iter().map(|value| value * value).sum();
        if norm <= 0.0 {
            return;
        }
        self.scale_freedom += rows.len() - 1;
        for row in rows {
            let value = |column: usize| measurement.values[(*row, column)];
            let scale = columns.iter().zip(&mean).map(|(column, mean)| value(*column) * mean).sum::<f64>() / norm;
            self.scale_sum += (scale - 1.0).powi(2);
            for (column, mean) in columns.iter().zip(&mean) {
                let sigma = measurement.uncertainty.standard.as_ref().map_or(1.0, |sigma| sigma[(*row, *column)]);
                let left = (value(*column) - scale * mean) / sigma;
                self.sum[*column] += left * left;
            }
        }
        for column in columns {
            self.freedom[column] += rows.len() as f64 - 1.0;
        }
    }
}

/// Rows that hold a measurement: at least one value that may enter a mean.
fn usable_rows(measurement: &Measurement, rows: &[usize]) -> Vec<usize> {
    let holds = |row: &usize| (0..measurement.emission.len()).any(|column| usable(measurement, *row, column));
    rows.iter().copied().filter(holds).collect()
}

fn usable(measurement: &Measurement, row: usize, column: usize) -> bool {
    measurement.values[(row, column)].is_finite() && measurement.flags_at(row, column).may_be_fitted()
}

fn all_usable(measurement: &Measurement, rows: &[usize], column: usize) -> bool {
    rows.iter().all(|row| usable(measurement, *row, column))
}

fn mean_at(measurement: &Measurement, rows: &[usize], column: usize) -> f64 {
    rows.iter().map(|row| measurement.values[(*row, column)]).sum::<f64>() / rows.len() as f64
}

/// The mean of a group of repeats.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mean {
    /// Mean per wavelength; NaN where no repeat has a value.
    pub(super) value: Vec<f64>,
    /// Its standard uncertainty without the shared scale; NaN where unknown.
    pub(super) sigma: Vec<f64>,
    /// Flags.
    pub(super) flags: Vec<Flags>,
    /// Repeats that hold a measurement.
    pub(super) count: usize,
}

impl Mean {
    /// The mean of some rows of a measurement.
    pub(super) fn of(measurement: &Measurement, rows: &[usize], spread: &Spread) -> Self {
        let count = usable_rows(measurement, rows).len();
        let columns: Vec<(f64, f64, Flags)> =
            (0..measurement.emission.len()).map(|column| at(measurement, rows, column, spread)).collect();
        Self {
            value: columns.iter().map(|column| column.0).collect(),
            sigma: columns.iter().map(|column| column.1).collect(),
            flags: columns.iter().map(|column| column.2).collect(),
            count,
        }
    }
}

/// Mean, uncertainty and flags at one wavelength.
///
/// Repeats that are refused (missing, saturated, stale) are left out where others are not. A repeat on the floor is
/// an upper bound: leaving it out would bias the mean upwards, so that it stays in and the mean is flagged.
fn at(measurement: &Measurement, rows: &[usize], column: usize, spread: &Spread) -> (f64, f64, Flags) {
    let flags = |row: &usize| measurement.flags_at(*row, column);
    let finite: Vec<usize> =
        rows.iter().copied().filter(|row| measurement.values[(*row, column)].is_finite()).collect();
    let floor = |row: &&usize| flags(row).contains(Flag::BelowDetection);
    let good: Vec<usize> = finite.iter().filter(|row| floor(row) || flags(row).may_be_fitted()).copied().collect();
    let used = if good.is_empty() { &finite } else { &good };
    let of_used = used.iter().map(flags).fold(Flags::NONE, Flags::union);
    if used.is_empty() {
        let of_all = rows.iter().map(flags).fold(Flags::NONE, Flags::union);
        return (f64::NAN, f64::NAN, of_all);
    }
    (mean_at(measurement, used, column), standard_error(measurement, used, column, spread), of_used)
}

fn standard_error(measurement: &Measurement, rows: &[usize], column: usize, spread: &Spread) -> f64 {
    let count = rows.len() as f64;
    if let Some(sigma) = measurement.uncertainty.standard.as_ref().filter(|_| spread.modelled) {
        let variance: f64 = rows.iter().map(|row| sigma[(*row, column)].powi(2)).sum::<f64>() / count;
        let excess = spread.excess.get(column).copied().unwrap_or(1.0);
        return (variance * excess / count).sqrt();
    }
    if rows.len() < 2 {
        return f64::NAN;
    }
    let mean = mean_at(measurement, rows, column);
    let squares: f64 = rows.iter().map(|row| (measurement.values[(*row, column)] - mean).powi(2)).sum();
    (squares / (count - 1.0) / count).sqrt()
}
