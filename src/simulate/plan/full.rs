//! The full picture, against which plans are held.

use std::cell::OnceCell;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::grid::NoGrid;
use super::super::picture::Prepared;
use super::super::scene::{Body, Bounces, Scene};
use super::super::source::Source;
use super::bound::Bound;
use super::exchange::{Exchange, Orders, Way};
use super::lab::Interest;
use super::reach::Reach;

/// The full picture, against which plans are held.
pub(super) struct Full<'a> {
    pub(super) scene: &'a Scene,
    pub(super) choice: Choice,
    pub(super) reach: Reach,
    pub(super) prepared: Prepared,
    /// The brightest of the perfect diffuser.
    pub(super) brightest: f64,
    /// Into about how many patches bodies are cut at most.
    patches: usize,
    /// Made where light may go round.
    between: OnceCell<Option<Between>>,
}

/// Light between bodies.
pub(super) struct Between {
    pub(super) exchange: Exchange,
    orders: Orders,
    /// Ways of so many first orders, whose colours are known.
    pub(super) ways: Vec<Way>,
    known: u32,
}

/// Largest irradiances of bodies by light from others.
pub(super) struct Indirect {
    /// Of each patch.
    pub(super) by_patch: Vec<Vec<f64>>,
    /// Of each body anywhere.
    pub(super) anywhere: Vec<Vec<f64>>,
    /// The ways that come to it, of those whose colours are known: those over more bodies than this, and at most so many.
    pub(super) known: std::ops::Range<usize>,
}

impl<'a> Full<'a> {
    pub(super) fn new(scene: &'a Scene, choice: Choice, patches: usize) -> Result<Self, NoGrid> {
        let prepared = Prepared::new(scene, choice.step_nm)?;
        let lights = prepared.lights(scene);
        let sum = |j: usize| lights.iter().map(|light| light[j]).sum::<f64>();
        let brightest = (0..prepared.grid.nm().len()).map(sum).fold(0.0, f64::max);
        Ok(Self { reach: Reach::new(scene), scene, choice, prepared, brightest, patches, between: OnceCell::new() })
    }

    /// Largest irradiance of each body by the lights themselves, at every wavelength.
    pub(super) fn lit(&self) -> Vec<Vec<f64>> {
        let lights = self.prepared.lights(self.scene);
        let count = self.prepared.grid.nm().len();
        let one = |body: usize| {
            (0..count)
                .map(|j| {
                    let part = |light: usize| match self.reach.lit[body][light] * lights[light][j].abs() {
                        // A light on the very surface has no power at this wavelength.
                        value if value.is_nan() => 0.0,
                        value => value,
                    };
                    (0..lights.len()).map(part).sum()
                })
                .collect()
        };
        (0..self.scene.bodies.len()).map(one).collect()
    }

    /// Light between the bodies of this scene; `None` where nothing bounds it.
    pub(super) fn between(&self) -> Option<&Between> {
        let make = || {
            // What an interface sends to a third body is not bounded here.
            let exchange = self.reach.is_matte().then(|| Exchange::new(self.scene, self.patches))?;
            let of = |body: &Body| &self.prepared.materials[body.material];
            let materials: Vec<_> = self.scene.bodies.iter().map(of).collect();
            let lights = self.prepared.lights(self.scene);
            let orders =
                Some(&exchange).filter(|one| one.is_finite())?.orders(&materials, &lights, self.choice.bounces)?;
            let (ways, known) = exchange.ways(self.scene);
            Some(Between { exchange, orders, ways, known })
        };
        self.between.get_or_init(make).as_ref()
    }

    /// All light that may fall on each body; `None` where nothing bounds it.
    pub(super) fn incident(&self) -> Option<Vec<Vec<f64>>> {
        let mut all = self.lit();
        if all.iter().flatten().any(|value| !value.is_finite()) {
            return None;
        }
        if !self.reach.is_open() && self.choice.bounces != Bounces::Most(0) {
            let more = self.indirect(0)?.anywhere;
            for (all, more) in all.iter_mut().flatten().zip(more.into_iter().flatten()) {
                *all += more;
            }
        }
        Some(all)
    }

    /// Light that goes from body to body more often than `kept`: the first orders are known by their colours, the rest by its size.
    fn indirect(&self, kept: u32) -> Option<Indirect> {
        let Between { exchange, orders, known, .. } = self.between()?;
        let most = match self.choice.bounces {
            Bounces::All => *known,
            Bounces::Most(most) => most.min(*known),
        };
        let by_patch = orders.beyond(kept.max(most), self.choice.bounces);
        let mut anywhere: Vec<Vec<f64>> = self.lit().into_iter().map(|list| vec![0.0; list.len()]).collect();
        for (patch, incident) in exchange.patches.iter().zip(&orders.beyond(kept, self.choice.bounces)) {
            anywhere[patch.body].iter_mut().zip(incident).for_each(|(most, e)| *most = most.max(*e));
        }
        Some(Indirect { by_patch, anywhere, known: kept as usize..most as usize })
    }

    /// True where an effect adds exactly nothing anywhere.
    pub(super) fn is_nothing(&self, effect: Effect) -> bool {
        let bodies = || self.scene.bodies.iter().enumerate();
        let on = |body: &Body| &self.prepared.materials[body.material];
        match effect {
            Effect::Surround => !self.scene.sources.iter().any(Source::is_surround),
            Effect::Shadow => !self.reach.shaded.iter().flatten().any(|may| *may),
            Effect::Interreflection => self.reach.is_open() || self.choice.bounces == Bounces::Most(0),
            Effect::Specular => {
                !self.reach.has_interface.iter().any(|has| *has)
                    || (self.reach.is_open() && self.reach.shining.iter().flatten().all(|most| *most == 0.0))
            }
            Effect::Luminescence if bodies().all(|(_, body)| on(body).luminescence.is_none()) => true,
            Effect::Diffuse if bodies().all(|(_, body)| on(body).elastic.iter().all(|rho| *rho == 0.0)) => true,
            Effect::Luminescence | Effect::Diffuse => self.incident().is_some_and(|incident| {
                bodies().all(|(number, body)| {
                    let material = on(body);
                    match (effect, &material.luminescence) {
                        (Effect::Luminescence, None) => true,
                        (Effect::Luminescence, Some(matrix)) => {
                            let is_dark = |row: ndarray::ArrayView1<'_, f64>| {
                                row.iter().zip(&incident[number]).all(|(a, b)| a * b == 0.0)
                            };
                            matrix.outer_iter().all(is_dark)
                        }
                        _ => material.elastic.iter().zip(&incident[number]).all(|(a, b)| a * b == 0.0),
                    }
                })
            }),
        }
    }

    /// What no pixel changes by more than when `plan` is drawn and not this.
    pub(super) fn bound(&self, plan: &Choice) -> Bound {
        self.bound_of(plan, Interest::ALL)
    }

    /// True where no pixel changes by more than so much.
    pub(super) fn keeps(&self, plan: &Choice, tolerance: f64) -> bool {
        self.bound_of(plan, Interest { floor: tolerance, ceiling: tolerance }).delta_e <= tolerance
    }

    fn bound_of(&self, plan: &Choice, interest: Interest) -> Bound {
        let is_same = Effect::ALL.iter().all(|effect| plan.has(*effect) || self.is_nothing(*effect));
        if is_same && plan.bounces == self.choice.bounces && plan.step_nm == self.choice.step_nm {
            return Bound::ZERO;
        }
        let Ok(prepared) = Prepared::new(self.scene, plan.step_nm) else { return Bound::UNKNOWN };
        let kept = if plan.has(Effect::Interreflection) {
            match plan.bounces {
                Bounces::All => None,
                Bounces::Most(most) => Some(most),
            }
        } else {
            Some(0)
        };
        let goes_round = !self.is_nothing(Effect::Interreflection);
        let indirect = match kept {
            _ if !goes_round => Some(None),
            Some(kept) if Bounces::Most(kept) != self.choice.bounces => self.indirect(kept).map(Some),
            _ => Some(None),
        };
        let drops = |effect: Effect| !plan.has(effect) && !self.is_nothing(effect);
        let still_round = goes_round && kept != Some(0);
        // What is left out of a body is left out of the light that it sends to others, too: that is not bounded here.
        let is_chained = still_round
            && (plan.step_nm != self.choice.step_nm
                || drops(Effect::Luminescence)
                || drops(Effect::Diffuse)
                || drops(Effect::Specular)
                || drops(Effect::Surround));
        let Some(indirect) = indirect.filter(|_| !is_chained) else { return Bound::UNKNOWN };
        let mut all = Bound::ZERO;
        for body in 0..self.scene.bodies.len() {
            if all.delta_e > interest.ceiling {
                break;
            }
            all = all.larger(self.of_body(body, plan, &prepared, indirect.as_ref(), interest.above(all.delta_e)));
        }
        all
    }
}
