//! The full picture, against which plans are held.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;

use super::super::choice::Choice;
use super::super::effect::Effect;
use super::super::grid::NoGrid;
use super::super::scene::{Body, Bounces, Scene};
use super::super::source::Source;
use super::bound::Bound;
use super::detail::Detail;
use super::exchange::{Exchange, Orders, Way, brightest_of};
use super::lab::Interest;
use super::left::is_within;
use super::reach::Reach;
use super::region::Lit;
use super::stepped::Stepped;

/// The full picture, against which plans are held.
pub(super) struct Full<'a> {
    pub(super) scene: &'a Scene,
    pub(super) choice: Choice,
    pub(super) reach: Reach,
    /// In the steps of the scene.
    pub(super) whole: Rc<Stepped>,
    /// In others that were asked for.
    others: RefCell<Vec<(f64, Rc<Stepped>)>>,
    /// The brightest of the perfect diffuser.
    pub(super) brightest: f64,
    pub(super) detail: Detail,
    /// Made where light may go round.
    between: OnceCell<Option<Between>>,
    nothing: [OnceCell<bool>; Effect::ALL.len()],
}

/// Light between bodies.
pub(super) struct Between {
    pub(super) exchange: Exchange,
    /// How much of each light each patch may get.
    pub(super) lit: Vec<Vec<Lit>>,
    /// Ways of so many first orders, whose colours are known.
    pub(super) ways: Vec<Way>,
    known: u32,
}

/// Largest irradiances by light from other bodies.
pub(super) struct Indirect {
    /// Of each body anywhere, with that of the lights; empty where no interface asks for it.
    pub(super) all: Vec<Vec<f64>>,
    /// Of each patch, or one for all, by what is drawn beyond the ways whose colours are known, and by what the full picture has more of; empty where
    /// there is none.
    pub(super) kept: Vec<Vec<f64>>,
    pub(super) lost: Vec<Vec<f64>>,
    /// In what steps the first is.
    pub(super) planned: Rc<Stepped>,
    /// Whether the first is no part of the full picture, for its wavelengths are others.
    pub(super) is_stepped: bool,
    /// Whether what an interface mirrors of others changes.
    pub(super) is_mirror_lost: bool,
}

impl<'a> Full<'a> {
    pub(super) fn new(scene: &'a Scene, choice: Choice, detail: Detail) -> Result<Self, NoGrid> {
        let whole = Stepped::new(scene, choice.step_nm)?;
        let sum = |j: usize| whole.lights.iter().map(|light| light[j]).sum::<f64>();
        let brightest = (0..whole.prepared.grid.nm().len()).map(sum).fold(0.0, f64::max);
        Ok(Self {
            reach: Reach::new(scene),
            scene,
            choice,
            whole: Rc::new(whole),
            others: RefCell::default(),
            brightest,
            detail,
            between: OnceCell::new(),
            nothing: Default::default(),
        })
    }

    fn in_steps_of(&self, step_nm: f64) -> Result<Rc<Stepped>, NoGrid> {
        if step_nm == self.choice.step_nm {
            return Ok(Rc::clone(&self.whole));
        }
        let mut others = self.others.borrow_mut();
        if let Some((_, known)) = others.iter().find(|(step, _)| *step == step_nm) {
            return Ok(Rc::clone(known));
        }
        let made = Rc::new(Stepped::new(self.scene, step_nm)?);
        others.push((step_nm, Rc::clone(&made)));
        Ok(made)
    }

    /// Largest irradiance of each body by the lights themselves, at every wavelength.
    pub(super) fn lit(&self) -> Vec<Vec<f64>> {
        let lights = &self.whole.lights;
        let count = self.whole.prepared.grid.nm().len();
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
            let exchange = self.reach.is_matte().then(|| Exchange::new(self.scene, &self.detail))?;
            let most = match self.choice.bounces {
                Bounces::All => self.detail.ways,
                Bounces::Most(most) => most.min(self.detail.ways),
            };
            let exchange = Some(exchange).filter(Exchange::is_finite)?;
            let (ways, known) = exchange.ways(self.scene, &self.whole.prepared.materials, most);
            let lit = exchange.patches.iter().map(|patch| self.lit_at(patch)).collect();
            Some(Between { exchange, lit, ways, known })
        };
        self.between.get_or_init(make).as_ref()
    }

    fn orders<'b>(&self, stepped: &'b Stepped) -> Option<&'b Orders> {
        let Between { exchange, .. } = self.between()?;
        let (materials, lights) = (&stepped.prepared.materials, &stepped.lights);
        let make = || exchange.orders(self.scene, materials, lights, self.choice.bounces, self.detail.orders);
        stepped.orders.get_or_init(make).as_ref()
    }

    /// All light that may fall on each body; `None` where nothing bounds it.
    pub(super) fn incident(&self) -> Option<Vec<Vec<f64>>> {
        let mut all = self.lit();
        if all.iter().flatten().any(|value| !value.is_finite()) {
            return None;
        }
        if self.goes_round() {
            let more = self.orders(&self.whole)?.between(0, Bounces::All, self.choice.bounces);
            let mut most = vec![vec![0.0; self.whole.prepared.grid.nm().len()]; all.len()];
            for (patch, incident) in self.between()?.exchange.patches.iter().zip(&more) {
                most[patch.body].iter_mut().zip(incident).for_each(|(most, e)| *most = f64::max(*most, *e));
            }
            all.iter_mut().flatten().zip(most.into_iter().flatten()).for_each(|(all, more)| *all += more);
        }
        Some(all)
    }

    /// Light that goes from body to body, beyond the ways whose colours are known.
    fn indirect(&self, plan: &Choice, planned: &Rc<Stepped>) -> Option<Indirect> {
        let Between { known, .. } = self.between()?;
        let has = |effect: Effect| !self.drops(plan, effect);
        let is_stepped = plan.step_nm != self.choice.step_nm;
        let drawn = plan.bounces_drawn();
        // What bodies send to others is as it is in full, as far as it is drawn.
        let is_sent = !is_stepped && has(Effect::Luminescence) && has(Effect::Surround);
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        if !is_within(known + 1, self.choice.bounces) {
        } else if is_sent && has(Effect::Diffuse) {
            let orders = self.orders(&self.whole)?;
            kept = orders.between(*known, drawn, self.choice.bounces);
            lost = orders.between(number(drawn).max(*known), Bounces::All, self.choice.bounces);
        } else {
            kept = self.orders(planned)?.between(*known, drawn, self.choice.bounces);
            lost = self.orders(&self.whole)?.between(*known, Bounces::All, self.choice.bounces);
        }
        if self.detail.orders == 0 {
            // All patches alike.
            (kept, lost) = (vec![brightest_of(&kept)], vec![brightest_of(&lost)]);
        }
        let all = if self.reach.has_interface.iter().any(|has| *has) { self.incident()? } else { Vec::new() };
        let is_mirror_lost = !(is_sent && has(Effect::Specular) && drawn == self.choice.bounces);
        Some(Indirect { all, kept, lost, planned: Rc::clone(planned), is_stepped, is_mirror_lost })
    }

    /// True where light may go from body to body.
    pub(super) fn goes_round(&self) -> bool {
        !self.reach.is_open() && self.choice.bounces != Bounces::Most(0)
    }

    /// True where a plan leaves out an effect that is there.
    fn drops(&self, plan: &Choice, effect: Effect) -> bool {
        !plan.has(effect) && !self.is_nothing(effect)
    }

    /// True where an effect adds exactly nothing anywhere.
    pub(super) fn is_nothing(&self, effect: Effect) -> bool {
        *self.nothing[effect as usize].get_or_init(|| self.adds_nothing(effect))
    }

    fn adds_nothing(&self, effect: Effect) -> bool {
        let bodies = || self.scene.bodies.iter().enumerate();
        let on = |body: &Body| &self.whole.prepared.materials[body.material];
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
            // Where the lights themselves make it, nobody needs to know how light goes round.
            Effect::Luminescence | Effect::Diffuse => {
                self.is_dark(effect, &self.lit())
                    && self.incident().is_some_and(|incident| self.is_dark(effect, &incident))
            }
        }
    }

    /// True where no body luminesces, or reflects diffusely, of what falls on it.
    fn is_dark(&self, effect: Effect, incident: &[Vec<f64>]) -> bool {
        let is_zero =
            |row: &mut dyn Iterator<Item = &f64>, incident: &[f64]| row.zip(incident).all(|(a, e)| a * e == 0.0);
        self.scene.bodies.iter().zip(incident).all(|(body, incident)| {
            let material = &self.whole.prepared.materials[body.material];
            match (effect, &material.luminescence) {
                (Effect::Luminescence, None) => true,
                (Effect::Luminescence, Some(matrix)) => {
                    matrix.outer_iter().all(|row| is_zero(&mut row.iter(), incident))
                }
                _ => is_zero(&mut material.elastic.iter(), incident),
            }
        })
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
        let Ok(planned) = self.in_steps_of(plan.step_nm) else { return Bound::UNKNOWN };
        if !self.goes_round() {
            return self.of_bodies(plan, &planned, None, interest);
        }
        let indirect = self.indirect(plan, &planned);
        // Where nothing bounds light that goes round, it must be there in the plan as it is.
        let is_left = |effect: &Effect| *effect != Effect::Shadow && self.drops(plan, *effect);
        let changes = Effect::ALL.iter().any(is_left)
            || plan.bounces_drawn() != self.choice.bounces
            || plan.step_nm != self.choice.step_nm;
        if indirect.is_none() && changes {
            return Bound::UNKNOWN;
        }
        self.of_bodies(plan, &planned, indirect.as_ref(), interest)
    }
}

fn number(bounces: Bounces) -> u32 {
    match bounces {
        Bounces::All => u32::MAX,
        Bounces::Most(most) => most,
    }
}
