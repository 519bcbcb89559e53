//! Everything at once: matrices, a look-at camera, light, textures with mip maps, a depth buffer, and blending.

use std::array::from_fn;
use std::sync::LazyLock;

use glam::{DMat4, DVec3, dvec3};
use rasterbook::area::Winding;
use rasterbook::cull::CullMode;
use rasterbook::figure::{Canvas, Knob, assets};
use rasterbook::light::{blinn_phong, dot, lambert, normalize, subtract};
use rasterbook::merge::{Blend, Merge};
use rasterbook::mipmap::MipMaps;
use rasterbook::model::ModelVertex;
use rasterbook::real::each;
use rasterbook::srgb::{decode, encode};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, look_at, normal_matrix, rotate_x_to_z, scale, translate};
use rasterbook::varyings::Derivatives;
use rasterbook::{ClipVertex, Color, LoadOp, Mesh, Real, RenderState, Shaded, Shader};

use super::degrees;
use super::directions::to_light;

pub(super) const KNOBS: &[Knob] = &[
    Knob::number(
        "azimuth",
        -28.0,
        [-180.0, 180.0],
        "°",
        "the eye goes round: the reflections stay below their pieces",
    ),
    Knob::number(
        "height",
        2.3,
        [0.3, 8.0],
        "",
        "that of the eye: from above, the reflections hide below their pieces",
    ),
    Knob::number(
        "opacity",
        0.86,
        [0.0, 1.0],
        "",
        "that of the board: at 1 nothing is reflected, at 0 pieces stand on their heads below a board of glass",
    ),
    Knob::number(
        "sun-azimuth",
        -126.9,
        [-180.0, 180.0],
        "°",
        "the sun goes round: shadows point away from it",
    ),
    Knob::number("sun-elevation", 36.9, [8.0, 90.0], "°", "the sun goes up: shadows become short"),
];

/// Towards the light: from the upper left, a little from behind; of length 1.
const TO_LIGHT: [f64; 3] = [-0.640, 0.600, 0.480];
/// The light of the sun, and that of the sky, which comes from everywhere.
const SUN: [f64; 3] = [1.7, 1.55, 1.3];
const SKY: [f64; 3] = [0.1, 0.125, 0.17];
/// What is far away fades into this color.
const HORIZON: Color = Color::rgb(205, 214, 222);

/// A ball that shadows the floor: its center and its radius.
type Ball = ([f64; 3], f64);

/// What is the same for all things of a frame.
#[derive(Clone)]
struct View {
    clip_from_world: DMat4,
    eye: [f64; 3],
    to_light: [f64; 3],
}

/// A polished thing.
struct Thing {
    view: View,
    world_from_model: DMat4,
    texture: MipMaps,
    /// Multiplies the texture.
    tint: [f64; 3],
    /// How often the texture is repeated.
    repeat: [f64; 2],
}

/// Varyings: the place in the world, the normal there, and texture coordinates.
impl Shader<8> for Thing {
    type Attributes = ModelVertex;
    const USES_DERIVATIVES: bool = true;

    fn vertex(&self, vertex: &ModelVertex) -> ClipVertex<8> {
        let world = self.world_from_model * vertex.position.extend(1.0);
        let normal = (normal_matrix(self.world_from_model) * vertex.normal).normalize();
        let [u, v] = from_fn(|i| vertex.uv[i] * self.repeat[i]);
        let varyings = [world.x, world.y, world.z, normal.x, normal.y, normal.z, u, v];
        ClipVertex { position: self.view.clip_from_world * world, varyings }
    }

    fn fragment<R: Real>(&self, [x, y, z, nx, ny, nz, u, v]: [R; 8]) -> Shaded<R> {
        let texel = self.texture.bilinear([u, v], R::of(0.0), AddressMode::Repeat);
        self.shade([x, y, z], [nx, ny, nz], texel)
    }

    fn fragment_with_derivatives<R: Real>(
        &self,
        varyings: [R; 8],
        change: Derivatives<R, 8>,
    ) -> Shaded<R> {
        let [x, y, z, nx, ny, nz, u, v] = varyings;
        let level = self
            .texture
            .level_of_detail([change.dx[6], change.dx[7]], [change.dy[6], change.dy[7]]);
        let texel = self.texture.trilinear([u, v], level, AddressMode::Repeat);
        self.shade([x, y, z], [nx, ny, nz], texel)
    }
}

impl Thing {
    fn shade<R: Real>(&self, place: [R; 3], normal: [R; 3], texel: [R; 3]) -> Shaded<R> {
        let normal = normalize(normal);
        let to_eye = normalize(subtract(R::array_of(self.view.eye), place));
        let to_light = R::array_of(self.view.to_light);
        let diffuse = lambert(normal, to_light);
        let gloss = blinn_phong(normal, to_light, to_eye, 60.0) * R::of(0.55);
        // What turns down sees the floor, not the sky.
        let open = normal[1] * R::of(0.4) + R::of(0.6);
        let surface = decode(texel);
        let light = each(surface, |k, reflected| {
            let body = R::of(SKY[k]) * open + R::of(SUN[k]) * diffuse;
            reflected * R::of(self.tint[k]) * body + R::of(SUN[k]) * gloss
        });
        Shaded::opaque(encode(light))
    }
}

/// The board: translucent, so that the things below it, which stand on their heads, look like reflections.
struct Board {
    view: View,
    texture: MipMaps,
    /// What keeps the sun away, and what the sky.
    sun: Vec<Ball>,
    sky: Vec<Ball>,
    opacity: f64,
}

/// Varyings: x and z in the world.
impl Shader<2> for Board {
    type Attributes = [f64; 2];
    const USES_DERIVATIVES: bool = true;

    fn vertex(&self, &[x, z]: &[f64; 2]) -> ClipVertex<2> {
        ClipVertex {
            position: self.view.clip_from_world * dvec3(x, 0.0, z).extend(1.0),
            varyings: [x, z],
        }
    }

    fn fragment<R: Real>(&self, [x, z]: [R; 2]) -> Shaded<R> {
        let texel = self.texture.bilinear(
            [x * R::of(0.5), z * R::of(0.5)],
            R::of(0.0),
            AddressMode::Repeat,
        );
        self.shade(x, z, texel)
    }

    fn fragment_with_derivatives<R: Real>(
        &self,
        [x, z]: [R; 2],
        change: Derivatives<R, 2>,
    ) -> Shaded<R> {
        let half = |pair: [R; 2]| [pair[0] * R::of(0.5), pair[1] * R::of(0.5)];
        let level = self.texture.level_of_detail(half(change.dx), half(change.dy));
        self.shade(x, z, self.texture.trilinear(half([x, z]), level, AddressMode::Repeat))
    }
}

impl Board {
    fn shade<R: Real>(&self, x: R, z: R, texel: [R; 3]) -> Shaded<R> {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let to_light = self.view.to_light;
        let (mut sun, mut sky) = (one, one);
        let way = |center: [f64; 3]| [R::of(center[0]) - x, R::of(center[1]), R::of(center[2]) - z];
        for &(center, radius) in &self.sun {
            let way = way(center);
            let along = dot(way, R::array_of(to_light));
            let distance = (dot(way, way) - along * along).max(zero).sqrt();
            // The farther the ball, the softer its shadow.
            let soft = along.max(zero) * R::of(0.05) + R::of(0.015);
            let shadow = ((R::of(radius) + soft - distance) / (soft + soft)).max(zero).min(one);
            sun = sun * (one - shadow);
        }
        for &(center, radius) in &self.sky {
            let way = way(center);
            let hidden = R::of(radius * radius) / dot(way, way);
            sky = sky * (one - (hidden * R::of(0.8)).min(R::of(0.8)));
        }
        let surface = decode(texel);
        let light = each(surface, |k, reflected| {
            reflected * (R::of(SKY[k]) * sky + R::of(SUN[k] * to_light[1]) * sun)
        });
        // Far away the board fades into the horizon.
        let [dx, dz] = [x - R::of(self.view.eye[0]), z - R::of(self.view.eye[2])];
        let far = ((dx * dx + dz * dz).sqrt() * R::of(1.0 / 26.0)).min(one);
        let fade = far * far;
        let (color, horizon) = (encode(light), HORIZON.to_f64());
        let color = each(color, |k, near| near + (R::of(horizon[k]) - near) * fade);
        // Seen at a flat angle a polished board reflects more.
        Shaded::translucent(color, R::of(self.opacity) + fade * R::of(1.0 - self.opacity))
    }
}

/// The board's texture, made once for all frames.
static SQUARES: LazyLock<MipMaps> = LazyLock::new(|| MipMaps::new(&squares()));

/// Two dark squares and two bright ones of wood, their grain in two directions.
fn squares() -> Texture {
    let wood = assets::texture("wood.png").expect("an asset");
    let texel = |column: u32, row: u32| {
        let (x, y) = (column % 128, row % 128);
        let is_bright = (column / 128 + row / 128) % 2 == 1;
        let (u, v) = if is_bright { (x, y) } else { (y, x) };
        let place = [u, v].map(|c| (f64::from(c) + 0.5) / 128.0);
        let factors = if is_bright { [1.2, 1.25, 1.35] } else { [0.5, 0.36, 0.3] };
        let color = wood.nearest(place, AddressMode::Repeat);
        // A thin line between the squares.
        let line = if x < 2 || y < 2 { 0.7 } else { 1.0 };
        Color::truncated(from_fn(|k| color[k] * factors[k] * line))
    };
    let rows = (0..256).flat_map(|row| (0..256).map(move |column| texel(column, row)));
    Texture::new(256, 256, rows.collect())
}

/// A pawn on a square, or the ball: model, texture, place of its foot, height, tint.
type Piece = (&'static str, &'static str, [f64; 2], f64, [f64; 3]);

const BRIGHT: [f64; 3] = [1.25, 1.2, 1.1];
const DARK: [f64; 3] = [0.3, 0.2, 0.16];

static PIECES: [Piece; 9] = [
    ("pawn.obj", "wood.png", [-0.5, -1.5], 1.35, BRIGHT),
    ("pawn.obj", "wood.png", [1.5, -0.5], 1.35, DARK),
    ("pawn.obj", "wood.png", [-2.5, 0.5], 1.35, BRIGHT),
    ("pawn.obj", "wood.png", [0.5, 1.5], 1.35, BRIGHT),
    ("pawn.obj", "wood.png", [3.5, 1.5], 1.35, DARK),
    ("pawn.obj", "wood.png", [-1.5, 3.5], 1.35, DARK),
    ("pawn.obj", "wood.png", [2.5, 4.5], 1.35, DARK),
    ("pawn.obj", "wood.png", [-4.5, 4.5], 1.35, BRIGHT),
    ("sphere.obj", "numbers.png", [-1.5, -0.5], 0.8, [0.9; 3]),
];

/// The balls that shadow the board: up, and the radius, of a piece of height 1. The sun's shadow shows a piece's outline; from
/// the sky, which comes from everywhere, few balls do.
const PAWN_IN_THE_SUN: &[[f64; 2]] = &[
    [0.07, 0.3],
    [0.2, 0.2],
    [0.33, 0.14],
    [0.47, 0.11],
    [0.6, 0.11],
    [0.66, 0.17],
    [0.85, 0.165],
];
const PAWN_BELOW_THE_SKY: &[[f64; 2]] = &[[0.1, 0.37], [0.62, 0.31]];
const BALL: &[[f64; 2]] = &[[0.5, 0.5]];

fn is_pawn((model, ..): &Piece) -> bool {
    *model == "pawn.obj"
}

/// Where a piece stands.
fn world_from_model(piece: &Piece) -> DMat4 {
    let (_, _, [x, z], height, _) = piece;
    let half = if is_pawn(piece) { 1.404 } else { 1.0 };
    let size = height / (2.0 * half);
    let turn = rotate_x_to_z(x * 1.7 + z);
    // The models stand about (0, 0, −4) of their files, (0, 0, 4) of ours.
    translate(dvec3(*x, height / 2.0, *z))
        * turn
        * scale(DVec3::splat(size))
        * translate(dvec3(0.0, 0.0, -4.0))
}

/// The balls of all pieces, where `of_pawn` are those of a pawn.
fn balls(of_pawn: &[[f64; 2]]) -> Vec<Ball> {
    let of_piece = |piece: &'static Piece| {
        let (_, _, [x, z], height, _) = piece;
        let outline = if is_pawn(piece) { of_pawn } else { BALL };
        outline.iter().map(move |[up, radius]| ([*x, up * height, *z], radius * height))
    };
    PIECES.iter().flat_map(of_piece).collect()
}

/// The textures of the pieces, made once for all frames.
static COATS: LazyLock<[MipMaps; 2]> = LazyLock::new(|| {
    ["wood.png", "numbers.png"].map(|name| MipMaps::new(&assets::texture(name).expect("an asset")))
});

/// Pieces on a polished board, one turn of the camera in all frames.
pub(super) fn still_life(canvas: &mut Canvas) {
    let knobs = canvas.knobs.clone();
    let angle = degrees(knobs.number("azimuth") + 3.0 * f64::from(canvas.frame));
    let eye = dvec3(6.4 * libm::sin(angle), knobs.number("height"), -6.4 * libm::cos(angle));
    let view_from_world = look_at(eye, dvec3(0.0, 0.35, 0.2), DVec3::Y);
    let clip_from_view = Frustum::from_field_of_view(degrees(36.0), 16.0 / 9.0, 0.5, 60.0).matrix();
    let (clip_from_world, to_light) = (
        clip_from_view * view_from_world,
        to_light(&knobs, ["sun-azimuth", "sun-elevation"], TO_LIGHT),
    );
    let view = View { clip_from_world, eye: eye.to_array(), to_light };

    let state = RenderState {
        cull: CullMode::Back,
        clear_color: HORIZON,
        load: LoadOp::Clear,
        ..RenderState::default()
    };
    let [wood, numbers]: &[MipMaps; 2] = &COATS;
    let mut load = LoadOp::Clear;
    // First what the board reflects, upside down: fronts run the other way there.
    let mirror = scale(dvec3(1.0, -1.0, 1.0));
    for (reflect, front_face) in
        [(mirror, Winding::Clockwise), (DMat4::IDENTITY, Winding::CounterClockwise)]
    {
        if front_face == Winding::CounterClockwise {
            draw_board(canvas, &view, knobs.number("opacity"));
        }
        for piece in &PIECES {
            let (model, texture, _, _, tint) = piece;
            let texture = if *texture == "wood.png" { wood.clone() } else { numbers.clone() };
            let repeat = if is_pawn(piece) { [3.0, 1.0] } else { [1.0, 1.0] };
            let world_from_model = reflect * world_from_model(piece);
            let thing =
                Thing { view: view.clone(), world_from_model, texture, tint: *tint, repeat };
            for part in assets::model(model).expect("an asset").parts.iter() {
                canvas.draw(&part.mesh, &thing, &RenderState { front_face, load, ..state });
                load = LoadOp::Load;
            }
        }
    }
}

fn draw_board(canvas: &mut Canvas, view: &View, opacity: f64) {
    let [sun, sky] = [PAWN_IN_THE_SUN, PAWN_BELOW_THE_SKY].map(balls);
    let board = Board { view: view.clone(), texture: SQUARES.clone(), sun, sky, opacity };
    let far = 60.0;
    let vertices = vec![[-far, -far], [far, -far], [far, far], [-far, far]];
    let state = RenderState {
        merge: Merge { blend: Blend::SourceOver, ..Merge::default() },
        ..RenderState::default()
    };
    canvas.draw(
        &Mesh::indexed(vertices, vec![0, 1, 2, 0, 2, 3]).expect("two triangles"),
        &board,
        &state,
    );
}
