//! Chapter 11, beyond the book: what the numbers of a picture mean as amounts of light.
//!
//! A channel of 128 is not half as bright as one of 255, but a fifth: pictures are encoded by the *sRGB* transfer
//! function, which spends more of its 256 steps on the dark, where eyes see smaller differences. Light adds up as
//! *linear light*; so a shader that adds and multiplies light decodes colors first, and encodes what comes out.
//!
//! ```text
//!   encoded                     light
//!   0..=255 ──── decode ────►  0..=1 ──── add, multiply, mix ────► encode ────► 0..=255
//! ```
//!
//! ```
//! use rasterbook::srgb::{decode, encode};
//!
//! let half: [f64; 3] = encode([0.5; 3]);
//! assert_eq!(half, [188.0; 3]); // half of the light
//! let stored: [f64; 3] = decode([128.0; 3]);
//! assert!((stored[0] - 0.2159).abs() < 1e-4); // half of the numbers
//! ```
//!
//! Source: IEC 61966-2-1; Direct3D 11.3 functional specification, 3.2.3.

use std::array::from_fn;
use std::sync::LazyLock;

use crate::real::{Real, map3};

// ANCHOR: tables
/// The light of an encoded value c, both in 0..=1: c / 12.92 for c ≤ 0.04045,
/// ((c + 0.055) / 1.055)^2.4 above.
fn light_of(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

/// The light of each of the 256 values of a channel. A table, since a power costs as much as a
/// hundred additions.
static LIGHT: LazyLock<[f64; 256]> = LazyLock::new(|| from_fn(|it| light_of(it as f64 / 255.0)));

/// The light half-way, in encoded values, between each value and the next: from there on the next
/// one is nearer.
static BORDERS: LazyLock<[f64; 255]> =
    LazyLock::new(|| from_fn(|value| light_of((value as f64 + 0.5) / 255.0)));

/// For each of 4096 equal steps of light, the value of its darkest light. No step holds more than
/// one border, so that the value of any light in it is this one or the next.
static STEPS: LazyLock<[u8; 4096]> =
    LazyLock::new(|| from_fn(|i| BORDERS.partition_point(|&it| it <= i as f64 / 4096.0) as u8));
// ANCHOR_END: tables

/// Stored channels, whole numbers in 0..=255 → light in 0..=1. Fractions are cut off, values outside clamped.
#[must_use]
#[inline(always)]
pub fn decode<R: Real>(stored: [R; 3]) -> [R; 3] {
    let light: &[f64; 256] = &LIGHT;
    map3(
        stored,
        #[inline(always)]
        |channel| channel.map(|value| light[usize::from(value as u8)]),
    )
}

/// Light, 0..=1 → the nearest stored channels, whole numbers in 0..=255; more light than 1 gives 255, NaN 0.
#[must_use]
#[inline(always)]
pub fn encode<R: Real>(light: [R; 3]) -> [R; 3] {
    let (steps, borders): (&[u8; 4096], &[f64; 255]) = (&STEPS, &BORDERS);
    let value = |amount: f64| {
        let value = steps[((amount * 4096.0) as usize).min(4095)];
        let is_next = borders.get(usize::from(value)).is_some_and(|&border| border <= amount);
        f64::from(value) + f64::from(u8::from(is_next))
    };
    map3(
        light,
        #[inline(always)]
        |amount| amount.map(value),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for value in 0..=255_u8 {
            let stored = f64::from(value);
            assert_eq!(encode(decode([stored; 3])), [stored; 3]);
        }
    }

    #[test]
    fn light_at_a_border_is_the_next_value() {
        for (value, &border) in BORDERS.iter().enumerate() {
            let at = |amount: f64| encode([amount; 3])[0] as usize;
            assert_eq!(
                [at(border.next_down()), at(border), at(border.next_up())],
                [value, value + 1, value + 1]
            );
        }
        for step in 0..4095 {
            let of = |step: usize| i32::from(STEPS[step]);
            assert!(of(step + 1) - of(step) <= 1, "step {step}");
        }
    }

    #[test]
    fn the_curve() {
        let decode = |value: f64| decode([value; 3])[0];
        assert_eq!((decode(0.0), decode(255.0)), (0.0, 1.0));
        assert!((decode(10.0) - 10.0 / 255.0 / 12.92).abs() < 1e-15, "straight in the dark");
        assert!((decode(188.0) - 0.5029).abs() < 1e-4);
        let encode = |amount: f64| encode([amount; 3])[0];
        assert_eq!([encode(-1.0), encode(2.0), encode(f64::NAN)], [0.0, 255.0, 0.0]);
        // The formula of the way back, and not only the inverse of the table.
        for amount in [0.001, 0.003, 0.02, 0.2, 0.5, 0.9] {
            let c: f64 = if amount <= 0.003_130_8 {
                12.92 * amount
            } else {
                1.055 * libm::pow(amount, 1.0 / 2.4) - 0.055
            };
            assert_eq!(encode(amount), (c * 255.0).round());
        }
    }
}
