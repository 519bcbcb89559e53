//! Chapter 9: the door that every rasterizer stands behind, and the first of them.
//!
//! A rasterizer takes a stream of triangles in NDC, the state, a shader, a target and a probe. What happens inside
//! (culling, viewport, coverage, interpolation, shading, merging) is its own business: that is where rasterizers
//! differ.
//!
//! ```
//! use glam::{DVec3, dvec3};
//! use rasterbook::Color;
//! use rasterbook::clip::{ClipVertex, NdcVertex};
//! use rasterbook::depth::Target;
//! use rasterbook::pipeline::RenderState;
//! use rasterbook::probe::Silent;
//! use rasterbook::raster::{Rasterizer, Scanline};
//! use rasterbook::real::Real;
//! use rasterbook::shader::{Shaded, Shader};
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
//! let corners = [dvec3(-1.0, -1.0, 0.0), dvec3(1.0, -1.0, 0.0), dvec3(0.0, 1.0, 0.0)];
//! let triangle = corners.map(|position| NdcVertex { position, w: 1.0, varyings: [] });
//! let (state, mut target) = (RenderState::default(), Target::new(32, 24));
//! target.clear(Color::BLACK, state.clear_depth);
//! Scanline.draw([triangle].into_iter(), &state, &Green, &mut target, &Silent);
//! assert_eq!(target.color.get(16, 10), Some(Color::GREEN));
//! ```

use crate::area::{is_drawable, twice_signed_area};
use crate::clip::NdcVertex;
use crate::depth::Target;
use crate::framebuffer::Rounding;
use crate::interpolate::{Projected, step_parameter_and_depth};
use crate::merge::merge;
use crate::mesh::Mesh;
use crate::pipeline::RenderState;
use crate::probe::{FragmentEvent, Probe, Vertex};
use crate::real::Scalar;
use crate::scanline::Corner;
use crate::shader::Shader;
use crate::varyings::{TriangleVaryings, weight_gradients};

/// Draws triangles, NDC → target.
pub trait Rasterizer {
    /// The precision of depths.
    type Depth: Scalar;

    /// Draws the triangles in order, onto what is in the target: the load operation of the state is the pipeline's affair.
    /// Fragments reach a pixel in the order of their triangles.
    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<Self::Depth>,
        probe: &P,
    );

    /// Draws a whole mesh, all stages of the pipeline and the load operation, if the rasterizer has a way of its own to do
    /// so; `false` if not.
    fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        _mesh: &Mesh<S::Attributes>,
        _shader: &S,
        _state: &RenderState,
        _target: &mut Target<Self::Depth>,
    ) -> bool {
        false
    }
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
    let [a, b, c] = triangle.map(|vertex| vertex.position.truncate());
    let signed_area = twice_signed_area(a, b, c);
    probe.piece(triangle.each_ref().map(Vertex::from), signed_area);
    if !is_drawable(signed_area) || state.cull.culls(signed_area, state.front_face) {
        probe.culled();
        return;
    }

    // 6. Viewport: NDC → screen.
    let window = target.color.window();
    let viewport = state.viewport_in(window.rect);
    let corners = triangle.map(|vertex| {
        let projected = Projected { w: vertex.w, values: vertex.varyings };
        Corner {
            position: viewport.pixel_corners(vertex.position),
            attributes: (projected, vertex.position.z),
        }
    });

    // How values change from pixel to pixel, for shaders that ask.
    let varyings = TriangleVaryings::new(triangle, state.interpolation);
    let gradients = weight_gradients(corners.map(|corner| corner.position));

    // 7. Rasterization: which pixels, and which values.
    step_parameter_and_depth(corners, state.interpolation, state.walk, window, |x, y, point, z| {
        // What is not linear on the screen is ω itself, which is interpolated like a value.
        let depth = if state.depth_encoding.is_linear_on_screen() { z } else { point.w };
        // 8. Fragment shading.
        let shaded = if S::USES_DERIVATIVES {
            shader.fragment_with_derivatives(point.values, varyings.derivatives(&point, gradients))
        } else {
            shader.fragment(point.values)
        };
        // 9. Depth test, and 10. blending.
        let verdict = merge(target, state.merge, Rounding::Truncate, [x, y], depth, shaded);
        probe.fragment(&FragmentEvent {
            x,
            y,
            w: point.w,
            depth,
            varyings: &point.values,
            color: shaded.color.channels(),
            verdict,
        });
    });
}
// ANCHOR_END: draw_triangle
