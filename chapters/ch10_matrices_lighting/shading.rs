//! Where light is computed (faces, vertices, pixels), which highlight there is, and how normals are turned.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DMat4, DVec3, dvec3};
use rasterbook::cull::CullMode;
use rasterbook::figure::{Canvas, Knob, Knobs};
use rasterbook::light::{Highlight, Light, Material, normalize};
use rasterbook::transform::{Frustum, normal_matrix, rotate_x_to_y, scale, translate};
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

use super::degrees;
use super::directions::{LIGHT, light_azimuth, light_elevation, to_light};

const EXPONENT: Knob = Knob::number(
    "exponent",
    24.0,
    [1.0, 200.0],
    "",
    "the highlight becomes small and sharp; in 'gouraud' the coarse ball then has next to none",
);
const RINGS: Knob = Knob::whole(
    "rings",
    7,
    [3, 24],
    "rings",
    "the coarse ball gets more faces: with light at its vertices it comes to look like the fine one",
);
const ANGLES: [Knob; 2] = [light_azimuth(-29.1), light_elevation(36.1)];

pub(super) const TWO_BALLS: &[Knob] = &[EXPONENT, RINGS, ANGLES[0], ANGLES[1]];

pub(super) const HIGHLIGHTS: &[Knob] = &[
    EXPONENT,
    Knob::number(
        "broad-exponent",
        0.5,
        [0.1, 8.0],
        "",
        "that of the ball below: the smaller, the harder the edge of Phong's highlight",
    ),
    ANGLES[0],
    ANGLES[1],
];

pub(super) const DISTANCE: &[Knob] = &[
    Knob::number(
        "lamp-x",
        -2.8,
        [-2.8, 2.8],
        "",
        "the lamp goes along the lower row: the ball next to it is bright",
    ),
    Knob::number(
        "lamp-z",
        3.9,
        [1.0, 5.2],
        "",
        "the lamp comes closer: the nearest ball outshines the next ones; far away all are dim alike",
    ),
];

pub(super) const NORMALS: &[Knob] = &[
    Knob::number(
        "scale-x",
        2.3,
        [0.3, 2.6],
        "",
        "at 1.6, with scale-y=1.6, it is a ball, and the mistake cannot be seen",
    ),
    Knob::number(
        "scale-y",
        0.55,
        [0.1, 2.3],
        "",
        "the flatter the ball, the more its normals should turn up",
    ),
];

/// A point of a ball of radius 1, and the normal that goes with it.
#[derive(Clone, Copy)]
struct BallVertex {
    position: DVec3,
    normal: DVec3,
}

/// A ball of so many rings and segments.
fn ball(rings: u32, segments: u32) -> Mesh<BallVertex> {
    let point = |ring: u32, segment: u32| {
        let (up, round) = (
            PI * f64::from(ring) / f64::from(rings),
            TAU * f64::from(segment) / f64::from(segments),
        );
        dvec3(libm::sin(up) * libm::sin(round), -libm::cos(up), -libm::sin(up) * libm::cos(round))
    };
    let mut vertices = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let [a, b] = [point(ring, segment), point(ring, segment + 1)];
            let [c, d] = [point(ring + 1, segment + 1), point(ring + 1, segment)];
            for point in [a, b, c, a, c, d] {
                vertices.push(BallVertex { position: point, normal: point });
            }
        }
    }
    Mesh::unindexed(vertices).expect("whole triangles")
}

/// The same ball with the normals of its faces.
fn faceted(ball: &Mesh<BallVertex>) -> Mesh<BallVertex> {
    let mut vertices = Vec::new();
    for triangle in ball.vertices().chunks_exact(3) {
        let [a, b, c] = [triangle[0].position, triangle[1].position, triangle[2].position];
        let normal = (c - a).cross(b - a).normalize_or(DVec3::Y);
        vertices.extend([a, b, c].map(|position| BallVertex { position, normal }));
    }
    Mesh::unindexed(vertices).expect("whole triangles")
}

// ANCHOR: frequency
/// Where light is computed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Frequency {
    /// In the vertex shader; colors are interpolated (Gouraud, 1971). With the normals of faces:
    /// flat shading.
    Vertex,
    /// In the fragment shader; normals are interpolated (Phong, 1975).
    Fragment,
}

/// A lit ball; all vectors in camera space, the eye at its origin.
struct Ball {
    clip_from_view: DMat4,
    view_from_model: DMat4,
    normals: DMat3,
    frequency: Frequency,
    material: Material,
    color: [f64; 3],
    light: Light,
}

impl Ball {
    fn light<R: Real>(&self, view: [R; 3], normal: [R; 3]) -> [R; 3] {
        let [x, y, z] = view;
        let to_eye = normalize([-x, -y, -z]);
        self.material.shade(R::array_of(self.color), normalize(normal), self.light.at(view), to_eye)
    }
}

impl Shader<6> for Ball {
    type Attributes = BallVertex;

    fn position(&self, vertex: &BallVertex) -> Option<DVec3> {
        Some(vertex.position)
    }

    fn vertex(&self, vertex: &BallVertex) -> ClipVertex<6> {
        let view = self.view_from_model * vertex.position.extend(1.0);
        let normal = self.normals * vertex.normal;
        let (view3, normal) = (view.truncate().to_array(), normal.to_array());
        let varyings = match self.frequency {
            Frequency::Vertex => {
                let [r, g, b] = self.light(view3, normal);
                [r, g, b, 0.0, 0.0, 0.0]
            }
            Frequency::Fragment => [view3[0], view3[1], view3[2], normal[0], normal[1], normal[2]],
        };
        ClipVertex { position: self.clip_from_view * view, varyings }
    }

    fn fragment<R: Real>(&self, [a, b, c, nx, ny, nz]: [R; 6]) -> Shaded<R> {
        Shaded::opaque(match self.frequency {
            Frequency::Vertex => [a, b, c],
            Frequency::Fragment => self.light([a, b, c], [nx, ny, nz]),
        })
    }
}
// ANCHOR_END: frequency

const CAMERA: Frustum =
    Frustum { left: -1.6, right: 1.6, bottom: -1.2, top: 1.2, near: 2.0, far: 20.0 };
const SHINY: Material = Material {
    ambient: 0.15,
    diffuse: 0.65,
    specular: 0.7,
    exponent: 24.0,
    highlight: Highlight::Phong,
};
const CORAL: [f64; 3] = [215.0, 90.0, 70.0];
const TEAL: [f64; 3] = [60.0, 140.0, 150.0];

fn state() -> RenderState {
    RenderState { cull: CullMode::Back, clear_color: Color::gray(28), ..RenderState::default() }
}

/// Towards the light of most figures.
fn light(knobs: &Knobs) -> Light {
    Light::Directional(to_light(knobs, LIGHT, normalize([-0.5, 0.75, -0.9])))
}

/// A ball of some material at a place, which is its middle in camera space, and its radius.
fn ball_at(
    place: DVec3,
    radius: f64,
    color: [f64; 3],
    frequency: Frequency,
    material: Material,
    light: Light,
) -> Ball {
    let view_from_model = translate(place) * scale(DVec3::splat(radius));
    Ball {
        clip_from_view: CAMERA.matrix(),
        view_from_model,
        normals: normal_matrix(view_from_model),
        frequency,
        material,
        color,
        light,
    }
}

/// A coarse ball on the left and a fine one on the right.
fn two_balls(canvas: &mut Canvas, frequency: Frequency, is_faceted: bool) {
    canvas.clear(&state());
    let shiny = Material { exponent: canvas.knobs.number("exponent"), ..SHINY };
    let (coarse, light) = (canvas.knobs.whole("rings").unsigned_abs(), light(&canvas.knobs));
    for (x, color, rings, segments) in
        [(-1.55, CORAL, coarse, coarse * 10 / 7), (1.55, TEAL, 24, 36)]
    {
        let mesh = ball(rings, segments);
        let mesh = if is_faceted { faceted(&mesh) } else { mesh };
        canvas.draw(
            &mesh,
            &ball_at(dvec3(x, 0.0, 5.0), 1.4, color, frequency, shiny, light),
            &state(),
        );
    }
}

/// The normals of the faces.
pub(super) fn flat(canvas: &mut Canvas) {
    two_balls(canvas, Frequency::Vertex, true);
}

/// Light at the vertices.
pub(super) fn gouraud(canvas: &mut Canvas) {
    two_balls(canvas, Frequency::Vertex, false);
}

/// Light at every pixel.
pub(super) fn phong(canvas: &mut Canvas) {
    highlights(canvas, Highlight::Phong);
}

/// The same with the half vector.
pub(super) fn blinn_phong(canvas: &mut Canvas) {
    highlights(canvas, Highlight::BlinnPhong);
}

// ANCHOR: highlights
/// Above, a coarse and a fine ball; below, a dull floor-like ball under light from behind, with a
/// broad highlight.
fn highlights(canvas: &mut Canvas, highlight: Highlight) {
    canvas.clear(&state());
    let [exponent, broad] = ["exponent", "broad-exponent"].map(|name| canvas.knobs.number(name));
    let (shiny, light) = (Material { exponent, highlight, ..SHINY }, light(&canvas.knobs));
    for (x, color, rings, segments) in [(-1.55, CORAL, 7, 10), (1.55, TEAL, 24, 36)] {
        let shader = ball_at(dvec3(x, 1.0, 6.0), 1.35, color, Frequency::Fragment, shiny, light);
        canvas.draw(&ball(rings, segments), &shader, &state());
    }
    // The flattened ball below is so large that we see a slope of it, and the light comes low from
    // behind us.
    let broad =
        Material { ambient: 0.05, diffuse: 0.25, specular: 0.8, exponent: broad, highlight };
    let low = Light::Directional(normalize([-0.9, 0.25, -0.6]));
    let view_from_model = translate(dvec3(0.0, -2.2, 6.0)) * scale(dvec3(3.2, 1.2, 2.0));
    let grazing = Ball {
        view_from_model,
        normals: normal_matrix(view_from_model),
        ..ball_at(DVec3::ZERO, 1.0, [120.0, 120.0, 130.0], Frequency::Fragment, broad, low)
    };
    canvas.draw(&ball(40, 60), &grazing, &state());
}
// ANCHOR_END: highlights

// ANCHOR: distance
/// Two rows of balls: parallel light above, a lamp in front of the ball on the left below.
pub(super) fn distance(canvas: &mut Canvas) {
    canvas.clear(&state());
    let dull = Material { highlight: Highlight::None, ambient: 0.1, diffuse: 0.9, ..SHINY };
    let mesh = ball(24, 36);
    let [lamp_x, lamp_z] = ["lamp-x", "lamp-z"].map(|name| canvas.knobs.number(name));
    for (y, color) in [(1.1, TEAL), (-1.1, CORAL)] {
        for i in 0..5 {
            let place = dvec3(-2.8 + 1.4 * f64::from(i), y, 6.0);
            let lamp = Light::Point { position: [lamp_x, y, lamp_z], intensity: 3.0 };
            let light = if y > 0.0 { Light::Directional([0.0, 0.0, -1.0]) } else { lamp };
            canvas.draw(
                &mesh,
                &ball_at(place, 0.62, color, Frequency::Fragment, dull, light),
                &state(),
            );
        }
    }
}
// ANCHOR_END: distance

// ANCHOR: normals
/// A flattened, tilted ball; `normals` makes of the model matrix what turns its normals.
fn flattened(canvas: &mut Canvas, normals: impl Fn(DMat4) -> DMat3) {
    canvas.clear(&state());
    let dull = Material { highlight: Highlight::None, ambient: 0.15, diffuse: 0.85, ..SHINY };
    let [x, y] = ["scale-x", "scale-y"].map(|name| canvas.knobs.number(name));
    let tilt = rotate_x_to_y(degrees(15.0));
    let view_from_model = translate(dvec3(0.0, 0.0, 5.0)) * tilt * scale(dvec3(x, y, 1.6));
    let light = Light::Directional(normalize([-0.2, 1.0, -0.5]));
    let shader = Ball {
        view_from_model,
        normals: normals(view_from_model),
        ..ball_at(DVec3::ZERO, 1.0, [225.0, 190.0, 120.0], Frequency::Fragment, dull, light)
    };
    canvas.draw(&ball(40, 60), &shader, &state());
}

/// By the inverse transpose.
pub(super) fn normals(canvas: &mut Canvas) {
    flattened(canvas, normal_matrix);
}

/// By the model matrix, a mistake under a scale that is not the same in all directions.
pub(super) fn normals_wrong(canvas: &mut Canvas) {
    flattened(canvas, DMat3::from_mat4);
}
// ANCHOR_END: normals
