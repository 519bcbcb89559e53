//! How time and memory grow: with the triangles, with the pixels, with the threads.

use std::error::Error;
use std::thread::available_parallelism;

use crate::chart::{Curve, curves};
use crate::ours::Threads;
use crate::peers::{self, Peer};
use crate::scenes::Scene;
use crate::{Options, measured, say, start};

/// The numbers of triangles.
const TRIANGLES: [u32; 5] = [1_000, 10_000, 100_000, 1_000_000, 10_000_000];
/// The pixels, in pictures of 16 : 9: 16 and 9 times this many; from 1e5 to 3e7 of them.
const SIXTEENTHS: [u32; 6] = [26, 46, 83, 144, 264, 456];
/// The numbers of threads, as far as there are cores.
const THREADS: [usize; 4] = [1, 2, 4, 8];
/// Rounds of each measurement at most: some frames take seconds.
const ROUNDS: u32 = 5;
/// Whoever takes longer than this for a frame, in milliseconds, is not asked for a larger one.
const PATIENCE: f64 = 10_000.0;

/// Takes all times and draws the curves.
pub(crate) fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let peers = options.peers();
    let with = |triangles: u32, [width, height]: [u32; 2]| format!("sphere:{triangles}:{width}x{height}");
    let full_hd = |triangles| with(triangles, [1920, 1080]);

    say("triangles, 1920×1080 pixels, one thread")?;
    let scenes = TRIANGLES.map(full_hd);
    let size = |scene: &Scene| scene.triangle_count() as f64;
    let [time, memory] = curves_over(options, &peers, &scenes, size)?;
    let x_name = "triangles (a sphere, 1920×1080, one thread)";
    options.save("growth-triangles.svg", &curves("Time and triangles", [x_name, "ms a frame"], &time))?;
    options
        .save("memory-triangles.svg", &curves("Memory and triangles", [x_name, "MiB at most"], &memory))?;

    say("pixels, 5000 triangles, one thread")?;
    let scenes = SIXTEENTHS.map(|n| with(5_000, [16 * n, 9 * n]));
    let size = |scene: &Scene| scene.size.map(f64::from).iter().product();
    let [time, memory] = curves_over(options, &peers, &scenes, size)?;
    let x_name = "pixels (a sphere of 5000 triangles, one thread)";
    options.save("growth-pixels.svg", &curves("Time and pixels", [x_name, "ms a frame"], &time))?;
    options.save("memory-pixels.svg", &curves("Memory and pixels", [x_name, "MiB at most"], &memory))?;

    over_threads(options, &peers, &full_hd(5_000))
}

/// The curves of time and of memory over some size of the scenes.
fn curves_over(
    options: &Options,
    peers: &[Peer],
    scenes: &[String],
    size: impl Fn(&Scene) -> f64,
) -> Result<[Vec<Curve>; 2], Box<dyn Error>> {
    let [mut times, mut memories] = [0, 1].map(|_| empty_curves(peers));
    let mut patient = peers.to_vec();
    for name in scenes {
        let x = size(&Scene::named(name).ok_or("no such scene")?);
        let mut contestants = start(None, &patient, &[1], name)?;
        let milliseconds = measured(&mut contestants, options.rounds.min(ROUNDS))?;
        for (contestant, &time) in contestants.iter_mut().zip(&milliseconds) {
            let memory = contestant.memory()?;
            let peer = contestant.peer.name;
            say(&format!("  {x:10} {peer:16}{time:12.3} ms{memory:10.1} MiB"))?;
            for (curves, y) in [(&mut times, time), (&mut memories, memory)] {
                curves.iter_mut().filter(|c| c.name == peer).for_each(|c| c.points.push([x, y]));
            }
            if time > PATIENCE {
                patient.retain(|patient| patient.name != peer);
            }
        }
    }
    Ok([times, memories])
}

/// A curve for each renderer, which has the same color in every image.
fn empty_curves(peers: &[Peer]) -> Vec<Curve> {
    let all = peers::all();
    let color = |peer: &Peer| all.iter().position(|there| there.name == peer.name).unwrap_or(0);
    peers
        .iter()
        .map(|peer| Curve { name: peer.name.to_owned(), color: color(peer), points: vec![] })
        .collect()
}

/// The curves of time over the number of threads, of the renderers that can have several.
fn over_threads(options: &Options, peers: &[Peer], scene: &str) -> Result<(), Box<dyn Error>> {
    let cores = available_parallelism()?.get();
    say(&format!("threads, {cores} cores"))?;
    let parallel: Vec<Peer> = peers.iter().filter(|peer| peer.threads == Threads::Many).copied().collect();
    let threads: Vec<usize> = THREADS.into_iter().filter(|&threads| threads <= cores).collect();
    let mut contestants = start(None, &parallel, &threads, scene)?;
    let milliseconds = measured(&mut contestants, options.rounds)?;
    let mut times = empty_curves(&parallel);
    for (contestant, &time) in contestants.iter().zip(&milliseconds) {
        let (peer, threads) = (contestant.peer.name, contestant.threads);
        say(&format!("  {threads:10} {peer:16}{time:12.3} ms"))?;
        let curves = times.iter_mut().filter(|curve| curve.name == peer);
        curves.for_each(|curve| curve.points.push([threads as f64, time]));
    }
    let x_name = "threads (a sphere of 5000 triangles, 1920×1080)";
    options.save("growth-threads.svg", &curves("Time and threads", [x_name, "ms a frame"], &times))
}
