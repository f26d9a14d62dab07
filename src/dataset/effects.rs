//! What an instrument does to the geometry: offsets of its angles, and the sizes of source and detector, over which a
//! reading is an average.

use crate::quantity::{Direction, Geometry, named};

named! {
    /// An effect of the instrument on the geometry.
    Effect, "instrument effect" {
        /// Zero error of the incidence angle, degrees: added to the signed in-plane angle (to theta out of the plane).
        IncidenceOffset = "incidence-offset",
        /// Zero error of the viewing angle, likewise.
        ViewingOffset = "viewing-offset",
        /// Angular diameter of the source as the sample sees it, degrees: a uniform disc.
        SourceSize = "source-size",
        /// Angular diameter of the detector's aperture as the sample sees it, degrees: a uniform disc.
        Aperture = "aperture",
    }
}

impl Effect {
    /// True for the size of a disc, which has no sign.
    #[must_use]
    pub const fn is_size(self) -> bool {
        matches!(self, Self::SourceSize | Self::Aperture)
    }
}

/// The effects of one instrument, degrees; all 0 for none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effects {
    incidence_offset: f64,
    viewing_offset: f64,
    source_size: f64,
    aperture: f64,
}

impl Effects {
    /// These effects with one of them set, degrees. A size has no sign.
    #[must_use]
    pub fn with(mut self, effect: Effect, degrees: f64) -> Self {
        match effect {
            Effect::IncidenceOffset => self.incidence_offset = degrees,
            Effect::ViewingOffset => self.viewing_offset = degrees,
            Effect::SourceSize => self.source_size = degrees.abs(),
            Effect::Aperture => self.aperture = degrees.abs(),
        }
        self
    }

    /// True where there is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The geometries whose mean reading the instrument gives for a nominal one, with their shares: seven points on each
    /// disc, exact for polynomials of the fifth degree (Stroud 1971, S2: 5-1). A point beyond 90 degrees has its share and
    /// no light.
    #[must_use]
    pub fn seen(&self, nominal: &Geometry) -> Vec<(Geometry, f64)> {
        let incidence = shifted(&nominal.incidence, self.incidence_offset, 180.0);
        let viewing = shifted(&nominal.viewing, self.viewing_offset, 0.0);
        let mut list = Vec::new();
        for (incidence, first) in disc(&incidence, self.source_size / 2.0) {
            for (viewing, second) in disc(&viewing, self.aperture / 2.0) {
                list.push((Geometry { incidence, viewing }, first * second));
            }
        }
        list
    }
}

/// A direction turned by an angle within its own plane: a signed angle keeps its sense through the normal. Signed angles are
/// positive on the side of an azimuth: in the paper's signs 180 for incidence and 0 for viewing.
fn shifted(direction: &Direction, degrees: f64, positive_phi: f64) -> Direction {
    if degrees == 0.0 {
        return *direction;
    }
    let from_positive = (direction.phi_deg() - positive_phi).to_radians().cos();
    // A negative signed angle grows towards the normal.
    let theta = direction.theta_deg() + if from_positive < -1e-9 { -degrees } else { degrees };
    let phi = if theta < 0.0 { (direction.phi_deg() + 180.0) % 360.0 } else { direction.phi_deg() };
    Direction::from_degrees(theta.abs(), phi).unwrap_or(*direction)
}

/// Seven directions on a disc of an angular radius, degrees, with their shares.
fn disc(centre: &Direction, radius: f64) -> Vec<(Direction, f64)> {
    if radius == 0.0 {
        return vec![(*centre, 1.0)];
    }
    let ring = (2.0_f64 / 3.0).sqrt() * radius.to_radians();
    let (sin, cos) = (centre.sin_theta(), centre.cos_theta());
    let (sin_phi, cos_phi) = centre.phi_deg().to_radians().sin_cos();
    // Tangents of the sphere: along theta and along phi.
    let (along, across) = ([cos * cos_phi, cos * sin_phi, -sin], [-sin_phi, cos_phi, 0.0]);
    let outward = centre.unit_vector();
    let mut list = vec![(*centre, 0.25)];
    for k in 0..6 {
        let (y, x) = (f64::from(k) * std::f64::consts::FRAC_PI_3).sin_cos();
        let [a, b, c] = [0, 1, 2].map(|i| outward[i] * ring.cos() + ring.sin() * (x * along[i] + y * across[i]));
        let theta = a.hypot(b).atan2(c).to_degrees();
        let phi = b.atan2(a).to_degrees().rem_euclid(360.0) % 360.0;
        let direction = Direction::from_degrees(theta, phi).unwrap_or(*centre);
        list.push((direction, 0.125));
    }
    list
}
