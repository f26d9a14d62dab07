//! What is asked of a fit on the command line: by `bbrf fit`, and by `bbrf cost fit`, which measures what the answer costs.

use std::path::Path;

use miette::miette;

use super::settings;
use crate::dataset::{Document, Mask, Measurement, Reduction, Role};
use crate::fit::{Effort, FitError, FitOptions, Loss, Nodes, SetError};
use crate::quantity::Reference;
use crate::terms::{Denominator, Distribution, TermKind};

/// The settings of a fit.
#[derive(Debug, Clone, clap::Args)]
pub(in crate::cli::command) struct Question {
    /// The measurement to fit; needed where a file holds several that can be
    #[arg(long)]
    pub(in crate::cli::command) measurement: Option<String>,
    /// Terms, separated by commas [default: luminescent for a luminescent factor, else lambertian,torrance-sparrow]
    #[arg(long, value_delimiter = ',')]
    terms: Vec<TermKind>,
    /// Form of D: gaussian-half-height, gaussian, torrance-sparrow-1967, gaussian-normalised, beckmann, trowbridge-reitz
    #[arg(long, default_value = Distribution::GaussianHalfHeight.name())]
    distribution: Distribution,
    /// Denominator of the specular term: cos-theta-i, cos-theta-v, cos-i-cos-v
    #[arg(long, default_value = Denominator::CosThetaI.name())]
    denominator: Denominator,
    /// How a spectrum becomes the fitted number: auto, band:FROM-TO (nm), luminance, none (every wavelength)
    #[arg(long, default_value = "auto")]
    pub(super) reduce: Reduction,
    /// What wavelengths that are fitted one by one have in common: shape (roughness and index), shape-and-intensity, nothing
    #[arg(long, default_value = "shape", value_parser = settings::share)]
    share: settings::Sharing,
    /// What a residual costs: squares, huber (outliers pull little), tukey (outliers do not pull)
    #[arg(long, default_value = "squares", value_parser = settings::loss)]
    loss: Loss,
    /// Bounds as roughness=LOW..HIGH (unit of the distribution) or refractive_index=LOW..HIGH; repeat for both
    #[arg(long, value_parser = settings::bounds)]
    bounds: Vec<settings::Bounds>,
    /// Nodes of the starting grid in roughness x index, and how many of them are polished; fewer may miss the minimum
    #[arg(long, default_value_t = Effort::default().nodes(), value_name = "RxNxS")]
    nodes: Nodes,
    /// A polish ends where chi-square would fall by less than this share of itself per degree of freedom
    #[arg(long, default_value_t = Effort::default().tolerance, value_parser = settings::tolerance)]
    tolerance: f64,
    /// Leave rows out: theta-i>DEGREES, theta-v>DEGREES, half-angle>DEGREES, rows:FIRST-LAST (from 0), by commas
    #[arg(long, default_value = "")]
    mask: Mask,
    /// An effect of the instrument as NAME=VALUE (known) or NAME=VALUE,SIGMA (fitted with that prior): incidence-offset,
    /// viewing-offset, source-size, aperture in degrees, wavelength-shift in nm; repeat for several
    #[arg(long, value_parser = settings::nuisance)]
    nuisance: Vec<settings::Nuisance>,
    /// Reference to assume where the file states none: same-geometry, fixed-geometry(THETA_I,THETA_V), none
    #[arg(long)]
    pub(super) reference: Option<Reference>,
}

impl Question {
    /// The same for the library; `digest` is that of the measurement.
    pub(in crate::cli::command) fn options(&self, digest: String) -> FitOptions {
        FitOptions {
            terms: self.terms.clone(),
            distribution: self.distribution,
            denominator: self.denominator,
            reduction: self.reduce,
            share: self.share.0,
            loss: self.loss,
            roughness_box: settings::within(&self.bounds, "roughness"),
            index_box: settings::within(&self.bounds, "refractive_index"),
            effort: Effort::of(self.nodes, self.tolerance),
            mask: self.mask.clone(),
            nuisances: self.nuisance.iter().filter_map(settings::Nuisance::of_geometry).collect(),
            wavelength_shift_nm: settings::wavelength_shift(&self.nuisance),
            assume_reference: self.reference,
            data_digest: digest,
        }
    }

    /// The words that ask a command the same. What is usual is left out, and what the rungs of a ladder say: effort and reduction.
    pub(in crate::cli::command) fn words(&self) -> Vec<String> {
        let usual = FitOptions::default();
        let mut words = Vec::new();
        let mut say = |option: &str, value: String| words.extend([format!("--{option}"), value]);
        self.measurement.iter().for_each(|id| say("measurement", id.clone()));
        if !self.terms.is_empty() {
            say("terms", self.terms.iter().map(ToString::to_string).collect::<Vec<_>>().join(","));
        }
        if self.distribution != usual.distribution {
            say("distribution", self.distribution.to_string());
        }
        if self.denominator != usual.denominator {
            say("denominator", self.denominator.to_string());
        }
        if self.share.0 != usual.share {
            say("share", self.share.to_string());
        }
        if self.loss != usual.loss {
            say("loss", self.loss.name().to_owned());
        }
        self.bounds.iter().for_each(|bounds| say("bounds", bounds.to_string()));
        if !self.mask.is_empty() {
            say("mask", self.mask.to_string());
        }
        self.nuisance.iter().for_each(|nuisance| say("nuisance", nuisance.to_string()));
        self.reference.iter().for_each(|reference| say("reference", reference.to_string()));
        words
    }

    /// The measurement asked for, or the one that can be meant: a factor of a sample before a radiance.
    pub(in crate::cli::command) fn choose<'a>(
        &self,
        document: &'a Document,
        file: &Path,
    ) -> Result<&'a Measurement, miette::Report> {
        let ids = || document.measurements.iter().map(|m| m.id.to_string()).collect::<Vec<_>>().join(", ");
        if let Some(id) = &self.measurement {
            return document
                .measurement(id)
                .ok_or_else(|| miette!("{}: no measurement `{id}`; the file holds: {}", file.display(), ids()));
        }
        let samples: Vec<&Measurement> = document.measurements.iter().filter(|m| m.role == Role::Sample).collect();
        let factors: Vec<&Measurement> = samples.iter().copied().filter(|m| m.quantity.kind.is_factor()).collect();
        match (factors.as_slice(), samples.as_slice()) {
            ([one], _) | ([], [one]) => Ok(one),
            ([], []) => Err(miette!("{}: no measurement of a sample; the file holds: {}", file.display(), ids())),
            _ => Err(miette!(
                "{}: several measurements can be fitted ({}); name one with --measurement",
                file.display(),
                ids()
            )),
        }
    }
}

/// How the call can be mended where the error alone does not say.
pub(in crate::cli::command) fn hint(error: &FitError) -> &'static str {
    match error {
        FitError::Geometry { source: SetError::Reference(_), .. } => {
            ", in the file, or pass it as --reference (it is recorded as an assumption)"
        }
        _ => "",
    }
}
