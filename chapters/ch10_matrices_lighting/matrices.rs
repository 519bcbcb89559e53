//! What matrices do: turn, turn about a point, and put the eye anywhere.

use glam::{DMat4, DVec3, dvec2, dvec3};
use rasterbook::cull::CullMode;
use rasterbook::figure::{Canvas, Knob, Knobs, assets};
use rasterbook::light::lambert;
use rasterbook::model::ModelVertex;
use rasterbook::real::each;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{
    Frustum, Viewport, about, look_at, normal_matrix, rotate_x_to_y, rotate_x_to_z, scale,
    translate,
};
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

use super::degrees;
use super::directions::{direction, is_turned};

pub(super) const ROTATION: &[Knob] = &[Knob::number(
    "angle",
    0.0,
    [-90.0, 90.0],
    "°",
    "added to the frame's: from 76 on we see the back, which is not drawn",
)];

pub(super) const PIVOT: &[Knob] = &[
    Knob::number(
        "step",
        10.0,
        [0.0, 40.0],
        "°",
        "from arrow to arrow: on the left they spread along a circle about the dot, on the right they stay",
    ),
    Knob::point(
        "pivot",
        [690.0, 110.0],
        "the point on the right about which the arrow turns: drag it away, and the arrow circles it",
    ),
];

pub(super) const CAMERA: &[Knob] = &[
    Knob::number(
        "azimuth",
        32.9,
        [-180.0, 180.0],
        "°",
        "the eye goes round; what is in the middle stays there",
    ),
    Knob::number(
        "elevation",
        23.5,
        [2.0, 88.0],
        "°",
        "the eye goes up: vertical edges lean outwards more and more",
    ),
    Knob::number("distance", 11.0, [7.5, 30.0], "", "the eye goes away: what is near shrinks most"),
    Knob::number(
        "field-of-view",
        40.0,
        [10.0, 100.0],
        "°",
        "the view widens, and everything shrinks alike",
    ),
];

/// A textured surface without light.
struct Textured {
    clip_from_model: DMat4,
    texture: Texture,
}

impl Shader<2> for Textured {
    type Attributes = (DVec3, [f64; 2]);

    fn vertex(&self, (position, uv): &(DVec3, [f64; 2])) -> ClipVertex<2> {
        ClipVertex { position: self.clip_from_model * position.extend(1.0), varyings: *uv }
    }

    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::texel(self.texture.nearest_texel(uv, AddressMode::Clamp))
    }
}

// ANCHOR: rotation
/// A triangle turns about the vertical axis through (0, 0, 4).
pub(super) fn rotation(canvas: &mut Canvas) {
    let camera = Frustum { left: -3.2, right: 3.2, bottom: -2.4, top: 2.4, near: 1.0, far: 10.0 };
    let axis = dvec3(0.0, 0.0, 4.0);
    let turn = rotate_x_to_z(degrees(f64::from(canvas.frame) + canvas.knobs.number("angle")));
    // Read from the right: to the origin, turn, back, project.
    let clip_from_model = camera.matrix() * translate(axis) * turn * translate(-axis);

    let points = [(-1.0, 1.0, [0.0, 1.0]), (-1.0, -1.0, [0.0, 0.0]), (1.0, -1.0, [1.0, 0.0])];
    let vertices = points.map(|(x, y, uv)| (dvec3(x, y, 3.0), uv)).to_vec();
    let state = RenderState { cull: CullMode::Back, ..RenderState::default() };
    let shader = Textured { clip_from_model, texture: Texture::book() };
    canvas.render(&Mesh::unindexed(vertices).expect("whole triangles"), &shader, &state);
}
// ANCHOR_END: rotation

/// One color, whatever the light.
struct Plain {
    clip_from_model: DMat4,
    color: Color,
}

impl Shader<0> for Plain {
    type Attributes = [f64; 2];

    fn vertex(&self, &[x, y]: &[f64; 2]) -> ClipVertex<0> {
        ClipVertex { position: self.clip_from_model * dvec3(x, y, 0.0).extend(1.0), varyings: [] }
    }

    fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
        Shaded::opaque(R::array_of(self.color.to_f64()))
    }
}

/// An arrow that points up, its middle at the origin.
const ARROW: [[f64; 2]; 9] = [
    [-0.1, -0.5],
    [0.1, -0.5],
    [0.1, 0.1],
    [-0.1, -0.5],
    [0.1, 0.1],
    [-0.1, 0.1],
    [-0.3, 0.1],
    [0.3, 0.1],
    [0.0, 0.5],
];

// ANCHOR: pivot
/// Nine arrows, each turned by a step more: about the origin on the left, about its middle, or
/// another point, on the right.
pub(super) fn pivot(canvas: &mut Canvas) {
    canvas.clear(&RenderState::default());
    let angle = canvas.knobs.number("step");
    // 100 pixels for a unit; the right panel's origin is at (450, 50).
    let pivot = ((canvas.knobs.point("pivot") - dvec2(450.0, 50.0)) / 100.0).extend(0.0);
    // Two square panels that show −0.5 to 3.5 in both directions, without perspective.
    let clip_from_world = scale(dvec3(0.5, 0.5, 1.0)) * translate(dvec3(-1.5, -1.5, 0.0));
    let place = dvec3(2.4, 0.6, 0.0);
    // The pivot; the arrows hide it as long as it is in their middle.
    draw_dot(canvas, clip_from_world * translate(pivot), 1);
    for step in 0..9 {
        let turn = rotate_x_to_y(degrees(angle * f64::from(step)));
        let tone = 60.0 + 24.0 * f64::from(step);
        let about_origin = turn * translate(place);
        let about_pivot = about(pivot, turn) * translate(place);
        let colors = [[tone, tone / 2.0, 40.0], [40.0, tone * 0.75, tone]].map(Color::truncated);
        let panels = [about_origin, about_pivot].into_iter().zip(colors);
        for (panel, (world_from_model, color)) in (0..).zip(panels) {
            let clip_from_model = clip_from_world * world_from_model;
            draw_flat(canvas, &ARROW, &Plain { clip_from_model, color }, canvas.panel(panel, 2));
        }
    }
    // The origin.
    for panel in 0..2 {
        draw_dot(canvas, clip_from_world, panel);
    }
}
// ANCHOR_END: pivot

/// A white dot at the model's origin.
fn draw_dot(canvas: &mut Canvas, clip_from_model: DMat4, panel: u32) {
    let dot =
        [[-0.04, -0.04], [0.04, -0.04], [0.04, 0.04], [-0.04, -0.04], [0.04, 0.04], [-0.04, 0.04]];
    draw_flat(
        canvas,
        &dot,
        &Plain { clip_from_model, color: Color::WHITE },
        canvas.panel(panel, 2),
    );
}

fn draw_flat(canvas: &mut Canvas, points: &[[f64; 2]], shader: &Plain, panel: Viewport) {
    let state = RenderState { viewport: Some(panel), ..RenderState::default() };
    canvas.draw(&Mesh::unindexed(points.to_vec()).expect("whole triangles"), shader, &state);
}

/// Diffuse light in world space.
struct LitInWorld {
    clip_from_world: DMat4,
    world_from_model: DMat4,
    texture: Texture,
    /// How often the texture is repeated.
    repeat: f64,
}

impl Shader<5> for LitInWorld {
    type Attributes = ModelVertex;

    fn vertex(&self, vertex: &ModelVertex) -> ClipVertex<5> {
        let normal = (normal_matrix(self.world_from_model) * vertex.normal).normalize();
        let world = self.world_from_model * vertex.position.extend(1.0);
        let [u, v] = vertex.uv.map(|coordinate| coordinate * self.repeat);
        ClipVertex {
            position: self.clip_from_world * world,
            varyings: [u, v, normal.x, normal.y, normal.z],
        }
    }

    fn fragment<R: Real>(&self, [u, v, nx, ny, nz]: [R; 5]) -> Shaded<R> {
        let to_light = R::array_of([-0.48, 0.8, -0.36]);
        let brightness = lambert([nx, ny, nz], to_light) * R::of(0.75) + R::of(0.25);
        let texel = self.texture.nearest([u, v], AddressMode::Repeat);
        Shaded::opaque(each(texel, |_, channel| brightness * channel))
    }
}

/// What the camera looks at.
const TARGET: DVec3 = dvec3(0.0, 0.6, 0.5);

/// Where the eye is: of the pinned picture at a place in whole numbers, which the angles come near.
fn eye(knobs: &Knobs) -> DVec3 {
    const NAMES: [&str; 3] = ["azimuth", "elevation", "distance"];
    if !is_turned(knobs, &NAMES) {
        return dvec3(5.5, 5.0, -8.0);
    }
    let [azimuth, elevation, distance] = NAMES.map(|name| knobs.number(name));
    TARGET + distance * direction(azimuth, elevation)
}

// ANCHOR: camera
/// A few things on the ground, seen from the upper right.
pub(super) fn camera(canvas: &mut Canvas) {
    let view_from_world = look_at(eye(&canvas.knobs), TARGET, DVec3::Y);
    let field_of_view = degrees(canvas.knobs.number("field-of-view"));
    let clip_from_view = Frustum::from_field_of_view(field_of_view, 4.0 / 3.0, 1.0, 40.0).matrix();
    let clip_from_world = clip_from_view * view_from_world;

    let state = RenderState {
        cull: CullMode::Back,
        clear_color: Color::rgb(150, 180, 210),
        ..RenderState::default()
    };
    canvas.clear(&state);
    // Each thing: its model and texture, how it is scaled, and where its middle stands.
    let things = [
        ("cube.obj", "bricks.png", dvec3(5.0, 0.1, 5.0), dvec3(0.0, -0.1, 0.0), 6.0),
        ("cube.obj", "letters.png", DVec3::splat(0.8), dvec3(-1.9, 0.8, 1.6), 1.0),
        ("cube.obj", "wood.png", dvec3(0.5, 1.3, 0.5), dvec3(1.7, 1.3, 2.2), 1.0),
        ("sphere.obj", "numbers.png", DVec3::splat(0.9), dvec3(1.6, 0.9, -1.4), 1.0),
        ("pawn.obj", "wood.png", DVec3::splat(0.9), dvec3(-1.3, 1.26, -1.6), 1.0),
    ];
    for (model, texture, size, place, repeat) in things {
        let model = assets::model(model).expect("an asset");
        let texture = assets::texture(texture).expect("an asset");
        // The models stand about (0, 0, 4).
        let world_from_model = translate(place) * scale(size) * translate(dvec3(0.0, 0.0, -4.0));
        for part in model.parts.iter() {
            let shader =
                LitInWorld { clip_from_world, world_from_model, texture: texture.clone(), repeat };
            canvas.draw(&part.mesh, &shader, &state);
        }
    }
}
// ANCHOR_END: camera
