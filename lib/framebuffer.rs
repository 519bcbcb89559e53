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
use std::io::{self, Write};

use crate::color::Color;
use crate::observer::{Observer, SharedObserver};
use crate::plane::PixelPlane;
use crate::rect::Rect;

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
    observer: Option<SharedObserver>,
}

/// Two framebuffers are equal if they show the same picture, whether they are observed or not.
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
        Self { width, height, pixels: pixels.into(), observer: None }
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

    /// Gives the pixel (x, y) a color. Outside the framebuffer nothing happens.
    #[inline]
    pub fn set(&mut self, x: i32, y: i32, color: Color) {
        self.set_pixel(x, y, color);
        if let Some(observer) = &self.observer
            && self.rect().contains(x, y)
        {
            observer.written((x, y), color);
        }
    }

    // ANCHOR: addressing
    #[inline]
    fn set_pixel(&mut self, x: i32, y: i32, color: Color) {
        if let Some(index) = self.index(x, y) {
            self.pixels[index] = color;
        }
    }

    /// Where the pixel (x, y) stands in memory; `None` outside the framebuffer. As [`Rect::index`],
    /// from (0, 0) on.
    #[inline]
    fn index(&self, x: i32, y: i32) -> Option<usize> {
        // A negative number becomes a very large one.
        let is_inside = (x as u32) < self.width && (y as u32) < self.height;
        is_inside.then(|| y as usize * self.width as usize + x as usize)
    }
    // ANCHOR_END: addressing

    /// The color of the pixel (x, y); `None` outside.
    #[must_use]
    #[inline]
    pub fn get(&self, x: i32, y: i32) -> Option<Color> {
        self.index(x, y).map(|index| self.pixels[index])
    }

    /// Gives all pixels the same color.
    pub fn clear(&mut self, color: Color) {
        self.pixels.fill(color);
        self.report(|observer| observer.cleared(color));
    }

    /// Gives the pixels of a rectangle a color; what lies outside the framebuffer is left out.
    pub fn fill(&mut self, rect: Rect, color: Color) {
        let inside = rect.intersection(self.rect());
        for y in inside.rows() {
            if let Some(first) = self.index(inside.left, y) {
                self.pixels[first..first + inside.columns().len()].fill(color);
            }
        }
        self.report(|observer| inside.pixels().for_each(|pixel| observer.written(pixel, color)));
    }

    /// Exchanges pictures with another framebuffer; observers stay where they are.
    pub(crate) const fn swap_pictures(&mut self, other: &mut Self) {
        std::mem::swap(&mut self.width, &mut other.width);
        std::mem::swap(&mut self.height, &mut other.height);
        std::mem::swap(&mut self.pixels, &mut other.pixels);
    }

    // ANCHOR: write_ppm
    /// The rows as an image file holds them: the highest first.
    pub fn rows_from_top(&self) -> impl Iterator<Item = &[Color]> {
        self.pixels.chunks(self.width as usize).rev()
    }

    /// The channels of all pixels as an image file holds them: red, green, blue, and the highest
    /// row first.
    #[must_use]
    pub fn rgb_from_top(&self) -> Vec<u8> {
        let mut channels = Vec::with_capacity(3 * self.pixels.len());
        for color in self.rows_from_top().flatten() {
            channels.extend_from_slice(&color.channels());
        }
        channels
    }

    /// Writes the picture as a PPM file (binary, `P6`): a line of text, then three bytes for each
    /// pixel.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_ppm(&self, mut writer: impl Write) -> io::Result<()> {
        writeln!(writer, "P6 {} {} 255", self.width, self.height)?;
        writer.write_all(&self.rgb_from_top())
    }
    // ANCHOR_END: write_ppm
}

impl Framebuffer {
    /// A number that says whether two pictures are the same, on whichever machines they were drawn: 64-bit FNV-1a of
    /// width, height, and the channels of all pixels, the first row on top.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        let size = [self.width, self.height].map(u32::to_le_bytes);
        size.into_iter().flatten().chain(self.rgb_from_top()).fold(0xcbf2_9ce4_8422_2325, mix)
    }
}

/// Observers, and stages that write many pixels at a time.
impl Framebuffer {
    /// From now on this one observes, and no other.
    pub fn set_observer(&mut self, observer: Option<SharedObserver>) {
        self.observer = observer;
    }

    /// Who observes.
    #[must_use]
    pub fn observer(&self) -> Option<SharedObserver> {
        self.observer.clone()
    }

    /// Reports to the observer, if there is one.
    pub(crate) fn report(&self, report: impl FnOnce(&dyn Observer)) {
        if let Some(observer) = &self.observer {
            report(observer.as_ref());
        }
    }

    /// The plane itself, for stages that write many pixels at a time; that is not reported.
    #[cfg(feature = "tiled")]
    pub(crate) const fn plane_mut(&mut self) -> &mut PixelPlane<Color> {
        &mut self.pixels
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

    #[test]
    fn a_pixel_is_where_it_was_set() {
        let mut framebuffer = Framebuffer::new(3, 2);
        framebuffer.set(2, 0, Color::RED);
        framebuffer.set(0, 1, Color::GREEN);
        let rows: Vec<Vec<Color>> = framebuffer.rows_from_top().map(<[Color]>::to_vec).collect();
        assert_eq!(rows[0], [Color::GREEN, Color::BLACK, Color::BLACK], "y = 1 is the first row of a file");
        assert_eq!(rows[1], [Color::BLACK, Color::BLACK, Color::RED], "y = 0 is the last row of a file");
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
    fn a_rectangle_is_filled_as_far_as_it_is_inside() {
        let mut framebuffer = Framebuffer::new(3, 2);
        assert_eq!((framebuffer.width(), framebuffer.height()), (3, 2));
        assert_eq!(framebuffer.rect(), Rect { left: 0, bottom: 0, right: 3, top: 2 });
        framebuffer.fill(Rect { left: 1, bottom: -7, right: 9, top: 1 }, Color::RED);
        let [black, red] = [Color::BLACK, Color::RED];
        let rows: Vec<&[Color]> = framebuffer.rows_from_top().collect();
        assert_eq!(rows, [[black, black, black], [black, red, red]]);
        assert_eq!(format!("{framebuffer:?}"), "Framebuffer of 3×2 pixels");
    }

    #[test]
    fn framebuffers_are_equal_if_their_pictures_are() {
        let red = |x| {
            let mut framebuffer = Framebuffer::new(3, 2);
            framebuffer.set(x, 0, Color::RED);
            framebuffer
        };
        assert!(red(1) == red(1) && red(1) != red(2));
        assert!(Framebuffer::new(3, 2) != Framebuffer::new(2, 3), "as many pixels in another shape");
    }

    #[test]
    fn another_picture_has_another_fingerprint() {
        let black = |width, height| Framebuffer::new(width, height).fingerprint();
        let mut dot = Framebuffer::new(2, 3);
        dot.set(0, 0, Color::rgb(0, 0, 1));
        assert_eq!(black(2, 3), black(2, 3));
        assert!(dot.fingerprint() != black(2, 3) && black(3, 2) != black(2, 3));
        // That of a single black pixel, computed by hand from the definition.
        assert_eq!(black(1, 1), 0x5d1e_e66e_3442_9d67);
    }

    #[test]
    fn a_ppm_file_has_its_first_row_on_top() {
        let mut framebuffer = Framebuffer::new(1, 2);
        framebuffer.set(0, 1, Color::rgb(1, 2, 3));
        let mut file = Vec::new();
        framebuffer.write_ppm(&mut file).expect("a vector takes all bytes");
        assert_eq!(file, b"P6 1 2 255\n\x01\x02\x03\0\0\0");
    }
}
