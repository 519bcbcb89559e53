//! A number for every picture, so that what different machines and builds draw can be compared.

use std::fmt::Write as _;

use rasterbook::figure::{Given, RasterizerChoice, Scene};

use crate::chapters::CHAPTERS;

/// Writes a line for each picture into the file that the environment variable FINGERPRINTS names: chapter, variant,
/// rasterizer, frame, fingerprint. Of animations the first, the middle and the last frame; where there is a choice, by all
/// rasterizers.
#[test]
#[ignore = "writes a list for the scripts that compare builds"]
fn list() {
    let path = std::env::var_os("FINGERPRINTS").expect("FINGERPRINTS names a file");
    let mut list = String::new();
    for (chapter, _) in CHAPTERS {
        for variant in chapter.variants {
            let mut scene = Scene::new(variant, &Given::default()).expect("its own model");
            let last = variant.animation.map_or(0, |animation| animation.frames - 1);
            let mut frames = vec![0, last / 2, last];
            frames.dedup();
            let own = [scene.rasterizer];
            let choices = if variant.rasterizer.is_some() { RasterizerChoice::ALL } else { &own };
            for (&rasterizer, frame) in choices.iter().flat_map(|c| frames.iter().map(move |f| (c, *f))) {
                (scene.rasterizer, scene.frame) = (rasterizer, frame);
                let (name, fingerprint) = (rasterizer.name(), scene.draw().fingerprint());
                let _ = writeln!(list, "{} {} {name} {frame} {fingerprint:016x}", chapter.name, variant.name);
            }
        }
    }
    std::fs::write(path, list).expect("the file can be written");
}
