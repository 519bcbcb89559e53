//! What the figures of the later chapters draw on: a target, and the pipeline with its viewport in the middle.

use super::knobs::Knobs;
use crate::exact::Exact;
use crate::framebuffer::Framebuffer;
use crate::mesh::Mesh;
use crate::pipeline::draw;
use crate::probe::{Probe, SharedProbe, Silent};
use crate::raster::Scanline;
use crate::shader::Shader;
use crate::state::{LoadOp, RenderState};
use crate::target::Target;
#[cfg(feature = "tiled")]
use crate::tiled::Tiled;
use crate::transform::Viewport;

/// Which rasterizer the pipeline ends with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RasterizerChoice {
    /// The book's, [`Scanline`].
    #[default]
    Scanline,
    /// The exact one in double precision, [`Exact`].
    Exact,
    /// The fast one, [`Tiled`]; while somebody observes, [`Exact`] in single precision, which draws the same.
    #[cfg(feature = "tiled")]
    Tiled,
}

impl RasterizerChoice {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Scanline,
        Self::Exact,
        #[cfg(feature = "tiled")]
        Self::Tiled,
    ];

    /// The fastest of them.
    #[cfg(feature = "tiled")]
    pub const FASTEST: Self = Self::Tiled;
    /// The fastest of them.
    #[cfg(not(feature = "tiled"))]
    pub const FASTEST: Self = Self::Exact;

    /// How it is called on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scanline => "scanline",
            Self::Exact => "exact",
            #[cfg(feature = "tiled")]
            Self::Tiled => "tiled",
        }
    }
}

/// A rasterizer, and a target of the precision in which it computes.
#[derive(Debug)]
enum Drawing {
    Scanline(Target),
    Exact(Target),
    #[cfg(feature = "tiled")]
    Tiled(Target<f32>, Tiled),
}

/// A picture in the making.
#[derive(Debug)]
pub struct Canvas {
    /// The number of the frame, 0 if the picture is no animation.
    pub frame: u32,
    /// What the variant's knobs are set to.
    pub knobs: Knobs,
    /// The target is not cleared at first.
    drawing: Drawing,
    /// Who observes the pipeline; the target carries the same observer.
    observer: Option<SharedProbe>,
    aspect: f64,
}

impl Canvas {
    /// A canvas like an empty framebuffer, for a scene that is made for a picture of the proportions of `native`.
    pub(super) fn new(
        framebuffer: &Framebuffer,
        native: (u32, u32),
        frame: u32,
        rasterizer: RasterizerChoice,
        observer: Option<SharedProbe>,
    ) -> Self {
        let aspect = f64::from(native.0) / f64::from(native.1);
        let drawing = match rasterizer {
            RasterizerChoice::Scanline => Drawing::Scanline(Target::like(framebuffer)),
            RasterizerChoice::Exact => Drawing::Exact(Target::like(framebuffer)),
            #[cfg(feature = "tiled")]
            RasterizerChoice::Tiled => Drawing::Tiled(Target::like(framebuffer), Tiled::new()),
        };
        Self { frame, knobs: Knobs::default(), drawing, observer, aspect }
    }

    pub(super) fn into_picture(self) -> Framebuffer {
        match self.drawing {
            Drawing::Scanline(target) | Drawing::Exact(target) => target.color,
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, _) => target.color,
        }
    }

    /// The picture so far.
    #[must_use]
    pub const fn picture(&self) -> &Framebuffer {
        match &self.drawing {
            Drawing::Scanline(target) | Drawing::Exact(target) => &target.color,
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, _) => &target.color,
        }
    }

    /// The picture so far, to be drawn into.
    pub const fn picture_mut(&mut self) -> &mut Framebuffer {
        match &mut self.drawing {
            Drawing::Scanline(target) | Drawing::Exact(target) => &mut target.color,
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, _) => &mut target.color,
        }
    }

    /// Where the scene is: as large as it fits, its proportions kept.
    #[must_use]
    pub fn viewport(&self) -> Viewport {
        Viewport::fitting(self.picture().rect(), self.aspect)
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
        match &mut self.drawing {
            Drawing::Scanline(target) | Drawing::Exact(target) => state.clear(target),
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, _) => state.clear(target),
        }
    }

    // ANCHOR: draw
    /// Draws a mesh with the pipeline, into the viewport of the state or else into that of the
    /// canvas.
    pub fn draw<S: Shader<N>, const N: usize>(
        &mut self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
    ) {
        let viewport = Some(state.viewport.unwrap_or_else(|| self.viewport()));
        let state = &RenderState { viewport, ..*state };
        // One type for both, so that the pipeline is compiled once for each shader, not twice.
        let probe: &dyn Probe = self.observer.as_deref().map_or(&Silent, |observer| observer);
        match &mut self.drawing {
            Drawing::Scanline(target) => draw(mesh, shader, state, &Scanline, target, probe),
            Drawing::Exact(target) => draw(mesh, shader, state, &Exact::new(), target, probe),
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, tiled) if self.observer.is_none() => {
                tiled.draw_mesh(mesh, shader, state, target);
            }
            #[cfg(feature = "tiled")]
            Drawing::Tiled(target, _) => draw(mesh, shader, state, &Exact::new(), target, probe),
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
        self.draw(mesh, shader, &RenderState { load: LoadOp::Clear, ..*state });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use glam::{DVec4, dvec4};

    use super::*;
    use crate::clip::ClipVertex;
    use crate::color::Color;
    use crate::observer::Observer;
    use crate::rect::Pixel;
    use crate::shader::from_fn;

    #[test]
    fn panels_lie_side_by_side_where_the_scene_is() {
        let framebuffer = Framebuffer::new(200, 100);
        let canvas = Canvas::new(&framebuffer, (50, 50), 0, RasterizerChoice::Scanline, None);
        assert_eq!(canvas.viewport(), Viewport { x: 50.0, y: 0.0, width: 100.0, height: 100.0 });
        let panels = [0, 1, 3].map(|index| canvas.panel(index, 4));
        let expected = [50.0, 75.0, 125.0].map(|x| Viewport { x, y: 0.0, width: 25.0, height: 100.0 });
        assert_eq!(panels, expected);
    }

    /// A square in one color, as large as the viewport.
    fn square(canvas: &mut Canvas, color: Color, state: &RenderState, clears: bool) {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let vertices = corners.map(|(x, y)| dvec4(x, y, 0.0, 1.0)).to_vec();
        let mesh = Mesh::indexed(vertices, vec![0, 1, 2, 0, 2, 3]).expect("two triangles");
        let vertex = |&position: &DVec4| ClipVertex { position, varyings: [] };
        let shader = from_fn(vertex, move |_: [f64; 0]| color.to_f64());
        if clears {
            canvas.render(&mesh, &shader, state);
        } else {
            canvas.draw(&mesh, &shader, state);
        }
    }

    #[test]
    fn a_scene_is_drawn_where_it_belongs() {
        for &rasterizer in RasterizerChoice::ALL {
            let mut canvas = Canvas::new(&Framebuffer::new(20, 10), (10, 10), 0, rasterizer, None);
            let in_blue = RenderState { clear_color: Color::BLUE, ..RenderState::default() };
            canvas.clear(&in_blue);
            assert_eq!(canvas.picture().get(0, 0), Some(Color::BLUE));
            square(&mut canvas, Color::RED, &in_blue, false);
            let seen = |canvas: &Canvas| [4, 5, 14, 15].map(|x| canvas.picture().get(x, 5).expect("inside"));
            assert_eq!(seen(&canvas), [Color::BLUE, Color::RED, Color::RED, Color::BLUE], "in the middle");

            let left = Some(Viewport { x: 0.0, y: 0.0, width: 5.0, height: 10.0 });
            let in_white =
                RenderState { clear_color: Color::WHITE, viewport: left, ..RenderState::default() };
            square(&mut canvas, Color::GREEN, &in_white, false);
            assert_eq!(seen(&canvas), [Color::GREEN, Color::RED, Color::RED, Color::BLUE], "in its own part");
            square(&mut canvas, Color::GREEN, &in_white, true);
            assert_eq!(
                seen(&canvas),
                [Color::GREEN, Color::WHITE, Color::WHITE, Color::WHITE],
                "after clearing"
            );
            assert_eq!(canvas.into_picture().get(4, 5), Some(Color::GREEN));
        }
    }

    #[test]
    fn what_is_observed_is_told_with_every_rasterizer() {
        #[derive(Debug, Default)]
        struct Written(AtomicUsize);
        impl Observer for Written {
            fn written(&self, _pixel: Pixel, _color: Color) {
                self.0.fetch_add(1, Ordering::Relaxed);
            }
        }
        impl Probe for Written {}

        for &rasterizer in RasterizerChoice::ALL {
            let written = Arc::new(Written::default());
            let mut framebuffer = Framebuffer::new(10, 10);
            framebuffer.set_observer(Some(written.clone()));
            let mut canvas = Canvas::new(&framebuffer, (10, 10), 0, rasterizer, Some(written.clone()));
            canvas.clear(&RenderState::default());
            square(&mut canvas, Color::RED, &RenderState::default(), false);
            assert!(written.0.load(Ordering::Relaxed) > 90, "{}", rasterizer.name());
        }
    }
}
