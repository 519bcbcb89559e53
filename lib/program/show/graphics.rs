//! Terminals that take pictures.
//!
//! Sources: kitty, *Terminal graphics protocol*; iTerm2, *Inline Images Protocol*; Digital Equipment Corporation, *VT330/VT340
//! Programmer Reference Manual*, volume 2, chapter 14 (sixels).

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageError, ImageFormat};

use crate::framebuffer::Framebuffer;
use crate::program::palette::Indexed;
use crate::save::encode;

/// The pixels of a cell where the terminal fits the picture into cells: a usual size. Nothing tells the true one.
pub(super) const CELL: (u32, u32) = (10, 20);

/// The pixels of a cell where the picture takes as many pixels as it has: so small that it fits with the smallest fonts.
pub(super) const SMALL_CELL: (u32, u32) = (6, 12);

/// The most pixels of a side as sixels: xterm cuts off more.
pub(super) const MOST_SIXELS: u32 = 1000;

/// The most characters in one of kitty's sequences.
const CHUNK: usize = 4096;

/// By kitty's protocol. It is told the columns only, and finds the rows itself by the aspect, since it knows its cells.
/// `q=2`: it is not to answer.
pub(super) fn kitty(picture: &Framebuffer, (columns, _): (u32, u32)) -> Result<Vec<u8>, ImageError> {
    let text = STANDARD.encode(encode(picture, ImageFormat::Png)?);
    let mut bytes = Vec::new();
    let mut control = format!("a=T,f=100,q=2,c={columns},");
    let mut rest = text.as_bytes();
    while !rest.is_empty() {
        let (chunk, after) = rest.split_at(rest.len().min(CHUNK));
        let more = u8::from(!after.is_empty());
        bytes.extend(format!("\x1b_G{control}m={more};").bytes());
        bytes.extend(chunk);
        bytes.extend(b"\x1b\\");
        control.clear();
        rest = after;
    }
    bytes.push(b'\n');
    Ok(bytes)
}

/// As an inline image of iTerm2, which fits it into the cells and keeps its aspect.
pub(super) fn iterm(picture: &Framebuffer, (columns, rows): (u32, u32)) -> Result<Vec<u8>, ImageError> {
    let png = encode(picture, ImageFormat::Png)?;
    let text = STANDARD.encode(&png);
    let size = png.len();
    let file = format!("inline=1;size={size};width={columns};height={rows};preserveAspectRatio=1");
    Ok(format!("\x1b]1337;File={file}:{text}\x07\n").into_bytes())
}

/// As sixels: bands of six rows. In each band, color by color, a character says which of the six pixels of a column have
/// this color.
///
/// ```text
///   ESC P q  "1;1;w;h           pixels as wide as high, and how many
///            #0;2;100;0;0 …     the palette: number, 2 for RGB, percents
///            #0!12~ $           color 0: 12 columns of six pixels; $ goes back to the left
///            #3!6?@ $ -         color 3: 6 columns of none, one of the top pixel; - goes to the next band
///   ESC \
/// ```
pub(super) fn sixel(picture: &Framebuffer) -> Vec<u8> {
    let Indexed { palette, pixels } = Indexed::new(picture);
    let width = picture.width() as usize;
    let mut text = format!("\x1bP0;1q\"1;1;{width};{}", picture.height());
    for (number, channels) in palette.iter().enumerate() {
        let [red, green, blue] = channels.map(|channel| (u32::from(channel) * 100 + 127) / 255);
        text.push_str(&format!("#{number};2;{red};{green};{blue}"));
    }
    for (number, band) in pixels.chunks(6 * width).enumerate() {
        text.push_str(if number > 0 { "-" } else { "" });
        // For each color that is in the band, the six pixels of each column as bits, the top one first.
        let mut columns: Vec<Vec<u8>> = vec![Vec::new(); palette.len()];
        for (row, pixels) in band.chunks(width).enumerate() {
            for (x, &color) in pixels.iter().enumerate() {
                let of_color = &mut columns[usize::from(color)];
                of_color.resize(width, 0);
                of_color[x] |= 1 << row;
            }
        }
        for (number, columns) in columns.iter().enumerate().filter(|(_, columns)| !columns.is_empty()) {
            text.push_str(&format!("#{number}"));
            for run in columns.chunk_by(|a, b| a == b) {
                let sixel = char::from(b'?' + run[0]);
                match run.len() {
                    count @ ..4 => text.extend(std::iter::repeat_n(sixel, count)),
                    count => text.push_str(&format!("!{count}{sixel}")),
                }
            }
            text.push('$');
        }
    }
    text.push_str("\x1b\\\n");
    text.into_bytes()
}

#[cfg(test)]
pub(super) mod tests {
    use image::{Rgb, RgbImage};

    use super::*;
    use crate::Color;

    /// What kitty is told, and the picture that it gets.
    pub(in crate::program::show) fn kitty_parts(bytes: &[u8]) -> (String, RgbImage) {
        let text = std::str::from_utf8(bytes).expect("ASCII");
        let sequences: Vec<(&str, &str)> = text
            .strip_suffix("\x1b\\\n")
            .expect("a fresh line")
            .split("\x1b\\")
            .map(|sequence| {
                sequence.strip_prefix("\x1b_G").and_then(|it| it.split_once(';')).expect("a sequence")
            })
            .collect();
        for (i, (control, chunk)) in sequences.iter().enumerate() {
            assert!(chunk.len() <= 4096 && chunk.len() % 4 == 0);
            let is_last = i + 1 == sequences.len();
            assert!(control.ends_with(if is_last { "m=0" } else { "m=1" }), "{control}");
        }
        let png =
            STANDARD.decode(sequences.iter().map(|(_, chunk)| *chunk).collect::<String>()).expect("base64");
        (sequences[0].0.to_owned(), image::load_from_memory(&png).expect("a picture").to_rgb8())
    }

    /// Takes the number with which the text begins.
    fn number(text: &mut &str) -> u32 {
        let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let (number, rest) = text.split_at(end);
        *text = rest;
        number.parse().expect("a number")
    }

    /// The picture that sixels show, as a terminal reads them.
    pub(in crate::program::show) fn pixels_of_sixel(bytes: &[u8]) -> RgbImage {
        let text = std::str::from_utf8(bytes).expect("ASCII");
        let text = text.strip_prefix("\x1bP0;1q\"1;1;").and_then(|text| text.strip_suffix("\x1b\\\n"));
        let mut rest = text.expect("sixels");
        let width = number(&mut rest);
        rest = &rest[1..];
        let mut image = RgbImage::new(width, number(&mut rest));
        let (mut palette, mut color, mut x, mut top) = (std::collections::BTreeMap::new(), 0, 0, 0);
        while let Some(character) = rest.chars().next() {
            rest = &rest[1..];
            match character {
                '#' => {
                    color = number(&mut rest);
                    if let Some(mut percents) = rest.strip_prefix(";2") {
                        let channels = [(); 3].map(|()| {
                            percents = &percents[1..];
                            ((number(&mut percents) * 255 + 50) / 100) as u8
                        });
                        rest = percents;
                        palette.insert(color, Rgb(channels));
                    }
                }
                '$' => x = 0,
                '-' => (x, top) = (0, top + 6),
                _ => {
                    let count = if character == '!' { number(&mut rest) } else { 1 };
                    let sixel =
                        if character == '!' { rest.chars().next().expect("a sixel") } else { character };
                    rest = if character == '!' { &rest[1..] } else { rest };
                    for column in x..x + count {
                        for row in (0..6).filter(|row| (u32::from(sixel) - 63) >> row & 1 == 1) {
                            image.put_pixel(column, top + row, palette[&color]);
                        }
                    }
                    x += count;
                }
            }
        }
        image
    }

    #[test]
    fn these_sixels() {
        let mut picture = Framebuffer::new(3, 7);
        picture.clear(Color::RED);
        picture.set(1, 6, Color::BLUE);
        let expected = "\x1bP0;1q\"1;1;3;7#0;2;0;0;100#1;2;100;0;0#0?@?$#1~}~$-#1@@@$\x1b\\\n";
        assert_eq!(String::from_utf8(sixel(&picture)).expect("ASCII"), expected);
        let expected = "\x1bP0;1q\"1;1;4;1#0;2;0;0;0#0!4@$\x1b\\\n";
        assert_eq!(String::from_utf8(sixel(&Framebuffer::new(4, 1))).expect("ASCII"), expected);
    }

    #[test]
    fn a_large_picture_goes_in_chunks() {
        let mut picture = Framebuffer::new(200, 100);
        for (x, y) in (0..100).flat_map(|y| (0..200).map(move |x| (x, y))) {
            picture.set(x, y, Color::rgb((x * x + y) as u8, (x * y) as u8, (y * y * 3 + x) as u8));
        }
        let bytes = kitty(&picture, (20, 5)).expect("PNG");
        assert!(bytes.len() > 2 * CHUNK && bytes.starts_with(b"\x1b_Ga=T,f=100,q=2,c=20,m=1;"));
        let (_, image) = kitty_parts(&bytes);
        assert_eq!(image.into_raw(), picture.rgb_from_top());
    }

    #[test]
    fn an_inline_image() {
        let bytes = iterm(&Framebuffer::new(20, 20), (2, 1)).expect("PNG");
        let text = String::from_utf8(bytes).expect("ASCII");
        let (head, image) = text.split_once(':').expect("a picture");
        let png = STANDARD.decode(image.strip_suffix("\x07\n").expect("an end")).expect("base64");
        let file = format!("inline=1;size={};width=2;height=1;preserveAspectRatio=1", png.len());
        assert_eq!(head, format!("\x1b]1337;File={file}"));
        assert_eq!(image::load_from_memory(&png).expect("a picture").to_rgb8().dimensions(), (20, 20));
    }
}
