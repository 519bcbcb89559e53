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
use crate::rect::{Pixel, Rect};

/// A small screen that a picture shows, each of its pixels as a block of the picture's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Enlargement {
    /// The pixels of the screen.
    pub screen: Rect,
    /// How many pixels of the picture a block is wide and high.
    pub factor: u32,
    /// The lower left pixel of the block that shows the pixel (0, 0) of the screen.
    pub origin: Pixel,
}

impl Enlargement {
    /// The pixel of the screen that a pixel of the picture shows; beside the blocks, one outside the screen.
    #[must_use]
    pub const fn pixel_at(self, (x, y): Pixel) -> Pixel {
        let factor = self.factor as i32;
        ((x - self.origin.0).div_euclid(factor), (y - self.origin.1).div_euclid(factor))
    }
}

/// Somebody who watches the stages. Recording needs a cell or a lock: the stages share the observer.
pub trait Observer: Debug {
    /// A pixel of the framebuffer has been given a color.
    fn written(&self, _pixel: Pixel, _color: Color) {}

    /// All pixels have been given a color.
    fn cleared(&self, _color: Color) {}

    /// A depth has been compared with the stored one.
    fn tested(&self, _pixel: Pixel, _depth: f64, _stored: f64, _passed: bool) {}

    /// What follows happens on a screen of its own, which the picture shows enlarged; with `None`, on the picture again.
    fn enlarged(&self, _enlargement: Option<Enlargement>) {}

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
