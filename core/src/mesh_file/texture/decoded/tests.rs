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
