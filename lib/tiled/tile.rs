//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::array::from_fn;

use wide::{f32x8, i32x8};

use super::front::{Front, Place, Source, Triangle, bounding_box, signed_area};
use crate::depth::DepthTest;
use crate::edge::{EdgeFunction, SUBPIXELS, center};
use crate::interpolate::Projected;
use crate::lanes::{LANES, LaneMask, Lanes, channels, is_greater, is_less_or_equal, packed};
use crate::merge::Blend;
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
        let corners = triangle.records.map(corner_of::<N>);
        let varyings = TriangleVaryings::between(corners, frame.state.interpolation);
        let gradients = setup.gradients(triangle.places);
        let Rect { left, right, .. } = setup.area;
        // Groups of eight begin at the same columns for all triangles.
        let first = left - (left - self.rect.left) % LANES as i32;
        let one_over_area = Lanes::splat(setup.one_over_area);
        let mut rows = Rows::new(setup, first, is_narrow(triangle.places));
        for y in setup.area.rows() {
            for x in (first..right).step_by(LANES) {
                let (covered, second, third) = rows.group(x);
                let mask = covered.and(LaneMask::range(left - x, right - x));
                if mask.bits() != 0 {
                    let weights = [second * one_over_area, third * one_over_area];
                    self.shade(frame, &varyings, gradients, mask, weights, [x, y]);
                }
            }
            rows.next_row();
        }
    }

    /// Tests, shades and writes eight neighbors.
    fn shade<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        varyings: &TriangleVaryings<Lanes, N>,
        gradients: WeightGradients<Lanes>,
        covered: LaneMask,
        weights: [Lanes; 2],
        [x, y]: [i32; 2],
    ) {
        let state = frame.state;
        let place = self.place(x, y);
        let is_linear = state.depth_encoding.is_linear_on_screen();

        // Depth first: what is hidden need not be shaded.
        let depth = if is_linear { varyings.depth_at(weights) } else { varyings.at(weights).w };
        let stored = load(&self.depths[place..], 0.0);
        let stored = Lanes::new(stored);
        let mask = covered.and(passes(state.merge.depth_test, depth, stored));
        if mask.bits() == 0 {
            return;
        }

        let point = varyings.at(weights);
        let shaded = if S::USES_DERIVATIVES {
            frame.shader.fragment_with_derivatives(point.values, varyings.derivatives(&point, gradients))
        } else {
            frame.shader.fragment(point.values)
        };
        let mask = mask.and(shaded.keep);

        if state.merge.depth_write {
            store(&mut self.depths[place..], Lanes::select(mask, depth, stored).to_array());
        }
        let there: [i32; LANES] = load(&self.colors[place..], Color::BLACK).map(|color| color.bits() as i32);
        let there = i32x8::new(there);
        let blended = match state.merge.blend {
            Blend::Opaque => packed([shaded.color[0], shaded.color[1], shaded.color[2]]),
            blend => packed(blend.apply(shaded.color, channels(there))),
        };
        let words = mask.choose(blended, there).to_array();
        store(&mut self.colors[place..], words.map(|word| Color::from_bits(word as u32)));
    }
    // ANCHOR_END: rows
}

/// What a corner's record holds, the same in all lanes.
fn corner_of<const N: usize>(record: &[f32x8]) -> CornerVaryings<Lanes, N> {
    let number = |k: usize| Lanes::splat(record[k / LANES].as_array_ref()[k % LANES]);
    CornerVaryings { distance: number(0), depth: number(1), values: from_fn(|k| number(k + 2)) }
}

/// Eight neighbors of a row; beyond its end, `rest`.
fn load<T: Copy>(row: &[T], rest: T) -> [T; LANES] {
    match row.first_chunk() {
        Some(eight) => *eight,
        None => from_fn(|lane| row.get(lane).copied().unwrap_or(rest)),
    }
}

/// Writes eight neighbors back, as far as the row goes.
fn store<T: Copy>(row: &mut [T], values: [T; LANES]) {
    match row.first_chunk_mut() {
        Some(eight) => *eight = values,
        None => row.iter_mut().zip(values).for_each(|(to, value)| *to = value),
    }
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

/// The edge functions along a row, eight centers at a time: which are covered, and two of the three values.
enum Rows<'a> {
    /// In 32-bit integers.
    Narrow { first: i32, values: [i32x8; 3], shy: [i32x8; 3], steps: [[i32; 3]; 2] },
    /// In 64-bit integers; weights by `f64`, in which they are exact.
    Wide { setup: &'a Setup, y: i32, first: i32, values: [i64; 3] },
}

impl<'a> Rows<'a> {
    fn new(setup: &'a Setup, first: i32, is_narrow: bool) -> Self {
        let y = setup.area.bottom;
        let start = center(first, y);
        if is_narrow {
            let values = from_fn(|i| narrow_lanes(&setup.edges[i], start));
            let shy = setup.shy.map(|shy| i32x8::splat(shy as i32));
            let steps = [
                setup.edges.map(|edge| (edge.step_x * SUBPIXELS) as i32),
                setup.edges.map(|edge| (edge.step_y * SUBPIXELS) as i32),
            ];
            Self::Narrow { first, values, shy, steps }
        } else {
            Self::Wide { setup, y, first, values: setup.edges.map(|edge| edge.at(start)) }
        }
    }

    fn next_row(&mut self) {
        match self {
            Self::Narrow { values, steps, .. } => {
                *values = from_fn(|i| values[i] + i32x8::splat(steps[1][i]));
            }
            Self::Wide { setup, y, first, values } => {
                *y += 1;
                *values = setup.edges.map(|edge| edge.at(center(*first, *y)));
            }
        }
    }

    /// Which of the eight pixels from x on are covered, and the values for the second and the third vertex.
    fn group(&self, x: i32) -> (LaneMask, Lanes, Lanes) {
        match self {
            Self::Narrow { first, values, shy, steps, .. } => {
                let here: [i32x8; 3] = from_fn(|i| values[i] + i32x8::splat(steps[0][i] * (x - first)));
                let outside = (here[0] - shy[0]) | (here[1] - shy[1]) | (here[2] - shy[2]);
                (LaneMask::of_signs(outside).not(), here[1].round_float(), here[2].round_float())
            }
            Self::Wide { setup, first, values, .. } => wide_group(setup, *values, x - first),
        }
    }
}

/// The same in 64 bits.
fn wide_group(setup: &Setup, row: [i64; 3], columns: i32) -> (LaneMask, Lanes, Lanes) {
    let steps = setup.edges.map(|edge| edge.step_x * SUBPIXELS);
    let start: [i64; 3] = from_fn(|i| row[i] + steps[i] * i64::from(columns));
    let mut covered = LaneMask::all(true);
    for i in 0..3 {
        let (from, to) = (start[i] - setup.shy[i], start[i] - setup.shy[i] + steps[i] * (LANES as i64 - 1));
        if from < 0 && to < 0 {
            return (LaneMask::all(false), Lanes::ZERO, Lanes::ZERO);
        }
        if from < 0 || to < 0 {
            covered = covered.and(crossing(from, steps[i]));
        }
    }
    let lanes = |i: usize| {
        let (start, step) = (start[i] as f64, steps[i] as f64);
        Lanes::new(from_fn(|lane| (start + step * lane as f64) as f32))
    };
    (covered, lanes(1), lanes(2))
}

/// The lanes on the right side of an edge that passes between the first and the last of them.
fn crossing(from: i64, step: i64) -> LaneMask {
    if step > 0 {
        // The first lane from which on the value is not negative.
        LaneMask::range(((-from + step - 1) / step) as i32, LANES as i32)
    } else {
        LaneMask::range(0, (from / -step) as i32 + 1)
    }
}
