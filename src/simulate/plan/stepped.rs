//! Materials and lights in steps of the wavelength, and what follows from them alone.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::f64::consts::FRAC_1_PI;

use super::super::grid::NoGrid;
use super::super::material::OnGrid;
use super::super::picture::Prepared;
use super::super::scene::Scene;
use super::exchange::{Orders, Way};

/// What a surface does: emit, reflect into all directions, reflect at its interface.
pub(super) const ACTS: usize = 3;

/// Colours (X, Y and Z over those of white) and spectra of an act of a material under each light.
#[derive(Default)]
pub(super) struct Acts {
    pub(super) xyz: Vec<[f64; 3]>,
    pub(super) spectra: Vec<Vec<f64>>,
}

/// A scene in steps of the wavelength.
pub(super) struct Stepped {
    pub(super) prepared: Prepared,
    pub(super) lights: Vec<Vec<f64>>,
    /// \[material\]\[act\].
    acts: OnceCell<Vec<[Acts; ACTS]>>,
    /// Spectra of the ways, with luminescence on them and without.
    by_ways: [OnceCell<Vec<Vec<f64>>>; 2],
    /// Made where light may go round.
    pub(super) orders: OnceCell<Option<Orders>>,
}

impl Stepped {
    pub(super) fn new(scene: &Scene, step_nm: f64) -> Result<Self, NoGrid> {
        let prepared = Prepared::new(scene, step_nm)?;
        let lights = prepared.lights(scene);
        let by_ways = [OnceCell::new(), OnceCell::new()];
        Ok(Self { prepared, lights, acts: OnceCell::new(), by_ways, orders: OnceCell::new() })
    }

    /// X, Y and Z over those of white of what is radiated.
    pub(super) fn colour(&self, radiated: &[f64]) -> [f64; 3] {
        let sum = |c: usize| -> f64 { self.prepared.weights[c].iter().zip(radiated).map(|(a, b)| a * b).sum() };
        [0, 1, 2].map(|c| sum(c) / self.prepared.white[c])
    }

    /// The larger of a spectrum's values on either side of each of these wavelengths.
    pub(super) fn beside(&self, spectrum: &[f64], nm: &[f64]) -> Vec<f64> {
        let own = self.prepared.grid.nm();
        let near = |at: &f64| {
            let after = own.partition_point(|one| one < at);
            let ends = [after.saturating_sub(1), after.min(own.len() - 1)];
            ends.map(|k| spectrum[k].abs()).into_iter().fold(0.0, f64::max)
        };
        nm.iter().map(near).collect()
    }

    /// What each act of a material makes of each light.
    pub(super) fn acts(&self, material: usize) -> &[Acts; ACTS] {
        let make = || self.prepared.materials.iter().map(|one| self.acts_of(one)).collect();
        &self.acts.get_or_init(make)[material]
    }

    fn acts_of(&self, material: &OnGrid) -> [Acts; ACTS] {
        [0, 1, 2].map(|act| {
            let mut all = Acts::default();
            for light in &self.lights {
                let radiated = done(material, light, [0, 1, 2].map(|one| one == act));
                all.xyz.push(self.colour(&radiated));
                all.spectra.push(radiated.into_iter().map(|value| value * FRAC_1_PI).collect());
            }
            all
        })
    }

    /// The spectrum of each way as it falls in, for a share of 1.
    pub(super) fn by_ways(&self, ways: &[Way], has_luminescence: bool) -> &[Vec<f64>] {
        let make = || {
            let mut known = HashMap::new();
            ways.iter().map(|way| self.over(way.light, &way.materials, has_luminescence, &mut known)).collect()
        };
        self.by_ways[usize::from(has_luminescence)].get_or_init(make)
    }

    /// The light that has gone over these materials, the last first.
    fn over<'b>(
        &self,
        light: usize,
        materials: &'b [usize],
        has_luminescence: bool,
        known: &mut Known<'b>,
    ) -> Vec<f64> {
        let Some((last, before)) = materials.split_first() else { return self.lights[light].clone() };
        if let Some(spectrum) = known.get(&(light, materials)) {
            return spectrum.clone();
        }
        let from = self.over(light, before, has_luminescence, known);
        let spectrum = done(&self.prepared.materials[*last], &from, [has_luminescence, true, false]);
        known.insert((light, materials), spectrum.clone());
        spectrum
    }
}

/// Spectra by light and materials.
type Known<'a> = HashMap<(usize, &'a [usize]), Vec<f64>>;

/// pi times what some acts of a material make of an irradiance.
pub(super) fn done(material: &OnGrid, incident: &[f64], [emits, reflects, mirrors]: [bool; ACTS]) -> Vec<f64> {
    let mut out = vec![0.0; incident.len()];
    let mut add = |factors: &[f64]| out.iter_mut().zip(factors).zip(incident).for_each(|((out, a), e)| *out += a * e);
    if reflects {
        add(&material.elastic);
    }
    if mirrors {
        add(&material.intensity);
    }
    if let Some(matrix) = material.luminescence.as_ref().filter(|_| emits) {
        for (out, row) in out.iter_mut().zip(matrix.outer_iter()) {
            *out += row.iter().zip(incident).map(|(value, e)| value * e).sum::<f64>();
        }
    }
    out
}
