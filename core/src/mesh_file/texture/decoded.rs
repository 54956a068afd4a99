//! Decoding of texture files: PNG and JPEG.

use super::{Texture, TexturePlacement};
use crate::color::Srgb8;
use crate::mesh_file::limits::MAX_TEXELS;
use glam::Vec3;
use std::fmt;
use std::io::Cursor;
use std::sync::Arc;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

impl TexturePlacement {
    /// Returns a placement that takes the mesh's texture coordinates unchanged.
    pub(in crate::mesh_file) fn plain(texture: Arc<Texture>) -> Self {
        Self { texture, transform: [Vec3::X, Vec3::Y] }
    }
}

/// The number of texels that may still be decoded.
pub(in crate::mesh_file) struct TexelBudget(usize);

impl Default for TexelBudget {
    fn default() -> Self {
        Self(MAX_TEXELS)
    }
}

impl TexelBudget {
    fn spend(&mut self, width: usize, height: usize) -> Result<(), String> {
        if width == 0 || height == 0 {
            return Err("is a picture without pixels".to_owned());
        }
        let left = width.checked_mul(height).and_then(|texels| self.0.checked_sub(texels));
        let too_large =
            || format!("is {width} x {height} pixels, too large: all textures together have at most {MAX_TEXELS}");
        self.0 = left.ok_or_else(too_large)?;
        Ok(())
    }
}

/// Decodes an image. An `Err` is a message without its subject, such as "is neither a PNG nor a
/// JPEG picture".
pub(in crate::mesh_file) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    if bytes.starts_with(b"\x89PNG") {
        decode_png(bytes, budget)
    } else if bytes.starts_with(b"\xff\xd8") {
        decode_jpeg(bytes, budget)
    } else if bytes.starts_with(b"version https://git-lfs") {
        Err("is only a pointer of Git LFS to the file: fetch it with `git lfs pull`".to_owned())
    } else {
        Err("is neither a PNG nor a JPEG picture".to_owned())
    }
}

fn decode_png(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let say = |error: png::DecodingError| format!("is a PNG picture that cannot be read: {error}");
    // At most 8 bytes per texel: 16-bit RGBA, before it is reduced to 8 bits per channel.
    let limits = png::Limits { bytes: 8 * MAX_TEXELS };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    // Makes the decoder expand palettes and 1, 2 or 4 bits per sample, and reduce 16, to 8 bits per channel.
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(say)?;
    let (width, height) = reader.info().size();
    budget.spend(width as usize, height as usize)?;
    check_plausible(width as usize * height as usize, bytes, 8 * 1032, "PNG")?;
    // `png` 0.18.1 panics where it expands a palette whose last colour is cut short. The fuzzer found such a picture.
    if reader.info().palette.as_ref().is_some_and(|palette| palette.len() % 3 != 0) {
        return Err("is a PNG picture whose palette has a colour of less than 3 bytes".to_owned());
    }
    let size = reader.output_buffer_size().ok_or("is a PNG picture that is too large")?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(say)?;
    // The frame of an animation may be smaller than the buffer.
    samples.truncate(frame.buffer_size());
    let texels = match frame.color_type.samples() {
        1 => samples.iter().map(|&y| Srgb8::new(y, y, y)).collect(),
        2 => samples.chunks_exact(2).map(|s| Srgb8::new(s[0], s[0], s[0])).collect(),
        n => samples.chunks_exact(n).map(|s| Srgb8::new(s[0], s[1], s[2])).collect(),
    };
    checked_texture(width, height, texels, "PNG")
}

fn decode_jpeg(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let say = |error: &dyn fmt::Debug| format!("is a JPEG picture that cannot be read: {error:?}");
    let options = DecoderOptions::default()
        .set_max_width(MAX_TEXELS)
        .set_max_height(MAX_TEXELS)
        // A decoder that is not strict fills the missing part of an image with grey.
        .set_strict_mode(true)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|error| say(&error))?;
    let (width, height) = decoder.dimensions().ok_or("is a JPEG picture without a size")?;
    budget.spend(width, height)?;
    check_plausible(width * height, bytes, 8 * 64, "JPEG")?;
    let samples = decoder.decode().map_err(|error| say(&error))?;
    let texels = samples.chunks_exact(3).map(|s| Srgb8::new(s[0], s[1], s[2])).collect();
    checked_texture(width as u32, height as u32, texels, "JPEG") // sizes of JPEG have 16 bits
}

/// Refuses a file too short for the texels that it claims, before they cost time and memory.
///
/// The limit is `most_per_byte` texels per byte. A byte of PNG decodes to at most 1032 bytes (the limit of deflate) of
/// one bit per texel; in JPEG each block of 64 texels takes at least a bit. The fuzzer found a JPEG of 700 bytes whose
/// 16 million texels took seconds to decode.
fn check_plausible(texels: usize, bytes: &[u8], most_per_byte: usize, format: &str) -> Result<(), String> {
    if texels / most_per_byte > bytes.len() { Err(cut_short(format)) } else { Ok(()) }
}

fn cut_short(format: &str) -> String {
    format!("is a {format} picture that is cut short")
}

/// Returns the texture, after checking that the decoder returned `width * height` texels: indexing
/// relies on it.
fn checked_texture(width: u32, height: u32, texels: Vec<Srgb8>, format: &str) -> Result<Texture, String> {
    if texels.len() != width as usize * height as usize {
        return Err(cut_short(format));
    }
    Ok(Texture { width, height, texels })
}

#[cfg(all(test, unit_tests))]
mod tests;
