//! Chapter 2: the scissor, the pixels that a stage may emit.
//!
//! Every stage that emits pixels takes one and emits nothing outside it. That is why not even a deliberate mistake can
//! write out of bounds or run for ever.
//!
//! ```
//! use rasterbook::{Framebuffer, Rect};
//!
//! let framebuffer = Framebuffer::new(8, 6);
//! let all = framebuffer.scissor();
//! assert_eq!(all.rect, Rect::sized(8, 6));
//! let part = all.within(Rect { left: 2, bottom: 2, right: 99, top: 4 });
//! assert_eq!(part.rect, Rect { left: 2, bottom: 2, right: 8, top: 4 });
//! ```

use crate::framebuffer::Framebuffer;
use crate::observer::{Observer, SharedObserver};
use crate::rect::Rect;

/// The rectangle in which a stage may emit pixels, with the observer of the picture, if it has one.
#[derive(Clone, Debug)]
pub struct Scissor {
    /// The pixels.
    pub rect: Rect,
    /// Who observes the stage.
    pub observer: Option<SharedObserver>,
}

impl From<Rect> for Scissor {
    fn from(rect: Rect) -> Self {
        Self { rect, observer: None }
    }
}

impl Framebuffer {
    /// All pixels, as the scissor that the drawing stages take.
    #[must_use]
    pub fn scissor(&self) -> Scissor {
        Scissor { rect: self.rect(), observer: self.observer() }
    }
}

impl Scissor {
    /// What of it lies in a rectangle.
    #[must_use]
    pub fn within(self, rect: Rect) -> Self {
        Self { rect: self.rect.intersection(rect), ..self }
    }

    /// Reports to the observer, if there is one.
    #[inline]
    pub(crate) fn report(&self, report: impl FnOnce(&dyn Observer)) {
        if let Some(observer) = &self.observer {
            report(observer.as_ref());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_the_same_observer() {
        #[derive(Debug)]
        struct Nobody;
        impl Observer for Nobody {}

        let mut framebuffer = Framebuffer::new(8, 6);
        framebuffer.set_observer(Some(std::sync::Arc::new(Nobody)));
        let part = framebuffer.scissor().within(Rect { left: 2, bottom: 3, right: 99, top: 4 });
        assert_eq!(part.rect, Rect { left: 2, bottom: 3, right: 8, top: 4 });
        assert!(part.observer.is_some());
    }
}
