//! One tile: coverage, depth test, shading and writing of the triangles in its bin.

use std::array::from_fn;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use wide::{f32x8, i32x8};

use super::edges::{Edges, GROUPS, Huge, Narrow, Setup, Split, Touch, is_narrow};
use super::front::{Front, Source, Triangle, bounding_box};
use super::occlusion::{depth_range, hidden_behind};
use super::{Band, TILE_HEIGHT, TILE_WIDTH};
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
    /// Whether the shader has been seen to throw fragments away.
    pub(super) discards: AtomicBool,
}

/// A rectangle of the picture, brought near: a copy of its colors and depths in the processor's nearest memory.
pub(super) struct Tile {
    /// What of the tile lies in the picture.
    rect: Rect,
    /// Nothing that is deeper than this can be seen.
    behind: f64,
    rows: [Row; TILE_HEIGHT as usize],
    queue: Queue,
    /// The groups that a triangle touches.
    touches: [Touch; GROUPS],
}

/// A row of a tile. Colors and depths of a pixel are near each other, but never at the same place of two memory pages,
/// where a processor takes one for the other.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Row {
    colors: [Color; TILE_WIDTH as usize],
    depths: [f32; TILE_WIDTH as usize],
}

/// Fragments of small triangles that wait until there are eight of them.
struct Queue {
    count: usize,
    /// 1/ω, depth, V/ω of each fragment.
    records: [f32x8; LANES],
    /// The row and the column of each fragment in the tile.
    places: [[usize; 2]; LANES],
}

/// Up to this many pixels wide and high, a triangle is small.
const SMALL: i32 = 8;

impl<S: Shader<N>, const N: usize> Frame<'_, S, N> {
    /// Notes which fragments the shader has kept.
    fn note(&self, kept: LaneMask) {
        if kept.bits() != LaneMask::all(true).bits() {
            self.discards.store(true, Ordering::Relaxed);
        }
    }
}

impl Tile {
    /// Room for a tile.
    pub(super) fn new() -> Self {
        let row = Row { colors: [Color::BLACK; TILE_WIDTH as usize], depths: [0.0; TILE_WIDTH as usize] };
        let queue = Queue { count: 0, records: [f32x8::ZERO; LANES], places: [[0; 2]; LANES] };
        Self {
            rect: Rect::sized(0, 0),
            behind: f64::INFINITY,
            rows: [row; TILE_HEIGHT as usize],
            queue,
            touches: [Touch::default(); GROUPS],
        }
    }

    /// Fetches the pixels of a rectangle of a band.
    pub(super) fn load(&mut self, rect: Rect, band: &Band<'_>) {
        self.rect = rect;
        for (row, place) in self.rows.iter_mut().zip(band.places(rect)) {
            row.colors[..place.len()].copy_from_slice(&band.colors[place.clone()]);
            row.depths[..place.len()].copy_from_slice(&band.depths[place]);
        }
    }

    /// Brings the pixels back.
    pub(super) fn store(&self, band: &mut Band<'_>) {
        for (row, place) in self.rows.iter().zip(band.places(self.rect)) {
            band.colors[place.clone()].copy_from_slice(&row.colors[..place.len()]);
            band.depths[place.clone()].copy_from_slice(&row.depths[..place.len()]);
        }
    }

    /// Draws triangles, one after the other, but for those that are known to be hidden.
    pub(super) fn draw<'a, S: Shader<N>, I: Iterator<Item = Triangle<'a>>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangles: impl Fn() -> I,
    ) {
        let may_hide = frame.front.has_large_triangles() && !frame.discards.load(Ordering::Relaxed);
        self.behind = if may_hide { hidden_behind(frame, triangles(), self.rect) } else { f64::INFINITY };
        for triangle in triangles() {
            self.draw_triangle(frame, triangle);
        }
        self.flush(frame);
    }

    /// Whether triangles were left out behind one whose fragments the shader may have thrown away.
    pub(super) fn has_holes<S: Shader<N>, const N: usize>(&self, frame: &Frame<'_, S, N>) -> bool {
        self.behind < f64::INFINITY && frame.discards.load(Ordering::Relaxed)
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

    /// The row and the column of a pixel in the tile.
    fn place(&self, x: i32, y: i32) -> [usize; 2] {
        [(y - self.rect.bottom) as usize, (x - self.rect.left) as usize]
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
        let [bottom, left] = self.place(area.left, area.bottom);
        let mut covered = setup.covered(area);
        while covered != 0 {
            let bit = covered.trailing_zeros();
            covered &= covered - 1;
            let (row, column) = (bit / 8, bit % 8);
            let [second, third] = setup.weights(column as i32, row as i32);
            let record = first + to_second * f32x8::splat(second) + to_third * f32x8::splat(third);
            self.enqueue(frame, record, [bottom + row as usize, left + column as usize]);
        }
    }

    /// Lets a fragment wait for others, unless it is hidden already.
    fn enqueue<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        record: f32x8,
        place: [usize; 2],
    ) {
        // Stored depths only become harder to pass: what fails now fails later.
        let is_linear = frame.state.depth_encoding.is_linear_on_screen();
        let [row, column] = place;
        let stored = self.rows[row].depths[column];
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
            let [row, column] = self.queue.places[lane];
            let row = &mut self.rows[row];
            let (color, depth) = (&mut row.colors[column], &mut row.depths[column]);
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
        let area = whole_groups(area, self.rect.left);
        let setup = Narrow::new(triangle.places, [area.left, area.bottom]);
        let (rows, groups) = self.rows_and_groups(area);
        let touched = setup.touched(rows.len(), groups.len(), &mut self.touches);
        let brush = Brush::new(frame, triangle, setup.one_over_area);
        let rows = &mut self.rows[rows];
        if is_plain(frame.state) {
            draw_touched::<true, S, N>(frame, &brush, &setup, touched, rows, groups.start);
        } else {
            draw_touched::<false, S, N>(frame, &brush, &setup, touched, rows, groups.start);
        }
    }

    /// Many pixels: row by row.
    fn draw_large<S: Shader<N>, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        triangle: Triangle<'_>,
        area: Rect,
    ) {
        let setup = Setup::new(triangle.places);
        if self.behind < f64::INFINITY && depth_range(&setup, triangle, area)[0] > self.behind {
            return;
        }
        self.flush(frame);
        let area = whole_groups(area, self.rect.left);
        if setup.misses(area) {
            // An edge has all of the tile on its wrong side.
        } else if !setup.is_split_exact(area) {
            self.draw_groups(frame, &setup, triangle, area, Huge { setup: &setup, area });
        } else if setup.covers(area) {
            self.draw_groups(frame, &setup, triangle, area, Split::<true>::new(&setup, area));
        } else {
            self.draw_groups(frame, &setup, triangle, area, Split::<false>::new(&setup, area));
        }
    }

    fn draw_groups<S: Shader<N>, E: Edges, const N: usize>(
        &mut self,
        frame: &Frame<'_, S, N>,
        setup: &Setup,
        triangle: Triangle<'_>,
        area: Rect,
        edges: E,
    ) {
        let brush = Brush::new(frame, triangle, setup.one_over_area);
        let (rows, groups) = self.rows_and_groups(area);
        let rows = &mut self.rows[rows];
        if is_plain(frame.state) {
            draw_area::<true, S, E, N>(frame, &brush, &edges, rows, groups);
        } else {
            draw_area::<false, S, E, N>(frame, &brush, &edges, rows, groups);
        }
    }

    /// Where in the tile an area of whole groups is.
    fn rows_and_groups(&self, area: Rect) -> (Range<usize>, Range<usize>) {
        let [bottom, left] = self.place(area.left, area.bottom);
        let [top, right] = self.place(area.right, area.top);
        (bottom..top, left / LANES..right / LANES)
    }
}

/// The area, as many columns wider as it takes to begin and to end with a group of eight.
///
/// No triangle covers pixels outside its area: what is tested there is not covered, or else outside the picture.
fn whole_groups(area: Rect, tile_left: i32) -> Rect {
    const SIDE: i32 = LANES as i32;
    let (from, to) = (area.left - tile_left, area.right - tile_left);
    Rect { left: tile_left + from / SIDE * SIDE, right: tile_left + (to + SIDE - 1) / SIDE * SIDE, ..area }
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

impl Row {
    /// Some of its groups of eight: colors and depths.
    #[inline(always)]
    fn groups(
        &mut self,
        groups: Range<usize>,
    ) -> impl Iterator<Item = (&mut [Color; LANES], &mut [f32; LANES])> {
        let colors = &mut self.colors.as_chunks_mut().0[groups.clone()];
        colors.iter_mut().zip(&mut self.depths.as_chunks_mut().0[groups])
    }
}

/// Draws the groups that a triangle touches.
///
/// A function by itself, so that the compiler knows that nothing that is written here changes what is read.
#[inline(never)]
fn draw_touched<const PLAIN: bool, S: Shader<N>, const N: usize>(
    frame: &Frame<'_, S, N>,
    brush: &Brush<N>,
    setup: &Narrow,
    touched: &[Touch],
    rows: &mut [Row],
    first: usize,
) {
    let mut kept = LaneMask::all(true);
    for &touch in touched {
        let mask = LaneMask::of_bits(i32::from(touch.covered));
        let (row, group) = (&mut rows[usize::from(touch.row)], first + usize::from(touch.group));
        let colors = &mut row.colors.as_chunks_mut().0[group];
        let depths = &mut row.depths.as_chunks_mut().0[group];
        let keep = draw_group::<PLAIN, S, N>(frame, brush, mask, setup.group(touch), colors, depths);
        kept = kept.and(keep);
    }
    frame.note(kept);
}

/// Draws the rows of a triangle, eight pixels at a time. A function by itself, as well.
#[inline(never)]
fn draw_area<const PLAIN: bool, S: Shader<N>, E: Edges, const N: usize>(
    frame: &Frame<'_, S, N>,
    brush: &Brush<N>,
    edges: &E,
    rows: &mut [Row],
    groups: Range<usize>,
) {
    let mut kept = LaneMask::all(true);
    let mut first = edges.first();
    for row in rows {
        let mut group = first;
        for (colors, depths) in row.groups(groups.clone()) {
            let mask = edges.covered(&group);
            if mask.bits() != 0 {
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
        Paint::Mixed([red, green, blue, _]) => packed([red, green, blue]),
    }
}

fn blended(blend: Blend, color: [f32; 4], there: Color) -> Color {
    let there = there.to_f64().map(|channel| channel as f32);
    crate::framebuffer::Rounding::Nearest.color(blend.apply(color, there))
}
