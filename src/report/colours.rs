//! Colour maps that colour-blind readers can use.

use kuva::plot::ColorMap;
use kuva::render::color::Color;

use super::scale::Scale;

/// How numbers become colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Colours {
    /// Viridis over a scale: dark is small.
    Values(Scale),
    /// Blue below zero, white at zero, red above, up to this magnitude.
    AroundZero(f64),
}

impl Colours {
    pub(super) fn scale(&self) -> Scale {
        match *self {
            Self::Values(scale) => scale,
            Self::AroundZero(magnitude) => Scale::Linear { from: -magnitude, to: magnitude },
        }
    }

    /// The colour of a number; beyond the ends that of the end.
    pub(super) fn colour(&self, value: f64) -> Color {
        let position = self.scale().position(value).clamp(0.0, 1.0);
        let hex = match self {
            Self::Values(_) => ColorMap::Viridis.map(position),
            Self::AroundZero(_) => ColorMap::RedBlue.map(1.0 - position),
        };
        Color::from(hex)
    }
}
