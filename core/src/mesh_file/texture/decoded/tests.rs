use super::*;

/// A PNG picture whose palette has 70 bytes, found by the fuzzer.
///
/// Its checksums are wrong, because fuzz targets do not check them.
const CUT_PALETTE: &[u8] = include_bytes!("../../../../../fuzz/corpus/texture/png_palette_cut_short");

/// Returns the picture with the right checksum in each chunk.
fn with_checksums(picture: &[u8]) -> Vec<u8> {
    let (mut bytes, mut at) = (picture.to_vec(), 8);
    while let Some(length) = bytes.get(at..at + 4) {
        let end = at + 8 + u32::from_be_bytes(length.try_into().expect("4 bytes")) as usize;
        if end + 4 > bytes.len() {
            break;
        }
        // CRC-32, bit by bit.
        let crc = bytes[at + 4..end].iter().fold(u32::MAX, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| crc >> 1 ^ (0xedb8_8320 & 0_u32.wrapping_sub(crc & 1)))
        });
        bytes[end..end + 4].copy_from_slice(&(!crc).to_be_bytes());
        at = end + 4;
    }
    bytes
}

#[test]
fn a_palette_that_is_cut_short_is_a_fault() {
    let fault = decode(&with_checksums(CUT_PALETTE), &mut TexelBudget::default()).err();
    assert_eq!(fault.as_deref(), Some("is a PNG picture whose palette has a colour of less than 3 bytes"));
}

/// Returns the texels of a picture as hexadecimal colours.
///
/// They are in rows from the upper left corner.
fn texels(picture: &[u8]) -> Vec<String> {
    let texture = decode(picture, &mut TexelBudget::default()).expect("a picture");
    texture.texels.iter().map(|texel| format!("{:02x}{:02x}{:02x}", texel.r, texel.g, texel.b)).collect()
}

/// Returns a TGA picture.
///
/// `kinds` are those of its palette and its own; `palette` has the first index, the length and the bits per entry, and
/// `size` the width, the height and the bits per pixel; `rest` follows the header.
fn tga(kinds: [u8; 2], palette: [u8; 3], size: [u8; 3], order: u8, rest: &[u8]) -> Vec<u8> {
    let [first, length, entry_bits] = palette;
    let [width, height, bits] = size;
    let header = [0, kinds[0], kinds[1], first, 0, length, 0, entry_bits, 0, 0, 0, 0, width, 0, height, 0, bits, order];
    [&header, rest].concat()
}

#[test]
fn runs_of_tga_pictures_are_expanded() {
    // A run of two reds, and a blue and a green pixel as they are; downwards and rightwards.
    let rest = [0x81, 0, 0, 255, 0x01, 255, 0, 0, 0, 255, 0];
    let picture = tga([0, 10], [0; 3], [2, 2, 24], 0x20, &rest);
    assert_eq!(texels(&picture), ["ff0000", "ff0000", "0000ff", "00ff00"]);
    let cut = decode(&picture[..picture.len() - 1], &mut TexelBudget::default()).err();
    assert_eq!(cut.as_deref(), Some("is a TGA picture that is cut short"));
}

#[test]
fn the_order_of_pixels_in_a_tga_picture_is_kept() {
    let rest = [1, 2, 3, 4, 5, 6];
    let in_order = |order| texels(&tga([0, 3], [0; 3], [2, 3, 8], order, &rest)).join(" ");
    assert_eq!(in_order(0x20), "010101 020202 030303 040404 050505 060606");
    assert_eq!(in_order(0x30), "020202 010101 040404 030303 060606 050505");
    assert_eq!(in_order(0x00), "050505 060606 030303 040404 010101 020202");
    assert_eq!(in_order(0x10), "060606 050505 040404 030303 020202 010101");
}

#[test]
fn tga_pictures_have_palettes_and_colours_of_five_bits() {
    // Entries 7 and 8: full green and a bit less than half red, of 16 bits.
    let palette = [0xe0, 0x03, 0x00, 0x3c];
    let mapped = |index: u8| tga([1, 1], [7, 2, 16], [1, 1, 8], 0x20, &[&palette[..], &[index]].concat());
    assert_eq!(texels(&mapped(7)), ["00ff00"]);
    // 15 / 31 of 255.
    assert_eq!(texels(&mapped(8)), ["7b0000"]);
    for index in [6, 9] {
        let fault = decode(&mapped(index), &mut TexelBudget::default()).err();
        assert_eq!(fault.as_deref(), Some("is a TGA picture with a colour that its palette does not have"));
    }
}

#[test]
fn blocks_of_dds_pictures_may_reach_beyond_them() {
    let header = |kind: &[u8; 4], width: u8, height: u8| {
        let mut header = b"DDS ".to_vec();
        header.resize(128, 0);
        (header[12], header[16]) = (height, width);
        header[84..88].copy_from_slice(kind);
        header
    };
    // Red and blue; each row has the first, the second and the two colours between them.
    let colors = [0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4];
    let row = ["ff0000", "0000ff", "aa0055", "5500aa", "ff0000"];
    let narrow = [header(b"DXT1", 5, 2), colors.to_vec(), colors.to_vec()].concat();
    assert_eq!(texels(&narrow), [row, row].concat());
    for kind in [b"DXT3", b"DXT5"] {
        let opacities = [0xff; 8];
        let high = [header(kind, 1, 5), [opacities, colors].concat(), [opacities, colors].concat()].concat();
        assert_eq!(texels(&high), ["ff0000"; 5]);
        assert!(decode(&high[..high.len() - 1], &mut TexelBudget::default()).is_err());
    }
}

#[test]
fn a_gif_frame_may_lie_inside_its_picture() {
    // 3 x 2 pixels, of which a frame of one red pixel lies at the right of the lower row.
    let picture = b"GIF89a\x03\0\x02\0\x80\0\0\0\0\xff\xff\0\0,\x02\0\x01\0\x01\0\x01\0\0\x02\x02\x4c\x01\0;";
    assert_eq!(texels(picture), ["000000", "000000", "000000", "000000", "000000", "ff0000"]);
}

/// Returns a BMP picture with a header of 40 bytes, which `rest` follows.
fn bmp(size: [i32; 2], bits: u8, compression: u8, colors: u8, rest: &[u8]) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    bytes.resize(54, 0);
    bytes[14] = 40;
    bytes[18..22].copy_from_slice(&size[0].to_le_bytes());
    bytes[22..26].copy_from_slice(&size[1].to_le_bytes());
    (bytes[28], bytes[30], bytes[46]) = (bits, compression, colors);
    let masks = if compression == 3 { 12 } else { 0 };
    bytes[10] = 54 + masks + 4 * colors;
    bytes.extend_from_slice(rest);
    bytes
}

/// The palette of [`bmp`] pictures in the tests: red and blue.
const RED_BLUE: [u8; 8] = [0, 0, 255, 0, 255, 0, 0, 0];

#[test]
fn bmp_pictures_have_few_bits_per_pixel() {
    let one_bit = bmp([3, -1], 1, 0, 2, &[&RED_BLUE[..], &[0b0100_0000, 0, 0, 0]].concat());
    assert_eq!(texels(&one_bit), ["ff0000", "0000ff", "ff0000"]);
    let four_bits = bmp([3, 2], 4, 0, 2, &[&RED_BLUE[..], &[0x10, 0x10, 0, 0], &[0x01, 0x00, 0, 0]].concat());
    // Upwards.
    assert_eq!(texels(&four_bits), ["ff0000", "0000ff", "ff0000", "0000ff", "ff0000", "0000ff"]);
    // Without the bytes that fill the last row.
    let five_bits = bmp([1, 1], 16, 0, 0, &[0xe0, 0x03]);
    assert_eq!(texels(&five_bits), ["00ff00"]);
    assert!(decode(&five_bits[..55], &mut TexelBudget::default()).is_err());
}

#[test]
fn masks_of_bmp_pictures_choose_the_bits() {
    let masks = [0x0000_ff00_u32, 0x00ff_0000, 0x0700_0000].map(u32::to_le_bytes).concat();
    let picture = bmp([1, 1], 32, 3, 0, &[&masks[..], &[0xff, 0x12, 0x34, 0x07]].concat());
    assert_eq!(texels(&picture), ["1234ff"]);
    // The masks of a longer header lie at the same place.
    let mut long = picture.clone();
    long[14] = 56;
    long[10] = 70;
    long.splice(66..66, [0; 4]);
    assert_eq!(texels(&long), ["1234ff"]);
    // Masks without bits make black, and no division by zero.
    let empty = bmp([1, 1], 32, 3, 0, &[[0; 12], [0xff; 12]].concat());
    assert_eq!(texels(&empty), ["000000"]);
}

#[test]
fn runs_of_bmp_pictures_are_expanded() {
    // Two blues; the end of the row; three single pixels, which take four bytes; one step up; the end.
    let runs = [2, 1, 0, 0, 0, 3, 1, 0, 1, 0, 0, 2, 0, 1, 1, 1, 0, 1];
    let picture = bmp([4, 3], 8, 1, 2, &[&RED_BLUE[..], &runs].concat());
    let [red, blue] = ["ff0000", "0000ff"];
    assert_eq!(texels(&picture)[..4], [red, red, red, blue]);
    assert_eq!(texels(&picture)[4..8], [blue, red, blue, red]);
    assert_eq!(texels(&picture)[8..], [blue, blue, red, red]);
    // Without the last run. The mark of the end alone may be missing.
    let cut = decode(&picture[..picture.len() - 4], &mut TexelBudget::default()).err();
    assert!(decode(&picture[..picture.len() - 2], &mut TexelBudget::default()).is_ok());
    assert_eq!(cut.as_deref(), Some("is a BMP picture that is cut short"));
    // A run of two alternating pixels of four bits, longer than its row.
    let picture = bmp([2, 1], 4, 2, 2, &[&RED_BLUE[..], &[200, 0x10]].concat());
    assert_eq!(texels(&picture), [blue, red]);
}

#[test]
fn gif_frames_are_cropped_to_their_picture() {
    // One pixel, and a frame of two from there on to the right: red and black.
    let picture = b"GIF89a\x01\0\x01\0\x80\0\0\xff\0\0\0\0\0,\0\0\0\0\x02\0\x01\0\0\x02\x02\x44\x0a\0;";
    assert_eq!(texels(picture), ["ff0000"]);
}

#[test]
fn a_webp_frame_of_another_size_is_refused() {
    // An animation of one pixel, with a frame of one pixel: an opacity, and colours that are no key frame, on which the
    // crate `image-webp` panics.
    let chunk = |name: &[u8; 4], content: &[u8]| {
        let mut chunk = [&name[..], &(content.len() as u32).to_le_bytes(), content].concat();
        chunk.resize(chunk.len().next_multiple_of(2), 0);
        chunk
    };
    let frame = [vec![0; 16], chunk(b"ALPH", &[0, 255]), chunk(b"VP8 ", &[1, 0, 0, 0, 0, 0, 0, 0, 0, 0])].concat();
    let parts = [chunk(b"VP8X", &[0x12, 0, 0, 0, 0, 0, 0, 0, 0, 0]), chunk(b"ANIM", &[0; 6]), chunk(b"ANMF", &frame)];
    let picture = chunk(b"RIFF", &[b"WEBP".to_vec(), parts.concat()].concat());
    let fault = decode(&picture, &mut TexelBudget::default()).err();
    assert_eq!(fault.as_deref(), Some("is a WebP picture that states two sizes"));
}
