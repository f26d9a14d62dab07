//! The lamps of the paper, as far as it describes them.

use crate::scan::lamp::Lamp;
use crate::scan::objects::half_height_gaussian;

/// The black light, "a very narrow band with the peak at 375 nm": 6 nm wide at half height, 3 W m-2 in all (both assumed), and
/// nothing else.
pub(crate) const BLACK_LIGHT: Lamp = Lamp { title: "375 nm diode (simulated)", irradiance: black_light };

/// The incandescent lamp, of which the paper says no more: a black body of 2856 K.
pub(crate) const INCANDESCENT: Lamp = Lamp { title: "incandescent lamp (simulated)", irradiance: incandescent };

/// The artificial sun, of which the paper says no more than that its spectrum is continuous: a black body of 5500 K behind glass
/// that ends at 340 nm.
pub(crate) const ARTIFICIAL_SUN: Lamp = Lamp { title: "artificial sun lamp (simulated)", irradiance: artificial_sun };

fn black_light(nm: f64) -> f64 {
    0.5 * half_height_gaussian(nm - 375.0, 3.0)
}

fn incandescent(nm: f64) -> f64 {
    0.01 * black_body(nm, 2856.0)
}

fn artificial_sun(nm: f64) -> f64 {
    0.01 * black_body(nm, 5500.0) / (1.0 + (-(nm - 340.0) / 6.0).exp())
}

/// Planck's law by the constants of CIE illuminant A, 1 at 560 nm.
fn black_body(nm: f64, kelvin: f64) -> f64 {
    let shape = |nm: f64| nm.powi(-5) / (1.4388e7 / (nm * kelvin)).exp_m1();
    shape(nm) / shape(560.0)
}
