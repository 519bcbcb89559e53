//! Chapter 3: the numbers that interpolation is written for.
//!
//! A formula that is generic over [`Real`] is written once and runs on `f64`, as the book computes, and on `f32`.
//!
//! ```
//! use rasterbook::real::Real;
//!
//! fn mean<R: Real>(a: R, b: R) -> R {
//!     (a + b) * R::of(0.5)
//! }
//! assert_eq!(mean(1.0_f64, 2.0), 1.5);
//! assert_eq!(mean(1.0_f32, 2.0), 1.5);
//! ```

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number with the four operations, which are exact IEEE operations: one rounding each, nothing fused.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A literal: the number nearest to `value`.
    fn of(value: f64) -> Self;
}

impl Real for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

impl Real for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }
}
