//! A gap in a spectrum is a gap, a mean is only drawn where it is one, and each figure says which numbers it shows.

use bbrf::dataset::{Document, Reduction, Role, reduce};
use bbrf::quantity::{EmissionAxis, Flag};
use bbrf::report::{CurveText, Pictures, Points, dots_and_curve, line_in_band, measurement_figures, page};

use super::scan;

/// The strokes of an SVG: paths that fill nothing, as lists of points.
fn strokes(svg: &str) -> Vec<Vec<(f64, f64)>> {
    let stroke = |path: &str| {
        let data = path.split("d=\"").nth(1).unwrap().split('"').next().unwrap();
        let numbers: Vec<f64> = data.split([' ', 'M', 'L', ',']).filter_map(|word| word.parse().ok()).collect();
        numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
    };
    let paths = svg.split("<path ").skip(1).map(|path| path.split('>').next().unwrap());
    paths.filter(|path| path.contains("fill=\"none\"")).map(stroke).collect()
}

fn text() -> CurveText {
    let empty = String::new;
    CurveText {
        name: "spectrum".to_owned(),
        title: "Sheet".to_owned(),
        subtitle: empty(),
        x: "nm".to_owned(),
        y: "1".to_owned(),
        caption: empty(),
    }
}

fn points(y: &[f64], error: f64) -> Points {
    Points {
        x: (0..y.len()).map(|k| 400.0 + 4.0 * k as f64).collect(),
        y: y.to_vec(),
        error: vec![error; y.len()],
        name: "mean".to_owned(),
        error_name: "band".to_owned(),
    }
}

/// Marks a value below detection in the first `rows` rows of a wavelength.
fn below_detection(document: &mut Document, column: usize, rows: usize) {
    let flags = &mut document.measurements[0].flags;
    (0..rows).for_each(|row| flags[(row, column)] |= Flag::BelowDetection.bit());
}

#[test]
fn a_line_ends_at_a_gap_and_a_single_value_is_a_point() {
    let gap = f64::NAN;
    let svg = line_in_band(&points(&[1.0, 2.0, gap, 3.0, gap, 2.0, 1.0, 2.0], 0.1), None, &text()).unwrap().to_svg();
    assert_eq!(strokes(&svg).iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
    assert_eq!(svg.matches("<circle ").count(), 1);
    let whole = line_in_band(&points(&[1.0, 2.0, 3.0], 0.1), None, &text()).unwrap().to_svg();
    assert_eq!((strokes(&whole).len(), whole.matches("<circle ").count()), (1, 0));
}

#[test]
fn a_band_stays_within_its_frame() {
    let mut wide = points(&[1.0, 1.1, 1.0, 1.2, 1.0, 1.1], 0.01);
    wide.error[5] = 40.0;
    let svg = line_in_band(&wide, None, &text()).unwrap().to_svg();
    let band = svg.split("fill-opacity").next().unwrap().rsplit("d=\"").next().unwrap();
    let numbers: Vec<f64> =
        band.split('"').next().unwrap().split([' ', 'M', 'L', 'Z']).filter_map(|word| word.parse().ok()).collect();
    let heights: Vec<f64> = numbers.chunks_exact(2).map(|pair| pair[1]).collect();
    let extent = heights.iter().fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(*y), high.max(*y)));
    assert!(extent.0 >= 50.0 && extent.1 - extent.0 <= 320.01, "{extent:?}");
}

#[test]
fn an_error_bar_that_leaves_the_frame_has_an_arrow_and_a_legend() {
    let mut cut = points(&[1.0, 1.1, 1.0, 1.2, 1.0, 1.1], 0.01);
    let legend = "the error bar goes on beyond the frame";
    assert!(!dots_and_curve(&cut, None, &text()).unwrap().to_svg().contains(legend));
    cut.error[5] = 40.0;
    assert!(dots_and_curve(&cut, None, &text()).unwrap().to_svg().contains(legend));
}

#[test]
fn a_mean_is_not_drawn_where_the_low_values_are_missing_from_it() {
    let mut document = scan::document();
    below_detection(&mut document, 5, 40);
    below_detection(&mut document, 40, 3);
    let drawn = measurement_figures(&document, &document.measurements[0]);
    let (svg, caption) = (drawn.figures[0].to_svg(), drawn.figures[0].caption());
    // 3 of 272 rows are no reason for a gap, 40 are.
    assert_eq!(strokes(&svg).iter().map(Vec::len).collect::<Vec<_>>(), [5, 95]);
    assert!(caption.contains("1 of 101 wavelengths are left out"), "{caption}");
    assert!(svg.contains("gaps: 1 of 101 wavelengths"));
    (0..101).for_each(|column| below_detection(&mut document, column, 40 + column));
    document.measurements[0].flags.row_mut(271).fill(0);
    let drawn = measurement_figures(&document, &document.measurements[0]);
    assert!(drawn.figures.is_empty() && drawn.not_drawn[0].contains("its mean spectrum"), "{:?}", drawn.not_drawn);
}

#[test]
fn spectra_of_one_sample_are_told_apart() {
    let mut document = scan::document();
    let mut white = document.measurements[0].clone();
    (white.id, white.role) = (scan::id("white"), Role::White);
    document.measurements.push(white);
    let pictures = Pictures::of(&document);
    let html = page(&document, &pictures);
    for name in ["sample `factor`,", "white `white`,"] {
        assert!(pictures.figures().any(|figure| figure.to_svg().contains(name)), "{name}");
    }
    assert!(html.contains("<h3>sample `factor`, radiance factor</h3>"));
    assert!(html.contains("<h3>white `white`, radiance factor</h3>"));
}

/// The document with its model at each wavelength of the reduced data.
fn at_every_wavelength() -> Document {
    let mut document = scan::document();
    for column in 30..34 {
        below_detection(&mut document, column, 250);
        // No number is no bound: such a wavelength gets no model.
        (0..250).for_each(|row| document.measurements[0].values[(row, column)] = f64::NAN);
    }
    let reduced = reduce(&document, &document.measurements[0], Reduction::None).unwrap();
    let model = &mut document.models[0];
    model.reduction = reduced.reduction;
    model.emission = reduced.emission;
    model.terms.truncate(1);
    let albedo = &mut model.terms[0].parameters[0];
    albedo.value = vec![1.0; reduced.values.nrows()];
    albedo.standard_uncertainty = vec![0.01; reduced.values.nrows()];
    document
}

#[test]
fn a_model_of_every_wavelength_says_which_one_is_shown_and_has_gaps_where_it_has_none() {
    let document = at_every_wavelength();
    let pictures = Pictures::of(&document);
    let drawn = &pictures.models[0];
    let figure = |name: &str| drawn.figures.iter().find(|figure| figure.name().ends_with(name)).unwrap();
    for name in ["fit-map", "surface", "map-interpolated", "residual-map", "residual-histogram"] {
        let (svg, caption) = (figure(name).to_svg(), figure(name).caption());
        let nm = caption.split("Shown at ").nth(1).unwrap().split(' ').next().unwrap();
        assert!(svg.contains(nm), "{name}: {nm} nm");
        assert!(caption.contains("where the mean of the fitted values is largest; the model has 97"), "{caption}");
    }
    let histogram = figure("residual-histogram").to_svg();
    assert!(histogram.contains("r.m.s. residual at 5") && histogram.contains("of all 97 wavelengths"));
    let albedo = figure("lambertian-albedo").to_svg();
    assert_eq!(strokes(&albedo).iter().map(Vec::len).collect::<Vec<_>>(), [30, 67]);
    assert!(albedo.contains("fitted at 97 of 101 wavelengths"));
}

#[test]
fn a_model_over_another_axis_is_not_drawn_beside_the_data() {
    let mut document = at_every_wavelength();
    let EmissionAxis::Wavelengths(axis) = &mut document.models[0].emission else { unreachable!() };
    axis.nm.iter_mut().for_each(|nm| *nm += 1.0);
    let reasons = &Pictures::of(&document).models[0].not_drawn;
    assert!(
        reasons[0].contains("97 wavelengths from 381 to 781 nm") && reasons[0].contains("fit it again"),
        "{reasons:?}"
    );
}

#[test]
fn the_page_says_what_the_departures_are_relative_to_and_keeps_numbers_whole() {
    let document = scan::document();
    let html = page(&document, &Pictures::of(&document));
    for text in ["9.00 % of its amplitude", "5.00 % of its mean", "20.00 % of their r.m.s."] {
        assert!(html.contains(text), "{text}");
    }
    assert!(html.contains("<rect shape-rendering=\"crispEdges\" "));
    assert!(html.contains("td { overflow-wrap: break-word; }"));
}
