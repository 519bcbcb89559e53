//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::array::from_fn;
use std::sync::atomic::{AtomicBool, Ordering};

use prefetch_index::prefetch_index;
use wide::{f32x8, i32x8};

use super::Band;
use super::edges::{Edges, GROUPS, Huge, Narrow, Setup, Split, Touch, is_narrow};
use super::front::{Front, Source, Triangle, bounding_box};
use super::occlusion::{NOTHING_IS_HIDDEN, depth_range, hidden_behind};
use crate::depth::DepthTest;
use crate::edge::gradients_between;
use crate::interpolate::{Interpolation, Projected};
use crate::lanes::{LANES, LaneMask, Lanes, is_greater, is_less_or_equal, packed};
use crate::merge::{Blend, Merge};
use crate::pipeline::RenderState;
use crate::real::{Mask, Real};
use crate::shader::{Paint, Shaded, Shader};
use crate::varyings::{CornerVaryings, TriangleVaryings, WeightGradients};
use crate::{Color, Rect};

/// What all tiles of a picture share.
pub(super) struct Frame<'a, S: Shader<N>, const N: usize> {
    pub(super) shader: &'a S,
    pub(super) state: &'a RenderState,
    pub(super) front: &'a Front,
    pub(super) source: &'a Source<'a, S, N>,
    /// Whether the shader has been seen to throw fragments of larger triangles away: only these can hide others.
    pub(super) discards: AtomicBool,
}

/// The tile of a band that is being drawn.
pub(super) struct Tile<'a> {
    pub(super) band: Band<'a>,
    /// What of the tile lies in the picture.
    rect: Rect,
    /// Nothing that is deeper than this can be seen.
    behind: f64,
    queue: Queue,
    /// How much the second and the third vertex of a small triangle weigh, row by row.
    weights: [[Lanes; 2]; SMALL as usize],
    /// The groups that a triangle touches.
    touches: [Touch; GROUPS],
}

/// Fragments of small triangles that wait until there are eight of them.
struct Queue {
    count: usize,
    /// 1/ω, depth, V/ω of each fragment.
    records: [f32x8; LANES],
    /// Where in the band each fragment is.
    places: [usize; LANES],
}

/// Up to this many pixels wide and high, a triangle is small: its coverage fits into 64 bits.
const SMALL: i32 = 8;

impl<S: Shader<N>, const N: usize> Frame<'_, S, N> {
    /// Notes whether the shader has thrown away any.
    fn note(&self, kept: LaneMask) {
        if kept.bits() != LaneMask::all(true).bits() {
            self.discards.store(true, Ordering::Relaxed);
        }
    }
}

impl<'a> Tile<'a> {
    /// No tile yet.
    pub(super) fn new(band: Band<'a>) -> Self {
        Self {
            band,
            rect: Rect::sized(0, 0),
            behind: NOTHING_IS_HIDDEN,
            queue: Queue { count: 0, records: [f32x8::ZERO; LANES], places: [0; LANES] },
            weights: [[Lanes::ZERO; 2]; SMALL as usize],
            touches: [Touch::default(); GROUPS],
        }
    }

    /// Draws triangles into a rectangle, one after the other, but for those that are known to be hidden.
    pub(super) fn draw<'t, S: Shader<N>, I: Iterator<Item = Triangle<'t>>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        rect: Rect,
        triangles: impl Fn() -> I,
    ) {
        self.rect = rect;
        let may_hide = frame.front.has_large_triangles() && !frame.discards.load(Ordering::Relaxed);
        self.behind = if may_hide { hidden_behind(frame, triangles(), rect) } else { NOTHING_IS_HIDDEN };
        self.draw_all(frame, triangles());
        if self.behind < NOTHING_IS_HIDDEN && frame.discards.load(Ordering::Relaxed) {
            // What seemed to cover the tile may have holes: once more, with all triangles. Where the nearest stays, and of
            // equally near ones the last, drawing twice is drawing once.
            self.behind = NOTHING_IS_HIDDEN;
            self.draw_all(frame, triangles());
        }
    }

    fn draw_all<'t, S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangles: impl Iterator<Item = Triangle<'t>>,
    ) {
        // Not `for`: so each chunk's bin has a loop of its own, and triangles stay in registers.
        triangles.for_each(|triangle| self.draw_triangle(frame, triangle));
        self.flush(frame);
    }

    /// Draws a triangle as far as it lies in the tile.
    fn draw_triangle<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
    ) {
        let Some(area) = bounding_box(triangle.places, self.rect) else { return };
        let is_small = area.columns().len() <= SMALL as usize && area.rows().len() <= SMALL as usize;
        let is_narrow = is_narrow(triangle.places);
        // A record of more than one block does not fit into the queue, and neighbors are needed for derivatives.
        if is_narrow && is_small && N + 2 <= LANES && !S::USES_DERIVATIVES {
            self.draw_small(frame, triangle, area);
        } else if is_narrow {
            self.draw_narrow(frame, triangle, area);
        } else {
            self.draw_large(frame, triangle, area);
        }
    }

    // ANCHOR: small
    /// A few pixels: each covered one goes into the queue.
    fn draw_small<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        let [first, second, third] = triangle.records.map(|record| record[0]);
        let (to_second, to_third) = (second - first, third - first);
        let setup = Narrow::new(triangle.places, [area.left, area.bottom]);
        let (corner, width) = (self.band.place([area.left, area.bottom]), self.band.stride);
        let mut covered = setup.covered(area, &mut self.weights);
        while covered != 0 {
            let bit = covered.trailing_zeros();
            covered &= covered - 1;
            let (row, column) = (bit / 8, bit % 8);
            let weight =
                |i: usize| f32x8::splat(self.weights[row as usize][i].as_array_ref()[column as usize]);
            let record = first + to_second * weight(0) + to_third * weight(1);
            self.enqueue(frame, record, corner + row as usize * width + column as usize);
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
        let stored = self.band.depths[place];
        if is_linear && !frame.state.merge.depth_test.passes(record.as_array_ref()[1], stored) {
            return;
        }
        self.queue.records[self.queue.count] = record;
        self.queue.places[self.queue.count] = place;
        self.queue.count += 1;
        if self.queue.count == LANES {
            self.flush(frame);
        }
    }

    /// Shades all fragments that wait.
    fn flush<S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        if self.queue.count > 0 && is_plain(frame.state) {
            self.flush_queue::<true, S, N>(frame);
        } else if self.queue.count > 0 {
            self.flush_queue::<false, S, N>(frame);
        }
    }

    /// Shades them all at once, and writes them one after the other.
    #[inline(never)]
    fn flush_queue<const PLAIN: bool, S: Shader<N>, const N: usize>(&mut self, frame: &Frame<'_, S, N>) {
        let count = std::mem::take(&mut self.queue.count);
        let Merge { depth_test, depth_write, blend } =
            if PLAIN { Merge::default() } else { frame.state.merge };
        let numbers = f32x8::transpose(self.queue.records);
        let corner = CornerVaryings {
            distance: numbers[0],
            depth: numbers[1],
            values: from_fn(|k| numbers.get(k + 2).copied().unwrap_or(f32x8::ZERO)),
        };
        let interpolation = if PLAIN { Interpolation::PerspectiveCorrect } else { frame.state.interpolation };
        let point: Projected<Lanes, N> = corner.multiplied(interpolation);
        let is_linear = PLAIN || frame.state.depth_encoding.is_linear_on_screen();
        let depths = if is_linear { corner.depth } else { point.w }.to_array();
        let shaded: Shaded<Lanes> = frame.shader.fragment(point.values);
        let kept = shaded.keep.bits();
        let opaque = opaque(shaded.color).to_array();
        let channels = shaded.color.channels();
        for lane in (0..count).filter(|lane| kept >> lane & 1 == 1) {
            let place = self.queue.places[lane];
            let (color, depth) = (&mut self.band.colors[place], &mut self.band.depths[place]);
            if !depth_test.passes(depths[lane], *depth) {
                continue;
            }
            if depth_write {
                *depth = depths[lane];
            }
            *color = match blend {
                Blend::Opaque => Color::from_bits(opaque[lane] as u32),
                _ => blended(blend, channels.map(|channel| channel.to_array()[lane]), *color),
            };
        }
    }
    // ANCHOR_END: small

    // ANCHOR: rows
    /// Some rows: first which groups of eight are touched, then group by group.
    fn draw_narrow<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        self.flush(frame);
        let area = whole_groups(area);
        let setup = Narrow::new(triangle.places, [area.left, area.bottom]);
        let part = self.band.part(area);
        let touched = setup.touched(size_in_groups(area), part.stride, &mut self.touches);
        if is_plain(frame.state) {
            draw_touched::<true, S, N>(frame, triangle, &setup, touched, part);
        } else {
            draw_touched::<false, S, N>(frame, triangle, &setup, touched, part);
        }
    }

    /// Many pixels: row by row.
    fn draw_large<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        let Some(setup) = Setup::new(triangle.places) else { return };
        if self.behind < NOTHING_IS_HIDDEN && depth_range(&setup, triangle, area)[0] > self.behind {
            return;
        }
        self.flush(frame);
        let area = whole_groups(area);
        if setup.misses(area) {
            // An edge has all of the tile on its wrong side.
        } else if !setup.is_split_exact(area) {
            self.draw_groups(frame, triangle, &setup, area, Huge { setup: &setup, area });
        } else if setup.covers(area) {
            self.draw_groups(frame, triangle, &setup, area, Split::<true>::new(&setup, area));
        } else {
            self.draw_groups(frame, triangle, &setup, area, Split::<false>::new(&setup, area));
        }
    }

    fn draw_groups<S: Shader<N>, E: Edges, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        setup: &Setup,
        area: Rect,
        edges: E,
    ) {
        let part = self.band.part(area);
        if is_plain(frame.state) {
            draw_area::<true, S, E, N>(frame, triangle, setup.one_over_area, &edges, part);
        } else {
            draw_area::<false, S, E, N>(frame, triangle, setup.one_over_area, &edges, part);
        }
    }
}

/// The area, as many columns wider as it takes to begin and to end with a group of eight.
///
/// No triangle covers pixels outside its area: what is tested there is not covered, or else outside the picture.
pub(super) fn whole_groups(area: Rect) -> Rect {
    const SIDE: i32 = LANES as i32;
    Rect { left: area.left / SIDE * SIDE, right: (area.right + SIDE - 1) / SIDE * SIDE, ..area }
}

/// How many groups wide and rows high an area of whole groups is.
pub(super) fn size_in_groups(area: Rect) -> [usize; 2] {
    [area.columns().len() / LANES, area.rows().len()]
}

/// Whether all options that matter for a pixel have their default values: the most common case, known at compile time.
pub(super) fn is_plain(state: &RenderState) -> bool {
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

impl<const N: usize> Brush<N> {
    /// Inlined, and called in the functions that draw: made outside of them, it would be copied once more.
    #[inline(always)]
    fn new<S: Shader<N>>(frame: &Frame<'_, S, N>, triangle: Triangle<'_>, one_over_area: f32) -> Self {
        let corners = triangle.records.map(corner_of::<N>);
        let vertices = triangle.places.map(|place| place.map(i64::from));
        Self {
            varyings: TriangleVaryings::between(corners, frame.state.interpolation),
            gradients: if S::USES_DERIVATIVES { gradients_between(vertices) } else { [[Lanes::ZERO; 2]; 2] },
            one_over_area: Lanes::splat(one_over_area),
        }
    }
}

/// Draws the groups that a triangle touches.
///
/// A function by itself, so that the compiler knows that nothing that is written here changes what is read.
#[inline(never)]
fn draw_touched<const PLAIN: bool, S: Shader<N>, const N: usize>(
    frame: &Frame<'_, S, N>,
    triangle: Triangle<'_>,
    setup: &Narrow,
    touched: &[Touch],
    Band { to_next_band, colors, depths, .. }: Band<'_>,
) {
    let brush = &Brush::new(frame, triangle, setup.one_over_area);
    let mut kept = LaneMask::all(true);
    for touch in touched {
        let mask = LaneMask::of_bits(touch.covered);
        let (colors, depths) = (eight(colors, touch.place), eight(depths, touch.place));
        fetch_ahead(to_next_band, colors, depths);
        let keep = draw_group::<PLAIN, S, N>(frame, brush, mask, setup.group(touch), colors, depths);
        kept = kept.and(keep);
    }
    frame.note(kept);
}

/// The eight pixels from one on.
#[inline(always)]
fn eight<T>(pixels: &mut [T], first: usize) -> &mut [T; LANES] {
    pixels[first..].first_chunk_mut().expect("rows have room for whole groups")
}

/// Draws the rows of a triangle, eight pixels at a time. A function by itself, as well.
#[inline(never)]
fn draw_area<const PLAIN: bool, S: Shader<N>, E: Edges, const N: usize>(
    frame: &Frame<'_, S, N>,
    triangle: Triangle<'_>,
    one_over_area: f32,
    edges: &E,
    Band { rect, stride, to_next_band, colors, depths }: Band<'_>,
) {
    let brush = &Brush::new(frame, triangle, one_over_area);
    let mut kept = LaneMask::all(true);
    let [columns, rows] = size_in_groups(rect);
    let mut first = edges.first();
    for (colors, depths) in colors.chunks_mut(stride).zip(depths.chunks_mut(stride)).take(rows) {
        let mut group = first;
        let (colors, depths) = (colors.as_chunks_mut().0, depths.as_chunks_mut().0);
        for (colors, depths) in colors.iter_mut().zip(depths).take(columns) {
            let mask = edges.covered(&group);
            if mask.bits() != 0 {
                fetch_ahead(to_next_band, colors, depths);
                let values = E::values(&group);
                let keep = draw_group::<PLAIN, S, N>(frame, brush, mask, values, colors, depths);
                kept = kept.and(keep);
            }
            edges.step_right(&mut group);
        }
        edges.step_up(&mut first);
    }
    frame.note(kept);
}

/// Asks for the same place of the next band, which is mostly cleared soon.
///
/// Only a hint: the picture does not depend on it, and there need not be a next band.
#[inline(always)]
fn fetch_ahead(to_next_band: usize, colors: &[Color; LANES], depths: &[f32; LANES]) {
    prefetch_index(colors, to_next_band);
    prefetch_index(depths, to_next_band);
}

/// Tests, shades and writes the covered ones of eight neighbors. Which of them the shader keeps.
#[inline(always)]
fn draw_group<const PLAIN: bool, S: Shader<N>, const N: usize>(
    frame: &Frame<'_, S, N>,
    brush: &Brush<N>,
    mut mask: LaneMask,
    values: [Lanes; 2],
    colors: &mut [Color; LANES],
    depths: &mut [f32; LANES],
) -> LaneMask {
    let (shader, state) = (frame.shader, frame.state);
    let Brush { varyings, gradients, one_over_area } = brush;
    let weights = [values[0] * *one_over_area, values[1] * *one_over_area];
    let interpolation = if PLAIN { Interpolation::PerspectiveCorrect } else { state.interpolation };

    // Depth first: what is hidden need not be shaded.
    let is_linear = PLAIN || state.depth_encoding.is_linear_on_screen();
    let depth = if is_linear { varyings.depth_at(weights) } else { varyings.at(weights).w };
    let stored = Lanes::new(*depths);
    let test = if PLAIN { DepthTest::LessOrEqual } else { state.merge.depth_test };
    mask = mask.and(passes(test, depth, stored));
    if mask.bits() == 0 {
        return LaneMask::all(true);
    }

    let point = varyings.interpolated(weights, interpolation);
    let shaded = if S::USES_DERIVATIVES {
        shader.fragment_with_derivatives(point.values, varyings.derivatives(&point, *gradients))
    } else {
        shader.fragment(point.values)
    };
    let thrown_away = mask.and(shaded.keep.not());
    mask = mask.and(shaded.keep);

    // Mostly all eight are written. If not, what is there stays in the other lanes.
    let is_whole = mask.bits() == LaneMask::all(true).bits();
    if PLAIN || state.merge.depth_write {
        *depths = if is_whole { depth } else { Lanes::select(mask, depth, stored) }.to_array();
    }
    let there = i32x8::new(colors.map(|color| color.bits() as i32));
    let blend = if PLAIN { Blend::Opaque } else { state.merge.blend };
    let words = match blend {
        Blend::Opaque => opaque(shaded.color),
        blend => packed(blend.apply(shaded.color.channels(), Lanes::channels(there))),
    };
    let words = if is_whole { words } else { mask.choose(words, there) };
    *colors = words.to_array().map(|word| Color::from_bits(word as u32));
    thrown_away.not()
}
// ANCHOR_END: rows

/// What a corner's record holds, the same in all lanes.
fn corner_of<const N: usize>(record: &[f32x8]) -> CornerVaryings<Lanes, N> {
    let number = |k: usize| Lanes::splat(record[k / LANES].as_array_ref()[k % LANES]);
    CornerVaryings { distance: number(0), depth: number(1), values: from_fn(|k| number(k + 2)) }
}

#[inline(always)]
fn passes(test: DepthTest, depth: Lanes, stored: Lanes) -> LaneMask {
    match test {
        DepthTest::Less => depth.is_less(stored),
        DepthTest::LessOrEqual => is_less_or_equal(depth, stored),
        DepthTest::Greater => is_greater(depth, stored),
        DepthTest::Always => LaneMask::all(true),
    }
}

/// The words of eight colors through which nothing shines.
#[inline(always)]
fn opaque(color: Paint<Lanes>) -> i32x8 {
    match color {
        Paint::Texel(texels) => texels,
        Paint::Channels([red, green, blue, _]) => packed([red, green, blue]),
    }
}

fn blended(blend: Blend, color: [f32; 4], there: Color) -> Color {
    let there = there.to_f64().map(|channel| channel as f32);
    crate::framebuffer::Rounding::Nearest.color(blend.apply(color, there))
}
