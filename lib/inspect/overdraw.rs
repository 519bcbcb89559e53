//! How often each pixel of a picture was written.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::color::Color;
use crate::figure::picture::block;
use crate::figure::{DrawOptions, Variant};
use crate::framebuffer::Framebuffer;
use crate::observer::{Enlargement, Observer};
use crate::probe::Probe;
use crate::rect::{Pixel, Rect};

/// Colors for 0, 1, 2, … writes.
pub(super) const HEAT: [(Color, &str); 7] = [
    (Color::BLACK, "black"),
    (Color::rgb(40, 70, 130), "blue"),
    (Color::rgb(255, 220, 60), "yellow"),
    (Color::rgb(250, 150, 40), "orange"),
    (Color::rgb(235, 60, 40), "red"),
    (Color::rgb(230, 60, 180), "pink"),
    (Color::WHITE, "white"),
];

/// Draws a variant and counts how often each pixel was written: as colors, and what the colors mean, a line each.
///
/// # Panics
/// As [`Framebuffer::new`] does.
#[must_use]
pub fn overdraw(variant: &Variant, options: &DrawOptions<'_>) -> (Framebuffer, Vec<String>) {
    let (width, height) = options.size;
    // Before anything is multiplied: it refuses sizes that are too large.
    let mut picture = Framebuffer::new(width, height);
    let screen = picture.rect();
    let counts = vec![0; width as usize * height as usize];
    let counter = Arc::new(Counter { screen, counts: Mutex::new(Counts { enlargement: None, counts }) });
    let _ = variant.draw(&DrawOptions { observer: Some(counter.clone()), ..options.clone() });

    let mut totals = [0_usize; HEAT.len()];
    for ((x, y), &count) in screen.pixels().zip(&counter.lock().counts) {
        totals[usize::from(count)] += 1;
        picture.set(x, y, HEAT[usize::from(count)].0);
    }
    let line = |(i, total): (usize, &usize)| {
        let more = if i + 1 == HEAT.len() { " or more" } else { "" };
        let pixels = if *total == 1 { "pixel" } else { "pixels" };
        format!("{i}{more}: {} ({total} {pixels})", HEAT[i].1)
    };
    let title = "How often each pixel was written:".to_owned();
    (picture, std::iter::once(title).chain(totals.iter().enumerate().map(line)).collect())
}

/// Counts writes. That all pixels are cleared is none.
#[derive(Debug)]
struct Counter {
    screen: Rect,
    counts: Mutex<Counts>,
}

#[derive(Debug)]
struct Counts {
    /// How the picture shows the current screen, if it is not the picture itself.
    enlargement: Option<Enlargement>,
    /// For each pixel, row by row from below; no more than there are colors for.
    counts: Vec<u8>,
}

impl Counter {
    fn lock(&self) -> MutexGuard<'_, Counts> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for Counter {
    fn written(&self, pixel: Pixel, _: Color) {
        const MOST: u8 = HEAT.len() as u8 - 1;
        let Counts { enlargement, counts } = &mut *self.lock();
        let (factor, origin) = enlargement.map_or((1, (0, 0)), |by| (by.factor, by.origin));
        let block = block(pixel, factor, origin).intersection(self.screen);
        for y in block.rows() {
            for index in block.columns().filter_map(|x| self.screen.index(x, y)) {
                counts[index] = (counts[index] + 1).min(MOST);
            }
        }
    }

    fn enlarged(&self, enlargement: Option<Enlargement>) {
        self.lock().enlargement = enlargement;
    }
}

impl Probe for Counter {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::picture::draw_enlarged;

    #[test]
    fn every_write_is_counted_and_clearing_is_none() {
        fn draw(picture: &mut Framebuffer) {
            picture.clear(Color::RED);
            for (x, writes) in [(1, 1), (2, 2), (3, 9)] {
                (0..writes).for_each(|_| picture.set(x, 0, Color::GREEN));
            }
        }
        let variant = Variant::new("often", draw, "").size(5, 1);
        let (picture, lines) = overdraw(&variant, &variant.options(None));
        let expected = [0, 1, 2, 6, 0].map(|count| Some(HEAT[count].0));
        assert_eq!([0, 1, 2, 3, 4].map(|x| picture.get(x, 0)), expected);
        assert_eq!((lines.len(), lines[1].as_str()), (1 + HEAT.len(), "0: black (2 pixels)"));
        assert_eq!(
            (lines[2].as_str(), lines[7].as_str()),
            ("1: blue (1 pixel)", "6 or more: white (1 pixel)")
        );
    }

    #[test]
    fn of_an_enlarged_screen_a_write_is_a_block() {
        fn draw(picture: &mut Framebuffer) {
            draw_enlarged(picture, (2, 1), |screen| screen.set(1, 0, Color::GREEN));
        }
        let variant = Variant::new("large", draw, "").size(8, 6);
        let (picture, _) = overdraw(&variant, &variant.options(None));
        for (x, y) in picture.rect().rows().flat_map(|y| (0..8).map(move |x| (x, y))) {
            let is_written = x >= 4 && (1..5).contains(&y);
            assert_eq!(picture.get(x, y), Some(HEAT[usize::from(is_written)].0), "({x}, {y})");
        }
    }
}
