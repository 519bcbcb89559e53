//! The command line that all chapters share.

use std::ffi::OsString;
use std::num::{IntErrorKind, ParseIntError};
use std::path::PathBuf;

use clap::builder::{OsStringValueParser, PossibleValue, PossibleValuesParser, StyledStr, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgAction, ArgMatches, Command};

use super::programs::PROGRAMS;
use super::show::Asked;
use crate::figure::picture::Zoom;
use crate::figure::{Chapter, Knob, Mistake, RasterizerChoice, Variant};
use crate::framebuffer::Framebuffer;
use crate::model::NormalStyle;
use crate::rect::Pixel;

/// The most pixels that `--size` may ask for: a picture of 8192×8192.
const MAX_PIXELS: u64 = 1 << 26;

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

/// The form of a history.
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

fn comparison(matches: &ArgMatches) -> Option<Comparison> {
    let mut names = matches.get_many::<String>("compare")?;
    Some(names.next().map_or(Comparison::Remedy, |name| Comparison::With(name.clone())))
}

/// All settings of knobs: `--set`, and the options that are short for some of them.
fn settings(matches: &ArgMatches) -> Vec<String> {
    let given = matches.get_many::<String>("set").into_iter().flatten().cloned();
    let angles = |id: &str, [first, second]: [&str; 2]| {
        let pair = matches.get_one::<[f64; 2]>(id);
        pair.map(|[a, b]| [format!("{first}={a}"), format!("{second}={b}")]).into_iter().flatten()
    };
    let background = matches.get_one::<String>("background").map(|color| format!("background={color}"));
    given
        .chain(angles("eye", ["azimuth", "elevation"]))
        .chain(angles("light", ["light-azimuth", "light-elevation"]))
        .chain(background)
        .collect()
}

fn command(chapter: &Chapter) -> Command {
    let others = PROGRAMS.iter().filter(|program| program.name != chapter.name);
    let others: String =
        others.map(|program| format!("  {:24} {}\n", program.name, program.question)).collect();
    let after = format!(
        "Variants:\n{}\nOther programs (cargo run --bin NAME):\n{others}\n\
         Written files are printed on standard output, a line each.",
        list(chapter)
    );
    Command::new(chapter.name)
        .about(chapter.question)
        .override_usage(format!("cargo run --bin {} -- [VARIANT] [OPTIONS]", chapter.name))
        .after_help(after)
        // Whole lines: they are wrapped afterwards, with the lists below them.
        .term_width(0)
        .version(env!("CARGO_PKG_VERSION"))
        .args(what_to_draw(chapter))
        .arg(window())
        .args(how_to_draw(chapter))
        .args(knobs(chapter))
        .args(subject(chapter))
        .arg(rasterizer(chapter))
        .args(what_to_tell())
        .arg(show())
}

fn switch(id: &'static str, help: &'static str) -> Arg {
    Arg::new(id).long(id).action(ArgAction::SetTrue).help(help)
}

/// An option with a value. The word after it is its value, whatever that begins with: so an error names both.
fn option(id: &'static str, value: &'static str, help: impl Into<String>) -> Arg {
    Arg::new(id).long(id).value_name(value).help(help.into()).allow_hyphen_values(true)
}

fn what_to_draw(chapter: &Chapter) -> [Arg; 3] {
    let variant = format!("The picture to draw [default: {}]", chapter.lead().name);
    [
        Arg::new("variant").value_name("VARIANT").help(variant),
        switch("list", "List the variants: what each is called and what to look for").exclusive(true),
        switch("all", "Draw all variants, of animations the first frame").conflicts_with("variant"),
    ]
}

/// What can be turned.
fn knobs(chapter: &Chapter) -> [Arg; 3] {
    let is_hidden = chapter.variants.iter().all(|variant| variant.knobs.is_empty());
    [
        option(
            "set",
            "NAME=VALUE",
            "Set a knob of the variant to a value, such as tilt=60; can be given several times",
        )
        .action(ArgAction::Append)
        .conflicts_with("all"),
        option(
            "sweep",
            "NAME",
            "Draw an animation in which a knob goes once through its range; with --compare too",
        )
        .conflicts_with_all(["all", "animate", "inspect", "steps", "overdraw"]),
        switch("knobs", "List the knobs of the variant: name, default, range, and what to watch")
            .conflicts_with_all(["all", "out", "inspect"]),
    ]
    .map(|argument| argument.hide(is_hidden))
}

/// The knobs of a variant, two lines each.
pub(super) fn knob_list(variant: &Variant) -> String {
    if variant.knobs.is_empty() {
        return format!("'{}' has no knobs", variant.name);
    }
    let line = |knob: &Knob| {
        let Knob { name, watch, .. } = knob;
        format!("\n  {name} = {}   ({})\n      {watch}", knob.shown(knob.default()), knob.range())
    };
    let lines: String = variant.knobs.iter().map(line).collect();
    format!("Knobs of '{}', --set NAME=VALUE:{lines}", variant.name)
}

/// Whether some variant has a knob of this name.
fn has_knob(chapter: &Chapter, name: &str) -> bool {
    chapter.variants.iter().flat_map(|variant| variant.knobs).any(|knob| knob.name == name)
}

/// What is drawn in place of a variant's own model, and how it is looked at.
fn subject(chapter: &Chapter) -> [Arg; 7] {
    let path = OsStringValueParser::new().try_map(parse_path);
    // Where no variant draws a model, help does not speak of them.
    let is_hidden = !chapter.variants.iter().any(Variant::has_model);
    let given = [
        option("model", "FILE.obj", "Draw this model (Wavefront OBJ: its faces, with Kd and map_Kd of their materials), where the variant draws one; a warning says what is left out")
            .value_parser(path.clone())
            .conflicts_with("all"),
        option("texture", "FILE", "Cover the model with this image (PNG, BMP, TGA, JPEG; transparent is white)")
            .value_parser(path)
            .conflicts_with("all"),
        switch("as-is", "Leave the model where it is and as large as it is, not centered and scaled to fit")
            .requires("model"),
        switch("flat", "Give the model the normals of its faces, so that every edge shows"),
    ];
    let view = [
        option(
            "eye",
            "AZIMUTH,ELEVATION",
            "Look at the model from there, in degrees: to the right, then up; 0,0 is from the front",
        )
        .value_parser(parse_angles)
        .conflicts_with("all"),
        option("light", "AZIMUTH,ELEVATION", "Light the model from there, in the same way")
            .value_parser(parse_angles)
            .allow_hyphen_values(true)
            .conflicts_with("all"),
        option("background", "#RRGGBB", "Put the model before this color").conflicts_with("all"),
    ];
    let has_view = has_knob(chapter, "azimuth");
    let [model, texture, as_is, flat] = given.map(|argument| argument.hide(is_hidden));
    let [eye, light, background] = view.map(|argument| argument.hide(!has_view));
    [model, texture, as_is, flat, eye, light, background]
}

/// How a picture came about.
fn what_to_tell() -> [Arg; 5] {
    let inspect = "Report all that happened at the pixel (X, Y), y up from the bottom; no picture is written";
    [
        option("inspect", "X,Y", inspect)
            .value_parser(parse_pixel)
            .conflicts_with_all(["all", "animate", "compare", "zoom", "out"]),
        option("format", "FORM", "The form of the report: text, or json for programs [default: text]")
            .value_parser(["text", "json"])
            .requires("inspect"),
        switch("verbose", "Report also what came near the pixel and did not reach it")
            .short('v')
            .requires("inspect"),
        switch("steps", "Draw an animation of how the picture comes about, step by step")
            .conflicts_with_all(["all", "animate", "compare", "inspect"]),
        switch(
            "overdraw",
            "Draw how often each pixel is written; what the colors mean stands below, and on standard error with counts",
        )
        .conflicts_with_all(["all", "animate", "compare", "inspect", "steps"]),
    ]
}

/// Which rasterizer the pipeline ends with.
fn rasterizer(chapter: &Chapter) -> Arg {
    // The exact rasterizer was once called by its method, edge functions: that name is still understood.
    let names = RasterizerChoice::ALL.iter().map(|choice| match choice {
        RasterizerChoice::Exact => PossibleValue::new(choice.name()).alias("edge"),
        _ => PossibleValue::new(choice.name()),
    });
    let parse = PossibleValuesParser::new(names).map(|name| {
        let named = RasterizerChoice::ALL.iter().find(|choice| choice.name() == name);
        named.copied().unwrap_or(RasterizerChoice::Exact)
    });
    option(
        "rasterizer",
        "NAME",
        "Fill triangles by the book's scanlines, exactly by edge functions, or exactly and fast in tiles",
    )
    .value_parser(parse)
    .hide(chapter.variants.iter().all(|variant| variant.rasterizer.is_none()))
}

/// A look at it.
fn window() -> Arg {
    switch(
        "window",
        "Open a window: turn knobs, drag points and models, look at single pixels; H tells the keys",
    )
    .conflicts_with_all([
        "all", "animate", "compare", "inspect", "steps", "overdraw", "knobs", "zoom", "show",
    ])
}

/// Whether the picture is shown in the terminal, and how.
fn show() -> Arg {
    let parse = PossibleValuesParser::new(Asked::ALL.map(Asked::name)).map(|name| {
        let named = Asked::ALL.into_iter().find(|asked| asked.name() == name);
        named.unwrap_or(Asked::Auto)
    });
    option(
        "show",
        "HOW",
        "Show the picture in the terminal instead of writing a file: in half blocks, or whole where the terminal is known \
         by its variables to take pictures; to any other, HOW names the way",
    )
    .num_args(0..=1)
    .require_equals(true)
    .default_missing_value(Asked::Auto.name())
    .value_parser(parse)
    .conflicts_with_all(["all", "animate", "inspect", "knobs", "out", "steps", "sweep"])
}

fn how_to_draw(chapter: &Chapter) -> [Arg; 6] {
    let out = format!(
        "A file (.png .bmp .tga .ppm; animations .gif .png), a folder, or - for a PNG on standard output [default: out/{}]",
        chapter.name
    );
    let zoom = "Draw each pixel as N×N, around the pixel (X, Y), y up from the bottom, in a frame with the numbers of columns and rows; from 8 on with a grid";
    [
        option("out", "PATH", out).value_parser(OsStringValueParser::new().try_map(parse_path)),
        option("size", "WxH", size_help(chapter)).value_parser(parse_size),
        option("frame", "N", "Draw one frame of an animation, counted from 0 [default: 0]")
            .value_parser(parse_frame)
            .conflicts_with("all"),
        switch(
            "animate",
            "Draw all frames of an animation into one file: GIF, 256 colors a frame, or PNG, which keeps all",
        )
        .conflicts_with_all(["all", "frame", "compare"]),
        option("zoom", "N[@X,Y]", zoom).value_parser(parse_zoom),
        option(
            "compare",
            "OTHER",
            "Draw this | OTHER | where they differ; OTHER is a mistake's remedy if none is named",
        )
        // Its value may be missing: what follows then is another option.
        .allow_hyphen_values(false)
        .allow_negative_numbers(true)
        .num_args(0..=1)
        .conflicts_with("all"),
    ]
}

/// What `--size` does, and which variants of the chapter it does not scale.
fn size_help(chapter: &Chapter) -> String {
    let help =
        "Size of the picture in pixels, such as 1920x1080; scenes scale to fit, their proportions kept";
    let in_pixels = chapter.variants.iter().filter(|variant| variant.in_pixels).map(|variant| variant.name);
    match in_pixels.collect::<Vec<_>>().as_slice() {
        [] => help.to_owned(),
        names => {
            format!("{help}; it only crops or borders what is drawn in pixels: {}", names.join(", "))
        }
    }
}

/// The variants of a chapter, a line each: name, then what to look for.
pub(super) fn list(chapter: &Chapter) -> String {
    let width = chapter.variants.iter().map(|variant| variant.name.len()).max().unwrap_or(0);
    let line = |variant: &Variant| {
        let mistake = match variant.mistake {
            Mistake::No => String::new(),
            Mistake::RemediedBy(remedy) => format!(" [mistake; remedy: {remedy}]"),
            Mistake::WithoutRemedy => " [mistake]".to_owned(),
        };
        let source = if variant.source.is_empty() { String::new() } else { format!(" ({})", variant.source) };
        let in_pixels = if variant.in_pixels { " [in pixels: --size does not scale it]" } else { "" };
        format!("  {:width$}  {}{source}{mistake}{in_pixels}\n", variant.name, variant.look)
    };
    chapter.variants.iter().map(line).collect()
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some((width.trim().parse::<u32>().ok()?, height.trim().parse::<u32>().ok()?))
    });
    let expected = || {
        format!("expected WIDTHxHEIGHT, whole numbers from 1 to {}, such as 640x480", Framebuffer::MAX_SIDE)
    };
    let (width, height) = sides.ok_or_else(expected)?;
    let allowed = 1..=Framebuffer::MAX_SIDE;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(format!("each side must be 1 to {} pixels", Framebuffer::MAX_SIDE));
    }
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!("more than {MAX_PIXELS} pixels"));
    }
    Ok((width, height))
}

fn parse_frame(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|error: ParseIntError| {
        let reason = match error.kind() {
            IntErrorKind::PosOverflow => "no animation has so many frames",
            _ => "expected a whole number from 0 on",
        };
        reason.to_owned()
    })
}

fn parse_path(text: OsString) -> Result<PathBuf, &'static str> {
    // Rather an option whose value was forgotten in front of it than a file.
    if text != "-" && text.as_encoded_bytes().starts_with(b"-") {
        return Err("expected a path; in front of one that begins with a hyphen put ./");
    }
    if text.is_empty() { Err("expected a path") } else { Ok(PathBuf::from(text)) }
}

fn parse_pixel(text: &str) -> Result<Pixel, String> {
    let coordinates = text
        .split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse::<i32>().ok()?, y.trim().parse::<i32>().ok()?)));
    coordinates.ok_or_else(|| "expected X,Y, a column and a row of the picture, such as 320,240".to_owned())
}

/// Two angles in degrees.
fn parse_angles(text: &str) -> Result<[f64; 2], String> {
    let angle = |text: &str| text.trim().parse::<f64>().ok().filter(|angle| angle.is_finite());
    let angles = text.split_once(',').and_then(|(a, b)| Some([angle(a)?, angle(b)?]));
    angles.ok_or_else(|| "expected AZIMUTH,ELEVATION in degrees, such as 30,20".to_owned())
}

fn parse_zoom(text: &str) -> Result<Zoom, String> {
    let (factor, center) = match text.split_once('@') {
        None => (text, None),
        Some((factor, pixel)) => {
            let center = parse_pixel(pixel).map_err(|_| "expected N@X,Y, such as 12@200,200")?;
            (factor, Some(center))
        }
    };
    let allowed = 1..=Zoom::MAX_FACTOR;
    let factor = factor.trim().parse::<u32>().ok().filter(|factor| allowed.contains(factor));
    let factor = factor.ok_or(format!("the factor must be a whole number from 1 to {}", Zoom::MAX_FACTOR))?;
    Ok(Zoom { factor, center })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(parse_size("640x480"), Ok((640, 480)));
        assert_eq!(parse_size("16384x1"), Ok((16384, 1)));
        for bad in
            ["", "640", "640x", "x480", "0x480", "-1x5", "640x480x3", "16385x1", "16384x16384", "1e3x5"]
        {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

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

    #[test]
    fn paths() {
        for good in ["-", "./-x", "a b", "out/"] {
            assert_eq!(parse_path(good.into()), Ok(good.into()));
        }
        for bad in ["", "-x", "--all"] {
            assert!(parse_path(bad.into()).is_err(), "{bad}");
        }
    }

    #[test]
    fn zooms() {
        assert_eq!(parse_zoom("8"), Ok(Zoom { factor: 8, center: None }));
        assert_eq!(parse_zoom("12@3,-4"), Ok(Zoom { factor: 12, center: Some((3, -4)) }));
        for bad in ["", "0", "65", "x", "8@", "8@1", "8@1,2,3", "8@1;2"] {
            assert!(parse_zoom(bad).is_err(), "{bad}");
        }
    }
}
