//! Universal BRDF JSON: a file written by hand along the schema of the format, what is refused and where, and the way
//! there and back.
#![cfg(feature = "write")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

mod documents;

use std::path::Path;

use bbrf::dataset::{Document, Excitation, Extension};
use bbrf::export::universal_brdf::write;
use bbrf::import::{Format, Options, import};
use bbrf::quantity::{Basis, Flag, NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight};
use proptest::prelude::*;
use serde_json::{Value, json};

/// A file as a laboratory would write it: two geometries, two wavelengths, everything the schema requires.
fn by_hand() -> Value {
    json!({
        "metadata": {
            "schema": "https://example.org/brdf_json_schema_v1.0.json",
            "id": "https://example.org/data/1",
            "type": "BRDF",
            "timestamp": "2026-11-22T10:00:00+00:00",
            "provenance": {
                "organization": "Optics Hall",
                "location": { "country": "Atlantis", "city": "Deep", "street": "Reef", "building_nr": "1", "postal_code": "0" },
                "email": "a@example.org",
                "contact_person": "A. Person"
            },
            "license": { "type": "CC-BY-4.0", "rights_holder": "Optics Hall" },
            "description": "A pink tile at two wavelengths",
            "method": "measurement",
            "instrumentation": {
                "name": "Gonio 2",
                "serial_number": "7",
                "operator_name": "B. Person",
                "illumination_system": {
                    "name": "lamp with monochromator",
                    "source": {
                        "name": "xenon", "type": "arc", "power": { "value": 150, "unit": "W" },
                        "wl_range": { "min_value": 300, "max_value": 900, "unit": "nm" }
                    },
                    "wavelength_selectors": { "monochromator": { "name": "M", "settings": [
                        { "bandpass_FWHM": { "value": 4, "unit": "nm" }, "selected_wl": { "value": 500, "unit": "nm" } }
                    ] } },
                    "beam": { "shape": "circular", "dimensions": { "area": { "value": 80, "unit": "mm^2" } } }
                },
                "detection_system": {
                    "name": "detector",
                    "sensors": [{ "name": "diode", "spectral_response_range": { "min_value": 300, "max_value": 1100, "unit": "nm" } }],
                    "distance_from_sample": { "value": 0.5, "unit": "m" },
                    "solid_angle": { "value": 0.001, "unit": "sr", "uncertainty": 1e-6, "uncertainty_unit": "sr" }
                },
                "reference_info": { "name": "White 3", "material": "PTFE", "solid_angle": { "value": 0.001, "unit": "sr" } }
            },
            "software": "NA",
            "sample": {
                "name": "Pink tile", "type": "diffuse reflectance sample", "shape": "square",
                "dimensions": { "thickness": { "value": 0.5, "unit": "cm" } },
                "zero_azimuth_location": "arrow on the back",
                "materials": [{ "name": "glazed ceramic" }]
            },
            "environment": {
                "temperature": { "value": 296.15, "unit": "K" },
                "relative_humidity": { "value": 45, "unit": "%" },
                "pressure": { "value": 101.3, "unit": "kPa" }
            },
            "adhoc_section": { "batch": 12 }
        },
        "data": {
            "theta_i": { "unit": "rad", "values": [0, 0, 0.5, 0.5], "uncertainty": { "value": 0.1, "unit": "%" } },
            "phi_i": { "unit": "deg", "values": [0, 0, 180, 180] },
            "theta_r": { "unit": "°", "values": [45, 45, 45, 45] },
            "phi_r": { "unit": "deg", "values": [0, 0, 0, 0] },
            "wavelength_i": { "unit": "μm", "values": [0.5, 0.625, 0.5, 0.625] },
            "wavelength_r": { "unit": "μm", "values": [0.5, 0.625, 0.5, 0.625] },
            "polarization_i": { "notation": "sp", "values": ["u", "u", "u", "u"] },
            "BRDF": { "name": "BRDF", "unit": "1/sr", "values": [0.25, 0.125, -0.0625, 0.3125] },
            "uBRDF": { "name": "BRDF", "unit": "%", "values": [1, 2, 4, 0] }
        }
    })
}

fn read(text: &str) -> Result<Document, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tile.json");
    std::fs::write(&path, text).unwrap();
    import(&[path], &Options::default()).map_err(|error| error.to_string())
}

fn imported(value: &Value) -> Document {
    read(&value.to_string()).unwrap()
}

#[test]
fn a_file_along_the_schema_is_taken_whole() {
    let document = imported(&by_hand());
    assert_eq!(document.title.as_deref(), Some("A pink tile at two wavelengths"));
    assert_eq!(document.license.as_deref(), Some("CC-BY-4.0"));
    assert_eq!(document.contact.as_deref(), Some("A. Person <a@example.org>"));
    let [measurement] = document.measurements.as_slice() else { panic!("one measurement") };
    assert_eq!(measurement.shape(), (2, 2));
    assert_eq!(measurement.quantity.kind, QuantityKind::Brdf);
    assert_eq!(measurement.quantity.part, Part::Elastic, "one wavelength in and out at every point");
    assert_eq!(measurement.emission.wavelengths(), Some(&[500.0, 625.0][..]));
    assert_eq!(measurement.values.as_slice(), Some(&[0.25, 0.125, -0.0625, 0.3125][..]), "negative noise is data");
    assert_eq!(measurement.uncertainty.standard.as_ref().unwrap().as_slice(), Some(&[0.0025, 0.0025, 0.0025, 0.0][..]));
    let angle = measurement.acquisitions[1].geometry.unwrap();
    assert_eq!((angle.incidence.theta_deg(), angle.incidence.phi_deg()), (0.5_f64.to_degrees(), 180.0));
    assert_eq!(measurement.excitations[0].polarisation.as_deref(), Some("u"));
    assert_eq!(measurement.excitations[0].fwhm_nm, Some(4.0));
    let sample = &document.samples[0];
    assert_eq!((sample.title.as_deref(), sample.thickness_mm.unwrap().get()), (Some("Pink tile"), 5.0));
    assert_eq!(sample.material.as_deref(), Some("glazed ceramic"));
    let instrument = &document.instruments[0];
    assert_eq!(instrument.model.as_deref(), Some("Gonio 2"));
    assert_eq!((instrument.distance_mm.unwrap().get(), instrument.solid_angle_sr.unwrap().get()), (500.0, 0.001));
    assert_eq!(measurement.conditions.temperature_celsius.unwrap().get(), 23.0);
    assert_eq!(document.white_references[0].material.as_deref(), Some("PTFE"));
    assert_eq!(document.lights[0].make.as_deref(), Some("arc"));
}

#[test]
fn what_is_assumed_and_what_has_no_place_is_said() {
    let document = imported(&by_hand());
    let receipt = &document.provenance.receipts[0];
    let assumed = serde_json::to_string(&receipt.assumptions).unwrap();
    for word in ["counter-clockwise", "from the surface to the source", "k = 1"] {
        assert!(assumed.contains(word), "{word} in {assumed}");
    }
    let notices = serde_json::to_string(&receipt.notices).unwrap();
    assert!(notices.contains("1 values below 0") && notices.contains("io.github.bird-project"), "{notices}");
    let extension = &document.extensions[0];
    assert_eq!(extension.domain.as_str(), "io.github.bird-project");
    let text = extension.content.dataset("metadata").unwrap().array.as_text().unwrap();
    for kept in ["Atlantis", "101.3", "\"batch\":12", "rights_holder", "uncertainty", "timestamp", "selected_wl"] {
        assert!(text.contains(kept), "{kept} in {text}");
    }
    for taken in ["Pink tile", "B. Person", "bandpass_FWHM", "xenon"] {
        assert!(!text.contains(taken), "{taken} in {text}");
    }
    assert!(extension.content.dataset("data").unwrap().array.as_text().unwrap().contains("theta_i"));
    assert!(receipt.inputs[0].dialect.starts_with("universal-brdf, https://example.org/"));
    bbrf::container::document_bytes(&document).unwrap();
}

#[test]
fn a_fault_is_named_with_its_path() {
    let cases: &[(&str, &str, Value)] = &[
        ("/data/phi_i/values", "data.phi_i.values: found 3 entries; expected 4", json!([0, 0, 180])),
        ("/data/theta_r/values/2", "data.theta_r.values[2]: found 91 degrees", json!(91)),
        ("/data/theta_r/values/2", "data.theta_r.values[2]: found null", json!(null)),
        ("/data/phi_r/values/1", "data.phi_r.values[1]: found 360 degrees", json!(360)),
        ("/data/phi_r/values/1", "data.phi_r.values: found a list of 4", json!("0")),
        ("/data/BRDF/unit", "data.BRDF.unit: found the unit `1/sr/nm`; expected one of: 1/sr, sr^-1", json!("1/sr/nm")),
        ("/data/theta_i", "data.theta_i: found nothing", json!(null)),
        ("/data/uBRDF/values/3", "data.uBRDF.values[3]: found -1", json!(-1)),
        ("/data/wavelength_i/values/0", "data.wavelength_i.values[0]: found 0 nm", json!(0)),
        ("/data/polarization_i/values/0", "data.polarization_i.values[0]: found `x`", json!("x")),
        ("/metadata/type", "metadata.type: found `BSSRDF`; expected `BRDF`", json!("BSSRDF")),
    ];
    for (pointer, message, value) in cases {
        let mut file = by_hand();
        if *pointer == "/data/theta_i" {
            file["data"].as_object_mut().unwrap().remove("theta_i");
        } else {
            *file.pointer_mut(pointer).unwrap() = value.clone();
        }
        let error = read(&file.to_string()).unwrap_err();
        assert!(error.contains(message) && error.contains("tile.json"), "{message}: {error}");
    }
    let nan = by_hand().to_string().replace("0.3125", "NaN");
    let error = read(&nan).unwrap_err();
    assert!(error.contains("line 1") && error.contains("JSON has no NaN"), "{error}");
    let twice = by_hand().to_string().replacen("\"data\":{", "\"data\":{\"BRDF\":1,", 1);
    assert!(read(&twice).unwrap_err().contains("`BRDF` a second time"));
}

#[test]
fn what_writers_do_beside_the_schema_is_taken_with_a_notice() {
    let mut file = by_hand();
    let data = file["data"].as_object_mut().unwrap();
    data.remove("uBRDF");
    data.insert(
        "BRDF".to_owned(),
        json!({ "unit": "1/sr", "value": [0.5, null, 0.5, 0.5], "uncertainty": { "unit": "1/sr", "value": [0.1, 0.1, 0.1, 0.2] } }),
    );
    let document = imported(&file);
    let measurement = &document.measurements[0];
    assert!(measurement.values[(0, 1)].is_nan() && measurement.flags_at(0, 1).contains(Flag::NotMeasured));
    assert_eq!(measurement.uncertainty.standard.as_ref().unwrap()[(1, 1)], 0.2);
    let notices = serde_json::to_string(&document.provenance.receipts[0].notices).unwrap();
    assert!(notices.contains("`value` where") && notices.contains("`null`"), "{notices}");
}

#[test]
fn wavelengths_repeats_and_polarisation_make_rows_and_measurements() {
    let mut file = by_hand();
    file["data"]["wavelength_i"]["values"] = json!([0.4, 0.4, 0.4, 0.4]);
    let bispectral = imported(&file);
    assert_eq!(bispectral.measurements[0].quantity.part, Part::Unstated);
    assert_eq!(bispectral.measurements[0].excitations[0].wavelength_nm, Some(400.0));
    file["data"].as_object_mut().unwrap().remove("wavelength_r");
    let unresolved = imported(&file);
    assert_eq!(unresolved.measurements[0].shape(), (4, 1), "two points of one geometry are repeats");
    file["data"]["polarization_r"] = json!({ "notation": "sp", "values": ["s", "p", "s", "p"] });
    let split = imported(&file);
    let states: Vec<_> =
        split.measurements.iter().map(|m| m.conditions.viewing_polarisation.clone().unwrap()).collect();
    assert_eq!(states, ["p", "s"]);
    file["data"]["polarization_i"] =
        json!({ "notation": "inStokes", "values": [[1, 0, 0, 0], [1, 1, 0, 0], [1, 0, 0, 0], [1, 0.5, 0.25, 0]] });
    let stokes = imported(&file);
    assert_eq!(stokes.measurements[0].excitations[1].polarisation.as_deref(), Some("stokes 1 0.5 0.25 0"));
}

/// A document whose measurement is a BRDF, with everything that the format can hold.
fn of_brdf() -> Document {
    let mut document = imported(&by_hand());
    document.provenance = Default::default();
    let measurement = &mut document.measurements[0];
    measurement.title = Some("two wavelengths".into());
    measurement.values.mapv_inplace(|value| value / 3.0 + 1e-9);
    measurement.flags[(1, 0)] = Flag::LowLight.bit();
    measurement.uncertainty.components.push(bbrf::quantity::Component::new(
        "white",
        vec![0.005],
        bbrf::quantity::CorrelatedOver::All,
    ));
    document
}

fn written(document: &Document) -> (String, Vec<String>) {
    let mut bytes = Vec::new();
    let lost = write(document, &document.measurements[0], &mut bytes).unwrap();
    (String::from_utf8(bytes).unwrap(), lost)
}

#[test]
fn there_and_back_is_the_same_to_the_bit() {
    let document = of_brdf();
    let (text, _) = written(&document);
    let mut back = read(&text).unwrap();
    back.provenance = Default::default();
    assert_eq!(back, document);
    assert_eq!(written(&back).0, text, "and there again");
    // What was kept of theirs goes back; what is of others has no place.
    let extension = |lost: &[String]| lost.iter().filter(|line| line.contains("extension")).count();
    assert_eq!(extension(&written(&document).1), 0);
    back.extensions.push(Extension { domain: documents::id("org.example.arm"), ..back.extensions[0].clone() });
    assert_eq!(extension(&written(&back).1), 1);
}

/// The rules of their schema that columns and required members have to follow, in our own words.
fn objections(file: &Value) -> Vec<String> {
    let mut found = Vec::new();
    let data = file["data"].as_object().unwrap();
    let known = [
        "theta_i",
        "phi_i",
        "theta_r",
        "phi_r",
        "BRDF",
        "uBRDF",
        "wavelength_i",
        "wavelength_r",
        "polarization_i",
        "polarization_r",
        "adhoc_variables",
    ];
    found.extend(data.keys().filter(|key| !known.contains(&key.as_str())).cloned());
    let length = data["BRDF"]["values"].as_array().unwrap().len();
    for (name, column) in data.iter().filter(|(name, _)| *name != "adhoc_variables") {
        let values = column["values"].as_array().unwrap();
        let limit = if name.starts_with("theta") {
            90.0
        } else if name.starts_with("phi") {
            360.0
        } else {
            f64::MAX
        };
        let fits = |value: &Value| value.as_f64().is_none_or(|value| (0.0..limit).contains(&value));
        if values.len() != length || !values.iter().all(fits) {
            found.push(name.clone());
        }
        let members = ["name", "description", "unit", "notation", "values", "uncertainty", "comments"];
        found.extend(column.as_object().unwrap().keys().filter(|key| !members.contains(&key.as_str())).cloned());
        let stated = if name == "uBRDF" { "BRDF" } else { name };
        assert!(column.get("name").is_none_or(|name| name == stated));
    }
    for section in ["metadata", "data"] {
        found.extend(file.get(section).is_none().then(|| section.to_owned()));
    }
    let required = [
        "schema",
        "id",
        "type",
        "timestamp",
        "provenance",
        "description",
        "method",
        "instrumentation",
        "software",
        "sample",
        "environment",
    ];
    found.extend(required.iter().filter(|key| file["metadata"].get(**key).is_none()).map(|key| (*key).to_owned()));
    found
}

#[test]
fn what_is_written_follows_their_schema_or_is_listed() {
    let (text, lost) = written(&of_brdf());
    let file: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(objections(&file), ["BRDF"], "the one negative value");
    assert!(lost.iter().any(|line| line.contains("1 values below 0")), "{lost:?}");
    assert!(!lost.iter().any(|line| line.contains("requires")), "an import brings all it had: {lost:?}");
    let documents = documents::small();
    let mut bytes = Vec::new();
    let lost = write(&documents, documents.measurement("scan").unwrap(), &mut bytes).unwrap();
    assert!(lost.iter().any(|line| line.contains("requires") && line.contains("sample.zero_azimuth")), "{lost:?}");
    assert!(lost.iter().any(|line| line.contains("holds the BRDF made of it")), "{lost:?}");
    assert!(lost.iter().any(|line| line.contains("values that are missing")), "{lost:?}");
}

#[test]
fn a_factor_becomes_a_brdf_where_its_reference_allows() {
    let mut document = documents::small();
    let at = document.measurements.iter().position(|m| m.id.as_str() == "scan").unwrap();
    let brdf = |document: &Document| -> Result<Vec<f64>, String> {
        let mut bytes = Vec::new();
        write(document, &document.measurements[at], &mut bytes).map_err(|error| error.to_string())?;
        let file: Value = serde_json::from_slice(&bytes).unwrap();
        Ok(file["data"]["BRDF"]["values"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect())
    };
    let factor = document.measurements[at].values[(0, 0)];
    assert_eq!(brdf(&document).unwrap()[0], factor * (1.0 / std::f64::consts::PI));
    // Against a reference lit at 60 degrees, a sample lit at 80 degrees: half the beam over cos(80).
    document.measurements[at].quantity.reference = Reference::FixedGeometry { theta_i_deg: 60.0, theta_v_deg: 0.0 };
    let cosine = document.measurements[at].acquisitions[0].geometry.unwrap().incidence.cos_theta();
    let expected = factor * 0.5 / (std::f64::consts::PI * cosine);
    assert!((brdf(&document).unwrap()[0] / expected - 1.0).abs() < 1e-14);
    document.measurements[at].quantity.reference = Reference::Unstated;
    assert!(brdf(&document).unwrap_err().contains("the reference of this factor is unstated"));
    for kind in [
        QuantityKind::Brrdf,
        QuantityKind::SpectralRadiance,
        QuantityKind::DonaldsonMatrix,
        QuantityKind::LuminanceFactor,
    ] {
        document.measurements[at].quantity.kind = kind;
        assert!(brdf(&document).unwrap_err().contains("cannot be a Universal BRDF"), "{kind}");
    }
}

#[test]
fn the_command_writes_it_and_says_what_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let run = |arguments: &[&Path]| assert_cmd::Command::cargo_bin("bbrf").unwrap().args(arguments).output().unwrap();
    std::fs::write(at("tile.json"), by_hand().to_string()).unwrap();
    let (json, bbrf, back) = (at("tile.json"), at("tile.bbrf"), at("back.json"));
    let p = Path::new;
    assert!(run(&[p("import"), &json, p("-o"), &bbrf]).status.success());
    let output = run(&[p("export"), &bbrf, p("--to"), p("universal-brdf"), p("-o"), &back]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && said.contains("bbrf: not in the file: "), "{said}");
    let output = run(&[p("validate"), p("--json"), &bbrf]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    // Pi and a cosine are between a BRDF and what the terms are of.
    let output = run(&[p("fit"), &bbrf]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("radiance factor first"));
}

/// One change of a text.
fn mutate(text: &str, changes: &[(u8, u16, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (kind, at, new) in changes {
        let at = usize::from(*at) % (bytes.len() + 1);
        let end = (at + new.len()).min(bytes.len());
        match kind % 3 {
            0 => drop(bytes.splice(at..end, new.iter().copied())),
            1 => drop(bytes.splice(at..at, new.iter().copied())),
            _ => drop(bytes.splice(at..end, [])),
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(
        std::env::var("BBRF_PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(300)) })]

    #[test]
    fn whatever_bytes_come_in(
        changes in prop::collection::vec((any::<u8>(), any::<u16>(), prop::collection::vec(prop_oneof![
            any::<u8>(), Just(b'['), Just(b'{'), Just(b'"'), Just(b','), Just(b'9'), Just(b'-'), Just(b'e'), Just(b'}'),
        ], 0..4)), 0..4)
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.json");
        std::fs::write(&path, mutate(&by_hand().to_string(), &changes)).unwrap();
        let options = Options { format: Some(Format::UniversalBrdf), ..Options::default() };
        if let Ok(document) = import(&[path], &options) {
            bbrf::container::document_bytes(&document).unwrap();
            for measurement in &document.measurements {
                let _ = write(&document, measurement, &mut Vec::new());
            }
        }
    }

    /// Values, uncertainties and angles in degrees come back to the bit.
    #[test]
    fn numbers_come_back(numbers in prop::collection::vec((0.0..90.0_f64, 0.0..360.0_f64, any::<f64>(), 0.0..1.0_f64), 1..30)) {
        let numbers: Vec<_> = numbers.into_iter().filter(|(_, _, value, _)| value.is_finite()).collect();
        prop_assume!(!numbers.is_empty());
        let column = |pick: fn(&(f64, f64, f64, f64)) -> f64| numbers.iter().map(pick).collect::<Vec<_>>();
        let file = json!({
            "metadata": { "type": "BRDF" },
            "data": {
                "theta_i": { "unit": "deg", "values": column(|n| n.0) },
                "phi_i": { "unit": "deg", "values": column(|n| n.1) },
                "theta_r": { "unit": "deg", "values": column(|n| n.0) },
                "phi_r": { "unit": "deg", "values": column(|n| n.1) },
                "BRDF": { "unit": "1/sr", "values": column(|n| n.2) },
                "uBRDF": { "unit": "1/sr", "values": column(|n| n.3) },
            }
        });
        let first = imported(&file);
        let second = read(&written(&first).0).unwrap();
        let bits = |document: &Document| document.measurements[0].values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&first), column(|n| n.2).iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        prop_assert_eq!(bits(&first), bits(&second));
        prop_assert_eq!(&first.measurements[0].acquisitions, &second.measurements[0].acquisitions);
        prop_assert_eq!(&first.measurements[0].uncertainty, &second.measurements[0].uncertainty);
    }
}

#[test]
fn a_sparse_file_does_not_fill_memory() {
    let count = 30_000;
    let angle: Vec<f64> = (0..count).map(|k| f64::from(k) * 0.002).collect();
    let nm: Vec<f64> = (0..count).map(|k| 400.0 + f64::from(k) * 0.01).collect();
    let column = |values: &[f64], unit: &str| json!({ "unit": unit, "values": values });
    let file = json!({ "metadata": {}, "data": {
        "theta_i": column(&angle, "deg"), "phi_i": column(&vec![0.0; angle.len()], "deg"),
        "theta_r": column(&angle, "deg"), "phi_r": column(&vec![0.0; angle.len()], "deg"),
        "wavelength_r": column(&nm, "nm"), "BRDF": column(&angle, "1/sr"),
    }});
    assert!(read(&file.to_string()).unwrap_err().contains("share their wavelengths"));
}

/// What a BRDF is in our terms, for a reader of this file.
#[test]
fn a_brdf_has_no_reference() {
    let mut file = by_hand();
    file["metadata"]["adhoc_section"].as_object_mut().unwrap().clear();
    let quantity = Quantity {
        kind: QuantityKind::Brdf,
        part: Part::Elastic,
        normalised_at: NormalisedAt::Emission,
        basis: Basis::Energy,
        reference: Reference::None,
        reference_light: ReferenceLight::Same,
        certified_factor: Vec::new(),
    };
    let document = imported(&file);
    assert_eq!(document.measurements[0].quantity, quantity);
    assert_eq!(
        document.measurements[0].excitations,
        [Excitation {
            light: Some(documents::id("xenon")),
            fwhm_nm: Some(4.0),
            polarisation: Some("u".into()),
            ..Excitation::default()
        }]
    );
}
