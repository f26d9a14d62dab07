//! What an eye makes of a spectrum: CIE XYZ, Lab, Luv, whiteness, and differences.
//!
//! Observers and the formula of CIEDE2000 come from a maintained crate; nothing is clipped: a fluorescent colour may be brighter
//! than white, and lie outside every gamut.

use colorimetry::lab::CieLab;
use colorimetry::observer::Observer as Table;
use colorimetry::xyz::{RelXYZ, XYZ};

use crate::quantity::named;

/// First and last wavelength of the observers, nm; they are tabulated at every nanometre.
pub(super) const VISIBLE_NM: (usize, usize) = (380, 780);

named! {
    /// A standard observer of the CIE.
    Observer, "observer" {
        /// CIE 1931, 2 degrees.
        Two = "2",
        /// CIE 1964, 10 degrees.
        Ten = "10",
    }
}

impl Observer {
    fn table(self) -> Table {
        match self {
            Self::Two => Table::Cie1931,
            Self::Ten => Table::Cie1964,
        }
    }

    /// The colour-matching functions at a whole nanometre; 0 outside 380 to 780.
    #[must_use]
    pub fn matching(self, nm: usize) -> [f64; 3] {
        self.table().xyz_at_wavelength(nm).map_or([0.0; 3], |xyz| xyz.to_array())
    }
}

/// A colour beside the white of its light, of which Y is 100.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour {
    /// Of the 2 or the 10 degree observer.
    pub observer: Observer,
    /// Tristimulus values.
    pub xyz: [f64; 3],
    /// Those of the perfect diffuser under the same light.
    pub white: [f64; 3],
}

/// CIE whiteness (CIE 15:2018, 9.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// W.
    pub whiteness: f64,
    /// T: greenish above 0, reddish below.
    pub tint: f64,
    /// True where the formula holds: light of the chromaticity of D65, W between 40 and 5 Y - 280, T between -4 and 2.
    pub is_defined: bool,
}

/// A difference of two colours, each beside its own white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// CIE 1976, in Lab.
    pub de76: f64,
    /// CIEDE2000 with all weights 1.
    pub de2000: f64,
}

impl Colour {
    /// Lightness and the two opponent colours, CIE 1976. `None` without a white.
    #[must_use]
    pub fn lab(&self) -> Option<[f64; 3]> {
        self.has_white().then(|| self.crate_lab().to_array())
    }

    /// Lightness, u* and v*, CIE 1976. `None` without a white; u* and v* are 0 for what is black.
    #[must_use]
    pub fn luv(&self) -> Option<[f64; 3]> {
        let lightness = self.lab()?[0];
        let (u, v) = uv(self.xyz).unwrap_or((0.0, 0.0));
        let (white_u, white_v) = uv(self.white)?;
        let is_black = uv(self.xyz).is_none();
        let of = |own: f64, white: f64| if is_black { 0.0 } else { 13.0 * lightness * (own - white) };
        Some([lightness, of(u, white_u), of(v, white_v)])
    }

    /// Whiteness and tint against the white of the light. `None` without chromaticities.
    #[must_use]
    pub fn whiteness(&self) -> Option<Whiteness> {
        let ((x, y), (white_x, white_y)) = (xy(self.xyz)?, xy(self.white)?);
        let (slope, d65) = match self.observer {
            Observer::Two => (1000.0, (0.3127, 0.3290)),
            Observer::Ten => (900.0, (0.3138, 0.3310)),
        };
        let whiteness = self.xyz[1] + 800.0 * (white_x - x) + 1700.0 * (white_y - y);
        let tint = slope * (white_x - x) - 650.0 * (white_y - y);
        // Lamps that stand for D65 miss its chromaticity by less than this.
        let is_daylight = (white_x - d65.0).abs() < 0.005 && (white_y - d65.1).abs() < 0.005;
        let is_white = whiteness > 40.0 && whiteness < 5.0 * self.xyz[1] - 280.0 && tint > -4.0 && tint < 2.0;
        Some(Whiteness { whiteness, tint, is_defined: is_daylight && is_white })
    }

    /// The difference to another colour; `None` without a white.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        // Each Lab is against its own white; the crate compares only what has one white in common.
        let (a, b) = (self.lab()?, other.lab()?);
        let (a, b) = (CieLab::new(a, white(self.white)), CieLab::new(b, white(self.white)));
        Some(Difference { de76: a.ciede(&b).ok()?, de2000: a.ciede2000(&b).ok()? })
    }

    fn has_white(&self) -> bool {
        self.white.iter().all(|value| *value > 0.0 && value.is_finite())
            && self.xyz.iter().all(|value| value.is_finite())
    }

    fn crate_lab(&self) -> CieLab {
        CieLab::from_rxyz(RelXYZ::new(self.xyz, white(self.white)))
    }
}

fn white(xyz: [f64; 3]) -> XYZ {
    XYZ::new(xyz, Table::Cie1931)
}

fn xy(xyz: [f64; 3]) -> Option<(f64, f64)> {
    let sum: f64 = xyz.iter().sum();
    (sum > 0.0 && sum.is_finite()).then(|| (xyz[0] / sum, xyz[1] / sum))
}

fn uv([x, y, z]: [f64; 3]) -> Option<(f64, f64)> {
    let sum = x + 15.0 * y + 3.0 * z;
    (sum > 0.0 && sum.is_finite()).then(|| (4.0 * x / sum, 9.0 * y / sum))
}
