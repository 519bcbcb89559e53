//! Chapter 9: the pipeline. From a mesh to a picture in ten stages, each of which is a room of this library.
//!
//! ```
//! use glam::{DVec4, dvec4};
//! use rasterbook::clip::ClipVertex;
//! use rasterbook::depth::Target;
//! use rasterbook::mesh::Mesh;
//! use rasterbook::pipeline::{LoadOp, RenderState, draw};
//! use rasterbook::probe::Silent;
//! use rasterbook::raster::Scanline;
//! use rasterbook::real::Real;
//! use rasterbook::shader::{Shaded, Shader};
//! use rasterbook::Color;
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
//! // A triangle whose upper right corner is cut off by the view volume.
//! let mesh = Mesh::unindexed(vec![dvec4(-1.0, -1.0, 0.0, 1.0), dvec4(1.0, -1.0, 0.0, 1.0), dvec4(2.0, 2.0, 0.0, 1.0)])?;
//! let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
//! let mut target = Target::new(64, 48);
//! draw(&mesh, &White, &state, &Scanline, &mut target, &Silent);
//! assert_eq!(target.color.get(60, 40), Some(Color::WHITE));
//! # Ok::<(), rasterbook::mesh::MeshError>(())
//! ```

use arrayvec::ArrayVec;

use crate::area::Winding;
use crate::clip::{
    ClipTest, ClipVertex, ClipVolume, DepthRange, MAX_VERTICES, NdcVertex, clip_triangle, fan,
};
use crate::cull::CullMode;
use crate::depth::{DepthEncoding, Target};
use crate::interpolate::Interpolation;
use crate::merge::Merge;
use crate::mesh::Mesh;
use crate::probe::{Assembled, Probe, Vertex};
use crate::raster::Rasterizer;
use crate::real::Real;
use crate::scanline::Walk;
use crate::shader::Shader;
use crate::transform::Viewport;
use crate::{Color, Rect};

/// What is in the target when drawing begins.
///
/// A rasterizer that draws a part of the picture at a time, as GPUs with tiles and [`tiled`](crate::tiled) do, can clear
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
/// use rasterbook::pipeline::RenderState;
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
    /// The viewport in a framebuffer of this rectangle.
    #[must_use]
    pub fn viewport_in(&self, rect: Rect) -> Viewport {
        self.viewport.unwrap_or_else(|| Viewport::whole(rect))
    }
}

// ANCHOR: draw
/// Draws a mesh into a target.
///
/// Fragments reach a pixel in the order of the triangles in the mesh; of a clipped triangle, in the order of its fan.
pub fn draw<S: Shader<N>, Z: Rasterizer, P: Probe + ?Sized, const N: usize>(
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: &RenderState,
    rasterizer: &Z,
    target: &mut Target<Z::Depth>,
    probe: &P,
) {
    // A rasterizer may do all of it in a way of its own: then the picture is the same.
    if rasterizer.draw_mesh(mesh, shader, state, target) {
        return;
    }
    if state.load == LoadOp::Clear {
        target.clear(state.clear_color, Z::Depth::of(state.clear_depth));
    }

    // 1. Vertex shading: every vertex once, however many triangles share it.
    let shaded: Vec<ClipVertex<N>> = mesh.vertices().iter().map(|vertex| shader.vertex(vertex)).collect();

    // 2. Primitive assembly: three vertices make a triangle.
    let triangles = mesh.triangles().map(|triangle| (triangle, triangle.map(|index| shaded[index])));

    // 3. Clipping, in clip space, where edges and values are still straight.
    let planes = state.clip_volume.planes(state.depth_range);
    let polygons = triangles.map(|(indices, triangle)| {
        probe.assembled(&Assembled {
            vertices: triangle.each_ref().map(Vertex::from),
            model: &|| all_three(indices.map(|index| shader.position(&mesh.vertices()[index]))),
            planes: &planes,
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
