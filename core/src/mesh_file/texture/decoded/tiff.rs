//! Decoding of TIFF pictures: grey or RGB, of 8 or 16 bits per sample.

use super::samples::{TexelBudget, check_plausible, checked_texture, cut_short, texels_of};
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;
use std::io::{Cursor, ErrorKind};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{PlanarConfiguration, Tag};
use tiff::{ColorType, TiffError};

/// Returns whether the bytes begin as a TIFF picture does, in either byte order.
pub(super) fn is_tiff(bytes: &[u8]) -> bool {
    [b"II*\0", b"MM\0*"].iter().any(|start| bytes.starts_with(*start))
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let say = |error: TiffError| match error {
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => cut_short("TIFF"),
        error => format!("is a TIFF picture that cannot be read: {error}"),
    };
    // At most 8 bytes per texel: 16-bit RGBA.
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MAX_TEXELS;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(say)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(say)?;
    budget.spend(width as usize, height as usize)?;
    // A byte decodes to at most 1032 samples, the limit of deflate.
    check_plausible(width as usize * height as usize, bytes, 1032, "TIFF")?;
    let planes = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(say)?;
    let color = decoder.colortype().map_err(say)?;
    let channels = match color {
        ColorType::Gray(8 | 16) => 1,
        ColorType::GrayA(8 | 16) => 2,
        ColorType::RGB(8 | 16) => 3,
        ColorType::RGBA(8 | 16) => 4,
        other => return Err(format!("is a TIFF picture of a kind that is not read ({other:?})")),
    };
    if channels > 1 && planes == Some(PlanarConfiguration::Planar.to_u16()) {
        return Err("is a TIFF picture whose channels lie one after the other, which are not read".to_owned());
    }
    let samples = match decoder.read_image().map_err(say)? {
        DecodingResult::U8(samples) => samples,
        // The nearest of 256 levels: 65535 is 255 times 257.
        DecodingResult::U16(samples) => samples.into_iter().map(|s| ((u32::from(s) + 128) / 257) as u8).collect(),
        _ => return Err("is a TIFF picture whose samples are not read: they are signed, or no integers".to_owned()),
    };
    checked_texture(width, height, texels_of(&samples, channels), "TIFF")
}
