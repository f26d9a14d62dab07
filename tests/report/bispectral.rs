//! The figures of a Donaldson matrix: reflected light apart from luminescence, noise as noise, gaps as gaps, whatever the matrix.

use bbrf::dataset::{Document, Measurement};
use bbrf::donaldson::{Matrix, Separate, parts, separate};
use bbrf::report::{Drawn, Pictures, matrix_figures, page};
use ndarray::Array2;

use super::{decoded, matrices, names};

const RED: usize = 0;
const BLUE: usize = 2;

fn drawn(measurement: &Measurement) -> Drawn {
    matrix_figures(&Document::default(), measurement)
}

fn orange(change: impl Fn(&mut Array2<f64>)) -> Measurement {
    let (excitation, emission, mut values) = matrices::values(10.0);
    change(&mut values);
    matrices::measurement("orange", &excitation, &emission, values, None, None)
}

/// The fills of the cells of a map, by column and row from the lower left.
fn cells(svg: &str, (excitations, emissions): (usize, usize)) -> std::collections::HashMap<(usize, usize), [u8; 3]> {
    let (width, height) = (500.0 / emissions as f64, 500.0 / excitations as f64);
    let mut found = std::collections::HashMap::new();
    for rest in svg.split("<rect ").skip(1) {
        let text = |name: &str| rest.split(&format!(" {name}=\"")).nth(1).map(|rest| rest.split('"').next().unwrap());
        let number = |name: &str| text(name).and_then(|text| text.parse::<f64>().ok()).unwrap_or(f64::NAN);
        let is_cell = (number("width") - width - 0.4).abs() < 0.02 && (number("height") - height - 0.4).abs() < 0.02;
        if !is_cell {
            continue;
        }
        // A few greys are written by their names.
        let fill = match text("fill").unwrap() {
            "white" => "#ffffff",
            "black" => "#000000",
            "gray" | "grey" => "#808080",
            "silver" | "lightgray" | "lightgrey" => "#c0c0c0",
            hex => hex,
        };
        let part = |at: usize| u8::from_str_radix(&fill[2 * at + 1..2 * at + 3], 16).unwrap();
        let column = ((number("x") - 84.0) / width).round() as usize;
        // Rows are counted from the top of the sheet here, and turned below.
        found.insert((column, number("y").round() as usize), [part(0), part(1), part(2)]);
    }
    let mut tops: Vec<usize> = found.keys().map(|key| key.1).collect();
    tops.sort_unstable();
    tops.dedup();
    let row = |top: usize| tops.len() - 1 - tops.binary_search(&top).unwrap();
    found.into_iter().map(|((column, top), fill)| ((row(top), column), fill)).collect()
}

#[test]
fn reflected_light_is_grey_and_does_not_swamp_the_luminescence() {
    let svg = drawn(&orange(|_| ())).figures[0].to_svg();
    let cells = cells(&svg, (49, 41));
    assert_eq!(cells.len(), 49 * 41);
    // 480 nm excites most, radiated at 610 nm; 700 nm is reflected.
    let (glow, mirror) = (cells[&(18, 23)], cells[&(40, 32)]);
    assert!(mirror[RED] == mirror[BLUE] && mirror[RED] < 60, "{mirror:?}");
    assert_eq!(glow, [0x67, 0x00, 0x1f], "the scale ends at the strongest luminescence, not at what is reflected");
}

#[test]
fn a_negative_value_is_seen_as_negative_and_a_missing_one_as_missing() {
    let measurement = orange(|values| {
        values[(45, 3)] = -0.002;
        values[(45, 6)] = 0.002;
        values[(5, 20)] = f64::NAN;
    });
    let svg = drawn(&measurement).figures[0].to_svg();
    let cells = cells(&svg, (49, 41));
    assert!(cells[&(45, 3)][BLUE] > cells[&(45, 3)][RED] + 10, "{:?}", cells[&(45, 3)]);
    assert!(cells[&(45, 6)][RED] > cells[&(45, 6)][BLUE] + 10, "{:?}", cells[&(45, 6)]);
    assert!(!cells.contains_key(&(5, 20)) && cells.len() == 49 * 41 - 1);
    assert!(svg.contains("no value") && svg.contains("1 without value"));
    assert!(!drawn(&orange(|_| ())).figures[0].to_svg().contains("no value"));
}

#[test]
fn what_lies_behind_the_wall_is_drawn_before_it_and_what_stands_before_it_after() {
    let svg = drawn(&orange(|values| values.slice_mut(ndarray::s![46..48, 0..2]).fill(0.1))).figures[1].to_svg();
    let paths: Vec<&str> = svg.split("<path ").skip(1).collect();
    let wall = paths.iter().position(|path| path.contains("fill-opacity=\"0.5\"")).unwrap();
    let is_deep = |path: &&str| {
        let fill = path
            .split("fill=\"#")
            .nth(1)
            .and_then(|fill| u32::from_str_radix(&fill[..6], 16).ok())
            .unwrap_or(0xff_ffff);
        let [_, red, green, blue] = fill.to_be_bytes();
        red > 90 && green < 140 && blue < 140 && red > green + 20
    };
    let (behind, before) =
        (paths[..wall].iter().filter(|p| is_deep(p)).count(), paths[wall..].iter().filter(|p| is_deep(p)).count());
    assert!((1..=9).contains(&behind), "the spike below the excitation: {behind}");
    assert!(before > 20, "the luminescence: {before}");
}

#[test]
fn captions_say_what_the_picture_shows_and_pages_name_pictures_by_them() {
    let mut document = matrices::document();
    let pictures = Pictures::of(&document);
    let names: Vec<&str> = pictures.figures().map(|figure| figure.name()).collect();
    assert_eq!(names, ["orange-bispectral-map", "orange-bispectral-surface"]);
    for figure in pictures.figures() {
        assert!(figure.caption().contains("excitation 480 nm and emission 610 nm"), "{}", figure.caption());
    }
    let html = page(&document, &pictures);
    assert!(html.contains("aria-labelledby=\"caption-orange-bispectral-map\""));
    assert!(html.contains("<figcaption id=\"caption-orange-bispectral-map\">"));
    let outlined = pictures.figures().next().unwrap().to_svg_outlined().unwrap();
    assert!(outlined.contains("aria-label=\"orange: Donaldson matrix over excitation"), "{}", &outlined[..300]);
    // With the parts beside the matrix, its luminescence and its factors are drawn as well.
    let matrix = Matrix::of(&document.measurements[0]).unwrap();
    let separated = separate(&matrix, Separate::default()).unwrap();
    let parts = parts(&document.measurements[0], &matrix, &separated, "").unwrap();
    document.measurements.extend([parts.elastic, parts.luminescent]);
    document.factorisations.push(parts.factorisation);
    let pictures = Pictures::of(&document);
    let html = page(&document, &pictures);
    for figure in ["orange-luminescent-bispectral-map", "orange-factors-spectra", "orange-elastic-spectrum"] {
        assert!(html.contains(&format!("id=\"figure-{figure}\"")), "{figure}");
    }
    let luminescent = pictures.figures().find(|figure| figure.name() == "orange-luminescent-bispectral-map").unwrap();
    let svg = luminescent.to_svg();
    assert!(svg.contains(">interpolated<") && !svg.contains("next to the diagonal"));
}

#[test]
fn tiny_and_awkward_matrices_are_drawn_or_the_reason_is_given() {
    let made = |excitation: &[f64], emission: &[f64], at: fn((usize, usize)) -> f64| {
        let values = Array2::from_shape_fn((excitation.len(), emission.len()), at);
        drawn(&matrices::measurement("m", excitation, emission, values, None, None))
    };
    let nan = |_: (usize, usize)| f64::NAN;
    // One cell of reflected light, one of luminescence, one row, one column.
    let small = [
        made(&[500.0], &[500.0], |_| 0.5),
        made(&[400.0], &[500.0], |_| 0.01),
        made(&[400.0], &[400.0, 410.0, 420.0, 430.0], |(_, j)| 0.1 * j as f64),
        made(&[300.0, 400.0, 420.0], &[500.0], |(i, _)| 0.1 * i as f64),
        made(&[500.0], &[500.0], |_| 0.0),
    ];
    for drawn in &small {
        assert_eq!(names(drawn), ["m-bispectral-map"], "{:?}", drawn.not_drawn);
        assert!(drawn.not_drawn[0].contains("its surface"), "{:?}", drawn.not_drawn);
        decoded(&drawn.figures[0]);
    }
    let axis = matrices::axis(400.0, 500.0, 10.0);
    let empty = made(&axis, &axis, nan);
    assert!(names(&empty).is_empty() && empty.not_drawn.len() == 2, "{:?}", empty.not_drawn);
    let whole = [
        made(&axis, &axis, |at| if at == (0, 8) { 0.01 } else { f64::NAN }),
        made(&axis, &axis, |(i, j)| if i == j { 0.5 } else { f64::NAN }),
        made(&axis, &axis, |_| 0.0),
        made(&axis, &axis, |_| -1e-3),
        made(&axis, &axis, |(i, j)| if i == 0 && j == 9 { f64::INFINITY } else { 1e300 }),
        made(&[300.0, 365.0, 405.0], &matrices::axis(411.5, 700.0, 7.0), |(i, j)| 1e-3 * (i + j) as f64),
        made(&matrices::axis(600.0, 700.0, 10.0), &axis, |_| 1e-3),
    ];
    for drawn in &whole {
        assert_eq!(names(drawn), ["m-bispectral-map", "m-bispectral-surface"], "{:?}", drawn.not_drawn);
        for figure in &drawn.figures {
            decoded(figure);
            assert!(!figure.to_svg().contains("NaN") && !figure.to_svg().contains("inf"), "{}", figure.name());
        }
    }
    let backwards = made(&[300.0, 310.0], &[500.0, 510.0], |_| 0.1);
    assert_eq!(names(&backwards).len(), 2);
}

#[test]
fn a_matrix_of_two_hundred_thousand_cells_is_drawn_in_blocks_that_say_so() {
    let (excitation, emission, values) = matrices::values(1.0);
    let drawn = drawn(&matrices::measurement("fine", &excitation, &emission, values, None, None));
    let svg = drawn.figures[0].to_svg();
    assert!(svg.contains("drawn in blocks of 4 x 3") && svg.len() < 6_000_000, "{}", svg.len());
    let rectangles = svg.matches("<rect ").count();
    assert!((121 * 134..121 * 134 + 400).contains(&rectangles), "{rectangles}");
}

#[test]
fn the_real_matrices_are_drawn() {
    for measurement in matrices::real() {
        let drawn = drawn(&measurement);
        assert_eq!((drawn.figures.len(), drawn.not_drawn.len()), (2, 0), "{}: {:?}", measurement.id, drawn.not_drawn);
        drawn.figures.iter().for_each(|figure| assert!(super::different_colours(&decoded(figure).2) > 100));
    }
}
