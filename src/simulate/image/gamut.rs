//! Colours that the display has not: fluorescent ones often are among them.

use std::fmt;

use super::srgb::Srgb;
use crate::quantity::named;

named! {
    /// What becomes of a colour outside the display's range.
    Gamut, "gamut" {
        /// Each channel by itself is brought to 0 or 1: the nearest that can be shown, of another hue.
        Clip = "clip",
        /// Mixed with the grey of its own luminance until it can be shown: the same hue in linear light, and paler.
        Desaturate = "desaturate",
    }
}

/// Below this a channel is outside by rounding alone: half a step of 16 bits.
const ROUNDING: f64 = 0.5 / 65_535.0;

/// How much of an image the display cannot show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutOfGamut {
    /// What was done with it.
    pub gamut: Gamut,
    /// Pixels with a channel below 0 or above 1 by more than half a step of 16 bits.
    pub pixels: usize,
    /// Of these with a channel above 1: a lower exposure shows them.
    pub brighter: usize,
    /// Of these with a channel below 0: purer than the display's primaries, at any exposure.
    pub purer: usize,
    /// All pixels of the image.
    pub of: usize,
    /// Most by which a linear channel lies below 0; white is 1.
    pub below: f64,
    /// Most by which a linear channel lies above 1.
    pub above: f64,
    /// Pixels with a number that is none; they are black.
    pub undefined: usize,
}

impl OutOfGamut {
    pub(super) fn new(gamut: Gamut, of: usize) -> Self {
        Self { gamut, pixels: 0, brighter: 0, purer: 0, of, below: 0.0, above: 0.0, undefined: 0 }
    }

    /// The colour as it is shown, from 0 to 1, and counted.
    pub(super) fn brought_in(&mut self, linear: [f64; 3], display: &Srgb) -> [f64; 3] {
        if linear.iter().any(|value| !value.is_finite()) {
            self.undefined += 1;
            return [0.0; 3];
        }
        let most = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
        let (below, above) = (most(linear.map(|value| -value)), most(linear.map(|value| value - 1.0)));
        (self.below, self.above) = (self.below.max(below), self.above.max(above));
        self.pixels += usize::from(below.max(above) > ROUNDING);
        self.brighter += usize::from(above > ROUNDING);
        self.purer += usize::from(below > ROUNDING);
        let shown = match self.gamut {
            Gamut::Clip => linear,
            Gamut::Desaturate => paler(linear, display.luminance(linear)),
        };
        shown.map(|value| value.clamp(0.0, 1.0))
    }
}

/// As much of a colour, the rest the grey of its luminance, as brings every channel to between 0 and 1. Above white and below black
/// there is no grey.
fn paler(linear: [f64; 3], luminance: f64) -> [f64; 3] {
    let grey = luminance.clamp(0.0, 1.0);
    let kept = linear.into_iter().fold(1.0_f64, |kept, value| {
        let room = if value > 1.0 {
            (1.0 - grey) / (value - grey)
        } else if value < 0.0 {
            grey / (grey - value)
        } else {
            1.0
        };
        kept.min(room)
    });
    linear.map(|value| grey + kept * (value - grey))
}

impl fmt::Display for OutOfGamut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let done = match self.gamut {
            Gamut::Clip => "each channel is cut at 0 and 1",
            Gamut::Desaturate => "they are paler than they are, at the same luminance",
        };
        if self.pixels == 0 {
            write!(f, "every one of {} pixels is a colour of sRGB", self.of - self.undefined)?;
        } else {
            write!(
                f,
                "{} of {} pixels ({:.2} %) are no colours of sRGB, and {done}; a channel lies up to {:.3} below 0 and {:.3} above 1, \
                 white being 1",
                self.pixels,
                self.of,
                100.0 * self.pixels as f64 / self.of as f64,
                self.below,
                self.above
            )?;
        }
        if self.undefined > 0 {
            write!(f, "; {} pixels have a number that is none, and are black", self.undefined)?;
        }
        Ok(())
    }
}
