//! Several samples in a pixel: jaggies become shades.

use glam::dvec2;
use rasterbook::exact::edge::{Coverage, Subpixel, center};
use rasterbook::exact::samples::{CENTER, GRID_2X2, GRID_4X4, Pattern, ROTATED_4, Samples};
use rasterbook::figure::{Knob, Knobs, picture};
use rasterbook::{Color, Framebuffer};

/// A triangle in space: x and y on the screen, and a depth; how it is painted.
struct Patch {
    vertices: [[f64; 3]; 3],
    paint: Paint,
}

enum Paint {
    Plain(Color),
    /// So many stripes from the first vertex to the opposite edge.
    Striped(f64, [Color; 2]),
}

impl Patch {
    fn color(&self, weight_of_first: f64) -> Color {
        match self.paint {
            Paint::Plain(color) => color,
            Paint::Striped(count, colors) => {
                let stripe = (weight_of_first * count).floor() as i64;
                colors[stripe.rem_euclid(2) as usize]
            }
        }
    }
}

/// How often the color of a pixel is computed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shading {
    /// For each sample, at its position.
    PerSample,
    /// Once, at the center of the pixel.
    PerPixel,
}

// ANCHOR: draw_samples
/// Draws a patch: coverage and depth for each sample, color as often as `shading` says.
fn draw(samples: &mut Samples<'_>, patch: &Patch, shading: Shading) {
    let coverage =
        Coverage::new(patch.vertices.map(|[x, y, _]| dvec2(x, y))).expect("a triangle with area");
    // The weights of the three vertices at a point of the screen.
    let weights = |place: Subpixel| {
        let [second, third]: [f64; 2] = coverage.weights(coverage.edge_values(place));
        [1.0 - second - third, second, third]
    };
    for (x, y) in samples.rect().pixels() {
        for (sample, place) in samples.of_pixel(x, y) {
            if coverage.covers(coverage.edge_values(place)) {
                let depth = (0..3).map(|i| weights(place)[i] * patch.vertices[i][2]).sum();
                let shaded_at = if shading == Shading::PerSample { place } else { center(x, y) };
                samples.draw(x, y, sample, depth, patch.color(weights(shaded_at)[0]));
            }
        }
    }
}
// ANCHOR_END: draw_samples

pub(super) const SCENE: &[Knob] = &[Knob::number(
    "shift",
    0.0,
    [0.0, 1.0],
    "pixels",
    "with one sample the dots of the spokes jump about, with more samples the spokes glide",
)];

// ANCHOR: samples_scene
/// A blue triangle and an orange one that pierce each other, narrow stripes, and thin spokes; all
/// of them are shifted to the right by a fraction of a pixel.
fn scene(framebuffer: &mut Framebuffer, pattern: &Pattern, shading: Shading, shift: f64) {
    let (blue, orange) = (Color::rgb(70, 120, 220), Color::rgb(240, 150, 50));
    let (light, dark) = (Color::rgb(230, 230, 220), Color::rgb(30, 40, 50));
    let mut patches = vec![
        Patch {
            vertices: [[3.0, 33.2, 1.0], [43.5, 30.1, 5.0], [12.4, 57.6, 3.0]],
            paint: Paint::Plain(blue),
        },
        Patch {
            vertices: [[6.2, 52.3, 4.5], [8.1, 27.9, 3.5], [40.3, 51.7, 2.5]],
            paint: Paint::Plain(orange),
        },
        Patch {
            vertices: [[22.0, 1.5, 1.0], [41.5, 26.3, 1.0], [1.6, 24.7, 1.0]],
            paint: Paint::Striped(38.0, [light, dark]),
        },
    ];
    for i in 0..9 {
        let (tip, root) =
            (dvec2(45.3, 3.4), dvec2(78.1 - 3.1 * f64::from(i), 9.0 + 5.7 * f64::from(i)));
        let aside = (root - tip).perp().normalize() * 0.75;
        let vertices = [tip, root - aside, root + aside].map(|point| [point.x, point.y, 1.0]);
        patches.push(Patch { vertices, paint: Paint::Plain(light) });
    }
    patches.iter_mut().flat_map(|patch| &mut patch.vertices).for_each(|vertex| vertex[0] += shift);
    picture::draw_enlarged(framebuffer, (80, 60), |screen| {
        let mut samples = Samples::like(screen, pattern);
        for patch in &patches {
            draw(&mut samples, patch, shading);
        }
        picture::paste(screen, &samples.resolved(), 0, 0);
    });
}
// ANCHOR_END: samples_scene

/// One sample in the middle.
pub(super) fn one_sample(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    scene(framebuffer, &CENTER, Shading::PerPixel, knobs.number("shift"));
}

/// 2×2 samples.
pub(super) fn supersampled(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    scene(framebuffer, &GRID_2X2, Shading::PerSample, knobs.number("shift"));
}

/// 4×4 samples.
pub(super) fn supersampled_16(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    scene(framebuffer, &GRID_4X4, Shading::PerSample, knobs.number("shift"));
}

/// Four samples, one color.
pub(super) fn multisampled(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    scene(framebuffer, &ROTATED_4, Shading::PerPixel, knobs.number("shift"));
}
