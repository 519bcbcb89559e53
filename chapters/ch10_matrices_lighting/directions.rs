//! Directions as two angles, and the knobs that turn the light of many figures.

use glam::{DVec3, dvec3};
use rasterbook::figure::{Knob, Knobs};

use super::degrees;

// ANCHOR: direction
/// The direction of an azimuth and an elevation: 0, 0 is towards the reader; to the right, then up.
pub(super) fn direction(azimuth: f64, elevation: f64) -> DVec3 {
    let [(sin_a, cos_a), (sin_e, cos_e)] =
        [azimuth, elevation].map(|angle| libm::sincos(degrees(angle)));
    dvec3(cos_e * sin_a, sin_e, -cos_e * cos_a)
}
// ANCHOR_END: direction

/// The knobs of the light.
pub(super) const LIGHT: [&str; 2] = ["light-azimuth", "light-elevation"];

/// The knob of a light's azimuth.
pub(super) const fn light_azimuth(default: f64) -> Knob {
    let watch = "the light goes round: faces turn dark one after the other";
    Knob::number(LIGHT[0], default, [-180.0, 180.0], "°", watch)
}

/// The knob of a light's elevation.
pub(super) const fn light_elevation(default: f64) -> Knob {
    let watch = "the light goes up: at 90 the sides get none";
    Knob::number(LIGHT[1], default, [-90.0, 90.0], "°", watch)
}

/// Towards a light, by its two knobs; while these stand at their defaults exactly `pinned`, which the angles come near.
pub(super) fn to_light(knobs: &Knobs, names: [&str; 2], pinned: [f64; 3]) -> [f64; 3] {
    if !is_turned(knobs, &names) {
        return pinned;
    }
    let [azimuth, elevation] = names.map(|name| knobs.number(name));
    direction(azimuth, elevation).to_array()
}

/// Whether one of these knobs does not stand at its default.
pub(super) fn is_turned(knobs: &Knobs, names: &[&str]) -> bool {
    knobs.iter().any(|(knob, value)| names.contains(&knob.name) && value != knob.default())
}
