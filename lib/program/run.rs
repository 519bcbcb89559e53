//! What a chapter's program does with its arguments.

use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;

use super::animation::encode;
use super::arguments::{Format, Request};
use super::choice::{check_model_options, find, hints, other, unnamed};
use super::failure::Failure;
use super::lists::{knob_list, list, list_json};
use super::output::{Destination, note, say};
use super::scenes::{check_inside, load, name_of, pair_of, scene_of, sweepable, unseen};
use super::show::Screen;
use super::threads;
#[cfg(feature = "window")]
use super::window::open_window;
use super::wrap::{WIDEST, terminal_width, wrap_columns};
use crate::figure::picture::{Zoom, difference, side_by_side, zoomed};
use crate::figure::{Animation, Chapter, DrawOptions, Knob, Scene, Variant};
use crate::files::silence_decoders;
use crate::framebuffer::Framebuffer;
use crate::inspect::{Steps, history, overdraw, with_legend};
use crate::rect::{Pixel, Rect};

impl Chapter {
    /// The whole program: reads the arguments, draws, writes, reports.
    #[must_use]
    pub fn main(&self) -> ExitCode {
        silence_decoders();
        self.main_with(std::env::args_os())
    }

    /// The same with arguments of the caller's, the program's own name first.
    #[must_use]
    pub fn main_with(&self, arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
        match Request::parse(self, arguments) {
            Ok(request) => ended(run(self, &request)),
            Err(error) => refused(&error),
        }
    }
}

/// Says what is wrong with the arguments; or help, or the version.
fn refused(error: &clap::Error) -> ExitCode {
    if error.kind() == ErrorKind::DisplayHelp {
        let help = wrap_columns(&error.to_string(), terminal_width().unwrap_or(WIDEST));
        return ended(say(help.trim_end()));
    }
    // The version goes to standard output, errors to standard error.
    if !error.use_stderr() {
        return ended(say(error.to_string().trim_end()));
    }
    note(error.to_string().trim_end());
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// Says what went wrong, if anything did.
fn ended(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if failure != Failure::ClosedPipe {
                note(&format!("error: {failure}"));
            }
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(chapter: &Chapter, request: &Request) -> Result<(), Failure> {
    if request.list {
        // A line each for grep, wrapped for people.
        let variants = match &request.variant {
            Some(name) => std::slice::from_ref(find(chapter, name)?),
            None => chapter.variants,
        };
        if request.format == Format::Json {
            return say(&list_json(chapter, variants));
        }
        let list = list(variants);
        let wrapped = terminal_width().map(|width| wrap_columns(&list, width));
        return say(wrapped.as_deref().unwrap_or(&list).trim_end());
    }
    threads::start();
    let default = || PathBuf::from("out").join(chapter.name);
    let destination = match request.show {
        Some(asked) => Destination::Screen(Screen::find(asked)?),
        None => Destination::new(request.out.clone().unwrap_or_else(default))?,
    };
    if request.all {
        if destination.is_single() && chapter.variants.len() > 1 {
            return Err(Failure::Usage("--all draws several pictures: --out must name a folder".to_owned()));
        }
        chapter.variants.iter().try_for_each(|variant| check_model_options(chapter, variant, request))?;
        return chapter.variants.iter().try_for_each(|variant| draw_one(variant, request, &destination));
    }
    let variant = match &request.variant {
        Some(name) => find(chapter, name)?,
        None => unnamed(chapter, request),
    };
    check_model_options(chapter, variant, request)?;
    if request.knobs {
        return say(&knob_list(variant));
    }
    if request.window {
        return open_window(chapter, variant, request, &destination);
    }
    if let Some(pixel) = request.inspect {
        return inspect_pixel(chapter, variant, request, pixel);
    }
    if request.steps || request.overdraw {
        return draw_recorded(variant, request, &destination);
    }
    let that = match &request.compare {
        None => None,
        Some(comparison) => Some(other(chapter, variant, comparison)?),
    };
    that.map_or(Ok(()), |that| check_model_options(chapter, that, request))?;
    match (&request.sweep, that) {
        (Some(knob), None) => sweep(variant, knob, request, &destination),
        (Some(knob), Some(that)) => sweep_comparison(variant, that, knob, request, &destination),
        (None, Some(that)) => draw_comparison(variant, that, request, &destination),
        (None, None) if request.animate => animate(variant, request, &destination),
        (None, None) => {
            draw_one(variant, request, &destination)?;
            // Below a picture in the terminal, they would push its top out of sight.
            if request.variant.is_none() && request.show.is_none() && std::io::stderr().is_terminal() {
                note(&hints(chapter, variant));
            }
            Ok(())
        }
    }
}

#[cfg(not(feature = "window"))]
fn open_window(chapter: &Chapter, variant: &Variant, _: &Request, _: &Destination) -> Result<(), Failure> {
    let (name, variant) = (chapter.name, variant.name);
    Err(Failure::Usage(format!(
        "this program was built without a window: cargo run --release --features window --bin {name} -- {variant} --window"
    )))
}

/// The picture, enlarged if that was asked for.
fn enlarged(picture: Framebuffer, zoom: Option<Zoom>) -> Framebuffer {
    match zoom {
        None => picture,
        Some(zoom) => zoomed(&picture, zoom),
    }
}

fn draw_one(variant: &Variant, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let scene = scene_of(variant, request, &load(request)?)?;
    let picture = scene.draw();
    let unseen = request.model.as_ref().and_then(|path| unseen(path, &scene, &picture));
    destination.write(&name_of(&scene, request), &enlarged(picture, request.zoom))?;
    if let Some(reason) = unseen {
        note(&reason);
    }
    tell_part(request, scene.size);
    Ok(())
}

/// Says which part of a picture is shown, if it is zoomed.
fn tell_part(request: &Request, size: (u32, u32)) {
    if let Some(zoom) = request.zoom {
        note(&shown_by(zoom, size));
    }
}

/// Which pixels a zoomed picture shows, so that one that is seen can be found again.
fn shown_by(zoom: Zoom, (width, height): (u32, u32)) -> String {
    let Rect { left, bottom, right, top } = zoom.part(Rect::sized(width, height));
    let factor = zoom.factor;
    format!(
        "shown: columns {left} to {} and rows {bottom} to {}, y up, each pixel as {factor}×{factor}",
        right - 1,
        top - 1
    )
}

fn animate(variant: &Variant, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let Some(animation) = variant.animation else {
        return Err(Failure::Usage(format!("'{}' is one picture: it cannot be animated", variant.name)));
    };
    let scene = scene_of(variant, request, &load(request)?)?;
    let draw = |frame| enlarged(variant.draw(&DrawOptions { frame, ..scene.options(None) }), request.zoom);
    destination.write_animation(&name_of(&scene, request), |format| encode(format, animation, &draw))
}

/// A scene with a knob at the place in its range that belongs to a frame of a sweep.
fn swept(scene: &Scene<'_>, knob: &Knob, number: u32) -> Framebuffer {
    let mut options = scene.options(None);
    let value = knob.at(f64::from(number) / f64::from(Animation::SWEEP.frames - 1));
    options.knobs.put(knob.name, value.unwrap_or(knob.default()));
    scene.variant.draw(&options)
}

/// Draws an animation in which a knob goes once through its range.
fn sweep(variant: &Variant, name: &str, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let knob = sweepable(variant, name, request)?;
    let scene = scene_of(variant, request, &load(request)?)?;
    let draw = |number| enlarged(swept(&scene, knob, number), request.zoom);
    let file = format!("{}-sweep-{name}", name_of(&scene, request));
    destination.write_animation(&file, |format| encode(format, Animation::SWEEP, &draw))
}

/// The same beside another variant, and where the two differ.
fn sweep_comparison(
    this: &Variant,
    that: &Variant,
    name: &str,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let knob = sweepable(this, name, request)?;
    let (first, second) = pair_of(this, that, request)?;
    let draw = |number| compared(swept(&first, knob, number), swept(&second, knob, number), request.zoom).0;
    let file = format!("{}-sweep-{name}--{}", name_of(&first, request), that.name);
    destination.write_animation(&file, |format| encode(format, Animation::SWEEP, &draw))
}

/// Prints the history of a pixel; nothing is written but text.
fn inspect_pixel(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
    pixel: Pixel,
) -> Result<(), Failure> {
    let scene = scene_of(variant, request, &load(request)?)?;
    check_inside(scene.size, pixel)?;
    let history = history(chapter.name, variant, &scene.options(None), pixel);
    if request.format == Format::Json {
        return say(&history.to_json());
    }
    let history = if request.verbose { history } else { history.without_misses() };
    say(&history.to_string())
}

/// Draws how a picture came about: step by step, or how often each pixel was written.
fn draw_recorded(variant: &Variant, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let scene = scene_of(variant, request, &load(request)?)?;
    if request.steps {
        let steps = Steps::new(variant, &scene.options(None));
        let steps =
            steps.map_err(|error| Failure::Usage(format!("'{}' has {error} (--size)", variant.name)))?;
        let draw = |number| enlarged(steps.frame(number), request.zoom);
        let name = format!("{}-steps", name_of(&scene, request));
        return destination.write_animation(&name, |format| encode(format, steps.animation(), &draw));
    }
    let (heat, legend) = overdraw(variant, &scene.options(None));
    note(&legend.join("\n"));
    let name = format!("{}-overdraw", name_of(&scene, request));
    destination.write(&name, &with_legend(enlarged(heat, request.zoom)))?;
    tell_part(request, scene.size);
    Ok(())
}

fn draw_comparison(
    this: &Variant,
    that: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let (first, second) = pair_of(this, that, request)?;
    let total = first.size.0 as usize * first.size.1 as usize;
    let (picture, count) = compared(first.draw(), second.draw(), request.zoom);
    destination.write(&format!("{}--{}", name_of(&first, request), that.name), &picture)?;
    note(&format!("{count} of {total} pixels differ"));
    tell_part(request, first.size);
    Ok(())
}

/// The two pictures of a pair and where they differ, side by side, and in how many pixels.
fn compared(first: Framebuffer, second: Framebuffer, zoom: Option<Zoom>) -> (Framebuffer, usize) {
    let (marked, count) = difference(&first, &second).expect("a pair is of one size");
    let panels = [first, second, marked].map(|panel| enlarged(panel, zoom));
    (side_by_side(&panels).expect("a pair fits side by side"), count)
}
