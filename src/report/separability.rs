//! The paper's separability check: the two averaged curves of its Figs 3 and 4.

use super::curve::{Curve, CurveText, Points, dots_and_curve};
use super::{Figure, ReportError};
use crate::dataset::Separability;

/// The paper's Fig. 3, left: averaged over viewing, with the fitted cosine.
pub(super) fn mean_over_viewing(check: &Separability, subject: &str, quantity: &str) -> Result<Figure, ReportError> {
    let points = Points {
        x: check.theta_i_deg.clone(),
        y: check.mean_over_viewing.clone(),
        error: check.spread_over_viewing.clone(),
        name: "mean over viewing".to_owned(),
        error_name: "± standard deviation".to_owned(),
    };
    let x: Vec<f64> = (-90..=90).map(f64::from).collect();
    let y = x.iter().map(|angle| check.cosine_amplitude * angle.to_radians().cos()).collect();
    let curve = Curve { x, y, name: "fitted cosine".to_owned() };
    let text = CurveText {
        name: "mean-over-viewing".to_owned(),
        title: format!("{subject}: averaged over viewing"),
        subtitle: format!(
            "cosine of amplitude {:.4}; r.m.s. departure {:.2} % of the amplitude",
            check.cosine_amplitude,
            100.0 * check.cosine_relative_rms
        ),
        x: "incidence angle θᵢ (degrees, signed)".to_owned(),
        y: format!("mean {quantity}"),
        caption: "The average over viewing directions against the incidence angle, with the cosine fitted to it: a \
                  Lambertian surface follows it. An error bar that ends in an arrow goes on beyond the frame."
            .to_owned(),
    };
    dots_and_curve(&points, Some(&curve), &text)
}

/// The paper's Fig. 3, right: averaged over incidence, which a Lambertian surface leaves constant.
pub(super) fn mean_over_incidence(check: &Separability, subject: &str) -> Result<Figure, ReportError> {
    let points = Points {
        x: check.theta_v_deg.clone(),
        y: check.mean_over_incidence.clone(),
        error: check.spread_over_incidence.clone(),
        name: "mean over incidence".to_owned(),
        error_name: "± standard deviation".to_owned(),
    };
    let finite: Vec<f64> = points.y.iter().copied().filter(|y| y.is_finite()).collect();
    let mean = finite.iter().sum::<f64>() / finite.len() as f64;
    let curve = Curve { x: vec![-90.0, 90.0], y: vec![mean; 2], name: "their mean".to_owned() };
    let text = CurveText {
        name: "mean-over-incidence".to_owned(),
        title: format!("{subject}: averaged over incidence"),
        subtitle: format!(
            "r.m.s. departure from a constant {:.2} % of the mean; the best product f(θᵢ) g(θᵥ) leaves {:.2} % of the \
             r.m.s. of all values",
            100.0 * check.constancy_relative_rms,
            100.0 * check.rank_one_relative_rms
        ),
        x: "viewing angle θᵥ (degrees, signed)".to_owned(),
        y: "mean of value / fitted cosine (unit 1)".to_owned(),
        caption:
            "The average over incidence directions, after division by the fitted cosine, against the viewing angle: \
                  a Lambertian surface looks the same from everywhere. An error bar that ends in an arrow goes on beyond the \
                  frame."
                .to_owned(),
    };
    dots_and_curve(&points, Some(&curve), &text)
}
