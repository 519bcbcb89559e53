//! Chapter 9: the two programs that a picture is made with, one for each vertex and one for each fragment.
//!
//! The vertex shader stands at the beginning of the data flow, before clipping; the fragment shader behind the
//! rasterizer, before the depth test.
//!
//! ```
//! use glam::{DVec3, dvec3};
//! use rasterbook::clip::ClipVertex;
//! use rasterbook::real::Real;
//! use rasterbook::shader::{Shaded, Shader};
//!
//! /// Brightness follows the height of a point.
//! struct Height {
//!     brightest: f64, // a uniform
//! }
//!
//! impl Shader<1> for Height {
//!     type Attributes = DVec3;
//!
//!     fn vertex(&self, view: &DVec3) -> ClipVertex<1> {
//!         ClipVertex { position: view.extend(view.z), varyings: [view.y] }
//!     }
//!
//!     fn fragment<R: Real>(&self, [height]: [R; 1]) -> Shaded<R> {
//!         Shaded::opaque([height * R::of(self.brightest); 3])
//!     }
//! }
//!
//! let shader = Height { brightest: 255.0 };
//! assert_eq!(shader.vertex(&dvec3(1.0, 0.5, 2.0)).varyings, [0.5]);
//! assert_eq!(shader.fragment([0.5_f64]).color.channels(), [127.5, 127.5, 127.5, 1.0]);
//! ```

use std::fmt;
use std::marker::PhantomData;

use glam::DVec3;

use crate::clip::ClipVertex;
use crate::real::{Mask, Real};
use crate::varyings::Derivatives;

/// A vertex shader and a fragment shader; what both need and what is the same for all vertices and fragments, the
/// *uniforms*, are the fields of the struct.
///
/// N is the number of *varyings*: the values that the vertex shader hands to the fragment shader, interpolated
/// perspective-correctly on the way. Book, section 9.2.
pub trait Shader<const N: usize>: Sync {
    /// What is known of a vertex: the record of the vertex buffer.
    type Attributes: Sync;

    /// Attributes → position in clip space, and varyings.
    fn vertex(&self, attributes: &Self::Attributes) -> ClipVertex<N>;

    /// Attributes → position in the space of the model, for those who ask where a vertex came from; drawing does not.
    fn position(&self, _: &Self::Attributes) -> Option<DVec3> {
        None
    }

    /// Varyings → color. Written for any number type, so that one source serves one fragment or several at a time;
    /// for that, it keeps no state.
    fn fragment<R: Real>(&self, varyings: [R; N]) -> Shaded<R>;

    /// Whether fragments are shaded for the processor that a program runs on, and not only for those that it is compiled for.
    ///
    /// Say `true` if [`Self::fragment`] and all functions and closures that it calls with generic numbers are
    /// `#[inline(always)]`, as those of [`light`](crate::light), [`mipmap`](crate::mipmap), [`srgb`](crate::srgb) and
    /// [`texture`](crate::texture) are; `map` of arrays is not, but [`each`](crate::real::each) is. What is not inlined then
    /// takes ten times as long, for each operation is a call. The picture is the same in any case.
    const IS_INLINED: bool = false;

    /// Whether fragments are shaded by [`Self::fragment_with_derivatives`].
    const USES_DERIVATIVES: bool = false;

    /// Varyings, and how they change from pixel to pixel → color: for filters, which need to know how much of a texture
    /// a pixel covers.
    #[inline(always)]
    fn fragment_with_derivatives<R: Real>(&self, varyings: [R; N], _: Derivatives<R, N>) -> Shaded<R> {
        self.fragment(varyings)
    }
}

/// A shader made of two functions: see [`from_fn`].
#[derive(Clone, Copy)]
pub struct FnShader<A, V, F> {
    vertex: V,
    fragment: F,
    attributes: PhantomData<fn(&A)>,
}

impl<A, V, F> fmt::Debug for FnShader<A, V, F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a shader made of two functions")
    }
}

/// A shader made of two functions: attributes → clip space and varyings, and varyings → red, green and blue in 0..=255.
///
/// The simplest way to a picture. The fragment function is written for `f64` and takes one fragment at a time, also where
/// eight could be shaded at once: what is to be fast implements [`Shader`].
///
/// ```
/// use glam::DVec3;
/// use rasterbook::{ClipVertex, Shader, shader};
///
/// let brightness = shader::from_fn(
///     |view: &DVec3| ClipVertex { position: view.extend(view.z), varyings: [view.y] },
///     |[height]: [f64; 1]| [height * 255.0; 3],
/// );
/// assert_eq!(brightness.fragment([0.5_f64]).color.channels(), [127.5, 127.5, 127.5, 1.0]);
/// ```
pub const fn from_fn<A, V, F, const N: usize>(vertex: V, fragment: F) -> FnShader<A, V, F>
where
    A: Sync,
    V: Fn(&A) -> ClipVertex<N> + Sync,
    F: Fn([f64; N]) -> [f64; 3] + Sync,
{
    FnShader { vertex, fragment, attributes: PhantomData }
}

impl<A, V, F, const N: usize> Shader<N> for FnShader<A, V, F>
where
    A: Sync,
    V: Fn(&A) -> ClipVertex<N> + Sync,
    F: Fn([f64; N]) -> [f64; 3] + Sync,
{
    type Attributes = A;

    fn vertex(&self, attributes: &A) -> ClipVertex<N> {
        (self.vertex)(attributes)
    }

    fn fragment<R: Real>(&self, varyings: [R; N]) -> Shaded<R> {
        Shaded::opaque(R::map_all(varyings, &self.fragment))
    }
}

/// What a fragment shader says of a fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaded<R: Real> {
    /// Its color.
    pub color: Paint<R>,
    /// Where the fragment is drawn at all.
    pub keep: R::Mask,
}

/// The color of a fragment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint<R: Real> {
    /// Red, green and blue in 0..=255, and opacity in 0..=1.
    Channels([R; 4]),
    /// A texel as it is stored. It can be written as it is: nothing is taken apart, rounded and put together again.
    Texel(R::Colors),
}

impl<R: Real> Paint<R> {
    /// Red, green and blue in 0..=255, and opacity in 0..=1.
    #[must_use]
    #[inline(always)]
    pub fn channels(self) -> [R; 4] {
        match self {
            Self::Channels(channels) => channels,
            Self::Texel(texel) => {
                let [red, green, blue] = R::channels(texel);
                [red, green, blue, R::of(1.0)]
            }
        }
    }
}

impl<R: Real> Shaded<R> {
    /// A fragment through which nothing shines; channels in 0..=255.
    #[must_use]
    #[inline(always)]
    pub fn opaque([red, green, blue]: [R; 3]) -> Self {
        Self::translucent([red, green, blue], R::of(1.0))
    }

    /// A fragment of some opacity, 0..=1.
    #[must_use]
    #[inline(always)]
    pub fn translucent([red, green, blue]: [R; 3], opacity: R) -> Self {
        Self { color: Paint::Channels([red, green, blue, opacity]), keep: R::Mask::all(true) }
    }

    /// A fragment that shows a texel, such as [`Texture::nearest_texel`](crate::texture::Texture::nearest_texel) gives,
    /// as it is.
    #[must_use]
    #[inline(always)]
    pub fn texel(texel: R::Colors) -> Self {
        Self { color: Paint::Texel(texel), keep: R::Mask::all(true) }
    }

    /// The same, but not drawn where the mask says so.
    #[must_use]
    #[inline(always)]
    pub fn discard(self, mask: R::Mask) -> Self {
        Self { keep: self.keep.and(mask.not()), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{dvec3, dvec4};

    #[test]
    fn discarding() {
        let shaded: Shaded<f64> = Shaded::opaque([1.0, 2.0, 3.0]);
        assert!(shaded.keep);
        assert!(!shaded.discard(1.0_f64.is_less(2.0)).keep);
        assert!(shaded.discard(2.0_f64.is_less(1.0)).keep);
        assert!(!shaded.discard(true).discard(false).keep, "what is discarded stays so");
    }

    #[test]
    fn a_shader_of_two_functions() {
        let shader = from_fn(
            |view: &DVec3| ClipVertex { position: view.extend(view.z), varyings: [view.y] },
            |[height]: [f64; 1]| [height * 255.0, 0.0, 1.0],
        );
        let vertex = shader.vertex(&dvec3(1.0, 0.5, 2.0));
        assert_eq!(vertex, ClipVertex { position: dvec4(1.0, 0.5, 2.0, 2.0), varyings: [0.5] });
        assert_eq!(shader.position(&DVec3::ONE), None, "nothing is said of the space of the model");
        let shaded = Shaded::opaque([127.5, 0.0, 1.0]);
        assert_eq!(shader.fragment([0.5]), shaded);
        let derivatives = Derivatives { dx: [9.0], dy: [9.0] };
        assert_eq!(shader.fragment_with_derivatives([0.5], derivatives), shaded, "it does not ask for them");
        assert_eq!(format!("{shader:?}"), "a shader made of two functions");
    }
}
