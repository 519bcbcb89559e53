//! Beside the data flow: whoever wants to know what happens on the way to a pixel listens here.
//!
//! The stages report to a [`Probe`]. All its methods do nothing unless they are written anew, so that drawing without
//! a listener, with [`Silent`], costs nothing: there is nothing left of the calls.
//!
//! ```
//! use std::cell::Cell;
//! use rasterbook::merge::Verdict;
//! use rasterbook::probe::{FragmentEvent, Probe};
//!
//! /// Counts the fragments that were hidden.
//! #[derive(Default)]
//! struct Hidden(Cell<u32>);
//!
//! impl Probe for Hidden {
//!     fn fragment(&self, event: &FragmentEvent<'_>) {
//!         if event.verdict == Verdict::Hidden {
//!             self.0.set(self.0.get() + 1);
//!         }
//!     }
//! }
//! ```

use crate::clip::{ClipVertex, NdcVertex};
use crate::merge::Verdict;

/// What happened to one fragment.
#[derive(Clone, Copy, Debug)]
pub struct FragmentEvent<'a> {
    /// Its pixel.
    pub x: i32,
    /// Its pixel, y up.
    pub y: i32,
    /// ω at the fragment.
    pub w: f64,
    /// Its depth.
    pub depth: f64,
    /// Its varyings.
    pub varyings: &'a [f64],
    /// The fragment shader's color: channels in 0..=255, opacity in 0..=1.
    pub color: [f64; 4],
    /// What became of it.
    pub verdict: Verdict,
}

/// Somebody who listens to the stages. Recording needs a cell: the stages share the probe.
pub trait Probe {
    /// A triangle has been assembled; its number, and its vertices in clip space.
    fn triangle<const N: usize>(&self, _number: usize, _vertices: &[ClipVertex<N>; 3]) {}

    /// A triangle has been clipped; what is left of it (nothing, if it is empty).
    fn clipped<const N: usize>(&self, _polygon: &[ClipVertex<N>]) {}

    /// A piece of the clipped triangle has reached the rasterizer; its vertices, and twice its signed area.
    fn piece<const N: usize>(&self, _vertices: &[NdcVertex<N>; 3], _signed_area: f64) {}

    /// The piece has been left out, because of the side that it turns to us or because it has no area.
    fn culled(&self) {}

    /// A fragment has come to its end.
    fn fragment(&self, _event: &FragmentEvent<'_>) {}
}

/// Nobody listens.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Probe for Silent {}
