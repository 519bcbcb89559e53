//! The command line that all chapters share.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgMatches, Command};

use super::options::{SHORT, command};
use super::show::Asked;
use crate::figure::picture::Zoom;
use crate::figure::{Chapter, RasterizerChoice};
use crate::model::NormalStyle;
use crate::rect::Pixel;

/// What a program was asked to do.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) list: bool,
    pub(super) all: bool,
    pub(super) variant: Option<String>,
    pub(super) out: Option<PathBuf>,
    pub(super) size: Option<(u32, u32)>,
    pub(super) zoom: Option<Zoom>,
    pub(super) frame: Option<u32>,
    pub(super) animate: bool,
    pub(super) compare: Option<Comparison>,
    pub(super) model: Option<PathBuf>,
    pub(super) texture: Option<PathBuf>,
    pub(super) as_is: bool,
    pub(super) flat: bool,
    pub(super) rasterizer: Option<RasterizerChoice>,
    pub(super) inspect: Option<Pixel>,
    pub(super) format: Format,
    pub(super) verbose: bool,
    pub(super) steps: bool,
    pub(super) overdraw: bool,
    /// Settings of knobs, NAME=VALUE.
    pub(super) settings: Vec<String>,
    /// The knob that is swept.
    pub(super) sweep: Option<String>,
    /// Whether the knobs are to be listed.
    pub(super) knobs: bool,
    /// Whether a window is to be opened.
    pub(super) window: bool,
    pub(super) show: Option<Asked>,
}

/// The form of a history, or of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

/// What `--compare` compares with.
#[derive(Debug)]
pub(super) enum Comparison {
    /// The remedy of the mistake.
    Remedy,
    /// The variant of this name.
    With(String),
}

impl Request {
    /// Reads the arguments, the program's own name first. Errors of clap print themselves, `--help` too.
    pub(super) fn parse(
        chapter: &Chapter,
        arguments: impl IntoIterator<Item = OsString>,
    ) -> Result<Self, clap::Error> {
        let mut command = command(chapter);
        let matches =
            command.try_get_matches_from_mut(arguments).map_err(|error| explained(error, &command))?;
        refuse_form_without_report(&matches, &mut command)?;
        refuse_knob_twice(&matches, &mut command)?;
        let text = |id: &str| matches.get_one::<String>(id).cloned();
        Ok(Self {
            list: matches.get_flag("list"),
            all: matches.get_flag("all"),
            variant: text("variant"),
            out: matches.get_one::<PathBuf>("out").cloned(),
            size: matches.get_one("size").copied(),
            zoom: matches.get_one("zoom").copied(),
            frame: matches.get_one("frame").copied(),
            animate: matches.get_flag("animate"),
            compare: comparison(&matches),
            model: matches.get_one("model").cloned(),
            texture: matches.get_one("texture").cloned(),
            as_is: matches.get_flag("as-is"),
            flat: matches.get_flag("flat"),
            rasterizer: matches.get_one("rasterizer").copied(),
            inspect: matches.get_one("inspect").copied(),
            format: if text("format").as_deref() == Some("json") { Format::Json } else { Format::Text },
            verbose: matches.get_flag("verbose"),
            steps: matches.get_flag("steps"),
            overdraw: matches.get_flag("overdraw"),
            settings: settings(&matches),
            sweep: text("sweep"),
            knobs: matches.get_flag("knobs"),
            window: matches.get_flag("window"),
            show: matches.get_one("show").copied(),
        })
    }

    /// Which normals a model gets.
    pub(super) const fn normal_style(&self) -> NormalStyle {
        if self.flat { NormalStyle::Flat } else { NormalStyle::Smooth }
    }
}

/// The error of clap without its tip to put what begins with a hyphen after `--`: no variant begins so. Where a value is
/// missing, the tip is what the value would be.
fn explained(mut error: clap::Error, command: &Command) -> clap::Error {
    error.remove(ContextKind::Suggested);
    let is_missing = error.kind() == ErrorKind::InvalidValue
        && matches!(error.get(ContextKind::InvalidValue), Some(ContextValue::String(value)) if value.is_empty());
    let named = |argument: &&Arg| {
        error.get(ContextKind::InvalidArg) == Some(&ContextValue::String(argument.to_string()))
    };
    if let Some(argument) = command.get_arguments().find(named).filter(|_| is_missing) {
        let help = argument.get_help().cloned().unwrap_or_default();
        let tip = StyledStr::from(format!("{argument}: {help}"));
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

/// How a report is told means nothing without one. Clap waives what an option requires where that would be in conflict with
/// another one that is given, as `--inspect` is with `--out`.
fn refuse_form_without_report(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let is_told = matches.get_flag("verbose") || matches.contains_id("format");
    if is_told && !matches.contains_id("inspect") && !matches.get_flag("list") {
        let reason = "--verbose and --format are for a report: give --inspect X,Y, or --list with --format";
        return Err(command.error(ErrorKind::MissingRequiredArgument, reason));
    }
    Ok(())
}

/// A knob has one value: what is short for setting it means nothing beside `--set` or `--sweep`.
fn refuse_knob_twice(matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let set = matches.get_many::<String>("set").into_iter().flatten();
    let set = set.filter_map(|setting| setting.split_once('=')).map(|(name, _)| ("set", name));
    let swept = matches.get_one::<String>("sweep").map(|name| ("sweep", name.as_str()));
    for (option, name) in set.chain(swept) {
        let is_same = |(short, knobs): &&(&str, &[&str])| matches.contains_id(short) && knobs.contains(&name);
        if let Some((short, _)) = SHORT.iter().find(is_same) {
            let reason = format!("--{short} and --{option} both set '{name}': give one of them");
            return Err(command.error(ErrorKind::ArgumentConflict, reason));
        }
    }
    Ok(())
}

fn comparison(matches: &ArgMatches) -> Option<Comparison> {
    let mut names = matches.get_many::<String>("compare")?;
    Some(names.next().map_or(Comparison::Remedy, |name| Comparison::With(name.clone())))
}

/// All settings of knobs: `--set`, and the options that are short for some of them.
fn settings(matches: &ArgMatches) -> Vec<String> {
    let given = matches.get_many::<String>("set").into_iter().flatten().cloned();
    let short = SHORT.iter().flat_map(|&(option, knobs)| {
        let values: Vec<String> = match matches.try_get_one::<[f64; 2]>(option) {
            Ok(angles) => angles.into_iter().flatten().map(f64::to_string).collect(),
            Err(_) => matches.get_one::<String>(option).cloned().into_iter().collect(),
        };
        knobs.iter().zip(values).map(|(knob, value)| format!("{knob}={value}")).collect::<Vec<_>>()
    });
    given.chain(short).collect()
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::figure::Variant;

    #[test]
    fn every_option_tells_what_its_value_may_be() {
        const VARIANTS: &[Variant] = &[Variant::new("one", |_| {}, "?")];
        let command = command(&Chapter { name: "ch00", question: "?", variants: VARIANTS });
        let error = |words: &[&str]| {
            let words = ["ch00"].iter().chain(words);
            let mut command = command.clone();
            let error = command.try_get_matches_from_mut(words).expect_err("refused");
            explained(error, &command).to_string()
        };
        // The value of --compare may be missing.
        let is_sure = |argument: &&Arg| {
            argument.get_action().takes_values()
                && argument.get_num_args().is_none_or(|count| count.min_values() > 0)
        };
        let mut count = 0;
        for name in command.get_arguments().filter(is_sure).filter_map(Arg::get_long) {
            let option = format!("--{name}");
            let missing = error(&[&option]);
            assert!(missing.contains("a value is required") && missing.contains("tip: --"), "{missing}");
            let negative = error(&[&option, "-2"]);
            assert!(negative.contains("invalid value '-2' for '--") && negative.contains(name), "{negative}");
            assert!(!negative.contains("tip:"), "{negative}");
            count += 1;
        }
        assert!(count > 8, "{count} options");
        let unknown = error(&["--sise"]);
        assert!(unknown.contains("'--size'") && !unknown.contains("-- --sise"), "{unknown}");
    }
}
