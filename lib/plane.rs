//! Chapter 1: a value for each pixel of a picture, in memory. Colors and depths are kept in such planes.
//!
//! It reads as a slice. It also keeps what the fast rasterizer knows of it: which parts hold nothing but the background
//! and need not be cleared again. Any other write makes that void.

use std::ops::{Deref, DerefMut};

/// The values of a picture, row by row from below, each from left to right.
#[derive(Clone, Debug)]
pub(crate) struct PixelPlane<T> {
    values: Vec<T>,
    #[cfg(feature = "tiled")]
    blank: Blank,
}

impl<T> From<Vec<T>> for PixelPlane<T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            #[cfg(feature = "tiled")]
            blank: Blank::default(),
        }
    }
}

impl<T> Deref for PixelPlane<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.values
    }
}

impl<T> DerefMut for PixelPlane<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        #[cfg(feature = "tiled")]
        self.blank.forget();
        &mut self.values
    }
}

#[cfg(feature = "tiled")]
pub(crate) use blank::Blank;

#[cfg(feature = "tiled")]
mod blank {
    use super::PixelPlane;

    /// Which tiles of a plane are blank: all their values are the background's.
    #[derive(Clone, Debug, Default)]
    pub(crate) struct Blank {
        /// Width and height of the picture whose tiles they are.
        size: [i32; 2],
        /// The bits of the background.
        background: u32,
        /// For each tile whether it is known to be blank. No tile: nothing is known.
        tiles: Vec<bool>,
    }

    impl<T> PixelPlane<T> {
        /// Takes out what is known of the tiles of a picture of this size. After that nothing is, until `set_blank`.
        pub(crate) fn take_blank(&mut self, size: [i32; 2]) -> Blank {
            let mut blank = std::mem::take(&mut self.blank);
            if blank.size != size {
                blank.size = size;
                blank.forget();
            }
            blank
        }

        /// Says what is known.
        pub(crate) fn set_blank(&mut self, blank: Blank) {
            self.blank = blank;
        }
    }

    impl Blank {
        /// Whether a tile is known to hold nothing but a background of these bits.
        pub(crate) fn holds(&self, tile: usize, background: u32) -> bool {
            self.background == background && self.tiles.get(tile) == Some(&true)
        }

        /// Nothing is known any more.
        #[inline]
        pub(super) fn forget(&mut self) {
            self.tiles.clear();
        }

        /// The plane has been cleared, and then only tiles that are not empty were drawn.
        pub(crate) fn cleared(&mut self, background: u32, tiles: usize, is_empty: impl Fn(usize) -> bool) {
            self.background = background;
            self.forget();
            self.tiles.extend((0..tiles).map(is_empty));
        }

        /// Tiles that are not empty were drawn.
        pub(crate) fn drawn(&mut self, is_empty: impl Fn(usize) -> bool) {
            for (tile, is_blank) in self.tiles.iter_mut().enumerate() {
                *is_blank &= is_empty(tile);
            }
        }
    }
}
