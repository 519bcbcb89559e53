//! Everything that is tested with the chapters' own tables. One program, since each contains all chapters.

#[path = "../fuzz/src/arguments.rs"]
mod arguments;
mod artefacts;
mod chapters;
mod command_line;
mod docs;
mod fingerprints;
#[path = "../fuzz/src/targets/mod.rs"]
mod fuzz;
mod inspect;
mod knobs;
mod rasterizers;
mod seeds;
mod sizes;
