//! Light that is not in a spectrum: a lamp that was measured from 380 nm has not been dark below, and a matrix that is excited
//! there would have shown it.

use super::colour::{Difference, Observer};
use super::light::Light;
use super::piecewise::{Line, tents};
use super::reradiation::Reradiation;

/// Wavelengths at which a light has no value although it would matter, and what is lost with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Unlit {
    /// From here, nm.
    pub from_nm: f64,
    /// To here, nm.
    pub to_nm: f64,
    /// True where the matrix can be excited there.
    pub is_excitation: bool,
    /// True where the matrix emits or an eye sees there, so that reflected light is missing.
    pub is_emission: bool,
    /// Of the luminescence that the matrix has under equal energy at all its excitations, the share excited there.
    pub excitation_share: f64,
    /// Of the luminescence under the same light, were it to go on at its last known value, the share that is lost.
    pub luminescence_lost: f64,
    /// The colour difference that this makes for the 2 degree observer, on both sides of the light together; `None` where one has no
    /// colour.
    pub difference: Option<Difference>,
}

/// What a light lacks; `flat` is the same light going on.
pub(super) fn unlit(surface: &Reradiation, light: &Light, flat: &Light) -> Vec<Unlit> {
    let (low, high) = light.range_nm();
    let (need_low, need_high) = flat.range_nm();
    let sides = [(need_low, low), (high, need_high)];
    let sides: Vec<(f64, f64)> = sides.into_iter().filter(|(from, to)| from < to).collect();
    if sides.is_empty() {
        return Vec::new();
    }
    let (as_is, whole) = (surface.lit(light), surface.lit(flat));
    let colour = |one: &super::Prediction| one.colour(Observer::Two);
    let difference = colour(&as_is).zip(colour(&whole)).and_then(|(a, b)| a.difference(&b));
    sides
        .into_iter()
        .filter_map(|(from_nm, to_nm)| {
            let one_side = if to_nm == low { light.extended(need_low, high) } else { light.extended(low, need_high) };
            let luminescence_lost = 1.0 - as_is.luminescent_sum() / surface.lit(&one_side).luminescent_sum();
            let overlaps = |nm: &[f64]| nm[0] < to_nm && nm[nm.len() - 1] > from_nm;
            let is_excitation = overlaps(&surface.excitation_nm);
            let is_emission = overlaps(&surface.emission_nm);
            let one = Unlit {
                from_nm,
                to_nm,
                is_excitation,
                is_emission,
                excitation_share: if is_excitation { excitation_share(surface, from_nm, to_nm) } else { 0.0 },
                luminescence_lost: if is_excitation && luminescence_lost.is_finite() { luminescence_lost } else { 0.0 },
                difference,
            };
            (is_excitation || is_emission).then_some(one)
        })
        .collect()
}

/// The share of the luminescence that equal energy in this range excites, of that which it excites everywhere.
fn excitation_share(surface: &Reradiation, from_nm: f64, to_nm: f64) -> f64 {
    let yields = surface.luminescent_yield();
    let sum = |from: f64, to: f64| {
        let equal = Line::new(vec![from, to], vec![1.0, 1.0]);
        let tents = tents(&surface.excitation_nm);
        tents.iter().zip(&yields).map(|(tent, part)| equal.integral_with(tent) * part).sum::<f64>()
    };
    let ends = (surface.excitation_nm[0], surface.excitation_nm[surface.excitation_nm.len() - 1]);
    let (part, whole) = (sum(from_nm, to_nm), sum(ends.0, ends.1));
    if whole == 0.0 { 0.0 } else { part / whole }
}

impl Unlit {
    /// The warning, for people.
    #[must_use]
    pub fn sentence(&self, light: &str) -> String {
        let range = format!("{light} has no value from {} to {} nm", self.from_nm, self.to_nm);
        let mut parts = Vec::new();
        if self.is_excitation {
            parts.push(format!(
                "{:.1} % of the excitation of the matrix (luminescence under equal energy) lies there; were the light to go on at \
                 its last known value, {:.1} % of the luminescence would be from there",
                100.0 * self.excitation_share,
                100.0 * self.luminescence_lost
            ));
        }
        if self.is_emission {
            parts.push("where the matrix emits, too, reflected light is missing".to_owned());
        }
        if let Some(Difference { de76, de2000 }) = self.difference {
            parts.push(format!("colour difference of what is missing: {de76:.2} (CIE76), {de2000:.2} (CIEDE2000)"));
        }
        format!("{range}; {}", parts.join("; "))
    }
}
