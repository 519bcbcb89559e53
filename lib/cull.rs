//! Chapter 9: leaving out triangles that turn their back on us.
//!
//! Stands between the perspective divide and rasterization: takes the signed area of a triangle and says whether it is
//! drawn at all.
//!
//! ```
//! use rasterbook::area::Winding;
//! use rasterbook::cull::CullMode;
//!
//! // A triangle of area −2 runs clockwise; if counter-clockwise is the front, we see its back.
//! assert!(CullMode::Back.culls(-2.0, Winding::CounterClockwise));
//! assert!(!CullMode::Front.culls(-2.0, Winding::CounterClockwise));
//! ```

use crate::area::Winding;

/// Which triangles are left out. Book, section 9.3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CullMode {
    /// None.
    #[default]
    None,
    /// Those that we see from behind: of a closed body they are hidden anyway.
    Back,
    /// Those that we see from the front.
    Front,
}

impl CullMode {
    /// Whether a triangle of this signed area on the screen (y up) is left out, if `front` is how a front runs.
    ///
    /// A triangle without area counts as seen from behind, as in Direct3D (11.3 functional specification, 15.11.1).
    #[must_use]
    #[inline]
    pub fn culls(self, signed_area: f64, front: Winding) -> bool {
        self.culls_facing(Winding::of(signed_area) == Some(front))
    }

    /// The same for a triangle of this winding.
    #[must_use]
    #[inline]
    pub fn culls_winding(self, winding: Winding, front: Winding) -> bool {
        self.culls_facing(winding == front)
    }

    #[inline]
    const fn culls_facing(self, is_front: bool) -> bool {
        match self {
            Self::None => false,
            Self::Back => !is_front,
            Self::Front => is_front,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_with_area_is_front_or_back() {
        for area in [3.0, -3.0] {
            for front in [Winding::CounterClockwise, Winding::Clockwise] {
                assert!(!CullMode::None.culls(area, front));
                assert_ne!(CullMode::Back.culls(area, front), CullMode::Front.culls(area, front));
            }
        }
        assert!(CullMode::Front.culls(3.0, Winding::CounterClockwise));
        assert!(CullMode::Back.culls(0.0, Winding::CounterClockwise));
    }

    #[test]
    fn by_winding_it_is_the_same() {
        for (area, winding) in [(3.0, Winding::CounterClockwise), (-3.0, Winding::Clockwise)] {
            for front in [Winding::CounterClockwise, Winding::Clockwise] {
                for mode in [CullMode::None, CullMode::Back, CullMode::Front] {
                    assert_eq!(mode.culls_winding(winding, front), mode.culls(area, front), "{mode:?}");
                }
            }
        }
    }
}
