use super::*;

#[test]
fn numbers_are_written_in_decimal() {
    for number in [0, 7, 10, 99, 100, 255, 1_000, 9_999, 10_000, u16::MAX] {
        let mut bytes = Vec::new();
        write_number(number, &mut bytes);
        assert_eq!(bytes, number.to_string().into_bytes());
    }
    for channel in 0..=u8::MAX {
        let mut bytes = Vec::new();
        write_channels([channel, 7, channel], &mut bytes);
        assert_eq!(bytes, format!(";{channel};7;{channel}").into_bytes());
    }
}
