use super::*;

/// Any bytes give as many elements as wanted, or a fault.
#[test]
fn arbitrary_bytes_do_no_harm() {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 16
    };
    let mut decoded_some = [false; 3];
    for round in 0..30_000 {
        let (at, mode, header) =
            [(0, Mode::Attributes, 0xa0), (1, Mode::Triangles, 0xe1), (2, Mode::Indices, 0xd1)][round % 3];
        let mut data: Vec<u8> = (0..random() % 80).map(|_| random() as u8 & random() as u8).collect();
        data.insert(0, header);
        let elements = Elements { count: (random() % 12 * 3) as usize, stride: [2, 4, 8, 12][random() as usize % 4] };
        let filter = [Filter::None, Filter::Octahedral, Filter::Exponential][random() as usize % 3];
        if let Ok(bytes) = decoded(&data, mode, filter, elements) {
            assert_eq!(bytes.len(), elements.count * elements.stride);
            decoded_some[at] = true;
        }
    }
    assert_eq!(decoded_some, [true; 3]);
}

#[test]
fn normals_are_unfolded_to_unit_length() {
    let mut bytes = [0x81, 0, 127, 9, 64, 0xc0, 127, 9, 127, 127, 127, 9];
    bytes.chunks_exact_mut(4).for_each(unfold_bytes);
    let back = [0x81, 0, 0, 9, 90, 0xa6, 0xff, 9, 0, 0, 0x81, 9];
    assert_eq!(bytes, back);
}

#[test]
fn mantissas_are_scaled() {
    let mut bytes = [0, 0, 0xc0, 0xfe].map(|byte: u8| byte);
    scale_mantissa(&mut bytes);
    assert_eq!(f32::from_le_bytes(bytes), -1_048_576.0);
}
