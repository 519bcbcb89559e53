//! What was recorded, as pictures: the order in which things happened, and how often each pixel was written.

use glam::{DMat3, DVec2, DVec3};

use super::record::{Event, Primitive, Recording};
use crate::clip::{Assembled, ClipVertex, clip_polygon};
use crate::color::Color;
use crate::exact::edge::SUBPIXELS;
use crate::figure::picture::block;
use crate::figure::{Animation, DrawOptions, Variant};
use crate::framebuffer::Framebuffer;
use crate::line::{StepAxis, dda};
use crate::rect::{Pixel, Rect};
use crate::transform::perspective_divide;

/// At most so many frames.
const MOST: usize = 240;
/// As long as there are at most so many primitives, each is shown row by row.
const FEW: usize = 64;

/// One write: where it shows in the picture, its color, and to which row and which primitive it belongs.
#[derive(Clone, Copy, Debug)]
struct Write {
    rect: Rect,
    color: Color,
    /// The picture is cleared: no pixel is drawn by that.
    is_clear: bool,
    row: usize,
    primitive: usize,
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
    writes: Vec<Write>,
    outlines: Vec<Outline>,
    /// For each frame, how many writes it shows, and which outline.
    frames: Vec<(usize, Option<usize>)>,
    last: Framebuffer,
}

/// The corners of a piece on the screen, if the primitive is a triangle.
fn corners_of(primitive: &Primitive) -> Option<[DVec2; 3]> {
    match primitive {
        Primitive::Triangle(triangle) => Some(triangle.positions),
        Primitive::Coverage(coverage) => {
            Some(coverage.vertices.map(|[x, y]| DVec2::new(x as f64, y as f64) / SUBPIXELS as f64))
        }
        Primitive::Line(_) | Primitive::Half(_) => None,
    }
}

impl Steps {
    /// Draws a variant and records it.
    #[must_use]
    pub fn new(variant: &Variant, options: &DrawOptions<'_>) -> Self {
        let Recording { events, picture, .. } = Recording::new(variant, options, None);
        Self::of(&events, picture)
    }

    /// Reads the events of a picture.
    fn of(events: &[Event], picture: Framebuffer) -> Self {
        let mut steps = Self {
            size: (picture.width(), picture.height()),
            writes: Vec::new(),
            outlines: Vec::new(),
            frames: Vec::new(),
            last: picture,
        };
        let (mut shown_by, mut primitive, mut row) = (None, 0, 0);
        let mut last: Option<Pixel> = None;
        let mut clipped: Option<&Assembled> = None;
        for event in events {
            match event {
                Event::Enlarged(enlargement) => shown_by = *enlargement,
                Event::Assembled(triangle) => clipped = Some(triangle),
                Event::Begun(begun) => {
                    (primitive, row, last) = (primitive + 1, row + 1, None);
                    // Its first piece tells where on the screen the polygon is.
                    if let Some((triangle, corners)) = clipped.take().zip(corners_of(begun)) {
                        steps.outline(triangle, corners);
                    }
                }
                Event::Done => (primitive, row, last) = (primitive + 1, row + 1, None),
                Event::Cleared(color) if shown_by.is_none() => {
                    (primitive, row) = (primitive + 1, row + 1);
                    steps.writes.push(Write {
                        rect: steps.last.rect(),
                        color: *color,
                        is_clear: true,
                        row,
                        primitive,
                    });
                }
                Event::Written(pixel, color) => {
                    row += usize::from(last.is_some_and(|last| last.1 != pixel.1));
                    last = Some(*pixel);
                    let (factor, origin) = shown_by.map_or((1, (0, 0)), |by| (by.factor, by.origin));
                    let rect = block(*pixel, factor, origin);
                    steps.writes.push(Write { rect, color: *color, is_clear: false, row, primitive });
                }
                _ => {}
            }
        }
        steps.choose_frames();
        steps
    }

    /// The polygon after each plane that cut something off.
    fn outline(&mut self, triangle: &Assembled, corners: [DVec2; 3]) {
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
        let screen = DMat3::from_cols(corners[0].extend(1.0), corners[1].extend(1.0), corners[2].extend(1.0));
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

    /// Steps that suit the picture: pixels of a few lines, rows of a few triangles, else whole primitives.
    fn choose_frames(&mut self) {
        let ends = |key: fn(&Write) -> usize| {
            let mut ends: Vec<usize> = (1..self.writes.len())
                .filter(|&i| key(&self.writes[i]) != key(&self.writes[i - 1]))
                .collect();
            ends.push(self.writes.len());
            ends
        };
        let primitives = ends(|write| write.primitive);
        let all: Vec<usize> = if self.writes.len() <= MOST {
            (1..=self.writes.len()).collect()
        } else if primitives.len() <= FEW {
            ends(|write| write.row)
        } else {
            primitives
        };
        // Of more steps than frames, several make a frame.
        let count = all.len().min(MOST);
        let ends = (1..=count).map(|i| all[i * all.len() / count - 1]);
        // Outlines come before what is drawn after them, unless they are too many.
        let shown = if self.outlines.len() <= 64 { self.outlines.len() } else { 0 };
        let mut next = 0;
        for end in ends {
            while next < shown && self.outlines[next].after < end {
                self.frames.push((self.outlines[next].after, Some(next)));
                next += 1;
            }
            self.frames.push((end, None));
        }
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
        for write in &self.writes[..end] {
            picture.fill(write.rect, write.color);
        }
        for [a, b] in outline.iter().flat_map(|&i| &self.outlines[i].lines) {
            dda(*a, *b, StepAxis::Longer, picture.rect(), |x, y| picture.set(x, y, Color::rgb(255, 220, 60)));
        }
        picture
    }

    /// How often each pixel was written, as colors, and what the colors mean: a line each.
    #[must_use]
    pub fn overdraw(&self) -> (Framebuffer, Vec<String>) {
        let mut counts = vec![0_usize; self.size.0 as usize * self.size.1 as usize];
        let all = self.last.rect();
        for write in self.writes.iter().filter(|write| !write.is_clear) {
            for y in write.rect.rows() {
                for x in write.rect.columns() {
                    if let Some(index) = all.index(x, y) {
                        counts[index] += 1;
                    }
                }
            }
        }
        let mut picture = Framebuffer::new(self.size.0, self.size.1);
        let mut totals = [0_usize; HEAT.len()];
        for (x, y) in all.rows().flat_map(|y| all.columns().map(move |x| (x, y))) {
            let count = all.index(x, y).map_or(0, |index| counts[index]).min(HEAT.len() - 1);
            totals[count] += 1;
            picture.set(x, y, HEAT[count].0);
        }
        let line = |(i, total): (usize, &usize)| {
            let more = if i + 1 == HEAT.len() { " or more" } else { "" };
            let pixels = if *total == 1 { "pixel" } else { "pixels" };
            format!("{i}{more}: {} ({total} {pixels})", HEAT[i].1)
        };
        let title = "How often each pixel was written:".to_owned();
        (picture, std::iter::once(title).chain(totals.iter().enumerate().map(line)).collect())
    }
}

/// Colors for 0, 1, 2, … writes.
pub(super) const HEAT: [(Color, &str); 7] = [
    (Color::BLACK, "black"),
    (Color::rgb(40, 70, 130), "blue"),
    (Color::rgb(255, 220, 60), "yellow"),
    (Color::rgb(250, 150, 40), "orange"),
    (Color::rgb(235, 60, 40), "red"),
    (Color::rgb(230, 60, 180), "pink"),
    (Color::WHITE, "white"),
];
