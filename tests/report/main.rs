//! Figures and pages show what the document holds, gaps included, and nothing makes them panic.

#![allow(clippy::unwrap_used, reason = "a test may panic, also in its helpers")]

#[path = "../common/bispectral.rs"]
mod matrices;

mod bispectral;
mod gaps;
mod scan;

use bbrf::dataset::Derivation;
use bbrf::quantity::{Geometry, SignHabit};
use bbrf::report::{
    AngleMap, AnglePoints, CurveText, Drawn, Figure, Pictures, Points, ReportError, angle_map, dots_and_curve,
    fitted_figures, histogram, interpolated_map, line_in_band, measurement_figures, page, residual_map, surface,
};
use ndarray::Array2;

fn map() -> AngleMap {
    let points = scan::points();
    AngleMap::from_points(&points, &points.measured, "radiance factor", "1").unwrap()
}

fn names(drawn: &Drawn) -> Vec<&str> {
    drawn.figures.iter().map(Figure::name).collect()
}

/// Width, height and the pixels as RGBA.
fn decoded(figure: &Figure) -> (u32, u32, Vec<u8>) {
    let bytes = figure.to_png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    (info.width, info.height, pixels)
}

fn different_colours(pixels: &[u8]) -> usize {
    pixels.chunks_exact(4).collect::<std::collections::HashSet<_>>().len()
}

/// Cells of the map: rectangles of the size of one cell.
fn count_cells(svg: &str) -> usize {
    let side = 560.0 / 17.0 + 0.4;
    let is_cell = |rest: &&str| {
        let width = rest.split("width=\"").nth(1).and_then(|rest| rest.split('"').next());
        width.and_then(|width| width.parse::<f64>().ok()).is_some_and(|width| (width - side).abs() < 0.02)
    };
    svg.split("<rect ").filter(is_cell).count()
}

#[test]
fn a_map_has_its_gap_and_no_cell_too_many() {
    let map = map();
    assert_eq!(map.gaps(), (17, 0));
    let svg = angle_map(&map, "Sheet").unwrap().to_svg();
    assert_eq!(count_cells(&svg), 272);
    assert!(svg.contains("gap: retro direction, not measured by design"));
    assert!(!svg.contains("interpolated"), "nothing in the map of measured values is interpolated");
}

#[test]
fn what_is_interpolated_is_marked_and_its_corners_stay_empty() {
    let svg = interpolated_map(&map(), "Sheet").unwrap().to_svg();
    assert_eq!(count_cells(&svg), 272 + 15);
    assert!(svg.contains("interpolated, drawn and never fitted: 15 cells"));
    assert!(svg.contains("gap: retro direction"));
}

#[test]
fn a_surface_is_pale_where_it_leans_on_what_was_not_measured() {
    let svg = surface(&map(), "Sheet").unwrap().to_svg();
    // 16 x 16 facets and 16 + 16 pieces of the sides; at the two corners of the retro diagonal they have an open end.
    assert_eq!(svg.matches("<path ").count(), 254 + 30);
    assert!(svg.contains("leans on interpolated points") && svg.contains("never fitted"));
}

/// The area of each polygon of an SVG, in square units of the drawing.
fn areas(svg: &str) -> Vec<f64> {
    let area = |path: &str| {
        let data = path.split(" d=\"").nth(1).unwrap().split('"').next().unwrap();
        let numbers: Vec<f64> = data.split([' ', 'M', 'L', 'Z']).filter_map(|word| word.parse().ok()).collect();
        let points: Vec<(f64, f64)> = numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>().abs() / 2.0
    };
    svg.split("<path").skip(1).map(area).collect()
}

#[test]
fn a_peak_at_a_corner_has_a_face_and_a_tick_above_it() {
    for corner in [(16, 16), (0, 0)] {
        let mut map = map();
        map.values.fill(1.0);
        map.values[corner] = 1.3;
        let svg = surface(&map, "Sheet").unwrap().to_svg();
        // A face from the floor to the peak: half a cell's width across, and as high as the drawing.
        let largest = areas(&svg).into_iter().fold(0.0, f64::max);
        assert!(largest > 1500.0, "{corner:?}: {largest}");
        assert!(svg.contains(">1.30<") || svg.contains(">1.3<"), "the highest value has a tick");
    }
}

#[test]
fn a_missing_cell_is_told_apart_from_the_retro_gap() {
    let mut map = map();
    map.values[(3, 4)] = f64::NAN;
    assert_eq!(map.gaps(), (17, 1));
    let svg = angle_map(&map, "Sheet").unwrap().to_svg();
    assert_eq!(count_cells(&svg), 271);
    assert!(svg.contains("gap: no usable value"));
}

#[test]
fn figures_name_quantities_units_and_sample() {
    let document = scan::document();
    let drawn = fitted_figures(&document, &document.models[0], &scan::points());
    let all = [
        "sheet-fit-map",
        "sheet-fit-surface",
        "sheet-fit-map-interpolated",
        "sheet-fit-mean-over-viewing",
        "sheet-fit-mean-over-incidence",
        "sheet-fit-residual-map",
        "sheet-fit-residual-histogram",
    ];
    assert_eq!((names(&drawn), drawn.not_drawn.len()), (all.to_vec(), 0));
    let svg: Vec<String> = drawn.figures.iter().map(Figure::to_svg).collect();
    assert!(svg.iter().all(|svg| svg.contains("Fluorescence sheet, yellow (simulated)") && svg.contains("viewBox")));
    assert!(svg[0].contains("radiance factor, 500–620 nm (unit 1)"));
    assert!(svg[3].contains("incidence angle θᵢ (degrees, signed)") && svg[3].contains("fitted cosine"));
    assert!(svg[5].contains("(measured − predicted) / standard uncertainty"));
    assert!(drawn.figures.iter().all(|figure| !figure.caption().is_empty()));
}

#[test]
fn a_png_has_the_right_size_and_a_picture_on_it() {
    let (width, height, pixels) = decoded(&angle_map(&map(), "Sheet").unwrap());
    assert_eq!(width, 2 * 660);
    assert!(height > width && pixels.len() == 4 * width as usize * height as usize);
    assert!(different_colours(&pixels) > 100);
    // Text is drawn by a font that comes along: without it two titles would give the same picture.
    let other = decoded(&angle_map(&map(), "Paper").unwrap()).2;
    assert!(pixels != other);
}

#[test]
fn an_svg_for_a_machine_without_fonts_has_its_text_as_outlines() {
    let figure = angle_map(&map(), "Sheet").unwrap();
    let outlined = figure.to_svg_outlined().unwrap();
    assert!(!outlined.contains("<text") && figure.to_svg().contains("<text"));
    // The letters of another title are other outlines.
    let paths = |svg: &str| svg.matches("<path").count();
    let other = angle_map(&map(), "Fluorescence paper").unwrap().to_svg_outlined().unwrap();
    assert!(paths(&outlined) > 100 && outlined != other);
}

#[test]
fn a_spectrum_is_drawn_with_its_band() {
    let document = scan::document();
    let drawn = measurement_figures(&document, &document.measurements[0]);
    assert_eq!(names(&drawn), ["factor-spectrum"]);
    let svg = drawn.figures[0].to_svg();
    assert!(svg.contains("emission wavelength (nm)") && svg.contains("standard uncertainty of one value"));
}

#[test]
fn a_document_is_drawn_from_its_own_numbers() {
    let document = scan::document();
    let points = AnglePoints::of(&document, &document.models[0]).unwrap();
    assert_eq!((points.geometry.len(), points.measured.len(), points.predicted.len()), (272, 272, 272));
    let pictures = Pictures::of(&document);
    assert_eq!(pictures.figures().count(), 8);
    let mut broken = document.clone();
    broken.models[0].measurement = scan::id("nowhere");
    let pictures = Pictures::of(&broken);
    assert!(pictures.models[0].not_drawn[0].contains("`nowhere` is not in the document"));
}

#[test]
fn a_scan_without_a_model_is_drawn_and_what_is_not_drawn_has_its_reason() {
    let mut document = scan::document();
    document.models.clear();
    let pictures = Pictures::of(&document);
    let all = ["factor-map", "factor-surface", "factor-map-interpolated", "factor-spectrum"];
    assert_eq!(pictures.figures().map(Figure::name).collect::<Vec<_>>(), all);
    let svg = pictures.figures().next().unwrap().to_svg();
    assert_eq!(count_cells(&svg), 272);
    assert!(svg.contains("radiance factor, 3") || svg.contains("radiance factor, 4"), "the band is named");
    let html = page(&document, &pictures);
    assert!(html.contains("no model was fitted to it") && html.matches("<svg ").count() == 4);
    for acquisition in &mut document.measurements[0].acquisitions {
        acquisition.geometry = None;
    }
    let pictures = Pictures::of(&document);
    assert_eq!(pictures.figures().map(Figure::name).collect::<Vec<_>>(), ["factor-spectrum"]);
    let reason = &pictures.measurements[0].not_drawn[0];
    assert!(reason.contains("none of its 272 rows has a known geometry"), "{reason}");
    for acquisition in &mut document.measurements[0].acquisitions {
        acquisition.geometry = Geometry::from_signed(10.0, 20.0, SignHabit::MirrorAtEqual).ok();
    }
    let reason = &Pictures::of(&document).measurements[0].not_drawn[0];
    assert!(reason.contains("1 x 1 different angles"), "{reason}");
}

#[test]
fn a_radiance_from_which_a_factor_was_formed_is_shown_by_the_factor() {
    let mut document = scan::document();
    document.models.clear();
    let mut radiance = document.measurements[0].clone();
    radiance.id = scan::id("radiance");
    document.measurements[0].derivation = Some(Derivation {
        numerator: radiance.id.clone(),
        numerator_row: Vec::new(),
        reference: radiance.id.clone(),
        reference_group: Vec::new(),
        row_reference: Vec::new(),
        dark: None,
    });
    document.measurements.push(radiance);
    let drawn = &Pictures::of(&document).measurements[1];
    assert_eq!(names(drawn), ["radiance-spectrum"]);
    assert!(drawn.not_drawn[0].contains("see `factor`"), "{:?}", drawn.not_drawn);
}

#[test]
fn that_a_sample_is_simulated_is_said_once() {
    let mut document = scan::document();
    document.samples[0].title = Some("Simulated scan: yellow sheet".to_owned());
    let pictures = Pictures::of(&document);
    for svg in pictures.figures().map(Figure::to_svg) {
        assert!(svg.contains("Simulated scan: yellow sheet") && !svg.contains("(simulated)"));
    }
}

#[test]
fn the_page_is_whole_and_nothing_in_it_is_markup_of_the_file() {
    let document = scan::document();
    let html = page(&document, &Pictures::of(&document));
    assert!(html.starts_with("<!doctype html>") && html.trim_end().ends_with("</html>"));
    assert!(html.contains("Simulated scan of a &quot;yellow&quot; sheet &amp; its &lt;fit&gt;"));
    assert!(html.contains("8 nm &lt;unstated in the records&gt; [scan.csv, line 3]"));
    for text in ["1.01511", "0.00041", "0.50 %", "correlated (-0.98)", "quality code 18", "Simulated, not measured"] {
        assert!(html.contains(text), "{text}");
    }
    assert_eq!(html.matches("<svg ").count(), 8);
    assert!(!html.contains("<script") && !html.contains("href="), "self-contained");
}

#[test]
fn hostile_text_stays_text() {
    let mut document = scan::document();
    let hostile = "</text><script>alert(1)</script> $x$ \\$ \u{1b} ".repeat(9);
    document.title = Some(hostile.clone());
    document.samples[0].title = Some(hostile.clone());
    document.models[0].unit = hostile;
    let pictures = Pictures::of(&document);
    let html = page(&document, &pictures);
    assert!(!html.contains("<script") && !html.contains('\u{1b}'));
    for figure in pictures.figures() {
        figure.to_png().unwrap();
    }
}

#[test]
fn nothing_to_draw_is_an_error_that_says_so() {
    let mut points = scan::points();
    points.measured.fill(f64::NAN);
    let result = AngleMap::from_points(&points, &points.measured, "factor", "1");
    assert_eq!(result, Err(ReportError::Empty { figure: "factor".to_owned() }));
    let empty = AnglePoints::default();
    assert!(matches!(AngleMap::from_points(&empty, &[], "factor", "1"), Err(ReportError::Empty { .. })));
    let text = CurveText {
        name: "curve".to_owned(),
        title: String::new(),
        subtitle: String::new(),
        x: String::new(),
        y: String::new(),
        caption: String::new(),
    };
    assert!(matches!(histogram(&[f64::NAN], None, &text), Err(ReportError::Empty { .. })));
    let nothing = Points { x: vec![], y: vec![], error: vec![], name: String::new(), error_name: String::new() };
    assert!(matches!(dots_and_curve(&nothing, None, &text), Err(ReportError::Empty { .. })));
    let uneven = Points { x: vec![1.0], ..nothing };
    assert!(matches!(line_in_band(&uneven, None, &text), Err(ReportError::Lengths { .. })));
}

#[test]
fn one_point_makes_a_picture() {
    let geometry = vec![Geometry::from_signed(10.0, 20.0, SignHabit::MirrorAtEqual).unwrap()];
    for value in [0.0, 1.0, -1.0, 1e300, -1e-300] {
        let points = AnglePoints {
            geometry: geometry.clone(),
            measured: vec![value],
            sigma: vec![f64::NAN],
            predicted: vec![0.0],
            wavelength_nm: None,
        };
        let document = scan::document();
        let drawn = fitted_figures(&document, &document.models[0], &points);
        assert_eq!(drawn.figures.len(), 7, "{:?}", drawn.not_drawn);
        for figure in &drawn.figures {
            figure.to_png().unwrap();
        }
    }
}

#[test]
fn directions_out_of_the_plane_have_no_map_but_a_histogram() {
    let mut points = scan::points();
    points.geometry[5] = Geometry::from_degrees(10.0, 20.0, 30.0, 40.0).unwrap();
    let document = scan::document();
    let drawn = fitted_figures(&document, &document.models[0], &points);
    assert!(names(&drawn).contains(&"sheet-fit-residual-histogram"));
    assert!(drawn.not_drawn[0].contains("1 of 272 geometries leave the plane"), "{:?}", drawn.not_drawn);
}

#[test]
fn lists_that_do_not_belong_together_are_named() {
    let mut points = scan::points();
    points.predicted.pop();
    let document = scan::document();
    let drawn = fitted_figures(&document, &document.models[0], &points);
    assert!(drawn.not_drawn.iter().any(|reason| reason.contains("`predicted` has 271 entries; expected 272")));
}

#[test]
fn a_scatter_of_angles_is_refused_as_a_map() {
    let angle = |n: usize| n as f64 * 0.08;
    let geometry: Vec<Geometry> =
        (0..1000).map(|n| Geometry::from_signed(angle(n), angle(n), SignHabit::MirrorAtEqual).unwrap()).collect();
    let ones = vec![1.0; 1000];
    let points = AnglePoints {
        geometry,
        measured: ones.clone(),
        sigma: ones.clone(),
        predicted: ones.clone(),
        wavelength_nm: None,
    };
    assert!(matches!(AngleMap::from_points(&points, &ones, "factor", "1"), Err(ReportError::TooManyCells { .. })));
}

#[test]
fn a_table_of_the_wrong_shape_is_refused() {
    let wrong = AngleMap { values: Array2::zeros((2, 3)), ..map() };
    assert!(matches!(angle_map(&wrong, "Sheet"), Err(ReportError::Lengths { .. })));
    assert!(matches!(residual_map(&wrong, "Sheet"), Err(ReportError::Lengths { .. })));
}
