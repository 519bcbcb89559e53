//! The history of a pixel: what was reported, with the numbers of each chapter's formula.
//!
//! Nothing here draws. Of a primitive that reached the pixel, the stage is gone through once more with the same library
//! functions, to find the numbers that it passed on the way.

use std::sync::Arc;

use super::event::{Event, Primitive, within};
use super::formulas::{clip_fields, edge_fields, facing, fragment_fields, vertex_fields};
use super::history::{Entry, Field, History, Value, field, table};
use super::rows::{line_at, miss, rows_at};
use crate::area::twice_signed_area;
use crate::clip::Assembled;
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::observer::Enlargement;
use crate::probe::Piece;
use crate::rect::{Pixel, Rect};

/// An area on the screen.
const PIXELS: &str = "area · 2, px²";

/// A pixel has at most so many entries, and as many of what did not reach it.
const MOST: usize = 10_000;

/// Entries in their order, of very many the first ones and the last.
#[derive(Debug, Default)]
struct Entries {
    told: Vec<Entry>,
    untold: usize,
}

impl Entries {
    fn push(&mut self, entry: Entry) {
        if self.told.len() == MOST {
            self.told.pop();
            self.untold += 1;
        }
        self.told.push(entry);
    }

    /// All of them, and how many are left out.
    fn finish(mut self) -> Vec<Entry> {
        if self.untold > 0 {
            let title = format!("{} more are left out here", self.untold);
            self.told.insert(MOST - 1, Entry::new("untold", title));
        }
        self.told
    }
}

/// What was found out about a pixel.
#[derive(Debug, Default)]
struct Findings {
    entries: Entries,
    others: Entries,
    /// The color that it was given last.
    color: Color,
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

/// Explains what happens at a pixel, event by event: none is kept.
#[derive(Debug)]
pub(super) struct Explainer {
    pixel: Pixel,
    picture: Rect,
    /// How the picture shows the current screen, if it is not the picture itself.
    enlargement: Option<Enlargement>,
    /// Of triangles and lines, counted from 1.
    number: usize,
    assembled: Option<Arc<Assembled>>,
    piece: Option<Arc<Piece>>,
    pieces: usize,
    primitive: Option<Arc<Primitive>>,
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

impl Explainer {
    /// For a pixel of a picture of this size.
    pub(super) fn new(pixel: Pixel, picture: Rect) -> Self {
        Self {
            pixel,
            picture,
            enlargement: None,
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
        }
    }

    /// The history, now that the picture is there.
    pub(super) fn finish(mut self, picture: &Framebuffer) -> History {
        self.end_triangle();
        let left_out: Vec<Entry> = self.left_out().collect();
        let Findings { entries, others, color: last_color } = self.found;
        let (mut entries, mut others) = (entries.finish(), others.finish());
        others.extend(left_out);
        let pixel = self.pixel;
        let color = picture.get(pixel.0, pixel.1).unwrap_or_default();
        if !entries.iter().any(|entry| matches!(entry.kind, "line" | "half" | "triangle" | "painted")) {
            let title = "Nothing covers this pixel: it keeps the background".to_owned();
            entries.push(Entry::new("background", title));
        }
        if color != last_color {
            let title = format!(
                "Afterwards the program shows something else here, {color:?}: another buffer, or a line between enlarged pixels"
            );
            entries.push(Entry::new("replaced", title));
        }
        let row = picture.height() as i32 - 1 - pixel.1;
        let (frame, knobs) = (None, Vec::new());
        History { program: "", variant: "", frame, knobs, pixel, row, entries, others, color, last_color }
    }

    /// Takes in an event; those of a pixel only if it is the one that is [here](Self::here).
    pub(super) fn read(&mut self, event: &Event) {
        match event {
            Event::Enlarged(enlargement) => self.enlarge(*enlargement),
            Event::Cleared(color) => self.clear(*color),
            Event::Assembled(triangle) => {
                self.end_triangle();
                self.number += 1;
                (self.assembled, self.piece, self.pieces) = (Some(triangle.clone()), None, 0);
            }
            Event::Piece(piece) => {
                self.pieces += 1;
                self.piece = Some(piece.clone());
            }
            Event::Unknown => {
                let title = "A stage begins that is not known here".to_owned();
                self.found.entries.push(Entry::new("unknown", title));
            }
            // Of a clipped triangle there may be several pieces.
            Event::Culled if self.culled.last() == Some(&self.number) => {}
            Event::Culled => self.culled.push(self.number),
            Event::Begun(primitive) => {
                if self.assembled.is_none() {
                    self.number += 1;
                }
                (self.primitive, self.is_open, self.hits, self.is_hit_complete) =
                    (Some(primitive.clone()), false, 0, true);
                if self.piece.is_none() && self.assembled.is_some() {
                    self.pieces += 1;
                }
            }
            Event::Done => self.done(),
            Event::Noted(text) => {
                if self.primitive.is_none() && !self.is_noting {
                    let title = "What the program says of this pixel".to_owned();
                    self.found.entries.push(Entry::new("note", title));
                    (self.is_open, self.is_noting) = (true, true);
                }
                self.open(true);
                self.add([field("note", "note", Value::Text(text.clone()))]);
            }
            Event::Tested { depth, stored, passed } => {
                self.begin_hit();
                self.add([
                    field("depth", "depth", Value::Number(*depth)),
                    field("stored", "  stored", Value::Number(*stored)),
                    field("passed", "  in front", Value::Yes(*passed)),
                ]);
                self.is_hit_complete = !passed && self.piece.is_none();
            }
            Event::Written(color) => {
                self.begin_hit();
                self.found.color = *color;
                self.add([field("written", "written", Value::Color(*color))]);
                self.is_hit_complete = self.piece.is_none();
            }
            Event::Fragment(fragment) => {
                self.begin_hit();
                self.add(fragment_fields(fragment));
                self.is_hit_complete = true;
            }
        }
    }

    fn enlarge(&mut self, enlargement: Option<Enlargement>) {
        (self.enlargement, self.number, self.assembled) = (enlargement, 0, None);
        if let Some(Enlargement { factor, screen, .. }) = enlargement {
            let (x, y) = self.here();
            let place = if screen.contains(x, y) {
                format!("what follows is its pixel ({x}, {y})")
            } else {
                "this pixel is beside it".to_owned()
            };
            let title = format!("A screen of its own, each pixel drawn as {factor}×{factor}: {place}");
            self.found.entries.push(Entry::new("enlarged", title));
        }
    }

    fn clear(&mut self, color: Color) {
        let (x, y) = self.here();
        if !self.screen().contains(x, y) {
            return;
        }
        self.found.color = color;
        let title = format!("The picture is cleared to {color:?}");
        self.found.entries.push(Entry::new("cleared", title));
        self.end_triangle();
        // What was drawn before stays in the history; triangles are counted from 1 again.
        (self.number, self.assembled, self.piece) = (0, None, None);
    }

    /// The pixel on the screen that is being drawn on.
    #[inline]
    pub(super) fn here(&self) -> Pixel {
        within(self.pixel, self.enlargement)
    }

    fn screen(&self) -> Rect {
        self.enlargement.map_or(self.picture, |enlargement| enlargement.screen)
    }

    /// Sees that the running primitive has an entry, and in it a hit, a new one if that is wanted.
    fn open(&mut self, is_new_hit: bool) {
        if !self.is_open {
            let entry = self.entry();
            self.found.entries.push(entry);
            self.is_open = true;
        }
        if let Some(entry) =
            self.found.entries.told.last_mut().filter(|entry| is_new_hit || entry.hits.is_empty())
        {
            entry.hits.push(Vec::new());
        }
    }

    /// Adds to the entry of the running primitive.
    fn add(&mut self, fields: impl IntoIterator<Item = Field>) {
        self.open(false);
        if let Some(hit) = self.found.entries.told.last_mut().and_then(|entry| entry.hits.last_mut()) {
            hit.extend(fields);
        }
    }

    /// A pixel of a primitive is met: the numbers on the way to it, once for each time.
    fn begin_hit(&mut self) {
        if !self.is_hit_complete {
            return;
        }
        if self.primitive.is_none() {
            // Every write by the program itself gets an entry of its own.
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
        let fields = match self.primitive.as_deref() {
            None => Vec::new(),
            Some(Primitive::Line(line)) => line_at(line, here, screen),
            Some(Primitive::Coverage(coverage)) => edge_fields(coverage, self.piece.as_deref(), here),
            Some(primitive) => rows_at(primitive, here, screen).into_iter().nth(hit).unwrap_or_default(),
        };
        self.add(fields);
    }

    /// The beginning of a primitive's entry.
    fn entry(&self) -> Entry {
        let Some(primitive) = self.primitive.as_deref() else {
            let title = "The program itself paints this pixel".to_owned();
            return Entry::new("painted", title);
        };
        let number = self.number;
        let (kind, title) = match primitive {
            Primitive::Line(_) => ("line", format!("Line {number}")),
            Primitive::Half(_) => ("half", format!("Half {number} of a triangle")),
            Primitive::Triangle(_) | Primitive::Coverage(_) => ("triangle", format!("Triangle {number}")),
        };
        let mut fields = vec![field("number", "", Value::Whole(number as i64))];
        if let Some(assembled) = &self.assembled {
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
        if let Some(Piece { vertices, signed_area }) = self.piece.as_deref() {
            let rows = "ABC".chars().zip(vertices.iter());
            let rows = rows.map(|(name, v)| (name.to_string(), v.position.to_array().map(Some).to_vec()));
            fields.push(field("ndc", "NDC, and ω", table(&["x", "y", "z", "ω"], rows.collect())));
            let is_on_screen = matches!(primitive, Primitive::Coverage(_));
            fields.extend(facing(*signed_area, if is_on_screen { PIXELS } else { "area · 2, NDC" }));
        } else if let Primitive::Triangle(triangle) = primitive {
            let [a, b, c] = triangle.positions;
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
            && let Some(reason) = miss(&primitive, self.here(), self.screen())
        {
            let name = match *primitive {
                Primitive::Line(_) => "line",
                Primitive::Half(_) => "half",
                Primitive::Triangle(_) | Primitive::Coverage(_) => "triangle",
            };
            let piece = if self.pieces > 1 { format!(", piece {}", self.pieces) } else { String::new() };
            let title = format!("{name} {}{piece}: {reason}", self.number);
            self.found.others.push(Entry::new("missed", title));
        }
        (self.primitive, self.is_open, self.is_hit_complete) = (None, false, true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_follow_one_another_are_a_range() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1–3, 7, 9–10");
        assert_eq!(ranges(&[]), "");
    }

    #[test]
    fn what_was_left_out_is_told_by_its_numbers() {
        let mut explainer = Explainer::new((0, 0), Rect::sized(1, 1));
        explainer.culled = vec![2, 3];
        let entries: Vec<Entry> = explainer.left_out().collect();
        assert_eq!(entries.len(), 1);
        assert_eq!(entries[0].title, "culled, seen from behind or without area: 2 triangles, 2–3");
        assert!(matches!(&entries[0].fields[0].value, Value::Numbers(numbers) if *numbers == [2.0, 3.0]));
    }
}
