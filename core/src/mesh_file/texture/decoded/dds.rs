//! Decoding of DDS pictures whose blocks of 4 x 4 texels are compressed: DXT1, DXT3 and DXT5.
//!
//! Only the largest of the stored sizes is read.

use super::samples::{TexelBudget, check_plausible, checked_texture, cut_short, texels_of};
use crate::mesh_file::texture::Texture;

/// Decodes a block into four rows of texels; the last argument is the number of bytes per row.
type DecodeBlock = fn(&[u8], &mut [u8], usize);

/// The bytes of the signature and the header.
const HEADER: usize = 128;
/// The side of a block, in texels.
const SIDE: usize = 4;
/// Red, green, blue and opacity.
const CHANNELS: usize = 4;

/// Returns whether the bytes begin as a DDS picture does.
pub(super) fn is_dds(bytes: &[u8]) -> bool {
    bytes.starts_with(b"DDS ")
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let (header, blocks) = bytes.split_at_checked(HEADER).ok_or_else(|| cut_short("DDS"))?;
    let number = |at: usize| u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]) as usize;
    let (height, width) = (number(12), number(16));
    let (decode_block, block_size): (DecodeBlock, usize) = match &header[84..88] {
        b"DXT1" => (bcdec_rs::bc1, 8),
        b"DXT3" => (bcdec_rs::bc2, 16),
        b"DXT5" => (bcdec_rs::bc3, 16),
        _ => {
            let kinds = "is a DDS picture of a kind that is not read: only DXT1, DXT3 and DXT5 are";
            return Err(kinds.to_owned());
        }
    };
    budget.spend(width, height)?;
    // Half a byte per texel, at least.
    check_plausible(width * height, bytes, 2, "DDS")?;
    let (columns, rows) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
    let blocks = blocks.get(..columns * rows * block_size).ok_or_else(|| cut_short("DDS"))?;
    let row_size = width * CHANNELS;
    let mut samples = vec![0; height * row_size];
    for (strip, blocks) in samples.chunks_mut(SIDE * row_size).zip(blocks.chunks_exact(columns * block_size)) {
        for (column, block) in blocks.chunks_exact(block_size).enumerate() {
            let mut texels = [0; SIDE * SIDE * CHANNELS];
            decode_block(block, &mut texels, SIDE * CHANNELS);
            // The last blocks may reach beyond the picture.
            let from = column * SIDE * CHANNELS;
            let to = row_size.min(from + SIDE * CHANNELS);
            for (row, texels) in strip.chunks_exact_mut(row_size).zip(texels.chunks_exact(SIDE * CHANNELS)) {
                row[from..to].copy_from_slice(&texels[..to - from]);
            }
        }
    }
    checked_texture(width as u32, height as u32, texels_of(&samples, CHANNELS), "DDS")
}
