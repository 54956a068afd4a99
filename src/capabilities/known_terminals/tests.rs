use super::*;

#[test]
fn terminals_are_known_by_their_names() {
    for (name, expected) in [
        ("kitty(0.26.5)", true),
        ("WezTerm 20230712-072601-f4abf8fd", true),
        ("foot(1.13.1)", true),
        ("VTE(7600)", true),
        ("Konsole 22.12.3", true),
        ("iTerm2 3.4.19", true),
        ("ghostty 1.0.1", true),
        ("tmux 3.3a", false),
        ("XTerm(379)", false),
        ("footprint 1", false),
        ("screen", false),
        ("", false),
    ] {
        assert_eq!(name_implies_truecolor(name), expected, "{name}");
    }
}

#[test]
fn terminals_are_known_by_their_secondary_attributes() {
    for (terminal, attributes, expected) in [
        ("Alacritty 0.11", &[0, 1100, 1][..], true),
        ("VTE 0.60", &[65, 6003, 1], true),
        ("VTE 0.76", &[61, 7600, 1], true),
        ("Konsole", &[1, 115, 0], true),
        ("Windows Terminal", &[0, 10, 1], true),
        ("xterm.js", &[0, 276, 0], true),
        ("mintty", &[77, 30400, 0], true),
        ("xterm", &[41, 379, 0], false),
        ("tmux", &[84, 0, 0], false),
        ("GNU screen", &[83, 40900, 0], false),
        ("Terminal.app", &[1, 95, 0], false),
        ("PuTTY", &[0, 136, 0], false),
        ("rxvt-unicode", &[85, 95, 0], false),
        ("mosh", &[1, 10, 0], false),
        ("nothing", &[], false),
    ] {
        assert_eq!(attributes_imply_truecolor(attributes), expected, "{terminal}");
    }
}

#[test]
fn terminals_that_show_parts_of_blocks_are_known_by_name_or_attributes() {
    for (name, expected) in [
        ("kitty(0.26.5)", true),
        ("XTerm(379)", true),
        ("foot(1.13.1)", true),
        ("alacritty 0.14.0", true),
        ("kitty(0.40.1)", true),
        ("foot(2.0.0)", true),
        ("XTerm(401)", true),
        ("kitty(0.25.9)", false),
        ("XTerm(378)", false),
        ("foot(1.12.9-dev)", false),
        ("alacritty 0.9", false),
        ("xterm.js(5.5.0)", false),
        ("xtermish 1", false),
        ("tmux 3.3a", false),
        ("VTE(7600)", false),
        ("kitty", false),
        ("kitty()", false),
        ("kitty(99999999999)", false),
        ("", false),
    ] {
        assert_eq!(name_implies_block_parts(name), expected, "{name}");
    }
    for (attributes, expected) in
        [(&[0, 1100, 1][..], true), (&[0, 1000, 1], false), (&[0, 10, 1], false), (&[41, 379, 0], false), (&[], false)]
    {
        assert_eq!(attributes_imply_block_parts(attributes), expected, "{attributes:?}");
    }
}
