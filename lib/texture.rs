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

use crate::Color;
use crate::real::Real;

/// Which texel is meant by coordinates outside 0..=1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AddressMode {
    /// The nearest texel at the border.
    #[default]
    Clamp,
    /// The picture again, side by side, without end.
    Repeat,
}

impl AddressMode {
    /// The texel index in 0..count that the whole number `index` stands for.
    ///
    /// Whatever comes in, NaN too, what goes out is inside.
    fn apply<R: Real>(self, index: R, count: u32) -> R {
        let count = R::of(f64::from(count));
        let inside = match self {
            Self::Clamp => index,
            Self::Repeat => index - (index / count).floor() * count,
        };
        inside.max(R::of(0.0)).min(count - R::of(1.0))
    }
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
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Shared, so that a copy of a texture costs nothing.
    texels: Arc<[Color]>,
}

impl Texture {
    /// A texture from its texels, the lowest row first, each from left to right.
    ///
    /// # Panics
    /// If there are not `width` × `height` texels, or none.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<Color>) -> Self {
        let count = width as usize * height as usize;
        assert!(count > 0 && texels.len() == count, "{width}×{height} texels, but {} given", texels.len());
        Self { width, height, texels: texels.into() }
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
    /// The texel that (u, v) falls into: column ⌊u · width⌋, row ⌊v · height⌋, as channels in 0..=255. Book, section 3.3.
    ///
    /// The book's early programs read past the array at u = 1; the address mode decides here.
    #[must_use]
    pub fn nearest<R: Real>(&self, [u, v]: [R; 2], mode: AddressMode) -> [R; 3] {
        let column = mode.apply((u * R::of(f64::from(self.width))).floor(), self.width);
        let row = mode.apply((v * R::of(f64::from(self.height))).floor(), self.height);
        R::look_up(column, row, |column, row| self.texels[row * self.width as usize + column].to_f64())
    }
    // ANCHOR_END: nearest
}

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
    fn outside_coordinates() {
        let texture = Texture::new(3, 1, vec![Color::RED, Color::GREEN, Color::BLUE]);
        let at = |u: f64, mode| Color::truncated(texture.nearest([u, 0.0], mode));
        assert_eq!(at(-0.1, AddressMode::Clamp), Color::RED);
        assert_eq!(at(-0.1, AddressMode::Repeat), Color::BLUE);
        assert_eq!(at(7.5, AddressMode::Clamp), Color::BLUE);
        assert_eq!(at(7.5, AddressMode::Repeat), Color::GREEN);
        for mode in [AddressMode::Clamp, AddressMode::Repeat] {
            for u in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
                let _ = at(u, mode); // some texel, no panic
            }
        }
    }
}
