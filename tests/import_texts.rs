//! What is accepted: encodings, line ends, prompts, other models, tables of every dialect.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use bbrf::dataset::{Document, Role};
use bbrf::import::{Options, import};
use bbrf::quantity::{Bandpass, Flag, QuantityKind};
use spectra::{Folder, bump, d5, good, grid, integral, rows};

fn read(text: impl AsRef<[u8]>) -> Document {
    let folder = Folder::new();
    let path = folder.write("spectrum.txt", text);
    import(&[path], &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn notices(document: &Document) -> String {
    document.provenance.receipts[0].notices.iter().map(|notice| format!("{}\n", notice.text)).collect()
}

#[test]
fn every_line_end_and_encoding_gives_the_same_values() {
    let crlf = good(1.0);
    let reference = read(&crlf);
    let utf16: Vec<u8> = std::iter::once(0xFEFF).chain(crlf.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let utf16_be: Vec<u8> = std::iter::once(0xFEFF).chain(crlf.encode_utf16()).flat_map(u16::to_be_bytes).collect();
    let texts: Vec<Vec<u8>> = vec![
        crlf.replace("\r\n", "\n").into(),
        crlf.replace("\r\n", "\r").into(),
        crlf.replacen("\r\n", "\r", 1).into(),
        crlf.replace("\r\n", "\r\r\n").into(),
        format!("\u{feff}{crlf}").into(),
        utf16,
        utf16_be,
        crlf.replace('E', "D").into(),
        format!("{crlf}\r\n\r\n>").into(),
        format!(">D5\r\n\r\n{crlf}>").into(),
        crlf.trim_end().to_owned().into_bytes().into_iter().chain(*b">").collect(),
    ];
    for text in texts {
        let document = read(&text);
        let shown = String::from_utf8_lossy(&text[..40]).into_owned();
        assert_eq!(document.measurements[0].values, reference.measurements[0].values, "{shown:?}");
        assert_eq!(document.measurements[0].acquisitions[0].quality_code, Some(0));
    }
}

#[test]
fn a_session_with_echoes_holds_several_records() {
    let spectrum = |nm: f64| bump(nm, 1.0);
    let text = format!(
        ">S01,,,,0,1000,1,1\r\n000\r\n>D120\r\n0101,008.0,0380.,0780.,004.\r\n>M5\r\n{}>D1\r\n00,0,9.000E+09,.3219,.3365\r\n>M5\r\n{}>",
        d5("00,0", spectrum),
        d5("18,0", |nm| bump(nm, 0.1))
    );
    let document = read(&text);
    let measurement = &document.measurements[0];
    assert_eq!(measurement.acquisitions.len(), 2);
    assert_eq!(measurement.acquisitions[1].quality_code, Some(18));
    assert!(measurement.flags_at(1, 0).contains(Flag::LowLight));
    assert!(notices(&document).contains("reported luminance"), "{}", notices(&document));
    let bbrf::quantity::EmissionAxis::Wavelengths(axis) = &measurement.emission else { panic!("no wavelengths") };
    assert!(matches!(&axis.bandpass, Bandpass::Stated { fwhm_nm, .. } if fwhm_nm == &[8.0]));
}

#[test]
fn later_models_are_read() {
    let spectrum = |nm: f64| if nm < 400.0 { 1e-27 } else { bump(nm, 1.0) };
    let line = |nm: u32| {
        let text = format!("{:.3e}", spectrum(f64::from(nm)));
        let (mantissa, exponent) = text.split_once('e').unwrap();
        let exponent: i32 = exponent.parse().unwrap();
        format!("{nm},{mantissa}e-{:03}\r\n", -exponent)
    };
    for (step, count, model) in [(4, 101, "PR-655"), (2, 201, "PR-670")] {
        let nm: Vec<u32> = (0..count).map(|index| 380 + step * index).collect();
        let sum: f64 = nm.iter().map(|nm| spectrum(f64::from(*nm))).sum();
        let rows: String = nm.iter().map(|nm| line(*nm)).collect();
        let text = format!("00000,0,5.500e+002,{:.3e},1.234e+018\r\n{rows}", f64::from(step) * sum);
        let document = read(&text);
        assert_eq!(document.instruments[0].model.as_deref(), Some(model));
        let measurement = &document.measurements[0];
        assert_eq!(measurement.emission.len(), count as usize);
        assert!(measurement.flags_at(0, 0).contains(Flag::BelowDetection));
        assert!(!measurement.flags_at(0, 60).contains(Flag::BelowDetection));
        let refused = text.replacen("00000,", "-0008,", 1);
        let folder = Folder::new();
        let error = import(&[folder.write("s.txt", refused)], &Options::default()).unwrap_err().to_string();
        assert!(error.contains("-8"), "{error}");
    }
}

#[test]
fn every_dialect_of_columns_is_read() {
    let value = |nm: u32| bump(f64::from(nm), 1.0);
    let table = |form: &dyn Fn(u32) -> String| grid().map(form).collect::<String>();
    let texts = [
        table(&|nm| format!("{nm} {:e}\n", value(nm))),
        table(&|nm| format!("{nm}\t{:e}\r\n", value(nm))),
        table(&|nm| format!("{nm}.0, {:e}\n", value(nm))),
        format!("Wavelength (nm),Spectral Power\n{}", table(&|nm| format!("{nm},{:.12}\n", value(nm)))),
        table(&|nm| format!("{nm};{}\r", format!("{:e}", value(nm)).replace('.', ","))),
        format!(
            "Metadata,Value\nIntegration time,120 ms\n\nWavelength,Power\n{}",
            table(&|nm| format!("{nm},{}\n", format!("{:e}", value(nm)).replace('e', "D")))
        ),
    ];
    for text in texts {
        let document = read(&text);
        let found = &document.measurements[0].values;
        for (column, nm) in grid().enumerate() {
            assert!((found[(0, column)] / value(nm) - 1.0).abs() < 1e-6, "{}", &text[..60]);
        }
        assert_eq!(document.measurements[0].quantity.kind, QuantityKind::Unstated);
    }
}

#[test]
fn blocks_and_columns_are_records() {
    let block = |scale: f64| -> String {
        let rows: String = grid().map(|nm| format!("{nm},{:e}\n", bump(f64::from(nm), scale))).collect();
        format!("wavelength, power\n{rows}")
    };
    let document = read(format!("{}{}{}", block(1.0), block(2.0), block(3.0)));
    assert_eq!(document.measurements[0].acquisitions.len(), 3);
    let wide: String = grid().map(|nm| format!("{nm},0.1,0.{nm}\n")).collect();
    let document = read(format!("wavelength,Red paint,Blue paint\n{wide}"));
    let ids: Vec<&str> = document.measurements.iter().map(|measurement| measurement.id.as_str()).collect();
    assert_eq!(ids, ["red-paint", "blue-paint"]);
}

#[test]
fn spectrawin_exports_are_read() {
    let values: String = grid().map(|nm| format!("{:.4e}\r\n", bump(f64::from(nm), 1.0))).collect();
    let mut full = b"[HEADER]\r\nTitle: sample A\r\nModel Num.: PR-650\r\nSerial Num.: 60000000\r\nExp. Time: 1200 msec\r\n\
        Date / Time: Tue Oct 10 2017 10:49:22\r\nRadiometric Mode: Radiance\r\n[END OF SECTION]\r\n[SPECTRAL]\r\n380\r\n\
        780\r\n4\r\n"
        .to_vec();
    full.extend(values.bytes());
    full.extend(b"[END OF SECTION]\r\n[CALCULATED]\r\nLuminance(cd/m\xb2): 7.5\r\n");
    let document = read(&full);
    let measurement = &document.measurements[0];
    assert_eq!(measurement.quantity.kind, QuantityKind::SpectralRadiance);
    assert_eq!(measurement.acquisitions[0].exposure_ms, Some(1200.0));
    assert_eq!(measurement.acquisitions[0].time, None);
    assert_eq!(document.instruments[0].serial.as_deref(), Some("60000000"));
    assert!(notices(&document).contains("without a zone"));
    let plain = read(format!("sample A\r\n380\r\n780\r\n4\r\n{values}"));
    assert_eq!(plain.measurements[0].values, measurement.values);
}

#[test]
fn a_single_spectrum_is_a_light_or_has_a_geometry() {
    let folder = Folder::new();
    let path = folder.write("lamp.txt", good(1.0));
    let lamp = Options { role: Some(Role::Lamp), ..Options::default() };
    let document = import(std::slice::from_ref(&path), &lamp).unwrap();
    assert_eq!(document.lights[0].spectrum.as_ref().unwrap().values.len(), 101);
    assert!(document.measurements.is_empty());
    let geometry = bbrf::quantity::Geometry::from_degrees(20.0, 180.0, 40.0, 0.0).unwrap();
    let placed = Options { geometry: Some(geometry), ..Options::default() };
    let document = import(std::slice::from_ref(&path), &placed).unwrap();
    assert_eq!(document.measurements[0].acquisitions[0].geometry, Some(geometry));
    let unknown = import(&[path], &Options::default()).unwrap();
    assert!(notices(&unknown).contains("geometry is unknown"));
}

#[test]
fn weak_light_is_missing_and_never_zero() {
    let text = format!("{}10,0\r\n0.000E+00\r\n{}", good(1.0), rows(|_| 0.0, "\r\n"));
    let document = read(&text);
    let measurement = &document.measurements[0];
    assert!(measurement.values.row(1).iter().all(|value| value.is_nan()));
    assert!(measurement.flags_at(1, 7).contains(Flag::BelowDetection));
    assert!(notices(&document).contains("quality code 10"));
    assert!(!integral(|nm| bump(nm, 1.0)).is_empty());
}

#[test]
fn the_floor_is_flagged_and_kept() {
    let floor = |nm: f64| 1e-7 + (nm - 560.0).abs() * 1e-9;
    let lit =
        move |scale: f64| move |nm: f64| f64::max(floor(nm), scale * 1e-2 * (-((nm - 550.0) / 20.0).powi(2)).exp());
    let text = format!("{}{}{}", d5("00,0", lit(1.0)), d5("00,0", lit(0.7)), d5("00,0", lit(0.5)));
    let document = read(&text);
    let measurement = &document.measurements[0];
    assert!(measurement.flags_at(0, 0).contains(Flag::BelowDetection));
    assert!(measurement.values[(0, 0)] > 0.0);
    assert!(!measurement.flags_at(0, 42).contains(Flag::BelowDetection));
    let texts: Vec<&str> =
        document.provenance.receipts[0].assumptions.iter().map(|assumption| assumption.text.as_str()).collect();
    assert!(texts.iter().any(|text| text.contains("floor is the smallest value")), "{texts:?}");
}

#[test]
fn the_same_input_gives_the_same_document() {
    let folder = Folder::new();
    let path = folder.write("spectrum.txt", good(1.0));
    let once = import(std::slice::from_ref(&path), &Options::default()).unwrap();
    let twice = import(&[path], &Options::default()).unwrap();
    assert_eq!(serde_json::to_string(&once).unwrap(), serde_json::to_string(&twice).unwrap());
}
