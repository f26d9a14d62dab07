//! Viewing directions as a quadrature: which incidences of a measurement were looked at from enough of the hemisphere.
//!
//! With x = sin(theta) cos(phi) and y = sin(theta) sin(phi), cos(theta) d(omega) is dx dy: an albedo is the mean of pi
//! times the BRDF over the unit disk. Points that fill the disk evenly each take the value of the nearest direction.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::dataset::{Measurement, Symmetry};

/// So many points stand for the disk.
const POINTS: usize = 400;
/// A point without a direction this near, in radii of the disk, is not sampled.
const NEAR: f64 = 0.3;
/// So many near directions are kept for each point, should the values of some be missing.
const KEPT: usize = 4;
/// With fewer directions nothing is said.
const FEWEST: usize = 16;

/// One incidence with the rows that are nearest to each point of the disk, nearest first.
pub(super) struct Cells {
    /// Its first row.
    pub(super) row: usize,
    /// For each point the rows.
    pub(super) nearest: Vec<Vec<usize>>,
}

/// Points that fill the unit disk evenly: a sunflower.
fn disk() -> impl Iterator<Item = [f64; 2]> {
    let golden = TAU * 0.618_033_988_749_895;
    (0..POINTS).map(move |k| {
        let radius = ((k as f64 + 0.5) / POINTS as f64).sqrt();
        let (sin, cos) = (golden * k as f64).sin_cos();
        [radius * cos, radius * sin]
    })
}

/// Viewing directions of one incidence as points of the disk, each with its row; turned so that light comes from phi = 0.
fn viewed(measurement: &Measurement, rows: &[usize], symmetry: Option<Symmetry>) -> Vec<([f64; 2], usize)> {
    let mut points = Vec::new();
    for row in rows {
        let Some(geometry) = &measurement.acquisitions[*row].geometry else { continue };
        let azimuth = (geometry.viewing.phi_deg() - geometry.incidence.phi_deg()).to_radians();
        let (x, y) = (geometry.viewing.sin_theta() * azimuth.cos(), geometry.viewing.sin_theta() * azimuth.sin());
        points.push(([x, y], *row));
        let in_mirror = match symmetry {
            Some(Symmetry::Isotropic) => true,
            Some(Symmetry::Mirror) => geometry.incidence.sin_theta() * geometry.incidence.unit_vector()[1].abs() < 1e-9,
            Some(Symmetry::None) | None => false,
        };
        if in_mirror {
            points.push(([x, -y], *row));
        }
    }
    points
}

/// The rows near each point, or `None` where a point has none.
fn nearest(points: &[([f64; 2], usize)]) -> Option<Vec<Vec<usize>>> {
    disk()
        .map(|[x, y]| {
            let mut near: Vec<(f64, usize)> = points
                .iter()
                .map(|([px, py], row)| ((px - x).hypot(py - y), *row))
                .filter(|(distance, _)| *distance < NEAR)
                .collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            near.dedup_by_key(|(_, row)| *row);
            near.truncate(KEPT);
            (!near.is_empty()).then(|| near.into_iter().map(|(_, row)| row).collect())
        })
        .collect()
}

/// Every incidence (under one excitation) whose viewing directions fill the hemisphere, or half of it where the sample
/// is declared symmetric.
pub(super) fn cells(measurement: &Measurement, symmetry: Option<Symmetry>) -> Vec<Cells> {
    let mut by_incidence: BTreeMap<(Option<u32>, [u64; 2]), Vec<usize>> = BTreeMap::new();
    for (row, acquisition) in measurement.acquisitions.iter().enumerate() {
        let Some(geometry) = acquisition.geometry else { continue };
        let (theta, phi) = (geometry.incidence.theta_deg(), geometry.incidence.phi_deg());
        if geometry.incidence.cos_theta() > 0.0 {
            by_incidence.entry((acquisition.excitation, [theta.to_bits(), phi.to_bits()])).or_default().push(row);
        }
    }
    let full = by_incidence.into_values().filter(|rows| rows.len() >= FEWEST);
    full.filter_map(|rows| {
        let nearest = nearest(&viewed(measurement, &rows, symmetry))?;
        Some(Cells { row: *rows.first()?, nearest })
    })
    .collect()
}
