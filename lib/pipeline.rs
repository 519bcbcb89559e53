//! Chapter 9: the pipeline. From a mesh to a picture in ten stages, each of which is a room of this library.
//!
//! ```
//! use glam::{DVec4, dvec4};
//! use rasterbook::clip::ClipVertex;
//! use rasterbook::mesh::Mesh;
//! use rasterbook::{Color, LoadOp, Real, RenderState, Scanline, Shaded, Shader, Silent, Target, draw};
//!
//! struct White;
//!
//! impl Shader<0> for White {
//!     type Attributes = DVec4;
//!     fn vertex(&self, clip: &DVec4) -> ClipVertex<0> {
//!         ClipVertex { position: *clip, varyings: [] }
//!     }
//!     fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
//!         Shaded::opaque([R::of(255.0); 3])
//!     }
//! }
//!
//! // A triangle whose upper right vertex is cut off by the view volume.
//! let mesh = Mesh::unindexed(vec![dvec4(-1.0, -1.0, 0.0, 1.0), dvec4(1.0, -1.0, 0.0, 1.0), dvec4(2.0, 2.0, 0.0, 1.0)])?;
//! let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
//! let mut target = Target::new(64, 48);
//! draw(&mesh, &White, &state, &Scanline, &mut target, &Silent);
//! assert_eq!(target.color.get(60, 40), Some(Color::WHITE));
//! # Ok::<(), rasterbook::mesh::MeshError>(())
//! ```

use arrayvec::ArrayVec;

use crate::clip::{Assembled, ClipVertex, MAX_VERTICES, NdcVertex, RecordedVertex, clip_triangle, fan};
use crate::mesh::Mesh;
use crate::probe::Probe;
use crate::raster::Rasterizer;
use crate::real::map3;
use crate::shader::Shader;
use crate::state::{LoadOp, RenderState};
use crate::target::Target;

// ANCHOR: draw
/// Draws a mesh into a target.
///
/// Fragments reach a pixel in the order of the triangles in the mesh; of a clipped triangle, in the
/// order of its fan.
///
/// # Panics
/// If a pixel of the target has no depth: its plane of depths is smaller than that of colors.
pub fn draw<S: Shader<N>, Z: Rasterizer, P: Probe + ?Sized, const N: usize>(
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: &RenderState,
    rasterizer: &Z,
    target: &mut Target<Z::Depth>,
    probe: &P,
) {
    if state.load == LoadOp::Clear {
        state.clear(target);
    }

    // 1. Vertex shading: every vertex once, however many triangles share it.
    let shaded: Vec<ClipVertex<N>> = mesh.vertices().iter().map(|it| shader.vertex(it)).collect();

    // 2. Primitive assembly: three vertices make a triangle.
    let triangles = mesh.triangles().map(|triangle| (triangle, map3(triangle, |i| shaded[i])));

    // 3. Clipping, in clip space, where edges and values are still straight.
    let planes = state.clip_volume.planes(state.depth_range);
    let polygons = triangles.map(|(indices, triangle)| {
        probe.assembled(&|| Assembled {
            vertices: RecordedVertex::of_triangle(&triangle),
            model: all_three(map3(indices, |index| shader.position(&mesh.vertices()[index]))),
            planes: planes.to_vec(),
            test: state.clip_test,
        });
        clip_triangle(triangle, &planes, state.clip_test)
    });

    // 4. The perspective divide, and triangles again.
    let pieces = polygons.flat_map(|polygon| {
        let divided: ArrayVec<NdcVertex<N>, MAX_VERTICES> =
            polygon.into_iter().map(NdcVertex::from).collect();
        fan(divided)
    });

    // 5. Culling, 6. viewport, 7. rasterization, 8. fragment shading, 9. depth test, 10. blending.
    rasterizer.draw(pieces, state, shader, target, probe);
}
// ANCHOR_END: draw

fn all_three<T>([a, b, c]: [Option<T>; 3]) -> Option<[T; 3]> {
    Some([a?, b?, c?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_of_a_model_are_told_if_all_three_are_known() {
        assert_eq!(all_three([Some(1), Some(2), Some(3)]), Some([1, 2, 3]));
        assert_eq!(all_three([Some(1), None, Some(3)]), None);
    }
}
