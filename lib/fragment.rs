//! Chapter 9: what is done with a fragment, whichever rasterizer has found it: stages 8 to 10.
//!
//! Behind the rasterizer: takes a pixel, and what has been interpolated there; shades, tests the depth, blends, writes
//! into the target, and reports.

use crate::interpolate::Projected;
use crate::merge::{Rounding, merge};
use crate::probe::{Fragment, Probe};
use crate::real::Scalar;
use crate::rect::Pixel;
use crate::shader::Shader;
use crate::state::RenderState;
use crate::target::Target;
use crate::varyings::Derivatives;

/// What the fragments of a picture share.
pub(crate) struct FragmentStages<'a, R: Scalar, S, P: ?Sized> {
    pub(crate) shader: &'a S,
    pub(crate) state: &'a RenderState,
    pub(crate) rounding: Rounding,
    pub(crate) target: &'a mut Target<R>,
    pub(crate) probe: &'a P,
}

impl<R: Scalar, S, P: Probe + ?Sized> FragmentStages<'_, R, S, P> {
    // ANCHOR: fragment
    /// Draws a fragment: `point` has been interpolated like any value, `z` linearly on the screen;
    /// `derivatives` says how the varyings change from pixel to pixel, for shaders that ask.
    #[inline(always)]
    pub(crate) fn draw<const N: usize>(
        &mut self,
        pixel: Pixel,
        point: Projected<R, N>,
        z: R,
        derivatives: impl FnOnce(&Projected<R, N>) -> Derivatives<R, N>,
    ) where
        S: Shader<N>,
    {
        // What is not linear on the screen is w itself.
        let depth = if self.state.depth_encoding.is_linear_on_screen() { z } else { point.w };
        // 8. Fragment shading.
        let shaded = if S::USES_DERIVATIVES {
            self.shader.fragment_with_derivatives(point.values, derivatives(&point))
        } else {
            self.shader.fragment(point.values)
        };
        // 9. Depth test, and 10. blending.
        let verdict = merge(self.target, self.state.merge, self.rounding, pixel, depth, shaded);
        self.probe.fragment(pixel, &|| Fragment {
            w: point.w.into(),
            depth: depth.into(),
            varyings: point.values.map(Into::into).to_vec(),
            color: shaded.color.channels().map(Into::into),
            verdict,
        });
    }
    // ANCHOR_END: fragment
}
