//! A picture in characters: two pixels in each cell.
//!
//! ```text
//!   ┌────┐
//!   │████│  foreground: the upper pixel
//!   │    │  background: the lower pixel
//!   └────┘
//! ```

use super::fit::light;
use super::terminal::Colors;
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::srgb::encode;

/// A row of cells for each two rows of pixels. Each ends without color, and with a new line.
pub(super) fn blocks(picture: &Framebuffer, colors: Colors) -> Vec<u8> {
    let rows: Vec<&[Color]> = picture.rows_from_top().collect();
    let mut text = String::new();
    for pair in rows.chunks(2) {
        let (upper, lower) = (pair[0], pair.get(1).copied());
        match colors {
            Colors::None => shade_row(&mut text, upper, lower),
            Colors::All | Colors::Cube => color_row(&mut text, upper, lower, colors),
        }
        text.push('\n');
    }
    text.into_bytes()
}

/// Foreground and background of each cell where they change. The lower half of the last row may have no pixels.
fn color_row(text: &mut String, upper: &[Color], lower: Option<&[Color]>, colors: Colors) {
    let mut current = [None, None];
    for (x, &color) in upper.iter().enumerate() {
        let wanted = [Some(color), lower.map(|row| row[x])];
        let changes = (0..2).filter(|&k| wanted[k] != current[k]).filter_map(|k| {
            // Selects the foreground, or the background.
            wanted[k].map(|color| format!("{}8;{}", 3 + k, selected(color, colors)))
        });
        let changes = changes.collect::<Vec<_>>().join(";");
        if !changes.is_empty() {
            text.push_str(&format!("\x1b[{changes}m"));
        }
        text.push('▀');
        current = wanted;
    }
    text.push_str("\x1b[0m");
}

/// How a color is called.
fn selected(color: Color, colors: Colors) -> String {
    if colors == Colors::Cube {
        return format!("5;{}", nearest_of_256(color));
    }
    let [red, green, blue] = color.channels();
    format!("2;{red};{green};{blue}")
}

/// The values of a channel in the cube of 6 × 6 × 6 colors, which are those from 16 on.
const CUBE: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// The nearest of the 256 colors. The first 16 are not used: each user has others.
fn nearest_of_256(color: Color) -> u8 {
    let channels = color.channels();
    let steps = channels.map(|channel| nearest((0..6).map(|step| (step, CUBE[usize::from(step)])), channel));
    let in_cube = steps.map(|step| CUBE[usize::from(step)]);
    // 24 grays from 232 on: 8, 18, …, 238.
    let mean = channels.iter().map(|&channel| u16::from(channel)).sum::<u16>() / 3;
    let step = nearest((0..24).map(|step| (step, 8 + 10 * step)), mean as u8);
    let distance = |other: [u8; 3]| -> u32 {
        other.iter().zip(channels).map(|(a, b)| u32::from(a.abs_diff(b)) * u32::from(a.abs_diff(b))).sum()
    };
    if distance([8 + 10 * step; 3]) < distance(in_cube) {
        232 + step
    } else {
        16 + 36 * steps[0] + 6 * steps[1] + steps[2]
    }
}

/// The step whose value is nearest.
fn nearest(steps: impl Iterator<Item = (u8, u8)>, value: u8) -> u8 {
    steps.min_by_key(|(_, of_step)| of_step.abs_diff(value)).map_or(0, |(step, _)| step)
}

/// From nothing to a full cell: on a dark terminal from black to white.
const SHADES: [char; 5] = [' ', '░', '▒', '▓', '█'];

fn shade_row(text: &mut String, upper: &[Color], lower: Option<&[Color]>) {
    for (x, &color) in upper.iter().enumerate() {
        let below = lower.map_or(color, |row| row[x]);
        let brightness = (luminance(color) + luminance(below)) / 2.0;
        let [stored, ..] = encode([brightness; 3]);
        text.push(SHADES[(stored / 255.0 * 4.0 + 0.5) as usize]);
    }
}

/// The light of a color as an eye weighs it, 0..=1.
fn luminance(color: Color) -> f64 {
    let [red, green, blue] = light(color);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rows: &[&[Color]]) -> Framebuffer {
        let mut picture = Framebuffer::new(rows[0].len() as u32, rows.len() as u32);
        for (row, y) in rows.iter().rev().zip(0..) {
            for (&color, x) in row.iter().zip(0..) {
                picture.set(x, y, color);
            }
        }
        picture
    }

    fn text(rows: &[&[Color]], colors: Colors) -> String {
        String::from_utf8(blocks(&picture(rows), colors)).expect("UTF-8")
    }

    #[test]
    fn two_pixels_in_a_cell() {
        let rows: &[&[Color]] = &[&[Color::RED, Color::GREEN], &[Color::BLUE, Color::rgb(1, 2, 3)]];
        assert_eq!(
            text(rows, Colors::All),
            "\x1b[38;2;255;0;0;48;2;0;0;255m▀\x1b[38;2;0;255;0;48;2;1;2;3m▀\x1b[0m\n"
        );
        assert_eq!(text(rows, Colors::Cube), "\x1b[38;5;196;48;5;21m▀\x1b[38;5;46;48;5;16m▀\x1b[0m\n");
    }

    #[test]
    fn only_what_changes_is_said() {
        let rows: &[&[Color]] =
            &[&[Color::RED; 3], &[Color::BLUE, Color::GREEN, Color::GREEN], &[Color::RED; 3]];
        assert_eq!(
            text(rows, Colors::All),
            "\x1b[38;2;255;0;0;48;2;0;0;255m▀\x1b[48;2;0;255;0m▀▀\x1b[0m\n\x1b[38;2;255;0;0m▀▀▀\x1b[0m\n",
            "and the last row has no lower half"
        );
    }

    #[test]
    fn the_256_colors() {
        for (color, number) in [
            (Color::BLACK, 16),
            (Color::WHITE, 231),
            (Color::rgb(95, 135, 175), 67),
            (Color::rgb(100, 130, 180), 67),
            (Color::gray(8), 232),
            (Color::gray(130), 244),
            (Color::rgb(127, 129, 128), 244),
            (Color::gray(240), 255),
            (Color::rgb(0, 40, 90), 17),
        ] {
            assert_eq!(nearest_of_256(color), number, "{color:?}");
        }
    }

    #[test]
    fn shades_without_colors() {
        let grays = [0, 60, 128, 190, 255].map(Color::gray);
        assert_eq!(text(&[&grays, &grays], Colors::None), " ░▒▓█\n");
        let colors = [Color::GREEN, Color::RED, Color::BLUE];
        assert_eq!(text(&[&colors, &colors], Colors::None), "▓▒░\n", "as bright as eyes see them");
        assert_eq!(text(&[&[Color::WHITE], &[Color::BLACK]], Colors::None), "▓\n", "half of the light");
        assert_eq!(text(&[&[Color::WHITE]], Colors::None), "█\n", "one half is all there is");
    }
}
