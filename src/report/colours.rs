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
    /// The same over a scale around zero; both sides are as deep at the same magnitude, wherever the scale ends.
    Signed(Scale),
    /// Greys over a scale, light is small: what is told apart from coloured numbers beside it.
    Greys(Scale),
}

impl Colours {
    pub(super) fn scale(&self) -> Scale {
        match *self {
            Self::Values(scale) | Self::Signed(scale) | Self::Greys(scale) => scale,
            Self::AroundZero(magnitude) => Scale::Linear { from: -magnitude, to: magnitude },
        }
    }

    /// The colour of a number; beyond the ends that of the end.
    pub(super) fn colour(&self, value: f64) -> Color {
        let position = self.scale().position(value).clamp(0.0, 1.0);
        let hex = match self {
            Self::Values(_) => ColorMap::Viridis.map(position),
            Self::AroundZero(_) => ColorMap::RedBlue.map(1.0 - position),
            Self::Signed(scale) => ColorMap::RedBlue.map(0.5 - 0.5 * depth(*scale, value)),
            Self::Greys(_) => return grey(position),
        };
        Color::from(hex)
    }
}

/// How far from zero a number is on a scale around zero, from -1 to 1 at the greater magnitude of both ends.
fn depth(scale: Scale, value: f64) -> f64 {
    let from_zero = |value: f64| scale.position(value) - scale.position(0.0);
    let most = from_zero(scale.value(0.0)).abs().max(from_zero(scale.value(1.0)).abs());
    if most > 0.0 { (from_zero(value) / most).clamp(-1.0, 1.0) } else { 0.0 }
}

fn grey(position: f64) -> Color {
    let level = (214.0 - 196.0 * position).round() as u8;
    Color::Rgb(level, level, level)
}
