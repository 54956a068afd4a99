//! Decoding of WebP pictures; of an animation, the first frame.

use super::samples::{TexelBudget, checked_texture, cut_short, texels_of};
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;
use image_webp::{DecodingError, WebPDecoder};
use std::io::{Cursor, ErrorKind};

/// Returns whether the bytes begin as a WebP picture does.
pub(super) fn is_webp(bytes: &[u8]) -> bool {
    matches!(bytes, [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..])
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let say = |error: DecodingError| match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => cut_short("WebP"),
        error => format!("is a WebP picture that cannot be read: {error}"),
    };
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(say)?;
    let (width, height) = decoder.dimensions();
    // Only the budget limits the texels: a picture of one colour takes 30 bytes, whatever its size.
    budget.spend(width as usize, height as usize)?;
    // What the decoder may reserve besides the samples: at most one more picture, such as a frame of an animation.
    decoder.set_memory_limit(8 * MAX_TEXELS);
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; decoder.output_buffer_size().ok_or("is a WebP picture that is too large")?];
    decoder.read_image(&mut samples).map_err(say)?;
    checked_texture(width, height, texels_of(&samples, channels), "WebP")
}
