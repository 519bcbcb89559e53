//! Beside the data flow: whoever wants to know what happens on the way to a pixel listens here.
//!
//! The stages report to a [`Probe`]. All its methods do nothing unless they are written anew. There are two ways to
//! hear them:
//!
//! - The pipeline takes a probe as a parameter. With [`Silent`], there is nothing left of the calls.
//! - A framebuffer can carry a [`Listener`]; the stages of the early chapters, which take the framebuffer's
//!   [`Window`], and the framebuffer itself report to it. Without one, that is a comparison a write.
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::{AtomicU32, Ordering};
//! use rasterbook::probe::Probe;
//! use rasterbook::{Color, Framebuffer};
//!
//! /// Counts the pixels that are written.
//! #[derive(Debug, Default)]
//! struct Writes(AtomicU32);
//!
//! impl Probe for Writes {
//!     fn written(&self, _x: i32, _y: i32, _color: Color) {
//!         self.0.fetch_add(1, Ordering::Relaxed);
//!     }
//! }
//!
//! let writes = Arc::new(Writes::default());
//! let mut framebuffer = Framebuffer::new(4, 3);
//! framebuffer.listen(Some(writes.clone()));
//! framebuffer.set(1, 1, Color::RED);
//! assert_eq!(writes.0.load(Ordering::Relaxed), 1);
//! ```

use std::fmt::{self, Debug};
use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};

use crate::clip::{ClipTest, ClipVertex, Plane};
use crate::edge::Coverage;
use crate::interpolate::Interpolation;
use crate::line::StepAxis;
use crate::merge::Verdict;
use crate::scanline::Walk;
use crate::{Color, Rect};

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

/// A vertex on its way: in clip space, or after the divide in NDC, with ω as the fourth component.
#[derive(Clone, Copy, Debug)]
pub struct Vertex<'a> {
    /// Where it is.
    pub position: DVec4,
    /// The values that it carries.
    pub varyings: &'a [f64],
}

/// A triangle of vertices in clip space, and what it will be clipped against.
#[derive(Clone, Copy)]
pub struct Assembled<'a> {
    /// The vertices.
    pub vertices: [Vertex<'a>; 3],
    /// Where they were before, in the space of the model, if the shader says so.
    pub model: &'a dyn Fn() -> Option<[DVec3; 3]>,
    /// The planes, in their order.
    pub planes: &'a [Plane],
    /// On which coordinates the test is made.
    pub test: ClipTest,
}

impl<'a> Assembled<'a> {
    /// A triangle that comes from nowhere else.
    #[must_use]
    pub fn new<const N: usize>(
        triangle: &'a [ClipVertex<N>; 3],
        planes: &'a [Plane],
        test: ClipTest,
    ) -> Self {
        Self { vertices: triangle.each_ref().map(Vertex::from), model: &|| None, planes, test }
    }
}

impl Debug for Assembled<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Assembled").field("vertices", &self.vertices).finish_non_exhaustive()
    }
}

/// A triangle on the screen that is about to be filled row by row.
#[derive(Clone, Copy, Debug)]
pub struct ScreenTriangle<'a> {
    /// The corners, in pixels.
    pub corners: [DVec2; 3],
    /// Their ω, if they have been projected.
    pub w: Option<[f64; 3]>,
    /// Their values.
    pub values: [&'a [f64]; 3],
    /// Their depths, if a depth is stepped beside t.
    pub depth: Option<[f64; 3]>,
    /// How values are interpolated.
    pub interpolation: Interpolation,
    /// How the rows are walked.
    pub walk: Walk,
}

/// Somebody who listens to the stages. Recording needs a cell or a lock: the stages share the probe.
pub trait Probe: Debug {
    /// A pixel of the framebuffer has been given a color.
    fn written(&self, _x: i32, _y: i32, _color: Color) {}

    /// All pixels have been given a color.
    fn cleared(&self, _color: Color) {}

    /// A depth has been compared with the stored one.
    fn tested(&self, _x: i32, _y: i32, _depth: f64, _stored: f64, _passed: bool) {}

    /// What follows happens on a screen of its own, each pixel of which is shown as `factor` × `factor` pixels.
    fn enlarged(&self, _factor: u32) {}

    /// A line is about to be drawn.
    fn line(&self, _a: DVec2, _b: DVec2, _axis: StepAxis) {}

    /// Half of a triangle is about to be filled: the lower and the upper end of its left and of its right side.
    fn half(&self, _left: [DVec2; 2], _right: [DVec2; 2], _walk: Walk) {}

    /// A triangle is about to be filled row by row.
    fn triangle(&self, _triangle: &ScreenTriangle<'_>) {}

    /// A triangle is about to be filled by edge functions.
    fn coverage(&self, _coverage: &Coverage) {}

    /// Something else that is worth telling about a pixel.
    fn note(&self, _x: i32, _y: i32, _text: &dyn Fn() -> String) {}

    /// What was announced last (line, half, triangle, coverage) is done.
    fn done(&self) {}

    /// A triangle has been assembled.
    fn assembled(&self, _triangle: &Assembled<'_>) {}

    /// A piece of the clipped triangle has reached the rasterizer; its vertices in NDC, and twice its signed area.
    fn piece(&self, _vertices: [Vertex<'_>; 3], _signed_area: f64) {}

    /// The piece has been left out, because of the side that it turns to us or because it has no area.
    fn culled(&self) {}

    /// A fragment has come to its end.
    fn fragment(&self, _event: &FragmentEvent<'_>) {}
}

/// Nobody listens.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Probe for Silent {}

/// A probe that a framebuffer carries.
pub type Listener = Arc<dyn Probe + Send + Sync>;

/// The rectangle in which a stage may emit pixels, and who listens to it.
#[derive(Clone, Debug)]
pub struct Window {
    /// The pixels.
    pub rect: Rect,
    /// Who listens.
    pub listener: Option<Listener>,
}

impl From<Rect> for Window {
    fn from(rect: Rect) -> Self {
        Self { rect, listener: None }
    }
}

impl Window {
    /// Tells the listener, if there is one.
    pub(crate) fn tell(&self, report: impl FnOnce(&dyn Probe)) {
        if let Some(listener) = &self.listener {
            report(listener.as_ref());
        }
    }
}
