//! Chapter 4: projection, from three dimensions onto the screen.
//!
//! Takes points in camera space and gives them in homogeneous coordinates (x, y, z, ω), the first stage of the data
//! flow; the perspective divide then makes screen coordinates of them.
//!
//! ```
//! use glam::dvec3;
//! use rasterbook::transform::{perspective, perspective_divide};
//!
//! // Twice as far away is half as large.
//! let near = perspective_divide(perspective(dvec3(100.0, 50.0, 200.0), 80.0));
//! let far = perspective_divide(perspective(dvec3(100.0, 50.0, 400.0), 80.0));
//! assert_eq!((near.x, near.y), (40.0, 20.0));
//! assert_eq!((far.x, far.y), (20.0, 10.0));
//! ```

use glam::{DVec2, DVec3, DVec4};

use crate::Rect;

// ANCHOR: perspective
/// Perspective projection onto the plane z = `near`: camera space → homogeneous coordinates (n x, n y, n z, z).
///
/// ```text
///          x │         ╱ (x, z)        similar triangles:
///            │     . ╱                     x′ / n = x / z
///            │   x′╱                       x′ = n x / z
///            │ . ╱ ┊
///            └─────┊────────── z       the division waits:
///            O     n                       (n x, n y, n z, z) with ω = z
/// ```
///
/// The result is not yet divided: ω keeps the distance, which chapter 5 needs. After the divide z is n for every point,
/// which says nothing; chapter 6 puts a depth there. Source: book, sections 4.2.2 and 4.2.3.
#[must_use]
pub fn perspective(view: DVec3, near: f64) -> DVec4 {
    DVec4::new(view.x * near, view.y * near, view.z * near, view.z)
}
// ANCHOR_END: perspective

/// Orthographic projection: camera space → homogeneous coordinates (x, y, z, 1). Distance changes nothing.
#[must_use]
pub fn orthographic(view: DVec3) -> DVec4 {
    view.extend(1.0)
}

/// The perspective divide: homogeneous coordinates → (x/ω, y/ω, z/ω). Not finite for ω = 0.
#[must_use]
pub fn perspective_divide(clip: DVec4) -> DVec3 {
    DVec3::new(clip.x / clip.w, clip.y / clip.w, clip.z / clip.w)
}

/// The six planes of a view volume (chapter 8): a pyramid without its top, seen from the eye at the origin.
///
/// ```text
///        far  ┌───────────────┐ z = far         left, right, bottom and top are measured on the near plane:
///              ╲             ╱                   x from left to right, y from bottom to top, at z = near.
///               ╲           ╱
///         near   └─────────┘   z = near
///               left     right
///                     O   the eye
/// ```
///
/// Camera space, in its units; 0 < near < far. Source: book, section 8.1, Figures 8-2 and 8-3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// x of the left border on the near plane.
    pub left: f64,
    /// x of the right border on the near plane.
    pub right: f64,
    /// y of the lower border on the near plane.
    pub bottom: f64,
    /// y of the upper border on the near plane.
    pub top: f64,
    /// z of the near plane.
    pub near: f64,
    /// z of the far plane.
    pub far: f64,
}

impl Frustum {
    // ANCHOR: project
    /// Projects so that the frustum becomes the cube −ω ≤ x, y, z ≤ ω: camera space → clip space.
    ///
    /// ```text
    ///   x′ = 2 n x / (r − l) − (r + l) / (r − l) · z
    ///   y′ = 2 n y / (t − b) − (t + b) / (t − b) · z
    ///   z′ = (f + n) / (f − n) · z + 2 n f / (n − f)
    ///   ω′ = z
    /// ```
    ///
    /// After the divide z is a + b/z: −1 on the near plane, 1 on the far plane. Source: book, section 8.2.
    #[must_use]
    pub fn project(&self, view: DVec3) -> DVec4 {
        let Self { left, right, bottom, top, near, far } = *self;
        DVec4::new(
            2.0 * near * view.x / (right - left) - (right + left) / (right - left) * view.z,
            2.0 * near * view.y / (top - bottom) - (top + bottom) / (top - bottom) * view.z,
            (far + near) / (far - near) * view.z + 2.0 * near * far / (near - far),
            view.z,
        )
    }
    // ANCHOR_END: project

    /// The same for 0 ≤ z ≤ ω, the depth range of Direct3D: z′ = f / (f − n) · (z − n).
    #[must_use]
    pub fn project_zero_to_one(&self, view: DVec3) -> DVec4 {
        let clip = self.project(view);
        let z = self.far / (self.far - self.near) * (view.z - self.near);
        DVec4::new(clip.x, clip.y, z, clip.w)
    }
}

/// The rectangle of the screen onto which NDC are laid (chapter 8), in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// The column of the left border.
    pub x: f64,
    /// The row of the lower border.
    pub y: f64,
    /// Pixels from the left border to the right one.
    pub width: f64,
    /// Pixels from the lower border to the upper one.
    pub height: f64,
}

impl Viewport {
    /// The whole of a framebuffer.
    #[must_use]
    pub fn whole(rect: Rect) -> Self {
        let [x, y] = [rect.left, rect.bottom].map(f64::from);
        Self { x, y, width: f64::from(rect.right) - x, height: f64::from(rect.top) - y }
    }

    /// The largest rectangle of width : height = `aspect` in the middle of a framebuffer, so that a scene which is made
    /// for that aspect is scaled and not distorted.
    #[must_use]
    pub fn fitting(rect: Rect, aspect: f64) -> Self {
        let whole = Self::whole(rect);
        let width = whole.width.min((whole.height * aspect).round().max(1.0));
        let height = whole.height.min((whole.width / aspect).round().max(1.0));
        let [x, y] = [whole.width - width, whole.height - height].map(|rest| (rest / 2.0).floor());
        Self { x: whole.x + x, y: whole.y + y, width, height }
    }

    // ANCHOR: viewport
    /// NDC → screen: −1..1 becomes 0..width − 1 and 0..height − 1, since the book's pixels sit on whole coordinates.
    ///
    /// Source: book, section 8.2.
    #[must_use]
    pub fn pixel_corners(&self, ndc: DVec3) -> DVec2 {
        DVec2::new(
            self.x + (ndc.x + 1.0) / 2.0 * (self.width - 1.0),
            self.y + (ndc.y + 1.0) / 2.0 * (self.height - 1.0),
        )
    }
    // ANCHOR_END: viewport
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_point_on_the_near_plane_stays() {
        let point = dvec3(3.0, -2.0, 5.0);
        assert_eq!(perspective_divide(perspective(point, 5.0)), point);
    }

    #[test]
    fn straight_lines_stay_straight() {
        let [a, b] = [dvec3(-3.0, 1.0, 2.0), dvec3(5.0, 4.0, 9.0)];
        let project = |p| perspective_divide(perspective(p, 1.0));
        let (start, end) = (project(a), project(b));
        for i in 0..=10 {
            let p = project(a.lerp(b, f64::from(i) / 10.0));
            let off_line = (end.x - start.x) * (p.y - start.y) - (end.y - start.y) * (p.x - start.x);
            assert!(off_line.abs() < 1e-12, "{p} is not on the line");
        }
    }

    #[test]
    fn without_distance_there_is_no_image() {
        assert!(!perspective_divide(perspective(dvec3(1.0, 1.0, 0.0), 1.0)).is_finite());
    }

    /// A frustum that is not symmetric: what symmetric ones hide shows here.
    const ASKEW: Frustum = Frustum { left: -1.0, right: 3.0, bottom: -2.0, top: 4.0, near: 2.0, far: 10.0 };

    #[test]
    fn the_frustum_becomes_a_cube() {
        for (z, ndc_z) in [(2.0, -1.0), (10.0, 1.0)] {
            // The borders at the distance z lie on the rays through those of the near plane.
            for (x, y, ndc) in [
                (-1.0, -2.0, dvec3(-1.0, -1.0, ndc_z)),
                (3.0, 4.0, dvec3(1.0, 1.0, ndc_z)),
                (3.0, -2.0, dvec3(1.0, -1.0, ndc_z)),
            ] {
                let found = perspective_divide(ASKEW.project(dvec3(x * z / 2.0, y * z / 2.0, z)));
                assert!((found - ndc).length() < 1e-12, "{found} is not {ndc}");
            }
        }
    }

    #[test]
    fn the_other_depth_range_differs_in_z_alone() {
        for z in [2.0, 3.0, 7.0, 10.0] {
            let point = dvec3(0.3, -0.7, z);
            let [book, other] =
                [ASKEW.project(point), ASKEW.project_zero_to_one(point)].map(perspective_divide);
            assert_eq!((book.x, book.y), (other.x, other.y));
            assert!((other.z - (book.z + 1.0) / 2.0).abs() < 1e-12, "0..1 is −1..1, shifted and halved");
        }
    }

    #[test]
    fn viewports() {
        let wide = Viewport::fitting(Rect::sized(1920, 1080), 4.0 / 3.0);
        assert_eq!(wide, Viewport { x: 240.0, y: 0.0, width: 1440.0, height: 1080.0 });
        let whole = Viewport::fitting(Rect::sized(640, 480), 4.0 / 3.0);
        assert_eq!(whole, Viewport::whole(Rect::sized(640, 480)));
        assert_eq!(whole.pixel_corners(dvec3(-1.0, 1.0, 0.0)), DVec2::new(0.0, 479.0));
        assert_eq!(whole.pixel_corners(dvec3(1.0, -1.0, 0.0)), DVec2::new(639.0, 0.0));
        for (width, height) in [(1, 1), (1, 16_384), (16_384, 1)] {
            let tiny = Viewport::fitting(Rect::sized(width, height), 4.0 / 3.0);
            assert!(tiny.width >= 1.0 && tiny.height >= 1.0 && tiny.x >= 0.0 && tiny.y >= 0.0, "{tiny:?}");
        }
    }
}
