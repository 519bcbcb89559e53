//! The order in which a picture came about, as an animation.

use std::any::Any;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::{DMat3, DVec2, DVec3};

use super::event::{Event, Primitive};
use crate::clip::{Assembled, ClipVertex, clip_polygon};
use crate::color::Color;
use crate::exact::edge::SUBPIXELS;
use crate::figure::picture::block;
use crate::figure::{Animation, DrawOptions, Variant};
use crate::framebuffer::Framebuffer;
use crate::line::{StepAxis, dda};
use crate::observer::{Enlargement, Observer};
use crate::probe::Probe;
use crate::rect::Pixel;
use crate::transform::perspective_divide;

/// At most so many frames.
const MOST: usize = 240;
/// As long as there are at most so many primitives, each is shown row by row.
const FEW: usize = 64;
/// Of more outlines none is shown.
const MOST_OUTLINES: usize = 64;
/// The most writes that are kept: 256 MiB.
const MAX_WRITES: usize = 1 << 25;

/// What begins with a write, the less before the more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Start {
    Nothing,
    Row,
    Primitive,
    /// The picture is cleared: no pixel is drawn by that.
    Clear,
}

/// One write. There are very many: 8 bytes each.
#[derive(Clone, Copy, Debug)]
struct Write {
    /// The pixel of the current screen; no side has more than [`Framebuffer::MAX_SIDE`].
    at: [u16; 2],
    color: [u8; 3],
    start: Start,
}

/// The outline of a polygon, shown after so many writes.
#[derive(Debug)]
struct Outline {
    after: usize,
    lines: Vec<[DVec2; 2]>,
}

/// How a picture comes about: everything that was written, in order.
#[derive(Debug)]
pub struct Steps {
    size: (u32, u32),
    story: Story,
    /// For each frame, how many writes it shows, and which outline.
    frames: Vec<(usize, Option<usize>)>,
    last: Framebuffer,
}

/// What was written.
#[derive(Debug, Default)]
struct Story {
    writes: Vec<Write>,
    /// How many writes there were that are not kept.
    untold: usize,
    /// From which write on the picture shows the screen enlarged, and how.
    enlargements: Vec<(usize, Option<Enlargement>)>,
    outlines: Vec<Outline>,
}

/// A picture has more steps than are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManySteps {
    /// A size that is not too large.
    pub fitting: (u32, u32),
}

impl TooManySteps {
    /// A picture of this size has too many steps, and would have few enough with `part` of its pixels.
    fn of((width, height): (u32, u32), part: f64) -> Self {
        let most = Framebuffer::MAX_SIDE;
        let side = |side: u32| ((f64::from(side.min(most)) * part.sqrt()) as u32).max(1);
        Self { fitting: (side(width), side(height)) }
    }
}

impl fmt::Display for TooManySteps {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (width, height) = self.fitting;
        write!(f, "more steps than are kept ({MAX_WRITES} writes): {width}x{height} pixels would fit")
    }
}

impl std::error::Error for TooManySteps {}

/// The vertices of a piece on the screen, if the primitive is a triangle.
fn vertices_of(primitive: &Primitive) -> Option<[DVec2; 3]> {
    match primitive {
        Primitive::Triangle(triangle) => Some(triangle.positions),
        Primitive::Coverage(coverage) => {
            Some(coverage.vertices.map(|[x, y]| DVec2::new(x as f64, y as f64) / SUBPIXELS as f64))
        }
        Primitive::Line(_) | Primitive::Half(_) => None,
    }
}

/// Takes down what is written.
#[derive(Debug)]
struct Recorder {
    most: usize,
    record: Mutex<Record>,
}

#[derive(Debug)]
struct Record {
    story: Story,
    is_enlarged: bool,
    /// What begins with the next write.
    start: Start,
    /// The pixel that the current primitive wrote last.
    last: Option<Pixel>,
    /// A triangle whose first piece is still to come.
    clipped: Option<Arc<Assembled>>,
}

impl Recorder {
    fn new(most: usize) -> Self {
        let (story, start) = (Story::default(), Start::Nothing);
        Self {
            most,
            record: Mutex::new(Record { story, is_enlarged: false, start, last: None, clipped: None }),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Record> {
        self.record.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Record {
    fn write(&mut self, (x, y): Pixel, color: Color, start: Start, most: usize) {
        if self.story.writes.len() < most {
            self.story.writes.push(Write { at: [x as u16, y as u16], color: color.channels(), start });
        } else {
            self.story.untold += 1;
        }
    }

    const fn begin(&mut self) {
        (self.start, self.last) = (Start::Primitive, None);
    }
}

impl Observer for Recorder {
    fn written(&self, pixel: Pixel, color: Color) {
        let mut record = self.lock();
        let is_new_row = record.last.is_some_and(|last| last.1 != pixel.1);
        let start = record.start.max(if is_new_row { Start::Row } else { Start::Nothing });
        (record.start, record.last) = (Start::Nothing, Some(pixel));
        record.write(pixel, color, start, self.most);
    }

    fn cleared(&self, color: Color) {
        let mut record = self.lock();
        if !record.is_enlarged {
            record.start = Start::Nothing;
            record.write((0, 0), color, Start::Clear, self.most);
        }
    }

    fn enlarged(&self, enlargement: Option<Enlargement>) {
        let mut record = self.lock();
        record.is_enlarged = enlargement.is_some();
        let from = record.story.writes.len();
        record.story.enlargements.push((from, enlargement));
    }

    fn begun(&self, what: &dyn Any) {
        let mut record = self.lock();
        match Event::begun(what) {
            Event::Assembled(triangle) => record.clipped = Some(triangle),
            Event::Begun(primitive) => {
                record.begin();
                // Its first piece tells where on the screen the polygon is.
                if let Some((triangle, vertices)) = record.clipped.take().zip(vertices_of(&primitive)) {
                    record.story.outline(&triangle, vertices);
                }
            }
            _ => {}
        }
    }

    fn done(&self) {
        self.lock().begin();
    }
}

impl Probe for Recorder {
    fn assembled(&self, triangle: &dyn Fn() -> Assembled) {
        self.lock().clipped = Some(Arc::new(triangle()));
    }
}

impl Story {
    /// The polygon after each plane that cut something off.
    fn outline(&mut self, triangle: &Assembled, vertices: [DVec2; 3]) {
        if self.outlines.len() > MOST_OUTLINES {
            return;
        }
        let mut polygon: Vec<ClipVertex<0>> = triangle.vertices.iter().map(ClipVertex::from).collect();
        let mut stages = vec![polygon.clone()];
        for plane in &triangle.planes {
            let cut = clip_polygon::<0, 16>(&polygon, plane, triangle.test).to_vec();
            if cut != polygon {
                stages.push(cut.clone());
            }
            polygon = cut;
        }
        if stages.len() == 1 || polygon.len() < 3 {
            return;
        }
        // The first three vertices are known in NDC and on the screen: that is enough to know where all others are.
        let flat = |i: usize| perspective_divide(polygon[i].position).truncate().extend(1.0);
        let ndc = DMat3::from_cols(flat(0), flat(1), flat(2));
        let screen =
            DMat3::from_cols(vertices[0].extend(1.0), vertices[1].extend(1.0), vertices[2].extend(1.0));
        let screen_from_ndc = screen * ndc.inverse();
        let place = |position: glam::DVec4| {
            let seen: DVec3 = screen_from_ndc * perspective_divide(position).truncate().extend(1.0);
            (position.w > 0.0 && seen.is_finite()).then(|| seen.truncate())
        };
        for stage in stages {
            let points: Vec<Option<DVec2>> = stage.iter().map(|vertex| place(vertex.position)).collect();
            let sides = (0..points.len()).filter_map(|i| Some([points[i]?, points[(i + 1) % points.len()]?]));
            self.outlines.push(Outline { after: self.writes.len(), lines: sides.collect() });
        }
    }

    /// Steps that suit the picture: pixels of a few lines, rows of a few triangles, else whole primitives. For each frame,
    /// how many writes it shows, and which outline.
    fn frames(&self) -> Vec<(usize, Option<usize>)> {
        let count = self.writes.len();
        let ends = |least: Start| {
            let begins = (1..count).filter(move |&i| self.writes[i].start >= least);
            begins.chain((count > 0).then_some(count))
        };
        let least = if count <= MOST {
            Start::Nothing
        } else if ends(Start::Primitive).nth(FEW).is_none() {
            Start::Row
        } else {
            Start::Primitive
        };
        // Of more steps than frames, several make a frame.
        let all = ends(least).count();
        let most = all.min(MOST);
        let mut chosen = (1..=most).map(|i| i * all / most).peekable();
        let ends = ends(least).zip(1..).filter(|(_, step)| chosen.next_if_eq(step).is_some());
        // Outlines come before what is drawn after them, unless they are too many.
        let shown = if self.outlines.len() <= MOST_OUTLINES { self.outlines.len() } else { 0 };
        let mut frames = Vec::new();
        let mut next = 0;
        for (end, _) in ends {
            while next < shown && self.outlines[next].after < end {
                frames.push((self.outlines[next].after, Some(next)));
                next += 1;
            }
            frames.push((end, None));
        }
        frames
    }

    /// Writes the first `end` writes once more.
    fn replay(&self, end: usize, picture: &mut Framebuffer) {
        let mut enlargements = self.enlargements.iter().peekable();
        let (mut factor, mut origin) = (1, (0, 0));
        for (i, write) in self.writes[..end].iter().enumerate() {
            while let Some((_, enlargement)) = enlargements.next_if(|(from, _)| *from <= i) {
                (factor, origin) = enlargement.map_or((1, (0, 0)), |by| (by.factor, by.origin));
            }
            let ([x, y], [red, green, blue]) = (write.at.map(i32::from), write.color);
            let color = Color::rgb(red, green, blue);
            if write.start == Start::Clear {
                picture.clear(color);
            } else {
                picture.fill(block((x, y), factor, origin), color);
            }
        }
    }
}

impl Steps {
    /// Draws a variant and records it.
    ///
    /// # Errors
    /// If there is no room for all steps: before it is drawn, if each pixel cannot be written twice, else afterwards.
    pub fn new(variant: &Variant, options: &DrawOptions<'_>) -> Result<Self, TooManySteps> {
        Self::within(MAX_WRITES, variant, options)
    }

    fn within(most: usize, variant: &Variant, options: &DrawOptions<'_>) -> Result<Self, TooManySteps> {
        let size = options.size;
        let needed = 2.0 * f64::from(size.0) * f64::from(size.1);
        if needed > most as f64 {
            return Err(TooManySteps::of(size, most as f64 / needed));
        }
        let recorder = Arc::new(Recorder::new(most));
        let last = variant.draw(&DrawOptions { observer: Some(recorder.clone()), ..options.clone() });
        let story = std::mem::take(&mut recorder.lock().story);
        if story.untold > 0 {
            // Fewer pixels have somewhat more at the borders of triangles.
            let part = 0.9 * most as f64 / (most + story.untold) as f64;
            return Err(TooManySteps::of(size, part));
        }
        let frames = story.frames();
        Ok(Self { size, story, frames, last })
    }

    /// How long the animation is, and how fast: one that can be followed.
    #[must_use]
    pub fn animation(&self) -> Animation {
        // The finished picture stays for a second.
        let rate = if self.frames.len() > 60 { 20 } else { 6 };
        Animation { frames: self.frames.len() as u32 + rate, rate }
    }

    /// A frame; the last ones are the finished picture.
    #[must_use]
    pub fn frame(&self, number: u32) -> Framebuffer {
        let Some(&(end, outline)) = self.frames.get(number as usize) else { return self.last.clone() };
        let mut picture = Framebuffer::new(self.size.0, self.size.1);
        self.story.replay(end, &mut picture);
        for [a, b] in outline.iter().flat_map(|&i| &self.story.outlines[i].lines) {
            dda(*a, *b, StepAxis::Longer, picture.rect(), |x, y| picture.set(x, y, Color::rgb(255, 220, 60)));
        }
        picture
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{ClipTest, Plane, RecordedVertex};
    use crate::figure::RasterizerChoice;
    use crate::figure::picture::draw_enlarged;
    use crate::inspect::tests::{by_itself, correct};
    use glam::dvec4;

    /// Each pixel of the left half three times, in rows.
    fn thrice(picture: &mut Framebuffer) {
        picture.clear(Color::BLUE);
        let half = crate::rect::Rect { right: picture.rect().right / 2, ..picture.rect() };
        for gray in [80, 160, 240] {
            picture.fill(half, Color::gray(gray));
        }
    }

    #[test]
    fn outlines_are_shown_unless_they_are_too_many() {
        // A plane cuts a vertex off: an outline before that, and one after it.
        let vertex = |x, y| RecordedVertex { position: dvec4(x, y, 0.0, 1.0), varyings: vec![] };
        let triangle = Assembled {
            vertices: [vertex(0.0, 0.0), vertex(2.0, 0.0), vertex(0.0, 1.0)],
            model: None,
            planes: vec![Plane::homogeneous(dvec4(-1.0, 0.0, 0.0, 1.0))],
            test: ClipTest::BeforeDivide,
        };
        let shown = |triangles| {
            let mut story = Story::default();
            (0..triangles).for_each(|_| story.outline(&triangle, [DVec2::ZERO, DVec2::X, DVec2::ONE]));
            story.writes.push(Write { at: [0, 0], color: [255, 0, 0], start: Start::Nothing });
            story.frames().iter().filter(|(_, outline)| outline.is_some()).count()
        };
        assert_eq!([1, MOST_OUTLINES / 2, MOST_OUTLINES / 2 + 1].map(shown), [2, MOST_OUTLINES, 0]);
    }

    /// The vertices of an outline, whose lines are closed, in their order.
    fn vertices(outline: &Outline) -> Vec<DVec2> {
        let lines = &outline.lines;
        for (i, [_, end]) in lines.iter().enumerate() {
            assert_eq!(lines[(i + 1) % lines.len()][0], *end, "a closed line");
        }
        lines.iter().map(|[start, _]| *start).collect()
    }

    #[test]
    fn an_outline_lies_where_its_triangle_is_drawn() {
        let outlines = |variant: Variant, rasterizer| {
            let options = DrawOptions { rasterizer, ..variant.options(None) };
            let story = Steps::new(&variant, &options).expect("a small picture").story;
            story.outlines.iter().map(|outline| (outline.after, vertices(outline))).collect::<Vec<_>>()
        };
        let pipeline = || Variant::with_pipeline("pipeline", correct, "").size(16, 16);
        let program = Variant::new("by-itself", by_itself, "").size(16, 16);
        // ABC and then DBCE: side · DB is cut off. Pixels of the book's rasterizer lie on whole coordinates, up to 15.
        for (outlines, side, cut) in [
            (outlines(pipeline(), RasterizerChoice::Scanline), 15.0, 0.25),
            (outlines(pipeline(), RasterizerChoice::Exact), 16.0, 0.25),
            (outlines(program, RasterizerChoice::Scanline), 16.0, 2.0 / 3.0),
        ] {
            let expected = [
                vec![[0.0, 0.0], [side, 0.0], [0.0, side]],
                vec![[cut * side, 0.0], [side, 0.0], [0.0, side], [0.0, cut * side]],
            ];
            assert_eq!(outlines.len(), 2, "of the only triangle that is cut and drawn: {outlines:?}");
            for ((_, outline), expected) in outlines.iter().zip(expected) {
                let is_near = |(a, b): (&DVec2, [f64; 2])| a.distance(b.into()) < 1e-3;
                assert_eq!(outline.len(), expected.len());
                assert!(outline.iter().zip(expected).all(is_near), "{outline:?}");
            }
            assert_eq!(outlines[0].0, outlines[1].0);
        }
    }

    #[test]
    fn only_what_is_cut_and_seen_has_an_outline() {
        let outlines = |x: [f64; 3], w: [f64; 3], plane| {
            let y = [0.0, 0.0, 1.0];
            let vertex =
                |i: usize| RecordedVertex { position: dvec4(x[i], y[i], 0.0, w[i]), varyings: vec![] };
            let triangle = Assembled {
                vertices: [vertex(0), vertex(1), vertex(2)],
                model: None,
                planes: vec![plane],
                test: ClipTest::BeforeDivide,
            };
            let mut story = Story::default();
            story.outline(&triangle, [DVec2::ZERO, DVec2::X, DVec2::ONE]);
            story.outlines.iter().map(|outline| outline.lines.len()).collect::<Vec<_>>()
        };
        assert_eq!(outlines([0.0, 0.5, 0.0], [1.0; 3], Plane::RIGHT), [0; 0], "nothing is cut");
        assert_eq!(outlines([2.0, 3.0, 2.0], [1.0; 3], Plane::RIGHT), [0; 0], "nothing is left");
        assert_eq!(outlines([0.0, 2.0, 3.0], [1.0; 3], Plane::RIGHT), [3, 3], "a triangle is left");
        // Of a vertex behind the eye no place is known: one side of three is left.
        assert_eq!(outlines([0.0, 0.5, 0.0], [-1.0, 1.0, 1.0], Plane::in_front(0.5)), [1, 4]);
    }

    #[test]
    fn an_outline_comes_after_what_was_drawn_before_it() {
        let write = Write { at: [0, 0], color: [255, 0, 0], start: Start::Nothing };
        let outlines = vec![Outline { after: 1, lines: vec![] }];
        let story = Story { writes: vec![write; 2], outlines, ..Story::default() };
        assert_eq!(story.frames(), [(1, None), (1, Some(0)), (2, None)]);
        assert_eq!(Story::default().frames(), [], "nothing is written");
    }

    #[test]
    fn many_primitives_are_shown_one_by_one() {
        // Each of three pixels, in two rows; and a pixel that the program writes itself.
        fn draw(picture: &mut Framebuffer) {
            let scissor = picture.scissor();
            for i in 0..70 {
                let (from, to) = (DVec2::new(0.0, 0.5), DVec2::new(3.0, 1.5));
                dda(from, to, StepAxis::Longer, scissor.clone(), |x, y| picture.set(x, y, Color::gray(i)));
                picture.set(5, 5, Color::WHITE);
            }
        }
        let variant = Variant::new("lines", draw, "").size(16, 16);
        let steps = Steps::new(&variant, &variant.options(None)).expect("a small picture");
        let ends: Vec<usize> = steps.frames.iter().map(|(end, _)| *end).collect();
        assert_eq!((ends.len(), &ends[..4]), (140, &[3, 4, 7, 8][..]));
    }

    #[test]
    fn an_enlarged_screen_is_replayed_in_blocks() {
        fn draw(picture: &mut Framebuffer) {
            picture.clear(Color::BLUE);
            draw_enlarged(picture, (4, 4), |screen| {
                screen.clear(Color::RED);
                screen.set(1, 2, Color::WHITE);
            });
            picture.set(0, 0, Color::GREEN);
        }
        let variant = Variant::new("enlarged", draw, "").size(16, 16);
        let steps = Steps::new(&variant, &variant.options(None)).expect("a small picture");
        assert_eq!(
            steps.frames,
            [(1, None), (2, None), (3, None)],
            "to clear the screen of its own is no step"
        );
        let seen = |frame: u32| [(0, 0), (4, 8), (7, 11), (8, 8)].map(|(x, y)| steps.frame(frame).get(x, y));
        assert_eq!(seen(0), [Some(Color::BLUE); 4]);
        assert_eq!(seen(1), [Color::BLUE, Color::WHITE, Color::WHITE, Color::BLUE].map(Some));
        assert_eq!(seen(2), [Color::GREEN, Color::WHITE, Color::WHITE, Color::BLUE].map(Some));
    }

    #[test]
    fn the_last_write_that_fits_is_kept() {
        fn draw(picture: &mut Framebuffer) {
            (0..60).for_each(|i| picture.set(i % 5, i / 25, Color::gray(i as u8)));
        }
        let variant = Variant::new("sixty", draw, "").size(5, 5);
        let within = |most| Steps::within(most, &variant, &variant.options(None));
        let steps = within(60).expect("it fits");
        assert_eq!(steps.animation(), Animation { frames: 60 + 6, rate: 6 });
        assert!(within(59).is_err());
    }

    #[test]
    fn what_does_not_fit_is_refused_with_a_size_that_does() {
        let variant = Variant::new("thrice", thrice, "").size(64, 48);
        let steps =
            |size, most| Steps::within(most, &variant, &DrawOptions { size, ..variant.options(None) });
        assert!(steps((64, 48), 2 * 64 * 48).is_ok());
        let refused = |most| steps((64, 48), most).expect_err("too many");
        // Before it is drawn, by its size alone.
        let TooManySteps { fitting } = refused(2 * 64 * 48 - 1);
        assert_eq!(fitting, (63, 47));
        assert!(steps(fitting, 2 * 64 * 48 - 1).is_ok());
        assert_eq!(refused(2 * 32 * 24).fitting, (32, 24));
    }

    #[test]
    fn more_writes_than_pixels_promise_are_refused_too() {
        fn often(picture: &mut Framebuffer) {
            for _ in 0..20 {
                picture.fill(picture.rect(), Color::RED);
            }
        }
        let variant = Variant::new("often", often, "").size(64, 48);
        let steps = |size| Steps::within(1 << 13, &variant, &DrawOptions { size, ..variant.options(None) });
        let TooManySteps { fitting } = steps((64, 48)).expect_err("20 × 3072 writes");
        assert!(fitting.0 > 20 && steps(fitting).is_ok(), "{fitting:?}");
        let text = TooManySteps { fitting }.to_string();
        assert_eq!(
            text,
            format!(
                "more steps than are kept (33554432 writes): {}x{} pixels would fit",
                fitting.0, fitting.1
            )
        );
    }

    #[test]
    fn frames_end_with_rows_and_show_what_was_written() {
        let variant = Variant::new("thrice", thrice, "").size(64, 48);
        let steps = Steps::new(&variant, &variant.options(None)).expect("a small picture");
        // Three times 48 rows; the first one shows with what was cleared before it.
        assert_eq!(steps.frames.len(), 3 * 48);
        let first = steps.frame(0);
        let seen = |x, y| first.get(x, y);
        assert_eq!([seen(0, 0), seen(31, 0)], [Some(Color::gray(80)); 2]);
        assert_eq!([seen(32, 0), seen(0, 1)], [Some(Color::BLUE); 2]);
        assert!(steps.frame(3 * 48 - 1) == steps.frame(999), "the finished picture");
        let one_second_more = Animation { frames: 3 * 48 + 20, rate: 20 };
        assert_eq!(steps.animation(), one_second_more);
    }
}
