//! Chapter 1: a value for each pixel of a picture, in memory. Colors and depths are kept in such planes.
//!
//! To read it, it is a slice. It also keeps what the fast rasterizer knows of it: which parts hold nothing but the
//! background and need not be cleared again. Whoever else writes to it makes that void.

use std::ops::{Deref, DerefMut};

/// The values of a picture, row by row from below, each from left to right.
#[derive(Clone, Debug)]
pub(crate) struct Plane<T> {
    values: Vec<T>,
    #[cfg(feature = "tiled")]
    blank: Blank,
}

impl<T> From<Vec<T>> for Plane<T> {
    fn from(values: Vec<T>) -> Self {
        Self {
            values,
            #[cfg(feature = "tiled")]
            blank: Blank::default(),
        }
    }
}

impl<T> Deref for Plane<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.values
    }
}

impl<T> DerefMut for Plane<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        #[cfg(feature = "tiled")]
        self.blank.tiles.clear();
        &mut self.values
    }
}

/// Which tiles of a plane are blank: all their values are the background's.
#[cfg(feature = "tiled")]
#[derive(Clone, Debug, Default)]
pub(crate) struct Blank {
    /// The bits of the background.
    background: u32,
    /// For each tile whether it is known to be blank. No tile: nothing is known.
    tiles: Vec<bool>,
}

#[cfg(feature = "tiled")]
impl<T> Plane<T> {
    /// What is known; who takes it may change the plane, and says then what is known now.
    pub(crate) fn take_blank(&mut self) -> Blank {
        std::mem::take(&mut self.blank)
    }

    /// Says what is known.
    pub(crate) fn set_blank(&mut self, blank: Blank) {
        self.blank = blank;
    }
}

#[cfg(feature = "tiled")]
impl Blank {
    /// Whether a tile is known to hold nothing but a background of these bits.
    pub(crate) fn holds(&self, tile: usize, background: u32) -> bool {
        self.background == background && self.tiles.get(tile) == Some(&true)
    }

    /// The plane has been cleared, and then only tiles that are not empty were drawn.
    pub(crate) fn cleared(&mut self, background: u32, tiles: usize, is_empty: impl Fn(usize) -> bool) {
        self.background = background;
        self.tiles.clear();
        self.tiles.extend((0..tiles).map(is_empty));
    }

    /// Tiles that are not empty were drawn.
    pub(crate) fn drawn(&mut self, is_empty: impl Fn(usize) -> bool) {
        for (tile, is_blank) in self.tiles.iter_mut().enumerate() {
            *is_blank &= is_empty(tile);
        }
    }
}
