//! Numbers that arithmetic is seldom asked about, between ordinary ones, and what is made of them.

use std::array::from_fn;

use glam::DVec2;
use proptest::prelude::*;
use proptest::sample::select;
use rasterbook::Rect;

#[rustfmt::skip]
/// Zeros, tiny, huge, infinite, and none.
const ODD: [f64; 24] = [
    0.0, -0.0, 5e-324, -5e-324, f64::MIN_POSITIVE, f32::MIN_POSITIVE as f64, 1e-40, -1e-40, 1e38, -1e38,
    f32::MAX as f64, f32::MIN as f64, i32::MIN as f64, i32::MAX as f64, u32::MAX as f64, 1e150, 1.5e308, -1.5e308,
    f64::MAX, f64::MIN, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN,
];

/// Any number, odd or ordinary.
pub(crate) fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => select(&ODD[..]), 2 => -1.5..1.5, 2 => -30.0..30.0, 1 => (-3..9).prop_map(f64::from)]
}

pub(crate) fn numbers<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(any_number(), N).prop_map(|numbers| from_fn(|i| numbers[i]))
}

pub(crate) fn any_whole() -> impl Strategy<Value = i32> {
    prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(i32::MIN + 7), Just(i32::MAX - 7), -2..9, any::<i32>()]
}

pub(crate) fn point() -> impl Strategy<Value = DVec2> {
    numbers().prop_map(DVec2::from_array)
}

pub(crate) fn triangle() -> impl Strategy<Value = [DVec2; 3]> {
    prop::array::uniform3(point())
}

/// A rectangle of at most 12 × 12 pixels, also where whole numbers end; sometimes without pixels.
pub(crate) fn small_rect() -> impl Strategy<Value = Rect> {
    let side = || (any_whole(), -2..12).prop_map(|(from, length)| (from, from.saturating_add(length)));
    (side(), side()).prop_map(|((left, right), (bottom, top))| Rect { left, bottom, right, top })
}

pub(crate) fn any_rect() -> impl Strategy<Value = Rect> {
    let sides = prop::array::uniform4(any_whole());
    sides.prop_map(|[left, bottom, right, top]| Rect { left, bottom, right, top })
}
