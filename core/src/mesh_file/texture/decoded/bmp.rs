//! Decoding of BMP pictures: of 1 to 32 bits per pixel, also with runs of equal pixels.
//!
//! Our own: the crate `zune-bmp` 0.5.2 refused pictures of one pixel and took the wrong colours of one bit, and `image`
//! brings all of its other formats and a colour management system, which the build of the tracer would wait for.

use super::samples::{Rgba, TexelBudget, check_plausible, checked_texture, cut_short, flip, texels_of};
use crate::mesh_file::texture::Texture;

/// The compressions that are read, by their numbers in the header.
mod compression {
    pub(super) const NONE: u32 = 0;
    /// Runs of pixels of 8 bits.
    pub(super) const RUNS_8: u32 = 1;
    /// Runs of pixels of 4 bits.
    pub(super) const RUNS_4: u32 = 2;
    /// The header has a mask of bits for each of red, green and blue.
    pub(super) const MASKS: u32 = 3;
    /// The header has a fourth mask, for the opacity.
    pub(super) const FOUR_MASKS: u32 = 6;
}

/// The bytes before the second header, which has one of several sizes.
const FILE_HEADER: usize = 14;
/// The size of the second header in its oldest form, with sizes of 16 bits and three bytes per colour of the palette.
const OLDEST: usize = 12;
/// The size of the second header from which on it holds the masks itself.
const WITH_MASKS: usize = 52;

/// The fields of both headers.
struct Header {
    width: usize,
    height: usize,
    /// Whether the first row is the highest one.
    downwards: bool,
    bits: usize,
    compression: u32,
    masks: [u32; 4],
    palette: Vec<Rgba>,
    /// The first byte of the pixels.
    pixels_at: usize,
}

/// Returns whether the bytes begin as a BMP picture does.
pub(super) fn is_bmp(bytes: &[u8]) -> bool {
    bytes.starts_with(b"BM")
}

pub(super) fn decode(bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
    let header = Header::read(bytes)?;
    let Header { width, height, bits, compression, .. } = header;
    budget.spend(width, height)?;
    // A run of equal pixels takes two bytes and has at most 255 pixels.
    check_plausible(width * height, bytes, 128, "BMP")?;
    let pixels = bytes.get(header.pixels_at..).ok_or_else(|| cut_short("BMP"))?;
    let mut texels = match (compression, bits) {
        (compression::NONE, 1 | 2 | 4 | 8) => {
            let of_row = |row: &[u8]| (0..width).map(|x| header.color(index(row, x, bits))).collect();
            rows_of(pixels, &header, of_row)?
        }
        (compression::NONE, 16 | 24 | 32) | (compression::MASKS | compression::FOUR_MASKS, 16 | 32) => {
            let of_row = |row: &[u8]| row.chunks_exact(bits / 8).take(width).map(|p| header.masked(p)).collect();
            rows_of(pixels, &header, of_row)?
        }
        (compression::RUNS_8, 8) | (compression::RUNS_4, 4) => {
            expanded_runs(pixels, &header).into_iter().map(|index| header.color(index)).collect()
        }
        _ => return Err(format!("is a BMP picture of a kind that is not read ({bits} bits, kind {compression})")),
    };
    if !header.downwards {
        flip(&mut texels, width);
    }
    checked_texture(width as u32, height as u32, texels_of(texels.as_flattened(), 4), "BMP") // checked by the budget
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let number = |at: usize| {
            let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
            four.map(u32::from_le_bytes).ok_or_else(|| cut_short("BMP"))
        };
        let half = |at: usize| number(at).map(|number| number & 0xffff);
        let size = number(FILE_HEADER)? as usize;
        let oldest = size == OLDEST;
        if !oldest && !(16..=1 << 16).contains(&size) {
            return Err(format!("is a BMP picture with a header of {size} bytes, which is not read"));
        }
        let (width, height) = if oldest { (half(18)?, half(20)?) } else { (number(18)?, number(22)?) };
        let bits = half(if oldest { 24 } else { 28 })? as usize;
        // A field that the header is too short for is 0.
        let field = |at: usize| if at + 4 <= FILE_HEADER + size { number(at) } else { Ok(0) };
        let compression = if oldest { 0 } else { field(30)? };
        // The masks of short headers follow them.
        let after_header = match compression {
            compression::MASKS if size < WITH_MASKS => 12,
            compression::FOUR_MASKS if size < WITH_MASKS => 16,
            _ => 0,
        };
        let masks = match (compression, bits) {
            (compression::MASKS, _) if size <= WITH_MASKS => [number(54)?, number(58)?, number(62)?, 0],
            (compression::MASKS | compression::FOUR_MASKS, _) => [number(54)?, number(58)?, number(62)?, number(66)?],
            (_, 16) => [0x7c00, 0x03e0, 0x001f, 0],
            _ => [0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0],
        };
        let used = if oldest { 0 } else { field(46)? as usize };
        let most = if bits <= 8 { 1 << bits } else { 0 };
        let entries = if used == 0 { most } else { used.min(most) };
        let palette_at = FILE_HEADER + size + after_header;
        let entry_size = if oldest { 3 } else { 4 };
        let palette = bytes.get(palette_at..palette_at + entries * entry_size).ok_or_else(|| cut_short("BMP"))?;
        Ok(Self {
            width: width as usize,
            height: height.cast_signed().unsigned_abs() as usize,
            downwards: !oldest && height.cast_signed() < 0,
            bits,
            compression,
            masks,
            palette: palette.chunks_exact(entry_size).map(|entry| [entry[2], entry[1], entry[0], 255]).collect(),
            pixels_at: number(10)? as usize,
        })
    }

    /// Returns a colour of the palette; black if it has fewer.
    fn color(&self, index: u8) -> Rgba {
        self.palette.get(usize::from(index)).copied().unwrap_or([0, 0, 0, 255])
    }

    /// Returns the colour of a pixel of two to four bytes.
    fn masked(&self, pixel: &[u8]) -> Rgba {
        let bits = pixel.iter().rev().fold(0, |bits, &byte| bits << 8 | u32::from(byte));
        let channel = |mask: u32| {
            let most = u64::from(mask >> mask.trailing_zeros().min(31));
            let level = u64::from((bits & mask) >> mask.trailing_zeros().min(31));
            // The nearest of 256 levels.
            (level * 255 + most / 2).checked_div(most).map(|level| level as u8)
        };
        let [red, green, blue, opacity] = self.masks.map(channel);
        [red.unwrap_or(0), green.unwrap_or(0), blue.unwrap_or(0), opacity.unwrap_or(255)]
    }
}

/// Returns the colours of all rows, each of which takes a multiple of four bytes.
fn rows_of(pixels: &[u8], header: &Header, of_row: impl Fn(&[u8]) -> Vec<Rgba>) -> Result<Vec<Rgba>, String> {
    let row_size = (header.width * header.bits).div_ceil(32) * 4;
    // The last row may lack the bytes that fill it.
    let used = (header.width * header.bits).div_ceil(8);
    let row = |y: usize| pixels.get(y * row_size..y * row_size + used).map(&of_row).ok_or_else(|| cut_short("BMP"));
    Ok((0..header.height).map(row).collect::<Result<Vec<_>, _>>()?.concat())
}

/// Returns pixel `x` of a row, of up to eight bits; the first pixel has the highest bits of its byte.
fn index(row: &[u8], x: usize, bits: usize) -> u8 {
    let shift = 8 - bits - x * bits % 8;
    row[x * bits / 8] >> shift & (0xff_u16 >> (8 - bits)) as u8
}

/// Returns the pixels of runs, upwards; those that no run covers are 0.
fn expanded_runs(bytes: &[u8], header: &Header) -> Vec<u8> {
    let Header { width, height, bits, .. } = *header;
    let mut pixels = vec![0; width * height];
    let (mut x, mut y) = (0, 0);
    let mut bytes = bytes.iter().copied();
    let mut set = |x: usize, y: usize, index: u8| {
        if x < width && y < height {
            pixels[y * width + x] = index;
        }
    };
    // A picture that is cut short keeps its rows.
    while let (Some(count), Some(value)) = (bytes.next(), bytes.next()) {
        let count = usize::from(count);
        let nibble = |byte: u8, at: usize| if bits == 8 { byte } else { byte >> (4 - at % 2 * 4) & 15 };
        match (count, value) {
            (0, 0) => (x, y) = (0, y + 1),
            (0, 1) => break,
            (0, 2) => {
                let [right, up] = [bytes.next(), bytes.next()].map(|step| usize::from(step.unwrap_or(0)));
                (x, y) = (x + right, y + up);
            }
            (0, count) => {
                let count = usize::from(count);
                // The stored pixels take a multiple of two bytes.
                let stored: Vec<_> = bytes.by_ref().take((count * bits).div_ceil(16) * 2).collect();
                for at in 0..count.min(stored.len() * 8 / bits) {
                    set(x + at, y, nibble(stored[at * bits / 8], at));
                }
                x += count;
            }
            _ => {
                for at in 0..count {
                    set(x + at, y, nibble(value, at));
                }
                x += count;
            }
        }
        if y >= height {
            break;
        }
    }
    pixels
}
