//! What the numbers of a color mean: light computed with encoded values, and in linear light.

use glam::{DVec2, DVec4, dvec4};
use rasterbook::figure::{Canvas, Knob};
use rasterbook::light::{add, lambert, normalize, scale};
use rasterbook::real::each;
use rasterbook::srgb::{decode, encode};
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

pub(super) const KNOBS: &[Knob] = &[Knob::whole(
    "period",
    2,
    [2, 6],
    "columns",
    "one column of so many is white, and the gray below has as much of it: only in linear light do they stay alike",
)];

// ANCHOR: space
/// In which numbers light is added and multiplied.
#[derive(Clone, Copy)]
enum Space {
    /// The encoded ones, a mistake: twice the number is more than four times the light.
    Gamma,
    /// Linear light.
    Linear,
}

impl Space {
    /// An encoded color, 0..=255 → what is computed with, 0..=1.
    fn enter<R: Real>(self, stored: [R; 3]) -> [R; 3] {
        match self {
            Self::Gamma => each(stored, |_, channel| channel / R::of(255.0)),
            Self::Linear => decode(stored),
        }
    }

    /// And back.
    fn leave<R: Real>(self, computed: [R; 3]) -> [R; 3] {
        match self {
            Self::Gamma => scale(computed, R::of(255.0)),
            Self::Linear => encode(computed),
        }
    }
}
// ANCHOR_END: space

/// What is shown in a rectangle of the picture.
#[derive(Clone, Copy)]
enum Sample {
    /// A white ball, lit from the right.
    Ball,
    /// Red on the left, green on the right, and their mixtures.
    Mixture,
    /// Vertical lines, one pixel wide, white and one black, or more of them.
    Stripes,
    /// The mean of these lines.
    Mean,
}

struct Rectangle {
    space: Space,
    sample: Sample,
    /// The fraction of the lines that is white.
    white: f64,
}

// ANCHOR: samples
impl Shader<3> for Rectangle {
    /// The place in NDC; −1..1 across the rectangle, and the column of the picture in pixels.
    type Attributes = (DVec4, DVec2, f64);

    fn vertex(&self, &(position, across, column): &Self::Attributes) -> ClipVertex<3> {
        ClipVertex { position, varyings: [across.x, across.y, column] }
    }

    fn fragment<R: Real>(&self, [x, y, column]: [R; 3]) -> Shaded<R> {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let stored = |color: Color| R::array_of(color.to_f64());
        let light = |color| self.space.enter(stored(color));
        let mix = |a: [R; 3], b: [R; 3], t: R| add(scale(a, one - t), scale(b, t));
        match self.sample {
            Sample::Ball => {
                let square = one - x * x - y * y;
                let normal = [x, y, -square.max(zero).sqrt()];
                let to_light = normalize([R::of(0.8), R::of(0.35), R::of(-0.5)]);
                let bright = lambert(normal, to_light);
                Shaded::opaque(self.space.leave(scale(light(Color::WHITE), bright)))
                    .discard(square.is_less(zero))
            }
            Sample::Mixture => Shaded::opaque(self.space.leave(mix(
                light(Color::RED),
                light(Color::GREEN),
                (x + one) * R::of(0.5),
            ))),
            Sample::Mean => Shaded::opaque(self.space.leave(mix(
                light(Color::BLACK),
                light(Color::WHITE),
                R::of(self.white),
            ))),
            Sample::Stripes => {
                let period = column * R::of(self.white);
                let is_black = (period - period.floor()).is_less(R::of(1.0 - self.white));
                let (black, white) = (stored(Color::BLACK), stored(Color::WHITE));
                Shaded::opaque(each(black, |k, black| R::select(is_black, black, white[k])))
            }
        }
    }
}
// ANCHOR_END: samples

/// The samples in their places: left, bottom, right and top, in pixels of a picture of 640×480.
const PLACES: [(Sample, [f64; 4]); 4] = [
    (Sample::Ball, [40.0, 160.0, 320.0, 440.0]),
    (Sample::Stripes, [380.0, 300.0, 600.0, 440.0]),
    (Sample::Mean, [380.0, 160.0, 600.0, 300.0]),
    (Sample::Mixture, [40.0, 40.0, 600.0, 120.0]),
];

fn draw(canvas: &mut Canvas, space: Space) {
    let state = RenderState { clear_color: Color::gray(60), ..RenderState::default() };
    canvas.clear(&state);
    let white = 1.0 / f64::from(canvas.knobs.whole("period"));
    for (sample, [left, bottom, right, top]) in PLACES {
        let points = [
            (left, bottom, -1.0, -1.0),
            (right, bottom, 1.0, -1.0),
            (right, top, 1.0, 1.0),
            (left, top, -1.0, 1.0),
        ];
        let vertices = points.map(|(column, row, x, y)| {
            (dvec4(column / 320.0 - 1.0, row / 240.0 - 1.0, 0.0, 1.0), DVec2::new(x, y), column)
        });
        let mesh = Mesh::indexed(vertices.to_vec(), vec![0, 1, 2, 0, 2, 3]).expect("two triangles");
        canvas.draw(&mesh, &Rectangle { space, sample, white }, &state);
    }
}

/// With encoded values.
pub(super) fn gamma_space(canvas: &mut Canvas) {
    draw(canvas, Space::Gamma);
}

/// In linear light.
pub(super) fn linear_space(canvas: &mut Canvas) {
    draw(canvas, Space::Linear);
}
