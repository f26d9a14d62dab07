//! What a PNG shows is the scene's colour, or it says what it is not.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/scans.rs"]
mod scans;

use std::io::{Cursor, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use bbrf::simulate::Film;
use bbrf::simulate::image::{Depth, Gamut, OutOfGamut, Png, Srgb};
use scans::Random;
use serde_json::{Value, json};

const WHITE: [f64; 3] = [109.85, 100.0, 35.58];
const D65: [f64; 3] = [0.3127 / 0.3290, 1.0, 0.3583 / 0.3290];

/// Samples as whole numbers, and the notes.
fn decoded(bytes: &[u8]) -> (Vec<u32>, Vec<(String, String)>) {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut buffer).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    let samples = match info.bit_depth {
        png::BitDepth::Sixteen => {
            buffer.as_chunks().0.iter().map(|pair| u32::from(u16::from_be_bytes(*pair))).collect()
        }
        _ => buffer.iter().map(|byte| u32::from(*byte)).collect(),
    };
    let texts = &reader.info().utf8_text;
    (samples, texts.iter().map(|text| (text.keyword.clone(), text.get_text().unwrap())).collect())
}

fn encode(film: &Film, white: [f64; 3], exposure: f64, gamut: Gamut, depth: Depth) -> (Vec<u32>, OutOfGamut) {
    let png = Png { display: Srgb::new(white, exposure).unwrap(), gamut, depth };
    let (bytes, out_of_gamut) = png.encode(film, &[]).unwrap();
    (decoded(&bytes).0, out_of_gamut)
}

fn one(xyz: [f64; 3], gamut: Gamut) -> (Vec<u32>, OutOfGamut) {
    let film = Film::from_pixels(1, 1, |_, _| xyz.map(|value| value as f32)).unwrap();
    encode(&film, D65, 1.0, gamut, Depth::Sixteen)
}

#[test]
fn the_white_of_the_scene_is_the_white_of_the_display_under_any_light() {
    for white in [WHITE, D65, [95.0, 100.0, 82.5], [0.4, 0.5, 0.6]] {
        let film = Film::from_pixels(3, 2, |_, _| white.map(|value| value as f32)).unwrap();
        for (depth, top) in [(Depth::Eight, 255), (Depth::Sixteen, 65_535)] {
            let (samples, out) = encode(&film, white, 1.0, Gamut::Clip, depth);
            assert_eq!(samples, vec![top; 18], "{white:?}");
            assert_eq!((out.pixels, out.of, out.undefined), (0, 6, 0), "{out}");
        }
    }
}

#[test]
fn half_the_exposure_of_a_grey_is_the_same_as_half_the_grey() {
    let grey = |share: f64| Film::from_pixels(2, 2, |_, _| WHITE.map(|value| (share * value) as f32)).unwrap();
    let (half, _) = encode(&grey(0.8), WHITE, 0.5, Gamut::Clip, Depth::Eight);
    let (darker, _) = encode(&grey(0.4), WHITE, 1.0, Gamut::Clip, Depth::Eight);
    assert_eq!(half, darker);
}

#[test]
fn rows_and_columns_stay_where_they_are() {
    let film = Film::from_pixels(3, 2, |column, row| {
        D65.map(|value| if (column, row) == (2, 0) { value as f32 } else { 0.0 })
    });
    let (samples, _) = encode(&film.unwrap(), D65, 1.0, Gamut::Clip, Depth::Eight);
    assert_eq!(samples, [[0; 6].as_slice(), &[255; 3], &[0; 9]].concat());
}

#[test]
fn colours_that_the_display_has_not_are_counted_and_said() {
    // Twice the green primary of sRGB, and a spectral cyan.
    let (clipped, out) = one([0.7152, 1.4304, 0.2384], Gamut::Clip);
    assert_eq!(clipped[1], 65_535);
    assert_eq!((out.pixels, out.of), (1, 1));
    assert!((out.above - 1.0).abs() < 1e-3, "{out}");
    let (cyan, out) = one([0.05, 0.4, 0.45], Gamut::Clip);
    assert_eq!(cyan[0], 0);
    assert!(out.below > 0.1 && out.to_string().starts_with("1 of 1 pixels (100.00 %) are no colours of sRGB"), "{out}");
}

#[test]
fn a_paler_colour_has_the_luminance_that_it_had() {
    let mut random = Random::new(1);
    let decoded = |value: u32| {
        let value = f64::from(value) / 65_535.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    let mut outside = 0;
    for _ in 0..500 {
        let xyz = [0; 3].map(|_| random.uniform() * 0.99);
        let (samples, out) = one(xyz, Gamut::Desaturate);
        outside += out.pixels;
        let luminance: f64 = [0.2126, 0.7152, 0.0722].iter().zip(&samples).map(|(y, s)| y * decoded(*s)).sum();
        assert!((luminance - xyz[1]).abs() < 1e-4, "{xyz:?}: {luminance}");
    }
    assert!(outside > 100, "{outside}");
    assert_eq!(one([3.0; 3], Gamut::Desaturate).0, [65_535; 3]);
}

#[test]
fn a_number_that_is_none_is_black_and_said() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (samples, out) = one([0.2, value, 0.1], Gamut::Desaturate);
        assert_eq!((samples, out.undefined), (vec![0; 3], 1));
        assert!(out.to_string().contains("1 pixels have a number that is none"), "{out}");
    }
}

#[test]
fn a_white_or_an_exposure_that_is_none_is_refused_with_what_was_found() {
    for white in [[0.0; 3], [f64::NAN, 1.0, 1.0], [1.0, -1.0, 1.0], [f64::INFINITY; 3], [1e-320; 3]] {
        let error = Srgb::new(white, 1.0).unwrap_err().to_string();
        assert!(error.contains(&white[1].to_string()), "{error}");
    }
    for exposure in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Srgb::new(D65, exposure).unwrap_err().to_string().contains(&exposure.to_string()));
    }
}

#[test]
fn the_same_film_gives_the_same_bytes_and_its_notes_come_back() {
    let mut random = Random::new(2);
    let film = Film::from_pixels(31, 17, |_, _| [0; 3].map(|_| random.uniform() as f32)).unwrap();
    let png = Png { display: Srgb::new(D65, 1.0).unwrap(), gamut: Gamut::Clip, depth: Depth::Eight };
    let notes = [("plan".to_owned(), "{\"ä\": 1}".to_owned()), ("seed".to_owned(), "7".to_owned())];
    let (first, _) = png.encode(&film, &notes).unwrap();
    assert_eq!(first, png.encode(&film, &notes).unwrap().0);
    assert_eq!(decoded(&first).1, notes);
    for name in ["x".repeat(80), String::new(), "ä".to_owned(), "a b".to_owned()] {
        let refused = png.encode(&film, &[(name.clone(), String::new())]).unwrap_err().to_string();
        assert!(refused.contains(&format!("`{name}`")) && refused.contains("1 to 79"), "{refused}");
    }
}

#[test]
fn every_sample_is_that_of_colour_science() {
    let Ok(python) = std::env::var("BBRF_PYTHON") else {
        eprintln!("skipped: BBRF_PYTHON does not name a Python interpreter (make test sets it)");
        return;
    };
    let mut random = Random::new(3);
    let pixels: Vec<[f32; 3]> = (0..2000)
        .map(|_| {
            let grey = random.uniform();
            [0, 1, 2].map(|c| (WHITE[c] * (grey + 0.3 * random.normal())).max(0.0) as f32)
        })
        .collect();
    let film = Film::from_pixels(50, 40, |column, row| pixels[50 * row + column]).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/srgb.py");
    let mut child = Command::new(python).arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let given = json!({"white": WHITE, "xyz": pixels}).to_string();
    child.stdin.take().unwrap().write_all(given.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let expected: Vec<f64> = serde_json::from_slice::<Value>(&output.stdout)
        .unwrap()
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    for (depth, top) in [(Depth::Eight, 255.0), (Depth::Sixteen, 65_535.0)] {
        let (samples, out) = encode(&film, WHITE, 1.0, Gamut::Clip, depth);
        assert_eq!(samples.len(), expected.len());
        assert!(out.pixels > 100 && out.pixels < 1900, "{out}");
        for (found, expected) in samples.iter().zip(&expected) {
            // Within half a step: as near as whole numbers come.
            assert!((f64::from(*found) - top * expected).abs() <= 0.5 + 1e-6 * top, "{found}, {}", top * expected);
        }
    }
}
