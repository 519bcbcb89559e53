//! Beside the data flow: somebody who watches how a picture comes about.
//!
//! A framebuffer can carry an [`Observer`]; the framebuffer itself reports to it, and so do the stages that draw into it.
//! All methods do nothing by default. Nothing that an observer does changes a picture. The pipeline of
//! chapter 9 reports more: see [`probe`](crate::probe).
//!
//! A stage announces what it is about to do with a value of its own type, such as [`line::Line`](crate::line::Line).
//! That is why [`Observer::begun`] takes `&dyn Any`: this room comes before all stages, and names none of them.
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::{AtomicU32, Ordering};
//! use rasterbook::observer::Observer;
//! use rasterbook::{Color, Framebuffer, Pixel};
//!
//! /// Counts the pixels that are written.
//! #[derive(Debug, Default)]
//! struct Writes(AtomicU32);
//!
//! impl Observer for Writes {
//!     fn written(&self, _: Pixel, _: Color) {
//!         self.0.fetch_add(1, Ordering::Relaxed);
//!     }
//! }
//!
//! let writes = Arc::new(Writes::default());
//! let mut framebuffer = Framebuffer::new(4, 3);
//! framebuffer.set_observer(Some(writes.clone()));
//! framebuffer.set(1, 1, Color::RED);
//! assert_eq!(writes.0.load(Ordering::Relaxed), 1);
//! ```

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use crate::color::Color;
use crate::rect::Pixel;

/// Somebody who watches the stages. Recording needs a cell or a lock: the stages share the observer.
pub trait Observer: Debug {
    /// A pixel of the framebuffer has been given a color.
    fn written(&self, _pixel: Pixel, _color: Color) {}

    /// All pixels have been given a color.
    fn cleared(&self, _color: Color) {}

    /// A depth has been compared with the stored one.
    fn tested(&self, _pixel: Pixel, _depth: f64, _stored: f64, _passed: bool) {}

    /// What follows happens on a screen of its own, each pixel of which is shown as `factor` × `factor` pixels.
    fn enlarged(&self, _factor: u32) {}

    /// A stage begins with something: a value of the stage's own type. What emits pixels says when it is [done](Self::done);
    /// a triangle that is [clipped](crate::clip::Assembled) is followed by its pieces instead.
    fn begun(&self, _what: &dyn Any) {}

    /// What was begun last is done.
    fn done(&self) {}

    /// Something else that is worth knowing about a pixel.
    fn note(&self, _pixel: Pixel, _text: &dyn Fn() -> String) {}
}

/// An observer that a framebuffer and the stages share.
pub type SharedObserver = Arc<dyn Observer + Send + Sync>;
