//! Chapter 1: what one pixel shows.
//!
//! The last value of the data flow: a shader computes numbers, the framebuffer holds colors.
//!
//! ```
//! use rasterbook::Color;
//!
//! let orange = Color::rgb(255, 128, 0);
//! assert_eq!(orange.channels(), [255, 128, 0]);
//! assert_eq!(Color::truncated([254.9, 128.2, 0.0]), Color::rgb(254, 128, 0)); // fractions are cut off
//! ```

use std::fmt;

/// A color of three channels with 8 bits each, as a screen shows it. Book, section 1.2.
///
/// Stored in one 32-bit word, `0x00RRGGBB`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Color(u32);

impl Color {
    /// No light at all: what a cleared framebuffer shows.
    pub const BLACK: Self = Self::rgb(0, 0, 0);
    /// All three lamps of a pixel at full brightness.
    pub const WHITE: Self = Self::rgb(255, 255, 255);
    /// The red lamp alone.
    pub const RED: Self = Self::rgb(255, 0, 0);
    /// The green lamp alone.
    pub const GREEN: Self = Self::rgb(0, 255, 0);
    /// The blue lamp alone.
    pub const BLUE: Self = Self::rgb(0, 0, 255);

    /// The color with the given channels, each in 0..=255.
    #[must_use]
    #[inline]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self((red as u32) << 16 | (green as u32) << 8 | blue as u32)
    }

    /// The gray whose three channels are all `value`.
    #[must_use]
    pub const fn gray(value: u8) -> Self {
        Self::rgb(value, value, value)
    }

    /// The word 0x00RRGGBB.
    #[cfg(feature = "tiled")]
    #[inline]
    pub(crate) const fn bits(self) -> u32 {
        self.0
    }

    /// The color of a word; its highest byte must be 0.
    #[cfg(feature = "tiled")]
    #[inline]
    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// The channels `[red, green, blue]`.
    #[must_use]
    #[inline]
    pub const fn channels(self) -> [u8; 3] {
        let [_, red, green, blue] = self.0.to_be_bytes();
        [red, green, blue]
    }

    /// Channel values in 0.0..=255.0, fractions cut off as the book does; values outside are clamped, NaN gives 0.
    #[must_use]
    #[inline]
    pub fn truncated([red, green, blue]: [f64; 3]) -> Self {
        Self::rgb(red as u8, green as u8, blue as u8)
    }

    /// The channels as numbers in 0.0..=255.0.
    #[must_use]
    #[inline]
    pub fn to_f64(self) -> [f64; 3] {
        let [red, green, blue] = self.channels();
        [f64::from(red), f64::from(green), f64::from(blue)]
    }
}

impl fmt::Debug for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.channels();
        write!(f, "({red}, {green}, {blue})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_survive_packing() {
        assert_eq!(Color::rgb(1, 2, 255).channels(), [1, 2, 255]);
        assert_eq!(Color::truncated([254.999, -3.0, f64::NAN]), Color::rgb(254, 0, 0));
        assert_eq!(Color::truncated([1e30, 128.0, 0.5]), Color::rgb(255, 128, 0));
        assert_eq!(Color::rgb(1, 2, 255).to_f64(), [1.0, 2.0, 255.0]);
        assert_eq!(format!("{:?}", Color::rgb(1, 2, 255)), "(1, 2, 255)", "as messages say it");
    }

    #[test]
    #[cfg(feature = "tiled")]
    fn a_word_has_red_on_top() {
        assert_eq!(Color::rgb(0x12, 0x34, 0x56).bits(), 0x0012_3456);
        assert_eq!(Color::from_bits(0x0012_3456), Color::rgb(0x12, 0x34, 0x56));
    }
}
