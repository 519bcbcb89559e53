//! Draws pictures beside the window, so that the window never waits for one that takes long.
//!
//! ```text
//!   window     change 1 ──► begins 1 ┄ waits a little ┄► begins a draft    shows it   shows 1
//!   painter                 ░░░░░░░░░ the whole picture ░░░░░░░░░░░░░░░░░░░░░░░░░░░░░│
//!   another painter                                      ░░░░ a draft ░░░░│
//! ```

use std::io;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, Scope};
use std::time::{Duration, Instant};

use crate::framebuffer::Framebuffer;
use crate::live::Live;

/// A thread that draws one picture at a time.
pub(super) struct Painter<'a> {
    orders: Sender<Order<'a>>,
    pictures: Receiver<Painted>,
    is_busy: bool,
}

/// What to draw.
struct Order<'a> {
    number: u64,
    live: Live<'a>,
    /// The divisor of a draft; 1 for the whole picture.
    divisor: u32,
}

/// A picture that has been drawn.
pub(super) struct Painted {
    /// The number with which it was begun.
    pub(super) number: u64,
    /// The whole picture, not magnified, or a draft; `None` if there is no draft of it.
    pub(super) picture: Option<Framebuffer>,
    /// How long it took.
    pub(super) took: Duration,
}

/// The thread is gone: drawing panicked, and has said why.
#[derive(Debug)]
pub(super) struct Gone;

impl<'a> Painter<'a> {
    /// Starts the thread. It ends when the painter is dropped.
    ///
    /// # Errors
    /// If no thread can be started.
    pub(super) fn start<'scope>(scope: &'scope Scope<'scope, '_>) -> io::Result<Self>
    where
        'a: 'scope,
    {
        let (orders, inbox) = channel::<Order<'a>>();
        let (outbox, pictures) = channel();
        let paint = move || {
            for Order { number, live, divisor } in inbox {
                let begun = Instant::now();
                let picture = if divisor == 1 { Some(live.whole_picture()) } else { live.draft(divisor) };
                // Nobody takes it when the window has been closed.
                let _ = outbox.send(Painted { number, picture, took: begun.elapsed() });
            }
        };
        Builder::new().name("painter".to_owned()).spawn_scoped(scope, paint)?;
        Ok(Self { orders, pictures, is_busy: false })
    }

    /// Begins a picture, unless another one is still being drawn: a draft with this divisor, or with 1 the whole one. Whether it
    /// has begun.
    pub(super) fn begin(&mut self, number: u64, live: &Live<'a>, divisor: u32) -> Result<bool, Gone> {
        if self.is_busy {
            return Ok(false);
        }
        self.orders.send(Order { number, live: live.clone(), divisor }).map_err(|_| Gone)?;
        self.is_busy = true;
        Ok(true)
    }

    /// The picture that was begun, if it is finished within so long.
    pub(super) fn finished(&mut self, wait: Duration) -> Result<Option<Painted>, Gone> {
        match self.pictures.recv_timeout(wait) {
            Ok(painted) => {
                self.is_busy = false;
                Ok(Some(painted))
            }
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err(Gone),
        }
    }
}
