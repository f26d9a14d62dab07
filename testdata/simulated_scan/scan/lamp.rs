//! What shines on the surface.

use super::objects::half_height_gaussian;

/// A lamp.
#[derive(Debug)]
pub(crate) struct Lamp {
    /// What the manifest calls it.
    pub(crate) title: &'static str,
    /// Irradiance across the beam at a wavelength in nm, W m-2 nm-1.
    pub(crate) irradiance: fn(f64) -> f64,
}

/// An ultraviolet diode at 375 nm, a blue one at 452, its phosphor, and a faint incandescent part: excites, and is seen.
pub(crate) const DIODES: Lamp = Lamp { title: "375 nm diode with a white diode (simulated)", irradiance: diodes };

fn diodes(nm: f64) -> f64 {
    let incandescent = 6.0e-5 * (nm / 600.0).powi(4);
    0.024 * half_height_gaussian(nm - 375.0, 6.0)
        + 0.020 * half_height_gaussian(nm - 452.0, 11.0)
        + 0.014 * half_height_gaussian(nm - 565.0, 62.0)
        + incandescent
}
