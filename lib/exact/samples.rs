//! Chapter 2, beyond the book: several samples in each pixel.
//!
//! One sample in the middle says that a pixel is inside a triangle or outside; several say how much of it is. Takes
//! colors and depths for single samples, and gives the mean of each pixel.
//!
//! ```
//! use rasterbook::Color;
//! use rasterbook::exact::samples::{GRID_2X2, Samples};
//!
//! let mut samples = Samples::new(1, 1, &GRID_2X2);
//! samples.draw(0, 0, 1, 0.5, Color::WHITE); // one of four samples, at the depth 0.5
//! assert_eq!(samples.resolved().get(0, 0), Some(Color::gray(64)));
//! ```

use std::array::from_fn;

use super::edge::{SUBPIXELS, Subpixel};
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::merge::Rounding;
use crate::observer::SharedObserver;
use crate::plane::count_of;
use crate::rect::Rect;

/// Where the samples of a pixel are: in 1/256 pixel from its lower left corner.
pub type Pattern = [Subpixel];

/// One sample, in the middle.
pub const CENTER: [Subpixel; 1] = grid::<1>(1);
/// Four samples, in two columns and two rows.
pub const GRID_2X2: [Subpixel; 4] = grid::<4>(2);
/// Sixteen samples, in four columns and four rows.
pub const GRID_4X4: [Subpixel; 16] = grid::<16>(4);
/// Four samples, each in a column and a row of its own, so that nearly horizontal and nearly vertical edges have four
/// steps instead of two: a *rotated grid*.
///
/// ```text
///   ┌────────────────┐
///   │     ●          │
///   │             ●  │       Direct3D 11.3 functional specification, 19.2.4: the standard pattern
///   │  ●             │       of four samples
///   │          ●     │
///   └────────────────┘
/// ```
pub const ROTATED_4: [Subpixel; 4] = [[96, 224], [224, 160], [32, 96], [160, 32]];

/// The centers of n × n equal squares.
const fn grid<const COUNT: usize>(n: i64) -> [Subpixel; COUNT] {
    let step = SUBPIXELS / n;
    let mut samples = [[0; 2]; COUNT];
    let mut i = 0;
    while i < COUNT {
        let (column, row) = (i as i64 % n, i as i64 / n);
        samples[i] = [step / 2 + column * step, step / 2 + row * step];
        i += 1;
    }
    samples
}

/// A picture in the making: a color and a depth for each sample.
#[derive(Clone, Debug)]
pub struct Samples<'a> {
    pattern: &'a Pattern,
    rect: Rect,
    colors: Vec<Color>,
    depths: Vec<f64>,
    observer: Option<SharedObserver>,
}

impl<'a> Samples<'a> {
    /// `width` × `height` pixels, black and infinitely far away.
    ///
    /// # Panics
    /// If the pattern is empty, or a side is 0 or larger than [`Framebuffer::MAX_SIDE`], or if no memory can hold so many
    /// samples.
    #[must_use]
    pub fn new(width: u32, height: u32, pattern: &'a Pattern) -> Self {
        let sides = 1..=Framebuffer::MAX_SIDE;
        assert!(sides.contains(&width) && sides.contains(&height), "no picture has {width}×{height} pixels");
        assert!(!pattern.is_empty(), "a pixel without samples has no color");
        let count = count_of::<f64>([width, height], pattern.len());
        let count = count.unwrap_or_else(|| {
            panic!("no memory can hold {width}×{height} pixels of {} samples", pattern.len())
        });
        Self {
            pattern,
            rect: Rect::sized(width, height),
            colors: vec![Color::BLACK; count],
            depths: vec![f64::INFINITY; count],
            observer: None,
        }
    }

    /// Samples for the picture of a framebuffer: of its size, and with the same observer.
    ///
    /// # Panics
    /// As [`Self::new`] does.
    #[must_use]
    pub fn like(framebuffer: &Framebuffer, pattern: &'a Pattern) -> Self {
        let observer = framebuffer.observer();
        Self { observer, ..Self::new(framebuffer.width(), framebuffer.height(), pattern) }
    }

    /// The pixels.
    #[must_use]
    pub const fn rect(&self) -> Rect {
        self.rect
    }

    /// The samples of a pixel: numbers, and positions on the screen.
    pub fn of_pixel(&self, x: i32, y: i32) -> impl Iterator<Item = (usize, Subpixel)> + use<'a> {
        let corner = [x, y].map(|i| i64::from(i) * SUBPIXELS);
        self.pattern.iter().map(move |offset| from_fn(|i| corner[i] + offset[i])).enumerate()
    }

    /// Gives a sample of the pixel (x, y) a color, unless what it holds is nearer. Outside, and for a sample that the
    /// pattern does not have, nothing happens.
    pub fn draw(&mut self, x: i32, y: i32, sample: usize, depth: f64, color: Color) {
        let Some(pixel) = self.rect.index(x, y).filter(|_| sample < self.pattern.len()) else { return };
        let index = pixel * self.pattern.len() + sample;
        if let Some(observer) = &self.observer {
            let stored = self.depths[index];
            let passes = if depth <= stored { "drawn" } else { "hidden" };
            observer.note((x, y), &|| {
                format!("sample {sample}: {depth:.4} against {stored:.4}, {color:?} {passes}")
            });
        }
        self.draw_at(index, depth, color);
    }

    // ANCHOR: sample
    /// Gives a sample a color, unless what it holds is nearer.
    fn draw_at(&mut self, index: usize, depth: f64, color: Color) {
        if depth <= self.depths[index] {
            self.depths[index] = depth;
            self.colors[index] = color;
        }
    }
    // ANCHOR_END: sample

    // ANCHOR: resolve
    /// The picture: the mean of the samples of each pixel, to the nearest whole number.
    #[must_use]
    pub fn resolved(&self) -> Framebuffer {
        let mut picture = Framebuffer::new(self.rect.right as u32, self.rect.top as u32);
        let count = self.pattern.len();
        let mut pixels = self.colors.chunks_exact(count);
        for y in self.rect.rows() {
            for (x, samples) in self.rect.columns().zip(&mut pixels) {
                let sum: [f64; 3] = from_fn(|k| samples.iter().map(|it| it.to_f64()[k]).sum());
                picture.set(x, y, Rounding::Nearest.color(sum.map(|sum| sum / count as f64)));
            }
        }
        picture
    }
    // ANCHOR_END: resolve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns() {
        assert_eq!(CENTER, [[128, 128]]);
        assert_eq!(GRID_2X2, [[64, 64], [192, 64], [64, 192], [192, 192]]);
        assert_eq!(GRID_4X4[5], [96, 96]);
        // No two samples share a column or a row.
        for axis in 0..2 {
            let mut places = ROTATED_4.map(|sample| sample[axis]);
            places.sort_unstable();
            assert_eq!(places, [32, 96, 160, 224]);
        }
    }

    #[test]
    fn samples_of_a_pixel() {
        let samples = Samples::new(3, 2, &GRID_2X2);
        let places: Vec<_> = samples.of_pixel(2, 1).collect();
        assert_eq!(places, [(0, [576, 320]), (1, [704, 320]), (2, [576, 448]), (3, [704, 448])]);
    }

    #[test]
    fn a_sample_that_there_is_not_changes_nothing() {
        let mut samples = Samples::new(2, 1, &CENTER);
        for sample in [1, 2, usize::MAX] {
            samples.draw(0, 0, sample, 0.0, Color::WHITE);
            samples.draw(1, 0, sample, 0.0, Color::WHITE);
        }
        assert!(samples.resolved().rows_from_top().flatten().all(|&color| color == Color::BLACK));
    }

    #[test]
    #[should_panic(expected = "without samples")]
    fn a_pattern_has_samples() {
        let _ = Samples::new(2, 1, &[]);
    }

    #[test]
    #[should_panic(expected = "0×1 pixels")]
    fn a_picture_has_pixels() {
        let _ = Samples::new(0, 1, &CENTER);
    }

    #[test]
    fn depth_counts_for_each_sample() {
        let mut samples = Samples::new(2, 1, &GRID_2X2);
        for (sample, _) in samples.of_pixel(1, 0).take(2) {
            samples.draw(1, 0, sample, 1.0, Color::RED);
        }
        for (sample, place) in samples.of_pixel(1, 0) {
            assert!(place[0] > 256);
            samples.draw(1, 0, sample, 2.0, Color::BLUE);
        }
        samples.draw(2, 0, 0, 0.0, Color::WHITE);
        let picture = samples.resolved();
        assert_eq!(picture.get(0, 0), Some(Color::BLACK));
        assert_eq!(picture.get(1, 0), Some(Color::rgb(128, 0, 128)));
    }
}
