//! A plan leaves out what nobody can see, and says how much that is.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/scans.rs"]
mod scans;
#[path = "common/scenes.rs"]
mod scenes;
#[path = "common/units.rs"]
mod units;

use bbrf::donaldson::{Light, Reradiation};
use bbrf::simulate::{
    Ball, Body, Bounces, Bound, Camera, Choice, Cuboid, Effect, Kept, Layer, Mesh, Picture, Place, Plane, Projection,
    Rectangle, Scene, Shape, Watch, plan,
};
use scans::Random;
use scenes::*;
use units::units;

/// How many random scenes: `BBRF_SCENES` for a long run.
fn count(usual: usize) -> usize {
    std::env::var("BBRF_SCENES").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// The same where paths are drawn, which takes a hundred times as long.
fn count_of_paths(usual: usize) -> usize {
    std::env::var_os("BBRF_SCENES").map_or(usual, |_| count(usual) / 10)
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

fn direction(random: &mut Random) -> [f64; 3] {
    unit([random.normal(), random.normal(), random.normal()])
}

fn place(random: &mut Random, size: f64) -> [f64; 3] {
    [0; 3].map(|_| random.between(-size, size))
}

fn body(random: &mut Random, number: usize, materials: usize) -> Body {
    // Side by side, more or less.
    let aside = place(random, 0.4);
    let centre = [aside[0] + 1.9 * (number as f64 - 1.0), aside[1], aside[2]];
    let axes = || {
        let normal = [0.0, 0.6, 0.8];
        [[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], normal]
    };
    let shape = match (random.uniform() * 6.0) as usize {
        0 | 1 => Shape::Sphere(Ball { centre, radius: random.between(0.2, 1.0) }),
        2 => Shape::Plane(Plane {
            point: [0.0, 0.0, random.between(-2.0, -1.0)],
            normal: [0.0, 0.0, 1.0],
            rectangle: None,
        }),
        3 => {
            let [a, b, normal] = axes();
            Shape::Plane(Plane {
                point: centre,
                normal,
                rectangle: Some(Rectangle { axes: [a, b], half: [random.between(0.2, 1.5), 0.7] }),
            })
        }
        4 => {
            Shape::Box(Cuboid { centre, axes: axes(), half: [random.between(0.1, 0.8), random.between(0.1, 0.8), 0.4] })
        }
        _ => {
            let corners: Vec<[f64; 3]> =
                (0..6).map(|_| [0, 1, 2].map(|k| centre[k] + random.between(-0.8, 0.8))).collect();
            Shape::Mesh(Mesh::new(&corners, &[[0, 1, 2], [2, 3, 4], [1, 4, 5], [0, 3, 5]]).unwrap())
        }
    };
    Body { name: format!("body {number}"), shape, material: (random.uniform() * materials as f64) as usize % materials }
}

fn random_scene(random: &mut Random) -> Scene {
    let mut materials = vec![
        grey(random.between(0.0, 0.9)),
        glowing("one", random.between(0.0, 0.5), random.between(450.0, 650.0), random.between(0.0, 0.4)),
    ];
    if random.uniform() < 0.3 {
        materials[0].specular = Some(gloss(random.log_between(0.01, 0.3), random.between(0.05, 0.5)));
    }
    if random.uniform() < 0.3 {
        materials.remove((random.uniform() * 2.0) as usize % 2);
    }
    let bodies = (0..1 + (random.uniform() * 3.0) as usize).map(|k| body(random, k, materials.len())).collect();
    let mut sources: Vec<_> = (0..1 + (random.uniform() * 2.0) as usize)
        .map(|k| {
            let values = match (random.uniform() * 3.0) as usize {
                0 => [1.0, 1.0, 1.0],
                1 => [0.0, 0.0, 1.0],
                _ => [random.uniform(), random.uniform(), 0.1],
            };
            let from = direction(random);
            let place = if random.uniform() < 0.6 {
                Place::Directional(from)
            } else {
                Place::Point(from.map(|x| x * random.between(3.0, 8.0)), 4.0)
            };
            lamp(&format!("light {k}"), place, values)
        })
        .collect();
    if random.uniform() < 0.3 {
        sources.push(lamp("all", Place::Surround, [0.3, random.uniform(), 0.2]));
    }
    let mut scene = scene(bodies, materials, sources);
    let up = [0.1, 0.2, 1.0];
    let from = direction(random).map(|x| 7.0 * x);
    let projection = if random.uniform() < 0.6 {
        Projection::Orthographic { width: 5.0 }
    } else {
        Projection::Perspective { width_deg: 40.0 }
    };
    scene.camera = Camera::new(from, place(random, 0.3), up, projection).unwrap();
    scene.size = (12, 10);
    scene.samples = 2;
    scene.seed = (random.uniform() * 1e6) as u64;
    scene.bounces = if random.uniform() < 0.5 { Bounces::All } else { Bounces::Most((random.uniform() * 4.0) as u32) };
    scene
}

fn numbers(picture: &Picture) -> impl Iterator<Item = f32> {
    picture.layers.iter().flat_map(|(_, planes)| planes.iter().flatten().copied())
}

#[test]
fn with_no_tolerance_the_picture_is_that_of_the_full_simulation() {
    let mut random = Random::new(11);
    let (mut skipped, mut drawn) = (0, 0);
    for case in 0..count(1000) {
        let mut scene = random_scene(&mut random);
        scene.size = (8, 6);
        scene.samples = 1;
        let everything = everything(&scene);
        let Ok(full) = Picture::draw(&scene, &everything, Kept::Colour, Layer::ALL, &Watch::default()) else {
            continue;
        };
        let plan = plan(&scene, Kept::Colour, 0.0).unwrap();
        assert!(plan.bound.is_zero(), "case {case}: {}", plan.text());
        let planned = draw(&scene, &plan.choice);
        drawn += 1;
        skipped += plan.effects.iter().filter(|one| !one.simulate).count();
        for (a, b) in numbers(&planned).zip(numbers(&full)) {
            assert!(units(a, b) <= 1, "case {case}: {a:e}, in full {b:e}: {}", plan.text());
        }
        // Where nothing is summed in another order, not a bit changes.
        let in_order = plan.choice.by_pixel();
        let same = draw(&scene, &in_order);
        assert!(
            numbers(&same).zip(numbers(&full)).all(|(a, b)| a.to_bits() == b.to_bits()),
            "case {case}: {}",
            plan.text()
        );
    }
    assert!(drawn > 9 * count(1000) / 10 && skipped > drawn, "{skipped} effects skipped in {drawn} scenes");
}

fn lab(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| if t > 216.0 / 24_389.0 { t.cbrt() } else { 841.0 / 108.0 * t + 4.0 / 29.0 };
    let [x, y, z] = [0, 1, 2].map(|c| f(xyz[c] / white[c]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// What single precision may add to the difference of two numbers: each is off by half a unit in its last place.
fn rounding(a: f64, b: f64) -> f64 {
    (a.abs() + b.abs()) * 2.0_f64.powi(-24)
}

/// Largest CIELAB distance, and largest difference of Y that is not rounding, between two pictures.
fn apart(one: &Picture, other: &Picture) -> (f64, f64) {
    let (a, b) = (one.layer(Layer::Total).unwrap(), other.layer(Layer::Total).unwrap());
    let mut most = (0.0_f64, 0.0_f64);
    for k in 0..a[0].len() {
        let at = |planes: &[Vec<f32>]| [0, 1, 2].map(|c| f64::from(planes[c][k]));
        let (x, y) = (lab(at(a), one.white), lab(at(b), one.white));
        most.0 = most.0.max((0..3).map(|c| (x[c] - y[c]).powi(2)).sum::<f64>().sqrt());
        most.1 = most.1.max((at(a)[1] - at(b)[1]).abs() - rounding(at(a)[1], at(b)[1]));
    }
    most
}

/// What measured files and rooms have, and random scenes have not: noise below 0, the lines of a lamp, and cameras and lamps close to bodies
/// or within them.
fn hard_scene(random: &mut Random) -> Scene {
    let mut scene = random_scene(random);
    for material in &mut scene.materials {
        let surface = &material.surface;
        let (excitation, emission) = (surface.excitation_nm.clone(), surface.emission_nm.clone());
        let elastic = surface.elastic.iter().map(|rho| rho + 0.05 * random.normal()).collect();
        let density = surface.density.mapv(|value| value + 2e-5 * random.normal());
        material.surface = Reradiation::from_parts(excitation, emission, elastic, density).unwrap();
    }
    if random.uniform() < 0.5 {
        scene.sources[0].light = Light::named("FL11").unwrap();
    }
    for source in &mut scene.sources {
        if let Place::Point(place, _) = source.place {
            let near = random.between(0.1, 0.5);
            source.place = Place::Point(place.map(|x| near * x), 1.0);
        }
    }
    let from = direction(random).map(|x| x * random.between(0.3, 3.0));
    let projection = Projection::Perspective { width_deg: 70.0 };
    scene.camera = Camera::new(from, [0.0, 0.0, 0.1], [0.1, 0.2, 1.0], projection).unwrap();
    scene.bounces = Bounces::Most(0);
    scene
}

#[test]
fn no_bound_is_exceeded_where_values_lie_below_0_lamps_have_lines_and_all_is_close() {
    let mut random = Random::new(17);
    let (mut changed, mut known) = (0, 0);
    for case in 0..count(300) {
        let mut scene = hard_scene(&mut random);
        scene
            .sources
            .retain(|source| !source.is_surround() || (scene.bodies.len() == 1 && scene.bodies[0].shape.is_convex()));
        // What shines back more than falls in is shown, and a white of nothing is no scene.
        let Ok(full) = Picture::draw(&scene, &everything(&scene), Kept::Colour, Layer::ALL, &Watch::default()) else {
            continue;
        };
        let all = everything(&scene);
        for choice in Effect::ALL.iter().map(|effect| all.without(*effect)).chain([all.in_steps_of(2.0 * STEP)]) {
            let bound = bbrf::simulate::bound(&scene, &choice).unwrap();
            let (delta_e, luminance) = apart(&full, &draw(&scene, &choice));
            assert!(delta_e <= bound.delta_e + 1e-4, "case {case}: {delta_e} and {bound:?}: {choice:?} of {scene:?}");
            assert!(luminance <= bound.luminance * (1.0 + 1e-9), "case {case}: {luminance} and {bound:?}: {choice:?}");
            changed += usize::from(delta_e > 0.01);
            known += usize::from(bound.delta_e.is_finite());
        }
    }
    println!("{changed} plans changed a pixel, {known} had a bound");
    assert!(changed > count(300) && known > 4 * count(300), "{changed} {known}");
}

/// Each effect alone, wherever it is no matter of chance: the difference that leaving it out makes is never above the bound.
#[test]
fn no_pixel_changes_by_more_than_the_bound_and_the_bound_is_not_idle() {
    let mut random = Random::new(12);
    let mut ratios: Vec<(Effect, f64)> = Vec::new();
    for case in 0..count(400) {
        let mut scene = random_scene(&mut random);
        // Larger, so that the worst place is not between two pixels.
        scene.size = (60, 50);
        scene.bounces = Bounces::Most(0);
        scene
            .sources
            .retain(|source| !source.is_surround() || (scene.bodies.len() == 1 && scene.bodies[0].shape.is_convex()));
        let planned = plan(&scene, Kept::Colour, 0.0).unwrap();
        let full = draw(&scene, &planned.choice);
        for decision in &planned.effects {
            let left = draw(&scene, &planned.choice.without(decision.effect));
            let (delta_e, luminance) = apart(&full, &left);
            let slack = 1e-4;
            // What a plan without a tolerance says takes no more time than the picture is worth; beside it the closer look.
            let close = bbrf::simulate::bound(&scene, &planned.choice.without(decision.effect)).unwrap();
            for bound in [decision.bound, close] {
                assert!(delta_e <= bound.delta_e + slack, "case {case}: {delta_e} and {bound:?}: {decision:?}");
                assert!(luminance <= bound.luminance, "case {case}: {luminance} and {bound:?}: {decision:?}");
            }
            if decision.simulate && delta_e > 0.01 {
                ratios.push((decision.effect, close.delta_e / delta_e));
            }
        }
    }
    for effect in [Effect::Luminescence, Effect::Diffuse, Effect::Specular, Effect::Shadow, Effect::Surround] {
        let mut own: Vec<f64> = ratios.iter().filter(|(one, _)| *one == effect).map(|(_, ratio)| *ratio).collect();
        own.sort_by(f64::total_cmp);
        println!("{effect}: bound over difference, median {:.2} of {}", own[own.len() / 2], own.len());
        assert!(own.len() > 5 && own[own.len() / 2] < 10.0, "{effect}: {own:?}");
    }
}

/// Two pictures of as many samples in full, of other seeds: the first says where the difference is largest and the second how large it is
/// there.
struct Twice {
    scene: Scene,
    first: Picture,
    second: Picture,
}

impl Twice {
    /// `None` for a scene that cannot be drawn.
    fn draw(mut scene: Scene) -> Option<Self> {
        scene.size = (60, 50);
        scene.samples = 50;
        let first = Picture::draw(&scene, &everything(&scene), Kept::Colour, Layer::ALL, &Watch::default()).ok()?;
        let second = draw(&Scene { seed: scene.seed + 1, ..scene.clone() }, &everything(&scene));
        Some(Self { scene, first, second })
    }

    /// The bound over the difference to what a plan draws, where it is seen; `None` for the bound where there is none. The mean of both
    /// pictures, less five times its noise, must be below the bound.
    fn hold(&self, case: usize, choice: &Choice) -> (Option<Bound>, Option<f64>) {
        let Self { scene, first, second } = self;
        let bound = bbrf::simulate::bound(scene, choice).unwrap();
        if !bound.delta_e.is_finite() {
            return (None, None);
        }
        let less = draw(scene, choice);
        let colour =
            |picture: &Picture, k: usize| [0, 1, 2].map(|c| f64::from(picture.layer(Layer::Total).unwrap()[c][k]));
        let distance = |a: [f64; 3], b: [f64; 3]| {
            let (a, b) = (lab(a, first.white), lab(b, first.white));
            (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
        };
        let mut most = (0.0_f64, 0);
        for k in 0..scene.size.0 * scene.size.1 {
            let (a, b, base) = (colour(first, k), colour(second, k), colour(&less, k));
            let noise = [first, second, &less].map(|one| one.noise.get(k).copied().map_or(0.0, f64::from));
            let noise = 0.5 * noise[0].hypot(noise[1]).hypot(2.0 * noise[2]);
            let mean = [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]));
            let difference = mean[1] - base[1];
            let sure = (difference.abs() - 5.0 * noise).max(0.0) / difference.abs();
            assert!(
                difference.abs() - 5.0 * noise <= bound.luminance + rounding(mean[1], base[1]),
                "case {case}: {difference} +- {noise} beyond {bound:?}: {choice:?}"
            );
            if sure > 0.0 {
                let sure = [0, 1, 2].map(|c| base[c] + sure * (mean[c] - base[c]));
                let delta_e = distance(sure, base);
                assert!(delta_e <= bound.delta_e + 1e-4, "case {case}: {delta_e} beyond {bound:?}: {choice:?}");
            }
            let found = distance(a, base);
            most = if found > most.0 { (found, k) } else { most };
        }
        let there = distance(colour(second, most.1), colour(&less, most.1));
        (Some(bound), (there > 0.05).then(|| bound.delta_e / there))
    }
}

fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list.get(list.len() / 2).copied().unwrap_or(f64::NAN)
}

fn has_interface(scene: &Scene) -> bool {
    scene.materials.iter().any(|one| one.specular.is_some())
}

#[test]
fn interreflection_is_bounded_to_any_number_of_bounces() {
    let mut random = Random::new(13);
    let (mut ratios, mut bounded, mut unknown) = (Vec::new(), 0, 0);
    for case in 0..count_of_paths(60) {
        let mut scene = random_scene(&mut random);
        scene.sources.retain(|source| !source.is_surround());
        if scene.bounces == Bounces::Most(0) {
            scene.bounces = Bounces::All;
        }
        let Some(twice) = Twice::draw(scene) else { continue };
        let scene = &twice.scene;
        for kept in [0, 1] {
            if scene.bounces == Bounces::Most(1) && kept == 1 {
                continue;
            }
            let fewer = everything(scene).bouncing(Bounces::Most(kept));
            let fewer = if kept == 0 { fewer.without(Effect::Interreflection) } else { fewer };
            let (bound, ratio) = twice.hold(case, &fewer);
            // What an interface sends on has no bound; all else has one.
            assert!(bound.is_some() || has_interface(scene), "case {case}: {scene:?}");
            bounded += usize::from(bound.is_some());
            unknown += usize::from(bound.is_none());
            ratios.extend(ratio);
        }
    }
    println!("interreflection: bound over difference, median {:.2} of {}", median(ratios.clone()), ratios.len());
    println!("{bounded} had a bound, {unknown} of those with an interface none");
    assert!(bounded > unknown, "{bounded} had a bound, {unknown} had none");
    assert!(median(ratios.clone()) < 10.0, "{ratios:?}");
}

/// What is left out of bodies is left out of the light that they send to others, too.
#[test]
fn what_is_left_out_while_light_goes_round_is_bounded() {
    let mut random = Random::new(15);
    let mut ratios: Vec<(&str, f64)> = Vec::new();
    // Scene 67 has all of its brightest place in a shadow that one of the plans does not draw.
    for case in 0..count_of_paths(70) {
        let mut scene = random_scene(&mut random);
        scene.materials.iter_mut().for_each(|one| one.specular = None);
        scene.bounces = if case % 2 == 0 { Bounces::All } else { Bounces::Most(1 + case as u32 % 4) };
        let Some(twice) = Twice::draw(scene) else { continue };
        let all = everything(&twice.scene);
        let fewer = all.without(Effect::Luminescence).bouncing(Bounces::Most(1)).in_steps_of(2.0 * STEP);
        for (kind, choice) in [
            ("luminescence", all.without(Effect::Luminescence)),
            ("diffuse", all.without(Effect::Diffuse)),
            ("surround", all.without(Effect::Surround)),
            ("shadow", all.without(Effect::Shadow)),
            ("twice the step", all.in_steps_of(2.0 * STEP)),
            ("several", fewer),
        ] {
            let (bound, ratio) = twice.hold(case, &choice);
            assert!(bound.is_some(), "case {case}: {kind} of {:?}", twice.scene);
            ratios.extend(ratio.map(|ratio| (kind, ratio)));
        }
    }
    for kind in ["luminescence", "diffuse", "surround", "shadow", "twice the step", "several"] {
        let own: Vec<f64> = ratios.iter().filter(|(one, _)| *one == kind).map(|(_, ratio)| *ratio).collect();
        println!(
            "{kind} while light goes round: bound over difference, median {:.2} of {}",
            median(own.clone()),
            own.len()
        );
        assert!(own.len() > 5 && median(own.clone()) < 10.0, "{kind}: {own:?}");
    }
}

/// At every wavelength, too, also where a plan has fewer of them.
#[test]
fn no_wavelength_changes_by_more_than_the_radiance_of_the_bound() {
    let mut random = Random::new(16);
    let mut compared = 0;
    for case in 0..count(100) {
        let mut scene = random_scene(&mut random);
        scene.sources.retain(|source| !source.is_surround());
        scene.bounces = Bounces::Most(0);
        // Of light that is 1 at all wavelengths a perfect diffuser makes as many as there are lights, over pi.
        scene.sources = scene.sources.iter().map(|source| white(&source.name, source.place)).collect();
        let spectra =
            |choice: &Choice| Picture::draw(&scene, choice, Kept::Spectra, &[Layer::Total], &Watch::default()).unwrap();
        let all = everything(&scene);
        let full = spectra(&all);
        let plans = Effect::ALL.iter().map(|effect| all.without(*effect)).chain([all.in_steps_of(2.0 * STEP)]);
        for choice in plans {
            let bound = bbrf::simulate::bound(&scene, &choice).unwrap();
            let less = spectra(&choice);
            for (j, nm) in full.nm.iter().enumerate() {
                let Some(other) = less.nm.iter().position(|one| one == nm) else { continue };
                let planes = [&full.layers[0].1[j], &less.layers[0].1[other]];
                for (a, b) in planes[0].iter().zip(planes[1]).map(|(a, b)| (f64::from(*a), f64::from(*b))) {
                    let change = ((a - b).abs() - rounding(a, b)) * std::f64::consts::PI / scene.sources.len() as f64;
                    assert!(change <= bound.radiance * (1.0 + 1e-9), "case {case}: {change} at {nm} nm, {bound:?}");
                    compared += usize::from(change > 0.0);
                }
            }
        }
    }
    assert!(compared > 1000, "{compared}");
}

/// A box about a tilted triangle has its middle beside the plane of the triangle.
#[test]
fn a_tilted_triangle_beside_a_lamp_is_lit_by_no_more_than_the_bound() {
    let mut random = Random::new(17);
    for case in 0..count(100) {
        let triangle = |random: &mut Random, centre: [f64; 3]| {
            let corners: Vec<[f64; 3]> = (0..3).map(|_| centre.map(|x| x + random.between(-1.0, 1.0))).collect();
            let shape = Shape::Mesh(Mesh::new(&corners, &[[0, 1, 2]]).unwrap());
            Body { name: "triangle".to_owned(), shape, material: 0 }
        };
        let bodies = vec![triangle(&mut random, [0.0; 3]), triangle(&mut random, [0.8, 0.3, 0.2])];
        let lamp = Place::Point(direction(&mut random).map(|x| 0.7 * x), 0.5);
        let mut scene = scene(bodies, vec![glowing("one", 0.5, 560.0, 0.3)], vec![white("lamp", lamp)]);
        scene.bounces = Bounces::Most(1);
        let Some(twice) = Twice::draw(scene) else { continue };
        let all = everything(&twice.scene);
        for effect in [Effect::Interreflection, Effect::Shadow, Effect::Luminescence] {
            twice.hold(case, &all.without(effect));
        }
    }
}

#[test]
fn with_a_tolerance_the_plan_keeps_it_and_does_less() {
    let mut random = Random::new(14);
    let (mut fewer, mut cases) = (0, 0);
    for case in 0..count(120) {
        let mut scene = random_scene(&mut random);
        scene.sources.retain(|source| !source.is_surround());
        scene.bounces = Bounces::Most(0);
        let exact = plan(&scene, Kept::Colour, 0.0).unwrap();
        let full = draw(&scene, &exact.choice);
        for tolerance in [0.5, 5.0] {
            let rough = plan(&scene, Kept::Colour, tolerance).unwrap();
            assert!(rough.bound.delta_e <= tolerance, "case {case}: {}", rough.text());
            let (delta_e, luminance) = apart(&full, &draw(&scene, &rough.choice));
            assert!(delta_e <= rough.bound.delta_e + 1e-4, "case {case}: {delta_e}: {}", rough.text());
            assert!(luminance <= rough.bound.luminance, "case {case}: {luminance}: {}", rough.text());
            cases += 1;
            fewer += usize::from(rough.choice != exact.choice);
        }
    }
    assert!(fewer > cases / 4, "{fewer} of {cases} plans do less");
}

/// Whoever keeps spectra gets the wavelengths that the scene names, whatever a colour would allow.
#[test]
fn a_plan_of_spectra_keeps_their_wavelengths_and_says_what_it_makes() {
    let sun = Place::Directional(unit([0.2, -1.0, 0.5]));
    let scene = scene(vec![ball([0.0; 3], 1.0, 0)], vec![glowing("one", 0.3, 560.0, 0.3)], vec![white("sun", sun)]);
    let [colours, spectra] = [Kept::Colour, Kept::Spectra].map(|kept| plan(&scene, kept, 20.0).unwrap());
    assert!(colours.step_nm > STEP && spectra.step_nm == STEP, "{} {}", colours.step_nm, spectra.step_nm);
    assert!(colours.text().contains("three numbers per term") && colours.text().contains("many pixels at once"));
    assert!(spectra.text().contains("one number per term and wavelength") && !spectra.text().contains("many pixels"));
}

#[test]
fn every_skip_has_its_reason() {
    let sun = Place::Directional(unit([0.2, -1.0, 0.5]));
    let text = |scene: &Scene, effect: Effect| {
        let plan = plan(scene, Kept::Colour, 0.0).unwrap();
        let one = plan.effects.iter().find(|one| one.effect == effect).unwrap().clone();
        if one.simulate { "simulated".to_owned() } else { one.reason }
    };
    let single = scene(vec![ball([0.0; 3], 1.0, 0)], vec![glowing("one", 0.3, 560.0, 0.3)], vec![white("sun", sun)]);
    assert!(text(&single, Effect::Shadow).contains("one convex body"));
    assert!(text(&single, Effect::Interreflection).contains("does not see itself"));
    assert!(text(&single, Effect::Specular).contains("no material has a specular term"));
    assert!(text(&single, Effect::Surround).contains("no light comes from all around"));
    assert_eq!(text(&single, Effect::Luminescence), "simulated");
    let mut red = single.clone();
    red.sources = vec![lamp("red", sun, [0.0, 0.0, 1.0])];
    red.sources[0].light = bbrf::donaldson::Light::new(
        "red",
        bbrf::quantity::QuantityKind::SpectralIrradiance,
        vec![700.0, 780.0],
        vec![1.0, 1.0],
        None,
    )
    .unwrap();
    assert!(text(&red, Effect::Luminescence).contains("excited"), "{}", plan(&red, Kept::Colour, 0.0).unwrap().text());
    let mut apart = single.clone();
    apart.bodies.push(ball([3.0, 0.0, 0.0], 1.0, 0));
    apart.sources[0].place = Place::Directional([0.0, 0.0, 1.0]);
    assert!(text(&apart, Effect::Shadow).contains("no body stands between"));
    let mut glossy = single.clone();
    glossy.materials[0].specular = Some(gloss(1.0, 0.01));
    glossy.bodies[0].shape = Shape::Plane(Plane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        rectangle: Some(Rectangle { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], half: [1.0, 1.0] }),
    });
    assert!(
        text(&glossy, Effect::Specular).contains("nowhere in view"),
        "{}",
        plan(&glossy, Kept::Colour, 0.0).unwrap().text()
    );
}

/// All triangles of a bowl lie on one side of each other's planes, and yet its inside sees itself.
#[test]
fn an_open_bowl_of_triangles_sees_itself_and_a_closed_one_does_not() {
    let corners = [[1.0, 0.0, 0.0], [-0.5, 0.8, 0.0], [-0.5, -0.8, 0.0], [0.0, 0.0, -0.7]];
    let sides = [[1, 0, 3], [2, 1, 3], [0, 2, 3]];
    let lid = [[0, 1, 2]];
    let above = Place::Directional(unit([0.1, 0.0, 1.0]));
    let text = |triangles: &[[usize; 3]]| {
        let bowl =
            Body { name: "bowl".to_owned(), shape: Shape::Mesh(Mesh::new(&corners, triangles).unwrap()), material: 0 };
        let mut scene = scene(vec![bowl], vec![grey(0.8)], vec![white("sun", above)]);
        scene.camera =
            Camera::new([0.0, -1.0, 8.0], [0.0; 3], [0.0, 0.0, 1.0], Projection::Orthographic { width: 3.0 }).unwrap();
        let plan = plan(&scene, Kept::Colour, 0.0).unwrap();
        let picture = draw(&scene, &everything(&scene));
        let most = picture.layer(Layer::Interreflection).unwrap()[1].iter().copied().fold(0.0, f32::max);
        (plan.choice.has(Effect::Interreflection), most)
    };
    let (is_simulated, most) = text(&sides);
    assert!(is_simulated && most > 0.05, "{most}");
    let (is_simulated, most) = text(&[&sides[..], &lid].concat());
    assert!(!is_simulated && most == 0.0, "{most}");
}

#[test]
fn what_sends_back_more_than_falls_in_is_shown_and_does_not_bounce() {
    let mut scene = scene(
        vec![ball([0.0; 3], 1.0, 0), floor(-1.0, 0)],
        vec![grey(1.2)],
        vec![white("sun", Place::Directional([0.0, 0.0, 1.0]))],
    );
    let refused = Picture::draw(&scene, &everything(&scene), Kept::Colour, Layer::ALL, &Watch::default()).unwrap_err();
    assert!(refused.to_string().contains("material `grey 1.2` sends back up to 1.2"), "{refused}");
    scene.bounces = Bounces::Most(0);
    draw(&scene, &everything(&scene));
}
