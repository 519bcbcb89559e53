//! What to draw: the one notion of it that the command line, the window and a page share.

use super::canvas::RasterizerChoice;
use super::chapter::{DrawOptions, Variant};
use super::knobs::Knobs;
use super::subject::Subject;
use crate::files::FileError;
use crate::framebuffer::Framebuffer;
use crate::model::{Model, NormalStyle};
use crate::probe::SharedProbe;
use crate::texture::Texture;

/// A variant as it is asked for: everything that its picture depends on.
#[derive(Clone, Debug)]
pub struct Scene<'a> {
    /// The variant.
    pub variant: &'a Variant,
    /// What its knobs are set to.
    pub knobs: Knobs,
    /// Which frame of an animation; 0 for one picture.
    pub frame: u32,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The rasterizer, where it has a choice.
    pub rasterizer: RasterizerChoice,
    /// What it is a picture of, where it draws a model.
    pub subject: Option<Subject>,
}

/// What is drawn in place of the variants' own models and textures.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// In place of their models.
    pub model: Option<Model>,
    /// In place of their textures.
    pub texture: Option<Texture>,
    /// The normals of a variant's own model.
    pub style: NormalStyle,
}

impl<'a> Scene<'a> {
    /// A variant at its own size, with its own rasterizer and its knobs at their defaults, of what is given.
    ///
    /// # Errors
    /// As [`Variant::subject`].
    pub fn new(variant: &'a Variant, given: &Given) -> Result<Self, FileError> {
        let subject = match &given.model {
            Some(model) if variant.has_model() => {
                Some(Subject { model: model.clone(), texture: given.texture.clone() })
            }
            // The chapters' own models are where they should be, and have their own texture.
            _ => variant
                .subject_with(given.style)?
                .map(|own| Subject { texture: given.texture.clone().or(own.texture), ..own }),
        };
        let DrawOptions { size, frame, rasterizer, knobs, .. } = variant.options(None);
        Ok(Self { variant, knobs, frame, size, rasterizer, subject })
    }

    /// The same as options of drawing, with somebody who observes, if anybody does.
    #[must_use]
    pub fn options(&self, observer: Option<SharedProbe>) -> DrawOptions<'_> {
        let Self { size, frame, rasterizer, ref knobs, .. } = *self;
        DrawOptions {
            size,
            frame,
            rasterizer,
            subject: self.subject.as_ref(),
            knobs: knobs.clone(),
            observer,
        }
    }

    /// Draws it.
    ///
    /// # Panics
    /// As [`Framebuffer::new`] does.
    #[must_use]
    pub fn draw(&self) -> Framebuffer {
        self.variant.draw(&self.options(None))
    }
}
