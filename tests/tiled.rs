//! The fast rasterizer draws what the exact one draws in single precision: the same colors and depths, to the last bit.

#[path = "support/targets.rs"]
mod targets;

use std::array::from_fn;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec2, DVec4, dvec2, dvec4};
use proptest::prelude::*;
use proptest::test_runner::contextualize_config;
use rasterbook::area::Winding;
use rasterbook::clip::{ClipTest, ClipVolume, DepthRange};
use rasterbook::cull::CullMode;
use rasterbook::depth::{DepthBuffer, DepthEncoding, DepthTest};
use rasterbook::exact::Exact;
use rasterbook::interpolate::Interpolation;
use rasterbook::merge::{Blend, Merge};
use rasterbook::mipmap::MipMaps;
use rasterbook::real::each;
use rasterbook::shader::Paint;
use rasterbook::srgb::{decode, encode};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::tiled::{Instructions, Tiled};
use rasterbook::transform::Viewport;
use rasterbook::varyings::Derivatives;
use rasterbook::{
    ClipVertex, Color, LoadOp, Mesh, Real, RenderState, Scanline, Shaded, Shader, Silent, Target, draw,
};
use targets::assert_same;

/// A vertex in clip space, with a color and texture coordinates.
type Record = (DVec4, [f64; 5]);

/// Uses all that a fragment shader may: textures, roots, tables, discarding, opacity.
struct Busy {
    texture: Texture,
    mode: AddressMode,
    is_filtered: bool,
}

impl Shader<5> for Busy {
    type Attributes = Record;
    const IS_INLINED: bool = true;

    fn vertex(&self, &(position, varyings): &Record) -> ClipVertex<5> {
        ClipVertex { position, varyings }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, [r, g, b, u, v]: [R; 5]) -> Shaded<R> {
        let texel = if self.is_filtered {
            self.texture.bilinear([u, v], self.mode)
        } else {
            self.texture.nearest([u, v], self.mode)
        };
        let bright = (u * u + v * v).sqrt();
        // Of 0 it is −∞: a zero has a sign.
        let side = R::select((R::of(1.0) / -u).is_less(R::of(0.0)), R::of(8.0), R::of(0.0));
        let mixed = each(
            [r, g, b],
            #[inline(always)]
            |k, channel| channel * R::of(0.25) + texel[k] * bright.min(R::of(0.75)) + side,
        );
        Shaded::translucent(mixed, R::of(0.75)).discard(bright.is_less(R::of(0.1)))
    }
}

/// The same with derivatives.
struct Sloped(Busy);

impl Shader<5> for Sloped {
    type Attributes = Record;
    const IS_INLINED: bool = true;
    const USES_DERIVATIVES: bool = true;

    fn vertex(&self, record: &Record) -> ClipVertex<5> {
        self.0.vertex(record)
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, varyings: [R; 5]) -> Shaded<R> {
        self.0.fragment(varyings)
    }

    #[inline(always)]
    fn fragment_with_derivatives<R: Real>(&self, varyings: [R; 5], change: Derivatives<R, 5>) -> Shaded<R> {
        let steep = (change.dx[3] * R::of(40.0)).max(change.dy[4] * R::of(25.0));
        let Shaded { color, keep } = self.fragment(varyings);
        let [r, g, b, a] = color.channels();
        Shaded { color: Paint::Channels([r + steep, g, b - steep, a]), keep }
    }
}

fn texture() -> Texture {
    let texels = (0..35).map(|i| Color::rgb(i * 7, 255 - i * 5, i * 3)).collect();
    Texture::new(7, 5, texels)
}

fn busy(mode: AddressMode, is_filtered: bool) -> Busy {
    Busy { texture: texture(), mode, is_filtered }
}

/// Draws a mesh: with the fast rasterizer, or else with the exact one.
fn draw_onto<S: Shader<N>, const N: usize>(
    target: &mut Target<f32>,
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: &RenderState,
    tiled: Option<&Tiled>,
) {
    match tiled {
        Some(tiled) => tiled.draw_mesh(mesh, shader, state, target),
        None => draw(mesh, shader, state, &Exact::<f32>::new(), target, &Silent),
    }
}

fn draw_with<S: Shader<N>, const N: usize>(
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: &RenderState,
    tiled: Option<&Tiled>,
    size: (u32, u32),
) -> Target<f32> {
    let mut target = Target::<f32>::sized(size.0, size.1);
    target.clear(Color::rgb(10, 20, 30), state.clear_depth as f32);
    draw_onto(&mut target, mesh, shader, state, tiled);
    target
}

fn compare<S: Shader<N>, const N: usize>(
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: &RenderState,
    size: (u32, u32),
) {
    let exact = draw_with(mesh, shader, state, None, size);
    // With all instructions that this processor has; working memory is kept from picture to picture.
    let mut tiled = Tiled::new();
    for instructions in Instructions::available() {
        tiled = tiled.with_instructions(instructions);
        assert_same(&draw_with(mesh, shader, state, Some(&tiled), size), &exact);
        // Triangles that others have shaded and clipped.
        let mut target = Target::<f32>::sized(size.0, size.1);
        target.clear(Color::rgb(10, 20, 30), state.clear_depth as f32);
        draw(mesh, shader, state, &tiled, &mut target, &Silent);
        assert_same(&target, &exact);
    }
}

/// A corner on the screen or near it, at the eye, behind it, or far away.
fn record() -> impl Strategy<Value = Record> {
    let place = prop_oneof![6 => -1.2..1.2, 1 => -9.0..9.0, 1 => -1000.0..1000.0];
    let place_y = prop_oneof![6 => -1.2..1.2, 1 => -9.0..9.0, 1 => -1000.0..1000.0];
    let w = prop_oneof![8 => 0.2..5.0, 1 => -1.0..1.0, 1 => Just(0.0)];
    (place, place_y, -1.3..1.3, w, prop::array::uniform5(0.0..3.0)).prop_map(
        |(x, y, z, w, values): (f64, f64, f64, f64, [f64; 5])| {
            let [r, g, b, u, v] = values;
            (dvec4(x * w, y * w, z * w, w), [r * 100.0, g * 100.0, b * 100.0, u, v])
        },
    )
}

/// Corners near one another, so that triangles are small.
fn small() -> impl Strategy<Value = [Record; 3]> {
    (record(), prop::array::uniform2((-0.05..0.05, -0.05..0.05, -0.1..0.1))).prop_map(|(first, offsets)| {
        let near = |(x, y, z): (f64, f64, f64)| {
            let w = first.0.w;
            (first.0 + dvec4(x * w, y * w, z * w, 0.0), first.1.map(|value| value + x * 20.0))
        };
        [first, near(offsets[0]), near(offsets[1])]
    })
}

/// The same for whole triangles, with derivatives or without.
fn compare_records(
    records: Vec<Record>,
    state: &RenderState,
    shader: Busy,
    is_sloped: bool,
    size: (u32, u32),
) {
    let mesh = Mesh::unindexed(records).expect("whole triangles");
    if is_sloped {
        compare(&mesh, &Sloped(shader), state, size);
    } else {
        compare(&mesh, &shader, state, size);
    }
}

fn records() -> impl Strategy<Value = Vec<Record>> {
    let triangle = prop_oneof![prop::array::uniform3(record()), small(), small()];
    prop::collection::vec(triangle, 0..40).prop_map(|triangles| triangles.concat())
}

/// A number that arithmetic is seldom asked about: huge, tiny, infinite, none; and some that are quite ordinary.
fn odd() -> impl Strategy<Value = f64> {
    const ODD: [f64; 14] = [
        -0.0,
        f64::MIN_POSITIVE,
        5e-324,
        1e-40,
        1.5e308,
        -1.5e308,
        f64::MAX,
        f32::MAX as f64,
        -3e38,
        1e300,
        -1e300,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    // From 1e37 to 1e300.
    let huge = (123_u64..997, 0_u64..1 << 52, any::<bool>()).prop_map(|(exponent, fraction, is_negative)| {
        let size = f64::from_bits((1023 + exponent) << 52 | fraction);
        if is_negative { -size } else { size }
    });
    let whole = (-2..3).prop_map(f64::from);
    prop_oneof![8 => -1.5..1.5, 8 => whole, 2 => -300.0..300.0, 4 => huge, 2 => prop::sample::select(&ODD[..])]
}

/// A corner made of such numbers.
fn odd_record() -> impl Strategy<Value = Record> {
    let w = prop_oneof![4 => 0.2..5.0, 2 => Just(1.0), 1 => Just(0.0), 1 => Just(-1.0), 1 => odd()];
    let position = (odd(), odd(), odd(), w).prop_map(|(x, y, z, w)| dvec4(x, y, z, w));
    let values = prop_oneof![Just([0.5; 5]), prop::array::uniform5(odd())];
    (position, values)
}

/// Scenes in which such corners stand beside ordinary ones.
fn odd_records() -> impl Strategy<Value = Vec<Record>> {
    let corner = || prop_oneof![2 => odd_record(), 1 => record()];
    let triangle = prop::array::uniform3(corner());
    prop::collection::vec(triangle, 1..12).prop_map(|triangles| triangles.concat())
}

fn state() -> impl Strategy<Value = RenderState> {
    let modes = (
        prop_oneof![Just(CullMode::None), Just(CullMode::Back), Just(CullMode::Front)],
        prop_oneof![Just(Winding::Clockwise), Just(Winding::CounterClockwise)],
        prop_oneof![
            1 => Just(DepthTest::Less),
            3 => Just(DepthTest::LessOrEqual),
            1 => Just(DepthTest::Greater),
            1 => Just(DepthTest::Always)
        ],
        prop_oneof![2 => Just(Blend::Opaque), 1 => Just(Blend::SourceOver), 1 => Just(Blend::Additive)],
        prop_oneof![
            1 => Just(Interpolation::Affine),
            3 => Just(Interpolation::PerspectiveCorrect),
            1 => Just(Interpolation::Reciprocal)
        ],
        prop_oneof![4 => Just(DepthEncoding::Ndc), 1 => Just(DepthEncoding::ViewZ), 1 => Just(DepthEncoding::Reciprocal)],
    );
    let view = (
        prop_oneof![
            4 => Just(ClipVolume::Canonical),
            1 => prop::sample::select(vec![0.1, 0.0, -1.0, 1e300]).prop_map(ClipVolume::InFront),
            1 => Just(ClipVolume::Everything)
        ],
        prop_oneof![2 => Just(ClipTest::BeforeDivide), 1 => Just(ClipTest::AfterDivide)],
        prop_oneof![
            4 => Just(None),
            2 => Just(Some(Viewport { x: 11.0, y: 5.5, width: 50.0, height: 33.0 })),
            1 => Just(Some(Viewport { x: 60.0, y: -7.0, width: -50.0, height: 3e5 }))
        ],
    );
    let depth = (any::<bool>(), any::<bool>(), prop::sample::select(vec![1.0, 4.0, 4.0, 1e39, f64::NAN]));
    (modes, view, any::<bool>(), depth).prop_map(|(modes, view, is_cleared, depth)| {
        let (cull, front_face, depth_test, blend, interpolation, depth_encoding) = modes;
        let (clip_volume, clip_test, viewport) = view;
        let (depth_write, is_zero, clear_depth) = depth;
        RenderState {
            cull,
            front_face,
            merge: Merge { depth_test, depth_write, blend },
            interpolation,
            depth_encoding,
            clip_volume,
            clip_test,
            depth_range: if is_zero { DepthRange::ZeroToOne } else { DepthRange::NegativeOneToOne },
            viewport,
            load: if is_cleared { LoadOp::Clear } else { LoadOp::Load },
            clear_color: Color::rgb(40, 5, 60),
            clear_depth: if depth_test == DepthTest::Greater { -clear_depth } else { clear_depth },
            ..RenderState::default()
        }
    })
}

fn mode() -> impl Strategy<Value = AddressMode> {
    prop_oneof![Just(AddressMode::Clamp), Just(AddressMode::Repeat), Just(AddressMode::Mirror)]
}

/// Up to four columns and four rows of tiles; of all widths, and often a multiple of eight.
fn size() -> impl Strategy<Value = (u32, u32)> {
    let groups = (1_u32..50).prop_map(|groups| 8 * groups);
    prop_oneof![
        (1_u32..400, 1_u32..120),
        (groups, 1_u32..120),
        Just((128, 32)),
        Just((129, 33)),
        Just((1, 1)),
        Just((600, 1)),
    ]
}

/// So many random scenes, unless `PROPTEST_CASES` says otherwise.
fn cases(cases: u32) -> ProptestConfig {
    contextualize_config(ProptestConfig { cases, ..ProptestConfig::default() })
}

proptest! {
    #![proptest_config(cases(512))]

    #[test]
    fn tiled_equals_exact_for_any_numbers(
        records in odd_records(), state in state(), mode in mode(), is_filtered in any::<bool>(), is_sloped in any::<bool>(),
        size in prop_oneof![4 => (1_u32..24, 1_u32..40), 1 => (120_u32..140, 28_u32..36)],
    ) {
        compare_records(records, &state, busy(mode, is_filtered), is_sloped, size);
    }
}

proptest! {
    #![proptest_config(cases(128))]

    #[test]
    fn tiled_equals_exact(records in records(), state in state(), mode in mode(), is_filtered in any::<bool>(), is_sloped in any::<bool>(),
        size in size(),
    ) {
        compare_records(records, &state, busy(mode, is_filtered), is_sloped, size);
    }

    #[test]
    fn shared_vertices_change_nothing(records in prop::collection::vec(record(), 3..30), order in prop::collection::vec(any::<prop::sample::Index>(), 0..30)) {
        let count = order.len() / 3 * 3;
        let indices = order[..count].iter().map(|index| index.index(records.len()) as u32).collect();
        let mesh = Mesh::indexed(records, indices).expect("indices in range");
        compare(&mesh, &busy(AddressMode::Repeat, false), &RenderState::default(), (258, 70));
    }
}

/// Pseudo-random numbers in 0..1.
fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    }
}

/// Many triangles all over the screen, mostly small.
fn crowd(count: usize, seed: u64) -> Mesh<Record> {
    let mut next = numbers(seed);
    let mut records = Vec::new();
    for _ in 0..count {
        let (x, y, z) = (next() * 2.4 - 1.2, next() * 2.4 - 1.2, next() * 2.2 - 1.1);
        let size = if next() < 0.9 { 0.01 } else { 0.6 };
        let w = 0.3 + next() * 3.0;
        for _ in 0..3 {
            let [px, py, pz] =
                [x + (next() - 0.5) * size, y + (next() - 0.5) * size, z + (next() - 0.5) * 0.2];
            records.push((dvec4(px * w, py * w, pz * w, w), from_fn(|_| next() * 250.0)));
        }
    }
    Mesh::unindexed(records).expect("whole triangles")
}

#[test]
fn a_crowd_of_triangles() {
    compare(&crowd(60_000, 7), &busy(AddressMode::Repeat, false), &RenderState::default(), (333, 222));
}

#[test]
fn threads_do_not_matter() {
    let mesh = crowd(20_000, 3);
    let (shader, size) = (busy(AddressMode::Mirror, true), (257, 190));
    // What blends is drawn by the baseline, whatever is asked for.
    let plain = RenderState::default();
    let blended = RenderState { merge: Merge { blend: Blend::SourceOver, ..Merge::default() }, ..plain };
    for state in [plain, blended] {
        let exact = draw_with(&mesh, &shader, &state, None, size);
        for instructions in Instructions::available() {
            for threads in [1, 2, 3, 8] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                let tiled = Tiled::new().with_instructions(instructions);
                assert_same(&pool.install(|| draw_with(&mesh, &shader, &state, Some(&tiled), size)), &exact);
            }
        }
    }
}

#[test]
fn odd_sizes_and_nothing_to_draw() {
    let some = crowd(300, 11);
    let none = Mesh::unindexed(Vec::new()).expect("no triangles are whole triangles");
    for size in [(1, 1), (16_384, 1), (1, 16_384), (7, 3), (8, 32), (127, 31), (257, 65)] {
        compare(&some, &busy(AddressMode::Clamp, false), &RenderState::default(), size);
        compare(&none, &busy(AddressMode::Clamp, false), &RenderState::default(), size);
    }
}

#[test]
fn pictures_narrower_than_a_group() {
    let some = crowd(300, 12);
    for size in [(1, 40), (3, 2), (2, 33), (4, 40), (5, 70), (7, 64), (7, 1)] {
        compare(&some, &busy(AddressMode::Clamp, false), &RenderState::default(), size);
        compare(&some, &Sloped(busy(AddressMode::Clamp, false)), &RenderState::default(), size);
    }
}

/// As many varyings as one likes, all of which have a part in the color.
struct Many<const N: usize, const IS_SLOPED: bool>;

impl<const N: usize, const IS_SLOPED: bool> Shader<N> for Many<N, IS_SLOPED> {
    type Attributes = Record;
    const IS_INLINED: bool = true;
    const USES_DERIVATIVES: bool = IS_SLOPED;

    fn vertex(&self, &(position, values): &Record) -> ClipVertex<N> {
        ClipVertex { position, varyings: from_fn(|k| values[k % 5] / (k + 1) as f64) }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, varyings: [R; N]) -> Shaded<R> {
        let sum =
            |from: usize| varyings.iter().skip(from).step_by(3).fold(R::of(0.0), |sum, &value| sum + value);
        Shaded::opaque(from_fn(sum))
    }

    #[inline(always)]
    fn fragment_with_derivatives<R: Real>(&self, varyings: [R; N], change: Derivatives<R, N>) -> Shaded<R> {
        self.fragment(from_fn(|k| varyings[k] + change.dx[k] * R::of(3.0) - change.dy[k]))
    }
}

#[test]
fn any_number_of_varyings() {
    fn check<const N: usize, const IS_SLOPED: bool>(mesh: &Mesh<Record>) {
        compare(mesh, &Many::<N, IS_SLOPED>, &RenderState::default(), (150, 90));
    }
    let mesh = crowd(400, 13);
    check::<0, false>(&mesh);
    check::<6, false>(&mesh);
    check::<7, true>(&mesh);
    check::<15, false>(&mesh);
    check::<15, true>(&mesh);
}

/// Filters that need derivatives, and the tables of sRGB.
struct Mipped(MipMaps);

impl Shader<5> for Mipped {
    type Attributes = Record;
    const IS_INLINED: bool = true;
    const USES_DERIVATIVES: bool = true;

    fn vertex(&self, &(position, varyings): &Record) -> ClipVertex<5> {
        ClipVertex { position, varyings }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, [.., u, v]: [R; 5]) -> Shaded<R> {
        Shaded::opaque(self.0.bilinear([u, v], R::of(0.0), AddressMode::Repeat))
    }

    #[inline(always)]
    fn fragment_with_derivatives<R: Real>(&self, [.., u, v]: [R; 5], change: Derivatives<R, 5>) -> Shaded<R> {
        let [.., u_dx, v_dx] = change.dx;
        let [.., u_dy, v_dy] = change.dy;
        let level = self.0.level_of_detail([u_dx, v_dx], [u_dy, v_dy]);
        let linear = decode(self.0.trilinear([u, v], level, AddressMode::Repeat));
        let lines = decode(self.0.bilinear([u, v], level, AddressMode::Clamp));
        let mixed = each(
            linear,
            #[inline(always)]
            |k, light| (light + lines[k]) * R::of(0.5),
        );
        Shaded::opaque(encode(mixed))
    }
}

#[test]
fn mip_maps_and_srgb() {
    let mut next = numbers(31);
    // Texture coordinates from much less than a texel a pixel to much more.
    let records = (0..600)
        .map(|i| {
            let size = [0.05, 0.5, 2.0][i / 3 % 3];
            let place = dvec4(next() * size - 0.5, next() * size - 0.5, next() - 0.5, 1.0 + next());
            (place, from_fn(|_| next() * [0.02, 1.0, 40.0][i / 9 % 3]))
        })
        .collect();
    let mesh = Mesh::unindexed(records).expect("whole triangles");
    compare(&mesh, &Mipped(MipMaps::new(&texture())), &RenderState::default(), (200, 90));
}

#[test]
fn a_small_window_on_a_huge_view() {
    // Corners are thousands of pixels away, so that edge functions outgrow 32 bits, and 40.
    let mut next = numbers(5);
    let records = (0..90)
        .map(|_| {
            let w = 0.5 + next();
            let place = dvec4((next() * 2.0 - 1.0) * w, (next() * 2.0 - 1.0) * w, (next() - 0.5) * w, w);
            (place, from_fn(|_| next() * 200.0))
        })
        .collect();
    let mesh = Mesh::unindexed(records).expect("whole triangles");
    let shader = busy(AddressMode::Repeat, false);
    for (x, width) in [(-700.0, 1500.0), (-3000.0, 6000.0), (-8000.0, 16_384.0), (-20_000.0, 40_000.0)] {
        let viewport = Some(Viewport { x, y: x, width, height: width });
        let state = RenderState { viewport, ..RenderState::default() };
        compare(&mesh, &shader, &state, (300, 70));
    }
}

#[test]
fn a_corner_that_is_too_far_away() {
    // The second corner is farther away than the grid reaches, the third beyond the left plane: of the two pieces that are
    // left one can be drawn.
    let corners = [(-0.9999, -0.5), (0.5, 0.0), (-1.0005, 0.9)];
    let records = corners.map(|(x, y)| (dvec4(x, y, 0.0, 1.0), [100.0; 5])).to_vec();
    let mesh = Mesh::unindexed(records).expect("one triangle");
    let viewport = Some(Viewport { x: 0.0, y: 0.0, width: 200_000.0, height: 64.0 });
    for clip_volume in [ClipVolume::Canonical, ClipVolume::Everything] {
        let state = RenderState { viewport, clip_volume, ..RenderState::default() };
        compare(&mesh, &busy(AddressMode::Repeat, false), &state, (64, 64));
    }
}

/// A triangle without color.
fn bare(corners: [[f64; 4]; 3]) -> Mesh<Record> {
    let records = corners.map(|corner| (DVec4::from_array(corner), [0.0; 5]));
    Mesh::unindexed(records.to_vec()).expect("one triangle")
}

#[test]
fn what_lies_beyond_a_plane_as_a_whole() {
    // Nearer than the near plane, all three. When the right plane has cut, rounding has moved what is left behind it.
    let near = [[1e38, 0.0, -1e300, 0.0], [0.0, 0.0, -1e38, 1.0], [1.0, 1.0, -1.2, 1.0]];
    let merge = Merge { depth_test: DepthTest::Always, ..Merge::default() };
    let state = RenderState { merge, ..RenderState::default() };
    compare(&bare(near), &Counted::default(), &state, (1, 2));
    // The divide turns the near plane round for the second: what seems to be beyond it is not, once the top has cut.
    let seemingly = [[0.0, 0.5, -1.0, 0.4], [0.5, 0.0, 175.0, -1.0], [0.0, 0.0, -260.0, 2.0]];
    let after = RenderState { clip_test: ClipTest::AfterDivide, ..state };
    compare(&bare(seemingly), &Counted::default(), &after, (8, 16));
    // A vertex at the eye, and far to the left.
    let at_the_eye = [[0.0, 0.0, -4.4, 1.0], [-6.1e298, 0.0, -2.1e37, 0.0], [1.0, 1.0, -6.9, 2.0]];
    let state = RenderState { depth_encoding: DepthEncoding::ViewZ, ..state };
    compare(&bare(at_the_eye), &Counted::default(), &state, (1, 2));
}

#[test]
fn thousands_of_clipped_triangles() {
    let mut next = numbers(99);
    let records = (0..9000)
        .map(|_| {
            let w = next() * 4.0 - 0.5;
            (
                dvec4(next() * 8.0 - 4.0, next() * 8.0 - 4.0, next() * 4.0 - 2.0, w),
                from_fn(|_| next() * 200.0),
            )
        })
        .collect();
    let mesh = Mesh::unindexed(records).expect("whole triangles");
    compare(&mesh, &busy(AddressMode::Repeat, true), &RenderState::default(), (140, 70));
}

#[test]
fn the_books_rule_covers_other_pixels_only_along_edges() {
    // Corners move to whole columns and rows, by √½ at most, and pixels are sampled at their corners, √½ from their
    // centers: √2 together, and a little more where an edge is steep.
    const BOUND: f64 = 2.0;
    let size = (80, 60);
    let mut next = numbers(21);
    for _ in 0..400 {
        let corners: [DVec2; 3] = from_fn(|_| dvec2(next() * 76.0 + 2.0, next() * 56.0 + 2.0));
        let records = corners
            .map(|p| (dvec4(p.x / 40.0 - 1.0, p.y / 30.0 - 1.0, 0.0, 1.0), [200.0, 0.0, 0.0, 0.5, 0.5]));
        let mesh = Mesh::unindexed(records.to_vec()).expect("a triangle");
        let (shader, state) = (busy(AddressMode::Repeat, false), RenderState::default());
        let [mut book, mut exact] = [Target::new(size.0, size.1), Target::new(size.0, size.1)];
        for target in [&mut book, &mut exact] {
            target.clear(Color::BLACK, 1.0);
        }
        draw(&mesh, &shader, &state, &Scanline, &mut book, &Silent);
        draw(&mesh, &shader, &state, &Exact::<f64>::new(), &mut exact, &Silent);
        for (x, y) in book.color.rect().rows().flat_map(|y| (0..80).map(move |x| (x, y))) {
            let covered = [&book, &exact].map(|target| target.depth.get(x, y) != Some(1.0));
            let center = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let distance =
                (0..3).map(|i| to_segment(center, corners[i], corners[(i + 1) % 3])).fold(9.0, f64::min);
            assert!(
                covered[0] == covered[1] || distance <= BOUND,
                "({x}, {y}) is {distance} from the edges of {corners:?}"
            );
        }
    }
}

/// How far a point is from a segment.
fn to_segment(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let t = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(from + along * t)
}

/// A color, perhaps with a hole, and how often it was asked for.
#[derive(Default)]
struct Counted {
    asked: AtomicUsize,
    has_holes: bool,
}

impl Shader<5> for Counted {
    type Attributes = Record;
    const IS_INLINED: bool = true;

    fn vertex(&self, &(position, varyings): &Record) -> ClipVertex<5> {
        ClipVertex { position, varyings }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, [r, g, b, u, v]: [R; 5]) -> Shaded<R> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        let radius = R::of(f64::from(u8::from(self.has_holes)));
        Shaded::opaque([r, g, b]).discard((u * u + v * v).is_less(radius))
    }
}

/// Leaning layers, each of two triangles and larger than the view, at these depths; their holes are anywhere.
fn layers(depths: &[f64], mut next: impl FnMut() -> f64) -> Mesh<Record> {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut records = Vec::new();
    for &depth in depths {
        let (lean_x, lean_y, w, color) =
            (next() * 0.1, next() * 0.1, 0.5 + next(), from_fn(|_| next() * 255.0));
        for (x, y) in corners.map(|(x, y)| (x * 1.1, y * 1.1)) {
            let [r, g, b]: [f64; 3] = color;
            let z = depth + x * lean_x + y * lean_y;
            let from_hole = [x - 1.0 + r / 127.0, y - 1.0 + g / 127.0].map(|way| way * 6.0);
            records.push((dvec4(x, y, z, 1.0) * w, [r, g, b, from_hole[0], from_hole[1]]));
        }
    }
    Mesh::unindexed(records).expect("whole triangles")
}

/// Compares pictures of up to twelve layers.
fn compare_layers(has_holes: bool) {
    let mut next = numbers(8);
    for round in 0..60 {
        // Some are equally deep, and the leaning ones pass through each other.
        let depths: Vec<f64> = (0..1 + round % 12).map(|_| (next() * 8.0).floor() / 10.0 - 0.4).collect();
        let mesh = layers(&depths, &mut next);
        let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
        for size in [(200, 67), (205, 67)] {
            compare(&mesh, &Counted { has_holes, ..Counted::default() }, &state, size);
        }
    }
}

#[test]
fn layers_in_any_order() {
    compare_layers(false);
}

#[test]
fn layers_with_holes_in_any_order() {
    compare_layers(true);
}

#[test]
fn layers_with_holes_on_what_was_there() {
    let mut next = numbers(9);
    for size in [(200, 67), (205, 67)].repeat(20) {
        let below = layers(&[0.3, 0.1], &mut next);
        let above = layers(&[0.2, 0.0, -0.2, 0.15], &mut next);
        let cleared = RenderState { load: LoadOp::Clear, ..RenderState::default() };
        let shader = Counted { has_holes: true, ..Counted::default() };
        let both = |tiled: Option<&Tiled>| {
            let mut target = Target::<f32>::sized(size.0, size.1);
            for (mesh, state) in [(&below, &cleared), (&above, &RenderState::default())] {
                draw_onto(&mut target, mesh, &shader, state, tiled);
            }
            target
        };
        let exact = both(None);
        for instructions in Instructions::available() {
            assert_same(&both(Some(&Tiled::new().with_instructions(instructions))), &exact);
        }
    }
}

#[test]
#[should_panic(expected = "(8, 8) colors and (8, 4) depths")]
fn pixels_without_depth_are_refused() {
    let mut target = Target::<f32>::sized(8, 8);
    target.depth = DepthBuffer::new(8, 4);
    let mesh = bare([[-1.0, -1.0, 0.0, 1.0], [1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]);
    draw_onto(&mut target, &mesh, &Counted::default(), &RenderState::default(), Some(&Tiled::new()));
}

#[test]
#[should_panic(expected = "(8, 8) colors and (8, 4) depths")]
fn pixels_without_depth_are_refused_by_the_exact_one_too() {
    let mut target = Target::<f32>::sized(8, 8);
    target.depth = DepthBuffer::new(8, 4);
    let mesh = bare([[-1.0, -1.0, 0.0, 1.0], [1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]);
    draw_onto(&mut target, &mesh, &Counted::default(), &RenderState::default(), None);
}

#[test]
fn depths_that_overflow_hide_nothing() {
    // From −3·10³⁸ to 10³⁸: the difference is infinite in single precision, and so is every depth but the first.
    let corners = |z: [f64; 3]| {
        let corners = [(-1.0, -1.0), (2.0, -1.0), (-1.0, 2.0)];
        let records: [Record; 3] = from_fn(|i| {
            (dvec4(corners[i].0, corners[i].1, z[i], 1.0), [100.0 + 50.0 * z[0].abs().min(1.0); 5])
        });
        records
    };
    let records = [corners([-3e38, 1e38, 1e38]), corners([0.0; 3])].concat();
    let state = RenderState { clip_volume: ClipVolume::Everything, ..RenderState::default() };
    let mesh = Mesh::unindexed(records).expect("two triangles");
    compare(&mesh, &Counted::default(), &state, (300, 80));
}

#[test]
fn a_small_triangle_with_a_hole_in_a_tile_of_one_pixel_hides_nothing() {
    let (width, height) = (129, 33);
    let mut records: Vec<Record> = Vec::new();
    let mut add = |corners: [(f64, f64); 3], depth: f64, color: f64, from_hole: f64| {
        let values = [color, color, color, from_hole, from_hole];
        records.extend(corners.map(|(x, y)| (dvec4(x, y, depth, 1.0), values)));
    };
    add([(-1.0, -1.0), (5.0, -1.0), (-1.0, 5.0)], 0.5, 200.0, 5.0);
    // All of it is thrown away.
    add([(0.985, 0.95), (1.05, 0.95), (0.985, 1.3)], 0.0, 100.0, 0.0);
    let mesh = Mesh::unindexed(records).expect("whole triangles");
    let shader = Counted { has_holes: true, ..Counted::default() };
    compare(&mesh, &shader, &RenderState { load: LoadOp::Clear, ..RenderState::default() }, (width, height));
}

#[test]
fn what_is_hidden_in_all_of_a_tile_is_not_shaded() {
    let eight: Vec<f64> = (0..8).map(|i| 0.8 - 0.1 * f64::from(i)).collect();
    let backwards: Vec<f64> = eight.iter().rev().copied().collect();
    for instructions in Instructions::available() {
        let count = |depths: &[f64]| {
            let shader = Counted::default();
            let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
            let mesh = layers(depths, || 0.0);
            let tiled = Tiled::new().with_instructions(instructions);
            draw_with(&mesh, &shader, &state, Some(&tiled), (1280, 320));
            shader.asked.into_inner()
        };
        let one = count(&[0.0]);
        assert!(one >= 1280 * 320 / 8);
        // Along the diagonal no triangle covers a tile alone.
        assert!(count(&eight) < 3 * one, "the farthest first, {instructions}");
        assert!(count(&backwards) < 3 * one, "the nearest first, {instructions}");
    }
}
