//! Residuals against whatever they should not depend on, and against the normal distribution.

use statrs::distribution::{ContinuousCDF, Normal};

use super::Shown;
use crate::report::angle_points::AnglePoints;
use crate::report::curve::{Curve, CurveText, Points, dots_and_curve};
use crate::report::frame::with_unit;
use crate::report::{Figure, ReportError};

/// More points than this make a page slow and say nothing more.
const MOST_DOTS: usize = 4000;
/// Residuals beyond this are drawn in any case.
const LARGE: f64 = 3.0;

/// Against the angle of the half vector, the angle of incidence on a facet, the predicted value and the order of rows; and
/// the quantiles.
pub(super) fn figures(shown: &Shown<'_>, points: &AnglePoints) -> Vec<Result<Figure, ReportError>> {
    let residual = shown.residual();
    let half = points.geometry.iter().map(|geometry| geometry.half_angles());
    let phi: Vec<f64> = half.clone().map(|half| half.phi.to_degrees()).collect();
    let theta_q: Vec<f64> = half.map(|half| half.cos_q.clamp(-1.0, 1.0).acos().to_degrees()).collect();
    let rows: Vec<f64> = shown.of.data.rows.iter().map(|row| *row as f64).collect();
    let value = with_unit("predicted value", &shown.model.unit);
    let scatter = |name: &str, against: &str, x: &[f64], axis: &str, reads: &str| {
        let text = CurveText {
            name: format!("residuals-{name}"),
            title: format!("{}: residuals against {against}{}", shown.subject, points.at_wavelength()),
            subtitle: thinned_in_words(residual.len()),
            x: axis.to_owned(),
            y: shown.residual_label().to_owned(),
            caption: reads.to_owned(),
        };
        against_line(x, &residual, &text, |_| 0.0, "0")
    };
    vec![
        scatter(
            "half-vector",
            "the angle of the half vector",
            &phi,
            "angle of the half vector from the normal (degrees)",
            "A pattern here is a wrong form of the lobe (another distribution), or a wrong roughness.",
        ),
        scatter(
            "facet",
            "the angle of incidence on the facet",
            &theta_q,
            "angle between light and half vector θ_Q (degrees)",
            "A pattern here is a wrong reflectance of the facets (index), or a wrong denominator at large angles.",
        ),
        scatter(
            "predicted",
            "the predicted value",
            &points.predicted,
            &value,
            "A funnel is a wrong dependence of the uncertainties on the value; a slope is a detector that is not linear.",
        ),
        scatter(
            "order",
            "the order of measurement",
            &rows,
            "row of the measurement, from 0",
            "A slope is a drift of lamp or detector; a step is something that was touched.",
        ),
        quantiles(shown, points, &residual),
    ]
}

/// Sorted residuals against what as many draws from a normal distribution would be on average.
fn quantiles(shown: &Shown<'_>, points: &AnglePoints, residual: &[f64]) -> Result<Figure, ReportError> {
    let mut sorted: Vec<f64> = residual.iter().copied().filter(|residual| residual.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let (normal, count) = (Normal::standard(), sorted.len() as f64);
    let expected: Vec<f64> = (0..sorted.len()).map(|k| normal.inverse_cdf((k as f64 + 0.5) / count)).collect();
    let text = CurveText {
        name: "residuals-normal".to_owned(),
        title: format!("{}: residuals beside the normal distribution{}", shown.subject, points.at_wavelength()),
        subtitle: thinned_in_words(sorted.len()),
        x: "quantile of the normal distribution (unit 1)".to_owned(),
        y: shown.residual_label().to_owned(),
        caption: "Steeper than the line: the uncertainties are too small. Ends that leave it: outliers.".to_owned(),
    };
    against_line(&expected, &sorted, &text, |x| x, "expected")
}

fn thinned_in_words(count: usize) -> String {
    if count <= MOST_DOTS {
        return format!("{count} values");
    }
    format!("one in {} of {count} values, and all beyond {LARGE}", count.div_ceil(MOST_DOTS))
}

/// Dots with a line.
fn against_line(
    x: &[f64],
    y: &[f64],
    text: &CurveText,
    line: impl Fn(f64) -> f64,
    name: &str,
) -> Result<Figure, ReportError> {
    let step = y.len().div_ceil(MOST_DOTS).max(1);
    let is_drawn = |k: usize| k.is_multiple_of(step) || y[k].abs() > LARGE;
    let kept: Vec<usize> = (0..y.len().min(x.len())).filter(|k| is_drawn(*k) && y[*k].is_finite()).collect();
    let points = Points {
        x: kept.iter().map(|k| x[*k]).collect(),
        y: kept.iter().map(|k| y[*k]).collect(),
        error: Vec::new(),
        name: "value".to_owned(),
        error_name: String::new(),
    };
    let ends = crate::report::scale::extent(points.x.iter().copied());
    let curve =
        ends.map(|(from, to)| Curve { x: vec![from, to], y: vec![line(from), line(to)], name: name.to_owned() });
    dots_and_curve(&points, curve.as_ref(), text)
}
