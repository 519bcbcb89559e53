//! Chapter 9: the trait of all rasterizers, and the first of them.
//!
//! A rasterizer takes a stream of triangles in NDC, the state, a shader, a target and a probe. What happens inside
//! (culling, viewport, coverage, interpolation, shading, merging) is its own business: that is where rasterizers
//! differ.
//!
//! ```
//! use glam::{DVec3, dvec3};
//! use rasterbook::clip::NdcVertex;
//! use rasterbook::raster::Rasterizer;
//! use rasterbook::{ClipVertex, Color, Real, RenderState, Scanline, Shaded, Shader, Silent, Target};
//!
//! struct Green;
//!
//! impl Shader<0> for Green {
//!     type Attributes = DVec3;
//!     fn vertex(&self, ndc: &DVec3) -> ClipVertex<0> {
//!         ClipVertex { position: ndc.extend(1.0), varyings: [] }
//!     }
//!     fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
//!         Shaded::opaque([0.0, 255.0, 0.0].map(R::of))
//!     }
//! }
//!
//! // One triangle in NDC, as it comes from clipping and the divide.
//! let positions = [dvec3(-1.0, -1.0, 0.0), dvec3(1.0, -1.0, 0.0), dvec3(0.0, 1.0, 0.0)];
//! let triangle = positions.map(|position| NdcVertex { position, w: 1.0, varyings: [] });
//! let (state, mut target) = (RenderState::default(), Target::new(32, 24));
//! target.clear(Color::BLACK, state.clear_depth);
//! Scanline.draw([triangle].into_iter(), &state, &Green, &mut target, &Silent);
//! assert_eq!(target.color.get(16, 10), Some(Color::GREEN));
//! ```

use crate::area::{is_drawable, twice_signed_area};
use crate::clip::{NdcVertex, RecordedVertex};
use crate::fragment::FragmentStages;
use crate::interpolate::{Projected, ScreenVertex, step_parameter_and_depth};
use crate::merge::Rounding;
use crate::probe::{Piece, Probe};
use crate::real::{Scalar, map3};
use crate::shader::Shader;
use crate::state::RenderState;
use crate::target::Target;
use crate::varyings::{TriangleVaryings, weight_gradients};

/// Draws triangles, NDC → target.
pub trait Rasterizer {
    /// The precision of depths.
    type Depth: Scalar;

    /// Draws the triangles in order, onto what is in the target: the load operation of the state is the pipeline's affair.
    /// Fragments reach a pixel in the order of their triangles.
    ///
    /// # Panics
    /// If a pixel of the target has no depth: its plane of depths is smaller than that of colors.
    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<Self::Depth>,
        probe: &P,
    );
}

/// The book's rasterizer: rows between two edges, from chapter 2, with everything that has come since.
///
/// Pixels sit on whole coordinates, and a row that holds a fractional middle vertex belongs to both halves of its
/// triangle: where blending makes that visible, use whole-pixel vertices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scanline;

impl Rasterizer for Scanline {
    type Depth = f64;

    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target,
        probe: &P,
    ) {
        target.assert_depths();
        for triangle in triangles {
            draw_triangle(&triangle, state, shader, target, probe);
        }
    }
}

// ANCHOR: draw_triangle
fn draw_triangle<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
    triangle: &[NdcVertex<N>; 3],
    state: &RenderState,
    shader: &S,
    target: &mut Target,
    probe: &P,
) {
    // 5. Culling, by the signed area in NDC.
    let [a, b, c] = map3(*triangle, |vertex| vertex.position.truncate());
    let signed_area = twice_signed_area(a, b, c);
    probe.piece(&|| Piece { vertices: RecordedVertex::of_triangle(triangle), signed_area });
    if !is_drawable(signed_area) || state.cull.culls(signed_area, state.front_face) {
        probe.culled();
        return;
    }

    // 6. Viewport: NDC → screen.
    let scissor = target.color.scissor();
    let viewport = state.viewport_in(scissor.rect);
    let on_screen = map3(*triangle, |vertex| {
        let projected = Projected { w: vertex.w, values: vertex.varyings };
        let position = viewport.pixel_corners(vertex.position);
        ScreenVertex { position, varyings: (projected, vertex.position.z) }
    });

    // How values change from pixel to pixel, for shaders that ask.
    let varyings = TriangleVaryings::new(triangle, state.interpolation);
    let gradients = weight_gradients(map3(on_screen, |vertex| vertex.position));

    // 7. Rasterization: which pixels, and which values. Each fragment goes through stages 8 to 10.
    let mut stages = FragmentStages { shader, state, rounding: Rounding::Truncate, target, probe };
    step_parameter_and_depth(on_screen, state.interpolation, state.walk, scissor, |x, y, point, z| {
        stages.draw((x, y), point, z, |point| varyings.derivatives(point, gradients));
    });
}
// ANCHOR_END: draw_triangle

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::ClipVertex;
    use crate::color::Color;
    use crate::cull::CullMode;
    use crate::probe::Silent;
    use crate::shader;
    use glam::{DVec3, dvec3};

    /// Whether something is drawn of a triangle in NDC, where all of those that are drawn have the middle pixel.
    fn is_drawn(positions: [DVec3; 3], cull: CullMode) -> bool {
        let white = shader::from_fn(
            |ndc: &DVec3| ClipVertex { position: ndc.extend(1.0), varyings: [] },
            |_: [f64; 0]| [255.0; 3],
        );
        let triangle = positions.map(|position| NdcVertex { position, w: 1.0, varyings: [] });
        let (state, mut target) = (RenderState { cull, ..RenderState::default() }, Target::new(16, 16));
        state.clear(&mut target);
        Scanline.draw([triangle].into_iter(), &state, &white, &mut target, &Silent);
        target.color.get(8, 8) == Some(Color::WHITE)
    }

    #[test]
    fn fronts_backs_and_what_has_no_area() {
        let [a, b, c] = [dvec3(-1.0, -1.0, 0.0), dvec3(1.0, -1.0, 0.0), dvec3(0.0, 1.0, 0.0)];
        let (front, back, line) = ([a, b, c], [a, c, b], [a, a, c]);
        let drawn = |cull| [front, back, line].map(|triangle| is_drawn(triangle, cull));
        assert_eq!(drawn(CullMode::None), [true, true, false]);
        assert_eq!(drawn(CullMode::Back), [true, false, false]);
        assert_eq!(drawn(CullMode::Front), [false, true, false]);
    }
}
