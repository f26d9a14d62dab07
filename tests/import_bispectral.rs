//! Matrices over excitation and emission: what is read, what is refused, and what comes back.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use bbrf::dataset::{Document, Measurement, Role};
use bbrf::export::{bfc, matrix};
use bbrf::import::{Options, Settings, import};
use bbrf::quantity::{
    Bandpass, BandpassCorrection, EmissionAxis, Flag, NormalisedAt, Part, QuantityKind, Reference, Uncertainty,
};
use spectra::Folder;

const BFC: &str = include_str!("../testdata/bispectral/synthetic.BFC");

fn options(keys: &[(&str, &str)]) -> Options {
    let mut settings = Settings::default();
    keys.iter().for_each(|(key, value)| settings.state(key, value).unwrap());
    Options { settings, ..Options::default() }
}

fn read(name: &str, text: impl AsRef<[u8]>, keys: &[(&str, &str)]) -> Result<Document, String> {
    let folder = Folder::new();
    import(&[folder.write(name, text)], &options(keys)).map_err(|error| error.to_string())
}

fn good(name: &str, text: impl AsRef<[u8]>, keys: &[(&str, &str)]) -> Document {
    read(name, text, keys).unwrap_or_else(|error| panic!("{error}"))
}

fn notes(document: &Document) -> String {
    let receipt = &document.provenance.receipts[0];
    let assumed = receipt.assumptions.iter().map(|note| &note.text);
    assumed.chain(receipt.notices.iter().map(|note| &note.text)).map(|text| format!("{text}\n")).collect()
}

/// The excitation wavelengths of the rows, nm.
fn excitations(measurement: &Measurement) -> Vec<f64> {
    let nm = |row| measurement.excitation_of(row).and_then(|state| state.wavelength_nm).unwrap();
    measurement.acquisitions.iter().map(nm).collect()
}

fn written(document: &Document) -> (String, Vec<String>) {
    let mut bytes = Vec::new();
    let lost = bfc::write(document, &document.measurements[0], &mut bytes).unwrap_or_else(|error| panic!("{error}"));
    (String::from_utf8(bytes).unwrap(), lost)
}

#[test]
fn a_bfc_file_is_a_donaldson_matrix_of_which_only_what_it_says_is_stated() {
    let document = good("a.BFC", BFC, &[]);
    let measurement = document.measurement("matrix").unwrap();
    let quantity = &measurement.quantity;
    assert_eq!((quantity.kind, quantity.part), (QuantityKind::DonaldsonMatrix, Part::Total));
    assert_eq!((quantity.normalised_at, quantity.reference), (NormalisedAt::Excitation, Reference::Unstated));
    assert_eq!(measurement.shape(), (16, 12));
    assert_eq!(excitations(measurement), (0..16).map(|k| 300.0 + 20.0 * f64::from(k)).collect::<Vec<_>>());
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else { panic!("a band") };
    assert_eq!((axis.nm[0], axis.nm[11], &axis.bandpass), (380.0, 600.0, &Bandpass::Unstated));
    assert!(measurement.excitations.iter().all(|state| state.fwhm_nm.is_none()));
    // The third emission row, the second and the last column.
    let row: Vec<f64> = BFC.lines().nth(14).unwrap().split_whitespace().map(|field| field.parse().unwrap()).collect();
    assert_eq!((row[0], row[2], row[16]), (420.0, measurement.values[(1, 2)], measurement.values[(15, 2)]));
    assert!(measurement.values.iter().any(|value| *value < 0.0));
    assert_eq!(document.samples[0].title.as_deref(), Some("Synthetic yellow # 1"));
    assert_eq!(measurement.title.as_deref(), Some("synth.BFC"));
    assert_eq!(measurement.conditions.operator.as_deref(), Some("nobody"));
    let accessories = document.instruments[0].accessories.as_deref();
    assert_eq!(accessories, Some("Si_ mod=1 FW=1A SW=1.04; BFC mod=1 FW=1A SW=1.099"));
    let said = notes(&document);
    assert!(said.contains("2024-02-29T07:08:09, without a zone") && said.contains("VEC_01"), "{said}");
    let unfilled = &document.provenance.receipts[0].unfilled;
    assert!(unfilled.iter().any(|path| path.ends_with("emission/bandpass")), "{unfilled:?}");
    assert!(unfilled.iter().any(|path| path.ends_with("quantity/reference")), "{unfilled:?}");
    let timed = good("a.BFC", BFC, &[("time-zone", "-05:00")]);
    assert_eq!(timed.measurements[0].acquisitions[3].time.as_deref(), Some("2024-02-29T07:08:09-05:00"));
}

#[test]
fn a_bfc_file_goes_back_without_a_changed_byte() {
    let (text, lost) = written(&good("a.BFC", BFC, &[("time-zone", "Z")]));
    assert_eq!(text, BFC);
    assert_eq!(lost, ["the zone of the time"]);
    // Blank lines inside the data are passed over, and are not written.
    let blank = BFC.replacen("\r\n420\t", "\r\n\r\n \t\r\n420\t", 1);
    assert_eq!(written(&good("a.BFC", blank, &[("time-zone", "Z")])).0, BFC);
}

#[test]
fn comments_of_another_number_are_kept_by_what_they_are() {
    let more = BFC.replacen(";<none>", ";second side\r\n;<none>", 1);
    let said = notes(&good("a.BFC", more, &[]));
    assert!(said.contains("a comment without a place in the document: `second side`"), "{said}");
    let none: String = BFC.split_inclusive("\r\n").filter(|line| !line.starts_with(';')).collect();
    let document = good("a.BFC", &none, &[]);
    assert!(document.samples.is_empty() && document.measurements[0].title.is_none());
    let (text, _) = written(&document);
    assert_eq!(text.matches(";<none>\r\n").count(), 8);
}

#[test]
fn a_bfc_file_that_contradicts_itself_says_where() {
    let lines: Vec<&str> = BFC.lines().collect();
    let with = |at: usize, line: &str| {
        let mut lines = lines.clone();
        lines[at - 1] = line;
        lines.join("\r\n")
    };
    let without = |at: usize| {
        let mut lines = lines.clone();
        lines.remove(at - 1);
        lines.join("\r\n")
    };
    let nan = lines[13].replacen("\t", "\tNaN\t", 1).rsplit_once('\t').unwrap().0.to_owned();
    let word = lines[13].replacen("0.", "O.", 1);
    let short = lines[13].rsplit_once('\t').unwrap().0.to_owned();
    let cases: &[(String, &[&str])] = &[
        (with(11, "380\t620\t20\t16\t300\t20"), &["`EOD` after 12 rows", "13 rows"]),
        (with(11, "380\t600\t20\t17\t300\t20"), &["line 12", "16 excitation wavelengths", "17"]),
        (with(11, "380\t600\t20\t16\t310\t20"), &["line 12", "`300`", "310 nm"]),
        (with(11, "380\t600\t10\t16\t300\t20"), &["line 14", "begins with `400`", "390 nm"]),
        (with(11, "380\t600\t20\t16\t300"), &["line 11", "six numbers"]),
        (with(11, "380\t600\t0\t16\t300\t20"), &["line 11", "six numbers"]),
        (with(11, "380\t600\t1e-9\t16\t300\t1e-9"), &["line 11", "values in a file of"]),
        (without(12), &["line 12", "`r:c:`"]),
        (without(16), &["line 16", "begins with `460`", "440 nm"]),
        (with(14, &nan), &["line 14", "`NaN` at emission 400 nm, excitation 300 nm"]),
        (with(14, &word), &["line 14", "emission 400 nm", "number"]),
        (with(14, &short), &["line 14", "15 values", "16"]),
        (without(25), &["without `EOD`"]),
        (lines[..20].join("\r\n"), &["line 20", "after 8 rows"]),
        (format!("{BFC}{BFC}"), &["line 26", "a second matrix", "split the file"]),
        (without(25) + "\r\n" + BFC, &["a second matrix"]),
        (format!("{BFC}more\r\n"), &["line 26", "`more`", "nothing after"]),
        (lines[..9].join("\r\n"), &["no line of ranges"]),
    ];
    for (text, words) in cases {
        let error = read("a.BFC", text, &[]).unwrap_err();
        for word in *words {
            assert!(error.contains(word), "`{word}` in {error}");
        }
    }
    for (key, value) in
        [("quantity", "radiance-factor"), ("excitation-nm", "400"), ("coverage-factor", "2"), ("rows", "emission")]
    {
        let error = read("a.BFC", BFC, &[(key, value)]).unwrap_err();
        assert!(error.contains(value) || error.contains(key), "{error}");
    }
}

#[test]
fn what_a_bfc_file_cannot_hold_is_refused_or_said() {
    let document = good("a.BFC", BFC, &[]);
    let refused = |change: &dyn Fn(&mut Measurement)| {
        let mut document = document.clone();
        change(&mut document.measurements[0]);
        bfc::write(&document, &document.measurements[0], &mut Vec::new()).unwrap_err().to_string()
    };
    let unequal = refused(&|m| m.excitations[3].wavelength_nm = Some(361.0));
    assert!(unequal.contains("excitation steps are unequal"), "{unequal}");
    let twice = refused(&|m| m.acquisitions[4].excitation = Some(2));
    assert!(twice.contains("rows 2 and 4 are both of the excitation 340 nm"), "{twice}");
    let dark = refused(&|m| m.acquisitions[4].excitation = None);
    assert!(dark.contains("row 4 has no excitation wavelength"), "{dark}");
    let missing = refused(&|m| m.values[(2, 1)] = f64::NAN);
    assert!(missing.contains("emission 400 nm, excitation 340 nm is missing"), "{missing}");
    let other = refused(&|m| m.quantity.kind = QuantityKind::RelativeSpectrum);
    assert!(other.contains("relative-spectrum"), "{other}");
    let mut full = document.clone();
    let measurement = &mut full.measurements[0];
    measurement.uncertainty = Uncertainty { standard: Some(measurement.values.clone()), ..Uncertainty::default() };
    measurement.flags[(0, 0)] = Flag::Noisy.bit();
    measurement.quantity.reference = Reference::SameGeometry;
    measurement.values[(0, 0)] = 1.0 / 3.0;
    let (text, lost) = written(&full);
    for words in
        ["standard uncertainty", "flags of 1 values", "reference `same-geometry`", "1 values are written with more"]
    {
        assert!(lost.iter().any(|line| line.contains(words)), "{words}: {lost:?}");
    }
    assert_eq!(good("a.BFC", text, &[]).measurements[0].values, full.measurements[0].values);
}

#[test]
fn a_matrix_text_reads_back_what_was_written() {
    let keys = [("quantity", "donaldson-matrix"), ("bandpass-nm", "10"), ("basis", "energy"), ("id", "m1")];
    let mut document = good("a.BFC", BFC, &keys);
    document.measurements[0].values[(2, 1)] = f64::NAN;
    document.measurements[0].flags[(2, 1)] = Flag::NotMeasured.bit();
    let mut bytes = Vec::new();
    let lost = matrix::write(&document, &document.measurements[0], &mut bytes).unwrap();
    assert_eq!(lost, ["the operator"]);
    let text = String::from_utf8(bytes).unwrap();
    assert!(text.contains("\nex_nm\\em_nm,380,400,"), "{text}");
    let back = good("m.csv", text, &[]);
    let (there, here) = (&document.measurements[0], back.measurement("m1").unwrap());
    assert_eq!(here.quantity, there.quantity);
    assert_eq!((&here.emission, &here.excitations, &here.flags), (&there.emission, &there.excitations, &there.flags));
    assert!(here.values.iter().zip(&there.values).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()));
    assert_eq!(back.samples[0].title, document.samples[0].title);
}

#[test]
fn the_axes_of_a_matrix_are_said_and_never_guessed() {
    let matrix = |corner: &str| format!("{corner},300,310,320\n400,1,2,3\n410,4,,-6\n");
    let emission = good("m.csv", matrix(r"em_nm\ex_nm"), &[]);
    let measurement = &emission.measurements[0];
    assert_eq!(
        (excitations(measurement), measurement.emission.wavelengths()),
        (vec![300.0, 310.0, 320.0], Some(&[400.0, 410.0][..]))
    );
    assert_eq!((measurement.values[(0, 1)], measurement.values[(2, 1)]), (4.0, -6.0));
    assert!(measurement.values[(1, 1)].is_nan() && measurement.flags_at(1, 1).contains(Flag::NotMeasured));
    assert_eq!(measurement.quantity.kind, QuantityKind::Unstated);
    let excitation = good("m.csv", matrix("Ex/Em"), &[("quantity", "relative-spectrum")]);
    assert_eq!(excitations(&excitation.measurements[0]), [400.0, 410.0]);
    assert_eq!(excitation.measurements[0].quantity.kind, QuantityKind::RelativeSpectrum);
    for corner in ["", "nm", "wavelength"] {
        let error = read("m.csv", matrix(corner), &[]).unwrap_err();
        assert!(error.contains("--set rows=emission") && error.contains("line 1"), "{error}");
        let said = good("m.csv", matrix(corner), &[("rows", "excitation")]);
        assert_eq!(excitations(&said.measurements[0]), [400.0, 410.0]);
    }
    let keyed = good("m.csv", format!("# rows: emission\n{}", matrix("nm")), &[]);
    assert_eq!(excitations(&keyed.measurements[0]), [300.0, 310.0, 320.0]);
    let error = read("m.csv", format!("# rows: excitation\n{}", matrix("em/ex")), &[]).unwrap_err();
    assert!(error.contains("`rows` is excitation") && error.contains("line 1"), "{error}");
}

#[test]
fn matrices_of_every_dialect_are_read() {
    let expected = good("m.csv", "ex/em,400,410\n300,1.5,-2\n310,0,4\n", &[]);
    for text in [
        "ex/em\t400\t410\n300\t1.5\t-2\n310\t0\t4\n",
        "ex/em\t400\t410\t\r\n300\t1.5\t-2\t\r\n310\t0\t4\t\r\n",
        "ex/em;400;410\n300;1,5;-2\n310;0;4\n",
        "ex/em 400 410\n300 1.5 -2\n\n310 0 4e0\n",
        "\"Ex/Em\",\"400\",\"410\"\n300,1.5,-2\n310,0,4\n",
        "# rows: excitation\n400 410\n300 1.5 -2\n310 0 4\n",
        "# rows: excitation\n\t400\t410\n300\t1.5\t-2\n310\t0\t4\n",
    ] {
        let found = good("m.txt", text, &[]);
        assert_eq!(found.measurements[0].values, expected.measurements[0].values, "{text}");
        assert_eq!(found.measurements[0].emission, expected.measurements[0].emission, "{text}");
    }
}

#[test]
fn a_matrix_that_cannot_be_read_says_where() {
    for (text, words) in [
        ("ex/em,400,410\n300,1,2\n310,3\n", &["line 3", "1 values in the row of 310 nm", "2"][..]),
        ("ex/em,400,410\n300,1,x\n", &["line 2", "`x`", "under 410 nm"]),
        ("ex/em,400,410\n300,1,2\nmean,3,4\n", &["line 3", "`mean` where a wavelength"]),
        ("ex/em,400,410\n310,1,2\n300,3,4\n", &["line 1", "300 nm", "ascending"]),
        ("ex/em,410,400\n300,1,2\n310,3,4\n", &["line 1", "400 nm", "ascending"]),
        ("# quantity: luminance\nex/em,400,410\n300,1,2\n", &["line 1", "luminance"]),
        ("# excitation_nm: 300\nex/em,400,410\n300,1,2\n", &["line 1", "excitation-nm"]),
    ] {
        let error = read("m.csv", text, &[]).unwrap_err();
        words.iter().for_each(|word| assert!(error.contains(word), "`{word}` in {error}"));
    }
    // A spectrum with numbered columns, and columns of anything else, are no matrices.
    let columns = good("c.csv", "wavelength,1,2\n400,1.5,2\n410,3,4\n", &[]);
    assert_eq!(columns.measurements.len(), 2);
}

#[test]
fn real_matrices_go_to_bfc_and_back_without_a_changed_digit() {
    let Some(shared) = spectra::shared() else { return };
    let folder = shared.join("bispectral");
    for name in ["CIBA12", "HERPIORA", "IXCRLALE", "POLGREE"] {
        let text = std::fs::read_to_string(folder.join(format!("{name}.BFC"))).unwrap();
        let document = good("a.BFC", &text, &[("time-zone", "Z")]);
        assert_eq!(document.measurements[0].shape(), (49, 41));
        assert!(document.measurements[0].values.iter().any(|value| *value < 0.0));
        assert_eq!(written(&document).0, text, "{name}");
    }
    let postit = std::fs::read(folder.join("postit_fluorescent_yellow_labsphere_bfc450.csv")).unwrap();
    let document = good("postit.csv", postit, &[("quantity", "donaldson-matrix")]);
    let measurement = &document.measurements[0];
    assert_eq!((measurement.emission.wavelengths().unwrap()[0], excitations(measurement)[0]), (380.0, 300.0));
    // The diagonal at 380 nm reflects a quarter.
    assert_eq!(measurement.values[(8, 0)], 0.251802);
}

/// A profile of two colours on two emission and three excitation wavelengths.
fn profile() -> String {
    let colour = |name: &str, data: &str| {
        format!(
            "<tagStructureType><StructureSignature>nmcl</StructureSignature><MemberTags><utf8TextType><TagSignature>name\
             </TagSignature><TextData>{name}</TextData></utf8TextType><float16NumberType>\n<TagSignature>spec</TagSignature>\
             <Data>\n{data}\n</Data></float16NumberType></MemberTags></tagStructureType>\n"
        )
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<IccProfile><Header><RenderingIntent>Absolute</RenderingIntent>\n\
         <SpectralPCS>bs0006</SpectralPCS>\n<SpectralRange><Wavelengths start=\"400\" end=\"410\" steps=\"2\"/></SpectralRange>\n\
         <BiSpectralRange><Wavelengths start=\"390\" end=\"410\" steps=\"3\"/></BiSpectralRange>\n</Header>\n<Tags>\
         <multiLocalizedUnicodeType><TagSignature>desc</TagSignature><LocalizedText><![CDATA[Two colours]]></LocalizedText>\
         </multiLocalizedUnicodeType><tagArrayType><TagSignature>ncl2</TagSignature><ArrayTags>\n{}{}</ArrayTags></tagArrayType>\
         </Tags></IccProfile>\n",
        colour("Neon &amp; red", "0.1 0.9 0\n.2 0.3 0.8"),
        colour("Neon &amp; red", "0 1 0\t0 0 -1e-2")
    )
}

#[test]
fn every_colour_of_a_bispectral_profile_is_a_matrix_of_its_name() {
    let document = good("p.xml", profile(), &[]);
    assert_eq!(document.title.as_deref(), Some("Two colours"));
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    assert_eq!(ids, ["neon-red", "neon-red-2"]);
    let first = &document.measurements[0];
    assert_eq!((first.title.as_deref(), first.quantity.kind), (Some("Neon & red"), QuantityKind::DonaldsonMatrix));
    assert_eq!(
        (excitations(first), first.emission.wavelengths()),
        (vec![390.0, 400.0, 410.0], Some(&[400.0, 410.0][..]))
    );
    // Rows are emission: 0.9 is reflected at 400 nm, 0.2 emitted at 410 nm under 390 nm.
    assert_eq!((first.values[(1, 0)], first.values[(0, 1)], first.values[(2, 1)]), (0.9, 0.2, 0.8));
    assert_eq!(document.measurements[1].values[(2, 1)], -0.01);
    let said = notes(&document);
    for words in ["rows of the matrices are emission", "density times their step of 10 nm", "RenderingIntent"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn a_profile_that_does_not_fit_says_where() {
    for (from, to, words) in [
        ("bs0006", "bs0007", &["line 3", "7 channels", "6"][..]),
        ("bs0006", "rs001F", &["line 3", "rs001F"]),
        (".2 0.3 0.8", ".2 0.3", &["line 9", "5 values of `Neon & red`", "2 rows of emission x 3"]),
        (".2 0.3 0.8", ".2 x 0.8", &["`x` as value 5"]),
        ("steps=\"3\"", "steps=\"1\"", &["line 5", "steps `1`"]),
        ("start=\"390\"", "start=\"490\"", &["line 5", "start `490`"]),
        ("BiSpectralRange", "OtherRange", &["without `BiSpectralRange`", "only bispectral colours"]),
        (">spec<", ">spek<", &["without a colour"]),
        ("float16NumberType", "uInt16NumberType", &["`uInt16NumberType`"]),
        ("<Data>", "<Data File=\"a.txt\">", &["another file"]),
        ("</Tags>", "", &["a fault of the XML"]),
        ("<IccProfile>", "<!DOCTYPE a [<!ENTITY b \"c\">]><IccProfile>", &["without a document type"]),
    ] {
        let error = read("p.xml", profile().replace(from, to), &[]).unwrap_err();
        words.iter().for_each(|word| assert!(error.contains(word), "{from} -> {to}: `{word}` in {error}"));
    }
}

const SPDX: &str = r#"<?xml version="1.0"?>
<IESTM2714 xmlns="iestm2714" version="1.0">
<Header><Manufacturer>Maker</Manufacturer><CatalogNumber>C-1</CatalogNumber><Description>Test lamp</Description>
<Laboratory>N/A</Laboratory><Comments>At 25 degrees.</Comments></Header>
<SpectralDistribution><SpectralQuantity>relative</SpectralQuantity>
<BandwidthFWHM>2.0</BandwidthFWHM><BandwidthCorrected>true</BandwidthCorrected><ReflectionGeometry>other</ReflectionGeometry>
<SpectralData wavelength="400.0">0.034</SpectralData>
<SpectralData wavelength="403.1">0.037</SpectralData>
<SpectralData wavelength="405.5">-1e-3</SpectralData>
</SpectralDistribution></IESTM2714>
"#;

#[test]
fn an_spdx_lamp_is_a_light_with_its_bandwidth() {
    let document = good("a.spdx", SPDX, &[]);
    assert!(document.measurements.is_empty());
    let light = &document.lights[0];
    assert_eq!(
        (light.id.as_str(), light.title.as_deref(), light.make.as_deref()),
        ("test-lamp", Some("Test lamp"), Some("Maker C-1"))
    );
    let spectrum = light.spectrum.as_ref().unwrap();
    assert_eq!(
        (spectrum.quantity.kind, &spectrum.values[..]),
        (QuantityKind::RelativeSpectrum, &[0.034, 0.037, -0.001][..])
    );
    assert_eq!(spectrum.axis.nm, [400.0, 403.1, 405.5]);
    let Bandpass::Stated { fwhm_nm, correction, .. } = &spectrum.axis.bandpass else { panic!("no bandpass") };
    assert_eq!((&fwhm_nm[..], *correction), (&[2.0][..], BandpassCorrection::Corrected));
    let said = notes(&document);
    for words in ["Comments: At 25 degrees.", "ReflectionGeometry: other", "`--role sample`"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let folder = Folder::new();
    let sample = Options { role: Some(Role::Sample), ..Options::default() };
    let measured = import(&[folder.write("a.spdx", SPDX.replace("relative", "radiance"))], &sample).unwrap();
    assert_eq!(measured.measurements[0].quantity.kind, QuantityKind::SpectralRadiance);
    let ratio = good("a.spdx", SPDX.replace("relative", "reflectance"), &[]);
    assert_eq!(ratio.measurements[0].quantity.kind, QuantityKind::Unstated);
    let flux = notes(&good("a.spdx", SPDX.replace("relative", "flux"), &[]));
    assert!(flux.contains("`flux`, W nm-1"), "{flux}");
}

#[test]
fn an_spdx_that_cannot_be_read_says_where() {
    for (from, to, words) in [
        ("403.1", "399", &["line 8", "399 nm after 400 nm"][..]),
        (">0.037<", ">zero<", &["line 8", "`zero` at 403.1 nm"]),
        ("\"403.1\"", "\"UV\"", &["line 8", "the wavelength `UV`"]),
        ("<BandwidthFWHM>2.0", "<BandwidthFWHM>-2", &["line 6", "`-2`"]),
        (">true<", ">yes<", &["line 6", "`yes`"]),
        ("SpectralDistribution", "Spectrum", &["no `SpectralDistribution`"]),
    ] {
        let error = read("a.spdx", SPDX.replace(from, to), &[]).unwrap_err();
        words.iter().for_each(|word| assert!(error.contains(word), "{from} -> {to}: `{word}` in {error}"));
    }
}

const CGATS: &str = "CGATS.17\nORIGINATOR \"somebody\"\nINSTRUMENTATION\t\"i1Pro\"\n# a comment\nNUMBER_OF_FIELDS 6\n\
                     BEGIN_DATA_FORMAT\nSAMPLE_ID SAMPLE_NAME LAB_L SPECTRAL_NM390 SPECTRAL_NM380 SPECTRAL_NM400\nEND_DATA_FORMAT\n\
                     NUMBER_OF_SETS 3\nBEGIN_DATA\n1 \"dark red\" 40 0.12 0.11 0.13\n2 white 96 0.92 0.91 0.93\n\
                     3 white 96 0.92 0.91 0.93\nEND_DATA\n";

#[test]
fn every_sample_of_a_cgats_file_is_a_measurement() {
    let document = good("a.txt", CGATS, &[]);
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    assert_eq!(ids, ["dark-red", "white-set-2", "white-set-3"]);
    let first = &document.measurements[0];
    // Sorted by wavelength, whatever the order of the fields.
    assert_eq!(first.emission.wavelengths(), Some(&[380.0, 390.0, 400.0][..]));
    assert_eq!(first.values.iter().copied().collect::<Vec<_>>(), [0.11, 0.12, 0.13]);
    assert_eq!(
        (first.quantity.kind, document.instruments[0].model.as_deref()),
        (QuantityKind::Unstated, Some("i1Pro"))
    );
    // Equal samples are no old buffer of an instrument.
    assert!(document.measurements.iter().all(|measurement| measurement.flags.iter().all(|flags| *flags == 0)));
    let said = notes(&document);
    assert!(said.contains("ORIGINATOR `somebody`") && said.contains("the field `LAB_L`"), "{said}");
    let commas = CGATS.replace("0.", "0,");
    assert_eq!(good("a.txt", commas, &[]).measurements[0].values, first.values);
    let tabs = CGATS.replace("1 \"dark red\" 40 0.12 0.11 0.13", "1\tdark red\t40\t0.12\t0.11\t0.13");
    assert_eq!(good("a.txt", tabs, &[]).measurements[0].values, first.values);
    let second =
        CGATS.replace("END_DATA\n", "END_DATA\nNUMBER_OF_SETS 1\nBEGIN_DATA\n4 blue 30 0.2 0.1 0.3\nEND_DATA\n");
    assert_eq!(good("a.txt", second, &[]).measurements.len(), 4);
}

#[test]
fn a_cgats_file_that_contradicts_itself_says_where() {
    for (from, to, words) in [
        ("FIELDS 6", "FIELDS 7", &["line 5", "NUMBER_OF_FIELDS 7 over 6"][..]),
        ("SETS 3", "SETS 4", &["line 9", "NUMBER_OF_SETS 4 over 3"]),
        ("END_DATA\n", "", &["line 10", "the end of the file"]),
        ("END_DATA_FORMAT\n", "", &["line 6", "END_DATA_FORMAT"]),
        ("BEGIN_DATA\n", "", &["line 10", "BEGIN_DATA before the rows"]),
        (" 0.91 0.93\n3", " 0.93\n3", &["line 12", "5 values", "6"]),
        ("0.11", "NaN", &["line 11", "`NaN` at 380 nm"]),
        ("0.11", "0,11", &["line 11", "`0,11` at 380 nm", "decimal point"]),
        ("SPECTRAL_NM", "COLOUR_", &["no spectra"]),
        ("SPECTRAL_NM400", "nm390", &["`SPECTRAL_NM390` and `nm390`"]),
    ] {
        let error = read("a.txt", CGATS.replace(from, to), &[]).unwrap_err();
        words.iter().for_each(|word| assert!(error.contains(word), "{from} -> {to}: `{word}` in {error}"));
    }
}

#[test]
fn the_real_profile_of_fluorescent_colours_is_read() {
    let Some(shared) = spectra::shared() else { return };
    let text = std::fs::read(shared.join("bispectral/iccDEV_FluorescentNamedColor.xml")).unwrap();
    let document = good("p.xml", text, &[]);
    let titles: Vec<&str> =
        document.measurements.iter().filter_map(|measurement| measurement.title.as_deref()).collect();
    assert_eq!((document.measurements.len(), titles[0], titles[1]), (4, "tnt0", "Neon-Orange"));
    // The bare substrate reflects everything, and emits nothing.
    let substrate = &document.measurements[0];
    assert_eq!(substrate.shape(), (41, 31));
    for ((row, column), value) in substrate.values.indexed_iter() {
        assert_eq!(*value, if row == column + 10 { 1.0 } else { 0.0 });
    }
}
