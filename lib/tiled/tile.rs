//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::sync::atomic::Ordering;

use prefetch_index::prefetch_index;

use super::bands::{Band, TILE_HEIGHT};
use super::edges::{SMALL_SIDE, STEPS, SmallTriangleSetup, Spans, TriangleSetup};
use super::frame::Frame;
use super::instruction_set::{InstructionSet, MaskOf, WordsOf};
use super::lanes::{ALL, Block, LANES, each_lane};
use super::occlusion::{NO_OCCLUDER, coverage_of, depth_range, occluder_depth};
use super::packed::{PackedTriangleVaryings, linear};
use super::snapped::{box_of, is_at_most, shared};
use super::vertices::Triangle;
use crate::color::Color;
use crate::depth::DepthTest;
use crate::exact::edge::gradients_between;
use crate::interpolate::{Interpolation, Projected};
use crate::merge::{Blend, Merge, Rounding};
use crate::real::{Mask, Real, map3};
use crate::rect::Rect;
use crate::shader::{Paint, Shaded, Shader};
use crate::state::RenderState;
use crate::varyings::{Derivatives, LinearVaryings};

/// The tile of a band that is being drawn.
pub(super) struct Tile<'a, I> {
    instructions: I,
    pub(super) band: Band<'a>,
    /// What of the tile lies in the picture.
    rect: Rect,
    /// Nothing that is deeper than this can be seen.
    occluder_depth: f64,
    queue: Queue,
    /// What a larger one covers.
    spans: Spans,
}

/// Fragments of small triangles that wait until there are eight of them.
struct Queue {
    count: usize,
    /// 1/w, depth, V/w of each fragment.
    packed: [Block; LANES],
    /// Where in the band each fragment is: an index.
    indices: [usize; LANES],
}

impl<'a, I: InstructionSet> Tile<'a, I> {
    /// No tile yet.
    pub(super) fn new(instructions: I, band: Band<'a>) -> Self {
        Self {
            instructions,
            band,
            rect: Rect::sized(0, 0),
            occluder_depth: NO_OCCLUDER,
            queue: Queue { count: 0, packed: [Block::ZERO; LANES], indices: [0; LANES] },
            spans: Spans::NONE,
        }
    }

    /// Draws the triangles of a bin into a tile, one after the other, but for those that are known to be hidden.
    pub(super) fn draw<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        number: usize,
        rect: Rect,
    ) {
        self.rect = rect;
        let may_hide = frame.front.has_large_triangles() && !frame.discards.load(Ordering::Relaxed);
        self.occluder_depth = if may_hide { occluder_depth(frame, number, rect) } else { NO_OCCLUDER };
        self.draw_all(frame, number);
        if self.occluder_depth < NO_OCCLUDER && frame.discards.load(Ordering::Relaxed) {
            // What seemed to cover the tile may have holes: once more, with all triangles. Where the nearest stays, and of
            // equally near ones the last, drawing twice is drawing once.
            self.occluder_depth = NO_OCCLUDER;
            self.draw_all(frame, number);
        }
    }

    #[inline(never)]
    fn draw_all<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>, number: usize) {
        self.instructions.run(
            #[inline(always)]
            || {
                frame.front.each_triangle_in(
                    frame.source,
                    number,
                    #[inline(always)]
                    |triangle| self.draw_triangle(frame, triangle),
                );
            },
        );
        self.flush(frame);
    }

    /// Draws a triangle as far as it lies in the tile.
    #[inline(always)]
    fn draw_triangle<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
    ) {
        let whole = box_of(triangle.positions);
        let Some(area) = shared(whole, self.rect) else { return };
        // Values are stepped from the first pixel of a row. It must be in this tile.
        let is_small = is_at_most(whole, SMALL_SIDE as i32) && whole.left >= self.rect.left;
        // What takes more than one block does not fit into the queue, nor do the gradients of a triangle.
        if is_small && 2 + N <= LANES && !S::USES_DERIVATIVES {
            self.draw_small(frame, triangle, area);
        } else {
            let may_be_hidden = self.occluder_depth < NO_OCCLUDER && !is_at_most(whole, TILE_HEIGHT);
            let is_hidden = |coverage| depth_range(&coverage, triangle, area)[0] > self.occluder_depth;
            if !(may_be_hidden && coverage_of(triangle).is_some_and(is_hidden)) {
                self.draw_spans(frame, triangle, area);
            }
        }
    }

    // ANCHOR: small
    /// A few pixels: each covered one goes into the queue.
    #[inline(always)]
    fn draw_small<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        let instructions = self.instructions;
        let setup = SmallTriangleSetup::new(triangle.positions, (area.left, area.bottom));
        let varyings = PackedTriangleVaryings::<_, N>::of(instructions, triangle);
        let step = varyings.change(instructions, setup.weight_step()).first;
        let mut covered = setup.covered(instructions, area);
        let (firsts, weights) = setup.starts(instructions, covered);
        let (corner, width) = (self.band.index((area.left, area.bottom)), self.band.stride);
        while covered != 0 {
            let bit = covered.trailing_zeros() as usize;
            covered &= covered - 1;
            let (row, column) = (bit / SMALL_SIDE, bit % SMALL_SIDE);
            let start = varyings.at(instructions, [weights[0][row], weights[1][row]]).first;
            // The remainder only shows the compiler that the index is in range.
            let steps = instructions.splat(STEPS[(column - firsts[row] as usize) % SMALL_SIDE]);
            self.enqueue(frame, start + step * steps, corner + row * width + column);
        }
    }

    /// Lets a fragment wait for others, unless it is hidden already.
    #[inline(always)]
    fn enqueue<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        packed: I::Lanes,
        index: usize,
    ) {
        // Stored depths never grow: what fails now fails later.
        if frame.is_plain && self.instructions.numbers(packed)[1] > self.band.depths[index] {
            return;
        }
        // The remainder only shows the compiler that there is room. All eight at once are written as they are read.
        let place = self.queue.count % LANES;
        self.queue.packed[place] = Block(self.instructions.numbers(packed));
        self.queue.indices[place] = index;
        self.queue.count = place + 1;
        if self.queue.count == LANES {
            self.flush(frame);
        }
    }

    /// Shades all fragments that wait.
    fn flush<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        if self.queue.count == 0 {
            return;
        }
        if I::ONLY_PLAIN || frame.is_plain {
            self.flush_queue::<true, S, N>(frame);
        } else {
            self.flush_queue::<false, S, N>(frame);
        }
    }

    /// Shades them all at once, and writes them one after the other.
    #[inline(never)]
    fn flush_queue<const PLAIN: bool, S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        self.instructions.run(
            #[inline(always)]
            || self.flush_queue_in::<PLAIN, S, N>(frame),
        );
    }

    #[inline(always)]
    fn flush_queue_in<const PLAIN: bool, S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        let (count, instructions) = (std::mem::take(&mut self.queue.count), self.instructions);
        let Merge { depth_test, depth_write, blend } =
            if PLAIN { Merge::default() } else { frame.state.merge };
        let numbers = instructions.transposed(&self.queue.packed);
        let zero = instructions.splat(0.0);
        let linear = linear(
            #[inline(always)]
            |k| if k < LANES { numbers[k] } else { zero },
        );
        let interpolation = if PLAIN { Interpolation::PerspectiveCorrect } else { frame.state.interpolation };
        let point: Projected<I::Lanes, N> = linear.multiplied(interpolation);
        let is_linear = PLAIN || frame.state.depth_encoding.is_linear_on_screen();
        let depths = instructions.numbers(if is_linear { linear.depth } else { point.w });
        let shaded: Shaded<I::Lanes> = frame.shader.fragment(point.values);
        let kept = instructions.bits(shaded.keep);
        let opaque = instructions.word_array(opaque(instructions, shaded.color));
        let channels = shaded.color.channels();
        // As many of both, so that one test is enough.
        let pixels = self.band.colors.len().min(self.band.depths.len());
        let (colors, band_depths) = (&mut self.band.colors[..pixels], &mut self.band.depths[..pixels]);
        for (lane, &index) in self.queue.indices.iter().enumerate().take(count) {
            if kept >> lane & 1 == 0 {
                continue;
            }
            let (color, depth) = (&mut colors[index], &mut band_depths[index]);
            if !depth_test.passes(depths[lane], *depth) {
                continue;
            }
            if depth_write {
                *depth = depths[lane];
            }
            *color = match blend {
                Blend::Opaque => Color::from_bits(opaque[lane]),
                _ => blended(blend, channels.map(|channel| instructions.numbers(channel)[lane]), *color),
            };
        }
    }
    // ANCHOR_END: small

    // ANCHOR: rows
    /// Many pixels: row by row.
    #[inline(never)]
    fn draw_spans<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        self.flush(frame);
        let instructions = self.instructions;
        let setup = instructions.run(
            #[inline(always)]
            || {
                let setup = TriangleSetup::new(instructions, triangle.positions);
                self.spans.find(instructions, &setup, area.rows(), frame.columns);
                setup
            },
        );
        if I::ONLY_PLAIN || frame.is_plain {
            draw_rows::<true, I, S, N>(
                instructions,
                frame,
                triangle,
                &setup,
                &self.spans,
                area,
                &mut self.band,
            );
        } else {
            draw_rows::<false, I, S, N>(
                instructions,
                frame,
                triangle,
                &setup,
                &self.spans,
                area,
                &mut self.band,
            );
        }
    }
}

/// Draws the rows of a triangle, eight pixels at a time from the first that is covered.
///
/// A function by itself, so that the compiler knows that nothing that is written here changes what is read.
#[inline(never)]
fn draw_rows<const PLAIN: bool, I: InstructionSet, S: Shader<N>, const N: usize>(
    instructions: I,
    frame: &Frame<'_, S, N>,
    triangle: Triangle<'_>,
    setup: &TriangleSetup,
    spans: &Spans,
    area: Rect,
    band: &mut Band<'_>,
) {
    instructions.run(
        #[inline(always)]
        || draw_rows_in::<PLAIN, I, S, N>(instructions, frame, triangle, setup, spans, area, band),
    );
}

#[inline(always)]
fn draw_rows_in<const PLAIN: bool, I: InstructionSet, S: Shader<N>, const N: usize>(
    instructions: I,
    frame: &Frame<'_, S, N>,
    triangle: Triangle<'_>,
    setup: &TriangleSetup,
    spans: &Spans,
    area: Rect,
    band: &mut Band<'_>,
) {
    let (bottom_left, stride, to_next_band) =
        (band.index((area.left, area.bottom)), band.stride, band.to_next_band);
    // Read once: the compiler cannot know that they stay the same.
    let program = (frame.shader, frame.state);
    // As many of both, so that one test is enough for eight of each.
    let pixels = band.colors.len().min(band.depths.len());
    let (colors, depths) = (&mut band.colors[..pixels], &mut band.depths[..pixels]);
    let last = pixels.checked_sub(LANES).expect("a band has room for eight");
    let varyings = PackedTriangleVaryings::<_, N>::of(instructions, triangle);
    let step = varyings.change(instructions, setup.weight_step()).spread(instructions);
    let gradients = S::USES_DERIVATIVES.then(
        #[inline(always)]
        || {
            let [dx, dy] = gradients_between(triangle.vertices());
            [
                varyings.change(instructions, dx).spread(instructions),
                varyings.change(instructions, dy).spread(instructions),
            ]
        },
    );
    let mut thrown_away = 0;
    for row in 0..area.rows().len() {
        let (first, covered, weights) = spans.row(row, &area.columns());
        if covered.is_empty() {
            continue;
        }
        let start = varyings.at(instructions, weights).spread(instructions);
        let mut right = instructions.splat((covered.start - first) as f32) + instructions.lanes(STEPS);
        let mut index = bottom_left + row * stride + (covered.start - area.left) as usize;
        let mut count = covered.end - covered.start;
        while count > 0 {
            let mut bits = instructions.lowest(count);
            let at = index.min(last);
            if at < index {
                // Fewer than eight are left of the band: the group begins as many before.
                let before = (index - at) as i32;
                bits <<= before;
                right = right - instructions.splat(before as f32);
            }
            let (colors, depths) = (eight(colors, at), eight(depths, at));
            fetch_ahead(to_next_band, colors, depths);
            let linear = start.moved(&step, right);
            thrown_away |=
                draw_group::<PLAIN, I, S, N>(instructions, program, linear, &gradients, bits, colors, depths);
            index += LANES;
            count -= LANES as i32;
            right = right + instructions.splat(LANES as f32);
        }
    }
    frame.note(thrown_away);
}

/// The eight pixels from one on.
#[inline(always)]
fn eight<T>(pixels: &mut [T], first: usize) -> &mut [T; LANES] {
    pixels[first..].first_chunk_mut().expect("a band has room for eight")
}

/// Prefetches the same pixel of the next band, which is mostly cleared soon.
///
/// Only a hint: the picture does not depend on it, and there need not be a next band.
#[inline(always)]
fn fetch_ahead(to_next_band: usize, colors: &[Color; LANES], depths: &[f32; LANES]) {
    prefetch_index(colors, to_next_band);
    prefetch_index(depths, to_next_band);
}

/// Tests, shades and writes the covered ones of eight neighbors, a bit for each. Which of them the shader throws away.
#[inline(always)]
fn draw_group<const PLAIN: bool, I: InstructionSet, S: Shader<N>, const N: usize>(
    instructions: I,
    (shader, state): (&S, &RenderState),
    linear: LinearVaryings<I::Lanes, N>,
    gradients: &Option<[LinearVaryings<I::Lanes, N>; 2]>,
    covered: i32,
    colors: &mut [Color; LANES],
    depths: &mut [f32; LANES],
) -> i32 {
    let interpolation = if PLAIN { Interpolation::PerspectiveCorrect } else { state.interpolation };

    // Depth first: what is hidden need not be shaded.
    let is_linear = PLAIN || state.depth_encoding.is_linear_on_screen();
    let depth = if is_linear { linear.depth } else { linear.multiplied(interpolation).w };
    let stored = instructions.lanes(*depths);
    let test = if PLAIN { DepthTest::LessOrEqual } else { state.merge.depth_test };
    let seen = covered & instructions.bits(passes(instructions, test, depth, stored));
    if seen == 0 {
        return 0;
    }

    let point = linear.multiplied(interpolation);
    let shaded = match gradients {
        Some(gradients) => {
            let [dx, dy] = gradients;
            let dx = dx.derivative(&point, interpolation);
            let dy = dy.derivative(&point, interpolation);
            shader.fragment_with_derivatives(point.values, Derivatives { dx, dy })
        }
        None => shader.fragment(point.values),
    };
    let drawn = seen & instructions.bits(shaded.keep);

    // Mostly all eight are written. If not, what is there stays in the other lanes.
    let there = instructions.words(each_lane(
        #[inline(always)]
        |lane| colors[lane].bits(),
    ));
    let blend = if PLAIN { Blend::Opaque } else { state.merge.blend };
    let mut words = match blend {
        Blend::Opaque => opaque(instructions, shaded.color),
        blend => instructions.packed(blend.apply(shaded.color.channels(), I::Lanes::channels(there))),
    };
    let mut nearest = depth;
    if drawn != ALL {
        let mask = instructions.mask(drawn);
        words = instructions.choose(mask, words, there);
        nearest = I::Lanes::select(mask, depth, stored);
    }
    let words = instructions.word_array(words);
    *colors = each_lane(
        #[inline(always)]
        |lane| Color::from_bits(words[lane]),
    );
    if PLAIN || state.merge.depth_write {
        *depths = instructions.numbers(nearest);
    }
    seen & !drawn
}
// ANCHOR_END: rows

#[inline(always)]
fn passes<I: InstructionSet>(
    instructions: I,
    test: DepthTest,
    depth: I::Lanes,
    stored: I::Lanes,
) -> MaskOf<I> {
    match test {
        DepthTest::Less => depth.is_less(stored),
        DepthTest::LessOrEqual => instructions.is_less_or_equal(depth, stored),
        DepthTest::Greater => stored.is_less(depth),
        DepthTest::Always => Mask::all(true),
    }
}

/// The words of eight colors through which nothing shines.
#[inline(always)]
fn opaque<I: InstructionSet>(instructions: I, color: Paint<I::Lanes>) -> WordsOf<I> {
    match color {
        Paint::Texel(texels) => texels,
        Paint::Channels([red, green, blue, _]) => instructions.packed([red, green, blue]),
    }
}

fn blended(blend: Blend, color: [f32; 4], there: Color) -> Color {
    let there = map3(there.to_f64(), |channel| channel as f32);
    Rounding::Nearest.color(blend.apply(color, there))
}
