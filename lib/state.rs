//! Chapter 9: the options of the pipeline, in one value.
//!
//! Beside the data flow: every stage reads its own options here. A mistake that a chapter discusses is a value of one of
//! them, never a copy of the code.

use crate::area::Winding;
use crate::clip::{ClipTest, ClipVolume, DepthRange};
use crate::color::Color;
use crate::cull::CullMode;
use crate::depth::DepthEncoding;
use crate::interpolate::Interpolation;
use crate::merge::Merge;
use crate::payload::Walk;
use crate::real::Scalar;
use crate::rect::Rect;
use crate::target::Target;
use crate::transform::Viewport;

/// What is in the target when drawing begins.
///
/// A rasterizer that draws a part of the picture at a time, as GPUs with tiles and `tiled` do, can clear
/// it just before: then it need not be fetched from far away. Source: Vulkan specification, *Load operations*.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadOp {
    /// What has been drawn before.
    #[default]
    Load,
    /// The clear color and the clear depth, everywhere.
    Clear,
}

/// How a mesh is drawn: plain data, and every default is the right one.
///
/// ```
/// use rasterbook::interpolate::Interpolation;
/// use rasterbook::RenderState;
///
/// let wrong = RenderState { interpolation: Interpolation::Affine, ..RenderState::default() };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderState {
    /// Which part of space is kept (stage 3).
    pub clip_volume: ClipVolume,
    /// On which coordinates that is tested (stage 3).
    pub clip_test: ClipTest,
    /// The range of z in NDC (stage 3).
    pub depth_range: DepthRange,
    /// Which triangles are left out (stage 5).
    pub cull: CullMode,
    /// In which direction the vertices of a front run on the screen (stage 5).
    pub front_face: Winding,
    /// Where on the screen the view is laid; the whole framebuffer if nothing is said (stage 6).
    pub viewport: Option<Viewport>,
    /// How the rows of a triangle are walked (stage 7).
    pub walk: Walk,
    /// How varyings are interpolated (stage 7).
    pub interpolation: Interpolation,
    /// What is stored as a depth (stage 7).
    pub depth_encoding: DepthEncoding,
    /// How a fragment meets what has been drawn before (stages 9 and 10).
    pub merge: Merge,
    /// What is in the target when drawing begins.
    pub load: LoadOp,
    /// The color of a pixel where nothing is drawn.
    pub clear_color: Color,
    /// The depth of a pixel where nothing is drawn.
    pub clear_depth: f64,
}

impl Default for RenderState {
    fn default() -> Self {
        Self {
            clip_volume: ClipVolume::default(),
            clip_test: ClipTest::default(),
            depth_range: DepthRange::default(),
            cull: CullMode::default(),
            front_face: Winding::CounterClockwise,
            viewport: None,
            walk: Walk::default(),
            interpolation: Interpolation::default(),
            depth_encoding: DepthEncoding::default(),
            merge: Merge::default(),
            load: LoadOp::default(),
            clear_color: Color::BLACK,
            clear_depth: 1.0,
        }
    }
}

impl RenderState {
    /// Gives all pixels of a target the clear color and the clear depth.
    pub fn clear<D: Scalar>(&self, target: &mut Target<D>) {
        target.clear(self.clear_color, D::of(self.clear_depth));
    }

    /// The viewport in a framebuffer of this rectangle.
    #[must_use]
    pub fn viewport_in(&self, rect: Rect) -> Viewport {
        self.viewport.unwrap_or_else(|| Viewport::whole(rect))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clearing_gives_both_planes_their_value() {
        let state = RenderState { clear_color: Color::BLUE, clear_depth: 0.25, ..RenderState::default() };
        let mut target = Target::<f32>::sized(2, 1);
        state.clear(&mut target);
        assert_eq!(target.color.get(1, 0), Some(Color::BLUE));
        assert_eq!(target.depth.get(1, 0), Some(0.25));
    }
}
