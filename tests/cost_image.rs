//! Every rung of a scene's ladder is drawn by its command, and gives the error that the ladder states.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, reason = "a test")]

mod common {
    pub mod bispectral;
    pub mod ladders;
    pub mod rooms;
}

use std::path::Path;

use bbrf::donaldson::{Colour, Observer};
use bbrf::simulate::image::Srgb;
use common::ladders::{bbrf, cost};
use common::rooms::{room, scene};
use exr::prelude::{ReadChannels, ReadLayers, read};
use nalgebra::{Matrix3, Vector3};
use predicates::str::contains;
use serde_json::Value;

/// The colour of each pixel of the total, Y of white being 100.
fn colours(folder: &Path, white: &Value) -> Vec<Colour> {
    let white: [f64; 3] = serde_json::from_value(white.clone()).unwrap();
    let display = Srgb::new(white, 1.0).unwrap();
    let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|xyz| Vector3::from(display.linear(xyz)));
    let back = Matrix3::from_columns(&columns).try_inverse().unwrap();
    let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_file(folder.join("layers.exr")).unwrap();
    let total = image.layer_data.iter().find(|one| one.attributes.layer_name == Some("total".into())).unwrap();
    let channel = |name: &str| -> Vec<f32> {
        let channel = total.channel_data.list.iter().find(|one| one.name.to_string() == name).unwrap();
        channel.sample_data.values_as_f32().collect()
    };
    let [r, g, b] = ["R", "G", "B"].map(channel);
    let colour = |k: usize| {
        let xyz = back * Vector3::new(f64::from(r[k]), f64::from(g[k]), f64::from(b[k]));
        Colour { observer: Observer::Two, xyz: (100.0 * xyz).into(), white: white.map(|value| 100.0 * value) }
    };
    (0..r.len()).map(colour).collect()
}

#[test]
fn every_rung_of_a_scene_is_drawn_by_its_command_with_the_error_that_it_states() {
    let folder = tempfile::tempdir().unwrap();
    let found = cost("image", &scene(folder.path(), &room()), &[]);
    let words = |list: &Value| -> Vec<String> { serde_json::from_value(list.clone()).unwrap() };
    let command = words(&found["command"]);
    let output = &command[command.iter().position(|word| word == "-o").unwrap() + 1];
    let record = |folder: &Path| -> Value {
        serde_json::from_slice(&std::fs::read(folder.join("render.json")).unwrap()).unwrap()
    };
    let drawn = |options: Vec<String>| {
        bbrf().args(&command[1..]).args(options).assert().success();
        colours(Path::new(output), &record(Path::new(output))["white"])
    };
    // Eight times the samples of the scene, by the seed after its own.
    let reference = drawn(["--everything", "--samples", "32", "--seed", "2"].map(str::to_owned).to_vec());
    let rungs = found["rungs"].as_array().unwrap();
    let mut knobs: Vec<&str> = rungs.iter().map(|rung| rung["knob"].as_str().unwrap()).collect();
    knobs.dedup();
    assert_eq!(knobs.len(), 5, "{knobs:?}");
    for rung in rungs {
        let distances = drawn(words(&rung["options"])).into_iter().zip(&reference).map(|(found, expected)| {
            // Colours of another scene's white keep their own numbers: what differs is the light.
            Colour { white: expected.white, ..found }.difference(expected).unwrap().de76
        });
        let (worst, stated) = (distances.fold(0.0, f64::max), rung["error"].as_f64().unwrap());
        // The file holds single precision.
        assert!((worst - stated).abs() < 1e-3, "{}: {worst} {stated}", rung["name"]);
    }
    let refused = |options: &[&str], expected: &str| {
        bbrf().args(&command[1..]).args(options).assert().code(2).stderr(contains(expected));
    };
    refused(&["--step", "0.01"], "--step: wavelengths from 300 to 780 nm");
    refused(&["--bounces", "many"], "expected `all` or a whole number");
    refused(&["--by-pixel", "--everything"], "cannot be used with");
    let asked = |options: &[&str]| {
        bbrf().args(&command[1..]).args(options).assert().success();
        record(Path::new(output))
    };
    assert_eq!(asked(&["--bounces", "all"])["bounces"], "all");
    assert_eq!(asked(&["--step", "20"])["wavelengths_nm"], serde_json::json!([300.0, 780.0, 20.0]));
    let route = asked(&["--by-pixel"])["plan"]["route"].to_string();
    assert!(route.contains("at every pixel, as asked") && !route.contains("made once for each of"), "{route}");
}
