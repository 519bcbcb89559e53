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
    draw: fn(&mut Framebuffer),
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
        Self { name, look, source: "", size: (640, 480), mistake: Mistake::No, draw }
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

    /// Draws the picture into a new framebuffer of the given size in pixels.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn draw(&self, width: u32, height: u32) -> Framebuffer {
        let mut framebuffer = Framebuffer::new(width, height);
        (self.draw)(&mut framebuffer);
        framebuffer
    }
}
