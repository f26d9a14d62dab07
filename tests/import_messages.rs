//! What errors and notices say: a path that can be opened, a fault named once, in words.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use std::path::PathBuf;

use bbrf::dataset::{Document, Place};
use bbrf::import::{Options, Settings, import};
use spectra::{Folder, bump, good, grid};

const HEAD: &str = "# angles: signed, mirror-at-equal\nfile,role,theta_i_deg,theta_v_deg\n";

fn fails(path: PathBuf) -> String {
    import(&[path], &Options::default()).unwrap_err().to_string()
}

fn notices(document: &Document) -> Vec<(Place, String)> {
    let notices = &document.provenance.receipts[0].notices;
    notices.iter().map(|notice| (notice.place.clone(), notice.text.clone())).collect()
}

#[test]
fn errors_in_files_of_a_manifest_name_a_path_that_can_be_opened() {
    let folder = Folder::new();
    folder.write("raw/cut.txt", "00,0\r\n1.000E-03\r\n0380.,1.000E-05\r\n");
    folder.write("raw/good.txt", good(1.0));
    folder.write("short.csv", "500 0.99\n504 0.98\n");
    let open = |name: &str| folder.path().join(name).display().to_string();
    let error = fails(folder.write("cut.csv", format!("{HEAD}./raw/cut.txt,sample,0,10\n")));
    assert!(error.starts_with(&open("raw/cut.txt")), "{error}");
    let error = fails(folder.write("missing.csv", format!("{HEAD}raw/none.txt,sample,0,10\n")));
    assert!(error.contains(&open("raw/none.txt")) && error.contains(&open("raw/cut.txt")), "{error}");
    let rows = "raw/good.txt,white,0,45\nraw/cut.txt,sample,0,10\n".replace("cut", "other");
    folder.write("raw/other.txt", good(1.1));
    let error = fails(folder.write("m.csv", format!("# certified-factor: short.csv\n{HEAD}{rows}")));
    assert!(error.starts_with(&open("short.csv")) && error.contains("does not cover"), "{error}");
}

#[test]
fn receipts_do_not_say_where_the_manifest_lay() {
    let folder = Folder::new();
    folder.write("raw/a.txt", good(1.0));
    folder.write("white.txt", good(2.0));
    folder.write("factor.csv", "380 0.99\n780 0.98\n");
    let rows = "./raw/a.txt,sample,0,10\nwhite.txt,white,0,45\n";
    let manifest = folder.write("m.csv", format!("# certified-factor: factor.csv\n{HEAD}{rows}"));
    let document = import(&[manifest], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let names: Vec<&str> = document.provenance.receipts[0].inputs.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(names, ["m.csv", "raw/a.txt", "white.txt", "factor.csv"]);
    let json = serde_json::to_string(&document).unwrap();
    assert!(!json.contains(&folder.path().display().to_string()), "{json}");
}

#[test]
fn nothing_is_named_or_expected_twice() {
    let folder = Folder::new();
    let path = folder.write("a.txt", good(1.0));
    let copy = folder.write("b.txt", good(1.0));
    let document = import(&[path, copy], &Options::default()).unwrap();
    for (place, text) in notices(&document) {
        let file = place.file.unwrap_or_default();
        assert!(file.is_empty() || !text.contains(&file), "{file}: {text}");
    }
    let error = fails(folder.write("far.csv", format!("{HEAD}a.txt,sample,0,100\n")));
    assert_eq!(error.matches("expected").count(), 1, "{error}");
    assert!(error.contains("found signed in-plane angle 100 degrees; expected a number from -90 to 90"), "{error}");
}

#[test]
fn a_comment_below_the_header_is_told_from_a_row() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    for comment in ["# title: A", "# the lamp was warm, very", "#end"] {
        let error = fails(folder.write("m.csv", format!("{HEAD}a.txt,sample,0,10\n{comment}\n")));
        assert!(error.contains("line 4: found the comment `#") && error.contains("above the header"), "{error}");
    }
}

#[test]
fn a_negative_value_on_the_grid_of_a_pr650_is_said() {
    let folder = Folder::new();
    let rows: String =
        grid().map(|nm| format!("{nm} {:e}\n", bump(f64::from(nm), 1.0) - f64::from(u8::from(nm < 388)))).collect();
    let document = import(&[folder.write("minus.txt", rows)], &Options::default()).unwrap();
    let said = notices(&document).into_iter().find(|(_, text)| text.contains("negative")).unwrap();
    assert!(said.1.starts_with("2 of 101 values") && said.1.contains("at 380 nm"), "{}", said.1);
    assert!(document.measurements[0].values[(0, 0)] < 0.0);
}

#[test]
fn what_the_call_overrides_is_said_in_the_spelling_of_the_keys() {
    let folder = Folder::new();
    folder.write("a.txt", good(1.0));
    let manifest = folder.write("m.csv", format!("# bandpass-nm: 8\n# part: total\n{HEAD}a.txt,sample,0,10\n"));
    let mut settings = Settings::default();
    settings.state("part", "elastic").unwrap();
    settings.state("bandpass-nm", "4").unwrap();
    let document = import(&[manifest], &Options { settings, ..Options::default() }).unwrap();
    let texts: Vec<&str> = document.provenance.receipts[0].assumptions.iter().map(|each| each.text.as_str()).collect();
    for expected in ["`part` is `elastic`, as the call states, and not `total`", "`bandpass-nm` is `4`"] {
        assert!(texts.iter().any(|text| text.starts_with(expected)), "{texts:?}");
    }
}
