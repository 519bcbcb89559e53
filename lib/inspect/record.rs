//! An observer that records: everything, or what concerns one pixel.

use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::clip::Assembled;
use crate::color::Color;
use crate::exact::edge::Coverage;
use crate::figure::{DrawOptions, Variant};
use crate::framebuffer::Framebuffer;
use crate::interpolate::ScreenTriangle;
use crate::line::Line;
use crate::observer::{Enlargement, Observer};
use crate::probe::{Fragment, Piece, Probe};
use crate::rect::Pixel;
use crate::scanline::HalfFill;

/// What covers pixels.
#[derive(Clone, Debug)]
pub(super) enum Primitive {
    Line(Line),
    Half(HalfFill),
    Triangle(ScreenTriangle),
    Coverage(Coverage),
}

/// Something that was reported.
#[derive(Clone, Debug)]
pub(super) enum Event {
    Written(Pixel, Color),
    Cleared(Color),
    Tested {
        at: Pixel,
        depth: f64,
        stored: f64,
        passed: bool,
    },
    Enlarged(Option<Enlargement>),
    Begun(Primitive),
    /// A stage began that is not known here.
    Unknown,
    Noted(Pixel, String),
    Done,
    Assembled(Assembled),
    Piece(Piece),
    Culled,
    Fragment(Pixel, Fragment),
}

impl Event {
    /// What a stage has begun with, by the stage's own type.
    fn begun(what: &dyn Any) -> Self {
        fn known<T: Clone + 'static>(what: &dyn Any, event: impl FnOnce(T) -> Event) -> Option<Event> {
            what.downcast_ref::<T>().cloned().map(event)
        }
        known(what, |line| Self::Begun(Primitive::Line(line)))
            .or_else(|| known(what, |half| Self::Begun(Primitive::Half(half))))
            .or_else(|| known(what, |triangle| Self::Begun(Primitive::Triangle(triangle))))
            .or_else(|| known(what, |coverage| Self::Begun(Primitive::Coverage(coverage))))
            .or_else(|| known(what, Self::Assembled))
            .unwrap_or(Self::Unknown)
    }
}

/// A picture, and what was recorded while it was drawn.
pub(super) struct Recording {
    pub(super) events: Vec<Event>,
    pub(super) picture: Framebuffer,
    /// The frame, if it is one of an animation.
    pub(super) frame: Option<u32>,
}

impl Recording {
    /// Draws a variant and records everything, or of what happens to pixels only what concerns one.
    pub(super) fn new(variant: &Variant, options: &DrawOptions<'_>, watched: Option<Pixel>) -> Self {
        let recorder = Arc::new(Recorder::new(watched));
        let picture = variant.draw(&DrawOptions { observer: Some(recorder.clone()), ..options.clone() });
        let events = std::mem::take(&mut recorder.lock().events);
        Self { events, picture, frame: variant.animation.map(|_| options.frame) }
    }
}

/// An observer that records.
#[derive(Debug)]
struct Recorder {
    /// The only pixel whose writes, tests and fragments are recorded.
    watched: Option<Pixel>,
    record: Mutex<Record>,
}

#[derive(Debug)]
struct Record {
    /// How the picture shows the current screen, if it is not the picture itself.
    enlargement: Option<Enlargement>,
    events: Vec<Event>,
}

impl Recorder {
    const fn new(watched: Option<Pixel>) -> Self {
        Self { watched, record: Mutex::new(Record { enlargement: None, events: Vec::new() }) }
    }

    fn lock(&self) -> MutexGuard<'_, Record> {
        self.record.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, event: Event) {
        self.lock().events.push(event);
    }

    fn push_at(&self, pixel: Pixel, event: impl FnOnce() -> Event) {
        let mut record = self.lock();
        let is_wanted = self.watched.is_none_or(|watched| within(watched, record.enlargement) == pixel);
        if is_wanted {
            record.events.push(event());
        }
    }
}

/// The pixel of the current screen that a pixel of the picture shows.
pub(super) fn within(pixel: Pixel, enlargement: Option<Enlargement>) -> Pixel {
    enlargement.map_or(pixel, |enlargement| enlargement.pixel_at(pixel))
}

impl Observer for Recorder {
    fn written(&self, pixel: Pixel, color: Color) {
        self.push_at(pixel, || Event::Written(pixel, color));
    }

    fn cleared(&self, color: Color) {
        self.push(Event::Cleared(color));
    }

    fn tested(&self, pixel: Pixel, depth: f64, stored: f64, passed: bool) {
        self.push_at(pixel, || Event::Tested { at: pixel, depth, stored, passed });
    }

    fn enlarged(&self, enlargement: Option<Enlargement>) {
        let mut record = self.lock();
        record.enlargement = enlargement;
        record.events.push(Event::Enlarged(enlargement));
    }

    fn begun(&self, what: &dyn Any) {
        self.push(Event::begun(what));
    }

    fn done(&self) {
        self.push(Event::Done);
    }

    fn note(&self, pixel: Pixel, text: &dyn Fn() -> String) {
        self.push_at(pixel, || Event::Noted(pixel, text()));
    }
}

impl Probe for Recorder {
    fn assembled(&self, triangle: &dyn Fn() -> Assembled) {
        self.push(Event::Assembled(triangle()));
    }

    fn piece(&self, piece: &dyn Fn() -> Piece) {
        self.push(Event::Piece(piece()));
    }

    fn culled(&self) {
        self.push(Event::Culled);
    }

    fn fragment(&self, pixel: Pixel, fragment: &dyn Fn() -> Fragment) {
        self.push_at(pixel, || Event::Fragment(pixel, fragment()));
    }
}
