//! Samples on the instrument's floor, and spectra from an old buffer.
//!
//! The PR-650 never reports zero. In the dark it prints a floor that depends on the wavelength and on the exposure and
//! repeats digit by digit from record to record: an upper bound and not a value. The floor is not documented, so it is
//! found in the data, by [`Floor`]. Samples within one per cent of the floor of their record are flagged; nothing is
//! changed. The noise of the dark is as large as the floor, which is therefore kept with each record.

use super::floor_scale::{Exposed, Floor};
use super::plan::Entry;
use crate::dataset::Role;
use crate::quantity::Flag;

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

/// Flags the samples on the floor as below detection, and gives each record its floor. All entries with data share one axis.
pub(super) fn flag_floor(entries: &mut [Entry]) -> Found {
    // A lamp has an axis and a range of its own; fixed decimals show zeros and no floor.
    let usable = |entry: &&Entry| {
        let record = &entry.record;
        let measured = entry.role != Role::Lamp && record.rejection.is_none() && !record.is_foreign();
        measured && record.fixed_decimals.is_none()
    };
    let spectra: Vec<Exposed<'_>> = entries.iter().filter(usable).map(exposed).collect();
    let floor = Floor::of(&spectra);
    let mut found = Found { wavelengths: floor.shape.iter().flatten().count(), ..Found::default() };
    for entry in entries.iter_mut().filter(|entry| usable(&&**entry)) {
        entry.floor = floor.at_most(&exposed(entry));
        let Some(scale) = floor.scale(&exposed(entry)) else { continue };
        let mut samples = 0;
        let record = &mut entry.record;
        for ((value, flags), shape) in record.values.iter().zip(&mut record.flags).zip(&floor.shape) {
            let level = shape.map(|shape| shape * scale);
            if level.is_some_and(|level| (value - level).abs() <= FLOOR_TOLERANCE * level) {
                *flags = flags.with(Flag::BelowDetection);
                samples += 1;
            }
        }
        found.samples += samples;
        found.records += usize::from(samples > 0);
    }
    found
}

fn exposed(entry: &Entry) -> Exposed<'_> {
    Exposed { values: &entry.record.values, exposure_ms: entry.exposure_ms.or(entry.record.details.exposure_ms) }
}

/// Flags every spectrum that repeats the one before it bit by bit; returns the positions of the copies. Dark spectra
/// that lie on the floor everywhere are alike without being copies.
pub(super) fn flag_stale(entries: &mut [Entry]) -> Vec<usize> {
    let mut copies = Vec::new();
    for index in 1..entries.len() {
        let (before, this) = (&entries[index - 1].record, &entries[index].record);
        let same = before.rejection.is_none() && this.rejection.is_none() && before.values == this.values;
        let dark = this.flags.iter().all(|flags| flags.contains(Flag::BelowDetection));
        if same && !this.is_foreign() && !dark && !this.values.is_empty() && before.nm == this.nm {
            copies.push(index);
        }
    }
    for index in &copies {
        entries[*index].record.flag_all(Flag::StaleBuffer);
    }
    copies
}
