//! The ladder of a fit: less search and coarser ends, on the user's own scan.

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::Patience;
use crate::dataset::{Document, Measurement, Model, Reduction};
use crate::fit::{Effort, FitError, FitOptions, fit_measurement};
use crate::quantity::EmissionAxis;

/// Searches and goes down further than any rung; the rung of the same nodes ends at the usual tolerance.
const REFERENCE: Effort = Effort { roughness_nodes: 48, index_nodes: 9, starts: 4, tolerance: 1e-14 };
/// Nodes at the usual tolerance: roughness, index, polished starts.
const NODES: [(usize, usize, usize); 7] =
    [(1, 1, 1), (2, 1, 1), (4, 1, 1), (8, 1, 1), (8, 3, 2), (24, 5, 2), (48, 9, 4)];
/// Tolerances at the usual nodes, the usual one among them.
const TOLERANCES: [f64; 7] = [1e6, 1e2, 1.0, 1e-2, 1e-4, 1e-8, 1e-14];
/// Few nodes and a coarse end together.
const BOTH: [(usize, usize, usize, f64); 3] = [(2, 1, 1, 1e-2), (4, 1, 1, 1e-2), (8, 1, 1, 1e-2)];

/// One setting of a fit.
struct Setting {
    name: String,
    knob: &'static str,
    options: Vec<String>,
    asked: FitOptions,
}

/// What less work costs in a fit with these options: their terms and all else stay, their effort is turned. Where every wavelength is
/// fitted (`--reduce none`) bands are rungs, too, of which roughness and index are judged.
///
/// # Errors
/// [`FitError`] where the fit itself is not possible.
pub fn fit_ladder(
    document: &Document,
    measurement: &Measurement,
    options: &FitOptions,
    patience: Patience,
) -> Result<Ladder, FitError> {
    let asked = |effort: Effort| FitOptions { effort, ..options.clone() };
    let reference = fit_measurement(document, measurement, &asked(REFERENCE))?;
    let mut candidates = Vec::new();
    for setting in settings(measurement, options) {
        // What a reduction cannot do on these data is no rung.
        let Ok(model) = fit_measurement(document, measurement, &setting.asked) else { continue };
        let distance = parameter_distance(&model, &reference);
        let is_same = model.reduction == reference.reduction;
        let asked = setting.asked;
        candidates.push(Candidate {
            name: setting.name,
            knob: setting.knob.to_owned(),
            options: setting.options,
            error: distance,
            second_error: if is_same { chi_square_gap(&model, &reference) } else { None },
            bytes: None,
            note: note(&model, distance, is_same),
            work: Box::new(move || {
                std::hint::black_box(fit_measurement(document, measurement, &asked).is_ok());
            }),
            times: 1.0,
            read: None,
        });
    }
    let meaning = Meaning {
        reference: format!(
            "the fit of the same numbers with {} nodes and a tolerance of {:e}",
            REFERENCE.nodes(),
            REFERENCE.tolerance
        ),
        error: "largest distance of a parameter from the reference fit, in its standard uncertainty there".to_owned(),
        axis: "largest distance of a parameter (standard uncertainty)".to_owned(),
        second_error: Some(
            "chi-square above that of the reference fit, in units of the reference's chi-square per degree of freedom"
                .to_owned(),
        ),
        time: "seconds of one fit, with its reduction and its intervals".to_owned(),
        read_time: None,
    };
    let subject = format!("{} ({} rows)", measurement.id, measurement.acquisitions.len());
    Ok(measured(Task::Fit, subject, meaning, candidates, patience))
}

fn settings(measurement: &Measurement, options: &FitOptions) -> Vec<Setting> {
    let usual = Effort::default();
    let setting = |name: String, knob: &'static str, effort: Effort| Setting {
        name,
        knob,
        options: [reduction_options(options.reduction), effort_options(effort)].concat(),
        asked: FitOptions { effort, ..options.clone() },
    };
    let at = |(roughness_nodes, index_nodes, starts): (usize, usize, usize), tolerance: f64| Effort {
        roughness_nodes,
        index_nodes,
        starts,
        tolerance,
    };
    let tolerances = TOLERANCES.map(|tolerance| {
        setting(format!("tolerance {tolerance:e}"), "tolerance of the polish", Effort { tolerance, ..usual })
    });
    let nodes = NODES.map(|nodes| {
        let effort = at(nodes, usual.tolerance);
        setting(effort.nodes().to_string(), "nodes of roughness x index x polished", effort)
    });
    let both = BOTH.map(|(roughness, index, starts, tolerance)| {
        let effort = at((roughness, index, starts), tolerance);
        setting(format!("{}, {tolerance:e}", effort.nodes()), "both", effort)
    });
    let mut all: Vec<Setting> = tolerances.into_iter().chain(nodes).chain(both).collect();
    let is_spectral = matches!(&measurement.emission, EmissionAxis::Wavelengths(axis) if axis.nm.len() > 1);
    if options.reduction == Reduction::None && is_spectral {
        all.extend([Reduction::Auto, Reduction::Luminance].map(|reduction| Setting {
            name: format!("reduce {reduction}"),
            knob: "bands in place of wavelengths",
            options: reduction_options(reduction),
            asked: FitOptions { reduction, effort: usual, ..options.clone() },
        }));
    }
    all
}

fn reduction_options(reduction: Reduction) -> Vec<String> {
    match reduction {
        Reduction::Auto => Vec::new(),
        stated => vec!["--reduce".to_owned(), stated.to_string()],
    }
}

/// What `bbrf fit` is told; nothing of what is usual.
fn effort_options(effort: Effort) -> Vec<String> {
    let usual = Effort::default();
    let mut options = Vec::new();
    if effort.nodes() != usual.nodes() {
        options.extend(["--nodes".to_owned(), effort.nodes().to_string()]);
    }
    if effort.tolerance != usual.tolerance {
        options.extend(["--tolerance".to_owned(), format!("{:e}", effort.tolerance)]);
    }
    options
}

/// The largest distance of a parameter from the same one of a reference, in the reference's standard uncertainty. Parameters that the
/// reference cannot tell do not count, nor those of which the two have different numbers. `None` where nothing is left, or where
/// the fit lacks a term of the reference.
#[must_use]
pub fn parameter_distance(model: &Model, reference: &Model) -> Option<f64> {
    let mut worst: Option<f64> = None;
    for expected in &reference.terms {
        let term = model.terms.iter().find(|term| term.kind == expected.kind)?;
        for parameter in &expected.parameters {
            let found = term.parameters.iter().find(|one| one.name == parameter.name)?;
            let is_comparable = model.reduction == reference.reduction || !is_amplitude(&parameter.name);
            if !is_comparable || found.value.len() != parameter.value.len() {
                continue;
            }
            let sigma = parameter.standard_uncertainty.iter();
            for ((found, expected), sigma) in found.value.iter().zip(&parameter.value).zip(sigma) {
                if !(expected.is_finite() && *sigma > 0.0 && sigma.is_finite()) {
                    continue;
                }
                // What the reference tells and this fit does not is lost altogether.
                let distance = if found.is_finite() { ((found - expected) / sigma).abs() } else { return None };
                worst = Some(worst.map_or(distance, |worst| worst.max(distance)));
            }
        }
    }
    worst
}

/// Of a band and of a wavelength amplitudes are different quantities; the shape is one.
fn is_amplitude(name: &str) -> bool {
    !matches!(name, "roughness" | "refractive_index")
}

/// Chi-square above the reference's, over the reference's chi-square per degree of freedom; by the residuals alone where there are no
/// uncertainties. `None` where the numbers fitted are not the same.
fn chi_square_gap(model: &Model, reference: &Model) -> Option<f64> {
    let (own, other) = (&model.residuals, &reference.residuals);
    if own.count != other.count {
        return None;
    }
    // The rung may have fewer parameters: chi-square itself is what both have.
    let freedom = |model: &Model| model.residuals.count as f64 - model.fitted_parameters() as f64;
    let (own_freedom, freedom) = (freedom(model), freedom(reference));
    let ratio = if own.reduced_chi_square.is_finite() && other.reduced_chi_square.is_finite() {
        own.reduced_chi_square * own_freedom / (other.reduced_chi_square * freedom)
    } else {
        (own.rms / other.rms).powi(2)
    };
    Some(freedom * (ratio - 1.0))
}

fn note(model: &Model, distance: Option<f64>, is_same: bool) -> Option<String> {
    match distance {
        None => Some("lacks what the reference fit found".to_owned()),
        Some(_) if !is_same => Some(format!("{}: roughness and index are compared", model.reduction)),
        Some(_) if !model.converged => Some("did not converge".to_owned()),
        Some(_) => None,
    }
}
