//! Chapters 4, 8 and 10: projection, frustum and viewport, matrices: from the model onto the screen.
//!
//! Takes points in camera space and gives them in homogeneous coordinates (x, y, z, w), the first stage of the data
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

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::rect::Rect;

// ANCHOR: perspective
/// Perspective projection onto the image plane z = `near`: camera space → homogeneous coordinates
/// (n x, n y, n z, z).
///
/// ```text
///          x │         ╱ (x, z)        similar triangles:
///            │     . ╱                     x′ / n = x / z
///            │   x′╱                       x′ = n x / z
///            │ . ╱ ┊
///            └─────┊────────── z       the division waits:
///            O     n                       (n x, n y, n z, z) with w = z
/// ```
///
/// The result is not yet divided: w (the book's ω) keeps the distance, which chapter 5 needs. After
/// the divide z is n for every point, which says nothing; chapter 6 puts a depth there. Source:
/// book, sections 4.2.2 and 4.2.3.
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

/// The perspective divide: homogeneous coordinates → (x/w, y/w, z/w). Not finite for w = 0.
#[must_use]
#[inline]
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
    /// Projects so that the frustum becomes the cube −w ≤ x, y, z ≤ w: camera space → clip space.
    ///
    /// ```text
    ///   x′ = 2 n x / (r − l) − (r + l) / (r − l) · z
    ///   y′ = 2 n y / (t − b) − (t + b) / (t − b) · z
    ///   z′ = (f + n) / (f − n) · z + 2 n f / (n − f)
    ///   w′ = z
    /// ```
    ///
    /// After the divide z is a + b/z: −1 on the near plane, 1 on the far plane. Source: book,
    /// section 8.2.
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

    /// The same as a matrix (chapter 10): `clip_from_view`, a column vector on its right.
    ///
    /// ```text
    ///   ┌ 2n/(r−l)     0       −(r+l)/(r−l)      0      ┐
    ///   │    0      2n/(t−b)   −(t+b)/(t−b)      0      │
    ///   │    0         0        (f+n)/(f−n)  2nf/(n−f)  │
    ///   └    0         0             1           0      ┘
    /// ```
    ///
    /// Left-handed camera space, z of NDC from −1 to 1. Source: book, section 10.1.
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        let Self { left: l, right: r, bottom: b, top: t, near: n, far: f } = *self;
        rows([
            [2.0 * n / (r - l), 0.0, -(r + l) / (r - l), 0.0],
            [0.0, 2.0 * n / (t - b), -(t + b) / (t - b), 0.0],
            [0.0, 0.0, (f + n) / (f - n), 2.0 * n * f / (n - f)],
            [0.0, 0.0, 1.0, 0.0],
        ])
    }

    /// The symmetric frustum of a camera that sees `fov_y` radians from bottom to top; `aspect` = width : height.
    ///
    /// ```text
    ///          ╱│ top = near · tan(fov_y / 2)
    ///        ╱  │
    ///      O ───┼──  fov_y / 2 on either side of the axis
    ///        ╲  │
    ///          ╲│    right = top · aspect
    /// ```
    #[must_use]
    pub fn from_field_of_view(fov_y: f64, aspect: f64, near: f64, far: f64) -> Self {
        let top = near * libm::tan(fov_y / 2.0);
        let right = top * aspect;
        Self { left: -right, right, bottom: -top, top, near, far }
    }

    /// The same for 0 ≤ z ≤ w, the depth range of Direct3D: z′ = f / (f − n) · (z − n).
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
    /// NDC → screen: −1..1 becomes 0..width − 1 and 0..height − 1, since the book's pixels sit on
    /// whole coordinates.
    ///
    /// Source: book, section 8.2.
    #[must_use]
    #[inline]
    pub fn pixel_corners(&self, ndc: DVec3) -> DVec2 {
        DVec2::new(
            self.x + (ndc.x + 1.0) / 2.0 * (self.width - 1.0),
            self.y + (ndc.y + 1.0) / 2.0 * (self.height - 1.0),
        )
    }
    // ANCHOR_END: viewport

    // ANCHOR: pixel_areas
    /// NDC → screen: −1..1 becomes 0..width and 0..height; a pixel is a square, (i, j) the one from
    /// i to i + 1.
    ///
    /// ```text
    ///   book:    ●─────●─────●─────●      4 pixels are 3 apart, −1 and 1 lie on the outer ones
    ///
    ///   here:  ┌─────┬─────┬─────┬─────┐
    ///          │  ●  │  ●  │  ●  │  ●  │  4 pixels are 4 wide, −1 and 1 are the outer borders
    ///          └─────┴─────┴─────┴─────┘
    /// ```
    ///
    /// Source: Direct3D 11.3 functional specification, 3.3 and 15.6.
    #[must_use]
    #[inline]
    pub fn pixel_areas(&self, ndc: DVec3) -> DVec2 {
        let Self { x, y, width, height } = *self;
        DVec2::new(x + (ndc.x + 1.0) / 2.0 * width, y + (ndc.y + 1.0) / 2.0 * height)
    }
    // ANCHOR_END: pixel_areas

    /// The same as a matrix (chapter 10): `screen_from_ndc`.
    ///
    /// ```text
    ///   ┌ (w−1)/2     0     0   x + (w−1)/2 ┐
    ///   │    0     (h−1)/2  0   y + (h−1)/2 │      z stays as it is
    ///   │    0        0     1        0      │
    ///   └    0        0     0        1      ┘
    /// ```
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        let [x, y] = [(self.width - 1.0) / 2.0, (self.height - 1.0) / 2.0];
        rows([
            [x, 0.0, 0.0, self.x + x],
            [0.0, y, 0.0, self.y + y],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }
}

/// A matrix as it is drawn, row by row; glam keeps columns.
fn rows(rows: [[f64; 4]; 4]) -> DMat4 {
    DMat4::from_cols_array_2d(&rows).transpose()
}

// ANCHOR: matrices
/// Moves by a vector. Book, section 10.3.
///
/// ```text
///   ┌ 1 0 0 a ┐        points (w = 1) move,
///   │ 0 1 0 b │        directions (w = 0) do not
///   │ 0 0 1 c │
///   └ 0 0 0 1 ┘
/// ```
#[must_use]
pub fn translate(by: DVec3) -> DMat4 {
    let [a, b, c] = by.to_array();
    rows([[1.0, 0.0, 0.0, a], [0.0, 1.0, 0.0, b], [0.0, 0.0, 1.0, c], [0.0, 0.0, 0.0, 1.0]])
}

/// Scales along the three axes, away from the origin. Book, section 10.2.
///
/// ```text
///   ┌ a 0 0 0 ┐
///   │ 0 b 0 0 │
///   │ 0 0 c 0 │
///   └ 0 0 0 1 ┘
/// ```
#[must_use]
pub fn scale(by: DVec3) -> DMat4 {
    let [a, b, c] = by.to_array();
    rows([[a, 0.0, 0.0, 0.0], [0.0, b, 0.0, 0.0], [0.0, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]])
}

/// Turns about the z axis, +x towards +y: counter-clockwise on the screen. Radians. The book's
/// `RotateZ`, section 10.4.
///
/// ```text
///   ┌ cos −sin 0 0 ┐        y
///   │ sin  cos 0 0 │        │ ╮
///   │  0    0  1 0 │        └──┴ x
///   └  0    0  0 1 ┘
/// ```
#[must_use]
pub fn rotate_x_to_y(angle: f64) -> DMat4 {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    rows([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
}

/// Turns about the x axis, +z towards +y: what is farther away comes up. Radians. The book's
/// `RotateX`, section 10.4.
///
/// ```text
///   ┌ 1   0    0  0 ┐        y
///   │ 0  cos  sin 0 │        │ ╮
///   │ 0 −sin  cos 0 │        └──┴ z
///   └ 0   0    0  1 ┘
/// ```
#[must_use]
pub fn rotate_z_to_y(angle: f64) -> DMat4 {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    rows([[1.0, 0.0, 0.0, 0.0], [0.0, c, s, 0.0], [0.0, -s, c, 0.0], [0.0, 0.0, 0.0, 1.0]])
}

/// Turns about the y axis, +x towards +z: what is on the right goes away from us. Radians. The
/// book's `RotateY`, section 10.4.
///
/// ```text
///   ┌ cos  0 −sin 0 ┐        z
///   │  0   1   0  0 │        │ ╮
///   │ sin  0  cos 0 │        └──┴ x
///   └  0   0   0  1 ┘
/// ```
#[must_use]
pub fn rotate_x_to_z(angle: f64) -> DMat4 {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    rows([[c, 0.0, -s, 0.0], [0.0, 1.0, 0.0, 0.0], [s, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]])
}

/// A transformation as seen from a point: T(p) · M · T(−p). A rotation then turns about `pivot`, a
/// scale grows away from it. Book, section 10.5.
#[must_use]
pub fn about(pivot: DVec3, transformation: DMat4) -> DMat4 {
    translate(pivot) * transformation * translate(-pivot)
}
// ANCHOR_END: matrices

// ANCHOR: look_at
/// `view_from_world` of a camera at `eye` that looks towards `target`, with `up` upwards in the
/// picture.
///
/// ```text
///   ┌ right.x    right.y    right.z    −right·eye   ┐   forward = target − eye     (+z)
///   │ up.x       up.y       up.z       −up·eye      │   right   = up × forward     (+x)
///   │ forward.x  forward.y  forward.z  −forward·eye │   up      = forward × right  (+y)
///   └    0          0          0           1        ┘   each of length 1
/// ```
///
/// The eye is subtracted, not the target: the eye becomes the origin. Left-handed. Not finite if
/// `up` points along the line of sight, to within 10⁻¹² of a full angle: what is left of it then
/// comes from rounding. Nor if the square of its length is 0 or infinite, as for lengths of 10⁻²⁰⁰
/// and 10²⁰⁰. Source: second and fourth note (world to view space).
#[must_use]
pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    let forward = (target - eye).normalize();
    let right = up.cross(forward);
    let is_along = right.length() <= 1e-12 * up.length();
    let right = if is_along { DVec3::NAN } else { right.normalize() };
    let up = forward.cross(right);
    let row = |axis: DVec3| axis.extend(-axis.dot(eye)).to_array();
    rows([row(right), row(up), row(forward), [0.0, 0.0, 0.0, 1.0]])
}
// ANCHOR_END: look_at

// ANCHOR: normal_matrix
/// The matrix for normals that belongs to a matrix for points: the inverse of its transpose.
///
/// A normal n is perpendicular to every direction t of a surface, n·t = 0. When t becomes M t, n
/// must become (M⁻¹)ᵀ n, since ((M⁻¹)ᵀ n)·(M t) = n·(M⁻¹ M t) = n·t. For rotations that is M
/// itself. Not finite if M flattens space. Source: fourth note, transformation of normals.
#[must_use]
pub fn normal_matrix(world_from_model: DMat4) -> DMat3 {
    DMat3::from_mat4(world_from_model).inverse().transpose()
}
// ANCHOR_END: normal_matrix

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn a_point_on_the_image_plane_stays() {
        let point = dvec3(3.0, -2.0, 5.0);
        assert_eq!(perspective_divide(perspective(point, 5.0)), point);
    }

    #[test]
    fn without_perspective_distance_changes_nothing() {
        for point in [dvec3(3.0, -2.0, 5.0), dvec3(3.0, -2.0, 50.0)] {
            assert_eq!(perspective_divide(orthographic(point)), point);
        }
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

    #[test]
    fn a_viewport_lies_where_its_rectangle_does() {
        let rect = Rect { left: 10, bottom: 20, right: 40, top: 100 };
        assert_eq!(Viewport::whole(rect), Viewport { x: 10.0, y: 20.0, width: 30.0, height: 80.0 });
        // Of the 65 rows that are left 32 are below.
        let low = Viewport::fitting(rect, 2.0);
        assert_eq!(low, Viewport { x: 10.0, y: 52.0, width: 30.0, height: 15.0 });
        let narrow = Viewport::fitting(Rect { left: 10, bottom: 20, right: 90, top: 50 }, 0.5);
        assert_eq!(narrow, Viewport { x: 42.0, y: 20.0, width: 15.0, height: 30.0 });
    }

    #[test]
    fn where_a_pixel_is_an_area_the_borders_are_the_outer_ones() {
        let viewport = Viewport { x: 7.0, y: -3.0, width: 200.0, height: 100.0 };
        assert_eq!(viewport.pixel_areas(dvec3(-1.0, 1.0, 0.0)), DVec2::new(7.0, 97.0));
        assert_eq!(viewport.pixel_areas(dvec3(1.0, -1.0, 0.0)), DVec2::new(207.0, -3.0));
        assert_eq!(viewport.pixel_areas(dvec3(0.25, -0.5, 0.0)), DVec2::new(132.0, 22.0));
    }

    fn apply(matrix: DMat4, point: DVec3) -> DVec3 {
        perspective_divide(matrix * point.extend(1.0))
    }

    fn assert_near(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-12, "{a} is not {b}");
    }

    #[test]
    fn matrices_by_hand() {
        let p = dvec3(1.0, 2.0, 3.0);
        assert_eq!(apply(translate(dvec3(10.0, 20.0, 30.0)), p), dvec3(11.0, 22.0, 33.0));
        assert_eq!(
            (translate(dvec3(9.0, 9.0, 9.0)) * p.extend(0.0)).truncate(),
            p,
            "a direction does not move"
        );
        assert_eq!(apply(scale(dvec3(2.0, 3.0, -4.0)), p), dvec3(2.0, 6.0, -12.0));
        // A quarter turn each.
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_near(apply(rotate_x_to_y(quarter), p), dvec3(-2.0, 1.0, 3.0));
        assert_near(apply(rotate_z_to_y(quarter), p), dvec3(1.0, 3.0, -2.0));
        assert_near(apply(rotate_x_to_z(quarter), p), dvec3(-3.0, 2.0, 1.0));
        // About a point, which stays where it is.
        let pivot = dvec3(1.0, 1.0, 0.0);
        let turn = about(pivot, rotate_x_to_y(quarter));
        assert_near(apply(turn, pivot), pivot);
        assert_near(apply(turn, dvec3(2.0, 1.0, 0.0)), dvec3(1.0, 2.0, 0.0));
    }

    #[test]
    fn matrices_by_glam() {
        let angle = 0.7;
        let by = dvec3(1.0, -2.0, 0.5);
        assert_eq!(translate(by), DMat4::from_translation(by));
        assert_eq!(scale(by), DMat4::from_scale(by));
        // glam turns y towards z and z towards x: two of the book's three turn the other way.
        assert!(rotate_x_to_y(angle).abs_diff_eq(DMat4::from_rotation_z(angle), 1e-15));
        assert!(rotate_z_to_y(angle).abs_diff_eq(DMat4::from_rotation_x(-angle), 1e-15));
        assert!(rotate_x_to_z(angle).abs_diff_eq(DMat4::from_rotation_y(-angle), 1e-15));

        let (eye, target, up) = (dvec3(3.0, 2.0, -5.0), dvec3(-1.0, 0.5, 4.0), dvec3(0.2, 1.0, 0.1));
        assert!(
            look_at(eye, target, up)
                .abs_diff_eq(glam::dcamera::lh::view::look_at_mat4(eye, target, up), 1e-12)
        );
        let camera = Frustum::from_field_of_view(1.1, 1.6, 0.5, 30.0);
        let glams = glam::dcamera::lh::proj::opengl::perspective(1.1, 1.6, 0.5, 30.0);
        assert!(camera.matrix().abs_diff_eq(glams, 1e-12));
    }

    #[test]
    fn projection_by_formula_and_by_matrix() {
        for point in [dvec3(0.3, -0.7, 3.0), dvec3(5.0, 4.0, 9.0), dvec3(-2.0, 1.0, -1.0)] {
            assert!((ASKEW.matrix() * point.extend(1.0) - ASKEW.project(point)).length() < 1e-12);
        }
    }

    #[test]
    fn viewport_by_formula_and_by_matrix() {
        let viewport = Viewport { x: 7.0, y: -3.0, width: 200.0, height: 100.0 };
        let ndc = dvec3(0.25, -0.5, 0.75);
        assert!((apply(viewport.matrix(), ndc).truncate() - viewport.pixel_corners(ndc)).length() < 1e-12);
    }

    #[test]
    fn the_eye_becomes_the_origin_and_the_target_lies_ahead() {
        let (eye, target) = (dvec3(3.0, 2.0, -5.0), dvec3(-1.0, 0.5, 4.0));
        let view_from_world = look_at(eye, target, DVec3::Y);
        assert_near(apply(view_from_world, eye), DVec3::ZERO);
        assert_near(apply(view_from_world, target), dvec3(0.0, 0.0, eye.distance(target)));
        assert!(apply(view_from_world, target + DVec3::Y).y > 0.0, "up is up");
        let right = apply(view_from_world, target + dvec3(1.0, 0.0, 0.0));
        assert!(right.x > 0.0, "seen along +z, +x is on the right");
    }

    #[test]
    fn up_along_the_line_of_sight_gives_no_picture() {
        for i in 0..1000 {
            let [x, y, z] = [7, 11, 13].map(|k| f64::from(i * k % 97) - 45.3);
            let (eye, up) = (dvec3(z, x, y), dvec3(x, y, z));
            for up in [up, -up, up * 1e-9] {
                let view = look_at(eye, eye + dvec3(x, y, z) * 3.7, up);
                assert!(view.x_axis.x.is_nan() && !view.is_finite(), "{view}");
            }
            let beside = look_at(eye, eye + dvec3(x, y, z) * 3.7, up + dvec3(-y, x, 0.0) * 1e-6);
            assert!(beside.is_finite());
            let sized = |size: f64| look_at(eye, eye + dvec3(x, y, z) * 3.7, dvec3(y, -x, 1.0) * size);
            assert!([1e-150, 1e150].map(sized).iter().all(DMat4::is_finite));
            assert!(![1e-200, 1e200].map(sized).iter().any(DMat4::is_finite));
        }
    }

    #[test]
    fn normals_stay_perpendicular() {
        // A slope under a scale of 1 : 4: the model matrix would tilt the normal the wrong way.
        let world_from_model =
            translate(dvec3(5.0, 6.0, 7.0)) * scale(dvec3(1.0, 4.0, 2.0)) * rotate_x_to_y(0.4);
        let (tangent, normal) = (dvec3(1.0, 1.0, 0.0), dvec3(-1.0, 1.0, 0.0));
        let new_tangent = (world_from_model * tangent.extend(0.0)).truncate();
        assert!((normal_matrix(world_from_model) * normal).dot(new_tangent).abs() < 1e-12);
        let wrong = (world_from_model * normal.extend(0.0)).truncate();
        assert!(wrong.dot(new_tangent).abs() > 1.0);
    }
}
