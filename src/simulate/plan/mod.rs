//! What of a scene is simulated, why the rest need not be, and what it may change at most.

mod bound;
mod cone;
mod detail;
mod exchange;
mod full;
mod hidden;
mod lab;
mod left;
mod patch;
mod reach;
mod region;
mod rings;
mod share;
mod stepped;

pub use bound::Bound;
pub(super) use lab::lab_distance;

use schemars::JsonSchema;
use serde::Serialize;

use self::detail::Detail;
use self::full::Full;
use super::alone::is_alone;
use super::choice::Choice;
use super::effect::Effect;
use super::grid::NoGrid;
use super::material::Material;
use super::picture::{Kept, NoPicture, may_bounce};
use super::scene::{Bounces, Scene};

/// Steps of the wavelength that are tried, as multiples of the scene's.
const STEPS: [f64; 3] = [4.0, 2.0, 1.0];
/// Numbers of bounces that are tried.
const BOUNCES: [u32; 9] = [0, 1, 2, 3, 4, 6, 8, 12, 16];

/// What is done about one effect.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Decision {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub simulate: bool,
    /// Why.
    pub reason: String,
    /// What no pixel changes by more than where this effect alone is left out. `null` in JSON stands for no bound.
    pub bound: Bound,
}

/// A plan.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Plan {
    /// CIELAB distance (1976) that was allowed; 0: only what is provably nothing is left out.
    pub max_delta_e: f64,
    /// One decision for each effect.
    pub effects: Vec<Decision>,
    /// How pixels are made.
    pub route: Vec<String>,
    /// Steps of the wavelength, nm.
    pub step_nm: f64,
    /// Steps of the scene, nm.
    pub full_step_nm: f64,
    /// Bounces of the plan.
    pub bounces: Bounces,
    /// What no pixel of the plan differs by more than from the full simulation, the noise of random paths apart.
    pub bound: Bound,
    /// What is drawn.
    #[serde(skip)]
    pub choice: Choice,
}

/// Makes the plan of a picture of a scene that keeps colours or spectra: with a tolerance of 0 only what is provably nothing is left out; otherwise the cheapest plan whose bound
/// in CIELAB distance (1976) is not above it.
///
/// # Errors
/// [`NoPicture`] for a scene that cannot be drawn.
pub fn plan(scene: &Scene, kept: Kept, max_delta_e: f64) -> Result<Plan, NoPicture> {
    scene.check()?;
    let everything = Choice::everything(scene.bounces, scene.grid.step());
    // Without a tolerance bounds decide nothing: they may be wide, and must not take longer than a small part of the picture.
    let rays = cost(scene, &everything);
    let detail = if max_delta_e > 0.0 { Detail::deciding(rays) } else { Detail::telling(rays, scene.bodies.len()) };
    let full = Full::new(scene, everything, detail)?;
    let nothing: Vec<Effect> = Effect::ALL.iter().copied().filter(|effect| full.is_nothing(*effect)).collect();
    let base = Choice { by_pixel: false, ..nothing.iter().fold(everything, |choice, effect| choice.without(*effect)) };
    let alone: Vec<Bound> = Effect::ALL.iter().map(|effect| full.bound(&everything.without(*effect))).collect();
    let choice = if max_delta_e > 0.0 { cheapest((scene, kept), &full, base, &alone, max_delta_e)? } else { base };
    let choice = if choice.bounces == Bounces::Most(0) { choice.without(Effect::Interreflection) } else { choice };
    may_bounce(scene, &choice, &full.whole.prepared)?;
    let mut bound = full.bound(&choice);
    if max_delta_e > 0.0 && choice != base {
        // That has been proven, by a closer look.
        bound.delta_e = bound.delta_e.min(max_delta_e);
    }
    let decision = |(effect, alone): (&Effect, &Bound)| {
        let simulate = choice.has(*effect);
        let reason = reason(scene, &full, *effect, simulate, alone, nothing.contains(effect), max_delta_e);
        Decision { effect: *effect, simulate, reason, bound: *alone }
    };
    Ok(Plan {
        max_delta_e,
        effects: Effect::ALL.iter().zip(&alone).map(decision).collect(),
        route: route((scene, kept), &full, &choice),
        step_nm: choice.step_nm,
        full_step_nm: scene.grid.step(),
        bounces: if choice.has(Effect::Interreflection) { choice.bounces } else { Bounces::Most(0) },
        bound,
        choice,
    })
}

/// Plans in the order of their cost; the first that keeps the bound.
fn cheapest(
    (scene, kept): (&Scene, Kept),
    full: &Full<'_>,
    base: Choice,
    alone: &[Bound],
    tolerance: f64,
) -> Result<Choice, NoGrid> {
    let may_go: Vec<Effect> = Effect::ALL
        .iter()
        .zip(alone)
        .filter(|(effect, bound)| base.has(**effect) && bound.delta_e <= tolerance)
        .map(|(effect, _)| *effect)
        .collect();
    let mut bounces = vec![base.bounces];
    if base.has(Effect::Interreflection) {
        let fewer = |most: &u32| match base.bounces {
            Bounces::All => true,
            Bounces::Most(all) => *most < all,
        };
        bounces.extend(BOUNCES.iter().filter(|most| fewer(most)).map(|most| Bounces::Most(*most)));
    }
    let mut plans: Vec<(f64, Choice)> = Vec::new();
    for which in 0..1_usize << may_go.len() {
        let left = may_go
            .iter()
            .enumerate()
            .filter(|(k, _)| which >> k & 1 == 1)
            .fold(base, |choice, (_, effect)| choice.without(*effect));
        for bounces in &bounces {
            for times in STEPS {
                let step_nm = scene.grid.step() * times;
                // Whoever keeps spectra asks for these wavelengths, and not for others that look the same.
                let may_step = times == 1.0 || kept == Kept::Colour;
                if may_step && scene.grid.in_steps_of(step_nm).is_ok() {
                    let choice = Choice { bounces: *bounces, step_nm, ..left };
                    plans.push((cost(scene, &choice), choice));
                }
            }
        }
    }
    plans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let keeps = |choice: &Choice| full.keeps(choice, tolerance);
    Ok(plans.into_iter().map(|(_, choice)| choice).find(keeps).unwrap_or(base))
}

/// Work in units of about one ray: what the order of plans is made by.
fn cost(scene: &Scene, choice: &Choice) -> f64 {
    let pixels = (scene.size.0 * scene.size.1) as f64;
    let (lights, samples) = (scene.sources.len() as f64, f64::from(scene.samples));
    let wavelengths = scene.grid.nm().len() as f64 * scene.grid.step() / choice.step_nm;
    let has = |effect: Effect| f64::from(u8::from(choice.has(effect)));
    let vertices = match choice.bounces {
        Bounces::All => 6.0,
        Bounces::Most(most) => f64::from(most).min(6.0),
    };
    let per_pixel = 1.0
        + lights
            * (0.3
                + has(Effect::Shadow)
                + has(Effect::Specular)
                + 0.05 * (has(Effect::Luminescence) + has(Effect::Diffuse)))
        + samples * (has(Effect::Surround) + has(Effect::Interreflection) * vertices * (1.0 + lights));
    // The products of spectra are made once for each order of materials.
    pixels * per_pixel
        + wavelengths * wavelengths * 0.01 * (1.0 + has(Effect::Luminescence)) * scene.materials.len() as f64
}

fn reason(
    scene: &Scene,
    full: &Full<'_>,
    effect: Effect,
    simulate: bool,
    alone: &Bound,
    is_nothing: bool,
    tolerance: f64,
) -> String {
    if simulate {
        return if alone.delta_e.is_finite() {
            format!("without it a pixel may change by up to {:.3} CIELAB", alone.delta_e)
        } else {
            "no bound is known of what it adds".to_owned()
        };
    }
    if !is_nothing {
        return format!("adds at most {:.3} CIELAB, and {tolerance} may be missing", alone.delta_e);
    }
    let is_single = matches!(scene.bodies.as_slice(), [only] if only.shape.is_convex());
    let text = match effect {
        Effect::Luminescence if used(scene).all(|one| one.surface.density.iter().all(|value| *value == 0.0)) => {
            "no material luminesces"
        }
        Effect::Luminescence => "no light falls where a material is excited",
        Effect::Diffuse => "no light falls where a material reflects",
        Effect::Specular if !full.reach.has_interface.iter().any(|has| *has) => "no material has a specular term",
        Effect::Specular => "the lobe is nowhere in view",
        Effect::Shadow if is_single => "one convex body, which does not stand in its own light",
        Effect::Shadow => "no body stands between a light and another",
        Effect::Interreflection if scene.bounces == Bounces::Most(0) => "the scene asks for no bounce",
        Effect::Interreflection if is_single => "one convex body, which does not see itself",
        Effect::Interreflection => "no body sees another",
        Effect::Surround => "no light comes from all around",
    };
    text.to_owned()
}

/// Materials of bodies.
fn used(scene: &Scene) -> impl Iterator<Item = &Material> {
    scene.bodies.iter().map(|body| &scene.materials[body.material])
}

fn route((scene, kept): (&Scene, Kept), full: &Full<'_>, choice: &Choice) -> Vec<String> {
    let mut list = Vec::new();
    let (materials, lights) = (scene.materials.len(), scene.sources.len());
    let numbers = match kept {
        Kept::Colour => "three numbers per term make each colour exactly",
        Kept::Spectra => "one number per term and wavelength makes each spectrum exactly",
    };
    list.push(format!(
        "the product of matrix and light is made once for each material and light ({materials} x {lights}), and not at every pixel: \
         {numbers}"
    ));
    if kept == Kept::Colour && is_alone(scene, choice) {
        list.push(
            "one sphere under one light, seen along parallel lines: colours of many pixels at once, in closed form"
                .to_owned(),
        );
    }
    if choice.has(Effect::Surround) && full.reach.is_open() && scene.bodies.len() == 1 {
        list.push("light from all around in closed form: nothing stands before the body".to_owned());
    } else if choice.has(Effect::Surround) {
        list.push(format!(
            "light from all around by {} random directions at each pixel, with their standard error",
            scene.samples
        ));
    }
    if choice.has(Effect::Interreflection) {
        list.push(format!(
            "light from body to body by {} random paths at each pixel, with their standard error; spectra multiplied once for each order \
             of materials",
            scene.samples
        ));
    }
    if let (true, Bounces::Most(most)) =
        (choice.has(Effect::Interreflection) && choice.bounces != scene.bounces, choice.bounces)
    {
        let all = match scene.bounces {
            Bounces::All => "as often as it does".to_owned(),
            Bounces::Most(all) => format!("{all} times"),
        };
        list.push(format!("light goes from body to body {most} times at most and not {all}"));
    }
    if choice.step_nm != scene.grid.step() {
        list.push(format!("wavelengths in steps of {} nm and not {} nm", choice.step_nm, scene.grid.step()));
    }
    list
}

impl Plan {
    /// The plan as text.
    #[must_use]
    pub fn text(&self) -> String {
        let number = |value: f64| match value {
            value if !value.is_finite() => "no bound".to_owned(),
            value if value > 0.0 && value < 5e-4 => format!("{value:.0e}"),
            value => format!("{value:.3}"),
        };
        let mut text = String::from("effect            do        CIELAB  why\n");
        for one in &self.effects {
            let what = if one.simulate { "simulate" } else { "skip" };
            text +=
                &format!("{:<16}  {what:<8}  {:>8}  {}\n", one.effect.name(), number(one.bound.delta_e), one.reason);
        }
        for line in &self.route {
            text += &format!("- {line}\n");
        }
        let rest = match self.bound {
            bound if bound.is_zero() => {
                "nothing: every pixel is that of the full simulation, to the last rounding of its sums".to_owned()
            }
            bound => {
                let there =
                    bound.ciede2000_there.map_or(String::new(), |value| format!(" (CIEDE2000 there {value:.3})"));
                format!(
                    "at most {} CIELAB{there}, {:.2e} of the luminance of white",
                    number(bound.delta_e),
                    bound.luminance
                )
            }
        };
        text + &format!("what is left out changes a pixel by {rest}")
    }
}

/// What no pixel changes by more than when this is drawn and not all of the scene in full; the noise of random paths apart.
///
/// # Errors
/// [`NoPicture`] for a scene that cannot be drawn.
pub fn bound(scene: &Scene, choice: &Choice) -> Result<Bound, NoPicture> {
    scene.check()?;
    Ok(Full::new(scene, Choice::everything(scene.bounces, scene.grid.step()), Detail::FULL)?.bound(choice))
}
