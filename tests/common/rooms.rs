//! Scenes as texts, beside the files that they name.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use bbrf::container::write_file;
use bbrf::dataset::Document;

use super::bispectral;

pub const SPHERE: &str = r#"bounces = 0
[film]
width = 48
height = 32
samples = 4
[wavelengths]
from = 300
to = 780
step = 10
[camera]
projection = "orthographic"
width = 3
from = [0, 0, 5]
at = [0, 0, 0]
[[material]]
name = "orange"
file = "orange.bbrf"
specular = { intensity = 30, roughness = 0.05, refractive_index = 1.45 }
[[light]]
spectrum = "D65"
towards = [0, 0, 1]
[[object]]
material = "orange"
sphere = { centre = [0, 0, 0], radius = 1 }
"#;

/// A dimmer orange on a white floor: light goes from one to the other, and none comes from nowhere.
pub fn room() -> String {
    let floor = "[[material]]\nname = \"white\"\nalbedo = 0.8\n\
        [[object]]\nmaterial = \"white\"\nplane = { point = [0, -1, 0], normal = [0, 1, 0] }\n";
    let light =
        SPHERE.replace("towards = [0, 0, 1]", "towards = [1, 1, 1]").replace("from = [0, 0, 5]", "from = [0, 2, 5]");
    light
        .replace("bounces = 0", "bounces = 3")
        .replace("intensity = 30", "intensity = 3")
        .replace("orange.bbrf", "dim.bbrf")
        + floor
}

/// A scene beside the files that it may name.
pub fn scene(folder: &Path, text: &str) -> PathBuf {
    let document = Document { license: Some("CC-BY-4.0".to_owned()), ..bispectral::document() };
    write_file(&document, &folder.join("orange.bbrf")).unwrap();
    let (excitation, emission, values) = bispectral::values(10.0);
    let sigma = Some(values.mapv(|_| 0.001));
    let dim = bispectral::measurement("dim", &excitation, &emission, 0.8 * values, sigma, None);
    let document = Document { measurements: vec![dim], ..document };
    write_file(&document, &folder.join("dim.bbrf")).unwrap();
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).unwrap();
    path
}
