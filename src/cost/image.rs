//! The ladder of a scene: what a tolerance, and what samples cost.

use super::ladder::{Ladder, Meaning, Task};
use super::measured::{Candidate, measured};
use super::timing::Patience;
use crate::simulate::{Choice, Kept, Layer, NoPicture, Picture, Scene, Watch, plan};

/// CIELAB distances that may be missing.
const TOLERANCES: [f64; 6] = [0.0, 0.1, 0.3, 1.0, 3.0, 10.0];
/// Parts of the scene's samples.
const SAMPLES: [u32; 3] = [4, 16, 64];

/// What each way of drawing a scene costs. Colours are drawn, whatever the scene keeps.
///
/// # Errors
/// [`NoPicture`] for a scene that cannot be drawn.
pub fn image_ladder(scene: &Scene, subject: String, patience: Patience) -> Result<Ladder, NoPicture> {
    let everything = Choice::everything(scene.bounces, scene.grid.step());
    let full = drawn(scene, &everything)?;
    let mut ways =
        vec![("everything".to_owned(), "plan", vec!["--everything".to_owned()], scene.clone(), everything, None)];
    for tolerance in TOLERANCES {
        let found = plan(scene, tolerance)?;
        let skipped: Vec<&str> =
            found.effects.iter().filter(|one| !one.simulate).map(|one| one.effect.name()).collect();
        let note = format!("bound {:.3}; left out: {}", found.bound.delta_e, skipped.join(", "));
        let options = vec!["--max-delta-e".to_owned(), tolerance.to_string()];
        ways.push((format!("tolerance {tolerance}"), "plan", options, scene.clone(), found.choice, Some(note)));
    }
    if !full.noise.is_empty() {
        let exact = plan(scene, 0.0)?.choice;
        for part in SAMPLES.iter().filter(|part| scene.samples / **part > 0) {
            let samples = scene.samples / part;
            let options = vec!["--samples".to_owned(), samples.to_string()];
            let fewer = Scene { samples, ..scene.clone() };
            ways.push((format!("{samples} samples"), "samples", options, fewer, exact, None));
        }
    }
    let mut candidates = Vec::new();
    for (name, knob, options, scene, choice, note) in ways {
        let distances = full.lab_distances(&drawn(&scene, &choice)?).unwrap_or_default();
        let squares = distances.iter().map(|one| one * one).sum::<f64>();
        candidates.push(Candidate {
            name,
            knob: knob.to_owned(),
            options,
            error: Some(distances.iter().copied().fold(0.0, f64::max)),
            second_error: Some((squares / distances.len().max(1) as f64).sqrt()),
            bytes: None,
            note,
            work: Box::new(move || {
                std::hint::black_box(drawn(&scene, &choice).is_ok());
            }),
            times: 1.0,
            read: None,
        });
    }
    let noise = if full.noise.is_empty() { "" } else { "; its own noise is part of the error of other samples" };
    let meaning = Meaning {
        reference: format!(
            "the scene simulated in full, with the whole product at every pixel, and the same seed and samples{noise}"
        ),
        error: "largest CIELAB distance (1976) of a pixel".to_owned(),
        second_error: Some("root mean square of that distance over the pixels".to_owned()),
        time: "seconds to draw the total in colour on all threads, without planning, PNG and EXR".to_owned(),
        read_time: None,
    };
    Ok(measured(Task::Image, subject, meaning, candidates, patience))
}

fn drawn(scene: &Scene, choice: &Choice) -> Result<Picture, NoPicture> {
    Picture::draw(scene, choice, Kept::Colour, &[Layer::Total], &Watch::default())
}
