//! Checks of decoded pictures, and the texels of their samples.

use crate::color::Srgb8;
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;

/// The number of texels that may still be decoded.
pub(in crate::mesh_file) struct TexelBudget(usize);

impl Default for TexelBudget {
    fn default() -> Self {
        Self(MAX_TEXELS)
    }
}

impl TexelBudget {
    pub(in crate::mesh_file) fn spend(&mut self, width: usize, height: usize) -> Result<(), String> {
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

/// Refuses a file too short for the texels that it claims, before they cost time and memory.
///
/// The limit is `most_per_byte` texels per byte. A byte of PNG decodes to at most 1032 bytes (the limit of deflate) of
/// one bit per texel; in JPEG each block of 64 texels takes at least a bit. The fuzzer found a JPEG of 700 bytes whose
/// 16 million texels took seconds to decode.
pub(super) fn check_plausible(texels: usize, bytes: &[u8], most_per_byte: usize, format: &str) -> Result<(), String> {
    if texels / most_per_byte > bytes.len() { Err(cut_short(format)) } else { Ok(()) }
}

/// The texels of a picture, and their opacities; none if all are opaque.
pub(super) struct Texels {
    colors: Vec<Srgb8>,
    opacities: Vec<u8>,
    has_opacities: bool,
}

/// Returns the texels of samples with one or two (grey), three or four (RGB) channels, of which the
/// second and the fourth are opacities.
pub(super) fn texels_of(samples: &[u8], channels: usize) -> Texels {
    let texels = samples.chunks_exact(channels);
    let colors = match channels {
        1 | 2 => texels.clone().map(|s| Srgb8::new(s[0], s[0], s[0])).collect(),
        _ => texels.clone().map(|s| Srgb8::new(s[0], s[1], s[2])).collect(),
    };
    let has_opacities = channels.is_multiple_of(2);
    let is_transparent = has_opacities && texels.clone().any(|s| s[channels - 1] < u8::MAX);
    let opacities = if is_transparent { texels.map(|s| s[channels - 1]).collect() } else { Vec::new() };
    Texels { colors, opacities, has_opacities }
}

/// Red, green, blue and the opacity of a texel.
pub(super) type Rgba = [u8; 4];

/// Returns the samples of the first three or all four channels of each texel.
pub(super) fn samples_of(texels: &[Rgba], channels: usize) -> Vec<u8> {
    texels.iter().flat_map(|texel| &texel[..channels]).copied().collect()
}

/// Reverses the order of the rows of a picture.
pub(super) fn flip(texels: &mut [Rgba], width: usize) {
    let rows = texels.len() / width;
    let (upper, lower) = texels.split_at_mut(rows / 2 * width);
    let lower = &mut lower[rows % 2 * width..];
    upper.chunks_exact_mut(width).zip(lower.chunks_exact_mut(width).rev()).for_each(|(a, b)| a.swap_with_slice(b));
}

pub(super) fn cut_short(format: &str) -> String {
    format!("is a {format} picture that is cut short")
}

/// Returns the texture, after checking that the decoder returned `width * height` texels: indexing
/// relies on it.
pub(super) fn checked_texture(width: u32, height: u32, texels: Texels, format: &str) -> Result<Texture, String> {
    let Texels { colors, opacities, has_opacities } = texels;
    if colors.len() != width as usize * height as usize {
        return Err(cut_short(format));
    }
    Ok(Texture { width, height, texels: colors, opacities, has_opacities })
}
