//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::array::from_fn;

use wide::{f32x8, i32x8};

use super::front::{Front, Place, Source, Triangle, bounding_box, signed_area};
use crate::depth::DepthTest;
use crate::edge::{EdgeFunction, SUBPIXELS, center};
use crate::interpolate::{Interpolation, Projected};
use crate::lanes::{LANES, LaneMask, Lanes, channels, is_greater, is_less_or_equal, packed};
use crate::merge::{Blend, Merge};
use crate::pipeline::RenderState;
use crate::real::{Mask, Real};
use crate::shader::{Shaded, Shader};
use crate::varyings::{CornerVaryings, TriangleVaryings, WeightGradients};
use crate::{Color, Rect};

/// What all tiles of a picture share.
pub(super) struct Frame<'a, S: Shader<N>, const N: usize> {
    pub(super) shader: &'a S,
    pub(super) state: &'a RenderState,
    pub(super) front: &'a Front,
    pub(super) source: &'a Source<'a, S, N>,
}

/// A rectangle of the picture, with the rows of the target in which it lies.
pub(super) struct Tile<'a> {
    rect: Rect,
    /// The rows are so long.
    width: usize,
    colors: &'a mut [Color],
    depths: &'a mut [f32],
    queue: Queue,
}

/// Fragments of small triangles that wait until there are eight of them.
struct Queue {
    count: usize,
    /// 1/ω, depth, V/ω of each fragment.
    records: [f32x8; LANES],
    /// Where each fragment stands in the tile's rows.
    places: [usize; LANES],
}

/// Up to this many pixels wide and high, a triangle is small.
const SMALL: i32 = 8;

/// The three edges of a triangle, each on the left of its inside, opposite to its vertex.
struct Setup {
    edges: [EdgeFunction; 3],
    /// What is taken off a value so that "not negative" means covered: 1 on edges that are neither top nor left.
    shy: [i64; 3],
    one_over_area: f32,
    area: Rect,
}

impl Setup {
    fn new([a, b, c]: [Place; 3], area: Rect) -> Self {
        let signed_area = signed_area([a, b, c]);
        let edge = |from: Place, to: Place| {
            let (from, to) = if signed_area > 0 { (from, to) } else { (to, from) };
            EdgeFunction::new(from.map(i64::from), to.map(i64::from))
        };
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let shy = edges.map(|edge| i64::from(!edge.is_top_left()));
        Self { edges, shy, one_over_area: 1.0 / (signed_area.abs() as f32), area }
    }

    /// The least and the greatest value of an edge function at the centers of a rectangle, less what keeps a tie out.
    fn range(&self, i: usize, area: Rect) -> [i64; 2] {
        let corners = [
            (area.left, area.bottom),
            (area.right - 1, area.bottom),
            (area.left, area.top - 1),
            (area.right - 1, area.top - 1),
        ];
        let values = corners.map(|(x, y)| self.edges[i].at(center(x, y)) - self.shy[i]);
        [values.into_iter().fold(i64::MAX, i64::min), values.into_iter().fold(i64::MIN, i64::max)]
    }

    /// Whether all centers of a rectangle are covered.
    fn covers(&self, area: Rect) -> bool {
        (0..3).all(|i| self.range(i, area)[0] >= 0)
    }

    /// Whether a rectangle lies wholly on the wrong side of an edge.
    fn misses(&self, area: Rect) -> bool {
        (0..3).any(|i| self.range(i, area)[1] < 0)
    }

    /// Whether values near a rectangle have at most 40 bits.
    fn is_split_exact(&self, area: Rect) -> bool {
        let near = Rect { right: area.right + LANES as i32, ..area };
        (0..3).all(|i| self.range(i, near).into_iter().all(|value| value.abs() < 1 << 39))
    }

    /// How the weights of the second and third vertex change per pixel.
    fn gradients(&self, places: [Place; 3]) -> WeightGradients<Lanes> {
        let corners = places.map(|[x, y]| glam::dvec2(f64::from(x), f64::from(y)) / SUBPIXELS as f64);
        crate::varyings::weight_gradients(corners)
    }
}

impl<'a> Tile<'a> {
    /// A tile; `colors` and `depths` begin with its lowest row, at the left border of the picture.
    pub(super) fn new(rect: Rect, width: usize, colors: &'a mut [Color], depths: &'a mut [f32]) -> Self {
        let queue = Queue { count: 0, records: [f32x8::ZERO; LANES], places: [0; LANES] };
        Self { rect, width, colors, depths, queue }
    }

    /// Draws a triangle as far as it lies in the tile.
    pub(super) fn draw<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
    ) {
        let Some(area) = bounding_box(triangle.places, self.rect) else { return };
        let setup = Setup::new(triangle.places, area);
        let is_small = area.columns().len() <= SMALL as usize && area.rows().len() <= SMALL as usize;
        // A record of more than one block does not fit into the queue, and neighbors are needed for derivatives.
        if is_small && N + 2 <= LANES && !S::USES_DERIVATIVES && is_narrow(triangle.places) {
            self.draw_small(frame, &setup, triangle);
        } else {
            self.flush(frame);
            self.draw_rows(frame, &setup, triangle);
        }
    }

    /// Draws what still waits.
    pub(super) fn finish<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        self.flush(frame);
    }

    /// Where a pixel stands in the rows.
    fn place(&self, x: i32, y: i32) -> usize {
        (y - self.rect.bottom) as usize * self.width + x as usize
    }

    // ANCHOR: small
    /// A few pixels: each covered one goes into the queue.
    fn draw_small<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        setup: &Setup,
        triangle: Triangle<'_>,
    ) {
        let [first, second, third] = triangle.records.map(|record| record[0]);
        let (to_second, to_third) = (second - first, third - first);
        let Rect { left, right, .. } = setup.area;
        let columns = (1 << (right - left)) - 1;
        let start = center(left, setup.area.bottom);
        let mut values: [i32x8; 3] = from_fn(|i| narrow_lanes(&setup.edges[i], start));
        let shy = setup.shy.map(|shy| i32x8::splat(shy as i32));
        let steps = from_fn::<_, 3, _>(|i| i32x8::splat((setup.edges[i].step_y * SUBPIXELS) as i32));

        for y in setup.area.rows() {
            // A sign bit in any of the three says that the pixel is outside.
            let outside = (values[0] - shy[0]) | (values[1] - shy[1]) | (values[2] - shy[2]);
            let mut covered = !outside.move_mask() & columns;
            let [_, weights_2, weights_3] = values.map(i32x8::to_array);
            while covered != 0 {
                let lane = covered.trailing_zeros() as usize;
                covered &= covered - 1;
                let second = f32x8::splat(weights_2[lane] as f32 * setup.one_over_area);
                let third = f32x8::splat(weights_3[lane] as f32 * setup.one_over_area);
                let record = first + to_second * second + to_third * third;
                self.enqueue(frame, record, self.place(left + lane as i32, y));
            }
            values = from_fn(|i| values[i] + steps[i]);
        }
    }

    /// Lets a fragment wait for others, unless it is hidden already.
    fn enqueue<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        record: f32x8,
        place: usize,
    ) {
        // Stored depths only become harder to pass: what fails now fails later.
        let is_linear = frame.state.depth_encoding.is_linear_on_screen();
        if is_linear && !frame.state.merge.depth_test.passes(record.as_array_ref()[1], self.depths[place]) {
            return;
        }
        self.queue.records[self.queue.count] = record;
        self.queue.places[self.queue.count] = place;
        self.queue.count += 1;
        if self.queue.count == LANES {
            self.flush(frame);
        }
    }

    /// Shades all fragments that wait, and writes them one after the other.
    fn flush<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        let count = std::mem::take(&mut self.queue.count);
        if count == 0 {
            return;
        }
        let numbers = f32x8::transpose(self.queue.records);
        let corner = CornerVaryings {
            distance: numbers[0],
            depth: numbers[1],
            values: from_fn(|k| numbers.get(k + 2).copied().unwrap_or(f32x8::ZERO)),
        };
        let point: Projected<Lanes, N> = corner.multiplied(frame.state.interpolation);
        let is_linear = frame.state.depth_encoding.is_linear_on_screen();
        let depths = if is_linear { corner.depth } else { point.w }.to_array();
        let shaded: Shaded<Lanes> = frame.shader.fragment(point.values);
        let kept = shaded.keep.bits();
        let blend = frame.state.merge.blend;
        let opaque = packed([shaded.color[0], shaded.color[1], shaded.color[2]]).to_array();
        for lane in (0..count).filter(|lane| kept >> lane & 1 == 1) {
            let place = self.queue.places[lane];
            if !frame.state.merge.depth_test.passes(depths[lane], self.depths[place]) {
                continue;
            }
            if frame.state.merge.depth_write {
                self.depths[place] = depths[lane];
            }
            self.colors[place] = match blend {
                Blend::Opaque => Color::from_bits(opaque[lane] as u32),
                _ => blended(blend, shaded.color.map(|channel| channel.to_array()[lane]), self.colors[place]),
            };
        }
    }
    // ANCHOR_END: small

    // ANCHOR: rows
    /// Many pixels: row by row, eight at a time.
    fn draw_rows<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        setup: &Setup,
        triangle: Triangle<'_>,
    ) {
        // Groups of eight begin at the same columns for all triangles.
        let first = setup.area.left - (setup.area.left - self.rect.left) % LANES as i32;
        let area = Rect { left: first, ..setup.area };
        if is_narrow(triangle.places) {
            self.draw_groups(frame, setup, triangle, Narrow::new(setup, first));
        } else if setup.misses(area) {
            // An edge has all of the tile on its wrong side.
        } else if !setup.is_split_exact(area) {
            self.draw_groups(frame, setup, triangle, Huge { setup, left: first });
        } else if setup.covers(area) {
            self.draw_groups(frame, setup, triangle, Split::<true>::new(setup, first));
        } else {
            self.draw_groups(frame, setup, triangle, Split::<false>::new(setup, first));
        }
    }

    fn draw_groups<S: Shader<N>, E: Edges, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        setup: &Setup,
        triangle: Triangle<'_>,
        edges: E,
    ) {
        let corners = triangle.records.map(corner_of::<N>);
        let varyings = TriangleVaryings::between(corners, frame.state.interpolation);
        let gradients =
            if S::USES_DERIVATIVES { setup.gradients(triangle.places) } else { [[Lanes::ZERO; 2]; 2] };
        let brush = Brush { varyings, gradients, one_over_area: Lanes::splat(setup.one_over_area) };
        let place = Placing { area: setup.area, tile: self.rect, width: self.width };
        let (state, colors, depths) = (frame.state, &mut *self.colors, &mut *self.depths);
        if is_plain(state) {
            draw_area::<true, S, E, N>(frame.shader, state, &brush, &edges, &place, colors, depths);
        } else {
            draw_area::<false, S, E, N>(frame.shader, state, &brush, &edges, &place, colors, depths);
        }
    }
}

/// Whether all options that matter for a pixel have their default values: the most common case, known at compile time.
fn is_plain(state: &RenderState) -> bool {
    state.merge == Merge::default()
        && state.depth_encoding.is_linear_on_screen()
        && state.interpolation == Interpolation::PerspectiveCorrect
}

/// What is the same for all pixels of a triangle.
struct Brush<const N: usize> {
    varyings: TriangleVaryings<Lanes, N>,
    gradients: WeightGradients<Lanes>,
    one_over_area: Lanes,
}

/// Which pixels of a tile a triangle may cover, and where they are in memory.
struct Placing {
    area: Rect,
    tile: Rect,
    width: usize,
}

/// Draws the rows of a triangle in a tile, eight pixels at a time.
///
/// A function by itself, so that the compiler knows that nothing that is written here changes what is read.
#[inline(never)]
fn draw_area<const PLAIN: bool, S: Shader<N>, E: Edges, const N: usize>(
    shader: &S,
    state: &RenderState,
    brush: &Brush<N>,
    edges: &E,
    place: &Placing,
    colors: &mut [Color],
    depths: &mut [f32],
) {
    let Placing { area, tile, width } = *place;
    let first = area.left - (area.left - tile.left) % LANES as i32;
    for y in area.rows() {
        let start = (y - tile.bottom) as usize * width;
        let row = start + first as usize..start + tile.right as usize;
        let (color_groups, color_rest) = colors[row.clone()].as_chunks_mut::<LANES>();
        let (depth_groups, depth_rest) = depths[row].as_chunks_mut::<LANES>();
        let mut group = edges.row(y);
        let mut x = first;
        for (colors, depths) in color_groups.iter_mut().zip(depth_groups) {
            if x >= area.right {
                break;
            }
            let limits = [area.left - x, area.right - x];
            draw_group::<PLAIN, S, E, N>(shader, state, brush, &group, edges, limits, colors, depths);
            edges.step(&mut group);
            x += LANES as i32;
        }
        if x < area.right {
            // The picture ends within a group.
            let (mut eight_colors, mut eight_depths) = ([Color::BLACK; LANES], [0.0; LANES]);
            eight_colors[..color_rest.len()].copy_from_slice(color_rest);
            eight_depths[..depth_rest.len()].copy_from_slice(depth_rest);
            let limits = [area.left - x, area.right - x];
            let (colors, depths) = (&mut eight_colors, &mut eight_depths);
            draw_group::<PLAIN, S, E, N>(shader, state, brush, &group, edges, limits, colors, depths);
            color_rest.copy_from_slice(&eight_colors[..color_rest.len()]);
            depth_rest.copy_from_slice(&eight_depths[..depth_rest.len()]);
        }
    }
}

/// Tests, shades and writes eight neighbors, as far as they are covered and their lanes lie between the limits.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a part of the innermost loop")]
fn draw_group<const PLAIN: bool, S: Shader<N>, E: Edges, const N: usize>(
    shader: &S,
    state: &RenderState,
    brush: &Brush<N>,
    group: &E::Group,
    edges: &E,
    [start, end]: [i32; 2],
    colors: &mut [Color; LANES],
    depths: &mut [f32; LANES],
) {
    let mut mask = edges.covered(group);
    if start > 0 || end < LANES as i32 {
        mask = mask.and(LaneMask::range(start, end));
    }
    if mask.bits() == 0 {
        return;
    }
    let Brush { varyings, gradients, one_over_area } = brush;
    let weights = E::values(group).map(|value| value * *one_over_area);
    let interpolation = if PLAIN { Interpolation::PerspectiveCorrect } else { state.interpolation };

    // Depth first: what is hidden need not be shaded.
    let is_linear = PLAIN || state.depth_encoding.is_linear_on_screen();
    let depth = if is_linear { varyings.depth_at(weights) } else { varyings.at(weights).w };
    let stored = Lanes::new(*depths);
    let test = if PLAIN { DepthTest::LessOrEqual } else { state.merge.depth_test };
    mask = mask.and(passes(test, depth, stored));
    if mask.bits() == 0 {
        return;
    }

    let point = varyings.interpolated(weights, interpolation);
    let shaded = if S::USES_DERIVATIVES {
        shader.fragment_with_derivatives(point.values, varyings.derivatives(&point, *gradients))
    } else {
        shader.fragment(point.values)
    };
    mask = mask.and(shaded.keep);

    if PLAIN || state.merge.depth_write {
        *depths = Lanes::select(mask, depth, stored).to_array();
    }
    let there = i32x8::new(colors.map(|color| color.bits() as i32));
    let blend = if PLAIN { Blend::Opaque } else { state.merge.blend };
    let words = match blend {
        Blend::Opaque => packed([shaded.color[0], shaded.color[1], shaded.color[2]]),
        blend => packed(blend.apply(shaded.color, channels(there))),
    };
    *colors = mask.choose(words, there).to_array().map(|word| Color::from_bits(word as u32));
}
// ANCHOR_END: rows

/// What a corner's record holds, the same in all lanes.
fn corner_of<const N: usize>(record: &[f32x8]) -> CornerVaryings<Lanes, N> {
    let number = |k: usize| Lanes::splat(record[k / LANES].as_array_ref()[k % LANES]);
    CornerVaryings { distance: number(0), depth: number(1), values: from_fn(|k| number(k + 2)) }
}

fn passes(test: DepthTest, depth: Lanes, stored: Lanes) -> LaneMask {
    match test {
        DepthTest::Less => depth.is_less(stored),
        DepthTest::LessOrEqual => is_less_or_equal(depth, stored),
        DepthTest::Greater => is_greater(depth, stored),
        DepthTest::Always => LaneMask::all(true),
    }
}

fn blended(blend: Blend, color: [f32; 4], there: Color) -> Color {
    let there = there.to_f64().map(|channel| channel as f32);
    crate::framebuffer::Rounding::Nearest.color(blend.apply(color, there))
}

/// Whether all values of a triangle's edge functions near it fit into 32 bits.
fn is_narrow([a, b, c]: [Place; 3]) -> bool {
    let size = |axis: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // Groups of eight begin up to seven pixels to the left, and end as many to the right.
        i64::from(high) - i64::from(low) + 16 * SUBPIXELS
    };
    size(0) * size(1) < 1 << 29
}

/// An edge function at eight neighboring centers from a point on, if its values fit into 32 bits.
fn narrow_lanes(edge: &EdgeFunction, start: [i64; 2]) -> i32x8 {
    let step = (edge.step_x * SUBPIXELS) as i32;
    i32x8::splat(edge.at(start) as i32) + i32x8::splat(step) * i32x8::new([0, 1, 2, 3, 4, 5, 6, 7])
}

/// The edge functions along a row, eight centers at a time.
trait Edges {
    /// The values at eight neighboring centers.
    type Group;

    /// The first group of a row.
    fn row(&self, y: i32) -> Self::Group;
    /// The next eight.
    fn step(&self, group: &mut Self::Group);
    /// Which of the eight are covered.
    fn covered(&self, group: &Self::Group) -> LaneMask;
    /// The values that belong to the second and the third vertex, each rounded once.
    fn values(group: &Self::Group) -> [Lanes; 2];
}

/// In 32-bit integers, for triangles that are not too large.
struct Narrow<'a> {
    setup: &'a Setup,
    left: i32,
    steps: [i32x8; 3],
    shy: [i32x8; 3],
}

impl<'a> Narrow<'a> {
    fn new(setup: &'a Setup, left: i32) -> Self {
        let step = |edge: EdgeFunction| i32x8::splat((edge.step_x * SUBPIXELS) as i32 * LANES as i32);
        let shy = setup.shy.map(|shy| i32x8::splat(shy as i32));
        Self { setup, left, steps: setup.edges.map(step), shy }
    }
}

impl Edges for Narrow<'_> {
    type Group = [i32x8; 3];

    #[inline(always)]
    fn row(&self, y: i32) -> [i32x8; 3] {
        from_fn(|i| narrow_lanes(&self.setup.edges[i], center(self.left, y)))
    }

    #[inline(always)]
    fn step(&self, group: &mut [i32x8; 3]) {
        *group = from_fn(|i| group[i] + self.steps[i]);
    }

    #[inline(always)]
    fn covered(&self, group: &[i32x8; 3]) -> LaneMask {
        let outside = (group[0] - self.shy[0]) | (group[1] - self.shy[1]) | (group[2] - self.shy[2]);
        LaneMask::of_signs(outside).not()
    }

    #[inline(always)]
    fn values(group: &[i32x8; 3]) -> [Lanes; 2] {
        [group[1].round_float(), group[2].round_float()]
    }
}

// ANCHOR: split
/// A whole number of up to 40 bits as the sum of two `f32` that are exact: a multiple of 2¹⁶, and the rest.
///
/// ```text
///    E = high · 2¹⁶ + low        high: up to 24 bits        low: 16 bits, and 20 after a tile's steps
/// ```
///
/// Both are stepped by additions that are exact; their sum is E, rounded once. Its sign is that of E.
#[derive(Clone, Copy)]
struct Parts {
    high: Lanes,
    low: Lanes,
}

impl Parts {
    /// The numbers start, start + step, start + 2 · step, …
    fn stepping(start: i64, step: i64) -> Self {
        let number = Lanes::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let (start, step) = (Self::same(start), Self::same(step));
        Self { high: start.high + step.high * number, low: start.low + step.low * number }
    }

    fn same(number: i64) -> Self {
        let (high, low) = (number >> 16, number & 0xFFFF);
        Self { high: Lanes::splat(high as f32 * 65_536.0), low: Lanes::splat(low as f32) }
    }
}
// ANCHOR_END: split

/// In [`Parts`]. With `INSIDE` all centers are known to be covered, and nothing is asked.
struct Split<'a, const INSIDE: bool> {
    setup: &'a Setup,
    left: i32,
    steps: [Parts; 3],
    shy: [Lanes; 3],
}

impl<'a, const INSIDE: bool> Split<'a, INSIDE> {
    fn new(setup: &'a Setup, left: i32) -> Self {
        let steps = setup.edges.map(|edge| Parts::same(edge.step_x * SUBPIXELS * LANES as i64));
        Self { setup, left, steps, shy: setup.shy.map(|shy| Lanes::splat(shy as f32)) }
    }
}

impl<const INSIDE: bool> Edges for Split<'_, INSIDE> {
    type Group = [Parts; 3];

    #[inline(always)]
    fn row(&self, y: i32) -> [Parts; 3] {
        self.setup.edges.map(|edge| Parts::stepping(edge.at(center(self.left, y)), edge.step_x * SUBPIXELS))
    }

    #[inline(always)]
    fn step(&self, group: &mut [Parts; 3]) {
        for (parts, step) in group.iter_mut().zip(&self.steps).skip(usize::from(INSIDE)) {
            *parts = Parts { high: parts.high + step.high, low: parts.low + step.low };
        }
    }

    #[inline(always)]
    fn covered(&self, group: &[Parts; 3]) -> LaneMask {
        if INSIDE {
            return LaneMask::all(true);
        }
        let is_inside =
            |i: usize| is_less_or_equal(Lanes::ZERO, group[i].high + (group[i].low - self.shy[i]));
        is_inside(0).and(is_inside(1)).and(is_inside(2))
    }

    #[inline(always)]
    fn values(group: &[Parts; 3]) -> [Lanes; 2] {
        [group[1].high + group[1].low, group[2].high + group[2].low]
    }
}

/// In 64-bit integers: for triangles of thousands of pixels on a side, seen from near their corners.
struct Huge<'a> {
    setup: &'a Setup,
    left: i32,
}

impl Edges for Huge<'_> {
    type Group = [[i64; LANES]; 3];

    fn row(&self, y: i32) -> Self::Group {
        self.setup.edges.map(|edge| from_fn(|lane| edge.at(center(self.left + lane as i32, y))))
    }

    fn step(&self, group: &mut Self::Group) {
        for (values, edge) in group.iter_mut().zip(&self.setup.edges) {
            values.iter_mut().for_each(|value| *value += edge.step_x * SUBPIXELS * LANES as i64);
        }
    }

    fn covered(&self, group: &Self::Group) -> LaneMask {
        let is_covered = |lane: usize| (0..3).all(|i| group[i][lane] >= self.setup.shy[i]);
        LaneMask::of_bits((0..LANES).fold(0, |bits, lane| bits | i32::from(is_covered(lane)) << lane))
    }

    fn values(group: &Self::Group) -> [Lanes; 2] {
        [1, 2].map(|i| Lanes::new(group[i].map(|value| value as f32)))
    }
}
