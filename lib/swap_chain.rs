//! Chapter 9: double buffering. Nobody sees a picture before it is finished.
//!
//! Behind the last stage: pictures are drawn into the back buffer; `present` makes a finished one the front buffer,
//! which is what the screen shows.
//!
//! ```
//! use rasterbook::Color;
//! use rasterbook::swap_chain::SwapChain;
//!
//! let mut screen = SwapChain::new(4, 3);
//! let mut back = rasterbook::Framebuffer::new(4, 3);
//! back.set(1, 1, Color::RED);
//! assert_eq!(screen.front().get(1, 1), Some(Color::BLACK)); // not yet
//! screen.present(&mut back);
//! assert_eq!(screen.front().get(1, 1), Some(Color::RED));
//! ```

use crate::framebuffer::Framebuffer;

/// A screen's front buffer, which is seen; the back buffer, which is drawn into, belongs to the one who draws. Book, section
/// 9.4.2, Figure 9-9.
#[derive(Clone, Debug)]
pub struct SwapChain {
    front: Framebuffer,
}

impl SwapChain {
    /// A black screen of `width` × `height` pixels.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self { front: Framebuffer::new(width, height) }
    }

    /// What the screen shows.
    #[must_use]
    pub const fn front(&self) -> &Framebuffer {
        &self.front
    }

    /// Shows the finished picture in the back buffer. The two are exchanged, which takes no time; the back buffer then
    /// holds the picture before, and must be cleared.
    pub const fn present(&mut self, back: &mut Framebuffer) {
        self.front.swap_pictures(back);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;

    #[test]
    fn drawing_is_not_seen_until_presented() {
        let (mut screen, mut back) = (SwapChain::new(2, 2), Framebuffer::new(2, 2));
        for color in [Color::RED, Color::GREEN] {
            let before = screen.front().clone();
            back.clear(color);
            assert!(*screen.front() == before);
            screen.present(&mut back);
            assert_eq!(screen.front().get(0, 0), Some(color));
        }
        assert_eq!(back.get(0, 0), Some(Color::RED), "the picture before");
    }
}
