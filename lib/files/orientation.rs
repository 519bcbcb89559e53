//! How a camera was held (EXIF): which way up the pixels of a photograph are to be shown.
//!
//! EXIF data is a TIFF file of its own inside an image file. Of all that it may hold, one number is read here.
//!
//! ```text
//!   II* or MM*   first directory at      number of tags   tag 0x0112  type 3  count 1  the orientation, 1 to 8
//!   0            4                       there            12 bytes for each tag
//! ```
//!
//! Source: CIPA DC-008, Exchangeable image file format, 4.6.

use image::metadata::Orientation;

/// The orientation that EXIF data tells; upright if it tells none.
pub(super) fn of_exif(data: &[u8]) -> Orientation {
    let data = data.strip_prefix(b"Exif\0\0").unwrap_or(data);
    let number = orientation_number(data).and_then(|number| u8::try_from(number).ok());
    number.and_then(Orientation::from_exif).unwrap_or(Orientation::NoTransforms)
}

fn orientation_number(data: &[u8]) -> Option<u16> {
    let is_little = match data.get(..4)? {
        b"II*\0" => true,
        b"MM\0*" => false,
        _ => return None,
    };
    let u16_at = |at: usize| {
        let bytes = *data.get(at..)?.first_chunk()?;
        Some(if is_little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    };
    let bytes = *data.get(4..)?.first_chunk()?;
    let directory = if is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) } as usize;
    let count = usize::from(u16_at(directory)?);
    let mut tags = (0..count).map(|i| directory.saturating_add(2 + 12 * i));
    let tag = tags.find(|&at| u16_at(at) == Some(0x0112))?;
    u16_at(tag.saturating_add(8))
}

/// The EXIF data of a PNG file, in a chunk of its own.
pub(super) fn exif_of_png(bytes: &[u8]) -> Option<&[u8]> {
    let mut rest = bytes.get(8..)?;
    loop {
        let (length, after) = rest.split_first_chunk()?;
        let length = u32::from_be_bytes(*length) as usize;
        let (kind, after) = after.split_first_chunk::<4>()?;
        if kind == b"eXIf" {
            return after.get(..length);
        }
        rest = after.get(length.checked_add(4)?..)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// EXIF data with tags before the one that counts.
    fn exif(is_little: bool, orientation: u16) -> Vec<u8> {
        let short = |number: u16| if is_little { number.to_le_bytes() } else { number.to_be_bytes() };
        let long = |number: u32| if is_little { number.to_le_bytes() } else { number.to_be_bytes() };
        let mut data = if is_little { b"II*\0".to_vec() } else { b"MM\0*".to_vec() };
        data.extend(long(8));
        data.extend(short(3));
        for (tag, value) in [(0x0100, 9), (0x0101, 9), (0x0112, orientation)] {
            data.extend([short(tag), short(3)].concat());
            data.extend(long(1));
            data.extend([short(value), short(0)].concat());
        }
        data
    }

    #[test]
    fn eight_orientations_in_both_orders() {
        for is_little in [true, false] {
            assert_eq!(of_exif(&exif(is_little, 6)), Orientation::Rotate90);
            assert_eq!(of_exif(&exif(is_little, 3)), Orientation::Rotate180);
            assert_eq!(of_exif(&exif(is_little, 2)), Orientation::FlipHorizontal);
            assert_eq!(of_exif(&exif(is_little, 9)), Orientation::NoTransforms, "there is none such");
        }
        assert_eq!(of_exif(&[b"Exif\0\0".as_slice(), &exif(true, 8)].concat()), Orientation::Rotate270);
    }

    #[test]
    fn damaged_data_is_upright() {
        let data = exif(true, 6);
        for length in 0..data.len() - 4 {
            assert_eq!(of_exif(&data[..length]), Orientation::NoTransforms, "{length} bytes");
        }
        assert_eq!(of_exif(b"II*\0\xff\xff\xff\xff"), Orientation::NoTransforms);
    }

    #[test]
    fn a_chunk_of_a_png_file() {
        let png = [b"\x89PNG\r\n\x1a\n".as_slice(), b"\0\0\0\x01IHDR?crc!", b"\0\0\0\x02eXIfMMcrc!"].concat();
        assert_eq!(exif_of_png(&png), Some(b"MM".as_slice()));
        assert_eq!(exif_of_png(&png[..30]), None);
        assert_eq!(exif_of_png(b"\x89PNG\r\n\x1a\n\xff\xff\xff\xffIHDR"), None);
    }
}
