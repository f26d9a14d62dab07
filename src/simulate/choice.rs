//! What is simulated, and how finely.

use super::effect::Effect;
use super::scene::Bounces;

/// What is simulated of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    effects: [bool; Effect::ALL.len()],
    /// Whether the product of matrix and incident spectrum is made at every pixel, as every renderer of bispectral surfaces does,
    /// and not once for each light.
    pub by_pixel: bool,
    /// Bounces.
    pub bounces: Bounces,
    /// Steps of the wavelength, nm.
    pub step_nm: f64,
}

impl Choice {
    /// Everything, in full.
    #[must_use]
    pub fn everything(bounces: Bounces, step_nm: f64) -> Self {
        Self { effects: [true; Effect::ALL.len()], by_pixel: true, bounces, step_nm }
    }

    /// True where the effect is simulated.
    #[must_use]
    pub fn has(&self, effect: Effect) -> bool {
        self.effects[effect as usize]
    }

    /// The same without an effect.
    #[must_use]
    pub fn without(mut self, effect: Effect) -> Self {
        self.effects[effect as usize] = false;
        self
    }
}
