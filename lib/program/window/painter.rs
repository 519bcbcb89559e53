//! Draws pictures beside the window, so that the window never waits for one that takes long.
//!
//! ```text
//!   window    change 1 ──► begins 1 ┄┄ waits a little ┄┄► a draft of 1     change 2 ──► a draft of 2      shows 2
//!   painter                ░░░░░░░░░░░░ draws 1 ░░░░░░░░░░░░░░░░░░░░░░░░░░░░░░░░│ draws 2 ░░░░░░░░░░░░│
//! ```

use std::io;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{Builder, Scope};
use std::time::{Duration, Instant};

use crate::framebuffer::Framebuffer;
use crate::live::Live;

/// A thread that draws one picture at a time.
pub(super) struct Painter<'a> {
    orders: Sender<(u64, Live<'a>)>,
    pictures: Receiver<Painted>,
    is_busy: bool,
}

/// A picture that has been drawn.
pub(super) struct Painted {
    /// The number with which it was begun.
    pub(super) number: u64,
    /// The whole picture, not magnified.
    pub(super) picture: Framebuffer,
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
        let (orders, inbox) = channel::<(u64, Live<'a>)>();
        let (outbox, pictures) = channel();
        let paint = move || {
            for (number, live) in inbox {
                let begun = Instant::now();
                let picture = live.whole_picture();
                // Nobody takes it when the window has been closed.
                let _ = outbox.send(Painted { number, picture, took: begun.elapsed() });
            }
        };
        Builder::new().name("painter".to_owned()).spawn_scoped(scope, paint)?;
        Ok(Self { orders, pictures, is_busy: false })
    }

    /// Begins a picture, unless another one is still being drawn. Whether it has begun.
    pub(super) fn begin(&mut self, number: u64, live: &Live<'a>) -> Result<bool, Gone> {
        if self.is_busy {
            return Ok(false);
        }
        self.orders.send((number, live.clone())).map_err(|_| Gone)?;
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
