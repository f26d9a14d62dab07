//! Samples on the instrument's floor, and spectra from an old buffer.
//!
//! The PR-650 never reports zero. In the dark it prints a floor that depends on the wavelength and on the exposure and
//! repeats digit by digit from record to record: an upper bound and not a value. The floor is not documented, so it is
//! found in the data: at a wavelength it is the smallest value of the set, printed with the same digits by two or more
//! records that are not copies of each other, no more than [`FLOOR_LIMIT`] and than a thousandth of the largest value
//! of the set; and it counts only where at least [`SHARED_SAMPLES`] wavelengths of each of two records lie on it.
//! Samples within one per cent of it are flagged; nothing is changed.

use super::plan::Entry;
use crate::dataset::Role;
use crate::quantity::Flag;

/// No floor above this has been seen, W m-2 sr-1 nm-1 (the highest known: 3.5e-6).
const FLOOR_LIMIT: f64 = 5e-6;

/// The floor's share of the largest value of the set is at most this.
const FLOOR_SHARE: f64 = 1e-3;

/// Two records share the floor at this many wavelengths at least: single equal digits are chance.
const SHARED_SAMPLES: usize = 4;

/// A sample within this part of the floor lies on it.
const FLOOR_TOLERANCE: f64 = 0.01;

/// What was found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Found {
    /// Wavelengths with a known floor.
    pub(super) wavelengths: usize,
    /// Samples on it.
    pub(super) samples: usize,
    /// Records with at least one such sample.
    pub(super) records: usize,
}

/// Flags the samples on the floor as below detection. All entries with data share one axis.
pub(super) fn flag_floor(entries: &mut [Entry]) -> Found {
    // A lamp has an axis and a range of its own; fixed decimals show zeros and no floor.
    let usable = |entry: &&Entry| {
        entry.role != Role::Lamp && entry.record.rejection.is_none() && entry.record.fixed_decimals.is_none()
    };
    let spectra: Vec<&[f64]> = entries.iter().filter(usable).map(|entry| entry.record.values.as_slice()).collect();
    let floor = floor(&spectra);
    let mut found = Found { wavelengths: floor.iter().flatten().count(), ..Found::default() };
    for entry in entries.iter_mut().filter(|entry| usable(&&**entry)) {
        let mut samples = 0;
        for (index, value) in entry.record.values.iter().enumerate() {
            let on_floor = floor.get(index).copied().flatten();
            if on_floor.is_some_and(|floor| (value - floor).abs() <= FLOOR_TOLERANCE * floor) {
                entry.record.flags[index] = entry.record.flags[index].with(Flag::BelowDetection);
                samples += 1;
            }
        }
        found.samples += samples;
        found.records += usize::from(samples > 0);
    }
    found
}

/// The floor at each wavelength, where there is one.
fn floor(spectra: &[&[f64]]) -> Vec<Option<f64>> {
    let mut distinct: Vec<&[f64]> = spectra.to_vec();
    distinct.sort_by(|a, b| order(a, b));
    distinct.dedup_by(|a, b| a == b);
    let width = distinct.first().map_or(0, |spectrum| spectrum.len());
    let largest = distinct.iter().flat_map(|spectrum| spectrum.iter()).copied().fold(0.0, f64::max);
    let limit = FLOOR_LIMIT.min(FLOOR_SHARE * largest);
    let candidate = |index: usize| {
        let smallest =
            distinct.iter().filter_map(|spectrum| spectrum.get(index)).copied().fold(f64::INFINITY, f64::min);
        let sharing = distinct.iter().filter(|spectrum| spectrum.get(index) == Some(&smallest)).count();
        (smallest > 0.0 && smallest <= limit && sharing >= 2).then_some(smallest)
    };
    let candidates: Vec<Option<f64>> = (0..width).map(candidate).collect();
    let shared = |spectrum: &&&[f64]| {
        let equal = |(value, floor): (&f64, &Option<f64>)| *floor == Some(*value);
        spectrum.iter().zip(&candidates).filter(|pair| equal(*pair)).count() >= SHARED_SAMPLES
    };
    if distinct.iter().filter(shared).count() >= 2 { candidates } else { Vec::new() }
}

fn order(a: &[f64], b: &[f64]) -> std::cmp::Ordering {
    let by_value = a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
    by_value.unwrap_or_else(|| a.len().cmp(&b.len()))
}

/// Flags every spectrum that repeats the one before it bit by bit; returns the positions of the copies. Dark spectra
/// that lie on the floor everywhere are alike without being copies.
pub(super) fn flag_stale(entries: &mut [Entry]) -> Vec<usize> {
    let mut copies = Vec::new();
    for index in 1..entries.len() {
        let (before, this) = (&entries[index - 1].record, &entries[index].record);
        let same = before.rejection.is_none() && this.rejection.is_none() && before.values == this.values;
        let dark = this.flags.iter().all(|flags| flags.contains(Flag::BelowDetection));
        if same && !dark && !this.values.is_empty() && before.nm == this.nm {
            copies.push(index);
        }
    }
    for index in &copies {
        entries[*index].record.flag_all(Flag::StaleBuffer);
    }
    copies
}
