//! What a page is told of a figure, as JSON.

use rasterbook::figure::{Kind, Knob, RasterizerChoice, Value};
use rasterbook::live::{Live, View};
use serde_json::{Value as Json, json};

/// All that the page shows around the picture.
pub(crate) fn of(live: &Live<'_>) -> Json {
    let scene = live.scene();
    let variant = scene.variant;
    let knobs: Vec<Json> = scene.knobs.iter().map(|(knob, value)| of_knob(knob, value)).collect();
    let rasterizers = variant.rasterizer.map(|_| names(RasterizerChoice::ALL));
    let view = match live.view() {
        View::Itself => "itself",
        View::Remedy => "remedy",
        View::Difference => "difference",
        View::Overdraw => "overdraw",
    };
    json!({
        "variant": variant.name,
        "look": variant.look,
        "size": [variant.size.0, variant.size.1],
        "scales": !variant.in_pixels,
        "knobs": knobs,
        "remedy": live.remedy().map(|remedy| remedy.name),
        "view": view,
        "frame": scene.frame,
        "frames": variant.animation.map_or(1, |animation| animation.frames),
        "rate": live.rate(),
        "rasterizers": rasterizers,
        "rasterizer": scene.rasterizer.name(),
        "command": live.command(),
    })
}

fn names(choices: &[RasterizerChoice]) -> Vec<&'static str> {
    choices.iter().map(|choice| choice.name()).collect()
}

fn of_knob(knob: &Knob, value: Value) -> Json {
    let mut json = json!({
        "name": knob.name,
        "watch": knob.watch,
        "range": knob.range(),
        "value": knob.shown(value),
        "default": knob.shown(knob.default()),
    });
    let more = match knob.kind {
        Kind::Number { range: [low, high], unit, .. } => {
            // What an arrow key moves it by.
            let step = match (knob.stepped(Value::Number(low), 1), low) {
                (Value::Number(next), low) => next - low,
                _ => 0.0,
            };
            json!({ "kind": "number", "low": low, "high": high, "step": step, "unit": unit })
        }
        Kind::Whole { range: [low, high], unit, .. } => {
            json!({ "kind": "whole", "low": low, "high": high, "step": 1, "unit": unit })
        }
        Kind::Choice(names) => json!({ "kind": "choice", "names": names }),
        Kind::Switch(_) => json!({ "kind": "switch" }),
        Kind::Point(_) => json!({ "kind": "point" }),
        Kind::Color(_) => json!({ "kind": "color" }),
    };
    if let (Json::Object(all), Json::Object(more)) = (&mut json, more) {
        all.extend(more);
    }
    json
}
