//! Directional albedo: the share of a beam that a term sends back into the hemisphere.
//!
//! The specular lobe is integrated over the half vector Q, where it stands still at the normal however narrow it is and
//! wherever the light comes from: d(omega_v) = 4 (L.Q) d(omega_Q). At an azimuth alpha of Q about the normal let
//! delta = atan(tan(theta_i) cos(alpha)). Then cos(theta_v) is proportional to cos(2 phi - delta), so that viewing ends
//! at phi = pi/4 + delta/2, and the three pieces of G meet at phi = pi/6 + delta/3 (masking begins) and phi = pi/2 - delta
//! (shadowing begins). Between those lines, and those at the azimuths where they cross, the integrand is smooth, and
//! Gauss's rule gains digits with every point.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use super::quadrature::gauss;
use super::{Evaluation, Term, Undefined};
use crate::quantity::{Direction, Geometry, Reference};

/// Points of Gauss's rule on each smooth piece, in azimuth and in polar angle of the half vector.
const AZIMUTHS: usize = 10;
const POLARS: usize = 10;
/// A lobe narrower than this, rad, has no digits left in an angle.
const NARROWEST: f64 = 1e-9;

impl Term {
    /// Share of the irradiance of the surface that the term radiates into the hemisphere, for light from a direction:
    /// the integral of Y / (pi E cos(theta_i)) cos(theta_v) over solid angle. Dimensionless, with its derivatives in the
    /// term's parameters; relative error below 2e-5 up to 85 degrees.
    ///
    /// # Errors
    /// [`Undefined`] for light from 90 degrees and for parameters beyond what numbers hold.
    pub fn directional_albedo(&self, incidence: &Direction) -> Result<Evaluation, Undefined> {
        if incidence.cos_theta() <= 0.0 {
            return Err(Undefined::Unbounded);
        }
        let Self::TorranceSparrow(specular) = self else {
            let [amplitude, ..] = self.values();
            return Ok(Evaluation { value: amplitude, by: [1.0, 0.0, 0.0] });
        };
        // The half width of every distribution is proportional to its roughness.
        let width = specular.roughness / specular.distribution.roughness_from_half_width(1.0);
        if !(NARROWEST..).contains(&width) {
            return Err(Undefined::NotFinite);
        }
        let lobe = HalfSpace::new(incidence.sin_theta(), incidence.cos_theta(), width);
        let mut sum = [0.0; 4];
        lobe.each_direction(|[x, y, z], solid_angle| {
            // Rounding may lift the last points over the edge, where nothing is radiated.
            let theta = x.hypot(y).atan2(z).to_degrees();
            let Ok(viewing) = Direction::from_degrees(theta, y.atan2(x).to_degrees().rem_euclid(360.0) % 360.0) else {
                return Ok::<(), Undefined>(());
            };
            let weight = solid_angle * viewing.cos_theta().max(0.0) / PI;
            let geometry = Geometry { incidence: lit_from(incidence), viewing };
            let at = self.evaluate(&geometry, &Reference::SameGeometry)?;
            for (total, part) in sum.iter_mut().zip([at.value, at.by[0], at.by[1], at.by[2]]) {
                *total += weight * part;
            }
            Ok(())
        })?;
        let [value, by @ ..] = sum;
        Ok(Evaluation { value, by })
    }
}

/// The terms know no azimuth of their own: light comes from phi = 0.
fn lit_from(incidence: &Direction) -> Direction {
    Direction::from_degrees(incidence.theta_deg(), 0.0).unwrap_or(*incidence)
}

/// The half vectors that belong to one direction of light, and with them all directions of viewing.
struct HalfSpace {
    sine: f64,
    cosine: f64,
    tangent: f64,
    width: f64,
}

impl HalfSpace {
    /// Of a direction at phi = 0 with this sine and cosine (above 0) of theta, for a lobe of this half width, rad.
    fn new(sine: f64, cosine: f64, width: f64) -> Self {
        Self { sine, cosine, tangent: sine / cosine, width }
    }

    /// Azimuths in [0, pi] between which the lines of polar angles keep their order; one half stands for both.
    fn azimuths(&self) -> Vec<f64> {
        let crossing = |tangent: f64| (tangent <= self.tangent).then(|| (tangent / self.tangent).acos());
        // At grazing incidence delta turns fast near pi/2; pieces that halve follow it.
        let turns = [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0].into_iter().filter_map(crossing);
        let ahead: Vec<f64> = turns.chain(crossing(FRAC_PI_6.tan())).collect();
        let behind: Vec<f64> = ahead.iter().map(|azimuth| PI - azimuth).collect();
        ordered([0.0, FRAC_PI_2, PI].into_iter().chain(ahead).chain(behind), PI)
    }

    /// Polar angles between which the integrand is smooth at an azimuth: edges of G, and the lobe in pieces that double.
    fn polars(&self, delta: f64) -> Vec<f64> {
        let last = (FRAC_PI_2 + delta) / 2.0;
        let edges = [0.0, (FRAC_PI_2 + delta) / 3.0, FRAC_PI_2 - delta, last];
        let doubling = std::iter::successors(Some(self.width), |width| Some(2.0 * width));
        ordered(edges.into_iter().chain(doubling.take_while(|width| *width < last)), last)
    }

    /// Calls with every direction of the rule, of length 1 and the normal along z, and its solid angle.
    fn each_direction<E>(&self, mut visit: impl FnMut([f64; 3], f64) -> Result<(), E>) -> Result<(), E> {
        for (alpha, alpha_weight) in gauss::<AZIMUTHS>(&self.azimuths()) {
            let delta = (self.tangent * alpha.cos()).atan();
            for (phi, phi_weight) in gauss::<POLARS>(&self.polars(delta)) {
                let half = [phi.sin() * alpha.cos(), phi.sin() * alpha.sin(), phi.cos()];
                let along = self.sine * half[0] + self.cosine * half[2];
                let other = [0, 1, 2].map(|k| 2.0 * along * half[k] - [self.sine, 0.0, self.cosine][k]);
                // One half of the azimuths stands for both.
                visit(other, 2.0 * (4.0 * along * phi.sin() * phi_weight * alpha_weight))?;
            }
        }
        Ok(())
    }
}

/// Break points within [0, last], each once.
fn ordered(breaks: impl Iterator<Item = f64>, last: f64) -> Vec<f64> {
    let mut breaks: Vec<f64> = breaks.filter(|point| (0.0..=last).contains(point)).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;
    use crate::terms::{Denominator, Distribution, TorranceSparrow};

    fn albedo(distribution: Distribution, denominator: Denominator, roughness: f64, theta: f64) -> Evaluation {
        let term = TorranceSparrow { intensity: 1.0, roughness, refractive_index: 1.5, distribution, denominator };
        Term::TorranceSparrow(term).directional_albedo(&Direction::from_degrees(theta, 0.0).unwrap()).unwrap()
    }

    /// Sums over 6 million viewing directions in polar coordinates about the mirror direction, in NumPy; two grids agree
    /// to 1e-6.
    #[test]
    fn the_albedo_follows_the_lobe_to_grazing_angles() {
        use Denominator::{CosICosV, CosThetaI, CosThetaV};
        use Distribution::{Beckmann, Gaussian, GaussianHalfHeight, TorranceSparrow1967, TrowbridgeReitz};
        for (distribution, denominator, roughness, theta, expected) in [
            (GaussianHalfHeight, CosThetaI, 0.1, 0.0, 0.002_221_883_398_7),
            (GaussianHalfHeight, CosThetaI, 0.05, 60.0, 0.001_272_226_052_4),
            (Gaussian, CosThetaV, 0.3, 45.0, 0.017_226_721_1),
            (TorranceSparrow1967, CosThetaI, 20.0, 30.0, 0.015_698_206_4),
            (Beckmann, CosICosV, 0.2, 70.0, 0.519_650_43),
            (TrowbridgeReitz, CosICosV, 0.05, 50.0, 0.114_885_780_8),
            (Beckmann, CosICosV, 0.01, 80.0, 2.840_850_648_1),
            (TrowbridgeReitz, CosICosV, 0.4, 85.0, 3.522_232),
            (GaussianHalfHeight, CosThetaV, 0.6, 75.0, 0.154_964_09),
        ] {
            let found = albedo(distribution, denominator, roughness, theta).value;
            let error = (found / expected - 1.0).abs();
            assert!(error < 2e-5, "{distribution} {denominator} {roughness} at {theta}: {found}, off by {error:.1e}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_albedo() {
        let at = |roughness: f64| albedo(Distribution::Beckmann, Denominator::CosICosV, roughness, 50.0);
        let step = 1e-4;
        let slope = (at(0.3 + step).value - at(0.3 - step).value) / (2.0 * step);
        assert!((at(0.3).by[1] - slope).abs() < 1e-6 * slope.abs(), "{} {slope}", at(0.3).by[1]);
        assert_eq!(at(0.3).by[0], at(0.3).value, "an intensity of 1");
    }

    #[test]
    fn a_diffuse_term_reflects_its_amplitude_and_grazing_light_has_no_albedo() {
        let diffuse = Term::Lambertian { albedo: 0.7 };
        let at = |theta: f64| diffuse.directional_albedo(&Direction::from_degrees(theta, 0.0).unwrap());
        assert_eq!(at(60.0).unwrap().value, 0.7);
        assert_eq!(at(90.0), Err(Undefined::Unbounded));
    }
}
