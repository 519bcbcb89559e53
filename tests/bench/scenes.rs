//! The scenes that are measured: geometry, texture and camera, the same numbers for every renderer.
//!
//! All numbers are exact in `f32`. Camera space is left-handed, +z into the screen, y up; fronts run against the clock
//! on the screen. Nothing here is random.

use std::f64::consts::PI;

use glam::dvec3;
use rasterbook::transform::Frustum;

/// Towards the light.
pub(crate) const TO_LIGHT: [f32; 3] = [0.577, 0.577, -0.577];
/// The light that is everywhere.
pub(crate) const AMBIENT: f32 = 0.2;
/// Texels in a row, and rows, of the texture.
pub(crate) const TEXTURE_SIDE: u32 = 512;
/// The five scenes.
pub(crate) const NAMES: [&str; 5] = ["S1", "S2", "S3", "S4", "S5"];

const NEAR: f64 = 2.0;
const FAR: f64 = 10.0;
/// y of the upper border of the view on the near plane.
const TOP: f64 = 1.2;
/// How far the quads reach in NDC: a little beyond the border, so that no edge of them is seen.
const BEYOND: f64 = 1.02;

/// What is known of a vertex. Camera space.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Vertex {
    /// Where it is.
    pub(crate) position: [f32; 3],
    /// The surface's normal there, of length 1.
    pub(crate) normal: [f32; 3],
    /// The place in the texture.
    pub(crate) uv: [f32; 2],
}

/// Something to draw, and from where.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// The width and height of the picture, in pixels.
    pub(crate) size: [u32; 2],
    /// Camera space → clip space: four rows, a column vector on its right; z of NDC from −1 to 1.
    pub(crate) clip_from_view: [[f32; 4]; 4],
    /// Whether there is light; else the color is the texel's.
    pub(crate) is_lit: bool,
    /// All vertices, each once.
    pub(crate) vertices: Vec<Vertex>,
    /// Three for each triangle.
    pub(crate) indices: Vec<u32>,
}

impl Scene {
    /// One of the five scenes, or a sphere of any size: `sphere:TRIANGLES:WIDTHxHEIGHT`.
    pub(crate) fn named(name: &str) -> Option<Self> {
        const FULL_HD: [u32; 2] = [1920, 1080];
        let large = |stacks, slices, size| Self::new(size, true, sphere(stacks, slices, 3.05, 6.0));
        Some(match name {
            "S1" => Self::new([640, 480], true, sphere(51, 50, 1.0, 4.0)),
            "S2" => large(51, 50, FULL_HD),
            "S3" => Self::new(FULL_HD, false, floor(FULL_HD)),
            "S4" => large(501, 1000, FULL_HD),
            "S5" => Self::new(FULL_HD, false, quads(FULL_HD)),
            _ => {
                let (triangles, size) = name.strip_prefix("sphere:")?.split_once(':')?;
                let (width, height) = size.split_once('x')?;
                // 2 · slices · (stacks − 1) triangles, twice as many slices as stacks.
                let half = (triangles.parse::<f64>().ok()?.sqrt() / 2.0).round().max(2.0) as u32;
                large(half + 1, 2 * half, [width.parse().ok()?, height.parse().ok()?])
            }
        })
    }

    fn new(size: [u32; 2], is_lit: bool, (vertices, indices): (Vec<Vertex>, Vec<u32>)) -> Self {
        let right = right(size);
        let camera = Frustum { left: -right, right, bottom: -TOP, top: TOP, near: NEAR, far: FAR };
        // glam keeps columns; rows are those of the transposed matrix.
        let clip_from_view = camera.matrix().transpose().to_cols_array_2d().map(|row| row.map(|x| x as f32));
        Self { size, clip_from_view, is_lit, vertices, indices }
    }

    /// How many triangles there are.
    pub(crate) fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// What is to be seen, in a few words.
    pub(crate) fn description(&self) -> String {
        let [width, height] = self.size;
        let light = if self.is_lit { "lit" } else { "unlit" };
        format!("{} triangles, {width}×{height}, {light}", self.triangle_count())
    }
}

/// x of the right border of the view on the near plane.
fn right([width, height]: [u32; 2]) -> f64 {
    TOP * f64::from(width) / f64::from(height)
}

/// A sphere round (0, 0, distance), its poles above and below, without the triangles that have no area there.
fn sphere(stacks: u32, slices: u32, radius: f64, distance: f64) -> (Vec<Vertex>, Vec<u32>) {
    let mut vertices = Vec::with_capacity((stacks as usize + 1) * (slices as usize + 1));
    for stack in 0..=stacks {
        let t = PI * f64::from(stack) / f64::from(stacks);
        for slice in 0..=slices {
            let p = 2.0 * PI * f64::from(slice) / f64::from(slices);
            let ring = libm::sin(t);
            let normal = dvec3(ring * libm::cos(p), libm::cos(t), ring * libm::sin(p));
            let position = normal * radius + dvec3(0.0, 0.0, distance);
            let uv = [p / (2.0 * PI), 1.0 - t / PI].map(|x| x as f32);
            let [position, normal] = [position, normal].map(|v| v.as_vec3().to_array());
            vertices.push(Vertex { position, normal, uv });
        }
    }
    let mut indices = Vec::with_capacity(6 * (stacks as usize - 1) * slices as usize);
    for stack in 0..stacks {
        for slice in 0..slices {
            let [a, b] = [0, 1].map(|next| stack * (slices + 1) + slice + next);
            let [c, d] = [a, b].map(|above| above + slices + 1);
            if stack + 1 < stacks {
                indices.extend([a, c, d]);
            }
            if stack > 0 {
                indices.extend([a, d, b]);
            }
        }
    }
    (vertices, indices)
}

/// The point of camera space that is seen at (x, y) of NDC at a distance.
fn seen_at([x, y]: [f64; 2], z: f64, size: [u32; 2]) -> [f32; 3] {
    [x * right(size) / NEAR * z, y * TOP / NEAR * z, z].map(|c| c as f32)
}

/// The corners of a quad that covers the view, against the clock from the lower left, at these distances.
fn corners(z: [f64; 4], size: [u32; 2]) -> [[f32; 3]; 4] {
    const SIDES: [[f64; 2]; 4] = [[-BEYOND, -BEYOND], [BEYOND, -BEYOND], [BEYOND, BEYOND], [-BEYOND, BEYOND]];
    [0, 1, 2, 3].map(|i| seen_at(SIDES[i], z[i], size))
}

/// A quad of two triangles, put behind the vertices and indices that are there.
fn push_quad(
    (vertices, indices): &mut (Vec<Vertex>, Vec<u32>),
    positions: [[f32; 3]; 4],
    uvs: [[f32; 2]; 4],
) {
    let first = vertices.len() as u32;
    vertices.extend((0..4).map(|i| Vertex { position: positions[i], normal: [0.0, 0.0, -1.0], uv: uvs[i] }));
    indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
}

/// A floor that fills the view, from near below to far above.
fn floor(size: [u32; 2]) -> (Vec<Vertex>, Vec<u32>) {
    const TEXTURES_PER_UNIT: f64 = 0.4;
    let mut mesh = (Vec::new(), Vec::new());
    let positions = corners([2.5, 2.5, 9.0, 9.0], size);
    let [_, near, far, _] = positions.map(|p| p.map(f64::from));
    let depth = libm::hypot(far[1] - near[1], far[2] - near[2]);
    let uv = |i: usize, v: f64| {
        [f64::from(positions[i][0]) * TEXTURES_PER_UNIT + 0.5, v * TEXTURES_PER_UNIT].map(|x| x as f32)
    };
    push_quad(&mut mesh, positions, [uv(0, 0.0), uv(1, 0.0), uv(2, depth), uv(3, depth)]);
    mesh
}

/// Sixteen quads that fill the view, the farthest first: every pixel is drawn sixteen times.
fn quads(size: [u32; 2]) -> (Vec<Vertex>, Vec<u32>) {
    const COUNT: u32 = 16;
    let mut mesh = (Vec::new(), Vec::new());
    for k in 0..COUNT {
        let z = 9.5 - f64::from(k) * 7.0 / 15.0;
        let start = (f64::from(k) / f64::from(COUNT)) as f32;
        let end = [start + 1.9, start + 1.07];
        let uvs = [[start, start], [end[0], start], end, [start, end[1]]];
        push_quad(&mut mesh, corners([z; 4], size), uvs);
    }
    mesh
}

/// The texture's texels, the lowest row first: a checkerboard with a gradient and a little noise. No channel is under 45,
/// so that nothing drawn is as black as the background, even in the shadow.
pub(crate) fn texels() -> Vec<[u8; 3]> {
    const FIELD: u32 = 32;
    let texel = |x: u32, y: u32| {
        let is_bright = (x / FIELD + y / FIELD).is_multiple_of(2);
        let base: [i32; 3] = if is_bright { [230, 200, 120] } else { [70, 110, 190] };
        let gradient = ((x + y) * 24 / TEXTURE_SIDE) as i32 - 24;
        let noise = (scrambled(y * TEXTURE_SIDE + x) % 13) as i32 - 6;
        base.map(|channel| (channel + gradient + noise).clamp(45, 255) as u8)
    };
    (0..TEXTURE_SIDE).flat_map(|y| (0..TEXTURE_SIDE).map(move |x| texel(x, y))).collect()
}

/// A number that looks random, from another one.
fn scrambled(number: u32) -> u32 {
    let mixed = (number ^ (number >> 16)).wrapping_mul(0x7feb_352d);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x846c_a68b);
    mixed ^ (mixed >> 16)
}
