//! Image files, decoded: their size is judged before there is memory for it, and they come out as they are meant to be seen.

use std::io::Cursor;
use std::path::Path;

use image::metadata::Orientation;
use image::{
    DynamicImage, ImageBuffer, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, Pixel, Rgba,
};

use super::guard::guarded;
use super::orientation::{exif_of_png, of_exif};
use super::{FileError, MAX_TEXELS};
use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::texture::Texture;

/// The most pixels that a byte of an image file can stand for. A header that claims more is wrong.
fn max_pixels_a_byte(bytes: &[u8], format: ImageFormat) -> u64 {
    match format {
        // A run of 128 pixels in two bytes.
        ImageFormat::Tga => 64,
        // A bit for eight times eight pixels.
        ImageFormat::Jpeg => 8 * 64,
        ImageFormat::Pnm => 8,
        ImageFormat::Bmp if !is_run_length(bytes) => 8,
        // Eight pixels a byte, and 1032 such bytes packed into one; with runs, BMP files leave out what is background.
        _ => 8 * 1032,
    }
}

/// Whether the pixels of a BMP file are runs: how they are compressed is told by four bytes.
fn is_run_length(bytes: &[u8]) -> bool {
    matches!(bytes.get(30..34), Some([1 | 2, 0, 0, 0]))
}

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
    let most = (bytes.len() as u64).saturating_mul(max_pixels_a_byte(bytes, format));
    let judge = |size| {
        check_size(size, max_texels).map_err(|cause| FileError::new(path, cause))?;
        let ((width, height), length) = (size, bytes.len());
        if u64::from(width) * u64::from(height) > most {
            let claim = format!("claims {width}×{height} pixels, which cannot be in {length} bytes");
            return Err(FileError::new(path, claim));
        }
        Ok(())
    };
    let image = match format {
        #[cfg(feature = "jpeg")]
        ImageFormat::Jpeg => super::jpeg::decode(bytes, path, judge),
        _ => decode(bytes, format, path, judge),
    };
    Ok((texture_of(image?), format))
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
    let decoder = guarded(path, || reader.into_decoder().map_err(failure))?;
    judge(decoder.dimensions())?;
    let mut image = guarded(path, || DynamicImage::from_decoder(decoder).map_err(failure))?;
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
fn check_size((width, height): (u32, u32), max_texels: u64) -> Result<(), String> {
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
fn texture_of(image: DynamicImage) -> Texture {
    let (width, height) = (image.width(), image.height());
    Texture::new(width, height, into_texels(image))
}

/// Texel by texel from what was decoded: a copy in between would be as large again.
fn into_texels(image: DynamicImage) -> Vec<Color> {
    match image {
        DynamicImage::ImageLuma8(image) => texels(&image),
        DynamicImage::ImageLumaA8(image) => texels(&image),
        DynamicImage::ImageRgb8(image) => texels(&image),
        DynamicImage::ImageRgba8(image) => texels(&image),
        deeper => texels(&deeper.into_rgba8()),
    }
}

fn texels<P: Pixel<Subpixel = u8>>(image: &ImageBuffer<P, Vec<u8>>) -> Vec<Color> {
    let over_white = |pixel: &P| {
        let Rgba([r, g, b, a]) = pixel.to_rgba();
        Color::rgb(over_white(r, a), over_white(g, a), over_white(b, a))
    };
    image.rows().rev().flatten().map(over_white).collect()
}

/// A channel over white, by its alpha, rounded to nearest.
fn over_white(channel: u8, alpha: u8) -> u8 {
    let [channel, alpha] = [channel, alpha].map(u32::from);
    ((channel * alpha + 255 * (255 - alpha) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

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
        let texture = texture_of(image.into());
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
        // 64 pixels a byte: what ends too early is not found out by the size that is claimed.
        claim[12..16].copy_from_slice(&[41, 0, 64, 0]);
        assert!(!refused(&claim, MAX_TEXELS).contains("claims"));
        claim[12..16].copy_from_slice(&[41, 0, 65, 0]);
        assert!(refused(&claim, MAX_TEXELS).contains("claims 41×65 pixels"));
    }

    #[test]
    fn how_many_pixels_are_in_a_byte() {
        let mut bmp = [0; 34];
        assert_eq!(max_pixels_a_byte(&bmp, ImageFormat::Bmp), 8, "a bit each");
        assert_eq!(max_pixels_a_byte(&bmp, ImageFormat::Pnm), 8, "a bit each");
        assert_eq!(max_pixels_a_byte(&bmp, ImageFormat::Tga), 128 / 2, "a run of 128 in two bytes");
        assert_eq!(max_pixels_a_byte(&bmp, ImageFormat::Jpeg), 512, "a bit for a block of 8×8");
        bmp[30] = 1;
        let packed = [ImageFormat::Bmp, ImageFormat::Png].map(|format| max_pixels_a_byte(&bmp, format));
        assert_eq!(packed, [8256; 2], "runs, or bytes that are packed again");
    }

    #[test]
    fn the_largest_image_is_accepted() {
        let side = Framebuffer::MAX_SIDE;
        for size in [(side, 1), (1, side), (8192, 8192)] {
            assert_eq!(check_size(size, MAX_TEXELS), Ok(()));
        }
        for size in [(side + 1, 1), (1, side + 1)] {
            assert!(check_size(size, MAX_TEXELS).is_err_and(|told| told.contains("no side may have more")));
        }
        assert!(check_size((0, 5), MAX_TEXELS).is_err_and(|told| told == "has no pixels"));
        assert!(check_size((8193, 8192), MAX_TEXELS).is_err_and(|told| told.contains("are allowed")));
        assert_eq!(check_size((2, 2), 4), Ok(()), "as many as are left");
        let largest = MAX_TEXELS * size_of::<[u16; 4]>() as u64;
        assert_eq!((limits().max_alloc, limits().max_image_width), (Some(largest), Some(side)));
    }

    #[test]
    fn a_png_file_is_turned_as_it_says() {
        let mut bytes = Cursor::new(Vec::new());
        RgbImage::new(2, 1).write_to(&mut bytes, ImageFormat::Png).expect("two pixels");
        let mut bytes = bytes.into_inner();
        // Behind the header: the EXIF data of a camera that was held upright.
        let exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0";
        let chunk = [b"\0\0\0\x16eXIf".as_slice(), exif, &0xB74A_E384_u32.to_be_bytes()].concat();
        bytes.splice(33..33, chunk);
        let (texture, _) = decode_within(&bytes, "a.png".as_ref(), 2).expect("a picture");
        assert_eq!((texture.width(), texture.height()), (1, 2));
    }
}
