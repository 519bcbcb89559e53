//! Chapter 6: what is drawn into, a plane of colors and a plane of depths.
//!
//! The end of the data flow: a fragment that passes the depth test writes into both planes.
//!
//! ```
//! use rasterbook::{Color, Target};
//! use rasterbook::depth::DepthTest;
//!
//! let mut target = Target::new(4, 3);
//! target.clear(Color::BLACK, 1000.0);
//! if target.depth.test_and_set(1, 1, 340.0, DepthTest::LessOrEqual) {
//!     target.color.set(1, 1, Color::RED);
//! }
//! assert_eq!(target.color.get(1, 1), Some(Color::RED));
//! ```

use crate::color::Color;
use crate::depth::{DepthBuffer, DepthTest};
use crate::framebuffer::Framebuffer;
use crate::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter_and_depth};
use crate::observer::SharedObserver;
use crate::payload::Walk;
use crate::real::Scalar;

/// What is drawn into: a plane of colors and a plane of depths, of the precision in which the rasterizer computes.
///
/// Each pixel must have a depth: rasterizers refuse a plane of depths that is smaller than that of colors. A larger one can
/// serve pictures of several sizes, if it is cleared for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Target<D = f64> {
    /// The picture.
    pub color: Framebuffer,
    /// How far away what is seen in each pixel is.
    pub depth: DepthBuffer<D>,
}

impl<D: Scalar> Target<D> {
    /// A target of `width` × `height` pixels; clear it before drawing.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] and [`DepthBuffer::new`] do.
    #[must_use]
    pub fn sized(width: u32, height: u32) -> Self {
        Self { color: Framebuffer::new(width, height), depth: DepthBuffer::new(width, height) }
    }

    /// A target for the picture of a framebuffer: of its size, black, and with the same observer.
    ///
    /// # Panics
    /// As [`DepthBuffer::new`] does.
    #[must_use]
    pub fn like(framebuffer: &Framebuffer) -> Self {
        let mut target = Self::sized(framebuffer.width(), framebuffer.height());
        target.set_observer(framebuffer.observer());
        target
    }

    /// Each pixel must have a depth.
    ///
    /// # Panics
    /// If the plane of depths is smaller than that of colors.
    pub(crate) fn assert_depths(&self) {
        let [color, depth] = [self.color.rect(), self.depth.rect()].map(|rect| (rect.right, rect.top));
        assert!(
            color.0 <= depth.0 && color.1 <= depth.1,
            "a target of {color:?} colors and {depth:?} depths"
        );
    }

    /// From now on this one observes both planes, and no other.
    pub fn set_observer(&mut self, observer: Option<SharedObserver>) {
        self.color.set_observer(observer.clone());
        self.depth.set_observer(observer);
    }

    /// Gives all pixels a color and a depth: what the last frame has left must not stay. Book, section 9.4.1.
    pub fn clear(&mut self, color: Color, depth: D) {
        self.color.clear(color);
        self.depth.clear(depth);
    }
}

impl Target {
    /// A target of `width` × `height` pixels in double precision; clear it before drawing.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] and [`DepthBuffer::new`] do.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self::sized(width, height)
    }

    // ANCHOR: fill
    /// Fills a triangle where it is not behind what has been drawn (chapters 7 and 8; the pipeline
    /// of chapter 9 has more options). Screen space; the depth of a vertex, beside its ω and
    /// values, changes linearly on the screen.
    pub fn fill<const N: usize>(
        &mut self,
        triangle: [ScreenVertex<(Projected<f64, N>, f64)>; 3],
        color_of: impl Fn([f64; N]) -> Color,
    ) {
        let Self { color, depth } = self;
        let (interpolation, walk) = (Interpolation::PerspectiveCorrect, Walk::default());
        step_parameter_and_depth(triangle, interpolation, walk, color.scissor(), |x, y, point, z| {
            if depth.test_and_set(x, y, z, DepthTest::LessOrEqual) {
                color.set(x, y, color_of(point.values));
            }
        });
    }
    // ANCHOR_END: fill
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    #[should_panic(expected = "a target of (4, 3) colors and (4, 2) depths")]
    fn fewer_depths_than_colors_are_refused() {
        Target { color: Framebuffer::new(4, 3), depth: DepthBuffer::<f64>::new(4, 2) }.assert_depths();
    }

    #[test]
    fn what_is_behind_is_not_filled() {
        let mut target = Target::new(8, 8);
        target.clear(Color::BLACK, 1.0);
        for (z, value) in [(0.25, 1.0), (0.75, 0.0)] {
            let triangle = [dvec2(0.0, 0.0), dvec2(7.0, 0.0), dvec2(0.0, 7.0)].map(|position| {
                let projected = Projected { w: 1.0, values: [value] };
                ScreenVertex { position, varyings: (projected, z) }
            });
            target.fill(triangle, |[value]| if value > 0.5 { Color::RED } else { Color::GREEN });
        }
        assert_eq!(
            [(1, 1), (7, 7)].map(|(x, y)| target.color.get(x, y)),
            [Some(Color::RED), Some(Color::BLACK)]
        );
        assert_eq!(target.depth.get(1, 1), Some(0.25));
    }
}
