//! What counts as white in a scene.

use super::grid::Grid;
use super::image::cones;
use super::scene::Scene;
use crate::donaldson::Light;
use crate::quantity::named;

/// The least answer of a cone over the greatest, below which no eye adapts to a light: daylight has .9, an incandescent lamp .3, a
/// lamp of sodium at high pressure .1; a blue diode and a lamp of low pressure have less than nothing.
const ADAPTS: f64 = 0.02;

named! {
    /// Of what light white is.
    WhiteOf, "white" {
        /// A perfect diffuser that faces all lights of the scene.
        Lights = "lights",
        /// The same under D65 of the irradiance that all lights have together at the wavelengths of the scene: where their own has no
        /// colour that an eye adapts to, as under a lamp of 365 nm.
        Daylight = "daylight",
    }
}

/// White.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct White {
    pub(super) xyz: [f64; 3],
    pub(super) of: WhiteOf,
}

impl Scene {
    /// The white of the scene, by its wavelengths.
    pub(super) fn white(&self) -> White {
        let weights = self.grid.weights(self.observer);
        let mut all = vec![0.0; self.grid.nm().len()];
        for source in &self.sources {
            all.iter_mut().zip(self.grid.spectrum(&source.light)).for_each(|(sum, e)| *sum += e);
        }
        let own = seen(&weights, &all);
        let answers = cones(own);
        let [least, most] = [f64::min, f64::max].map(|pick| answers.into_iter().reduce(pick).unwrap_or(0.0));
        if own[1] > 0.0 && least > ADAPTS * most {
            return White { xyz: own, of: WhiteOf::Lights };
        }
        let daylight = Light::named("D65").map_or_else(Vec::new, |light| self.grid.spectrum(&light));
        let scale = irradiance(&self.grid, &all) / irradiance(&self.grid, &daylight);
        White { xyz: seen(&weights, &daylight).map(|value| scale * value), of: WhiteOf::Daylight }
    }

    /// Of what light the white of the scene is.
    #[must_use]
    pub fn white_of(&self) -> WhiteOf {
        self.white().of
    }
}

fn seen(weights: &[Vec<f64>; 3], spectrum: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|c| weights[c].iter().zip(spectrum).map(|(weight, e)| weight * e).sum())
}

fn irradiance(grid: &Grid, spectrum: &[f64]) -> f64 {
    grid.widths().iter().zip(spectrum).map(|(width, e)| width * e).sum()
}
