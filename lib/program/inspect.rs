//! The history of a pixel: what was recorded, told with the numbers of each chapter's formula.
//!
//! Nothing here draws. Of a primitive that reached the pixel, the stage is gone through once more with the same library
//! functions, to find the numbers that it passed on the way.

use std::sync::Arc;

use super::chapter::{Sitting, Variant};
use super::history::{Entry, Field, History, Value, field};
use super::record::{ClipTriangle, Event, Fragment, Pixel, Point, Primitive, Recorder, within};
use super::rows::{line_at, rows_at};
use crate::area::{Winding, twice_signed_area};
use crate::clip::{ClipTest, ClipVertex, Plane, clip_polygon};
use crate::edge::{Coverage, SUBPIXELS, center};
use crate::interpolate::Interpolation;
use crate::merge::Verdict;
use crate::varyings::TriangleVaryings;
use crate::{Color, Framebuffer, Rect};

/// What was found out about a pixel.
#[derive(Debug, Default)]
struct Findings {
    entries: Vec<Entry>,
    others: Vec<Entry>,
    /// The color that it was given last.
    color: Color,
}

/// The history of a pixel of a variant's picture.
#[must_use]
pub fn history(
    program: &'static str,
    variant: &Variant,
    sitting: &Sitting<'_>,
    pixel: (i32, i32),
) -> History {
    let Heard { events, picture, frame } = listen(variant, sitting, Some(pixel));
    History { program, variant: variant.name, frame, ..History::of(&events, &picture, pixel) }
}

/// The histories of several pixels; the picture is drawn once.
pub fn histories(
    program: &'static str,
    variant: &Variant,
    sitting: &Sitting<'_>,
    pixels: impl IntoIterator<Item = (i32, i32)>,
) -> Vec<History> {
    let Heard { events, picture, frame } = listen(variant, sitting, None);
    let history =
        |pixel| History { program, variant: variant.name, frame, ..History::of(&events, &picture, pixel) };
    pixels.into_iter().map(history).collect()
}

/// A picture, and what was heard while it was drawn.
struct Heard {
    events: Vec<Event>,
    picture: Framebuffer,
    frame: Option<u32>,
}

/// Draws a variant and listens: to everything, or of what happens to pixels only to what concerns one.
fn listen(variant: &Variant, sitting: &Sitting<'_>, watched: Option<Pixel>) -> Heard {
    let recorder = Arc::new(Recorder::new(watched));
    let picture = variant.draw(&Sitting { listener: Some(recorder.clone()), ..sitting.clone() });
    let frame = variant.animation.map(|_| sitting.frame);
    Heard { events: recorder.events(), picture, frame }
}

impl History {
    /// What happened at a pixel on the way to a picture, from what was heard.
    pub(super) fn of(events: &[Event], picture: &Framebuffer, pixel: Pixel) -> Self {
        let Findings { mut entries, others, color: told } = explain(events, pixel, picture.rect());
        let color = picture.get(pixel.0, pixel.1).unwrap_or_default();
        if !entries.iter().any(|entry| matches!(entry.kind, "line" | "half" | "triangle" | "painted")) {
            let title = "Nothing covers this pixel: it keeps the background".to_owned();
            entries.push(Entry::new("background", title));
        }
        if color != told {
            let title = format!(
                "Afterwards the program shows something else here, {color:?}: another buffer, or a line between enlarged pixels"
            );
            entries.push(Entry::new("replaced", title));
        }
        let row = picture.height() as i32 - 1 - pixel.1;
        Self { program: "", variant: "", frame: None, pixel, row, entries, others, color, told }
    }
}

/// Tells what happened at a pixel of a picture of this size.
fn explain(events: &[Event], pixel: Pixel, picture: Rect) -> Findings {
    let mut teller = Teller {
        pixel,
        window: picture,
        factor: 1,
        number: 0,
        assembled: None,
        piece: None,
        pieces: 0,
        primitive: None,
        is_open: false,
        hits: 0,
        is_hit_complete: true,
        is_noting: false,
        culled: Vec::new(),
        clipped_away: Vec::new(),
        found: Findings::default(),
    };
    for event in events {
        teller.hear(event);
    }
    teller.end_triangle();
    let left_out: Vec<Entry> = teller.left_out().collect();
    teller.found.others.extend(left_out);
    teller.found
}

/// Numbers in rising order as text: 1–3, 7, 9–12.
fn ranges(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b).map(|run| match run {
        [first, .., last] => format!("{first}–{last}"),
        [single] => single.to_string(),
        [] => String::new(),
    });
    runs.collect::<Vec<_>>().join(", ")
}

/// Where we are in the events.
struct Teller<'a> {
    pixel: Pixel,
    window: Rect,
    factor: u32,
    /// Of triangles and lines, counted from 1.
    number: usize,
    assembled: Option<&'a ClipTriangle>,
    piece: Option<(&'a [Point; 3], f64)>,
    pieces: usize,
    primitive: Option<&'a Primitive>,
    /// Whether the primitive has reached the pixel, and has an entry.
    is_open: bool,
    hits: usize,
    is_hit_complete: bool,
    /// Whether the last entry is one of notes.
    is_noting: bool,
    /// Numbers of triangles that never reached the screen.
    culled: Vec<usize>,
    clipped_away: Vec<usize>,
    found: Findings,
}

impl<'a> Teller<'a> {
    fn hear(&mut self, event: &'a Event) {
        match event {
            Event::Enlarged(factor) => self.enlarge(*factor),
            Event::Cleared(color) => self.clear(*color),
            Event::Assembled(triangle) => {
                self.end_triangle();
                self.number += 1;
                (self.assembled, self.piece, self.pieces) = (Some(triangle), None, 0);
            }
            Event::Piece(vertices, area) => {
                self.pieces += 1;
                self.piece = Some((vertices, *area));
            }
            // Of a clipped triangle there may be several pieces.
            Event::Culled if self.culled.last() == Some(&self.number) => {}
            Event::Culled => self.culled.push(self.number),
            Event::Begun(primitive) => {
                if self.assembled.is_none() {
                    self.number += 1;
                }
                (self.primitive, self.is_open, self.hits, self.is_hit_complete) =
                    (Some(primitive), false, 0, true);
                if self.piece.is_none() && self.assembled.is_some() {
                    self.pieces += 1;
                }
            }
            Event::Done => self.done(),
            Event::Noted(at, text) if *at == self.here() => {
                if self.primitive.is_none() && !self.is_noting {
                    let title = "What the program says of this pixel".to_owned();
                    self.found.entries.push(Entry::new("note", title));
                    (self.is_open, self.is_noting) = (true, true);
                }
                self.open(true);
                self.add([field("note", "note", Value::Text(text.clone()))]);
            }
            Event::Tested { at, depth, stored, passed } if *at == self.here() => {
                self.begin_hit();
                self.add([
                    field("depth", "depth", Value::Number(*depth)),
                    field("stored", "  stored", Value::Number(*stored)),
                    field("passed", "  in front", Value::Yes(*passed)),
                ]);
                self.is_hit_complete = !passed && self.piece.is_none();
            }
            Event::Written(at, color) if *at == self.here() => {
                self.begin_hit();
                self.found.color = *color;
                self.add([field("written", "written", Value::Color(*color))]);
                self.is_hit_complete = self.piece.is_none();
            }
            Event::Fragment(at, fragment) if *at == self.here() => {
                self.begin_hit();
                self.add(fragment_fields(fragment));
                self.is_hit_complete = true;
            }
            Event::Noted(..) | Event::Tested { .. } | Event::Written(..) | Event::Fragment(..) => {}
        }
    }

    fn enlarge(&mut self, factor: u32) {
        (self.factor, self.number, self.assembled) = (factor, 0, None);
        if factor > 1 {
            let (x, y) = within(self.pixel, factor);
            let title = format!(
                "A screen of its own, each pixel drawn as {factor}×{factor}: what follows is its pixel ({x}, {y})"
            );
            self.found.entries.push(Entry::new("enlarged", title));
        }
    }

    fn clear(&mut self, color: Color) {
        self.found.color = color;
        let title = format!("The picture is cleared to {color:?}");
        self.found.entries.push(Entry::new("cleared", title));
        self.end_triangle();
        // What was drawn before is gone, but not forgotten: triangles are counted anew.
        (self.number, self.assembled, self.piece) = (0, None, None);
    }

    /// The pixel on the screen that is being drawn on.
    fn here(&self) -> Pixel {
        within(self.pixel, self.factor)
    }

    fn screen(&self) -> Rect {
        let [width, height] = [self.window.right, self.window.top].map(|side| side as u32 / self.factor);
        Rect::sized(width, height)
    }

    /// Sees that the running primitive has an entry, and in it a hit, a new one if that is wanted.
    fn open(&mut self, is_new_hit: bool) {
        if !self.is_open {
            let entry = self.entry();
            self.found.entries.push(entry);
            self.is_open = true;
        }
        if let Some(entry) = self.found.entries.last_mut().filter(|entry| is_new_hit || entry.hits.is_empty())
        {
            entry.hits.push(Vec::new());
        }
    }

    /// Adds to the entry of the running primitive.
    fn add(&mut self, fields: impl IntoIterator<Item = Field>) {
        self.open(false);
        if let Some(hit) = self.found.entries.last_mut().and_then(|entry| entry.hits.last_mut()) {
            hit.extend(fields);
        }
    }

    /// A pixel of a primitive is met: the numbers on the way to it, once for each time.
    fn begin_hit(&mut self) {
        if !self.is_hit_complete {
            return;
        }
        if self.primitive.is_none() {
            // Every write by the program itself is news.
            (self.is_open, self.is_noting) = (false, false);
        }
        let hit = self.hits;
        self.hits += 1;
        self.open(true);
        if hit > 0 && self.primitive.is_some() {
            let again = "the pixel belongs to both halves of the triangle".to_owned();
            self.add([field("", "again", Value::Text(again))]);
        }
        let (here, screen) = (self.here(), self.screen());
        let fields = match self.primitive {
            None => Vec::new(),
            Some(Primitive::Line { a, b, axis }) => line_at(*a, *b, *axis, here, screen),
            Some(Primitive::Coverage(coverage)) => edge_fields(coverage, self.piece.map(|(p, _)| p), here),
            Some(primitive) => rows_at(primitive, here, screen).into_iter().nth(hit).unwrap_or_default(),
        };
        self.add(fields);
    }

    /// The beginning of a primitive's entry.
    fn entry(&self) -> Entry {
        let Some(primitive) = self.primitive else {
            let title = "The program itself paints this pixel".to_owned();
            return Entry::new("painted", title);
        };
        let number = self.number;
        let (kind, title) = match primitive {
            Primitive::Line { .. } => ("line", format!("Line {number}")),
            Primitive::Half { .. } => ("half", format!("Half {number} of a triangle")),
            Primitive::Triangle(_) | Primitive::Coverage(_) => ("triangle", format!("Triangle {number}")),
        };
        let mut fields = vec![field("number", "", Value::Whole(number as i64))];
        if let Some(assembled) = self.assembled {
            fields.extend(vertex_fields(assembled));
            let (clipping, names) = clip_fields(assembled);
            fields.push(field("piece", "", Value::Whole(self.pieces as i64)));
            if let Some(clipping) = clipping {
                let corner = |i: usize| names.get(i).copied().unwrap_or('?');
                let (k, count) = (self.pieces, names.len().saturating_sub(2));
                let [a, b, c] = [corner(0), corner(k), corner(k + 1)];
                let text = format!("{k} of {count}: {a}, {b} and {c} are called A, B and C from here on");
                fields.extend([clipping, field("", "piece", Value::Text(text))]);
            }
        }
        if let Some((vertices, area)) = self.piece {
            let rows = "ABC".chars().zip(vertices.iter());
            let rows = rows.map(|(name, v)| (name.to_string(), v.position.to_array().map(Some).to_vec()));
            fields.push(field("ndc", "NDC, and ω", table(&["x", "y", "z", "ω"], rows.collect())));
            let is_on_screen = matches!(primitive, Primitive::Coverage(_));
            fields.extend(facing(area, if is_on_screen { PIXELS } else { "area · 2, NDC" }));
        } else if let Primitive::Triangle(triangle) = primitive {
            let [a, b, c] = triangle.corners;
            fields.extend(facing(twice_signed_area(a, b, c), PIXELS));
        }
        Entry { fields, ..Entry::new(kind, title) }
    }

    /// The next triangle is assembled, or there is none: has anything been left of this one?
    fn end_triangle(&mut self) {
        if self.assembled.is_some() && self.pieces == 0 {
            self.clipped_away.push(self.number);
        }
    }

    /// What was left out on the way, by numbers.
    fn left_out(&self) -> impl Iterator<Item = Entry> {
        let all = [
            ("culled", "culled, seen from behind or without area", &self.culled),
            ("clipped", "clipped away", &self.clipped_away),
        ];
        let entry = |(kind, why, numbers): (&'static str, &str, &Vec<usize>)| {
            let count = if numbers.len() == 1 { "triangle" } else { "triangles" };
            let title = format!("{why}: {} {count}, {}", numbers.len(), ranges(numbers));
            let list = numbers.iter().map(|&number| number as f64).collect();
            let fields = vec![field("numbers", "", Value::Numbers(list))];
            (!numbers.is_empty()).then(|| Entry { fields, ..Entry::new(kind, title) })
        };
        all.map(entry).into_iter().flatten()
    }

    fn done(&mut self) {
        if let Some(primitive) = self.primitive.take_if(|_| !self.is_open)
            && let Some(reason) = super::rows::miss(primitive, within(self.pixel, self.factor), self.screen())
        {
            let name = if matches!(primitive, Primitive::Line { .. }) { "line" } else { "triangle" };
            let piece = if self.pieces > 1 { format!(", piece {}", self.pieces) } else { String::new() };
            let title = format!("{name} {}{piece}: {reason}", self.number);
            self.found.others.push(Entry::new("missed", title));
        }
        (self.primitive, self.is_open, self.is_hit_complete) = (None, false, true);
    }
}

/// An area on the screen.
const PIXELS: &str = "area · 2, px²";

pub(super) fn table(columns: &[&str], rows: Vec<(String, Vec<Option<f64>>)>) -> Value {
    Value::Table { columns: columns.iter().map(|&column| column.to_owned()).collect(), rows }
}

/// The names of values: V1, V2, …
pub(super) fn value_names(count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("V{i}")).collect()
}

/// Twice the signed area, and what it says; the label names the space in which it was reckoned.
fn facing(area: f64, label: &'static str) -> Vec<Field> {
    let winding = match Winding::of(area) {
        Some(Winding::CounterClockwise) => "counter-clockwise",
        Some(Winding::Clockwise) => "clockwise",
        None => "none",
    };
    vec![
        field("area", label, Value::Number(area)),
        field("winding", "winding", Value::Text(winding.to_owned())),
    ]
}

fn vertex_fields(triangle: &ClipTriangle) -> Vec<Field> {
    let mut fields = Vec::new();
    if let Some(model) = triangle.model {
        let rows = "ABC".chars().zip(model);
        let rows = rows.map(|(name, p)| (name.to_string(), p.to_array().map(Some).to_vec())).collect();
        fields.push(field("model", "model space", table(&["x", "y", "z"], rows)));
    }
    let rows = "ABC".chars().zip(&triangle.vertices);
    let rows = rows.map(|(name, v)| (name.to_string(), v.position.to_array().map(Some).to_vec())).collect();
    fields.push(field("clip", "clip space", table(&["x", "y", "z", "ω"], rows)));
    fields
}

fn plane_name(plane: &Plane) -> String {
    let named = [
        (Plane::LEFT, "left, ω + x ≥ 0"),
        (Plane::RIGHT, "right, ω − x ≥ 0"),
        (Plane::BOTTOM, "bottom, ω + y ≥ 0"),
        (Plane::TOP, "top, ω − y ≥ 0"),
        (Plane::NEAR, "near, ω + z ≥ 0"),
        (Plane::NEAR_ZERO, "near, z ≥ 0"),
        (Plane::FAR, "far, ω − z ≥ 0"),
    ];
    let name = named.iter().find(|(known, _)| known == plane);
    name.map_or_else(
        || format!("near, ω ≥ {}", -plane.signed_distance(glam::DVec4::ZERO)),
        |(_, name)| (*name).to_owned(),
    )
}

/// How each plane changed the triangle: which vertices it cut off, and where the cuts are. New vertices are D, E, …
fn clip_fields(triangle: &ClipTriangle) -> (Option<Field>, Vec<char>) {
    let mut names: Vec<char> = "ABC".chars().collect();
    let mut polygon: Vec<ClipVertex<0>> = triangle.vertices.iter().map(Point::bare).collect();
    let mut next = 'D';
    let mut lines = Vec::new();
    for plane in &triangle.planes {
        let distance = |vertex: &ClipVertex<0>| match triangle.test {
            ClipTest::BeforeDivide => plane.signed_distance(vertex.position),
            ClipTest::AfterDivide => plane.signed_distance(vertex.position / vertex.position.w),
        };
        let distances: Vec<f64> = polygon.iter().map(distance).collect();
        if distances.iter().all(|&distance| distance >= 0.0) {
            continue;
        }
        let mut kept = Vec::new();
        let mut line = plane_name(plane) + ":";
        for (i, &from) in distances.iter().enumerate() {
            let end = (i + 1) % distances.len();
            if from >= 0.0 {
                kept.push(names[i]);
            } else {
                line += &format!(" {} outside;", names[i]);
            }
            if (from >= 0.0) != (distances[end] >= 0.0) {
                // From the outer end to the inner one, as the clipper reckons.
                let (outer, inner) = if from >= 0.0 { (end, i) } else { (i, end) };
                let t = distances[outer] / (distances[outer] - distances[inner]);
                line += &format!(" {next} on {}{} at t = {t:.4};", names[outer], names[inner]);
                kept.push(next);
                next = char::from_u32(next as u32 + 1).unwrap_or('?');
            }
        }
        lines.push(line.trim_end_matches(';').to_owned());
        polygon = clip_polygon::<0, 16>(&polygon, plane, triangle.test).to_vec();
        names = kept;
    }
    if lines.is_empty() {
        return (None, names);
    }
    lines.push(format!(
        "left: {}",
        if names.is_empty() { "nothing".to_owned() } else { names.iter().collect() }
    ));
    (Some(field("clipping", "clipped", Value::List(lines))), names)
}

/// The three edge functions at a pixel's center, and what the weights make of the vertices.
fn edge_fields(coverage: &Coverage, piece: Option<&[Point; 3]>, (x, y): Pixel) -> Vec<Field> {
    let unit = (SUBPIXELS * SUBPIXELS) as f64;
    let values = coverage.edge_values(center(x, y));
    let weights = values.map(|value| value as f64 / coverage.twice_area as f64);
    let corners = coverage.vertices.map(|vertex| vertex.map(|c| c as f64 / SUBPIXELS as f64));
    let rows = (0..3).map(|i| {
        let numbers = [corners[i][0], corners[i][1], values[i] as f64 / unit, weights[i]];
        (["A", "B", "C"][i].to_owned(), numbers.map(Some).to_vec())
    });
    let mut fields =
        vec![field("edges", "on the screen", table(&["x", "y", "E opposite", "weight"], rows.collect()))];
    let ties = values.iter().zip(["BC", "CA", "AB"]).filter(|(value, _)| **value == 0);
    let ties = ties.map(|(_, name)| format!("the center is on {name}, a top or left edge: covered"));
    let ties: Vec<String> = ties.collect();
    if !ties.is_empty() {
        fields.push(field("ties", "tie", Value::List(ties)));
    }
    if let Some(piece) = piece {
        fields.extend(weighted_fields(piece, [weights[1], weights[2]]));
    }
    fields
}

/// ω, and the values interpolated in both ways.
fn weighted_fields(piece: &[Point; 3], weights: [f64; 2]) -> Vec<Field> {
    let count = piece[0].values.len();
    let one = |k: usize, interpolation| {
        let corner = |i: usize| crate::clip::NdcVertex {
            position: piece[i].position.truncate(),
            w: piece[i].position.w,
            varyings: [piece[i].values.get(k).copied().unwrap_or_default()],
        };
        TriangleVaryings::<f64, 1>::new(&[corner(0), corner(1), corner(2)], interpolation).at(weights)
    };
    let all = |interpolation| (0..count).map(|k| Some(one(k, interpolation).values[0])).collect::<Vec<_>>();
    let w = |interpolation| Some(one(0, interpolation).w);
    let mut rows: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    for (name, point) in ["A", "B", "C"].into_iter().zip(piece) {
        let values = point.values.iter().map(|value| Some(*value));
        rows.push((name.to_owned(), std::iter::once(Some(point.position.w)).chain(values).collect()));
    }
    for (name, interpolation) in
        [("affine", Interpolation::Affine), ("V_p", Interpolation::PerspectiveCorrect)]
    {
        rows.push((name.to_owned(), std::iter::once(w(interpolation)).chain(all(interpolation)).collect()));
    }
    let mut columns = vec!["ω".to_owned()];
    columns.extend(value_names(count));
    vec![field("values", "values", Value::Table { columns, rows })]
}

fn fragment_fields(fragment: &Fragment) -> Vec<Field> {
    let verdict = match fragment.verdict {
        Verdict::Discarded => "discarded by the shader".to_owned(),
        Verdict::Hidden => "hidden: something nearer was there".to_owned(),
        Verdict::Drawn(color) => format!("drawn as {color:?}"),
    };
    let [red, green, blue, opacity] = fragment.color;
    let mut fields = vec![
        field("w", "ω", Value::Number(fragment.w)),
        field(
            "varyings",
            if fragment.values.is_empty() { "" } else { "varyings" },
            Value::Numbers(fragment.values.clone()),
        ),
        field("fragment_depth", "", Value::Number(fragment.depth)),
        field("shaded", "shader's color", Value::Numbers(vec![red, green, blue])),
    ];
    if opacity < 1.0 {
        fields.push(field("opacity", "opacity", Value::Number(opacity)));
    }
    fields.push(field("verdict", "fragment", Value::Text(verdict)));
    fields
}
