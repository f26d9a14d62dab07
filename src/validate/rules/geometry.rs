//! Are the directions directions?

use super::super::Context;
use super::super::context::numbers;
use super::super::finding::Finder;
use crate::container::layout::name;
use crate::dataset::{Acquisition, Instrument, Place, Role};
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

/// Unit vectors are written with all digits; this is a few roundings of angles that were not.
const VECTOR_TOLERANCE: f64 = 1e-6;

pub(in super::super) fn self_test(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        for (index, test) in measurement.direction_tests.iter().enumerate() {
            let row = usize::try_from(test.row).ok().and_then(|row| measurement.acquisitions.get(row));
            let Some(geometry) = row.and_then(|row| row.geometry) else { continue };
            let pairs = [
                (name::DIRECTION_TEST_INCIDENCE, test.incidence, geometry.incidence.unit_vector()),
                (name::DIRECTION_TEST_VIEWING, test.viewing, geometry.viewing.unit_vector()),
            ];
            for (dataset, stated, computed) in pairs {
                let agrees = stated.iter().zip(computed).all(|(a, b)| (a - b).abs() <= VECTOR_TOLERANCE);
                if !agrees {
                    let place = Place::path(format!("{path}/{dataset}")).at_index([index]);
                    found.add(
                        place,
                        format!("{stated:?}{}", habit(stated, computed)),
                        format!("{computed:?}, from the angles"),
                    );
                }
            }
        }
    }
}

/// Names the usual mistakes: azimuth turned the other way, x and y exchanged, the beam's direction of travel.
fn habit(stated: [f64; 3], computed: [f64; 3]) -> &'static str {
    let [x, y, z] = computed;
    let is = |other: [f64; 3]| stated.iter().zip(other).all(|(a, b)| (a - b).abs() <= VECTOR_TOLERANCE);
    if is([x, -y, z]) {
        ": the azimuth turns clockwise"
    } else if is([y, x, z]) {
        ": the azimuth is counted from y"
    } else if is([-x, -y, -z]) {
        ": the direction in which the light travels"
    } else if is([-x, -y, z]) {
        ": the azimuth is counted from the other side"
    } else {
        ""
    }
}

pub(in super::super) fn self_test_row(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let known = |row: u32| {
            let row = usize::try_from(row).ok().and_then(|row| measurement.acquisitions.get(row));
            row.is_some_and(|row| row.geometry.is_some())
        };
        if let Some(index) = measurement.direction_tests.iter().position(|test| !known(test.row)) {
            let place = Place::path(format!("{path}/{}", name::DIRECTION_TEST_ROW)).at_index([index]);
            let row = measurement.direction_tests[index].row;
            found.add(place, row.to_string(), "a row that has a geometry");
        }
    }
}

pub(in super::super) fn self_test_missing(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements() {
        let has_geometry = measurement.acquisitions.iter().any(|row| row.geometry.is_some());
        if has_geometry && measurement.direction_tests.is_empty() {
            let place = Place::path(format!("{path}/{}", name::DIRECTION_TEST_ROW));
            found.add(place, "no self-test vectors", "some directions as unit vectors, from the source of the angles");
        }
    }
}

pub(in super::super) fn grazing(context: &Context<'_>, found: &mut Finder) {
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        let at_horizon = |row: usize| {
            let geometry = measurement.acquisitions[row].geometry;
            let grazes = geometry.is_some_and(|g| g.incidence.theta_deg() == 90.0 || g.viewing.theta_deg() == 90.0);
            grazes
                && (0..measurement.emission.len()).any(|column| !measurement.flags_at(row, column).explains_absence())
        };
        if let Some(row) = (0..measurement.acquisitions.len()).find(|row| at_horizon(*row)) {
            let place = Place::path(format!("{path}/{}", name::VALUE)).at_index([row]);
            found.add(
                place,
                "a value at 90 degrees",
                "a direction above the surface: there is no surface to see along it",
            );
        }
    }
}

pub(in super::super) fn footprint(context: &Context<'_>, found: &mut Finder) {
    let Some(document) = context.document() else { return };
    for (path, measurement) in context.measurements().filter(|(_, measurement)| measurement.role == Role::Sample) {
        let sample = measurement.sample.as_ref().and_then(|id| document.samples.iter().find(|part| part.id == *id));
        let instrument =
            measurement.instrument.as_ref().and_then(|id| document.instruments.iter().find(|part| part.id == *id));
        let extent = sample.and_then(|sample| Some(sample.width_mm?.get().min(sample.height_mm?.get())));
        let (Some(extent), Some(spot)) = (extent, instrument.and_then(Instrument::spot_mm)) else { continue };
        let footprint = |row: &Acquisition| row.geometry.map(|geometry| spot / geometry.viewing.cos_theta());
        let sizes = measurement.acquisitions.iter().enumerate().filter_map(|(row, at)| Some((row, footprint(at)?)));
        let larger: Vec<(usize, f64)> = sizes.filter(|(_, size)| *size > extent).collect();
        if let Some((row, size)) = larger.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)) {
            let place = Place::path(format!("{path}/{}", name::THETA_V)).at_index([row]);
            let what = format!("a footprint of {size:.1} mm, the largest of {} that are too large", larger.len());
            found.add(place, what, format!("at most the sample's {extent} mm"));
        }
    }
}
