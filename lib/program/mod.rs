//! Beside the renderer: what the `main`s of all chapters share. The renderer never imports it.
//!
//! A chapter is a table of variants ([`Chapter`]); a variant is one picture. From the table come `--list`, the drawing
//! itself, the snapshots and the tests.
//!
//! ```
//! use rasterbook::program::{Chapter, Variant};
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
//! assert_eq!(lead.draw(&lead.sitting(None)).get(1, 1), Some(Color::RED));
//! // fn main() -> std::process::ExitCode { CHAPTER.main() }
//! ```

mod animation;
mod arguments;
pub mod assets;
mod canvas;
mod chapter;
mod failure;
mod formulas;
mod history;
mod inspect;
mod output;
mod palette;
pub mod picture;
mod record;
mod rows;
mod run;
mod steps;

pub use canvas::{Canvas, RasterizerChoice, Subject};
pub use chapter::{Animation, Chapter, Mistake, Sitting, Variant};
pub use failure::Failure;
pub use history::History;
pub use inspect::{histories, history};
