//! The crate `euc`: every pixel of a triangle's box is asked whether it is inside.

use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingEnabled, Triangles};
use euc::{DepthStrategy, Pipeline, Target};

use crate::ours::Frame;
use crate::picture::{Texels, channels, lit, word};
use crate::scenes::{Scene, Vertex};

/// How triangles are drawn: with a plane of depths, without their backs.
type Method<'a> = Triangles<'a, Buffer2d<f32>, BackfaceCullingEnabled>;

/// What the shaders need. It has no index buffer; a vertex is an index, and is shaded once for each of its triangles.
struct Uniforms {
    clip_from_view: [[f32; 4]; 4],
    vertices: Vec<Vertex>,
    texels: Texels,
}

impl Uniforms {
    fn project(&self, [x, y, z]: [f32; 3]) -> [f32; 4] {
        self.clip_from_view.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
    }
}

/// Diffuse light on the texel.
struct Lit<'a>(&'a Uniforms);

impl Pipeline for Lit<'_> {
    type Vertex = u32;
    type VsOut = ((f32, f32), (f32, f32, f32));
    type Pixel = u32;

    fn vert(&self, index: &u32) -> ([f32; 4], Self::VsOut) {
        let vertex = &self.0.vertices[*index as usize];
        let ([u, v], [x, y, z]) = (vertex.uv, vertex.normal);
        (self.0.project(vertex.position), ((u, v), (x, y, z)))
    }

    fn frag(&self, &((u, v), (x, y, z)): &Self::VsOut) -> u32 {
        word(lit(channels(self.0.texels.nearest([u, v])), [x, y, z]))
    }

    fn get_depth_strategy(&self) -> DepthStrategy {
        DepthStrategy::IfLessWrite
    }
}

/// The texel.
struct Unlit<'a>(&'a Uniforms);

impl Pipeline for Unlit<'_> {
    type Vertex = u32;
    type VsOut = (f32, f32);
    type Pixel = u32;

    fn vert(&self, index: &u32) -> ([f32; 4], Self::VsOut) {
        let vertex = &self.0.vertices[*index as usize];
        (self.0.project(vertex.position), vertex.uv.into())
    }

    fn frag(&self, &(u, v): &Self::VsOut) -> u32 {
        self.0.texels.nearest([u, v])
    }
}

struct Prepared {
    uniforms: Uniforms,
    indices: Vec<u32>,
    is_lit: bool,
    color: Buffer2d<u32>,
    depth: Buffer2d<f32>,
}

/// Makes a scene ready.
pub(crate) fn prepare(scene: Scene) -> Box<dyn Frame> {
    let size = scene.size.map(|side| side as usize);
    let Scene { clip_from_view, is_lit, vertices, indices, .. } = scene;
    let uniforms = Uniforms { clip_from_view, vertices, texels: Texels::new() };
    let (color, depth) = (Buffer2d::new(size, 0), Buffer2d::new(size, 1.0));
    Box::new(Prepared { uniforms, indices, is_lit, color, depth })
}

impl Frame for Prepared {
    fn draw(&mut self) {
        let Self { uniforms, indices, is_lit, color, depth } = self;
        color.clear(0);
        depth.clear(1.0);
        if *is_lit {
            Lit(uniforms).draw::<Method<'_>, _>(indices, color, Some(depth));
        } else {
            Unlit(uniforms).draw::<Method<'_>, _>(indices, color, Some(depth));
        }
    }

    fn picture(&mut self) -> Vec<[u8; 3]> {
        // Its first row is the highest.
        let rows = self.color.as_ref().chunks_exact(self.color.size()[0]);
        rows.rev().flatten().copied().map(channels).collect()
    }
}
