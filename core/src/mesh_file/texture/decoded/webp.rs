//! Decoding of WebP pictures; of an animation, the first frame.

use super::samples::{TexelBudget, checked_texture, cut_short, texels_of};
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
    if lossy_size_agrees(bytes, [width, height]) == Some(false) {
        return Err("is a WebP picture that states two sizes".to_owned());
    }
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = vec![0; decoder.output_buffer_size().ok_or("is a WebP picture that is too large")?];
    decoder.read_image(&mut samples).map_err(say)?;
    checked_texture(width, height, texels_of(&samples, channels), "WebP")
}

/// Returns whether the first lossy picture has the size that its container states.
///
/// `None` if there is no such picture, or the file is cut short.
// `image-webp` 0.2.4 does not test this in animations whose frames have a separate opacity, and panics; elsewhere it
// tests it after it has reserved memory for the picture.
fn lossy_size_agrees(bytes: &[u8], canvas: [u32; 2]) -> Option<bool> {
    let number = |at: usize, size: usize| {
        Some(
            bytes
                .get(at..at.checked_add(size)?)?
                .iter()
                .rev()
                .fold(0_u32, |number, &byte| number << 8 | u32::from(byte)),
        )
    };
    let (mut at, mut stated) = (12_usize, canvas);
    loop {
        let (content, size) = (at + 8, number(at + 4, 4)? as usize);
        match bytes.get(at..content)?.first_chunk::<4>()? {
            b"VP8 " => {
                // The first bit tells that this is no key frame, which alone has a size.
                let is_key = number(content, 1)? & 1 == 0;
                return Some(is_key && [number(content + 6, 2)? & 0x3fff, number(content + 8, 2)? & 0x3fff] == stated);
            }
            // The pictures of a frame follow its position, size and time.
            b"ANMF" => {
                stated = [number(content + 6, 3)? + 1, number(content + 9, 3)? + 1];
                at = content + 16;
            }
            _ => at = content.checked_add(size)?.checked_next_multiple_of(2)?,
        }
    }
}
