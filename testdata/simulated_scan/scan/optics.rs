//! What the light does: the lamp, the surface, the slit. Radiances in W m-2 sr-1 nm-1, irradiances (across the beam) in
//! W m-2 nm-1.

use std::f64::consts::{LN_2, PI};

use super::lamp::Lamp;
use super::objects::Object;

/// Emission wavelengths of a PR-650: 380 to 780 nm in steps of 4.
pub(crate) const WAVELENGTHS: usize = 101;
/// Radiance factor of the white plate, the same at every wavelength and in every direction.
pub(crate) const WHITE_FACTOR: f64 = 0.99;

/// The fine grid on which light is excited and emitted: 300 to 800 nm in steps of 1.
const FINE_FROM_NM: usize = 300;
const FINE_COUNT: usize = 501;
/// The slit is a triangle of this full width at half maximum, nm.
const SLIT_NM: f64 = 8.0;

/// A wavelength of the instrument, nm.
pub(crate) fn wavelength_nm(index: usize) -> f64 {
    380.0 + 4.0 * index as f64
}

/// Spectra after the slit, on the wavelengths of the instrument.
#[derive(Debug)]
pub(crate) struct Spectra {
    /// Irradiance of the beam.
    pub(crate) irradiance: Vec<f64>,
    /// pi times the radiance at normal incidence of what leaves diffusely by reflection.
    pub(crate) diffuse: Vec<f64>,
    /// The same of what leaves by luminescence.
    pub(crate) luminescent: Vec<f64>,
}

impl Spectra {
    /// The spectra of an object under a lamp.
    pub(crate) fn of(object: &Object, lamp: &Lamp) -> Self {
        let beam: Vec<f64> = fine().map(lamp.irradiance).collect();
        let diffuse: Vec<f64> = fine().zip(&beam).map(|(nm, beam)| object.reflectance_at(nm) * beam).collect();
        Self {
            irradiance: through_slit(&beam),
            diffuse: through_slit(&diffuse),
            luminescent: through_slit(&luminescence(object, &beam)),
        }
    }

    /// Radiance of the object in a geometry of signed angles, degrees.
    pub(crate) fn radiance(&self, object: &Object, theta_i_deg: f64, theta_v_deg: f64) -> Vec<f64> {
        let cosine = theta_i_deg.to_radians().cos();
        let specular = object.intensity * specular_shape(object, theta_i_deg, theta_v_deg);
        (0..WAVELENGTHS)
            .map(|i| ((self.diffuse[i] + self.luminescent[i]) * cosine + specular * self.irradiance[i]) / PI)
            .collect()
    }

    /// Radiance of the white plate at an angle of incidence, degrees.
    pub(crate) fn white_radiance(&self, theta_i_deg: f64) -> Vec<f64> {
        let scale = WHITE_FACTOR * theta_i_deg.to_radians().cos() / PI;
        self.irradiance.iter().map(|irradiance| scale * irradiance).collect()
    }
}

fn fine() -> impl Iterator<Item = f64> {
    (0..FINE_COUNT).map(|i| (FINE_FROM_NM + i) as f64)
}

/// pi times the luminescent radiance at normal incidence: the energy that the excitation band takes in, spread over
/// the emission band; never below the wavelength of excitation (Stokes).
fn luminescence(object: &Object, beam: &[f64]) -> Vec<f64> {
    let area: f64 = fine().map(|nm| object.emission_at(nm)).sum();
    let taken_in: Vec<f64> = fine().zip(beam).map(|(nm, beam)| object.excitation_at(nm) * beam).collect();
    let mut below = 0.0;
    fine()
        .zip(&taken_in)
        .map(|(nm, here)| {
            let emitted = object.yield_at_centre * below * object.emission_at(nm) / area;
            below += here;
            emitted
        })
        .collect()
}

fn through_slit(fine: &[f64]) -> Vec<f64> {
    (0..WAVELENGTHS)
        .map(|index| {
            let centre = 380 + 4 * index - FINE_FROM_NM;
            let reach = SLIT_NM as usize;
            let (mut sum, mut weights) = (0.0, 0.0);
            for (at, value) in fine.iter().enumerate().take(centre + reach + 1).skip(centre - reach) {
                let weight = 1.0 - (at as f64 - centre as f64).abs() / SLIT_NM;
                sum += weight * value;
                weights += weight;
            }
            sum / weights
        })
        .collect()
}

/// D G F / cos(theta_i) in the plane, from unit vectors: Torrance-Sparrow as in the paper, D a Gaussian by its half
/// width at half height.
pub(crate) fn specular_shape(object: &Object, theta_i_deg: f64, theta_v_deg: f64) -> f64 {
    let (ti, tv) = (theta_i_deg.to_radians(), theta_v_deg.to_radians());
    // (x, N); a positive angle of incidence lies on the -x side, so that the mirror direction is theta_v = theta_i.
    let (light, view) = ((-ti.sin(), ti.cos()), (tv.sin(), tv.cos()));
    let half = (light.0 + view.0, light.1 + view.1);
    let length = half.0.hypot(half.1);
    let half = (half.0 / length, half.1 / length);
    let cos_q = view.0 * half.0 + view.1 * half.1;
    let phi = half.0.abs().atan2(half.1);
    let distribution = (-LN_2 * (phi / object.roughness).powi(2)).exp();
    let shadow = (2.0 * half.1 * view.1 / cos_q).min(2.0 * half.1 * light.1 / cos_q).min(1.0);
    distribution * shadow * fresnel(cos_q, object.refractive_index) / light.1
}

/// Unpolarised reflectance of a dielectric of that index, from the cosine of the angle of incidence.
fn fresnel(cosine: f64, index: f64) -> f64 {
    let inside = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let perpendicular = (cosine - index * inside) / (cosine + index * inside);
    let parallel = (inside - index * cosine) / (inside + index * cosine);
    (perpendicular * perpendicular + parallel * parallel) / 2.0
}
