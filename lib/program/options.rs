//! The options that all chapters share, in three groups: what to draw, how to look at it, where to write it. One line of
//! help each, so that all of it fits a screen; the pages tell more.

use clap::builder::{OsStringValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgAction, Command};

use super::programs::PROGRAMS;
use super::show::Asked;
use super::values::{
    parse_angles, parse_color, parse_frame, parse_name, parse_path, parse_pixel, parse_setting, parse_size,
    parse_zoom,
};
use crate::figure::{Chapter, RasterizerChoice, Variant};

/// The command line of a chapter's program.
pub(super) fn command(chapter: &Chapter) -> Command {
    let names = |names: &mut dyn Iterator<Item = &str>| names.collect::<Vec<_>>().join(", ");
    let variants = names(&mut chapter.variants.iter().map(|variant| variant.name));
    let others = names(&mut PROGRAMS.iter().map(|program| program.name).filter(|name| *name != chapter.name));
    let after = format!(
        "Variants (--list tells what to look for):\n  {variants}\n\n\
         Other programs (cargo run --bin NAME):\n  {others}\n\n\
         The names of written files are printed on standard output, a line each."
    );
    let variant = format!("The picture to draw [default: {}]", chapter.lead().name);
    let group = |heading: &'static str, arguments: Vec<Arg>| {
        arguments.into_iter().map(move |argument| argument.help_heading(heading))
    };
    Command::new(chapter.name)
        .about(chapter.question)
        .override_usage(format!("cargo run --bin {} -- [VARIANT] [OPTIONS]", chapter.name))
        .after_help(after)
        // Whole lines: they are wrapped afterwards, with the lists below them.
        .term_width(0)
        .version(env!("CARGO_PKG_VERSION"))
        .arg(Arg::new("variant").value_name("VARIANT").help(variant))
        .args(group("What to draw", what_to_draw(chapter)))
        .args(group("How to look at it", how_to_look(chapter)))
        .args(group("Where to write it", where_to_write(chapter)))
}

fn switch(id: &'static str, help: &'static str) -> Arg {
    Arg::new(id).long(id).action(ArgAction::SetTrue).help(help)
}

/// An option with a value. The word after it is its value, whatever that begins with: so an error names both.
fn option(id: &'static str, value: &'static str, help: impl Into<String>) -> Arg {
    Arg::new(id).long(id).value_name(value).help(help.into()).allow_hyphen_values(true)
}

fn what_to_draw(chapter: &Chapter) -> Vec<Arg> {
    let animated = chapter.variants.iter().any(|variant| variant.animation.is_some());
    let mut arguments = vec![
        switch("list", "List the variants: what each is called and what to look for")
            .conflicts_with_all(BESIDE_LISTS)
            .conflicts_with("knobs"),
        switch("all", "Draw all variants, of animations the first frame").conflicts_with("variant"),
        option("frame", "N", "Draw frame N of an animation, counted from 0")
            .value_parser(parse_frame)
            .conflicts_with("all")
            .hide(!animated),
    ];
    arguments.extend(knobs(chapter));
    arguments.extend(subject(chapter));
    arguments.extend(view(chapter));
    arguments.push(rasterizer(chapter));
    arguments
}

/// What means nothing to a list.
const BESIDE_LISTS: [&str; 23] = [
    "window",
    "verbose",
    "all",
    "frame",
    "set",
    "model",
    "texture",
    "as-is",
    "flat",
    "eye",
    "light",
    "background",
    "rasterizer",
    "show",
    "zoom",
    "compare",
    "animate",
    "sweep",
    "steps",
    "overdraw",
    "inspect",
    "out",
    "size",
];

/// What can be turned.
fn knobs(chapter: &Chapter) -> [Arg; 2] {
    let is_hidden = chapter.variants.iter().all(|variant| variant.knobs.is_empty());
    [
        switch("knobs", "List the knobs of the variant: what can be turned, and what to watch")
            .conflicts_with_all(BESIDE_LISTS)
            .conflicts_with("format"),
        option("set", "NAME=VALUE", "Set a knob, such as tilt=60; can be given several times")
            .value_parser(parse_setting)
            .action(ArgAction::Append)
            .conflicts_with("all"),
    ]
    .map(|argument| argument.hide(is_hidden))
}

/// What is drawn in place of a variant's own model.
fn subject(chapter: &Chapter) -> [Arg; 4] {
    let path = OsStringValueParser::new().try_map(parse_path);
    // Where no variant draws a model, help does not speak of them.
    let is_hidden = !chapter.variants.iter().any(Variant::has_model);
    [
        option("model", "FILE.obj", "Draw a model of your own: Wavefront OBJ, with its materials")
            .value_parser(path.clone())
            .conflicts_with("all"),
        option("texture", "FILE", "Cover the model with this image: PNG, BMP, TGA or JPEG")
            .value_parser(path)
            .conflicts_with("all"),
        switch("as-is", "Leave the model where it is and as large as it is").requires("model"),
        switch("flat", "Give the model the normals of its faces, so that every edge shows"),
    ]
    .map(|argument| argument.hide(is_hidden))
}

/// Options that are short for knobs, and which knobs they set.
pub(super) const SHORT: [(&str, &[&str]); 3] = [
    ("eye", &["azimuth", "elevation"]),
    ("light", &["light-azimuth", "light-elevation"]),
    ("background", &["background"]),
];

/// From where a model is seen and lit: short for some knobs.
fn view(chapter: &Chapter) -> [Arg; 3] {
    let mut knobs = chapter.variants.iter().flat_map(|variant| variant.knobs);
    let is_hidden = !knobs.any(|knob| knob.name == SHORT[0].1[0]);
    [
        option("eye", "A,E", "Look at the model from azimuth A and elevation E, in degrees")
            .value_parser(parse_angles)
            .conflicts_with("all"),
        option("light", "A,E", "Light the model from there, in the same way")
            .value_parser(parse_angles)
            .conflicts_with("all"),
        option("background", "COLOR", "Draw the model in front of this color, such as 203040")
            .value_parser(parse_color)
            .conflicts_with("all"),
    ]
    .map(|argument| argument.hide(is_hidden))
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
    option("rasterizer", "NAME", "Fill by scanline (the book's), exact, or tiled (exact and fast)")
        .value_parser(parse)
        .hide_possible_values(true)
        .hide(chapter.variants.iter().all(|variant| variant.rasterizer.is_none()))
}

fn how_to_look(chapter: &Chapter) -> Vec<Arg> {
    let mut arguments = vec![window(), show()];
    arguments.extend([
        option("zoom", "N[@X,Y]", "Draw each pixel as N×N, around the pixel (X, Y), y up from the bottom")
            .value_parser(parse_zoom),
        option("compare", "OTHER", "Draw it beside OTHER, or beside its remedy, and where they differ")
            // Its value may be missing: what follows then is another option.
            .allow_hyphen_values(false)
            .allow_negative_numbers(true)
            .num_args(0..=1)
            .conflicts_with("all"),
    ]);
    arguments.extend(moving(chapter));
    arguments.extend(what_to_tell());
    arguments
}

/// Pictures that move.
fn moving(chapter: &Chapter) -> [Arg; 3] {
    let animated = chapter.variants.iter().any(|variant| variant.animation.is_some());
    let has_knobs = chapter.variants.iter().any(|variant| !variant.knobs.is_empty());
    [
        switch("animate", "Draw all frames of an animation into one file")
            .conflicts_with_all(["all", "frame", "compare"])
            .hide(!animated),
        option("sweep", "KNOB", "Turn a knob once through its range, as an animation")
            .value_parser(parse_name)
            .conflicts_with_all(["all", "animate", "inspect", "steps", "overdraw"])
            .hide(!has_knobs),
        switch("steps", "Draw how the picture comes about, step by step, as an animation")
            .conflicts_with_all(["all", "animate", "compare", "inspect"]),
    ]
}

/// How a picture came about.
fn what_to_tell() -> [Arg; 4] {
    [
        switch("overdraw", "Draw how often each pixel is written")
            .conflicts_with_all(["all", "animate", "compare", "inspect", "steps"])
            // What color is written makes no difference.
            .conflicts_with_all(["texture", "flat", "light", "background"]),
        option("inspect", "X,Y", "Print all that happened at the pixel (X, Y), y up from the bottom")
            .value_parser(parse_pixel)
            .conflicts_with_all(["all", "animate", "compare", "zoom", "out"]),
        switch("verbose", "Print also what came near that pixel and did not reach it").short('v'),
        option("format", "FORM", "Print it, or the list, as text, or as json for programs")
            .value_parser(["text", "json"])
            .hide_possible_values(true),
    ]
}

/// A look at it.
fn window() -> Arg {
    switch("window", "Open a window: turn knobs, drag, see single pixels; H lists the keys")
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
    option("show", "HOW", "Show it in the terminal: auto, blocks, kitty, iterm or sixel")
        .num_args(0..=1)
        .require_equals(true)
        .default_missing_value(Asked::Auto.name())
        .hide_possible_values(true)
        .value_parser(parse)
        .conflicts_with_all(["all", "animate", "inspect", "knobs", "out", "steps", "sweep"])
}

fn where_to_write(chapter: &Chapter) -> Vec<Arg> {
    let out = format!(
        "A file (.png .bmp .tga .ppm, moving .gif .png), a folder, or - [default: out/{}]",
        chapter.name
    );
    vec![
        option("out", "PATH", out).value_parser(OsStringValueParser::new().try_map(parse_path)),
        option("size", "WxH", size_help(chapter)).value_parser(parse_size),
    ]
}

/// What `--size` does, and which variants of the chapter it does not scale.
fn size_help(chapter: &Chapter) -> String {
    let help = "Size in pixels, such as 1920x1080; scenes scale to fit";
    let in_pixels = chapter.variants.iter().filter(|variant| variant.in_pixels).map(|variant| variant.name);
    match in_pixels.collect::<Vec<_>>().as_slice() {
        [] => help.to_owned(),
        names => format!("{help}, but not {}", names.join(", ")),
    }
}
