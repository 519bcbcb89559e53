//! Pictures in the terminal: `--show`.
//!
//! ```text
//!   environment ── terminal ──► How, columns × rows ─┐
//!                                                    ├─ rendered ──► bytes for standard output
//!   picture ─────── fit ──────► picture that fits ───┘
//! ```
//!
//! Every terminal has characters: with the upper half block ▀ a cell shows two pixels, one above the other. Some take
//! pictures as well, in one of three ways; which, `terminal` finds out from the environment.

mod blocks;
mod fit;
mod graphics;
mod terminal;

use std::io::IsTerminal;

use console::Term;
use image::ImageError;

use super::failure::Failure;
use crate::framebuffer::Framebuffer;
use blocks::blocks;
use fit::{fitted, within};
use graphics::{CELL, MOST_SIXELS, SMALL_CELL, iterm, kitty, sixel};
pub(super) use terminal::Asked;
use terminal::{Choice, How, Output, choose, columns_of};

/// A terminal, or a file that one is shown later, and how it shows pictures.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Screen {
    choice: Choice,
    /// Columns and rows that a picture may take.
    cells: (u32, u32),
}

impl Screen {
    /// Below a picture stand the lines that the program says of it, two at most, and the next prompt.
    const LINES_BELOW: u32 = 3;

    /// Where standard output goes, and how pictures are shown there.
    pub(super) fn find(asked: Asked) -> Result<Self, Failure> {
        let lookup = |name: &str| std::env::var(name).ok();
        let term = Term::stdout();
        let output = match std::io::stdout().is_terminal() {
            false => Output::File,
            // To ask a console of Windows for its colors is also to switch them on.
            true if cfg!(windows) && term.features().colors_supported() => Output::Console,
            true => Output::Terminal,
        };
        let choice = choose(asked, output, lookup)?;
        let cells = if output == Output::File {
            (columns_of(lookup), Framebuffer::MAX_SIDE)
        } else {
            let (rows, columns) = term.size_checked().unwrap_or((24, 80));
            (u32::from(columns), u32::from(rows).saturating_sub(Self::LINES_BELOW).max(1))
        };
        Ok(Self { choice, cells })
    }

    /// The picture as the bytes that show it here.
    pub(super) fn rendered(&self, picture: &Framebuffer) -> Result<Vec<u8>, ImageError> {
        rendered(picture, self.choice.how, self.cells)
    }

    /// What to say of the way in which pictures are shown.
    pub(super) fn note(&self) -> Option<&str> {
        self.choice.note.as_deref()
    }
}

/// A picture as bytes that show it in so many columns and rows. They end on a fresh line, and leave no color behind.
fn rendered(picture: &Framebuffer, how: How, (columns, rows): (u32, u32)) -> Result<Vec<u8>, ImageError> {
    let pixels = |(width, height): (u32, u32)| (columns * width, rows * height);
    let size = (picture.width(), picture.height());
    match how {
        How::Blocks(colors) => Ok(blocks(&fitted(picture, pixels((1, 2))), colors)),
        How::Sixel => {
            let (width, height) = pixels(SMALL_CELL);
            Ok(sixel(&fitted(picture, (width.min(MOST_SIXELS), height.min(MOST_SIXELS)))))
        }
        How::Kitty | How::Iterm => {
            let (width, height) = within(size, pixels(CELL));
            let shown = (width.div_ceil(CELL.0), height.div_ceil(CELL.1));
            // The terminal reduces it, from at most twice as many pixels as we think that it has.
            let is_reduced = width < size.0 || height < size.1;
            let sent = fitted(picture, pixels(if is_reduced { (2 * CELL.0, 2 * CELL.1) } else { CELL }));
            if how == How::Kitty { kitty(&sent, shown) } else { iterm(&sent, shown) }
        }
    }
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::graphics::tests::{kitty_parts, pixels_of_sixel};
    use super::terminal::Colors;
    use super::*;
    use crate::Color;

    fn image_of(picture: &Framebuffer) -> RgbImage {
        RgbImage::from_raw(picture.width(), picture.height(), picture.rgb_from_top()).expect("whole")
    }

    fn gradient(width: u32, height: u32) -> Framebuffer {
        let mut picture = Framebuffer::new(width, height);
        for (x, y) in (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| (x, y))) {
            picture.set(x, y, Color::rgb((x * 7) as u8, (y * 5) as u8, 9));
        }
        picture
    }

    #[test]
    fn blocks_take_no_more_than_their_cells() {
        let bytes = rendered(&gradient(640, 480), How::Blocks(Colors::All), (100, 20)).expect("no file");
        let text = String::from_utf8(bytes).expect("UTF-8");
        assert_eq!(text.lines().count(), 20);
        // 4:3 of 40 square pixels.
        assert!(text.lines().all(|line| line.matches('▀').count() == 53 && line.ends_with("\x1b[0m")));
    }

    #[test]
    fn kitty_gets_every_pixel_and_as_many_columns_as_they_fill() {
        let picture = gradient(330, 200);
        let (control, image) = kitty_parts(&rendered(&picture, How::Kitty, (100, 40)).expect("PNG"));
        assert!(control.contains(",c=33,"), "{control}");
        assert_eq!(image, image_of(&picture));
        // Not as wide as the picture: the terminal reduces it, from what it may have use for.
        let (control, image) = kitty_parts(&rendered(&picture, How::Kitty, (20, 40)).expect("PNG"));
        assert!(control.contains(",c=20,") && image == image_of(&picture), "{control}");
        let (control, image) = kitty_parts(&rendered(&picture, How::Kitty, (5, 40)).expect("PNG"));
        assert!(control.contains(",c=5,") && image.dimensions() == (100, 61), "{control}");
        // Ten times as large, since it is small.
        let (control, image) = kitty_parts(&rendered(&gradient(20, 10), How::Kitty, (21, 40)).expect("PNG"));
        assert!(control.contains(",c=20,") && image.dimensions() == (200, 100), "{control}");
    }

    #[test]
    fn sixels_are_the_picture() {
        // No more colors than a palette has.
        let picture = gradient(16, 13);
        let shown = pixels_of_sixel(&rendered(&picture, How::Sixel, (5, 40)).expect("no file"));
        let picture = image_of(&picture);
        assert_eq!(shown.dimensions(), picture.dimensions());
        let large = rendered(&gradient(1600, 8), How::Sixel, (300, 40)).expect("no file");
        assert_eq!(pixels_of_sixel(&large).dimensions(), (1000, 5));
        for (shown, pixel) in shown.pixels().zip(picture.pixels()) {
            // A color has 101 steps a channel.
            assert!(shown.0.iter().zip(pixel.0).all(|(&a, b)| a.abs_diff(b) <= 2), "{shown:?} {pixel:?}");
        }
    }
}
