//! Chapter 11: normals from faces, for models that have none.
//!
//! Corners in left-handed model space go in, in the order that an OBJ file has them; unit vectors come out. Where there
//! is no direction, because no face has an area, it is −z.
//!
//! A face counts at each of its corners as much as its *angle* there. Cut a polygon into triangles in whatever way: at a
//! corner the angles of the pieces add up to the angle of the whole, and the normal stays as it is. (Weights by area do
//! not have that: a corner of a square gets one triangle or two, by how it is cut.)
//!
//! ```text
//!        ╱│╲                at p meet three faces of a cube, one of them cut in two:
//!       ╱ │ ╲               90° + 90° + (30° + 60°), so the normal is (1, 1, 1)/√3
//!      ╱  p  ╲              whichever diagonal was taken
//!      │ ╱·╲  │
//! ```
//!
//! Two faces over the same corners that turn against each other are the two sides of a sheet, and each keeps its own: of
//! such a pair one alone counts for a face beside it, the one that runs along their common edge the other way, as
//! neighbors on one side do. Without a common edge it is the one that does not turn away.
//!
//! Source: G. Thürmer, C. A. Wüthrich, Computing vertex normals from polygonal facets, 1998.

use std::collections::HashMap;

use arrayvec::ArrayVec;
use glam::DVec3;

/// Where more faces than this meet, some of them sheets, each keeps its own normal: no model that is meant has so many.
const MAX_AROUND: usize = 128;

/// A vector perpendicular to a polygon, as long as twice its area; outwards if the polygon runs counter-clockwise.
///
/// ```text
///          c
///         ╱ ╲         (c − a) × (b − a): model space is left-handed here, and so z has changed its
///        ╱   ╲        sign since the file was written, and the cross product with it
///       a ─── b
/// ```
///
/// A polygon is the sum of the triangles of its fan: those that lie outside count negative. (Newell's method.)
pub(super) fn area_vector(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).skip(1).map(|pair| (pair[1] - corners[0]).cross(pair[0] - corners[0])).sum()
}

/// The same direction with length 1; nothing if there is no direction.
pub(super) fn direction(vector: DVec3) -> Option<DVec3> {
    // In two steps, since squares of large or small coordinates may leave the range.
    let largest = vector.abs().max_element();
    (largest > 0.0 && vector.is_finite()).then(|| (vector / largest).normalize())
}

/// The normal of a face by itself.
pub(super) fn face_normal(corners: &[DVec3]) -> DVec3 {
    direction(area_vector(corners)).unwrap_or(DVec3::NEG_Z)
}

/// The angle at `b` inside a polygon that `normal` is perpendicular to, in 0..2π.
fn angle([a, b, c]: [DVec3; 3], normal: DVec3) -> f64 {
    let (to_next, to_last) = (c - b, a - b);
    let cross = to_last.cross(to_next);
    let angle = libm::atan2(cross.length(), to_next.dot(to_last));
    // A concave corner: the outer angle was measured.
    if cross.dot(normal) < 0.0 { std::f64::consts::TAU - angle } else { angle }
}

/// One face around a position.
#[derive(Clone, Copy)]
struct Around {
    /// Its unit normal times its angle.
    weighted: DVec3,
    is_paired: bool,
    neighbors: [u32; 2],
}

/// The corners before and after one of a face.
fn neighbors(face: &[u32], at: usize) -> [u32; 2] {
    let before = if at == 0 { face.len() - 1 } else { at - 1 };
    let after = if at + 1 == face.len() { 0 } else { at + 1 };
    [face[before], face[after]]
}

impl Around {
    /// Whether it counts for a face with this normal and these neighbors.
    fn counts(&self, normal: DVec3, [before, after]: [u32; 2]) -> bool {
        let [own_before, own_after] = self.neighbors;
        let is_against = (own_before == after) ^ (own_after == before);
        let is_along = (own_before == before) ^ (own_after == after);
        match (is_against, is_along) {
            _ if !self.is_paired => true,
            (true, false) => true,
            (false, true) => false,
            _ => self.weighted.dot(normal) > 0.0,
        }
    }
}

/// The normals that the faces of all objects make where they meet.
///
/// Positions have numbers, by which corners of different objects are recognized as the same, and faces have the numbers
/// in which they were added.
#[derive(Default)]
pub(super) struct SmoothNormals {
    numbers: HashMap<[u64; 3], u32>,
    positions: Vec<DVec3>,
    /// The sum around each position.
    sums: Vec<DVec3>,
    /// The normal of each face, or zero.
    normals: Vec<DVec3>,
    /// The corners of all faces, and where each face ends.
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// The faces around positions where there are pairs.
    around: HashMap<u32, Vec<Around>>,
}

impl SmoothNormals {
    /// The number of a position: the same for all that are equal.
    pub(super) fn number(&mut self, position: DVec3) -> u32 {
        let next = self.positions.len() as u32;
        // Adding zero makes one of the two zeros.
        let key = position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.positions.push(position);
            self.sums.push(DVec3::ZERO);
        }
        number
    }

    /// Adds the next face, by the numbers of its positions.
    pub(super) fn add(&mut self, face: &[u32]) {
        let corners: ArrayVec<DVec3, 4>;
        let many: Vec<DVec3>;
        let positions: &[DVec3] = if face.len() <= 4 {
            corners = face.iter().map(|&number| self.positions[number as usize]).collect();
            &corners
        } else {
            many = face.iter().map(|&number| self.positions[number as usize]).collect();
            &many
        };
        let normal = direction(area_vector(positions)).unwrap_or(DVec3::ZERO);
        self.normals.push(normal);
        self.corners.extend_from_slice(face);
        self.ends.push(self.corners.len());
        for (at, &number) in face.iter().enumerate() {
            self.sums[number as usize] += weighted(positions, at, normal);
        }
    }

    /// The corners of a face.
    fn face(&self, face: usize) -> &[u32] {
        let start = if face == 0 { 0 } else { self.ends[face - 1] };
        &self.corners[start..self.ends[face]]
    }

    /// Finds the sheets that have two sides, when all faces are there.
    pub(super) fn find_pairs(&mut self) {
        let is_paired = self.paired_faces();
        if !is_paired.contains(&true) {
            return;
        }
        let mut around: HashMap<u32, Vec<Around>> = HashMap::new();
        for face in (0..is_paired.len()).filter(|&face| is_paired[face]) {
            around.extend(self.face(face).iter().map(|&number| (number, Vec::new())));
        }
        for (face, &is_paired) in is_paired.iter().enumerate() {
            let numbers = self.face(face);
            let positions: Vec<DVec3> = numbers.iter().map(|&n| self.positions[n as usize]).collect();
            for (at, number) in numbers.iter().enumerate() {
                if let Some(faces) = around.get_mut(number) {
                    let weighted = weighted(&positions, at, self.normals[face]);
                    faces.push(Around { weighted, is_paired, neighbors: neighbors(numbers, at) });
                }
            }
        }
        self.around = around;
    }

    /// Which faces have another one over the same corners that turns against them.
    fn paired_faces(&self) -> Vec<bool> {
        // The same for all faces that have the same corners, in whatever order.
        let mark = |face| self.face(face).iter().map(|&number| scattered(number)).fold(0, u64::wrapping_add);
        let mut marks: Vec<(u64, u32)> = (0..self.ends.len()).map(|face| (mark(face), face as u32)).collect();
        marks.sort_unstable();
        let sorted = |face: u32| {
            let mut corners = self.face(face as usize).to_vec();
            corners.sort_unstable();
            corners
        };
        let mut is_paired = vec![false; self.ends.len()];
        for alike in marks.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1) {
            let first = alike[0].1;
            let corners = sorted(first);
            let turned = |face: u32| self.normals[first as usize].dot(self.normals[face as usize]) < 0.0;
            let same: Vec<u32> =
                alike.iter().map(|&(_, face)| face).filter(|&face| sorted(face) == corners).collect();
            if same.iter().any(|&face| turned(face)) {
                same.iter().for_each(|&face| is_paired[face as usize] = true);
            }
        }
        is_paired
    }

    /// The normal of a face at one of its corners, both counted from 0.
    pub(super) fn at(&self, face: usize, corner: usize) -> DVec3 {
        let corners = self.face(face);
        let (number, own) = (corners[corner], self.normals[face]);
        let sum = match self.around.get(&number) {
            None => self.sums[number as usize],
            Some(around) if around.len() > MAX_AROUND => own,
            Some(around) => {
                let beside = neighbors(corners, corner);
                around.iter().filter(|other| other.counts(own, beside)).map(|other| other.weighted).sum()
            }
        };
        direction(sum).unwrap_or(DVec3::NEG_Z)
    }
}

/// The normal of a face, as long as its angle at one of its corners. Corners that follow one another in the same place are
/// one corner, as at the pole of a sphere: the first of them counts, the others are zero.
fn weighted(positions: &[DVec3], at: usize, normal: DVec3) -> DVec3 {
    let next = |i: usize| if i + 1 == positions.len() { 0 } else { i + 1 };
    let here = positions[at];
    let before = positions[if at == 0 { positions.len() - 1 } else { at - 1 }];
    if before == here {
        return DVec3::ZERO;
    }
    let mut after = next(at);
    while positions[after] == here {
        after = next(after);
    }
    normal * angle([before, here, positions[after]], normal)
}

/// A number that shares few bits with those of its neighbors, so that sums of such numbers seldom are equal.
/// (The last step of SplitMix64.)
fn scattered(number: u32) -> u64 {
    let mut bits = u64::from(number).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    /// The normals at each corner of each face; z is negated, as on reading.
    fn smooth(positions: &[[f64; 3]], faces: &[&[usize]]) -> Vec<Vec<DVec3>> {
        let mut normals = SmoothNormals::default();
        let numbers: Vec<u32> = positions.iter().map(|&[x, y, z]| normals.number(dvec3(x, y, -z))).collect();
        let faces: Vec<Vec<u32>> =
            faces.iter().map(|face| face.iter().map(|&i| numbers[i]).collect()).collect();
        faces.iter().for_each(|face| normals.add(face));
        normals.find_pairs();
        let of_face = |face: usize| (0..faces[face].len()).map(|corner| normals.at(face, corner)).collect();
        (0..faces.len()).map(of_face).collect()
    }

    const CUBE: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    const QUADS: [[usize; 4]; 6] =
        [[4, 5, 6, 7], [1, 0, 3, 2], [5, 1, 2, 6], [0, 4, 7, 3], [7, 6, 2, 3], [0, 1, 5, 4]];

    #[test]
    fn a_vector_that_leaves_the_range_has_no_direction() {
        assert_eq!(direction(dvec3(0.0, 1e308, 0.0)), Some(DVec3::Y));
        for odd in [f64::NAN, f64::INFINITY] {
            assert_eq!(direction(dvec3(odd, 5.0, 0.0)), None);
        }
        // (b − a) × (c − a) is ∞ − ∞ along x.
        let corners = [dvec3(0.0, 0.0, 0.0), dvec3(0.0, 1e308, 1e308), dvec3(1.0, 1e308, 1e308)];
        assert!(area_vector(&corners).x.is_nan());
        assert_eq!(face_normal(&corners), DVec3::NEG_Z);
    }

    #[test]
    fn a_cube_however_it_is_cut() {
        let expected = |corner: usize| {
            let [x, y, z] = CUBE[corner];
            dvec3(x, y, -z) / 3.0_f64.sqrt()
        };
        // All ways: six quads from any corner, or each cut along either diagonal.
        for start in 0..4 {
            let turned = QUADS.map(|mut quad| {
                quad.rotate_left(start);
                quad
            });
            let quads: Vec<&[usize]> = turned.iter().map(<[usize; 4]>::as_slice).collect();
            let halves: Vec<[usize; 3]> =
                turned.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
            let halves: Vec<&[usize]> = halves.iter().map(<[usize; 3]>::as_slice).collect();
            for faces in [quads, halves] {
                for (face, normals) in faces.iter().zip(smooth(&CUBE, &faces)) {
                    for (&corner, normal) in face.iter().zip(normals) {
                        assert!(normal.abs_diff_eq(expected(corner), 1e-15), "{corner}: {normal}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_sheet_has_two_sides() {
        // A roof of two quads, flat or steep, each with both windings.
        for height in [1.0, 5.0] {
            let roof = [
                [0.0, 0.0, 0.0],
                [1.0, height, 0.0],
                [1.0, height, -1.0],
                [0.0, 0.0, -1.0],
                [2.0, 0.0, 0.0],
                [2.0, 0.0, -1.0],
            ];
            let fronts: [&[usize]; 2] = [&[0, 1, 2, 3], &[1, 4, 5, 2]];
            let backs: [&[usize]; 2] = [&[3, 2, 1, 0], &[2, 5, 4, 1]];
            let alone = smooth(&roof, &fronts);
            let both = smooth(&roof, &[fronts[0], fronts[1], backs[0], backs[1]]);
            assert_eq!(both[..2], alone[..], "as if there were no back");
            for side in 0..2 {
                for (&normal, corner) in both[side].iter().zip(fronts[side]) {
                    let turned = backs[side].iter().position(|other| other == corner).expect("shared");
                    assert!(both[side + 2][turned].abs_diff_eq(-normal, 1e-15));
                }
            }
            let single = smooth(&roof, &[fronts[0], backs[0], fronts[1]]);
            assert_eq!(single[0], alone[0], "a neighbor of one side counts as it stands");
            assert_eq!(single[2], alone[1], "and for it the side that goes on where it ends");
        }
    }

    #[test]
    fn what_is_no_sheet_counts_whatever_it_faces() {
        // The tips of two triangles that turn away from each other.
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.5], [0.0, -1.0, 0.5]];
        let (front, back, other): ([usize; 3], [usize; 3], [usize; 3]) = ([0, 1, 2], [0, 2, 1], [0, 4, 3]);
        let alone = smooth(&places, &[&front, &other]);
        let with_a_back = smooth(&places, &[&front, &other, &back]);
        assert_eq!(with_a_back[0], alone[0]);
    }

    #[test]
    fn a_sheet_is_two_faces_that_turn_against_each_other() {
        let paired = |faces: &[[u32; 3]]| {
            let mut normals = SmoothNormals::default();
            for place in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X * 2.0] {
                normals.number(place);
            }
            faces.iter().for_each(|face| normals.add(face));
            normals.paired_faces()
        };
        assert_eq!(paired(&[[0, 1, 2], [1, 3, 2], [2, 1, 0]]), [true, false, true]);
        assert_eq!(paired(&[[0, 1, 2], [1, 2, 0]]), [false; 2], "the same one twice");
        assert_eq!(paired(&[[0, 1, 3], [3, 1, 0]]), [false; 2], "without area");
    }

    #[test]
    fn equal_positions_have_one_number() {
        let mut normals = SmoothNormals::default();
        let places = [DVec3::ZERO, DVec3::X, dvec3(-0.0, 0.0, -0.0), DVec3::X];
        assert_eq!(places.map(|place| normals.number(place)), [0, 1, 0, 1]);
    }

    #[test]
    fn where_very_many_sheets_meet_each_keeps_its_own() {
        // The tip of a flat cone whose faces have both windings.
        let at_tip = |count: usize| {
            let around = (0..count).map(|i| std::f64::consts::TAU * i as f64 / count as f64);
            let base = around.map(|angle| [libm::cos(angle), 0.0, libm::sin(angle)]);
            let positions: Vec<_> = std::iter::once([0.0, 0.5, 0.0]).chain(base).collect();
            let sides = (0..count).map(|i| [i + 1, (i + 1) % count + 1]);
            let faces: Vec<_> = sides.flat_map(|[a, b]| [[0, a, b], [0, b, a]]).collect();
            let faces: Vec<&[usize]> = faces.iter().map(<[usize; 3]>::as_slice).collect();
            smooth(&positions, &faces)[0][0].y.abs()
        };
        assert!((at_tip(MAX_AROUND / 2) - 1.0).abs() < 1e-12, "along the axis");
        assert!(at_tip(MAX_AROUND / 2 + 1) < 0.9, "perpendicular to the side");
    }

    #[test]
    fn concave_corners_have_their_inner_angle() {
        let dent = [dvec3(0.0, 0.0, 0.0), dvec3(1.0, 1.0, 0.0), dvec3(2.0, 0.0, 0.0), dvec3(1.0, 3.0, 0.0)];
        let normal = face_normal(&dent);
        assert_eq!(normal, DVec3::NEG_Z);
        let angles: Vec<f64> = (0..4).map(|at| weighted(&dent, at, normal).length()).collect();
        assert!((angles[1] - 1.5 * std::f64::consts::PI).abs() < 1e-15);
        assert!((angles.iter().sum::<f64>() - std::f64::consts::TAU).abs() < 1e-14, "as in every quadrangle");
        // A square that runs out to a point and back.
        let spike = [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let spike = spike.map(|[x, y]| dvec3(x, y, 0.0));
        let angles = [0, 1, 2, 3, 4, 5].map(|at| weighted(&spike, at, normal).length());
        let right = std::f64::consts::FRAC_PI_2;
        for (angle, rights) in angles.into_iter().zip([1.0, 2.0, 0.0, 3.0, 1.0, 1.0]) {
            assert!((angle - rights * right).abs() < 1e-15, "{angles:?}");
        }
    }

    #[test]
    fn a_corner_that_stands_twice_counts_once() {
        // The pole of a ball: quads of which two corners are in one place, whichever two.
        let [a, b, pole] = [DVec3::NEG_X, DVec3::X, DVec3::Y];
        let normal = face_normal(&[a, b, pole]);
        for face in [[a, b, pole, pole], [pole, a, b, pole], [pole, pole, a, b]] {
            let at_pole = |at: usize| weighted(&face, at, normal).length();
            let sum: f64 = (0..4).filter(|&at| face[at] == pole).map(at_pole).sum();
            assert!((sum - std::f64::consts::FRAC_PI_2).abs() < 1e-15, "{face:?}: {sum}");
        }
    }

    #[test]
    fn scattered_numbers_are_those_of_split_mix_64() {
        let first_three = [0xE220_A839_7B1D_CDAF, 0x6E78_9E6A_A1B9_65F4, 0x06C4_5D18_8009_454F];
        assert_eq!([0, 1, 2].map(scattered), first_three);
    }

    #[test]
    fn no_direction() {
        let line = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(face_normal(&line.map(DVec3::from_array)), DVec3::NEG_Z);
        assert_eq!(smooth(&line, &[&[0, 1, 2]]), [[DVec3::NEG_Z; 3]]);
        assert_eq!(direction(DVec3::splat(1e300)), Some(DVec3::ONE.normalize()));
        assert_eq!(direction(DVec3::X * 1e-310), Some(DVec3::X));
        assert_eq!([DVec3::ZERO, DVec3::NAN, DVec3::INFINITY].map(direction), [None; 3]);
    }
}
