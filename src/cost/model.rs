//! The ladder of a complete model: many geometries, each under a light of its own or all under one.

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::{Patience, Work};
use crate::donaldson::{By, Complete, CompleteTable, Extend, Incident, Light};
use crate::quantity::Geometry;

/// Steps of the samples, nm.
const STEPS: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];
/// The knobs.
const OWN: &str = "each geometry under a light of its own";
const ONE: &str = "all geometries under one light";

/// What a model ladder is made of.
#[derive(Debug)]
pub struct ModelLadder<'a> {
    /// What it is called.
    pub subject: String,
    /// The model.
    pub model: &'a Complete,
    /// The light.
    pub light: &'a Light,
    /// What it does where it has no value.
    pub extend: Extend,
    /// Over which errors are the largest.
    pub geometries: &'a [Geometry],
    /// How many evaluations the time is of.
    pub count: f64,
}

/// Why there is no ladder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the model has no value other than 0 at any of the geometries under this light; expected light that comes back"
)]
pub struct NoModelLadder;

/// What each way to evaluate a complete model costs.
///
/// # Errors
/// [`NoModelLadder`].
pub fn model_ladder(asked: &ModelLadder<'_>, patience: Patience) -> Result<Ladder, NoModelLadder> {
    let ModelLadder { model, light, extend, geometries, .. } = *asked;
    let lit = model.under(light, extend);
    let reference: Vec<Vec<f64>> = geometries.iter().map(|geometry| lit.at(geometry).total).collect();
    if !reference.iter().flatten().any(|value| value.is_finite() && *value != 0.0) {
        return Err(NoModelLadder);
    }
    let incident = model.incident(light, extend);
    let all = |incident: &Incident| -> Vec<Vec<f64>> {
        geometries.iter().map(|geometry| model.values(incident, geometry).total).collect()
    };
    let exact = largest_difference(&all(&incident), &reference);
    let times = asked.count / geometries.len().max(1) as f64;
    let candidate = |name: String, knob: &str, options: &[&str], error: Option<f64>, work| Candidate {
        name,
        knob: knob.to_owned(),
        options: options.iter().map(|word| (*word).to_owned()).collect(),
        error,
        second_error: None,
        bytes: None,
        note: None,
        work,
        times,
        read: None,
    };
    let mut candidates = vec![
        candidate(
            "own light, uncertainties".to_owned(),
            OWN,
            &[],
            Some(0.0),
            Box::new(|| {
                geometries
                    .iter()
                    .for_each(|geometry| drop(std::hint::black_box(model.under(light, extend).at(geometry))));
            }),
        ),
        candidate(
            "own light, values".to_owned(),
            OWN,
            &["--values"],
            exact,
            Box::new(|| {
                for geometry in geometries {
                    std::hint::black_box(model.values(&model.incident(light, extend), geometry));
                }
            }),
        ),
    ];
    for step in STEPS {
        let Some(table) = CompleteTable::new(model, step) else { continue };
        let samples = table.sampled(light, extend);
        let error = largest_difference(&all(&table.incident(&samples)), &reference);
        let options = ["--values", "--by", &By::Product.to_string(), "--step", &step.to_string()];
        let work: Work<'_> = Box::new(move || {
            for geometry in geometries {
                std::hint::black_box(model.values(&table.incident(&samples), geometry));
            }
        });
        candidates.push(candidate(format!("own light, values, product {step} nm"), OWN, &options, error, work));
    }
    candidates.push(candidate(
        "one light, uncertainties".to_owned(),
        ONE,
        &[],
        Some(0.0),
        Box::new(|| {
            geometries.iter().for_each(|geometry| drop(std::hint::black_box(lit.at(geometry))));
        }),
    ));
    candidates.push(candidate(
        "one light, values".to_owned(),
        ONE,
        &["--values"],
        exact,
        Box::new(|| {
            geometries.iter().for_each(|geometry| drop(std::hint::black_box(model.values(&incident, geometry))));
        }),
    ));
    Ok(measured(Task::Eval, asked.subject.clone(), meaning(asked), candidates, patience))
}

fn meaning(asked: &ModelLadder<'_>) -> Meaning {
    Meaning {
        reference: format!("`bbrf eval --light {}` by exact integrals", asked.light.name()),
        error: format!(
            "largest r.m.s. difference of the radiance over all emissions at one of {} geometries, over the r.m.s. of the radiance",
            asked.geometries.len()
        ),
        axis: "largest relative difference of the radiance".to_owned(),
        second_error: None,
        time: format!(
            "seconds for {} evaluations on one thread: each geometry with a light of its own (`own light`; of a product samples \
             already), or all with one that was brought in before (`one light`)",
            asked.count
        ),
        read_time: None,
    }
}

/// `None` where a value is lost. What the reference does not tell does not count, nor a geometry at which nothing comes back.
fn largest_difference(found: &[Vec<f64>], reference: &[Vec<f64>]) -> Option<f64> {
    let mut worst = 0.0_f64;
    for (found, expected) in found.iter().zip(reference) {
        let pairs = || found.iter().zip(expected).filter(|(_, expected)| expected.is_finite());
        let whole = pairs().map(|(_, expected)| expected * expected).sum::<f64>();
        let difference = pairs().map(|(found, expected)| (found - expected).powi(2)).sum::<f64>();
        if difference.is_nan() {
            return None;
        }
        if whole > 0.0 {
            worst = worst.max((difference / whole).sqrt());
        }
    }
    Some(worst)
}
