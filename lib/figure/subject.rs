//! What a figure draws when it draws a model.

use super::assets;
use crate::color::Color;
use crate::files::FileError;
use crate::model::{Model, NormalStyle, Part};
use crate::texture::Texture;

/// What a picture is of: a model and how it is covered.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The model, about (0, 0, 4).
    pub model: Model,
    /// The texture that was given; it covers what the model's file says.
    pub texture: Option<Texture>,
}

impl Subject {
    /// A model of `assets/`, with normals of a style and a texture of `assets/`.
    ///
    /// # Errors
    /// If there are no such files.
    pub fn of_assets(model: &str, texture: &str, style: NormalStyle) -> Result<Self, FileError> {
        Ok(Self { model: assets::model_with(model, style)?, texture: Some(assets::texture(texture)?) })
    }

    /// The texture of a part: the one that was given, or its material's, or plain gray.
    #[must_use]
    pub fn texture_of(&self, part: &Part) -> Texture {
        let given = self.texture.as_ref().or(part.texture.as_ref());
        given.cloned().unwrap_or_else(|| Texture::new(1, 1, vec![Color::gray(200)]))
    }
}
