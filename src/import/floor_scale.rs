//! The floor of each record: one shape over wavelength times a scale of the record.
//!
//! A floor in counts becomes a floor in radiance by the exposure: a short exposure lifts it, and the values of a scan
//! lie on floors of many heights. What stays is the shape over wavelength. It is taken from the records that share it
//! digit by digit; the scale of any other record is the smallest ratio of its values to the shape, and counts where
//! [`AGREEING`] wavelengths give it: all in the record, or together with records of the same scale, or of the same
//! product of scale and exposure. Wavelengths without a shape get one from the scaled records that agree there.

/// Wavelengths that must agree on a scale: single equal digits are chance.
pub(super) const AGREEING: usize = 4;

/// No floor above this has been seen, W m-2 sr-1 nm-1 (the highest known: 4.6e-6).
const LIMIT: f64 = 5e-6;

/// The floor's share of the largest value of the set is at most this, at the scale of the shape.
const SHARE: f64 = 1e-3;

/// Two ratios of numbers with four digits are the same within this part.
const SAME: f64 = 1.5e-3;

/// A shape from scaled records lies within this factor of that of its neighbours.
const NEIGHBOURLY: f64 = 1.5;

/// A spectrum with its exposure, where known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exposed<'a> {
    /// Values as printed.
    pub(super) values: &'a [f64],
    /// Integration time, ms.
    pub(super) exposure_ms: Option<f64>,
}

/// The floor of a set of records.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Floor {
    /// The shape, where known.
    pub(super) shape: Vec<Option<f64>>,
    /// Scales that were confirmed, ascending, and their products with the exposure.
    confirmed: [Vec<f64>; 2],
    limit: f64,
}

impl Floor {
    /// The floor that some records show; empty where they show none.
    pub(super) fn of(spectra: &[Exposed<'_>]) -> Self {
        let mut distinct = spectra.to_vec();
        distinct.sort_by(|a, b| order(a.values, b.values));
        distinct.dedup_by(|a, b| a.values == b.values);
        let largest = distinct.iter().flat_map(|spectrum| spectrum.values).copied().fold(0.0, f64::max);
        let limit = LIMIT.min(SHARE * largest);
        let shape = shape(&distinct, limit);
        let mut floor = Self { shape, confirmed: [Vec::new(), Vec::new()], limit: SHARE * largest };
        if floor.shape.is_empty() {
            return floor;
        }
        floor.confirm(&distinct);
        floor.extend(&distinct);
        floor.confirm(&distinct);
        floor
    }

    /// The scale of a record, where it is known.
    pub(super) fn scale(&self, spectrum: &Exposed<'_>) -> Option<f64> {
        let candidate = self.candidate(spectrum)?;
        let coordinates = [Some(candidate.scale), spectrum.exposure_ms.map(|exposure| candidate.scale * exposure)];
        let known = |(confirmed, coordinate): (&Vec<f64>, &Option<f64>)| {
            coordinate.is_some_and(|coordinate| holds(confirmed, coordinate))
        };
        let confirmed = candidate.count >= AGREEING || self.confirmed.iter().zip(&coordinates).any(known);
        confirmed.then_some(candidate.scale)
    }

    /// The floor of a record at every wavelength, or the highest that it can be where the record lies above it: no
    /// value is below its floor, and no floor above the highest of the set. Between the wavelengths that have a shape it
    /// is drawn geometrically: good enough for a noise, not for a flag.
    pub(super) fn at_most(&self, spectrum: &Exposed<'_>) -> Option<Vec<f64>> {
        let highest = self.confirmed[0].last().copied().unwrap_or(f64::INFINITY);
        let smallest = self.ratios(spectrum).map(|(_, ratio)| ratio).min_by(f64::total_cmp)?;
        let scale = self.scale(spectrum).unwrap_or(smallest.min(highest));
        (0..self.shape.len()).map(|index| self.drawn(index).map(|shape| shape * scale)).collect()
    }

    /// The shape at a wavelength, or between its neighbours.
    fn drawn(&self, index: usize) -> Option<f64> {
        let known = |index: usize| self.shape[index].map(|shape| (index as f64, shape));
        let before = (0..=index).rev().find_map(known);
        let after = (index..self.shape.len()).find_map(known);
        match (before, after) {
            (Some((from, low)), Some((to, high))) if to > from => {
                Some(low * (high / low).powf((index as f64 - from) / (to - from)))
            }
            (nearest, other) => nearest.or(other).map(|(_, shape)| shape),
        }
    }

    /// The positive values that have a shape, with their ratios to it.
    fn ratios(&self, spectrum: &Exposed<'_>) -> impl Iterator<Item = (f64, f64)> {
        let pairs = spectrum.values.iter().zip(&self.shape);
        pairs.filter_map(|(value, shape)| shape.filter(|_| *value > 0.0).map(|shape| (*value, value / shape)))
    }

    /// The smallest ratio to the shape, and how many wavelengths give it.
    fn candidate(&self, spectrum: &Exposed<'_>) -> Option<Candidate> {
        let ratios = || self.ratios(spectrum);
        let (_, smallest) = ratios().min_by(|a, b| a.1.total_cmp(&b.1))?;
        // A short exposure lifts the floor and, with it, what a floor may be.
        let allowed = LIMIT.min(self.limit * smallest.max(1.0));
        let agreeing: Vec<f64> = ratios()
            .filter(|(value, ratio)| *ratio <= smallest * (1.0 + SAME) && *value <= allowed)
            .map(|(_, ratio)| ratio)
            .collect();
        let count = agreeing.len();
        (count > 0).then(|| Candidate { scale: agreeing.iter().sum::<f64>() / count as f64, count })
    }

    /// Keeps the scales that enough wavelengths of several records, or of one, give.
    fn confirm(&mut self, distinct: &[Exposed<'_>]) {
        let candidates: Vec<(Candidate, Option<f64>)> = distinct
            .iter()
            .filter_map(|spectrum| self.candidate(spectrum).map(|candidate| (candidate, spectrum.exposure_ms)))
            .collect();
        let scales = candidates.iter().map(|(candidate, _)| (candidate.scale, candidate.count)).collect();
        let products = candidates
            .iter()
            .filter_map(|(candidate, exposure)| exposure.map(|exposure| (candidate.scale * exposure, candidate.count)))
            .collect();
        self.confirmed = [supported(scales), supported(products)];
    }

    /// Gives a shape to wavelengths without one: the smallest scaled value where two records agree on it.
    fn extend(&mut self, distinct: &[Exposed<'_>]) {
        let scaled: Vec<(&[f64], f64)> =
            distinct.iter().filter_map(|spectrum| self.scale(spectrum).map(|scale| (spectrum.values, scale))).collect();
        let found = |index: usize| {
            let level = |(values, scale): &(&[f64], f64)| {
                let value = values.get(index).copied().filter(|value| *value > 0.0 && *value <= LIMIT);
                value.map(|value| value / scale)
            };
            let mut levels: Vec<f64> = scaled.iter().filter_map(level).collect();
            levels.sort_by(f64::total_cmp);
            shared_level(&levels).filter(|level| self.is_neighbourly(index, *level))
        };
        let shape = (0..self.shape.len()).map(|index| self.shape[index].or_else(|| found(index))).collect();
        self.shape = shape;
    }

    fn is_neighbourly(&self, index: usize, level: f64) -> bool {
        let before = self.shape[..index].iter().rev().find_map(|shape| *shape);
        let after = self.shape[index..].iter().find_map(|shape| *shape);
        let near = |other: f64| level <= other * NEIGHBOURLY && other <= level * NEIGHBOURLY;
        before.into_iter().chain(after).any(near)
    }
}

#[derive(Debug, Clone, Copy)]
struct Candidate {
    scale: f64,
    count: usize,
}

/// The coordinates, ascending, whose surroundings hold enough agreeing wavelengths.
fn supported(mut candidates: Vec<(f64, usize)>) -> Vec<f64> {
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sums: Vec<usize> = std::iter::once(0)
        .chain(candidates.iter().scan(0, |sum, (_, count)| {
            *sum += count;
            Some(*sum)
        }))
        .collect();
    let enough = |coordinate: f64| {
        let from = candidates.partition_point(|(other, _)| *other < coordinate * (1.0 - SAME));
        let to = candidates.partition_point(|(other, _)| *other <= coordinate * (1.0 + SAME));
        sums[to] - sums[from] >= AGREEING
    };
    candidates.iter().map(|(coordinate, _)| *coordinate).filter(|coordinate| enough(*coordinate)).collect()
}

/// The lowest of ascending levels that two records share, or three where single ones lie below it (a scale too high).
fn shared_level(levels: &[f64]) -> Option<f64> {
    let sharing = |index: usize| {
        let end = levels.partition_point(|level| *level <= levels[index] * (1.0 + SAME));
        end - index
    };
    (0..levels.len()).find(|index| sharing(*index) >= if *index == 0 { 2 } else { 3 }).map(|index| levels[index])
}

/// True where an ascending list has the coordinate, within rounding.
fn holds(confirmed: &[f64], coordinate: f64) -> bool {
    let next = confirmed.partition_point(|known| *known < coordinate * (1.0 - SAME));
    confirmed.get(next).is_some_and(|known| *known <= coordinate * (1.0 + SAME))
}

/// The shape: at a wavelength the smallest value of the set, printed with the same digits by two or more records.
fn shape(distinct: &[Exposed<'_>], limit: f64) -> Vec<Option<f64>> {
    let width = distinct.first().map_or(0, |spectrum| spectrum.values.len());
    let at = |index: usize| distinct.iter().filter_map(move |spectrum| spectrum.values.get(index)).copied();
    let candidate = |index: usize| {
        let smallest = at(index).fold(f64::INFINITY, f64::min);
        let sharing = at(index).filter(|value| *value == smallest).count();
        (smallest > 0.0 && smallest <= limit && sharing >= 2).then_some(smallest)
    };
    let candidates: Vec<Option<f64>> = (0..width).map(candidate).collect();
    let shares = |spectrum: &&Exposed<'_>| {
        let equal = |(value, floor): (&f64, &Option<f64>)| *floor == Some(*value);
        spectrum.values.iter().zip(&candidates).filter(|pair| equal(*pair)).count() >= AGREEING
    };
    if distinct.iter().filter(shares).count() >= 2 { candidates } else { Vec::new() }
}

fn order(a: &[f64], b: &[f64]) -> std::cmp::Ordering {
    let by_value = a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
    by_value.unwrap_or_else(|| a.len().cmp(&b.len()))
}
