//! The histories of pixels: what is reported is what stands in the picture, and its numbers are those of the formulas.

use crate::chapters::{CHAPTERS, smaller, variant, variants};
use crate::sizes::GRID;
use rasterbook::figure::{DrawOptions, RasterizerChoice, Variant};
use rasterbook::inspect::{History, Steps, histories, history};
use rasterbook::{Color, Framebuffer, Pixel};
use rayon::prelude::*;
use serde_json::Value;

/// Variants that show another buffer at the end than the one that was drawn into last.
const OTHER_BUFFER: &[&str] = &["presented", "double-buffer"];

fn of(chapter: &'static str, variant: &Variant, pixel: Pixel) -> History {
    let subject = variant.subject().expect("assets");
    history(chapter, variant, &variant.options(subject.as_ref()), pixel)
}

/// Pixels all over a picture: a grid of odd steps, the corners, and the middle of each side.
fn pixels((width, height): (u32, u32)) -> Vec<Pixel> {
    let (right, top) = (width as i32 - 1, height as i32 - 1);
    let mut pixels = vec![(0, 0), (right, 0), (0, top), (right, top), (right / 2, 0), (0, top / 2), (100, 0)];
    for row in 0..3 {
        for column in 0..3 {
            pixels.push((right * (2 * column + 1) / 6, top * (2 * row + 1) / 6));
        }
    }
    pixels
}

#[test]
fn what_is_reported_is_what_stands_in_the_picture_and_no_event_is_unknown() {
    let rows: Vec<_> = variants().collect();
    rows.par_iter().for_each(|&(chapter, variant)| {
        let subject = variant.subject().expect("assets");
        let own = DrawOptions { size: smaller(variant, 4), ..variant.options(subject.as_ref()) };
        let both = [RasterizerChoice::Scanline, RasterizerChoice::Exact];
        let choices = variant.rasterizer.map_or(vec![own.rasterizer], |_| both.to_vec());
        for rasterizer in choices {
            let options = DrawOptions { rasterizer, ..own.clone() };
            for history in histories(chapter, variant, &options, pixels(options.size)) {
                check(&history, variant);
            }
        }
    });
}

/// What the outline of a clipped triangle is drawn in.
const OUTLINE: Color = Color::rgb(255, 220, 60);

#[test]
fn steps_lead_to_the_picture() {
    let rows: Vec<_> = variants().filter(|(_, variant)| !OTHER_BUFFER.contains(&variant.name)).collect();
    let with_outlines: usize = rows
        .par_iter()
        .map(|&(chapter, variant)| {
            let subject = variant.subject().expect("assets");
            let own = variant.options(subject.as_ref());
            let options = DrawOptions { size: smaller(variant, 4), ..own };
            let steps = Steps::new(variant, &options).expect("a small picture");
            // After the last step the finished picture stays for a second.
            let count = steps.animation().frames - steps.animation().rate;
            let last = steps.frame(count - 1);
            let picture = variant.draw(&options);
            // The finished picture has lines between enlarged pixels, and no step.
            let both = last.rows_from_top().flatten().zip(picture.rows_from_top().flatten());
            let differing = both.filter(|(step, end)| step != end && **end != GRID).count();
            assert_eq!(differing, 0, "{chapter} {}", variant.name);
            let has_outline = |number| steps.frame(number).rows_from_top().flatten().any(|&c| c == OUTLINE);
            usize::from(chapter == "ch09_pipeline" && (0..count).any(has_outline))
        })
        .sum();
    assert!(with_outlines > 0, "triangles are clipped in chapter 9");
}

#[test]
fn an_event_of_another_stage_is_called_unknown() {
    #[derive(Debug)]
    struct Elsewhere;
    fn draw(framebuffer: &mut Framebuffer) {
        let observer = framebuffer.observer().expect("it is observed");
        observer.begun(&Elsewhere);
        framebuffer.set(1, 1, Color::RED);
        observer.done();
    }
    let variant = Variant::new("elsewhere", draw, "").size(4, 4);
    let history = history("ch00", &variant, &variant.options(None), (1, 1));
    assert_eq!(json(&history)["events"][0]["kind"], "unknown", "{history}");
}

fn check(history: &History, variant: &Variant) {
    let text = history.to_string();
    let json: Value = serde_json::from_str(&history.to_json()).expect("JSON");
    let events = json["events"].as_array().expect("a list");
    // A line between enlarged pixels belongs to none of them.
    let is_enlarged = events.iter().any(|event| event["kind"] == "enlarged");
    if !is_enlarged && !OTHER_BUFFER.contains(&variant.name) {
        assert_eq!(history.last_color(), history.color(), "{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(!events.is_empty(), "{text}");
    // The recorder knows every event that a stage sends.
    assert!(!events.iter().any(|event| event["kind"] == "unknown"), "{text}");
    // Something covers a pixel, or it is said that nothing does.
    let covers = |event: &Value| {
        matches!(event["kind"].as_str(), Some("line" | "half" | "triangle" | "painted" | "note"))
    };
    let is_background = events.iter().any(|event| event["kind"] == "background");
    assert!(events.iter().any(covers) != is_background, "{text}");
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_history_tells_which_knobs_were_turned() {
    let variant = variant("ch05_perspective_correct", "affine");
    let mut options = variant.options(None);
    options.knobs.set("tilt=60").expect("in range");
    let history = history("ch05_perspective_correct", variant, &options, (20, 120));
    assert!(history.to_string().starts_with("ch05_perspective_correct affine tilt=60\n"), "{history}");
    assert_eq!(json(&history)["knobs"], serde_json::json!(["tilt=60"]));
}

fn json(history: &History) -> Value {
    serde_json::from_str(&history.to_json()).expect("JSON")
}

#[test]
fn the_formula_gives_what_is_reported() {
    for (name, x, y) in [("correct", 60, 120), ("correct", 80, 50), ("floor", 300, 100), ("affine", 60, 120)]
    {
        let variant = variant("ch05_perspective_correct", name);
        let json = json(&of("ch05_perspective_correct", variant, (x, y)));
        let triangle = json["events"].as_array().expect("a list").iter().find(|e| e["kind"] == "triangle");
        let hit = &triangle.expect("a triangle covers it")["hits"][0];
        let (values, t) = (&hit["values"], number(&hit["t"]["here"]["along row"]));
        // What is told of the ends of the row of the affine picture was computed affinely: only its last step is checked.
        let (a, b) = (&values["row, left"], &values["row, right"]);
        for v in ["V1", "V2"] {
            let (va, vb) = (number(&a[v]), number(&b[v]));
            if name == "affine" {
                assert!((number(&values["affine"][v]) - (va + (vb - va) * t)).abs() < 1e-12);
            } else {
                let (wa, wb) = (number(&a["ω"]), number(&b["ω"]));
                let expected = (wb * va + (wa * vb - wb * va) * t) / (wb + (wa - wb) * t);
                assert!((number(&values["V_p"][v]) - expected).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn weights_of_the_exact_rasterizer_give_what_is_reported() {
    let variant = variant("ch10_matrices_lighting", "exact");
    let json = json(&of("ch10_matrices_lighting", variant, (320, 240)));
    let triangle = &json["events"][1]["hits"][0];
    let (corners, values) = (&triangle["edges"], &triangle["values"]);
    let weight = |name: &str| number(&corners[name]["weight"]);
    let one_over_w: f64 = ["A", "B", "C"].iter().map(|name| weight(name) / number(&values[*name]["ω"])).sum();
    for v in ["V1", "V2", "V3", "V4", "V5"] {
        let over_w: f64 = ["A", "B", "C"]
            .iter()
            .map(|name| weight(name) * number(&values[*name][v]) / number(&values[*name]["ω"]))
            .sum();
        assert!((number(&values["V_p"][v]) - over_w / one_over_w).abs() < 1e-12, "{v}");
    }
}

#[test]
fn nothing_says_so() {
    let variant = variant("ch05_perspective_correct", "correct");
    let text = of("ch05_perspective_correct", variant, (600, 400)).to_string();
    assert!(text.contains("Nothing covers this pixel"), "{text}");
}

/// One history for each chapter, pinned.
const PINNED: [(&str, &str, Pixel); 13] = [
    ("ch01_pixels", "pixel", (200, 200)),
    ("ch02_dda_lines", "star", (300, 260)),
    ("ch02_triangles", "flat", (150, 100)),
    ("ch02_triangles", "top-left", (400, 232)),
    ("ch03_barycentric", "rgb", (100, 200)),
    ("ch04_projection", "cube", (386, 261)),
    ("ch05_perspective_correct", "affine", (60, 120)),
    ("ch05_perspective_correct", "correct", (60, 120)),
    ("ch06_z_buffer", "z-buffer", (60, 120)),
    ("ch07_clipping", "near", (60, 100)),
    ("ch08_cvv", "clipped", (300, 100)),
    ("ch09_pipeline", "blended", (150, 200)),
    ("ch10_matrices_lighting", "exact", (320, 240)),
];

#[test]
fn histories_are_as_before() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../histories");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let mut names = Vec::new();
    for (chapter, name, pixel) in PINNED {
        let file = format!("{chapter}__{name}");
        let text = of(chapter, variant(chapter, name), pixel).to_string();
        settings.bind(|| insta::assert_snapshot!(file.as_str(), text));
        names.push(format!("{file}.snap"));
    }
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/histories");
    for entry in std::fs::read_dir(folder).expect("the folder").filter_map(Result::ok) {
        let file = entry.file_name().to_string_lossy().into_owned();
        assert!(names.contains(&file) || file.ends_with(".new"), "{file} is an orphan");
    }
    assert!(CHAPTERS.iter().all(|(chapter, _)| PINNED.iter().any(|(name, ..)| *name == chapter.name)));
}
