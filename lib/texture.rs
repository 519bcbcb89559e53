//! Chapter 3: textures, pictures that are laid on a triangle by coordinates.
//!
//! Takes texture coordinates (u, v), where (0, 0) is the lower left corner of the picture and (1, 1) the upper right
//! one, and gives the color of the texel that they fall into. Stands between interpolation and writing.
//!
//! ```
//! use rasterbook::Color;
//! use rasterbook::texture::{AddressMode, Texture};
//!
//! let texture = Texture::new(2, 1, vec![Color::RED, Color::GREEN]);
//! assert_eq!(texture.nearest([0.75, 0.5], AddressMode::Clamp), Color::GREEN.to_f64());
//! assert_eq!(texture.nearest([1.25, 0.5], AddressMode::Clamp), Color::GREEN.to_f64());
//! assert_eq!(texture.nearest([1.25, 0.5], AddressMode::Repeat), Color::RED.to_f64());
//! ```

use std::sync::Arc;

use crate::color::Color;
use crate::interpolate::linear;
use crate::real::{Real, each};

/// Which texel is meant by coordinates outside 0..=1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AddressMode {
    /// The nearest texel at the border.
    #[default]
    Clamp,
    /// The picture again and again, without end.
    Repeat,
    /// The picture and its mirror image by turns, so that no seam shows.
    Mirror,
}

impl AddressMode {
    // ANCHOR: address_mode
    /// The texel index in 0..count that the whole number `index` stands for.
    ///
    /// ```text
    ///   index    −3 −2 −1  0  1  2  3  4  5        (count 3)
    ///   Clamp     0  0  0  0  1  2  2  2  2
    ///   Repeat    0  1  2  0  1  2  0  1  2
    ///   Mirror    2  1  0  0  1  2  2  1  0
    /// ```
    ///
    /// Whatever comes in, NaN too, what goes out is inside. Source: Direct3D 11.3 functional
    /// specification, 7.18.9.
    #[inline(always)]
    pub(crate) fn apply<R: Real>(self, index: R, count: R) -> R {
        let last = count - R::of(1.0);
        let inside = match self {
            Self::Clamp => index,
            Self::Repeat => rest(index, count),
            Self::Mirror => {
                // There and back again: the second half of the way runs backwards.
                let way = rest(index, count + count);
                way.min(count + last - way)
            }
        };
        inside.max(R::of(0.0)).min(last)
    }
    // ANCHOR_END: address_mode

    /// The texel index in 0..count that a coordinate falls into, perhaps with a fraction: ⌊u · count⌋, and the address
    /// mode.
    ///
    /// Repeated, u is wrapped before it is scaled, as the book does: no division is needed.
    #[inline(always)]
    fn index<R: Real>(self, u: R, count: R, last: R) -> R {
        match self {
            Self::Clamp | Self::Mirror => self.apply((u * count).floor(), count),
            // Never negative, so that cutting the fraction off later rounds down; what is no number gives way to the last.
            Self::Repeat => ((u - u.floor()) * count).min(last),
        }
    }
}

/// What is left of an index when as many whole periods are taken off as there are.
#[inline(always)]
fn rest<R: Real>(index: R, period: R) -> R {
    index - (index / period).floor() * period
}

/// A picture of `width` × `height` texels, row 0 at the bottom: v points up, as y does.
///
/// ```text
///     v                            book, Figure 3-10:
///   1 ┌──────┬──────┐
///     │ blue │ pink │
///     ├──────┼──────┤  u = 0.75, v = 0.25 is green
///     │ red  │ green│
///   0 └──────┴──────┘ u
///     0             1
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Width and height once more, and the last column and row: converted once and not for each texel. Exact, since no
    /// side is longer than 2²⁴.
    columns: f32,
    rows: f32,
    last_column: f32,
    last_row: f32,
    /// A row begins 2 to this power texels after the one below it: a place is found by a shift, not by a multiplication.
    row_bits: u32,
    /// What is beyond the width is never asked for. Shared, so that a copy of a texture costs nothing.
    texels: Arc<[Color]>,
}

impl Texture {
    /// A texture from its texels, the lowest row first, each from left to right.
    ///
    /// # Panics
    /// If there are not `width` × `height` texels, or none, or if a side is longer than 2²⁴.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<Color>) -> Self {
        assert!(width.max(height) <= 1 << 24, "no side of a texture has {} texels", width.max(height));
        // Of 64 bits: in 32, sides that are too large could be multiplied to the number that is given.
        let (count, given) = (u64::from(width) * u64::from(height), texels.len() as u64);
        assert!(count > 0 && given == count, "{width}×{height} texels, but {given} given");
        let (columns, rows) = (width as f32, height as f32);
        let (last_column, last_row) = (columns - 1.0, rows - 1.0);
        let row_bits = width.next_power_of_two().trailing_zeros();
        let texels = with_longer_rows(texels, width as usize, 1 << row_bits).into();
        Self { width, height, columns, rows, last_column, last_row, row_bits, texels }
    }

    /// The 2×2 texture that the book uses up to chapter 10 (Figure 3-10).
    #[must_use]
    pub fn book() -> Self {
        Self::new(2, 2, vec![Color::RED, Color::GREEN, Color::BLUE, Color::rgb(255, 123, 172)])
    }

    /// A checkerboard of 2×2 texels, `dark` at the lower left.
    #[must_use]
    pub fn checkerboard(dark: Color, bright: Color) -> Self {
        Self::new(2, 2, vec![dark, bright, bright, dark])
    }

    /// The number of texels in a row.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    // ANCHOR: nearest
    /// The texel that (u, v) falls into: column ⌊u · width⌋, row ⌊v · height⌋, as channels in
    /// 0..=255. Book, section 3.3.
    ///
    /// The book's early programs read past the array at u = 1; the address mode decides here.
    #[must_use]
    #[inline(always)]
    pub fn nearest<R: Real>(&self, uv: [R; 2], mode: AddressMode) -> [R; 3] {
        R::channels(self.nearest_texel(uv, mode))
    }

    /// The same texel, as it is stored: who only shows it need not take it apart.
    #[must_use]
    #[inline(always)]
    pub fn nearest_texel<R: Real>(&self, [u, v]: [R; 2], mode: AddressMode) -> R::Colors {
        let [width, height] = self.size();
        let column = mode.index(u, width, R::from(self.last_column));
        let row = mode.index(v, height, R::from(self.last_row));
        R::gather_color(column, row, self.row_bits, &self.texels)
    }
    // ANCHOR_END: nearest

    /// The mixture of the four texels around (u, v), as channels in 0..=255.
    ///
    /// Infinite coordinates mean the border for [`AddressMode::Clamp`], and NaN the first texel, as in [`Self::nearest`]. For
    /// the others they have no fraction: the mixture is NaN.
    #[must_use]
    #[inline(always)]
    pub fn bilinear<R: Real>(&self, uv: [R; 2], mode: AddressMode) -> [R; 3] {
        bilinear(
            uv,
            self.size(),
            mode,
            #[inline(always)]
            |column, row| R::channels(R::gather_color(column, row, self.row_bits, &self.texels)),
        )
    }

    #[inline(always)]
    fn size<R: Real>(&self) -> [R; 2] {
        [R::from(self.columns), R::from(self.rows)]
    }

    /// A row of texels, from left to right.
    pub(crate) fn row(&self, row: usize) -> &[Color] {
        &self.texels[row << self.row_bits..][..self.width() as usize]
    }

    /// A texel by its column and row.
    #[inline(always)]
    pub(crate) fn color(&self, column: usize, row: usize) -> Color {
        self.texels[(row << self.row_bits) + column]
    }

    /// The channels of a texel, in 0..=255.
    #[inline(always)]
    pub(crate) fn texel(&self, column: usize, row: usize) -> [f64; 3] {
        self.color(column, row).to_f64()
    }
}

/// The same texels, in rows that are made longer.
fn with_longer_rows(texels: Vec<Color>, width: usize, length: usize) -> Vec<Color> {
    if width == length {
        return texels;
    }
    let mut longer = Vec::with_capacity(texels.len() / width * length);
    for row in texels.chunks_exact(width) {
        longer.extend_from_slice(row);
        longer.resize(longer.len() + length - width, Color::BLACK);
    }
    longer
}

// ANCHOR: bilinear
/// Mixes the four texels around (u, v) of a picture of `size` texels.
///
/// ```text
///     ┌───────┬───────┐      Texel centers lie at halves: (u, v) is between the columns
///     │   c───┼───d   │      ⌊u·width − ½⌋ and the next one, and the fraction is the weight
///     ├───│───┼───│───┤      of the next one; rows likewise. Each of the four goes through
///     │   a─p─┼───b   │      the address mode by itself.
///     └───────┴───────┘
/// ```
///
/// Source: Direct3D 11.3 functional specification, 7.18.8.
#[inline(always)]
pub(crate) fn bilinear<R: Real>(
    [u, v]: [R; 2],
    [width, height]: [R; 2],
    mode: AddressMode,
    texel: impl Fn(R, R) -> [R; 3],
) -> [R; 3] {
    let [x, y] = each(
        [u, v],
        #[inline(always)]
        |axis, coordinate| {
            let count = [width, height][axis];
            let along = coordinate * count - R::of(0.5);
            match mode {
                // Farther out there is nothing new, and infinity has no fraction.
                AddressMode::Clamp => along.max(R::of(-1.0)).min(count),
                AddressMode::Repeat | AddressMode::Mirror => along,
            }
        },
    );
    let columns = [mode.apply(x.floor(), width), mode.apply(x.floor() + R::of(1.0), width)];
    let rows = [mode.apply(y.floor(), height), mode.apply(y.floor() + R::of(1.0), height)];
    let low = linear(texel(columns[0], rows[0]), texel(columns[1], rows[0]), x - x.floor());
    let high = linear(texel(columns[0], rows[1]), texel(columns[1], rows[1]), x - x.floor());
    linear(low, high, y - y.floor())
}
// ANCHOR_END: bilinear

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_texels_of_the_book() {
        let texture = Texture::book();
        let at = |u: f64, v| Color::truncated(texture.nearest([u, v], AddressMode::Clamp));
        assert_eq!(at(0.25, 0.25), Color::RED);
        assert_eq!(at(0.75, 0.25), Color::GREEN);
        assert_eq!(at(0.25, 0.75), Color::BLUE);
        assert_eq!(at(0.75, 0.75), Color::rgb(255, 123, 172));
        assert_eq!(at(0.5, 0.5), Color::rgb(255, 123, 172), "the middle belongs to the upper right texel");
        assert_eq!(at(1.0, 1.0), at(0.75, 0.75), "u = 1 is the last column");
    }

    #[test]
    fn rows_of_any_length() {
        for width in 1..=9_u8 {
            let texels = (0..2 * width).map(Color::gray).collect();
            let texture = Texture::new(width.into(), 2, texels);
            for (row, column) in (0..2).flat_map(|row| (0..width).map(move |column| (row, column))) {
                let uv = [(f64::from(column) + 0.5) / f64::from(width), f64::from(row) * 0.5 + 0.25];
                let expected = Color::gray(row * width + column);
                assert_eq!(Color::truncated(texture.nearest(uv, AddressMode::Clamp)), expected);
                assert_eq!(texture.texel(column.into(), row.into()), expected.to_f64());
            }
        }
    }

    #[test]
    fn outside_coordinates() {
        let texture = Texture::new(3, 1, vec![Color::RED, Color::GREEN, Color::BLUE]);
        let at = |u: f64, mode| Color::truncated(texture.nearest([u, 0.0], mode));
        assert_eq!(at(-0.1, AddressMode::Clamp), Color::RED);
        assert_eq!(at(-0.1, AddressMode::Repeat), Color::BLUE);
        assert_eq!(at(7.5, AddressMode::Clamp), Color::BLUE);
        assert_eq!(at(7.5, AddressMode::Repeat), Color::GREEN);
        assert_eq!(at(-0.1, AddressMode::Mirror), Color::RED, "mirror of −1 is 0");
        assert_eq!(at(1.1, AddressMode::Mirror), Color::BLUE);
        assert_eq!(at(1.9, AddressMode::Mirror), Color::RED);
        for mode in [AddressMode::Clamp, AddressMode::Repeat, AddressMode::Mirror] {
            for u in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
                let _ = at(u, mode); // some texel, no panic
                let _ = texture.bilinear([u, u], mode);
            }
        }
    }

    #[test]
    fn clamped_coordinates_may_be_infinite() {
        let texture = Texture::new(2, 2, [0, 100, 40, 140].map(Color::gray).to_vec());
        let at = |u: f64, v: f64| texture.bilinear([u, v], AddressMode::Clamp)[0];
        let far = f64::INFINITY;
        assert_eq!([at(far, far), at(-far, far), at(far, -far), at(-far, -far)], [140.0, 40.0, 100.0, 0.0]);
        assert_eq!(at(far, 0.5), 120.0, "between the rows of the last column");
        assert_eq!(at(f64::NAN, far), 40.0, "the first column, as the nearest texel");
        for (u, near) in [(-3.0, -0.25), (9.0, 1.25), (1e30, 1.0), (-1e30, 0.0)] {
            assert_eq!(at(u, 0.4), at(near, 0.4));
        }
        assert!(texture.bilinear([far, 0.5], AddressMode::Repeat)[0].is_nan());
    }

    #[test]
    fn mirrored_indices() {
        let indices =
            |mode: AddressMode| [-4.0, -3.0, -1.0, 0.0, 2.0, 3.0, 5.0, 6.0].map(|i| mode.apply(i, 3.0_f64));
        assert_eq!(indices(AddressMode::Mirror), [2.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0]);
        assert_eq!(indices(AddressMode::Repeat), [2.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0, 0.0]);
        assert_eq!(indices(AddressMode::Clamp), [0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0]);
    }

    #[test]
    fn between_texels() {
        let texture = Texture::new(2, 2, [0, 100, 40, 140].map(Color::gray).to_vec());
        let at = |u: f64, v, mode| texture.bilinear([u, v], mode)[0];
        assert_eq!(at(0.25, 0.25, AddressMode::Clamp), 0.0, "a center is the texel alone");
        assert_eq!(at(0.5, 0.25, AddressMode::Clamp), 50.0);
        assert_eq!(at(0.5, 0.5, AddressMode::Clamp), 70.0, "the mean of all four");
        assert_eq!(at(0.0, 0.25, AddressMode::Clamp), 0.0);
        assert_eq!(at(0.0, 0.25, AddressMode::Repeat), 50.0, "half of the texel from the other side");
        assert_eq!(at(0.0, 0.25, AddressMode::Mirror), 0.0);
    }

    #[test]
    fn a_plane_of_grays_stays_a_plane_between_its_texels() {
        // 10 a column and 30 a row. (0.7, 0.6) is at the column 2.1 − ½ and the row 1.8 − ½.
        let texture = Texture::new(3, 3, [0, 10, 20, 30, 40, 50, 60, 70, 80].map(Color::gray).to_vec());
        for mode in [AddressMode::Clamp, AddressMode::Repeat, AddressMode::Mirror] {
            let [gray, ..]: [f64; 3] = texture.bilinear([0.7, 0.6], mode);
            assert!((gray - (10.0 * 1.6 + 30.0 * 1.3)).abs() < 1e-12, "{mode:?}: {gray}");
        }
    }
}
