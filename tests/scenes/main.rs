//! What a scene depends on, for every variant: its size, its knobs, and its rasterizer. One program, since each contains all chapters.

#[path = "../support/chapters.rs"]
mod chapters;
mod fingerprints;
#[path = "../fuzz/src/targets/mod.rs"]
mod fuzz;
mod knobs;
mod rasterizers;
mod seeds;
mod sizes;
