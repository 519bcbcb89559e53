//! Chapter 9: what the pipeline reports on the way to a pixel.
//!
//! To an [`Observer`] the framebuffer and the stages of the early chapters report; to a [`Probe`] the pipeline's stages
//! too. It is a parameter of [`draw`](crate::draw): with [`Silent`], nothing is left of the calls. What is reported
//! is made only if it is wanted, hence the functions.
//!
//! What is written, tested and begun is reported to the target's own observer: see [`Target::set_observer`].
//!
//! [`Target::set_observer`]: crate::Target::set_observer
//!
//! ```
//! use std::cell::Cell;
//! use rasterbook::observer::Observer;
//! use rasterbook::probe::Probe;
//!
//! /// Counts the triangles that are left out.
//! #[derive(Debug, Default)]
//! struct Culled(Cell<u32>);
//!
//! impl Observer for Culled {}
//!
//! impl Probe for Culled {
//!     fn culled(&self) {
//!         self.0.set(self.0.get() + 1);
//!     }
//! }
//! ```

use std::sync::Arc;

use crate::clip::{Assembled, RecordedVertex};
use crate::merge::Verdict;
use crate::observer::Observer;
use crate::rect::Pixel;

/// A piece of a clipped triangle that has reached the rasterizer.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its vertices in NDC, with w.
    pub vertices: [RecordedVertex; 3],
    /// Twice its signed area: in NDC, or in square pixels where the rasterizer culls on the screen.
    pub signed_area: f64,
}

/// A fragment that has come to its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragment {
    /// w.
    pub w: f64,
    /// Its depth.
    pub depth: f64,
    /// Its varyings.
    pub varyings: Vec<f64>,
    /// The fragment shader's color: channels in 0..=255, opacity in 0..=1.
    pub color: [f64; 4],
    /// What became of it.
    pub verdict: Verdict,
}

/// Somebody who watches the pipeline. Recording needs a cell or a lock: the stages share the probe.
pub trait Probe: Observer {
    /// A triangle has been assembled.
    fn assembled(&self, _triangle: &dyn Fn() -> Assembled) {}

    /// A piece of the clipped triangle has reached the rasterizer.
    fn piece(&self, _piece: &dyn Fn() -> Piece) {}

    /// The piece has been left out, because of its winding or because it has no area.
    fn culled(&self) {}

    /// A fragment of this pixel has come to its end.
    fn fragment(&self, _pixel: Pixel, _fragment: &dyn Fn() -> Fragment) {}
}

/// Nobody watches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {}

impl Probe for Silent {}

/// A probe that several share.
pub type SharedProbe = Arc<dyn Probe + Send + Sync>;
