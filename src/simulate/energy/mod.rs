//! Energy: what falls in comes out, and nothing more. In double precision, which no picture is in.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests alone")]

mod admission;
mod interface;

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use ndarray::Array2;

use super::picture::Prepared;
use super::random::Stream;
use super::trace::{Pixel, Tracer};
use super::transport::Ways;
use super::vector::Vector;
use super::{
    Ball, Body, Bounces, Camera, Choice, Cuboid, Effect, Grid, Kept, Material, Mesh, Place, Plane, Projection, Scene,
    Shape, Source,
};
use crate::donaldson::{Light, Observer, Reradiation};
use crate::quantity::QuantityKind;

/// What is promised of the Lambertian terms.
const EXACT: f64 = 1e-12;

fn nm() -> Vec<f64> {
    (0..25).map(|k| 300.0 + 20.0 * f64::from(k)).collect()
}

fn level(place: Place, value: f64) -> Source {
    let light = Light::new("level", QuantityKind::SpectralIrradiance, vec![200.0, 1100.0], vec![value; 2], None);
    Source { name: "level".to_owned(), light: light.unwrap(), place }
}

fn material(elastic: Vec<f64>, density: Array2<f64>) -> Material {
    let surface = Reradiation::from_parts(nm(), nm(), elastic, density).unwrap();
    Material { name: "material".to_owned(), surface, specular: None, intensity: Vec::new() }
}

fn grey(albedo: f64) -> Material {
    material(vec![albedo; 25], Array2::zeros((25, 25)))
}

/// Some reflectance, and luminescence at longer wavelengths.
fn some(random: &mut Stream) -> Material {
    let elastic = (0..25).map(|_| random.uniform()).collect();
    let density = Array2::from_shape_fn((25, 25), |(i, j)| if j > i { 0.002 * random.uniform() } else { 0.0 });
    material(elastic, density)
}

fn scene(shapes: Vec<Shape>, materials: Vec<Material>, sources: Vec<Source>) -> Scene {
    let projection = Projection::Orthographic { width: 4.0 };
    let body = |(k, shape)| Body { name: format!("body {k}"), shape, material: k % materials.len() };
    Scene {
        bodies: shapes.into_iter().enumerate().map(body).collect(),
        camera: Camera::new([0.0, -10.0, 4.0], [0.0; 3], [0.0, 0.0, 1.0], projection).unwrap(),
        materials,
        sources,
        size: (4, 4),
        grid: Grid::new(300.0, 780.0, 20.0).unwrap(),
        observer: Observer::Two,
        samples: 1,
        bounces: Bounces::All,
        seed: 1,
    }
}

fn cuboid(half: f64) -> Shape {
    Shape::Box(Cuboid { centre: [0.0; 3], axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], half: [half; 3] })
}

fn ball(centre: Vector, radius: f64) -> Shape {
    Shape::Sphere(Ball { centre, radius })
}

fn floor(height: f64) -> Shape {
    Shape::Plane(Plane { point: [0.0, 0.0, height], normal: [0.0, 0.0, 1.0], rectangle: None })
}

/// A cube of triangles.
fn cube() -> Shape {
    let corners: Vec<Vector> =
        (0..8_u8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 })).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[usize; 3]> = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Shape::Mesh(Mesh::new(&corners, &triangles).unwrap())
}

/// Spectral radiance times pi of what rays see, in double precision: luminescent, diffuse, specular and what of them is indirect.
fn see(scene: &Scene, choice: &Choice, rays: &[(Vector, Vector)]) -> Vec<[Vec<f64>; 4]> {
    let prepared = Prepared::new(scene, choice.step_nm).unwrap();
    let spectra = prepared.spectra(scene, choice, Kept::Spectra);
    let tracer = Tracer::new(scene, *choice, &prepared.grid, &spectra, prepared.weights[1].clone());
    let (mut ways, mut out, mut sample) = (Ways::new(&spectra), Pixel::default(), Pixel::default());
    let look = |(k, (from, towards)): (usize, &(Vector, Vector))| {
        tracer.pixel(k as u64, *from, *towards, &mut ways, &mut out, &mut sample);
        [&out.luminescent, &out.diffuse, &out.specular, &out.indirect].map(|sum| sum.iter().map(|x| PI * x).collect())
    };
    rays.iter().enumerate().map(look).collect()
}

fn everything(scene: &Scene) -> Choice {
    Choice::everything(scene.bounces, scene.grid.step())
}

/// Light from all around as lights of directions: Gauss's rule in height, even steps around, exact for a cosine.
fn all_around() -> Vec<Source> {
    let offset = 0.5 * 0.6_f64.sqrt();
    let heights = [(0.5 - offset, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + offset, 5.0 / 18.0)];
    let directions = heights.into_iter().flat_map(|height| (0..6).map(move |k| (height, TAU * f64::from(k) / 6.0)));
    let source = |((height, weight), phi): ((f64, f64), f64)| {
        let radius = (1.0 - height * height).sqrt();
        let towards = [radius * phi.cos(), radius * phi.sin(), height];
        level(Place::Directional(towards), FRAC_1_PI * weight * TAU / 6.0)
    };
    directions.map(source).collect()
}

#[test]
fn a_white_body_of_any_form_sends_back_what_falls_in() {
    let mut worst = 0.0_f64;
    for shape in [ball([0.0, 0.0, 0.0], 1.0), cuboid(1.0), cube(), floor(1.0)] {
        // Its top, from everywhere above; and any place of it in light that is the same all around.
        let views = [[0.0, 0.0, -1.0], [0.6, 0.0, -0.8], [0.0, -0.96, -0.28]];
        let top: Vec<_> = views.iter().map(|view| ([-view[0], -view[1], 1.0 - view[2]], *view)).collect();
        let aside: Vec<_> = (0..20)
            .map(|k| f64::from(k) / 11.0 - 0.9)
            .map(|x| ([x * 0.9 - 1.8, x * x - 2.4, 4.0], super::vector::unit([0.6, 0.8, -1.2]).unwrap()))
            .collect();
        for (sources, rays) in [(all_around(), top), (vec![level(Place::Surround, 1.0)], aside)] {
            let scene = scene(vec![shape.clone()], vec![grey(1.0)], sources);
            for choice in [everything(&scene), Choice { by_pixel: false, ..everything(&scene) }] {
                let seen = see(&scene, &choice, &rays);
                let lit: Vec<f64> =
                    seen.iter().flat_map(|[_, diffuse, ..]| diffuse.clone()).filter(|x| *x != 0.0).collect();
                assert!(lit.len() >= 3 * 25);
                worst = lit.iter().fold(worst, |worst, value| worst.max((value - 1.0).abs()));
            }
        }
    }
    println!("white furnace, outside: {worst:.1e}");
    assert!(worst < EXACT, "{worst}");
}

/// Between white bodies no path gains or loses: each sample is 0, or all that there is.
#[test]
fn between_white_bodies_every_path_that_leaves_holds_all_it_began_with() {
    let shapes = vec![ball([-1.0, 0.0, 0.0], 1.0), cuboid(0.7), floor(-1.0)];
    let scene = scene(shapes, vec![grey(1.0)], vec![level(Place::Surround, 1.0)]);
    let rays: Vec<_> = (0..4000)
        .map(|k| ([f64::from(k % 63) / 16.0 - 2.0, f64::from(k / 63) / 16.0 - 2.0, 5.0], [0.0, 0.0, -1.0]))
        .collect();
    let choice = everything(&scene).without(Effect::Surround);
    assert!(see(&scene, &choice, &rays).iter().all(|[.., indirect]| indirect.iter().all(|x| *x == 0.0)));
    let (mut worst, mut whole, mut sum) = (0.0_f64, 0, 0.0);
    for [_, diffuse, _, indirect] in see(&scene, &everything(&scene), &rays) {
        whole += usize::from(indirect[0] > 0.5);
        sum += diffuse[0];
        for value in indirect {
            worst = worst.max(value.abs().min((value - 1.0).abs()));
        }
    }
    let mean = sum / rays.len() as f64;
    println!("white furnace, between: {worst:.1e}; {whole} of {} paths met a body; mean {mean}", rays.len());
    assert!(worst < EXACT && whole > 400, "{worst}, {whole}");
    // A place is lit from above or by way of a body: of two coins each is .5 off at most.
    assert!((mean - 1.0).abs() < 5.0 * 0.5_f64.sqrt() / (rays.len() as f64).sqrt(), "{mean}");
}

#[test]
fn what_is_emitted_reflected_and_absorbed_is_what_falls_in() {
    let mut random = Stream::new(1, 0, 0, Effect::Luminescence);
    let mut worst = 0.0_f64;
    for _ in 0..50 {
        let material = some(&mut random);
        let values: Vec<f64> = (0..25).map(|_| random.uniform()).collect();
        let light = Light::new("lamp", QuantityKind::SpectralIrradiance, nm(), values, None).unwrap();
        let source = Source { name: "lamp".to_owned(), light, place: Place::Directional([0.0, 0.0, 1.0]) };
        let scene = scene(vec![floor(0.0)], vec![material.clone()], vec![source]);
        let incident = scene.grid.spectrum(&scene.sources[0].light);
        let widths = scene.grid.widths();
        let surface = &material.surface;
        // What a wavelength keeps, by the definition of the density.
        let kept = |i: usize| {
            1.0 - surface.elastic[i] - surface.density.row(i).iter().zip(&widths).map(|(d, w)| d * w).sum::<f64>()
        };
        let absorbed: f64 = (0..25).map(|i| widths[i] * incident[i] * kept(i)).sum();
        let falls_in: f64 = (0..25).map(|i| widths[i] * incident[i]).sum();
        for choice in [everything(&scene), Choice { by_pixel: false, ..everything(&scene) }] {
            let [luminescent, diffuse, ..] = &see(&scene, &choice, &[([0.0, 0.0, 5.0], [0.0, 0.0, -1.0])])[0];
            let leaves: f64 = (0..25).map(|j| widths[j] * (luminescent[j] + diffuse[j])).sum();
            worst = worst.max(((leaves + absorbed) / falls_in - 1.0).abs());
        }
        let on_grid = material.on(&scene.grid);
        let most = (0..25).map(|i| 1.0 - kept(i)).fold(0.0, f64::max);
        worst = worst.max((on_grid.albedo(&scene.grid) - most).abs());
    }
    println!("emitted + reflected + absorbed over incident: {worst:.1e}");
    assert!(worst < EXACT, "{worst}");
}
