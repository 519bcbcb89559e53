//! A renderer with a scene, in a process of its own.
//!
//! llvmpipe and rayon choose their threads once for a process, and the memory that is used is told for a process. So
//! this program starts itself for each renderer and number of threads. The children draw when they are asked to, one at
//! a time; while one draws, the others wait.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write, stdin, stdout};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::str::FromStr;

use crate::ours::Frame;
use crate::peers::{Peer, prepare};
use crate::scenes::Scene;
use rasterbook_bench::cores::keep_on_core;
use rasterbook_bench::timing::milliseconds;

/// The first argument of a child; a renderer, the number of its threads and a scene follow.
pub(crate) const CHILD: &str = "--child";
/// How many frames a child draws before anything else.
const WARM_FRAMES: u32 = 2;
/// How long it draws then, in milliseconds, before anything is measured.
const WARM_TIME: f64 = 300.0;

/// A child, from outside.
pub(crate) struct Contestant {
    pub(crate) peer: Peer,
    pub(crate) threads: usize,
    /// Whether its program is another build of this one.
    pub(crate) is_other_build: bool,
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Contestant {
    /// Starts a child: this program, or another build of it. The error says why the renderer is not to be had.
    pub(crate) fn start(
        other_build: Option<&Path>,
        peer: Peer,
        threads: usize,
        scene: &str,
    ) -> Result<Self, Box<dyn Error>> {
        // 0 makes llvmpipe draw in the thread that calls it. With 1 there would be two: that one, and one that draws.
        let llvmpipe_threads = if threads == 1 { 0 } else { threads };
        let program = other_build.map_or_else(std::env::current_exe, |path| Ok(path.to_owned()))?;
        let mut child = Command::new(program)
            .args([CHILD, peer.name, &threads.to_string(), scene])
            .env("GALLIUM_DRIVER", "llvmpipe")
            .env("LP_NUM_THREADS", llvmpipe_threads.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let orders = child.stdin.take().ok_or("no standard input")?;
        let answers = BufReader::new(child.stdout.take().ok_or("no standard output")?);
        let is_other_build = other_build.is_some();
        let mut started = Self { peer, threads, is_other_build, child, orders, answers };
        match started.answer()?.as_str() {
            "ready" => Ok(started),
            problem => Err(problem.into()),
        }
    }

    /// What it is called: the renderer's name, with a mark if it is another build of it.
    pub(crate) fn name(&self) -> String {
        format!("{}{}", self.peer.name, if self.is_other_build { ", other" } else { "" })
    }

    /// Milliseconds a frame, when so many are drawn.
    pub(crate) fn time(&mut self, frames: u32) -> Result<f64, Box<dyn Error>> {
        self.ask(&format!("frames {frames}"))
    }

    /// The most memory that the child has had, in MiB.
    pub(crate) fn memory(&mut self) -> Result<f64, Box<dyn Error>> {
        self.ask("memory")
    }

    /// What it has drawn.
    pub(crate) fn picture(&mut self) -> Result<Vec<[u8; 3]>, Box<dyn Error>> {
        let pixels: usize = self.ask("picture")?;
        let mut bytes = vec![0; 3 * pixels];
        self.answers.read_exact(&mut bytes)?;
        Ok(bytes.as_chunks().0.to_vec())
    }

    fn ask<T: FromStr<Err: Error + 'static>>(&mut self, order: &str) -> Result<T, Box<dyn Error>> {
        writeln!(self.orders, "{order}")?;
        Ok(self.answer()?.parse()?)
    }

    fn answer(&mut self) -> Result<String, Box<dyn Error>> {
        let mut line = String::new();
        self.answers.read_line(&mut line)?;
        if line.is_empty() {
            return Err(format!("{} has ended by itself", self.name()).into());
        }
        Ok(line.trim_end().to_owned())
    }
}

impl Drop for Contestant {
    fn drop(&mut self) {
        // A child that waits for an order has nothing to lose. Errors: it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What a child does: it makes the scene ready, warms up, and carries out orders until there are no more.
pub(crate) fn serve(renderer: &str, threads: usize, scene: &str) -> Result<(), Box<dyn Error>> {
    // The thread that asks for a picture draws as well, as llvmpipe's does: nobody has to be woken first.
    rayon::ThreadPoolBuilder::new().num_threads(threads).use_current_thread().build_global()?;
    let mut answers = stdout().lock();
    let prepared = Scene::named(scene).ok_or("no such scene".to_owned()).and_then(|s| prepare(renderer, s));
    let mut frame = match prepared {
        Ok(frame) => frame,
        Err(problem) => return Ok(writeln!(answers, "{}", problem.replace('\n', " "))?),
    };
    warm_up(threads, &mut *frame);
    writeln!(answers, "ready")?;
    for order in stdin().lock().lines() {
        let order = order?;
        match order.split_once(' ').unwrap_or((&order, "")) {
            ("frames", count) => {
                let count = count.parse()?;
                // What the other children have pushed out of the caches comes back.
                frame.draw();
                writeln!(answers, "{}", milliseconds(count, || frame.draw()))?;
            }
            ("memory", _) => writeln!(answers, "{}", peak_memory())?,
            ("picture", _) => {
                let picture = frame.picture();
                writeln!(answers, "{}", picture.len())?;
                answers.write_all(picture.as_flattened())?;
            }
            _ => return Err(format!("what is {order}?").into()),
        }
        answers.flush()?;
    }
    Ok(())
}

/// Draws for a while. Meanwhile, if there are several threads, those that work get a core each.
fn warm_up(threads: usize, frame: &mut dyn Frame) {
    // The first frames compile shaders and get memory.
    milliseconds(WARM_FRAMES, || frame.draw());
    let before = work_of_threads();
    let mut warm = 0.0;
    while warm < WARM_TIME {
        warm += milliseconds(1, || frame.draw());
    }
    if threads > 1 {
        let mut work = work_of_threads();
        for (thread, time) in &mut work {
            *time -= before.get(thread).unwrap_or(&0);
        }
        let mut threads_by_work: Vec<(i32, u64)> = work.into_iter().collect();
        threads_by_work.sort_by_key(|&(_, time)| Reverse(time));
        for (core, &(thread, _)) in threads_by_work.iter().take(threads).enumerate() {
            keep_on_core(thread, core);
        }
    }
}

/// How long the threads of this process have worked, by their numbers; nothing where the system does not tell.
fn work_of_threads() -> BTreeMap<i32, u64> {
    let folders = fs::read_dir("/proc/self/task").into_iter().flatten().filter_map(Result::ok);
    folders
        .filter_map(|folder| {
            // After the name, which is in parentheses, the 12th word is the time in units of the system's own.
            let status = fs::read_to_string(folder.path().join("stat")).ok()?;
            let time = status.rsplit_once(')')?.1.split_whitespace().nth(11)?.parse().ok()?;
            Some((folder.file_name().to_str()?.parse().ok()?, time))
        })
        .collect()
}

/// The most memory that this process has had, in MiB; 0 where the system does not tell.
fn peak_memory() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()).and_then(|number| number.parse().ok());
    kib.unwrap_or(0.0) / 1024.0
}
