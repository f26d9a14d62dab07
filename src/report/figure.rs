//! A finished drawing, and its two forms.

use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;

use super::ReportError;
use super::html::escaped;

/// Pixels of the PNG per unit of the drawing.
const PIXELS_PER_UNIT: f32 = 2.0;

/// A finished drawing with its name and a sentence about it.
#[derive(Debug)]
pub struct Figure {
    name: String,
    caption: String,
    scene: Scene,
}

impl Figure {
    pub(super) fn new(name: &str, caption: String, scene: Scene) -> Self {
        Self { name: name.to_owned(), caption, scene }
    }

    /// The name, fit for a file: ASCII letters, digits and `-`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The same figure under a name that starts with `prefix`.
    #[must_use]
    pub fn prefixed(mut self, prefix: &str) -> Self {
        self.name = format!("{prefix}-{}", self.name);
        self
    }

    /// The same figure with one more sentence in its caption.
    pub(super) fn noted(mut self, sentence: &str) -> Self {
        self.caption = format!("{} {sentence}", self.caption);
        self
    }

    /// What the figure shows, a sentence or two.
    #[must_use]
    pub fn caption(&self) -> &str {
        &self.caption
    }

    /// The figure as SVG for a page, whose reader has fonts: small, and it scales with the space it is given.
    #[must_use]
    pub fn to_svg(&self) -> String {
        self.svg(SvgBackend::new())
    }

    /// The figure as SVG with its text as outlines: the same picture on a machine without fonts.
    ///
    /// # Errors
    /// [`ReportError::Svg`] when the drawing cannot be converted.
    pub fn to_svg_outlined(&self) -> Result<String, ReportError> {
        let mut options = usvg::Options { font_family: "DejaVu Sans".to_owned(), ..usvg::Options::default() };
        let fonts = options.fontdb_mut();
        fonts.load_font_data(dejavu::sans::regular().to_vec());
        fonts.load_font_data(dejavu::sans::bold().to_vec());
        let tree = usvg::Tree::from_str(&self.to_svg(), &options)
            .map_err(|error| ReportError::Svg { figure: self.name.clone(), reason: error.to_string() })?;
        let short = usvg::WriteOptions { coordinates_precision: 2, ..usvg::WriteOptions::default() };
        // The converter leaves roles out; a file that stands alone has its caption as its name.
        let named = format!("<svg role=\"img\" aria-label=\"{}\" ", escaped(&self.caption));
        Ok(tree.to_string(&short).replacen("<svg ", &named, 1))
    }

    /// The figure as PNG, with two pixels per unit of the SVG. No font of the system is used.
    ///
    /// # Errors
    /// [`ReportError::Png`] when it cannot be encoded.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        kuva::PngBackend::new()
            .with_scale(PIXELS_PER_UNIT)
            .render_scene(&self.scene)
            .map_err(|reason| ReportError::Png { figure: self.name.clone(), reason })
    }

    fn svg(&self, backend: SvgBackend) -> String {
        let (width, height) = (self.scene.width, self.scene.height);
        // The backend writes a fixed size only; with a view box a page can scale the figure.
        let opening = format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" ");
        let svg = backend.render_scene(&self.scene).replacen("<svg ", &opening, 1);
        // Neighbouring cells end on the same pixel: without this a light line stands between them at most sizes.
        svg.replace("<rect ", "<rect shape-rendering=\"crispEdges\" ")
    }
}
