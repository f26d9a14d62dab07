//! The faults, by rule.

use bbrf::container::tree::{Array, Data, Dataset, Group};
use bbrf::dataset::*;
use bbrf::quantity::*;
use ndarray::s;

use super::{Edit, Fault, id, numbers};

const fn d(rule: &'static str, what: &'static str, change: fn(&mut Document)) -> Fault {
    Fault { rule, what, edit: Edit::Document(change) }
}

const fn t(rule: &'static str, what: &'static str, change: fn(&mut Group)) -> Fault {
    Fault { rule, what, edit: Edit::Tree(change) }
}

const fn c(rule: &'static str, what: &'static str, change: fn(&mut Group)) -> Fault {
    Fault { rule, what, edit: Edit::Changed(change) }
}

const fn b(rule: &'static str, what: &'static str, change: fn(&mut Vec<u8>)) -> Fault {
    Fault { rule, what, edit: Edit::Bytes(change) }
}

fn scan(document: &mut Document) -> &mut Measurement {
    &mut document.measurements[1]
}

fn density(document: &mut Document) -> &mut Measurement {
    &mut document.measurements[2]
}

fn matrix(document: &mut Document) -> &mut Measurement {
    &mut document.measurements[3]
}

fn attached(document: &mut Document) -> &mut Attachment {
    document.models[0].donaldson.as_mut().expect("a matrix")
}

fn axis(measurement: &mut Measurement) -> &mut WavelengthAxis {
    match &mut measurement.emission {
        EmissionAxis::Wavelengths(axis) => axis,
        EmissionAxis::Band { .. } => panic!("the clean measurements have wavelengths"),
    }
}

/// The first column of a measurement, as if it were the value of a band.
fn one_band(measurement: &mut Measurement) {
    measurement.emission = EmissionAxis::Band { band: Some(Band { from_nm: 500.0, to_nm: 620.0 }) };
    let first = s![.., 0..1];
    measurement.values.slice_collapse(first);
    measurement.flags.slice_collapse(first);
    if let Some(standard) = &mut measurement.uncertainty.standard {
        standard.slice_collapse(first);
    }
}

fn bandpass(measurement: &mut Measurement) -> (&mut Vec<f64>, &mut BandpassShape, &mut BandpassCorrection) {
    match &mut axis(measurement).bandpass {
        Bandpass::Stated { fwhm_nm, shape, correction } => (fwhm_nm, shape, correction),
        Bandpass::Unstated => panic!("the clean measurements state their bandpass"),
    }
}

fn sigma(measurement: &mut Measurement) -> &mut ndarray::ArcArray2<f64> {
    measurement.uncertainty.standard.as_mut().expect("the clean measurements have uncertainties")
}

/// The elastic scan is what its model was fitted to; a change of it is meant to be one fault and no second.
fn scan_without_model(document: &mut Document) -> &mut Measurement {
    document.models.clear();
    scan(document)
}

fn finite(number: f64) -> Option<Finite> {
    Finite::try_from(number).ok()
}

fn group<'a>(tree: &'a mut Group, path: &str) -> &'a mut Group {
    tree.at_mut(path).expect("the group")
}

fn without(group: &mut Group, dataset: &str) {
    group.datasets.retain(|(name, _)| name != dataset);
}

fn set(group: &mut Group, attribute: &str, text: &str) {
    group.attributes.insert(attribute.to_owned(), Array::text(text));
}

fn set_on(group: &mut Group, dataset: &str, attribute: &str, value: Array) {
    group.dataset_mut(dataset).expect("the dataset").attributes.insert(attribute.to_owned(), value);
}

fn replace(group: &mut Group, dataset: &str, array: Array) {
    let found = group.dataset_mut(dataset).expect("the dataset");
    found.array = array;
    found.axes.clear();
}

/// The place of a text in the bytes.
fn position(bytes: &[u8], text: &[u8]) -> usize {
    bytes.windows(text.len()).position(|window| window == text).expect("the text")
}

/// Every fault.
#[rustfmt::skip]
pub const FAULTS: &[Fault] = &[
    b("structure.hdf5", "empty", |bytes| bytes.clear()),
    b("structure.hdf5", "no-hdf5", |bytes| *bytes = b"theta_i,theta_v,value\n0,10,0.5\n".to_vec()),
    b("structure.hdf5", "cut-in-the-middle", |bytes| bytes.truncate(bytes.len() / 2)),
    b("structure.hdf5", "last-byte-missing", |bytes| bytes.truncate(bytes.len() - 1)),
    b("structure.hdf5", "signature-damaged", |bytes| bytes[1] = b'h'),
    b("structure.hdf5", "text-mode-transfer", |bytes| {
        // What a transfer that turns CR LF into LF leaves of the signature.
        let at = position(bytes, b"\r\n");
        bytes.remove(at);
    }),
    b("structure.hdf5", "superblock-checksum", |bytes| bytes[13] ^= 1),
    t("structure.version-stated", "absent", |tree| drop(tree.attributes.remove("bbrf_version"))),
    t("structure.version-stated", "not-a-version", |tree| set(tree, "bbrf_version", "one")),
    t("structure.version-stated", "one-digit", |tree| set(tree, "bbrf_version", "1")),
    t("structure.version-stated", "a-number", |tree| {
        tree.attributes.insert("bbrf_version".into(), Array::scalar(Data::F64(vec![1.0].into())));
    }),
    t("structure.major-version", "two", |tree| set(tree, "bbrf_version", "2.0")),
    t("structure.major-version", "zero", |tree| set(tree, "bbrf_version", "0.9")),
    t("structure.minor-version", "later", |tree| set(tree, "bbrf_version", "1.7")),
    t("structure.conventions", "cf-only", |tree| set(tree, "Conventions", "CF-1.11")),
    t("structure.conventions", "inside-a-word", |tree| set(tree, "Conventions", "CF-1.11 NOBBRF")),
    t("structure.conventions", "absent", |tree| drop(tree.attributes.remove("Conventions"))),
    t("structure.complete", "no-flags", |tree| without(group(tree, "measurement/scan"), "value_flag")),
    t("structure.complete", "no-values", |tree| without(group(tree, "measurement/scan"), "value")),
    t("structure.complete", "no-wavelengths", |tree| without(group(tree, "measurement/scan"), "wavelength_emission")),
    t("structure.complete", "no-polar-angle", |tree| without(group(tree, "measurement/scan"), "theta_v")),
    t("structure.complete", "no-role", |tree| drop(group(tree, "measurement/scan").attributes.remove("role"))),
    t("structure.complete", "no-quantity", |tree| {
        let value = group(tree, "measurement/scan").dataset_mut("value").expect("values");
        value.attributes.remove("quantity");
    }),
    t("structure.complete", "no-reference", |tree| {
        let value = group(tree, "measurement/scan").dataset_mut("value").expect("values");
        value.attributes.remove("reference");
    }),
    t("structure.complete", "no-stated-mask", |tree| without(group(tree, "measurement/scan"), "stated")),
    t("structure.complete", "model-without-measurement", |tree| drop(group(tree, "model/fit").attributes.remove("measurement"))),
    t("structure.complete", "model-without-covariance", |tree| without(group(tree, "model/fit"), "covariance")),
    t("structure.complete", "component-without-cause", |tree| {
        let component = group(tree, "measurement/scan").dataset_mut("value_u_shared_0").expect("a component");
        component.attributes.remove("cause");
    }),
    t("structure.readable", "role-of-another-name", |tree| set(group(tree, "measurement/scan"), "role", "specimen")),
    t("structure.readable", "quantity-of-another-name", |tree| {
        set_on(group(tree, "measurement/scan"), "value", "quantity", Array::text("reflectance"));
    }),
    t("structure.readable", "reference-of-another-form", |tree| {
        set_on(group(tree, "measurement/scan"), "value", "reference", Array::text("fixed-geometry(45)"));
    }),
    t("structure.readable", "values-of-text", |tree| {
        let texts = Data::Text(vec!["0.5".to_owned(); 43 * 5]);
        replace(group(tree, "measurement/scan"), "value", Array { shape: vec![43, 5], data: texts });
    }),
    t("structure.readable", "values-of-one-axis", |tree| {
        replace(group(tree, "measurement/scan"), "value", Array::vector(Data::F64(vec![0.5; 215].into())));
    }),
    t("structure.readable", "angles-one-short", |tree| {
        replace(group(tree, "measurement/scan"), "theta_i", Array::vector(Data::F64(vec![0.0; 42].into())));
    }),
    t("structure.readable", "description-of-the-wrong-type", |tree| set(group(tree, "instrument/radiometer"), "distance_mm", "800 mm")),
    t("structure.readable", "description-not-finite", |tree| {
        let instrument = group(tree, "instrument/radiometer");
        instrument.attributes.insert("distance_mm".into(), Array::scalar(Data::F64(vec![f64::NAN].into())));
    }),
    t("structure.readable", "half-a-band", |tree| {
        let model = group(tree, "model/fit");
        model.dataset_mut("band").expect("a band").attributes.remove("to_nm");
    }),
    t("structure.readable", "receipts-no-json", |tree| {
        group(tree, "provenance").dataset_mut("receipts").expect("receipts").array = Array::text("[{");
    }),
    t("structure.readable", "term-of-another-name", |tree| set(group(tree, "model/fit/term_1"), "kind", "phong")),
    t("structure.readable", "truth-of-two", |tree| {
        group(tree, "sample/paint").attributes.insert("simulated".into(), Array::scalar(Data::U8(vec![2].into())));
    }),
    t("structure.readable", "identifier-with-a-space", |tree| {
        let samples = group(tree, "sample");
        samples.groups[0].0 = "the paint".to_owned();
    }),
    t("structure.shapes", "values-of-another-shape", |tree| {
        replace(group(tree, "measurement/scan"), "value", Array { shape: vec![1, 5], data: Data::F64(vec![1.0; 5].into()) });
    }),
    t("structure.shapes", "flags-of-another-shape", |tree| {
        replace(group(tree, "measurement/scan"), "value_flag", Array { shape: vec![43, 1], data: Data::U16(vec![0; 43].into()) });
    }),
    t("structure.shapes", "uncertainties-of-another-shape", |tree| {
        replace(group(tree, "measurement/scan"), "value_u", Array { shape: vec![5, 43], data: Data::F64(vec![0.1; 215].into()) });
    }),
    t("structure.attributes", "flag-meanings-in-another-order", |tree| {
        set_on(group(tree, "measurement/scan"), "value_flag", "flag_meanings", Array::text("one two"));
    }),
    t("structure.attributes", "coordinates-left-out", |tree| {
        set_on(group(tree, "measurement/scan"), "value", "coordinates", Array::text("theta_i phi_i"));
    }),
    t("structure.attributes", "flag-masks-shifted", |tree| {
        set_on(group(tree, "measurement/scan"), "value_flag", "flag_masks", Array::vector(Data::U16(vec![2, 4, 8].into())));
    }),
    t("structure.unknown", "a-dataset", |tree| {
        let extra = Dataset::new(Array::vector(Data::F64(vec![1.0].into())));
        group(tree, "measurement/scan").datasets.push(("temperature".into(), extra));
    }),
    t("structure.unknown", "an-attribute", |tree| set(group(tree, "measurement/scan"), "weather", "sunny")),
    t("structure.unknown", "a-group", |tree| tree.groups.push(("images".into(), Group::default()))),
    t("structure.description", "cut-short", |tree| {
        set_on(group(tree, "measurement/scan"), "phi_i", "long_name", Array::text("azimu"));
    }),
    t("structure.description", "another-version-of-cf", |tree| set(tree, "Conventions", "CF-1.1 BBRF-1.0")),
    b("structure.bytes", "index-of-chunks", |bytes| {
        // The address of the left neighbour of a chunk index, which only some readers follow.
        let at = position(bytes, b"TREE") + 9;
        bytes[at] ^= 4;
    }),
    d("structure.extension-domain", "no-domain", |d| d.extensions[0].domain = id("goniometer")),

    c("digest.object", "one-value", |tree| numbers(group(tree, "measurement/scan"), "value")[0] += 1e-9),
    c("digest.object", "one-uncertainty", |tree| numbers(group(tree, "measurement/scan"), "value_u")[0] *= 2.0),
    c("digest.object", "one-angle", |tree| numbers(group(tree, "measurement/scan"), "theta_v")[0] += 1e-3),
    c("digest.object", "one-wavelength", |tree| numbers(group(tree, "measurement/scan"), "wavelength_emission")[1] += 0.5),
    c("digest.object", "the-quantity", |tree| set_on(group(tree, "measurement/scan"), "value", "part", Array::text("total"))),
    c("digest.object", "the-title", |tree| set(tree, "title", "another title")),
    c("digest.object", "the-sample", |tree| set(group(tree, "sample/paint"), "material", "paper")),
    c("digest.object", "a-parameter", |tree| numbers(group(tree, "model/fit/term_0"), "parameter_0")[0] *= 1.01),
    c("digest.object", "the-extension", |tree| numbers(group(tree, "extension/org.example.goniometer"), "temperature")[0] += 1.0),
    c("digest.object", "the-receipt", |tree| {
        group(tree, "provenance").dataset_mut("receipts").expect("receipts").array = Array::text("[]");
    }),
    c("digest.document", "one-value", |tree| numbers(group(tree, "measurement/scan"), "value")[3] += 1e-9),
    c("digest.document", "a-measurement-removed", |tree| group(tree, "measurement").groups.retain(|(name, _)| name != "matrix")),
    c("digest.document", "another-digest", |tree| set(tree, "digest", &format!("sha256:{}", "0".repeat(64)))),
    c("digest.missing", "of-the-document", |tree| drop(tree.attributes.remove("digest"))),
    c("digest.missing", "of-the-values", |tree| {
        group(tree, "measurement/scan").dataset_mut("value").expect("values").attributes.remove("sha256");
    }),
    c("digest.missing", "of-a-group", |tree| drop(group(tree, "sample/paint").attributes.remove("sha256"))),

    t("quantity.units", "percent", |tree| set_on(group(tree, "measurement/scan"), "value", "units", Array::text("percent"))),
    t("quantity.units", "of-the-light", |tree| set_on(group(tree, "light/lamp"), "value", "units", Array::text("W"))),
    t("quantity.other-units", "angles-in-radians", |tree| set_on(group(tree, "measurement/scan"), "theta_i", "units", Array::text("radian"))),
    t("quantity.other-units", "wavelengths-in-micrometres", |tree| {
        set_on(group(tree, "measurement/scan"), "wavelength_emission", "units", Array::text("um"));
    }),
    t("quantity.si-unit", "another-factor", |tree| {
        set_on(group(tree, "measurement/density"), "value", "unit_si_factor", Array::scalar(Data::F64(vec![1.0].into())));
    }),
    t("quantity.si-unit", "no-exponents", |tree| {
        group(tree, "measurement/density").dataset_mut("value").expect("values").attributes.remove("unit_si_exponents");
    }),
    d("quantity.unstated", "reference", |d| scan_without_model(d).quantity.reference = Reference::Unstated),
    d("quantity.unstated", "part", |d| scan_without_model(d).quantity.part = Part::Unstated),
    d("quantity.unstated", "basis", |d| density(d).quantity.basis = Basis::Unstated),
    d("quantity.unstated", "normalised-at", |d| density(d).quantity.normalised_at = NormalisedAt::Unstated),
    d("quantity.unstated", "reference-light", |d| density(d).quantity.reference_light = ReferenceLight::Unstated),
    d("quantity.certified-factor", "two-for-five", |d| scan_without_model(d).quantity.certified_factor = vec![0.9, 0.9]),
    d("quantity.certified-factor-range", "per-cent", |d| density(d).quantity.certified_factor = vec![99.0]),
    d("quantity.certified-factor-range", "zero", |d| density(d).quantity.certified_factor = vec![0.0]),
    d("quantity.part-of-kind", "density-of-all", |d| density(d).quantity.part = Part::Total),
    d("quantity.part-of-kind", "elastic-brrdf", |d| {
        let quantity = &mut density(d).quantity;
        (quantity.kind, quantity.reference, quantity.part) = (QuantityKind::Brrdf, Reference::None, Part::Elastic);
    }),
    d("quantity.part-of-kind", "elastic-density", |d| density(d).quantity.part = Part::Elastic),
    d("quantity.normalised-at-of-kind", "factor-at-excitation", |d| scan_without_model(d).quantity.normalised_at = NormalisedAt::Excitation),
    d("quantity.normalised-at-of-kind", "density-at-emission", |d| density(d).quantity.normalised_at = NormalisedAt::Emission),
    d("quantity.normalised-at-of-kind", "radiance-at-emission", |d| d.measurements[0].quantity.normalised_at = NormalisedAt::Emission),
    d("quantity.reference-of-kind", "factor-without", |d| scan_without_model(d).quantity.reference = Reference::None),
    d("quantity.reference-of-kind", "radiance-with", |d| d.measurements[0].quantity.reference = Reference::SameGeometry),
    d("quantity.reference-of-kind", "brdf-with", |d| scan_without_model(d).quantity.kind = QuantityKind::Brdf),
    d("quantity.reference-of-kind", "brrdf-with", |d| density(d).quantity.kind = QuantityKind::Brrdf),
    d("quantity.donaldson-width", "a-band", |d| one_band(matrix(d))),

    d("wavelength.positive", "zero", |d| axis(density(d)).nm[0] = 0.0),
    d("wavelength.positive", "negative", |d| axis(density(d)).nm[0] = -360.0),
    d("wavelength.positive", "nan", |d| axis(density(d)).nm[3] = f64::NAN),
    d("wavelength.ascending", "swapped", |d| axis(density(d)).nm.swap(1, 2)),
    d("wavelength.ascending", "twice", |d| axis(density(d)).nm[2] = 370.0),
    d("wavelength.ascending", "descending", |d| axis(density(d)).nm.reverse()),
    d("wavelength.bandpass-length", "two", |d| bandpass(density(d)).0.push(8.0)),
    d("wavelength.bandpass-positive", "zero", |d| bandpass(density(d)).0[0] = 0.0),
    d("wavelength.bandpass-positive", "nan", |d| bandpass(scan_without_model(d)).0[0] = f64::NAN),
    d("wavelength.bandpass-unstated", "of-a-scan", |d| axis(scan_without_model(d)).bandpass = Bandpass::Unstated),
    d("wavelength.bandpass-unstated", "of-a-matrix", |d| axis(matrix(d)).bandpass = Bandpass::Unstated),
    d("wavelength.bandpass-unstated", "of-a-light", |d| {
        d.lights[0].spectrum.as_mut().expect("a spectrum").axis.bandpass = Bandpass::Unstated;
    }),
    d("wavelength.bandpass-particulars", "shape", |d| *bandpass(density(d)).1 = BandpassShape::Unstated),
    d("wavelength.bandpass-particulars", "correction", |d| *bandpass(density(d)).2 = BandpassCorrection::Unstated),
    d("wavelength.actual-length", "one-short", |d| axis(density(d)).actual_nm = vec![360.1]),
    d("wavelength.actual-near", "next-one", |d| {
        let nm = axis(density(d)).nm.clone();
        axis(density(d)).actual_nm = nm.iter().map(|nm| nm + 10.0).collect();
    }),
    d("wavelength.range", "micrometres", |d| axis(density(d)).nm.iter_mut().for_each(|nm| *nm /= 1000.0)),
    d("wavelength.range", "picometres", |d| axis(density(d)).nm.iter_mut().for_each(|nm| *nm *= 1000.0)),
    d("wavelength.band-order", "reversed", |d| {
        d.models[0].emission = EmissionAxis::Band { band: Some(Band { from_nm: 545.0, to_nm: 495.0 }) };
    }),
    d("wavelength.excitation", "zero", |d| density(d).excitations[0].wavelength_nm = Some(0.0)),
    d("wavelength.excitation", "negative-width", |d| density(d).excitations[0].fwhm_nm = Some(-10.0)),
    d("wavelength.excitation", "actual-nan", |d| density(d).excitations[0].actual_nm = Some(f64::NAN)),
    d("wavelength.excitation-bandpass", "unstated", |d| density(d).excitations[0].fwhm_nm = None),

    t("geometry.polar-range", "signed-angle", |tree| numbers(group(tree, "measurement/scan"), "theta_v")[2] = -20.0),
    t("geometry.polar-range", "below-the-horizon", |tree| numbers(group(tree, "measurement/scan"), "theta_i")[2] = 100.0),
    t("geometry.azimuth-range", "full-turn", |tree| numbers(group(tree, "measurement/scan"), "phi_v")[2] = 360.0),
    t("geometry.azimuth-range", "negative", |tree| numbers(group(tree, "measurement/scan"), "phi_i")[2] = -180.0),
    d("geometry.unknown", "one-row", |d| {
        scan_without_model(d).acquisitions[1].geometry = None;
    }),
    d("geometry.retro", "a-value-in-the-gap", |d| {
        scan_without_model(d).acquisitions[1].geometry = Some(Geometry::from_degrees(10.0, 30.0, 10.0, 30.0).expect("angles"));
    }),
    d("geometry.self-test", "clockwise", |d| clockwise(density(d))),
    d("geometry.self-test", "travelling-light", |d| {
        density(d).direction_tests[0].incidence.iter_mut().for_each(|component| *component = -*component);
    }),
    d("geometry.self-test", "other-side", |d| {
        let test = &mut density(d).direction_tests[0].incidence;
        (test[0], test[1]) = (-test[0], -test[1]);
    }),
    d("geometry.self-test", "elevation-for-polar-angle", |d| {
        let test = &mut density(d).direction_tests[0].viewing;
        (test[0], test[2]) = (test[2], test[0]);
    }),
    d("geometry.self-test", "not-a-unit-vector", |d| density(d).direction_tests[0].viewing = [0.0, 0.0, 2.0]),
    d("geometry.self-test-row", "beyond-the-end", |d| density(d).direction_tests[0].row = 300),
    d("geometry.self-test-missing", "none", |d| density(d).direction_tests.clear()),
    d("geometry.grazing", "incidence", |d| at_horizon(density(d), 90.0, 10.0)),
    d("geometry.grazing", "viewing", |d| at_horizon(density(d), 10.0, 90.0)),
    d("geometry.footprint", "small-sample", |d| d.samples[0].width_mm = finite(8.0)),

    d("flag.unknown-bits", "high-bit", |d| scan_without_model(d).flags[[0, 0]] = 0x8000),
    d("flag.nan-without-reason", "no-flag", |d| scan_without_model(d).values[[0, 0]] = f64::NAN),
    d("flag.nan-without-reason", "a-flag-that-gives-none", |d| {
        scan_without_model(d).values[[0, 0]] = f64::NAN;
        scan(d).flags[[0, 0]] = Flag::BatteryLow.bit();
    }),
    d("flag.infinite", "plus", |d| density(d).values[[0, 0]] = f64::INFINITY),
    d("flag.infinite", "minus", |d| density(d).values[[0, 0]] = f64::NEG_INFINITY),
    d("flag.value-not-measured", "by-design", |d| density(d).flags[[0, 0]] = Flag::NotMeasuredByDesign.bit()),
    d("flag.value-not-measured", "not-measured", |d| density(d).flags[[0, 0]] = Flag::NotMeasured.bit()),

    d("flag.no-value", "all-below-detection", |d| density(d).flags.fill(Flag::BelowDetection.bit())),

    d("uncertainty.missing", "none", |d| {
        density(d).uncertainty = Uncertainty::default();
    }),
    d("uncertainty.negative", "one", |d| sigma(density(d))[[0, 0]] = -0.1),
    d("uncertainty.shared", "two-for-thirty", |d| density(d).uncertainty.components[0].relative = vec![0.1, 0.1]),
    d("uncertainty.shared", "negative", |d| density(d).uncertainty.components[0].relative = vec![-0.1]),
    d("uncertainty.coverage", "factor-of-zero", |d| density(d).uncertainty.statement.coverage_factor = finite(0.0)),
    d("uncertainty.coverage", "per-cent", |d| {
        density(d).uncertainty.statement.coverage_factor = finite(2.0);
        density(d).uncertainty.statement.coverage_probability = finite(95.0);
    }),
    d("uncertainty.coverage", "negative-freedom", |d| density(d).uncertainty.components[0].statement.degrees_of_freedom = finite(-1.0)),
    d("uncertainty.student", "without-freedom", |d| {
        density(d).uncertainty.statement.distribution = Some(ErrorDistribution::StudentT);
    }),
    d("uncertainty.expanded", "probability-alone", |d| density(d).uncertainty.statement.coverage_probability = finite(0.95)),
    d("uncertainty.of-value", "nan", |d| sigma(density(d))[[0, 0]] = f64::NAN),
    d("uncertainty.zero", "exact", |d| {
        density(d).uncertainty.components.clear();
        sigma(density(d))[[0, 0]] = 0.0;
    }),
    d("uncertainty.infinite", "one", |d| sigma(density(d))[[0, 0]] = f64::INFINITY),

    d("reference.dangling", "sample", |d| density(d).sample = Some(id("other"))),
    d("reference.dangling", "instrument", |d| density(d).instrument = Some(id("other"))),
    d("reference.dangling", "light-of-an-excitation", |d| density(d).excitations[0].light = Some(id("other"))),
    d("reference.dangling", "measurement-of-a-model", |d| d.models[0].measurement = id("other")),
    d("reference.dangling", "derivation", |d| scan_without_model(d).derivation.as_mut().expect("a derivation").dark = Some(id("other"))),
    d("reference.light", "unknown", |d| density(d).quantity.reference_light = ReferenceLight::Light("d65".into())),
    d("reference.excitation", "beyond-the-end", |d| density(d).acquisitions[0].excitation = Some(6)),

    d("factorisation.shape", "a-row-less", |d| d.factorisations[0].excitation_nm.truncate(5)),
    d("factorisation.shape", "elastic-short", |d| d.factorisations[0].elastic.truncate(5)),
    d("factorisation.axis", "descending", |d| d.factorisations[0].excitation_nm[1] = 300.0),
    d("factorisation.negative", "emission", |d| d.factorisations[0].emission_factor[[0, 3]] = -0.01),
    d("factorisation.negative", "uncertainty", |d| d.factorisations[0].excitation_u[[0, 0]] = -0.01),
    d("factorisation.data-changed", "said", |d| d.factorisations[0].data_digest = format!("sha256:{}", "0".repeat(64))),
    d("reference.dangling", "matrix-of-factors", |d| d.factorisations[0].measurement = id("other")),
    d("model.data-changed", "a-value", |d| scan(d).values[[0, 0]] *= 1.0 + 1e-12),
    d("model.data-changed", "another-digest", |d| d.models[0].data_digest = format!("sha256:{}", "0".repeat(64))),
    d("model.covariance-symmetric", "one-side", |d| d.models[0].covariance[[0, 0, 1]] *= 2.0),
    d("model.covariance-diagonal", "negative", |d| d.models[0].covariance[[0, 0, 0]] = -1e-6),
    d("model.covariance-parameters", "one-name-less", |d| drop(d.models[0].covariance_parameters.pop())),
    d("model.covariance-parameters", "a-table-too-many", |d| {
        let table = d.models[0].covariance.clone();
        d.models[0].covariance = ndarray::concatenate![ndarray::Axis(0), table, table].into_shared();
    }),
    d("model.parameter-bounds", "negative-roughness", |d| d.models[0].terms[1].parameters[1].value = vec![-0.05]),
    d("model.parameter-bounds", "index-below-one", |d| d.models[0].terms[1].parameters[2].value = vec![0.9]),
    d("model.not-converged", "said", |d| d.models[0].converged = false),
    d("model.residuals", "rms", |d| d.models[0].residuals.rms *= 0.5),
    d("model.residuals", "chi-square", |d| d.models[0].residuals.reduced_chi_square = 1.0),
    d("model.residuals", "count", |d| d.models[0].residuals.count += 1),
    d("model.residuals", "another-albedo", |d| d.models[0].terms[0].parameters[0].value = vec![0.7]),
    d("model.residuals", "another-denominator", |d| {
        d.models[0].terms[1].denominator = Some(bbrf::terms::Denominator::CosThetaI);
    }),
    d("model.complete", "no-roughness", |d| drop(d.models[0].terms[1].parameters.remove(1))),
    d("model.uncertainty", "negative", |d| d.models[0].terms[0].parameters[0].standard_uncertainty = vec![-1.0]),
    d("model.uncertainty", "none", |d| d.models[0].terms[0].parameters[0].standard_uncertainty.clear()),
    d("model.correlation", "beyond-one", |d| {
        d.models[0].covariance[[0, 0, 1]] *= 100.0;
        d.models[0].covariance[[0, 1, 0]] *= 100.0;
    }),
    d("model.covariance-names", "twice", |d| {
        let names = &mut d.models[0].covariance_parameters;
        names[2] = names[1].clone();
    }),
    d("model.covariance-names", "of-no-term", |d| d.models[0].covariance_parameters[0] = "lambertian.roughness".into()),
    d("model.covariance-names", "two-terms-of-a-kind", |d| {
        let again = d.models[0].terms[1].clone();
        d.models[0].terms.push(again);
    }),
    d("model.albedo", "diffuse", |d| d.models[0].terms[0].parameters[0].value = vec![1.02]),
    d("model.albedo", "specular", |d| d.models[0].terms[1].parameters[0].value = vec![800.0]),

    d("model.donaldson", "another-part", |d| attached(d).luminescent = id("matrix")),
    d("model.donaldson", "a-scan-for-the-elastic-part", |d| attached(d).elastic = id("scan")),
    d("model.donaldson", "another-axis", |d| {
        let part = d.measurements.iter_mut().find(|one| one.id == id("matrix-elastic")).expect("the elastic part");
        axis(part).nm[0] -= 1.0;
    }),
    d("model.donaldson", "albedo-of-a-band", |d| attached(d).reflectance = ReflectanceSource::Terms),
    d("model.data-changed", "elastic-part", |d| attached(d).elastic_digest = format!("sha256:{}", "0".repeat(64))),
    d("reference.dangling", "factors-of-a-model", |d| attached(d).factorisation = id("other")),
    d("reference.dangling", "elastic-part-of-a-model", |d| attached(d).elastic = id("other")),
    d("reference.dangling", "luminescent-part-of-a-model", |d| attached(d).luminescent = id("other")),

    d("calibration.date-form", "slashes", |d| d.instruments[0].calibration[0].date = Some("11/22/26".into())),
    d("calibration.date-form", "no-such-day", |d| d.instruments[0].calibration[0].expires = Some("2027-02-30".into())),
    d("calibration.order", "ends-before", |d| d.white_references[0].calibration[0].date = Some("2029-01-10".into())),
    d("calibration.expired", "instrument", |d| d.instruments[0].calibration[0].expires = Some("2026-11-21".into())),
    d("calibration.expired", "white-reference", |d| d.white_references[0].calibration[0].expires = Some("2026-06-01".into())),
    d("calibration.missing", "instrument", |d| d.instruments[0].calibration.clear()),
    d("calibration.missing", "white-reference", |d| {
        d.white_references[0].calibration.clear();
        d.white_references[0].certificate = None;
    }),

    d("acquisition.time-form", "no-zone", |d| density(d).acquisitions[0].time = Some("2026-11-22 10:00".into())),
    d("acquisition.time-form", "no-such-hour", |d| density(d).acquisitions[0].time = Some("2026-11-22T25:00:00Z".into())),
    d("acquisition.time-order", "swapped", |d| {
        let rows = &mut d.measurements[0].acquisitions;
        (rows[1].time, rows[2].time) = (rows[2].time.clone(), rows[1].time.clone());
    }),
    d("acquisition.order-unique", "twice", |d| density(d).acquisitions[1].order = 0),
    d("acquisition.exposure", "zero", |d| density(d).acquisitions[0].exposure_ms = Some(0.0)),
    d("acquisition.exposure", "nan", |d| density(d).acquisitions[0].exposure_ms = Some(f64::NAN)),
    d("acquisition.repeats", "zero", |d| density(d).acquisitions[0].repeats = 0),
    d("acquisition.derivation", "beyond-the-end", |d| {
        scan_without_model(d).derivation.as_mut().expect("a derivation").numerator_row[0] = 300;
    }),
    d("acquisition.derivation", "below-minus-one", |d| {
        scan_without_model(d).derivation.as_mut().expect("a derivation").row_reference[0] = -2;
    }),
    d("acquisition.derivation", "one-short", |d| {
        scan_without_model(d).derivation.as_mut().expect("a derivation").reference_group.truncate(42);
    }),

    d("physics.negative", "beyond-noise", |d| density(d).values[[0, 20]] = -0.05),
    d("physics.anti-stokes", "stray-light", |d| density(d).values[[5, 0]] = 0.001),
    d("physics.energy-balance", "too-much", |d| density(d).values.row_mut(0).iter_mut().for_each(|value| *value *= 8.0)),
    d("physics.energy-balance", "matrix", |d| {
        matrix(d).values.indexed_iter_mut().filter(|((row, column), _)| *row == 0 && *column > 5).for_each(|(_, v)| *v *= 8.0);
    }),
    d("physics.photon-balance", "between", |d| density(d).values.row_mut(0).iter_mut().for_each(|value| *value *= 3.3)),
    d("physics.reciprocity", "one-direction", |d| scan_without_model(d).values.row_mut(1).iter_mut().for_each(|v| *v *= 1.5)),
    d("physics.symmetry", "one-side", |d| {
        let scan = scan_without_model(d);
        scan.quantity.part = Part::Total;
        scan.values.row_mut(1).iter_mut().for_each(|value| *value *= 1.5);
    }),
    d("physics.drift", "the-last-row", |d| {
        let scan = scan_without_model(d);
        let last = scan.values.nrows() - 1;
        scan.values.row_mut(last).iter_mut().for_each(|value| *value *= 0.8);
    }),
    d("physics.albedo", "more-than-falls-in", |d| {
        scan_without_model(d);
        d.measurements[1] = hemisphere(scan(d), 1.05);
    }),
    d("physics.albedo", "distribution-function", |d| {
        scan_without_model(d);
        d.measurements[1] = hemisphere(scan(d), 0.4);
        let quantity = &mut scan(d).quantity;
        (quantity.kind, quantity.reference) = (QuantityKind::Brdf, Reference::None);
    }),

    d("light.shape", "a-value-more", |d| spectrum(d).values.push(0.5)),
    d("light.shape", "a-flag-less", |d| spectrum(d).flags.truncate(2)),
    d("light.nan-without-reason", "no-flag", |d| spectrum(d).flags[2] = 0),
    d("light.infinite", "plus", |d| spectrum(d).values[0] = f64::INFINITY),
    d("light.negative", "a-tenth", |d| spectrum(d).values[0] = -0.1),
    d("light.no-value", "dark", |d| spectrum(d).values.fill(0.0)),
    d("light.covers-emission", "too-short", |d| spectrum(d).axis.nm = vec![510.0, 520.0, 530.0]),

    d("provenance.source-digest", "not-hexadecimal", |d| d.provenance.receipts[0].inputs[0].sha256 = "unknown".into()),
    d("provenance.source-digest", "upper-case", |d| d.provenance.receipts[0].inputs[0].sha256 = "AB".repeat(32)),
    d("provenance.unfilled", "listed", |d| d.provenance.receipts[0].unfilled = vec!["samples/paint/mark".into()]),
    d("provenance.origin", "none", |d| d.provenance = Provenance::default()),
    d("provenance.license", "none", |d| d.license = None),
    d("provenance.license", "a-name-with-spaces", |d| d.license = Some("CC BY 4.0".into())),
    d("provenance.license", "open-bracket", |d| d.license = Some("(MIT OR Apache-2.0".into())),
    d("provenance.license", "a-sentence", |d| d.license = Some("free for all, ask us".into())),
];

fn spectrum(document: &mut Document) -> &mut LightSpectrum {
    document.lights[0].spectrum.as_mut().expect("a spectrum")
}

/// The same surface seen from all over the hemisphere under one incidence, of one value in every direction.
pub fn hemisphere(like: &Measurement, value: f64) -> Measurement {
    let mut rows = Vec::new();
    for ring in 0..6_u32 {
        for step in 0..6 * ring.max(1) {
            let (theta, phi) = (f64::from(ring) * 16.0, f64::from(step) * 60.0 / f64::from(ring.max(1)));
            let geometry = Geometry::from_degrees(30.0, 180.0, theta, phi).expect("angles");
            // One row where the azimuth has no meaning.
            if ring > 0 || step == 0 {
                let order = u32::try_from(rows.len()).expect("few rows");
                rows.push(Acquisition { excitation: Some(0), ..Acquisition::at(Some(geometry), order) });
            }
        }
    }
    let shape = (rows.len(), like.emission.len());
    let mut measurement = Measurement {
        acquisitions: rows,
        values: ndarray::ArcArray2::from_elem(shape, value),
        flags: ndarray::ArcArray2::zeros(shape),
        derivation: None,
        ..like.clone()
    };
    measurement.uncertainty.standard = Some(ndarray::ArcArray2::from_elem(shape, value / 100.0));
    measurement.state_directions();
    measurement
}

fn clockwise(measurement: &mut Measurement) {
    let geometry = Geometry::from_degrees(45.0, 150.0, 20.0, 30.0).expect("angles");
    measurement.acquisitions[0].geometry = Some(geometry);
    measurement.state_directions();
    measurement.direction_tests[0].viewing[1] *= -1.0;
}

fn at_horizon(measurement: &mut Measurement, theta_i: f64, theta_v: f64) {
    let geometry = Geometry::from_degrees(theta_i, 180.0, theta_v, 0.0).expect("angles");
    measurement.acquisitions.iter_mut().for_each(|row| row.geometry = Some(geometry));
    measurement.state_directions();
}
