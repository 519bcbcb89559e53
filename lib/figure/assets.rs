//! The models and textures that the chapters draw, and the generator that made them.
//!
//! What is in `assets/` is what [`generate`] writes; the programs carry the files inside, so that they find them from
//! any working directory.

use std::borrow::Cow;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::sync::{Mutex, PoisonError};

use glam::dvec3;
use image::ImageFormat;

use super::glyphs::{DIGITS, glyph};
use super::picture::enlarged;
use crate::color::Color;
use crate::files::FileError;
#[cfg(not(target_family = "wasm"))]
use crate::files::decode_texture;
use crate::framebuffer::Framebuffer;
use crate::model::{Model, NormalStyle};
use crate::rect::Rect;
use crate::save::encode;
use crate::texture::Texture;

/// Names one file of `assets/` and carries its bytes.
#[cfg(not(target_family = "wasm"))]
macro_rules! asset {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../../assets/", $name)).as_slice())
    };
}

/// The files that the programs carry.
#[cfg(not(target_family = "wasm"))]
const FILES: [(&str, &[u8]); 8] = [
    asset!("cube.obj"),
    asset!("sphere.obj"),
    asset!("pawn.obj"),
    asset!("letters.png"),
    asset!("numbers.png"),
    asset!("bricks.png"),
    asset!("bricks-normals.png"),
    asset!("wood.png"),
];

#[cfg(not(target_family = "wasm"))]
fn bytes_of(name: &str) -> Result<Cow<'static, [u8]>, FileError> {
    let file = FILES.iter().find(|(file, _)| *file == name);
    file.map(|(_, bytes)| Cow::Borrowed(*bytes)).ok_or_else(|| missing(name))
}

/// Where a page has to be sent, the generator is sent and not what it makes, which is twenty times as long.
#[cfg(target_family = "wasm")]
fn bytes_of(name: &str) -> Result<Cow<'static, [u8]>, FileError> {
    model_text(name).map(|text| Cow::Owned(text.into_bytes())).ok_or_else(|| missing(name))
}

fn missing(name: &str) -> FileError {
    FileError::new(name.as_ref(), "is not in assets/")
}

/// A model of `assets/`, such as `cube.obj`.
///
/// # Errors
/// If there is no such model.
pub fn model(name: &str) -> Result<Model, FileError> {
    model_with(name, NormalStyle::Smooth)
}

/// The same with normals of a style.
///
/// # Errors
/// If there is no such model.
pub fn model_with(name: &str, style: NormalStyle) -> Result<Model, FileError> {
    static READ: Read<(String, NormalStyle), Model> = Mutex::new(Vec::new());
    once(&READ, (name.to_owned(), style), || {
        Model::parse(&bytes_of(name)?, name.as_ref(), style).map(|(model, _)| model)
    })
}

/// A texture of `assets/`, such as `bricks.png`.
///
/// # Errors
/// If there is no such texture.
pub fn texture(name: &str) -> Result<Texture, FileError> {
    static READ: Read<String, Texture> = Mutex::new(Vec::new());
    once(&READ, name.to_owned(), || read_texture(name))
}

#[cfg(not(target_family = "wasm"))]
fn read_texture(name: &str) -> Result<Texture, FileError> {
    decode_texture(&bytes_of(name)?, name.as_ref()).map(|(texture, _)| texture)
}

#[cfg(target_family = "wasm")]
fn read_texture(name: &str) -> Result<Texture, FileError> {
    made_texture(name).ok_or_else(|| missing(name))
}

/// What has been read already, by name: reading a file takes longer than drawing a picture with it.
type Read<K, T> = Mutex<Vec<(K, T)>>;

/// What `read` gives; the second time, what it gave the first time.
fn once<K: PartialEq, T: Clone>(
    known: &Read<K, T>,
    key: K,
    read: impl FnOnce() -> Result<T, FileError>,
) -> Result<T, FileError> {
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, value)) = known.iter().find(|(name, _)| *name == key) {
        return Ok(value.clone());
    }
    let value = read()?;
    known.push((key, value.clone()));
    Ok(value)
}

/// All files of `assets/` but its page: names and contents.
#[must_use]
pub fn generate() -> Vec<(&'static str, Vec<u8>)> {
    let png = |picture: Framebuffer| encode(&picture, ImageFormat::Png).unwrap_or_default();
    let of = |name| model_text(name).map(String::into_bytes).or_else(|| picture(name).map(png));
    NAMES.into_iter().filter_map(|name| Some((name, of(name)?))).collect()
}

/// The texture that the generator makes: that of the file of this name.
#[must_use]
pub fn made_texture(name: &str) -> Option<Texture> {
    let picture = picture(name)?;
    let rows: Vec<&[Color]> = picture.rows_from_top().collect();
    Some(Texture::new(picture.width(), picture.height(), rows.into_iter().rev().flatten().copied().collect()))
}

const NAMES: [&str; 8] = [
    "cube.obj",
    "sphere.obj",
    "pawn.obj",
    "letters.png",
    "numbers.png",
    "bricks.png",
    "bricks-normals.png",
    "wood.png",
];

fn model_text(name: &str) -> Option<String> {
    match name {
        "cube.obj" => Some(cube()),
        "sphere.obj" => Some(sphere()),
        "pawn.obj" => Some(pawn()),
        _ => None,
    }
}

fn picture(name: &str) -> Option<Framebuffer> {
    match name {
        "letters.png" => Some(letters()),
        "numbers.png" => Some(numbers()),
        "bricks.png" => Some(bricks()),
        "bricks-normals.png" => Some(bricks_normals()),
        "wood.png" => Some(wood()),
        _ => None,
    }
}

/// A cube of side 2 about (0, 0, −4), each face with the whole texture upright on it.
fn cube() -> String {
    let mut text = String::from("# A cube. Made by the generator of Rasterbook.\no cube\n");
    // Each face: its normal, and where its u and v point, counter-clockwise as seen from outside.
    let faces: [[[f64; 3]; 3]; 6] = [
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    ];
    for [n, u, v] in faces {
        for (i, j) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let [x, y, z] = [0, 1, 2].map(|k| n[k] + i * u[k] + j * v[k]);
            let _ = writeln!(text, "v {x} {y} {}", z - 4.0);
        }
        let _ = writeln!(text, "vn {} {} {}", n[0], n[1], n[2]);
    }
    text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    for face in 1..=6 {
        let corner = |i: i32| format!("{}/{i}/{face}", 4 * (face - 1) + i);
        let _ = writeln!(text, "f {} {} {} {}", corner(1), corner(2), corner(3), corner(4));
    }
    text
}

/// A sphere of radius 1 about (0, 0, −4): 40 rings of 64 quads.
fn sphere() -> String {
    const RINGS: usize = 40;
    let profile: Vec<[f64; 2]> = (0..=RINGS)
        .map(|ring| {
            let angle = PI * ring as f64 / RINGS as f64;
            [libm::sin(angle), -libm::cos(angle)]
        })
        .collect();
    lathe("A sphere", "sphere", &profile, 64)
}

/// A pawn of height 2.8 about (0, 0, −4): a smooth outline, turned about its axis.
fn pawn() -> String {
    // Outline from the foot to the top: distance from the axis, height.
    const OUTLINE: [[f64; 2]; 21] = [
        [0.0, -1.0],
        [0.5, -1.0],
        [0.61, -0.97],
        [0.62, -0.86],
        [0.54, -0.77],
        [0.46, -0.72],
        [0.47, -0.64],
        [0.38, -0.54],
        [0.27, -0.34],
        [0.21, -0.08],
        [0.2, 0.18],
        [0.25, 0.25],
        [0.36, 0.29],
        [0.36, 0.34],
        [0.24, 0.38],
        [0.26, 0.46],
        [0.34, 0.6],
        [0.345, 0.74],
        [0.27, 0.9],
        [0.13, 0.985],
        [0.0, 1.0],
    ];
    let outline = smoothed(&OUTLINE, 3).into_iter().map(|[radius, height]| [1.404 * radius, 1.404 * height]);
    lathe("A pawn", "pawn", &outline.collect::<Vec<_>>(), 40)
}

/// A curve through all points of an outline (Catmull and Rom, 1974), `steps` points for each of its pieces.
fn smoothed(outline: &[[f64; 2]], steps: usize) -> Vec<[f64; 2]> {
    let last = outline.len() - 1;
    let mut curve = Vec::new();
    for i in 0..last {
        let [a, b, c, d] =
            [outline[i.saturating_sub(1)], outline[i], outline[i + 1], outline[(i + 2).min(last)]];
        for step in 0..steps {
            let t = step as f64 / steps as f64;
            let along = |k: usize| {
                let cubic = 3.0 * b[k] - a[k] - 3.0 * c[k] + d[k];
                let square = 2.0 * a[k] - 5.0 * b[k] + 4.0 * c[k] - d[k];
                b[k] + 0.5 * t * (c[k] - a[k] + t * (square + t * cubic))
            };
            curve.push([along(0).max(0.0), along(1)]);
        }
    }
    curve.push(outline[last]);
    curve
}

/// A surface of revolution: an outline, turned about the axis through (0, 0, −4); u goes round, v up.
fn lathe(title: &str, name: &str, outline: &[[f64; 2]], segments: usize) -> String {
    let mut text = format!("# {title}. Made by the generator of Rasterbook.\no {name}\n");
    let angle = |segment: usize| TAU * segment as f64 / segments as f64;
    for [radius, height] in outline {
        for segment in 0..segments {
            let (x, z) = (radius * libm::sin(angle(segment)), radius * libm::cos(angle(segment)));
            let _ = writeln!(text, "v {x:.5} {height:.5} {:.5}", z - 4.0);
        }
    }
    let rows = outline.len() - 1;
    for row in 0..=rows {
        for segment in 0..=segments {
            let _ =
                writeln!(text, "vt {:.4} {:.4}", segment as f64 / segments as f64, row as f64 / rows as f64);
        }
    }
    for row in 0..rows {
        for segment in 0..segments {
            // The seam has two columns of texture coordinates and one of positions.
            let corner = |i: usize, j: usize| {
                let (row, segment) = (row + j, segment + i);
                format!("{}/{}", 1 + row * segments + segment % segments, 1 + row * (segments + 1) + segment)
            };
            let _ = writeln!(text, "f {} {} {} {}", corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
        }
    }
    text
}

/// Letters that look different however they are turned or mirrored.
const LETTERS: [(&str, [&str; 7]); 4] = [
    ("G", [".###.", "#...#", "#....", "#.###", "#...#", "#...#", ".###."]),
    ("R", ["####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"]),
    ("F", ["#####", "#....", "#....", "####.", "#....", "#....", "#...."]),
    ("J", ["..###", "....#", "....#", "....#", "#...#", "#...#", ".###."]),
];

/// Four letters on four colors, with a border: F below left, J below right, G above left, R above right.
fn letters() -> Framebuffer {
    let mut small = Framebuffer::new(32, 32);
    let colors =
        [Color::rgb(40, 110, 60), Color::rgb(150, 50, 50), Color::rgb(40, 70, 140), Color::rgb(150, 110, 30)];
    for (i, (_, rows)) in LETTERS.iter().enumerate() {
        let (left, bottom) = (16 * (i as i32 % 2), if i < 2 { 16 } else { 0 });
        small.fill(Rect { left, bottom, right: left + 16, top: bottom + 16 }, colors[i]);
        glyph(&mut small, rows, (left + 5, bottom + 4), Color::rgb(250, 245, 225));
    }
    let border = Color::rgb(235, 225, 200);
    for i in 0..32 {
        for (x, y) in [(i, 0), (i, 31), (0, i), (31, i)] {
            small.set(x, y, border);
        }
    }
    blocks(&small, 8)
}

/// A picture with every pixel as a block, without a grid.
fn blocks(small: &Framebuffer, factor: u32) -> Framebuffer {
    // Two steps, so that no step is large enough for a grid.
    enlarged(&enlarged(small, factor / 2), 2)
}

/// 64 colored and checkered squares, numbered from 1 at the lower left.
fn numbers() -> Framebuffer {
    let mut small = Framebuffer::new(128, 128);
    for i in 0..64 {
        let (left, bottom) = (16 * (i % 8), 16 * (i / 8));
        let color = hue(f64::from(i * 23) / 64.0);
        small.fill(Rect { left, bottom, right: left + 16, top: bottom + 16 }, Color::gray(20));
        // A fine checkerboard, so that a texel from elsewhere shows.
        let dark = Color::truncated(color.to_f64().map(|channel| channel * 0.72));
        for (x, y) in (0..15).flat_map(|y| (0..15).map(move |x| (x, y))) {
            small.set(left + x, bottom + y, if x / 3 % 2 == y / 3 % 2 { color } else { dark });
        }
        let number = i + 1;
        let digits = if number < 10 { vec![(6, number)] } else { vec![(4, number / 10), (9, number % 10)] };
        for (place, digit) in digits {
            glyph(&mut small, &DIGITS[digit as usize], (left + place, bottom + 5), Color::rgb(20, 20, 20));
        }
    }
    blocks(&small, 4)
}

/// A light color of a hue, of which the fraction counts: red, yellow, green, cyan, blue, magenta, and red again.
fn hue(hue: f64) -> Color {
    let channel = |shift: f64| {
        let place = (hue + shift) - (hue + shift).floor();
        let strength = ((place * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        90.0 + 165.0 * strength
    };
    Color::truncated([channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)])
}

/// A number in 0..1 that looks like chance, the same for the same coordinates.
fn noise(x: i32, y: i32) -> f64 {
    let mut bits = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2C1B_3C6D);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297A_2D39);
    f64::from(bits ^ (bits >> 15)) / f64::from(u32::MAX)
}

/// A brick wall that can be laid side by side: eight courses, every other one shifted by half a brick.
fn bricks() -> Framebuffer {
    let mut picture = Framebuffer::new(128, 128);
    for y in picture.rect().rows() {
        for x in picture.rect().columns() {
            let course = y / 16;
            let along = (x + if course % 2 == 0 { 0 } else { 16 }) % 128;
            let is_mortar = y % 16 < 2 || along % 32 < 2;
            let grain = 18.0 * noise(x, y);
            let tint = 40.0 * noise(along / 32 + 100, course);
            let color = if is_mortar {
                [170.0 + grain, 165.0 + grain, 155.0 + grain]
            } else {
                [140.0 + tint + grain, 60.0 + tint / 2.0 + grain, 45.0 + grain]
            };
            picture.set(x, y, Color::truncated(color));
        }
    }
    picture
}

/// The normal map that belongs to the bricks: bricks stand out of the mortar with rounded edges, and are rough.
fn bricks_normals() -> Framebuffer {
    let height = |x: i32, y: i32| {
        let (x, y) = (x.rem_euclid(128), y.rem_euclid(128));
        let along = x + if y / 16 % 2 == 0 { 0 } else { 16 };
        // How far inside its brick a texel is; the mortar is 2 wide, at the lower and left border of a brick.
        let inside =
            [along % 32 - 2, 31 - along % 32, y % 16 - 2, 15 - y % 16].into_iter().min().unwrap_or(0);
        let rounded = f64::from(inside.clamp(-1, 2));
        rounded + 0.12 * noise(x / 2, y / 2) + 0.08 * noise(x, y + 500)
    };
    let mut picture = Framebuffer::new(128, 128);
    for y in picture.rect().rows() {
        for x in picture.rect().columns() {
            // The normal leans against the slope.
            let slope = [height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1)];
            let normal = dvec3(-slope[0] / 2.0, -slope[1] / 2.0, 1.0).normalize();
            picture.set(x, y, Color::truncated(((normal + 1.0) * 127.5 + 0.5).to_array()));
        }
    }
    picture
}

/// Wood that can be laid side by side from left to right: vertical grain.
fn wood() -> Framebuffer {
    let mut picture = Framebuffer::new(128, 128);
    for y in picture.rect().rows() {
        for x in picture.rect().columns() {
            let bend =
                5.0 * libm::sin(TAU * f64::from(y) / 128.0) + 2.0 * libm::sin(TAU * f64::from(y) / 43.0);
            let ring = 0.5 + 0.5 * libm::sin(TAU * (f64::from(x) * 9.0 / 128.0 + bend / 12.0));
            let fiber = noise(x, y / 24) * 0.5 + noise(x, y / 5) * 0.25;
            let tone = 0.62 + 0.23 * ring + 0.2 * fiber;
            picture.set(x, y, Color::truncated([205.0 * tone, 145.0 * tone, 85.0 * tone]));
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    // In WebAssembly the files are not carried.
    #[test]
    #[cfg(not(target_family = "wasm"))]
    fn what_is_made_is_what_is_read() {
        let made = generate();
        assert_eq!(made.len(), FILES.len());
        for ((name, made), (file, bytes)) in made.into_iter().zip(FILES) {
            assert_eq!(name, file);
            if name.ends_with(".obj") {
                assert!(made == bytes, "{name}");
                continue;
            }
            // By their pixels: encoders change. In a page of the book textures are made, and not decoded.
            let read = texture(name).ok();
            let decoded = decode_texture(&made, name.as_ref()).ok();
            assert!(read.is_some() && made_texture(name) == read, "{name}");
            assert_eq!(decoded.map(|(texture, _)| texture), read, "{name}");
        }
        assert_eq!((made_texture("cube.obj"), model_text("wood.png")), (None, None));
    }

    #[test]
    fn what_has_been_read_is_known_by_its_name() {
        let known = Mutex::new(Vec::new());
        let read = |name: &'static str| once(&known, name, || Ok(name.len()));
        assert_eq!([read("a").ok(), read("bc").ok(), read("a").ok()], [Some(1), Some(2), Some(1)]);
        let again = once(&known, "bc", || Err(missing("bc")));
        assert_eq!(again.ok(), Some(2), "not read once more");
        let failed = once(&known, "d", || Err(missing("d"))).expect_err("is not there");
        assert_eq!(failed.to_string(), "d: is not in assets/");
        assert_eq!(read("d").ok(), Some(1), "what failed is tried again");
    }
}
