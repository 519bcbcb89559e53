//! The threads that draw: as many as the machine offers, or as many as can be had.

use std::sync::mpsc::{Sender, channel};
use std::thread;

use rayon::{ThreadBuilder, ThreadPoolBuilder};

/// The most threads that are started, unless the machine offers more. Each is a place in memory and work for all others:
/// thousands of them end the program, and with hundreds a picture takes seconds.
const MOST: usize = 64;

/// Starts the threads that share the work, once in a program. The one that calls is the first of them; those that the
/// system refuses are done without. Left to itself, `rayon` starts them when it is asked first, and panics if it cannot.
pub(super) fn start() {
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|count| count.parse().ok());
    let offered = thread::available_parallelism().map_or(1, usize::from);
    let count = asked.filter(|&count| count > 0).unwrap_or(offered).min(offered.max(MOST));
    let mut others = (1..count).map_while(|_| waiting()).collect::<Vec<_>>();
    let pool = ThreadPoolBuilder::new().num_threads(others.len() + 1).use_current_thread();
    let pool = pool.spawn_handler(|worker| {
        // There is one for each worker, and it waits.
        if let Some(other) = others.pop() {
            let _ = other.send(worker);
        }
        Ok(())
    });
    // It fails if there is a pool already: that one will do.
    let _ = pool.build_global();
}

/// A thread that waits for its work in the pool, if the system starts one.
fn waiting() -> Option<Sender<ThreadBuilder>> {
    let (sender, receiver) = channel::<ThreadBuilder>();
    let run = move || receiver.recv().into_iter().for_each(ThreadBuilder::run);
    thread::Builder::new().spawn(run).ok().map(|_| sender)
}
