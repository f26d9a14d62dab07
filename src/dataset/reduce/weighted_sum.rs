//! The weighted sum over wavelengths that a band or V(lambda) asks for.

use ndarray::Array2;

use super::{ReduceError, Reduced, Reduction, geometry_of, nothing_left, shared, usable};
use crate::dataset::{Document, Measurement};
use crate::quantity::{Band, CorrelatedOver, EmissionAxis, Flag, Flags, QuantityKind, luminous_efficacy};

/// The default band holds the wavelengths whose mean signal exceeds this share of its peak.
const BAND_SHARE_OF_PEAK: f64 = 0.1;
/// A wavelength that is unusable in some rows is left out of both sums for all rows if it carries at most this share
/// of the signal; otherwise the rows are left out.
const NEGLIGIBLE_SHARE: f64 = 1e-3;
/// The default band ends where more than this share of the rows has no usable value: each wavelength that a row lacks
/// costs the row.
const MOST_MISSING: f64 = 0.01;

/// A weighted sum over wavelengths, the same wavelengths for every row.
pub(super) struct WeightedSum<'a> {
    measurement: &'a Measurement,
    /// Indices of the wavelengths in the sum.
    columns: Vec<usize>,
    /// Weights \[row, index in `columns`\].
    weights: Array2<f64>,
    /// True for a factor: divide by the sum of the weights.
    ratio: bool,
    kind: QuantityKind,
    band: Band,
    name: String,
    notes: Vec<String>,
}

impl<'a> WeightedSum<'a> {
    pub(super) fn new(
        document: &Document,
        measurement: &'a Measurement,
        nm: &[f64],
        reduction: Reduction,
    ) -> Result<Self, ReduceError> {
        let mut notes = Vec::new();
        let ratio = measurement.quantity.kind.is_factor();
        let base = base_weights(document, measurement, nm, ratio, &mut notes);
        let alive: Vec<usize> = (0..nm.len()).filter(|&column| is_alive(measurement, &base, column)).collect();
        let luminance = reduction == Reduction::Luminance;
        let response = |column: usize| if luminance { luminous_efficacy(nm[column]) } else { 1.0 };
        let band = match reduction {
            Reduction::Band(band) => Some(band),
            Reduction::Luminance => Some(Band { from_nm: f64::MIN_POSITIVE, to_nm: f64::MAX }),
            Reduction::Auto | Reduction::None => auto_band(measurement, nm, &base, &alive),
        };
        let mut columns: Vec<usize> =
            alive.into_iter().filter(|&column| band.is_some_and(|band| band.contains(nm[column]))).collect();
        drop_negligible_gaps(measurement, &base, &response, &mut columns);
        let (Some(&first), Some(&last)) = (columns.first(), columns.last()) else {
            return Err(ReduceError::EmptyBand {
                measurement: measurement.id.to_string(),
                reduction: reduction.to_string(),
                from: nm.first().copied().unwrap_or(f64::NAN),
                to: nm.last().copied().unwrap_or(f64::NAN),
            });
        };
        let weights = Array2::from_shape_fn((measurement.acquisitions.len(), columns.len()), |(row, k)| {
            base[(row, columns[k])] * response(columns[k])
        });
        let band = match (reduction, band) {
            (Reduction::Band(band), _) => band,
            (Reduction::Auto, Some(band)) if first == last => band,
            _ => Band { from_nm: nm[first], to_nm: nm[last] },
        };
        let inside = nm.iter().filter(|nm| band.contains(**nm)).count();
        if inside > columns.len() {
            notes.push(format!(
                "{} of the {inside} wavelengths in the band are left out of both sums: no row has a usable value there, or \
                 some rows have none and it carries at most a thousandth of the signal",
                inside - columns.len()
            ));
        }
        let name = if luminance { "luminance".to_owned() } else { format!("band:{band}") };
        let kind = reduced_kind(measurement.quantity.kind, luminance);
        Ok(Self { measurement, columns, weights, ratio, kind, band, name, notes })
    }

    pub(super) fn reduced(mut self) -> Result<Reduced, ReduceError> {
        let count = self.measurement.acquisitions.len();
        let rows: Vec<usize> = (0..count)
            .filter(|&row| geometry_of(self.measurement, row).is_some() && self.value(row).is_finite())
            .collect();
        if rows.is_empty() {
            return Err(nothing_left(self.measurement, &self.name));
        }
        self.notes.extend(self.truncated_rows());
        let has_sigma = self.measurement.uncertainty.standard.is_some();
        let shape = (1, rows.len());
        Ok(Reduced {
            kind: self.kind,
            reference: self.measurement.quantity.reference,
            geometry: rows.iter().filter_map(|&row| geometry_of(self.measurement, row)).collect(),
            values: Array2::from_shape_fn(shape, |(_, k)| self.value(rows[k])),
            sigma: has_sigma.then(|| Array2::from_shape_fn(shape, |(_, k)| self.sigma(rows[k]))),
            bounds: Vec::new(),
            record_relative: vec![0.0],
            shared_relative: vec![self.shared_relative(&rows)],
            left_out: count - rows.len(),
            left_out_emission: 0,
            emission: EmissionAxis::Band { band: Some(self.band) },
            reduction: self.name,
            notes: self.notes,
            rows,
        })
    }

    /// Rows that are lost because a part of their band is below detection: the dark ones, so that a fit sees too bright a
    /// surface.
    fn truncated_rows(&self) -> Option<String> {
        let is_below =
            |row: usize| self.columns.iter().any(|&k| self.measurement.flags_at(row, k).contains(Flag::BelowDetection));
        let placed =
            || (0..self.measurement.acquisitions.len()).filter(|&row| geometry_of(self.measurement, row).is_some());
        let lost = placed().filter(|&row| is_below(row) && !self.value(row).is_finite()).count();
        (lost > 0).then(|| {
            format!(
                "{lost} of {} rows are left out because they are below detection at some wavelength of the band: what is left \
                 is truncated, the darkest rows are missing and amplitudes may be too high; a narrower band with more \
                 light keeps these rows",
                placed().count()
            )
        })
    }

    /// Sum over the columns of weight times `term`, over the sum of the weights for a ratio.
    fn sum(&self, row: usize, term: impl Fn(usize) -> f64) -> f64 {
        let weights = self.weights.row(row);
        let total: f64 = self.columns.iter().zip(weights).map(|(&column, weight)| weight * term(column)).sum();
        total / if self.ratio { weights.sum() } else { 1.0 }
    }

    fn value(&self, row: usize) -> f64 {
        self.sum(row, |column| usable(self.measurement, row, column))
    }

    fn sigma(&self, row: usize) -> f64 {
        let own = self.measurement.uncertainty.standard.as_ref();
        let weights = self.weights.row(row);
        let variance: f64 = self
            .columns
            .iter()
            .zip(weights)
            .map(|(&column, weight)| (weight * own.map_or(f64::NAN, |own| own[(row, column)])).powi(2))
            .sum();
        let total = if self.ratio { weights.sum() } else { 1.0 };
        let scale = self.sum(row, |column| {
            shared(self.measurement, column, |over| over == CorrelatedOver::Wavelengths)
                * self.measurement.values[(row, column)]
        });
        (variance.sqrt() / total).hypot(scale)
    }

    /// What all rows share, relative to the value, at the mean spectrum.
    fn shared_relative(&self, rows: &[usize]) -> f64 {
        let mean = |column: usize| {
            rows.iter().map(|&row| usable(self.measurement, row, column)).sum::<f64>() / rows.len() as f64
        };
        let weights: Vec<f64> =
            (0..self.columns.len()).map(|k| rows.iter().map(|&row| self.weights[(row, k)]).sum::<f64>()).collect();
        let parts: Vec<f64> =
            self.columns.iter().zip(&weights).map(|(&column, weight)| weight * mean(column)).collect();
        let total: f64 = parts.iter().sum();
        let each = |over: CorrelatedOver| {
            self.columns
                .iter()
                .zip(&parts)
                .map(move |(&column, part)| part * shared(self.measurement, column, |o| o == over))
        };
        let independent = each(CorrelatedOver::Acquisitions).map(|part| part * part).sum::<f64>().sqrt();
        let common: f64 = each(CorrelatedOver::All).sum();
        (independent.hypot(common) / total).abs()
    }
}

fn reduced_kind(kind: QuantityKind, luminance: bool) -> QuantityKind {
    match (kind.is_factor(), luminance) {
        (true, true) => QuantityKind::LuminanceFactor,
        (true, false) => QuantityKind::BandRadianceFactor,
        (false, true) if kind == QuantityKind::SpectralRadiance => QuantityKind::Luminance,
        (false, false) if kind == QuantityKind::SpectralRadiance => QuantityKind::BandRadiance,
        (false, _) => kind,
    }
}

/// The weight of each value \[row, wavelength\]: p of the perfect diffuser for a factor, the step for a radiance.
fn base_weights(
    document: &Document,
    measurement: &Measurement,
    nm: &[f64],
    ratio: bool,
    notes: &mut Vec<String>,
) -> Array2<f64> {
    let steps: Vec<f64> = (0..nm.len()).map(|column| step(nm, column)).collect();
    let perfect = if ratio { perfect_diffuser(document, measurement) } else { None };
    if ratio && perfect.is_none() {
        notes.push("the file holds no reference spectrum for this factor: the band is the ratio of sums under an equal-energy light".to_owned());
    }
    Array2::from_shape_fn(measurement.shape(), |(row, column)| {
        steps[column] * perfect.as_ref().map_or(1.0, |perfect| perfect[(row, column)])
    })
}

/// The width of wavelength that a sample stands for, nm: half way to its neighbours.
fn step(nm: &[f64], column: usize) -> f64 {
    let last = nm.len().saturating_sub(1);
    if last == 0 {
        return 1.0;
    }
    let (before, after) = (column.saturating_sub(1), (column + 1).min(last));
    (nm[after] - nm[before]) / (after - before) as f64
}

/// A dark signal on the floor, or a white one, is a weight all the same: the importer averaged it in.
fn weighs(flags: Flags) -> bool {
    flags.iter().all(|flag| flag == Flag::BelowDetection || !flag.excludes_from_fit())
}

/// What the perfect diffuser would have radiated, per row and wavelength; NaN where the reference is not usable.
fn perfect_diffuser(document: &Document, measurement: &Measurement) -> Option<Array2<f64>> {
    let derivation = measurement.derivation.as_ref()?;
    let reference = document.measurement(derivation.reference.as_str())?;
    if reference.emission.len() != measurement.emission.len() {
        return None;
    }
    let dark = derivation.dark.as_ref().and_then(|id| document.measurement(id.as_str()));
    let certified = &measurement.quantity.certified_factor;
    let certified_at = |column: usize| certified.get(column).or(certified.last()).copied().unwrap_or(1.0);
    let mean = |source: &Measurement, column: usize, select: &dyn Fn(usize) -> bool| {
        let values: Vec<f64> = (0..source.acquisitions.len())
            .filter(|&row| select(row))
            .filter(|&row| weighs(source.flags_at(row, column)))
            .map(|row| source.values[(row, column)])
            .filter(|value| value.is_finite())
            .collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let groups = derivation.reference_group.iter().copied().max().unwrap_or(-1) + 1;
    let table =
        Array2::from_shape_fn((usize::try_from(groups).ok()?, measurement.emission.len()), |(group, column)| {
            let in_group =
                |row: usize| derivation.reference_group.get(row).is_some_and(|&g| usize::try_from(g) == Ok(group));
            // A dark signal on the floor is an upper bound, and the importer took nothing off there.
            let offset = dark.filter(|dark| !is_bound(dark, column)).map_or(0.0, |dark| mean(dark, column, &|_| true));
            let offset = if offset.is_finite() { offset } else { 0.0 };
            (mean(reference, column, &in_group) - offset) / certified_at(column)
        });
    Some(Array2::from_shape_fn(measurement.shape(), |(row, column)| {
        let group = derivation.row_reference.get(row).and_then(|&group| usize::try_from(group).ok());
        group.and_then(|group| table.get((group, column))).copied().unwrap_or(f64::NAN)
    }))
}

/// True where the mean of a dark signal is an upper bound: a part of it lies on the instrument's floor.
fn is_bound(dark: &Measurement, column: usize) -> bool {
    (0..dark.acquisitions.len()).map(|row| dark.flags_at(row, column)).any(|flags| flags.contains(Flag::BelowDetection))
}

/// True where some row has a usable value with a positive weight.
fn is_alive(measurement: &Measurement, base: &Array2<f64>, column: usize) -> bool {
    (0..measurement.acquisitions.len())
        .any(|row| usable(measurement, row, column).is_finite() && base[(row, column)] > 0.0)
}

/// Drops the wavelengths that some rows lack and that carry next to nothing.
fn drop_negligible_gaps(
    measurement: &Measurement,
    base: &Array2<f64>,
    response: &impl Fn(usize) -> f64,
    columns: &mut Vec<usize>,
) {
    let signals: Vec<f64> =
        columns.iter().map(|&column| mean_signal(measurement, base, column) * response(column)).collect();
    let total: f64 = signals.iter().sum();
    let has_gap = |column: usize| {
        (0..measurement.acquisitions.len())
            .any(|row| usable(measurement, row, column).is_nan() || base[(row, column)].is_nan())
    };
    let mut signal = signals.iter();
    columns.retain(|&column| {
        let share = signal.next().copied().unwrap_or(0.0).abs() / total.abs();
        share > NEGLIGIBLE_SHARE || !has_gap(column)
    });
}

/// Mean over the rows of value times weight, over the rows that have one.
fn mean_signal(measurement: &Measurement, base: &Array2<f64>, column: usize) -> f64 {
    let values: Vec<f64> = (0..measurement.acquisitions.len())
        .map(|row| usable(measurement, row, column) * base[(row, column)])
        .filter(|value| value.is_finite())
        .collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// The run of wavelengths around the peak of the mean signal in which it exceeds a tenth of the peak and nearly every
/// row has a value.
fn auto_band(measurement: &Measurement, nm: &[f64], base: &Array2<f64>, alive: &[usize]) -> Option<Band> {
    let signal = |column: usize| mean_signal(measurement, base, column) / step(nm, column);
    let means: Vec<f64> = alive.iter().map(|&column| signal(column)).collect();
    let known = || (0..measurement.acquisitions.len()).filter(|&row| geometry_of(measurement, row).is_some());
    let most = MOST_MISSING * known().count() as f64;
    let lacks = |column: usize| known().filter(|&row| usable(measurement, row, column).is_nan()).count();
    let whole: Vec<bool> = alive.iter().map(|&column| lacks(column) as f64 <= most).collect();
    let any_whole = whole.contains(&true);
    let candidates = (0..means.len()).filter(|&k| whole[k] || !any_whole);
    let peak = candidates.max_by(|&a, &b| means[a].total_cmp(&means[b]))?;
    let exceeds = |k: usize| means[k] > BAND_SHARE_OF_PEAK * means[peak] && whole[k] == any_whole;
    let first = (0..=peak).rev().take_while(|&k| k == peak || exceeds(k)).last()?;
    let last = (peak..means.len()).take_while(|&k| k == peak || exceeds(k)).last()?;
    let (from, to) = (alive[first], alive[last]);
    // A band has a width: that of the one sample, where it is one.
    let margin = if from == to { step(nm, from) / 2.0 } else { 0.0 };
    Some(Band { from_nm: nm[from] - margin, to_nm: nm[to] + margin })
}
