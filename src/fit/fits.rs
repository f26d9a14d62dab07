//! The fits of a measurement's emission values, together or each by itself, and what of them a model stores.

use ndarray::{Array3, s};
use rayon::prelude::*;

use super::curvature::Share;
use super::error::DataError;
use super::joint::{FittedEffect, Joint};
use super::loss::Loss;
use super::observed::{Observations, Observed};
use super::options::{Choice, FitOptions};
use super::outcome::{Fit, Stop};
use super::profile::Interval;
use super::solve::Fitter;
use super::statistics::SINGULAR;
use crate::dataset::{Bound, FittedParameter, FittedTerm, Reduced};
use crate::quantity::Reference;
use crate::terms::{Parameter, TermKind};

/// Coverage of the stored intervals.
pub(super) const PROBABILITY: f64 = 0.95;

/// One fit of all emission values, or one of each.
#[derive(Debug)]
pub(super) struct Fits {
    pub(super) list: Vec<Observed>,
    shared_intensity: bool,
    /// True where the wavelengths of a record were taken to share its scale.
    pub(super) correlated: bool,
    /// The instrument's effects after the fit.
    pub(super) effects: Vec<FittedEffect>,
    /// The box that was searched: of the roughness in its unit, and of n - 1.
    pub(super) searched: [(f64, f64); 2],
}

impl Fits {
    pub(super) fn of(fitter: &Fitter<'_>, data: &Reduced, options: &FitOptions) -> Result<Self, DataError> {
        let bands = data.values.nrows();
        let runs: Vec<(usize, usize)> = match options.share {
            Some(_) => vec![(0, bands)],
            None => (0..bands).map(|band| (band, band + 1)).collect(),
        };
        let fit = |&(from, to): &(usize, usize)| {
            let bounds: Vec<Bound> = data
                .bounds
                .iter()
                .filter(|bound| (from..to).contains(&bound.emission))
                .map(|bound| Bound { emission: bound.emission - from, ..*bound })
                .collect();
            let observations = Observations {
                values: data.values.slice(s![from..to, ..]),
                sigma: data.sigma.as_ref().map(|sigma| sigma.slice(s![from..to, ..])),
                bounds: &bounds,
                loss: options.loss,
            };
            fitter.fit_observed(&observations, PROBABILITY)
        };
        let shared_intensity = options.share == Some(Share::ShapeAndIntensity) && bands > 1;
        let list: Vec<Observed> = match runs.as_slice() {
            [run] => vec![fit(run)?],
            runs => runs.par_iter().map(fit).collect::<Result<_, _>>()?,
        };
        let searched = fitter.bounds.map(|(low, high)| (low.exp(), high.exp()));
        Ok(Self { list, shared_intensity, correlated: false, effects: Vec::new(), searched })
    }

    /// Goes on to a joint fit where errors hang together or the instrument has effects; says whether that was called for and
    /// could not be done.
    pub(super) fn refine(
        &mut self,
        fitter: &Fitter<'_>,
        data: &Reduced,
        reference: &Reference,
        options: &FitOptions,
    ) -> Option<String> {
        let bands = data.values.nrows();
        let has_record_scale = data.record_relative.iter().any(|relative| *relative > 0.0);
        let correlated = bands > 1 && options.share.is_some() && has_record_scale;
        if options.nuisances.is_empty() && !correlated {
            return None;
        }
        let ([observed], Some(sigma)) = (self.list.as_mut_slice(), &data.sigma) else {
            let why =
                "effects of the instrument were not fitted: they need uncertainties and one fit of all wavelengths";
            return (!options.nuisances.is_empty()).then(|| why.to_owned());
        };
        if options.loss != Loss::Squares {
            return Some(
                "errors that hang together and effects of the instrument are not part of a robust fit".to_owned(),
            );
        }
        let (values, sigma) = observed.working.as_ref().map_or((&data.values, sigma), |(v, s)| (v, s));
        let joint = Joint {
            geometry: &data.geometry,
            reference,
            distribution: options.distribution,
            denominator: options.denominator,
            has_diffuse: fitter.has_diffuse(),
            share: options.share.unwrap_or_default(),
            values: values.view(),
            sigma: sigma.view(),
            record_relative: &data.record_relative,
            nuisances: &options.nuisances,
            bounds: &data.bounds,
            box_of_shape: fitter.bounds,
        };
        match joint.refine(&observed.fit) {
            Some(refined) => {
                observed.fit = refined.fit;
                observed.intervals = refined.intervals;
                self.correlated = correlated;
                self.effects = refined.effects;
                None
            }
            None if !observed.fit.has_specular() && options.nuisances.is_empty() => None,
            None => Some(
                "the joint fit found no minimum with a covariance: the fit takes the wavelengths of a record for independent \
                 and the geometry for true"
                    .to_owned(),
            ),
        }
    }

    /// The instrument's effects as a model stores them.
    pub(super) fn nuisances(&self) -> Vec<FittedParameter> {
        let stored = |effect: &FittedEffect| FittedParameter {
            name: effect.effect.name().to_owned(),
            unit: "degree".to_owned(),
            value: vec![effect.value],
            standard_uncertainty: vec![effect.sigma],
            shared_relative_uncertainty: Vec::new(),
            interval_low: Vec::new(),
            interval_high: Vec::new(),
        };
        self.effects.iter().map(stored).collect()
    }

    /// These, of a diffuse term alone, after others that saw no specular one.
    pub(super) fn after(mut self, others: &Self) -> Self {
        for (this, other) in self.list.iter_mut().zip(&others.list) {
            this.fit.specular_gain = other.fit.specular_gain;
            this.fit.evaluations = other.fit.evaluations;
        }
        self
    }

    pub(super) fn has_specular(&self) -> bool {
        self.list.iter().any(|observed| observed.fit.has_specular())
    }

    pub(super) fn converged(&self) -> bool {
        self.list.iter().all(|observed| observed.settled && observed.fit.stop.is_converged())
    }

    /// True where one fit holds one emission value, and no other fit is there.
    fn single(&self) -> bool {
        self.list.len() == 1 && self.list[0].fit.bands.len() == 1
    }

    /// Each emission value's fit, with its place in it.
    fn bands(&self) -> impl Iterator<Item = (&Observed, usize)> {
        self.list.iter().flat_map(|observed| (0..observed.fit.bands.len()).map(move |band| (observed, band)))
    }

    pub(super) fn terms(&self, data: &Reduced, choice: Choice, options: &FitOptions) -> Vec<FittedTerm> {
        let unit = data.kind.unit();
        let mut terms = Vec::new();
        if let Some(kind) = choice.diffuse {
            let parameters = vec![self.amplitude(&kind.parameters()[0], unit, data, options, 0)];
            terms.push(FittedTerm { kind, distribution: None, denominator: None, parameters });
        }
        if self.has_specular() {
            let names = TermKind::TorranceSparrow.parameters();
            let shape = |k: usize| {
                let unit = names[k].unit(Some(options.distribution));
                self.shape(&names[k], unit, k + 1)
            };
            terms.push(FittedTerm {
                kind: TermKind::TorranceSparrow,
                distribution: Some(options.distribution),
                denominator: Some(options.denominator),
                parameters: vec![self.amplitude(&names[0], unit, data, options, 1), shape(1), shape(2)],
            });
        }
        terms
    }

    /// An amplitude, one per emission value or one for all.
    fn amplitude(
        &self,
        parameter: &Parameter,
        unit: &str,
        data: &Reduced,
        options: &FitOptions,
        k: usize,
    ) -> FittedParameter {
        let all = if k == 1 && self.shared_intensity { 1 } else { usize::MAX };
        let value = |fit: &Fit, band: usize| if k == 0 { fit.bands[band].diffuse } else { fit.bands[band].intensity };
        let interval = |observed: &Observed| {
            if k == 0 { observed.intervals.diffuse } else { observed.intervals.intensity }
        };
        let each = || self.bands().take(all);
        let (interval_low, interval_high) = ends(each().map(|(observed, _)| interval(observed)));
        let values: Vec<f64> = each().map(|(observed, band)| value(&observed.fit, band)).collect();
        let shared_relative_uncertainty = shared(data, &values, options.wavelength_shift_nm);
        FittedParameter {
            name: parameter.name.to_owned(),
            unit: unit.to_owned(),
            value: values,
            standard_uncertainty: each().map(|(observed, band)| observed.fit.standard_uncertainty(band)[k]).collect(),
            shared_relative_uncertainty,
            interval_low,
            interval_high,
        }
    }

    /// Roughness (k = 2) or index (k = 3), one of each fit.
    fn shape(&self, parameter: &Parameter, unit: &str, k: usize) -> FittedParameter {
        let fits = || self.list.iter();
        let value = |fit: &Fit| if k == 2 { fit.roughness } else { fit.refractive_index() };
        let interval = |observed: &Observed| match k {
            2 => observed.intervals.roughness,
            _ => observed.intervals.index_minus_one.map(Interval::plus_one),
        };
        let (interval_low, interval_high) = ends(fits().map(interval));
        let sigma = |observed: &Observed| {
            if observed.fit.has_specular() { observed.fit.standard_uncertainty(0)[k] } else { f64::NAN }
        };
        FittedParameter {
            name: parameter.name.to_owned(),
            unit: unit.to_owned(),
            value: fits().map(|observed| value(&observed.fit)).collect(),
            standard_uncertainty: fits().map(sigma).collect(),
            shared_relative_uncertainty: Vec::new(),
            interval_low,
            interval_high,
        }
    }

    /// The covariance that is stored: of all parameters, at each emission value \[emission, parameter, parameter\]. That
    /// between two emission values is not: only what they have in common ties them.
    pub(super) fn stored_covariance(&self, choice: Choice) -> (Vec<String>, Array3<f64>) {
        let name = |kind: TermKind, k: usize| format!("{}.{}", kind.name(), kind.parameters()[k].name);
        let mut entries: Vec<(String, usize)> = choice.diffuse.map(|kind| (name(kind, 0), 0)).into_iter().collect();
        if self.has_specular() {
            entries.extend([0, 1, 2].map(|k| (name(TermKind::TorranceSparrow, k), k + 1)));
        }
        let bands: Vec<(&Observed, usize)> = self.bands().collect();
        let covariance = Array3::from_shape_fn((bands.len(), entries.len(), entries.len()), |(emission, i, j)| {
            let (fit, band) = (&bands[emission].0.fit, bands[emission].1);
            let (i, j) = (entries[i].1, entries[j].1);
            // A term that was not seen has no uncertainty of its shape.
            if i.max(j) > 0 && !fit.has_specular() { f64::NAN } else { fit.bands[band].covariance[i][j] }
        });
        (entries.into_iter().map(|entry| entry.0).collect(), covariance)
    }

    /// How it was done and why it stopped.
    pub(super) fn method(&self, options: &FitOptions) -> String {
        let cost = match options.loss {
            Loss::Squares => "least squares, weighted with 1/sigma^2 where sigma is known".to_owned(),
            loss => format!("least squares reweighted for the loss `{}`, its scale from the residuals", loss.name()),
        };
        let evaluations: usize = self.list.iter().map(|observed| observed.fit.evaluations).sum();
        let effort = options.effort.in_words();
        let passes = self.list.iter().map(|observed| observed.passes).max().unwrap_or(1);
        let passes = if passes > 1 { format!(", {passes} passes") } else { String::new() };
        let not_settled = self.list.iter().filter(|observed| !observed.settled).count();
        let unsettled = if not_settled > 0 { ", which did not settle" } else { "" };
        let correlated = if self.correlated {
            ", the wavelengths of a record sharing its scale (generalised least squares)"
        } else {
            ""
        };
        let together = match (options.share, self.list.len()) {
            (_, 1) if self.single() => "",
            (None, _) => "; each emission value by itself",
            (Some(Share::Shape), _) => "; roughness and index common to all emission values",
            (Some(Share::ShapeAndIntensity), _) => "; roughness, index and intensity common to all emission values",
        };
        format!(
            "{cost}{correlated}; amplitudes non-negative by variable projection; roughness and index from {effort}{together}; {} after {evaluations} evaluations{passes}{unsettled}{}",
            self.worst_stop().text(),
            self.singular()
        )
    }

    /// Why the fits stopped; of several the first that did not converge.
    fn worst_stop(&self) -> Stop {
        let mut stops = self.list.iter().map(|observed| observed.fit.stop);
        stops.clone().find(|stop| !stop.is_converged()).or(stops.next()).unwrap_or(Stop::Linear)
    }

    /// What decided which directions of the common parameters are called known.
    fn singular(&self) -> String {
        match self.list.as_slice() {
            [one] if !one.fit.singular_values.is_empty() => {
                let values: Vec<String> = one.fit.singular_values.iter().map(|value| format!("{value:.2e}")).collect();
                let cut = one.fit.singular_values.iter().filter(|value| **value < SINGULAR).count();
                format!(
                    "; singular values of the common columns beside all others {} (scaled), cut below {SINGULAR:.0e}: {cut}",
                    values.join(", ")
                )
            }
            _ => String::new(),
        }
    }
}

/// Lower and upper ends as they are stored, NaN for an open one; nothing where no interval was formed.
fn ends(intervals: impl Iterator<Item = Option<Interval>>) -> (Vec<f64>, Vec<f64>) {
    let intervals: Vec<Option<Interval>> = intervals.collect();
    if intervals.iter().all(Option::is_none) {
        return (Vec::new(), Vec::new());
    }
    let end = |open: bool, end: f64| if open { f64::NAN } else { end };
    let of = |interval: &Option<Interval>| {
        interval.map_or((f64::NAN, f64::NAN), |i| (end(i.low_open, i.low), end(i.high_open, i.high)))
    };
    intervals.iter().map(of).unzip()
}

/// What all rows share scales every amplitude alike: the reference's errors, and a shift of the wavelength, which moves a
/// spectrum of amplitudes by its slope. Nothing is stored where there is none.
fn shared(data: &Reduced, values: &[f64], shift_nm: f64) -> Vec<f64> {
    // One amplitude of many wavelengths has at most what the worst of them has.
    let of_reference: Vec<f64> = match (values.len(), data.shared_relative.len()) {
        (1, count) if count > 1 => vec![data.shared_relative.iter().copied().fold(0.0, f64::max)],
        _ => data.shared_relative.clone(),
    };
    let nm = data.emission.wavelengths().unwrap_or(&[]);
    let slope = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(values.len() - 1));
        if nm.len() != values.len() || before == after || values[k] == 0.0 {
            return 0.0;
        }
        (values[after] - values[before]) / (nm[after] - nm[before]) / values[k]
    };
    let all: Vec<f64> =
        of_reference.iter().enumerate().map(|(k, relative)| relative.hypot(slope(k) * shift_nm)).collect();
    if all.iter().all(|relative| *relative == 0.0) { Vec::new() } else { all }
}
