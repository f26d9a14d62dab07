//! What may bounce, and what becomes of it in a closed room.

use std::f64::consts::PI;

use super::{EXACT, ball, cuboid, everything, floor, grey, level, nm, scene, see, some};
use crate::donaldson::Light;
use crate::quantity::{Direction, QuantityKind};
use crate::simulate::random::Stream;
use crate::simulate::{Effect, Grid, Kept, Layer, Material, NoPicture, NotDrawn, Picture, Place, Scene, Watch};
use crate::terms::{Denominator, Distribution, Term, TorranceSparrow};

fn draw(scene: &Scene) -> Result<Picture, NoPicture> {
    Picture::draw(scene, &everything(scene), Kept::Colour, &[Layer::Total], &Watch::default())
}

/// The largest share of energy, and of photons, that a wavelength sends back, by the definition of the density.
fn shares(material: &Material, interface: f64) -> (f64, f64) {
    let (nm, grid) = (nm(), Grid::new(300.0, 780.0, 20.0).unwrap());
    let widths = grid.widths();
    let back = |i: usize, worth: &dyn Fn(usize) -> f64| {
        let row = material.surface.density.row(i);
        let emitted: f64 = row.iter().enumerate().map(|(j, density)| density * widths[j] * worth(j)).sum();
        material.surface.elastic[i] + interface + emitted
    };
    let largest =
        |photons: bool| (0..25).map(|i| back(i, &|j| if photons { nm[j] / nm[i] } else { 1.0 })).fold(0.0, f64::max);
    (largest(false), largest(true))
}

/// Photons that are reflected are not there to be emitted: both together are at most those that fall in.
#[test]
fn what_may_bounce_never_sends_back_more_photons_or_energy_than_fall_in() {
    let mut random = Stream::new(3, 0, 0, Effect::Interreflection);
    let (mut by_photons, mut admitted) = (0, 0);
    for number in 0..300 {
        let mut one = some(&mut random);
        // Some reflect and glow, some glow above all; some have an interface.
        if number % 2 == 0 {
            one.surface.elastic.iter_mut().for_each(|x| *x *= 0.1);
        }
        let interface = if number % 3 == 0 {
            let term = TorranceSparrow {
                intensity: random.uniform(),
                roughness: 0.05 + 0.3 * random.uniform(),
                refractive_index: 1.3 + 0.5 * random.uniform(),
                distribution: Distribution::Gaussian,
                denominator: Denominator::CosThetaV,
            };
            one.specular = Some(term);
            let at = |theta: f64| {
                let direction = Direction::from_degrees(theta, 0.0).unwrap();
                Term::TorranceSparrow(term).directional_albedo(&direction).unwrap().value
            };
            [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0].into_iter().map(at).fold(0.0, f64::max)
        } else {
            0.0
        };
        let (energy, photons) = shares(&one, 0.0);
        let room = 1.0 - interface;
        by_photons += usize::from(photons > energy);
        for (most, is_admitted) in [(room - 1e-6, true), (room + 1e-6, false), (room * random.uniform(), true)] {
            let factor = most / energy.max(photons);
            let mut scaled = one.clone();
            scaled.surface.elastic.iter_mut().for_each(|x| *x *= factor);
            scaled.surface.density *= factor;
            let scene = scene(
                vec![ball([0.0; 3], 1.0), floor(-1.0)],
                vec![scaled.clone()],
                vec![level(Place::Directional([0.0, 0.0, 1.0]), 1.0)],
            );
            let drawn = draw(&scene);
            assert_eq!(drawn.is_ok(), is_admitted, "{number}: {energy} {photons} {interface}: {:?}", drawn.err());
            if is_admitted {
                admitted += 1;
                let (energy, photons) = shares(&scaled, interface);
                assert!(energy <= 1.0 && photons <= 1.0, "{number}: {energy} {photons}");
            } else {
                assert!(matches!(drawn, Err(NoPicture::Scene(NotDrawn::Brighter { .. }))));
            }
        }
    }
    println!("{admitted} materials admitted, none with more than 1; of 300 by their photons {by_photons}");
    assert!(by_photons > 100);
}

/// In a closed room every photon flux goes round until it is absorbed: what its walls send out in all is the sum of the series of
/// their matrix, whatever the form of the room, and never more than that of the largest share.
#[test]
fn in_a_closed_room_all_light_is_the_sum_of_its_series() {
    let mut random = Stream::new(5, 0, 0, Effect::Interreflection);
    let side = 2.0;
    // From the middle of the room to every place of a wall alike.
    let rays: Vec<_> = (0..12_000)
        .map(|_| {
            let (axis, sign) = ((6.0 * random.uniform()) as usize, random.uniform());
            let mut from = [0.0; 3];
            let mut towards = [0.0; 3];
            towards[axis % 3] = if sign < 0.5 { -1.0 } else { 1.0 };
            from[(axis + 1) % 3] = side * (random.uniform() - 0.5);
            from[(axis + 2) % 3] = side * (random.uniform() - 0.5);
            (from, towards)
        })
        .collect();
    for number in 0..3 {
        let mut one = if number == 0 { grey(0.8) } else { some(&mut random) };
        let (energy, photons) = shares(&one, 0.0);
        let factor = 0.8 / energy.max(photons);
        one.surface.elastic.iter_mut().for_each(|x| *x *= factor);
        one.surface.density *= factor;
        let mut lamp = level(Place::Point([0.1, -0.2, 0.15], 1.0), 1.0);
        lamp.light = Light::new(
            "lamp",
            QuantityKind::SpectralIrradiance,
            nm(),
            nm().iter().map(|nm| nm / 500.0).collect(),
            None,
        )
        .unwrap();
        let scene = scene(vec![cuboid(side / 2.0)], vec![one.clone()], vec![lamp]);
        let widths = scene.grid.widths();
        let mut falling: Vec<f64> = scene.grid.spectrum(&scene.sources[0].light).iter().map(|e| 4.0 * PI * e).collect();
        let power = |flux: &[f64]| flux.iter().zip(&widths).map(|(flux, width)| flux * width).sum::<f64>();
        let begun = power(&falling);
        let mut series = vec![0.0; 25];
        for _ in 0..400 {
            let out: Vec<f64> = (0..25)
                .map(|j| {
                    let emitted: f64 = (0..25).map(|i| one.surface.density[(i, j)] * widths[i] * falling[i]).sum();
                    one.surface.elastic[j] * falling[j] + emitted
                })
                .collect();
            series.iter_mut().zip(&out).for_each(|(sum, out)| *sum += out);
            falling = out;
        }
        let area = 6.0 * side * side;
        let found: Vec<f64> = see(&scene, &everything(&scene), &rays)
            .iter()
            .map(|[luminescent, diffuse, ..]| {
                let all: Vec<f64> = luminescent.iter().zip(diffuse).map(|(a, b)| area * (a + b)).collect();
                power(&all)
            })
            .collect();
        let count = found.len() as f64;
        let mean = found.iter().sum::<f64>() / count;
        let sigma = (found.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count / count).sqrt();
        let expected = power(&series);
        let bound = begun * 0.8 / (1.0 - 0.8);
        println!("closed room {number}: {mean:.4} +- {sigma:.4}, series {expected:.4}, bound {bound:.4}");
        assert!((mean - expected).abs() < 5.0 * sigma && sigma < 0.02 * expected);
        assert!(expected <= bound * (1.0 + EXACT) && mean < bound + 5.0 * sigma);
    }
}
