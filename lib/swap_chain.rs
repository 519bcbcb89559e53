//! Chapter 9: double buffering. Nobody sees a picture before it is finished.
//!
//! Behind the last stage: pictures are drawn into the back buffer; `present` makes a finished one the front buffer,
//! which is what the screen shows.
//!
//! ```
//! use rasterbook::Color;
//! use rasterbook::swap_chain::SwapChain;
//!
//! let mut chain = SwapChain::new(4, 3);
//! chain.back.color.set(1, 1, Color::RED);
//! assert_eq!(chain.front().get(1, 1), Some(Color::BLACK)); // not yet
//! chain.present();
//! assert_eq!(chain.front().get(1, 1), Some(Color::RED));
//! ```

use crate::Framebuffer;
use crate::depth::Target;

/// A front buffer, which is seen, and a back buffer, which is drawn into. Book, section 9.4.2, Figure 9-9.
#[derive(Clone, Debug)]
pub struct SwapChain {
    front: Framebuffer,
    /// What the next picture is drawn into.
    pub back: Target,
}

impl SwapChain {
    /// Two black buffers of `width` × `height` pixels.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self { front: Framebuffer::new(width, height), back: Target::new(width, height) }
    }

    /// What the screen shows.
    #[must_use]
    pub const fn front(&self) -> &Framebuffer {
        &self.front
    }

    /// Shows the finished picture. The two buffers change places, which takes no time; the back buffer then holds the
    /// picture before, and wants to be cleared.
    pub fn present(&mut self) {
        std::mem::swap(&mut self.front, &mut self.back.color);
    }

    /// The front buffer, once nothing more is to be drawn.
    #[must_use]
    pub fn into_front(self) -> Framebuffer {
        self.front
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;

    #[test]
    fn drawing_is_not_seen_until_presented() {
        let mut chain = SwapChain::new(2, 2);
        for color in [Color::RED, Color::GREEN] {
            let before = chain.front().clone();
            chain.back.clear(color, 1.0);
            assert!(*chain.front() == before);
            chain.present();
            assert_eq!(chain.front().get(0, 0), Some(color));
        }
        assert_eq!(chain.back.color.get(0, 0), Some(Color::RED), "the picture before");
    }
}
