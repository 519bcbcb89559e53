//! Animations: all frames of a variant in one file. Frames are drawn in parallel, and written in their order.

use std::error::Error;
use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::prelude::*;

use super::output::AnimationFormat;
use super::palette::Indexed;
use crate::figure::Animation;
use crate::framebuffer::Framebuffer;

/// How much memory the frames that are drawn at a time may take.
const BATCH_BYTES: u64 = 1 << 28;

/// Draws a frame. Not generic: the encoders are compiled once.
pub(super) type Draw<'a> = &'a (dyn Fn(u32) -> Framebuffer + Sync);

/// Draws all frames and puts them into one file.
pub(super) fn encode(
    format: AnimationFormat,
    animation: Animation,
    draw: Draw<'_>,
) -> Result<Vec<u8>, Box<dyn Error>> {
    match format {
        AnimationFormat::Gif => encode_gif(animation, draw),
        AnimationFormat::Png => encode_png(animation, draw),
    }
}

/// Makes something of every frame, in parallel, and hands it on in order.
fn for_each_frame<T: Send>(
    frames: u32,
    (width, height): (u32, u32),
    make: impl Fn(u32) -> T + Sync,
    mut take: impl FnMut(T) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let progress = progress_bar(u64::from(frames), "frames");
    // Enough for every core, few enough to stay in memory.
    let batch = (BATCH_BYTES / (u64::from(width) * u64::from(height) * 16)).clamp(1, 32) as u32;
    for first in (0..frames).step_by(batch as usize) {
        let batch: Vec<T> = (first..frames.min(first + batch)).into_par_iter().map(&make).collect();
        for made in batch {
            take(made)?;
            progress.inc(1);
        }
    }
    progress.finish_and_clear();
    Ok(())
}

/// A progress bar on standard error; nothing if that is no terminal.
pub(super) fn progress_bar(length: u64, what: &'static str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len} {msg}, {eta} left");
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr()).with_message(what);
    let bar = match style {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    };
    // It shows itself now, and whenever something is done: a steady tick needs a thread, which may not be had.
    bar.tick();
    bar
}

fn encode_png(animation: Animation, draw: Draw<'_>) -> Result<Vec<u8>, Box<dyn Error>> {
    let (width, height) = size_of(&draw(0));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_animated(animation.frames, 0)?;
    encoder.set_frame_delay(1, u16::try_from(animation.rate)?)?;
    let mut writer = encoder.write_header()?;
    for_each_frame(
        animation.frames,
        (width, height),
        |frame| draw(frame).rgb_from_top(),
        |pixels| Ok(writer.write_image_data(&pixels)?),
    )?;
    writer.finish()?;
    Ok(bytes)
}

fn encode_gif(animation: Animation, draw: Draw<'_>) -> Result<Vec<u8>, Box<dyn Error>> {
    let (width, height) = size_of(&draw(0));
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, u16::try_from(width)?, u16::try_from(height)?, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    // GIF counts in hundredths of a second: of 30 frames a second two take 3, and the third 4.
    let shown_from = |frame: u32| frame * 100 / animation.rate;
    for_each_frame(
        animation.frames,
        (width, height),
        |frame| {
            let mut image = gif_frame(&draw(frame));
            image.delay = (shown_from(frame + 1) - shown_from(frame)) as u16;
            image.make_lzw_pre_encoded();
            image
        },
        |frame| Ok(encoder.write_lzw_pre_encoded_frame(&frame)?),
    )?;
    drop(encoder);
    Ok(bytes)
}

/// A frame with its own palette: exact for up to 256 colors.
fn gif_frame(picture: &Framebuffer) -> gif::Frame<'static> {
    let (width, height) = size_of(picture);
    let Indexed { palette, pixels } = Indexed::new(picture);
    gif::Frame::from_palette_pixels(width as u16, height as u16, pixels, palette.as_flattened(), None)
}

fn size_of(picture: &Framebuffer) -> (u32, u32) {
    (picture.width(), picture.height())
}
