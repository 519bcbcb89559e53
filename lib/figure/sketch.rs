//! Diagrams: lines that are thick enough to be seen, dots, bars and numbers, in the coordinates of a scene.

use glam::{DVec2, dvec2};

use super::fit::Fit;
use super::glyphs::{DOT, LABEL_HEIGHT, digits, label_width};
use crate::color::Color;
use crate::exact::edge::Coverage;
use crate::framebuffer::Framebuffer;
use crate::rect::{Pixel, Rect};

/// Draws a diagram into a picture: places, widths and radii are the scene's.
///
/// ```
/// use rasterbook::figure::{Fit, Sketch};
/// use rasterbook::glam::dvec2;
/// use rasterbook::{Color, Framebuffer};
///
/// let mut picture = Framebuffer::new(64, 48);
/// let fit = Fit::new(picture.rect(), [640.0, 480.0]);
/// let mut sketch = Sketch::new(&mut picture, fit);
/// sketch.line(dvec2(100.0, 200.0), dvec2(400.0, 200.0), 20.0, Color::RED);
/// sketch.dot(dvec2(400.0, 200.0), 50.0, Color::WHITE);
/// assert_eq!(picture.get(20, 20), Some(Color::RED));
/// assert_eq!(picture.get(40, 23), Some(Color::WHITE));
/// ```
#[derive(Debug)]
pub struct Sketch<'a> {
    /// The picture.
    pub framebuffer: &'a mut Framebuffer,
    /// How the scene lies in it.
    pub fit: Fit,
    /// The part of the picture outside which nothing is drawn.
    pub part: Rect,
}

impl<'a> Sketch<'a> {
    /// A sketch in the whole of a picture.
    #[must_use]
    pub const fn new(framebuffer: &'a mut Framebuffer, fit: Fit) -> Self {
        let part = framebuffer.rect();
        Self { framebuffer, fit, part }
    }

    /// The same in a part of it.
    #[must_use]
    pub const fn within(self, part: Rect) -> Self {
        Self { part, ..self }
    }

    /// A line between two points, at least a pixel wide; none if they are the same, or as far away as
    /// [`Self::triangle`] does not draw.
    pub fn line(&mut self, a: DVec2, b: DVec2, width: f64, color: Color) {
        for triangle in stroke([a, b], width.max(1.0 / self.fit.scale)) {
            self.triangle(triangle, color);
        }
    }

    /// A triangle: the pixels whose centers are inside. None if a vertex is not finite, or farther than 65,536 pixels from
    /// the lower left one of the picture.
    pub fn triangle(&mut self, triangle: [DVec2; 3], color: Color) {
        let Some(coverage) = Coverage::new(triangle.map(|vertex| self.fit.at(vertex))) else { return };
        let scissor = self.framebuffer.scissor().within(self.part);
        coverage.pixels(scissor).for_each(|(x, y, _)| self.framebuffer.set(x, y, color));
    }

    /// A disk around a point: the pixels whose centers are no farther from it than the radius; none if that is negative.
    pub fn dot(&mut self, center: DVec2, radius: f64, color: Color) {
        let (center, radius) = (self.fit.at(center), radius * self.fit.scale);
        let [(left, bottom), (right, top)] = [center - radius, center + radius].map(pixel);
        let around = Rect { left, bottom, right: right.saturating_add(1), top: top.saturating_add(1) };
        let around = around.intersection(self.framebuffer.rect()).intersection(self.part);
        for (x, y) in around.pixels() {
            let pixel = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5);
            if radius >= 0.0 && pixel.distance_squared(center) <= radius * radius {
                self.framebuffer.set(x, y, color);
            }
        }
    }

    /// A rectangle from its lower left to its upper right vertex, its borders on whole pixels; one that is not a number
    /// is 0.
    pub fn bar(&mut self, lower_left: DVec2, upper_right: DVec2, color: Color) {
        let border = |point| pixel(self.fit.at(point).round());
        let [(left, bottom), (right, top)] = [lower_left, upper_right].map(border);
        let bar = Rect { left, bottom, right, top };
        self.framebuffer.fill(bar.intersection(self.part), color);
    }

    /// A number, its middle at a point, each dot of a digit at least a pixel.
    pub fn number(&mut self, number: u32, middle: DVec2, color: Color) {
        let text = number.to_string();
        let dot = (f64::from(DOT) * self.fit.scale).round().max(1.0) as i32;
        let half = |length: i32| (length / DOT).saturating_mul(dot) / 2;
        let (x, y) = pixel(self.fit.at(middle).round());
        let [left, bottom] =
            [(x, label_width(&text)), (y, LABEL_HEIGHT)].map(|(at, length)| at.saturating_sub(half(length)));
        for square in digits(&text, (left, bottom), dot) {
            self.framebuffer.fill(square.intersection(self.part), color);
        }
    }
}

/// The pixel in which a point of the picture lies.
fn pixel(point: DVec2) -> Pixel {
    (point.x.floor() as i32, point.y.floor() as i32)
}

/// The two triangles that a line of some width is made of; its ends are cut off at right angles. Without area if the points
/// are the same, or so near or far that the square of their distance is 0 or infinite.
///
/// ```text
///      ┌──────────────┐ ┐
///    a │ ·  ·  ·  ·  ·│ b     width
///      └──────────────┘ ┘
/// ```
#[must_use]
pub fn stroke([a, b]: [DVec2; 2], width: f64) -> [[DVec2; 3]; 2] {
    let aside = (b - a).perp().normalize_or_zero() * (width / 2.0);
    [[a - aside, b - aside, b + aside], [a - aside, b + aside, a + aside]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(fit_to: [f64; 2], draw: impl FnOnce(&mut Sketch<'_>)) -> Vec<String> {
        let mut picture = Framebuffer::new(12, 8);
        let fit = Fit::new(picture.rect(), fit_to);
        draw(&mut Sketch::new(&mut picture, fit));
        let mark = |x, y| if picture.get(x, y) == Some(Color::WHITE) { '#' } else { '.' };
        (0..8).rev().map(|y| (0..12).map(|x| mark(x, y)).collect()).collect()
    }

    #[test]
    fn a_line_has_its_width_and_no_seam() {
        let level =
            drawn([12.0, 8.0], |sketch| sketch.line(dvec2(2.0, 3.0), dvec2(9.0, 3.0), 2.0, Color::WHITE));
        let count = level.iter().flat_map(|row| row.chars()).filter(|mark| *mark == '#').count();
        assert_eq!((level[4].as_str(), level[5].as_str()), ("..#######...", "..#######..."));
        assert_eq!(count, 14);

        let thin = drawn([1200.0, 800.0], |sketch| {
            sketch.line(DVec2::ZERO, dvec2(1200.0, 800.0), 1.0, Color::WHITE);
        });
        assert!((0..12).all(|x| thin.iter().any(|row| row.as_bytes()[x] == b'#')), "{thin:#?}");
    }

    #[test]
    fn dots_bars_and_numbers_lie_where_they_should() {
        let dot = drawn([12.0, 8.0], |sketch| sketch.dot(dvec2(6.0, 4.0), 2.0, Color::WHITE));
        let expected = [".....##.....", "....####....", "....####....", ".....##....."];
        assert_eq!(dot[2..6], expected);
        let one = drawn([12.0, 8.0], |sketch| sketch.dot(dvec2(6.5, 4.5), 0.9, Color::WHITE));
        assert_eq!((one[3].as_str(), one.concat().matches('#').count()), ("......#.....", 1));
        let half = drawn([24.0, 16.0], |sketch| sketch.dot(dvec2(12.0, 8.0), 4.0, Color::WHITE));
        assert_eq!(half, dot, "the scene's radius");
        // From 4.3 to 8.7, and from 2.3 to 6.7: its last column and row, too.
        let dot = drawn([12.0, 8.0], |sketch| sketch.dot(dvec2(6.5, 4.5), 2.2, Color::WHITE));
        let expected = ["......#.....", ".....###....", "....#####...", ".....###....", "......#....."];
        assert_eq!(dot[1..6], expected);

        let bar = drawn([24.0, 16.0], |sketch| sketch.bar(dvec2(2.0, 2.0), dvec2(8.0, 4.0), Color::WHITE));
        assert_eq!((bar[5].as_str(), bar[6].as_str()), ("............", ".###........"));

        // Half the size: each dot of a digit is a pixel.
        let seven = drawn([24.0, 16.0], |sketch| sketch.number(7, dvec2(12.0, 8.0), Color::WHITE));
        assert_eq!((seven[1].as_str(), seven[5].as_str()), (".....###....", "......#....."));
    }

    #[test]
    fn a_dot_of_a_negative_radius_is_none() {
        let dot =
            |radius| drawn([12.0, 8.0], |sketch| sketch.dot(dvec2(3.5, 4.5), radius, Color::WHITE)).concat();
        assert_eq!([0.3, 0.0, -0.3].map(|radius| dot(radius).matches('#').count()), [1, 1, 0]);
    }

    #[test]
    fn a_line_is_two_triangles_with_right_angles() {
        let [a, b] = [dvec2(1.0, 2.0), dvec2(4.0, 6.0)];
        // Five long, and 2.5 to each side.
        let aside = dvec2(-2.0, 1.5);
        let expected = [[a - aside, b - aside, b + aside], [a - aside, b + aside, a + aside]];
        let near = |(a, b): (&DVec2, &DVec2)| a.distance(*b) < 1e-12;
        let stroke = stroke([a, b], 5.0);
        assert!(stroke.as_flattened().iter().zip(expected.as_flattened()).all(near), "{stroke:?}");
    }

    #[test]
    fn the_middle_of_a_number_is_where_it_should_be() {
        let box_of = |scale: f64| {
            let mut picture = Framebuffer::new(40, 30);
            let fit = Fit::new(picture.rect(), [40.0 / scale, 30.0 / scale]);
            Sketch::new(&mut picture, fit).number(20, dvec2(20.0, 15.0) / scale, Color::WHITE);
            let inked = |&(x, y): &Pixel| picture.get(x, y) == Some(Color::WHITE);
            let inked: Vec<Pixel> = picture.rect().pixels().filter(inked).collect();
            let ends = |of: fn(&Pixel) -> i32| [inked.iter().map(of).min(), inked.iter().map(of).max()];
            [ends(|pixel| pixel.0), ends(|pixel| pixel.1)].map(|ends| ends.map(|end| end.expect("ink")))
        };
        // Two digits of three columns and five rows with a column between them, each dot a pixel, two, or four.
        let [columns, rows] = [label_width("20"), LABEL_HEIGHT].map(|length| length / DOT);
        for (scale, dot) in [(0.5, 1), (1.0, 2), (2.0, 4)] {
            let [width, height] = [columns * dot, rows * dot];
            let from = [20 - width / 2, 15 - height / 2];
            let expected = [[from[0], from[0] + width - 1], [from[1], from[1] + height - 1]];
            assert_eq!(box_of(scale), expected, "{scale}");
        }
    }

    #[test]
    fn nothing_is_drawn_outside_its_part() {
        let part = Rect { left: 3, bottom: 2, right: 5, top: 4 };
        let mut picture = Framebuffer::new(12, 8);
        let fit = Fit::new(picture.rect(), [12.0, 8.0]);
        let mut sketch = Sketch::new(&mut picture, fit).within(part);
        sketch.line(dvec2(-5.0, 3.0), dvec2(90.0, 3.0), 9.0, Color::RED);
        sketch.dot(dvec2(4.0, 4.0), 9.0, Color::RED);
        sketch.bar(dvec2(0.0, 0.0), dvec2(12.0, 8.0), Color::RED);
        let all = picture.rect();
        for (x, y) in all.pixels() {
            assert_eq!(picture.get(x, y) == Some(Color::RED), part.contains(x, y), "({x}, {y})");
        }
    }
}
