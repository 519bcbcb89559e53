//! Pictures made of pictures: enlarged, side by side, and where two of them differ.

use super::fit::Fit;
use super::ruler::ruler;
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::observer::Enlargement;
use crate::rect::{Pixel, Rect};

/// How a picture is enlarged so that its pixels can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zoom {
    /// Each pixel becomes a block of factor × factor pixels.
    pub factor: u32,
    /// The pixel around which to cut, framebuffer coordinates; the middle of the picture if there is none.
    pub center: Option<Pixel>,
}

impl Zoom {
    /// The largest factor.
    pub const MAX_FACTOR: u32 = 64;
    /// From this factor on, a thin grid separates the pixels.
    const GRID_FROM: u32 = 8;
    /// The part that is shown fits into so many pixels when it is enlarged.
    const SHOWN: (u32, u32) = (1280, 960);

    /// The part of a picture that is shown: around the center, moved so that it lies inside the picture.
    ///
    /// # Panics
    /// If the factor is 0.
    #[must_use]
    pub fn part(self, whole: Rect) -> Rect {
        self.part_within(whole, Self::SHOWN)
    }

    /// The same, where the enlarged part fits into so many pixels.
    pub(crate) fn part_within(self, whole: Rect, (width, height): (u32, u32)) -> Rect {
        let range = |center: Option<i32>, side: i32, shown: u32| {
            let count = if self.factor == 1 { side } else { side.min((shown / self.factor).max(1) as i32) };
            let first = center.unwrap_or(side / 2).saturating_sub(count / 2).clamp(0, side - count);
            (first, first + count)
        };
        let (left, right) = range(self.center.map(|(x, _)| x), whole.right, width);
        let (bottom, top) = range(self.center.map(|(_, y)| y), whole.top, height);
        Rect { left, bottom, right, top }
    }
}

const GRID: Color = Color::gray(80);
const GAP: Color = Color::gray(128);
const GAP_WIDTH: u32 = 4;

/// The whole picture, each pixel as a block of factor × factor.
///
/// # Panics
/// As [`Framebuffer::new`] does, if the result is too large.
#[must_use]
pub fn enlarged(picture: &Framebuffer, factor: u32) -> Framebuffer {
    blocks(picture, picture.rect(), factor)
}

/// The part of a picture around the zoom's center, each pixel as a block, in a frame that numbers its columns and rows.
///
/// # Panics
/// As [`enlarged`] and [`Zoom::part`] do.
#[must_use]
pub fn zoomed(picture: &Framebuffer, zoom: Zoom) -> Framebuffer {
    let part = zoom.part(picture.rect());
    let blocks = blocks(picture, part, zoom.factor);
    if zoom.factor == 1 {
        // Nothing is enlarged, and a frame may not fit into the largest picture.
        return blocks;
    }
    let (mut framed, (left, bottom)) = ruler(part, zoom.factor);
    paste(&mut framed, &blocks, left, bottom);
    framed
}

/// The block that shows a pixel of an enlarged screen, the block of (0, 0) at `origin`; from a certain size on a line is
/// left free beside it.
pub(crate) const fn block((x, y): Pixel, factor: u32, origin: Pixel) -> Rect {
    let line = if factor >= Zoom::GRID_FROM { 1 } else { 0 };
    let factor = if factor < i32::MAX as u32 { factor as i32 } else { i32::MAX };
    let left = origin.0.saturating_add(x.saturating_mul(factor));
    let bottom = origin.1.saturating_add(y.saturating_mul(factor));
    let (right, top) = (left.saturating_add(factor - line), bottom.saturating_add(factor - line));
    Rect { left, bottom, right, top }
}

/// A part of a picture, each pixel as a block, with a thin grid if the blocks are large enough.
fn blocks(picture: &Framebuffer, part: Rect, factor: u32) -> Framebuffer {
    let [width, height] =
        [part.columns(), part.rows()].map(|side| (side.len() as u32).saturating_mul(factor));
    let mut result = Framebuffer::new(width, height);
    fill_blocks(&mut result, picture, part, factor);
    result
}

/// The same, from the lower left pixel of a picture on; what does not fit is cut.
pub(crate) fn fill_blocks(into: &mut Framebuffer, picture: &Framebuffer, part: Rect, factor: u32) {
    into.clear(GRID);
    for (x, y) in part.pixels() {
        let block = block((x - part.left, y - part.bottom), factor, (0, 0));
        into.fill(block, picture.get(x, y).unwrap_or_default());
    }
}

/// Draws on a screen of its own, `width` × `height` pixels, and shows each of them as a block, as large as all of them fit.
///
/// The screen comes to lie in the middle. Of one that is larger than the picture, the middle is shown.
///
/// # Panics
/// As [`Framebuffer::new`] does.
pub fn draw_enlarged(into: &mut Framebuffer, screen: (u32, u32), draw: impl FnOnce(&mut Framebuffer)) {
    draw_enlarged_within(into, into.rect(), screen, draw);
}

/// The same in a part of a picture: the screen comes to lie in its middle. Where its pixels are in the picture.
///
/// # Panics
/// As [`Framebuffer::new`] does.
pub fn draw_enlarged_within(
    into: &mut Framebuffer,
    part: Rect,
    (width, height): (u32, u32),
    draw: impl FnOnce(&mut Framebuffer),
) -> Fit {
    let mut screen = Framebuffer::new(width, height);
    let (columns, rows) = (part.columns().len() as u32, part.rows().len() as u32);
    let factor = (columns / width).min(rows / height).max(1);
    // At most the half of 2³², so it is an `i32`.
    let middle = |side: u32, shown: u32| (i64::from(side) - i64::from(shown * factor)).div_euclid(2) as i32;
    let origin =
        (part.left.saturating_add(middle(columns, width)), part.bottom.saturating_add(middle(rows, height)));

    let observer = into.observer();
    screen.set_observer(observer.clone());
    let enlargement = Enlargement { screen: screen.rect(), factor, origin };
    screen.report(|observer| observer.enlarged(Some(enlargement)));
    draw(&mut screen);
    screen.report(|observer| observer.enlarged(None));
    // Writing the blocks is not reported.
    into.set_observer(None);
    paste(into, &enlarged(&screen, factor), origin.0, origin.1);
    into.set_observer(observer);
    Fit::placed(origin, factor)
}

/// Copies a picture into another one, its lower left corner to (left, bottom); what does not fit is left out.
pub fn paste(into: &mut Framebuffer, picture: &Framebuffer, left: i32, bottom: i32) {
    for (x, y) in picture.rect().pixels() {
        into.set(left.saturating_add(x), bottom.saturating_add(y), picture.get(x, y).unwrap_or_default());
    }
}

/// Where two pictures of equal size differ: magenta on a dim gray copy of the first, and how many pixels that are.
///
/// `None` if the sizes differ.
#[must_use]
pub fn difference(this: &Framebuffer, that: &Framebuffer) -> Option<(Framebuffer, usize)> {
    if this.rect() != that.rect() {
        return None;
    }
    let mut result = Framebuffer::new(this.width(), this.height());
    let mut count = 0;
    for (x, y) in this.rect().pixels() {
        let color = this.get(x, y).unwrap_or_default();
        let differs = that.get(x, y) != Some(color);
        count += usize::from(differs);
        result.set(x, y, if differs { Color::rgb(255, 0, 255) } else { dim(color) });
    }
    Some((result, count))
}

/// A dark gray of the color's brightness.
fn dim(color: Color) -> Color {
    let [red, green, blue] = color.channels().map(u32::from);
    Color::gray(((red * 2 + green * 5 + blue) / 8 / 4) as u8)
}

/// How wide pictures of these widths are beside each other, with the gaps between them.
///
/// `None` if there are none, or if that would be too wide for a framebuffer.
#[must_use]
pub fn width_side_by_side(widths: impl IntoIterator<Item = u32>) -> Option<u32> {
    let with_gap = |width: u32| width.checked_add(GAP_WIDTH);
    let total = widths.into_iter().try_fold(0_u32, |sum, width| sum.checked_add(with_gap(width)?))?;
    total.checked_sub(GAP_WIDTH).filter(|width| *width <= Framebuffer::MAX_SIDE)
}

/// Pictures beside each other, from left to right, with a gray gap between them; aligned at the top.
///
/// `None` if the result would be too large for a framebuffer.
#[must_use]
pub fn side_by_side(pictures: &[Framebuffer]) -> Option<Framebuffer> {
    let width = width_side_by_side(pictures.iter().map(Framebuffer::width))?;
    let height = pictures.iter().map(Framebuffer::height).max()?;
    let mut result = Framebuffer::new(width, height);
    result.clear(GAP);
    let mut left = 0;
    for picture in pictures {
        let bottom = (height - picture.height()) as i32;
        paste(&mut result, picture, left, bottom);
        left += (picture.width() + GAP_WIDTH) as i32;
    }
    Some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dots(width: u32, height: u32, dots: &[(i32, i32)]) -> Framebuffer {
        let mut picture = Framebuffer::new(width, height);
        for &(x, y) in dots {
            picture.set(x, y, Color::RED);
        }
        picture
    }

    #[test]
    fn enlarging_makes_blocks_and_a_grid() {
        let small = enlarged(&dots(3, 2, &[(1, 1)]), 2);
        assert_eq!((small.width(), small.height()), (6, 4));
        let red = |x, y| small.get(x, y) == Some(Color::RED);
        assert!(red(2, 2) && red(3, 3) && !red(1, 2) && !red(4, 3) && !red(2, 1));

        let large = enlarged(&dots(3, 2, &[(1, 1)]), 8);
        assert_eq!(large.get(8, 8), Some(Color::RED));
        assert_eq!(large.get(14, 14), Some(Color::RED));
        assert_eq!(large.get(15, 14), Some(GRID));
        assert_eq!(large.get(14, 15), Some(GRID));
    }

    #[test]
    fn an_enlarged_screen_lies_in_the_middle_of_its_part() {
        let part = Rect { left: 20, bottom: 10, right: 45, top: 32 };
        let mut picture = Framebuffer::new(50, 40);
        let cells = draw_enlarged_within(&mut picture, part, (4, 2), |screen| screen.set(1, 1, Color::RED));
        // Six times as large: a column is left over on the right, and five rows below and above.
        assert_eq!(cells, Fit::placed((20, 15), 6));
        assert_eq!(cells.at(glam::dvec2(1.0, 1.0)), glam::dvec2(26.0, 21.0));
        let reds = picture.rect().rows().flat_map(|y| (0..50).map(move |x| (x, y)));
        let reds: Vec<_> = reds.filter(|&(x, y)| picture.get(x, y) == Some(Color::RED)).collect();
        assert_eq!((reds.len(), reds[0], reds[35]), (36, (26, 21), (31, 26)));
        // Where the height is what limits it, and the part does not begin at the border.
        let flat = Rect { bottom: 3, top: 12, ..part };
        let cells = draw_enlarged_within(&mut picture, flat, (4, 2), |_| {});
        assert_eq!(cells, Fit::placed((24, 3), 4));
    }

    #[test]
    fn zoom_cuts_around_its_center_and_stays_inside() {
        let picture = dots(640, 480, &[(0, 0), (639, 479)]);
        for (center, corner) in [((0, 0), (0, 0)), ((639, 479), (1279 - 31, 959 - 31))] {
            let zoom = Zoom { factor: 32, center: Some(center) };
            let (frame, (left, bottom)) = ruler(zoom.part(picture.rect()), 32);
            let part = zoomed(&picture, zoom);
            assert_eq!(part.rect(), frame.rect());
            assert_eq!(part.get(left + corner.0, bottom + corner.1), Some(Color::RED));
            assert_eq!(part.get(left - 1, bottom + corner.1), frame.get(left - 1, bottom + corner.1));
        }
        let middle = Zoom { factor: 32, center: None }.part(picture.rect());
        assert_eq!(middle, Rect { left: 300, bottom: 225, right: 340, top: 255 }, "1280 × 960 pixels of it");
        let same = Zoom { factor: 1, center: Some((0, 0)) };
        assert_eq!(zoomed(&picture, same).rect(), picture.rect(), "no frame: it might not fit");
    }

    #[test]
    fn difference_counts_and_marks() {
        let (marked, count) =
            difference(&dots(4, 4, &[(1, 1), (2, 2)]), &dots(4, 4, &[(1, 1), (3, 0)])).expect("same size");
        assert_eq!(count, 2);
        assert_eq!(marked.get(2, 2), Some(Color::rgb(255, 0, 255)));
        assert_eq!(marked.get(3, 0), Some(Color::rgb(255, 0, 255)));
        assert_eq!(marked.get(1, 1), Some(Color::gray(15)), "a quarter of the brightness of red");
        let dimmed = [Color::RED, Color::GREEN, Color::BLUE, Color::WHITE].map(dim);
        assert_eq!(dimmed, [15, 39, 7, 63].map(Color::gray), "green is the brightest, blue the darkest");
        assert!(difference(&dots(4, 4, &[]), &dots(4, 5, &[])).is_none());
    }

    #[test]
    fn side_by_side_has_gaps() {
        let both = side_by_side(&[dots(2, 2, &[(0, 1)]), dots(2, 3, &[(1, 0)])]).expect("small enough");
        assert_eq!((both.width(), both.height()), (8, 3));
        assert_eq!(both.get(0, 2), Some(Color::RED), "aligned at the top");
        assert_eq!(both.get(3, 1), Some(GAP));
        assert_eq!(both.get(7, 0), Some(Color::RED));
        let half = (Framebuffer::MAX_SIDE - GAP_WIDTH) / 2;
        let wide = |width| side_by_side(&[dots(half, 1, &[]), dots(width, 1, &[])]);
        assert_eq!(wide(half).expect("as wide as it may be").width(), Framebuffer::MAX_SIDE);
        assert!(wide(half + 1).is_none());
        let three = side_by_side(&[dots(2, 1, &[]), dots(2, 1, &[]), dots(2, 1, &[(1, 0)])]);
        assert_eq!(three.map(|three| (three.width(), three.get(13, 0))), Some((14, Some(Color::RED))));
    }
}
