//! What the other renderers' shaders share, and how pictures are compared.

use crate::scenes::{AMBIENT, TEXTURE_SIDE, TO_LIGHT, texels};

/// The texture, as words `0x00RRGGBB`.
pub(crate) struct Texels(Vec<u32>);

impl Texels {
    pub(crate) fn new() -> Self {
        Self(texels().into_iter().map(word).collect())
    }

    /// The texel that (u, v) falls into; the texture is repeated. Its sides are powers of two.
    pub(crate) fn nearest(&self, uv: [f32; 2]) -> u32 {
        let [column, row] = uv.map(|x| (x * TEXTURE_SIDE as f32).floor() as i32 as u32 & (TEXTURE_SIDE - 1));
        self.0[(row * TEXTURE_SIDE + column) as usize]
    }
}

/// Diffuse light on the channels of a texel.
pub(crate) fn lit(texel: [u8; 3], [x, y, z]: [f32; 3]) -> [u8; 3] {
    let diffuse = x * TO_LIGHT[0] + y * TO_LIGHT[1] + z * TO_LIGHT[2];
    let brightness = (diffuse.max(0.0) + AMBIENT).min(1.0);
    texel.map(|channel| (f32::from(channel) * brightness + 0.5) as u8)
}

/// The channels of a word `0x00RRGGBB`.
pub(crate) fn channels(word: u32) -> [u8; 3] {
    let [_, channels @ ..] = word.to_be_bytes();
    channels
}

/// The word `0x00RRGGBB` of channels.
pub(crate) fn word([r, g, b]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, r, g, b])
}

/// How two pictures differ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Difference {
    /// How many pixels are covered in one of them, and not in the other.
    pub(crate) uncovered: usize,
    /// How many pixels both cover.
    pub(crate) common: usize,
    /// The mean of the differences of all channels there, 0..=255.
    pub(crate) mean: f64,
    /// How many pixels there differ by more than 2 in a channel.
    pub(crate) others: usize,
}

impl Difference {
    /// Compares pictures of the same size. What is black is not covered.
    pub(crate) fn between(a: &[[u8; 3]], b: &[[u8; 3]]) -> Self {
        let is_covered = |pixel: &[u8; 3]| *pixel != [0; 3];
        let pairs = || a.iter().zip(b);
        let both = || pairs().filter(|(a, b)| is_covered(a) && is_covered(b));
        let apart = |a: &[u8; 3], b: &[u8; 3]| [0, 1, 2].map(|i| a[i].abs_diff(b[i]));
        let sum: u64 = both().flat_map(|(a, b)| apart(a, b)).map(u64::from).sum();
        let common = both().count();
        Self {
            uncovered: pairs().filter(|(a, b)| is_covered(a) != is_covered(b)).count(),
            common,
            mean: sum as f64 / (3 * common.max(1)) as f64,
            others: both().filter(|(a, b)| apart(a, b).into_iter().any(|d| d > 2)).count(),
        }
    }
}
