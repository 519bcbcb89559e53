//! Beside the renderer: what a figure of a chapter is. The renderer never imports it.
//!
//! A chapter is a table of variants ([`Chapter`]); a variant is one picture, drawn into a framebuffer or, from chapter 9
//! on, on a [`Canvas`], which has the pipeline. From the table come `--list`, the drawing itself, the snapshots and the
//! tests.
//!
//! ```
//! use rasterbook::figure::{Chapter, Variant};
//! use rasterbook::{Color, Framebuffer};
//!
//! fn dot(framebuffer: &mut Framebuffer) {
//!     framebuffer.set(1, 1, Color::RED);
//! }
//!
//! const CHAPTER: Chapter = Chapter {
//!     name: "ch00_example",
//!     question: "How does a dot get onto the screen?",
//!     variants: &[Variant::new("dot", dot, "one red pixel at (1, 1)").size(4, 4)],
//! };
//! let lead = CHAPTER.lead();
//! assert_eq!(lead.draw(&lead.options(None)).get(1, 1), Some(Color::RED));
//! // fn main() -> std::process::ExitCode { CHAPTER.main() }
//! ```

pub mod assets;
mod canvas;
mod chapter;
mod fit;
pub(crate) mod glyphs;
mod knob;
mod knobs;
pub mod picture;
mod ruler;
mod scene;
mod sketch;
mod subject;

pub use canvas::{Canvas, RasterizerChoice};
pub use chapter::{Animation, Chapter, DrawOptions, Mistake, Variant};
pub use fit::Fit;
pub use knob::{Kind, Knob, Value};
pub use knobs::{KnobError, Knobs};
pub use scene::{Given, Scene};
pub use sketch::{Sketch, stroke};
pub use subject::Subject;
