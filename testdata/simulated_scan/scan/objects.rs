//! The twelve objects of Tominaga, Hirai and Horiuchi and a matte white, as made-up numbers.

/// A surface: diffuse reflection with an absorption edge, one luminescence band, and an interface.
#[derive(Debug)]
pub(crate) struct Object {
    /// Name of its folder.
    pub(crate) name: &'static str,
    /// Title in the manifest.
    pub(crate) title: &'static str,
    /// Diffuse reflectance far below and far above the edge.
    pub(crate) reflectance: (f64, f64),
    /// Where the edge is and how wide, nm.
    pub(crate) edge_nm: (f64, f64),
    /// Peak of the emission and its half widths at half height below and above, nm.
    pub(crate) emission_nm: (f64, f64, f64),
    /// Centre of the excitation band and its half width at half height, nm.
    pub(crate) excitation_nm: (f64, f64),
    /// Share of the energy falling in at the centre of the excitation band that is radiated again.
    pub(crate) yield_at_centre: f64,
    /// Specular intensity c_s, dimensionless.
    pub(crate) intensity: f64,
    /// Roughness: half width at half height of D, rad (`gaussian-half-height`).
    pub(crate) roughness: f64,
    /// Refractive index of the interface.
    pub(crate) refractive_index: f64,
}

/// One line per object: reflectance, edge, emission, excitation, yield, intensity, roughness, index.
#[rustfmt::skip]
pub(crate) const OBJECTS: [Object; 13] = [
    object("color-board-yellow", "Color board, yellow", (0.06, 0.82), (505.0, 11.0), (524.0, 15.0, 36.0), (440.0, 45.0), 0.55, 1.2, 0.16, 1.50),
    object("sticker-green", "Sticker, green", (0.07, 0.16), (640.0, 30.0), (514.0, 14.0, 30.0), (435.0, 48.0), 0.60, 4.0, 0.08, 1.50),
    object("paint-red", "Paint, red", (0.04, 0.76), (590.0, 10.0), (606.0, 15.0, 30.0), (530.0, 60.0), 0.50, 0.6, 0.28, 1.50),
    object("fluorescence-paper-red", "Fluorescence paper, red", (0.08, 0.78), (585.0, 12.0), (602.0, 16.0, 32.0), (520.0, 65.0), 0.48, 0.25, 0.40, 1.48),
    object("fluorescence-paper-green", "Fluorescence paper, green", (0.12, 0.35), (530.0, 25.0), (516.0, 14.0, 32.0), (440.0, 46.0), 0.62, 0.25, 0.40, 1.48),
    object("fluorescence-paper-yellow", "Fluorescence paper, yellow", (0.10, 0.84), (500.0, 10.0), (520.0, 15.0, 36.0), (438.0, 45.0), 0.58, 0.25, 0.40, 1.48),
    object("fluorescence-sheet-red", "Fluorescence sheet, red", (0.05, 0.74), (590.0, 11.0), (608.0, 15.0, 30.0), (525.0, 62.0), 0.52, 2.2, 0.10, 1.49),
    object("fluorescence-sheet-green", "Fluorescence sheet, green", (0.06, 0.22), (560.0, 30.0), (512.0, 13.0, 30.0), (435.0, 47.0), 0.64, 2.2, 0.10, 1.49),
    object("fluorescence-sheet-yellow", "Fluorescence sheet, yellow", (0.07, 0.80), (508.0, 10.0), (526.0, 15.0, 36.0), (445.0, 45.0), 0.56, 2.0, 0.10, 1.45),
    object("fluorescence-tape-red", "Fluorescence tape, red", (0.05, 0.70), (592.0, 11.0), (610.0, 15.0, 31.0), (525.0, 60.0), 0.50, 9.0, 0.06, 1.52),
    object("fluorescence-tape-green", "Fluorescence tape, green", (0.06, 0.20), (560.0, 30.0), (514.0, 14.0, 30.0), (436.0, 46.0), 0.60, 9.0, 0.06, 1.52),
    object("fluorescence-tape-yellow", "Fluorescence tape, yellow", (0.07, 0.78), (506.0, 10.0), (524.0, 15.0, 35.0), (442.0, 45.0), 0.55, 9.0, 0.06, 1.52),
    object("matte-white", "Matte white (Spectralon-like)", (0.985, 0.985), (500.0, 10.0), (500.0, 20.0, 20.0), (400.0, 20.0), 0.0, 0.5, 0.45, 1.35),
];

#[expect(clippy::too_many_arguments, reason = "one line of the table per object")]
const fn object(
    name: &'static str,
    title: &'static str,
    reflectance: (f64, f64),
    edge_nm: (f64, f64),
    emission_nm: (f64, f64, f64),
    excitation_nm: (f64, f64),
    yield_at_centre: f64,
    intensity: f64,
    roughness: f64,
    refractive_index: f64,
) -> Object {
    Object {
        name,
        title,
        reflectance,
        edge_nm,
        emission_nm,
        excitation_nm,
        yield_at_centre,
        intensity,
        roughness,
        refractive_index,
    }
}

impl Object {
    /// Diffuse reflectance S_r at a wavelength: a logistic edge.
    pub(crate) fn reflectance_at(&self, nm: f64) -> f64 {
        let (low, high) = self.reflectance;
        let (centre, width) = self.edge_nm;
        low + (high - low) / (1.0 + (-(nm - centre) / width).exp())
    }

    /// Shape of the emission band, 1 at its peak.
    pub(crate) fn emission_at(&self, nm: f64) -> f64 {
        let (peak, below, above) = self.emission_nm;
        half_height_gaussian(nm - peak, if nm < peak { below } else { above })
    }

    /// Shape of the excitation band, 1 at its centre.
    pub(crate) fn excitation_at(&self, nm: f64) -> f64 {
        half_height_gaussian(nm - self.excitation_nm.0, self.excitation_nm.1)
    }
}

/// A Gaussian of height 1 by its half width at half height.
pub(crate) fn half_height_gaussian(x: f64, half_width: f64) -> f64 {
    (-std::f64::consts::LN_2 * (x / half_width) * (x / half_width)).exp()
}
