//! Polygons, cut into triangles.
//!
//! Corners in space go in, three numbers for each triangle come out: which corners it has. A convex polygon becomes a
//! fan from its first corner. A concave one is cut by *ear clipping*: an ear is a triangle of three neighboring corners
//! that lies inside and has no other corner in it; it is cut off, and the rest is a smaller polygon.
//!
//! ```text
//!   d ─────────── c        a fan from a:  a b c, a c d, a d e      a c d lies half outside
//!    ╲    ╱╲     ╱
//!     ╲ ╱    ╲  ╱          the ears:      c has one (b c d is free of e), then …
//!      a   e   b           (here e is the concave corner)
//! ```
//!
//! Every corner stays a corner of some triangle, so no crack opens beside a neighbor that has the same corner. Crates for
//! this leave out corners on straight edges, and give no sign for a polygon that crosses itself.
//!
//! Source: G. H. Meisters, Polygons have ears, 1975.

use glam::{DVec2, DVec3};

/// How many comparisons of corners all concave polygons of a model may cost, so that none takes for ever: about a second.
pub(super) const MAX_WORK: u64 = 1 << 28;

/// Cuts a polygon of three corners or more into triangles, and says whether that is right everywhere: a polygon that
/// crosses itself or has no area, or for which `work` does not last, becomes a fan all the same.
///
/// `area` is perpendicular to the polygon, as [`area_vector`](super::normals::area_vector) gives it (its length does not matter).
/// Corners are compared along the two axes that it is least parallel to, so that no coordinate is rounded.
pub(super) fn triangulate(
    corners: &[DVec3],
    area: DVec3,
    work: &mut u64,
    triangles: &mut Vec<[usize; 3]>,
) -> bool {
    triangles.clear();
    let fan = (2..corners.len()).map(|i| [0, i - 1, i]);
    let points: Vec<DVec2>;
    if corners.len() > 3 && area == DVec3::ZERO {
        triangles.extend(fan);
        return false;
    }
    if corners.len() > 3 {
        points = flattened(corners, area);
        if !is_convex(&points) {
            let ears = if crosses_itself(&points, work) { None } else { ears(&points, work) };
            return match ears {
                Some(ears) => {
                    *triangles = ears;
                    true
                }
                None => {
                    triangles.extend(fan);
                    false
                }
            };
        }
    }
    triangles.extend(fan);
    true
}

/// The corners without the coordinate in which the polygon is thinnest, counter-clockwise. Space is left-handed: what runs
/// counter-clockwise in x and y has its area towards −z.
fn flattened(corners: &[DVec3], area: DVec3) -> Vec<DVec2> {
    let size = area.abs();
    let (flatten, sign): (fn(&DVec3) -> DVec2, f64) = if size.x >= size.y && size.x >= size.z {
        (|c| DVec2::new(c.y, c.z), area.x)
    } else if size.y >= size.z {
        (|c| DVec2::new(c.z, c.x), area.y)
    } else {
        (|c| DVec2::new(c.x, c.y), area.z)
    };
    let points = corners.iter().map(flatten);
    if sign > 0.0 { points.map(|p| DVec2::new(-p.x, p.y)).collect() } else { points.collect() }
}

/// Twice the area of a triangle, positive if it runs counter-clockwise.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether a polygon that runs counter-clockwise never turns right, and goes round once.
fn is_convex(points: &[DVec2]) -> bool {
    let at = |i: usize| points[i % points.len()];
    let mut turns_left = false;
    let mut reversals = 0;
    let mut before = 0.0;
    // Once round, and the first side again: to the right and back is two reversals, wherever it begins.
    for i in 0..=points.len() {
        let bend = turn(at(i), at(i + 1), at(i + 2));
        if bend < 0.0 || bend.is_nan() {
            return false;
        }
        turns_left |= bend > 0.0;
        let way = at(i + 1).x - at(i).x;
        if way != 0.0 {
            reversals += u32::from(way * before < 0.0);
            before = way;
        }
    }
    turns_left && reversals <= 2
}

/// Takes `steps` from what is left; false if there is not as much.
fn spend(work: &mut u64, steps: usize) -> bool {
    let rest = work.checked_sub(steps as u64);
    *work = rest.unwrap_or(0);
    rest.is_some()
}

/// Whether two sides cross, each inside the other; also if that cannot be found out. Sides that touch do not count.
fn crosses_itself(points: &[DVec2], work: &mut u64) -> bool {
    let count = points.len();
    if !spend(work, count * count / 2) {
        return true;
    }
    let side = |i: usize| [points[i], points[(i + 1) % count]];
    let apart = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| {
        let [left, right] = [turn(a, b, c), turn(a, b, d)];
        left != 0.0 && right != 0.0 && (left > 0.0) != (right > 0.0)
    };
    (0..count).any(|i| (i + 2..count).any(|j| apart(side(i), side(j)) && apart(side(j), side(i))))
}

/// What is left of a polygon: each corner knows its neighbors.
struct Ring<'a> {
    points: &'a [DVec2],
    next: Vec<usize>,
    previous: Vec<usize>,
}

impl<'a> Ring<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let count = points.len();
        let next = (0..count).map(|i| (i + 1) % count).collect();
        let previous = (0..count).map(|i| (i + count - 1) % count).collect();
        Self { points, next, previous }
    }

    fn triangle(&self, at: usize) -> [usize; 3] {
        [self.previous[at], at, self.next[at]]
    }

    fn cut(&mut self, at: usize) {
        let [before, _, after] = self.triangle(at);
        self.next[before] = after;
        self.previous[after] = before;
    }

    /// Whether the corner bends to the left, and no other corner is in its triangle or on the border of it.
    fn is_ear(&self, at: usize, bend: f64) -> bool {
        let [before, _, after] = self.triangle(at);
        let [a, b, c] = self.triangle(at).map(|i| self.points[i]);
        if bend <= 0.0 {
            return false;
        }
        let mut other = self.next[after];
        while other != before {
            let p = self.points[other];
            // Where a hole is bridged, two corners are in one place.
            let is_apart = p != a && p != b && p != c;
            if is_apart && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0 {
                return false;
            }
            other = self.next[other];
        }
        true
    }
}

/// The ears of a polygon that runs counter-clockwise; nothing if there is none at some point.
fn ears(points: &[DVec2], work: &mut u64) -> Option<Vec<[usize; 3]>> {
    let mut ring = Ring::new(points);
    let mut left = points.len();
    let mut triangles = Vec::with_capacity(left - 2);
    let (mut at, mut misses) = (0, 0);
    while left > 3 {
        if !spend(work, left) {
            return None;
        }
        let [a, b, c] = ring.triangle(at).map(|i| points[i]);
        let bend = turn(a, b, c);
        // A corner on a straight line has no triangle that could be seen: only when nothing else is left.
        let is_flat = bend == 0.0 && misses >= left;
        if is_flat || ring.is_ear(at, bend) {
            triangles.push(ring.triangle(at));
            ring.cut(at);
            left -= 1;
            misses = 0;
            // The next but one, so that the triangles do not all meet in one corner.
            at = ring.next[ring.next[at]];
        } else {
            at = ring.next[at];
            misses += 1;
            // Each corner was looked at twice: as an ear, and as one that is none but flat.
            if misses == 2 * left {
                return None;
            }
        }
    }
    triangles.push(ring.triangle(at));
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::super::normals::area_vector;
    use super::*;

    fn cut(points: &[[f64; 2]]) -> (Vec<[usize; 3]>, bool, f64) {
        let corners: Vec<DVec3> = points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
        let sum: f64 = (0..points.len()).map(|i| flat(&corners, [0, i, (i + 1) % points.len()])).sum();
        let (mut triangles, mut work) = (Vec::new(), MAX_WORK);
        let is_right = triangulate(&corners, DVec3::NEG_Z * sum, &mut work, &mut triangles);
        let area = triangles.iter().map(|&triangle| flat(&corners, triangle).abs()).sum();
        (triangles, is_right, area)
    }

    fn flat(corners: &[DVec3], triangle: [usize; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| corners[i].truncate());
        turn(a, b, c) / 2.0
    }

    #[test]
    fn a_convex_polygon_is_a_fan_from_wherever_it_begins() {
        let with_a_straight_angle = [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]];
        let round = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5];
        let round = round.map(|angle| [libm::cos(angle), libm::sin(angle)]);
        for mut polygon in [with_a_straight_angle.to_vec(), round.to_vec()] {
            let fan: Vec<_> = (2..polygon.len()).map(|i| [0, i - 1, i]).collect();
            for _ in 0..polygon.len() {
                let (triangles, is_right, _) = cut(&polygon);
                assert!(is_right && triangles == fan, "{polygon:?}: {triangles:?}");
                polygon.rotate_left(1);
            }
        }
        assert_eq!(cut(&with_a_straight_angle).2, 5.0);
    }

    #[test]
    fn a_triangle_stays_what_it_is_with_or_without_area() {
        for last in [[2.0, 0.0], [0.0, 1.0], [f64::NAN, 0.0]] {
            let (triangles, is_right, _) = cut(&[[0.0, 0.0], [1.0, 0.0], last]);
            assert!(is_right && triangles == [[0, 1, 2]], "{last:?}");
        }
    }

    /// Concave polygons, counter-clockwise, and their areas.
    const CONCAVE: [(&[[f64; 2]], f64); 6] = [
        (&[[0.0, 0.0], [2.0, 1.0], [4.0, 0.0], [2.0, 4.0]], 6.0),
        // The same, each corner twice.
        (
            &[[0.0, 0.0], [0.0, 0.0], [2.0, 1.0], [2.0, 1.0], [4.0, 0.0], [4.0, 0.0], [2.0, 4.0], [2.0, 4.0]],
            6.0,
        ),
        // A corner touches another side from outside, at (2, 1).
        (
            &[
                [0.0, 0.0],
                [4.0, 0.0],
                [4.0, 1.0],
                [1.0, 1.0],
                [1.0, 3.0],
                [1.5, 3.0],
                [2.0, 1.0],
                [3.0, 3.0],
                [3.0, 4.0],
                [0.0, 4.0],
            ],
            10.5,
        ),
        (&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]], 10.0),
        // A comb, with corners on straight lines.
        (
            &[
                [0.0, 0.0],
                [1.0, 0.0],
                [3.0, 0.0],
                [5.0, 0.0],
                [5.0, 3.0],
                [4.0, 3.0],
                [4.0, 1.0],
                [3.0, 1.0],
                [3.0, 3.0],
                [2.0, 3.0],
                [2.0, 1.0],
                [1.0, 1.0],
                [1.0, 3.0],
                [0.0, 3.0],
            ],
            11.0,
        ),
        // A square with a hole, bridged at (0, 0) to (1, 1).
        (
            &[
                [0.0, 0.0],
                [3.0, 0.0],
                [3.0, 3.0],
                [0.0, 3.0],
                [0.0, 0.0],
                [1.0, 1.0],
                [1.0, 2.0],
                [2.0, 2.0],
                [2.0, 1.0],
                [1.0, 1.0],
            ],
            8.0,
        ),
    ];

    #[test]
    fn a_concave_polygon_is_covered_once_from_wherever_it_begins() {
        for (shape, area) in CONCAVE {
            for start in 0..shape.len() {
                let mut turned = shape.to_vec();
                turned.rotate_left(start);
                for _ in 0..2 {
                    let (triangles, is_right, covered) = cut(&turned);
                    assert!(
                        is_right && (covered - area).abs() < 1e-12,
                        "{turned:?}: {triangles:?} {covered}"
                    );
                    assert_eq!(triangles.len(), shape.len() - 2);
                    // Each corner is one of a triangle that has an area: else a crack could open beside it.
                    let seen = |place: &[f64; 2]| {
                        let is_seen = |[a, b, c]: &[usize; 3]| {
                            let places = [turned[*a], turned[*b], turned[*c]];
                            let [a, b, c] = places.map(DVec2::from_array);
                            turn(a, b, c) != 0.0 && places.contains(place)
                        };
                        triangles.iter().any(is_seen)
                    };
                    assert!(turned.iter().all(seen), "{turned:?}: {triangles:?}");
                    turned.reverse();
                }
            }
        }
    }

    #[test]
    fn a_polygon_is_cut_in_the_same_way_whichever_axis_it_faces() {
        let mut arrow = [[0.0, 0.0], [2.0, 1.0], [4.0, 0.0], [2.0, 4.0]];
        for _ in 0..2 {
            let (expected, ..) = cut(&arrow);
            // x and y as two of three coordinates, in turn.
            for axis in 0..3 {
                let corners = arrow.map(|[x, y]| {
                    let mut place = [x, y, 0.0];
                    place.rotate_right(axis);
                    DVec3::from_array(place)
                });
                let (mut triangles, mut work) = (Vec::new(), MAX_WORK);
                assert!(triangulate(&corners, area_vector(&corners), &mut work, &mut triangles));
                assert_eq!(triangles, expected, "{corners:?}");
            }
            arrow.reverse();
        }
    }

    #[test]
    fn what_cannot_be_cut_is_a_fan() {
        let crossing: [&[[f64; 2]]; 5] = [
            &[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]],
            &[[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [2.0, 7.0], [4.0, 7.0], [2.0, 5.0], [0.0, 6.0]],
            &[[0.0, 3.0], [-2.0, -3.0], [3.0, 1.0], [-3.0, 1.0], [2.0, -3.0]],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
            &[[1.0, 1.0]; 5],
        ];
        for polygon in crossing {
            // Wherever it lies, however small it is, and wherever it begins.
            for [size, from] in [[1.0, 0.0], [1.0, 10.0], [1e-90, 0.0]] {
                let place = |&[x, y]: &[f64; 2]| [size * x + from, size * y + from];
                let mut polygon: Vec<_> = polygon.iter().map(place).collect();
                for _ in 0..polygon.len() {
                    let (triangles, is_right, _) = cut(&polygon);
                    assert!(
                        !is_right && triangles[0] == [0, 1, 2] && triangles.len() == polygon.len() - 2,
                        "{polygon:?}"
                    );
                    polygon.rotate_left(1);
                }
            }
        }
    }

    #[test]
    fn work_is_limited() {
        let comb: Vec<DVec3> = (0..1000)
            .map(|i| DVec3::new(f64::from(i), f64::from(i % 2 * 1000), 0.0))
            .chain([DVec3::new(1000.0, -5.0, 0.0), DVec3::new(-1.0, -5.0, 0.0)])
            .collect();
        let (mut triangles, mut work) = (Vec::new(), 1000);
        assert!(!triangulate(&comb, DVec3::Z, &mut work, &mut triangles));
        assert_eq!((triangles.len(), work), (1000, 0));
        work = MAX_WORK;
        assert!(triangulate(&comb, DVec3::Z, &mut work, &mut triangles) && work > MAX_WORK / 2);
        // Of a star, each side is compared with each other one.
        let star = [[0.0, 3.0], [-2.0, -3.0], [3.0, 1.0], [-3.0, 1.0], [2.0, -3.0]];
        let star = star.map(|[x, y]| DVec3::new(x, y, 0.0));
        work = MAX_WORK;
        assert!(!triangulate(&star, area_vector(&star), &mut work, &mut triangles));
        assert_eq!(MAX_WORK - work, 12, "5 · 5 / 2");
        // A square that is seen from behind has no ear: each corner is looked at twice, and four are compared each time.
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        work = MAX_WORK;
        assert!(!triangulate(&square, -area_vector(&square), &mut work, &mut triangles));
        assert_eq!(MAX_WORK - work, 4 * 4 / 2 + 4 * 2 * 4);
    }
}
