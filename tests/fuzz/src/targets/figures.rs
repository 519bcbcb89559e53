//! Bytes as what somebody does with a figure.

use rasterbook::figure::{Chapter, Given, Kind, Knob, RasterizerChoice, Scene, Value};
use rasterbook::live::{Event, Live, View};

use super::bytes::Bytes;

/// Keys, buttons and the wheel, whatever comes: the history of a pixel ends with the color that the picture has there.
pub(crate) fn history(chapters: &[&Chapter], data: &[u8]) {
    let bytes = &mut Bytes(data);
    let chapter = chapters[bytes.below(chapters.len())];
    let variant = &chapter.variants[bytes.below(chapter.variants.len())];
    let scene = Scene::new(variant, &Given::default()).expect("the chapters' own assets");
    let mut live = Live::new(chapter, scene, Given::default());
    resize(&mut live, bytes);
    for _ in 0..24 {
        if bytes.is_empty() {
            break;
        }
        let event = event(&live, bytes);
        live.apply(event).expect("the chapters' own assets");
    }
    // Another variant has another size.
    resize(&mut live, bytes);
    let (width, height) = live.scene().size;
    let pixel = (bytes.below(width as usize) as i32, bytes.below(height as usize) as i32);
    let history = live.history(pixel);
    assert!(!live.status().is_empty() && !live.command().is_empty() && !history.to_string().is_empty());
    if matches!(live.view(), View::Itself | View::Remedy) {
        assert_eq!(live.whole_picture().get(pixel.0, pixel.1), Some(history.color()), "{}", live.command());
    }
    assert!(live.picture().width() > 0);
}

/// Small, so that it is fast.
fn resize(live: &mut Live<'_>, bytes: &mut Bytes<'_>) {
    let size = (1 + bytes.below(64) as u32, 1 + bytes.below(48) as u32);
    live.apply(Event::Resize(size)).expect("the chapters' own assets");
}

fn event(live: &Live<'_>, bytes: &mut Bytes<'_>) -> Event {
    let step = |bytes: &mut Bytes<'_>| bytes.below(9) as i32 - 4;
    let pixel = |bytes: &mut Bytes<'_>| (bytes.below(80) as i32 - 8, bytes.below(64) as i32 - 8);
    match bytes.below(16) {
        0 => Event::NextVariant(step(bytes)),
        1 => Event::NextKnob(step(bytes)),
        2 => Event::Turn(step(bytes)),
        3..=6 => set(live, bytes),
        7 => Event::Frame(bytes.below(300) as u32),
        8 => Event::Show(bytes.one_of(&[View::Itself, View::Remedy, View::Difference, View::Overdraw])),
        9 => bytes.one_of(&[Event::Run, Event::Sweep, Event::Tick, Event::Reset]),
        10 => Event::NextRasterizer,
        11 => Event::Rasterizer(bytes.one_of(RasterizerChoice::ALL)),
        12 => Event::Magnify(step(bytes), pixel(bytes)),
        13 => Event::Press(pixel(bytes)),
        14 => Event::Drag(pixel(bytes)),
        _ => Event::Release,
    }
}

/// A knob, set to something of its kind that may lie outside of its range.
fn set(live: &Live<'_>, bytes: &mut Bytes<'_>) -> Event {
    let knobs: Vec<(&Knob, Value)> = live.scene().knobs.iter().collect();
    if knobs.is_empty() {
        return Event::Tick;
    }
    let index = bytes.below(knobs.len());
    let (knob, value) = knobs[index];
    let value = match (&knob.kind, value) {
        (Kind::Point(_), Value::Point(_)) => Value::Point([bytes.number(), bytes.number()].into()),
        (Kind::Number { .. }, _) if bytes.byte() < 32 => Value::Number(bytes.number()),
        _ => knob.at(f64::from(bytes.byte()) / 255.0).unwrap_or(value),
    };
    Event::Set(index, value)
}
