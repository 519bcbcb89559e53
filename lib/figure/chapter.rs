//! A chapter's table: its variants, each one picture.

use super::canvas::{Canvas, RasterizerChoice};
use super::knob::Knob;
use super::knobs::Knobs;
use super::subject::Subject;
use crate::files::FileError;
use crate::framebuffer::Framebuffer;
use crate::model::NormalStyle;
use crate::observer::SharedObserver;
use crate::probe::SharedProbe;

/// A chapter: the question it asks, and the pictures that answer it.
#[derive(Debug)]
pub struct Chapter {
    /// The name of its program, such as `ch05_perspective_correct`.
    pub name: &'static str,
    /// What the chapter asks, in one sentence.
    pub question: &'static str,
    /// The pictures; the first one is drawn when none is named.
    pub variants: &'static [Variant],
}

impl Chapter {
    /// The variant that is drawn when none is named.
    ///
    /// # Panics
    /// If the table is empty.
    #[must_use]
    pub fn lead(&self) -> &Variant {
        &self.variants[0]
    }

    /// The variant of that name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&Variant> {
        self.variants.iter().find(|variant| variant.name == name)
    }
}

/// What a chapter's `main` calls is in `program`. Where a chapter is drawn by something else, such as a page, there are no
/// arguments to be read, and nothing calls it.
#[cfg(not(feature = "program"))]
impl Chapter {
    /// Does nothing, and fails.
    #[must_use]
    pub const fn main(&self) -> std::process::ExitCode {
        std::process::ExitCode::FAILURE
    }
}

/// One picture that a chapter can draw: a row of its table.
#[derive(Debug)]
pub struct Variant {
    /// How it is called on the command line.
    pub name: &'static str,
    /// What to look for in the picture.
    pub look: &'static str,
    /// Section and figure of the book; empty where the book has none.
    pub source: &'static str,
    /// Width and height in pixels, unless `--size` says otherwise.
    pub size: (u32, u32),
    /// For a deliberate mistake: that it is one, and which variant is its remedy.
    pub mistake: Mistake,
    /// How long and how fast it is, if it is an animation.
    pub animation: Option<Animation>,
    /// The rasterizer, unless `--rasterizer` says otherwise; figures without a pipeline have none.
    pub rasterizer: Option<RasterizerChoice>,
    /// Whether it brings any model into its view by itself, wherever that is.
    pub fits_model: bool,
    /// What can be turned.
    pub knobs: &'static [Knob],
    /// Whether it is about single pixels, and drawn in them whatever the size; all others are scenes, and scale to fit.
    pub in_pixels: bool,
    figure: Figure,
}

/// How a variant is to be drawn.
#[derive(Clone, Debug)]
pub struct DrawOptions<'a> {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The frame of an animation; 0 for one picture.
    pub frame: u32,
    /// The rasterizer of the pipeline, where there is one.
    pub rasterizer: RasterizerChoice,
    /// What it is a picture of, where it draws a model.
    pub subject: Option<&'a Subject>,
    /// What the variant's knobs are set to.
    pub knobs: Knobs,
    /// Who observes, if anybody does.
    pub observer: Option<SharedProbe>,
}

impl DrawOptions<'_> {
    /// What is drawn into: black, and observed.
    fn framebuffer(&self) -> Framebuffer {
        let mut framebuffer = Framebuffer::new(self.size.0, self.size.1);
        framebuffer.set_observer(self.observer.clone().map(|observer| observer as SharedObserver));
        framebuffer
    }

    /// What is drawn on with the pipeline, for a scene that is made for a picture of the proportions of `native`.
    fn canvas(&self, native: (u32, u32)) -> Canvas {
        let mut canvas =
            Canvas::new(&self.framebuffer(), native, self.frame, self.rasterizer, self.observer.clone());
        canvas.knobs = self.knobs.clone();
        canvas
    }
}

/// What draws a picture.
#[derive(Clone, Copy, Debug)]
enum Figure {
    /// Chapters 1 to 8: into a framebuffer.
    Plain(fn(&mut Framebuffer)),
    /// The same, with knobs.
    Turned(fn(&mut Framebuffer, &Knobs)),
    /// Chapter 2, of a model.
    PlainModel(fn(&mut Framebuffer, &Subject), Assets),
    /// From chapter 9 on: with the pipeline.
    Canvas(fn(&mut Canvas)),
    /// The same, of a model.
    Model(fn(&mut Canvas, &Subject), Assets),
}

/// The model and the texture that are drawn when none is given: names of files in `assets/`.
#[derive(Clone, Copy, Debug)]
struct Assets {
    model: &'static str,
    texture: &'static str,
}

/// How long an animation is, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Animation {
    /// The number of frames; they are numbered from 0.
    pub frames: u32,
    /// Frames in a second.
    pub rate: u32,
}

impl Animation {
    /// A knob that goes once through its range.
    pub const SWEEP: Self = Self { frames: 60, rate: 20 };
}

/// Whether a variant is a deliberate mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// It is right.
    No,
    /// It is wrong, and this variant of the same chapter is its remedy.
    RemediedBy(&'static str),
    /// It is wrong, and the chapter has no remedy for it.
    WithoutRemedy,
}

impl Variant {
    /// A right picture of 640×480 pixels, drawn into a framebuffer.
    #[must_use]
    pub const fn new(name: &'static str, draw: fn(&mut Framebuffer), look: &'static str) -> Self {
        Self::of(name, Figure::Plain(draw), look)
    }

    /// The same with knobs, which the drawing function reads.
    #[must_use]
    pub const fn with_knobs(
        name: &'static str,
        draw: fn(&mut Framebuffer, &Knobs),
        knobs: &'static [Knob],
        look: &'static str,
    ) -> Self {
        Self::of(name, Figure::Turned(draw), look).knobs(knobs)
    }

    /// The same, drawn with the pipeline; knobs are read from the canvas.
    #[must_use]
    pub const fn with_pipeline(name: &'static str, draw: fn(&mut Canvas), look: &'static str) -> Self {
        Self::of(name, Figure::Canvas(draw), look)
    }

    /// The same of a model; which one, `--model` can change.
    #[must_use]
    pub const fn of_model(
        name: &'static str,
        draw: fn(&mut Canvas, &Subject),
        [model, texture]: [&'static str; 2],
        look: &'static str,
    ) -> Self {
        Self::of(name, Figure::Model(draw, Assets { model, texture }), look)
    }

    /// A picture of a model without the pipeline.
    #[must_use]
    pub const fn of_model_in_plane(
        name: &'static str,
        draw: fn(&mut Framebuffer, &Subject),
        [model, texture]: [&'static str; 2],
        look: &'static str,
    ) -> Self {
        Self::of(name, Figure::PlainModel(draw, Assets { model, texture }), look)
    }

    const fn of(name: &'static str, figure: Figure, look: &'static str) -> Self {
        let rasterizer = match figure {
            Figure::Plain(_) | Figure::Turned(_) | Figure::PlainModel(..) => None,
            Figure::Canvas(_) | Figure::Model(..) => Some(RasterizerChoice::Scanline),
        };
        let (source, mistake) = ("", Mistake::No);
        let (size, in_pixels, fits_model) = ((640, 480), false, false);
        Self {
            name,
            look,
            source,
            size,
            mistake,
            animation: None,
            rasterizer,
            knobs: &[],
            in_pixels,
            fits_model,
            figure,
        }
    }

    /// The same, with the exact rasterizer.
    ///
    /// # Panics
    /// If it does not use the pipeline.
    #[must_use]
    pub const fn exact(self) -> Self {
        assert!(self.rasterizer.is_some(), "only the pipeline has a choice of rasterizers");
        Self { rasterizer: Some(RasterizerChoice::Exact), ..self }
    }

    /// The same, with the fast rasterizer, or with the exact one, which draws the same, where it is not built in.
    ///
    /// # Panics
    /// If it does not use the pipeline.
    #[must_use]
    pub const fn tiled(self) -> Self {
        assert!(self.rasterizer.is_some(), "only the pipeline has a choice of rasterizers");
        Self { rasterizer: Some(RasterizerChoice::FASTEST), ..self }
    }

    /// The same, as an animation: the canvas says which frame to draw, and each can be drawn by itself.
    ///
    /// # Panics
    /// If it has no frames, or none a second.
    #[must_use]
    pub const fn animated(self, animation: Animation) -> Self {
        assert!(animation.frames > 0 && animation.rate > 0, "an animation has frames, and they move");
        Self { animation: Some(animation), ..self }
    }

    /// The same, bringing any model into its view by itself.
    #[must_use]
    pub const fn fits_model(self) -> Self {
        Self { fits_model: true, ..self }
    }

    /// The same, with knobs.
    ///
    /// # Panics
    /// If the drawing function gets none: [`Self::with_knobs`] is for figures without the pipeline.
    #[must_use]
    pub const fn knobs(self, knobs: &'static [Knob]) -> Self {
        assert!(
            !matches!(self.figure, Figure::Plain(_) | Figure::PlainModel(..)),
            "its drawing function reads no knobs"
        );
        Self { knobs, ..self }
    }

    /// The same, of another size in pixels.
    #[must_use]
    pub const fn size(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// The same, but about single pixels: another size crops it or leaves a border, and does not scale it.
    #[must_use]
    pub const fn in_pixels(self) -> Self {
        Self { in_pixels: true, ..self }
    }

    /// The same, with its section and figure of the book.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// The same, but a mistake whose remedy is another variant.
    #[must_use]
    pub const fn remedied_by(self, remedy: &'static str) -> Self {
        Self { mistake: Mistake::RemediedBy(remedy), ..self }
    }

    /// The same, but a mistake without a remedy in its chapter.
    #[must_use]
    pub const fn without_remedy(self) -> Self {
        Self { mistake: Mistake::WithoutRemedy, ..self }
    }

    /// Whether `--texture` means anything to it.
    #[must_use]
    pub const fn has_texture(&self) -> bool {
        matches!(self.figure, Figure::Model(..))
    }

    /// Whether `--model` means anything to it.
    #[must_use]
    pub const fn has_model(&self) -> bool {
        matches!(self.figure, Figure::Model(..) | Figure::PlainModel(..))
    }

    /// Its own model and texture, if it draws one.
    ///
    /// # Errors
    /// If the table names files that are not in `assets/`.
    pub fn subject(&self) -> Result<Option<Subject>, FileError> {
        self.subject_with(NormalStyle::Smooth)
    }

    /// The same, the model with normals of a style.
    ///
    /// # Errors
    /// As [`Self::subject`].
    pub fn subject_with(&self, style: NormalStyle) -> Result<Option<Subject>, FileError> {
        match self.figure {
            Figure::Plain(_) | Figure::Turned(_) | Figure::Canvas(_) => Ok(None),
            Figure::PlainModel(_, Assets { model, texture })
            | Figure::Model(_, Assets { model, texture }) => {
                Subject::of_assets(model, texture, style).map(Some)
            }
        }
    }

    /// How it is drawn when nothing else is said: its own size and rasterizer, the first frame.
    #[must_use]
    pub fn options<'a>(&self, subject: Option<&'a Subject>) -> DrawOptions<'a> {
        let rasterizer = self.rasterizer.unwrap_or_default();
        let knobs = Knobs::new(self.knobs, self.size);
        DrawOptions { size: self.size, frame: 0, rasterizer, subject, knobs, observer: None }
    }

    /// Draws the picture; without a subject, a variant that draws one stays black.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn draw(&self, options: &DrawOptions<'_>) -> Framebuffer {
        let in_plane = |draw: &dyn Fn(&mut Framebuffer)| {
            let mut framebuffer = options.framebuffer();
            draw(&mut framebuffer);
            framebuffer
        };
        let on_canvas = |draw: &dyn Fn(&mut Canvas)| {
            let mut canvas = options.canvas(self.size);
            draw(&mut canvas);
            canvas.into_picture()
        };
        match (self.figure, options.subject) {
            (Figure::Plain(draw), _) => in_plane(&draw),
            (Figure::Turned(draw), _) => in_plane(&|picture| draw(picture, &options.knobs)),
            (Figure::PlainModel(draw, _), Some(subject)) => in_plane(&|picture| draw(picture, subject)),
            (Figure::Canvas(draw), _) => on_canvas(&draw),
            (Figure::Model(draw, _), Some(subject)) => on_canvas(&|canvas| draw(canvas, subject)),
            (Figure::PlainModel(..) | Figure::Model(..), None) => options.framebuffer(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::color::Color;
    use crate::observer::Observer;
    use crate::probe::Probe;

    #[test]
    fn only_a_picture_of_a_model_has_a_subject() {
        let of_model = Variant::of_model("model", |_, _| {}, ["cube.obj", "wood.png"], "-");
        let subject = of_model.subject().expect("in assets/").expect("a model");
        assert_eq!(subject.model.triangle_count(), 12);
        assert_eq!(subject.texture.map(|texture| texture.width()), Some(128));
        let missing = Variant::of_model_in_plane("missing", |_, _| {}, ["teapot.obj", "wood.png"], "-");
        assert!(missing.subject().is_err());
        assert!(Variant::new("plain", |_| {}, "-").subject().expect("no file").is_none());
    }

    const RED: fn(&mut Framebuffer) = |picture| picture.clear(Color::RED);
    const GREEN: fn(&mut Canvas) = |canvas| canvas.picture_mut().clear(Color::GREEN);
    const KNOBS: &[Knob] = &[Knob::number("gray", 9.0, [0.0, 255.0], "", "brighter")];

    #[test]
    fn a_variant_is_what_its_table_says() {
        let plain = Variant::new("plain", RED, "red");
        assert_eq!((plain.name, plain.look, plain.source, plain.size), ("plain", "red", "", (640, 480)));
        assert_eq!((plain.mistake, plain.animation, plain.rasterizer), (Mistake::No, None, None));
        assert!(plain.knobs.is_empty() && !plain.in_pixels && !plain.fits_model);

        let plain = plain.size(3, 2).in_pixels().source("section 1").remedied_by("other");
        assert_eq!((plain.size, plain.in_pixels, plain.source), ((3, 2), true, "section 1"));
        assert_eq!(plain.mistake, Mistake::RemediedBy("other"));
        assert_eq!(plain.without_remedy().mistake, Mistake::WithoutRemedy);

        let canvas = || Variant::with_pipeline("canvas", GREEN, "-");
        assert_eq!(canvas().rasterizer, Some(RasterizerChoice::Scanline));
        assert_eq!(canvas().exact().rasterizer, Some(RasterizerChoice::Exact));
        assert_eq!(canvas().tiled().rasterizer, Some(RasterizerChoice::FASTEST));
        assert_eq!(canvas().animated(Animation::SWEEP).animation, Some(Animation::SWEEP));
        assert_eq!(canvas().knobs(KNOBS).knobs.len(), 1);
        assert!(canvas().fits_model().fits_model);
    }

    #[test]
    fn models_and_textures_mean_something_to_some() {
        let of_model = Variant::of_model("model", |_, _| {}, ["cube.obj", "wood.png"], "-");
        let in_plane = Variant::of_model_in_plane("plane", |_, _| {}, ["cube.obj", "wood.png"], "-");
        let plain = Variant::new("plain", RED, "-");
        let both = |variant: &Variant| (variant.has_model(), variant.has_texture());
        assert_eq!([&of_model, &in_plane, &plain].map(both), [(true, true), (true, false), (false, false)]);
    }

    #[test]
    fn each_kind_of_figure_is_drawn_and_observed() {
        #[derive(Debug, Default)]
        struct Cleared(AtomicUsize);
        impl Observer for Cleared {
            fn cleared(&self, _color: Color) {
                self.0.fetch_add(1, Ordering::Relaxed);
            }
        }
        impl Probe for Cleared {}

        let gray =
            |picture: &mut Framebuffer, knobs: &Knobs| picture.clear(Color::gray(knobs.number("gray") as u8));
        let of_model = |canvas: &mut Canvas, _: &Subject| canvas.picture_mut().clear(Color::BLUE);
        let in_plane = |picture: &mut Framebuffer, _: &Subject| picture.clear(Color::WHITE);
        let assets = ["cube.obj", "wood.png"];
        let variants = [
            (Variant::new("plain", RED, "-"), Color::RED),
            (Variant::with_knobs("turned", gray, KNOBS, "-"), Color::gray(9)),
            (Variant::with_pipeline("canvas", GREEN, "-"), Color::GREEN),
            (Variant::of_model("model", of_model, assets, "-"), Color::BLUE),
            (Variant::of_model_in_plane("plane", in_plane, assets, "-"), Color::WHITE),
        ];
        for (variant, color) in variants {
            let (variant, observer) = (variant.size(4, 3), Arc::new(Cleared::default()));
            let subject = variant.subject().expect("in assets/");
            let options = variant.options(subject.as_ref());
            assert_eq!((options.size, options.frame, options.knobs.changed().is_empty()), ((4, 3), 0, true));
            let picture = variant.draw(&DrawOptions { observer: Some(observer.clone()), ..options });
            assert_eq!((picture.width(), picture.height(), picture.get(3, 2)), (4, 3, Some(color)));
            assert_eq!(observer.0.load(Ordering::Relaxed), 1, "{}", variant.name);
            let expected = if variant.has_model() { Color::BLACK } else { color };
            assert_eq!(variant.draw(&variant.options(None)).get(3, 2), Some(expected), "without its subject");
        }
    }

    #[test]
    fn a_chapter_finds_its_variants() {
        static VARIANTS: [Variant; 2] = [Variant::new("first", RED, "-"), Variant::new("second", RED, "-")];
        let chapter = Chapter { name: "ch00", question: "?", variants: &VARIANTS };
        assert_eq!(chapter.lead().name, "first");
        assert_eq!(chapter.find("second").map(|variant| variant.name), Some("second"));
        assert!(chapter.find("third").is_none());
    }
}
