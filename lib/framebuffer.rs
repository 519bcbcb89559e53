//! Chapter 1: a plane of pixels, addressing, clearing.
//!
//! The last stop of the data flow: every other room emits positions and values, and the caller writes colors here.
//!
//! ```
//! use rasterbook::{Color, Framebuffer};
//!
//! let mut framebuffer = Framebuffer::new(4, 3);
//! framebuffer.set(1, 2, Color::RED);
//! assert_eq!(framebuffer.get(1, 2), Some(Color::RED));
//! assert_eq!(framebuffer.get(4, 0), None); // outside
//! ```

use std::fmt;
use std::ops::Range;

use crate::plane::PixelPlane;
use crate::probe::{Listener, Probe, Window};
use crate::real::Scalar;

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

    /// Channel values in 0.0..=255.0, fractions cut off as the book does; values outside are limited, NaN gives 0.
    #[must_use]
    #[inline]
    pub fn truncated([red, green, blue]: [f64; 3]) -> Self {
        Self::rgb(red as u8, green as u8, blue as u8)
    }

    /// The channels as numbers in 0.0..=255.0.
    #[must_use]
    #[inline]
    pub fn to_f64(self) -> [f64; 3] {
        self.channels().map(f64::from)
    }
}

/// How a channel becomes a whole number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// The fraction is cut off, as the book does.
    Truncate,
    /// To the nearest, halves upwards: add ½, then truncate. Direct3D 11.3 functional specification, 3.2.3.6.
    Nearest,
}

impl Rounding {
    /// The color with channels in 0..=255; values outside are limited, NaN gives 0.
    #[must_use]
    #[inline]
    pub fn color<R: Scalar>(self, channels: [R; 3]) -> Color {
        let channels = match self {
            Self::Truncate => channels,
            Self::Nearest => channels.map(|channel| channel + R::of(0.5)),
        };
        Color::truncated(channels.map(Into::into))
    }
}

impl fmt::Debug for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.channels();
        write!(f, "({red}, {green}, {blue})")
    }
}

/// A rectangle of pixels, half-open: `left ≤ x < right`, `bottom ≤ y < top`.
///
/// Every stage that emits pixels takes one and emits nothing outside it: that is the scissor, and it is why
/// not even a deliberate mistake can write out of bounds or run for ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// The first column.
    pub left: i32,
    /// The lowest row.
    pub bottom: i32,
    /// The column after the last.
    pub right: i32,
    /// The row above the highest.
    pub top: i32,
}

impl Rect {
    /// The rectangle of `width` × `height` pixels with its lower left pixel at (0, 0).
    #[must_use]
    pub const fn sized(width: u32, height: u32) -> Self {
        Self { left: 0, bottom: 0, right: width as i32, top: height as i32 }
    }

    /// Whether the pixel (x, y) belongs to the rectangle.
    #[must_use]
    #[inline]
    pub const fn contains(self, x: i32, y: i32) -> bool {
        self.left <= x && x < self.right && self.bottom <= y && y < self.top
    }

    /// Where the pixel (x, y) stands in a plane that holds the rectangle's rows one after the other, the lowest first;
    /// `None` outside.
    #[must_use]
    #[inline]
    pub const fn index(self, x: i32, y: i32) -> Option<usize> {
        // As `u32`, a negative difference is greater than any width: one comparison for each axis.
        let (column, row) = (x.wrapping_sub(self.left) as u32, y.wrapping_sub(self.bottom) as u32);
        let (width, height) = (side(self.left, self.right), side(self.bottom, self.top));
        if column < width && row < height {
            Some(row as usize * width as usize + column as usize)
        } else {
            None
        }
    }

    /// The columns, from left to right.
    #[must_use]
    pub const fn columns(self) -> Range<i32> {
        self.left..self.right
    }

    /// The rows, from bottom to top.
    #[must_use]
    pub const fn rows(self) -> Range<i32> {
        self.bottom..self.top
    }
}

/// The length of a side from `from` to `to`; 0 if it runs backwards.
#[inline]
const fn side(from: i32, to: i32) -> u32 {
    if from < to { to.wrapping_sub(from) as u32 } else { 0 }
}

/// A plane of pixels. The origin is at the bottom left and y points up, as in the book's `SetPixel` (section 1.5).
///
/// ```text
///      y
///      ▲
///      2 │ . # .        set(1, 2, …) is the pixel #
///      1 │ . . .
///      0 │ . . .        memory: row 0 first, left to right,
///        └──────► x     so (x, y) stands at y · width + x
///          0 1 2
/// ```
#[derive(Clone)]
pub struct Framebuffer {
    width: u32,
    height: u32,
    pixels: PixelPlane<Color>,
    listener: Option<Listener>,
}

/// Two framebuffers are equal if they show the same picture, whoever listens.
impl PartialEq for Framebuffer {
    fn eq(&self, other: &Self) -> bool {
        self.rect() == other.rect() && *self.pixels == *other.pixels
    }
}

impl Eq for Framebuffer {}

impl Framebuffer {
    /// The largest width and the largest height of a framebuffer, in pixels.
    pub const MAX_SIDE: u32 = 16_384;

    /// A black framebuffer of `width` × `height` pixels.
    ///
    /// # Panics
    /// If a side is 0 or larger than [`Self::MAX_SIDE`].
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        let sides = 1..=Self::MAX_SIDE;
        assert!(
            sides.contains(&width) && sides.contains(&height),
            "no framebuffer has {width}×{height} pixels"
        );
        let pixels = vec![Color::BLACK; width as usize * height as usize];
        Self { width, height, pixels: pixels.into(), listener: None }
    }

    /// The number of columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// The number of rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// All pixels.
    #[must_use]
    #[inline]
    pub const fn rect(&self) -> Rect {
        Rect::sized(self.width, self.height)
    }

    // ANCHOR: addressing
    /// Gives the pixel (x, y) a color. Outside the framebuffer nothing happens.
    #[inline]
    pub fn set(&mut self, x: i32, y: i32, color: Color) {
        if let Some(index) = self.rect().index(x, y) {
            self.pixels[index] = color;
            if let Some(listener) = &self.listener {
                listener.written(x, y, color);
            }
        }
    }
    // ANCHOR_END: addressing

    /// The color of the pixel (x, y); `None` outside.
    #[must_use]
    #[inline]
    pub fn get(&self, x: i32, y: i32) -> Option<Color> {
        self.rect().index(x, y).map(|index| self.pixels[index])
    }

    /// Gives all pixels the same color.
    pub fn clear(&mut self, color: Color) {
        self.pixels.fill(color);
        self.tell(|probe| probe.cleared(color));
    }

    /// Gives the pixels of a rectangle a color; what lies outside the framebuffer is left out.
    pub fn fill(&mut self, rect: Rect, color: Color) {
        let all = self.rect();
        for y in rect.bottom.max(all.bottom)..rect.top.min(all.top) {
            for x in rect.left.max(all.left)..rect.right.min(all.right) {
                self.set(x, y, color);
            }
        }
    }

    /// All pixels, as the window that the drawing stages take, with whoever listens.
    #[must_use]
    pub fn window(&self) -> Window {
        Window { rect: self.rect(), listener: self.listener.clone() }
    }

    /// From now on this one listens, and nobody else.
    pub fn listen(&mut self, listener: Option<Listener>) {
        self.listener = listener;
    }

    /// Who listens.
    #[must_use]
    pub fn listener(&self) -> Option<Listener> {
        self.listener.clone()
    }

    /// Tells the listener, if there is one.
    pub fn tell(&self, report: impl FnOnce(&dyn Probe)) {
        if let Some(listener) = &self.listener {
            report(listener.as_ref());
        }
    }

    /// The plane itself, for who writes many pixels at a time; nobody is told of that.
    #[cfg(feature = "tiled")]
    pub(crate) const fn plane_mut(&mut self) -> &mut PixelPlane<Color> {
        &mut self.pixels
    }

    /// Changes pictures with another framebuffer; listeners stay where they are.
    pub(crate) const fn swap_pictures(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.width, &mut other.width);
        std::mem::swap(&mut self.height, &mut other.height);
        std::mem::swap(&mut self.pixels, &mut other.pixels);
    }

    /// The rows as an image file holds them: the highest first.
    pub fn rows_from_top(&self) -> impl Iterator<Item = &[Color]> {
        self.pixels.chunks(self.width as usize).rev()
    }
}

impl fmt::Debug for Framebuffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Framebuffer of {}×{} pixels", self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_pixel_is_where_it_was_set() {
        let mut framebuffer = Framebuffer::new(3, 2);
        framebuffer.set(2, 0, Color::RED);
        framebuffer.set(0, 1, Color::GREEN);
        let rows: Vec<Vec<Color>> = framebuffer.rows_from_top().map(<[Color]>::to_vec).collect();
        assert_eq!(rows[0], [Color::GREEN, Color::BLACK, Color::BLACK], "y = 1 is the first row of a file");
        assert_eq!(rows[1], [Color::BLACK, Color::BLACK, Color::RED], "y = 0 is the last row of a file");
    }

    proptest! {
        #[test]
        fn what_a_rectangle_contains_has_a_place(
            sides in prop::array::uniform4(prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)]),
            x in prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)],
            y in prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)],
        ) {
            let [left, bottom, right, top] = sides;
            let rect = Rect { left, bottom, right, top };
            let [left, bottom, right, x, y] = [left, bottom, right, x, y].map(i128::from);
            let place = (y - bottom) * (right - left) + (x - left);
            let expected = rect.contains(x as i32, y as i32).then_some(place);
            prop_assert_eq!(rect.index(x as i32, y as i32).map(|place| place as i128), expected);
        }
    }

    #[test]
    fn outside_is_left_alone() {
        let mut framebuffer = Framebuffer::new(3, 2);
        let before = framebuffer.clone();
        for (x, y) in [(-1, 0), (0, -1), (3, 0), (0, 2), (i32::MIN, i32::MAX)] {
            framebuffer.set(x, y, Color::RED);
            assert_eq!(framebuffer.get(x, y), None);
        }
        framebuffer.fill(Rect { left: 3, bottom: -5, right: 99, top: 99 }, Color::RED);
        assert!(framebuffer == before);
    }

    #[test]
    fn channels_survive_packing() {
        assert_eq!(Color::rgb(1, 2, 255).channels(), [1, 2, 255]);
        assert_eq!(Color::truncated([254.999, -3.0, f64::NAN]), Color::rgb(254, 0, 0));
        assert_eq!(Color::truncated([1e30, 128.0, 0.5]), Color::rgb(255, 128, 0));
    }
}
