//! The models, as their data files state them.

use std::f64::consts::PI;

use super::dual::Dual;

/// The model of a data set at a row's predictors.
pub fn model(name: &str, b: &[Dual], x: &[f64]) -> Dual {
    let t = x[0];
    match name {
        "Bennett5" => b[0] * ((b[1] + t).ln() * (b[2].powf(-1.0) * -1.0)).exp(),
        "BoxBOD" | "Misra1a" => b[0] * ((-b[1] * t).exp() * -1.0 + 1.0),
        "Chwirut1" | "Chwirut2" => (-b[0] * t).exp() / (b[1] + b[2] * t),
        "DanWood" => b[0] * (b[1] * t.ln()).exp(),
        "ENSO" => {
            let yearly = 2.0 * PI * t / 12.0;
            let wave = |period: Dual, c: Dual, s: Dual| {
                let angle = period.powf(-1.0) * (2.0 * PI * t);
                c * angle.cos() + s * angle.sin()
            };
            b[0] + b[1] * yearly.cos() + b[2] * yearly.sin() + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8])
        }
        "Eckerle4" => {
            let z = (-b[2] + t) / b[1];
            b[0] / b[1] * (z * z * -0.5).exp()
        }
        "Gauss1" | "Gauss2" | "Gauss3" => {
            let peak = |height: Dual, centre: Dual, width: Dual| {
                let z = (-centre + t) / width;
                height * (-(z * z)).exp()
            };
            b[0] * (-b[1] * t).exp() + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
        }
        "Hahn1" | "Thurber" => {
            let above = b[0] + b[1] * t + b[2] * (t * t) + b[3] * (t * t * t);
            above / (b[4] * t + b[5] * (t * t) + b[6] * (t * t * t) + 1.0)
        }
        "Kirby2" => (b[0] + b[1] * t + b[2] * (t * t)) / (b[3] * t + b[4] * (t * t) + 1.0),
        "Lanczos1" | "Lanczos2" | "Lanczos3" => {
            b[0] * (-b[1] * t).exp() + b[2] * (-b[3] * t).exp() + b[4] * (-b[5] * t).exp()
        }
        "MGH09" => b[0] * (b[1] * t + t * t) / (b[2] * t + b[3] + t * t),
        "MGH10" => b[0] * (b[1] / (b[2] + t)).exp(),
        "MGH17" => b[0] + b[1] * (-b[3] * t).exp() + b[2] * (-b[4] * t).exp(),
        "Misra1b" => b[0] * ((b[1] * (t / 2.0) + 1.0).powf(-2.0) * -1.0 + 1.0),
        "Misra1c" => b[0] * ((b[1] * (2.0 * t) + 1.0).powf(-0.5) * -1.0 + 1.0),
        "Misra1d" => b[0] * b[1] * t / (b[1] * t + 1.0),
        "Nelson" => b[0] - b[1] * t * (-b[2] * x[1]).exp(),
        "Rat42" => b[0] / ((b[1] - b[2] * t).exp() + 1.0),
        "Rat43" => b[0] * (((b[1] - b[2] * t).exp() + 1.0).ln() * (b[3].powf(-1.0) * -1.0)).exp(),
        "Roszman1" => b[0] - b[1] * t - (b[2] / (-b[3] + t)).atan() / PI,
        other => panic!("no model for {other}"),
    }
}

/// The response as the model has it.
pub fn response(name: &str, y: f64) -> f64 {
    if name == "Nelson" { y.ln() } else { y }
}
