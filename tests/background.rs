//! The fast rasterizer does not clear again what is blank already. Whatever has happened to a picture in between, it
//! must look as if all of it had been cleared.

use crate::targets::assert_same;
use glam::{DVec4, dvec4};
use proptest::prelude::*;
use rasterbook::depth::{DepthBuffer, DepthTest};
use rasterbook::exact::Exact;
use rasterbook::tiled::{Instructions, Tiled};
use rasterbook::transform::Viewport;
use rasterbook::{
    ClipVertex, Color, Framebuffer, LoadOp, Mesh, Real, RenderState, Shaded, Shader, Silent, Target, draw,
};

/// Six columns and three rows of tiles, the last ones not whole. Once the width is a multiple of eight, once not.
const SIZES: [(u32, u32); 2] = [(728, 90), (725, 90)];

/// All in one color.
struct Flat;

impl Shader<0> for Flat {
    type Attributes = DVec4;
    const IS_INLINED: bool = true;

    fn vertex(&self, position: &DVec4) -> ClipVertex<0> {
        ClipVertex { position: *position, varyings: [] }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
        Shaded::opaque([R::of(200.0), R::of(100.0), R::of(50.0)])
    }
}

/// A rasterizer for each set of instructions that this processor has.
fn rasterizers() -> impl Iterator<Item = Tiled> {
    Instructions::available().map(rasterizer)
}

fn rasterizer(instructions: Instructions) -> Tiled {
    Tiled::new().with_instructions(instructions)
}

/// One of them.
fn instructions() -> impl Strategy<Value = Instructions> {
    prop::sample::select(Instructions::available().collect::<Vec<_>>())
}

/// What can happen to a picture.
#[derive(Clone, Debug)]
enum Step {
    /// Triangles are drawn, on a background or on what is there.
    Draw(LoadOp, Color, f64, Option<Viewport>, Vec<DVec4>),
    /// A pixel is colored.
    Set(i32, i32),
    /// A depth is written.
    Test(i32, i32),
    /// The plane of colors, or that of depths, is cleared with something else.
    ClearColors,
    ClearDepths,
    /// One of the planes is exchanged for a new one.
    NewColors,
    NewDepths,
}

impl Step {
    /// Draws with the fast rasterizer, or else with the exact one.
    fn happen(&self, target: &mut Target<f32>, tiled: Option<&Tiled>) {
        match self {
            &Self::Draw(load, clear_color, clear_depth, viewport, ref corners) => {
                let mesh = Mesh::unindexed(corners.clone()).expect("whole triangles");
                let state =
                    RenderState { load, clear_color, clear_depth, viewport, ..RenderState::default() };
                match tiled {
                    Some(tiled) => tiled.draw_mesh(&mesh, &Flat, &state, target),
                    None => draw(&mesh, &Flat, &state, &Exact::<f32>::new(), target, &Silent),
                }
            }
            &Self::Set(x, y) => target.color.set(x, y, Color::GREEN),
            &Self::Test(x, y) => {
                target.depth.test_and_set(x, y, -0.75, DepthTest::Always);
            }
            Self::ClearColors => target.color.clear(Color::BLUE),
            Self::ClearDepths => target.depth.clear(0.25),
            Self::NewColors => target.color = Framebuffer::new(target.color.width(), target.color.height()),
            Self::NewDepths => target.depth = DepthBuffer::new(target.color.width(), target.color.height()),
        }
    }
}

/// A triangle somewhere, of a few pixels or of a few tiles.
fn triangle() -> impl Strategy<Value = Vec<DVec4>> {
    let size = prop_oneof![4 => Just(0.05), 1 => Just(0.8)];
    (-1.0..1.0, -1.0..1.0, -0.9..0.9, size).prop_map(|(x, y, z, size): (f64, f64, f64, f64)| {
        vec![dvec4(x, y, z, 1.0), dvec4(x + size, y, z, 1.0), dvec4(x, y + 2.0 * size, z, 1.0)]
    })
}

fn step() -> impl Strategy<Value = Step> {
    let color = prop_oneof![3 => Just(Color::BLACK), 1 => Just(Color::WHITE)];
    let depth = prop_oneof![6 => Just(1.0), 1 => Just(0.0), 1 => Just(-0.0)];
    let load = prop_oneof![3 => Just(LoadOp::Clear), 1 => Just(LoadOp::Load)];
    let triangles = prop::collection::vec(triangle(), 0..3).prop_map(|triangles| triangles.concat());
    let part = Viewport { x: 140.0, y: 20.5, width: 300.0, height: 40.0 };
    let viewport = prop_oneof![4 => Just(None), 1 => Just(Some(part))];
    let draw =
        (load, color, depth, viewport, triangles).prop_map(|(load, color, depth, viewport, corners)| {
            Step::Draw(load, color, depth, viewport, corners)
        });
    // In both sizes.
    let (width, height) = SIZES[1];
    let place = || (0..width as i32, 0..height as i32);
    prop_oneof![
        9 => draw,
        1 => place().prop_map(|(x, y)| Step::Set(x, y)),
        1 => place().prop_map(|(x, y)| Step::Test(x, y)),
        1 => prop_oneof![Just(Step::ClearColors), Just(Step::ClearDepths)],
        1 => prop_oneof![Just(Step::NewColors), Just(Step::NewDepths)],
    ]
}

fn size() -> impl Strategy<Value = (u32, u32)> {
    prop_oneof![Just(SIZES[0]), Just(SIZES[1])]
}

/// What happens to two pictures between two steps.
#[derive(Clone, Copy, Debug)]
enum Turn {
    /// The same goes on.
    Stay,
    /// The other one's turn.
    Other,
    /// The other one's turn, and it becomes a copy of this one.
    Copy,
    /// They exchange their colors, and keep their depths.
    Swap,
}

proptest! {
    #[test]
    fn pictures_one_after_the_other(
        instructions in instructions(), size in size(), steps in prop::collection::vec(step(), 1..12),
    ) {
        let tiled = rasterizer(instructions);
        let mut targets = [0, 1].map(|_| Target::<f32>::sized(size.0, size.1));
        for step in &steps {
            let [by_tiles, by_pixels] = &mut targets;
            step.happen(by_tiles, Some(&tiled));
            step.happen(by_pixels, None);
            assert_same(by_tiles, by_pixels);
        }
    }

    #[test]
    fn two_pictures_by_turns(instructions in instructions(), size in size(), steps in prop::collection::vec(
        (step(), prop_oneof![Just(Turn::Stay), Just(Turn::Other), Just(Turn::Copy), Just(Turn::Swap)]), 1..12,
    )) {
        // What is known of a picture stays with it, and its copy knows nothing false.
        let tiled = rasterizer(instructions);
        let pair = [0, 1].map(|_| Target::<f32>::sized(size.0, size.1));
        let [mut here, mut there] = [pair.clone(), pair];
        for (step, turn) in &steps {
            match turn {
                Turn::Stay => {}
                Turn::Other => std::mem::swap(&mut here, &mut there),
                Turn::Copy => there = here.clone(),
                Turn::Swap => {
                    let pairs = here.iter_mut().zip(&mut there);
                    pairs.for_each(|(here, there)| std::mem::swap(&mut here.color, &mut there.color));
                }
            }
            let [by_tiles, by_pixels] = &mut here;
            step.happen(by_tiles, Some(&tiled));
            step.happen(by_pixels, None);
            assert_same(by_tiles, by_pixels);
        }
    }
}

/// A triangle of one depth that covers the lower left half of the view, or only its corner.
fn half(depth: f64, size: f64, load: LoadOp) -> Step {
    let corners = [(0.0, 0.0), (size, 0.0), (0.0, size)].map(|(x, y)| dvec4(x - 1.0, y - 1.0, depth, 1.0));
    Step::Draw(load, Color::BLACK, 1.0, None, corners.to_vec())
}

#[test]
fn one_depth_buffer_for_pictures_of_two_sizes() {
    for tiled in rasterizers() {
        let mut pictures = [(64, 64), (256, 128)].map(|(width, height)| Framebuffer::new(width, height));
        let mut depth = DepthBuffer::new(256, 128);
        // In the second tile of both pictures nothing is drawn at first. But that of the small one has depths that belong to
        // the first tile of the large one.
        for (which, size) in [(0, 0.2), (1, 0.45), (0, 2.0)] {
            let mut target = Target { color: pictures[which].clone(), depth };
            let mut alone = Target::sized(target.color.width(), target.color.height());
            // Near in the large picture, far in the small one: what it leaves would hide the other.
            let step = half(if which == 1 { -0.9 } else { 0.9 }, size, LoadOp::Clear);
            step.happen(&mut target, Some(&tiled));
            step.happen(&mut alone, Some(&tiled));
            assert!(target.color == alone.color, "picture {which}, {size}");
            (pictures[which], depth) = (target.color, target.depth);
        }
    }
}

#[test]
fn a_smaller_picture_on_the_same_depths() {
    for tiled in rasterizers() {
        let [mut by_tiles, mut by_pixels] = [0, 1].map(|_| Target::<f32>::sized(64, 64));
        half(0.5, 0.5, LoadOp::Clear).happen(&mut by_tiles, Some(&tiled));
        half(0.5, 0.5, LoadOp::Clear).happen(&mut by_pixels, None);
        (by_tiles.color, by_pixels.color) = (Framebuffer::new(64, 32), Framebuffer::new(64, 32));
        half(0.2, 1.5, LoadOp::Load).happen(&mut by_tiles, Some(&tiled));
        half(0.2, 1.5, LoadOp::Load).happen(&mut by_pixels, None);
        assert_same(&by_tiles, &by_pixels);
    }
}
