//! The size that a picture has in a terminal, and the picture in that size.

use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::srgb::{decode, encode};

/// A picture with no side longer than this is enlarged, so that its pixels can be seen.
const SMALL: u32 = 128;

/// The size that a picture gets within so many pixels. One that is too large keeps its aspect; a small one is enlarged by
/// a whole number.
pub(super) fn within((width, height): (u32, u32), (most_wide, most_high): (u32, u32)) -> (u32, u32) {
    let factor = (most_wide / width).min(most_high / height);
    if factor > 0 {
        let factor = if width.max(height) <= SMALL { factor } else { 1 };
        return (width * factor, height * factor);
    }
    let [w, h, wide, high] = [width, height, most_wide, most_high].map(u64::from);
    if w * high >= h * wide {
        (most_wide, scaled(height, most_wide, width))
    } else {
        (scaled(width, most_high, height), most_high)
    }
}

/// side · part / whole, rounded, and not 0.
fn scaled(side: u32, part: u32, whole: u32) -> u32 {
    let [side, part, whole] = [side, part, whole].map(u64::from);
    ((side * part + whole / 2) / whole).max(1) as u32
}

/// The picture in the size that it gets within so many pixels.
pub(super) fn fitted(picture: &Framebuffer, most: (u32, u32)) -> Framebuffer {
    let size = within((picture.width(), picture.height()), most);
    let mut fitted = Framebuffer::new(size.0, size.1);
    let rows: Vec<&[Color]> = picture.rows_from_top().collect();
    let columns: Vec<Vec<Share>> = (0..size.0).map(|x| shares(x, picture.width(), size.0)).collect();
    for (row, y) in (0..size.1).zip((0..size.1 as i32).rev()) {
        let mut lights = vec![[0.0; 3]; columns.len()];
        for (from, row_share) in shares(row, picture.height(), size.1) {
            let row: Vec<[f64; 3]> = rows[from].iter().map(|color| light(*color)).collect();
            for (sum, column) in lights.iter_mut().zip(&columns) {
                for &(from, share) in column {
                    *sum = std::array::from_fn(|k| sum[k] + row[from][k] * share * row_share);
                }
            }
        }
        for (x, light) in (0..).zip(lights) {
            fitted.set(x, y, Color::truncated(encode(light)));
        }
    }
    fitted
}

/// The light of a color.
pub(super) fn light(color: Color) -> [f64; 3] {
    decode(color.channels().map(f64::from))
}

/// The place of an old pixel in its row, and which part of a new pixel it covers.
type Share = (usize, f64);

/// Of `old` pixels in a row `new` ones are made: those that the one at `place` is the mean of. A row of both has the same
/// length, old · new:
///
/// ```text
///   old   ├───────────┼───────────┼───────────┤    each `new` long
///   new   ├─────────────────┼─────────────────┤    each `old` long
///          share: 2/3   1/3
/// ```
fn shares(place: u32, old: u32, new: u32) -> Vec<Share> {
    let [place, old, new] = [place, old, new].map(u64::from);
    let (start, end) = (place * old, (place + 1) * old);
    let share = |from: u64| (end.min((from + 1) * new) - start.max(from * new)) as f64 / old as f64;
    (start / new..end.div_ceil(new)).map(|from| (from as usize, share(from))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        for (size, most, expected) in [
            ((640, 480), (640, 480), (640, 480)),
            ((640, 480), (2000, 2000), (640, 480)), // large enough
            ((640, 480), (100, 100), (100, 75)),    // columns are few
            ((640, 480), (100, 48), (64, 48)),      // rows are few
            ((16_384, 1), (80, 48), (80, 1)),       // never nothing
            ((1, 16_384), (80, 48), (1, 48)),
            ((8, 6), (100, 48), (64, 48)), // eight times
            ((8, 6), (15, 48), (8, 6)),    // no place for the double
            ((128, 128), (300, 300), (256, 256)),
            ((129, 12), (300, 300), (129, 12)),
        ] {
            assert_eq!(within(size, most), expected, "{size:?} within {most:?}");
        }
    }

    #[test]
    fn light_is_what_is_averaged() {
        let mut picture = Framebuffer::new(130, 2);
        for x in (0..130).step_by(2) {
            picture.set(x, 0, Color::WHITE);
            picture.set(x + 1, 1, Color::WHITE);
        }
        // Half of the light, not half of the number.
        let half = fitted(&picture, (65, 9));
        assert_eq!((half.width(), half.height()), (65, 1));
        assert!(half.rows_from_top().flatten().all(|&color| color == Color::gray(188)));
    }

    #[test]
    fn a_pixel_is_cut_where_a_new_one_begins() {
        assert_eq!(shares(0, 3, 2), [(0, 2.0 / 3.0), (1, 1.0 / 3.0)]);
        assert_eq!(shares(1, 3, 2), [(1, 1.0 / 3.0), (2, 2.0 / 3.0)]);
        assert_eq!(shares(5, 2, 6), [(1, 1.0)]);
    }

    #[test]
    fn enlarged_pixels_keep_their_colors() {
        let mut picture = Framebuffer::new(2, 2);
        picture.set(1, 0, Color::rgb(1, 128, 254));
        let large = fitted(&picture, (7, 7));
        assert_eq!((large.width(), large.height()), (6, 6));
        for (x, y) in (0..6).flat_map(|y| (0..6).map(move |x| (x, y))) {
            assert_eq!(large.get(x, y), picture.get(x / 3, y / 3));
        }
    }
}
