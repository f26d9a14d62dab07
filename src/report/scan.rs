//! The figures of a scan that no model was fitted to: its values over both angles, reduced as a fit would reduce them.

use super::angle_map::AngleMap;
use super::angle_points::AnglePoints;
use super::fitted::{Drawn, quantity_words, with_band};
use super::{ReportError, subject};
use crate::dataset::{Document, Measurement, Reduction, Role, reduce};

/// The map and the surface of a sample's measurement without a model; what is not drawn has its reason. Nothing for a
/// measurement of something else (white, dark, lamp) or with a model, whose own figures show it.
#[must_use]
pub fn scan_figures(document: &Document, measurement: &Measurement) -> Drawn {
    let mut drawn = Drawn::default();
    let is_fitted = document.models.iter().any(|model| model.measurement == measurement.id);
    if measurement.role != Role::Sample || is_fitted {
        return drawn;
    }
    let id = &measurement.id;
    let is_numerator = |one: &&Measurement| one.derivation.as_ref().is_some_and(|from| from.numerator == *id);
    if let Some(factor) = document.measurements.iter().find(is_numerator) {
        drawn
            .not_drawn
            .push(format!("measurement `{id}`: its map over the angles; see `{}`, formed from it", factor.id));
        return drawn;
    }
    match map(document, measurement) {
        Ok(map) => drawn.take_maps(&map, &subject::of_sample(document, measurement), ""),
        Err(error) => drawn.not_drawn.push(error.in_full()),
    }
    drawn.not_drawn.push(format!(
        "measurement `{id}`: averages over the angles, residuals and parameters; no model was fitted to it, and `bbrf fit` \
         adds one"
    ));
    drawn.prefixed(id.as_str())
}

/// The values over both angles, in the band that a fit takes by default; of a measurement that has no band, its own.
fn map(document: &Document, measurement: &Measurement) -> Result<AngleMap, ReportError> {
    let data = reduce(document, measurement, Reduction::Auto).map_err(|source| ReportError::Scan { source })?;
    let label = with_band(quantity_words(data.kind), &data.emission, None);
    let points = AnglePoints::measured(&data);
    let map = AngleMap::from_points(&points, &points.measured, label, data.kind.unit())?;
    let (incidences, viewings) = (map.theta_i_deg.len(), map.theta_v_deg.len());
    if incidences < 2 || viewings < 2 {
        return Err(ReportError::NoTable { figure: map.label, incidences, viewings });
    }
    Ok(map)
}
