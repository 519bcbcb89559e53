//! Normals from a picture: a flat wall whose bricks stand out.

use glam::{DMat4, DVec3, dvec3};
use rasterbook::figure::{Canvas, Knob, assets};
use rasterbook::light::{Highlight, Light, Material, mapped_normal, normalize};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, normal_matrix, rotate_x_to_z, translate};
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

use super::degrees;

pub(super) const KNOBS: &[Knob] = &[
    Knob::number(
        "strength",
        1.0,
        [-2.0, 3.0],
        "",
        "of the map: at 0 the right wall is flat too, below 0 its bricks lie deeper than the joints",
    ),
    Knob::number(
        "lamp-x",
        0.0,
        [-1.5, 1.5],
        "",
        "the lamp moves to the right: the bright side of each brick is where the lamp is",
    ),
    Knob::number(
        "lamp-y",
        0.5,
        [-1.2, 1.2],
        "",
        "the lamp moves up: upper and lower borders of the bricks change their brightness",
    ),
];

const CAMERA: Frustum =
    Frustum { left: -1.6, right: 1.6, bottom: -1.2, top: 1.2, near: 2.0, far: 20.0 };
const CLAY: Material = Material {
    ambient: 0.12,
    diffuse: 0.9,
    specular: 0.25,
    exponent: 20.0,
    highlight: Highlight::BlinnPhong,
};

// ANCHOR: wall
/// A flat wall under the lamp; all vectors in camera space.
struct Wall {
    view_from_model: DMat4,
    /// Where u grows, where v grows, and off the wall: tangent, bitangent and normal, of length 1.
    axes: [DVec3; 3],
    colors: Texture,
    normals: Texture,
    /// How far the map makes normals lean: 1 as it says.
    strength: f64,
    /// In camera space.
    lamp: Light,
}

impl Wall {
    fn new(view_from_model: DMat4, normals: Texture, strength: f64, lamp: Light) -> Self {
        let turn = normal_matrix(view_from_model);
        // The wall lies in the plane of x and y and turns its front to −z, to us.
        let axes = [DVec3::X, DVec3::Y, DVec3::NEG_Z].map(|axis| (turn * axis).normalize());
        let colors = assets::texture("bricks.png").expect("an asset");
        Self { view_from_model, axes, colors, normals, strength, lamp }
    }
}

impl Shader<5> for Wall {
    /// x and y of the wall, which are its texture coordinates too.
    type Attributes = [f64; 2];

    fn position(&self, &[x, y]: &[f64; 2]) -> Option<DVec3> {
        Some(dvec3(x, y, 0.0))
    }

    fn vertex(&self, &[x, y]: &[f64; 2]) -> ClipVertex<5> {
        let view = (self.view_from_model * dvec3(x, y, 0.0).extend(1.0)).truncate();
        ClipVertex {
            position: CAMERA.matrix() * view.extend(1.0),
            varyings: [view.x, view.y, view.z, x, y],
        }
    }

    fn fragment<R: Real>(&self, [x, y, z, u, v]: [R; 5]) -> Shaded<R> {
        let place = [x, y, z];
        let uv = [u * R::of(0.5), v * R::of(0.5)];
        let [tangent, bitangent, upright] = self.axes;
        let axes = [tangent * self.strength, bitangent * self.strength, upright];
        let axes = axes.map(|axis| R::array_of(axis.to_array()));
        let normal = mapped_normal(self.normals.bilinear(uv, AddressMode::Repeat), axes);
        let color = self.colors.bilinear(uv, AddressMode::Repeat);
        let to_eye = normalize([-x, -y, -z]);
        Shaded::opaque(CLAY.shade(color, normal, self.lamp.at(place), to_eye))
    }
}
// ANCHOR_END: wall

/// Two walls that meet: on the left one normal for all, on the right one for every texel.
pub(super) fn normal_mapped(canvas: &mut Canvas) {
    let state = RenderState { clear_color: Color::gray(20), ..RenderState::default() };
    canvas.clear(&state);
    let [strength, x, y] = ["strength", "lamp-x", "lamp-y"].map(|name| canvas.knobs.number(name));
    let lamp = Light::Point { position: [x, y, 2.4], intensity: 3.4 };
    let straight_up = Texture::new(1, 1, vec![Color::rgb(128, 128, 255)]);
    let mapped = assets::texture("bricks-normals.png").expect("an asset");
    for (side, normals) in [(-1.0, straight_up), (1.0, mapped)] {
        let place = translate(dvec3(1.52 * side, 0.0, 4.0)) * rotate_x_to_z(degrees(-25.0 * side));
        let vertices = vec![[-1.5, -1.6], [1.5, -1.6], [1.5, 1.6], [-1.5, 1.6]];
        let mesh = Mesh::indexed(vertices, vec![0, 1, 2, 0, 2, 3]).expect("two triangles");
        canvas.draw(&mesh, &Wall::new(place, normals, strength, lamp), &state);
    }
}
