//! JPEG files, decoded.

use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, RgbImage};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::FileError;
use super::guard::guarded;
use super::orientation::of_exif;
use crate::framebuffer::Framebuffer;

/// Decodes JPEG files, and turns them upright by the orientation that a camera left in them (EXIF).
pub(super) fn decode(
    bytes: &[u8],
    path: &Path,
    judge: impl Fn((u32, u32)) -> Result<(), FileError>,
) -> Result<DynamicImage, FileError> {
    let failure = |error: DecodeErrors| FileError::from_source(path, error);
    let damaged = |cause: &str| FileError::new(path, cause);
    let side = Framebuffer::MAX_SIDE as usize;
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_strict_mode(false)
        .set_max_width(side)
        .set_max_height(side);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    guarded(path, || decoder.decode_headers().map_err(failure))?;
    let (width, height) = decoder.dimensions().ok_or_else(|| damaged("has no size"))?;
    let size = (width as u32, height as u32);
    judge(size)?;
    let pixels = guarded(path, || decoder.decode().map_err(failure))?;
    let image = RgbImage::from_raw(size.0, size.1, pixels).ok_or_else(|| damaged("has too few pixels"))?;
    let mut image = DynamicImage::from(image);
    image.apply_orientation(decoder.exif().map_or(Orientation::NoTransforms, |exif| of_exif(exif)));
    Ok(image)
}
