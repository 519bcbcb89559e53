//! The chapters' figures for the pages of the book: what `live.js` calls.
//!
//! Compiled to WebAssembly, the same library and the same chapter files draw here as in the programs. The page writes a
//! line of text, calls a function, and reads an answer:
//!
//! ```text
//!   page                                      here
//!   text(n), then n bytes into the memory ──► what is asked
//!   open()   "ch05_perspective_correct affine"  ──► the number of a figure
//!   event(figure)   "set tilt=60"               ──► whether the picture changed
//!   draw(figure)                                ──► where its pixels are: RGBA, first row on top
//!   describe(figure), history(figure, x, y)     ──► where a text is, `length()` bytes of it
//! ```
//!
//! Nothing is drawn, computed or known here: it is all in [`rasterbook::live`].

use std::cell::RefCell;

use rasterbook::Framebuffer;
use rasterbook::figure::{Given, Scene};
use rasterbook::live::Live;

mod chapters;
mod description;
mod events;

use chapters::CHAPTERS;

/// All figures of the page, and the last answer.
#[derive(Default)]
struct Page {
    figures: Vec<Live<'static>>,
    text: Vec<u8>,
    pixels: Vec<u8>,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

/// Does something with a figure. Gives `none` if there is no such figure.
fn with<T>(figure: usize, none: T, action: impl FnOnce(&mut Live<'static>, &mut Page) -> T) -> T {
    PAGE.with_borrow_mut(|page| {
        if figure >= page.figures.len() {
            return none;
        }
        // Out of the page while it is used, so that the page can be written to.
        let mut live = page.figures.swap_remove(figure);
        let result = action(&mut live, page);
        page.figures.push(live);
        let last = page.figures.len() - 1;
        page.figures.swap(figure, last);
        result
    })
}

/// Makes room for a text of so many bytes, and says where.
#[unsafe(no_mangle)]
pub extern "C" fn text(length: usize) -> *mut u8 {
    PAGE.with_borrow_mut(|page| {
        page.text.clear();
        page.text.resize(length, 0);
        page.text.as_mut_ptr()
    })
}

/// How long the text is that was answered.
#[unsafe(no_mangle)]
pub extern "C" fn length() -> usize {
    PAGE.with_borrow(|page| page.text.len())
}

/// The text that the page wrote.
fn asked(page: &Page) -> String {
    String::from_utf8_lossy(&page.text).into_owned()
}

fn answer(page: &mut Page, text: String) -> *const u8 {
    page.text = text.into_bytes();
    page.text.as_ptr()
}

/// Opens a figure: the text names its chapter and its variant. Its number, or −1 if there is no such variant.
#[unsafe(no_mangle)]
pub extern "C" fn open() -> i32 {
    PAGE.with_borrow_mut(|page| {
        let Some(live) = figure(&asked(page)) else { return -1 };
        page.figures.push(live);
        page.figures.len() as i32 - 1
    })
}

/// A figure by the names of its chapter and its variant, a blank between them.
fn figure(text: &str) -> Option<Live<'static>> {
    let (chapter, variant) = text.split_once(' ')?;
    let chapter = CHAPTERS.iter().find(|it| it.name == chapter)?;
    let given = Given::default();
    let scene = Scene::new(chapter.find(variant)?, &given).ok()?;
    Some(Live::new(chapter, scene, given))
}

/// Does what the text says. 1 if the picture may have changed, 0 if not, −1 if it says nothing that can be done.
#[unsafe(no_mangle)]
pub extern "C" fn event(figure: usize) -> i32 {
    with(figure, -1, |live, page| {
        let event = events::parse(&asked(page), live);
        event.and_then(|event| live.apply(event).ok()).map_or(-1, i32::from)
    })
}

/// Draws what is looked at, in the size that was asked for; at first in the variant's own.
#[unsafe(no_mangle)]
pub extern "C" fn draw(figure: usize) -> *const u8 {
    with(figure, std::ptr::null(), |live, page| {
        page.pixels = rgba(&live.whole_picture());
        page.pixels.as_ptr()
    })
}

/// Four bytes a pixel, the first row on top: what a canvas takes.
fn rgba(picture: &Framebuffer) -> Vec<u8> {
    let channels = picture.rows_from_top().flatten().map(|color| color.channels());
    let mut bytes = Vec::with_capacity(4 * picture.width() as usize * picture.height() as usize);
    channels.for_each(|[red, green, blue]| bytes.extend([red, green, blue, 255]));
    bytes
}

/// A number that two figures have in common only if they show the same pixels.
#[unsafe(no_mangle)]
pub extern "C" fn fingerprint(figure: usize) -> u64 {
    with(figure, 0, |live, _| live.whole_picture().fingerprint())
}

/// What the figure is, how it stands, and what can be done with it: JSON.
#[unsafe(no_mangle)]
pub extern "C" fn describe(figure: usize) -> *const u8 {
    with(figure, std::ptr::null(), |live, page| {
        let description = description::of(live);
        answer(page, description.to_string())
    })
}

/// All that happened at a pixel, y up, as the program prints it.
#[unsafe(no_mangle)]
pub extern "C" fn history(figure: usize, x: i32, y: i32) -> *const u8 {
    with(figure, std::ptr::null(), |live, page| answer(page, live.history((x, y)).to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(line: &str) {
        text(line.len());
        PAGE.with_borrow_mut(|page| page.text.copy_from_slice(line.as_bytes()));
    }

    fn answered() -> String {
        PAGE.with_borrow(asked)
    }

    fn opened(names: &str) -> usize {
        ask(names);
        usize::try_from(open()).expect("a figure")
    }

    #[test]
    fn a_figure_is_opened_turned_and_drawn() {
        let [affine, pawn] = ["ch05_perspective_correct affine", "ch01_pixels pawn"].map(opened);
        ask("set tilt=60");
        assert_eq!(event(affine), 1);
        assert!(!draw(affine).is_null());
        let expected = figure("ch05_perspective_correct affine").map(|mut live| {
            live.apply(events::parse("set tilt=60", &live).expect("a knob")).expect("no model");
            rgba(&live.whole_picture())
        });
        assert_eq!(PAGE.with_borrow(|page| page.pixels.clone()), expected.expect("a variant"));
        describe(affine);
        let description: serde_json::Value = serde_json::from_str(&answered()).expect("JSON");
        assert_eq!(
            description["command"],
            "cargo run --bin ch05_perspective_correct -- affine --set tilt=60"
        );
        assert_eq!(description["remedy"], "correct");
        assert_eq!(description["knobs"][0]["value"], "60");
        describe(pawn);
        assert!(answered().contains("ch01_pixels -- pawn\""));
        history(affine, 320, 239);
        assert!(answered().contains("pixel (320, 239)"));
    }

    #[test]
    fn what_is_not_there_is_refused() {
        for names in ["", "ch05_perspective_correct", "ch05_perspective_correct x", "x affine"] {
            ask(names);
            assert_eq!(open(), -1, "{names}");
        }
        let line = opened("ch02_dda_lines line");
        for event_text in
            ["", "set", "set x=1", "fly", "frame", "show me", "size 0x0", "size 9999999x9", "press 1"]
        {
            ask(event_text);
            assert_eq!(event(line), -1, "{event_text}");
        }
        assert_eq!(event(99), -1);
        assert!(draw(99).is_null() && describe(99).is_null());
    }
}
