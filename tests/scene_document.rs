//! Scenes in TOML: what they may say, and what is said of those that are wrong.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

use bbrf::donaldson::{Light, Observer, Reradiation};
use bbrf::simulate::document::{Corners, Library, NotAScene, Points, Resolved, SceneDocument, Source};
use bbrf::simulate::{Bounces, Kept, Material, Place, Shape};
use ndarray::Array2;

/// Files that are made up.
struct Shelf;

fn red() -> Material {
    let nm = vec![400.0, 700.0];
    let surface = Reradiation::from_parts(nm.clone(), nm, vec![0.1, 0.9], Array2::zeros((2, 2))).unwrap();
    Material { name: String::new(), surface, specular: None, intensity: Vec::new() }
}

impl Library for Shelf {
    fn material(&mut self, source: &Source<'_>) -> Result<(Material, Vec<String>), String> {
        match source.file {
            "red.bbrf" => Ok((red(), vec!["made up".to_owned()])),
            other => Err(format!("{other}: cannot be read")),
        }
    }

    fn reflectance(&mut self, _: &str) -> Result<(Points, Vec<String>), String> {
        Ok((vec![(400.0, 0.2), (700.0, 0.6)], Vec::new()))
    }

    fn light(&mut self, name: &str) -> Result<(Light, Vec<String>), String> {
        Light::named(name).map(|light| (light, Vec::new())).ok_or_else(|| format!("{name}: found no such light"))
    }

    fn mesh(&mut self, _: &str) -> Result<(Corners, Vec<String>), String> {
        let places = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Ok((Corners { places, triangles: vec![[0, 1, 2]] }, Vec::new()))
    }
}

const WHOLE: &str = r#"observer = 10
bounces = 3

[film]
width = 4
height = 3
samples = 8
seed = 9223372036854775807
exposure = 2
kept = "spectra"

[wavelengths]
from = 400
to = 700
step = 10

[camera]
projection = "perspective"
width_deg = 40
from = [0, 0, 5]
at = [0, 0, 0]

[[material]]
name = "grey"
albedo = 0.5
specular = { intensity = 30, roughness = 0.05, refractive_index = 1.45 }

[[material]]
name = "red"
file = "red.bbrf"

[[light]]
name = "sun"
spectrum = "D65"
strength = 2
theta_deg = 90
phi_deg = 90

[[light]]
spectrum = "A"
at = [0, 4, 0]
reference_distance = 2

[[light]]
spectrum = "E"
surround = true

[[object]]
name = "ball"
material = "grey"
sphere = { centre = [0, 1, 0], radius = 1 }

[[object]]
material = "red"
plane = { point = [0, 0, 0], normal = [0, 5, 0], size = [4, 2], up = [1, 0, 0] }

[[object]]
material = "red"
box = { centre = [3, 0, 0], size = [1, 2, 3], rotate_deg = [0, 0, 90] }

[[object]]
material = "grey"
mesh = { file = "three.obj", scale = 2, move = [0, 0, 1] }
"#;

fn resolve(text: &str) -> Result<Resolved, NotAScene> {
    SceneDocument::resolve("scene.toml", text, &mut Shelf)
}

/// The whole scene with one piece of text in place of another.
fn wrong(old: &str, new: &str) -> String {
    assert!(WHOLE.contains(old), "{old}");
    resolve(&WHOLE.replacen(old, new, 1)).unwrap_err().to_string()
}

#[test]
fn a_scene_is_what_its_text_says() {
    let Resolved { scene, kept, exposure, remarks, warnings, .. } = resolve(WHOLE).unwrap();
    assert_eq!((scene.size, scene.samples, scene.seed), ((4, 3), 8, 9_223_372_036_854_775_807));
    assert_eq!((kept, exposure, scene.observer, scene.bounces), (Kept::Spectra, 2.0, Observer::Ten, Bounces::Most(3)));
    assert_eq!(scene.grid.nm().len(), 31);
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["ball", "object 2", "object 3", "object 4"]);
    let materials: Vec<usize> = scene.bodies.iter().map(|body| body.material).collect();
    assert_eq!(materials, [0, 1, 1, 0]);
    assert_eq!(scene.materials[0].specular.unwrap().intensity, 30.0);
    assert_eq!(scene.materials[1].name, "red");
    let Place::Directional(towards) = scene.sources[0].place else { panic!("{:?}", scene.sources[0]) };
    assert!((towards[1] - 1.0).abs() < 1e-15 && towards[0].abs() < 1e-15 && towards[2].abs() < 1e-15, "{towards:?}");
    assert_eq!(scene.sources[0].light.values()[0], 2.0 * Light::named("D65").unwrap().values()[0]);
    assert_eq!(scene.sources[1].place, Place::Point([0.0, 4.0, 0.0], 2.0));
    assert_eq!(scene.sources[2].place, Place::Surround);
    assert_eq!(remarks, ["material `red`: made up"]);
    assert_eq!(warnings, Vec::<String>::new());
}

#[test]
fn rectangles_boxes_and_meshes_stand_where_they_are_put() {
    let scene = resolve(WHOLE).unwrap().scene;
    let Shape::Plane(plane) = scene.bodies[1].shape else { panic!("no plane") };
    let ends = plane.rectangle.unwrap();
    assert_eq!((plane.normal, ends.half), ([0.0, 1.0, 0.0], [2.0, 1.0]));
    // The height goes up, the width across it and the normal.
    assert_eq!(ends.axes[1], [1.0, 0.0, 0.0]);
    assert_eq!(ends.axes[0].map(f64::abs), [0.0, 0.0, 1.0]);
    let Shape::Box(cuboid) = scene.bodies[2].shape else { panic!("no box") };
    assert_eq!(cuboid.half, [0.5, 1.0, 1.5]);
    assert_eq!(cuboid.axes, [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let (centre, radius) = scene.bodies[3].shape.around().unwrap();
    assert_eq!((centre, radius), ([1.0, 1.0, 1.0], 2.0_f64.sqrt()));
}

#[test]
fn what_is_left_out_has_the_values_of_the_schema() {
    let text = "[film]\nwidth = 2\nheight = 2\n[camera]\nprojection = \"orthographic\"\nwidth = 2\nfrom = [0, 0, 5]\nat = [0, 0, 0]\n\
        [[material]]\nname = \"a\"\nreflectance = \"a.csv\"\n[[light]]\nspectrum = \"D65\"\ntowards = [0, 0, 1]\n\
        [[object]]\nmaterial = \"a\"\nsphere = { centre = [0, 0, 0], radius = 1 }\n";
    let Resolved { scene, kept, exposure, remarks, .. } = resolve(text).unwrap();
    assert_eq!((scene.samples, scene.seed, scene.bounces, scene.observer), (16, 1, Bounces::All, Observer::Two));
    assert_eq!((kept, exposure), (Kept::Colour, 1.0));
    assert_eq!((scene.grid.nm()[0], scene.grid.nm().len()), (300.0, 97));
    assert_eq!(
        remarks,
        ["the reflectance of material `a` is known from 400 to 700 nm; outside it is that of the nearest"]
    );
}

/// Of [`WHOLE`]: what is changed, into what, and what is said of it; `\n` is the end of a line.
const WRONG: &str = r#"radius = 1 >> radius = -1 >> scene.toml, line 51, column 32, `object.sphere.radius`: found -1; expected a number above 0
material = "red" >> material = "rot" >> line 54, column 1, `object.material`: found `rot`; expected one of: grey, red
radius = 1 >> radus = 1 >> line 51, column 32, `object.sphere.radus`: unknown field `radus`, expected `centre` or `radius`
width = 4 >> width = "4" >> line 5, column 9, `film.width`: invalid type: string "4", expected usize
width = 4 >> width = 40000 >> line 5, column 1, `film.width`: found 40000; expected 1 to 32768 pixels
exposure = 2 >> exposure = inf >> line 9, column 12, `film.exposure`: inf; expected a finite number below 1e9
at = [0, 4, 0] >> at = [0, nan, 0] >> `light.at`: nan; expected a finite number
normal = [0, 5, 0] >> normal = [0, 0, 0] >> `object.plane.normal`: found [0, 0, 0], which has no direction
up = [1, 0, 0] >> up = [0, 2, 0] >> `object.plane.up`: found `normal` and `up`
theta_deg = 90\n >> theta_deg = 190\n >> `light.theta_deg`: found 190; expected degrees from 0 to 180
name = "red" >> name = "grey" >> `material.name`: found a second material `grey`; expected another name
spectrum = "A" >> spectrum = "sun" >> `light.spectrum`: sun: found no such light
file = "red.bbrf" >> file = "no.bbrf" >> `material.file`: no.bbrf: cannot be read
file = "red.bbrf" >> file = "red.bbrf"\nalbedo = 1 >> found 2 of `file`, `albedo` and `reflectance`; expected exactly one
surround = true >> surround = false >> found 0 of `towards`, `theta_deg`, `at` and `surround = true`
reference_distance = 2 >> reference_distance = 0 >> `light.reference_distance`: found 0
refractive_index = 1.45 >> refractive_index = 0.9 >> `material.specular`: torrance-sparrow: `refractive_index`
width_deg = 40 >> width = 40 >> `camera.projection`: found "perspective"; expected `width_deg` beside it
width_deg = 40 >> width_deg = 180 >> line 19, column 1, `camera.width_deg`: the camera sees a width of 180
from = [0, 0, 5] >> from = [0, 0, 0] >> `camera.at`: the camera looks from where it stands
step = 10 >> step = 0.01 >> `wavelengths`: wavelengths from 400 to 700 nm in steps of 0.01 nm
observer = 10 >> observer = 5 >> line 1, column 12, `observer`: invalid value: integer `5`, expected 2 or 10, degrees
bounces = 3 >> bounces = "many" >> expected "all" or a whole number from 0
samples = 8 >> samples = 0 >> `film.samples`: found 0; expected 1 to
kept = "spectra" >> kept = "both" >> unknown variant `both`, expected `colour` or `spectra`
[camera] >> [camera >> line 17"#;

#[test]
fn an_error_names_line_column_and_key() {
    let cases: Vec<Vec<String>> =
        WRONG.lines().map(|line| line.split(" >> ").map(|part| part.replace("\\n", "\n")).collect()).collect();
    assert_eq!(cases.len(), 26);
    let mut missed = Vec::new();
    for case in &cases {
        let [old, new, expected] = case.as_slice() else { panic!("{case:?}") };
        let found = wrong(old, new);
        if !(found.contains(expected.as_str()) && found.starts_with("scene.toml, line ")) {
            missed.push(format!("{new}: found: {found}; expected: {expected}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_light_that_stops_where_a_material_is_excited_is_a_warning() {
    struct Glowing;
    impl Library for Glowing {
        fn material(&mut self, _: &Source<'_>) -> Result<(Material, Vec<String>), String> {
            let nm: Vec<f64> = (0..=40).map(|k| 300.0 + 10.0 * f64::from(k)).collect();
            let glow = |x: f64, m: f64| if x < 400.0 && m > 500.0 { 0.002 } else { 0.0 };
            let density = Array2::from_shape_fn((41, 41), |(i, j)| glow(nm[i], nm[j]));
            let surface = Reradiation::from_parts(nm.clone(), nm, vec![0.5; 41], density).unwrap();
            Ok((Material { name: String::new(), surface, specular: None, intensity: Vec::new() }, Vec::new()))
        }

        fn reflectance(&mut self, file: &str) -> Result<(Points, Vec<String>), String> {
            Shelf.reflectance(file)
        }

        fn light(&mut self, _: &str) -> Result<(Light, Vec<String>), String> {
            let kind = bbrf::quantity::QuantityKind::RelativeSpectrum;
            Ok((Light::new("lamp", kind, vec![350.0, 780.0], vec![1.0, 1.0], None).unwrap(), Vec::new()))
        }

        fn mesh(&mut self, file: &str) -> Result<(Corners, Vec<String>), String> {
            Shelf.mesh(file)
        }
    }
    let text = |from: f64| WHOLE.replacen("from = 400", &format!("from = {from}"), 1);
    let warnings = |from: f64| SceneDocument::resolve("s", &text(from), &mut Glowing).unwrap().warnings;
    let from_300 = warnings(300.0);
    assert_eq!(from_300.len(), 3, "one for each light: {from_300:?}");
    assert!(
        from_300[0].starts_with("material `red` under light `sun`: lamp has no value from 300 to 350 nm"),
        "{from_300:?}"
    );
    // What the wavelengths of the scene leave out is said, too: of 350 to 400 nm that is all.
    let from_400 = warnings(400.0).join("\n");
    assert!(from_400.contains("of its luminescence is excited outside 400 to 700 nm"), "{from_400}");
}

#[test]
fn no_text_ends_the_program() {
    for end in 0..WHOLE.len() {
        if let Err(error) = resolve(&WHOLE[..end]) {
            assert!(error.line >= 1 && error.column >= 1);
        }
    }
    for text in
        ["", "film = 3", "[[object]]", "object = [1, 2]", "film.width.x = 1", "\u{0}", "[film]\nwidth = 1\nwidth = 2"]
    {
        assert!(resolve(text).is_err(), "{text}");
    }
    let deep = format!("a = {}{}", "[".repeat(10_000), "]".repeat(10_000));
    assert!(resolve(&deep).is_err());
}

/// Numbers that mean nothing, the same for every run.
fn numbers(mut state: u64) -> impl FnMut(usize) -> usize {
    move |below| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    }
}

/// What differs from a scene by a word, a line or a letter is a scene or an error with its place; small ones are drawn as well.
#[test]
fn no_mutation_of_a_scene_ends_the_program() {
    let small = WHOLE.replace("bounces = 3", "bounces = 1").replace("samples = 8", "samples = 1");
    let words = [
        "0",
        "-1",
        "1e8",
        "nan",
        "-0.0",
        "1e-300",
        "[]",
        "[0, 0, 0]",
        "\"\"",
        "true",
        "{}",
        "\n",
        "=",
        "[[light]]\n",
        "[film]\n",
        "5e8",
        "18446744073709551615",
        "\u{e9}",
        "\"grey\"",
        "# ",
        "\"\"\"",
        "0x7fffffffffffffff",
        "1979-05-27",
        "surround = true\n",
    ];
    let mut draw = numbers(7);
    let (mut scenes, mut errors, mut drawn) = (0, 0, 0);
    for _ in 0..2000 {
        let mut lines: Vec<String> = small.lines().map(str::to_owned).collect();
        for _ in 0..=draw(2) {
            let at = draw(lines.len());
            match draw(6) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(draw(at + 1), lines[at].clone()),
                // Another value.
                2 | 3 => {
                    let key = lines[at].split('=').next().unwrap_or_default().to_owned();
                    lines[at] = format!("{key}= {}", words[draw(words.len())]);
                }
                // Another number in a list or a table.
                4 => {
                    let parts: Vec<&str> = lines[at].split(' ').collect();
                    let place = draw(parts.len());
                    let mut parts: Vec<&str> = parts;
                    parts[place] = words[draw(words.len())];
                    lines[at] = parts.join(" ");
                }
                _ => {
                    let mut letters: Vec<char> = lines[at].chars().collect();
                    let place = draw(letters.len() + 1);
                    letters.insert(place, char::from_u32(draw(0x300) as u32).unwrap_or(' '));
                    lines[at] = letters.into_iter().collect();
                }
            }
        }
        let text = lines.join("\n") + "\n";
        match resolve(&text) {
            Ok(found) => {
                scenes += 1;
                let scene = &found.scene;
                let paths = scene.size.0 * scene.size.1 * scene.samples as usize;
                if paths <= 64 && scene.grid.nm().len() <= 100 && scene.bounces != Bounces::All {
                    drawn += 1;
                    let choice = bbrf::simulate::Choice::everything(Bounces::Most(1), scene.grid.step());
                    let watch = bbrf::simulate::Watch::default();
                    let layers = &[bbrf::simulate::Layer::Total];
                    if let Err(why) = bbrf::simulate::Picture::draw(scene, &choice, found.kept, layers, &watch) {
                        assert!(why.to_string().contains("expected"), "{why}");
                    }
                }
            }
            Err(error) => {
                errors += 1;
                assert!(error.line >= 1 && error.line <= text.lines().count() + 1, "{error}");
                assert!(!error.problem.is_empty(), "{error}");
            }
        }
    }
    println!("{scenes} scenes, {drawn} of them drawn, {errors} errors");
    assert!(scenes > 100 && drawn > 100 && errors > 1000, "{scenes} {drawn} {errors}");
}

#[test]
fn lights_of_different_units_need_a_strength_that_brings_them_together() {
    struct Measured;
    impl Library for Measured {
        fn material(&mut self, source: &Source<'_>) -> Result<(Material, Vec<String>), String> {
            Shelf.material(source)
        }

        fn reflectance(&mut self, file: &str) -> Result<(Points, Vec<String>), String> {
            Shelf.reflectance(file)
        }

        fn light(&mut self, name: &str) -> Result<(Light, Vec<String>), String> {
            use bbrf::quantity::QuantityKind::{RelativeSpectrum, SpectralIrradiance, SpectralRadiance};
            let kind = match name {
                "A" => SpectralIrradiance,
                "E" => SpectralRadiance,
                _ => RelativeSpectrum,
            };
            Ok((Light::new(name, kind, vec![300.0, 780.0], vec![1.0, 1.0], None).unwrap(), Vec::new()))
        }

        fn mesh(&mut self, file: &str) -> Result<(Corners, Vec<String>), String> {
            Shelf.mesh(file)
        }
    }
    let resolve = |text: &str| SceneDocument::resolve("scene.toml", text, &mut Measured);
    // The first says its strength; of the other two one has to.
    let error = resolve(WHOLE).unwrap_err().to_string();
    assert_eq!(
        error,
        "scene.toml, line 45, column 1, `light.spectrum`: found a light in W m-2 sr-1 nm-1, and light `light 2` in W m-2 nm-1; \
         expected one unit, or a `strength` beside one of them that brings both together (1 if they are so already)"
    );
    let stated = WHOLE.replace("surround = true", "surround = true\nstrength = 1");
    assert_eq!(resolve(&stated).unwrap().scene.sources.len(), 3);
    // Of one unit they are added as they are.
    assert!(resolve(&WHOLE.replace("spectrum = \"E\"", "spectrum = \"A\"")).is_ok());
}
