//! Each deliberate mistake shows its artefact, and its remedy does not: measured in the pictures themselves.

use crate::chapters::{CHAPTERS, variant};
use rasterbook::figure::Mistake;
use rasterbook::{Color, Framebuffer};

/// The mistakes that a test below looks for.
const TESTED: &[&str] = &[
    "broken",
    "overshoot",
    "shared-edge",
    "spikes",
    "affine",
    "floor-affine",
    "painter-red-first",
    "painter-green-first",
    "z-fighting",
    "uncleared",
    "behind",
    "divide-first",
    "tearing",
    "normals-wrong",
    "gamma-space",
];

#[test]
fn every_mistake_has_a_test_and_a_real_remedy() {
    for (chapter, _) in CHAPTERS {
        for variant in chapter.variants {
            match variant.mistake {
                Mistake::No => assert!(!TESTED.contains(&variant.name), "{} is no mistake", variant.name),
                Mistake::RemediedBy(remedy) => {
                    let remedy = chapter.find(remedy).expect("the remedy is a variant of the same chapter");
                    assert_eq!(remedy.mistake, Mistake::No);
                    assert_eq!(remedy.size, variant.size, "comparable");
                }
                Mistake::WithoutRemedy => {}
            }
            let is_tested = variant.mistake == Mistake::No || TESTED.contains(&variant.name);
            assert!(is_tested, "no test here looks for the artefact of {} {}", chapter.name, variant.name);
        }
    }
}

#[test]
fn names_are_unique_and_look_says_something() {
    for (chapter, _) in CHAPTERS {
        for (i, variant) in chapter.variants.iter().enumerate() {
            assert!(chapter.variants[..i].iter().all(|other| other.name != variant.name), "{}", variant.name);
            assert!(variant.look.len() > 20, "{}: what is to be looked for?", variant.name);
        }
    }
}

const RED: Color = Color::rgb(225, 70, 60);
const GREEN: Color = Color::rgb(80, 180, 90);

fn draw(chapter: &str, name: &str) -> Framebuffer {
    let variant = variant(chapter, name);
    let subject = variant.subject().expect("assets");
    variant.draw(&variant.options(subject.as_ref()))
}

fn count(picture: &Framebuffer, is_meant: impl Fn(i32, i32, Color) -> bool) -> usize {
    picture.rect().pixels().filter(|&(x, y)| is_meant(x, y, picture.get(x, y).expect("inside"))).count()
}

#[test]
fn stepping_a_steep_line_by_x_leaves_gaps() {
    // Rows that a steep ray from (240, 240) to (278, 468) crosses without a pixel.
    let gaps = |picture: &Framebuffer| {
        let is_lit = |x: i32, y: i32| picture.get(x, y).is_some_and(|color| color != Color::BLACK);
        let column = |y: i32| 240 + (y - 240) * 38 / 228;
        (300..460).filter(|&y| !is_lit(column(y), y) && !is_lit(column(y) - 1, y)).count()
    };
    assert_eq!(gaps(&draw("ch02_dda_lines", "star")), 0);
    assert!(gaps(&draw("ch02_dda_lines", "broken")) > 120);

    let vertical =
        |picture: &Framebuffer| count(picture, |x, y, color| x == 240 && y > 260 && color != Color::BLACK);
    assert_eq!(vertical(&draw("ch02_dda_lines", "star")), 468 - 261);
    assert_eq!(vertical(&draw("ch02_dda_lines", "broken")), 0, "a vertical line vanishes");
}

#[test]
fn nearly_level_edges_shoot_out_of_the_triangle() {
    let outside = |picture: &Framebuffer| {
        count(picture, |x, _, color| !(60..=260).contains(&x) && color != Color::BLACK)
    };
    assert_eq!(outside(&draw("ch02_triangles", "clamped")), 0);
    assert!(outside(&draw("ch02_triangles", "overshoot")) > 6 * 50);
}

#[test]
fn seams_are_drawn_twice() {
    let twice = |picture: &Framebuffer| count(picture, |_, _, color| color == Color::rgb(255, 220, 60));
    assert!(twice(&draw("ch02_triangles", "shared-edge")) > 16 * 16 * 50);

    // By the top-left rule every pixel is drawn once, and none between two triangles is left out.
    let exact = draw("ch02_triangles", "top-left");
    assert_eq!(twice(&exact), 0);
    for y in exact.rect().rows() {
        let row: Vec<bool> = exact.rect().columns().map(|x| is_hexagon(&exact, x, y)).collect();
        // Enlarged pixels have lines between them; the hexagon is convex, so no row has a gap of 16 pixels.
        let inner = row.iter().position(|&lit| lit).zip(row.iter().rposition(|&lit| lit));
        assert!(
            inner.is_none_or(|(first, last)| row[first..=last].windows(2).all(|pair| pair[0] || pair[1]))
        );
    }
}

fn is_hexagon(picture: &Framebuffer, x: i32, y: i32) -> bool {
    picture.get(x, y) == Some(Color::rgb(60, 90, 130))
}

#[test]
fn stored_numbers_are_not_amounts_of_light() {
    let [wrong, right] = ["gamma-space", "linear-space"].map(|name| draw("ch10_matrices_lighting", name));
    let at = |picture: &Framebuffer, x, y| picture.get(x, y).expect("inside").channels();
    // The mean of black and white, and the middle between red and green.
    assert_eq!((at(&wrong, 500, 200), at(&right, 500, 200)), ([128; 3], [188; 3]));
    let [muddy, bright] = [&wrong, &right].map(|picture| at(picture, 320, 80)[0]);
    assert!(muddy <= 128 && bright >= 187, "{muddy} {bright}");
    // Half of the columns of the stripes are white.
    assert_eq!(count(&right, |x, y, color| x >= 380 && y >= 300 && color == Color::WHITE), 110 * 140);
}

#[test]
fn several_samples_make_shades() {
    let shades = |name| {
        let picture = draw("ch02_triangles", name);
        let mut colors: Vec<[u8; 3]> =
            picture.rows_from_top().flatten().map(|color| color.channels()).collect();
        colors.sort_unstable();
        colors.dedup();
        colors.len()
    };
    assert_eq!(shades("one-sample"), 5, "black, blue, orange, light and dark");
    let [four, sixteen, multi] = ["supersampled", "supersampled-16", "multisampled"].map(shades);
    assert!(four > 20 && sixteen > 2 * four && multi > 20, "{four} {sixteen} {multi}");
}

#[test]
fn three_filters_flicker_less_and_less() {
    // How much neighbors differ far away, just below the horizon.
    let unrest = |name| {
        let picture = draw("ch10_matrices_lighting", name);
        let red = |x: i32, y: i32| f64::from(picture.get(x, y).expect("inside").channels()[0]);
        (280..300)
            .flat_map(|y| (1..640).map(move |x| (x, y)))
            .map(|(x, y)| (red(x, y) - red(x - 1, y)).abs())
            .sum::<f64>()
    };
    let [nearest, bilinear, mipmapped] = ["nearest", "bilinear", "mipmapped"].map(unrest);
    assert!(bilinear < 0.9 * nearest && mipmapped < 0.2 * nearest, "{nearest} {bilinear} {mipmapped}");
}

#[test]
fn weights_corrected_by_w_give_the_same_square() {
    let [weights, rows] = ["barycentric", "correct"].map(|name| draw("ch05_perspective_correct", name));
    // Pixels are sampled half a pixel to the upper right, so borders differ by one pixel at most.
    let differ = count(&weights, |x, y, color| {
        let near = |dx: i32, dy: i32| rows.get(x + dx, y + dy) == Some(color);
        !(near(0, 0) || near(1, 0) || near(0, 1) || near(1, 1) || near(-1, 0) || near(0, -1) || near(-1, -1))
    });
    assert!(differ <= 2, "{differ}");
    assert!(bend(&weights) <= 2.5);
}

#[test]
fn values_leave_the_range_of_the_vertices() {
    let orange =
        |name| count(&draw("ch03_barycentric", name), |_, _, color| color == Color::rgb(255, 140, 0));
    let [spikes, edges, everywhere] = ["spikes", "clamped-edges", "clamped"].map(orange);
    assert_eq!(everywhere, 0);
    assert!(edges > 0, "the book's remedy leaves the ends of rows");
    assert!(spikes > 2 * edges, "and mends the tips");
}

/// How far the border between the lower and the upper colors of the tilted square is from a straight line, in pixels.
fn bend(picture: &Framebuffer) -> f64 {
    let is_upper = |color| color == Color::BLUE || color == Color::rgb(255, 123, 172);
    let border: Vec<(f64, f64)> = (0..90)
        .map(|x| {
            let height = picture.rect().rows().find(|&y| picture.get(x, y).is_some_and(is_upper));
            (f64::from(x), f64::from(height.expect("both colors are in every column")))
        })
        .collect();
    let [(x0, y0), (x1, y1)] = [border[0], border[border.len() - 1]];
    let off = |&(x, y): &(f64, f64)| (y - (y0 + (y1 - y0) * (x - x0) / (x1 - x0))).abs();
    border.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn affine_interpolation_bends_a_straight_line() {
    assert!(bend(&draw("ch05_perspective_correct", "correct")) <= 2.5);
    assert!(bend(&draw("ch05_perspective_correct", "reciprocal")) <= 2.5);
    assert!(bend(&draw("ch05_perspective_correct", "affine")) > 20.0);
}

#[test]
fn affine_interpolation_folds_the_floor() {
    // Across a row of the floor all squares are equally wide, but for those that the picture cuts off.
    let unevenness = |picture: &Framebuffer| {
        let row: Vec<Color> = picture.rect().columns().filter_map(|x| picture.get(x, 190)).collect();
        let runs: Vec<usize> = row.chunk_by(|a, b| a == b).map(<[Color]>::len).collect();
        let whole = &runs[1..runs.len() - 1];
        whole.iter().max().expect("some") - whole.iter().min().expect("some")
    };
    assert!(unevenness(&draw("ch05_perspective_correct", "floor")) <= 2);
    assert!(unevenness(&draw("ch05_perspective_correct", "floor-affine")) > 200);
}

#[test]
fn three_ways_to_the_same_picture() {
    let correct = draw("ch05_perspective_correct", "correct");
    assert!(correct == draw("ch05_perspective_correct", "reciprocal"), "1/ω and V/ω give the same picture");
    assert!(correct != draw("ch05_perspective_correct", "affine"));
}

#[test]
fn no_order_of_painting_is_right_for_triangles_that_pierce_each_other() {
    let [right, red_first, green_first] =
        ["intersecting", "painter-red-first", "painter-green-first"].map(|name| draw("ch06_z_buffer", name));
    // On the left green is nearer, on the right red: of what both cover, each painter gets one side wrong.
    let wrong = |picture: &Framebuffer, color: Color, is_side: &dyn Fn(i32) -> bool| {
        count(&right, |x, y, now| is_side(x) && now == color && picture.get(x, y) != Some(color))
    };
    let (is_left, is_right) = (|x| x < 320, |x| x >= 320);
    assert!(wrong(&red_first, RED, &is_right) > 1000);
    assert_eq!(wrong(&red_first, GREEN, &is_left), 0);
    assert!(wrong(&green_first, GREEN, &is_left) > 1000);
    assert_eq!(wrong(&green_first, RED, &is_right), 0);
}

#[test]
fn far_away_surfaces_fight_unless_depths_are_reversed() {
    // The share of a plate that is lost, of the eight in their order.
    let lost = |format: &str, name: &str| {
        let variant = variant("ch06_z_buffer", name);
        let mut options = variant.options(None);
        options.knobs.set(&format!("format={format}")).expect("a format");
        let picture = variant.draw(&options);
        [0, 1, 2, 3, 4, 5, 6, 7].map(|index| {
            let (left, bottom) = (95 + 150 * (index % 4) - 20, 370 - 220 * (index / 4) - 15);
            let is_there = |x, y| (left..left + 40).contains(&x) && (bottom..bottom + 30).contains(&y);
            count(&picture, |x, y, color| is_there(x, y) && color == GREEN) as f64 / 1200.0
        })
    };
    assert_eq!(lost("float32", "reversed"), [0.0; 8]);
    let wrong = lost("float32", "z-fighting");
    assert_eq!(wrong[..5], [0.0; 5], "up to 50");
    // 1 − gap / step, the steps at 100, 200 and 500.
    for (lost, step) in wrong[5..].iter().zip([0.00596, 0.0238, 0.149]) {
        assert!((lost - (1.0 - 0.005 / step)).abs() < 0.03, "{lost} where a step is {step}");
    }
    // Integers have the same step everywhere: reversing them gains nothing.
    let (reversed, ordinary) = (lost("unorm24", "reversed"), lost("unorm24", "z-fighting"));
    assert!(
        reversed.into_iter().zip(ordinary).all(|(a, b)| (a - b).abs() < 0.03),
        "{reversed:?} {ordinary:?}"
    );
    assert!(reversed[7] > 0.9);
}

#[test]
fn depths_of_the_last_frame_cut_a_hole() {
    let green = |name| count(&draw("ch06_z_buffer", name), |_, _, color| color == GREEN);
    let (whole, cut) = (green("cleared"), green("uncleared"));
    assert!(whole > 39_000 && cut < whole * 2 / 3, "{cut} of {whole}");
}

#[test]
fn colors_of_the_last_frames_stay() {
    let lit = |name| count(&draw("ch09_pipeline", name), |_, _, color| color != Color::BLACK);
    assert!(lit("uncleared") > 2 * lit("cleared"));
    assert!(lit("cleared") > 10_000);
}

#[test]
fn what_is_behind_the_eye_turns_up_in_the_sky() {
    let floor = |name, above: bool| {
        let background = Color::rgb(20, 24, 32);
        count(&draw("ch07_clipping", name), |_, y, color| (y > 240) == above && color != background)
    };
    assert_eq!(floor("in-front", true), 0, "a floor is never above the horizon");
    assert!(floor("behind", true) > 3000);
    assert!(floor("in-front", false) > 50_000);
}

#[test]
fn testing_after_the_divide_cuts_too_much() {
    let lit = |name| count(&draw("ch08_cvv", name), |_, _, color| color != Color::BLACK);
    assert!(lit("clip-first") > 100_000);
    assert!(lit("divide-first") < 10_000);
}

#[test]
fn one_buffer_shows_two_pictures() {
    let [torn, old] = ["tearing", "presented"].map(|name| draw("ch09_pipeline", name));
    let differs =
        |above: bool| count(&torn, |x, y, color| (y >= 240) == above && old.get(x, y) != Some(color));
    assert_eq!(differs(true), 0, "the upper half is the old picture");
    assert!(differs(false) > 10_000, "the lower half is the new one");
}

#[test]
fn pictures_that_are_claimed_to_be_equal_are() {
    let clipped = draw("ch08_cvv", "clipped");
    assert!(clipped == draw("ch08_cvv", "zero-to-one"));
    assert!(clipped == draw("ch09_pipeline", "vbo"));
    let [ccw, cw, none] = ["cull-ccw", "cull-cw", "cull-none"].map(|name| draw("ch09_pipeline", name));
    assert!(ccw != cw && cw != none && none != ccw);
}

#[test]
fn texels_from_beyond_a_triangle_show_on_the_ball() {
    let [wrong, mended] = ["spikes", "spikes-fixed"].map(|name| draw("ch10_matrices_lighting", name));
    let is_other =
        |a: Color, b: Color| a.channels().iter().zip(b.channels()).any(|(a, b)| a.abs_diff(b) > 60);
    let strong = count(&wrong, |x, y, color| is_other(color, mended.get(x, y).expect("inside")));
    assert!(strong > 80, "{strong} pixels of plainly another color");
}

#[test]
fn light_on_wrong_normals_does_not_fit_the_shape() {
    // The ball is tilted by 15° and lit from above: right, its upper half is bright and its lower half dark.
    let [wrong, right] = ["normals-wrong", "normals"].map(|name| draw("ch10_matrices_lighting", name));
    let contrast = |picture: &Framebuffer| {
        let at = |dy: i32| f64::from(picture.get(320, 240 + dy).expect("inside").channels()[0]);
        at(30) - at(-30)
    };
    assert!(contrast(&right) > 100.0, "{}", contrast(&right));
    assert!(contrast(&wrong) < 0.6 * contrast(&right), "{}", contrast(&wrong));
}
