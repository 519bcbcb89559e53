//! Beside the renderer: how a picture came about. The history of a pixel, the steps, and how often each pixel was written.
//!
//! A figure is drawn while a recorder observes; what it has recorded is explained here. Nothing here draws a picture of
//! a chapter.

mod explain;
mod formulas;
mod history;
mod legend;
mod record;
mod rows;
mod steps;

pub use explain::{histories, history};
pub use history::History;
pub use legend::{heat_legend, with_legend};
pub use steps::Steps;
