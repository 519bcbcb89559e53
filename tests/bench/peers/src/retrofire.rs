//! The crate `retrofire-core`: rows between two edges.

use retrofire_core::geom::{Tri, tri, vertex};
use retrofire_core::math::mat::ProjMat3;
use retrofire_core::math::{Color4, Vary, Vec3, pt2, pt3, rgba, vec3, viewport};
use retrofire_core::render::raster::Frag;
use retrofire_core::render::tex::{SamplerRepeatPot, Texture};
use retrofire_core::render::{Colorbuf, Context, Framebuf, Model, TexCoord, render, shader, uv};
use retrofire_core::util::pixfmt::Xrgb8888;
use retrofire_core::util::{Buf2, Dims};

use crate::ours::Frame;
use crate::picture::{channels, lit};
use crate::scenes::{Scene, TEXTURE_SIDE, Vertex, texels};

/// Words `0x00RRGGBB`, and depths.
type Canvas = Framebuf<Colorbuf<Buf2<u32>, Xrgb8888>, Buf2<f32>>;

struct Prepared {
    clip_from_view: ProjMat3<Model>,
    vertices: Vec<Vertex>,
    triangles: Vec<Tri<usize>>,
    is_lit: bool,
    texture: Texture<Buf2<Color4>>,
    size: [u32; 2],
    canvas: Canvas,
}

/// Makes a scene ready.
pub(crate) fn prepare(scene: Scene) -> Box<dyn Frame> {
    let Scene { size, clip_from_view, is_lit, vertices, indices } = scene;
    let dims = Dims(size[0], size[1]);
    let triangles =
        indices.chunks_exact(3).map(|c| tri(c[0] as usize, c[1] as usize, c[2] as usize)).collect();
    let texels = texels().into_iter().map(|[r, g, b]| rgba(r, g, b, 255));
    Box::new(Prepared {
        clip_from_view: ProjMat3::new(clip_from_view),
        vertices,
        triangles,
        is_lit,
        texture: Buf2::new_from(Dims(TEXTURE_SIDE, TEXTURE_SIDE), texels).into(),
        size,
        canvas: Framebuf { color_buf: Colorbuf::new(Buf2::new(dims)), depth_buf: Buf2::new(dims) },
    })
}

impl Prepared {
    /// Draws with these varyings and this fragment shader.
    fn render<V: Vary + Clone>(
        &mut self,
        varyings: impl Fn(&Vertex) -> V,
        fragment: impl Fn(&Texture<Buf2<Color4>>, V) -> Color4,
    ) {
        let Self { clip_from_view, vertices, triangles, texture, size, canvas, .. } = self;
        let vertex_shader = |v: Vertex, clip_from_view: &ProjMat3<Model>| {
            let [x, y, z] = v.position;
            vertex(clip_from_view.apply(&pt3(x, y, z)), varyings(&v))
        };
        let fragment_shader = |frag: Frag<V>, _: &ProjMat3<Model>| fragment(texture, frag.var);
        let shader = shader::new(vertex_shader, fragment_shader);
        // Rows are counted upwards, so that fronts run against the clock, as it wants them.
        let screen = viewport(pt2(0, 0)..pt2(size[0], size[1]));
        render(&*triangles, &*vertices, &shader, &*clip_from_view, screen, canvas, &Context::default());
    }
}

impl Frame for Prepared {
    fn draw(&mut self) {
        self.canvas.color_buf.buf.fill(0);
        // It keeps 1/z: 0 is infinitely far.
        self.canvas.depth_buf.fill(0.0);
        let sampler = SamplerRepeatPot::new(&self.texture);
        if self.is_lit {
            self.render(
                |v| {
                    let ([s, t], [x, y, z]) = (v.uv, v.normal);
                    (uv(s, t), vec3(x, y, z))
                },
                move |texture, (uv, normal): (TexCoord, Vec3)| shaded(sampler.sample(texture, uv), normal.0),
            );
        } else {
            self.render(|v| uv(v.uv[0], v.uv[1]), move |texture, uv: TexCoord| sampler.sample(texture, uv));
        }
    }

    fn picture(&mut self) -> Vec<[u8; 3]> {
        self.canvas.color_buf.buf.data().iter().copied().map(channels).collect()
    }
}

/// Diffuse light on a texel.
fn shaded(texel: Color4, normal: [f32; 3]) -> Color4 {
    let [r, g, b, a] = texel.0;
    let [r, g, b] = lit([r, g, b], normal);
    rgba(r, g, b, a)
}
