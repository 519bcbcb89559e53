//! Chapters 10 and 11: light. How bright a surface is at a point, from its normal, the direction to the light, and the eye.
//!
//! Called by fragment shaders (or, for Gouraud shading, by vertex shaders); all vectors are of length 1 and in one
//! space, whichever that is. Everything is written for any number type. (What is long is inlined for speed, but not in
//! development builds, which would take longer to compile.)
//!
//! ```
//! use rasterbook::light::{dot, lambert, normalize};
//!
//! let normal = normalize([0.0, 2.0, 0.0]);
//! let to_light = normalize([0.0, 1.0, -1.0]);
//! assert!((lambert(normal, to_light) - 0.5_f64.sqrt()).abs() < 1e-15); // 45°
//! assert_eq!(lambert(normal, [0.0, -1.0, 0.0]), 0.0); // from below: no light
//! assert_eq!(dot(normal, normal), 1.0);
//! ```

use crate::real::{Real, each};

/// A vector in any space.
type Vector<R> = [R; 3];

/// a · b.
#[must_use]
#[inline(always)]
pub fn dot<R: Real>(a: Vector<R>, b: Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector of length 1 in the same direction; not finite for the zero vector.
///
/// The square of the length is needed on the way. Where that is rounded to 0 the result is not finite, either; where it is
/// infinite, as for `f64` from a length of 1.4 · 10¹⁵⁴ on, a finite vector becomes the zero vector.
#[must_use]
#[inline(always)]
pub fn normalize<R: Real>(v: Vector<R>) -> Vector<R> {
    scale_down(v, dot(v, v).sqrt())
}

/// v / s.
#[inline(always)]
fn scale_down<R: Real>(v: Vector<R>, s: R) -> Vector<R> {
    [v[0] / s, v[1] / s, v[2] / s]
}

/// v · s.
#[must_use]
#[inline(always)]
pub fn scale<R: Real>(v: Vector<R>, s: R) -> Vector<R> {
    [v[0] * s, v[1] * s, v[2] * s]
}

/// a + b.
#[must_use]
#[inline(always)]
pub fn add<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a − b.
#[must_use]
#[inline(always)]
pub fn subtract<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The direction in which light from the direction `to_light` leaves a mirror: 2 (n·l) n − l.
///
/// ```text
///    to_light    n     reflected
///          ╲     │     ╱
///            ╲ θ │ θ ╱
///              ╲ │ ╱
///        ────────┴────────
/// ```
///
/// Source: fourth note, Phong model.
#[must_use]
#[inline(always)]
pub fn reflect<R: Real>(normal: Vector<R>, to_light: Vector<R>) -> Vector<R> {
    subtract(scale(normal, R::of(2.0) * dot(normal, to_light)), to_light)
}

// ANCHOR: lambert
/// Diffuse light: max(0, n·l), the cosine of the angle at which the light arrives; 0 where n·l is
/// not a number. Book, section 11.1.
///
/// ```text
///    light straight from above: much of it       at an angle: the same light on more surface
///          │ │ │ │                                       ╲ ╲ ╲ ╲
///          ▼ ▼ ▼ ▼                                         ╲ ╲ ╲ ╲
///       ───────────────                             ────────────────────
/// ```
#[must_use]
#[inline(always)]
pub fn lambert<R: Real>(normal: Vector<R>, to_light: Vector<R>) -> R {
    dot(normal, to_light).max(R::of(0.0))
}
// ANCHOR_END: lambert

/// How much of a point light's intensity arrives at a distance: 1 / r², infinite at 0. Source: fourth note, Lambert model.
#[must_use]
#[inline(always)]
pub fn attenuation<R: Real>(distance: R) -> R {
    R::of(1.0) / (distance * distance)
}

// ANCHOR: specular
/// Phong's highlight: max(0, r·v)^p, r the reflected light, v the direction to the eye; max(0, r·v)
/// is 0 where r·v is not a number. Large exponents make it small.
///
/// Where the angle between r and v passes 90° the highlight is cut off, which shows at small
/// exponents. Source: fourth note, Phong model.
#[must_use]
#[inline(always)]
pub fn phong<R>(normal: Vector<R>, to_light: Vector<R>, to_eye: Vector<R>, exponent: f64) -> R
where
    R: Real,
{
    power(dot(reflect(normal, to_light), to_eye).max(R::of(0.0)), exponent)
}

/// The highlight of Blinn–Phong: max(0, n·h)^p, h half-way between light and eye. It has no cut-off
/// while both are above the surface. Where they are opposite to each other there is no h, and
/// max(0, n·h) is 0. Source: fourth note, Blinn–Phong model.
#[must_use]
#[inline(always)]
pub fn blinn_phong<R>(normal: Vector<R>, to_light: Vector<R>, to_eye: Vector<R>, exponent: f64) -> R
where
    R: Real,
{
    let half = normalize(add(to_light, to_eye));
    power(dot(normal, half).max(R::of(0.0)), exponent)
}
// ANCHOR_END: specular

/// The largest whole exponent for which multiplying is taken.
const LARGEST_WHOLE: f64 = 1024.0;

/// base^exponent, for a base that is not negative.
///
/// A whole exponent takes a few multiplications, by the squares that its bits name, x⁵ = x · (x²)²: a small part of the
/// time of a power in general, and the same to some roundings.
#[inline(always)]
fn power<R: Real>(base: R, exponent: f64) -> R {
    let mut left = exponent as u32;
    if f64::from(left) != exponent || exponent > LARGEST_WHOLE {
        return base.map(|base| libm::pow(base, exponent));
    }
    let (mut product, mut square) = (R::of(1.0), base);
    while left > 0 {
        if left & 1 == 1 {
            product = product * square;
        }
        left >>= 1;
        square = square * square;
    }
    product
}

// ANCHOR: mapped_normal
/// The normal that a normal map gives to a point of a surface: the texel's channels, 0..=255, are
/// x, y and z of a vector in the surface's own *tangent space*, −1..1.
///
/// ```text
///        n (blue)          x runs along t, where u grows, y along b, where v grows, and
///        │   ╱ b (green)   z along n, off the surface. (128, 128, 255) all but leaves the
///        │ ╱               normal as it is, which is why such maps are bluish.
///        └───── t (red)
/// ```
///
/// No texel leaves it exactly: 0 would be 127.5, and 128 tilts the normal by 0.3°. A mixture of
/// texels that is 127.5 in all channels is the zero vector: the normal is not finite.
///
/// The axes are of length 1 and in any space; the normal is in the same. Source: first note (a
/// normal map on a quad).
#[must_use]
#[inline(always)]
pub fn mapped_normal<R: Real>(texel: Vector<R>, [t, b, n]: [Vector<R>; 3]) -> Vector<R> {
    let [x, y, z] = subtract(scale_down(texel, R::of(127.5)), [R::of(1.0); 3]);
    normalize(add(add(scale(t, x), scale(b, y)), scale(n, z)))
}
// ANCHOR_END: mapped_normal

// ANCHOR: light
/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// From far away: everywhere from the same direction (of length 1, towards the light), equally
    /// bright.
    Directional([f64; 3]),
    /// From a point, of some intensity: at the distance r so much of it arrives as [`attenuation`]
    /// says, I / r².
    Point {
        /// Where it is.
        position: [f64; 3],
        /// How bright it is at the distance 1.
        intensity: f64,
    },
}

impl Light {
    /// At a place: the direction towards the light, and how bright it is there. At a point light
    /// itself there is no direction: neither is finite.
    #[must_use]
    #[inline(always)]
    pub fn at<R: Real>(&self, place: Vector<R>) -> (Vector<R>, R) {
        match *self {
            Self::Directional([x, y, z]) => ([R::of(x), R::of(y), R::of(z)], R::of(1.0)),
            Self::Point { position: [x, y, z], intensity } => {
                let offset = subtract([R::of(x), R::of(y), R::of(z)], place);
                let distance = dot(offset, offset).sqrt();
                (scale_down(offset, distance), R::of(intensity) * attenuation(distance))
            }
        }
    }
}
// ANCHOR_END: light

/// Which highlight a surface has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Highlight {
    /// None: a dull surface.
    #[default]
    None,
    /// By the reflected ray.
    Phong,
    /// By the half vector.
    BlinnPhong,
}

/// How a surface reflects light: the sum of three terms. Source: fourth note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The part of the ambient light that comes back, which is there without any direction.
    pub ambient: f64,
    /// The part of the diffuse light.
    pub diffuse: f64,
    /// The part of the highlight, which has the light's color and not the surface's.
    pub specular: f64,
    /// The exponent of the highlight.
    pub exponent: f64,
    /// Which highlight.
    pub highlight: Highlight,
}

impl Material {
    // ANCHOR: shade
    /// The color (0..=255) of a surface of color `surface` under white light of some intensity.
    ///
    /// As in the note, nothing keeps a broad highlight from reaching a little beyond where the
    /// surface turns away from the light. A channel that is not a number, as at a point light
    /// itself, is 255.
    #[must_use]
    #[inline(always)]
    pub fn shade<R: Real>(
        &self,
        surface: [R; 3],
        normal: Vector<R>,
        (to_light, intensity): (Vector<R>, R),
        to_eye: Vector<R>,
    ) -> [R; 3] {
        let diffuse = intensity * lambert(normal, to_light);
        let highlight = match self.highlight {
            Highlight::None => R::of(0.0),
            Highlight::Phong => phong(normal, to_light, to_eye, self.exponent),
            Highlight::BlinnPhong => blinn_phong(normal, to_light, to_eye, self.exponent),
        };

        let body = R::of(self.ambient) + R::of(self.diffuse) * diffuse;
        let gloss = R::of(self.specular * 255.0) * intensity * highlight;
        each(
            surface,
            #[inline(always)]
            |_, channel| (body * channel + gloss).min(R::of(255.0)),
        )
    }
    // ANCHOR_END: shade
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::array::from_fn;

    fn direction() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-1.0..1.0).prop_filter("too short", |v| dot(*v, *v) > 0.01).prop_map(normalize)
    }

    const WHITE: [f64; 3] = [255.0; 3];

    #[test]
    fn a_whole_exponent_is_multiplied_to_the_same_power() {
        for exponent in [0.0, 1.0, 2.0, 5.0, 24.0, 60.0, 100.0, 1023.0, 1024.0] {
            for base in [0.0, 1e-3, 0.3, 0.9, 0.999, 1.0] {
                let (power, expected) = (power(base, exponent), libm::pow(base, exponent));
                assert!(
                    (power - expected).abs() <= 1e-12 * expected,
                    "{base}^{exponent}: {power}, not {expected}"
                );
            }
        }
        assert_eq!(power(0.9, 2.5), libm::pow(0.9, 2.5), "not a whole one");
    }

    #[test]
    fn large_exponents_are_not_multiplied() {
        // Ten squarings are x¹⁰²⁴, and not rounded as a power is.
        let squared = (0..10).fold(0.9, |x: f64, _| x * x);
        assert_ne!(squared, libm::pow(0.9, 1024.0));
        assert_eq!(power(0.9, 1024.0), squared);
        // Beyond, each squaring would double the error: of (1 − 10⁻⁶) to the 10⁶ it would reach the tenth digit.
        for exponent in [1025.0, 1e6 + 1.0, 4e9] {
            assert_eq!(power(0.999_999, exponent), libm::pow(0.999_999, exponent), "{exponent}");
        }
    }

    #[test]
    fn light_from_straight_above_and_from_the_side() {
        let up = [0.0, 1.0, 0.0];
        let material =
            Material { ambient: 0.2, diffuse: 0.6, specular: 0.0, exponent: 1.0, highlight: Highlight::None };
        let gray = |to_light| material.shade(WHITE, up, (to_light, 1.0), up)[0] / 255.0;
        assert!((gray(up) - 0.8).abs() < 1e-12);
        assert!((gray([1.0, 0.0, 0.0]) - 0.2).abs() < 1e-12, "ambient alone");
        assert!((gray([0.6, 0.8, 0.0]) - 0.68).abs() < 1e-12);
        assert_eq!(attenuation(2.0), 0.25);
        let lamp = Light::Point { position: [0.0, 3.0, 4.0], intensity: 50.0 };
        assert_eq!(lamp.at([0.0; 3]), ([0.0, 0.6, 0.8], 2.0), "50 at the distance 1 is 2 at the distance 5");
        assert_eq!(Light::Directional([0.0, 1.0, 0.0]).at([9.0; 3]), ([0.0, 1.0, 0.0], 1.0));
    }

    #[test]
    fn a_highlight_is_added_in_the_color_of_the_light() {
        // The light at half intensity straight above, the eye 60° beside it: the ray is mirrored to the light itself, and
        // the half vector is 30° from the normal. Squared, the cosines are 1/4 and 3/4.
        let (up, eye) = ([0.0, 1.0, 0.0], [0.75_f64.sqrt(), 0.5, 0.0]);
        let shade = |highlight, to_eye| {
            let material = Material { ambient: 0.1, diffuse: 0.2, specular: 0.5, exponent: 2.0, highlight };
            material.shade([100.0, 50.0, 0.0], up, (up, 0.5), to_eye)
        };
        // A fifth of the surface's color, and of half the light's 255 · 0.5 as much as the square says.
        for (highlight, to_eye, gloss) in [
            (Highlight::None, up, 0.0),
            (Highlight::Phong, up, 63.75),
            (Highlight::Phong, eye, 15.9375),
            (Highlight::BlinnPhong, eye, 47.8125),
        ] {
            let (found, expected) = (shade(highlight, to_eye), [20.0 + gloss, 10.0 + gloss, gloss]);
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-12), "{highlight:?}: {found:?}");
        }
    }

    #[test]
    fn a_bluish_texel_all_but_leaves_the_normal() {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(mapped_normal([127.5, 127.5, 255.0], axes), [0.0, 0.0, 1.0]);
        let tilt = libm::acos(mapped_normal([128.0, 128.0, 255.0], axes)[2]).to_degrees();
        assert!((0.317..0.319).contains(&tilt), "{tilt}");
    }

    #[test]
    fn phong_is_cut_off_where_blinn_phong_goes_on() {
        // Light and eye on the same side, both low: the reflected ray is more than 90° from the eye.
        let (up, low) = ([0.0, 1.0, 0.0], normalize([1.0, 0.3, 0.0]));
        assert_eq!(phong(up, low, low, 2.0), 0.0);
        assert!(blinn_phong(up, low, low, 2.0) > 0.05);
    }

    proptest! {
        #[test]
        fn reflection_mirrors_at_the_normal(n in direction(), l in direction()) {
            let r = reflect(n, l);
            prop_assert!((dot(r, r) - 1.0).abs() < 1e-12, "as long as before");
            prop_assert!((dot(r, n) - dot(l, n)).abs() < 1e-12, "the same angle to the normal");
            let back = reflect(n, r);
            prop_assert!((0..3).all(|i| (back[i] - l[i]).abs() < 1e-12), "twice is nothing");
        }

        #[test]
        fn the_half_vector_has_half_the_angle(n in direction(), l in direction(), v in direction()) {
            let h = normalize(from_fn(|i| l[i] + v[i]));
            prop_assume!(h.iter().all(|c: &f64| c.is_finite()));
            prop_assert!((dot(h, l) - dot(h, v)).abs() < 1e-9);
            // Where both agree on the highlight's middle: the eye in the mirror's direction.
            let n = if dot(n, l) < 0.0 { n.map(|c| -c) } else { n };
            let mirrored = reflect(n, l);
            prop_assert!((phong(n, l, mirrored, 8.0) - 1.0).abs() < 1e-6);
            prop_assert!((blinn_phong(n, l, mirrored, 8.0) - 1.0).abs() < 1e-6);
        }

        #[test]
        fn colors_stay_in_range(n in direction(), l in direction(), v in direction(), exponent in 1.0..100.0) {
            for highlight in [Highlight::None, Highlight::Phong, Highlight::BlinnPhong] {
                let material = Material { ambient: 0.3, diffuse: 0.9, specular: 0.8, exponent, highlight };
                for channel in material.shade(WHITE, n, (l, 1.0), v) {
                    prop_assert!((0.0..=255.0).contains(&channel));
                }
            }
        }
    }
}
