//! Chapters 7 and 8: cutting away what cannot be projected, or is not to be seen.
//!
//! Takes a polygon in clip space, before the perspective divide, and gives the part of it that lies inside a list of
//! planes. Values need no correction here: what changes linearly along an edge in camera space
//! changes linearly along it in clip space.
//!
//! ```
//! use glam::dvec4;
//! use rasterbook::clip::{ClipVertex, Plane, clip_triangle};
//!
//! let vertex = |x, w, u| ClipVertex { position: dvec4(x, 0.0, 0.0, w), varyings: [u] };
//! let triangle = [vertex(0.0, 1.0, 0.0), vertex(4.0, 1.0, 1.0), vertex(0.0, 5.0, 0.0)];
//! let clipped = clip_triangle(triangle, &[Plane::RIGHT], Default::default());
//! assert_eq!(clipped.len(), 4); // the vertex at x = 4, beyond x = w, is cut off
//! ```

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4, dvec4};

use crate::real::{each, map3};
use crate::target::Target;
use crate::transform::perspective_divide;

/// A vertex in clip space, with the values that it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipVertex<const N: usize> {
    /// (x, y, z, w), before the perspective divide. The book writes ω for w.
    pub position: DVec4,
    /// The values, as they are in space.
    pub varyings: [f64; N],
}

impl<const N: usize> ClipVertex<N> {
    /// The point at the parameter t between two vertices; position and values change linearly.
    #[inline]
    fn between(a: Self, b: Self, t: f64) -> Self {
        Self {
            position: a.position + (b.position - a.position) * t,
            varyings: each(a.varyings, |i, a| a + (b.varyings[i] - a) * t),
        }
    }
}

/// A plane in clip space, given by a signed distance: not negative inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: DVec4,
    offset: f64,
}

// ANCHOR: planes
impl Plane {
    /// w + x ≥ 0.
    pub const LEFT: Self = Self::homogeneous(dvec4(1.0, 0.0, 0.0, 1.0));
    /// w − x ≥ 0.
    pub const RIGHT: Self = Self::homogeneous(dvec4(-1.0, 0.0, 0.0, 1.0));
    /// w + y ≥ 0.
    pub const BOTTOM: Self = Self::homogeneous(dvec4(0.0, 1.0, 0.0, 1.0));
    /// w − y ≥ 0.
    pub const TOP: Self = Self::homogeneous(dvec4(0.0, -1.0, 0.0, 1.0));
    /// w + z ≥ 0, where NDC run from −1.
    pub const NEAR: Self = Self::homogeneous(dvec4(0.0, 0.0, 1.0, 1.0));
    /// z ≥ 0, where NDC run from 0 (Direct3D).
    pub const NEAR_ZERO: Self = Self::homogeneous(dvec4(0.0, 0.0, 1.0, 0.0));
    /// w − z ≥ 0.
    pub const FAR: Self = Self::homogeneous(dvec4(0.0, 0.0, -1.0, 1.0));

    /// The six planes of the canonical view volume, in the order of the book (section 8.3, Table
    /// 8-1).
    pub const CANONICAL: [Self; 6] =
        [Self::LEFT, Self::RIGHT, Self::BOTTOM, Self::TOP, Self::NEAR, Self::FAR];
    /// The same where z runs from 0 to w.
    pub const ZERO_TO_ONE: [Self; 6] =
        [Self::LEFT, Self::RIGHT, Self::BOTTOM, Self::TOP, Self::NEAR_ZERO, Self::FAR];

    /// All points with normal · (x, y, z, w) ≥ 0: a plane through the origin of clip space, a
    /// *homogeneous* plane. The same points are inside, however (x, y, z, w) is scaled.
    #[must_use]
    pub const fn homogeneous(normal: DVec4) -> Self {
        Self { normal, offset: 0.0 }
    }

    /// w ≥ `distance`: what is at least so far in front of the eye. Book, section 7.4.
    #[must_use]
    pub const fn in_front(distance: f64) -> Self {
        Self { normal: dvec4(0.0, 0.0, 0.0, 1.0), offset: -distance }
    }

    /// How far inside a point with finite coordinates is; negative outside.
    #[must_use]
    #[inline]
    pub fn signed_distance(&self, position: DVec4) -> f64 {
        self.normal.dot(position) + self.offset
    }
}
// ANCHOR_END: planes

#[cfg(feature = "tiled")]
impl Plane {
    /// The normal, and what is added.
    pub(crate) const fn coefficients(&self) -> ([f64; 4], f64) {
        (self.normal.to_array(), self.offset)
    }
}

/// On which coordinates the distance to a plane is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClipTest {
    /// Clip space: x is compared with w.
    #[default]
    BeforeDivide,
    /// NDC: x/w is compared with 1, a mistake.
    ///
    /// - Cause: behind the eye w is negative, and the division reverses the comparison: what is outside seems inside.
    ///   Nor is x/w linear along an edge, so that the cut is made in the wrong place.
    /// - Artefact: a triangle that passes the eye is cut where it should not be, or turns up where nothing is.
    /// - Remedy: [`ClipTest::BeforeDivide`]. Book, section 8.3; second note, the proof about w.
    AfterDivide,
}

impl ClipTest {
    /// Whether what lies between two points outside a plane lies outside too: the divide can turn that round.
    #[inline]
    pub(crate) const fn keeps_sides(self) -> bool {
        match self {
            Self::BeforeDivide => true,
            Self::AfterDivide => false,
        }
    }

    #[inline]
    pub(crate) fn signed_distance(self, plane: &Plane, position: DVec4) -> f64 {
        match self {
            Self::BeforeDivide => plane.signed_distance(position),
            Self::AfterDivide => plane.signed_distance(position / position.w),
        }
    }
}

/// What a triangle may be cut against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ClipVolume {
    /// Nothing is cut away, a mistake as soon as a vertex is not in front of the eye.
    ///
    /// - Cause: a point behind the eye has a negative w; the divide mirrors it to the other side of the screen, and a
    ///   point beside the eye (w = 0) to infinity.
    /// - Artefact: a triangle that passes the eye turns inside out.
    /// - Remedy: [`ClipVolume::InFront`]. Book, section 7.3, Figure 7-5.
    Everything,
    /// What is at least so far in front of the eye. Book, section 7.4.
    InFront(f64),
    /// The canonical view volume, six planes. Book, section 8.3.
    #[default]
    Canonical,
}

/// The range of z in NDC.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthRange {
    /// −1 at the near plane, 1 at the far plane: the book, and OpenGL.
    #[default]
    NegativeOneToOne,
    /// 0 at the near plane, 1 at the far plane: Direct3D, Vulkan, WebGPU.
    ZeroToOne,
}

impl ClipVolume {
    /// The planes of the volume.
    #[must_use]
    pub fn planes(self, range: DepthRange) -> ArrayVec<Plane, 6> {
        match (self, range) {
            (Self::Everything, _) => ArrayVec::new(),
            (Self::InFront(distance), _) => ArrayVec::from_iter([Plane::in_front(distance)]),
            (Self::Canonical, DepthRange::NegativeOneToOne) => Plane::CANONICAL.into(),
            (Self::Canonical, DepthRange::ZeroToOne) => Plane::ZERO_TO_ONE.into(),
        }
    }
}

/// The most vertices that a triangle can have after it was cut by six planes: each plane adds at most one.
pub const MAX_VERTICES: usize = 9;

/// What is left of a triangle, its vertices in order around it; nothing is allocated.
pub type Polygon<const N: usize> = ArrayVec<ClipVertex<N>, MAX_VERTICES>;

// ANCHOR: clip_polygon
/// The part of a polygon inside a plane, by the algorithm of Sutherland and Hodgman: clip space →
/// clip space.
///
/// ```text
///        inside │ outside        each edge, from its start to its end:
///         a ────┼──── b            in  → in    keep the start
///         │     ┊    ╱             in  → out   keep the start, and the cut
///         │     ┊  ╱               out → in    keep the cut
///         d ────┼─ c               out → out   keep nothing
/// ```
///
/// The cut lies at t = d_a / (d_a − d_b), d the signed distances. It is always computed from the
/// outer end a to the inner end b, whatever the direction of the edge: two triangles that share the
/// edge get the same point to the last bit. Exact for convex polygons; of a concave one the parts
/// stay connected along the plane.
///
/// At most `CAP` vertices are kept; a convex polygon gains at most one. Source: book, sections 7.4
/// and 8.3.
#[must_use]
pub fn clip_polygon<const N: usize, const CAP: usize>(
    polygon: &[ClipVertex<N>],
    plane: &Plane,
    test: ClipTest,
) -> ArrayVec<ClipVertex<N>, CAP> {
    let mut kept = ArrayVec::new();
    for_each_clip(polygon, plane, test, |clip| {
        let vertex = match clip {
            Clip::Outside(_) => return,
            Clip::Inside(vertex) => polygon[vertex],
            Clip::Cut { outer, inner, t } => ClipVertex::between(polygon[outer], polygon[inner], t),
        };
        // Rounding can make a convex polygon slightly concave; a vertex too many is due to that.
        let _ = kept.try_push(vertex);
    });
    kept
}

/// What clipping finds on its way round a polygon: a vertex, by its number, or a cut of the edge
/// between two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Clip {
    Inside(usize),
    Outside(usize),
    Cut { outer: usize, inner: usize, t: f64 },
}

/// Goes round a polygon: each vertex, and behind it the cut of the edge that begins there, if the
/// plane cuts it.
#[inline]
pub(crate) fn for_each_clip<const N: usize>(
    polygon: &[ClipVertex<N>],
    plane: &Plane,
    test: ClipTest,
    mut emit: impl FnMut(Clip),
) {
    let distance = |vertex: usize| test.signed_distance(plane, polygon[vertex].position);
    for start in 0..polygon.len() {
        let end = (start + 1) % polygon.len();
        let [from, to] = [distance(start), distance(end)];
        emit(if from >= 0.0 { Clip::Inside(start) } else { Clip::Outside(start) });
        match (from >= 0.0, to >= 0.0) {
            (true, false) => emit(Clip::Cut { outer: end, inner: start, t: to / (to - from) }),
            (false, true) => emit(Clip::Cut { outer: start, inner: end, t: from / (from - to) }),
            _ => {}
        }
    }
}
// ANCHOR_END: clip_polygon

/// The part of a triangle inside all planes, taken one after the other; empty if nothing is left, if a coordinate is not
/// finite, or if coordinates are so large that that of a cut is not (from some 10³⁰⁷ on).
///
/// # Panics
/// If there are more than six planes: what is left might have more than [`MAX_VERTICES`].
#[must_use]
pub fn clip_triangle<const N: usize>(
    triangle: [ClipVertex<N>; 3],
    planes: &[Plane],
    test: ClipTest,
) -> Polygon<N> {
    assert!(planes.len() <= MAX_VERTICES - 3, "{} planes cut a triangle", planes.len());
    let is_finite = |polygon: &[ClipVertex<N>]| polygon.iter().all(|vertex| vertex.position.is_finite());
    let is_inside =
        |plane: &Plane, vertex: &ClipVertex<N>| test.signed_distance(plane, vertex.position) >= 0.0;
    let is_beyond = |plane: &Plane| triangle.iter().all(|vertex| !is_inside(plane, vertex));
    // What lies outside one plane is gone before another one cuts it, and rounding moves the cut.
    if !is_finite(&triangle) || (test.keeps_sides() && planes.iter().any(is_beyond)) {
        return Polygon::new();
    }
    let mut polygon = Polygon::from_iter(triangle);
    for plane in planes {
        // Most triangles lie inside all planes.
        if !polygon.iter().all(|vertex| is_inside(plane, vertex)) {
            polygon = clip_polygon(&polygon, plane, test);
        }
    }
    if is_finite(&polygon) { polygon } else { Polygon::new() }
}

/// The triangles of a convex polygon, as a fan from its first vertex. Book, section 7.4, Figure 7-9.
///
/// ```text
///      d ── c         a b c, a c d
///      │ ╲  │
///      a ── b     (the diagonal runs from a to c)
/// ```
pub fn fan<V: Copy, const CAP: usize>(polygon: ArrayVec<V, CAP>) -> impl Iterator<Item = [V; 3]> {
    (2..polygon.len()).map(move |i| [polygon[0], polygon[i - 1], polygon[i]])
}

/// A point beside the eye (ω = 0) counts as being so far in front of it. A power of two: dividing by it and multiplying
/// again changes nothing.
const HAIR: f64 = 1.0 / 18_446_744_073_709_551_616.0;

/// A vertex after the perspective divide.
///
/// A point beside the eye (ω = 0) has no place on the screen. So that the direction to it is not lost, it is taken to be a
/// hair in front of the eye, 2⁻⁶⁴; what has to be cut away is then cut away by what comes next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NdcVertex<const N: usize> {
    /// Normalized device coordinates, −1..1 inside the view volume.
    pub position: DVec3,
    /// w, kept for perspective-correct interpolation.
    pub w: f64,
    /// The values, as they are in space.
    pub varyings: [f64; N],
}

impl<const N: usize> From<ClipVertex<N>> for NdcVertex<N> {
    #[inline]
    fn from(vertex: ClipVertex<N>) -> Self {
        let DVec4 { w, .. } = vertex.position;
        let w = if w == 0.0 { HAIR } else { w };
        let position = perspective_divide(vertex.position.truncate().extend(w));
        Self { position, w, varyings: vertex.varyings }
    }
}

/// A vertex as it is reported: in clip space, or after the divide in NDC, with w as the fourth component.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedVertex {
    /// Where it is.
    pub position: DVec4,
    /// The values that it carries.
    pub varyings: Vec<f64>,
}

impl RecordedVertex {
    /// Those of a triangle.
    pub(crate) fn of_triangle<'a, V>(triangle: &'a [V; 3]) -> [Self; 3]
    where
        Self: From<&'a V>,
    {
        map3(triangle.each_ref(), Self::from)
    }
}

impl<const N: usize> From<&ClipVertex<N>> for RecordedVertex {
    fn from(vertex: &ClipVertex<N>) -> Self {
        Self { position: vertex.position, varyings: vertex.varyings.to_vec() }
    }
}

impl<const N: usize> From<&NdcVertex<N>> for RecordedVertex {
    fn from(vertex: &NdcVertex<N>) -> Self {
        Self { position: vertex.position.extend(vertex.w), varyings: vertex.varyings.to_vec() }
    }
}

/// The position alone.
impl From<&RecordedVertex> for ClipVertex<0> {
    fn from(vertex: &RecordedVertex) -> Self {
        Self { position: vertex.position, varyings: [] }
    }
}

/// A triangle that is about to be clipped, and against what: what is reported.
#[derive(Clone, Debug, PartialEq)]
pub struct Assembled {
    /// The vertices, in clip space.
    pub vertices: [RecordedVertex; 3],
    /// Where they were before, in the space of the model, if that is known.
    pub model: Option<[DVec3; 3]>,
    /// The planes, in their order.
    pub planes: Vec<Plane>,
    /// On which coordinates the test is made.
    pub test: ClipTest,
}

impl<D> Target<D> {
    /// [`clip_triangle`], for a triangle that is about to be drawn here: reported to the target's observer.
    #[must_use]
    pub fn clip_triangle<const N: usize>(
        &self,
        triangle: [ClipVertex<N>; 3],
        planes: &[Plane],
        test: ClipTest,
    ) -> Polygon<N> {
        self.color.report(|observer| {
            let vertices = triangle.each_ref().map(RecordedVertex::from);
            observer.begun(&Assembled { vertices, model: None, planes: planes.to_vec(), test });
        });
        clip_triangle(triangle, planes, test)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;

    fn position() -> impl Strategy<Value = DVec4> {
        (-3.0..3.0, -3.0..3.0, -3.0..3.0, -1.0..3.0).prop_map(|(x, y, z, w)| dvec4(x, y, z, w))
    }

    /// A triangle whose values are its positions, so that a value shows where it came from.
    fn triangle() -> impl Strategy<Value = [ClipVertex<4>; 3]> {
        prop::array::uniform3(position().prop_map(|p| ClipVertex { position: p, varyings: p.to_array() }))
    }

    /// A triangle in the plane, ω = 1, larger than the view.
    fn flat_triangle() -> impl Strategy<Value = [ClipVertex<0>; 3]> {
        prop::array::uniform3(
            (-3.0..3.0, -3.0..3.0)
                .prop_map(|(x, y)| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [] }),
        )
    }

    fn area(polygon: Polygon<0>) -> f64 {
        let point = |vertex: &ClipVertex<0>| DVec2::new(vertex.position.x, vertex.position.y);
        let twice: f64 = fan(polygon)
            .map(|t| crate::area::twice_signed_area(point(&t[0]), point(&t[1]), point(&t[2])))
            .sum();
        twice.abs() / 2.0
    }

    /// The area of a triangle inside the view −1..1, another way: integrate the length of its rows.
    fn area_by_rows(triangle: &[ClipVertex<0>; 3]) -> f64 {
        const ROWS: usize = 20_000;
        let mut area = 0.0;
        for i in 0..ROWS {
            let y = -1.0 + (i as f64 + 0.5) * 2.0 / ROWS as f64;
            let crossings: Vec<f64> = (0..3)
                .filter_map(|k| {
                    let (a, b) = (triangle[k].position, triangle[(k + 1) % 3].position);
                    ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
                })
                .collect();
            if let [p, q] = crossings[..] {
                area += (p.max(q).min(1.0) - p.min(q).max(-1.0)).max(0.0) * 2.0 / ROWS as f64;
            }
        }
        area
    }

    #[test]
    fn a_vertex_is_cut_off() {
        let vertex = |x, y, u| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [u] };
        let clipped = clip_triangle(
            [vertex(0.0, 0.0, 0.0), vertex(2.0, 0.0, 8.0), vertex(0.0, 0.5, 0.0)],
            &[Plane::RIGHT],
            ClipTest::BeforeDivide,
        );
        assert_eq!(
            clipped.as_slice(),
            [vertex(0.0, 0.0, 0.0), vertex(1.0, 0.0, 4.0), vertex(1.0, 0.25, 4.0), vertex(0.0, 0.5, 0.0)]
        );
    }

    #[test]
    fn distances_to_the_planes() {
        let planes =
            [Plane::LEFT, Plane::RIGHT, Plane::BOTTOM, Plane::TOP, Plane::NEAR, Plane::NEAR_ZERO, Plane::FAR];
        // w + x, w − x, w + y, w − y, w + z, z, w − z.
        let at = |position| planes.map(|plane| plane.signed_distance(position));
        assert_eq!(at(dvec4(1.0, 2.0, 3.0, 10.0)), [11.0, 9.0, 12.0, 8.0, 13.0, 3.0, 7.0]);
        assert_eq!(Plane::in_front(4.0).signed_distance(dvec4(1.0, 2.0, 3.0, 10.0)), 6.0);
        let after = ClipTest::AfterDivide.signed_distance(&Plane::RIGHT, dvec4(3.0, 0.0, 0.0, -2.0));
        assert_eq!(after, 2.5, "1 − 3 / −2");
    }

    #[test]
    fn planes_of_the_volumes() {
        let [book, other] = [DepthRange::NegativeOneToOne, DepthRange::ZeroToOne];
        assert!(ClipVolume::Everything.planes(book).is_empty());
        assert_eq!(ClipVolume::InFront(2.0).planes(other).as_slice(), [Plane::in_front(2.0)]);
        assert_eq!(ClipVolume::Canonical.planes(book).as_slice(), Plane::CANONICAL);
        assert_eq!(ClipVolume::Canonical.planes(other).as_slice(), Plane::ZERO_TO_ONE);
    }

    #[test]
    fn after_the_divide_a_cut_can_bring_back_what_is_outside() {
        // x/w is 3, 5.5 and 3: all beyond the right plane. The middle of the first edge, where the upper plane cuts it,
        // is (0.25, −1, 0, 0.5).
        let vertex = |x, y, w| ClipVertex { position: dvec4(x, y, 0.0, w), varyings: [] };
        let triangle = [vertex(6.0, 0.0, 2.0), vertex(-5.5, -2.0, -1.0), vertex(6.0, 0.5, 2.0)];
        let left = clip_triangle(triangle, &[Plane::TOP, Plane::RIGHT], ClipTest::AfterDivide);
        assert!(left.contains(&vertex(0.25, -1.0, 0.5)), "{left:?}");
    }

    #[test]
    fn a_quad_is_two_triangles_from_its_first_vertex() {
        let quad: ArrayVec<char, 4> = ['a', 'b', 'c', 'd'].into();
        assert_eq!(fan(quad).collect::<Vec<_>>(), [['a', 'b', 'c'], ['a', 'c', 'd']]);
        let line: ArrayVec<char, 4> = ['a', 'b'].into_iter().collect();
        assert_eq!(fan(line).count(), 0);
    }

    #[test]
    fn outside_nothing_is_left_and_odd_numbers_are_discarded() {
        let vertex = |x, w| ClipVertex { position: dvec4(x, 0.5, 0.0, w), varyings: [] };
        let clip = |triangle| clip_triangle(triangle, &Plane::CANONICAL, ClipTest::BeforeDivide);
        assert!(clip([vertex(2.0, 1.0), vertex(3.0, 1.0), vertex(2.5, 1.5)]).is_empty());
        assert!(clip([vertex(0.0, -1.0), vertex(0.5, -1.0), vertex(0.5, -2.0)]).is_empty(), "behind the eye");
        for odd in [f64::NAN, f64::INFINITY] {
            assert!(clip([vertex(odd, 1.0), vertex(0.0, 1.0), vertex(0.5, odd)]).is_empty());
        }
    }

    #[test]
    fn what_lies_beyond_a_plane_is_gone_before_others_cut_it() {
        let vertex = |x, y, z, w| ClipVertex { position: dvec4(x, y, z, w), varyings: [] };
        // Cut at the right plane first, the middle of −1e300 and −1e38 would come out as 0: inside.
        let near =
            [vertex(1e38, 0.0, -1e300, 0.0), vertex(0.0, 0.0, -1e38, 1.0), vertex(1.0, 1.0, -1.2, 1.0)];
        assert!(clip_triangle(near, &Plane::CANONICAL, ClipTest::BeforeDivide).is_empty());
    }

    #[test]
    fn cuts_that_are_no_numbers_leave_nothing() {
        let vertex = |x, y| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [] };
        for far in [1.5e308, -1.5e308] {
            let triangle = [vertex(far, 0.0), vertex(-far, 0.5), vertex(0.0, 0.5)];
            assert!(clip_triangle(triangle, &Plane::CANONICAL, ClipTest::BeforeDivide).is_empty());
        }
        let triangle = [vertex(1e307, 0.0), vertex(-1e307, 0.5), vertex(0.0, 0.5)];
        let clipped = clip_triangle(triangle, &Plane::CANONICAL, ClipTest::BeforeDivide);
        assert!(clipped.len() > 2 && clipped.iter().all(|vertex| vertex.position.is_finite()));
    }

    #[test]
    #[should_panic(expected = "7 planes")]
    fn more_than_six_planes_are_refused() {
        let vertex = |x, y| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [] };
        let triangle = [vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(0.0, 1.0)];
        let _ = clip_triangle(triangle, &[Plane::LEFT; 7], ClipTest::BeforeDivide);
    }

    #[test]
    fn a_point_beside_the_eye_is_a_hair_in_front_of_it() {
        let [x, y, z, w] = [1e3, -0.3, 5.0, 0.0];
        let vertex = NdcVertex::from(ClipVertex { position: dvec4(x, y, z, w), varyings: [] });
        let hair = (0..64).fold(1.0, |half: f64, _| half / 2.0);
        assert!(vertex.w == hair && vertex.position.is_finite());
        assert_eq!(vertex.position * vertex.w, dvec4(x, y, z, w).truncate());
    }

    proptest! {
        #[test]
        fn what_is_left_is_inside_every_plane(t in triangle()) {
            for vertex in clip_triangle(t, &Plane::CANONICAL, ClipTest::BeforeDivide) {
                for plane in &Plane::CANONICAL {
                    prop_assert!(plane.signed_distance(vertex.position) >= -1e-12);
                }
                let expected = DVec4::from_array(vertex.varyings);
                prop_assert!((expected - vertex.position).length() < 1e-12, "values stay with their positions");
            }
        }

        #[test]
        fn a_shared_edge_is_cut_in_the_same_point(t in triangle(), other in position()) {
            // The same edge in the other direction, as in the neighboring triangle.
            let neighbor = [t[1], t[0], ClipVertex { position: other, varyings: other.to_array() }];
            for plane in &Plane::CANONICAL {
                let cut = |t: &[ClipVertex<4>; 3]| {
                    let [a, b] = [t[0], t[1]];
                    let line: ArrayVec<_, 4> = clip_polygon(&[a, b], plane, ClipTest::BeforeDivide);
                    line.into_iter().filter(|vertex| *vertex != a && *vertex != b).collect::<Vec<_>>()
                };
                let (mine, theirs) = (cut(&t), cut(&neighbor));
                prop_assert!(mine.iter().all(|vertex| theirs.contains(vertex)), "{mine:?} {theirs:?}");
            }
        }

        #[test]
        fn area_is_that_of_the_intersection(t in flat_triangle()) {
            let clipped = clip_triangle(t, &Plane::CANONICAL[..4], ClipTest::BeforeDivide);
            prop_assert!((area(clipped) - area_by_rows(&t)).abs() < 2e-3);
        }

        #[test]
        fn the_order_of_the_planes_does_not_matter(t in flat_triangle(), order in Just([0, 1, 2, 3]).prop_shuffle()) {
            let planes = order.map(|i| Plane::CANONICAL[i]);
            let [a, b] = [&Plane::CANONICAL[..4], &planes].map(|planes| area(clip_triangle(t, planes, ClipTest::BeforeDivide)));
            prop_assert!((a - b).abs() < 1e-9);
        }

        #[test]
        fn at_most_nine_vertices(t in triangle()) {
            let mut polygon: ArrayVec<ClipVertex<4>, 64> = t.into_iter().collect();
            for plane in &Plane::CANONICAL {
                polygon = clip_polygon(&polygon, plane, ClipTest::BeforeDivide);
            }
            prop_assert!(polygon.len() <= MAX_VERTICES);
        }
    }
}
