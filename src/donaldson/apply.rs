//! How a surface is applied to a light: exact integrals, and sums over the observers.

use super::colour::{Colour, Observer, VISIBLE_NM};
use super::light::{Extend, Light};
use super::piecewise::Line;
use super::predict::{Prediction, Sums, Visible};
use super::reradiation::Reradiation;
use super::unlit::unlit;

impl Reradiation {
    /// What the surface radiates under a light.
    #[must_use]
    pub fn under(&self, light: &Light, extend: Extend) -> Prediction {
        let flat = || {
            let (low, high) = self.needed_nm();
            light.extended(low, high)
        };
        let mut prediction = match extend {
            Extend::Zero => self.lit(light),
            Extend::Flat => self.lit(&flat()),
        };
        prediction.unlit = unlit(self, light, &flat());
        prediction
    }

    /// The wavelengths at which light has an effect that shows, nm.
    pub(super) fn needed_nm(&self) -> (f64, f64) {
        let ends = |nm: &[f64]| (nm[0], nm[nm.len() - 1]);
        let (excitation, emission) = (ends(&self.excitation_nm), ends(&self.emission_nm));
        let (from, to) = (VISIBLE_NM.0 as f64, VISIBLE_NM.1 as f64);
        (excitation.0.min(emission.0).min(from), excitation.1.max(emission.1).max(to))
    }

    /// The irradiance that each excitation takes part in: a spectrum shared out between the centres, nothing lost and nothing twice.
    #[must_use]
    pub fn shares(&self, light: &Light) -> Vec<f64> {
        light.shares(&self.excitation_nm)
    }

    /// Under a light as it is, 0 where it has no value.
    pub(super) fn lit(&self, light: &Light) -> Prediction {
        let shares = self.shares(light);
        let columns = self.emission_nm.len();
        let irradiance = self.seen(light);
        let elastic: Vec<f64> = self.elastic.iter().zip(&irradiance).map(|(factor, e)| factor * e).collect();
        let luminescent = self.luminescent(&shares);
        let unit = |j: usize, size: f64| {
            let mut weights = vec![0.0; columns];
            weights[j] = size;
            weights
        };
        let nothing = vec![0.0; columns];
        let sigma = |elastic: &[f64], emission: &[f64]| self.variance(elastic, &shares, emission).sqrt();
        let visible = self.visible(light, &luminescent);
        Prediction {
            light: light.name().to_owned(),
            kind: light.kind(),
            emission_nm: self.emission_nm.clone(),
            elastic_sigma: (0..columns).map(|j| irradiance[j] * self.elastic_sigma[j]).collect(),
            luminescent_sigma: (0..columns).map(|j| sigma(&nothing, &unit(j, 1.0))).collect(),
            total_sigma: (0..columns).map(|j| sigma(&unit(j, irradiance[j]), &unit(j, 1.0))).collect(),
            sums: Observer::ALL.iter().map(|one| (*one, self.sums(*one, &visible, &shares))).collect(),
            irradiance,
            elastic,
            luminescent,
            visible,
            unlit: Vec::new(),
        }
    }

    /// The luminescence of each emission from the irradiance that each excitation takes part in.
    pub(super) fn luminescent(&self, shares: &[f64]) -> Vec<f64> {
        let column = |j: usize| shares.iter().enumerate().map(|(i, share)| share * self.density[(i, j)]).sum();
        (0..self.emission_nm.len()).map(column).collect()
    }

    /// The light as an instrument of the emission's bandpass sees it, or, where that is unstated, shared out between the centres.
    pub(super) fn seen(&self, light: &Light) -> Vec<f64> {
        let window = |j: usize| {
            let nm = self.emission_nm[j];
            match &self.emission_fwhm_nm {
                Some(fwhm) => Line::triangle(nm - fwhm[j], nm, nm + fwhm[j]),
                None => {
                    let last = self.emission_nm.len() - 1;
                    Line::triangle(self.emission_nm[j.saturating_sub(1)], nm, self.emission_nm[(j + 1).min(last)])
                }
            }
        };
        let average = |j: usize| light.line().average_over(&window(j), self.emission_nm[j]).unwrap_or(0.0);
        (0..self.emission_nm.len()).map(average).collect()
    }

    /// At every nanometre: the light as [`per_nanometre`] has it, the elastic factor straight between its wavelengths and level
    /// outside them (CIE 15:2018, 7.2.3), the luminescence straight between its wavelengths and 0 outside.
    fn visible(&self, light: &Light, luminescent: &[f64]) -> Visible {
        let nm: Vec<f64> = (VISIBLE_NM.0..=VISIBLE_NM.1).map(|nm| nm as f64).collect();
        let irradiance = per_nanometre(light, &nm);
        let luminescence = Line::new(self.emission_nm.clone(), luminescent.to_vec());
        let factor = |nm: f64| {
            let (_, line) = self.elastic_line()?;
            let (low, high) = line.range();
            line.at(nm.clamp(low, high))
        };
        let elastic = nm.iter().zip(&irradiance).map(|(nm, e)| factor(*nm).unwrap_or(f64::NAN) * e).collect();
        let luminescent = nm.iter().map(|nm| luminescence.at(*nm).unwrap_or(0.0)).collect();
        Visible { nm, irradiance, elastic, luminescent }
    }

    /// Sums over the colour-matching functions, Y of white being 100.
    fn sums(&self, observer: Observer, visible: &Visible, shares: &[f64]) -> Option<Sums> {
        let matching: Vec<[f64; 3]> = visible.nm.iter().map(|nm| observer.matching(*nm as usize)).collect();
        let sum = |spectrum: &[f64]| {
            [0, 1, 2].map(|c| matching.iter().zip(spectrum).map(|(matching, value)| matching[c] * value).sum::<f64>())
        };
        let white = sum(&visible.irradiance);
        let scale = 100.0 / white[1];
        if !(white[1] > 0.0 && scale.is_finite()) {
            return None;
        }
        let (elastic, luminescent) = (sum(&visible.elastic), sum(&visible.luminescent));
        let xyz = [0, 1, 2].map(|c| scale * (elastic[c] + luminescent[c]));
        if xyz.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let weights = self.weights(visible, &matching, scale);
        let variance = |sign: f64, k: usize, l: usize| {
            let with = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + sign * b).collect::<Vec<f64>>();
            let ((e, m), (other_e, other_m)) = (&weights[k], &weights[l]);
            self.variance(&with(e, other_e), shares, &with(m, other_m))
        };
        let covariance = |k: usize, l: usize| (variance(1.0, k, l) - variance(-1.0, k, l)) / 4.0;
        let covariance = [0, 1, 2].map(|k| [0, 1, 2].map(|l| covariance(k, l)));
        Some(Sums { colour: Colour { observer, xyz, white: white.map(|value| scale * value) }, covariance })
    }

    /// For each of X, Y and Z: how much of it a unit of each elastic value makes, and one of each emission's luminescence.
    fn weights(&self, visible: &Visible, matching: &[[f64; 3]], scale: f64) -> [(Vec<f64>, Vec<f64>); 3] {
        let columns = self.emission_nm.len();
        let elastic = self.elastic_line().map(|(known, line)| (known, line.nm().to_vec()));
        [0, 1, 2].map(|c| {
            let (mut of_elastic, mut of_emission) = (vec![0.0; columns], vec![0.0; columns]);
            for ((nm, e), matching) in visible.nm.iter().zip(&visible.irradiance).zip(matching) {
                let weight = scale * matching[c];
                for (j, part) in between(&self.emission_nm, *nm, false) {
                    of_emission[j] += weight * part;
                }
                if let Some((known, nodes)) = &elastic {
                    for (j, part) in between(nodes, *nm, true) {
                        of_elastic[known[j]] += weight * e * part;
                    }
                }
            }
            (of_elastic, of_emission)
        })
    }
}

/// The light at whole nanometres. One given at whole nanometres is taken there: the sum is then its integral. Any other is averaged
/// over a nanometre to either side, which keeps its energy, however narrow its lines are.
fn per_nanometre(light: &Light, nm: &[f64]) -> Vec<f64> {
    let is_whole = light.nm().iter().all(|nm| nm.fract() == 0.0);
    let at = |nm: f64| match is_whole {
        true => light.line().at(nm),
        false => light.line().average_over(&Line::triangle(nm - 1.0, nm, nm + 1.0), nm),
    };
    nm.iter().map(|nm| at(*nm).unwrap_or(0.0)).collect()
}

/// The points that a wavelength lies between, with the part that each has of it; outside them the nearest, if `level`, or none.
fn between(points: &[f64], nm: f64, level: bool) -> Vec<(usize, f64)> {
    let last = points.len() - 1;
    if nm <= points[0] || nm >= points[last] {
        let nearest = if nm <= points[0] { 0 } else { last };
        return if level || nm == points[nearest] { vec![(nearest, 1.0)] } else { Vec::new() };
    }
    let after = points.partition_point(|point| *point <= nm);
    let part = (nm - points[after - 1]) / (points[after] - points[after - 1]);
    vec![(after - 1, 1.0 - part), (after, part)]
}
