//! One test per malformed input of the format's research: an error says where and what; a warning is imported, flagged
//! and in the receipt.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use bbrf::dataset::Document;
use bbrf::import::{Format, ImportError, Options, import};
use bbrf::quantity::{Flag, QuantityKind};
use spectra::{Folder, bump, d5, good, grid, print};

fn read(text: impl AsRef<[u8]>, options: &Options) -> Result<Document, ImportError> {
    let folder = Folder::new();
    let path = folder.write("spectrum.txt", text);
    import(&[path], options)
}

/// The message of the error; every one names the file.
fn message(text: impl AsRef<[u8]>) -> String {
    let message = read(text, &Options::default()).unwrap_err().to_string();
    assert!(message.contains("spectrum.txt"), "{message}");
    message
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

fn notices(document: &Document) -> String {
    let receipt = &document.provenance.receipts[0];
    receipt.notices.iter().map(|notice| format!("{}: {}\n", notice.place, notice.text)).collect()
}

/// A good report with one data line changed.
fn with_line(nm: u32, change: impl Fn(&str) -> String) -> String {
    let start = format!("{nm:04}.");
    good(1.0)
        .split_inclusive('\n')
        .map(|line| if line.starts_with(&start) { change(line) } else { line.into() })
        .collect()
}

/// The first rows of a good report.
fn cut(rows: usize) -> String {
    good(1.0).split_inclusive('\n').take(2 + rows).collect()
}

#[test]
fn empty() {
    assert_says(&message(""), &["empty file"]);
    assert_says(&message("\r\n\r\n"), &["empty file"]);
}

#[test]
fn truncated() {
    assert_says(&message(cut(57)), &["57 rows", "604 nm", "101"]);
    assert_says(&message("00,0\r\n"), &["no integral", "101 rows"]);
    assert_says(&message(cut(0)), &["0 rows", "101"]);
}

#[test]
fn cut_in_a_line() {
    let text = format!("{}0608.,1.2", cut(57));
    assert_says(&message(text), &["line 60", "608", "`1.2`"]);
    assert_says(&message(format!("{}060", cut(57))), &["57 rows", "604 nm"]);
    assert_says(&message(format!("{}0608.,1.234E-0", cut(57))), &["line 60"]);
}

#[test]
fn doubled_and_lost_rows() {
    let text = with_line(460, |line| line.replace("0460.", "0456."));
    assert_says(&message(text), &["line 23", "456 nm", "460 nm", "not increasing by 4"]);
    let lost: String = good(1.0).split_inclusive('\n').filter(|line| !line.starts_with("0460.")).collect();
    assert_says(&message(lost), &["line 23", "464 nm", "not increasing by 4"]);
}

#[test]
fn overload() {
    assert_says(&message("19,0\r\n"), &["overload, no data", "19"]);
    assert_says(&message(d5("19,0", |nm| bump(nm, 1.0))), &["overload, no data"]);
}

#[test]
fn unknown_code() {
    assert_says(&message(d5("42,0", |nm| bump(nm, 1.0))), &["line 1", "unknown quality code 42"]);
    assert_says(&message(d5("29,0", |nm| bump(nm, 1.0))), &["29", "corrupted data"]);
}

#[test]
fn uncalibrated() {
    let text = d5("00,2", |nm| bump(nm, 1.0));
    assert_says(&message(&text), &["unit code 2", "uncalibrated", "--allow-uncalibrated"]);
    let forced = read(&text, &Options { allow_uncalibrated: true, ..Options::default() }).unwrap();
    assert_eq!(forced.measurements[0].quantity.kind, QuantityKind::Unstated);
}

#[test]
fn irradiance_in_a_radiance_set() {
    let text = format!("{}{}", good(1.0), d5("00,1", |nm| bump(nm, 2.0)));
    assert_says(&message(text), &["mixed quantity", "spectral-irradiance", "spectral-radiance"]);
    let alone = read(d5("00,1", |nm| bump(nm, 2.0)), &Options::default()).unwrap();
    assert_eq!(alone.measurements[0].quantity.kind, QuantityKind::SpectralIrradiance);
}

#[test]
fn integral_mismatch() {
    let right = spectra::integral(|nm| bump(nm, 1.0));
    let wrong = print(1.25 * right.parse::<f64>().unwrap());
    let text = good(1.0).replacen(&right, &wrong, 1);
    assert_says(&message(text), &["line 2", "integral", "sum of the values times 4 nm"]);
}

#[test]
fn two_spectra_in_one_file() {
    let both = format!("{}{}", good(1.0), good(2.0));
    let document = read(&both, &Options::default()).unwrap();
    assert_eq!(document.measurements[0].acquisitions.len(), 2);
    assert_eq!(document.provenance.receipts[0].inputs[0].records, 2);
    let folder = Folder::new();
    folder.write("two.txt", &both);
    let manifest = folder.write("manifest.csv", "# angles: full\nfile,role\ntwo.txt,sample\n");
    let error = import(&[manifest], &Options::default()).unwrap_err().to_string();
    assert_says(&error, &["line 3", "2 records", "manifest must name the record"]);
}

#[test]
fn nan_and_negative() {
    let nan = with_line(420, |_| "0420.,NaN\r\n".to_owned());
    assert_says(&message(nan), &["line 13", "420 nm", "NaN"]);
    let negative = with_line(420, |_| "0420.,-1.000E-05\r\n".to_owned());
    assert_says(&message(negative), &["line 13", "420 nm", "-1.000E-05"]);
    let columns: String = grid().map(|nm| format!("{nm} {}\n", if nm == 384 { "NaN" } else { "0.1" })).collect();
    assert_says(&message(columns), &["line 2", "384 nm", "NaN"]);
}

#[test]
fn a_byte_outside_ascii() {
    let mut bytes = good(1.0).into_bytes();
    let offset = good(1.0).find("0500.").unwrap() + 2;
    bytes[offset] = 0xe8;
    assert_says(&message(bytes), &[&format!("byte {offset}"), "0xe8"]);
    let first = good(1.0).find("0380.").unwrap();
    let mut bytes = good(1.0).into_bytes();
    bytes[first] = 0xe8;
    assert_says(&message(bytes), &[&format!("byte {first}"), "0xe8"]);
}

#[test]
fn mixed_decimal_marks() {
    assert_says(&message("380;1,5E-07\n384;1.4E-07\n"), &["line 2", "'.' after ','"]);
}

#[test]
fn a_comma_for_both() {
    let text: String = grid().map(|nm| format!("{nm},0,000028\n")).collect();
    assert_says(&message(text), &["ambiguous", "--dialect"]);
    let text: String = grid().map(|nm| format!("{nm} 0,000028\n")).collect();
    assert_says(&message(&text), &["ambiguous", "--dialect"]);
    let options = Options { dialect: Some("space-decimal-comma".parse().unwrap()), ..Options::default() };
    assert_eq!(read(text, &options).unwrap().measurements[0].values[(0, 0)], 0.000_028);
}

#[test]
fn values_per_band() {
    // The numbers alone cannot tell; the luminance beside them does.
    let rows: String = grid().map(|nm| format!("{nm},{:e},132.0\n", 4.0 * bump(f64::from(nm), 14.0))).collect();
    let text = format!("wavelength,power,luminance\n{rows}");
    let document = read(&text, &Options::default()).unwrap();
    let luminance_of = |notices: &str| notices.contains("reported luminance");
    assert!(luminance_of(&notices(&document)), "{}", notices(&document));
    assert_eq!(document.measurements[0].quantity.kind, QuantityKind::Unstated);
    let unfilled = &document.provenance.receipts[0].unfilled;
    assert!(unfilled.iter().any(|path| path.ends_with("quantity/quantity")), "{unfilled:?}");
}

#[test]
fn a_wrong_declared_grid() {
    let values: String = (0..81).map(|_| "1.0e-05\n").collect();
    let text = format!("[HEADER]\nTitle: a\n[SPECTRAL]\n380\n780\n4\n{values}[END OF SECTION]\n");
    assert_says(&message(text), &["81 values", "700 nm", "101 values", "380 to 780 nm by 4"]);
    let plain = format!("title\n380\n780\n4\n{values}");
    assert_says(&message(plain), &["81 values", "700 nm", "101 values"]);
}

#[test]
fn a_status_line_as_data() {
    let text = format!("00,0\r\n1.000E-01\r\n0000.,1.655E-01\r\n{}", spectra::rows(|nm| bump(nm, 1.0), "\r\n"));
    assert_says(&message(text), &["line 3", "wavelength 0 nm", "first wavelength 380"]);
    let columns: String = grid().map(|nm| format!("{nm} 0.1\n")).collect();
    let forced = Options { format: Some(Format::Columns), ..Options::default() };
    let error = read(format!("0 0.1655\n{columns}"), &forced).unwrap_err().to_string();
    assert_says(&error, &["line 1", "wavelength 0 nm", "status line"]);
}

#[test]
fn stale_buffer() {
    let folder = Folder::new();
    let first = folder.write("a1.txt", good(1.0));
    let second = folder.write("a2.txt", good(1.0));
    let third = folder.write("a3.txt", good(1.5));
    let document = import(&[first, second, third], &Options::default()).unwrap();
    assert_says(&notices(&document), &["a1.txt", "a2.txt", "bit for bit"]);
    let flag = |index: usize| document.measurements[index].flags_at(0, 50).contains(Flag::StaleBuffer);
    assert_eq!([flag(0), flag(1), flag(2)], [false, true, false]);
}

#[test]
fn fixed_decimals() {
    let text: String = grid().map(|nm| format!("{nm} {:.6}\n", 1e-3 * bump(f64::from(nm), 1.0))).collect();
    let document = read(text, &Options::default()).unwrap();
    assert_says(&notices(&document), &["precision 1e-6", "fixed 6 decimals", "1 %"]);
    assert!(document.measurements[0].flags_at(0, 0).contains(Flag::BelowDetection));
    assert_eq!(document.measurements[0].values[(0, 0)], 0.0);
}

#[test]
fn numbers_are_sorted_as_numbers() {
    let folder = Folder::new();
    for number in 1..=12 {
        folder.write(&format!("Spectrum{number}.txt"), good(f64::from(number)));
    }
    let options = Options {
        scan_order: Some("theta_i=0:20:10; theta_v=0:30:10".to_owned()),
        settings: bbrf::import::Settings {
            angles: Some("signed, mirror-at-equal".parse().unwrap()),
            ..Default::default()
        },
        ..Options::default()
    };
    let document = import(&[folder.path()], &options).unwrap();
    let column = document.measurement("radiance").unwrap().values.column(42).to_vec();
    assert!(column.windows(2).all(|pair| pair[0] < pair[1]), "{column:?}");
    let too_many = Options { scan_order: Some("theta_i=0; theta_v=0:30:10".to_owned()), ..options };
    let error = import(&[folder.path()], &too_many).unwrap_err().to_string();
    assert_says(&error, &["12 records", "4 looks"]);
}

#[test]
fn missing_and_unlisted_files() {
    let folder = Folder::new();
    folder.write("raw/a.txt", good(1.0));
    folder.write("raw/extra.txt", good(2.0));
    let head = "# angles: signed, mirror-at-equal\nfile,record,role,theta_i_deg,theta_v_deg\nraw/a.txt,1,sample,0,10\n";
    let lost = folder.write("lost.csv", format!("{head}raw/b.txt,1,sample,0,20\nraw/c.txt,1,sample,0,30\n"));
    let error = import(&[lost], &Options::default()).unwrap_err().to_string();
    assert_says(&error, &["raw/b.txt (line 4)", "raw/c.txt (line 5)", "raw/extra.txt"]);
    let whole = folder.write("whole.csv", head);
    let document = import(&[whole], &Options::default()).unwrap();
    assert_says(&notices(&document), &["not listed", "raw/extra.txt"]);
}
