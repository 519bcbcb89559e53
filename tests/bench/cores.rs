//! Keeps a thread on one core. Systems may leave two busy threads on the same core for seconds, the other one idle; then
//! two threads look no faster than one.

/// Keeps a thread on the core of this number, counted round the cores that there are. `thread` is the system's number, 0
/// the calling thread. Only on Linux; where it is not allowed, nothing happens.
#[cfg(target_os = "linux")]
pub fn keep_on_core(thread: i32, core: usize) {
    use nix::sched::{CpuSet, sched_setaffinity};
    use nix::unistd::Pid;
    use std::sync::LazyLock;

    // Asked once: a thread that is kept on one core already is told that there is no other.
    static CORES: LazyLock<usize> =
        LazyLock::new(|| std::thread::available_parallelism().map_or(1, usize::from));
    let mut set = CpuSet::new();
    if set.set(core % *CORES).is_ok() {
        // Without it threads are measured as the system places them.
        let _ = sched_setaffinity(Pid::from_raw(thread), &set);
    }
}

/// Other systems place threads as they see fit.
#[cfg(not(target_os = "linux"))]
pub fn keep_on_core(_: i32, _: usize) {}
