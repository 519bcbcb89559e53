//! The command line that all chapters share.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};

use super::programs::PROGRAMS;
use super::show::Asked;
use crate::figure::picture::Zoom;
use crate::figure::{Chapter, Mistake, RasterizerChoice, Variant};
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
        let matches = command(chapter).try_get_matches_from(arguments)?;
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
            show: matches.get_one("show").copied(),
        })
    }

    /// Which normals a model gets.
    pub(super) const fn normal_style(&self) -> NormalStyle {
        if self.flat { NormalStyle::Flat } else { NormalStyle::Smooth }
    }
}

fn comparison(matches: &ArgMatches) -> Option<Comparison> {
    let mut names = matches.get_many::<String>("compare")?;
    Some(names.next().map_or(Comparison::Remedy, |name| Comparison::With(name.clone())))
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
        .max_term_width(100)
        .version(env!("CARGO_PKG_VERSION"))
        .args(what_to_draw(chapter))
        .args(how_to_draw(chapter))
        .args(subject(chapter))
        .arg(rasterizer(chapter))
        .args(what_to_tell())
        .arg(show())
}

fn switch(id: &'static str, help: &'static str) -> Arg {
    Arg::new(id).long(id).action(ArgAction::SetTrue).help(help)
}

fn option(id: &'static str, value: &'static str, help: impl Into<String>) -> Arg {
    Arg::new(id).long(id).value_name(value).help(help.into())
}

fn what_to_draw(chapter: &Chapter) -> [Arg; 3] {
    let variant = format!("The picture to draw [default: {}]", chapter.lead().name);
    [
        Arg::new("variant").value_name("VARIANT").help(variant),
        switch("list", "List the variants: what each is called and what to look for").exclusive(true),
        switch("all", "Draw all variants, of animations the first frame").conflicts_with("variant"),
    ]
}

/// What is drawn in place of a variant's own model.
fn subject(chapter: &Chapter) -> [Arg; 4] {
    let path = value_parser!(PathBuf);
    // Where no variant draws a model, help does not speak of them.
    let is_hidden = !chapter.variants.iter().any(Variant::has_model);
    [
        option("model", "FILE.obj", "Draw this model (Wavefront OBJ: its faces, with Kd and map_Kd of their materials), where the variant draws one; a warning says what is left out")
            .value_parser(path.clone())
            .conflicts_with("all"),
        option("texture", "FILE", "Cover the model with this image (PNG, BMP, TGA, JPEG; transparent is white)")
            .value_parser(path)
            .conflicts_with("all"),
        switch("as-is", "Leave the model where it is and as large as it is, not centered and scaled to fit")
            .requires("model"),
        switch("flat", "Give the model the normals of its faces, so that every edge shows"),
    ]
    .map(|argument| argument.hide(is_hidden))
}

/// How a picture came about.
fn what_to_tell() -> [Arg; 5] {
    let inspect = "Report all that happened at the pixel (X, Y), y up from the bottom; no picture is written";
    [
        option("inspect", "X,Y", inspect)
            .value_parser(parse_pixel)
            .allow_hyphen_values(true)
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
            "Draw how often each pixel is written; what the colors mean goes to standard error",
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
    .conflicts_with_all(["all", "animate", "inspect", "out", "steps"])
}

fn how_to_draw(chapter: &Chapter) -> [Arg; 6] {
    let out = format!(
        "A file (.png .bmp .tga .ppm; animations .gif .png), a folder, or - for a PNG on standard output [default: out/{}]",
        chapter.name
    );
    let zoom = "Draw each pixel as N×N, around the pixel (X, Y), y up from the bottom; from 8 on with a grid";
    [
        option("out", "PATH", out).value_parser(value_parser!(PathBuf)),
        option("size", "WxH", "Size of the picture in pixels, such as 1920x1080").value_parser(parse_size),
        option("frame", "N", "Draw one frame of an animation [default: 0]")
            .value_parser(value_parser!(u32))
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
        .num_args(0..=1)
        .conflicts_with("all"),
    ]
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
        format!("  {:width$}  {}{source}{mistake}\n", variant.name, variant.look)
    };
    chapter.variants.iter().map(line).collect()
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some((width.trim().parse::<u32>().ok()?, height.trim().parse::<u32>().ok()?))
    });
    let (width, height) = sides.ok_or("expected WIDTHxHEIGHT, such as 640x480")?;
    let allowed = 1..=Framebuffer::MAX_SIDE;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(format!("each side must be 1 to {} pixels", Framebuffer::MAX_SIDE));
    }
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!("more than {MAX_PIXELS} pixels"));
    }
    Ok((width, height))
}

fn parse_pixel(text: &str) -> Result<Pixel, String> {
    let coordinates = text
        .split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse::<i32>().ok()?, y.trim().parse::<i32>().ok()?)));
    coordinates.ok_or_else(|| "expected X,Y, such as 320,240".to_owned())
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
    fn zooms() {
        assert_eq!(parse_zoom("8"), Ok(Zoom { factor: 8, center: None }));
        assert_eq!(parse_zoom("12@3,-4"), Ok(Zoom { factor: 12, center: Some((3, -4)) }));
        for bad in ["", "0", "65", "x", "8@", "8@1", "8@1,2,3", "8@1;2"] {
            assert!(parse_zoom(bad).is_err(), "{bad}");
        }
    }
}
