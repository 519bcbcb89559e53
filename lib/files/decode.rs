//! Image files, decoded: their size is judged before there is memory for it, and they come out as they are meant to be seen.

use std::io::Cursor;
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, Rgb, Rgba};

use super::orientation::{exif_of_png, of_exif};
use super::{FileError, MAX_TEXELS};
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::texture::Texture;

/// The most pixels that a byte of an image file can stand for: a PNG file of one bit a pixel, packed as far as its
/// compression can. A header that claims more is wrong.
const MAX_PIXELS_A_BYTE: u64 = 8 * 1032;

/// Decodes an image of no more than `max_texels` pixels.
pub(super) fn decode_within(
    bytes: &[u8],
    path: &Path,
    max_texels: u64,
) -> Result<(Texture, ImageFormat), FileError> {
    if bytes.is_empty() {
        return Err(FileError::new(path, "is empty"));
    }
    let guessed = image::guess_format(bytes).or_else(|_| ImageFormat::from_path(path));
    let format = guessed
        .ok()
        .filter(|format| READABLE.contains(format))
        .ok_or_else(|| FileError::new(path, "is no image that can be read here (PNG, BMP, TGA, JPEG)"))?;
    let judge =
        |size| check_size(size, bytes.len() as u64, max_texels).map_err(|cause| FileError::new(path, cause));
    let image = match format {
        #[cfg(feature = "jpeg")]
        ImageFormat::Jpeg => super::jpeg::decode(bytes, path, judge),
        _ => decode(bytes, format, path, judge),
    };
    Ok((texture_of(&image?), format))
}

/// Decodes PNG, BMP, TGA and PNM files, if `judge` lets their size pass, and turns them as they say.
fn decode(
    bytes: &[u8],
    format: ImageFormat,
    path: &Path,
    judge: impl Fn((u32, u32)) -> Result<(), FileError>,
) -> Result<DynamicImage, FileError> {
    let failure = |error: ImageError| FileError::from_source(path, error);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let decoder = reader.into_decoder().map_err(failure)?;
    judge(decoder.dimensions())?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(failure)?;
    if format == ImageFormat::Png {
        image.apply_orientation(exif_of_png(bytes).map_or(Orientation::NoTransforms, of_exif));
    }
    Ok(match (format, bytes.get(17)) {
        (ImageFormat::Tga, Some(&descriptor)) => as_tga_says(image, descriptor),
        _ => image,
    })
}

const READABLE: &[ImageFormat] = &[
    ImageFormat::Png,
    ImageFormat::Bmp,
    ImageFormat::Tga,
    #[cfg(feature = "jpeg")]
    ImageFormat::Jpeg,
    ImageFormat::Pnm,
];

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(Framebuffer::MAX_SIDE);
    limits.max_image_height = Some(Framebuffer::MAX_SIDE);
    // Four channels of 16 bits.
    limits.max_alloc = Some(8 * MAX_TEXELS);
    limits
}

/// Judges the size that a header claims, before there is memory for it.
fn check_size((width, height): (u32, u32), bytes: u64, max_texels: u64) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err("has no pixels".to_owned());
    }
    let side = Framebuffer::MAX_SIDE;
    if width > side || height > side {
        return Err(format!(
            "exceeds limits: {width}×{height} pixels, but no side may have more than {side}"
        ));
    }
    if pixels > max_texels {
        let limit = if max_texels == MAX_TEXELS {
            format!("{MAX_TEXELS} are allowed")
        } else {
            format!("all textures of a model may have {MAX_TEXELS}, of which {max_texels} are left")
        };
        return Err(format!("exceeds limits: {width}×{height} are {pixels} pixels; {limit}"));
    }
    if pixels > bytes.saturating_mul(MAX_PIXELS_A_BYTE) {
        return Err(format!("claims {width}×{height} pixels, which cannot be in {bytes} bytes"));
    }
    Ok(())
}

/// What the descriptor of a TGA file says and the decoder (`image` 0.25.6) does not do: bit 4, the first pixel of a row is
/// the right one; bits 0 to 3, how many bits of a pixel are its alpha.
fn as_tga_says(image: DynamicImage, descriptor: u8) -> DynamicImage {
    let image = if descriptor & 0x10 == 0 { image } else { image.fliph() };
    if descriptor & 0x0f == 0 { image.into_rgb8().into() } else { image }
}

/// An image, whose first row is on top, as a texture, whose first row is at the bottom. What is transparent shows white
/// beneath it: the color of the material then tints it, so that the surface has that color there.
fn texture_of(image: &DynamicImage) -> Texture {
    let (width, height) = (image.width(), image.height());
    let texels = if image.color().has_alpha() {
        let pixels = image.to_rgba8();
        pixels
            .rows()
            .rev()
            .flatten()
            .map(|&Rgba([r, g, b, a])| Color::rgb(over_white(r, a), over_white(g, a), over_white(b, a)))
            .collect()
    } else {
        let pixels = image.to_rgb8();
        pixels.rows().rev().flatten().map(|&Rgb([r, g, b])| Color::rgb(r, g, b)).collect()
    };
    Texture::new(width, height, texels)
}

/// A channel over white, by its alpha, rounded to nearest.
fn over_white(channel: u8, alpha: u8) -> u8 {
    let [channel, alpha] = [channel, alpha].map(u32::from);
    ((channel * alpha + 255 * (255 - alpha) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_of_an_image_file_is_the_first_of_a_texture() {
        // Red above green.
        let image = RgbImage::from_fn(1, 2, |_, row| Rgb(if row == 0 { [255, 0, 0] } else { [0, 255, 0] }));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).expect("two pixels");
        let (texture, _) = decode_within(bytes.get_ref(), "a.png".as_ref(), MAX_TEXELS).expect("a picture");
        let at = |v: f64| Color::truncated(texture.nearest([0.5, v], crate::texture::AddressMode::Clamp));
        assert_eq!((at(0.25), at(0.75)), (Color::GREEN, Color::RED), "v points up");
    }

    /// A TGA file of 2×2 pixels: 1 2 above 3 4 as they are seen, blue, with 8 more bits that may be alpha.
    fn tga(descriptor: u8) -> Vec<u8> {
        let mut bytes = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, descriptor];
        let [mut rows, is_right] = [[[1, 2], [3, 4]], [[u8::from(descriptor & 0x10 != 0); 2]; 2]];
        if descriptor & 0x20 == 0 {
            rows.reverse();
        }
        for mut row in rows {
            if is_right[0][0] == 1 {
                row.reverse();
            }
            bytes.extend(row.iter().flat_map(|&blue| [blue, 0, 0, 0]));
        }
        bytes
    }

    #[test]
    fn wherever_a_tga_file_begins() {
        for descriptor in [0, 0x10, 0x20, 0x30] {
            let (texture, _) = decode_within(&tga(descriptor), "a.tga".as_ref(), 4).expect("four pixels");
            let texels = [(0, 1), (1, 1), (0, 0), (1, 0)].map(|(x, y)| texture.texel(x, y)[2]);
            assert_eq!(texels, [1.0, 2.0, 3.0, 4.0], "{descriptor:#x}");
        }
        let (texture, _) = decode_within(&tga(0x28), "a.tga".as_ref(), 4).expect("four pixels");
        assert_eq!(texture.texel(0, 0), [255.0; 3], "transparent: white");
    }

    #[test]
    fn transparent_texels_are_white() {
        let pixels = [[255, 0, 255, 0], [100, 0, 200, 255], [0, 0, 0, 51], [255, 0, 0, 128]];
        let image = image::RgbaImage::from_fn(4, 1, |x, _| Rgba(pixels[x as usize]));
        let texture = texture_of(&image.into());
        let texels: Vec<_> = (0..4).map(|x| texture.texel(x, 0)).collect();
        assert_eq!(texels, [[255.0; 3], [100.0, 0.0, 200.0], [204.0; 3], [255.0, 127.0, 127.0]]);
    }

    #[test]
    fn a_header_is_judged_before_there_is_memory() {
        // A TGA file of 41 bytes that claims 8000×8000 pixels.
        let mut claim = tga(0x20);
        claim.resize(41, 0);
        claim[12..16].copy_from_slice(&[0x40, 0x1f, 0x40, 0x1f]);
        let refused = |bytes: &[u8], most| {
            decode_within(bytes, "a.tga".as_ref(), most).expect_err("refused").to_string()
        };
        assert!(refused(&claim, MAX_TEXELS).contains("claims 8000×8000 pixels, which cannot be in 41 bytes"));
        claim[12..16].copy_from_slice(&[0xff, 0x2f, 0xff, 0x2f]);
        assert!(refused(&claim, MAX_TEXELS).contains("67108864 are allowed"));
        claim[12..16].copy_from_slice(&[0, 0, 5, 0]);
        assert!(
            refused(&claim, MAX_TEXELS).contains("has no pixels")
                || refused(&claim, MAX_TEXELS).contains("dimension")
        );
        assert!(refused(&tga(0), 3).contains("of which 3 are left"));
    }
}
