//! What light becomes on its way from surface to surface.
//!
//! A path says where light has been, and a number says how much of it there is; what it has become depends on the materials alone. So the
//! product of spectra is made once for each order of materials that occurs, and not for each path: then a path is a number times the few
//! channels that are kept of a spectrum. The products run backwards, from the channels of the film to the lights.

use super::material::OnGrid;

/// What a surface does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Act {
    /// It emits.
    Luminescent,
    /// It reflects into all directions.
    Diffuse,
    /// Both.
    Body,
    /// It reflects at its interface.
    Specular,
}

/// How many acts there are.
const ACTS: usize = 4;

/// Most numbers that are kept for orders of materials.
const MOST_KEPT: usize = 8_000_000;

/// The constant part: spectra and channels.
#[derive(Debug, Clone)]
pub(super) struct Spectra<'a> {
    pub(super) materials: &'a [OnGrid],
    /// Spectral irradiance of each light.
    pub(super) lights: Vec<Vec<f64>>,
    /// What is kept of a spectrum: sums with these weights.
    pub(super) channels: Vec<Vec<f64>>,
    /// Whether luminescence is applied at all.
    pub(super) has_luminescence: bool,
}

/// An order of materials.
pub(super) type Way = usize;

/// The orders that have occurred.
#[derive(Debug, Clone)]
pub(super) struct Ways<'a> {
    spectra: &'a Spectra<'a>,
    /// Channels by wavelength, what a unit at each adds to each channel.
    rows: Vec<Vec<f64>>,
    /// Channels of each light.
    lit: Vec<Vec<f64>>,
    next: Vec<Vec<Option<Way>>>,
    size: usize,
}

/// The film itself, before any surface.
pub(super) const FILM: Way = 0;

impl Spectra<'_> {
    fn wavelengths(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// Rows before an act, from those after it.
    pub(super) fn before(&self, rows: &[f64], act: Act, material: usize) -> Vec<f64> {
        let count = self.wavelengths();
        let material = &self.materials[material];
        let mut all = vec![0.0; rows.len()];
        for (row, out) in rows.chunks_exact(count).zip(all.chunks_exact_mut(count)) {
            match act {
                Act::Specular => {
                    out.iter_mut().zip(row).zip(&material.intensity).for_each(|((out, row), c)| *out = row * c)
                }
                Act::Diffuse | Act::Body => {
                    out.iter_mut().zip(row).zip(&material.elastic).for_each(|((out, row), rho)| *out = row * rho);
                }
                Act::Luminescent => {}
            }
            if let Some(matrix) = material.luminescence.as_ref().filter(|_| self.has_luminescence)
                && matches!(act, Act::Luminescent | Act::Body)
            {
                for (row, emitted) in row.iter().zip(matrix.outer_iter()).filter(|(row, _)| **row != 0.0) {
                    out.iter_mut().zip(emitted).for_each(|(out, emitted)| *out += row * emitted);
                }
            }
        }
        all
    }

    /// Channels of each light through rows.
    pub(super) fn through(&self, rows: &[f64]) -> Vec<f64> {
        let sum = |row: &[f64], light: &[f64]| row.iter().zip(light).map(|(row, light)| row * light).sum::<f64>();
        let count = self.wavelengths();
        self.lights.iter().flat_map(|light| rows.chunks_exact(count).map(move |row| sum(row, light))).collect()
    }
}

impl<'a> Ways<'a> {
    pub(super) fn new(spectra: &'a Spectra<'a>) -> Self {
        let mut all = Self { spectra, rows: Vec::new(), lit: Vec::new(), next: Vec::new(), size: 0 };
        all.add(spectra.channels.concat());
        all
    }

    /// Forgets, where much is kept, all but the film. Between two paths only: what is found again is the same.
    pub(super) fn tidy(&mut self) {
        if self.size > MOST_KEPT {
            *self = Self::new(self.spectra);
        }
    }

    fn add(&mut self, rows: Vec<f64>) -> Way {
        self.size += rows.len();
        self.lit.push(self.spectra.through(&rows));
        self.rows.push(rows);
        self.next.push(vec![None; ACTS * self.spectra.materials.len()]);
        self.rows.len() - 1
    }

    /// One surface further from the film.
    pub(super) fn further(&mut self, way: Way, act: Act, material: usize) -> Way {
        let at = ACTS * material + act as usize;
        if let Some(known) = self.next[way][at] {
            return known;
        }
        let rows = self.spectra.before(&self.rows[way], act, material);
        let found = self.add(rows);
        self.next[way][at] = Some(found);
        found
    }

    /// Channels of a light that has come this way.
    pub(super) fn lit(&self, way: Way, light: usize) -> &[f64] {
        let count = self.spectra.channels.len();
        &self.lit[way][light * count..(light + 1) * count]
    }
}
