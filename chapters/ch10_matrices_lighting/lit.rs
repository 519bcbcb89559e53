//! The book's last program: a textured model under a light, and its last exercise, the spike bug.

use glam::{DMat4, DVec3, dvec3};
use rasterbook::cull::CullMode;
use rasterbook::figure::{Canvas, Knob, Subject};
use rasterbook::light::lambert;
use rasterbook::model::ModelVertex;
use rasterbook::payload::{StepClamp, Walk};
use rasterbook::real::each;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, about, rotate_x_to_y, rotate_z_to_y};
use rasterbook::{ClipVertex, Real, RenderState, Shaded, Shader};

use super::degrees;
use super::directions::{LIGHT, light_azimuth, light_elevation, to_light};

pub(super) const KNOBS: &[Knob] = &[
    light_azimuth(45.0),
    light_elevation(35.26),
    Knob::number(
        "ambient",
        0.2,
        [0.0, 1.0],
        "",
        "at 0 the dark side cannot be told from the background, at 1 nothing has a shape",
    ),
];

/// The camera of the book's last chapter.
const CAMERA: Frustum =
    Frustum { left: -1.6, right: 1.6, bottom: -1.2, top: 1.2, near: 2.0, far: 10.0 };
/// Towards the light: from the upper right, behind the eye; of length 1.
const TO_LIGHT: [f64; 3] =
    [0.577_350_269_189_625_8, 0.577_350_269_189_625_8, -0.577_350_269_189_625_8];

// ANCHOR: lit_shader
/// Diffuse light on a texture.
struct Lit {
    clip_from_model: DMat4,
    view_from_model: DMat4,
    texture: Texture,
    to_light: [f64; 3],
    /// The light that is everywhere.
    ambient: f64,
}

impl Shader<5> for Lit {
    type Attributes = ModelVertex;

    fn position(&self, vertex: &ModelVertex) -> Option<DVec3> {
        Some(vertex.position)
    }

    fn vertex(&self, vertex: &ModelVertex) -> ClipVertex<5> {
        // A normal is a direction: with w = 0 it turns and does not move. A rotation is its own
        // inverse transpose.
        let normal = self.view_from_model * vertex.normal.extend(0.0);
        ClipVertex {
            position: self.clip_from_model * vertex.position.extend(1.0),
            varyings: [vertex.uv[0], vertex.uv[1], normal.x, normal.y, normal.z],
        }
    }

    fn fragment<R: Real>(&self, [u, v, nx, ny, nz]: [R; 5]) -> Shaded<R> {
        let diffuse = lambert([nx, ny, nz], R::array_of(self.to_light));
        let brightness = (diffuse + R::of(self.ambient)).min(R::of(1.0));
        let texel = self.texture.nearest([u, v], AddressMode::Repeat);
        Shaded::opaque(each(texel, |_, channel| brightness * channel))
    }
}
// ANCHOR_END: lit_shader

// ANCHOR: model_matrix
/// The turns of a frame, about the point (0, 0, 4): T · Rz · Rx · T⁻¹.
fn turned(frame: u32) -> DMat4 {
    let angle = degrees(f64::from(45 + frame));
    about(dvec3(0.0, 0.0, 4.0), rotate_x_to_y(angle) * rotate_z_to_y(angle))
}
// ANCHOR_END: model_matrix

fn draw_subject(canvas: &mut Canvas, subject: &Subject, walk: Walk) {
    let state = RenderState { cull: CullMode::Back, walk, ..RenderState::default() };
    canvas.clear(&state);
    let view_from_model = turned(canvas.frame);
    let clip_from_model = CAMERA.matrix() * view_from_model;
    let (to_light, ambient) =
        (to_light(&canvas.knobs, LIGHT, TO_LIGHT), canvas.knobs.number("ambient"));
    for part in subject.model.parts.iter() {
        let texture = subject.texture_of(part);
        let shader = Lit { clip_from_model, view_from_model, texture, to_light, ambient };
        canvas.draw(&part.mesh, &shader, &state);
    }
}

/// The model, with the book's remedy, which is the default.
pub(super) fn lit(canvas: &mut Canvas, subject: &Subject) {
    draw_subject(canvas, subject, Walk::default());
}

// ANCHOR: spikes
/// The model, t free to pass the end of an edge.
pub(super) fn spikes(canvas: &mut Canvas, subject: &Subject) {
    draw_subject(canvas, subject, Walk { clamp: StepClamp::Overrun, ..Walk::default() });
}
// ANCHOR_END: spikes
