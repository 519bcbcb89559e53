//! **Rasterbook**: a software renderer in eleven programs that teaches how 3D rendering works.
//!
//! # A first picture
//!
//! A cube with a color for each vertex, in perspective, with a depth buffer:
//!
//! ```
//! use rasterbook::exact::Exact;
//! use rasterbook::glam::{DVec3, dvec3};
//! use rasterbook::transform::{Frustum, about, rotate_x_to_z, rotate_z_to_y};
//! use rasterbook::{ClipVertex, LoadOp, Mesh, RenderState, Silent, Target, draw, shader};
//!
//! // Eight vertices, and two triangles for each of the six sides.
//! let vertex = |i: u32| dvec3((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
//! let sides = [[0, 1, 3, 2], [5, 4, 6, 7], [4, 0, 2, 6], [1, 5, 7, 3], [2, 3, 7, 6], [4, 5, 1, 0]];
//! let triangles = sides.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
//! let cube = Mesh::indexed((0..8).map(vertex).collect(), triangles)?;
//!
//! // Turned about its middle, and seen from the origin: +x is right, +y is up, +z is away from us.
//! let camera = Frustum::from_field_of_view(0.7, 4.0 / 3.0, 1.0, 10.0);
//! let turn = about(DVec3::splat(0.5), rotate_z_to_y(0.6) * rotate_x_to_z(0.7));
//! let colored = shader::from_fn(
//!     |&vertex: &DVec3| {
//!         let view = turn.transform_point3(vertex) + dvec3(-0.5, -0.5, 3.0);
//!         ClipVertex { position: camera.project(view), varyings: vertex.to_array() }
//!     },
//!     |color: [f64; 3]| color.map(|channel| 55.0 + 200.0 * channel),
//! );
//!
//! let mut target = Target::new(640, 480);
//! let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
//! draw(&cube, &colored, &state, &Exact::new(), &mut target, &Silent);
//!
//! // A PPM file needs nothing else; with the feature `files` there is `target.color.save("cube.png")`.
//! target.color.write_ppm(std::fs::File::create(std::env::temp_dir().join("cube.ppm"))?)?;
//! # let colors = |x, y| target.color.get(x, y).expect("inside");
//! # assert_ne!(colors(320, 240), colors(0, 0), "something is in the middle");
//! # let picture = target.color.rows_from_top().flatten().collect::<std::collections::HashSet<_>>();
//! # assert!(picture.len() > 1000, "{} colors", picture.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! | feature | what it brings |
//! |---|---|
//! | none | the renderer: all of chapters 1 to 10, and the exact rasterizer |
//! | `tiled` | the fast rasterizer: eight numbers at a time, several threads |
//! | `files` | models and textures from files, pictures into files |
//! | `jpeg` | textures from JPEG files, too; with `files` |
//! | `figure` | the chapters' figures: their tables, the canvas, the history of a pixel; with `files` |
//! | `program` | what the eleven programs share: arguments, animations; with `figure` and `jpeg` |
//! | `window` | a live window, `--window`; with `program` |
//!
//! `program` and `tiled` are on by default; a renderer in a program of your own needs neither:
//! `rasterbook = { version = "0.1", default-features = false, features = ["files"] }`.
//!
//! # The rooms
//!
//! Every pixel is drawn by code in this library, on the CPU, and every room of it is met in the order of the book:
//!
//! ```text
//!   vertices ──► clip space ──► clipped polygon ──► NDC ──► screen ──► spans ──► fragments ──► framebuffer
//!
//!   ch1  color         what one pixel shows
//!   ch1  rect          rectangles of pixels
//!   ch1  framebuffer   a plane of pixels: addressing, clearing, saving
//!   ch2  scissor       the pixels that a stage may emit
//!   ch2  line          DDA: emits pixels through a callback
//!   ch2  area          signed area, which side of an edge, winding
//!   ch2  scanline      split, walk the edges, emit spans: coverage only, no color
//!   ch3  real          the numbers that interpolation is written for
//!   ch3  payload       what goes along with the walk by equal steps
//!   ch3  interpolate   barycentric weights; (ch5) affine and perspective-correct interpolation
//!   ch3  texture       texels, address modes, bilinear filter
//!   ch4  transform     projection, (ch8) frustum, viewport, (ch10) matrices
//!   ch6  depth         encodings, the test, a depth for each pixel
//!   ch6  target        color and depth planes
//!   ch7  clip          signed distance to a plane, Sutherland–Hodgman, clip volumes, the divide
//!   ch9  mesh          vertex and index buffers, primitive assembly
//!   ch9  cull          which side of a triangle is seen
//!   ch9  varyings      weights corrected by ω, derivatives
//!   ch9  shader        the Shader trait: attributes → clip space, varyings → color
//!   ch9  merge         depth test, blending, rounding, writing
//!   ch9  state         RenderState: the options of all stages
//!   ch9  probe         what the pipeline reports on the way to a pixel
//!   ch9  fragment      what is done with a fragment: shading, merging, reporting
//!   ch9  raster        the trait of all rasterizers; the book's scanline rasterizer
//!   ch9  pipeline      draw(): the stages in their order
//!   ch9  swap_chain    front and back buffer, present
//!   ch10 light         ambient, Lambert, Phong, Blinn–Phong, normal maps
//!   ch10 mipmap        smaller copies of a texture, levels of detail
//!   ch11 files         what is wrong with a file; textures from image files
//!   ch11 model         models (OBJ) from files, with the normals that they lack
//!   more save          pictures into image files
//!   more srgb          what the numbers of a picture mean as light
//!   more exact         the exact rasterizer; (ch2, 3, 5) edge functions, the top-left rule, several samples in a pixel
//!   more tiled         the fast rasterizer: the same picture by tiles, lanes and threads
//!   …    figure        a chapter's table, the canvas, pictures made of pictures, assets
//!   …    inspect       the history of a pixel, steps, overdraw
//!   …    live          a figure that is turned and looked at: events change it, a pure function draws it
//!   …    program       what the eleven `main`s share; nothing above imports it
//! ```
//!
//! Beside the data flow are `observer`, for those who watch how a picture comes about, and `plane`, its memory. They can
//! be skipped at first. A room imports only rooms above it: a reader who takes them in this order meets nothing that is
//! explained later.
//!
//! Data flows one way. A stage hands its results to the next through a callback, so that an early chapter can call
//! a stage by itself. Coverage (which pixels), interpolation (which values) and writing (which colors) are three rooms.
//!
//! # Conventions
//!
//! - Camera space is left-handed: +x right, +y up, +z into the screen.
//! - The framebuffer's origin is at the bottom left and y points up; image files have their first row on top.
//! - Pixels sit on integer coordinates; a span runs from `trunc(start)` while `x ≤ end`, rows from `trunc(y₁)` while
//!   `y < y₂`. This is the book's rule.
//! - ω, the fourth component of a projected point, is the distance along the camera's z axis.
//! - Everything is computed in `f64`, in a fixed order, without fused or reassociated arithmetic: the pictures are the
//!   same on every machine.
//! - A mistake that a chapter discusses is a value of an option, never a copy of the code. The default is the right one.

// docs.rs says of each item which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
// The order of the modules is the order of the book; rustfmt would sort them by name. A test holds each of them to it:
// a room imports only rooms that stand above it.
#![cfg_attr(rustfmt, rustfmt_skip)]

pub mod color;
pub mod rect;
pub mod observer;
mod plane;
pub mod framebuffer;
pub mod scissor;
pub mod line;
pub mod area;
pub mod scanline;
pub mod real;
pub mod payload;
pub mod interpolate;
pub mod texture;
pub mod transform;
pub mod depth;
pub mod target;
pub mod clip;
pub mod mesh;
pub mod cull;
pub mod varyings;
pub mod shader;
pub mod merge;
pub mod state;
pub mod probe;
mod fragment;
pub mod raster;
pub mod pipeline;
pub mod swap_chain;
pub mod light;
pub mod mipmap;
#[cfg(feature = "files")]
pub mod files;
#[cfg(feature = "files")]
pub mod model;
#[cfg(feature = "files")]
mod save;
pub mod srgb;
pub mod exact;
#[cfg(feature = "tiled")]
pub mod tiled;
#[cfg(feature = "figure")]
pub mod figure;
#[cfg(feature = "figure")]
pub mod inspect;
#[cfg(feature = "figure")]
pub mod live;
#[cfg(feature = "program")]
pub mod program;

pub use clip::ClipVertex;
pub use color::Color;
pub use framebuffer::Framebuffer;
pub use mesh::Mesh;
pub use pipeline::draw;
pub use probe::Silent;
pub use raster::Scanline;
pub use real::Real;
pub use rect::{Pixel, Rect};
pub use shader::{Shaded, Shader};
pub use state::{LoadOp, RenderState};
pub use target::Target;

pub use glam;
