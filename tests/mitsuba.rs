//! The same scenes by Mitsuba 3: the same pixels within the noise of both, and the time of both.
//!
//! Needs the interpreter named by `BBRF_PYTHON` with the package `mitsuba`; `make soak` brings it. Both read the same TOML and look
//! through the middle of the same pixels. Three wavelengths of 1 everywhere are its three channels, so that no colour is made.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use bbrf::donaldson::Light;
use bbrf::simulate::document::{Corners, Library, Points, SceneDocument, Source};
use bbrf::simulate::{Choice, Kept, Layer, Material, Picture, Scene, Watch};

const SIDE: usize = 32;
/// Pictures of each program, each with its own seed: what they scatter by is their noise, whatever either says of it.
const REPEATS: usize = 64;
/// Samples of a pixel in each picture.
const SAMPLES: usize = if cfg!(debug_assertions) { 8 } else { 64 };
/// Mitsuba counts in single precision, of which places, cosines and shadows that graze lose a few digits more: the noise of what has
/// no other.
const SINGLE: f64 = 5e-6;
/// Standard deviations: of the 27,648 differences one in a thousand runs has one beyond.
const FAR: f64 = 6.0;

const HEAD: &str = r#"
[wavelengths]
from = 400
to = 600
step = 100

[[material]]
name = "white"
albedo = 0.8

[[material]]
name = "grey"
albedo = 0.5

[[material]]
name = "red"
reflectance = "red.csv"
"#;

/// A ball over a floor, beside a red wall, in the light of the sun and of a lamp.
const BALL: &str = r#"
[camera]
projection = "perspective"
width_deg = 40
from = [1, 2, 6]
at = [0, 0.2, 0]
[[light]]
spectrum = "E"
strength = 0.01
towards = [1, 2, 0.7]
[[light]]
spectrum = "E"
strength = 0.02
at = [0.6, 1.6, 2.1]
reference_distance = 1.5
[[object]]
material = "grey"
sphere = { centre = [0.1, 0.05, 0], radius = 0.9 }
[[object]]
material = "white"
plane = { point = [0, -1, 0], normal = [0, 1, 0], size = [7, 6], up = [0, 0, 1] }
[[object]]
material = "red"
plane = { point = [-1.6, 0, 0], normal = [2, 0, 0.3], size = [5, 4] }
"#;

/// A ball in the corner of a room, lit by a lamp: every place sees two walls and the ball.
const CORNER: &str = r#"
[camera]
projection = "perspective"
width_deg = 50
from = [4, 3.1, 5]
at = [0.7, 0.6, 0.8]
[[light]]
spectrum = "E"
strength = 0.03
at = [2.4, 2.6, 1.9]
reference_distance = 2
[[object]]
name = "ball"
material = "grey"
sphere = { centre = [1, 0.8, 1.1], radius = 0.6 }
[[object]]
material = "white"
plane = { point = [2, 0, 2], normal = [0, 1, 0], size = [4, 4], up = [0, 0, 1] }
[[object]]
material = "red"
plane = { point = [0, 2, 2], normal = [1, 0, 0], size = [4, 4] }
[[object]]
material = "white"
plane = { point = [2, 2, 0], normal = [0, 0, 1], size = [4, 4] }
"#;

/// A turned box and an open bowl of triangles on a floor, in light from all around and from one side.
const OVERCAST: &str = r#"
[camera]
projection = "perspective"
width_deg = 36
from = [0.5, 3, 7]
at = [0, -0.2, 0]
[[light]]
spectrum = "E"
strength = 0.01
surround = true
[[light]]
spectrum = "E"
strength = 0.005
towards = [-1, 1.2, 0.9]
[[object]]
material = "red"
box = { centre = [-0.9, -0.1, 0], size = [1, 1.3, 0.8], rotate_deg = [20, 35, 10] }
[[object]]
material = "grey"
mesh = { file = "bowl.obj", scale = 0.8, move = [0.9, -0.7, 0.3] }
[[object]]
material = "white"
plane = { point = [0, -1, 0], normal = [0, 1, 0], size = [7, 6], up = [0, 0, 1] }
"#;

/// Reflectance at the three wavelengths.
const RED: &str = "nm,share\n400,0.1\n500,0.35\n600,0.9\n";

/// A hollow half of an octahedron, standing on its point.
const BOWL: &str = "v 0 -0.2 0\nv 1 1 0\nv 0 1 1\nv -1 1 0\nv 0 1 -1\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n";

struct Beside;

impl Library for Beside {
    fn material(&mut self, source: &Source<'_>) -> Result<(Material, Vec<String>), String> {
        Err(source.file.to_owned())
    }

    fn reflectance(&mut self, _: &str) -> Result<(Points, Vec<String>), String> {
        let numbers = |line: &str| line.split_once(',').map(|(a, b)| (a.parse().unwrap(), b.parse().unwrap())).unwrap();
        Ok((RED.lines().skip(1).map(numbers).collect(), Vec::new()))
    }

    fn light(&mut self, name: &str) -> Result<(Light, Vec<String>), String> {
        Light::named(name).map(|light| (light, Vec::new())).ok_or_else(|| name.to_owned())
    }

    fn mesh(&mut self, _: &str) -> Result<(Corners, Vec<String>), String> {
        let (mut places, mut triangles) = (Vec::new(), Vec::new());
        for line in BOWL.lines() {
            let three = |line: &str| -> [f64; 3] {
                line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap()
            };
            match &line[..1] {
                "v" => places.push(three(line)),
                _ => triangles.push(three(line).map(|corner| corner as usize - 1)),
            }
        }
        Ok((Corners { places, triangles }, Vec::new()))
    }
}

/// Pixels after pixels, three channels each: the mean, and the variance of it; with the time of one picture.
struct Rendered {
    mean: Vec<f64>,
    variance: Vec<f64>,
    seconds: f64,
}

fn python() -> Option<String> {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make soak sets it)");
        return None;
    };
    let has = Command::new(&python).args(["-c", "import mitsuba"]).output().unwrap().status.success();
    if !has {
        eprintln!("skipped: {python} has no package `mitsuba` (make soak brings it)");
    }
    has.then_some(python)
}

fn theirs(python: &str, scene: &Path) -> Rendered {
    let out = scene.with_extension("f64");
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/python/mitsuba_radiance.py");
    let mut command = Command::new(python);
    let run =
        command.arg(script).arg(scene).args([REPEATS.to_string(), SAMPLES.to_string()]).arg(&out).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let said: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let bytes = std::fs::read(out).unwrap();
    let mut numbers: Vec<f64> =
        bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect();
    let variance = numbers.split_off(numbers.len() / 2);
    Rendered { mean: numbers, variance, seconds: said["seconds"].as_f64().unwrap() }
}

fn ours(scene: &mut Scene) -> Rendered {
    let choice = Choice::everything(scene.bounces, scene.grid.step());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (mut found, mut seconds): (Vec<Vec<f64>>, Vec<f64>) = (Vec::new(), Vec::new());
    for seed in 0..REPEATS as u64 {
        scene.seed = seed;
        let start = Instant::now();
        let draw = || Picture::draw(scene, &choice, Kept::Spectra, &[Layer::Total], &Watch::default());
        let picture = pool.install(draw).unwrap();
        seconds.push(start.elapsed().as_secs_f64());
        let planes = picture.layer(Layer::Total).unwrap();
        let pixels = (0..SIDE * SIDE).flat_map(|pixel| planes.iter().map(move |plane| f64::from(plane[pixel])));
        found.push(pixels.collect());
    }
    let count = REPEATS as f64;
    let over = |of: &dyn Fn(usize) -> f64| (0..found[0].len()).map(of).collect::<Vec<f64>>();
    let mean = over(&|k| found.iter().map(|one| one[k]).sum::<f64>() / count);
    let variance = over(&|k| found.iter().map(|one| (one[k] - mean[k]).powi(2)).sum::<f64>() / (count - 1.0) / count);
    seconds.sort_by(f64::total_cmp);
    Rendered { mean, variance, seconds: seconds[REPEATS / 2] }
}

/// Of one picture, what a sample of a pixel takes, and how long until its noise is the same.
fn report(name: &str, bounces: &str, ours: &Rendered, theirs: &Rendered, z: &[f64]) -> (f64, f64) {
    let count = z.len() as f64;
    let mean = z.iter().sum::<f64>() / count;
    let rms = (z.iter().map(|z| z * z).sum::<f64>() / count).sqrt();
    let largest = z.iter().map(|z| z.abs()).fold(0.0, f64::max);
    let each = 1e9 / (SAMPLES * SIDE * SIDE) as f64;
    let noise = |one: &Rendered| one.seconds * one.variance.iter().sum::<f64>();
    let same = match noise(ours) {
        0.0 => "we have none".to_owned(),
        noise_of_ours => format!("{:.2}", noise_of_ours / noise(theirs)),
    };
    println!(
        "{name:8} bounces {bounces:>5}: {:4} differences, mean {mean:+.3}, r.m.s. {rms:.3}, largest {largest:.2}; ns per sample and \
         pixel: ours {:.0}, Mitsuba {:.0}; time to the same noise, ours over Mitsuba: {same}",
        z.len(),
        each * ours.seconds,
        each * theirs.seconds,
    );
    (mean, rms)
}

#[test]
fn mitsuba_sees_the_same_pixels_within_the_noise() {
    let Some(python) = python() else { return };
    println!("one thread each, {REPEATS} pictures of {SIDE} x {SIDE} pixels with {SAMPLES} samples");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("red.csv"), RED).unwrap();
    std::fs::write(folder.path().join("bowl.obj"), BOWL).unwrap();
    let mut wrong = Vec::new();
    for (name, rest) in [("ball", BALL), ("corner", CORNER), ("overcast", OVERCAST)] {
        for bounces in ["0", "1", "3", "\"all\""] {
            let film = format!("[film]\nwidth = {SIDE}\nheight = {SIDE}\nsamples = {SAMPLES}\n");
            let text = format!("bounces = {bounces}\n{film}{HEAD}{rest}");
            let path = folder.path().join(format!("{name}.toml"));
            std::fs::write(&path, &text).unwrap();
            let mut scene = SceneDocument::resolve("scene", &text, &mut Beside).unwrap().scene;
            let (ours, theirs) = (ours(&mut scene), theirs(&python, &path));
            assert_eq!(ours.mean.len(), theirs.mean.len());
            let mut z = Vec::new();
            for k in 0..ours.mean.len() {
                let (a, b) = (ours.mean[k], theirs.mean[k]);
                let variance = ours.variance[k] + theirs.variance[k] + (SINGLE * a.max(b)).powi(2);
                if variance == 0.0 {
                    // Nothing is there.
                    continue;
                }
                let one = (a - b) / variance.sqrt();
                if one.abs() > FAR {
                    let (pixel, channel) = (k / 3, k % 3);
                    wrong.push(format!(
                        "{name}, bounces {bounces}, column {}, row {}, channel {channel}: {a} and {b}, {one:.1} standard deviations",
                        pixel % SIDE,
                        pixel / SIDE
                    ));
                }
                z.push(one);
            }
            assert!(z.len() > 3 * SIDE * SIDE / 2, "{name}: {} pixels show something", z.len() / 3);
            let (mean, rms) = report(name, bounces, &ours, &theirs, &z);
            // Channels of a pixel share their paths: so many are on their own.
            let pixels = (z.len() / 3) as f64;
            if mean.abs() > 4.0 / pixels.sqrt() {
                wrong.push(format!("{name}, bounces {bounces}: the mean is {mean}"));
            }
            // Variances from 64 pictures make it 1.008; no noise at all is less, and nothing is known where only rounding is.
            if rms > 1.008 + 4.0 / (2.0 * pixels).sqrt() {
                wrong.push(format!("{name}, bounces {bounces}: the r.m.s. is {rms}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
