//! Bytes as triangles, states and planes.

use glam::{DVec4, dvec4};
use rasterbook::area::Winding;
use rasterbook::clip::{ClipTest, ClipVolume, DepthRange, Plane, clip_polygon, clip_triangle};
use rasterbook::cull::CullMode;
use rasterbook::depth::{DepthEncoding, DepthTest};
use rasterbook::exact::Exact;
use rasterbook::interpolate::Interpolation;
use rasterbook::merge::{Blend, Merge};
use rasterbook::real::each;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::tiled::{Instructions, Tiled};
use rasterbook::transform::Viewport;
use rasterbook::{
    ClipVertex, Color, LoadOp, Mesh, Real, RenderState, Scanline, Shaded, Shader, Silent, Target, draw,
};

use super::bytes::Bytes;

type Record = (DVec4, [f64; 3]);

/// Texture, a color, opacity, and holes.
struct Surface {
    texture: Texture,
    mode: AddressMode,
}

impl Shader<3> for Surface {
    type Attributes = Record;
    const IS_INLINED: bool = true;

    fn vertex(&self, &(position, varyings): &Record) -> ClipVertex<3> {
        ClipVertex { position, varyings }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, [bright, u, v]: [R; 3]) -> Shaded<R> {
        let texel = self.texture.bilinear([u, v], self.mode);
        let color = each(
            texel,
            #[inline(always)]
            |_, channel| channel * bright,
        );
        Shaded::translucent(color, bright.min(R::of(1.0))).discard(bright.is_less(R::of(0.05)))
    }
}

/// A mesh of up to twelve triangles, by every rasterizer: none panics, and `Tiled` draws what `Exact<f32>` does, with all
/// instructions that the processor has.
pub(crate) fn scene(data: &[u8]) {
    let bytes = &mut Bytes(data);
    let state = state(bytes);
    let texels = (0..12).map(|i| Color::rgb(i * 20, 255 - i * 9, i * 3)).collect();
    let mode = bytes.one_of(&[AddressMode::Clamp, AddressMode::Repeat, AddressMode::Mirror]);
    let shader = Surface { texture: Texture::new(4, 3, texels), mode };
    // Mostly small, sometimes two tiles.
    let size = if bytes.byte() < 240 {
        (1 + bytes.below(24) as u32, 1 + bytes.below(24) as u32)
    } else {
        (120 + bytes.below(20) as u32, 28 + bytes.below(10) as u32)
    };
    let mut records = Vec::new();
    while records.len() < 36 && (!bytes.is_empty() || records.len() % 3 > 0) {
        records.push(record(bytes));
    }
    let mesh = Mesh::unindexed(records).expect("whole triangles");

    let mut book = Target::<f64>::sized(size.0, size.1);
    draw(&mesh, &shader, &state, &Scanline, &mut book, &Silent);
    draw(&mesh, &shader, &state, &Exact::<f64>::new(), &mut book, &Silent);
    let mut exact = Target::<f32>::sized(size.0, size.1);
    draw(&mesh, &shader, &state, &Exact::<f32>::new(), &mut exact, &Silent);
    for instructions in Instructions::available() {
        let mut tiled = Target::<f32>::sized(size.0, size.1);
        Tiled::new().with_instructions(instructions).draw_mesh(&mesh, &shader, &state, &mut tiled);
        compare(&tiled, &exact, instructions);
    }
}

/// Colors and depths, as bits; what is not a number may be written in any way.
fn compare(tiled: &Target<f32>, exact: &Target<f32>, instructions: Instructions) {
    for (x, y) in exact.color.rect().pixels() {
        let colors = [tiled, exact].map(|target| target.color.get(x, y));
        assert_eq!(colors[0], colors[1], "color at ({x}, {y}), {instructions}");
        let depths = [tiled, exact].map(|target| target.depth.get(x, y).expect("inside"));
        let is_same = depths[0].to_bits() == depths[1].to_bits() || depths.iter().all(|depth| depth.is_nan());
        assert!(is_same, "depths {depths:?} at ({x}, {y}), {instructions}");
    }
}

fn record(bytes: &mut Bytes<'_>) -> Record {
    let is_odd = bytes.byte() >= 200;
    let mut number = || if is_odd { bytes.number() } else { bytes.ordinary() };
    let [x, y, z, w, bright, u, v] = std::array::from_fn(|_| number());
    // In front of the eye, mostly.
    let w = if is_odd { w } else { w.abs() + 0.25 };
    let position = if is_odd { dvec4(x, y, z, w) } else { dvec4(x / 2.0 * w, y / 2.0 * w, z / 3.0 * w, w) };
    (position, [bright, u, v])
}

fn state(bytes: &mut Bytes<'_>) -> RenderState {
    let volume = match bytes.below(4) {
        0 => ClipVolume::Everything,
        1 => ClipVolume::InFront(bytes.number()),
        _ => ClipVolume::Canonical,
    };
    let viewport = (bytes.below(4) == 0).then(|| {
        let [x, y, width, height] = std::array::from_fn(|_| bytes.number() * 10.0);
        Viewport { x, y, width, height }
    });
    RenderState {
        clip_volume: volume,
        clip_test: bytes.one_of(&[ClipTest::BeforeDivide, ClipTest::BeforeDivide, ClipTest::AfterDivide]),
        depth_range: bytes.one_of(&[DepthRange::NegativeOneToOne, DepthRange::ZeroToOne]),
        cull: bytes.one_of(&[CullMode::None, CullMode::Back, CullMode::Front]),
        front_face: bytes.one_of(&[Winding::Clockwise, Winding::CounterClockwise]),
        viewport,
        interpolation: bytes.one_of(&[
            Interpolation::PerspectiveCorrect,
            Interpolation::Affine,
            Interpolation::Reciprocal,
        ]),
        depth_encoding: bytes.one_of(&[DepthEncoding::Ndc, DepthEncoding::ViewZ, DepthEncoding::Reciprocal]),
        merge: Merge {
            depth_test: bytes.one_of(&[
                DepthTest::LessOrEqual,
                DepthTest::Less,
                DepthTest::Greater,
                DepthTest::Always,
            ]),
            depth_write: bytes.yes(),
            blend: bytes.one_of(&[Blend::Opaque, Blend::SourceOver, Blend::Additive]),
        },
        load: bytes.one_of(&[LoadOp::Clear, LoadOp::Load]),
        clear_depth: bytes.number(),
        ..RenderState::default()
    }
}

/// A polygon and planes: what is left is finite, lies inside the plane, and within the polygon's own bounds.
pub(crate) fn polygon(data: &[u8]) {
    const MOST: usize = 9;
    let bytes = &mut Bytes(data);
    let test = bytes.one_of(&[ClipTest::BeforeDivide, ClipTest::AfterDivide]);
    let is_odd = bytes.yes();
    let vector = |bytes: &mut Bytes<'_>| {
        DVec4::from_array(std::array::from_fn(|_| if is_odd { bytes.number() } else { bytes.ordinary() }))
    };
    let planes: Vec<Plane> = (0..bytes.below(7))
        .map(|_| match bytes.below(3) {
            0 => Plane::in_front(vector(bytes).x),
            1 => bytes.one_of(&Plane::CANONICAL),
            _ => Plane::homogeneous(vector(bytes)),
        })
        .collect();
    let vertex = |bytes: &mut Bytes<'_>| {
        let position = vector(bytes);
        ClipVertex { position, varyings: [position.x] }
    };
    let triangle = [vertex(bytes), vertex(bytes), vertex(bytes)];
    let left = clip_triangle(triangle, &planes, test);
    assert!(left.iter().all(|vertex| vertex.position.is_finite()));
    let mut polygon = triangle.to_vec();
    while !bytes.is_empty() && polygon.len() < MOST {
        polygon.push(vertex(bytes));
    }
    for plane in &planes {
        let kept = clip_polygon::<1, { MOST + 6 }>(&polygon, plane, test);
        if !is_odd && test == ClipTest::BeforeDivide {
            check_kept(&kept, &polygon, plane);
        }
    }
}

/// For numbers up to 4 in size.
fn check_kept(kept: &[ClipVertex<1>], polygon: &[ClipVertex<1>], plane: &Plane) {
    const TOLERANCE: f64 = 1e-12;
    let bounds = |vertices: &[ClipVertex<1>]| {
        vertices.iter().fold([DVec4::INFINITY, DVec4::NEG_INFINITY], |[low, high], vertex| {
            [low.min(vertex.position), high.max(vertex.position)]
        })
    };
    let [low, high] = bounds(polygon);
    for vertex in kept {
        let distance = plane.signed_distance(vertex.position);
        assert!(distance >= -64.0 * TOLERANCE, "{distance} inside {plane:?}: {vertex:?}");
        let slack = DVec4::splat(TOLERANCE);
        assert!(vertex.position.cmpge(low - slack).all() && vertex.position.cmple(high + slack).all());
        // What is carried along is interpolated as the position is.
        assert!((vertex.varyings[0] - vertex.position.x).abs() <= TOLERANCE, "{vertex:?}");
    }
    let inside = polygon.iter().filter(|vertex| plane.signed_distance(vertex.position) >= 0.0).count();
    assert!(kept.len() >= inside && (inside > 0 || kept.is_empty()));
}
