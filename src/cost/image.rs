//! The ladder of a scene: what tolerances, steps of the wavelength, bounces and samples cost.

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::Patience;
use crate::simulate::{Bounces, Choice, Effect, Kept, Layer, NoPicture, Picture, Scene, Watch, plan};

/// CIELAB distances that may be missing.
const TOLERANCES: [f64; 6] = [0.0, 0.1, 0.3, 1.0, 3.0, 10.0];
/// Steps of the wavelength, as multiples of the scene's.
const STEPS: [f64; 3] = [2.0, 4.0, 8.0];
/// Numbers of bounces.
const BOUNCES: [u32; 5] = [0, 1, 2, 4, 8];
/// The scene's samples times this, and over it.
const SAMPLES: [(u32, u32); 4] = [(4, 1), (1, 4), (1, 16), (1, 64)];
/// How many times as many samples the reference has, from other random numbers: its noise is a third of the scene's.
const SURER: u32 = 8;

/// One way to draw a scene.
struct Setting {
    name: String,
    knob: &'static str,
    options: Vec<String>,
    scene: Scene,
    choice: Choice,
    /// The tolerance that it is planned with; `None` where nothing is planned.
    planned: Option<f64>,
    note: Option<String>,
}

/// What each way of drawing a scene costs. Colours are drawn, whatever the scene keeps.
///
/// # Errors
/// [`NoPicture`] for a scene that cannot be drawn.
pub fn image_ladder(scene: &Scene, subject: String, patience: Patience) -> Result<Ladder, NoPicture> {
    let (everything, samples) = (Choice::everything(scene.bounces, scene.grid.step()), scene.samples);
    let full = drawn(scene, &everything)?;
    let is_random = !full.noise.is_empty();
    let reference = match is_random {
        true => drawn(&surer(scene), &plan(scene, Kept::Colour, 0.0)?.choice)?,
        false => full.clone(),
    };
    let mut candidates = Vec::new();
    for Setting { name, knob, options, scene, choice, planned, note } in settings(scene, everything, is_random)? {
        // What cannot be drawn so is no rung: in coarse steps a material may seem to send back more than it receives.
        let Ok(picture) = drawn(&scene, &choice) else { continue };
        let distances = reference.lab_distances(&picture).unwrap_or_default();
        let squares = distances.iter().map(|one| one * one).sum::<f64>();
        // Random numbers are the same wherever as many are drawn: what is left beside them is what the rung leaves out.
        let systematic = full.lab_distances(&picture).filter(|_| is_random && scene.samples == samples);
        let systematic = systematic.map(|all| all.into_iter().fold(0.0, f64::max));
        let systematic = systematic.map(|error| format!("beside the same random numbers {error:.1e}"));
        let note = note.into_iter().chain(systematic).collect::<Vec<_>>().join("; ");
        candidates.push(Candidate {
            name,
            knob: knob.to_owned(),
            options,
            error: Some(distances.iter().copied().fold(0.0, f64::max)),
            second_error: Some((squares / distances.len().max(1) as f64).sqrt()),
            bytes: None,
            note: Some(note).filter(|note| !note.is_empty()),
            work: Box::new(move || {
                // Who renders so pays for the plan, too.
                let is_planned = planned.is_none_or(|tolerance| plan(&scene, Kept::Colour, tolerance).is_ok());
                std::hint::black_box(is_planned && drawn(&scene, &choice).is_ok());
            }),
            times: 1.0,
            read: None,
        });
    }
    let of_noise = || {
        let mut noise = reference.noise.clone();
        noise.sort_by(f32::total_cmp);
        format!(
            "all of the scene with {SURER} times as many samples and other random numbers (standard error of Y {:.1e} in the median, {:.1e} \
             at most, white being 1)",
            noise[noise.len() / 2],
            noise[noise.len() - 1]
        )
    };
    let meaning = Meaning {
        reference: match is_random {
            true => of_noise(),
            false => "the scene simulated in full, with the whole product at every pixel".to_owned(),
        },
        error: match is_random {
            true => "largest CIELAB distance (1976) of a pixel, noise and all".to_owned(),
            false => "largest CIELAB distance (1976) of a pixel".to_owned(),
        },
        axis: "largest colour difference of a pixel (CIE 1976)".to_owned(),
        second_error: Some("root mean square of that distance over the pixels".to_owned()),
        time: "seconds to draw the total in colour on all threads, with its plan, without PNG and EXR".to_owned(),
        read_time: None,
    };
    Ok(measured(Task::Image, subject, meaning, candidates, patience))
}

/// The same scene with less noise, by its own random numbers.
fn surer(scene: &Scene) -> Scene {
    Scene { samples: scene.samples.saturating_mul(SURER), seed: scene.seed.wrapping_add(1), ..scene.clone() }
}

/// In full, by plans, and with less of one thing at a time beside the plan that leaves out nothing.
fn settings(scene: &Scene, everything: Choice, is_random: bool) -> Result<Vec<Setting>, NoPicture> {
    let exact = plan(scene, Kept::Colour, 0.0)?.choice;
    let of = |name: String, knob, options: &[&str], scene: Scene, choice| {
        let options = options.iter().map(|word| (*word).to_owned()).collect();
        Setting { name, knob, options, scene, choice, planned: Some(0.0), note: None }
    };
    let mut settings = vec![
        Setting { planned: None, ..of("everything".to_owned(), IN_FULL, &["--everything"], scene.clone(), everything) },
        of("plan, product by pixel".to_owned(), IN_FULL, &["--by-pixel"], scene.clone(), exact.by_pixel()),
    ];
    for tolerance in TOLERANCES {
        let found = plan(scene, Kept::Colour, tolerance)?;
        // The same plan is the same rung.
        if settings.last().is_some_and(|last| last.knob == PLANNED && last.choice == found.choice) {
            continue;
        }
        let skipped = found.effects.iter().filter(|one| !one.simulate).map(|one| one.effect.name());
        let note = format!("bound {:.3}; left out: {}", found.bound.delta_e, or_nothing(skipped.collect()));
        let options = ["--max-delta-e", &tolerance.to_string()];
        let setting = of(format!("tolerance {tolerance}"), PLANNED, &options, scene.clone(), found.choice);
        settings.push(Setting { planned: Some(tolerance), note: Some(note), ..setting });
    }
    for times in STEPS {
        let step = scene.grid.step() * times;
        let Ok(grid) = scene.grid.in_steps_of(step) else { continue };
        let coarser = Scene { grid, ..scene.clone() };
        let choice = plan(&coarser, Kept::Colour, 0.0)?.choice;
        settings.push(of(
            format!("{step} nm"),
            "step of the wavelength",
            &["--step", &step.to_string()],
            coarser,
            choice,
        ));
    }
    let is_fewer = |most: &u32| match scene.bounces {
        Bounces::All => true,
        Bounces::Most(all) => *most < all,
    };
    for most in BOUNCES.into_iter().filter(|most| exact.has(Effect::Interreflection) && is_fewer(most)) {
        let fewer = Scene { bounces: Bounces::Most(most), ..scene.clone() };
        let choice = plan(&fewer, Kept::Colour, 0.0)?.choice;
        let name = if most == 1 { "1 bounce".to_owned() } else { format!("{most} bounces") };
        settings.push(of(name, "bounces", &["--bounces", &most.to_string()], fewer, choice));
    }
    for (times, over) in SAMPLES.into_iter().filter(|(_, over)| is_random && scene.samples / over > 0) {
        let samples = scene.samples.saturating_mul(times) / over;
        let fewer = Scene { samples, ..scene.clone() };
        let name = if samples == 1 { "1 sample".to_owned() } else { format!("{samples} samples") };
        settings.push(of(name, "samples", &["--samples", &samples.to_string()], fewer, exact));
    }
    Ok(settings)
}

/// The knob of what a plan may leave out.
const PLANNED: &str = "plan";
/// The knob of what leaves the products to the pixels.
const IN_FULL: &str = "whole product at every pixel";

fn or_nothing(names: Vec<&str>) -> String {
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

fn drawn(scene: &Scene, choice: &Choice) -> Result<Picture, NoPicture> {
    Picture::draw(scene, choice, Kept::Colour, &[Layer::Total], &Watch::default())
}
