//! `bbrf render`: from a scene and a file to images.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common {
    pub mod bispectral;
    pub mod rooms;
}

use std::path::Path;

use assert_cmd::Command;
use common::rooms::{SPHERE, room, scene};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn record(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("render.json")).unwrap()).unwrap()
}

fn layer<'a>(record: &'a Value, name: &str) -> &'a Value {
    record["layers"].as_array().unwrap().iter().find(|layer| layer["layer"] == name).unwrap()
}

#[test]
fn a_fluorescent_sphere_is_drawn_with_its_parts() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), SPHERE);
    let out = folder.path().join("out");
    let run =
        bbrf().arg("render").arg(&scene).arg("-o").arg(&out).arg("--json").assert().success().get_output().clone();
    assert_eq!(
        names(&out),
        ["diffuse.png", "layers.exr", "luminescent.png", "render.json", "specular.png", "total.png"]
    );
    let printed: Value = serde_json::from_slice(&run.stdout).unwrap();
    let record = record(&out);
    assert_eq!(printed, record);
    let schema = bbrf().args(["schema", "render"]).assert().success().get_output().stdout.clone();
    let schema: Value = serde_json::from_slice(&schema).unwrap();
    jsonschema::validator_for(&schema).unwrap().validate(&record).unwrap();
    assert_eq!(record["schema"], "bbrf:render:1");
    // A sphere under one lamp has a closed form: nothing is drawn at random.
    assert_eq!(record["noise"], Value::Null);
    let mean = |name: &str| layer(&record, name)["mean"][1].as_f64().unwrap();
    for name in ["luminescent", "diffuse", "specular"] {
        assert!(mean(name) > 0.0, "{name}");
    }
    let sum = mean("luminescent") + mean("diffuse") + mean("specular");
    assert!((mean("total") - sum).abs() < 1e-6 * sum, "{} {sum}", mean("total"));
    // The lamp stands behind the eye: the highlight is in the middle.
    let at = &layer(&record, "specular")["brightest"];
    let (column, row) = (at["column"].as_u64().unwrap(), at["row"].as_u64().unwrap());
    assert!((23..=24).contains(&column) && (15..=16).contains(&row), "{at}");
    let png = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(out.join("total.png")).unwrap()));
    let reader = png.read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (48, 32));
}

#[test]
fn the_same_scene_has_the_same_bytes_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), &room());
    let draw = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        bbrf().arg("render").arg(&scene).arg("-o").arg(&out).args(more).assert().success();
        out
    };
    let one = draw("one", &["--threads", "1"]);
    let two = draw("two", &["--threads", "3"]);
    let other = draw("other", &["--seed", "2"]);
    assert!(names(&one).contains(&"interreflection.png".to_owned()), "{:?}", names(&one));
    assert_eq!(names(&one), names(&two));
    for name in names(&one) {
        assert!(std::fs::read(one.join(&name)).unwrap() == std::fs::read(two.join(&name)).unwrap(), "{name}");
    }
    assert!(std::fs::read(one.join("layers.exr")).unwrap() != std::fs::read(other.join("layers.exr")).unwrap());
    let noise = &record(&one)["noise"];
    assert!(noise["largest"].as_f64().unwrap() >= noise["median"].as_f64().unwrap());
    assert!(noise["largest"].as_f64().unwrap() > 0.0);
}

#[test]
fn layers_are_those_that_are_asked_for_and_none_of_an_earlier_image_stays() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), SPHERE);
    let out = folder.path().join("out");
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().success();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).args(["--layers", "total,luminescent"]).assert().success();
    assert_eq!(names(&out), ["layers.exr", "luminescent.png", "notes.txt", "render.json", "total.png"]);
}

#[test]
fn spectra_look_like_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), SPHERE);
    let draw = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        bbrf().arg("render").arg(&scene).arg("-o").arg(&out).args(more).assert().success();
        out
    };
    let (colours, spectra) = (draw("colours", &[]), draw("spectra", &["--spectra"]));
    let mean = |out: &Path| layer(&record(out), "total")["mean"].clone();
    for c in 0..3 {
        let (a, b) = (mean(&colours)[c].as_f64().unwrap(), mean(&spectra)[c].as_f64().unwrap());
        assert!((a - b).abs() < 1e-5 * a, "{a} {b}");
    }
    let size = |out: &Path| std::fs::metadata(out.join("layers.exr")).unwrap().len();
    assert!(size(&spectra) > 3 * size(&colours), "49 wavelengths beside 3 colours");
    assert_eq!(record(&spectra)["kept"], "spectra");
}

#[test]
fn an_error_names_the_scene_its_line_and_key_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let wrong = |old: &str, new: &str, expected: &str| {
        let scene = scene(folder.path(), &SPHERE.replacen(old, new, 1));
        let run = bbrf().arg("render").arg(scene).arg("-o").arg(&out).assert().code(2);
        run.stderr(contains("scene.toml, line ").and(contains(expected)));
        assert!(!out.exists(), "{new}");
    };
    wrong("radius = 1", "radius = 0", "`object.sphere.radius`: found 0");
    wrong("file = \"orange.bbrf\"", "file = \"apple.bbrf\"", "`material.file`:");
    wrong("file = \"orange.bbrf\"", "file = \"orange.bbrf\"\nmatrix = \"apple\"", "no measurement `apple`");
    wrong(
        "file = \"orange.bbrf\"",
        "file = \"orange.bbrf\"\nmodel = \"apple\"",
        "no model `apple`; the file holds: none",
    );
    wrong("spectrum = \"D65\"", "spectrum = \"lamp.csv\"", "found neither a file nor a light of the CIE");
    wrong(
        "sphere = { centre = [0, 0, 0], radius = 1 }",
        "mesh = { file = \"three.ply\" }",
        "expected a Wavefront file",
    );
}

#[test]
fn what_is_read_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), SPHERE);
    std::fs::rename(&scene, folder.path().join("render.json")).unwrap();
    let run = bbrf().arg("render").arg(folder.path().join("render.json")).arg("-o").arg(folder.path()).assert().code(2);
    run.stderr(contains("would be overwritten"));
}

#[test]
fn a_scene_that_multiplies_light_may_be_shown_and_not_bounce() {
    let folder = tempfile::tempdir().unwrap();
    let text = room().replace("albedo = 0.8", "albedo = 1.2");
    let path = scene(folder.path(), &text);
    let out = folder.path().join("out");
    let run = bbrf().arg("render").arg(&path).arg("-o").arg(&out).assert().code(2);
    run.stderr(contains("material `white` sends back up to 1.2").and(contains("bounces = 0")));
    let path = scene(folder.path(), &text.replace("bounces = 3", "bounces = 0"));
    bbrf().arg("render").arg(&path).arg("-o").arg(&out).assert().success();
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_file() {
    use std::io::Read;
    let folder = tempfile::tempdir().unwrap();
    let text = room().replace("samples = 4", "samples = 100000");
    let path = scene(folder.path(), &text);
    let out = folder.path().join("out");
    let program = assert_cmd::cargo::cargo_bin("bbrf");
    let mut child = std::process::Command::new(program)
        .arg("render")
        .args([&path, Path::new("-o"), &out])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Long enough for the work to begin, and far from its end.
    std::thread::sleep(std::time::Duration::from_secs(2));
    let status = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(status.success());
    let ended = child.wait().unwrap();
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!(ended.code(), Some(2), "{said}");
    assert!(said.contains("interrupted after") && said.contains("nothing was written"), "{said}");
    assert!(!out.exists());
}

#[test]
fn the_plan_says_why_and_stands_beside_the_images() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), SPHERE);
    let plan = bbrf().args(["plan", "--json"]).arg(&scene).output().unwrap();
    assert!(plan.status.success(), "{}", String::from_utf8_lossy(&plan.stderr));
    let plan: Value = serde_json::from_slice(&plan.stdout).unwrap();
    let schema: Value = serde_json::from_str(include_str!("../schema/plan.json")).unwrap();
    assert!(jsonschema::is_valid(&schema, &plan), "{plan:#}");
    let shadow = plan["effects"].as_array().unwrap().iter().find(|one| one["effect"] == "shadow").unwrap();
    assert_eq!(shadow["simulate"], false);
    assert!(shadow["reason"].as_str().unwrap().contains("one convex body"));
    bbrf()
        .arg("plan")
        .arg(&scene)
        .assert()
        .success()
        .stdout(contains("luminescence").and(contains("changes a pixel by nothing")));
    bbrf()
        .arg("plan")
        .arg(&scene)
        .args(["--max-delta-e", "-1"])
        .assert()
        .code(2)
        .stderr(contains("expected a number of 0 or more"));
    let images = folder.path().join("images");
    bbrf().arg("render").arg(&scene).arg("-o").arg(&images).assert().success().stdout(contains("left out: "));
    let record: Value = serde_json::from_slice(&std::fs::read(images.join("render.json")).unwrap()).unwrap();
    assert_eq!(record["plan"]["effects"], plan["effects"]);
    let full = folder.path().join("full");
    bbrf().arg("render").arg(&scene).arg("--everything").arg("-o").arg(&full).assert().success();
    let bytes = |folder: &Path| std::fs::read(folder.join("total.png")).unwrap();
    assert_eq!(bytes(&images), bytes(&full), "what was left out cannot be seen");
}

#[test]
fn a_ladder_of_a_scene_names_the_plan_to_render_with() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), &room());
    let ladder = |more: &[&str]| -> Value {
        let run = bbrf().args(["cost", "image", "--patience", "0", "--json"]).args(more).arg(&scene).output().unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        serde_json::from_slice(&run.stdout).unwrap()
    };
    let found = ladder(&[]);
    let rungs = found["rungs"].as_array().unwrap();
    let error = |name: &str| rungs.iter().find(|rung| rung["name"] == name).unwrap()["error"].as_f64().unwrap();
    // The reference has other random numbers, and fewer of its own errors: more samples come nearer to it.
    let own = error("everything");
    assert!(own > 0.0 && (error("tolerance 0") - own).abs() < 1e-3, "{rungs:#?}");
    assert!(error("16 samples") < own && own < error("1 sample"), "{rungs:#?}");
    assert!(
        (error("plan, product by pixel") - own).abs() < 1e-3 && error("0 bounces") > error("2 bounces"),
        "{rungs:#?}"
    );
    assert!(found["meaning"]["reference"].as_str().unwrap().contains("8 times as many samples"), "{found:#}");
    let found = ladder(&["--max-error", &(1.001 * own).to_string()]);
    let answer = found["answer"]["command"].as_str().unwrap();
    assert!(answer.starts_with("bbrf render ") && !answer.contains("--samples 1 "), "{answer}");
}

#[test]
fn the_annotated_scene_of_the_manual_has_every_key_and_can_be_planned() {
    let folder = tempfile::tempdir().unwrap();
    let manual = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rendering.md")).unwrap();
    let text = manual.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let path = scene(folder.path(), &text.replace("orange.bbrf", "dim.bbrf"));
    std::fs::write(folder.path().join("wall.csv"), "300,0.6\n780,0.7\n").unwrap();
    std::fs::write(folder.path().join("thing.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    bbrf().arg("plan").arg(&path).assert().success().stdout(contains("interreflection"));
    let schema = bbrf().args(["schema", "scene"]).assert().success().get_output().stdout.clone();
    let schema: Value = serde_json::from_slice(&schema).unwrap();
    let sections = schema["$defs"].as_object().unwrap().values().chain([&schema]);
    let keys: Vec<&String> =
        sections.filter_map(|section| section["properties"].as_object()).flat_map(|keys| keys.keys()).collect();
    assert!(keys.len() > 40, "{keys:?}");
    let words: Vec<&str> = text.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let missing: Vec<&&String> = keys.iter().filter(|key| !words.contains(&key.as_str())).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// Under a lamp that no eye sees a white surface is no white: the picture is shown as daylight of the same power would be.
#[test]
fn fluorescence_is_seen_under_a_lamp_that_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let lamp = |name: &str, nm: [f64; 5]| {
        let values = [0.0, 1.0, 2.0, 1.0, 0.0];
        let rows: Vec<String> = nm.iter().zip(values).map(|(nm, value)| format!("{nm},{value}\n")).collect();
        std::fs::write(folder.path().join(name), rows.concat()).unwrap();
    };
    lamp("dark.csv", [345.0, 350.0, 355.0, 360.0, 365.0]);
    lamp("blue.csv", [430.0, 440.0, 450.0, 460.0, 470.0]);
    // Knots at any distance are a spectrum, too.
    lamp("sodium.csv", [580.0, 586.0, 589.0, 592.0, 598.0]);
    for (name, glows) in [("dark.csv", true), ("blue.csv", true), ("sodium.csv", false)] {
        let text = SPHERE.replace("\"D65\"", &format!("\"{name}\""));
        let scene = scene(folder.path(), &text);
        let out = folder.path().join(name.replace(".csv", ""));
        let run = bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().success();
        run.stderr(contains("white is a perfect diffuser under D65 of the same irradiance"));
        let record = record(&out);
        assert_eq!(record["white_of"], "daylight");
        let most = |layer_name: &str| layer(&record, layer_name)["brightest"]["xyz"][1].as_f64().unwrap();
        // As bright as a surface may be, and not thousands of times as bright.
        assert!(most("total") > 0.01 && most("total") < 30.0, "{name}: {}", most("total"));
        assert_eq!(most("luminescent") > 0.02, glows, "{name}: {}", most("luminescent"));
        bbrf().arg("plan").arg(&scene).assert().success();
    }
    let daylight = scene(folder.path(), SPHERE);
    let out = folder.path().join("daylight");
    bbrf().arg("render").arg(&daylight).arg("-o").arg(&out).assert().success().stderr(contains("under D65 of").not());
    assert_eq!(record(&out)["white_of"], "lights");
}

/// The scene that the README begins with, fewer samples.
#[test]
fn the_scene_of_the_readme_is_drawn_from_a_clean_clone() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let room = folder.path().join("room.toml");
    std::fs::copy(root.join("examples/room.toml"), &room).unwrap();
    let matrix = root.join("testdata/bispectral/synthetic.BFC");
    bbrf().arg("import").arg(matrix).arg("-o").arg(folder.path().join("glow.bbrf")).assert().success();
    bbrf().arg("plan").arg(&room).assert().success().stdout(contains("interreflection   simulate"));
    let out = folder.path().join("room");
    bbrf().arg("render").arg(&room).arg("-o").arg(&out).args(["--samples", "2"]).assert().success();
    let record = record(&out);
    // The ball lights the wall: what came by way of another body is yellower than the light.
    let [x, y, z] = [0, 1, 2].map(|c| layer(&record, "interreflection")["mean"][c].as_f64().unwrap());
    let white = [0, 1, 2].map(|c| record["white"][c].as_f64().unwrap());
    assert!(y > 0.01 && z / white[2] < 0.8 * y && x > 0.0, "{x} {y} {z}");
}

#[test]
fn what_may_not_bounce_is_named_by_its_line_by_plan_and_render_alike() {
    let folder = tempfile::tempdir().unwrap();
    let text = room().replace("albedo = 0.8", "albedo = 1.2");
    let scene = scene(folder.path(), &text);
    let line = text.lines().take_while(|line| !line.contains("name = \"white\"")).count();
    let expected = format!("scene.toml, line {line}, column 1, `material`: material `white` sends back up to 1.2");
    let out = folder.path().join("out");
    bbrf().arg("plan").arg(&scene).assert().code(2).stderr(contains(expected.clone()));
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().code(2).stderr(contains(expected));
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).args(["--bounces", "0"]).assert().success();
}

#[test]
fn what_looks_like_a_mistake_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let warned = |text: String, expected: &str| {
        let scene = scene(folder.path(), &text);
        bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().success().stderr(contains(expected));
    };
    std::fs::write(folder.path().join("below.csv"), "300,0.5\n500,-0.1\n780,0.5\n").unwrap();
    let paper = "name = \"paper\"\nreflectance = \"below.csv\"";
    let noisy = SPHERE
        .replace("name = \"orange\"\nfile = \"orange.bbrf\"", paper)
        .replace("material = \"orange\"", "material = \"paper\"");
    warned(noisy, "the reflectance of material `paper` has 1 of 3 values below 0, the least -0.1");
    std::fs::write(folder.path().join("lamp.csv"), "300,1\n500,1\n520,-0.25\n780,1\n").unwrap();
    warned(SPHERE.replace("\"D65\"", "\"lamp.csv\""), "light `light 1` has 1 of 4 values below 0, the least -0.25");
    warned(
        SPHERE
            .replace("from = [0, 0, 5]", "from = [0, 0, 0.5]")
            .replace("at = [0, 0, 0]", "at = [0, 0, -9]")
            .replace("width = 3\n", "width = 1\n"),
        "the picture is black: the camera is inside",
    );
    warned(SPHERE.replace("from = 300", "from = 500"), "the wavelengths of the scene are 500 to 780 nm");
    warned(SPHERE.to_owned() + "[[material]]\nname = \"spare\"\nalbedo = 0.1\n", "material `spare` is on no object");
}

#[test]
fn a_lamp_in_counts_is_not_added_to_daylight_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lamp.csv"), "300,0.001\n500,0.002\n780,0.001\n").unwrap();
    let second = "[[light]]\nspectrum = \"lamp.csv\"\ntowards = [1, 0, 0]\n";
    let scene = scene(folder.path(), &(SPHERE.to_owned() + second));
    let expected = "found a light in a relative unit of its own, and light `light 1` in the relative unit of the CIE";
    bbrf().arg("plan").arg(&scene).assert().code(2).stderr(contains(expected));
}
