//! Lights and spectra on the wavelengths of the matrix: exact averages, nothing sampled.

use super::super::light::Light;
use super::super::piecewise::{Line, tents};
use super::{Axes, Lit, NoEstimate, Seen};
use crate::quantity::QuantityKind;

/// A spectrum that was measured of the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// What its numbers are: spectral radiance, or a radiance factor.
    pub kind: QuantityKind,
    /// Wavelengths, nm, ascending.
    pub nm: Vec<f64>,
    /// Values, one per wavelength; NaN where missing.
    pub values: Vec<f64>,
    /// Standard uncertainties of these.
    pub sigma: Vec<f64>,
}

impl Lit {
    /// A light on the axes of a matrix: shared out between the excitations, so that no line of a lamp falls between two, and
    /// averaged from neighbour to neighbour at the emissions. 0 where the light has no value.
    #[must_use]
    pub fn of(light: &Light, axes: &Axes) -> Self {
        let share = |tent: &Line| light.line().integral_with(tent) / axes.width_nm;
        let average = |(tent, nm): (Line, &f64)| light.line().average_over(&tent, *nm).unwrap_or(0.0);
        Self {
            name: light.name().to_owned(),
            excitation: tents(&axes.excitation_nm).iter().map(|tent| share(tent).max(0.0)).collect(),
            emission: tents(&axes.emission_nm)
                .into_iter()
                .zip(&axes.emission_nm)
                .map(average)
                .map(|e| e.max(0.0))
                .collect(),
        }
    }
}

impl Seen {
    /// A spectrum on the axes of a matrix, in the unit of the light: a radiance factor times the light; a spectral radiance times
    /// pi where the light is a spectral irradiance, and as it is where the light is the radiance of a perfect diffuser under it.
    ///
    /// # Errors
    /// [`NoEstimate::Units`], [`NoEstimate::Length`].
    pub fn of(light: &Light, spectrum: &Spectrum, axes: &Axes) -> Result<Self, NoEstimate> {
        use QuantityKind::{RadianceFactor, SpectralIrradiance, SpectralRadiance};
        let lit = Lit::of(light, axes);
        let factor = match (spectrum.kind, light.kind()) {
            (RadianceFactor, _) => None,
            (SpectralRadiance, SpectralIrradiance) => Some(std::f64::consts::PI),
            (SpectralRadiance, SpectralRadiance) => Some(1.0),
            (found, of_light) => return Err(NoEstimate::Units { light: lit.name, found, of_light }),
        };
        for (what, found) in [("the spectrum", spectrum.values.len()), ("its uncertainty", spectrum.sigma.len())] {
            if found != spectrum.nm.len() {
                return Err(NoEstimate::Length { light: lit.name, what, found, expected: spectrum.nm.len() });
            }
        }
        let averages = averages(spectrum, axes);
        let scale = |j: usize| factor.unwrap_or(lit.emission[j]);
        let (values, sigma) =
            averages.iter().enumerate().map(|(j, (value, sigma))| (value * scale(j), sigma * scale(j))).unzip();
        Ok(Self { light: lit, values, sigma })
    }
}

/// The average of the samples from neighbour to neighbour at each emission, with the uncertainty of independent errors; NaN where no
/// value is. Samples at the wavelengths of the matrix stay as they are: an instrument's bandpass is in them already.
fn averages(spectrum: &Spectrum, axes: &Axes) -> Vec<(f64, f64)> {
    let usable: Vec<usize> = (0..spectrum.nm.len()).filter(|k| spectrum.values[*k].is_finite()).collect();
    if usable.len() < 2 {
        return vec![(f64::NAN, f64::NAN); axes.emission_nm.len()];
    }
    let nm: Vec<f64> = usable.iter().map(|k| spectrum.nm[*k]).collect();
    let cells = super::super::matrix::steps(&nm);
    let at = |(tent, centre): (Line, &f64)| {
        if !(nm[0]..=nm[nm.len() - 1]).contains(centre) {
            return (f64::NAN, f64::NAN);
        }
        let inside = |k: usize| tent.at(nm[k]).unwrap_or(0.0) * cells[k];
        let mut weights: Vec<f64> = (0..nm.len()).map(inside).collect();
        if weights.iter().filter(|weight| **weight > 0.0).count() < 2 {
            weights = between(&nm, *centre);
        }
        let whole: f64 = weights.iter().sum();
        let sum = |of: &dyn Fn(usize) -> f64| weights.iter().zip(&usable).map(|(w, k)| of(*k) * w / whole).sum::<f64>();
        let variance: f64 = weights
            .iter()
            .zip(&usable)
            .filter(|(w, _)| **w > 0.0)
            .map(|(w, k)| (spectrum.sigma[*k] * w / whole).powi(2))
            .sum();
        (sum(&|k| spectrum.values[k]), variance.sqrt())
    };
    tents(&axes.emission_nm).into_iter().zip(&axes.emission_nm).map(at).collect()
}

/// The shares of the two points around a wavelength on the straight line between them.
fn between(nm: &[f64], centre: f64) -> Vec<f64> {
    let mut weights = vec![0.0; nm.len()];
    let after = nm.partition_point(|one| *one < centre).min(nm.len() - 1);
    if nm[after] == centre || after == 0 {
        weights[after] = 1.0;
    } else {
        let part = (centre - nm[after - 1]) / (nm[after] - nm[after - 1]);
        (weights[after - 1], weights[after]) = (1.0 - part, part);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> Axes {
        let nm = |from: f64, to: f64| (0..).map(|k| from + 10.0 * f64::from(k)).take_while(|nm| *nm <= to).collect();
        Axes { excitation_nm: nm(300.0, 500.0), emission_nm: nm(400.0, 500.0), width_nm: 10.0 }
    }

    #[test]
    fn a_spectrum_in_finer_steps_gives_the_same_with_less_noise() {
        let nm: Vec<f64> = (0..401).map(|k| 300.0 + 0.5 * f64::from(k)).collect();
        let flat = |value: f64| vec![value; nm.len()];
        let light = Light::new("flat", QuantityKind::SpectralIrradiance, nm.clone(), flat(2.0), None).unwrap();
        let spectrum =
            Spectrum { kind: QuantityKind::SpectralRadiance, nm: nm.clone(), values: flat(0.3), sigma: flat(0.01) };
        let seen = Seen::of(&light, &spectrum, &axes()).unwrap();
        // Whole cells inside, half ones at both ends.
        assert!((seen.light.excitation[3] - 2.0).abs() < 1e-12 && (seen.light.excitation[0] - 1.0).abs() < 1e-12);
        for j in 1..10 {
            assert!((seen.values[j] - 0.3 * std::f64::consts::PI).abs() < 1e-12);
            // A triangle 20 samples wide to either side averages 30 of them.
            let expected = 0.01 * std::f64::consts::PI * (2.0_f64 / 60.0).sqrt();
            assert!((seen.sigma[j] / expected - 1.0).abs() < 0.02, "{} {expected}", seen.sigma[j]);
        }
        let relative = Light::new("flat", QuantityKind::RelativeSpectrum, nm.clone(), flat(2.0), None).unwrap();
        assert!(matches!(Seen::of(&relative, &spectrum, &axes()), Err(NoEstimate::Units { .. })));
        let factor = Spectrum { kind: QuantityKind::RadianceFactor, ..spectrum };
        assert!((Seen::of(&relative, &factor, &axes()).unwrap().values[4] - 0.6).abs() < 1e-12);
    }

    #[test]
    fn samples_on_the_grid_of_the_matrix_stay_as_they_are() {
        let nm: Vec<f64> = (0..31).map(|k| 400.0 + 10.0 * f64::from(k)).collect();
        let values: Vec<f64> = nm.iter().map(|nm| if *nm == 450.0 { 0.9 } else { 0.1 }).collect();
        let spectrum =
            Spectrum { kind: QuantityKind::RadianceFactor, sigma: vec![0.01; nm.len()], values: values.clone(), nm };
        let flat = Light::named("E").unwrap();
        let seen = Seen::of(&flat, &spectrum, &axes()).unwrap();
        for (j, value) in seen.values.iter().enumerate() {
            assert!((value / 100.0 - values[j]).abs() < 1e-12, "{j}: {value}");
            assert!((seen.sigma[j] / 100.0 - 0.01).abs() < 1e-12);
        }
    }

    #[test]
    fn what_was_not_measured_is_missing() {
        let light = Light::named("A").unwrap();
        let nm = vec![420.0, 440.0, 460.0];
        let spectrum =
            Spectrum { kind: QuantityKind::RadianceFactor, values: vec![0.5, f64::NAN, 0.5], sigma: vec![0.01; 3], nm };
        let seen = Seen::of(&light, &spectrum, &axes()).unwrap();
        assert!(seen.values[1].is_nan() && seen.values[7].is_nan());
        assert!(seen.values[2..=6].iter().all(|value| value.is_finite()));
    }
}
