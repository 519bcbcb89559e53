//! What a chapter's program does with its arguments.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::ErrorKind;
use glam::DVec3;

use super::animation::{encode, progress_bar};
use super::arguments::{Comparison, Format, Request, knob_list, list};
use super::failure::Failure;
use super::output::{Destination, note, say};
use super::programs::{PROGRAMS, Program};
use super::show::Screen;
use super::wrap::{WIDEST, terminal_width, wrap_columns};
use crate::figure::picture::{Zoom, difference, side_by_side, zoomed};
use crate::figure::{
    Animation, Chapter, DrawOptions, Given, Knob, KnobError, Knobs, Mistake, RasterizerChoice, Scene,
    Subject, Variant,
};
use crate::files::{FileError, load_texture, shown};
use crate::framebuffer::Framebuffer;
use crate::inspect::{Steps, history, with_legend};
#[cfg(feature = "window")]
use crate::live::{Event, Live};
use crate::model::Model;
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

#[cfg(feature = "window")]
fn open_window(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let given = load(request)?;
    let mut live = Live::new(chapter, scene_of(variant, request, &given)?, given);
    if let Some(name) = &request.sweep {
        sweepable(variant, name)?;
        live.take_knob(name);
        live.apply(Event::Run).map_err(runtime_failure)?;
    }
    super::window::open(live, destination)
}

#[cfg(not(feature = "window"))]
fn open_window(chapter: &Chapter, _: &Variant, _: &Request, _: &Destination) -> Result<(), Failure> {
    let name = chapter.name;
    Err(Failure::Usage(format!(
        "this program was built without a window: cargo run --features window --bin {name} -- --window"
    )))
}

/// The variant for those who have named none: the lead, or the first that can draw what was given instead of its own.
fn unnamed<'a>(chapter: &'a Chapter, request: &Request) -> &'a Variant {
    let has_knobs = |variant: &Variant| {
        let knobs = Knobs::new(variant.knobs, variant.size);
        let names = request.settings.iter().filter_map(|setting| setting.split_once('='));
        names.map(|(name, _)| name).chain(request.sweep.as_deref()).all(|name| knobs.find(name).is_some())
    };
    let accepts =
        |variant: &&Variant| check_model_options(chapter, variant, request).is_ok() && has_knobs(variant);
    chapter.variants.iter().find(accepts).unwrap_or_else(|| chapter.lead())
}

/// For those who have named no variant: what is seen, what to compare it with, and how to ask a pixel.
fn hints(chapter: &Chapter, drawn: &Variant) -> String {
    let Variant { name, look, size: (width, height), .. } = drawn;
    let run = format!("cargo run --bin {} --", chapter.name);
    let is_compared = |variant: &&Variant| matches!(variant.mistake, Mistake::RemediedBy(_));
    let compare = match chapter.variants.iter().find(is_compared) {
        Some(mistake) => format!("A mistake beside its remedy: {run} {} --compare", mistake.name),
        None => format!("What else can be drawn: {run} --list"),
    };
    let pixel = format!("{},{}", width / 2, height / 2);
    format!("{name}: {look}\n{compare}\nWhat happened at a pixel: {run} {name} --inspect {pixel}")
}

fn find<'a>(chapter: &'a Chapter, name: &str) -> Result<&'a Variant, Failure> {
    chapter.find(name).ok_or_else(|| Failure::Usage(no_such_variant(chapter, name)))
}

/// What is said of a name that no variant has: what may be meant, here or in another program, and what there is.
fn no_such_variant(chapter: &Chapter, name: &str) -> String {
    let names: Vec<&str> = chapter.variants.iter().map(|variant| variant.name).collect();
    let likeness = |known: &&str| strsim::jaro(name, known);
    let nearest = names.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let others: Vec<&str> = PROGRAMS
        .iter()
        .filter(|program| program.variants.contains(&name))
        .map(|program| program.name)
        .collect();
    let hint = match nearest.filter(|nearest| strsim::jaro(name, nearest) > 0.8) {
        _ if !others.is_empty() => format!("; {} has it", others.join(" and ")),
        Some(nearest) => format!("; did you mean '{nearest}'?"),
        None => String::new(),
    };
    format!("{} has no variant '{name}'{hint}\nIt has: {}", chapter.name, names.join(", "))
}

/// The variant to compare with.
fn other<'a>(
    chapter: &'a Chapter,
    variant: &Variant,
    comparison: &Comparison,
) -> Result<&'a Variant, Failure> {
    match (comparison, variant.mistake) {
        (Comparison::With(name), _) => find(chapter, name),
        (Comparison::Remedy, Mistake::RemediedBy(remedy)) => find(chapter, remedy),
        (Comparison::Remedy, _) => Err(Failure::Usage(format!(
            "'{}' has no remedy to be compared with: name the other variant, --compare OTHER",
            variant.name
        ))),
    }
}

/// A variant as it was asked for: what it is a picture of, its size, its rasterizer, its knobs, its frame.
fn scene_of<'a>(variant: &'a Variant, request: &Request, given: &Given) -> Result<Scene<'a>, Failure> {
    let mut scene = Scene { frame: frame_of(variant, request)?, ..sized(variant, request, given)? };
    for setting in &request.settings {
        scene.knobs.set(setting).map_err(|error| not_set(variant, &error))?;
    }
    Ok(scene)
}

/// The same at the first frame, its knobs at their defaults.
fn sized<'a>(variant: &'a Variant, request: &Request, given: &Given) -> Result<Scene<'a>, Failure> {
    let size = request.size.unwrap_or(variant.size);
    check_zoom(size, request.zoom)?;
    if variant.in_pixels && size != variant.size {
        let name = variant.name;
        note(&format!("'{name}' is drawn in pixels: the size only crops it or leaves a border black"));
    }
    let rasterizer = rasterizer_of(variant, request)?;
    Ok(Scene { size, rasterizer, ..Scene::new(variant, given).map_err(runtime_failure)? })
}

/// Why a knob was not set, and which there are.
fn not_set(variant: &Variant, error: &KnobError) -> Failure {
    Failure::Usage(format!("'{}': {error}\n{}", variant.name, knob_list(variant)))
}

/// What is wrong with a file.
fn runtime_failure(error: FileError) -> Failure {
    Failure::Runtime(error.to_string())
}

/// The rasterizer that was asked for, if the variant has a choice.
fn rasterizer_of(variant: &Variant, request: &Request) -> Result<RasterizerChoice, Failure> {
    match (variant.rasterizer, request.rasterizer) {
        (None, Some(_)) => Err(Failure::Usage(format!(
            "'{}' does not use the pipeline: --rasterizer means nothing to it",
            variant.name
        ))),
        (own, asked) => Ok(asked.or(own).unwrap_or_default()),
    }
}

/// Where a model is brought to, and how far it reaches from there; the near plane of the book's view is at z = 2.
const PLACE: (DVec3, f64) = (DVec3::new(0.0, 0.0, 4.0), 1.7);

/// Whether what was given in place of a variant's own model and texture means anything to it.
fn check_model_options(chapter: &Chapter, variant: &Variant, request: &Request) -> Result<(), Failure> {
    let name = variant.name;
    if !variant.has_model() && (request.model.is_some() || request.as_is || request.flat) {
        let others = those(chapter, Variant::has_model, |program| program.has_model);
        return Err(Failure::Usage(format!(
            "'{name}' draws no model: --model, --as-is and --flat mean nothing to it\nModels are drawn by {others}"
        )));
    }
    if !variant.has_texture() && request.texture.is_some() {
        let others = those(chapter, Variant::has_texture, |program| program.has_texture);
        return Err(Failure::Usage(format!(
            "'{name}' draws no texture: --texture means nothing to it\nTextures are drawn by {others}"
        )));
    }
    Ok(())
}

/// The variants of a chapter that do something; if none does, the programs that do.
fn those(chapter: &Chapter, does: fn(&Variant) -> bool, has: fn(&Program) -> bool) -> String {
    let variants: Vec<&str> =
        chapter.variants.iter().filter(|variant| does(variant)).map(|variant| variant.name).collect();
    if !variants.is_empty() {
        return variants.join(", ");
    }
    let programs: Vec<&str> =
        PROGRAMS.iter().filter(|program| has(program)).map(|program| program.name).collect();
    format!("other programs: {}", programs.join(", "))
}

/// Reads what was given in place of a variant's own model and texture.
fn load(request: &Request) -> Result<Given, Failure> {
    let mut warnings = Vec::new();
    let mut model = None;
    if let Some(path) = &request.model {
        let progress = progress_bar(0, "bytes");
        let loaded = Model::load(path, request.normal_style(), |read, total| {
            progress.set_length(total);
            progress.set_position(read);
        });
        progress.finish_and_clear();
        let (loaded, more) = loaded.map_err(runtime_failure)?;
        warnings.extend(more);
        if request.texture.is_some() && !loaded.has_texture_coordinates() {
            let odd = "has no texture coordinates: one texel covers all of it";
            warnings.push(shown(&format!("{}: {odd}", path.display())));
        }
        model = Some(if request.as_is { loaded } else { loaded.fitted(PLACE.0, PLACE.1) });
    }
    let mut texture = None;
    if let Some(path) = &request.texture {
        let (loaded, more) = load_texture(path).map_err(runtime_failure)?;
        warnings.extend(more);
        texture = Some(loaded);
    }
    for warning in warnings {
        note(&format!("warning: {warning}"));
    }
    Ok(Given { model, texture, style: request.normal_style() })
}

/// The frame that was asked for, if the variant has it.
fn frame_of(variant: &Variant, request: &Request) -> Result<u32, Failure> {
    match (request.frame, variant.animation) {
        (None, _) => Ok(0),
        (Some(_), None) => {
            Err(Failure::Usage(format!("'{}' is one picture: it has no frames", variant.name)))
        }
        (Some(frame), Some(animation)) if frame < animation.frames => Ok(frame),
        (Some(frame), Some(animation)) => Err(Failure::Usage(format!(
            "'{}' has no frame {frame}: its frames are 0 to {}",
            variant.name,
            animation.frames - 1
        ))),
    }
}

/// The picture, enlarged if that was asked for.
fn enlarged(picture: Framebuffer, zoom: Option<Zoom>) -> Framebuffer {
    match zoom {
        None => picture,
        Some(zoom) => zoomed(&picture, zoom),
    }
}

/// Whether the pixel around which to zoom is in the picture.
fn check_zoom(size: (u32, u32), zoom: Option<Zoom>) -> Result<(), Failure> {
    zoom.and_then(|zoom| zoom.center).map_or(Ok(()), |pixel| check_inside(size, pixel))
}

fn check_inside((width, height): (u32, u32), (x, y): Pixel) -> Result<(), Failure> {
    if Rect::sized(width, height).contains(x, y) {
        return Ok(());
    }
    Err(Failure::Usage(format!("the pixel {x},{y} is outside the picture of {width}×{height} pixels")))
}

/// The file name of a picture, without extension.
fn name_of(variant: &Variant, request: &Request) -> String {
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

/// If the picture shows nothing of the model: that it does not, and why.
fn unseen(path: &Path, scene: &Scene<'_>, picture: &Framebuffer) -> Option<String> {
    let subject = scene.subject.as_ref()?;
    let without = Subject { model: Model { parts: Vec::new() }, texture: None };
    let empty = scene.variant.draw(&DrawOptions { subject: Some(&without), ..scene.options(None) });
    if difference(picture, &empty).is_none_or(|(_, count)| count > 0) {
        return None;
    }
    let meshes = || subject.model.parts.iter().map(|part| &part.mesh);
    let has_area = meshes().any(|mesh| {
        mesh.triangles().any(|indices| {
            let [a, b, c] = indices.map(|index| mesh.vertices()[index].position);
            (b - a).cross(c - a) != DVec3::ZERO
        })
    });
    let reason = if has_area {
        "its faces turn away from the eye, or lie outside the view; 'turntable' of chapter 10 draws both sides, and \
         all of it (without --as-is the model is brought into the view)"
    } else {
        "its faces have no area"
    };
    Some(shown(&format!("nothing of {} is visible: {reason}", path.display())))
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

/// The knob of a name, if it has a range.
fn sweepable(variant: &Variant, name: &str) -> Result<&'static Knob, Failure> {
    let knob = variant.knobs.iter().find(|knob| knob.name == name);
    let knob = knob.ok_or_else(|| not_set(variant, &KnobError::Unknown(name.to_owned())))?;
    if knob.at(0.0).is_none() {
        return Err(Failure::Usage(format!("'{name}' is {}: it has no range to be swept", knob.range())));
    }
    Ok(knob)
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

/// Two variants that are to be compared: the second takes over the frame, and the knobs that it has too.
fn pair_of<'a>(
    this: &'a Variant,
    that: &'a Variant,
    request: &Request,
) -> Result<(Scene<'a>, Scene<'a>), Failure> {
    let given = load(request)?;
    let first = scene_of(this, request, &given)?;
    let mut second = Scene { frame: first.frame, ..sized(that, request, &given)? };
    second.knobs.take_over(&first.knobs);
    Ok((first, second))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn nothing(_: &mut Framebuffer) {}

    #[test]
    fn hints_for_a_newcomer_and_for_a_wrong_name() {
        const RIGHT: Variant = Variant::new("right", nothing, "what is right").size(640, 480);
        const WRONG: Variant = Variant::new("wrong", nothing, "what is wrong").remedied_by("right");
        let with_mistake = Chapter { name: "ch00", question: "?", variants: &[RIGHT, WRONG] };
        assert_eq!(
            hints(&with_mistake, with_mistake.lead()),
            "right: what is right\n\
             A mistake beside its remedy: cargo run --bin ch00 -- wrong --compare\n\
             What happened at a pixel: cargo run --bin ch00 -- right --inspect 320,240"
        );
        assert_eq!(
            no_such_variant(&with_mistake, "wring"),
            "ch00 has no variant 'wring'; did you mean 'wrong'?\nIt has: right, wrong"
        );
        assert_eq!(
            no_such_variant(&with_mistake, "camera"),
            "ch00 has no variant 'camera'; ch10_matrices_lighting has it\nIt has: right, wrong"
        );
        assert_eq!(no_such_variant(&with_mistake, "x"), "ch00 has no variant 'x'\nIt has: right, wrong");
        let without = Chapter { variants: &[RIGHT], ..with_mistake };
        assert!(
            hints(&without, without.lead())
                .contains("\nWhat else can be drawn: cargo run --bin ch00 -- --list\n")
        );
    }
}
