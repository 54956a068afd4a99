//! Decoding of GIF pictures; of an animation, the first frame.

use super::samples::{TexelBudget, check_plausible, checked_texture, cut_short, texels_of};
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;
use gif::{ColorOutput, DecodeOptions, DecodingError, MemoryLimit};
use std::num::NonZeroU64;

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
    // A frame larger than the picture is refused.
    options.check_frame_consistency(true);
    // Four bytes per texel.
    options.set_memory_limit(NonZeroU64::new(4 * MAX_TEXELS as u64).map_or(MemoryLimit::Unlimited, MemoryLimit::Bytes));
    let mut decoder = options.read_info(bytes).map_err(say)?;
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    budget.spend(width, height)?;
    // A code of LZW stands for at most 4096 texels.
    check_plausible(width * height, bytes, 4096, "GIF")?;
    let frame = decoder.read_next_frame().map_err(say)?.ok_or("is a GIF picture without a frame")?;
    // Texels around the frame are transparent.
    let mut samples = vec![0; width * height * 4];
    let (row, left) = (usize::from(frame.width) * 4, usize::from(frame.left) * 4);
    let rows = samples.chunks_exact_mut(width * 4).skip(usize::from(frame.top));
    for (to, from) in rows.zip(frame.buffer.chunks_exact(row.max(1))) {
        to[left..left + row].copy_from_slice(from);
    }
    checked_texture(width as u32, height as u32, texels_of(&samples, 4), "GIF") // sizes of GIF have 16 bits
}
