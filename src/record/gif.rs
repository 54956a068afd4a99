//! Recording of animated GIFs.

use crate::framebuffer::Resolution;
use crate::tone::Picture;
use gif::{EncodingError, Repeat};
use std::fmt;
use std::io::{self, Write};

/// An animated GIF that repeats for ever.
///
/// Viewers show the pixels of a GIF as squares. Pixels of another aspect are repeated along their longer axis, so that
/// the picture has the right shape. Each frame has its own 256 colours. Delays are whole hundredths of a second; the
/// rounding error is carried over to the next frame, so that the total time is right. (Viewers show delays of less than
/// two hundredths much longer.)
///
/// ```
/// use termtrace::{Gif, Picture, Resolution, Srgb8};
///
/// let picture = Picture::from_pixels(4, 2, vec![Srgb8::new(90, 160, 40); 8]).ok_or("4 by 2 pixels")?;
/// let mut gif = Gif::begin(Vec::new(), Resolution::new(4, 2)?, 8, 25)?;
/// gif.frame(&picture)?;
/// assert!(gif.end()?.starts_with(b"GIF89a"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Gif<W: Write> {
    encoder: gif::Encoder<W>,
    resolution: Resolution,
    size: (u16, u16),
    frames_per_second: u32,
    frame: u64,
}

impl<W: Write> fmt::Debug for Gif<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, frames_per_second, frame, .. } = self;
        let mut gif = f.debug_struct("Gif");
        gif.field("size", size).field("frames_per_second", frames_per_second).field("frame", frame);
        gif.finish_non_exhaustive()
    }
}

impl<W: Write> Gif<W> {
    /// Starts a film of pictures of this resolution, with each pixel enlarged `scale` times in both
    /// directions.
    ///
    /// # Errors
    /// If writing fails, or a side of the GIF would exceed 65,535 pixels.
    pub fn begin(out: W, resolution: Resolution, scale: u32, frames_per_second: u32) -> io::Result<Self> {
        let (width, height) = gif_size(resolution, scale);
        let size = match (width.try_into(), height.try_into()) {
            (Ok(width), Ok(height)) => (width, height),
            _ => return Err(invalid("a GIF has at most 65535 pixels each way")),
        };
        let mut encoder = gif::Encoder::new(out, size.0, size.1, &[]).map_err(io_error)?;
        encoder.set_repeat(Repeat::Infinite).map_err(io_error)?;
        Ok(Self { encoder, resolution, size, frames_per_second, frame: 0 })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If writing fails, or the picture has another size.
    pub fn frame(&mut self, picture: &Picture) -> io::Result<()> {
        let [width, height] = [self.resolution.width(), self.resolution.height()];
        if (picture.width, picture.height, picture.pixels.len()) != (width, height, self.resolution.pixel_count()) {
            return Err(invalid("all frames of a film have one size"));
        }
        let rgb = picture.to_bytes();
        // Colours are quantised before the enlargement, because there are fewer pixels. The casts do not truncate: no
        // side exceeds that of the GIF, which fits into 16 bits.
        let mut frame =
            gif::Frame::from_rgb_speed(width as u16, height as u16, &rgb, sampling_step(picture.pixels.len()));
        // Enlarged to square pixels here, because viewers ignore a GIF's pixel aspect.
        frame.buffer = self.enlarged(&frame.buffer).into();
        (frame.width, frame.height) = self.size;
        frame.delay = self.delay();
        self.frame += 1;
        self.encoder.write_frame(&frame).map_err(io_error)
    }

    /// Finishes the film and returns the writer.
    ///
    /// # Errors
    /// If writing fails.
    pub fn end(self) -> io::Result<W> {
        let mut out = self.encoder.into_inner().map_err(io_error)?;
        out.flush()?;
        Ok(out)
    }

    /// Returns the pixels of a picture, each repeated across and down so that they fill the GIF.
    fn enlarged(&self, pixels: &[u8]) -> Vec<u8> {
        let (across, down) = (usize::from(self.size.0), usize::from(self.size.1));
        let (width, height) = (self.resolution.width() as usize, self.resolution.height() as usize);
        let mut enlarged = Vec::with_capacity(across * down);
        for y in 0..down {
            let row = &pixels[y * height / down * width..][..width];
            enlarged.extend((0..across).map(|x| row[x * width / across]));
        }
        enlarged
    }

    /// Returns the time from the current frame to the next in hundredths of a second.
    fn delay(&self) -> u16 {
        let second = u64::from(self.frames_per_second.max(1));
        // The difference of the rounded start times of both frames, so that rounding errors do not add up.
        let hundredths = |frame: u64| (100 * frame + second / 2) / second;
        // The difference is at most 100, at one frame per second.
        (hundredths(self.frame + 1) - hundredths(self.frame)) as u16
    }
}

/// Returns the width and height in pixels of a GIF of this resolution, with each pixel enlarged
/// `scale` times.
pub fn gif_size(resolution: Resolution, scale: u32) -> (u64, u64) {
    let pixel_aspect = resolution.pixel_aspect();
    let [width, height] = [resolution.width(), resolution.height()].map(|side| u64::from(side) * u64::from(scale));
    let stretched = |side: u64, by: f32| ((side as f64 * f64::from(by)).round() as u64).max(side);
    if pixel_aspect < 1.0 {
        (stretched(width, 1.0 / pixel_aspect), height)
    } else {
        (width, stretched(height, pixel_aspect))
    }
}

/// Returns the quantiser's sampling step for a number of pixels, from 1 (every pixel) to 30.
// The quantiser then reads about 50,000 pixels, which bounds its time per frame.
fn sampling_step(pixels: usize) -> i32 {
    i32::try_from(pixels / 50_000).map_or(30, |sampling_step| sampling_step.clamp(1, 30))
}

fn invalid(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}
