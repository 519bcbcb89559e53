//! What the benchmarks share: scenes, our rasterizers ready to draw them, and how times are taken.

pub mod cores;
pub mod machine;
pub mod ours;
pub mod scenes;
pub mod timing;
