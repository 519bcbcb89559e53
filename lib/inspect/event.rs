//! What is reported while a picture is drawn, as one type: for those who take it in, in its order.

use std::any::Any;
use std::sync::Arc;

use crate::clip::Assembled;
use crate::color::Color;
use crate::exact::edge::Coverage;
use crate::interpolate::ScreenTriangle;
use crate::line::Line;
use crate::observer::Enlargement;
use crate::probe::{Fragment, Piece};
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

/// Something that was reported. What is written, tested, noted, and a fragment belong to one pixel; who is told of them
/// knows which.
#[derive(Clone, Debug)]
pub(super) enum Event {
    Written(Color),
    Cleared(Color),
    Tested {
        depth: f64,
        stored: f64,
        passed: bool,
    },
    Enlarged(Option<Enlargement>),
    Begun(Arc<Primitive>),
    /// A stage began that is not known here.
    Unknown,
    Noted(String),
    Done,
    Assembled(Arc<Assembled>),
    Piece(Arc<Piece>),
    Culled,
    Fragment(Fragment),
}

impl Event {
    /// What a stage has begun with, by the stage's own type.
    pub(super) fn begun(what: &dyn Any) -> Self {
        fn known<T: Clone + 'static>(what: &dyn Any, event: impl FnOnce(T) -> Event) -> Option<Event> {
            what.downcast_ref::<T>().cloned().map(event)
        }
        let primitive = |primitive| Self::Begun(Arc::new(primitive));
        known(what, |line| primitive(Primitive::Line(line)))
            .or_else(|| known(what, |half| primitive(Primitive::Half(half))))
            .or_else(|| known(what, |triangle| primitive(Primitive::Triangle(triangle))))
            .or_else(|| known(what, |coverage| primitive(Primitive::Coverage(coverage))))
            .or_else(|| known(what, |triangle| Self::Assembled(Arc::new(triangle))))
            .unwrap_or(Self::Unknown)
    }
}

/// The pixel of the current screen that a pixel of the picture shows.
#[inline]
pub(super) fn within(pixel: Pixel, enlargement: Option<Enlargement>) -> Pixel {
    enlargement.map_or(pixel, |enlargement| enlargement.pixel_at(pixel))
}
