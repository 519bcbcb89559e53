//! Whatever the bytes are: no panic, no hang, and what the documentation promises. (A panic of an image's decoder is its own,
//! and an error here.)

mod bytes;
mod figures;
mod files;
mod scenes;

pub(crate) use figures::history;
pub(crate) use files::{image, model};
pub(crate) use scenes::{polygon, scene};
