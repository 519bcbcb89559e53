//! `--size` means the same for every variant: a scene scales, keeps its proportions and lies in the middle; what is about
//! single pixels is the same picture with more or less around it.

use crate::chapters::{smaller, variant, variants};
use rasterbook::figure::picture::paste;
use rasterbook::figure::{DrawOptions, Variant};
use rasterbook::inspect::{history, overdraw};
use rasterbook::{Color, Framebuffer, Pixel, Rect};
use rayon::prelude::*;

/// From a certain size on there is a grid between enlarged pixels.
pub(crate) const GRID: Color = Color::gray(80);

fn draw(variant: &Variant, size: (u32, u32)) -> Framebuffer {
    let subject = variant.subject().expect("assets");
    variant.draw(&DrawOptions { size, ..variant.options(subject.as_ref()) })
}

/// Looks at all variants that scale, or at all that do not, and collects what is wrong with them.
fn all(in_pixels: bool, what_is_wrong: impl Fn(&Variant) -> Option<String> + Sync) {
    let variants: Vec<_> = variants().filter(|(_, variant)| variant.in_pixels == in_pixels).collect();
    let look = |(chapter, variant): &(&str, &Variant)| {
        what_is_wrong(variant).map(|wrong| format!("{chapter} {}: {wrong}", variant.name))
    };
    let wrong: Vec<String> = variants.par_iter().filter_map(look).collect();
    assert!(!variants.is_empty() && wrong.is_empty(), "{wrong:#?}");
}

/// Of a part of the pixels of `this`, those that are not like its first one: how many show something that `that` does not
/// show near the same place, and how many there are. `that` is `factor` times as large.
fn missing(this: &Framebuffer, that: &Framebuffer, factor: f64) -> (usize, usize) {
    let background = this.get(0, 0);
    let reach = factor.ceil() as i32;
    let (mut missing, mut count) = (0, 0);
    let (columns, rows) = (this.rect().columns(), this.rect().rows());
    for (x, y) in rows.step_by(3).flat_map(|y| columns.clone().step_by(3).map(move |x| (x, y))) {
        let Some(color) = this.get(x, y).filter(|color| Some(*color) != background && *color != GRID) else {
            continue;
        };
        let [left, bottom] = [x, y].map(|along| (f64::from(along) * factor) as i32);
        let shows = |(x, y): Pixel| that.get(x, y).is_some_and(|it| is_like(it, color));
        let near = Rect {
            left: left - reach,
            bottom: bottom - reach,
            right: left + 2 * reach + 1,
            top: bottom + 2 * reach + 1,
        };
        count += 1;
        // Nearly always it is at the place itself.
        missing += usize::from(!shows((left, bottom)) && !near.pixels().any(shows));
    }
    (missing, count)
}

fn is_like(a: Color, b: Color) -> bool {
    a == b || a.channels().into_iter().zip(b.channels()).all(|(a, b)| a.abs_diff(b) <= 24)
}

/// What is wrong if more than two of a hundred pixels are missing, or if hardly any were compared.
fn too_many(missing: &[(usize, usize)]) -> Option<String> {
    let is_wrong = |&(missing, count): &(usize, usize)| missing * 50 > count || count < 50;
    missing.iter().any(is_wrong).then(|| format!("(missing, of): {missing:?}"))
}

/// Which copy of a texture they show depends on how many pixels a texel covers, and that is their point.
const BY_LEVEL_OF_DETAIL: [&str; 2] = ["mip-levels", "address-modes"];

#[test]
fn twice_as_large_a_scene_shows_the_same() {
    all(false, |variant| {
        if BY_LEVEL_OF_DETAIL.contains(&variant.name) {
            return None;
        }
        let wrong = |(width, height): (u32, u32)| {
            let (once, twice) = (draw(variant, (width, height)), draw(variant, (2 * width, 2 * height)));
            too_many(&[missing(&once, &twice, 2.0), missing(&twice, &once, 0.5)])
        };
        // Smaller pictures first: a sixth of the pixels. On a screen of few pixels a block is a whole number of pixels wide, and
        // such pictures are only alike where that number doubles.
        let (width, height) = smaller(variant, 5);
        wrong((2 * width, 2 * height)).and_then(|_| wrong(variant.size))
    });
}

#[test]
fn in_other_proportions_a_scene_lies_undistorted_in_the_middle() {
    all(false, |variant| {
        let wrong = |(width, height): (u32, u32)| {
            let own = draw(variant, (width, height));
            let found = [(60, 0), (0, 60)].map(|(wider, higher)| {
                let picture = draw(variant, (width + wider, height + higher));
                let mut middle = Framebuffer::new(width, height);
                paste(&mut middle, &picture, -(wider as i32 / 2), -(higher as i32 / 2));
                [missing(&own, &middle, 1.0), missing(&middle, &own, 1.0)]
            });
            too_many(found.as_flattened())
        };
        // A smaller picture first. Where that has too few pixels, or too many on edges, a larger one decides.
        wrong(smaller(variant, 4)).and_then(|_| wrong(smaller(variant, 2)))
    });
}

#[test]
fn what_is_drawn_in_pixels_is_cropped_and_not_scaled() {
    all(true, |variant| {
        let own = draw(variant, variant.size);
        let wrong = [(250, 250), (1000, 700)].map(|size| {
            let picture = draw(variant, size);
            differing(&picture, |x, y| own.get(x, y).or(Some(Color::BLACK)))
        });
        (wrong != [0, 0]).then(|| format!("{wrong:?} pixels differ"))
    });
}

fn differing(picture: &Framebuffer, other: impl Fn(i32, i32) -> Option<Color>) -> usize {
    picture.rect().pixels().filter(|&(x, y)| picture.get(x, y) != other(x, y)).count()
}

#[test]
fn no_size_is_too_small_or_too_odd() {
    for in_pixels in [false, true] {
        all(in_pixels, |variant| {
            for size in [(1, 1), (3, 2), (1, 300), (300, 1), (17, 11)] {
                let picture = draw(variant, size);
                assert_eq!((picture.width(), picture.height()), size);
            }
            None
        });
    }
}

#[test]
fn an_enlarged_screen_is_asked_where_it_is_shown() {
    // The hexagon of 40×30 pixels, drawn as 16×16 each, as 24×24 with a border, and as 7×7 with another one.
    let hexagon = variant("ch02_triangles", "top-left");
    let inside: Pixel = (19, 14);
    for (size, factor, origin) in
        [((640, 480), 16, (0, 0)), ((1280, 720), 24, (160, 0)), ((300, 300), 7, (10, 45))]
    {
        let options = DrawOptions { size, ..hexagon.options(None) };
        let at = (origin.0 + inside.0 * factor + 2, origin.1 + inside.1 * factor + 3);
        let text = history("ch02_triangles", hexagon, &options, at).to_string();
        let place = format!("each pixel drawn as {factor}×{factor}: what follows is its pixel (19, 14)");
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&place) && words.contains("written"), "{size:?}: {text}");

        // Each write is counted where the picture shows it: but for its grid, what was written is the picture.
        let (heat, _) = overdraw(hexagon, &options);
        let picture = hexagon.draw(&options);
        assert_eq!(differing(&heat, |x, y| Some(heat_of(picture.get(x, y)))), 0, "{size:?}");

        if origin != (0, 0) {
            let text = history("ch02_triangles", hexagon, &options, (1, 1)).to_string();
            assert!(text.contains("this pixel is beside it"), "{size:?}: {text}");
        }
    }
}

/// What the overdraw shows where the hexagon's picture has this color: black, or once.
fn heat_of(color: Option<Color>) -> Color {
    if color == Some(Color::rgb(60, 90, 130)) { Color::rgb(40, 70, 130) } else { Color::BLACK }
}

#[test]
fn a_screen_that_is_too_large_is_cropped_around_its_middle() {
    // 16×22 pixels in a picture of 6×8: columns 5 to 10, rows 7 to 14.
    let pawn = variant("ch01_pixels", "pawn");
    let (once, small) = (draw(pawn, (16, 22)), draw(pawn, (6, 8)));
    assert_eq!(differing(&small, |x, y| once.get(x + 5, y + 7)), 0);
    let history = history("ch01_pixels", pawn, &DrawOptions { size: (6, 8), ..pawn.options(None) }, (2, 3));
    assert_eq!(Some(history.color()), once.get(7, 10));
    assert_eq!(history.color(), history.last_color());
}
