//! The fast rasterizer does not clear again what is blank already. Whatever has happened to a picture in between, it
//! must look as if all of it had been cleared.

use glam::{DVec4, dvec4};
use proptest::prelude::*;
use rasterbook::clip::ClipVertex;
use rasterbook::depth::{DepthBuffer, DepthTest, Target};
use rasterbook::exact::Exact;
use rasterbook::mesh::Mesh;
use rasterbook::pipeline::{LoadOp, RenderState, draw};
use rasterbook::probe::Silent;
use rasterbook::raster::Rasterizer;
use rasterbook::real::Real;
use rasterbook::shader::{Shaded, Shader};
use rasterbook::tiled::Tiled;
use rasterbook::{Color, Framebuffer};

/// Six tiles side by side, three of them one above the other; the last ones are not whole.
const SIZE: (u32, u32) = (344, 90);

/// All in one color.
struct Flat;

impl Shader<0> for Flat {
    type Attributes = DVec4;

    fn vertex(&self, position: &DVec4) -> ClipVertex<0> {
        ClipVertex { position: *position, varyings: [] }
    }

    fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
        Shaded::opaque([200.0, 100.0, 50.0].map(R::of))
    }
}

/// What can happen to a picture.
#[derive(Clone, Debug)]
enum Step {
    /// Triangles are drawn, on a background or on what is there.
    Draw(LoadOp, Color, f64, Vec<DVec4>),
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
    fn happen<Z: Rasterizer<Depth = f32>>(&self, target: &mut Target<f32>, rasterizer: &Z) {
        match self {
            &Self::Draw(load, clear_color, clear_depth, ref corners) => {
                let mesh = Mesh::unindexed(corners.clone()).expect("whole triangles");
                let state = RenderState { load, clear_color, clear_depth, ..RenderState::default() };
                draw(&mesh, &Flat, &state, rasterizer, target, &Silent);
            }
            &Self::Set(x, y) => target.color.set(x, y, Color::GREEN),
            &Self::Test(x, y) => {
                target.depth.test_and_set(x, y, -0.75, DepthTest::Always);
            }
            Self::ClearColors => target.color.clear(Color::BLUE),
            Self::ClearDepths => target.depth.clear(0.25),
            Self::NewColors => target.color = Framebuffer::new(SIZE.0, SIZE.1),
            Self::NewDepths => target.depth = DepthBuffer::new(SIZE.0, SIZE.1),
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
    let draw = (load, color, depth, triangles)
        .prop_map(|(load, color, depth, corners)| Step::Draw(load, color, depth, corners));
    let place = || (0..SIZE.0 as i32, 0..SIZE.1 as i32);
    prop_oneof![
        9 => draw,
        1 => place().prop_map(|(x, y)| Step::Set(x, y)),
        1 => place().prop_map(|(x, y)| Step::Test(x, y)),
        1 => prop_oneof![Just(Step::ClearColors), Just(Step::ClearDepths)],
        1 => prop_oneof![Just(Step::NewColors), Just(Step::NewDepths)],
    ]
}

fn assert_same(tiled: &Target<f32>, exact: &Target<f32>) {
    for (x, y) in exact.color.rect().rows().flat_map(|y| (0..SIZE.0 as i32).map(move |x| (x, y))) {
        assert_eq!(tiled.color.get(x, y), exact.color.get(x, y), "color at ({x}, {y})");
        let depths = [tiled, exact].map(|target| target.depth.get(x, y).map(f32::to_bits));
        assert_eq!(depths[0], depths[1], "depth at ({x}, {y})");
    }
}

proptest! {
    #[test]
    fn pictures_one_after_the_other(steps in prop::collection::vec(step(), 1..12)) {
        let tiled = Tiled::new();
        let mut targets = [0, 1].map(|_| Target::<f32>::sized(SIZE.0, SIZE.1));
        for step in &steps {
            let [by_tiles, by_pixels] = &mut targets;
            step.happen(by_tiles, &tiled);
            step.happen(by_pixels, &Exact::<f32>::new());
            assert_same(by_tiles, by_pixels);
        }
    }

    #[test]
    fn two_pictures_by_turns(steps in prop::collection::vec((step(), any::<bool>()), 1..12)) {
        // What is known of a picture stays with it, and with its copy.
        let tiled = Tiled::new();
        let first = Target::<f32>::sized(SIZE.0, SIZE.1);
        let mut targets = [[first.clone(), first.clone()], [first.clone(), first]];
        for (step, is_second) in &steps {
            if let Step::NewColors = step {
                targets[usize::from(!is_second)] = targets[usize::from(*is_second)].clone();
            }
            let [by_tiles, by_pixels] = &mut targets[usize::from(*is_second)];
            step.happen(by_tiles, &tiled);
            step.happen(by_pixels, &Exact::<f32>::new());
            assert_same(by_tiles, by_pixels);
        }
    }
}
