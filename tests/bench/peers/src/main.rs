//! Measures our rasterizers and other software renderers side by side: the same triangles, the same texture, one run.
//!
//! ```text
//! cargo run --release --manifest-path tests/bench/peers/Cargo.toml                  the five scenes
//! cargo run --release --manifest-path tests/bench/peers/Cargo.toml -- --growth      how time and memory grow
//! ```
//!
//! Options: `--quick` (few rounds), `--rounds N`, `--out FOLDER` (of the images; `target/bench` unless said otherwise),
//! `--other PROGRAM` (another build of this program, whose rasterizers take part in the five scenes), and words: only
//! renderers and scenes with one of them in their names. The reference, llvmpipe, always takes part.
//!
//! First the pictures are compared with the reference's; if one is not the same, nothing is measured.

mod chart;
mod check;
mod contestant;
mod euc;
mod growth;
#[path = "../../machine.rs"]
mod machine;
mod osmesa;
#[expect(dead_code, reason = "stages are measured by `cargo bench`")]
#[path = "../../ours.rs"]
mod ours;
mod peers;
mod picture;
mod retrofire;
#[path = "../../scenes.rs"]
mod scenes;
mod table;

use std::error::Error;
use std::fs;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};
use std::process::Command;

use contestant::{CHILD, Contestant};
use ours::Threads;
use peers::{Peer, REFERENCE};
use rasterbook_bench::timing::{median, runs_for};
use scenes::{NAMES, Scene};
use table::{Row, Table};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if let [first, renderer, threads, scene] = &args[..]
        && first == CHILD
    {
        return contestant::serve(renderer, threads.parse()?, scene);
    }
    if args == [MACHINE] {
        return say(&machine::description());
    }
    let options = Options::from_args(&args)?;
    fs::create_dir_all(&options.folder)?;
    if options.growth { growth::run(&options) } else { five_scenes(&options) }
}

/// The argument that makes this program say what it is compiled for, and on which processor it runs.
const MACHINE: &str = "--machine";

/// What the command line asks for.
struct Options {
    rounds: u32,
    growth: bool,
    /// Where the images go.
    folder: PathBuf,
    /// Another build of this program, which takes part.
    other: Option<PathBuf>,
    words: Vec<String>,
}

impl Options {
    fn from_args(args: &[String]) -> Result<Self, Box<dyn Error>> {
        let folder = PathBuf::from("target/bench");
        let mut options = Self { rounds: 15, growth: false, folder, other: None, words: vec![] };
        let mut args = args.iter();
        while let Some(arg) = args.next() {
            match arg.as_str() {
                "--quick" => options.rounds = 3,
                "--growth" => options.growth = true,
                "--rounds" => options.rounds = args.next().ok_or("--rounds wants a number")?.parse()?,
                "--out" => options.folder = args.next().ok_or("--out wants a folder")?.into(),
                "--other" => options.other = Some(args.next().ok_or("--other wants a program")?.into()),
                option if option.starts_with("--") => {
                    return Err(format!("no option is called {option}").into());
                }
                word => options.words.push(word.to_owned()),
            }
        }
        Ok(options)
    }

    /// Those with one of the words in their names; all of them if no word is meant for them.
    fn chosen<T: Copy>(&self, all: &[T], name: impl Fn(&T) -> &'static str) -> Vec<T> {
        let is_meant = |item: &T| self.words.iter().any(|word| name(item).contains(word.as_str()));
        let meant: Vec<T> = all.iter().copied().filter(is_meant).collect();
        if meant.is_empty() { all.to_vec() } else { meant }
    }

    /// The renderers that take part, the reference among them.
    fn peers(&self) -> Vec<Peer> {
        let all = peers::all();
        let chosen = self.chosen(&all, |peer| peer.name);
        let takes_part =
            |peer: &&Peer| peer.name == REFERENCE || chosen.iter().any(|chosen| chosen.name == peer.name);
        all.iter().filter(takes_part).copied().collect()
    }

    /// Writes an image.
    fn save(&self, name: &str, svg: &str) -> Result<(), Box<dyn Error>> {
        let path = self.folder.join(name);
        fs::write(&path, svg)?;
        say(&format!("wrote {}", path.display()))
    }
}

/// Prints a line.
fn say(line: &str) -> Result<(), Box<dyn Error>> {
    Ok(writeln!(stdout().lock(), "{line}")?)
}

/// Starts the renderers with these numbers of threads, those that cannot have several with one. Says which are not to
/// be had.
fn start(
    other_build: Option<&Path>,
    peers: &[Peer],
    threads: &[usize],
    scene: &str,
) -> Result<Vec<Contestant>, Box<dyn Error>> {
    let mut contestants = vec![];
    for &threads in threads {
        for peer in peers.iter().filter(|peer| threads == 1 || peer.threads == Threads::Many) {
            match Contestant::start(other_build, *peer, threads, scene) {
                Ok(contestant) => contestants.push(contestant),
                Err(problem) => say(&format!("without {}: {problem}", peer.name))?,
            }
        }
    }
    Ok(contestants)
}

/// Milliseconds a frame of all contestants: medians of rounds in which each has its turn.
fn measured(contestants: &mut [Contestant], rounds: u32) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut frames = vec![];
    for contestant in contestants.iter_mut() {
        frames.push(runs_for(contestant.time(1)?));
    }
    let mut times = vec![vec![]; contestants.len()];
    for _ in 0..rounds {
        for (place, contestant) in contestants.iter_mut().enumerate() {
            times[place].push(contestant.time(frames[place])?);
        }
    }
    Ok(times.into_iter().map(median).collect())
}

/// Compares the pictures, takes the times and the memory of the five scenes, and makes the tables.
fn five_scenes(options: &Options) -> Result<(), Box<dyn Error>> {
    let (scenes, peers) = (options.chosen(&NAMES, |name| name), options.peers());
    let is_ours = |peer: &&Peer| peers::ours().any(|ours| ours.name == peer.name);
    let others: Vec<Peer> = peers.iter().filter(is_ours).copied().collect();
    let heads: Vec<String> = scenes.iter().map(|&name| name.to_owned()).collect();
    let mut times = Table::new("Milliseconds a frame (times llvmpipe's)", &heads);
    let mut memory = Table::new("Memory at most, MiB", &heads);
    let about_other = options.other.as_deref().map(about_build).transpose()?;
    for name in scenes {
        let scene = Scene::named(name).ok_or("no such scene")?;
        times.notes.push(format!("{name}: {}", scene.description()));
        say(&format!("{name}: {}", scene.description()))?;
        let mut contestants = start(None, &peers, &[1, 2], name)?;
        if let Some(other) = &options.other {
            contestants.extend(start(Some(other), &others, &[1, 2], name)?);
        }
        check::pictures(&mut contestants)?;
        let milliseconds = measured(&mut contestants, options.rounds)?;
        let reference = |threads| {
            let place = contestants.iter().position(|c| c.peer.name == REFERENCE && c.threads == threads);
            place.map(|place| milliseconds[place])
        };
        for (contestant, &time) in contestants.iter().zip(&milliseconds) {
            let ratio =
                reference(contestant.threads).map_or_else(String::new, |r| format!(" ({:.2})", time / r));
            times.put(row_of(contestant), name, format!("{time:.2}{ratio}"));
        }
        for contestant in &mut contestants {
            let mib = contestant.memory()?;
            memory.put(row_of(contestant), name, format!("{mib:.0}"));
        }
    }
    times.notes.push(format!("medians of {} interleaved rounds; {}", options.rounds, machine::description()));
    memory.notes.push(machine::description());
    for table in [&mut times, &mut memory] {
        table.notes.extend(about_other.clone());
    }
    say(&format!("\n{times}\n{memory}"))?;
    options.save("table.svg", &chart::table(&times))?;
    options.save("memory.svg", &chart::table(&memory))
}

/// What another build of this program says of itself.
fn about_build(program: &Path) -> Result<String, Box<dyn Error>> {
    let output = Command::new(program).arg(MACHINE).output();
    let output = output.map_err(|error| format!("{}: {error}", program.display()))?;
    let about = String::from_utf8(output.stdout)?;
    if !output.status.success() || !about.starts_with("compiled for") {
        return Err(format!("{}: not a build of this program", program.display()).into());
    }
    Ok(format!("other: the same program, {}", about.trim_end()))
}

fn row_of(contestant: &Contestant) -> Row {
    let group = match contestant.threads {
        1 => "one thread",
        _ => "two threads",
    };
    Row { group: group.to_owned(), name: contestant.name() }
}
