//! Chapter 9: the last stage. A shaded fragment meets what has been drawn before.
//!
//! Takes a position, a depth and a shaded color; tests the depth, blends, and writes into the target.
//!
//! ```
//! use rasterbook::merge::Blend;
//!
//! // Half-transparent red over white.
//! assert_eq!(Blend::SourceOver.apply([255.0, 0.0, 0.0, 0.5], [255.0; 3]), [255.0, 127.5, 127.5]);
//! ```

use crate::color::Color;
use crate::depth::DepthTest;
use crate::real::{Real, Scalar, each, map3};
use crate::rect::Pixel;
use crate::shader::{Paint, Shaded};
use crate::target::Target;

/// How a fragment's color and the color already there make the new one. Second note, output merger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The fragment replaces what was there.
    #[default]
    Opaque,
    /// The fragment covers what was there as far as it is opaque: s·α + d·(1 − α). The order of drawing matters.
    SourceOver,
    /// The fragment's light is added: s·α + d, at most 255.
    Additive,
}

impl Blend {
    /// The new color from the fragment's (with opacity) and the one that is there; channels in 0..=255.
    #[must_use]
    #[inline(always)]
    pub fn apply<R: Real>(self, [red, green, blue, opacity]: [R; 4], there: [R; 3]) -> [R; 3] {
        let source = [red, green, blue];
        match self {
            Self::Opaque => source,
            Self::SourceOver => each(
                source,
                #[inline(always)]
                |i, s| s * opacity + there[i] * (R::of(1.0) - opacity),
            ),
            Self::Additive => each(
                source,
                #[inline(always)]
                |i, s| (s * opacity + there[i]).min(R::of(255.0)),
            ),
        }
    }
}

/// How a channel becomes a whole number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// The fraction is cut off, as the book does.
    Truncate,
    /// To the nearest, halves upwards: add ½, then truncate. The sum is rounded like any other, so that the number just below
    /// a half may go up: of `f32`, 0.49999997. Direct3D 11.3 functional specification, 3.2.3.6.
    Nearest,
}

impl Rounding {
    /// The color with channels in 0..=255; values outside are clamped, NaN gives 0.
    #[must_use]
    #[inline]
    pub fn color<R: Scalar>(self, channels: [R; 3]) -> Color {
        let channels = match self {
            Self::Truncate => channels,
            Self::Nearest => map3(channels, |channel| channel + R::of(0.5)),
        };
        Color::truncated(map3(channels, Into::into))
    }
}

/// The options of the last stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Merge {
    /// How a fragment's depth must compare.
    pub depth_test: DepthTest,
    /// Whether a drawn fragment's depth is stored; translucent things often leave the depth alone.
    pub depth_write: bool,
    /// How colors are combined.
    pub blend: Blend,
}

impl Default for Merge {
    fn default() -> Self {
        Self { depth_test: DepthTest::default(), depth_write: true, blend: Blend::default() }
    }
}

/// What became of a fragment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The shader discarded it.
    Discarded,
    /// Something nearer was there.
    Hidden,
    /// It was drawn, and this is the pixel's new color.
    Drawn(Color),
}

// ANCHOR: merge
/// Merges a fragment into the target at (x, y): depth test, blending, writing.
#[inline(always)]
pub fn merge<R: Scalar>(
    target: &mut Target<R>,
    options: Merge,
    rounding: Rounding,
    (x, y): Pixel,
    depth: R,
    shaded: Shaded<R>,
) -> Verdict {
    if !shaded.keep {
        return Verdict::Discarded;
    }
    let passes = if options.depth_write {
        target.depth.test_and_set(x, y, depth, options.depth_test)
    } else {
        target.depth.get(x, y).is_some_and(|stored| options.depth_test.passes(depth, stored))
    };
    if !passes {
        return Verdict::Hidden;
    }
    let color = match (options.blend, shaded.color) {
        // What was there does not show.
        (Blend::Opaque, Paint::Texel(texel)) => texel,
        (Blend::Opaque, Paint::Channels([r, g, b, _])) => rounding.color([r, g, b]),
        (blend, paint) => {
            let there = R::channels(target.color.get(x, y).unwrap_or_default());
            rounding.color(blend.apply(paint.channels(), there))
        }
    };
    target.color.set(x, y, color);
    Verdict::Drawn(color)
}
// ANCHOR_END: merge

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blending() {
        let there = [100.0, 200.0, 50.0];
        assert_eq!(Blend::Opaque.apply([1.0, 2.0, 3.0, 0.25], there), [1.0, 2.0, 3.0]);
        assert_eq!(Blend::SourceOver.apply([200.0, 0.0, 250.0, 0.25], there), [125.0, 150.0, 100.0]);
        assert_eq!(Blend::Additive.apply([200.0, 200.0, 4.0, 0.5], there), [200.0, 255.0, 52.0]);
    }

    #[test]
    fn a_half_is_added_and_the_fraction_cut_off() {
        let nearest = |channel: f64| Rounding::Nearest.color([channel; 3]).channels()[0];
        assert_eq!(
            [0.49999997, 0.5, 1.49, 254.5, 300.0, -1.0, f64::NAN].map(nearest),
            [0, 1, 1, 255, 255, 0, 0]
        );
        let nearest = |channel: f32| Rounding::Nearest.color([channel; 3]).channels()[0];
        assert_eq!([0.49999994, 0.49999997, 0.5].map(nearest), [0, 1, 1], "the sum is rounded");
        assert_eq!(Rounding::Truncate.color([0.99_f32, 255.9, f32::NAN]), Color::rgb(0, 255, 0));
    }

    #[test]
    fn a_texel_is_drawn_like_its_channels() {
        let texel = Color::rgb(3, 128, 255);
        for rounding in [Rounding::Truncate, Rounding::Nearest] {
            for blend in [Blend::Opaque, Blend::SourceOver, Blend::Additive] {
                let drawn = [Shaded::texel(texel), Shaded::opaque(texel.to_f64())].map(|shaded| {
                    let mut target = Target::new(1, 1);
                    target.clear(Color::rgb(100, 200, 1), 1.0);
                    merge(&mut target, Merge { blend, ..Merge::default() }, rounding, (0, 0), 0.5, shaded)
                });
                assert_eq!(drawn[0], drawn[1], "{rounding:?}, {blend:?}");
            }
        }
    }

    #[test]
    fn what_becomes_of_a_fragment() {
        let mut target = Target::new(2, 1);
        target.clear(Color::BLACK, 1.0);
        let red = Shaded::opaque([255.0_f64, 0.0, 0.0]);
        let mut merge =
            |options, depth, shaded| merge(&mut target, options, Rounding::Truncate, (0, 0), depth, shaded);
        let untouched = Merge { depth_write: false, ..Merge::default() };
        assert_eq!(merge(untouched, 0.5, red), Verdict::Drawn(Color::RED));
        assert_eq!(merge(Merge::default(), 0.7, red), Verdict::Drawn(Color::RED), "0.5 was not stored");
        assert_eq!(merge(Merge::default(), 0.8, red), Verdict::Hidden, "0.7 was");
        assert_eq!(merge(untouched, 0.8, red), Verdict::Hidden, "tested all the same");
        assert_eq!(merge(Merge::default(), 0.1, red.discard(true)), Verdict::Discarded);
        assert_eq!(
            merge(Merge::default(), 0.6, red),
            Verdict::Drawn(Color::RED),
            "a discarded fragment stores nothing"
        );
    }
}
