//! Chapter 6: which surface is in front. A depth for each pixel, a test, and what a depth is.
//!
//! Stands at the end of the data flow, in front of the framebuffer: a fragment that fails the test is dropped.
//!
//! ```
//! use rasterbook::depth::{DepthBuffer, DepthTest};
//!
//! let mut buffer = DepthBuffer::new(4, 3);
//! buffer.clear(1000.0);
//! assert!(buffer.test_and_set(1, 1, 340.0, DepthTest::LessOrEqual)); // in front of nothing
//! assert!(!buffer.test_and_set(1, 1, 500.0, DepthTest::LessOrEqual)); // behind the first
//! assert_eq!(buffer.get(1, 1), Some(340.0));
//! ```

use crate::observer::SharedObserver;
use crate::plane::{PixelPlane, count_of};
use crate::real::Scalar;
use crate::rect::Rect;

/// When a fragment is drawn: how its depth must compare with the stored one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthTest {
    /// It must be nearer.
    Less,
    /// It must be nearer or equally far: of two equal ones the later wins. Book, section 6.2.
    #[default]
    LessOrEqual,
    /// Its depth must be larger, for buffers in which near is large (reversed z).
    Greater,
    /// It is always drawn, as by the painter's algorithm.
    Always,
}

impl DepthTest {
    /// Whether a fragment at `depth` passes against the stored one. NaN passes only `Always`.
    #[must_use]
    #[inline]
    pub fn passes<D: PartialOrd>(self, depth: D, stored: D) -> bool {
        match self {
            Self::Less => depth < stored,
            Self::LessOrEqual => depth <= stored,
            Self::Greater => depth > stored,
            Self::Always => true,
        }
    }
}

/// What is stored as the depth of a fragment. Every encoding grows with the distance.
///
/// ```text
///   depth                               near = 1, far = 10
///     │                          ____
///     │            ________──────  .·   Reciprocal, Ndc: most of the range is spent
///     │     _.·──‾‾             .·      on what is near
///     │   .'                 .·
///     │  /              .·'             ViewZ: linear
///     │ /         . ·'
///     │/. · '
///     └────────────────────────────► z
///      1                           10
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthEncoding {
    /// The distance z of camera space, which is w, interpolated like a value: a w-buffer. Book, section 6.2.
    ///
    /// Clear the buffer to more than the largest distance.
    ViewZ,
    /// −1/z, linear on the screen: what the divide makes of a clip-space z of −1. Book, section 7.2.
    Reciprocal,
    /// z of NDC, a + b/z, from −1 at the near plane to 1 at the far plane; linear on the screen. Book, section 8.2.
    #[default]
    Ndc,
}

impl DepthEncoding {
    /// What the vertex stage writes as z of clip space, so that the divide by w = z leaves this encoding: z · z, −1, or
    /// a z + b with `near` → −1 and `far` → 1. The distances count for [`Self::Ndc`] alone.
    #[must_use]
    pub fn clip_z(self, view_z: f64, near: f64, far: f64) -> f64 {
        match self {
            Self::ViewZ => view_z * view_z,
            Self::Reciprocal => -1.0,
            Self::Ndc => (far + near) / (far - near) * view_z + 2.0 * near * far / (near - far),
        }
    }

    /// Whether it changes linearly on the screen, and so needs no correction. Book, section 7.5.1.
    #[must_use]
    #[inline]
    pub const fn is_linear_on_screen(self) -> bool {
        match self {
            Self::ViewZ => false,
            Self::Reciprocal | Self::Ndc => true,
        }
    }
}

/// The depth of hardware buffers, 0 at the near plane and 1 at the far plane, from the distance w.
///
/// Q (w − n) / w with Q = f / (f − n): the conversion from a w-buffer to a z-buffer. Source: fourth note, Z-Buffer and
/// W-Buffer.
#[must_use]
pub fn z_from_w(w: f64, near: f64, far: f64) -> f64 {
    far / (far - near) * (w - near) / w
}

/// The distance w from a hardware depth in 0..=1: the inverse of [`z_from_w`].
#[must_use]
pub fn w_from_z(z: f64, near: f64, far: f64) -> f64 {
    near * far / (far - z * (far - near))
}

// ANCHOR: reversed
/// The same depth the other way round: 1 at the near plane and 0 at the far plane, from the
/// distance w. Nearer is larger, so the test is [`DepthTest::Greater`].
///
/// n (f − w) / ((f − n) w), which is 1 − [`z_from_w`], computed without subtracting from 1: that
/// would round off what is small far away. Not a number where both products are 0 or infinite.
/// Source: Reed, *Depth precision visualized*, 2015.
#[must_use]
pub fn reversed_z_from_w(w: f64, near: f64, far: f64) -> f64 {
    near * (far - w) / ((far - near) * w)
}

/// What numbers a buffer of hardware can hold for depths of 0..=1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthFormat {
    /// Whole multiples of 1 / (2²⁴ − 1): the same step everywhere.
    Unorm24,
    /// `f32`: 24 digits wherever they begin, so the step is finest near 0.
    Float32,
}

impl DepthFormat {
    const UNORM_MAX: f64 = 16_777_215.0;

    /// The number of this format that is nearest to a depth of 0..=1.
    #[must_use]
    pub fn stored(self, depth: f64) -> f64 {
        match self {
            Self::Unorm24 => (depth * Self::UNORM_MAX).round() / Self::UNORM_MAX,
            Self::Float32 => f64::from(depth as f32),
        }
    }
    // ANCHOR_END: reversed

    /// How far the number that is stored for a depth of 0..1 is from the next larger one.
    #[must_use]
    pub fn step(self, depth: f64) -> f64 {
        match self {
            Self::Unorm24 => 1.0 / Self::UNORM_MAX,
            Self::Float32 => f64::from((depth as f32).next_up()) - f64::from(depth as f32),
        }
    }
}

/// A depth for each pixel, of double precision unless said otherwise.
#[derive(Clone, Debug)]
pub struct DepthBuffer<D = f64> {
    rect: Rect,
    values: PixelPlane<D>,
    observer: Option<SharedObserver>,
}

/// Two buffers are equal if they hold the same depths, whether they are observed or not.
impl<D: PartialEq> PartialEq for DepthBuffer<D> {
    fn eq(&self, other: &Self) -> bool {
        self.rect == other.rect && *self.values == *other.values
    }
}

impl<D: Scalar> DepthBuffer<D> {
    /// A buffer of `width` × `height` depths, all of them 0; a side has at most 2³¹ − 1.
    ///
    /// # Panics
    /// If no memory can hold so many.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        let rect = Rect::sized(width, height);
        let count = count_of::<D>([rect.right as u32, rect.top as u32], 1);
        let count = count.unwrap_or_else(|| panic!("no memory can hold {width}×{height} depths"));
        let values = vec![D::of(0.0); count];
        Self { rect, values: values.into(), observer: None }
    }

    /// All pixels.
    #[must_use]
    #[inline]
    pub const fn rect(&self) -> Rect {
        self.rect
    }

    /// Gives all pixels the same depth.
    pub fn clear(&mut self, depth: D) {
        self.values.fill(depth);
    }

    /// The depth of the pixel (x, y); `None` outside.
    #[must_use]
    #[inline]
    pub fn get(&self, x: i32, y: i32) -> Option<D> {
        self.rect.index(x, y).map(|index| self.values[index])
    }

    /// The rows as [`Framebuffer::rows_from_top`](crate::Framebuffer::rows_from_top) has them: the highest first. There are none
    /// if there are no columns.
    pub fn rows_from_top(&self) -> impl Iterator<Item = &[D]> {
        // No slice is cut into pieces of no length.
        self.values.chunks(self.rect.columns().len().max(1)).rev()
    }

    /// The plane itself, for stages that write many depths at a time; that is not reported.
    #[cfg(feature = "tiled")]
    pub(crate) const fn plane_mut(&mut self) -> &mut PixelPlane<D> {
        &mut self.values
    }

    /// From now on this one observes, and no other.
    pub fn set_observer(&mut self, observer: Option<SharedObserver>) {
        self.observer = observer;
    }

    /// Whether a fragment at (x, y) passes the test; if so, its depth replaces the stored one. Outside nothing passes.
    #[inline]
    pub fn test_and_set(&mut self, x: i32, y: i32, depth: D, test: DepthTest) -> bool {
        let Some(index) = self.rect.index(x, y) else { return false };
        if let Some(observer) = &self.observer {
            let stored = self.values[index];
            observer.tested((x, y), depth.into(), stored.into(), test.passes(depth, stored));
        }
        self.test_and_set_at(index, depth, test)
    }

    // ANCHOR: test_and_set
    /// Whether a depth passes the test against the one that is stored for a pixel; if so, it
    /// replaces it.
    #[inline]
    fn test_and_set_at(&mut self, index: usize, depth: D, test: DepthTest) -> bool {
        let passes = test.passes(depth, self.values[index]);
        if passes {
            self.values[index] = depth;
        }
        passes
    }
    // ANCHOR_END: test_and_set
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::{Interpolation, Projected};
    use proptest::prelude::*;

    #[test]
    #[should_panic(expected = "no memory can hold 4294967295×4294967294 depths")]
    fn a_buffer_has_its_limit() {
        let _ = DepthBuffer::<f64>::new(u32::MAX, u32::MAX - 1);
    }

    #[test]
    fn rows_begin_at_the_top() {
        let mut depths = DepthBuffer::<f32>::new(2, 3);
        depths.test_and_set(1, 2, 0.5, DepthTest::Always);
        depths.test_and_set(0, 0, 0.25, DepthTest::Always);
        let rows: Vec<_> = depths.rows_from_top().collect();
        assert_eq!(rows, [[0.0, 0.5], [0.0, 0.0], [0.25, 0.0]]);
        assert_eq!(DepthBuffer::<f32>::new(0, 3).rows_from_top().count(), 0);
    }

    #[test]
    fn tests_by_name() {
        let passes = |test: DepthTest| [0.25, 0.5, 0.75].map(|depth| test.passes(depth, 0.5));
        assert_eq!(passes(DepthTest::Less), [true, false, false]);
        assert_eq!(passes(DepthTest::LessOrEqual), [true, true, false]);
        assert_eq!(passes(DepthTest::Greater), [false, false, true]);
        assert_eq!(passes(DepthTest::Always), [true, true, true]);
        assert!(!DepthTest::LessOrEqual.passes(f64::NAN, 0.5));
    }

    #[test]
    fn what_fails_leaves_the_buffer_alone() {
        let mut buffer = DepthBuffer::new(2, 2);
        buffer.clear(0.5);
        assert!(!buffer.test_and_set(0, 0, 0.6, DepthTest::Less));
        assert_eq!(buffer.get(0, 0), Some(0.5));
        assert!(!buffer.test_and_set(2, 0, 0.1, DepthTest::Less), "outside");
    }

    #[test]
    fn what_the_divide_leaves_of_each_encoding() {
        let divided = |encoding: DepthEncoding, z: f64| encoding.clip_z(z, 2.0, 10.0) / z;
        assert_eq!([2.0, 4.0, 10.0].map(|z| divided(DepthEncoding::ViewZ, z)), [2.0, 4.0, 10.0]);
        assert_eq!([2.0, 4.0, 10.0].map(|z| divided(DepthEncoding::Reciprocal, z)), [-0.5, -0.25, -0.1]);
        // −1 on the near plane, 1 on the far one, and linear in 1/z: 0 where that is (1/2 + 1/10) / 2.
        for (z, expected) in [(2.0, -1.0), (10.0 / 3.0, 0.0), (10.0, 1.0)] {
            assert!((divided(DepthEncoding::Ndc, z) - expected).abs() < 1e-12, "at {z}");
        }
    }

    #[test]
    fn depths_of_hardware_by_hand() {
        // Q = 10 / (10 − 2) = 5/4, and at the distance 4: 5/4 · (4 − 2) / 4 = 5/8.
        assert_eq!([2.0, 4.0, 10.0].map(|w| z_from_w(w, 2.0, 10.0)), [0.0, 0.625, 1.0]);
        assert_eq!([0.0, 0.625, 1.0].map(|z| w_from_z(z, 2.0, 10.0)), [2.0, 4.0, 10.0]);
        assert_eq!([2.0, 4.0, 10.0].map(|w| reversed_z_from_w(w, 2.0, 10.0)), [1.0, 0.375, 0.0]);
    }

    #[test]
    fn buffers_are_equal_if_their_depths_are() {
        let filled = |width, height, depth| {
            let mut buffer = DepthBuffer::new(width, height);
            buffer.clear(depth);
            buffer
        };
        assert!(filled(2, 3, 1.0) == filled(2, 3, 1.0));
        assert!(filled(2, 3, 1.0) != filled(2, 3, 0.5), "other depths");
        assert!(filled(2, 3, 1.0) != filled(3, 2, 1.0), "as many in another shape");
        assert_eq!(filled(2, 3, 1.0).rect(), Rect::sized(2, 3));
    }

    #[test]
    fn what_a_format_can_hold() {
        let unorm = DepthFormat::Unorm24;
        assert_eq!([0.0, 1.0].map(|depth| unorm.stored(depth)), [0.0, 1.0]);
        assert_eq!(unorm.stored(0.4 * unorm.step(0.0)), 0.0);
        assert_eq!(unorm.stored(0.6 * unorm.step(0.0)), unorm.step(0.0));
        let float = DepthFormat::Float32;
        assert_eq!(float.stored(0.1), f64::from(0.1_f32));
        assert_eq!([0.25, 0.4, 0.5, 0.9].map(|depth| float.step(depth) * 33_554_432.0), [1.0, 1.0, 2.0, 2.0]);
    }

    proptest! {
        #[test]
        fn reversed_is_one_minus_ordinary(w in 1.0..20.0) {
            let (ordinary, reversed) = (z_from_w(w, 1.0, 20.0), reversed_z_from_w(w, 1.0, 20.0));
            prop_assert!((ordinary + reversed - 1.0).abs() < 1e-12);
        }

        #[test]
        fn conversion_between_w_and_z(w in 1.0..10.0) {
            let z = z_from_w(w, 1.0, 10.0);
            prop_assert!((0.0..=1.0).contains(&z));
            prop_assert!((w_from_z(z, 1.0, 10.0) - w).abs() < 1e-9);
        }

        #[test]
        fn a_converted_depth_is_linear_on_the_screen(w in prop::array::uniform2(1.0..10.0), t in 0.0..1.0) {
            // Book, section 7.5.1: a + b/z changes linearly where ω itself does not.
            let [a, b] = w.map(|w| Projected { w, values: [] });
            let seen = Interpolation::PerspectiveCorrect.between(a, b, t).w;
            let [za, zb, z] = [w[0], w[1], seen].map(|w| z_from_w(w, 1.0, 10.0));
            prop_assert!((z - (za + (zb - za) * t)).abs() < 1e-12);
        }

        #[test]
        fn every_encoding_grows_with_the_distance(z in 1.0..10.0, more in 0.001..5.0) {
            prop_assert!(z_from_w(z, 1.0, 20.0) < z_from_w(z + more, 1.0, 20.0));
            for encoding in [DepthEncoding::ViewZ, DepthEncoding::Reciprocal, DepthEncoding::Ndc] {
                let divided = |z: f64| encoding.clip_z(z, 1.0, 20.0) / z;
                prop_assert!(divided(z) < divided(z + more), "{:?}", encoding);
            }
        }

        #[test]
        fn two_encodings_are_linear_on_the_screen(w in prop::array::uniform2(1.0..10.0), t in 0.1..0.9) {
            let [a, b] = w.map(|w| Projected { w, values: [] });
            let seen = Interpolation::PerspectiveCorrect.between(a, b, t).w;
            for encoding in [DepthEncoding::ViewZ, DepthEncoding::Reciprocal, DepthEncoding::Ndc] {
                let [za, zb, z] = [w[0], w[1], seen].map(|w| encoding.clip_z(w, 1.0, 20.0) / w);
                let is_linear = (z - (za + (zb - za) * t)).abs() < 1e-12;
                prop_assert!(is_linear == encoding.is_linear_on_screen() || (w[0] - w[1]).abs() < 1e-3);
            }
        }
    }
}
