//! An EXR holds every layer and every wavelength to the last bit, by the names that spectral tools look for.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "common/layers.rs"]
mod layers;

use std::io::Cursor;

use bbrf::simulate::image::{Channel, Layer, Primaries, Radiance, spectral_channel, write_exr};
use exr::meta::attribute::AttributeValue;
use exr::prelude::{ReadChannels, ReadLayers, Text, read};
use layers::{SIZE, layers};

fn notes() -> Vec<(String, String)> {
    vec![("seed".to_owned(), "7".to_owned()), ("plan".to_owned(), "{\"ä\": 1}".to_owned())]
}

fn written(layers: &[Layer], primaries: Primaries) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write_exr(SIZE, layers, (primaries, Radiance::Absolute), &notes(), &mut bytes).unwrap();
    bytes.into_inner()
}

fn opened(bytes: &[u8]) -> exr::prelude::FlatImage {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    reader.from_buffered(Cursor::new(bytes)).unwrap()
}

#[test]
fn every_layer_comes_back_to_the_last_bit() {
    let layers = layers();
    let image = opened(&written(&layers, Primaries::Xyz));
    assert_eq!(image.layer_data.len(), layers.len());
    for (found, layer) in image.layer_data.iter().zip(&layers) {
        assert_eq!(found.attributes.layer_name, Some(Text::from(layer.name.as_str())));
        assert_eq!(found.channel_data.list.len(), layer.channels.len());
        for channel in &layer.channels {
            let same = |other: &&exr::prelude::AnyChannel<_>| other.name.to_string() == channel.name;
            let other = found.channel_data.list.iter().find(same).unwrap();
            let exr::prelude::FlatSamples::F32(values) = &other.sample_data else { unreachable!("not f32") };
            assert!(values.iter().zip(&channel.values).all(|(a, b)| a.to_bits() == b.to_bits()), "{}", channel.name);
        }
    }
}

#[test]
fn spectral_layers_have_the_attributes_of_the_layout_and_others_do_not() {
    let image = opened(&written(&layers(), Primaries::Srgb));
    let text = |value: &str| Some(AttributeValue::Text(Text::from(value)));
    let version = Text::from("spectralLayoutVersion");
    // The reader has every part's attributes in the layer.
    for layer in &image.layer_data {
        assert_eq!(layer.attributes.other.get(&version).cloned(), text("1.0"));
    }
    let units = |k: usize| image.layer_data[k].attributes.other.get(&Text::from("emissiveUnits")).cloned();
    assert_eq!([units(0), units(1), units(2)], [text("W.m^-2.sr^-1"), text("W.m^-2.sr^-1"), None]);
    let without = opened(&written(&layers()[2..], Primaries::Srgb));
    assert_eq!(without.layer_data[0].attributes.other.get(&version), None);
}

#[test]
fn channels_are_named_as_the_public_tools_name_them() {
    assert_eq!(spectral_channel(550.0), "S0.550,000000nm");
    assert_eq!(spectral_channel(555.5), "S0.555,500000nm");
}

#[test]
fn what_red_green_and_blue_are_is_told() {
    let of = |primaries| opened(&written(&layers(), primaries)).attributes.chromaticities.unwrap();
    assert_eq!((of(Primaries::Xyz).red.0, of(Primaries::Xyz).green.1), (1.0, 1.0));
    assert_eq!((of(Primaries::Srgb).red.0, of(Primaries::Srgb).white.1), (0.64, 0.329));
}

#[test]
fn notes_are_json_and_come_back() {
    let image = opened(&written(&layers(), Primaries::Xyz));
    let comments = image.layer_data[0].attributes.comments.clone().unwrap().to_string();
    let found: serde_json::Value = serde_json::from_str(&comments).unwrap();
    assert_eq!(found, serde_json::json!({"seed": "7", "plan": "{\"ä\": 1}"}));
}

#[test]
fn the_same_layers_give_the_same_bytes_with_any_number_of_threads() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let first = pool(1).install(|| written(&layers(), Primaries::Xyz));
    for threads in [1, 2, 5, 8] {
        for _ in 0..5 {
            assert!(first == pool(threads).install(|| written(&layers(), Primaries::Xyz)), "{threads} threads");
        }
    }
}

#[test]
fn what_is_no_image_is_refused_with_the_layer_and_the_channel() {
    let refused = |layers: &[Layer]| {
        write_exr(SIZE, layers, (Primaries::Xyz, Radiance::Absolute), &[], Cursor::new(Vec::new()))
            .unwrap_err()
            .to_string()
    };
    let channel = |name: &str, count: usize| Channel { name: name.to_owned(), values: vec![0.0; count] };
    let layer = |name: &str, channels: Vec<Channel>| Layer { name: name.to_owned(), channels };
    let all = SIZE.0 * SIZE.1;
    let short = refused(&[layer("total", vec![channel("R", all), channel("G", 5)])]);
    assert!(
        short.contains("`G`") && short.contains("`total`") && short.contains("has 5 values; expected 777"),
        "{short}"
    );
    assert!(refused(&[]).contains("0 layers"));
    assert!(refused(&[layer("total", Vec::new())]).contains("`total` without a channel"));
    let twice = layer("total", vec![channel("R", all)]);
    assert!(refused(&[twice.clone(), twice]).contains("second layer named `total`"));
    assert!(refused(&[layer("", vec![channel("R", all)])]).contains("layer named ``"));
    assert!(refused(&[layer("a", vec![channel("ä", all)])]).contains("`ä`"));
}
