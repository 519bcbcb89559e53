//! Chapter 11: normals from faces, for models that have none.
//!
//! Corners in left-handed model space go in, in the order that an OBJ file has them; unit vectors come out. Where there is
//! no direction, because faces have no area or turn against each other, it is −z.

use std::collections::HashMap;

use glam::DVec3;

/// A vector upright on a face, as long as twice its area; outwards for counter-clockwise faces.
///
/// ```text
///          c
///         ╱ ╲         (c − a) × (b − a): model space is left-handed here, and so z has changed its
///        ╱   ╲        sign since the file was written, and the cross product with it
///       a ─── b
/// ```
fn upright([a, b, c]: [DVec3; 3]) -> DVec3 {
    (c - a).cross(b - a)
}

fn unit(normal: DVec3) -> DVec3 {
    normal.normalize_or(DVec3::NEG_Z)
}

/// The normal of a face by itself.
pub(crate) fn face_normal(corners: [DVec3; 3]) -> DVec3 {
    unit(upright(corners))
}

/// A position by which corners of different objects are recognized as the same.
fn key_of(position: DVec3) -> [u64; 3] {
    // Adding zero makes one of the two zeros.
    position.to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}

/// The sums of the vectors upright on the faces around each position, of whichever objects: larger faces count more.
#[derive(Default)]
pub(crate) struct SmoothNormals(HashMap<[u64; 3], DVec3>);

impl SmoothNormals {
    /// Adds a face.
    pub(crate) fn add(&mut self, corners: [DVec3; 3]) {
        let normal = upright(corners);
        for corner in corners {
            *self.0.entry(key_of(corner)).or_default() += normal;
        }
    }

    /// The mean of the normals around a position.
    pub(crate) fn at(&self, position: DVec3) -> DVec3 {
        unit(self.0.get(&key_of(position)).copied().unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn larger_faces_count_more() {
        let left = [DVec3::ZERO, DVec3::Y * 3.0, DVec3::Z];
        let front = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!([left, front].map(face_normal), [DVec3::NEG_X, DVec3::NEG_Z]);
        let mut smooth = SmoothNormals::default();
        smooth.add(left);
        smooth.add(front);
        assert!(smooth.at(dvec3(-0.0, 0.0, 0.0)).abs_diff_eq(dvec3(-3.0, 0.0, -1.0).normalize(), 1e-15));
        assert_eq!(smooth.at(DVec3::X), DVec3::NEG_Z, "of one face only");
    }

    #[test]
    fn no_direction() {
        let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        assert_eq!(face_normal(line), DVec3::NEG_Z);
        let mut smooth = SmoothNormals::default();
        assert_eq!(smooth.at(DVec3::X), DVec3::NEG_Z, "of no face");
        smooth.add(line);
        assert_eq!(smooth.at(DVec3::X), DVec3::NEG_Z);
    }
}
