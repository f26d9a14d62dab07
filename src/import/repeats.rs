//! Repeats of one look without a white reference: their mean beside the raw rows.

use ndarray::ArcArray2;

use super::mean::{Mean, Spread};
use super::noise::{Noise, RECORD_SCALE, kept};
use super::plan::Plan;
use super::raw::record_scale;
use super::receipt::Notes;
use super::reference::sample_groups;
use crate::dataset::{Acquisition, Id, Measurement, Role};
use crate::quantity::Uncertainty;

/// The mean of each look of the sample, with the spread of its repeats as standard uncertainty; `None` where no look
/// has repeats. `repeats` says that records outside a scan are repeats of one look.
pub(super) fn average(
    plan: &Plan,
    raw: &[Measurement],
    noise: Option<&Noise>,
    repeats: bool,
    notes: &mut Notes,
) -> Option<Measurement> {
    let sample = raw.iter().find(|measurement| measurement.role == Role::Sample)?;
    let groups = sample_groups(sample, plan.scan, repeats);
    if groups.iter().all(|rows| rows.len() < 2) {
        return None;
    }
    let spread = Spread::of(groups.iter().map(|rows| (sample, rows)), noise.is_some());
    let means: Vec<Mean> = groups.iter().map(|rows| Mean::of(sample, rows, &spread)).collect();
    let id = plan.settings.id.as_deref().map_or_else(|| format!("{}-mean", sample.id), str::to_owned);
    let id = Id::from_title(&id);
    notes.assume(plan.place.clone(), format!("`{id}` holds the means of `{}`; {}", sample.id, spread.describe()));
    let shape = (means.len(), sample.emission.len());
    let fewest = means.iter().map(|mean| mean.count).min().unwrap_or(1).max(1) as f64;
    let scale = spread.record_scale().unwrap_or(RECORD_SCALE) / fewest.sqrt();
    let known = spread.known();
    Some(Measurement {
        id,
        acquisitions: acquisitions(sample, &groups, &means),
        values: ArcArray2::from_shape_fn(shape, |(row, column)| means[row].value[column]),
        flags: ArcArray2::from_shape_fn(shape, |(row, column)| means[row].flags[column].0),
        uncertainty: Uncertainty {
            standard: known.then(|| ArcArray2::from_shape_fn(shape, |(row, column)| kept(means[row].sigma[column]))),
            components: known.then(|| record_scale(scale)).into_iter().collect(),
            ..Uncertainty::default()
        },
        ..sample.clone()
    })
}

/// The rows of means: what all repeats of a look have in common, and when the first of them was taken.
pub(super) fn acquisitions(sample: &Measurement, groups: &[Vec<usize>], means: &[Mean]) -> Vec<Acquisition> {
    let rows = groups.iter().zip(means);
    rows.filter_map(|(rows, mean)| {
        let raw: Vec<&Acquisition> = rows.iter().map(|row| &sample.acquisitions[*row]).collect();
        let first = *raw.first()?;
        let same_exposure = raw.iter().all(|other| other.exposure_ms == first.exposure_ms);
        Some(Acquisition {
            geometry: first.geometry,
            excitation: first.excitation,
            order: first.order,
            repeats: u32::try_from(mean.count).unwrap_or(u32::MAX).max(1),
            time: first.time.clone(),
            exposure_ms: first.exposure_ms.filter(|_| same_exposure),
            quality_code: first.quality_code.filter(|_| raw.len() == 1),
        })
    })
    .collect()
}
