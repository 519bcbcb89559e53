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

use glam::{DVec3, DVec4};

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
}
