//! What the data cannot tell, in words and numbers.

use super::geometry_set::{GeometrySet, INDEX_BOX};
use super::left_out::LeftOut;
use super::outcome::Fit;
use super::solve::{SEEN, Terms};

/// Relative standard uncertainty of n - 1 beyond which the index is called undetermined.
const VAGUE_INDEX: f64 = 0.2;
/// Relative standard uncertainty of the roughness beyond which it is called undetermined.
const VAGUE_ROUGHNESS: f64 = 0.2;
/// Correlation of intensity and index beyond which only their product is quoted as known.
const TIED: f64 = 0.98;

/// One sentence for each thing that a reader of the numbers must know.
pub(super) fn findings(fit: &Fit, set: &GeometrySet, terms: Terms, has_sigma: bool, left_out: &LeftOut) -> Vec<String> {
    let mut list: Vec<String> = left_out.reasons().iter().map(|reason| format!("values left out: {reason}")).collect();
    if !has_sigma {
        list.push(
            "the data have no uncertainties: all values weigh the same and the covariance is scaled by the residuals"
                .to_owned(),
        );
    }
    if terms.specular && !fit.has_specular() {
        list.push(format!(
            "no specular term seen: the best one lowers chi-square by {:.1}, and {SEEN} are asked for; roughness, index \
             and intensity are undefined and the term is left out",
            fit.specular_gain.max(0.0)
        ));
    }
    list.extend(misfit(fit, has_sigma));
    if terms.diffuse {
        list.extend(at_zero("diffuse", fit.bands.iter().map(|band| band.diffuse)));
    }
    if fit.has_specular() {
        list.extend(specular(fit, set));
    }
    list
}

/// Residuals far beyond the uncertainties: the model or the uncertainties are wrong.
fn misfit(fit: &Fit, has_sigma: bool) -> Option<String> {
    let reduced = fit.chi_square / fit.degrees_of_freedom;
    let limit = 1.0 + 5.0 * (2.0 / fit.degrees_of_freedom).sqrt();
    (has_sigma && reduced > limit).then(|| {
        format!(
            "the residuals exceed the stated uncertainties (reduced chi-square {reduced:.3}): the model does not describe \
             the data to that accuracy, or the uncertainties are too small; the standard uncertainties of the \
             parameters do not include it"
        )
    })
}

fn specular(fit: &Fit, set: &GeometrySet) -> Vec<String> {
    let mut list = Vec::new();
    list.extend(at_zero("specular", fit.bands.iter().map(|band| band.intensity)));
    let (index_low, index_high) = (1.0 + INDEX_BOX.0, 1.0 + INDEX_BOX.1);
    list.extend(if fit.at_bound[0] {
        Some(on_edge("roughness", fit.roughness, set.roughness_box))
    } else {
        roughness(fit, set)
    });
    list.extend(if fit.at_bound[1] {
        Some(on_edge("refractive index", fit.refractive_index(), (index_low, index_high)))
    } else {
        index(fit)
    });
    list
}

/// A parameter that ended on the edge of the searched box.
fn on_edge(name: &str, value: f64, (low, high): (f64, f64)) -> String {
    format!(
        "{name} {value:.4} lies on the edge of the searched box ({low:.4} to {high:.4}): the data ask for a value beyond it; \
         on a bound it has no ordinary standard uncertainty, and none is given"
    )
}

/// Amplitudes that ended on their bound.
fn at_zero(term: &str, amplitudes: impl ExactSizeIterator<Item = f64>) -> Option<String> {
    let count = amplitudes.len();
    let zeros = amplitudes.filter(|amplitude| *amplitude == 0.0).count();
    let wavelengths = if count > 1 { format!(" at {zeros} of {count} wavelengths") } else { String::new() };
    (zeros > 0).then(|| {
        format!(
            "the amplitude of the {term} term ended on its bound, 0{wavelengths}: the data ask for none or for a negative \
             one; on a bound it has no ordinary standard uncertainty, and none is given"
        )
    })
}

fn index(fit: &Fit) -> Option<String> {
    let sigma = fit.log_sigma[1];
    let interval = |factor: f64| 1.0 + fit.index_minus_one * factor;
    if sigma.is_nan() {
        return Some(
            "refractive index: these geometries cannot tell it from the intensity (all have the same angle between \
             light and facet); only the product intensity x normal reflectance is determined"
                .to_owned(),
        );
    }
    let band = fit.bands.iter().max_by(|a, b| a.intensity.total_cmp(&b.intensity))?;
    let c = &band.covariance;
    let correlation = c[1][3] / (c[1][1] * c[3][3]).sqrt();
    if sigma <= VAGUE_INDEX && correlation.abs() < TIED {
        return None;
    }
    let product = product_uncertainty(fit, band.intensity, c);
    Some(format!(
        "refractive index: between {:.3} and {:.3} (two standard uncertainties), correlation with the intensity {:.4}; \
         their product with the normal reflectance, intensity x F(0), is known to {:.2} %; measure beyond 60 degrees",
        interval((-2.0 * sigma).exp()),
        interval((2.0 * sigma).exp()),
        correlation,
        100.0 * product
    ))
}

/// Relative standard uncertainty of intensity times ((n-1)/(n+1))^2.
fn product_uncertainty(fit: &Fit, intensity: f64, c: &[[f64; 4]; 4]) -> f64 {
    let m = fit.index_minus_one;
    // d ln F0 / dn = 4 / (n^2 - 1).
    let by_index = 4.0 / (m * (2.0 + m));
    let variance =
        c[1][1] / (intensity * intensity) + 2.0 * by_index * c[1][3] / intensity + by_index * by_index * c[3][3];
    variance.max(0.0).sqrt()
}

fn roughness(fit: &Fit, set: &GeometrySet) -> Option<String> {
    let sigma = fit.log_sigma[0];
    let narrowest = set.distribution.roughness_from_half_width(set.smallest_angle);
    if sigma.is_nan() || sigma > VAGUE_ROUGHNESS {
        return Some(format!(
            "roughness: not determined by these geometries (standard uncertainty {:.0} %)",
            100.0 * sigma
        ));
    }
    (fit.roughness < 0.5 * narrowest).then(|| {
        format!(
            "roughness {:.4} is below half of what the smallest half-vector angle of the scan ({:.2} degrees) resolves: \
             it rests on the mirror direction against its nearest neighbours",
            fit.roughness,
            set.smallest_angle.to_degrees()
        )
    })
}
