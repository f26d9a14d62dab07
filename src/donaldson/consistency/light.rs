//! What fell on a scan, as a light.

use super::super::Light;
use crate::dataset::{Document, Excitation, Measurement};
use crate::quantity::{QuantityKind, ReferenceLight};

/// A line without a stated width is so wide, nm: next to the steps of a matrix it is a line.
const LINE_NM: f64 = 1e-3;

/// A light with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lamp {
    pub(super) light: Light,
    /// True for a spectrum of the file; false for a band made of a stated centre and width.
    pub(super) is_measured: bool,
    /// In words.
    pub(super) name: String,
}

/// The light of an excitation state: the spectrum of its lamp, unless a stated band cuts most of it off; else that band; else the
/// light of the reference.
pub(super) fn lamp(document: &Document, scan: &Measurement, state: Option<u32>) -> Option<Lamp> {
    let state = state.and_then(|index| scan.excitations.get(usize::try_from(index).ok()?));
    let stored = |id: &str| {
        let light = document.lights.iter().find(|light| light.id.as_str() == id)?;
        let Some(spectrum) = light.spectrum.as_ref() else {
            let name = format!("the CIE's light `{id}`, which the file names without a spectrum");
            return Some(Lamp { light: Light::named(id)?, is_measured: false, name });
        };
        let (light, _) = Light::of_stored(id, spectrum).ok()?;
        Some(Lamp { light, is_measured: true, name: format!("the light `{id}`") })
    };
    let band = state.and_then(band);
    let of_state = state.and_then(|state| stored(state.light.as_ref()?.as_str()));
    let of_state = of_state.filter(|lamp| band.as_ref().is_none_or(|band| is_mostly_within(&lamp.light, &band.light)));
    of_state.or(band).or_else(|| match &scan.quantity.reference_light {
        ReferenceLight::Light(id) => stored(id),
        ReferenceLight::Same | ReferenceLight::Unstated => None,
    })
}

/// The stated band of an excitation: a triangle.
fn band(state: &Excitation) -> Option<Lamp> {
    let centre = state.centre_nm().filter(|nm| nm.is_finite() && *nm > 0.0)?;
    let width = state.fwhm_nm.filter(|width| *width > 0.0 && *width < centre).unwrap_or(LINE_NM);
    let nm = vec![centre - width, centre, centre + width];
    let kind = QuantityKind::RelativeSpectrum;
    let light = Light::new(format!("{centre} nm"), kind, nm, vec![0.0, 1.0, 0.0], None).ok()?;
    let name = if width > LINE_NM {
        format!("a triangle of {width} nm at {centre} nm")
    } else {
        format!("a line at {centre} nm (its width is not stated)")
    };
    Some(Lamp { light, is_measured: false, name })
}

/// A lamp most of whose light lies outside the stated band (three of its widths to either side, 20 nm at least) stands behind a
/// filter or a monochromator: its own spectrum is not what falls on the sample.
fn is_mostly_within(lamp: &Light, band: &Light) -> bool {
    let (low, high) = band.range_nm();
    let (centre, reach) = ((low + high) / 2.0, (1.5 * (high - low)).max(20.0));
    let sum = |from: f64, to: f64| {
        let points = lamp.nm().iter().zip(lamp.values()).filter(|(nm, _)| (from..=to).contains(*nm));
        points.map(|(_, value)| value.max(0.0)).sum::<f64>()
    };
    sum(centre - reach, centre + reach) > 0.5 * sum(0.0, f64::INFINITY)
}
