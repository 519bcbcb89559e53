//! How times are taken, by all benchmarks.

pub mod cores;
pub mod timing;
