//! What the figures of the later chapters draw on: a target, and the pipeline laid into the middle of it.

use std::sync::Arc;

use super::{Failure, Sitting};
use crate::depth::Target;
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::model::{Model, Part};
use crate::pipeline::{RenderState, draw};
use crate::probe::{Listener, Probe, Silent};
use crate::raster::Scanline;
use crate::shader::Shader;
use crate::texture::Texture;
use crate::tiled::Tiled;
use crate::transform::Viewport;
use crate::{Color, Framebuffer};

/// Which rasterizer the pipeline ends with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RasterizerChoice {
    /// The book's, [`Scanline`].
    #[default]
    Scanline,
    /// The exact one in double precision, [`Exact`].
    Edge,
    /// The fast one, [`Tiled`]; while somebody listens, [`Exact`] in single precision, which draws the same.
    Tiled,
}

impl RasterizerChoice {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Scanline, Self::Edge, Self::Tiled];

    /// How it is called on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scanline => "scanline",
            Self::Edge => "edge",
            Self::Tiled => "tiled",
        }
    }
}

/// A picture in the making.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// What is drawn into; it comes uncleared.
    pub target: Target,
    /// The number of the frame, 0 if the picture is no animation.
    pub frame: u32,
    rasterizer: RasterizerChoice,
    /// Who listens to the pipeline; the target carries the same listener.
    listener: Option<Listener>,
    tiled: Arc<Tiled>,
    aspect: f64,
}

impl Canvas {
    /// A canvas of some size for a scene that is made for a picture of the proportions of `native`.
    pub(super) fn new(sitting: &Sitting<'_>, native: (u32, u32)) -> Self {
        let aspect = f64::from(native.0) / f64::from(native.1);
        let (width, height) = sitting.size;
        let mut framebuffer = Framebuffer::new(width, height);
        framebuffer.listen(sitting.listener.clone());
        let target = Target::like(&framebuffer);
        let Sitting { frame, rasterizer, listener, .. } = sitting.clone();
        Self { target, frame, rasterizer, listener, tiled: Arc::default(), aspect }
    }

    pub(super) fn into_picture(self) -> Framebuffer {
        self.target.color
    }

    /// Where the scene is: as large as it fits, its proportions kept.
    #[must_use]
    pub fn viewport(&self) -> Viewport {
        Viewport::fitting(self.target.color.rect(), self.aspect)
    }

    /// One of `count` panels side by side, counted from the left.
    #[must_use]
    pub fn panel(&self, index: u32, count: u32) -> Viewport {
        let whole = self.viewport();
        let width = whole.width / f64::from(count);
        Viewport { x: whole.x + width * f64::from(index), width, ..whole }
    }

    /// Gives all pixels the color and the depth that the state names.
    pub fn clear(&mut self, state: &RenderState) {
        self.target.clear(state.clear_color, state.clear_depth);
    }

    // ANCHOR: draw
    /// Draws a mesh with the pipeline, into the viewport of the state or else into that of the canvas.
    pub fn draw<S: Shader<N>, const N: usize>(
        &mut self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
    ) {
        let viewport = Some(state.viewport.unwrap_or_else(|| self.viewport()));
        let state = &RenderState { viewport, ..*state };
        let listener = self.listener.clone();
        // One type for both, so that the pipeline is compiled once for each shader, not twice.
        let probe: &dyn Probe = listener.as_deref().map_or(&Silent, |listener| listener);
        let target = &mut self.target;
        match self.rasterizer {
            RasterizerChoice::Scanline => draw(mesh, shader, state, &Scanline, target, probe),
            RasterizerChoice::Edge => draw(mesh, shader, state, &Exact::<f64>::new(), target, probe),
            RasterizerChoice::Tiled => {
                // Depths are of single precision there; numbers that come from it lose nothing on the way.
                let mut single = target.with_depths_of::<f32>();
                if listener.is_some() {
                    draw(mesh, shader, state, &Exact::<f32>::new(), &mut single, probe);
                } else {
                    draw(mesh, shader, state, self.tiled.as_ref(), &mut single, probe);
                }
                *target = single.with_depths_of::<f64>();
            }
        }
    }
    // ANCHOR_END: draw

    /// Clears, then draws a mesh.
    pub fn render<S: Shader<N>, const N: usize>(
        &mut self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
    ) {
        self.clear(state);
        self.draw(mesh, shader, state);
    }
}

/// What a picture is of: a model and how it is covered.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The model, about (0, 0, 4).
    pub model: Model,
    /// The texture that was given; it covers what the model's file says.
    pub texture: Option<Texture>,
}

impl Subject {
    /// A model of `assets/` with a texture of `assets/`.
    ///
    /// # Errors
    /// If there are no such files.
    pub fn of_assets(model: &str, texture: &str) -> Result<Self, Failure> {
        let failure = |error: crate::files::FileError| Failure::Runtime(error.to_string());
        let model = super::assets::model(model).map_err(failure)?;
        let texture = super::assets::texture(texture).map_err(failure)?;
        Ok(Self { model, texture: Some(texture) })
    }

    /// The texture of a part: the one that was given, or its material's, or plain gray.
    #[must_use]
    pub fn texture_of(&self, part: &Part) -> Texture {
        let given = self.texture.as_ref().or(part.texture.as_ref());
        given.cloned().unwrap_or_else(|| Texture::new(1, 1, vec![Color::gray(200)]))
    }
}
