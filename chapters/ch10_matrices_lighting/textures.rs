//! How texels are picked: filters, and what lies beyond the border.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3, dvec3};
use rasterbook::figure::{Canvas, Knob, assets};
use rasterbook::light::{add, scale};
use rasterbook::mipmap::MipMaps;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, look_at};
use rasterbook::varyings::Derivatives;
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

const HEIGHT: Knob = Knob::number(
    "height",
    2.0,
    [0.8, 8.0],
    "",
    "the eye comes down to the floor: seen at a flat angle it gets noisy or blurred already near by",
);
const BIAS: Knob = Knob::number(
    "bias",
    0.0,
    [-3.0, 3.0],
    "levels",
    "added to the level of detail: below 0 the noise comes back, above 0 all is blurred",
);
pub(super) const EYE: &[Knob] = &[HEIGHT];
pub(super) const EYE_AND_BIAS: &[Knob] = &[HEIGHT, BIAS];
pub(super) const COPIES: &[Knob] = &[Knob::number(
    "size",
    1.8,
    [0.5, 3.6],
    "",
    "that of a copy: the smaller, the more copies; the clamped floor has one at any size",
)];

/// How a color is made of texels.
#[derive(Clone, Copy)]
enum Filter {
    Nearest,
    Bilinear,
    /// Bilinear in the copy that fits best.
    Mipmapped,
    /// The same in two copies, mixed.
    Trilinear,
    /// A color for each copy.
    Levels,
}

// ANCHOR: floor
/// A floor that is covered with a texture.
struct Floor {
    clip_from_world: DMat4,
    texture: Texture,
    maps: MipMaps,
    filter: Filter,
    mode: AddressMode,
    /// By how many levels the copies are taken too coarse.
    bias: f64,
}

impl Shader<2> for Floor {
    /// x and z of the floor, and the texture coordinates there.
    type Attributes = ([f64; 2], [f64; 2]);
    const USES_DERIVATIVES: bool = true;

    fn position(&self, &([x, z], _): &Self::Attributes) -> Option<DVec3> {
        Some(dvec3(x, 0.0, z))
    }

    fn vertex(&self, &([x, z], uv): &Self::Attributes) -> ClipVertex<2> {
        ClipVertex { position: self.clip_from_world * dvec3(x, 0.0, z).extend(1.0), varyings: uv }
    }

    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::texel(self.texture.nearest_texel(uv, self.mode))
    }

    fn fragment_with_derivatives<R: Real>(
        &self,
        uv: [R; 2],
        change: Derivatives<R, 2>,
    ) -> Shaded<R> {
        // A change that is twice as large asks for the next level.
        let larger = R::of(libm::exp2(self.bias));
        let [dx, dy] = [change.dx, change.dy].map(|[u, v]| [u * larger, v * larger]);
        let level = self.maps.level_of_detail(dx, dy);
        Shaded::opaque(match self.filter {
            Filter::Nearest => self.texture.nearest(uv, self.mode),
            Filter::Bilinear => self.texture.bilinear(uv, self.mode),
            Filter::Mipmapped => self.maps.bilinear(uv, level, self.mode),
            Filter::Trilinear => self.maps.trilinear(uv, level, self.mode),
            Filter::Levels => {
                let texel = self.maps.bilinear(uv, level, self.mode);
                let tint = R::gather(level + R::of(0.5), R::of(0.0), |level, _| tint(level));
                scale(add(texel, tint), R::of(0.5))
            }
        })
    }
}
// ANCHOR_END: floor

/// The color of a level: around the color wheel from red.
fn tint(level: usize) -> [f64; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0]
        .map(|turn| 127.5 + 127.5 * libm::cos(TAU * (level as f64 / 8.0 - turn)))
}

fn camera(eye: DVec3, target: DVec3) -> DMat4 {
    let view_from_world = look_at(eye, target, DVec3::Y);
    let camera = Frustum { left: -0.8, right: 0.8, bottom: -0.6, top: 0.6, near: 1.0, far: 500.0 };
    camera.matrix() * view_from_world
}

fn sky() -> RenderState {
    RenderState { clear_color: Color::rgb(150, 190, 230), ..RenderState::default() }
}

/// A part of the floor; `uv` gives the texture coordinates at its vertices.
fn floor(
    canvas: &mut Canvas,
    shader: &Floor,
    [left, right]: [f64; 2],
    uv: impl Fn(f64, f64) -> [f64; 2],
) {
    let points = [[left, -10.0], [right, -10.0], [right, 400.0], [left, 400.0]];
    let vertices = points.map(|[x, z]| ([x, z], uv(x, z))).to_vec();
    canvas.draw(
        &Mesh::indexed(vertices, vec![0, 1, 2, 0, 2, 3]).expect("two triangles"),
        shader,
        &sky(),
    );
}

fn shader(clip_from_world: DMat4, texture: &str, filter: Filter, mode: AddressMode) -> Floor {
    let texture = assets::texture(texture).expect("an asset");
    Floor { clip_from_world, maps: MipMaps::new(&texture), texture, filter, mode, bias: 0.0 }
}

/// Bricks to the horizon.
fn bricks(canvas: &mut Canvas, filter: Filter, bias: f64) {
    canvas.clear(&sky());
    let clip_from_world =
        camera(dvec3(0.0, canvas.knobs.number("height"), -6.0), dvec3(0.6, 1.0, 0.0));
    let shader =
        Floor { bias, ..shader(clip_from_world, "bricks.png", filter, AddressMode::Repeat) };
    floor(canvas, &shader, [-300.0, 300.0], |x, z| [x / 4.0, z / 4.0]);
}

/// The nearest texel.
pub(super) fn nearest(canvas: &mut Canvas) {
    bricks(canvas, Filter::Nearest, 0.0);
}

/// Four texels.
pub(super) fn bilinear(canvas: &mut Canvas) {
    bricks(canvas, Filter::Bilinear, 0.0);
}

/// Four texels of one copy.
pub(super) fn mipmapped(canvas: &mut Canvas) {
    bricks(canvas, Filter::Mipmapped, canvas.knobs.number("bias"));
}

/// Four texels of two copies each.
pub(super) fn trilinear(canvas: &mut Canvas) {
    bricks(canvas, Filter::Trilinear, canvas.knobs.number("bias"));
}

/// Which copy is where.
pub(super) fn mip_levels(canvas: &mut Canvas) {
    bricks(canvas, Filter::Levels, canvas.knobs.number("bias"));
}

// ANCHOR: address_modes
/// Three floors side by side, one for each address mode; the texture itself lies in the middle of
/// each, a little in front of us.
pub(super) fn address_modes(canvas: &mut Canvas) {
    canvas.clear(&sky());
    let size = canvas.knobs.number("size");
    let clip_from_world = camera(dvec3(0.0, 4.5, -6.0), dvec3(0.0, 0.0, 2.6));
    let modes = [AddressMode::Clamp, AddressMode::Repeat, AddressMode::Mirror];
    for (i, mode) in (0..).zip(modes) {
        let left = -6.2 + 4.2 * f64::from(i);
        let shader = shader(clip_from_world, "letters.png", Filter::Trilinear, mode);
        floor(canvas, &shader, [left, left + 3.8], |x, z| {
            [(x - left - 1.1) / size, (z + 0.6) / size]
        });
    }
}
// ANCHOR_END: address_modes
