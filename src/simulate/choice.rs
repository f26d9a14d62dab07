//! What is simulated, and how finely.

use super::effect::Effect;
use super::plan::Plan;
use super::scene::Bounces;

/// What is simulated of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    pub(super) effects: [bool; Effect::ALL.len()],
    /// Whether the product of matrix and incident spectrum is made at every pixel, as every renderer of bispectral surfaces does,
    /// and not once for each light.
    pub(super) by_pixel: bool,
    /// Bounces.
    pub(super) bounces: Bounces,
    /// Steps of the wavelength, nm.
    pub(super) step_nm: f64,
}

/// How the line of a plan begins that [`Plan::by_pixel`] makes wrong.
const ONCE: &str = "the product of matrix and light is made once";

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

    /// The same with the product at every pixel.
    #[must_use]
    pub fn by_pixel(mut self) -> Self {
        self.by_pixel = true;
        self
    }

    /// The same with at most so many bounces.
    #[must_use]
    pub fn bouncing(mut self, bounces: Bounces) -> Self {
        self.bounces = bounces;
        self
    }

    /// The same in other steps of the wavelength, nm.
    #[must_use]
    pub fn in_steps_of(mut self, step_nm: f64) -> Self {
        self.step_nm = step_nm;
        self
    }

    /// Bounces.
    #[must_use]
    pub fn bounces(&self) -> Bounces {
        self.bounces
    }

    /// How often light goes from body to body where that is drawn at all.
    pub(super) fn bounces_drawn(&self) -> Bounces {
        if self.has(Effect::Interreflection) { self.bounces } else { Bounces::Most(0) }
    }

    /// Steps of the wavelength, nm.
    #[must_use]
    pub fn step_nm(&self) -> f64 {
        self.step_nm
    }
}

impl Plan {
    /// The same with the whole product at every pixel: what it skips stays skipped, and pixels cost what they cost elsewhere.
    #[must_use]
    pub fn by_pixel(mut self) -> Self {
        self.choice = self.choice.by_pixel();
        self.route.retain(|line| !line.starts_with(ONCE));
        self.route.insert(0, "the whole product of matrix and direct light at every pixel, as asked".to_owned());
        self
    }
}
