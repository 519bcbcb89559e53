//! What is tested of the library as a whole, without the chapters' programs. One program of tests, since each is linked by
//! itself, and compiles anew what is generic.

mod assets;
mod background;
mod conventions;
mod exact;
mod house;
mod pipeline;
#[path = "support/targets.rs"]
mod targets;
