//! Whatever bytes come in: a document or an error, in time, never a panic. `BBRF_PROPTEST_CASES` sets the number of
//! cases.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used, clippy::panic)]

mod spectra;

use std::time::{Duration, Instant};

use bbrf::import::{Format, Options, import};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use spectra::{Folder, good};

fn runner() -> TestRunner {
    let cases = std::env::var("BBRF_PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(300);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

const ICC: &str = r#"<?xml version="1.0"?><IccProfile><Header><SpectralPCS>bs0006</SpectralPCS><SpectralRange>
<Wavelengths start="400" end="410" steps="2"/></SpectralRange><BiSpectralRange><Wavelengths start="300" end="320" steps="3"/>
</BiSpectralRange></Header><Tags><tagArrayType><ArrayTags><tagStructureType><StructureSignature>nmcl</StructureSignature>
<MemberTags><utf8TextType><TagSignature>name</TagSignature><TextData><![CDATA[Red]]></TextData></utf8TextType>
<float16NumberType><TagSignature>spec</TagSignature><Data>1 2 3 4 5 -6</Data></float16NumberType></MemberTags>
</tagStructureType></ArrayTags></tagArrayType></Tags></IccProfile>"#;

const SPDX: &str = r#"<IESTM2714 xmlns="http://www.ies.org/iestm2714" version="1.0"><Header><Manufacturer>Maker</Manufacturer>
<Description>Lamp</Description></Header><SpectralDistribution><SpectralQuantity>flux</SpectralQuantity>
<BandwidthFWHM>2.0</BandwidthFWHM><BandwidthCorrected>true</BandwidthCorrected>
<SpectralData wavelength="400.0">0.034</SpectralData><SpectralData wavelength="403.1">0.037</SpectralData>
</SpectralDistribution></IESTM2714>"#;

fn valid() -> Vec<String> {
    let columns: String = spectra::grid().map(|nm| format!("{nm};0,{nm}\n")).collect();
    let win: String = spectra::grid().map(|_| "1.0e-5\n").collect();
    vec![
        good(1.0),
        format!(">D120\r0101,008.0,0380.,0780.,004.\r>D5\r{}>D1\r00,0,1.2E+00,.3,.3\r", good(1.0)),
        format!("wavelength;power\n{columns}"),
        format!("[HEADER]\nTitle: a\n[SPECTRAL]\n380\n780\n4\n{win}[END OF SECTION]\n"),
        format!("title\n380\n780\n4\n{win}"),
        "# angles: full\n# quantity: radiance-factor\ntheta_i_deg,phi_i_deg,theta_v_deg,phi_v_deg,emission_nm,value,flag\n\
         1,2,3,4,500,0.5,\n1,2,3,4,504,,invalid\n"
            .to_owned(),
        "# angles: signed, mirror-at-equal\nfile,record,role,theta_i_deg,theta_v_deg\nspectrum,1,sample,0,10\n".to_owned(),
        include_str!("../testdata/bispectral/synthetic.BFC").to_owned(),
        "# quantity: relative-spectrum\n# bandpass-nm: 5\nem\\ex,300,310,320\n400,1,2,3\n410,4,,-6\n".to_owned(),
        "ex/em\t400\t410\n300\t1,5\t-2\n310\t0\t4\n".to_owned(),
        ICC.to_owned(),
        SPDX.to_owned(),
        "CGATS.17\nINSTRUMENTATION \"i1\"\nNUMBER_OF_FIELDS 4\nBEGIN_DATA_FORMAT\nSAMPLE_ID\tLAB_L\tSPECTRAL_NM380\tnm390\n\
         END_DATA_FORMAT\nNUMBER_OF_SETS 2\nBEGIN_DATA\n1\t5\t0.1\t0.2\n2\t6\t0.3\t0.4\nEND_DATA\n"
            .to_owned(),
        "angles = \"full\"\n[[record]]\nfile = \"spectrum\"\nrole = \"white\"\n".to_owned(),
    ]
}

/// One change of a text: bytes replaced, put in, taken out, or a piece doubled.
fn mutate(text: &str, changes: &[(u8, u16, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (kind, at, new) in changes {
        let at = usize::from(*at) % (bytes.len() + 1);
        let end = (at + new.len()).min(bytes.len());
        match kind % 4 {
            0 => drop(bytes.splice(at..end, new.iter().copied())),
            1 => drop(bytes.splice(at..at, new.iter().copied())),
            2 => drop(bytes.splice(at..end, [])),
            _ => {
                let piece = bytes[at..].to_vec();
                bytes.extend(piece);
            }
        }
    }
    bytes
}

fn formats() -> impl Iterator<Item = Option<Format>> {
    Format::ALL.iter().copied().map(Some).chain([None])
}

fn try_all(bytes: &[u8]) {
    let folder = Folder::new();
    let path = folder.write("input", bytes);
    folder.write("spectrum", good(1.0));
    for format in formats() {
        let start = Instant::now();
        let options = Options { format, ..Options::default() };
        if let Ok(document) = import(std::slice::from_ref(&path), &options) {
            document.check().unwrap();
        }
        assert!(start.elapsed() < Duration::from_secs(10), "{format:?} takes too long");
    }
}

#[test]
fn random_bytes_never_panic() {
    let bytes = prop::collection::vec(any::<u8>(), 0..2000);
    let printable =
        prop::collection::vec(prop::sample::select(b"0123456789.,;eE+-#: \t\r\n>DMnaf[]\"{}=".to_vec()), 0..600);
    runner()
        .run(&prop_oneof![bytes, printable], |bytes| {
            try_all(&bytes);
            Ok(())
        })
        .unwrap();
}

#[test]
fn mutated_texts_never_panic() {
    let byte = prop_oneof![any::<u8>(), prop::sample::select(b"0,.;\r\n-E>#\"\0\xff".to_vec())];
    let change = (any::<u8>(), any::<u16>(), prop::collection::vec(byte, 0..12));
    let input = (prop::sample::select(valid()), prop::collection::vec(change, 1..4));
    runner()
        .run(&input, |(text, changes)| {
            try_all(&mutate(&text, &changes));
            Ok(())
        })
        .unwrap();
}

#[test]
fn every_truncation_is_answered() {
    for text in valid() {
        for length in (0..text.len()).step_by(37) {
            let folder = Folder::new();
            let path = folder.write("input", &text.as_bytes()[..length]);
            let _ = import(&[path], &Options::default());
        }
    }
}

#[test]
fn long_inputs_take_time_in_proportion() {
    let folder = Folder::new();
    let start = Instant::now();
    let sets: String = (0..20_000).map(|k| format!("{k} 0.1 0.2\n")).collect();
    let attributes: String = (0..100_000).map(|k| format!(" a{k}=''")).collect();
    let colour = "<tagStructureType><MemberTags><float32NumberType><TagSignature>spec</TagSignature><Data>1 2 3 4 5 6</Data>\
                  </float32NumberType></MemberTags></tagStructureType>";
    for text in [
        "\n".repeat(4_000_000),
        ">".repeat(4_000_000),
        "1,".repeat(1_000_000),
        "380 1\n".repeat(300_000),
        format!("CGATS.17\nBEGIN_DATA_FORMAT\nSAMPLE_ID nm380 nm390\nEND_DATA_FORMAT\nBEGIN_DATA\n{sets}END_DATA\n"),
        "<a>".repeat(500_000),
        format!("<IESTM2714{attributes}/>"),
        "<IccProfile xmlns:a='b'>".repeat(50_000),
        ICC.replace("</ArrayTags>", &format!("{}</ArrayTags>", colour.repeat(3_000))),
        format!("ex/em,{}\n300,1\n", "400,".repeat(500_000)),
        "VEC_1\n;\n".repeat(300_000),
    ] {
        for format in formats() {
            let path = folder.write("input", &text);
            let _ = import(&[path], &Options { format, ..Options::default() });
        }
    }
    assert!(start.elapsed() < Duration::from_secs(120), "{:?}", start.elapsed());
}
