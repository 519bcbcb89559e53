//! How texels are picked.

use glam::{DMat4, dvec3};
use rasterbook::Color;
use rasterbook::clip::ClipVertex;
use rasterbook::mesh::Mesh;
use rasterbook::pipeline::RenderState;
use rasterbook::program::{Canvas, assets};
use rasterbook::real::Real;
use rasterbook::shader::{Shaded, Shader};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, look_at};

// ANCHOR: floor
/// A floor on which a texture is repeated.
struct Floor {
    clip_from_world: DMat4,
    texture: Texture,
}

impl Shader<2> for Floor {
    /// x and z of the floor.
    type Attributes = [f64; 2];

    fn vertex(&self, &[x, z]: &[f64; 2]) -> ClipVertex<2> {
        ClipVertex {
            position: self.clip_from_world * dvec3(x, 0.0, z).extend(1.0),
            varyings: [x / 4.0, z / 4.0],
        }
    }

    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::opaque(self.texture.nearest(uv, AddressMode::Repeat))
    }
}

/// The nearest texel.
pub(super) fn nearest(canvas: &mut Canvas) {
    let view_from_world = look_at(dvec3(0.0, 2.0, -6.0), dvec3(0.6, 1.0, 0.0), glam::DVec3::Y);
    let camera = Frustum { left: -0.8, right: 0.8, bottom: -0.6, top: 0.6, near: 1.0, far: 500.0 };
    let shader = Floor {
        clip_from_world: camera.matrix() * view_from_world,
        texture: assets::texture("bricks.png").expect("an asset"),
    };
    let corners = vec![[-300.0, -10.0], [300.0, -10.0], [300.0, 400.0], [-300.0, 400.0]];
    let state = RenderState { clear_color: Color::rgb(150, 190, 230), ..RenderState::default() };
    let mesh = Mesh::indexed(corners, vec![0, 1, 2, 0, 2, 3]).expect("two triangles");
    canvas.render(&mesh, &shader, &state);
}
// ANCHOR_END: floor
