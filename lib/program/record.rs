//! A listener that keeps what it hears: all of it, or what concerns one pixel.

use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::{DVec2, DVec3, DVec4};

use crate::Color;
use crate::clip::{ClipTest, ClipVertex, Plane};
use crate::edge::Coverage;
use crate::interpolate::Interpolation;
use crate::line::StepAxis;
use crate::merge::Verdict;
use crate::probe::{Assembled, FragmentEvent, Probe, ScreenTriangle, Vertex};
use crate::scanline::Walk;

/// A pixel, y up.
pub(super) type Pixel = (i32, i32);

/// A vertex with its values.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) position: DVec4,
    pub(super) values: Vec<f64>,
}

impl From<Vertex<'_>> for Point {
    fn from(vertex: Vertex<'_>) -> Self {
        Self { position: vertex.position, values: vertex.varyings.to_vec() }
    }
}

impl Point {
    /// The same as a vertex for the clipper, without its values.
    pub(super) fn bare(&self) -> ClipVertex<0> {
        ClipVertex { position: self.position, varyings: [] }
    }
}

/// A triangle of vertices in clip space.
#[derive(Clone, Debug)]
pub(super) struct ClipTriangle {
    pub(super) vertices: [Point; 3],
    pub(super) model: Option<[DVec3; 3]>,
    pub(super) planes: Vec<Plane>,
    pub(super) test: ClipTest,
}

/// A triangle on the screen.
#[derive(Clone, Debug)]
pub(super) struct FilledTriangle {
    pub(super) corners: [DVec2; 3],
    pub(super) w: Option<[f64; 3]>,
    pub(super) values: [Vec<f64>; 3],
    pub(super) depth: Option<[f64; 3]>,
    pub(super) interpolation: Interpolation,
    pub(super) walk: Walk,
}

/// What covers pixels.
#[derive(Clone, Debug)]
pub(super) enum Primitive {
    Line { a: DVec2, b: DVec2, axis: StepAxis },
    Half { left: [DVec2; 2], right: [DVec2; 2], walk: Walk },
    Triangle(FilledTriangle),
    Coverage(Coverage),
}

/// What became of a fragment of the pipeline.
#[derive(Clone, Debug)]
pub(super) struct Fragment {
    pub(super) w: f64,
    pub(super) depth: f64,
    pub(super) values: Vec<f64>,
    pub(super) color: [f64; 4],
    pub(super) verdict: Verdict,
}

/// Something that was heard.
#[derive(Clone, Debug)]
pub(super) enum Event {
    Written(Pixel, Color),
    Cleared(Color),
    Tested { at: Pixel, depth: f64, stored: f64, passed: bool },
    Enlarged(u32),
    Begun(Primitive),
    Noted(Pixel, String),
    Done,
    Assembled(ClipTriangle),
    Piece([Point; 3], f64),
    Culled,
    Fragment(Pixel, Fragment),
}

/// A listener that keeps what it hears.
#[derive(Debug)]
pub(super) struct Recorder {
    /// The only pixel whose writes, tests and fragments are kept.
    watched: Option<Pixel>,
    heard: Mutex<Heard>,
}

#[derive(Debug)]
struct Heard {
    /// How large a pixel of the current screen is in the picture.
    factor: u32,
    events: Vec<Event>,
}

impl Recorder {
    /// Keeps everything, or of what happens to pixels only what concerns one.
    pub(super) const fn new(watched: Option<Pixel>) -> Self {
        Self { watched, heard: Mutex::new(Heard { factor: 1, events: Vec::new() }) }
    }

    /// What has been heard, in order.
    pub(super) fn events(&self) -> Vec<Event> {
        std::mem::take(&mut self.lock().events)
    }

    fn lock(&self) -> MutexGuard<'_, Heard> {
        self.heard.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn keep(&self, event: Event) {
        self.lock().events.push(event);
    }

    fn keep_at(&self, pixel: Pixel, event: impl FnOnce() -> Event) {
        let mut heard = self.lock();
        let is_wanted = self.watched.is_none_or(|watched| within(watched, heard.factor) == pixel);
        if is_wanted {
            heard.events.push(event());
        }
    }
}

/// The pixel of an enlarged screen that a pixel of the picture shows.
pub(super) fn within((x, y): Pixel, factor: u32) -> Pixel {
    let factor = factor as i32;
    (x.div_euclid(factor), y.div_euclid(factor))
}

impl Probe for Recorder {
    fn written(&self, x: i32, y: i32, color: Color) {
        self.keep_at((x, y), || Event::Written((x, y), color));
    }

    fn cleared(&self, color: Color) {
        self.keep(Event::Cleared(color));
    }

    fn tested(&self, x: i32, y: i32, depth: f64, stored: f64, passed: bool) {
        self.keep_at((x, y), || Event::Tested { at: (x, y), depth, stored, passed });
    }

    fn enlarged(&self, factor: u32) {
        let mut heard = self.lock();
        heard.factor = factor;
        heard.events.push(Event::Enlarged(factor));
    }

    fn line(&self, a: DVec2, b: DVec2, axis: StepAxis) {
        self.keep(Event::Begun(Primitive::Line { a, b, axis }));
    }

    fn half(&self, left: [DVec2; 2], right: [DVec2; 2], walk: Walk) {
        self.keep(Event::Begun(Primitive::Half { left, right, walk }));
    }

    fn triangle(&self, triangle: &ScreenTriangle<'_>) {
        let ScreenTriangle { corners, w, values, depth, interpolation, walk } = *triangle;
        let values = values.map(<[f64]>::to_vec);
        let filled = FilledTriangle { corners, w, values, depth, interpolation, walk };
        self.keep(Event::Begun(Primitive::Triangle(filled)));
    }

    fn coverage(&self, coverage: &Coverage) {
        self.keep(Event::Begun(Primitive::Coverage(*coverage)));
    }

    fn note(&self, x: i32, y: i32, text: &dyn Fn() -> String) {
        self.keep_at((x, y), || Event::Noted((x, y), text()));
    }

    fn done(&self) {
        self.keep(Event::Done);
    }

    fn assembled(&self, triangle: &Assembled<'_>) {
        self.keep(Event::Assembled(ClipTriangle {
            vertices: triangle.vertices.map(Point::from),
            model: (triangle.model)(),
            planes: triangle.planes.to_vec(),
            test: triangle.test,
        }));
    }

    fn piece(&self, vertices: [Vertex<'_>; 3], signed_area: f64) {
        self.keep(Event::Piece(vertices.map(Point::from), signed_area));
    }

    fn culled(&self) {
        self.keep(Event::Culled);
    }

    fn fragment(&self, event: &FragmentEvent<'_>) {
        self.keep_at((event.x, event.y), || {
            let FragmentEvent { w, depth, varyings, color, verdict, .. } = *event;
            Event::Fragment(
                (event.x, event.y),
                Fragment { w, depth, values: varyings.to_vec(), color, verdict },
            )
        });
    }
}
