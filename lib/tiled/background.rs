//! The background: what stands where nothing is drawn. Where it stands already it is not written again.

use super::bands::Band;
use crate::color::Color;
use crate::plane::PixelPlane;
use crate::rect::Rect;
use crate::state::{LoadOp, RenderState};

// ANCHOR: background
/// The background of a picture, and where it was before this one was begun.
pub(super) struct Background {
    load: LoadOp,
    color: Color,
    depth: f32,
    /// Which tiles hold nothing else, of the colors and of the depths.
    blank: [Box<Blank>; 2],
}

impl Background {
    /// The background of a state. What is known of the planes is taken from them: they will be drawn on.
    pub(super) fn take(
        state: &RenderState,
        picture: Rect,
        colors: &mut PixelPlane<Color>,
        depths: &mut PixelPlane<f32>,
    ) -> Self {
        let size = [picture.right, picture.top];
        let blank = [Blank::take(colors, size), Blank::take(depths, size)];
        Self { load: state.load, color: state.clear_color, depth: state.clear_depth as f32, blank }
    }

    /// The bits of color and depth.
    fn bits(&self) -> [u32; 2] {
        [self.color.bits(), self.depth.to_bits()]
    }

    /// Clears the tiles of a band, which are numbered from `first` on, if that is wanted, and but for those that are blank.
    ///
    /// Tiles that stand side by side are cleared together: long rows are fetched ahead of their use, those of a single
    /// tile one by one.
    pub(super) fn clear(&self, band: &mut Band<'_>, first: usize) {
        if self.load != LoadOp::Clear {
            return;
        }
        let bits = self.bits();
        let is_blank = |tile| self.blank.iter().zip(bits).all(|(blank, bits)| blank.holds(tile, bits));
        let mut run: Option<Rect> = None;
        for (tile, rect) in band.tiles(first) {
            if !is_blank(tile) {
                run = Some(Rect { left: run.map_or(rect.left, |run| run.left), ..rect });
            } else if let Some(run) = run.take() {
                self.fill(band, run);
            }
        }
        if let Some(run) = run {
            self.fill(band, run);
        }
    }

    fn fill(&self, band: &mut Band<'_>, rect: Rect) {
        if rect == band.rect {
            fill(band.colors, self.color);
            fill(band.depths, self.depth);
        } else {
            for range in band.ranges(rect) {
                band.colors[range.clone()].fill(self.color);
                band.depths[range].fill(self.depth);
            }
        }
    }

    /// Gives the planes back what is known of them, now that tiles that are not empty have been drawn.
    pub(super) fn put_back(
        mut self,
        colors: &mut PixelPlane<Color>,
        depths: &mut PixelPlane<f32>,
        tiles: usize,
        is_empty: &dyn Fn(usize) -> bool,
    ) {
        let bits = self.bits();
        for (blank, bits) in self.blank.iter_mut().zip(bits) {
            match self.load {
                LoadOp::Clear => blank.cleared(bits, tiles, is_empty),
                LoadOp::Load => blank.drawn(is_empty),
            }
        }
        let [of_colors, of_depths] = self.blank;
        colors.leave_memo(of_colors);
        depths.leave_memo(of_depths);
    }
}
// ANCHOR_END: background

/// Which tiles of a plane are blank, that is, hold nothing but the background: a memo that is left with the plane, and
/// void as soon as a value of it is written by others.
#[derive(Debug, Default)]
struct Blank {
    /// Width and height of the picture whose tiles they are.
    size: [i32; 2],
    /// The bits of the background.
    background: u32,
    /// For each tile whether it is known to be blank. No tile: nothing is known.
    tiles: Vec<bool>,
}

impl Blank {
    /// Takes out what is known of the tiles of a picture of this size.
    fn take<T>(plane: &mut PixelPlane<T>, size: [i32; 2]) -> Box<Self> {
        let mut blank = plane.take_memo::<Self>().unwrap_or_default();
        if blank.size != size {
            blank.size = size;
            blank.tiles.clear();
        }
        blank
    }

    /// Whether a tile is known to hold nothing but a background of these bits.
    fn holds(&self, tile: usize, background: u32) -> bool {
        self.background == background && self.tiles.get(tile) == Some(&true)
    }

    /// The plane has been cleared, and then only tiles that are not empty were drawn.
    fn cleared(&mut self, background: u32, tiles: usize, is_empty: impl Fn(usize) -> bool) {
        self.background = background;
        self.tiles.clear();
        self.tiles.extend((0..tiles).map(is_empty));
    }

    /// Tiles that are not empty were drawn.
    fn drawn(&mut self, is_empty: impl Fn(usize) -> bool) {
        for (tile, is_blank) in self.tiles.iter_mut().enumerate() {
            *is_blank &= is_empty(tile);
        }
    }
}

/// Fills a plane with one value.
///
/// Block by block: for copies of some thousand bytes processors have instructions that need not fetch what they write
/// over.
fn fill<T: Copy>(plane: &mut [T], value: T) {
    const BLOCK: usize = 4096;
    let (first, rest) = plane.split_at_mut(BLOCK.min(plane.len()));
    first.fill(value);
    rest.chunks_mut(BLOCK).for_each(|block| block.copy_from_slice(&first[..block.len()]));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether each of five tiles holds this background.
    fn blank_tiles(blank: &Blank, background: u32) -> [bool; 5] {
        std::array::from_fn(|tile| blank.holds(tile, background))
    }

    #[test]
    fn a_tile_is_blank_until_something_is_drawn_in_it() {
        let mut blank = Blank::default();
        assert_eq!(blank_tiles(&blank, 0), [false; 5], "nothing is known yet");
        blank.cleared(7, 4, |tile| tile != 2);
        assert_eq!(blank_tiles(&blank, 7), [true, true, false, true, false]);
        assert_eq!(blank_tiles(&blank, 8), [false; 5], "another background");
        blank.drawn(|tile| tile == 1 || tile == 2);
        assert_eq!(blank_tiles(&blank, 7), [false, true, false, false, false]);
    }

    #[test]
    fn what_is_blank_is_left_with_the_planes() {
        let picture = Rect::sized(300, 20);
        let plane_of = |size| PixelPlane::from(vec![Color::BLACK; size]);
        let (mut colors, mut depths) = (plane_of(6000), PixelPlane::from(vec![1.0_f32; 6000]));
        let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
        let background = Background::take(&state, picture, &mut colors, &mut depths);
        let [color, depth] = background.bits();
        assert_eq!([color, depth], [state.clear_color.bits(), (state.clear_depth as f32).to_bits()]);
        background.put_back(&mut colors, &mut depths, 3, &|tile| tile == 1);
        let again = Background::take(&state, picture, &mut colors, &mut depths);
        let expected = [false, true, false, false, false];
        assert_eq!([&again.blank[0], &again.blank[1]].map(|it| it.background), [color, depth]);
        assert_eq!(blank_tiles(&again.blank[0], color), expected);
        assert_eq!(blank_tiles(&again.blank[1], depth), expected);
        // The same pixels in another shape: other tiles.
        again.put_back(&mut colors, &mut depths, 3, &|_| true);
        let other = Background::take(&state, Rect::sized(20, 300), &mut colors, &mut depths);
        assert_eq!(blank_tiles(&other.blank[0], color), [false; 5]);
    }
}
