//! Decoding of GIF pictures; of an animation, the first frame.

use super::samples::{TexelBudget, check_plausible, checked_texture, cut_short, texels_of};
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;
use gif::{ColorOutput, DecodeOptions, DecodingError, MemoryLimit};
use std::num::NonZeroU64;

/// The most bytes of a frame: four per texel.
const MAX_FRAME_BYTES: NonZeroU64 = NonZeroU64::new(4 * MAX_TEXELS as u64).unwrap();

/// Returns whether the bytes begin as a GIF picture does.
pub(super) fn is_gif(bytes: &[u8]) -> bool {
    bytes.starts_with(b"GIF8")
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let say = |error: DecodingError| match error {
        DecodingError::UnexpectedEof => cut_short("GIF"),
        error => format!("is a GIF picture that cannot be read: {error}"),
    };
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::RGBA);
    options.set_memory_limit(MemoryLimit::Bytes(MAX_FRAME_BYTES));
    let mut decoder = options.read_info(bytes).map_err(say)?;
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    budget.spend(width, height)?;
    // A code of LZW stands for at most 4096 texels.
    check_plausible(width * height, bytes, 4096, "GIF")?;
    let frame = decoder.read_next_frame().map_err(say)?.ok_or("is a GIF picture without a frame")?;
    // Texels around the frame are transparent.
    let mut samples = vec![0; width * height * 4];
    // A frame may reach beyond the picture.
    let left = usize::from(frame.left).min(width);
    let columns = usize::from(frame.width).min(width - left);
    let rows = samples.chunks_exact_mut(width * 4).skip(usize::from(frame.top));
    for (to, from) in rows.zip(frame.buffer.chunks_exact((usize::from(frame.width) * 4).max(1))) {
        to[left * 4..][..columns * 4].copy_from_slice(&from[..columns * 4]);
    }
    checked_texture(width as u32, height as u32, texels_of(&samples, 4), "GIF") // sizes of GIF have 16 bits
}
