//! Beside the renderer: what the `main`s of all chapters share. Nothing in the library imports it.
//!
//! [`Chapter::main`](crate::figure::Chapter::main) reads the arguments, has the figure drawn or inspected, and writes what
//! comes of it.

mod animation;
mod arguments;
mod choice;
mod failure;
mod lists;
mod options;
mod output;
mod palette;
mod programs;
mod run;
mod scenes;
mod show;
mod threads;
mod values;
#[cfg(feature = "window")]
mod window;
mod wrap;

pub use failure::Failure;
pub use programs::{PROGRAMS, Program};
