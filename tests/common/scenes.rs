//! Scenes made in a few words.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use bbrf::donaldson::{Light, Observer, Reradiation};
use bbrf::quantity::QuantityKind;
use bbrf::simulate::{
    Ball, Body, Bounces, Camera, Choice, Grid, Kept, Layer, Material, Picture, Place, Plane, Projection, Scene, Shape,
    Source, Watch,
};
use bbrf::terms::{Denominator, Distribution, TorranceSparrow};
use ndarray::Array2;

pub const STEP: f64 = 20.0;

/// A light of spectral irradiance 1 from 300 to 780 nm.
pub fn white(name: &str, place: Place) -> Source {
    let light = Light::new(name, QuantityKind::SpectralIrradiance, vec![300.0, 780.0], vec![1.0, 1.0], None).unwrap();
    Source { name: name.to_owned(), light, place }
}

/// A light with a spectrum that rises.
pub fn lamp(name: &str, place: Place, values: [f64; 3]) -> Source {
    let light =
        Light::new(name, QuantityKind::SpectralIrradiance, vec![300.0, 500.0, 780.0], values.to_vec(), None).unwrap();
    Source { name: name.to_owned(), light, place }
}

/// The same reflectance at every wavelength.
pub fn grey(reflectance: f64) -> Material {
    let nm = vec![300.0, 780.0];
    let surface = Reradiation::from_parts(nm.clone(), nm, vec![reflectance; 2], Array2::zeros((2, 2))).unwrap();
    Material { name: format!("grey {reflectance}"), surface, specular: None, intensity: Vec::new() }
}

/// Reflects little and turns blue light into light about an emission wavelength.
pub fn glowing(name: &str, reflectance: f64, emission: f64, strength: f64) -> Material {
    let axis: Vec<f64> = (0..25).map(|k| 300.0 + 20.0 * f64::from(k)).collect();
    let bell = |nm: f64, centre: f64, width: f64| (-((nm - centre) / width).powi(2)).exp();
    let density = Array2::from_shape_fn((25, 25), |(i, j)| {
        let emitted = bell(axis[j], emission, 40.0) / (40.0 * std::f64::consts::PI.sqrt());
        if axis[j] > axis[i] { strength * bell(axis[i], emission - 90.0, 60.0) * emitted } else { 0.0 }
    });
    let elastic = axis.iter().map(|nm| reflectance * (0.3 + 0.7 * bell(*nm, emission + 60.0, 150.0))).collect();
    let surface = Reradiation::from_parts(axis.clone(), axis, elastic, density).unwrap();
    Material { name: name.to_owned(), surface, specular: None, intensity: Vec::new() }
}

pub fn gloss(intensity: f64, roughness: f64) -> TorranceSparrow {
    TorranceSparrow {
        intensity,
        roughness,
        refractive_index: 1.45,
        distribution: Distribution::GaussianHalfHeight,
        denominator: Denominator::CosThetaI,
    }
}

pub fn ball(centre: [f64; 3], radius: f64, material: usize) -> Body {
    Body { name: "ball".to_owned(), shape: Shape::Sphere(Ball { centre, radius }), material }
}

pub fn floor(height: f64, material: usize) -> Body {
    let plane = Plane { point: [0.0, 0.0, height], normal: [0.0, 0.0, 1.0], rectangle: None };
    Body { name: "floor".to_owned(), shape: Shape::Plane(plane), material }
}

/// Seen from above along -y and a little from above.
pub fn camera() -> Camera {
    Camera::new([0.0, -10.0, 4.0], [0.0; 3], [0.0, 0.0, 1.0], Projection::Orthographic { width: 4.0 }).unwrap()
}

pub fn scene(bodies: Vec<Body>, materials: Vec<Material>, sources: Vec<Source>) -> Scene {
    Scene {
        bodies,
        materials,
        sources,
        camera: camera(),
        size: (24, 20),
        grid: Grid::new(300.0, 780.0, STEP).unwrap(),
        observer: Observer::Two,
        samples: 16,
        bounces: Bounces::All,
        seed: 1,
    }
}

pub fn everything(scene: &Scene) -> Choice {
    Choice::everything(scene.bounces, scene.grid.step())
}

pub fn draw(scene: &Scene, choice: &Choice) -> Picture {
    Picture::draw(scene, choice, Kept::Colour, Layer::ALL, &Watch::default()).unwrap()
}

/// The Y plane of the total.
pub fn luminance(picture: &Picture) -> &[f32] {
    &picture.layer(Layer::Total).unwrap()[1]
}
