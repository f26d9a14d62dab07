//! Daylight of a correlated colour temperature, and the older illuminant C: the tables that the standard gives from 300 nm.

/// First wavelength of both tables, nm.
pub(super) const START_NM: f64 = 300.0;
/// Step of the components, nm. Between them the standard interpolates linearly.
pub(super) const DAYLIGHT_STEP_NM: f64 = 10.0;
/// Step of illuminant C, nm.
pub(super) const C_STEP_NM: f64 = 5.0;

/// The relative spectral power of daylight on the grid of its components, by CIE 15:2018, 4.1.2; `hundreds` names it, as 65 does
/// D65. `None` outside 4000 to 25000 K.
pub(super) fn daylight(hundreds: u32) -> Option<Vec<f64>> {
    let nominal = 100.0 * f64::from(hundreds);
    if !(4000.0..=25_000.0).contains(&nominal) {
        return None;
    }
    // The names are older than the present value of c2.
    let t = nominal * 1.4388 / 1.4380;
    let x = if t <= 7000.0 {
        0.244_063 + 0.099_11e3 / t + 2.967_8e6 / t.powi(2) - 4.607_0e9 / t.powi(3)
    } else {
        0.237_040 + 0.247_48e3 / t + 1.901_8e6 / t.powi(2) - 2.006_4e9 / t.powi(3)
    };
    let y = -3.0 * x * x + 2.87 * x - 0.275;
    // The standard rounds both, and its tables are made so.
    let rounded = |m: f64| (1000.0 * m).round() / 1000.0;
    let m = 0.0241 + 0.2562 * x - 0.7341 * y;
    let m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
    let m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / m);
    Some(COMPONENTS.iter().map(|[s0, s1, s2]| s0 + m1 * s1 + m2 * s2).collect())
}

/// S0, S1, S2 of daylight from 300 to 830 nm (CIE 15:2018, table of the components of the relative spectral distribution of
/// daylight).
#[rustfmt::skip]
const COMPONENTS: [[f64; 3]; 54] = [
    [0.04, 0.02, 0.0],
    [6.0, 4.5, 2.0],
    [29.6, 22.4, 4.0],
    [55.3, 42.0, 8.5],
    [57.3, 40.6, 7.8],
    [61.8, 41.6, 6.7],
    [61.5, 38.0, 5.3],
    [68.8, 42.4, 6.1],
    [63.4, 38.5, 3.0],
    [65.8, 35.0, 1.2],
    [94.8, 43.4, -1.1],
    [104.8, 46.3, -0.5],
    [105.9, 43.9, -0.7],
    [96.8, 37.1, -1.2],
    [113.9, 36.7, -2.6],
    [125.6, 35.9, -2.9],
    [125.5, 32.6, -2.8],
    [121.3, 27.9, -2.6],
    [121.3, 24.3, -2.6],
    [113.5, 20.1, -1.8],
    [113.1, 16.2, -1.5],
    [110.8, 13.2, -1.3],
    [106.5, 8.6, -1.2],
    [108.8, 6.1, -1.0],
    [105.3, 4.2, -0.5],
    [104.4, 1.9, -0.3],
    [100.0, 0.0, 0.0],
    [96.0, -1.6, 0.2],
    [95.1, -3.5, 0.5],
    [89.1, -3.5, 2.1],
    [90.5, -5.8, 3.2],
    [90.3, -7.2, 4.1],
    [88.4, -8.6, 4.7],
    [84.0, -9.5, 5.1],
    [85.1, -10.9, 6.7],
    [81.9, -10.7, 7.3],
    [82.6, -12.0, 8.6],
    [84.9, -14.0, 9.8],
    [81.3, -13.6, 10.2],
    [71.9, -12.0, 8.3],
    [74.3, -13.3, 9.6],
    [76.4, -12.9, 8.5],
    [63.3, -10.6, 7.0],
    [71.7, -11.6, 7.6],
    [77.0, -12.2, 8.0],
    [65.2, -10.2, 6.7],
    [47.7, -7.8, 5.2],
    [68.6, -11.2, 7.4],
    [65.0, -10.4, 6.8],
    [66.0, -10.6, 7.0],
    [61.0, -9.7, 6.4],
    [53.3, -8.3, 5.5],
    [58.9, -9.3, 6.1],
    [61.9, -9.8, 6.5],
];

/// Illuminant C from 300 to 780 nm (CIE 15:2004, table T.1).
#[rustfmt::skip]
pub(super) const C: [f64; 97] = [
    0.0, 0.0, 0.0, 0.0, 0.01, 0.2, 0.4, 1.55, 2.7, 4.85, 7.0, 9.95, 12.9, 17.2, 21.4, 27.5, 33.0, 39.92, 47.4, 55.17,
    63.3, 71.81, 80.6, 89.53, 98.1, 105.8, 112.4, 117.75, 121.5, 123.45, 124.0, 123.6, 123.1, 123.3, 123.8, 124.09,
    123.9, 122.92, 120.7, 116.9, 112.1, 106.98, 102.3, 98.81, 96.9, 96.78, 98.0, 99.94, 102.1, 103.95, 105.2, 105.67,
    105.3, 104.11, 102.3, 100.15, 97.8, 95.43, 93.2, 91.22, 89.7, 88.83, 88.4, 88.19, 88.1, 88.06, 88.0, 87.86, 87.8,
    87.99, 88.2, 88.2, 87.9, 87.22, 86.3, 85.3, 84.0, 82.21, 80.2, 78.24, 76.3, 74.36, 72.4, 70.4, 68.3, 66.3, 64.4,
    62.8, 61.5, 60.2, 59.2, 58.5, 58.1, 58.0, 58.2, 58.5, 59.1,
];
