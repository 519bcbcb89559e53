//! A chapter's table: its variants, each one picture.

use std::process::ExitCode;

use super::run;
use crate::Framebuffer;

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
    /// The whole program: reads the arguments, draws, writes, reports.
    #[must_use]
    pub fn main(&self) -> ExitCode {
        run::main(self)
    }

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
    /// For a deliberate mistake: that it is one, and which variant mends it.
    pub mistake: Mistake,
    figure: Figure,
}

/// What draws a picture.
#[derive(Clone, Copy, Debug)]
enum Figure {
    Still(fn(&mut Framebuffer)),
    /// Its second argument is the number of the frame.
    Animated(fn(&mut Framebuffer, u32), Animation),
}

/// How long an animation is, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Animation {
    /// The number of frames; they are numbered from 0.
    pub frames: u32,
    /// Frames in a second.
    pub rate: u32,
}

/// Whether a variant is a deliberate mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// It is right.
    No,
    /// It is wrong, and this variant of the same chapter is its remedy.
    MendedBy(&'static str),
    /// It is wrong, and the chapter has no remedy for it.
    Unmended,
}

impl Variant {
    /// A right picture of 640×480 pixels.
    #[must_use]
    pub const fn new(name: &'static str, draw: fn(&mut Framebuffer), look: &'static str) -> Self {
        Self { name, look, source: "", size: (640, 480), mistake: Mistake::No, figure: Figure::Still(draw) }
    }

    /// An animation of 640×480 pixels; `draw` gets the number of a frame, and each frame can be drawn by itself.
    #[must_use]
    pub const fn animated(
        name: &'static str,
        draw: fn(&mut Framebuffer, u32),
        animation: Animation,
        look: &'static str,
    ) -> Self {
        let figure = Figure::Animated(draw, animation);
        Self { name, look, source: "", size: (640, 480), mistake: Mistake::No, figure }
    }

    /// The same, of another size in pixels.
    #[must_use]
    pub const fn size(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// The same, with its section and figure of the book.
    #[must_use]
    pub const fn source(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// The same, but a mistake that another variant mends.
    #[must_use]
    pub const fn mended_by(self, remedy: &'static str) -> Self {
        Self { mistake: Mistake::MendedBy(remedy), ..self }
    }

    /// The same, but a mistake without a remedy in its chapter.
    #[must_use]
    pub const fn unmended(self) -> Self {
        Self { mistake: Mistake::Unmended, ..self }
    }

    /// How long and how fast it is, if it is an animation.
    #[must_use]
    pub const fn animation(&self) -> Option<Animation> {
        match self.figure {
            Figure::Still(_) => None,
            Figure::Animated(_, animation) => Some(animation),
        }
    }

    /// Draws the picture, or a frame of the animation, into a new framebuffer of the given size in pixels.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn draw(&self, (width, height): (u32, u32), frame: u32) -> Framebuffer {
        let mut framebuffer = Framebuffer::new(width, height);
        match self.figure {
            Figure::Still(draw) => draw(&mut framebuffer),
            Figure::Animated(draw, _) => draw(&mut framebuffer, frame),
        }
        framebuffer
    }
}
