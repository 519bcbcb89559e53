//! **Rasterbook**: a software renderer in eleven programs that teaches how 3D rendering works.
//!
//! Every pixel is drawn by code in this library, on the CPU, and every room of it is met in the order of the book:
//!
//! ```text
//!   vertices ──► clip space ──► clipped polygon ──► NDC ──► screen ──► spans ──► fragments ──► framebuffer
//!
//!   ch1  framebuffer   a plane of pixels: addressing, clearing
//!   ch2  line          DDA: emits pixels through a callback
//!   ch2  area          signed area, which side of an edge, winding
//!   ch2  scanline      sort, split, walk the edges, emit spans: coverage only, no color
//!   ch3  real          the numbers that interpolation is written for
//!   ch3  interpolate   barycentric weights, affine and perspective-correct interpolation
//!   ch3  texture       texels, address modes, bilinear filter
//!   ch4  transform     projection, (ch8) frustum, viewport, (ch10) matrices
//!   ch6  depth         encodings, the test, the target: color and depth
//!   ch7  clip          signed distance to a plane, Sutherland–Hodgman, clip volumes, the divide
//!   ch9  cull          which side of a triangle is seen
//!   ch9  mesh          vertex and index buffers, primitive assembly
//!   ch9  shader        the Shader trait: attributes → clip space, varyings → color
//!   ch9  merge         depth test, blending, writing
//!   ch9  probe         who wants to know what happens to a pixel
//!   ch9  raster        the door of all rasterizers; the book's scanline rasterizer
//!   ch9  pipeline      RenderState and draw(): the stages in their order
//!   ch9  swap_chain    front and back buffer, present
//!   ch11 light         ambient, Lambert, Phong, Blinn–Phong, normal maps
//!   ch11 files         what is wrong with a file; textures from image files
//!   ch11 model         models (OBJ) from files
//!   more mipmap        smaller copies of a texture, levels of detail
//!   more srgb          what the numbers of a picture mean as light
//!   more varyings      weights corrected by ω, derivatives
//!   more edge          edge functions, pixel centers, the top-left rule
//!   more exact         the exact rasterizer
//!   more antialias     several samples in each pixel
//!   more lanes         eight numbers at a time
//!   more tiled         the fast rasterizer: the same picture by tiles, lanes and threads
//!   …    program       what the eleven `main`s share; nothing above imports it
//! ```
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

// The order of the modules is the order of the book; rustfmt would sort them by name.
#![cfg_attr(rustfmt, rustfmt_skip)]

mod plane;
pub mod framebuffer;
pub mod line;
pub mod area;
pub mod scanline;
pub mod real;
pub mod interpolate;
pub mod texture;
pub mod transform;
pub mod depth;
pub mod clip;
pub mod cull;
pub mod mesh;
pub mod shader;
pub mod merge;
pub mod probe;
pub mod raster;
pub mod pipeline;
pub mod swap_chain;
pub mod light;
pub mod mipmap;
pub mod srgb;
pub mod varyings;
pub mod edge;
pub mod exact;
pub mod antialias;
#[cfg(feature = "tiled")]
pub mod lanes;
#[cfg(feature = "tiled")]
pub mod tiled;
#[cfg(feature = "files")]
pub mod files;
#[cfg(feature = "files")]
pub mod model;

#[cfg(feature = "program")]
pub mod program;

pub use framebuffer::{Color, Framebuffer, Rect};
