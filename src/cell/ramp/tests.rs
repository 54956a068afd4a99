use super::*;

#[test]
fn each_step_of_lightness_has_its_character() {
    // L* of these sRGB greys is just below 8, 18, ... 88 and just above (CIE's formula, computed by hand).
    let below = [23, 43, 66, 89, 113, 139, 165, 192, 220];
    let above = below.map(|grey| grey + 1);
    let text_of =
        |greys: &[u8]| -> String { greys.iter().map(|&grey| glyph(luminance(Srgb8::new(grey, grey, grey)))).collect() };
    assert_eq!(text_of(&below).as_bytes(), &RAMP[..9]);
    assert_eq!(text_of(&above).as_bytes(), &RAMP[1..]);
}

#[test]
fn black_and_white_have_the_first_and_last_character() {
    assert_eq!(glyph(0.0), ' ');
    assert_eq!(glyph(1.0), '@');
}
