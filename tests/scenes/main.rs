//! What a scene depends on, for every variant: its size, and its knobs. One program, since each contains all chapters.

#[path = "../support/chapters.rs"]
mod chapters;
mod fingerprints;
mod knobs;
mod sizes;
