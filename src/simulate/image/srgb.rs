//! From tristimulus values under the scene's white to what a display of sRGB is sent.
//!
//! The eye is taken to be adapted to the scene's white: von Kries scaling in the cones of Bradford (Lam 1985; ICC.1:2022, annex E) to
//! D65, then the primaries and the curve of IEC 61966-2-1.

use nalgebra::{Matrix3, Vector3};

/// XYZ to the cones of Bradford.
const BRADFORD: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];
/// x and y of red, green and blue (ITU-R BT.709).
const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
/// x and y of the white of sRGB.
const D65: [f64; 2] = [0.3127, 0.3290];

/// The way from a scene to a display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Srgb {
    /// XYZ of the scene to linear red, green and blue, white being 1.
    matrix: Matrix3<f64>,
    luminance: [f64; 3],
}

/// A white or an exposure that no display shows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoDisplay {
    /// Adaptation divides by the answer of each cone to the white.
    #[error(
        "white of XYZ ({}, {}, {}); expected finite numbers that every cone answers to: give the colour of the perfect diffuser in the scene",
        .0[0], .0[1], .0[2]
    )]
    White([f64; 3]),
    /// No factor.
    #[error("exposure {0}; expected a number above 0, 1 to show the scene's white as the display's")]
    Exposure(f64),
}

fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}

/// XYZ of a chromaticity, with a Y of 1.
fn xyz([x, y]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// How the cones of Bradford answer to a colour.
pub(in crate::simulate) fn cones(xyz: [f64; 3]) -> [f64; 3] {
    (matrix(BRADFORD) * Vector3::from(xyz)).into()
}

impl Srgb {
    /// `white` is the scene's, in the unit of its pixels: times `exposure` it is the display's.
    ///
    /// # Errors
    /// [`NoDisplay`].
    pub fn new(white: [f64; 3], exposure: f64) -> Result<Self, NoDisplay> {
        if !(exposure > 0.0 && exposure.is_finite()) {
            return Err(NoDisplay::Exposure(exposure));
        }
        let cones = matrix(BRADFORD);
        let answer = cones * Vector3::from(white);
        let gains = (cones * xyz(D65)).component_div(&answer);
        let primaries = Matrix3::from_columns(&PRIMARIES.map(xyz));
        let refused = || NoDisplay::White(white);
        if !(answer.min() > 0.0 && gains.iter().all(|gain| gain.is_finite() && *gain > 0.0)) {
            return Err(refused());
        }
        let from_cones = cones.try_inverse().ok_or_else(refused)?;
        let to_primaries = primaries.try_inverse().ok_or_else(refused)?;
        // How much of each primary makes white: its Y, for a Y of 1 in each column.
        let luminance = to_primaries * xyz(D65);
        let linear = Matrix3::from_diagonal(&luminance.map(f64::recip)) * to_primaries;
        let matrix = linear * from_cones * Matrix3::from_diagonal(&gains) * cones * exposure;
        if !matrix.iter().all(|value| value.is_finite()) {
            return Err(refused());
        }
        Ok(Self { matrix, luminance: luminance.into() })
    }

    /// Linear red, green and blue; below 0 and above 1 where the display has no such colour.
    #[must_use]
    pub fn linear(&self, xyz: [f64; 3]) -> [f64; 3] {
        (self.matrix * Vector3::from(xyz)).into()
    }

    /// Y of a linear colour over that of white.
    pub(super) fn luminance(&self, linear: [f64; 3]) -> f64 {
        self.luminance.iter().zip(linear).map(|(share, value)| share * value).sum()
    }
}

/// The curve of sRGB (IEC 61966-2-1, equations 8 and 9), from 0 to 1.
pub(super) fn encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
