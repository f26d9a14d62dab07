//! Scenes of fitted models: a pixel shows what `bbrf eval` says of its geometry.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod common {
    pub mod bispectral;
}

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use bbrf::container::write_file;
use bbrf::dataset::{Document, Id, LightSpectrum};
use bbrf::quantity::{Bandpass, Part, Quantity, QuantityKind, WavelengthAxis};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use serde_json::Value;

fn bbrf() -> Command {
    Command::cargo_bin("bbrf").unwrap()
}

/// A fit of the simulated scan, with the matrix where it is asked for.
fn fitted(folder: &Path, with_matrix: bool, settings: &[&str]) -> PathBuf {
    let scan = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan/scan.csv");
    let (file, matrix, out) = (folder.join("scan.bbrf"), folder.join("matrix.bbrf"), folder.join("model.bbrf"));
    bbrf().arg("import").arg(scan).arg("-o").arg(&file).assert().success();
    write_file(&common::bispectral::document(), &matrix).unwrap();
    let mut fit = bbrf();
    fit.arg("fit").arg(&file).args(settings).arg("-o").arg(&out);
    if with_matrix {
        fit.arg("--donaldson").arg(&matrix);
    }
    fit.assert().success();
    out
}

/// A plane of the model under one light of an angle, as one pixel sees it from another.
fn scene(folder: &Path, lights: &str, theta_v: f64) -> PathBuf {
    let (sine, cosine) = theta_v.to_radians().sin_cos();
    let text = format!(
        "bounces = 0\n[film]\nwidth = 1\nheight = 1\nkept = \"spectra\"\n[wavelengths]\nfrom = 300\nto = 780\nstep = 10\n\
         [camera]\nprojection = \"orthographic\"\nwidth = 1e-6\nfrom = [{}, 0, {}]\nat = [0, 0, 0]\n\
         [[material]]\nname = \"fitted\"\nfile = \"model.bbrf\"\n{lights}\
         [[object]]\nmaterial = \"fitted\"\nplane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}\n",
        5.0 * sine,
        5.0 * cosine
    );
    let path = folder.join("scene.toml");
    std::fs::write(&path, text).unwrap();
    path
}

fn light(spectrum: &str, theta: f64, phi: f64) -> String {
    format!("[[light]]\nspectrum = \"{spectrum}\"\ntheta_deg = {theta}\nphi_deg = {phi}\n")
}

/// Layer by layer pi times the radiance of the one pixel, by wavelength.
fn pixel(folder: &Path, scene: &Path) -> Vec<(String, Vec<(f64, f64)>)> {
    let out = folder.join("out");
    bbrf().args(["render", "--spectra"]).arg(scene).arg("-o").arg(&out).assert().success();
    let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_file(out.join("layers.exr")).unwrap();
    std::fs::remove_dir_all(out).unwrap();
    let layer = |layer: &exr::prelude::Layer<exr::prelude::AnyChannels<FlatSamples>>| {
        let channel = |channel: &exr::prelude::AnyChannel<FlatSamples>| {
            let name = channel.name.to_string();
            let nm = name.strip_prefix("S0.")?.strip_suffix("nm")?.replace(',', ".").parse().ok()?;
            let FlatSamples::F32(values) = &channel.sample_data else { panic!("not f32") };
            Some((nm, std::f64::consts::PI * f64::from(values[0])))
        };
        let mut spectrum: Vec<(f64, f64)> = layer.channel_data.list.iter().filter_map(channel).collect();
        spectrum.sort_by(|a, b| a.0.total_cmp(&b.0));
        (layer.attributes.layer_name.clone().unwrap().to_string(), spectrum)
    };
    image.layer_data.iter().map(layer).collect()
}

fn json(command: &mut Command) -> Value {
    let output = command.assert().success().get_output().clone();
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Signed angles as a scan has them, and how a scene says the same: beyond the normal the light comes from the other side.
const GEOMETRIES: [(f64, f64, f64); 4] =
    [(20.0, 20.0, 180.0), (-60.0, 10.0, 0.0), (45.0, 50.0, 180.0), (5.0, 0.0, 0.0)];

#[test]
fn a_pixel_of_a_complete_model_is_what_eval_says_of_its_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let model = fitted(folder.path(), true, &[]);
    let list = folder.path().join("g.csv");
    let rows: String = GEOMETRIES.iter().map(|(i, v, _)| format!("{i},{v}\n")).collect();
    std::fs::write(&list, format!("# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n{rows}")).unwrap();
    for spectrum in ["E", "A", "D65"] {
        let said = json(
            bbrf().args(["eval", "--light", spectrum, "--json", "--model"]).arg(&model).arg("--geometry").arg(&list),
        );
        let nm: Vec<f64> = said["emission_nm"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let mut worst = 0.0_f64;
        for (row, (theta_i, theta_v, phi)) in GEOMETRIES.iter().enumerate() {
            let scene = scene(folder.path(), &light(spectrum, theta_i.abs(), *phi), *theta_v);
            for (layer, spectrum) in pixel(folder.path(), &scene) {
                let Some(expected) = said["under"]["rows"][row][&layer].as_array() else { continue };
                let peak = expected.iter().map(|x| x.as_f64().unwrap()).fold(0.0, f64::max);
                // At the first emission `eval` sees half a cell of the light, the half that the matrix has; the scene has both.
                for (nm, expected) in nm.iter().zip(expected).skip(1) {
                    let found = spectrum.iter().find(|(at, _)| at == nm).unwrap().1;
                    let error = (found - expected.as_f64().unwrap()).abs() / peak;
                    if error > worst {
                        worst = error;
                        println!("{layer} {nm} nm row {row}: {found} for {expected}: {error:.1e}");
                    }
                }
            }
        }
        println!("{spectrum}: {worst:.1e}");
        assert!(worst < 2e-7, "{worst}");
    }
}

#[test]
fn a_model_without_a_matrix_reflects_and_says_that_it_does_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let model = fitted(folder.path(), false, &["--reduce", "none"]);
    let list = folder.path().join("g.csv");
    std::fs::write(&list, "# angles: signed, mirror-at-equal\ntheta_i_deg,theta_v_deg\n20,20\n").unwrap();
    let said = json(bbrf().args(["eval", "--json", "--model"]).arg(&model).arg("--geometry").arg(&list));
    let scene = scene(folder.path(), &light("E", 20.0, 180.0), 20.0);
    let total = pixel(folder.path(), &scene).into_iter().find(|(name, _)| name == "total").unwrap().1;
    let rows = said["rows"].as_array().unwrap();
    assert!(rows.len() > 20, "{}", rows.len());
    let mut compared = 0;
    for row in rows {
        let (nm, value) = (row["emission_nm"].as_f64().unwrap(), row["value"].as_f64().unwrap());
        let Some((_, found)) = total.iter().find(|(at, _)| *at == nm) else { continue };
        // The light is 100 at every wavelength.
        assert!((found / 100.0 - value).abs() < 2e-7 * value.max(1.0), "{nm} nm: {found} for {value}");
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
    bbrf()
        .arg("plan")
        .arg(&scene)
        .assert()
        .success()
        .stderr(contains("has no matrix: it reflects, and does not luminesce"));
}

#[test]
fn a_roughness_that_differs_between_wavelengths_is_an_error_with_line_and_key() {
    let folder = tempfile::tempdir().unwrap();
    fitted(folder.path(), false, &["--reduce", "none", "--share", "nothing"]);
    let scene = scene(folder.path(), &light("E", 20.0, 180.0), 20.0);
    let out = folder.path().join("out");
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().code(2).stderr(
        contains("scene.toml, line 17, column 1, `material.file`")
            .and(contains("the specular term differs between wavelengths"))
            .and(contains("--share shape")),
    );
    assert!(!out.exists());
    // The way out that is named.
    let text = std::fs::read_to_string(&scene).unwrap();
    let stated = "file = \"model.bbrf\"\nspecular = { intensity = 3, roughness = 0.1, refractive_index = 1.5 }\n";
    std::fs::write(&scene, text.replace("file = \"model.bbrf\"\n", stated)).unwrap();
    bbrf().arg("render").arg(&scene).arg("-o").arg(&out).assert().success();
}

/// A lamp that was measured in W m-2 nm-1 beside one of the CIE, of which only the form is known.
#[test]
fn lights_of_different_units_are_added_only_where_their_strength_says_how() {
    let folder = tempfile::tempdir().unwrap();
    fitted(folder.path(), false, &[]);
    let lamp = bbrf::dataset::Light {
        id: Id::new("lamp").unwrap(),
        spectrum: Some(LightSpectrum {
            quantity: Quantity::absolute(QuantityKind::SpectralIrradiance, Part::Total),
            axis: WavelengthAxis::new(vec![300.0, 780.0], Bandpass::Unstated).unwrap(),
            values: vec![0.1, 0.2],
            flags: vec![0; 2],
        }),
        ..bbrf::dataset::Light::default()
    };
    let document = Document { lights: vec![lamp], ..common::bispectral::document() };
    write_file(&document, &folder.path().join("lamp.bbrf")).unwrap();
    let both = light("D65", 20.0, 180.0) + &light("lamp.bbrf#lamp", 30.0, 0.0);
    let path = scene(folder.path(), &both, 20.0);
    bbrf().arg("plan").arg(&path).assert().code(2).stderr(
        contains("scene.toml, line 23, column 1, `light.spectrum`")
            .and(contains("found a light in W m-2 nm-1, and light `light 1` in the relative unit of the CIE"))
            .and(contains("`strength`")),
    );
    for stated in [
        both.replacen("theta", "strength = 0.01\ntheta", 1),
        both.replace("theta_deg = 30", "strength = 1\ntheta_deg = 30"),
    ] {
        let path = scene(folder.path(), &stated, 20.0);
        bbrf().arg("plan").arg(&path).assert().success();
    }
}
