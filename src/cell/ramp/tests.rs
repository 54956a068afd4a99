use super::*;

#[test]
fn each_tenth_of_lightness_has_its_character() {
    // L* of these sRGB greys is 5, 15, ... 95 (CIE's formula, computed by hand).
    let greys = [17, 38, 59, 82, 106, 131, 157, 184, 212, 240];
    let text: String = greys.iter().map(|&grey| glyph(luminance(Srgb8::new(grey, grey, grey)))).collect();
    assert_eq!(text.as_bytes(), RAMP);
}

#[test]
fn black_and_white_have_the_first_and_last_character() {
    assert_eq!(glyph(0.0), ' ');
    assert_eq!(glyph(1.0), '@');
}
