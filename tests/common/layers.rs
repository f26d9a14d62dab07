//! Layers of an image for the tests of EXR.
#![allow(dead_code, missing_docs)]

use bbrf::simulate::image::{Channel, Layer, spectral_channel};

pub(crate) const SIZE: (usize, usize) = (37, 21);

/// Numbers of every kind: the smallest, infinite ones and those of pixels.
fn plane(k: usize) -> Vec<f32> {
    let any = |i: usize| match i % 7 {
        0 => f32::MIN_POSITIVE / 8.0,
        1 => -0.0,
        2 => f32::MAX,
        _ => ((i * 2_654_435_761 + k * 97) % 10_007) as f32 / 1e4,
    };
    (0..SIZE.0 * SIZE.1).map(|i| any(i + k)).collect()
}

pub(crate) fn layers() -> Vec<Layer> {
    let channel = |name: String, k| Channel { name, values: plane(k) };
    let rgb = |first| ["R", "G", "B"].into_iter().enumerate().map(move |(k, name)| channel(name.to_owned(), first + k));
    let spectrum = [380.0, 550.0, 555.5, 1000.0];
    let spectral =
        |first| spectrum.into_iter().enumerate().map(move |(k, nm)| channel(spectral_channel(nm), first + k));
    vec![
        Layer { name: "total".to_owned(), channels: rgb(0).chain(spectral(3)).collect() },
        Layer { name: "luminescent".to_owned(), channels: rgb(10).chain(spectral(13)).collect() },
        Layer { name: "specular".to_owned(), channels: rgb(20).collect() },
    ]
}
