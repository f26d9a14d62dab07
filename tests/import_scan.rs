//! Scans: manifests, patterns, orders; roles, references, repeats, uncertainty.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use std::fmt::Write;
use std::path::PathBuf;

use bbrf::dataset::{Document, Measurement};
use bbrf::import::{Options, Settings, import};
use bbrf::quantity::{CorrelatedOver, Flag, QuantityKind, Reference, ReferenceLight};
use spectra::{Folder, bump, d5, good};

const HEAD: &str = "# angles: signed, mirror-at-equal\nfile,role,theta_i_deg,theta_v_deg,repeat\n";

fn angles() -> impl Iterator<Item = i32> {
    (-8..=8).map(|step| step * 10)
}

/// Every record gets a scale of its own, so that no two are alike.
fn scale(number: u32) -> f64 {
    1.0 + f64::from(number) * 1e-3
}

/// The 272 files of a scan; returns the rows of its manifest.
fn scan(folder: &Folder) -> String {
    let mut rows = String::new();
    let pairs = angles().flat_map(|i| angles().map(move |v| (i, v))).filter(|(i, v)| *i != -*v);
    for (number, (i, v)) in (0..).zip(pairs) {
        let name = format!("raw/ti{i:+03}_tv{v:+03}.txt");
        folder.write(&name, good(scale(number)));
        writeln!(rows, "{name},sample,{i},{v},1").unwrap();
    }
    rows
}

fn whites(folder: &Folder) -> String {
    (0..3).fold(String::new(), |mut rows, number| {
        let name = format!("white{number}.txt");
        folder.write(&name, good(2.0 * scale(number)));
        writeln!(rows, "{name},white,0,45,{}", number + 1).unwrap();
        rows
    })
}

fn run(path: PathBuf) -> Document {
    import(&[path], &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn fails(path: PathBuf) -> String {
    import(&[path], &Options::default()).unwrap_err().to_string()
}

fn notices(document: &Document) -> String {
    document.provenance.receipts[0].notices.iter().map(|notice| format!("{}\n", notice.text)).collect()
}

fn factor(document: &Document) -> &Measurement {
    document.measurement("scan").unwrap()
}

#[test]
fn a_whole_scan_with_a_white_reference() {
    let folder = Folder::new();
    let rows = scan(&folder);
    let keys = "# certified-factor: 0.98\n# certified-relative-uncertainty: 0.005\n# light: lamp A\n";
    let manifest = folder.write("manifest.csv", format!("{keys}{HEAD}{rows}{}", whites(&folder)));
    let document = run(manifest);
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    assert_eq!(ids, ["radiance", "white", "scan"]);
    assert!(notices(&document).contains("coverage: 272 of 289 cells"), "{}", notices(&document));
    assert!(notices(&document).contains("17 cells of the retro diagonal not measured by design; no other gap"));
    let scan = factor(&document);
    assert_eq!((scan.quantity.kind, scan.shape()), (QuantityKind::RadianceFactor, (272, 101)));
    assert_eq!(scan.quantity.reference, Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 });
    assert_eq!(scan.quantity.reference_light, ReferenceLight::Same);
    assert_eq!(scan.quantity.certified_factor, [0.98]);
    let expected = 0.98 * scale(100) / (2.0 * scale(1));
    assert!((scan.values[(100, 42)] / expected - 1.0).abs() < 1e-3, "{}", scan.values[(100, 42)]);
    let sigma = scan.uncertainty.standard.as_ref().unwrap()[(100, 42)];
    assert!(sigma > 0.0 && sigma < 0.02 * expected, "{sigma}");
    let shared: Vec<CorrelatedOver> = scan.uncertainty.components.iter().map(|part| part.correlated_over).collect();
    for over in [CorrelatedOver::Wavelengths, CorrelatedOver::Acquisitions, CorrelatedOver::All] {
        assert!(shared.contains(&over), "{over:?}");
    }
    let derivation = scan.derivation.as_ref().unwrap();
    assert_eq!(derivation.numerator_row, (0..272).collect::<Vec<i32>>());
    assert_eq!((derivation.reference_group.as_slice(), derivation.row_reference[271]), (&[0, 0, 0][..], 0));
}

#[test]
fn toml_says_the_same_as_csv() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    folder.write("w.txt", good(2.0));
    let csv = folder.write("m.csv", format!("{HEAD}a.txt,sample,10,20,\nw.txt,white,10,20,\n"));
    let toml = folder.write(
        "m.toml",
        "angles = \"signed, mirror-at-equal\"\n[[record]]\nfile = \"a.txt\"\nrole = \"sample\"\ntheta_i_deg = 10\n\
         theta_v_deg = 20.0\n[[record]]\nfile = \"w.txt\"\nrole = \"white\"\ntheta_i_deg = 10\ntheta_v_deg = 20\n",
    );
    let (csv, toml) = (run(csv), run(toml));
    assert_eq!(csv.measurements, toml.measurements);
    assert_eq!(factor(&csv).quantity.reference, Reference::SameGeometry);
    let wrong = folder.write("wrong.toml", "angels = \"full\"\n[[record]]\nfile = \"a.txt\"\n");
    let error = fails(wrong);
    assert!(error.contains("line 1") && error.contains("`angels`"), "{error}");
}

#[test]
fn a_white_for_each_geometry_is_the_same_geometry() {
    let folder = Folder::new();
    let mut rows = String::new();
    for (number, angle) in (0..).zip([10, 20, 30]) {
        folder.write(&format!("s{angle}.txt"), good(scale(number)));
        folder.write(&format!("w{angle}.txt"), good(2.0 * scale(number + 5)));
        writeln!(rows, "s{angle}.txt,sample,{angle},0,\nw{angle}.txt,white,{angle},0,").unwrap();
    }
    let document = run(folder.write("m.csv", format!("{HEAD}{rows}")));
    let scan = factor(&document);
    assert_eq!(scan.quantity.reference, Reference::SameGeometry);
    assert_eq!(scan.quantity.reference_light, ReferenceLight::Unstated);
    assert!((scan.values[(2, 42)] - scale(2) / (2.0 * scale(7))).abs() < 1e-3);
    let over = |kind| scan.uncertainty.components.iter().any(|part| part.correlated_over == kind);
    assert!(!over(CorrelatedOver::Acquisitions));
}

#[test]
fn the_declared_convention_is_checked_and_demanded() {
    let folder = Folder::new();
    let rows = scan(&folder);
    let wrong = format!("{HEAD}{rows}").replace("mirror-at-equal", "retro-at-equal");
    let error = fails(folder.write("wrong.csv", wrong));
    assert!(error.contains("declare `signed, mirror-at-equal`"), "{error}");
    let (_, without) = HEAD.split_once('\n').unwrap();
    let error = fails(folder.write("without.csv", format!("{without}{rows}")));
    assert!(error.contains("without a declared sign convention") && error.contains("line 2"), "{error}");
    let sentence = "# angles: signed in-plane polar angles in degrees; retro-reflection is theta_v = -theta_i\n";
    assert_eq!(run(folder.write("sentence.csv", format!("{sentence}{without}{rows}"))).measurements.len(), 1);
}

#[test]
fn patterns_and_orders_give_the_manifests_document() {
    let folder = Folder::new();
    let rows = scan(&folder);
    let by_manifest = run(folder.write("manifest.csv", format!("{HEAD}{rows}")));
    let settings = Settings { angles: Some("signed, mirror-at-equal".parse().unwrap()), ..Settings::default() };
    let pattern = Some("ti{theta_i}_tv{theta_v}.txt".to_owned());
    let options = Options { settings: settings.clone(), pattern, ..Options::default() };
    let by_pattern = import(&[folder.path().join("raw")], &options).unwrap();
    let rows = |document: &Document| {
        let raw = document.measurement("radiance").unwrap();
        let mut rows: Vec<(String, Vec<u64>)> = raw
            .acquisitions
            .iter()
            .zip(raw.values.rows())
            .map(|(row, values)| (format!("{:?}", row.geometry), values.iter().map(|value| value.to_bits()).collect()))
            .collect();
        rows.sort();
        rows
    };
    assert_eq!(rows(&by_manifest), rows(&by_pattern));
    let numbered = Folder::new();
    for number in 0..272 {
        numbered.write(&format!("Spectrum{}.txt", number + 1), good(scale(number)));
    }
    let scan_order = Some("theta_i=-80:80:10; theta_v=-80:80:10; skip=retro".to_owned());
    let by_order = import(&[numbered.path()], &Options { settings, scan_order, ..Options::default() }).unwrap();
    assert_eq!(rows(&by_manifest), rows(&by_order));
}

#[test]
fn repeats_are_averaged_with_their_spread() {
    let folder = Folder::new();
    let mut rows = String::new();
    // A hash of seed and wavelength, uniform with a standard deviation of 1 %.
    let uniform = |seed: u32, nm: f64| ((f64::from(seed) * 12.9898 + nm * 78.233).sin() * 43_758.545_3).rem_euclid(1.0);
    let noise = |seed: u32| move |nm: f64| bump(nm, 1.0) * (1.0 + 0.01 * 12.0_f64.sqrt() * (uniform(seed, nm) - 0.5));
    for geometry in 0..10 {
        for repeat in 1..=3 {
            let name = format!("g{geometry}r{repeat}.txt");
            folder.write(&name, d5("00,0", noise(geometry * 3 + repeat)));
            writeln!(rows, "{name},sample,{},45,{repeat}", geometry * 5).unwrap();
        }
    }
    let document = run(folder.write("m.csv", format!("{HEAD}{rows}{}", whites(&folder))));
    let scan = factor(&document);
    assert_eq!((scan.acquisitions.len(), scan.acquisitions[0].repeats), (10, 3));
    // The mean of three has 1 % / sqrt(3) = 0.58 %, known from 26 degrees of freedom.
    let sigma = scan.uncertainty.standard.as_ref().unwrap();
    let relative: f64 = (0..10).map(|row| sigma[(row, 42)] / scan.values[(row, 42)]).sum::<f64>() / 10.0;
    assert!((0.0042..0.0074).contains(&relative), "{relative}");
    let alone = run(folder.write("alone.csv", format!("{HEAD}{rows}")));
    let ids: Vec<&str> = alone.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    assert_eq!(ids, ["radiance", "radiance-mean"]);
    let (raw, mean) = (&alone.measurements[0], &alone.measurements[1]);
    assert_eq!((raw.shape().0, mean.shape().0, mean.acquisitions[0].repeats), (30, 10, 3));
    let expected = (0..3).map(|row| raw.values[(row, 42)]).sum::<f64>() / 3.0;
    assert!((mean.values[(0, 42)] / expected - 1.0).abs() < 1e-12);
    let sigma = mean.uncertainty.standard.as_ref().unwrap();
    let relative: f64 = (0..10).map(|row| sigma[(row, 42)] / mean.values[(row, 42)]).sum::<f64>() / 10.0;
    assert!((0.0042..0.0074).contains(&relative), "{relative}");
    let doubled = format!("{HEAD}g0r1.txt,sample,0,45,\ng0r2.txt,sample,0,45,\n");
    let error = fails(folder.write("doubled.csv", doubled));
    assert!(error.contains("line 4") && error.contains("`repeat`"), "{error}");
}

#[test]
fn a_refused_record_is_a_row_with_its_reason() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    folder.write("b.txt", "19,0\r\n");
    folder.write("c.txt", d5("07,0", |nm| bump(nm, 1.0)));
    let rows = "a.txt,sample,0,10,\nb.txt,sample,0,20,\nc.txt,sample,0,30,\n";
    let document = run(folder.write("m.csv", format!("{HEAD}{rows}{}", whites(&folder))));
    let raw = document.measurement("radiance").unwrap();
    assert!(raw.values.row(1).iter().all(|value| value.is_nan()) && raw.values.row(2).iter().all(|v| v.is_nan()));
    assert!(raw.flags_at(1, 5).contains(Flag::Saturated) && raw.flags_at(2, 5).contains(Flag::Invalid));
    assert_eq!(raw.acquisitions[2].quality_code, Some(7));
    assert!(factor(&document).flags_at(1, 5).contains(Flag::Saturated) && factor(&document).values[(1, 5)].is_nan());
    assert!(notices(&document).contains("overload") && notices(&document).contains("cannot synchronise"));
}

#[test]
fn nothing_is_divided_by_a_dark_reference() {
    let folder = Folder::new();
    let lamp = |nm: f64| if nm < 420.0 { 1e-2 } else { 1e-7 };
    folder.write("w1.txt", d5("00,0", lamp));
    folder.write("w2.txt", d5("00,0", move |nm| if nm < 420.0 { 1.1e-2 } else { 1e-7 }));
    folder.write("s.txt", good(1.0));
    let rows = "s.txt,sample,0,10,\nw1.txt,white,0,45,1\nw2.txt,white,0,45,2\n";
    let document = run(folder.write("m.csv", format!("{HEAD}{rows}")));
    let scan = factor(&document);
    assert!(scan.values[(0, 0)].is_finite());
    assert!(scan.values[(0, 50)].is_nan() && scan.flags_at(0, 50).contains(Flag::BelowDetection));
    assert!(notices(&document).contains("the reference is below detection"));
}

#[test]
fn dark_and_lamp_have_their_roles() {
    let folder = Folder::new();
    folder.write("s.txt", good(1.0));
    folder.write("w.txt", good(2.0));
    folder.write("d.txt", good(0.1));
    folder.write("l.txt", d5("00,1", |nm| bump(nm, 9.0)));
    let rows = "s.txt,sample,0,10,\nw.txt,white,0,45,\nd.txt,dark,,,\nl.txt,lamp,,,\n";
    let document = run(folder.write("m.csv", format!("{HEAD}{rows}")));
    assert_eq!(document.lights[0].spectrum.as_ref().unwrap().quantity.kind, QuantityKind::SpectralIrradiance);
    let scan = factor(&document);
    assert!((scan.values[(0, 42)] - 0.9 / 1.9).abs() < 1e-3, "{}", scan.values[(0, 42)]);
    assert_eq!(scan.derivation.as_ref().unwrap().dark.as_ref().unwrap().as_str(), "dark");
}

#[test]
fn a_reference_that_contradicts_its_geometry_is_refused() {
    let folder = Folder::new();
    folder.write("s.txt", good(1.0));
    folder.write("w.txt", good(2.0));
    let rows = "s.txt,sample,0,10,\nw.txt,white,0,45,\n";
    let error = fails(folder.write("m.csv", format!("# reference: same-geometry\n{HEAD}{rows}")));
    assert!(error.contains("fixed-geometry(0,45)"), "{error}");
}

#[test]
fn names_do_not_depend_on_how_the_path_was_typed() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    folder.write("w.txt", good(2.0));
    folder.write("deep/b.txt", good(1.1));
    let manifest = folder.write("m.csv", format!("{HEAD}a.txt,sample,10,20,\nw.txt,white,10,20,\n"));
    let other = folder.path().join("deep/../m.csv");
    assert_eq!(json(&run(manifest)), json(&run(other)));
    let list = |base: PathBuf| {
        let white = vec![base.join("w.txt").display().to_string()];
        let options = Options { white, ..Options::default() };
        import(&[base.join("a.txt"), base.join("deep/b.txt")], &options).unwrap()
    };
    let (one, two) = (list(folder.path()), list(folder.path().join("deep/..")));
    assert_eq!(json(&one), json(&two));
    let names: Vec<&str> = one.provenance.receipts[0].inputs.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(names, ["a.txt", "deep/b.txt", "w.txt"]);
    assert!(!json(&one).contains(&folder.path().display().to_string()), "{}", json(&one));
}

fn json(document: &Document) -> String {
    serde_json::to_string(document).unwrap()
}

#[test]
fn statements_that_contradict_each_other_are_said() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    let rows = "a.txt,sample,0,10,2\n";
    let error = fails(folder.write("twice.csv", format!("# title: A\n# title: B\n{HEAD}{rows}")));
    assert!(error.contains("line 2") && error.contains("line 1") && error.contains("`A`"), "{error}");
    let error = fails(folder.write("kind.csv", format!("# quantity: spectral-irradiance\n{HEAD}{rows}")));
    assert!(error.contains("a mixed quantity"), "{error}");
    let titled = folder.write("m.csv", format!("# title: A\n{HEAD}{rows}"));
    let settings = Settings { title: Some("B".to_owned()), ..Settings::default() };
    let document = import(&[titled], &Options { settings, ..Options::default() }).unwrap();
    let assumed = &document.provenance.receipts[0].assumptions;
    let both = |text: &str| text.contains("`title`") && text.contains("`A`") && text.contains("`B`");
    assert!(assumed.iter().any(|assumption| both(&assumption.text)), "{assumed:?}");
}

#[test]
fn folders_as_people_keep_them() {
    let folder = Folder::new();
    folder.write("raw/a1.txt", good(1.0));
    folder.write("raw/a2.txt", good(1.1));
    folder.write("raw/Notes.txt", "the lamp was warm\n");
    let settings = Settings { angles: Some("signed, mirror-at-equal".parse().unwrap()), ..Settings::default() };
    let scan_order = Some("theta_i=10; theta_v=10:20:10".to_owned());
    let options = Options { settings, scan_order, ..Options::default() };
    let document = import(&[folder.path().join("raw")], &options).unwrap_or_else(|error| panic!("{error}"));
    assert!(notices(&document).contains("left out: Notes.txt"), "{}", notices(&document));
    let rows = "raw\\a1.txt,sample,10,20,\n";
    let manifest = folder.write("m.csv", format!("{HEAD}{rows}"));
    let error = fails(folder.path());
    assert!(error.contains("import the manifest in it"), "{error}");
    assert_eq!(run(manifest).measurements.len(), 1);
    let error = fails(folder.write("bfc.txt", "BFC-450 Matrix File\n1 2 3\n"));
    assert!(error.contains("six numbers: emission start"), "{error}");
    let rows = "bfc.txt,sample,10,20,\n";
    let error = fails(folder.write("m.csv", format!("{HEAD}{rows}")));
    assert!(error.contains("a file of the format bfc") && error.contains("on its own"), "{error}");
}
