//! # Chapters 10 and 11: matrices and light
//!
//! **How does a thing get its place, and its light and shade?** A matrix moves, turns and projects; the matrices of
//! many steps are multiplied once, and one product takes every vertex to where it is seen. How bright it is,
//! the angle between its surface and the light says.
//!
//! New here: matrices (`lib/transform.rs`), light (`lib/light.rs`), models and textures from files (`lib/model.rs`, `lib/files.rs`).
//! The figures (`directions.rs` is what they share): `matrices.rs`, `lit.rs`, `shading.rs`, `textures.rs`,
//! `walls.rs`, `spaces.rs`, `still_life.rs`, `turntable.rs`. Book: chapters 10 and 11.

mod directions;
mod lit;
mod matrices;
mod shading;
mod spaces;
mod still_life;
mod textures;
mod turntable;
mod walls;

use std::process::ExitCode;

use rasterbook::figure::{Animation, Chapter, Variant};

/// 360 frames, a degree each.
const TURN: Animation = Animation { frames: 360, rate: 30 };

/// The camera goes round once, 3 degrees a frame.
const ORBIT: Animation = Animation { frames: 120, rate: 24 };

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch10_matrices_lighting",
    question: "How does a thing get its place, and its light and shade?",
    variants: &[
        Variant::with_pipeline("still-life", still_life::still_life, "pawns and a ball on a polished board, everything at once: perspective, textures with mip maps, light, depth, and a board that is blended over its reflections")
            .tiled().size(768, 432).animated(ORBIT).knobs(still_life::KNOBS),
        Variant::of_model("turntable", turntable::turntable, ["cube.obj", "letters.png"], "a model seen from the upper right and lit from the left: three sides, three brightnesses; made for a --model of your own")
            .tiled().animated(ORBIT).fits_model().knobs(turntable::KNOBS),
        Variant::of_model("lit", lit::lit, ["pawn.obj", "wood.png"], "a model turns in the light: bright where it faces the light, never black; a few specks are seams that the scanline fill leaves open, or first texels where u ends at 1")
            .source("sections 11.1 to 11.3").animated(TURN).knobs(lit::KNOBS),
        Variant::with_pipeline("rotation", matrices::rotation, "a triangle turns about a vertical axis, a degree a frame; it vanishes when we see its back")
            .source("section 10.6").animated(TURN).knobs(matrices::ROTATION),
        Variant::with_pipeline("pivot", matrices::pivot, "nine arrows, each turned by 10° more, dark to bright: left about the origin (the white dot), right about the arrow's own middle")
            .source("section 10.5").size(800, 400).knobs(matrices::PIVOT),
        Variant::with_pipeline("camera", matrices::camera, "two boxes, a ball and a pawn on bricks, seen from the upper right by a look-at matrix: the eye looks down, and vertical edges lean outwards").exact().knobs(matrices::CAMERA),
        Variant::of_model("spikes", lit::spikes, ["sphere.obj", "numbers.png"], "short dashes of wrong color on the ball: texels from beyond a triangle, fetched with t past an edge's end; try --zoom 4 --compare")
            .source("section 11.4").animated(TURN).remedied_by("spikes-fixed").knobs(lit::KNOBS),
        Variant::of_model("spikes-fixed", lit::lit, ["sphere.obj", "numbers.png"], "the same ball with t clamped on the edges: nearly all dashes are gone; where u ends at 1, a first texel is left here and there")
            .source("section 11.4").animated(TURN).knobs(lit::KNOBS),
        Variant::of_model("exact", lit::lit, ["sphere.obj", "numbers.png"], "the same ball by the exact rasterizer: no value is ever stepped past an edge, and no dash is left")
            .exact().animated(TURN).knobs(lit::KNOBS),
        Variant::with_pipeline("normals-wrong", shading::normals_wrong, "a flattened ball, its normals turned by the model matrix: they lean to the sides, and the light does not fit the shape")
            .remedied_by("normals").exact().knobs(shading::NORMALS),
        Variant::with_pipeline("normals", shading::normals, "the same ball, its normals turned by the inverse transpose: they are perpendicular to the surface, and the top is bright").exact().knobs(shading::NORMALS),
        Variant::with_pipeline("flat", shading::flat, "one normal a face: every face of the coarse ball (left) shows, and of the fine one (right) still many").exact().knobs(shading::TWO_BALLS),
        Variant::with_pipeline("gouraud", shading::gouraud, "light computed at the vertices: smooth, but the highlight of the coarse ball has corners of its own").exact().knobs(shading::TWO_BALLS),
        Variant::with_pipeline("phong", shading::phong, "light computed at every pixel: a round highlight on the coarse ball too; the broad one below ends in a hard edge").exact().knobs(shading::HIGHLIGHTS),
        Variant::with_pipeline("blinn-phong", shading::blinn_phong, "the same with the half vector: the broad highlight below has no edge within the lit side").exact().knobs(shading::HIGHLIGHTS),
        Variant::with_pipeline("distance", shading::distance, "above: parallel light, five balls alike; below: a lamp in front of the first ball, its light falls off with the square of the distance").exact().knobs(shading::DISTANCE),
        Variant::with_pipeline("nearest", textures::nearest, "a brick floor to the horizon, the nearest texel for each pixel: blocks in front, and far away false patterns, moiré").exact().knobs(textures::EYE),
        Variant::with_pipeline("bilinear", textures::bilinear, "four texels mixed: smooth in front, the false patterns far away stay").exact().knobs(textures::EYE),
        Variant::with_pipeline("mipmapped", textures::mipmapped, "smaller copies of the texture far away: no false pattern; look for the lines where one copy ends and the next begins").exact().knobs(textures::EYE_AND_BIAS),
        Variant::with_pipeline("trilinear", textures::trilinear, "two copies mixed: no line is left; seen at a flat angle, all is blurred more than need be").exact().knobs(textures::EYE_AND_BIAS),
        Variant::with_pipeline("mip-levels", textures::mip_levels, "which copy is used where: red the texture itself, then orange, yellow, green, …, each half as large").exact().knobs(textures::EYE_AND_BIAS),
        Variant::with_pipeline("address-modes", textures::address_modes, "texture coordinates far beyond 0 to 1, three floors: clamped (the border is drawn out), repeated, mirrored (every other copy is reversed)").exact().knobs(textures::COPIES),
        Variant::with_pipeline("normal-mapped", walls::normal_mapped, "two flat walls under one lamp: the left one has one normal, the right one has a normal for every texel, and its bricks stand out")
            .source("first note").exact().knobs(walls::KNOBS),
        Variant::with_pipeline("gamma-space", spaces::gamma_space, "light computed with encoded values: the ball darkens too soon, red and green meet in mud, and the mean of black and white is darker than fine stripes of both")
            .exact().remedied_by("linear-space").knobs(spaces::KNOBS),
        Variant::with_pipeline("linear-space", spaces::linear_space, "the same in linear light: a half-lit ball, a bright middle between red and green, and a mean as bright as the stripes")
            .exact().knobs(spaces::KNOBS),
    ],
};

/// An angle in radians from degrees.
fn degrees(angle: f64) -> f64 {
    angle * std::f64::consts::PI / 180.0
}

fn main() -> ExitCode {
    CHAPTER.main()
}
