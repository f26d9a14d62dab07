//! Directions of incidence and viewing, and the half-vector angles that the terms depend on.

use serde::{Deserialize, Serialize};

use super::angle::{cos_deg, sin_deg};

/// A direction that points away from the surface: to the source (incidence) or to the detector (viewing).
///
/// `theta` is counted from the surface normal N, `phi` counter-clockwise from the sample's mark (+x) as seen by an
/// observer who looks down on the surface from outside; (x, y, N) is right-handed. Built from degrees, because that is
/// what instruments and files give and where no digit is lost next to 90; sines and cosines are kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    theta_deg: f64,
    phi_deg: f64,
    sin_theta: f64,
    cos_theta: f64,
}

/// Why two angles are not a direction.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DirectionError {
    /// The polar angle is outside what the caller may give.
    #[error("polar angle {0} degrees; expected a number from 0 to 180 (a measured direction: 0 to 90)")]
    Theta(f64),
    /// The azimuth is outside its range.
    #[error("azimuth {0} degrees; expected a number from 0 up to but not including 360")]
    Phi(f64),
    /// A signed in-plane angle is outside its range.
    #[error("signed in-plane angle {0} degrees; expected a number from -90 to 90")]
    Signed(f64),
}

impl Direction {
    /// A direction from its polar angle in [0, 180] and azimuth in [0, 360), both in degrees.
    ///
    /// Polar angles beyond 90 lie below the horizon: every term is exactly zero there.
    ///
    /// # Errors
    /// [`DirectionError`] outside these ranges or for NaN.
    pub fn from_degrees(theta_deg: f64, phi_deg: f64) -> Result<Self, DirectionError> {
        if !(0.0..=180.0).contains(&theta_deg) {
            return Err(DirectionError::Theta(theta_deg));
        }
        if !(0.0..360.0).contains(&phi_deg) {
            return Err(DirectionError::Phi(phi_deg));
        }
        Ok(Self { theta_deg, phi_deg, sin_theta: sin_deg(theta_deg), cos_theta: cos_deg(theta_deg) })
    }

    /// Polar angle from the normal, degrees.
    #[must_use]
    pub fn theta_deg(&self) -> f64 {
        self.theta_deg
    }

    /// Azimuth, degrees.
    #[must_use]
    pub fn phi_deg(&self) -> f64 {
        self.phi_deg
    }

    /// Sine of the polar angle.
    #[must_use]
    pub fn sin_theta(&self) -> f64 {
        self.sin_theta
    }

    /// Cosine of the polar angle; negative below the horizon, exactly 0 at 90 degrees.
    #[must_use]
    pub fn cos_theta(&self) -> f64 {
        self.cos_theta
    }

    /// The unit vector (x, y, N).
    #[must_use]
    pub fn unit_vector(&self) -> [f64; 3] {
        [self.sin_theta * cos_deg(self.phi_deg), self.sin_theta * sin_deg(self.phi_deg), self.cos_theta]
    }
}

/// How a source writes signed in-plane angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SignHabit {
    /// The mirror direction is theta_v = +theta_i and the retro direction theta_v = -theta_i (the paper's).
    MirrorAtEqual,
    /// The retro direction is theta_v = +theta_i: both angles are counted to the same side.
    RetroAtEqual,
}

impl SignHabit {
    /// The name in files and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MirrorAtEqual => "mirror-at-equal",
            Self::RetroAtEqual => "retro-at-equal",
        }
    }
}

/// A pair of directions: incidence L and viewing V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// From the surface to the source.
    pub incidence: Direction,
    /// From the surface to the detector.
    pub viewing: Direction,
}

/// The angles between the normal N, the half vector Q = (L + V)/|L + V| and the directions.
///
/// From the sum and difference of the angles in degrees, so that no digit is lost next to mirror, retro and grazing
/// geometries (an arccosine of N.Q loses all of them at 1e-8 rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfAngles {
    /// Angle between Q and N, radians, in [0, pi/2].
    pub phi: f64,
    /// |sin| of that angle.
    pub sin_phi: f64,
    /// N.Q.
    pub cos_phi: f64,
    /// V.Q = L.Q = |L + V| / 2.
    pub cos_q: f64,
    /// Squared sine of the angle between L and Q.
    pub sin2_q: f64,
}

impl Geometry {
    /// A geometry from four angles in degrees: incidence theta, phi, viewing theta, phi.
    ///
    /// # Errors
    /// [`DirectionError`] when one of the angles is out of range.
    pub fn from_degrees(
        theta_i_deg: f64,
        phi_i_deg: f64,
        theta_v_deg: f64,
        phi_v_deg: f64,
    ) -> Result<Self, DirectionError> {
        Ok(Self {
            incidence: Direction::from_degrees(theta_i_deg, phi_i_deg)?,
            viewing: Direction::from_degrees(theta_v_deg, phi_v_deg)?,
        })
    }

    /// A geometry from signed in-plane angles in degrees: with [`SignHabit::MirrorAtEqual`], incidence +t is (t, 180)
    /// and viewing +t is (t, 0); with [`SignHabit::RetroAtEqual`] the incidence is counted to the other side.
    ///
    /// # Errors
    /// [`DirectionError::Signed`] outside [-90, 90].
    pub fn from_signed(theta_i_deg: f64, theta_v_deg: f64, habit: SignHabit) -> Result<Self, DirectionError> {
        for angle in [theta_i_deg, theta_v_deg] {
            if !(-90.0..=90.0).contains(&angle) {
                return Err(DirectionError::Signed(angle));
            }
        }
        let incidence_positive = match habit {
            SignHabit::MirrorAtEqual => theta_i_deg >= 0.0,
            SignHabit::RetroAtEqual => theta_i_deg < 0.0,
        };
        let phi_i = if incidence_positive { 180.0 } else { 0.0 };
        let phi_v = if theta_v_deg >= 0.0 { 0.0 } else { 180.0 };
        Self::from_degrees(theta_i_deg.abs(), phi_i, theta_v_deg.abs(), phi_v)
    }

    /// The signed in-plane angles (incidence, viewing) in the paper's convention (`mirror-at-equal`), degrees; `None`
    /// where a direction leaves the plane of phi = 0 and 180. A direction along the normal counts as in the plane.
    #[must_use]
    pub fn signed_deg(&self) -> Option<(f64, f64)> {
        let side = |direction: &Direction, positive_phi: f64| {
            if direction.theta_deg == 0.0 {
                return Some(0.0);
            }
            match direction.phi_deg {
                phi if phi == positive_phi => Some(direction.theta_deg),
                phi if phi == 180.0 - positive_phi => Some(-direction.theta_deg),
                _ => None,
            }
        };
        Some((side(&self.incidence, 180.0)?, side(&self.viewing, 0.0)?))
    }

    /// True where source and detector lie in the same direction to within `half_width_deg` degrees (the gap of a scan
    /// in which the detector would stand before the source).
    #[must_use]
    pub fn is_retro(&self, half_width_deg: f64) -> bool {
        // The angle between L and V is twice that between L and Q.
        let half = self.half_angles();
        2.0 * half.sin2_q.sqrt().atan2(half.cos_q).to_degrees() <= half_width_deg
    }

    /// True where either direction lies below the horizon: every term is exactly zero.
    #[must_use]
    pub fn is_below_horizon(&self) -> bool {
        self.incidence.cos_theta < 0.0 || self.viewing.cos_theta < 0.0
    }

    /// The half-vector angles. With d = phi_i - phi_v, a = sin ti - sin tv and b = cos ti - cos tv:
    /// |L+V| sin(phi) = sqrt(a^2 + 4 sin ti sin tv cos^2(d/2)), |L+V| cos(phi) = cos ti + cos tv, and
    /// 4 sin^2(theta_Q) = b^2 + a^2 + 4 sin ti sin tv sin^2(d/2), with a and b as products.
    ///
    /// Where L = -V the half vector does not exist; then `cos_q` is 0 and `phi` is 0.
    #[must_use]
    pub fn half_angles(&self) -> HalfAngles {
        let (i, v) = (&self.incidence, &self.viewing);
        let half_difference = (i.theta_deg - v.theta_deg) / 2.0;
        let (sin_sum, cos_sum) = half_sum(i.theta_deg, v.theta_deg);
        let a = 2.0 * cos_sum * sin_deg(half_difference);
        let b = -2.0 * sin_sum * sin_deg(half_difference);
        let (sin_azimuth, cos_azimuth) = half_azimuth(i.phi_deg, v.phi_deg);
        let product = 4.0 * i.sin_theta * v.sin_theta;
        let across = a.hypot(product.sqrt() * cos_azimuth);
        let along = 2.0 * cos_sum * cos_deg(half_difference);
        let length = across.hypot(along);
        let sin2_q = (b * b + a * a + product * sin_azimuth * sin_azimuth) / 4.0;
        if length == 0.0 {
            return HalfAngles { phi: 0.0, sin_phi: 0.0, cos_phi: 1.0, cos_q: 0.0, sin2_q: 1.0 };
        }
        HalfAngles {
            phi: across.atan2(along),
            sin_phi: across / length,
            cos_phi: along / length,
            cos_q: length / 2.0,
            sin2_q,
        }
    }
}

/// Sine and cosine of half the sum of two polar angles; near 90 + 90 the complements are added, which is exact.
fn half_sum(first_deg: f64, second_deg: f64) -> (f64, f64) {
    if first_deg + second_deg > 90.0 {
        let complement = ((90.0 - first_deg) + (90.0 - second_deg)) / 2.0;
        (cos_deg(complement), sin_deg(complement))
    } else {
        let half = (first_deg + second_deg) / 2.0;
        (sin_deg(half), cos_deg(half))
    }
}

/// |sin| and |cos| of half the azimuth difference; the rounding error of the difference is carried along, so that the
/// plane of incidence is kept to the last digit at every azimuth.
fn half_azimuth(phi_i_deg: f64, phi_v_deg: f64) -> (f64, f64) {
    let (larger, smaller) = if phi_i_deg >= phi_v_deg { (phi_i_deg, phi_v_deg) } else { (phi_v_deg, phi_i_deg) };
    let difference = larger - smaller;
    // Knuth's two-sum: larger - smaller = difference + error, exactly.
    let back = difference - larger;
    let error = (larger - (difference - back)) - (smaller + back);
    if difference > 90.0 && difference < 270.0 {
        let complement = ((180.0 - difference) - error) / 2.0;
        (cos_deg(complement).abs(), sin_deg(complement).abs())
    } else if difference >= 270.0 {
        let complement = ((360.0 - difference) - error) / 2.0;
        (sin_deg(complement).abs(), cos_deg(complement).abs())
    } else {
        let half = (difference + error) / 2.0;
        (sin_deg(half).abs(), cos_deg(half).abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signed_angles_follow_the_paper() {
        let mirror = Geometry::from_signed(40.0, 40.0, SignHabit::MirrorAtEqual).unwrap();
        assert_eq!((mirror.incidence.phi_deg(), mirror.viewing.phi_deg()), (180.0, 0.0));
        assert_eq!(mirror.half_angles().phi, 0.0);
        let retro = Geometry::from_signed(40.0, -40.0, SignHabit::MirrorAtEqual).unwrap();
        assert!(retro.is_retro(1e-9));
        assert_eq!(retro.half_angles().sin2_q, 0.0);
        let same = Geometry::from_signed(40.0, 40.0, SignHabit::RetroAtEqual).unwrap();
        assert!(same.is_retro(1e-9));
        assert_eq!(retro.signed_deg(), Some((40.0, -40.0)));
        assert_eq!(same.signed_deg(), Some((-40.0, 40.0)));
    }

    #[test]
    fn angles_out_of_range_are_refused() {
        assert!(Direction::from_degrees(f64::NAN, 0.0).is_err());
        assert!(Direction::from_degrees(10.0, 360.0).is_err());
        assert!(Geometry::from_signed(91.0, 0.0, SignHabit::MirrorAtEqual).is_err());
    }

    #[test]
    fn opposite_directions_have_no_half_vector_and_no_nan() {
        let half = Geometry::from_degrees(90.0, 0.0, 90.0, 180.0).unwrap().half_angles();
        assert!(half.cos_q.abs() < 1e-15 && !half.phi.is_nan());
    }
}
