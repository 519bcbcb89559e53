//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::array::from_fn;

use wide::{f32x8, i32x8};

use super::edges::{Edges, Huge, Narrow, Setup, Split, is_narrow, narrow_lanes};
use super::front::{Front, Source, Triangle, bounding_box};
use crate::depth::DepthTest;
use crate::edge::{SUBPIXELS, center};
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
    pub(super) fn flush<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
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
