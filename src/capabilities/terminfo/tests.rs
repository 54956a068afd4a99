use super::*;

/// Returns a compiled terminfo entry, as in term(5), with a number of colours, an extended flag and
/// a string.
fn entry(colors: Option<i16>, flag: &str) -> Vec<u8> {
    let len = |text: &str| i16::try_from(text.len()).expect("it is short");
    let shorts = |numbers: &[i16]| -> Vec<u8> { numbers.iter().flat_map(|number| number.to_le_bytes()).collect() };
    let mut bytes = shorts(&[0o432, 2, 0, 14, 0, 0]);
    bytes.extend_from_slice(b"x\0");
    bytes.extend(shorts(&[-1; 13]));
    bytes.extend(shorts(&[colors.unwrap_or(-1)]));
    let table = format!("v\0{flag}\0Xv\0");
    bytes.extend(shorts(&[1, 0, 1, 3, len(&table)]));
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend(shorts(&[0, 0, len(flag) + 1]));
    bytes.extend_from_slice(table.as_bytes());
    bytes
}

#[test]
fn the_flag_precedes_the_number() {
    for (colors, flag, expected) in [
        (Some(256), "AX", Colors::Indexed256),
        (Some(256), "Tc", Colors::Truecolor),
        (Some(8), "RGB", Colors::Truecolor),
        (Some(88), "AX", Colors::SIXTEEN),
        (Some(8), "AX", Colors::SIXTEEN),
        (Some(2), "AX", Colors::None),
        (None, "AX", Colors::None),
    ] {
        let entry = TermInfo::parse(&entry(colors, flag)[..]).expect("it is an entry");
        assert_eq!(entry_colors(&entry), expected, "{colors:?} {flag}");
    }
}

/// Checks that truncated entries, and entries with any changed byte, are parsed without a panic.
#[test]
fn broken_entries_do_not_panic() {
    let whole = entry(Some(256), "Tc");
    for end in 0..whole.len() {
        let _ = TermInfo::parse(&whole[..end]).map(|entry| entry_colors(&entry));
    }
    assert!(TermInfo::parse(&whole[..30]).is_err());
    for at in 0..whole.len() {
        for byte in 0..=255 {
            let mut broken = whole.clone();
            broken[at] = byte;
            let _ = TermInfo::parse(&broken[..]).map(|entry| entry_colors(&entry));
        }
    }
}

#[test]
fn unknown_names_have_no_entry() {
    for name in ["", "no-such-terminal", "../x/xterm", "/etc/passwd", ".", "..", "x\0y"] {
        assert_eq!(terminfo_colors(name), None, "{name:?}");
    }
}
