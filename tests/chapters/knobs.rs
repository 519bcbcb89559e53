//! Every knob of every variant: turning it changes the picture, and both ends of its range can be drawn.

use rasterbook::figure::{Given, Kind, Knob, Scene, Value, Variant};
use rasterbook::{Color, Framebuffer};
use rayon::prelude::*;

use crate::chapters::{smaller, variants};

/// The picture of a size, with knobs at values.
fn with(variant: &Variant, size: (u32, u32), values: &[(&Knob, Value)]) -> Framebuffer {
    let mut scene = Scene::new(variant, &Given::default()).expect("its own model");
    scene.size = size;
    for (knob, value) in values {
        scene.knobs.put(knob.name, *value);
    }
    scene.draw()
}

/// Whether turning a knob changes the picture, when others stand at these values. A smaller picture is asked first.
fn changes(variant: &Variant, knob: &Knob, others: &[(&Knob, Value)]) -> bool {
    let changes = |size| {
        let before = with(variant, size, others);
        let mut values = values(variant, knob).into_iter();
        values.any(|value| with(variant, size, &[others, &[(knob, value)]].concat()) != before)
    };
    changes(smaller(variant, 4)) || changes(variant.size)
}

/// Values that a knob can have, both ends of its range among them.
fn values(variant: &Variant, knob: &Knob) -> Vec<Value> {
    let (width, height) = (f64::from(variant.size.0), f64::from(variant.size.1));
    match (knob.kind, knob.default()) {
        (Kind::Point(_), Value::Point(point)) => {
            let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
            let moved = Value::Point((point + glam::dvec2(31.0, 17.0)).min(glam::dvec2(width, height)));
            corners.iter().map(|&corner| Value::Point(corner.into())).chain([moved]).collect()
        }
        (Kind::Color(_), _) => [Color::BLACK, Color::WHITE].map(Value::Color).to_vec(),
        (Kind::Choice(names), _) => (0..names.len()).map(Value::Choice).collect(),
        _ => [0.0, 0.37, 1.0].into_iter().filter_map(|fraction| knob.at(fraction)).collect(),
    }
}

#[test]
fn every_knob_changes_its_picture_over_its_whole_range() {
    let variants: Vec<_> = variants().filter(|(_, variant)| !variant.knobs.is_empty()).collect();
    variants.par_iter().for_each(|(chapter, variant)| {
        for knob in variant.knobs {
            // It may be a lesson that one choice makes another knob idle: reversed z does so with the near plane.
            let choices = variant.knobs.iter().filter(|other| matches!(other.kind, Kind::Choice(_)));
            let is_idle = !changes(variant, knob, &[])
                && !choices
                    .flat_map(|other| values(variant, other).into_iter().map(move |value| (other, value)))
                    .any(|choice| changes(variant, knob, &[choice]));
            assert!(!is_idle, "{chapter} {}: '{}' changes nothing", variant.name, knob.name);
            assert!(!knob.watch.is_empty() && knob.name == knob.name.to_lowercase());
        }
    });
    let count: usize = variants.iter().map(|(_, variant)| variant.knobs.len()).sum();
    assert!(count >= 150, "{count} knobs");
}

#[test]
fn a_knob_reads_what_it_shows() {
    for (_, variant) in variants() {
        let mut scene = Scene::new(variant, &Given::default()).expect("its own model");
        for knob in variant.knobs {
            for value in values(variant, knob).into_iter().chain([knob.default()]) {
                let text = format!("{}={}", knob.name, knob.shown(value));
                scene.knobs.set(&text).unwrap_or_else(|error| panic!("{}: {error}", variant.name));
                let read = scene.knobs.iter().find(|(other, _)| other.name == knob.name).expect("is there").1;
                assert_eq!(read, value, "{} {text}", variant.name);
            }
        }
    }
}

#[test]
fn all_knobs_can_stand_at_their_ends_together() {
    let variants: Vec<_> = variants().collect();
    variants.par_iter().for_each(|(_, variant)| {
        let mut scene = Scene::new(variant, &Given::default()).expect("its own model");
        // Another size than its own, and small: there are many.
        scene.size = (97, 61);
        for fraction in [0.0, 1.0] {
            for knob in variant.knobs {
                let corner = [variant.size.0, variant.size.1].map(|side| f64::from(side) * fraction);
                scene.knobs.put(
                    knob.name,
                    knob.at(fraction).unwrap_or(match knob.default() {
                        Value::Point(_) => Value::Point(corner.into()),
                        other => other,
                    }),
                );
            }
            let picture = scene.draw();
            assert_eq!((picture.width(), picture.height()), (97, 61), "{}", variant.name);
        }
    });
}
