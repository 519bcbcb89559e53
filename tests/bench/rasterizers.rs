//! Measures our rasterizers: the five scenes, and each stage alone.
//!
//! ```text
//! cargo bench                                      all of it
//! cargo bench -p rasterbook-bench -- --quick       few rounds, and no more compiled than they need
//! cargo bench -p rasterbook-bench -- S1 S3 exact   only what has these words in its name
//! ```
//!
//! Times are milliseconds: medians of rounds in which each rasterizer has its turn. See `README.md` in this folder.

mod machine;
#[expect(dead_code, reason = "pictures are compared with those of other renderers, in peers/")]
mod ours;
mod scenes;

use std::error::Error;
use std::io::{Write, stdout};

use ours::{Ours, RASTERIZERS, Stage, Stages, Threads};
use rasterbook_bench::cores::keep_on_core;
use rasterbook_bench::timing::{median, milliseconds, runs_for};
use rayon::{ThreadPool, ThreadPoolBuilder};
use scenes::{NAMES, Scene};

/// What is measured, in the order of the table.
const STAGES: [Stage; 8] = [
    Stage::Clear,
    Stage::Vertex,
    Stage::Clip,
    Stage::Setup,
    Stage::Raster,
    Stage::Shade,
    Stage::Kernel,
    Stage::Frame,
];
/// A scene to try everything on.
const TINY: &str = "sphere:100:64x36";

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::from_args(std::env::args().skip(1));
    let mut out = stdout().lock();
    writeln!(out, "milliseconds, medians of {} interleaved rounds", options.rounds)?;
    writeln!(out, "{}\n", machine::description())?;
    for name in options.scenes.iter().copied() {
        let scene = Scene::named(name).ok_or("no such scene")?;
        writeln!(out, "{name}: {}", scene.description())?;
        writeln!(
            out,
            "{:18}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}",
            "", "clear", "vertex", "clip", "setup", "raster", "shade", "kernel", "frame"
        )?;
        for contender in measured(&scene, &options)? {
            writeln!(out, "{contender}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// What the command line asks for.
struct Options {
    rounds: u32,
    scenes: Vec<&'static str>,
    rasterizers: Vec<Ours>,
}

impl Options {
    fn from_args(args: impl Iterator<Item = String>) -> Self {
        let (flags, words): (Vec<String>, Vec<String>) = args.partition(|arg| arg.starts_with("--"));
        let has = |flag: &str| flags.iter().any(|given| given == flag);
        let rasterizers = matching(&RASTERIZERS, |ours| ours.name, &words);
        // Cargo says `--bench` if times are wanted; else it only wants to see the program run.
        if has("--test") || !has("--bench") {
            return Self { rounds: 1, scenes: vec![TINY], rasterizers };
        }
        let rounds = if has("--quick") { 3 } else { 15 };
        Self { rounds, scenes: matching(&NAMES, |name| name, &words), rasterizers }
    }
}

/// Those with one of the words in their names; all of them if no word is meant for them.
fn matching<T: Copy>(all: &[T], name: impl Fn(&T) -> &'static str, words: &[String]) -> Vec<T> {
    let is_meant = |item: &T| words.iter().any(|word| name(item).contains(word.as_str()));
    let meant: Vec<T> = all.iter().copied().filter(is_meant).collect();
    if meant.is_empty() { all.to_vec() } else { meant }
}

/// A rasterizer, its threads, and how long it took for each stage in each round.
struct Contender {
    name: String,
    pool: ThreadPool,
    stages: Box<dyn Stages + Send>,
    times: [Vec<f64>; STAGES.len()],
}

impl Contender {
    fn new(ours: Ours, threads: usize, scene: Scene) -> Result<Self, Box<dyn Error>> {
        let name = match threads {
            1 => ours.name.to_owned(),
            _ => format!("{} ×{threads}", ours.name),
        };
        let pool = ThreadPoolBuilder::new().num_threads(threads);
        let pool = if threads > 1 { pool.start_handler(|place| keep_on_core(0, place)) } else { pool };
        let pool = pool.build()?;
        Ok(Self { name, pool, stages: (ours.stages)(scene), times: Default::default() })
    }

    /// Takes the time of one stage once. Milliseconds.
    fn measure(&mut self, stage: Stage) -> f64 {
        let Self { pool, stages, .. } = self;
        pool.install(|| {
            let warm = milliseconds(1, || stages.run(stage));
            milliseconds(runs_for(warm), || stages.run(stage))
        })
    }
}

/// Takes the times of all rasterizers on a scene, each with one thread and with two if it can.
fn measured(scene: &Scene, options: &Options) -> Result<Vec<Contender>, Box<dyn Error>> {
    let mut contenders = vec![];
    for &ours in &options.rasterizers {
        let threads: &[usize] = if ours.threads == Threads::Many { &[1, 2] } else { &[1] };
        for &threads in threads {
            contenders.push(Contender::new(ours, threads, scene.clone())?);
        }
    }
    // The first round warms up.
    for round in 0..=options.rounds {
        for (place, stage) in STAGES.into_iter().enumerate() {
            for contender in &mut contenders {
                let time = contender.measure(stage);
                if round > 0 {
                    contender.times[place].push(time);
                }
            }
        }
    }
    Ok(contenders)
}

impl std::fmt::Display for Contender {
    /// A row of the table. Some stages are measured together with what must come before them; that is taken off.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [clear, vertex, clip, setup, raster, shade, kernel, frame] = self.times.clone().map(median);
        write!(f, "{:18}{clear:9.3}{vertex:9.3}{clip:9.3}{setup:9.3}", self.name)?;
        write!(f, "{:9.3}", raster - setup)?;
        // What throws its fragments away hides nothing, and may take longer than what is left out if they are kept.
        let shade = shade - clear - raster;
        let shade = if shade > 0.0 { format!("{shade:.3}") } else { "–".to_owned() };
        write!(f, "{shade:>9}{kernel:9.3}{frame:10.3}")
    }
}
