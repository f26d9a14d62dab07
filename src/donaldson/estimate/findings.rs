//! What an estimate cannot know, in words.

use super::{Axes, Estimate, UNTOLD};

/// A mean square of the numbers of the shapes beyond which they strain their prior.
const STRAINED: f64 = 1.5;
/// A spread below which the shapes of the family, and not the lights, bound it.
const NARROW: f64 = 0.15;
/// A spread of the excitation spectrum beyond which its shape counts as open.
const OPEN: f64 = 0.5;

impl Estimate {
    /// What the lights do not tell, and what contradicts the model, one sentence each.
    #[must_use]
    pub fn findings(&self, axes: &Axes) -> Vec<String> {
        let mut list = Vec::new();
        let untold: Vec<f64> =
            (0..axes.emission_nm.len()).filter(|j| !self.is_told(*j)).map(|j| axes.emission_nm[j]).collect();
        if !untold.is_empty() {
            list.push(format!(
                "the lights alone do not tell reflected light from luminescence (reflectance beyond +-{UNTOLD}) at {}: there the \
                 prior fills in",
                bands(&axes.emission_nm, &untold)
            ));
        }
        let luminescent = |i: usize| self.luminescent.row(i).iter().map(|cell| cell.best).sum::<f64>();
        let most = (0..self.excitation.len()).map(luminescent).fold(0.0, f64::max);
        let widths = (0..self.excitation.len()).filter(|i| luminescent(*i) > 0.1 * most);
        let widths: Vec<f64> = widths.map(|i| self.excitation[i].high - self.excitation[i].low).collect();
        let median = super::super::overlap::median(widths);
        if median > OPEN {
            list.push(format!(
                "the excitation spectrum stays open: its 95 % intervals are {median:.2} of its peak wide in the median; another light, or \
                 a known spectrum, narrows them"
            ));
        }
        if self.strain > STRAINED {
            list.push(format!(
                "the excitation spectra that fit lie at the edge of their prior (mean square {:.1}; usual is 1): where the true one \
                 is outside of it, the intervals do not cover it",
                self.strain
            ));
        }
        if self.shapes > 1 && median < NARROW {
            list.push(format!(
                "the intervals of the excitation spectrum ({median:.2} wide in the median) are narrower than shapes of the prior come to real \
                 ones: they do not cover 95 %; with so many lights measure it and give it"
            ));
        }
        list.extend(self.contradiction());
        if self.emission.iter().all(|interval| interval.low == 0.0) {
            list.push("no luminescence is certain: at no wavelength does what fits exclude zero".to_owned());
        }
        list
    }

    /// That the spectra contradict the model, where they do.
    #[must_use]
    pub fn contradiction(&self) -> Option<String> {
        (self.chi_square > self.count as f64).then(|| {
            format!(
                "the spectra contradict the model: chi-square {:.1} of {} values; expected fewer, and the numbers mean little. Uncertainties \
                 that are too small, lights that are not those (changed over?) or have lines that the step is too wide for, or more than \
                 one dye",
                self.chi_square, self.count
            )
        })
    }
}

/// Wavelengths as ranges of neighbours: `410, 600 to 640 nm`.
#[must_use]
pub fn bands(axis: &[f64], chosen: &[f64]) -> String {
    let place = |nm: f64| axis.iter().position(|one| *one == nm).unwrap_or(0);
    let mut runs: Vec<(f64, f64)> = Vec::new();
    for nm in chosen {
        match runs.last_mut() {
            Some(run) if place(run.1) + 1 == place(*nm) => run.1 = *nm,
            _ => runs.push((*nm, *nm)),
        }
    }
    let word = |(from, to): &(f64, f64)| if from == to { format!("{from}") } else { format!("{from} to {to}") };
    format!("{} nm", runs.iter().map(word).collect::<Vec<_>>().join(", "))
}
