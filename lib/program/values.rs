//! The values of options: texts that are read, or refused with what is allowed.

use std::ffi::OsString;
use std::num::{IntErrorKind, ParseIntError};
use std::path::PathBuf;

use crate::figure::picture::Zoom;
use crate::framebuffer::Framebuffer;
use crate::rect::Pixel;

/// The most pixels that `--size` may ask for: a picture of 8192×8192.
const MAX_PIXELS: u64 = 1 << 26;

pub(super) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some((width.trim().parse::<u32>().ok()?, height.trim().parse::<u32>().ok()?))
    });
    let expected = || {
        format!("expected WIDTHxHEIGHT, whole numbers from 1 to {}, such as 640x480", Framebuffer::MAX_SIDE)
    };
    let (width, height) = sides.ok_or_else(expected)?;
    let allowed = 1..=Framebuffer::MAX_SIDE;
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(format!("each side must be 1 to {} pixels", Framebuffer::MAX_SIDE));
    }
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!("more than {MAX_PIXELS} pixels"));
    }
    Ok((width, height))
}

pub(super) fn parse_frame(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|error: ParseIntError| {
        let reason = match error.kind() {
            IntErrorKind::PosOverflow => "no animation has so many frames",
            _ => "expected a whole number from 0 on",
        };
        reason.to_owned()
    })
}

pub(super) fn parse_path(text: OsString) -> Result<PathBuf, &'static str> {
    // Rather an option whose value was forgotten in front of it than a file.
    if text != "-" && text.as_encoded_bytes().starts_with(b"-") {
        return Err("expected a path; in front of one that begins with a hyphen put ./");
    }
    if text.is_empty() { Err("expected a path") } else { Ok(PathBuf::from(text)) }
}

pub(super) fn parse_pixel(text: &str) -> Result<Pixel, String> {
    let coordinates = text
        .split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse::<i32>().ok()?, y.trim().parse::<i32>().ok()?)));
    coordinates.ok_or_else(|| "expected X,Y, a column and a row of the picture, such as 320,240".to_owned())
}

/// Two angles in degrees.
pub(super) fn parse_angles(text: &str) -> Result<[f64; 2], String> {
    let angle = |text: &str| text.trim().parse::<f64>().ok().filter(|angle| angle.is_finite());
    let angles = text.split_once(',').and_then(|(a, b)| Some([angle(a)?, angle(b)?]));
    angles.ok_or_else(|| "expected AZIMUTH,ELEVATION in degrees, such as 30,20".to_owned())
}

pub(super) fn parse_zoom(text: &str) -> Result<Zoom, String> {
    let (factor, center) = match text.split_once('@') {
        None => (text, None),
        Some((factor, pixel)) => {
            let center = parse_pixel(pixel).map_err(|_| "expected N@X,Y, such as 12@200,200")?;
            (factor, Some(center))
        }
    };
    let allowed = 1..=Zoom::MAX_FACTOR;
    let factor = factor.trim().parse::<u32>().ok().filter(|factor| allowed.contains(factor));
    let factor = factor.ok_or(format!("the factor must be a whole number from 1 to {}", Zoom::MAX_FACTOR))?;
    Ok(Zoom { factor, center })
}

/// A setting of a knob; which there are is known by the variant.
pub(super) fn parse_setting(text: &str) -> Result<String, String> {
    let is_setting = text.split_once('=').is_some_and(|(name, _)| !name.is_empty() && !name.starts_with('-'));
    is_setting
        .then(|| text.to_owned())
        .ok_or_else(|| "expected NAME=VALUE, such as tilt=60; --knobs lists them".to_owned())
}

/// A color, as a knob reads it.
pub(super) fn parse_color(text: &str) -> Result<String, String> {
    let is_color = !text.starts_with('-') && !text.is_empty();
    is_color.then(|| text.to_owned()).ok_or_else(|| "expected a color, RRGGBB, such as 203040".to_owned())
}

/// A name that is no option.
pub(super) fn parse_name(text: &str) -> Result<String, String> {
    let is_name = !text.is_empty() && !text.starts_with('-');
    is_name
        .then(|| text.to_owned())
        .ok_or_else(|| "expected a name, such as tilt; --knobs lists them".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(parse_size("640x480"), Ok((640, 480)));
        assert_eq!(parse_size("16384x1"), Ok((16384, 1)));
        for bad in
            ["", "640", "640x", "x480", "0x480", "-1x5", "640x480x3", "16385x1", "16384x16384", "1e3x5"]
        {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn paths() {
        for good in ["-", "./-x", "a b", "out/"] {
            assert_eq!(parse_path(good.into()), Ok(good.into()));
        }
        for bad in ["", "-x", "--all"] {
            assert!(parse_path(bad.into()).is_err(), "{bad}");
        }
    }

    #[test]
    fn zooms() {
        assert_eq!(parse_zoom("8"), Ok(Zoom { factor: 8, center: None }));
        assert_eq!(parse_zoom("12@3,-4"), Ok(Zoom { factor: 12, center: Some((3, -4)) }));
        for bad in ["", "0", "65", "x", "8@", "8@1", "8@1,2,3", "8@1;2"] {
            assert!(parse_zoom(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn knobs() {
        assert_eq!(parse_setting("tilt=60"), Ok("tilt=60".to_owned()));
        assert_eq!(parse_setting("paint=#00ff00"), Ok("paint=#00ff00".to_owned()));
        for bad in ["", "tilt", "=60", "--tilt=60"] {
            assert!(parse_setting(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_name("tilt"), Ok("tilt".to_owned()));
        assert!(parse_name("--compare").is_err() && parse_name("").is_err());
        assert_eq!(parse_angles("-30, 12.5"), Ok([-30.0, 12.5]));
        for bad in ["", "30", "30,", "a,b", "1,2,3", "nan,0", "inf,0"] {
            assert!(parse_angles(bad).is_err(), "{bad}");
        }
    }
}
