//! Export of a picture as PNG.

use super::format_row::{FileEncoder, FormatRow, GoldenDifference};
use crate::color::Srgb8;
use crate::framebuffer::{Resolution, ResolutionError};
use crate::tone::Picture;
use std::{fmt, io};

pub(super) const KIND: FormatRow = FormatRow {
    name: "png",
    help: "A picture file",
    extensions: &["png"],
    key: 'p',
    command: "WritePng",
    title: "PNG picture",
    file_encoder: FileEncoder::Pixels(|picture, aspect, scale| png(picture, aspect, scale).map_err(io::Error::other)),
    difference,
};

/// Returns the PNG file of a picture, with each pixel enlarged by `scale`.
///
/// Viewers show the pixels of a file as squares, whatever aspect it states. A pixel of another aspect (height / width)
/// therefore becomes `scale` squares along its shorter side and more along the other. The file is marked as sRGB.
///
/// ```
/// use termtrace::{Picture, Srgb8, export::png};
///
/// let picture = Picture::from_pixels(4, 2, vec![Srgb8::new(90, 160, 40); 8]).ok_or("4 by 2 pixels")?;
/// assert!(png(&picture, 1.0, 8)?.starts_with(b"\x89PNG"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the picture has no pixels, or more than a [`Resolution`] may have when it is scaled; and unless `pixel_aspect` is
/// greater than 0 and finite.
pub fn png(picture: &Picture, pixel_aspect: f32, scale: u32) -> Result<Vec<u8>, ExportError> {
    let shown = Resolution::new(picture.width(), picture.height())?.with_pixel_aspect(pixel_aspect)?;
    let [width, height] = shown.size_in_square_pixels(scale).map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    // The size is checked before anything is allocated, because an allocation for the largest scale panicked.
    let file = Resolution::new(width, height)?;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // The sRGB chunk tells viewers the transfer function, which they would otherwise guess.
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut data = Vec::with_capacity(3 * file.pixel_count());
    let pixels = shown.scaled_pixels(picture.pixels(), [width as usize, height as usize]);
    data.extend(pixels.flat_map(|pixel| [pixel.r, pixel.g, pixel.b]));
    let written = encoder.write_header().and_then(|mut file| file.write_image_data(&data));
    written.map(|()| bytes).map_err(ExportError)
}

impl From<ResolutionError> for ExportError {
    fn from(error: ResolutionError) -> Self {
        Self(io::Error::new(io::ErrorKind::InvalidInput, error).into())
    }
}

/// The reason why a picture cannot be written in a format: its size, or the aspect of its pixels.
#[derive(Debug)]
pub struct ExportError(png::EncodingError);

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for ExportError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.source()
    }
}

/// Returns the number of differing pixels, the largest difference, the first differing pixel, and a
/// picture of the differences.
fn difference(golden: &[u8], frame: &[u8]) -> GoldenDifference {
    let (golden, frame) = match (decoded(golden), decoded(frame)) {
        (Ok(golden), Ok(frame)) => (golden, frame),
        (Err(error), _) | (_, Err(error)) => {
            return format!("the golden frame is not a PNG of 8-bit RGB: {error}\n").into();
        }
    };
    if (golden.width, golden.height) != (frame.width, frame.height) {
        let size = |picture: &Decoded| format!("{}x{}", picture.width, picture.height);
        return format!("the golden frame has {} pixels, this frame {}\n", size(&golden), size(&frame)).into();
    }
    let pixels = || golden.pixels().zip(frame.pixels()).enumerate();
    let count = pixels().filter(|(_, (a, b))| a != b).count();
    let largest = pixels().map(|(_, (a, b))| largest_channel_difference(a, b)).max().unwrap_or(0);
    let Some((first, (a, b))) = pixels().find(|(_, (a, b))| a != b) else {
        return "the pixels are equal; only what the files say beside them differs\n".to_owned().into();
    };
    let (x, y) = (first % golden.width, first / golden.width);
    let text = format!(
        "{count} of {} pixels differ, by at most {largest} of 255\nfirst: pixel ({x}, {y}) was {a:?}, is {b:?}\n",
        golden.width * golden.height
    );
    let marked = pixels().map(|(_, (a, b))| difference_color(a, b)).collect();
    let picture = Picture::from_pixels(golden.width as u32, golden.height as u32, marked);
    GoldenDifference { text, picture: picture.and_then(|picture| png(&picture, 1.0, 1).ok()) }
}

/// Returns the largest difference of a channel.
fn largest_channel_difference(a: [u8; 3], b: [u8; 3]) -> u8 {
    a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

/// Returns a pixel of the picture of differences: dim grey for equal pixels, otherwise red.
///
/// The larger the difference, the brighter the red.
fn difference_color(a: [u8; 3], b: [u8; 3]) -> Srgb8 {
    match largest_channel_difference(a, b) {
        0 => {
            // Half of the channels' mean, so that the red of differences stands out.
            let grey = (a.iter().map(|&channel| u16::from(channel)).sum::<u16>() / 6) as u8;
            Srgb8::new(grey, grey, grey)
        }
        // From 160 on, so that even the smallest difference is visible.
        distance => Srgb8::new(160 + (distance / 3).min(95), 0, 0),
    }
}

struct Decoded {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Decoded {
    fn pixels(&self) -> impl Iterator<Item = [u8; 3]> {
        self.rgb.as_chunks().0.iter().copied()
    }
}

fn decoded(bytes: &[u8]) -> Result<Decoded, String> {
    let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().map_err(|error| error.to_string())?;
    let mut rgb = vec![0; reader.output_buffer_size().ok_or("too large")?];
    let info = reader.next_frame(&mut rgb).map_err(|error| error.to_string())?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
        return Err(format!("it has {:?} of {:?}", info.color_type, info.bit_depth));
    }
    Ok(Decoded { width: info.width as usize, height: info.height as usize, rgb })
}
