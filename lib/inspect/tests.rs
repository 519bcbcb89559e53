//! Whole histories of small scenes, word for word: each number in them is one that a reader can compute.

use glam::{DVec3, DVec4, dvec2, dvec3, dvec4};

use super::{History, history};
use crate::clip::{ClipTest, ClipVertex, NdcVertex, Plane, fan};
use crate::color::Color;
use crate::cull::CullMode;
use crate::exact::samples::{ROTATED_4, Samples};
use crate::figure::picture::draw_enlarged;
use crate::figure::{Canvas, DrawOptions, RasterizerChoice, Variant};
use crate::framebuffer::Framebuffer;
use crate::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter, step_values};
use crate::line::{StepAxis, dda};
use crate::mesh::Mesh;
use crate::payload::Walk;
use crate::real::Real;
use crate::rect::Pixel;
use crate::scanline::{EdgeWalk, spans};
use crate::shader::{Shaded, Shader};
use crate::state::RenderState;
use crate::target::Target;

/// A vertex in clip space, whose x and y are its place in the model, too; and its values.
type Vertex = (DVec4, [f64; 2]);

/// Two values as red and green; nothing where the first is large.
struct Values;

impl Shader<2> for Values {
    type Attributes = Vertex;

    fn vertex(&self, &(position, varyings): &Vertex) -> ClipVertex<2> {
        ClipVertex { position, varyings }
    }

    fn position(&self, (position, _): &Vertex) -> Option<DVec3> {
        Some(dvec3(position.x, position.y, 0.0))
    }

    fn fragment<R: Real>(&self, [u, v]: [R; 2]) -> Shaded<R> {
        Shaded::opaque([u, v, R::of(0.0)]).discard(R::of(200.0).is_less(u))
    }
}

/// A triangle of these places in NDC, all at the same depth.
fn flat(places: [[f64; 2]; 3], z: f64) -> [Vertex; 3] {
    let values = [[300.0, 0.0], [0.0, 120.0], [0.0, 120.0]];
    [0, 1, 2].map(|i| (dvec4(places[i][0], places[i][1], z, 1.0), values[i]))
}

const WHOLE: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];

/// What the pipeline may do with a triangle, one after the other, in a picture of 16×16.
fn pipeline(canvas: &mut Canvas, interpolation: Interpolation) {
    // Runs into the picture, from ω = 1 to ω = 4; its first vertex is nearer than the near plane.
    let clipped = [
        (dvec4(-1.0, -1.0, -1.5, 1.0), [0.0, 80.0]),
        (dvec4(4.0, -4.0, 2.0, 4.0), [100.0, 0.0]),
        (dvec4(-4.0, 4.0, 2.0, 4.0), [0.0, 160.0]),
    ];
    let [a, b, c] = WHOLE;
    let [near, right, left] = clipped;
    let triangles = [
        clipped,
        flat([a, c, b], -0.5),
        // Its left edge runs through the centers of column 8.
        flat([[0.0625, -1.0], [1.0, -1.0], [0.0625, 1.0]], -0.5),
        flat(WHOLE.map(|[x, y]| [x + 9.0, y]), -0.5),
        flat(WHOLE, 0.9),
        [left, right, near],
    ];
    let mesh = Mesh::unindexed(triangles.concat()).expect("whole triangles");
    let state = RenderState { cull: CullMode::Back, interpolation, ..RenderState::default() };
    canvas.draw(&mesh, &Values, &state);
}

pub(super) fn correct(canvas: &mut Canvas) {
    pipeline(canvas, Interpolation::PerspectiveCorrect);
}

fn affine(canvas: &mut Canvas) {
    pipeline(canvas, Interpolation::Affine);
}

fn reciprocal(canvas: &mut Canvas) {
    pipeline(canvas, Interpolation::Reciprocal);
}

/// The stages of the first chapters, one after the other, in a picture of 16×16.
fn early(picture: &mut Framebuffer) {
    picture.clear(Color::BLUE);
    picture.set(3, 4, Color::RED);
    let scissor = picture.scissor();
    for (from, to) in [((0.0, 2.5), (9.0, 7.0)), ((4.0, 12.0), (2.0, 1.0)), ((0.0, 5.0), (9.0, 0.0))] {
        dda(from.into(), to.into(), StepAxis::Longer, scissor.clone(), |x, y| {
            picture.set(x, y, Color::GREEN);
        });
    }
    let triangle = [dvec2(1.0, 1.0), dvec2(9.0, 4.0), dvec2(2.0, 12.0)];
    spans(triangle, EdgeWalk::Clamped, scissor.clone(), |span| {
        span.columns().for_each(|x| picture.set(x, span.y, Color::RED));
    });
    spans(triangle.map(|p| p + 3.0), EdgeWalk::Clamped, scissor.clone(), |_| {});
    // The row of a middle vertex between two rows belongs to both halves.
    let positions = [dvec2(1.0, 1.0), dvec2(9.0, 4.5), dvec2(2.0, 12.0)];
    let values = [[0.0, 10.0], [80.0, 20.0], [160.0, 30.0]];
    let triangle = [0, 1, 2].map(|i| ScreenVertex { position: positions[i], varyings: values[i] });
    step_values(triangle, Walk::default(), scissor, |x, y, [red, green]| {
        picture.set(x, y, Color::truncated([red, green, 0.0]));
    });
    draw_enlarged(picture, (4, 4), |screen| {
        screen.clear(Color::BLACK);
        let scissor = screen.scissor();
        dda(dvec2(0.0, 0.0), dvec2(3.0, 3.0), StepAxis::Longer, scissor, |x, y| {
            screen.set(x, y, Color::WHITE);
        });
    });
}

/// A spike, a triangle of chapter 5, samples of a pixel, and a triangle that a program clips by itself, as chapter 7 does.
pub(super) fn by_itself(picture: &mut Framebuffer) {
    // The nearly horizontal edge leads 40 pixels to the right in its second row.
    let flat = [dvec2(1.0, 10.9), dvec2(9.0, 11.1), dvec2(2.0, 14.0)];
    spans(flat, EdgeWalk::Unclamped, picture.scissor(), |span| {
        span.columns().for_each(|x| picture.set(x, span.y, Color::RED));
    });
    let corners = [(1.0, 1.0, 1.0), (13.0, 1.0, 2.0), (1.0, 9.0, 4.0)];
    let projected = corners.map(|(x, y, w)| {
        let varyings = Projected { w, values: [x * 10.0] };
        ScreenVertex { position: dvec2(x, y), varyings }
    });
    let (way, walk) = (Interpolation::PerspectiveCorrect, Walk::default());
    step_parameter(projected, way, walk, picture.scissor(), |x, y, point| {
        picture.set(x, y, Color::truncated([point.values[0], 0.0, 0.0]));
    });
    let mut samples = Samples::like(picture, &ROTATED_4);
    for (sample, depth, color) in [(0, 0.5, Color::RED), (3, 0.5, Color::GREEN), (0, 0.75, Color::BLUE)] {
        samples.draw(3, 4, sample, depth, color);
    }
    picture.set(3, 4, samples.resolved().get(3, 4).unwrap_or_default());

    // x and y of the clip space, divided by ω, are places in the picture.
    let vertex = |x, y, w| ClipVertex { position: dvec4(x, y, 0.5, 1.0) * w, varyings: [x] };
    let triangle = [vertex(0.0, 0.0, 1.0), vertex(16.0, 0.0, 4.0), vertex(0.0, 16.0, 4.0)];
    let mut target = Target::like(picture);
    target.clear(Color::BLACK, 1.0);
    for piece in fan(target.clip_triangle(triangle, &[Plane::in_front(2.0)], ClipTest::BeforeDivide)) {
        let on_screen = piece.map(|vertex| {
            let NdcVertex { position, w, varyings } = NdcVertex::from(vertex);
            let projected = Projected { w, values: varyings };
            ScreenVertex { position: position.truncate(), varyings: (projected, position.z) }
        });
        target.fill(on_screen, |[red]| Color::truncated([red, 0.0, 0.0]));
    }
    *picture = target.color;
}

fn of_framebuffer(draw: fn(&mut Framebuffer), pixel: Pixel) -> History {
    let variant = Variant::new("stages", draw, "").size(16, 16);
    history("ch00", &variant, &variant.options(None), pixel)
}

fn of_pipeline(draw: fn(&mut Canvas), rasterizer: RasterizerChoice, pixel: Pixel) -> History {
    let variant = Variant::with_pipeline("pipeline", draw, "").size(16, 16);
    let options = DrawOptions { rasterizer, ..variant.options(None) };
    history("ch00", &variant, &options, pixel)
}

/// Pins a text as `snapshots/NAME.snap`.
fn pin(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

#[test]
fn lines_halves_and_stepped_values() {
    pin("early-upper-half", &of_framebuffer(early, (3, 4)).to_string());
    pin("early-lower-half", &of_framebuffer(early, (2, 2)).to_string());
    pin("early-nothing", &of_framebuffer(early, (12, 13)).to_string());
}

#[test]
fn what_a_program_does_by_itself() {
    pin("samples", &of_framebuffer(by_itself, (3, 4)).to_string());
    pin("spike", &of_framebuffer(by_itself, (14, 11)).to_string());
    pin("pieces", &of_framebuffer(by_itself, (6, 8)).to_string());
}

#[test]
fn what_the_books_rows_step() {
    use RasterizerChoice::Scanline;
    pin("scanline-correct", &of_pipeline(correct, Scanline, (3, 3)).to_string());
    pin("scanline-affine", &of_pipeline(affine, Scanline, (3, 3)).to_string());
    pin("scanline-reciprocal", &of_pipeline(reciprocal, Scanline, (5, 1)).to_string());
}

#[test]
fn edge_functions_and_weights() {
    use RasterizerChoice::Exact;
    pin("exact-piece", &of_pipeline(correct, Exact, (3, 3)).to_string());
    pin("exact-tie", &of_pipeline(correct, Exact, (8, 8)).to_string());
    pin("exact-discarded", &of_pipeline(correct, Exact, (9, 1)).to_string());
}

#[test]
fn misses_can_be_left_out() {
    let whole = of_framebuffer(early, (3, 4)).to_string();
    let (before, _) = whole.split_once("\nWhat did not reach this pixel").expect("there are some");
    let without = of_framebuffer(early, (3, 4)).without_misses().to_string();
    assert_eq!(without, format!("{before}\nIn the picture: (0, 0, 0)"));
}

#[test]
fn the_same_as_json() {
    pin("early-json", &of_framebuffer(early, (3, 4)).to_json());
    pin("scanline-json", &of_pipeline(correct, RasterizerChoice::Scanline, (3, 3)).to_json());
    pin("exact-json", &of_pipeline(correct, RasterizerChoice::Exact, (8, 8)).to_json());
}
