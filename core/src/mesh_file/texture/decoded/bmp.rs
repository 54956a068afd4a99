//! Decoding of BMP pictures: of 1 to 32 bits per pixel, also with runs of equal pixels.
//!
//! Read here, because the crate `zune-bmp` 0.5.2 refused pictures of one pixel and took the wrong colours for one bit
//! per pixel, and `image` makes a clean build much longer.

use super::samples::{Rgba, TexelBudget, check_plausible, checked_texture, cut_short, flip, samples_of, texels_of};
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
/// The size of the second header in its oldest form.
///
/// It has sizes of 16 bits, and the palette three bytes per colour.
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
    // At most eight pixels per byte; or many more, as a mark of two bytes leaves out the rest of a row.
    let most_per_byte = if matches!(compression, compression::RUNS_8 | compression::RUNS_4) { 1 << 16 } else { 8 };
    check_plausible(width * height, bytes, most_per_byte, "BMP")?;
    let pixels = bytes.get(header.pixels_at..).ok_or_else(|| cut_short("BMP"))?;
    let mut texels = match (compression, bits) {
        (compression::NONE, 1 | 2 | 4 | 8) => {
            rows_of(pixels, &header, |row, to| to.extend((0..width).map(|x| header.color(index(row, x, bits)))))?
        }
        (compression::NONE, 16 | 24 | 32) | (compression::MASKS | compression::FOUR_MASKS, 16 | 32) => {
            rows_of(pixels, &header, |row, to| to.extend(row.chunks_exact(bits / 8).map(|pixel| header.masked(pixel))))?
        }
        (compression::RUNS_8, 8) | (compression::RUNS_4, 4) => {
            expanded_runs(pixels, &header)?.into_iter().map(|index| header.color(index)).collect()
        }
        _ => return Err(format!("is a BMP picture of a kind that is not read ({bits} bits, kind {compression})")),
    };
    if !header.downwards {
        flip(&mut texels, width);
    }
    let channels = if header.masks[3] == 0 { 3 } else { 4 };
    // The budget is below 2^32.
    checked_texture(width as u32, height as u32, texels_of(&samples_of(&texels, channels), channels), "BMP")
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
        let after_header = match compression {
            compression::MASKS if size < WITH_MASKS => 12,
            compression::FOUR_MASKS if size < WITH_MASKS => 16,
            _ => 0,
        };
        // The masks of short headers follow them.
        let masks_at = if size < WITH_MASKS { FILE_HEADER + size } else { 54 };
        let mask = |index: usize| number(masks_at + 4 * index);
        let masks = match (compression, bits) {
            (compression::MASKS, _) if size <= WITH_MASKS => [mask(0)?, mask(1)?, mask(2)?, 0],
            (compression::MASKS | compression::FOUR_MASKS, _) => [mask(0)?, mask(1)?, mask(2)?, mask(3)?],
            (_, 16) => [0x7c00, 0x03e0, 0x001f, 0],
            _ => [0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0],
        };
        let pixels_at = number(10)? as usize;
        let used = if oldest { 0 } else { field(46)? as usize };
        let most = if bits <= 8 { 1 << bits } else { 0 };
        let palette_at = FILE_HEADER + size + after_header;
        let entry_size = if oldest { 3 } else { 4 };
        // Some files have fewer colours than they claim: the pixels begin earlier.
        let room = pixels_at.saturating_sub(palette_at) / entry_size;
        let entries = if used == 0 { most } else { used.min(most) }.min(room);
        let palette = bytes.get(palette_at..palette_at + entries * entry_size).ok_or_else(|| cut_short("BMP"))?;
        Ok(Self {
            width: width as usize,
            height: height.cast_signed().unsigned_abs() as usize,
            downwards: height.cast_signed() < 0,
            bits,
            compression,
            masks,
            palette: palette.chunks_exact(entry_size).map(|entry| [entry[2], entry[1], entry[0], 255]).collect(),
            pixels_at,
        })
    }

    /// Returns the colour of the palette at an index, or black beyond its end.
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
fn rows_of(pixels: &[u8], header: &Header, add_row: impl Fn(&[u8], &mut Vec<Rgba>)) -> Result<Vec<Rgba>, String> {
    let row_size = (header.width * header.bits).div_ceil(32) * 4;
    // The last row may lack the bytes that fill it.
    let used = (header.width * header.bits).div_ceil(8);
    let mut colors = Vec::with_capacity(header.width * header.height);
    for y in 0..header.height {
        let row = pixels.get(y * row_size..y * row_size + used).ok_or_else(|| cut_short("BMP"))?;
        add_row(row, &mut colors);
    }
    Ok(colors)
}

/// Returns pixel `x` of a row, of up to eight bits.
///
/// The first pixel has the highest bits of its byte.
fn index(row: &[u8], x: usize, bits: usize) -> u8 {
    let shift = 8 - bits - x * bits % 8;
    row[x * bits / 8] >> shift & (0xff >> (8 - bits))
}

/// Returns the indices of all pixels, from the lowest row upwards.
///
/// Those that no run covers are 0.
fn expanded_runs(bytes: &[u8], header: &Header) -> Result<Vec<u8>, String> {
    let Header { width, height, bits, .. } = *header;
    let mut pixels = vec![0; width * height];
    let (mut x, mut y) = (0, 0);
    let mut bytes = bytes.iter().copied();
    let mut set = |x: usize, y: usize, index: u8| {
        if x < width && y < height {
            pixels[y * width + x] = index;
        }
    };
    let nibble = |byte: u8, at: usize| if bits == 8 { byte } else { byte >> (4 - at % 2 * 4) & 15 };
    while y < height {
        let (Some(count), Some(value)) = (bytes.next(), bytes.next()) else {
            // The mark of the end may be missing after the last pixel.
            if y + 1 == height && x >= width {
                break;
            }
            return Err(cut_short("BMP"));
        };
        match (usize::from(count), value) {
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
                let count = count.min(stored.len() * 8 / bits);
                for at in 0..count {
                    set(x + at, y, nibble(stored[at * bits / 8], at));
                }
                x += count;
            }
            (count, value) => {
                for at in 0..count {
                    set(x + at, y, nibble(value, at));
                }
                x += count;
            }
        }
    }
    Ok(pixels)
}
