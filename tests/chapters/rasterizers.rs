//! Every variant that the pipeline draws, by all three rasterizers.

use rasterbook::figure::{DrawOptions, RasterizerChoice, Variant};
use rasterbook::{Color, Framebuffer};
use rayon::prelude::*;

use crate::chapters::{smaller, variants};

#[test]
fn every_variant_of_the_pipeline() {
    let variants: Vec<_> = variants().filter(|(_, variant)| variant.rasterizer.is_some()).collect();
    // A smaller picture first; but more of its texels are smaller than its pixels.
    let look = |(_, variant): &(&str, &Variant)| {
        what_is_wrong(variant, smaller(variant, 2)).and_then(|_| what_is_wrong(variant, variant.size))
    };
    let wrong: Vec<String> = variants.par_iter().filter_map(look).collect();
    assert!(variants.len() > 20 && wrong.is_empty(), "{wrong:#?}");
}

fn what_is_wrong(variant: &Variant, size: (u32, u32)) -> Option<String> {
    let subject = variant.subject().expect("assets");
    let picture =
        |rasterizer| variant.draw(&DrawOptions { rasterizer, size, ..variant.options(subject.as_ref()) });
    let [scanline, edge, tiled] =
        [RasterizerChoice::Scanline, RasterizerChoice::Exact, RasterizerChoice::Tiled].map(picture);
    // In double precision the coverage is the same, and colors differ only where a border of texels is near.
    let off = differing(&edge, &tiled, 1);
    if off > 40 + size.0 as usize {
        return Some(format!("{}: {off} pixels differ from the exact rasterizer", variant.name));
    }
    // The book's rule puts pixels elsewhere, by less than one. Where texels are smaller than pixels, that shows.
    let (off, pixels) = (displaced(&scanline, &edge), size.0 as usize * size.1 as usize);
    (off > pixels / 25).then(|| format!("{}: scanline shows what is not near in {off} pixels", variant.name))
}

/// How many pixels have a channel that differs by more than `by`.
fn differing(a: &Framebuffer, b: &Framebuffer, by: u8) -> usize {
    let rows = a.rows_from_top().zip(b.rows_from_top()).filter(|(a, b)| a != b);
    rows.flat_map(|(a, b)| a.iter().zip(b))
        .filter(|(a, b)| a != b && a.channels().iter().zip(b.channels()).any(|(a, b)| a.abs_diff(b) > by))
        .count()
}

/// How many pixels of a picture have a channel that is darker or brighter, by more than 2, than all of the other
/// picture's pixels there and next to it.
fn displaced(picture: &Framebuffer, other: &Framebuffer) -> usize {
    let rect = picture.rect();
    let is_displaced = |&(x, y): &(i32, i32)| {
        let color = picture.get(x, y).expect("inside");
        let there = other.get(x, y).expect("of the same size");
        let [color, there] = if color == there { return false } else { [color.channels(), there.channels()] };
        if color.iter().zip(there).all(|(a, b)| a.abs_diff(b) <= 2) {
            return false;
        }
        let near = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
        let around: Vec<_> = near.filter_map(|(x, y)| other.get(x, y)).map(Color::channels).collect();
        (0..3).any(|k| {
            let channels = || around.iter().map(|color| color[k]);
            let (least, most) = (channels().min().expect("itself"), channels().max().expect("itself"));
            !(least.saturating_sub(2)..=most.saturating_add(2)).contains(&color[k])
        })
    };
    rect.pixels().filter(is_displaced).count()
}
