//! An observer that explains some pixels while a picture is drawn: of all that happens, it keeps what concerns them.

use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::event::Event;
use super::explain::Explainer;
use super::history::History;
use crate::clip::Assembled;
use crate::color::Color;
use crate::figure::{DrawOptions, Variant};
use crate::observer::{Enlargement, Observer};
use crate::probe::{Fragment, Piece, Probe};
use crate::rect::{Pixel, Rect};

/// The history of a pixel of a variant's picture.
#[must_use]
pub fn history(program: &'static str, variant: &Variant, options: &DrawOptions<'_>, pixel: Pixel) -> History {
    // One pixel, one history.
    histories(program, variant, options, [pixel]).remove(0)
}

/// The histories of several pixels; the picture is drawn once.
pub fn histories(
    program: &'static str,
    variant: &Variant,
    options: &DrawOptions<'_>,
    pixels: impl IntoIterator<Item = Pixel>,
) -> Vec<History> {
    let screen = Rect::sized(options.size.0, options.size.1);
    let explainers = pixels.into_iter().map(|pixel| Explainer::new(pixel, screen)).collect();
    let recorder = Arc::new(Recorder(Mutex::new(explainers)));
    let picture = variant.draw(&DrawOptions { observer: Some(recorder.clone()), ..options.clone() });
    let explainers = std::mem::take(&mut *recorder.lock());
    let history = |explainer: Explainer| History {
        program,
        variant: variant.name,
        frame: variant.animation.map(|_| options.frame),
        knobs: options.knobs.changed(),
        ..explainer.finish(&picture)
    };
    explainers.into_iter().map(history).collect()
}

/// Hands on what is reported, to each explainer what concerns its pixel.
#[derive(Debug)]
struct Recorder(Mutex<Vec<Explainer>>);

impl Recorder {
    #[inline]
    fn lock(&self) -> MutexGuard<'_, Vec<Explainer>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, event: &Event) {
        self.lock().iter_mut().for_each(|explainer| explainer.read(event));
    }

    /// The event is not made if nobody asks for its pixel.
    fn tell_at(&self, pixel: Pixel, event: impl FnOnce() -> Event) {
        let mut explainers = self.lock();
        let mut concerned = explainers.iter_mut().filter(|explainer| explainer.here() == pixel).peekable();
        if concerned.peek().is_some() {
            let event = event();
            concerned.for_each(|explainer| explainer.read(&event));
        }
    }
}

impl Observer for Recorder {
    fn written(&self, pixel: Pixel, color: Color) {
        self.tell_at(pixel, || Event::Written(color));
    }

    fn cleared(&self, color: Color) {
        self.tell(&Event::Cleared(color));
    }

    fn tested(&self, pixel: Pixel, depth: f64, stored: f64, passed: bool) {
        self.tell_at(pixel, || Event::Tested { depth, stored, passed });
    }

    fn enlarged(&self, enlargement: Option<Enlargement>) {
        self.tell(&Event::Enlarged(enlargement));
    }

    fn begun(&self, what: &dyn Any) {
        self.tell(&Event::begun(what));
    }

    fn done(&self) {
        self.tell(&Event::Done);
    }

    fn note(&self, pixel: Pixel, text: &dyn Fn() -> String) {
        self.tell_at(pixel, || Event::Noted(text()));
    }
}

impl Probe for Recorder {
    fn assembled(&self, triangle: &dyn Fn() -> Assembled) {
        self.tell(&Event::Assembled(Arc::new(triangle())));
    }

    fn piece(&self, piece: &dyn Fn() -> Piece) {
        self.tell(&Event::Piece(Arc::new(piece())));
    }

    fn culled(&self) {
        self.tell(&Event::Culled);
    }

    fn fragment(&self, pixel: Pixel, fragment: &dyn Fn() -> Fragment) {
        self.tell_at(pixel, || Event::Fragment(fragment()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Animation;
    use crate::framebuffer::Framebuffer;

    #[test]
    fn the_frame_of_an_animation_is_told() {
        let plain = || Variant::new("plain", |_| {}, "").size(4, 4);
        let moving = plain().animated(Animation { frames: 3, rate: 1 });
        let frame = |variant: &Variant| {
            let options = DrawOptions { frame: 2, ..variant.options(None) };
            history("ch00", variant, &options, (1, 1)).frame
        };
        assert_eq!((frame(&moving), frame(&plain())), (Some(2), None));
    }

    #[test]
    fn a_history_is_json() {
        let variant = Variant::new("red", |picture| picture.set(1, 1, Color::RED), "").size(4, 4);
        let json = history("ch00", &variant, &variant.options(None), (1, 1)).to_json();
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let expected = serde_json::json!([{
            "kind": "painted",
            "title": "The program itself paints this pixel",
            "hits": [{ "written": [255, 0, 0] }],
        }]);
        assert_eq!(json["events"], expected);
        assert_eq!((&json["pixel"], &json["row"]), (&serde_json::json!([1, 1]), &serde_json::json!(2)));
    }

    #[test]
    fn of_very_many_events_the_first_and_the_last_are_told() {
        fn draw(picture: &mut Framebuffer) {
            for i in 0..10_020 {
                picture.set(1, 1, Color::gray((i % 251) as u8));
                picture.set(2, 1, Color::RED);
            }
        }
        let variant = Variant::new("often", draw, "").size(4, 4);
        let history = history("ch00", &variant, &variant.options(None), (1, 1));
        assert_eq!(history.entries.len(), 10_001);
        assert_eq!(history.entries[9999].title, "20 more are left out here");
        let last = Color::gray((10_019 % 251) as u8);
        assert_eq!([history.color(), history.last_color()], [last; 2]);
        assert!(history.to_string().contains(&format!("written         {last:?}\n\nIn the picture")));
    }
}
