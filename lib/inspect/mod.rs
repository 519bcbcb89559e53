//! Beside the renderer: how a picture came about. The history of a pixel, the steps, and how often each pixel was written.
//!
//! A figure is drawn while somebody observes, who keeps what the answer needs and no more. Nothing here draws a picture of
//! a chapter.

mod event;
mod explain;
mod formulas;
mod history;
mod legend;
mod overdraw;
mod record;
mod rows;
mod steps;
#[cfg(test)]
mod tests;

pub use history::History;
#[cfg(feature = "program")]
pub(crate) use history::text_json;
pub use legend::{heat_legend, with_legend};
pub use overdraw::overdraw;
pub use record::{histories, history};
pub use steps::{Steps, TooManySteps};
