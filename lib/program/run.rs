//! What a chapter's program does with its arguments.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use glam::DVec3;

use super::animation::{encode, progress_bar};
use super::arguments::{Comparison, Format, Request, list};
use super::failure::Failure;
use super::output::{Destination, note, say};
use super::programs::PROGRAMS;
use super::show::Screen;
use crate::figure::picture::{Zoom, difference, side_by_side, zoomed};
use crate::figure::{Chapter, DrawOptions, Mistake, RasterizerChoice, Subject, Variant};
use crate::files::{FileError, load_texture, shown};
use crate::framebuffer::Framebuffer;
use crate::inspect::{Steps, history};
use crate::model::Model;
use crate::rect::{Pixel, Rect};
use crate::texture::Texture;

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
        Err(error) => {
            // Help goes to standard output, errors to standard error; a closed pipe is not worth a word.
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match run(chapter, &request) {
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
        return say(list(chapter).trim_end());
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
        return chapter.variants.iter().try_for_each(|variant| draw_one(variant, request, &destination));
    }
    let variant = match &request.variant {
        Some(name) => find(chapter, name)?,
        None => unnamed(chapter, request),
    };
    if let Some(pixel) = request.inspect {
        return inspect_pixel(chapter, variant, request, pixel);
    }
    if request.steps || request.overdraw {
        return draw_recorded(variant, request, &destination);
    }
    match &request.compare {
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
            draw_comparison(variant, other(chapter, variant, comparison)?, request, &destination)
        }
    }
}

/// The variant for those who have named none: the lead, or the first that can draw what was given instead of its own.
fn unnamed<'a>(chapter: &'a Chapter, request: &Request) -> &'a Variant {
    let accepts = |variant: &&Variant| check_model_options(variant, request).is_ok();
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

/// A variant as it was asked for: its size, its rasterizer, and what it is a picture of.
struct Job<'a> {
    variant: &'a Variant,
    size: (u32, u32),
    rasterizer: RasterizerChoice,
    subject: Option<Subject>,
}

impl<'a> Job<'a> {
    fn new(variant: &'a Variant, request: &Request, given: &Given) -> Result<Self, Failure> {
        let size = request.size.unwrap_or(variant.size);
        check_zoom(size, request.zoom)?;
        let own = variant.subject_with(request.normal_style()).map_err(runtime_failure)?;
        let subject = own.map(|own| match &given.model {
            // The chapters' own models are where they should be, and have their own texture.
            None => Subject { texture: given.texture.clone().or(own.texture), ..own },
            Some(model) => Subject { model: model.clone(), texture: given.texture.clone() },
        });
        let rasterizer = rasterizer_of(variant, request)?;
        Ok(Self { variant, size, rasterizer, subject })
    }

    fn draw(&self, frame: u32) -> Framebuffer {
        self.variant.draw(&self.options(frame))
    }

    fn options(&self, frame: u32) -> DrawOptions<'_> {
        let (size, rasterizer, subject) = (self.size, self.rasterizer, self.subject.as_ref());
        DrawOptions { size, frame, rasterizer, subject, observer: None }
    }
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

fn check_model_options(variant: &Variant, request: &Request) -> Result<(), Failure> {
    if !variant.has_model() && (request.model.is_some() || request.as_is || request.flat) {
        let reason =
            format!("'{}' draws no model: --model, --as-is and --flat mean nothing to it", variant.name);
        return Err(Failure::Usage(reason));
    }
    if !variant.has_texture() && request.texture.is_some() {
        return Err(Failure::Usage(format!(
            "'{}' draws no texture: --texture means nothing to it",
            variant.name
        )));
    }
    Ok(())
}

/// What was given in place of a variant's own model and texture.
struct Given {
    model: Option<Model>,
    texture: Option<Texture>,
}

impl Given {
    /// Reads what was given, if it means something to all variants.
    fn load(request: &Request, variants: &[&Variant]) -> Result<Self, Failure> {
        for variant in variants {
            check_model_options(variant, request)?;
        }
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
        Ok(Self { model, texture })
    }
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
    format!("{}{frame}{rasterizer}{zoom}", variant.name)
}

fn draw_one(variant: &Variant, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let frame = frame_of(variant, request)?;
    let job = Job::new(variant, request, &Given::load(request, &[variant])?)?;
    let picture = enlarged(job.draw(frame), request.zoom);
    destination.write(&name_of(variant, request), &picture)?;
    if let Some(zoom) = request.zoom {
        note(&shown_by(zoom, job.size));
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
    let job = Job::new(variant, request, &Given::load(request, &[variant])?)?;
    let draw = |frame| enlarged(job.draw(frame), request.zoom);
    destination.write_animation(&name_of(variant, request), |format| encode(format, animation, &draw))
}

/// Prints the history of a pixel; nothing is written but text.
fn inspect_pixel(
    chapter: &Chapter,
    variant: &Variant,
    request: &Request,
    pixel: Pixel,
) -> Result<(), Failure> {
    let frame = frame_of(variant, request)?;
    let job = Job::new(variant, request, &Given::load(request, &[variant])?)?;
    check_inside(job.size, pixel)?;
    let history = history(chapter.name, variant, &job.options(frame), pixel);
    if request.format == Format::Json {
        return say(&history.to_json());
    }
    let history = if request.verbose { history } else { history.without_misses() };
    say(&history.to_string())
}

/// Draws how a picture came about: step by step, or how often each pixel was written.
fn draw_recorded(variant: &Variant, request: &Request, destination: &Destination) -> Result<(), Failure> {
    let frame = frame_of(variant, request)?;
    let job = Job::new(variant, request, &Given::load(request, &[variant])?)?;
    let steps = Steps::new(variant, &job.options(frame));
    if request.steps {
        let draw = |number| enlarged(steps.frame(number), request.zoom);
        let name = format!("{}-steps", name_of(variant, request));
        return destination.write_animation(&name, |format| encode(format, steps.animation(), &draw));
    }
    let (heat, legend) = steps.overdraw();
    note(&legend.join("\n"));
    let name = format!("{}-overdraw", name_of(variant, request));
    destination.write(&name, &enlarged(heat, request.zoom))
}

fn draw_comparison(
    this: &Variant,
    that: &Variant,
    request: &Request,
    destination: &Destination,
) -> Result<(), Failure> {
    let frame = frame_of(this, request)?;
    let given = Given::load(request, &[this, that])?;
    let first = Job::new(this, request, &given)?.draw(frame);
    let second = Job::new(that, request, &given)?.draw(frame);
    let Some((marked, count)) = difference(&first, &second) else {
        let reason = format!("'{}' and '{}' differ in size: give --size", this.name, that.name);
        return Err(Failure::Usage(reason));
    };
    let total = first.width() as usize * first.height() as usize;
    let panels = [first, second, marked].map(|panel| enlarged(panel, request.zoom));
    let picture = side_by_side(&panels).ok_or_else(|| {
        Failure::Usage("three such pictures are too wide: give a smaller --size".to_owned())
    })?;
    destination.write(&format!("{}--{}", name_of(this, request), that.name), &picture)?;
    note(&format!("{count} of {total} pixels differ"));
    Ok(())
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
