//! The specular term between any two directions, and directions drawn where it is bright.

mod around;

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, Mutex};

pub(super) use around::at;

use super::vector::{Vector, across, along, dot, minus, plus, scaled};
use crate::quantity::{Direction, HalfAngles};
use crate::terms::{Denominator, Distribution, Lobe, Term, TorranceSparrow, fresnel};

/// Most interfaces whose making is kept.
const MOST_KEPT: usize = 32;

/// An interface, with what depends on its parameters alone. Its intensity is left to the spectra.
#[derive(Debug, Clone)]
pub(super) struct Interface {
    lobe: Lobe,
    spread: Spread,
    denominator: Denominator,
    index_minus_one: f64,
}

/// How polar angles of half vectors are drawn.
#[derive(Debug, Clone, Copy)]
enum Spread {
    /// Density proportional to phi exp(-rate phi^2), up to a right angle.
    Gaussian { rate: f64 },
    /// By the slopes' own distribution.
    Beckmann { width: f64 },
    /// By the slopes' own distribution.
    TrowbridgeReitz { width: f64 },
}

impl Interface {
    pub(super) fn new(term: &TorranceSparrow) -> Self {
        let width = term.roughness;
        let spread = match term.distribution.gaussian_width(width) {
            Some(width) => Spread::Gaussian { rate: (width * width).recip() },
            None if term.distribution == Distribution::Beckmann => Spread::Beckmann { width },
            None => Spread::TrowbridgeReitz { width },
        };
        Self {
            lobe: term.distribution.lobe(width),
            spread,
            denominator: term.denominator,
            index_minus_one: term.refractive_index - 1.0,
        }
    }

    /// About the angle at which D has fallen to a half, rad.
    pub(super) fn half_width(&self) -> f64 {
        match self.spread {
            Spread::Gaussian { rate } => (std::f64::consts::LN_2 / rate).sqrt(),
            Spread::Beckmann { width } => std::f64::consts::LN_2.sqrt() * width,
            Spread::TrowbridgeReitz { width } => 0.64 * width,
        }
    }

    /// D F G / den; 0 where light or view is below the horizon.
    #[inline]
    pub(super) fn value(&self, normal: Vector, light: Vector, view: Vector) -> f64 {
        let (cos_i, cos_v) = (dot(normal, light), dot(normal, view));
        if cos_i < 0.0 || cos_v < 0.0 {
            return 0.0;
        }
        let sum = plus(light, view);
        let length = dot(sum, sum).sqrt();
        if length == 0.0 {
            return 0.0;
        }
        let apart = minus(normal, scaled(sum, 1.0 / length));
        let s = (0.25 * dot(apart, apart)).min(1.0);
        let between = minus(light, view);
        let cos_phi = ((cos_i + cos_v) / length).min(1.0);
        let half = HalfAngles {
            phi: 2.0 * s.sqrt().asin(),
            sin_phi: 2.0 * (s * (1.0 - s)).sqrt(),
            cos_phi,
            cos_q: 0.5 * length,
            sin2_q: 0.25 * dot(between, between),
        };
        let d = self.lobe.evaluate(&half).value;
        if d == 0.0 {
            return 0.0;
        }
        d * (fresnel(&half, self.index_minus_one).value * self.masking(cos_i, cos_v, 4.0 * cos_phi / length))
    }

    /// G over the denominator in a form that keeps its one-sided limit where light or view grazes: a division by 0 gives an infinite
    /// number, and the other is taken.
    fn masking(&self, cos_i: f64, cos_v: f64, twice_ratio: f64) -> f64 {
        let over = |cosine: f64, other: f64| (1.0 / cosine).min(twice_ratio * (other / cosine).min(1.0));
        match self.denominator {
            Denominator::CosThetaI => over(cos_i, cos_v),
            Denominator::CosThetaV => over(cos_v, cos_i),
            Denominator::CosICosV => (1.0 / (cos_i * cos_v)).min(twice_ratio / cos_i.max(cos_v)),
        }
    }

    /// The most that D F G / den can be where the half vector stands between so far and so far from the normal (rad) and light and
    /// view at most so far from it (`least_cos_q`, a cosine). Infinite where nothing bounds it.
    pub(super) fn most(&self, from: f64, to: f64, least_cos_q: f64) -> f64 {
        let half = |phi: f64, cos_q: f64| {
            let (sin_phi, cos_phi) = phi.sin_cos();
            HalfAngles { phi, sin_phi, cos_phi, cos_q, sin2_q: 1.0 - cos_q * cos_q }
        };
        // D falls or grows all along a ring, but for Beckmann's, which is largest where tan^2(phi) = 2 m^2 - 1.
        let d = |phi: f64| self.lobe.evaluate(&half(phi, 1.0)).value;
        let turn = match self.spread {
            Spread::Beckmann { width } => (2.0 * width * width - 1.0).max(0.0).sqrt().atan(),
            Spread::Gaussian { .. } | Spread::TrowbridgeReitz { .. } => from,
        };
        let d = d(from).max(d(to)).max(d(turn.clamp(from, to)));
        if d == 0.0 {
            return 0.0;
        }
        // Neither cosine is below that of both angles together; G over one cosine is at most 2 cos(phi) / cos(theta_Q), too.
        let least = (least_cos_q.clamp(-1.0, 1.0).acos() + to).min(FRAC_PI_2).cos().max(0.0);
        let over_one = if least > 1e-12 { 1.0 / least } else { f64::INFINITY };
        let by_half = if least_cos_q > 0.0 { 2.0 * from.cos() / least_cos_q } else { f64::INFINITY };
        let angular = match self.denominator {
            Denominator::CosThetaI | Denominator::CosThetaV => over_one.min(by_half),
            Denominator::CosICosV => over_one * over_one.min(by_half),
        };
        // F grows with theta_Q, or falls before it grows where n is above 2 + sqrt(3): it is largest at one of the ends.
        let f = |cos_q: f64| fresnel(&half(from, cos_q), self.index_minus_one).value;
        d * f(least_cos_q.max(0.0)).max(f(1.0)) * angular
    }

    /// A direction of light for a view, drawn by the lobe, with D F G / den over pi times its density; `None` where it falls below
    /// the horizon.
    pub(super) fn draw(&self, normal: Vector, view: Vector, numbers: [f64; 2]) -> Option<(Vector, f64)> {
        let (cos_phi, sin_phi, density) = self.spread.draw(numbers[0]);
        let [a, b] = across(normal);
        let (sin, cos) = (TAU * numbers[1]).sin_cos();
        let half = along(along(scaled(normal, cos_phi), a, sin_phi * cos), b, sin_phi * sin);
        let cos_q = dot(half, view);
        if cos_q <= 0.0 || density <= 0.0 {
            return None;
        }
        let light = minus(scaled(half, 2.0 * cos_q), view);
        if dot(normal, light) <= 0.0 {
            return None;
        }
        let weight = self.value(normal, light, view) * 4.0 * cos_q / (PI * density);
        weight.is_finite().then_some((light, weight))
    }

    /// What the interface sends of light from all around, over that which a perfect diffuser does, as [`at`] takes it.
    pub(super) fn surrounded(&self) -> Vec<f64> {
        around::table(self)
    }
}

/// What is long in the making of an interface, by its term of intensity 1: the plan of a scene asks for it, and then each picture.
type Made<T> = Mutex<Vec<(TorranceSparrow, T)>>;

fn kept<T: Clone>(all: &Made<T>, term: &TorranceSparrow, make: impl FnOnce(&TorranceSparrow) -> T) -> T {
    let term = TorranceSparrow { intensity: 1.0, ..*term };
    let lock = || all.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some((_, made)) = lock().iter().find(|(one, _)| *one == term) {
        return made.clone();
    }
    let made = make(&term);
    let mut all = lock();
    if all.len() >= MOST_KEPT {
        all.remove(0);
    }
    all.push((term, made.clone()));
    made
}

/// [`Interface::surrounded`], kept.
pub(super) fn surrounded(term: &TorranceSparrow) -> Arc<Vec<f64>> {
    static KEPT: Made<Arc<Vec<f64>>> = Mutex::new(Vec::new());
    kept(&KEPT, term, |term| Arc::new(Interface::new(term).surrounded()))
}

/// The largest directional albedo of an interface of intensity 1 up to 80 degrees: with the paper's denominator that beyond has no
/// bound.
pub(super) fn most_albedo(term: &TorranceSparrow) -> f64 {
    static KEPT: Made<f64> = Mutex::new(Vec::new());
    kept(&KEPT, term, |term| {
        let at = |theta: f64| {
            let direction = Direction::from_degrees(theta, 0.0).ok()?;
            Term::TorranceSparrow(*term).directional_albedo(&direction).ok().map(|found| found.value)
        };
        [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0].into_iter().filter_map(at).fold(0.0, f64::max)
    })
}

impl Spread {
    /// Cosine and sine of a polar angle, with its density per solid angle.
    fn draw(self, number: f64) -> (f64, f64, f64) {
        match self {
            Self::Gaussian { rate } => {
                // 1 - exp(-rate (pi/2)^2), also where the lobe is wider than the hemisphere.
                let all = -(-rate * FRAC_PI_2 * FRAC_PI_2).exp_m1();
                let phi = (-(-number * all).ln_1p() / rate).sqrt().min(FRAC_PI_2);
                let (sin, cos) = phi.sin_cos();
                let over_sine = if phi < 1e-8 { 1.0 } else { phi / sin };
                (cos, sin, rate * over_sine * (-rate * phi * phi).exp() / (PI * all))
            }
            Self::Beckmann { width } => {
                let square = -width * width * (-number).ln_1p();
                let cos2 = 1.0 / (1.0 + square);
                let density = (-square / (width * width)).exp() / (PI * width * width * cos2 * cos2.sqrt());
                (cos2.sqrt(), (square * cos2).sqrt(), density)
            }
            Self::TrowbridgeReitz { width } => {
                let square = width * width * number / (1.0 - number);
                let cos2 = 1.0 / (1.0 + square);
                let (cos, sin2) = (cos2.sqrt(), square * cos2);
                let under = sin2 + width * width * cos2;
                (cos, sin2.sqrt(), width * width * cos / (PI * under * under))
            }
        }
    }
}
