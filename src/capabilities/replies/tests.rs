use super::*;

#[test]
fn colours_are_read_in_every_spelling() {
    for (text, expected) in [
        ("rgb:1e1e/2020/ffff", Some(Srgb8::new(0x1e, 0x20, 0xff))),
        ("rgb:1e/20/ff", Some(Srgb8::new(0x1e, 0x20, 0xff))),
        ("rgb:f/0/8", Some(Srgb8::new(255, 0, 136))),
        ("rgba:0000/8080/ffff/ffff", Some(Srgb8::new(0, 0x80, 0xff))),
        ("#102030", Some(Srgb8::new(0x10, 0x20, 0x30))),
        ("#1020", None),
        ("#é0203", None),
        ("rgb:+1/2/3", None),
        ("rgb:12345/0/0", None),
        ("rgb:1/2", None),
        ("rgb://", None),
        ("red", None),
        ("?", None),
    ] {
        assert_eq!(parse_color(text), expected, "{text}");
    }
}

#[test]
fn background_and_palette_replies_are_recorded() {
    let mut replies = Replies::default();
    for text in ["11;rgb:ff/ff/ff", "4;15;rgb:1/2/3", "4;16;rgb:1/2/3", "4;x;rgb:1/2/3", "4;1;?", "10;#000000", "11;?"]
    {
        replies.take_osc(text.as_bytes());
    }
    replies.take_osc(b"11;\xff");
    assert_eq!(replies.background, Some(Srgb8::new(255, 255, 255)));
    assert_eq!(replies.sixteen[15], Some(Srgb8::new(17, 34, 51)));
    assert_eq!(replies.sixteen.iter().flatten().count(), 1);
}

#[test]
fn a_background_is_light_or_dark() {
    for (text, light) in
        [("#000000", false), ("#002b36", false), ("#555555", false), ("#fdf6e3", true), ("#ffffff", true)]
    {
        let mut replies = Replies::default();
        assert_eq!(replies.light_background(), None);
        replies.take_osc(format!("11;{text}").as_bytes());
        assert_eq!(replies.light_background(), Some(light), "{text}");
    }
}

#[test]
fn truecolor_terminals_keep_the_test_colour() {
    for (text, expected) in [
        ("1$r48;2;1;2;3m", Some(true)),
        ("1$r0;48:2::1:2:3m", Some(true)),
        ("1$r0;48:2:1:2:3m", Some(true)),
        ("1$r0;48:5:16m", Some(false)),
        ("1$r0;38:2::1:2:3m", Some(false)),
        ("1$r0m", Some(false)),
        ("0$r", None),
        ("0$r48;2;1;2;3m", None),
        ("1$r2 q", None),
        (">|XTerm(379)", None),
    ] {
        let mut replies = Replies::default();
        replies.take_dcs(text.as_bytes());
        assert_eq!(replies.truecolor, expected, "{text}");
    }
}

#[test]
fn mode_states_1_to_3_mean_support() {
    for (state, known) in [(0, false), (1, true), (2, true), (3, true), (4, false), (9, false)] {
        let mut replies = Replies::default();
        for mode in [2026, 1006, 1016, 7] {
            replies.take_mode(mode, state);
        }
        let expected = [Some(known); 3];
        assert_eq!([replies.synchronized_output, replies.sgr_mouse, replies.pixel_mouse], expected, "{state}");
    }
}

#[test]
fn a_blocks_width_follows_from_the_cursor_column() {
    for (column, width) in [(0, None), (1, None), (2, Some(1)), (3, Some(2)), (4, Some(3))] {
        let mut replies = Replies::default();
        replies.take_cursor(column);
        assert_eq!(replies.block_width, width, "{column}");
    }
}
