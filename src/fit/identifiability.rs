//! What the data cannot tell, in words and numbers.

use super::fits::Fits;
use super::geometry_set::GeometrySet;
use super::joint::FittedEffect;
use super::left_out::LeftOut;
use super::observed::Observed;
use super::outcome::Fit;
use super::profile::Interval;
use super::repeats::{Repeats, Verdict};
use super::solve::{SEEN, Terms};
use crate::dataset::{Reduced, Side};

/// Relative standard uncertainty of n - 1 beyond which the index is called undetermined.
const VAGUE_INDEX: f64 = 0.2;
/// Relative standard uncertainty of the roughness beyond which it is called undetermined.
const VAGUE_ROUGHNESS: f64 = 0.2;
/// Correlation of intensity and index beyond which only their product is quoted as known.
const TIED: f64 = 0.98;

/// One sentence for each thing that a reader of the numbers must know.
pub(super) fn findings(
    fits: &Fits,
    set: &GeometrySet,
    terms: Terms,
    data: &Reduced,
    wavelength_shift_nm: f64,
) -> Vec<String> {
    let mut left_out = LeftOut { no_value: data.left_out * data.values.nrows(), ..LeftOut::default() };
    fits.list.iter().for_each(|observed| left_out.add_all(&observed.fit.left_out));
    let mut list: Vec<String> = left_out.reasons().iter().map(|reason| format!("values left out: {reason}")).collect();
    let has_sigma = data.sigma.is_some();
    if !has_sigma {
        list.push(
            "the data have no uncertainties: all values weigh the same and the covariance is scaled by the residuals"
                .to_owned(),
        );
    }
    list.extend(repeats(data));
    list.extend(bounds(data));
    list.extend(outliers(fits));
    list.extend(fits.effects.iter().map(effect));
    if wavelength_shift_nm > 0.0 {
        list.push(format!(
            "a shift of the wavelength by {wavelength_shift_nm} nm (standard uncertainty) is the same at all geometries: the \
             scan cannot tell it from the amplitudes, whose shared uncertainty holds it by the slope of their spectrum"
        ));
    }
    match fits.list.as_slice() {
        [one] => list.extend(of_one(one, fits.searched, set, data, terms, has_sigma)),
        many => list.extend(of_many(many, data, terms, has_sigma)),
    }
    list
}

/// Geometries that were measured more than once and scatter by more than is stated. Less is no finding: the stated
/// uncertainty may hold what repeats together.
fn repeats(data: &Reduced) -> Option<String> {
    let repeats = Repeats::of(&data.geometry, &data.values, data.sigma.as_ref()?)?;
    (repeats.verdict() == Verdict::TooSmall).then(|| {
        format!(
            "{} geometries were measured more than once, and their values scatter by {:.2} +- {:.2} times the stated \
             uncertainties: those are too small, and so are the uncertainties of the parameters",
            repeats.geometries.len(),
            repeats.scatter,
            repeats.scatter_uncertainty()
        )
    })
}

/// Readings that were fitted as bounds.
fn bounds(data: &Reduced) -> Option<String> {
    let count = |side: Side| data.bounds.iter().filter(|bound| bound.side == side).count();
    let (floor, ceiling) = (count(Side::AtMost), count(Side::AtLeast));
    let phrase = |count: usize, what: &str| (count > 0).then(|| format!("{count} {what}"));
    let said: Vec<String> =
        [phrase(floor, "below detection as upper bounds"), phrase(ceiling, "saturated as lower bounds")]
            .into_iter()
            .flatten()
            .collect();
    (!said.is_empty()).then(|| {
        format!(
            "readings fitted as bounds and not as values: {} (the probability of a reading beyond the bound takes the place \
             of a residual)",
            said.join(", ")
        )
    })
}

/// An effect of the instrument, and whether the data told more of it than was known.
fn effect(effect: &FittedEffect) -> String {
    let FittedEffect { effect: name, value, sigma, prior } = effect;
    if *sigma == 0.0 {
        return format!("{name} taken as {value} degrees");
    }
    let told = if *sigma > 0.9 * prior.1 { "; the data tell no more of it than was known" } else { "" };
    format!(
        "{name} {value:.4} ± {sigma:.4} degrees, fitted with what was known ({} ± {} degrees){told}",
        prior.0, prior.1
    )
}

/// What a robust loss did.
fn outliers(fits: &Fits) -> Option<String> {
    let scales: Vec<f64> = fits.list.iter().filter_map(|observed| observed.scale).collect();
    let count: usize = fits.list.iter().map(|observed| observed.outliers.len()).sum();
    let largest = scales.iter().copied().fold(f64::NAN, f64::max);
    (!scales.is_empty()).then(|| {
        format!(
            "{count} values count for less than half by the robust loss; the residuals of the others scatter by \
             {largest:.3} of their stated uncertainty (of their unit, where none is stated)"
        )
    })
}

/// Findings of fits that each stand for one emission value: how many, and where.
fn of_many(fits: &[Observed], data: &Reduced, terms: Terms, has_sigma: bool) -> Vec<String> {
    let nm = data.emission.wavelengths().unwrap_or(&[]);
    let count = fits.len();
    let said = |what: &str, is: &dyn Fn(&Observed) -> bool| {
        let at: Vec<usize> = (0..count).filter(|&band| is(&fits[band])).collect();
        let (first, last) = (at.first()?, at.last()?);
        let place = |band: &usize| nm.get(*band).map_or_else(|| format!("value {band}"), |nm| format!("{nm} nm"));
        Some(format!("{} of {count} emission values ({} to {}): {what}", at.len(), place(first), place(last)))
    };
    let mut list = Vec::new();
    if terms.specular {
        let unseen = |observed: &Observed| !observed.fit.has_specular();
        list.extend(said("no specular term seen; roughness, index and intensity are undefined there", &unseen));
        let open = |interval: Option<Interval>| interval.is_some_and(|interval| !interval.is_closed());
        let index = |observed: &Observed| open(observed.intervals.index_minus_one);
        list.extend(said("the refractive index has an open interval, the data cannot tell it there", &index));
        let roughness = |observed: &Observed| open(observed.intervals.roughness);
        list.extend(said("the roughness has an open interval, the data cannot tell it there", &roughness));
    }
    let wrong = |observed: &Observed| misfit(&observed.fit, has_sigma).is_some();
    list.extend(said("the residuals exceed the stated uncertainties", &wrong));
    list
}

/// Findings of one fit, of one emission value or of many together.
fn of_one(
    observed: &Observed,
    searched: [(f64, f64); 2],
    set: &GeometrySet,
    data: &Reduced,
    terms: Terms,
    has_sigma: bool,
) -> Vec<String> {
    let fit = &observed.fit;
    let mut list = Vec::new();
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
        list.extend(specular(observed, searched, set, data));
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

fn specular(observed: &Observed, searched: [(f64, f64); 2], set: &GeometrySet, data: &Reduced) -> Vec<String> {
    let fit = &observed.fit;
    let mut list = Vec::new();
    list.extend(at_zero("specular", fit.bands.iter().map(|band| band.intensity)));
    let [of_roughness, (index_low, index_high)] = searched;
    let of_index = (1.0 + index_low, 1.0 + index_high);
    list.extend(if fit.at_bound[0] {
        Some(on_edge("roughness", fit.roughness, of_roughness))
    } else {
        roughness(observed, set)
    });
    list.extend(if fit.at_bound[1] {
        Some(on_edge("refractive index", fit.refractive_index(), of_index))
    } else {
        index(observed, data)
    });
    list
}

/// An interval in words.
fn between(interval: &Interval) -> String {
    match (interval.low_open, interval.high_open) {
        (false, false) => format!("between {:.4} and {:.4}", interval.low, interval.high),
        (true, false) => format!("below {:.4}, with no lower limit", interval.high),
        (false, true) => format!("above {:.4}, with no upper limit", interval.low),
        (true, true) => "anywhere in the searched box".to_owned(),
    }
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

fn index(observed: &Observed, data: &Reduced) -> Option<String> {
    let fit = &observed.fit;
    let sigma = fit.log_sigma[1];
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
    let interval = observed.intervals.index_minus_one.map(Interval::plus_one)?;
    if interval.is_closed() && sigma <= VAGUE_INDEX && correlation.abs() < TIED {
        return None;
    }
    let product = product_uncertainty(fit, band.intensity, c);
    let verdict = if interval.is_closed() { "" } else { "the data cannot tell it; " };
    Some(format!(
        "refractive index: {verdict}{} (95 %), correlation with the intensity {correlation:.4}; their product with the \
         normal reflectance, intensity x F(0), is known to {:.2} %; {}",
        between(&interval),
        100.0 * product,
        advice_for_index(data)
    ))
}

/// What to measure so that the index is told from the intensity: F bends only where light and facet are far apart.
fn advice_for_index(data: &Reduced) -> String {
    let used = (0..data.geometry.len()).filter(|&row| data.values.column(row).iter().any(|value| value.is_finite()));
    let angle = |row: usize| data.geometry[row].half_angles().sin2_q.sqrt().asin().to_degrees();
    let steepest = used.map(angle).fold(0.0, f64::max);
    if steepest < 75.0 {
        format!("measure beyond 60 degrees (light and facet are at most {steepest:.0} degrees apart so far)")
    } else {
        format!("measure more often near the mirror direction at {steepest:.0} degrees, or with less noise")
    }
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

fn roughness(observed: &Observed, set: &GeometrySet) -> Option<String> {
    let fit = &observed.fit;
    let sigma = fit.log_sigma[0];
    let narrowest = set.distribution.roughness_from_half_width(set.smallest_angle);
    let interval = observed.intervals.roughness?;
    if !interval.is_closed() || sigma.is_nan() || sigma > VAGUE_ROUGHNESS {
        let verdict = if interval.is_closed() { "" } else { "not determined by these geometries; " };
        let advice = if fit.roughness < narrowest {
            format!(
                "; the smallest half-vector angle of the scan besides the mirror direction is {:.2} degrees: measure closer \
                 to the mirror direction",
                set.smallest_angle.to_degrees()
            )
        } else {
            String::new()
        };
        return Some(format!("roughness: {verdict}{} (95 %){advice}", between(&interval)));
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
