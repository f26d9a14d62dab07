//! A paint like the paper's Lumi Yellow, whose numbers the paper does not give: these are made up.

use crate::scan::objects::Object;

/// Reflects above 500 nm, is excited from the ultraviolet to the blue, and radiates at 525 nm. It is looked at from outside its
/// lobe, so its interface does not matter.
pub(crate) const YELLOW_PAINT: Object = Object {
    name: "lumi-yellow",
    title: "Fluorescent paint like Lumi Yellow",
    reflectance: (0.08, 0.85),
    edge_nm: (505.0, 10.0),
    emission_nm: (522.0, 16.0, 36.0),
    excitation_nm: (430.0, 50.0),
    yield_at_centre: 0.55,
    intensity: 0.0,
    roughness: 0.05,
    refractive_index: 1.45,
};

/// What the estimated matrix should hold where excitation and emission differ: the share of the energy at `excitation` that
/// `width_nm` of the emission radiates.
pub(crate) fn luminescent(excitation_nm: f64, emission_nm: f64, width_nm: f64) -> f64 {
    if emission_nm < excitation_nm {
        return 0.0;
    }
    YELLOW_PAINT.excitation_at(excitation_nm) * emission(emission_nm, width_nm)
}

/// The same where the excitation is strongest.
pub(crate) fn emission(emission_nm: f64, width_nm: f64) -> f64 {
    let area: f64 = (300..=800).map(|nm| YELLOW_PAINT.emission_at(f64::from(nm))).sum();
    YELLOW_PAINT.yield_at_centre * YELLOW_PAINT.emission_at(emission_nm) * width_nm / area
}
