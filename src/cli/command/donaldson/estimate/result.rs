//! What `bbrf donaldson estimate` prints.

use schemars::JsonSchema;
use serde::Serialize;

use crate::donaldson::estimate::{Axes, Estimate, Helpful, Interval, Range, bands};

/// What `--json` prints. Intervals are of 95 %, prior included.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct EstimateResult {
    /// The id of the matrix.
    measurement: String,
    /// The file written, with `-o`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) file: Option<String>,
    /// The lights.
    lights: Vec<String>,
    /// True where the excitation spectrum was given.
    excitation_is_known: bool,
    /// Excitation spectra that the intervals are over; 1 where it was given.
    excitation_spectra: usize,
    /// Excitation wavelengths, nm.
    excitation_nm: Vec<f64>,
    /// Emission wavelengths, nm.
    emission_nm: Vec<f64>,
    /// Excitation spectrum, 1 at its peak, one per excitation.
    excitation: Vec<IntervalResult>,
    /// Reflectance, one per emission.
    reflectance: Vec<IntervalResult>,
    /// Emission spectrum: the matrix where the excitation spectrum is 1, one per emission.
    emission: Vec<IntervalResult>,
    /// Luminescent matrix, one list per excitation.
    luminescent: Vec<Vec<IntervalResult>>,
    /// What each emission wavelength radiates.
    ranges: Vec<Range>,
    /// Standard uncertainty of the reflectance from the lights alone, one per emission; `null` where they cannot tell.
    lights_alone: Vec<Option<f64>>,
    /// True where the lights tell reflected light from luminescence without the prior.
    told: Vec<bool>,
    /// Weighted sum of squares that the best leaves.
    chi_square: f64,
    /// How many values it sums over.
    count: usize,
    /// What is taken for granted.
    prior: String,
    /// What cannot be known, and what contradicts the model.
    findings: Vec<String>,
    /// Standard uncertainty of the reflectance, root mean square over the wavelengths, prior included, for this excitation spectrum.
    reflectance_standard_uncertainty: f64,
    /// The same with one more light, the best first.
    further_lights: Vec<HelpfulResult>,
}

/// The best and a 95 % interval.
#[derive(Debug, Serialize, JsonSchema)]
struct IntervalResult {
    best: f64,
    low: f64,
    high: f64,
}

/// What a further light would give.
#[derive(Debug, Serialize, JsonSchema)]
struct HelpfulResult {
    light: String,
    reflectance_standard_uncertainty: f64,
}

impl From<&Interval> for IntervalResult {
    fn from(interval: &Interval) -> Self {
        Self { best: interval.best, low: interval.low, high: interval.high }
    }
}

impl EstimateResult {
    pub(super) fn new(
        id: &str,
        lights: &[String],
        axes: &Axes,
        found: &Estimate,
        is_known: bool,
        (helpful, now): (&[Helpful], f64),
    ) -> Self {
        let list = |intervals: &[Interval]| intervals.iter().map(IntervalResult::from).collect::<Vec<_>>();
        Self {
            measurement: id.to_owned(),
            file: None,
            lights: lights.to_vec(),
            excitation_is_known: is_known,
            excitation_spectra: found.shapes,
            excitation_nm: axes.excitation_nm.clone(),
            emission_nm: axes.emission_nm.clone(),
            excitation: list(&found.excitation),
            reflectance: list(&found.reflectance),
            emission: list(&found.emission),
            luminescent: found.luminescent.rows().into_iter().map(|row| row.iter().map(Into::into).collect()).collect(),
            ranges: found.ranges.clone(),
            lights_alone: found.lights_alone.iter().map(|x| x.is_finite().then_some(*x)).collect(),
            told: (0..axes.emission_nm.len()).map(|j| found.is_told(j)).collect(),
            chi_square: found.chi_square,
            count: found.count,
            prior: found.prior.clone(),
            findings: found.findings(axes),
            reflectance_standard_uncertainty: now,
            further_lights: helpful
                .iter()
                .map(|one| HelpfulResult {
                    light: one.name.clone(),
                    reflectance_standard_uncertainty: one.reflectance_sigma,
                })
                .collect(),
        }
    }

    pub(super) fn text(&self) -> String {
        let ends = |nm: &[f64]| format!("{} to {} nm", nm[0], nm[nm.len() - 1]);
        let mut lines = vec![format!(
            "{}: estimated from spectra under {}; excitation {}, emission {}",
            self.measurement,
            self.lights.join(", "),
            ends(&self.excitation_nm),
            ends(&self.emission_nm)
        )];
        if !self.excitation_is_known {
            lines.push(format!(
                "  excitation spectrum unknown: the intervals are over {} that fit",
                self.excitation_spectra
            ));
        }
        for range in [Range::ReflectionOnly, Range::Mixed, Range::Open] {
            let chosen = (0..self.ranges.len()).filter(|j| self.ranges[*j] == range);
            let chosen: Vec<f64> = chosen.map(|j| self.emission_nm[j]).collect();
            let what = match range {
                Range::ReflectionOnly => "reflected light alone",
                Range::Mixed => "reflected light and luminescence",
                Range::Open => "luminescence possible, not certain",
            };
            if !chosen.is_empty() {
                lines.push(format!("  {what}: {}", bands(&self.emission_nm, &chosen)));
            }
        }
        let peak = |list: &[IntervalResult]| (0..list.len()).max_by(|a, b| list[*a].best.total_cmp(&list[*b].best));
        if let Some(k) = peak(&self.emission) {
            let IntervalResult { best, low, high } = &self.emission[k];
            lines.push(format!(
                "  emission peaks at {} nm: {best:.4} ({low:.4} to {high:.4}) per 1 of the excitation",
                self.emission_nm[k]
            ));
        }
        if let Some(k) = peak(&self.excitation) {
            lines.push(format!("  excited most at {} nm", self.excitation_nm[k]));
        }
        let width = |one: &IntervalResult| one.high - one.low;
        if let Some(k) = (0..self.reflectance.len())
            .max_by(|a, b| width(&self.reflectance[*a]).total_cmp(&width(&self.reflectance[*b])))
        {
            let IntervalResult { best, low, high } = &self.reflectance[k];
            lines.push(format!(
                "  reflectance is known least at {} nm: {best:.3} ({low:.3} to {high:.3})",
                self.emission_nm[k]
            ));
        }
        lines.extend(self.findings.iter().map(|finding| format!("  {finding}")));
        if let [first, ..] = self.further_lights.as_slice() {
            lines.push(format!(
                "  one more light that would help most: {} (reflectance to +-{:.4}; now +-{:.4}, root mean square, for the best excitation spectrum)",
                first.light, first.reflectance_standard_uncertainty, self.reflectance_standard_uncertainty
            ));
        }
        lines.push(format!("  prior: {}", self.prior));
        lines.extend(self.file.iter().map(|file| format!("wrote {file}")));
        lines.join("\n")
    }
}
