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
