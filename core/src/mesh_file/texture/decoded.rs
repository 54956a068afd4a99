//! Decoding of texture files: PNG and JPEG here, other formats in modules of their own.
//!
//! Each format has a small crate of its own, or is read here. The crate `image` would read all of them, but brings a
//! colour management system, which made a clean build 26 s longer. Its TIFF decoder also turns on the SIMD of
//! `zune-jpeg`, with which JPEG textures might have other bits on other CPUs; `tiff` is taken without JPEG.

mod bmp;
mod dds;
mod gif;
mod samples;
mod tga;
mod tiff;
mod webp;

pub(in crate::mesh_file) use samples::TexelBudget;

use self::samples::{check_plausible, checked_texture, texels_of};
use super::{Sampler, Texture, TexturePlacement};
use crate::mesh_file::limits::MAX_TEXELS;
use glam::Vec3;
use std::fmt;
use std::io::Cursor;
use std::sync::Arc;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// A decoder of the pictures of one scene, which limits the texels of all together.
#[derive(Default)]
pub(crate) struct TextureDecoder {
    budget: TexelBudget,
}

impl TextureDecoder {
    /// Decodes an image. An `Err` is a message without its subject, as of [`decode`].
    pub(crate) fn decode(&mut self, bytes: &[u8]) -> Result<Texture, String> {
        decode(bytes, &mut self.budget)
    }
}

impl TexturePlacement {
    /// Returns a placement that takes the mesh's texture coordinates unchanged.
    pub(in crate::mesh_file) fn plain(texture: Arc<Texture>) -> Self {
        Self { texture, transform: [Vec3::X, Vec3::Y], sampler: Sampler::default() }
    }
}

/// Decodes a picture, or returns a message without its subject.
type Decode = fn(&[u8], &mut TexelBudget) -> Result<Texture, String>;

/// Returns whether a file's first bytes are those of a format.
type Recognises = fn(&[u8]) -> bool;

/// The formats, each with the test of a file's first bytes.
// TGA is last, because it has no signature.
const FORMATS: [(Recognises, Decode); 8] = [
    (|bytes| bytes.starts_with(b"\x89PNG"), decode_png),
    (|bytes| bytes.starts_with(b"\xff\xd8"), decode_jpeg),
    (tiff::is_tiff, tiff::decode),
    (bmp::is_bmp, bmp::decode),
    (gif::is_gif, gif::decode),
    (webp::is_webp, webp::decode),
    (dds::is_dds, dds::decode),
    (tga::is_tga, tga::decode),
];

/// Decodes an image. An `Err` is a message without its subject, such as "is a PNG picture that is
/// cut short".
pub(in crate::mesh_file) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    if let Some((_, decode)) = FORMATS.iter().find(|(recognises, _)| recognises(bytes)) {
        decode(bytes, budget)
    } else if bytes.starts_with(b"version https://git-lfs") {
        Err("is only a pointer of Git LFS to the file: fetch it with `git lfs pull`".to_owned())
    } else {
        Err("is not a picture of a known format (PNG, JPEG, BMP, TGA, GIF, TIFF, WebP, DDS)".to_owned())
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
    let texels = texels_of(&samples, frame.color_type.samples());
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
    checked_texture(width as u32, height as u32, texels_of(&samples, 3), "JPEG") // sizes of JPEG have 16 bits
}

#[cfg(all(test, unit_tests))]
mod tests;
