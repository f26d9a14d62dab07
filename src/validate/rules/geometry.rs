//! Are the directions directions?

use super::super::Context;
use super::super::context::numbers;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Place, Role};
use crate::quantity::Flag;

/// Half width of the cone about the source in which no detector can stand, degrees: none is narrower than this.
const RETRO_HALF_WIDTH_DEG: f64 = 1e-6;

/// Reports the first angle of each dataset outside its range; NaN stands for an unstated geometry.
fn in_range(context: &Context<'_>, found: &mut Finder, angles: [&str; 2], fits: fn(f64) -> bool, range: &str) {
    for (path, group) in context.measurement_groups() {
        for angle in angles {
            let outside = |degrees: &f64| !degrees.is_nan() && !fits(*degrees);
            if let Some(index) = numbers(group, angle).iter().position(outside) {
                let degrees = numbers(group, angle)[index];
                found.add(
                    Place::path(format!("{path}/{angle}")).at_index([index]),
                    format!("{degrees} degrees"),
                    range,
                );
            }
        }
    }
}

pub(in super::super) fn polar_range(context: &Context<'_>, found: &mut Finder) {
    let fits = |degrees: f64| (0.0..=90.0).contains(&degrees);
    in_range(context, found, [name::THETA_I, name::THETA_V], fits, "0 to 90 degrees from the normal");
}

pub(in super::super) fn azimuth_range(context: &Context<'_>, found: &mut Finder) {
    let fits = |degrees: f64| (0.0..360.0).contains(&degrees);
    in_range(context, found, [name::PHI_I, name::PHI_V], fits, "0 up to but not including 360 degrees");
}

pub(in super::super) fn unknown(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        let unknown = measurement.acquisitions.iter().filter(|row| row.geometry.is_none()).count();
        if unknown > 0 {
            let total = measurement.acquisitions.len();
            let place = Place::path(format!("{path}/{}", name::THETA_I));
            found.add(place, format!("{unknown} of {total} rows without a geometry"), "a geometry for every row");
        }
    }
}

pub(in super::super) fn retro(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        let measured_there = |row: usize| {
            let geometry = measurement.acquisitions[row].geometry;
            let columns = measurement.emission.len();
            geometry.is_some_and(|geometry| geometry.is_retro(RETRO_HALF_WIDTH_DEG))
                && (0..columns).any(|column| {
                    let flags = measurement.flags_at(row, column);
                    !flags.explains_absence() && !flags.contains(Flag::Interpolated)
                })
        };
        if let Some(row) = (0..measurement.acquisitions.len()).find(|row| measured_there(*row)) {
            let place = Place::path(format!("{path}/{}", name::VALUE)).at_index([row]);
            found.add(
                place,
                "a measured value",
                "a reason why there is none: the detector would stand before the source",
            );
        }
    }
}
