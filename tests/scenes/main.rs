//! What a scene depends on, for every variant: its size, its knobs, and its rasterizer. One program, since each contains all chapters.

#[path = "../support/chapters.rs"]
mod chapters;
mod fingerprints;
mod knobs;
mod rasterizers;
mod sizes;
