//! Grids of geometries, planned or offered for choice.

use std::str::FromStr;

use crate::quantity::{Geometry, SignHabit};

/// Directions that are equal to within this many degrees are one.
const SAME: f64 = 1e-9;
/// More geometries than any scan has.
const MOST: usize = 4_000_000;

/// A grid in steps of the polar angles: `step=5,max=85`, and with `azimuths=N` N relative azimuths from 0 to 180 degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CandidateGrid {
    /// Step of both polar angles, degrees.
    pub step: f64,
    /// Largest polar angle, degrees.
    pub max: f64,
    /// Number of relative azimuths from 0 to 180 degrees; 2 are the plane of incidence.
    pub azimuths: usize,
}

/// A text that is no grid.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is no grid; expected `step=DEGREES,max=DEGREES` with 0 < step and max up to 90, and for other planes \
     `,azimuths=N` with N of at least 2 (at most {MOST} geometries)"
)]
pub struct UnknownGrid(pub String);

impl FromStr for CandidateGrid {
    type Err = UnknownGrid;

    fn from_str(text: &str) -> Result<Self, UnknownGrid> {
        let refuse = || UnknownGrid(text.to_owned());
        let (mut step, mut max, mut azimuths) = (None, None, 2);
        for part in text.split(',') {
            let (key, value) = part.split_once('=').ok_or_else(refuse)?;
            let number = || value.trim().parse::<f64>().map_err(|_| refuse());
            match key.trim() {
                "step" => step = Some(number()?),
                "max" => max = Some(number()?),
                "azimuths" => azimuths = value.trim().parse().map_err(|_| refuse())?,
                _ => return Err(refuse()),
            }
        }
        let (Some(step), Some(max)) = (step, max) else { return Err(refuse()) };
        let steps = max / step;
        let fine = step > 0.0 && (0.0..=90.0).contains(&max) && azimuths >= 2 && steps.is_finite();
        let count = (steps + 1.0).powi(2) * azimuths as f64;
        if fine && count <= MOST as f64 { Ok(Self { step, max, azimuths }) } else { Err(refuse()) }
    }
}

impl CandidateGrid {
    fn polars(&self) -> Vec<f64> {
        let last = (self.max / self.step + SAME).floor() as usize;
        (0..=last).map(|k| (k as f64 * self.step).min(90.0)).collect()
    }

    /// Every geometry of the grid, each once: light comes from one side, for the terms know no azimuth of their own.
    /// Directions closer than `retro_gap` degrees to the source are left out; of a gap of 0, none.
    #[must_use]
    pub fn geometries(&self, retro_gap: f64) -> Vec<Geometry> {
        let mut list = Vec::new();
        for theta_i in self.polars() {
            for theta_v in self.polars() {
                // Along the normal all azimuths are one.
                let one = theta_i == 0.0 || theta_v == 0.0;
                for k in 0..if one { 1 } else { self.azimuths } {
                    let phi_v = 180.0 * k as f64 / (self.azimuths - 1) as f64;
                    list.extend(Geometry::from_degrees(theta_i, 180.0, theta_v, phi_v));
                }
            }
        }
        list.retain(|geometry| is_free(geometry, retro_gap));
        list
    }
}

/// The paper's scan: signed angles of incidence and viewing from -max to max in steps, without what the source blocks.
#[must_use]
pub fn in_plane_grid(grid: &CandidateGrid, retro_gap: f64) -> Vec<Geometry> {
    let polars = grid.polars();
    let signed = || polars.iter().skip(1).rev().map(|theta| -theta).chain(polars.iter().copied());
    let pairs = signed().flat_map(|i| signed().map(move |v| (i, v)));
    let all = pairs.filter_map(|(i, v)| Geometry::from_signed(i, v, SignHabit::MirrorAtEqual).ok());
    all.filter(|geometry| is_free(geometry, retro_gap)).collect()
}

/// True where the detector is not before the source; at exactly the gap it passes, as in the paper's steps of 10 degrees.
fn is_free(geometry: &Geometry, retro_gap: f64) -> bool {
    !(retro_gap > 0.0 && geometry.is_retro(retro_gap - SAME))
}

/// True for two geometries that no term tells apart: polar angles and relative azimuth are the same.
pub(super) fn is_same(a: &Geometry, b: &Geometry) -> bool {
    let near = |x: f64, y: f64| (x - y).abs() < SAME;
    let azimuth = |geometry: &Geometry| {
        let difference = (geometry.incidence.phi_deg() - geometry.viewing.phi_deg()).rem_euclid(360.0);
        difference.min(360.0 - difference)
    };
    let normal = |geometry: &Geometry| geometry.incidence.theta_deg() == 0.0 || geometry.viewing.theta_deg() == 0.0;
    near(a.incidence.theta_deg(), b.incidence.theta_deg())
        && near(a.viewing.theta_deg(), b.viewing.theta_deg())
        && (normal(a) || near(azimuth(a), azimuth(b)))
}
