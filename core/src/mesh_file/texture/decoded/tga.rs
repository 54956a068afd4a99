//! Decoding of TGA pictures.
//!
//! Read here, because the crate `tinytga` brings a graphics library for small devices, and `image` makes a clean build
//! much longer.

use super::samples::{Rgba, TexelBudget, check_plausible, checked_texture, cut_short, flip, samples_of, texels_of};
use crate::mesh_file::texture::Texture;

const HEADER: usize = 18;

/// Returns whether the bytes may be the beginning of a TGA picture, which has no signature.
pub(super) fn is_tga(bytes: &[u8]) -> bool {
    // The kind of its palette (none or one), the kind of the picture, and the number of bits per pixel.
    matches!(bytes, [_, 0 | 1, 1..=3 | 9..=11, _, _, _, _, _, _, _, _, _, _, _, _, _, 8 | 15 | 16 | 24 | 32, ..])
}

/// How the bytes of a pixel are read.
#[derive(Clone, Copy)]
enum PixelKind {
    Mapped,
    Color,
    Grey,
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let header = bytes.get(..HEADER).ok_or_else(|| cut_short("TGA"))?;
    let number = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
    let (width, height) = (number(12), number(14));
    budget.spend(width, height)?;
    // A run of equal texels takes at least two bytes and has at most 128 of them.
    check_plausible(width * height, bytes, 128, "TGA")?;
    let kind = match header[2] & 7 {
        1 => PixelKind::Mapped,
        2 => PixelKind::Color,
        _ => PixelKind::Grey,
    };
    let pixel_size = usize::from(header[16].div_ceil(8));
    let entry_size = usize::from(header[7].div_ceil(8));
    let supported = match kind {
        PixelKind::Mapped => header[1] == 1 && pixel_size <= 2 && (2..=4).contains(&entry_size),
        PixelKind::Color => pixel_size >= 2,
        PixelKind::Grey => pixel_size <= 2,
    };
    if !supported {
        return Err("is a TGA picture of a kind that is not read".to_owned());
    }
    let (first, entries) = (number(3), number(5));
    let palette_at = HEADER + usize::from(header[0]);
    let palette_size = if header[1] == 1 { entries * entry_size } else { 0 };
    let palette = bytes.get(palette_at..palette_at + palette_size).ok_or_else(|| cut_short("TGA"))?;
    let pixels = &bytes[palette_at + palette_size..];
    let expanded;
    let pixels = if header[2] >= 9 {
        expanded = expanded_runs(pixels, pixel_size, width * height);
        &expanded
    } else {
        pixels
    };
    let texel = |pixel: &[u8]| match kind {
        PixelKind::Mapped => {
            let index = usize::from(pixel[0]) | pixel.get(1).map_or(0, |&high| usize::from(high) << 8);
            let entry = index.checked_sub(first).and_then(|index| palette.chunks_exact(entry_size).nth(index));
            entry.map(color).ok_or("is a TGA picture with a colour that its palette does not have")
        }
        PixelKind::Color => Ok(color(pixel)),
        PixelKind::Grey => Ok([pixel[0], pixel[0], pixel[0], pixel.get(1).copied().unwrap_or(255)]),
    };
    let pixels = pixels.chunks_exact(pixel_size).take(width * height);
    let mut texels = pixels.map(texel).collect::<Result<Vec<_>, _>>()?;
    if texels.len() < width * height {
        return Err(cut_short("TGA"));
    }
    // The order of the pixels: rightwards if bit 4 is not set, upwards if bit 5 is not set.
    if header[17] & 0x10 != 0 {
        texels.chunks_exact_mut(width).for_each(<[Rgba]>::reverse);
    }
    if header[17] & 0x20 == 0 {
        flip(&mut texels, width);
    }
    // The four lowest bits tell how many bits of a pixel are its opacity.
    let channels = if header[17] % 16 == 0 { 3 } else { 4 };
    checked_texture(width as u32, height as u32, texels_of(&samples_of(&texels, channels), channels), "TGA")
}

/// Returns the pixels of runs and of literal pieces, at most `most` of them.
///
/// The first bit of a piece says whether one pixel is repeated; the other seven have the number of pixels less one.
fn expanded_runs(mut bytes: &[u8], pixel_size: usize, most: usize) -> Vec<u8> {
    let mut pixels = Vec::with_capacity(most * pixel_size);
    while let Some((&head, rest)) = bytes.split_first() {
        let count = usize::from(head & 0x7f) + 1;
        let (stored, times) = if head >= 0x80 { (1, count) } else { (count, 1) };
        // A piece that is cut short ends the pixels: the caller counts them.
        let Some((piece, rest)) = rest.split_at_checked(stored * pixel_size) else { break };
        for _ in 0..times {
            pixels.extend_from_slice(piece);
        }
        bytes = rest;
        if pixels.len() >= most * pixel_size {
            break;
        }
    }
    pixels
}

/// Returns the colour of a pixel of two, three or four bytes.
///
/// Two bytes have 5 bits per channel; others are blue, green, red and the opacity.
fn color(bytes: &[u8]) -> Rgba {
    match *bytes {
        [low, high] => {
            let bits = u16::from_le_bytes([low, high]);
            // The nearest of 256 levels to a level of 32.
            let channel = |shift: u16| ((u32::from(bits >> shift & 31) * 255 + 15) / 31) as u8;
            [channel(10), channel(5), channel(0), 255]
        }
        [blue, green, red] => [red, green, blue, 255],
        [blue, green, red, opacity, ..] => [red, green, blue, opacity],
        _ => [0, 0, 0, 255],
    }
}
