//! A picture in parts that belong to one thread alone: bands, the rows of pixels in which a row of tiles lies.

use std::ops::Range;

use rayon::prelude::*;

use super::lanes::LANES;
use crate::color::Color;
use crate::rect::{Pixel, Rect};

/// The width of a tile in pixels.
pub(super) const TILE_WIDTH: i32 = 128;
/// The height of a tile in pixels.
pub(super) const TILE_HEIGHT: i32 = 32;

/// How many columns and rows of tiles a picture has.
pub(super) fn tiles_of(picture: Rect) -> [usize; 2] {
    [(picture.right, TILE_WIDTH), (picture.top, TILE_HEIGHT)]
        .map(|(pixels, side)| (pixels as usize).div_ceil(side as usize))
}

// ANCHOR: bands
/// Hands a picture out in bands, counted from below, each a part that belongs to one thread alone.
pub(super) fn each_band(
    picture: Rect,
    colors: &mut [Color],
    depths: &mut [f32],
    draw: &(dyn Fn(usize, Band<'_>) + Sync),
) {
    let width = picture.right as usize;
    let pixels = width * TILE_HEIGHT as usize;
    let bands = colors.par_chunks_mut(pixels).zip(depths.par_chunks_mut(pixels)).enumerate();
    bands.for_each(|(row, (colors, depths))| {
        let bottom = row as i32 * TILE_HEIGHT;
        let rect = Rect { bottom, top: (bottom + TILE_HEIGHT).min(picture.top), ..picture };
        draw(row, Band { rect, stride: width, to_next_band: pixels, colors, depths });
    });
}

/// The rows of a picture in which a row of tiles lies, or a copy of them if they are very short.
pub(super) struct Band<'a> {
    /// Its lower left pixel is the first of colors and depths.
    pub(super) rect: Rect,
    /// How many pixels there are from one row to the next.
    pub(super) stride: usize,
    /// How many there are to the same pixel of the next band; 0 in a copy, for which nothing is fetched ahead.
    pub(super) to_next_band: usize,
    pub(super) colors: &'a mut [Color],
    pub(super) depths: &'a mut [f32],
}

impl Band<'_> {
    /// Its tiles from left to right, numbered from `first` on.
    pub(super) fn tiles(&self, first: usize) -> impl Iterator<Item = (usize, Rect)> + use<> {
        let band = self.rect;
        let lefts = band.columns().step_by(TILE_WIDTH as usize);
        let rects = lefts.map(move |left| Rect { left, right: (left + TILE_WIDTH).min(band.right), ..band });
        (first..).zip(rects)
    }
}
// ANCHOR_END: bands

impl Band<'_> {
    /// Lets it be drawn: where it is, or in a copy if it has no room for a group of eight pixels.
    pub(super) fn with_room(self, draw: impl FnOnce(Band<'_>)) {
        let count = self.colors.len();
        if count >= LANES {
            return draw(self);
        }
        let (mut colors, mut depths) = ([Color::BLACK; LANES], [0.0; LANES]);
        colors[..count].copy_from_slice(self.colors);
        depths[..count].copy_from_slice(self.depths);
        draw(Band { to_next_band: 0, colors: &mut colors, depths: &mut depths, ..self });
        self.colors.copy_from_slice(&colors[..count]);
        self.depths.copy_from_slice(&depths[..count]);
    }

    /// Where in the band a pixel stands.
    pub(super) fn index(&self, (x, y): Pixel) -> usize {
        (y - self.rect.bottom) as usize * self.stride + (x - self.rect.left) as usize
    }

    /// Where the rows of a rectangle stand.
    pub(super) fn ranges(&self, rect: Rect) -> impl Iterator<Item = Range<usize>> + Clone + use<> {
        let (first, stride) = (self.index((rect.left, rect.bottom)), self.stride);
        (0..rect.rows().len()).map(move |row| {
            let start = first + row * stride;
            start..start + rect.columns().len()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_at_the_border_are_cut() {
        assert_eq!(tiles_of(Rect::sized(128, 32)), [1, 1]);
        assert_eq!(tiles_of(Rect::sized(129, 33)), [2, 2]);
        assert_eq!(tiles_of(Rect::sized(640, 480)), [5, 15]);
    }

    #[test]
    fn each_pixel_is_in_one_tile_of_one_band() {
        let picture = Rect::sized(300, 70);
        let columns = tiles_of(picture)[0];
        let count = 300 * 70;
        let mut colors = vec![Color::BLACK; count];
        // Each has its own number, to be recognized by.
        let mut depths: Vec<f32> = (0..count).map(|index| index as f32).collect();
        each_band(picture, &mut colors, &mut depths, &|row, band| {
            assert_eq!((band.stride, band.to_next_band), (300, 300 * 32));
            for (number, tile) in band.tiles(row * columns) {
                assert_eq!((tile.left, tile.bottom), (number as i32 % 3 * 128, number as i32 / 3 * 32));
                assert_eq!(band.ranges(tile).count(), tile.rows().len());
                for (y, range) in tile.rows().zip(band.ranges(tile)) {
                    for (x, index) in tile.columns().zip(range.clone()) {
                        assert_eq!(index, band.index((x, y)));
                        assert_eq!(band.depths[index], (y * 300 + x) as f32);
                        assert_eq!(band.colors[index], Color::BLACK, "twice");
                        band.colors[index] = Color::WHITE;
                    }
                    assert_eq!(range.len(), tile.columns().len());
                }
            }
        });
        assert_eq!(colors, vec![Color::WHITE; count]);
    }

    #[test]
    fn pixels_are_counted_from_the_lower_left_one() {
        let rect = Rect { left: 3, bottom: 32, right: 8, top: 64 };
        let band = Band { rect, stride: 5, to_next_band: 0, colors: &mut [], depths: &mut [] };
        assert_eq!([(3, 32), (4, 32), (3, 33), (7, 63)].map(|pixel| band.index(pixel)), [0, 1, 5, 159]);
    }

    #[test]
    fn a_very_short_band_is_drawn_in_a_copy() {
        for width in [1, 7, 8, 9] {
            let picture = Rect::sized(width, 1);
            let mut colors = vec![Color::rgb(1, 2, 3); width as usize];
            let mut depths = vec![0.5; width as usize];
            each_band(picture, &mut colors, &mut depths, &|_, band| {
                band.with_room(|band| {
                    let count = (width as usize).max(LANES);
                    assert_eq!((band.colors.len(), band.depths.len()), (count, count));
                    assert_eq!(band.to_next_band == 0, width < 8, "{width}");
                    assert_eq!((band.colors[0], band.depths[0]), (Color::rgb(1, 2, 3), 0.5));
                    let last = width as usize - 1;
                    (band.colors[last], band.depths[last]) = (Color::WHITE, 0.25);
                });
            });
            assert_eq!((colors.last(), depths.last()), (Some(&Color::WHITE), Some(&0.25)));
        }
    }
}
