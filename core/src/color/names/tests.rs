use super::*;
use csscolorparser::NAMED_COLORS;

#[test]
fn names_are_those_of_css() {
    assert_eq!(Srgb8::names().count(), NAMED_COLORS.len());
    for (name, &[r, g, b]) in NAMED_COLORS.entries() {
        let name = name.as_str();
        assert_eq!(Srgb8::from_name(name), Some(Srgb8::new(r, g, b)), "{name}");
        assert_eq!(Srgb8::from_name(&name.to_uppercase()), Some(Srgb8::new(r, g, b)), "{name}");
    }
    for strange in ["", "stealblue", "blu", "red ", "#ff0000"] {
        assert_eq!(Srgb8::from_name(strange), None, "{strange}");
    }
}
