//! A finished drawing, and its two forms.

use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;

use super::ReportError;

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

    /// The figure as SVG with its font inside (about 1 MB): the same picture on a machine without fonts.
    #[must_use]
    pub fn to_svg_with_font(&self) -> String {
        self.svg(SvgBackend::new().with_embedded_font(true))
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
        backend.render_scene(&self.scene).replacen("<svg ", &opening, 1)
    }
}
