//! Runs tests that are known only when the program runs, as `cargo test` runs others: names to look for, `--exact`, `--skip`,
//! `--list`, `--quiet`, `--test-threads`.
//!
//! The crate `libtest-mimic` does this and more. It asks for other features of `clap` than the programs do. So after the first
//! `cargo run` the first `cargo test` built `clap`, the library and all programs once more; and what it tested were not the
//! programs that a reader runs.

use std::ffi::OsString;
use std::io::{self, Write, stdout};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Arg, ArgAction, Command, value_parser};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

/// A test: its name, and what it does. An error says why it has failed, as a panic does.
pub(crate) struct Trial {
    name: String,
    run: Box<dyn Fn() -> Result<(), String> + Send + Sync>,
}

impl Trial {
    pub(crate) fn new(
        name: impl Into<String>,
        run: impl Fn() -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), run: Box::new(run) }
    }

    /// Why it has failed.
    fn failure(&self) -> Option<String> {
        let outcome = catch_unwind(AssertUnwindSafe(&self.run));
        outcome.unwrap_or_else(|_| Err("it panicked".to_owned())).err()
    }
}

/// What `cargo test -- OPTIONS` asks for.
pub(crate) struct Options {
    wanted: Vec<String>,
    skipped: Vec<String>,
    is_exact: bool,
    is_terse: bool,
    /// Tests that are ignored otherwise: there are none.
    only_ignored: bool,
    threads: usize,
    /// Names are printed, and nothing is run.
    pub(crate) is_list: bool,
}

impl Options {
    /// Of the arguments after the program's name. Ends the program if they make no sense.
    pub(crate) fn from_args(arguments: impl Iterator<Item = OsString>) -> Self {
        let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
        let command = Command::new("snapshots")
            .no_binary_name(true)
            .arg(Arg::new("wanted").value_name("NAME").action(ArgAction::Append).num_args(0..))
            .arg(Arg::new("skip").long("skip").value_name("NAME").action(ArgAction::Append))
            .args(
                ["exact", "list", "ignored", "include-ignored", "nocapture", "no-capture", "show-output"]
                    .map(flag),
            )
            .arg(flag("quiet").short('q'))
            .arg(Arg::new("test-threads").long("test-threads").value_parser(value_parser!(usize)))
            .arg(Arg::new("format").long("format").value_parser(["pretty", "terse"]))
            .arg(Arg::new("color").long("color").value_parser(["auto", "always", "never"]));
        let matches = command.get_matches_from(arguments);
        let names = |name| matches.get_many::<String>(name).into_iter().flatten().cloned().collect();
        Self {
            wanted: names("wanted"),
            skipped: names("skip"),
            is_exact: matches.get_flag("exact"),
            is_terse: matches.get_flag("quiet")
                || matches.get_one::<String>("format").is_some_and(|format| format == "terse"),
            only_ignored: matches.get_flag("ignored"),
            threads: matches.get_one("test-threads").copied().unwrap_or_default(),
            is_list: matches.get_flag("list"),
        }
    }

    fn includes(&self, name: &str) -> bool {
        let fits =
            |pattern: &String| if self.is_exact { name == pattern } else { name.contains(pattern.as_str()) };
        !self.only_ignored
            && (self.wanted.is_empty() || self.wanted.iter().any(fits))
            && !self.skipped.iter().any(fits)
    }
}

/// Runs what the options ask for, several at a time, and tells of each how it went.
///
/// # Errors
/// If nothing can be printed, or no thread can be started.
pub(crate) fn run(options: &Options, trials: &[Trial]) -> io::Result<ExitCode> {
    let chosen: Vec<&Trial> = trials.iter().filter(|trial| options.includes(&trial.name)).collect();
    if options.is_list {
        list(options, &chosen)?;
        return Ok(ExitCode::SUCCESS);
    }
    let start = Instant::now();
    let count = chosen.len();
    writeln!(stdout(), "\nrunning {count} test{}", if count == 1 { "" } else { "s" })?;
    let threads = ThreadPoolBuilder::new().num_threads(options.threads).build().map_err(io::Error::other)?;
    let outcomes: io::Result<Vec<_>> =
        threads.install(|| chosen.par_iter().map(|trial| outcome(options, trial)).collect());
    let failures: Vec<_> = outcomes?.into_iter().flatten().collect();
    let mut out = stdout().lock();
    if !failures.is_empty() {
        writeln!(out, "\nfailures:\n")?;
        failures.iter().try_for_each(|(name, why)| writeln!(out, "---- {name} ----\n{why}\n"))?;
    }
    let verdict = if failures.is_empty() { "ok" } else { "FAILED" };
    let (failed, filtered) = (failures.len(), trials.len() - count);
    writeln!(
        out,
        "\ntest result: {verdict}. {} passed; {failed} failed; 0 ignored; 0 measured; {filtered} filtered out; \
         finished in {:.2}s\n",
        count - failed,
        start.elapsed().as_secs_f64()
    )?;
    // As the standard library's tests have it.
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(101) })
}

/// Runs one; if it has failed, its name and why.
fn outcome<'a>(options: &Options, trial: &'a Trial) -> io::Result<Option<(&'a str, String)>> {
    let failure = trial.failure();
    match (options.is_terse, &failure) {
        (true, None) => write!(stdout(), ".")?,
        (true, Some(_)) => write!(stdout(), "F")?,
        (false, None) => writeln!(stdout(), "test {} ... ok", trial.name)?,
        (false, Some(_)) => writeln!(stdout(), "test {} ... FAILED", trial.name)?,
    }
    Ok(failure.map(|why| (trial.name.as_str(), why)))
}

fn list(options: &Options, chosen: &[&Trial]) -> io::Result<()> {
    let mut out = stdout().lock();
    chosen.iter().try_for_each(|trial| writeln!(out, "{}: test", trial.name))?;
    if !options.is_terse {
        writeln!(out, "\n{} tests, 0 benchmarks", chosen.len())?;
    }
    Ok(())
}
