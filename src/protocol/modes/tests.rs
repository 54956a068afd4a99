use super::*;

const BEYOND: [TerminalMode; 2] = [TerminalMode::MousePixels, TerminalMode::Keyboard];

#[test]
fn modes_are_switched_off_in_reverse_order() {
    let (mut modes, mut on, mut off) = (TerminalModes::default(), Vec::new(), Vec::new());
    let all: Vec<_> = TerminalMode::ALL_TERMINALS.into_iter().chain(BEYOND).collect();
    for &mode in &all {
        modes.switch_on(mode, &mut on);
    }
    modes.switch_all_off(&mut off);
    let expected: String = all.iter().rev().map(|mode| mode.off_sequence()).collect();
    assert_eq!(String::from_utf8_lossy(&off), expected);
    assert_eq!(modes, TerminalModes::default());
}

#[test]
fn a_mode_is_switched_on_and_off_once() {
    let (mut modes, mut bytes) = (TerminalModes::default(), Vec::new());
    modes.switch_on(TerminalMode::MousePixels, &mut bytes);
    modes.switch_on(TerminalMode::MousePixels, &mut bytes);
    assert!(modes.is_on(TerminalMode::MousePixels) && !modes.is_on(TerminalMode::Keyboard));
    modes.switch_all_off(&mut bytes);
    modes.switch_all_off(&mut bytes);
    assert_eq!(bytes, b"\x1b[?1016h\x1b[?1016l");
}
