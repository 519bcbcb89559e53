//! What a chapter's program does with its arguments.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;

use super::animation::encode;
use super::arguments::{Format, Request};
use super::choice::{check_model_options, find, hints, other, unnamed};
use super::failure::Failure;
use super::options::{knob_list, list};
use super::output::{Destination, note, say};
use super::scenes::{check_inside, load, pair_of, scene_of, sweepable, unseen};
use super::show::Screen;
#[cfg(feature = "window")]
use super::window::open_window;
use super::wrap::{WIDEST, terminal_width, wrap_columns};
use crate::figure::picture::{Zoom, difference, side_by_side, zoomed};
use crate::figure::{Animation, Chapter, DrawOptions, Scene, Variant};
use crate::framebuffer::Framebuffer;
use crate::inspect::{Steps, history, with_legend};
use crate::rect::{Pixel, Rect};

impl Chapter {
    /// The whole program: reads the arguments, draws, writes, reports.
    #[must_use]
    pub fn main(&self) -> ExitCode {
        main(self)
    }
}

/// Reads the arguments, does what they say, reports.
fn main(chapter: &Chapter) -> ExitCode {
    let request = match Request::parse(chapter, std::env::args_os()) {
        Ok(request) => request,
        Err(error) if error.kind() == ErrorKind::DisplayHelp => {
            let help = wrap_columns(&error.to_string(), terminal_width().unwrap_or(WIDEST));
            return ended(say(help.trim_end()));
        }
        Err(error) => {
            // The version goes to standard output, errors to standard error; a closed pipe is not worth a word.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    ended(run(chapter, &request))
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
        let list =
            terminal_width().map_or_else(|| list(chapter), |width| wrap_columns(&list(chapter), width));
        return say(list.trim_end());
    }
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
    match &request.compare {
        _ if request.sweep.is_some() => sweep(chapter, variant, request, &destination),
        None if request.animate => animate(variant, request, &destination),
        None => {
            draw_one(variant, request, &destination)?;
            // Below a picture in the terminal, they would push its top out of sight.
            if request.variant.is_none() && request.show.is_none() && std::io::stderr().is_terminal() {
                note(&hints(chapter, variant));
            }
            Ok(())
        }
        Some(comparison) => {
            let other = other(chapter, variant, comparison)?;
            check_model_options(chapter, other, request)?;
            draw_comparison(variant, other, request, &destination)
        }
    }
}

#[cfg(not(feature = "window"))]
fn open_window(chapter: &Chapter, _: &Variant, _: &Request, _: &Destination) -> Result<(), Failure> {
    let name = chapter.name;
    Err(Failure::Usage(format!(
        "this program was built without a window: cargo run --features window --bin {name} -- --window"
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
    destination.write(&name_of(variant, request), &enlarged(picture, request.zoom))?;
    if let Some(reason) = unseen {
        note(&reason);
    }
    if let Some(zoom) = request.zoom {
        note(&shown_by(zoom, scene.size));
    }
    Ok(())
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
    destination.write_animation(&name_of(variant, request), |format| encode(format, animation, &draw))
}

/// How many frames a sweep has, and how fast they are shown.
const SWEEP: Animation = Animation { frames: 60, rate: 20 };

/// Draws an animation in which a knob goes once through its range, beside the remedy and the difference if that is asked.
fn sweep(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let name = request.sweep.as_deref().unwrap_or_default();
    let knob = sweepable(variant, name)?;
    let turned = |scene: &Scene<'_>, number: u32| {
        let mut options = scene.options(None);
        let value = knob.at(f64::from(number) / f64::from(SWEEP.frames - 1));
        options.knobs.put(name, value.unwrap_or(knob.default()));
        scene.variant.draw(&options)
    };
    let swept = format!("{}-sweep-{name}", name_of(variant, request));
    let Some(comparison) = &request.compare else {
        let scene = scene_of(variant, request, &load(request)?)?;
        let draw = |number| enlarged(turned(&scene, number), request.zoom);
        return destination.write_animation(&swept, |format| encode(format, SWEEP, &draw));
    };
    let that = other(chapter, variant, comparison)?;
    check_model_options(chapter, that, request)?;
    let (first, second) = pair_of(variant, that, request)?;
    // Whether the three fit is seen at the first frame.
    let panels = |number| compared(turned(&first, number), turned(&second, number), request.zoom);
    panels(0).ok_or_else(|| not_comparable(&first, &second))?;
    let draw = |number| panels(number).map_or_else(|| first.draw(), |(picture, _)| picture);
    let swept = format!("{swept}--{}", that.name);
    destination.write_animation(&swept, |format| encode(format, SWEEP, &draw))
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
    let steps = Steps::new(variant, &scene.options(None));
    if request.steps {
        let draw = |number| enlarged(steps.frame(number), request.zoom);
        let name = format!("{}-steps", name_of(variant, request));
        return destination.write_animation(&name, |format| encode(format, steps.animation(), &draw));
    }
    let (heat, legend) = steps.overdraw();
    note(&legend.join("\n"));
    let name = format!("{}-overdraw", name_of(variant, request));
    destination.write(&name, &with_legend(enlarged(heat, request.zoom)))
}

fn draw_comparison(
    this: &Variant,
    that: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let (first, second) = pair_of(this, that, request)?;
    let total = first.size.0 as usize * first.size.1 as usize;
    let (picture, count) =
        compared(first.draw(), second.draw(), request.zoom).ok_or_else(|| not_comparable(&first, &second))?;
    destination.write(&format!("{}--{}", name_of(this, request), that.name), &picture)?;
    note(&format!("{count} of {total} pixels differ"));
    Ok(())
}

/// The two pictures and where they differ, side by side, and in how many pixels; `None` if that cannot be drawn.
fn compared(first: Framebuffer, second: Framebuffer, zoom: Option<Zoom>) -> Option<(Framebuffer, usize)> {
    let (marked, count) = difference(&first, &second)?;
    let panels = [first, second, marked].map(|panel| enlarged(panel, zoom));
    Some((side_by_side(&panels)?, count))
}

/// Why two variants cannot be drawn side by side.
fn not_comparable(first: &Scene<'_>, second: &Scene<'_>) -> Failure {
    Failure::Usage(if first.size == second.size {
        "three such pictures are too wide: give a smaller --size".to_owned()
    } else {
        format!("'{}' and '{}' differ in size: give --size", first.variant.name, second.variant.name)
    })
}

/// The file name of a picture, without extension.
pub(super) fn name_of(variant: &Variant, request: &Request) -> String {
    let frame = request.frame.map_or_else(String::new, |frame| format!("@{frame:03}"));
    let rasterizer = request.rasterizer.map_or_else(String::new, |choice| format!("-{}", choice.name()));
    let zoom = request.zoom.map_or_else(String::new, |zoom| {
        let place = zoom.center.map_or_else(String::new, |(x, y)| format!("-at-{x}-{y}"));
        format!("-zoom{}{place}", zoom.factor)
    });
    let settings: String =
        request.settings.iter().map(|setting| format!("-{}", file_name(setting))).collect();
    format!("{}{frame}{settings}{rasterizer}{zoom}", variant.name)
}

/// A setting such as `tilt=60` as a part of a file name.
fn file_name(setting: &str) -> String {
    setting.chars().filter(|c| *c != '#').map(|c| if c == '=' || c == ',' { '-' } else { c }).collect()
}
