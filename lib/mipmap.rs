//! Chapter 10, beyond the book: smaller and smaller copies of a texture, so that a pixel always covers about one texel.
//!
//! Takes texture coordinates and how they change from pixel to pixel, and gives a filtered color. Where a pixel covers
//! many texels, one of them, or four, says little about their mean; the *mip maps* hold that mean, computed beforehand.
//!
//! ```
//! use rasterbook::Color;
//! use rasterbook::mipmap::MipMaps;
//! use rasterbook::texture::{AddressMode, Texture};
//!
//! let maps = MipMaps::new(&Texture::checkerboard(Color::BLACK, Color::WHITE));
//! assert_eq!(maps.count(), 2); // 2×2 and 1×1
//! assert_eq!(maps.trilinear([0.3, 0.3], 1.0, AddressMode::Repeat), [128.0; 3]); // the mean
//! ```

use std::iter::{repeat_n, successors};
use std::sync::Arc;

use crate::color::Color;
use crate::interpolate::linear;
use crate::merge::Rounding;
use crate::real::{Real, each, map3};
use crate::texture::{AddressMode, Texture, bilinear};

/// A texture and its copies, each half as wide and high as the one before, down to one texel.
///
/// ```text
///   ┌───────────────┐ ┌───────┐ ┌───┐ ┌─┐
///   │               │ │   1   │ │ 2 │ └─┘ 3
///   │       0       │ │       │ └───┘
///   │               │ └───────┘
///   └───────────────┘
/// ```
///
/// Source: L. Williams, Pyramidal parametrics, 1983.
#[derive(Clone, Debug)]
pub struct MipMaps {
    levels: Arc<[Level]>,
    /// The texels of all levels, one level above the other, each row as long as the longest: 2 to the power of
    /// `row_bits`.
    texels: Arc<[Color]>,
    row_bits: u32,
}

/// Where a level is: its width and height in texels, and how many rows lie below it.
type Level = [f64; 3];

impl MipMaps {
    // ANCHOR: mip_maps
    /// Makes the copies: each texel is the mean of four of the level before (of two where that is
    /// one texel wide or high; an odd last column or row is left out).
    ///
    /// # Panics
    /// If the texture has more than 2²³ rows: those of all levels are counted in single precision.
    #[must_use]
    pub fn new(texture: &Texture) -> Self {
        assert!(texture.height() <= 1 << 23, "mip maps of {} rows", texture.height());
        let next = |level: &Texture| (level.width().max(level.height()) > 1).then(|| halved(level));
        let copies: Vec<Texture> = successors(Some(texture.clone()), next).collect();
        let row_bits = texture.width().next_power_of_two().trailing_zeros();
        let rows: usize = copies.iter().map(|level| level.height() as usize).sum();
        // Made once, as large as it will be: of the largest texture it has half a gigabyte.
        let mut texels: Arc<[Color]> = repeat_n(Color::BLACK, rows << row_bits).collect();
        let places = Arc::get_mut(&mut texels).expect("nobody shares it yet");
        let mut below = 0;
        let levels = copies.iter().map(|level| {
            let [width, height] = [level.width(), level.height()].map(|side| side as usize);
            for row in 0..height {
                let first = (below + row) << row_bits;
                places[first..first + width].copy_from_slice(level.row(row));
            }
            let level = [width as f64, height as f64, below as f64];
            below += height;
            level
        });
        Self { levels: levels.collect(), texels, row_bits }
    }
    // ANCHOR_END: mip_maps

    /// The number of levels.
    #[must_use]
    pub fn count(&self) -> usize {
        self.levels.len()
    }

    // ANCHOR: level_of_detail
    /// Which level fits: λ = log₂ ρ, where ρ is how far (u, v) moves, in texels, from a pixel to
    /// its right or to its upper neighbor, whichever is farther. Clamped to the levels that there
    /// are.
    ///
    /// ```text
    ///    a pixel on the texture:
    ///                             ρ = max( |∂(u·width, v·height)/∂x|, |∂(u·width, v·height)/∂y| )
    ///        ╱╲   ∂/∂y
    ///       ╱  ╲                  λ = 0: a texel a pixel, or larger texels
    ///      ╲  ╱                   λ = 1: two texels a pixel: level 1
    ///       ╲╱   ∂/∂x
    /// ```
    ///
    /// Source: Direct3D 11.3 functional specification, 7.18.11.
    #[must_use]
    #[inline(always)]
    pub fn level_of_detail<R: Real>(&self, uv_dx: [R; 2], uv_dy: [R; 2]) -> R {
        #[inline(always)]
        fn length<R: Real>([x, y]: [R; 2]) -> R {
            (x * x + y * y).sqrt()
        }
        let [width, height, _] = map3(self.levels[0], R::of);
        let right = length([uv_dx[0] * width, uv_dx[1] * height]);
        let up = length([uv_dy[0] * width, uv_dy[1] * height]);
        let texels = right.max(up);
        let last = R::of((self.count() - 1) as f64);
        texels.map(libm::log2).max(R::of(0.0)).min(last)
    }
    // ANCHOR_END: level_of_detail

    /// A level that there is: the last one for all beyond it, the first one for all before it and for NaN.
    #[inline(always)]
    fn clamped<R: Real>(&self, level: R) -> R {
        level.max(R::of(0.0)).min(R::of((self.count() - 1) as f64))
    }

    /// Bilinear in the level nearest to `level`, as channels in 0..=255: levels meet in lines. Levels beyond the last
    /// are the last.
    #[must_use]
    #[inline(always)]
    pub fn bilinear<R: Real>(&self, uv: [R; 2], level: R, mode: AddressMode) -> [R; 3] {
        let level = (self.clamped(level) + R::of(0.5)).floor();
        let [width, height, below] = R::gather(level, R::of(0.0), |level, _| self.levels[level]);
        bilinear(
            uv,
            [width, height],
            mode,
            #[inline(always)]
            |column, row| R::channels(R::gather_color(column, below + row, self.row_bits, &self.texels)),
        )
    }

    /// Bilinear in the two levels around `level`, and linear between them: no line shows. Levels beyond the last are the
    /// last.
    #[must_use]
    #[inline(always)]
    pub fn trilinear<R: Real>(&self, uv: [R; 2], level: R, mode: AddressMode) -> [R; 3] {
        let level = self.clamped(level);
        let [low, high] = [level.floor(), self.clamped(level.floor() + R::of(1.0))];
        linear(self.bilinear(uv, low, mode), self.bilinear(uv, high, mode), level - low)
    }
}

/// The next smaller copy.
fn halved(texture: &Texture) -> Texture {
    let [width, height] = [texture.width(), texture.height()].map(|side| (side / 2).max(1));
    // The neighbor of a single column or row is itself.
    let pair = |i: u32, count: u32| [2 * i, 2 * i + 1].map(|i| i.min(count - 1) as usize);
    let mean = |x: u32, y: u32| {
        let [columns, rows] = [pair(x, texture.width()), pair(y, texture.height())];
        let [a, b] = [texture.texel(columns[0], rows[0]), texture.texel(columns[1], rows[0])];
        let [c, d] = [texture.texel(columns[0], rows[1]), texture.texel(columns[1], rows[1])];
        Rounding::Nearest.color(each(a, |k, a| (a + b[k] + c[k] + d[k]) / 4.0))
    };
    let texels: Vec<Color> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
    Texture::new(width, height, texels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: u32, height: u32) -> Texture {
        let texels = (0..width * height).map(|i| Color::gray((i * 4) as u8)).collect();
        Texture::new(width, height, texels)
    }

    #[test]
    fn down_to_one_texel() {
        let sizes = |width, height| {
            let maps = MipMaps::new(&ramp(width, height));
            maps.levels.iter().map(|&[width, height, _]| (width as u32, height as u32)).collect::<Vec<_>>()
        };
        assert_eq!(sizes(8, 4), [(8, 4), (4, 2), (2, 1), (1, 1)]);
        assert_eq!(sizes(5, 3), [(5, 3), (2, 1), (1, 1)]);
        assert_eq!(sizes(1, 1), [(1, 1)]);
    }

    #[test]
    fn rows_can_be_counted_in_single_precision() {
        // As many as there may be, and the last level is the last row.
        let height = 1 << 23;
        let mut texels = vec![Color::BLACK; height];
        texels[height / 2..].fill(Color::WHITE);
        let maps = MipMaps::new(&Texture::new(1, height as u32, texels));
        let rows: f64 = maps.levels.iter().map(|[_, height, _]| height).sum();
        assert!(rows <= f64::from(1 << 24));
        let at = |v: f32, level: f32| maps.bilinear([0.5, v], level, AddressMode::Clamp)[0];
        assert_eq!([at(0.25, 22.0), at(0.75, 22.0), at(0.5, 23.0)], [0.0, 255.0, 128.0]);
    }

    #[test]
    #[should_panic(expected = "8388609 rows")]
    fn more_rows_are_refused() {
        let _ = MipMaps::new(&Texture::new(1, (1 << 23) + 1, vec![Color::BLACK; (1 << 23) + 1]));
    }

    #[test]
    fn a_level_is_the_mean_of_the_one_before() {
        let maps = MipMaps::new(&ramp(4, 2));
        // 0 4 8 12 and 16 20 24 28: the mean of 0, 4, 16 and 20 is 10.
        let at = |u: f64, level: f64| maps.bilinear([u, 0.5], level, AddressMode::Clamp)[0];
        assert_eq!([at(0.25, 1.0), at(0.75, 1.0), at(0.5, 2.0)], [10.0, 18.0, 14.0]);
    }

    #[test]
    fn which_level_fits() {
        let maps = MipMaps::new(&ramp(8, 8));
        let level = |x: f64, y: f64| {
            let level = maps.level_of_detail([x / 8.0, 0.0], [0.0, y / 8.0]);
            assert_eq!(level, maps.level_of_detail([0.0, x / 8.0], [y / 8.0, 0.0]), "along the other axis");
            level
        };
        assert_eq!(level(1.0, 1.0), 0.0);
        assert_eq!(level(0.01, 0.01), 0.0, "magnified");
        assert_eq!(level(2.0, 1.0), 1.0, "the longer way decides");
        assert_eq!(level(1.0, 4.0), 2.0);
        assert_eq!(level(1000.0, 0.0), 3.0, "the last level");
        assert_eq!(level(f64::NAN, f64::NAN), 0.0);
    }

    #[test]
    fn a_bright_texel_fades_from_level_to_level() {
        // Black, but for two texels of the first column: a quarter of each is left in level 1, and in level 2 a quarter of
        // their sum.
        let mut texels = vec![Color::BLACK; 16];
        texels[0] = Color::gray(160);
        texels[12] = Color::gray(80);
        let maps = MipMaps::new(&Texture::new(4, 4, texels));
        let (low, high) = ([0.125, 0.125], [0.125, 0.875]);
        let nearest = |uv, level: f64| maps.bilinear(uv, level, AddressMode::Clamp)[0];
        assert_eq!(
            [0.0, 0.4, 0.6, 1.0, 1.4, 1.5, 2.0].map(|level| nearest(low, level)),
            [160.0, 160.0, 40.0, 40.0, 40.0, 15.0, 15.0]
        );
        assert_eq!([0.0, 1.0, 2.0].map(|level| nearest(high, level)), [80.0, 20.0, 15.0]);
        let between = |level: f64| maps.trilinear(low, level, AddressMode::Clamp)[0];
        // 160 and 40, three quarters and one; 40 and 15 likewise.
        assert_eq!([0.25, 1.0, 1.25].map(between), [130.0, 40.0, 33.75]);
    }

    #[test]
    fn between_levels() {
        let maps = MipMaps::new(&ramp(4, 4));
        let at = |level: f64| maps.trilinear([0.5, 0.5], level, AddressMode::Clamp)[0];
        let [first, second] = [at(0.0), at(1.0)];
        assert_eq!(at(0.25), first + (second - first) * 0.25);
        assert_eq!(maps.bilinear([0.5, 0.5], 0.6, AddressMode::Clamp)[0], second);
        let last = maps.bilinear([0.5, 0.5], 2.0, AddressMode::Clamp);
        assert_eq!(last, [30.0; 3], "the mean of all");
        for (level, expected) in
            [(-5.0, at(0.0)), (2.5, last[0]), (99.0, last[0]), (f64::INFINITY, last[0]), (f64::NAN, at(0.0))]
        {
            assert_eq!(at(level), expected, "{level}");
            assert_eq!(maps.bilinear([0.5, 0.5], level, AddressMode::Clamp)[0], expected, "{level}");
        }
    }
}
