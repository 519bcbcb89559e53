//! The eleven programs: each knows of the ten others, so that what is asked of the wrong one can be found. A test holds
//! this list to the chapters' tables.

/// A program: its name, and the names of its variants.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// The name of the program.
    pub name: &'static str,
    /// What its chapter asks.
    pub question: &'static str,
    /// The names of its variants, in their order.
    pub variants: &'static [&'static str],
}

/// All programs, in the order of the book.
pub const PROGRAMS: [Program; 11] = [
    Program {
        name: "ch01_pixels",
        question: "How does a program put a picture on a screen?",
        variants: &["pawn", "pixel", "digit", "subpixels"],
    },
    Program {
        name: "ch02_dda_lines",
        question: "Which pixels belong to a line between two points?",
        variants: &["star", "line", "broken", "wireframe"],
    },
    Program {
        name: "ch02_triangles",
        question: "Which pixels belong to a triangle?",
        variants: &[
            "split",
            "flat",
            "overshoot",
            "clamped",
            "shared-edge",
            "top-left",
            "bounding-box",
            "one-sample",
            "supersampled",
            "supersampled-16",
            "multisampled",
            "facets",
        ],
    },
    Program {
        name: "ch03_barycentric",
        question: "The corners have values: which value has a pixel between them?",
        variants: &["weights", "areas", "rgb", "gray", "texture", "spikes", "limited-edges", "limited"],
    },
    Program {
        name: "ch04_projection",
        question: "Why is small what is far away?",
        variants: &["cube", "orthographic", "rails", "near"],
    },
    Program {
        name: "ch05_perspective_correct",
        question: "Why does a texture bend when a surface is tilted?",
        variants: &[
            "floor",
            "correct",
            "affine",
            "facing",
            "square",
            "reciprocal",
            "barycentric",
            "floor-affine",
        ],
    },
    Program {
        name: "ch06_z_buffer",
        question: "Which surface is in front?",
        variants: &[
            "intersecting",
            "z-buffer",
            "painter",
            "painter-red-first",
            "painter-green-first",
            "depth",
            "w-buffer",
            "uncleared",
            "cleared",
        ],
    },
    Program {
        name: "ch07_clipping",
        question: "What if a triangle reaches behind the eye?",
        variants: &["in-front", "near", "reciprocal", "behind", "polygon"],
    },
    Program {
        name: "ch08_cvv",
        question: "What of the world gets into the picture?",
        variants: &["clipped", "ndc", "planes", "frustum", "divide-first", "clip-first", "zero-to-one"],
    },
    Program {
        name: "ch09_pipeline",
        question: "How is all this put together?",
        variants: &[
            "blended",
            "vbo",
            "cull-ccw",
            "cull-cw",
            "cull-none",
            "uncleared",
            "cleared",
            "double-buffer",
            "tearing",
            "presented",
            "indexed",
        ],
    },
    Program {
        name: "ch10_matrices_lighting",
        question: "How does a thing get its place, and its light and shade?",
        variants: &[
            "still-life",
            "turntable",
            "lit",
            "rotation",
            "pivot",
            "camera",
            "spikes",
            "spikes-fixed",
            "exact",
            "normals-wrong",
            "normals",
            "flat",
            "gouraud",
            "phong",
            "blinn-phong",
            "distance",
            "nearest",
            "bilinear",
            "mipmapped",
            "trilinear",
            "mip-levels",
            "address-modes",
            "normal-mapped",
            "gamma-space",
            "linear-space",
        ],
    },
];
