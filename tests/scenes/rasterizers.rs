//! Every variant that the pipeline draws, by all three rasterizers.

use rasterbook::figure::{DrawOptions, RasterizerChoice};
use rasterbook::{Color, Framebuffer};

use crate::chapters::CHAPTERS;

#[test]
fn every_variant_of_the_pipeline() {
    for (chapter, _) in CHAPTERS {
        for variant in chapter.variants.iter().filter(|variant| variant.rasterizer.is_some()) {
            let subject = variant.subject().expect("assets");
            let picture =
                |rasterizer| variant.draw(&DrawOptions { rasterizer, ..variant.options(subject.as_ref()) });
            let [scanline, edge, tiled] =
                [RasterizerChoice::Scanline, RasterizerChoice::Exact, RasterizerChoice::Tiled].map(picture);
            let differ = |a: &Framebuffer, b: &Framebuffer, by: u8| {
                a.rows_from_top()
                    .flatten()
                    .zip(b.rows_from_top().flatten())
                    .filter(|(a, b)| a.channels().iter().zip(b.channels()).any(|(a, b)| a.abs_diff(b) > by))
                    .count()
            };
            // In double precision the coverage is the same, and colors differ only where a border of texels is near.
            let off = differ(&edge, &tiled, 1);
            assert!(
                off <= 40 + variant.size.0 as usize,
                "{}: {off} pixels differ from the exact rasterizer",
                variant.name
            );
            // The book's rule puts pixels elsewhere, by less than one. Where texels are smaller than pixels, that shows.
            let (off, pixels) =
                (displaced(&scanline, &edge), variant.size.0 as usize * variant.size.1 as usize);
            assert!(off <= pixels / 25, "{}: scanline shows what is not near in {off} pixels", variant.name);
        }
    }
}

/// How many pixels of a picture have a channel that is darker or brighter, by more than 2, than all of the other
/// picture's pixels there and next to it.
fn displaced(picture: &Framebuffer, other: &Framebuffer) -> usize {
    let rect = picture.rect();
    let is_displaced = |&(x, y): &(i32, i32)| {
        let color = picture.get(x, y).expect("inside").channels();
        let near = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
        let around: Vec<_> = near.filter_map(|(x, y)| other.get(x, y)).map(Color::channels).collect();
        (0..3).any(|k| {
            let channels = || around.iter().map(|color| color[k]);
            let (least, most) = (channels().min().expect("itself"), channels().max().expect("itself"));
            !(least.saturating_sub(2)..=most.saturating_add(2)).contains(&color[k])
        })
    };
    rect.rows().flat_map(|y| rect.columns().map(move |x| (x, y))).filter(is_displaced).count()
}
