//! Keys: the many ways in which terminals name them.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, MediaKeyCode, ModifierKeyCode};

/// The Escape key.
pub(super) fn escape() -> KeyEvent {
    KeyCode::Esc.into()
}

/// The function key of this number.
pub(super) fn function(number: u8) -> KeyEvent {
    KeyCode::F(number).into()
}

/// A character typed; none for U+FFFD, which stands for broken bytes, and for the C1 controls.
pub(super) fn from_char(c: char) -> Option<KeyEvent> {
    match c {
        '\u{7f}' => Some(KeyCode::Backspace.into()),
        '\u{fffd}' => None,
        c if c.is_control() => None,
        c if c.is_uppercase() => Some(KeyEvent::new(KeyCode::Char(c), KeyModifiers::SHIFT)),
        c => Some(KeyCode::Char(c).into()),
    }
}

/// A control letter: the key of its own, or Ctrl and a letter. A line feed is Ctrl+J, since raw mode leaves the Enter
/// key its carriage return.
pub(super) fn from_control(byte: u8) -> Option<KeyEvent> {
    let letter = match byte {
        0x08 => return Some(KeyCode::Backspace.into()),
        b'\t' => return Some(KeyCode::Tab.into()),
        b'\r' => return Some(KeyCode::Enter.into()),
        0x00 => b' ',
        0x01..=0x1a => byte - 1 + b'a',
        // Ctrl+\ ] ^ _, which crossterm names after the digits that give the same.
        0x1c..=0x1f => byte - 0x1c + b'4',
        _ => return None,
    };
    Some(KeyEvent::new(KeyCode::Char(letter.into()), KeyModifiers::CONTROL))
}

/// `ESC O`, perhaps `1 ; modifiers` or the modifiers alone, and a letter.
pub(super) fn from_ss3(numbers: &[u8], letter: u8) -> Option<KeyEvent> {
    let last = numbers.rsplit(|&byte| byte == b';').next().unwrap_or_default();
    let modifiers = match std::str::from_utf8(last).ok()? {
        "" => KeyModifiers::NONE,
        digits => modifiers_from_mask(digits.parse().ok()?),
    };
    match letter {
        // The arrows of rxvt with Ctrl.
        b'a'..=b'd' => {
            let letter = char::from(letter.to_ascii_uppercase());
            from_letter(letter, modifiers | KeyModifiers::CONTROL)
        }
        b'R' => Some(KeyEvent::new(KeyCode::F(3), modifiers)),
        _ => from_letter(letter.into(), modifiers).or_else(|| from_keypad(letter, modifiers)),
    }
}

/// The keypad in application mode.
fn from_keypad(letter: u8, modifiers: KeyModifiers) -> Option<KeyEvent> {
    let code = match letter {
        b'p'..=b'y' => KeyCode::Char((letter - b'p' + b'0').into()),
        b'j'..=b'o' => KeyCode::Char((letter - b'j' + b'*').into()),
        b'X' => KeyCode::Char('='),
        b' ' => KeyCode::Char(' '),
        b'M' => KeyCode::Enter,
        b'I' => KeyCode::Tab,
        _ => return None,
    };
    let state = KeyEventState::KEYPAD;
    Some(KeyEvent::new_with_kind_and_state(code, modifiers, KeyEventKind::Press, state))
}

/// The key that a letter after `ESC [` or `ESC O` names.
pub(super) fn from_letter(letter: char, modifiers: KeyModifiers) -> Option<KeyEvent> {
    let code = match letter {
        'A' => KeyCode::Up,
        'B' => KeyCode::Down,
        'C' => KeyCode::Right,
        'D' => KeyCode::Left,
        'E' => KeyCode::KeypadBegin,
        'F' => KeyCode::End,
        'H' => KeyCode::Home,
        'P' => KeyCode::F(1),
        'Q' => KeyCode::F(2),
        'S' => KeyCode::F(4),
        _ => return None,
    };
    Some(KeyEvent::new(code, modifiers))
}

/// `CSI 1 ; modifiers : kind A`, or the letter alone.
pub(super) fn from_letter_with_modifiers(letter: char, params: &[&[u16]]) -> Option<KeyEvent> {
    let how = How::from_params(params.get(1))?;
    // An echo of our own cursor movements (`CSI 5 A`) is no key.
    if params.len() > 2 || !matches!(params[0], [0 | 1]) {
        return None;
    }
    match letter {
        'Z' => Some(how.press(KeyCode::BackTab, KeyModifiers::SHIFT)),
        // `CSI R` alone: with numbers it is a cursor report, and does not come here.
        'R' => Some(how.press(KeyCode::F(3), KeyModifiers::NONE)),
        _ => from_letter(letter, KeyModifiers::NONE).map(|key| how.press(key.code, KeyModifiers::NONE)),
    }
}

/// `CSI number ; modifiers : kind ~`, and the letters that rxvt puts in the place of `~`.
pub(super) fn from_number(params: &[&[u16]], more: KeyModifiers) -> Option<KeyEvent> {
    let how = How::from_params(params.get(1))?;
    let [number] = *params[0] else {
        return None;
    };
    let code = match u8::try_from(number).ok()? {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        n @ 11..=15 => KeyCode::F(n - 10),
        n @ 17..=21 => KeyCode::F(n - 11),
        n @ 23..=26 => KeyCode::F(n - 12),
        n @ 28..=29 => KeyCode::F(n - 13),
        n @ 31..=34 => KeyCode::F(n - 14),
        _ => return None,
    };
    (params.len() <= 2).then(|| how.press(code, more))
}

/// `CSI 27 ; modifiers ; code ~`: xterm's `modifyOtherKeys`.
pub(super) fn from_other_keys(params: &[&[u16]]) -> Option<KeyEvent> {
    let [_, modifiers, code] = params else {
        return None;
    };
    let how = How::from_params(Some(modifiers))?;
    key_from_code(code.first().copied()?, None, how)
}

/// `CSI code : shifted : base ; modifiers : kind ; text u`: the kitty keyboard protocol.
///
/// A key of an alphabet other than the Latin one goes by its place on a Latin keyboard where the terminal says it, with
/// what Shift makes of it there: the letter is a command here, not text.
///
/// Unicode above U+FFFF cannot be told apart here (the tokeniser keeps 16 bits) and is no key.
pub(super) fn from_kitty(params: &[&[u16]]) -> Option<KeyEvent> {
    let how = How::from_params(params.get(1))?;
    let alternate = |at: usize| params[0].get(at).copied().filter(|&code| code != 0);
    let (code, shifted) = match (params[0][0], alternate(2)) {
        (LATIN_END.., Some(base @ 0x20..0x7f)) => (base, None),
        (code, _) => (code, alternate(1)),
    };
    if params.len() > 3 {
        return None;
    }
    if let Some(key) = functional(code) {
        return Some(how.press(key, KeyModifiers::NONE));
    }
    if let Some(key) = keypad(code) {
        let mut event = how.press(key, KeyModifiers::NONE);
        event.state |= KeyEventState::KEYPAD;
        return Some(event);
    }
    key_from_code(code, shifted, how)
}

/// The first letter that is not Latin: Greek.
const LATIN_END: u16 = 0x370;

/// The key of a Unicode number, with the character that Shift makes of it where the terminal says so.
fn key_from_code(code: u16, shifted: Option<u16>, how: How) -> Option<KeyEvent> {
    let key = match code {
        0x08 | 0x7f => KeyCode::Backspace,
        0x09 if how.modifiers.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        0x09 => KeyCode::Tab,
        0x0d => KeyCode::Enter,
        0x1b => KeyCode::Esc,
        _ => return Some(how.press_char(char_from_code(code)?, shifted.and_then(char_from_code))),
    };
    Some(how.press(key, KeyModifiers::NONE))
}

/// The character of a number, if it can be typed: no control, no private use (where the protocol keeps its own
/// keys), and not U+FFFF, at which the tokeniser stops counting.
fn char_from_code(code: u16) -> Option<char> {
    char::from_u32(code.into()).filter(|c| !c.is_control() && !matches!(code, 0xe000..=0xf8ff | 0xfffd..))
}

/// How a key is pressed.
#[derive(Clone, Copy)]
struct How {
    modifiers: KeyModifiers,
    kind: KeyEventKind,
    state: KeyEventState,
}

impl How {
    /// From `modifiers : kind`; none where the kind is none that is known.
    fn from_params(param: Option<&&[u16]>) -> Option<Self> {
        let (mask, kind) = match param {
            None => (0, 1),
            Some([mask]) => (*mask, 1),
            Some([mask, kind]) => (*mask, *kind),
            Some(_) => return None,
        };
        let kind = match kind {
            0 | 1 => KeyEventKind::Press,
            2 => KeyEventKind::Repeat,
            3 => KeyEventKind::Release,
            _ => return None,
        };
        Some(Self { modifiers: modifiers_from_mask(mask), kind, state: state_from_mask(mask) })
    }

    fn press(self, code: KeyCode, more: KeyModifiers) -> KeyEvent {
        KeyEvent::new_with_kind_and_state(code, self.modifiers | more, self.kind, self.state)
    }

    /// A character, named as it would be without the protocol: Shift and `w` is `W` with Shift, Shift and `/` is `?`
    /// without, if the terminal says that it is.
    fn press_char(self, c: char, shifted: Option<char>) -> KeyEvent {
        if !self.modifiers.contains(KeyModifiers::SHIFT) {
            return self.press(KeyCode::Char(c), KeyModifiers::NONE);
        }
        let shown = shifted.unwrap_or_else(|| upper_case(c));
        let mut event = self.press(KeyCode::Char(shown), KeyModifiers::NONE);
        if shifted.is_some() && !shown.is_uppercase() {
            event.modifiers.remove(KeyModifiers::SHIFT);
        }
        event
    }
}

/// The capital of a letter, where it is one letter.
fn upper_case(c: char) -> char {
    let mut upper = c.to_uppercase();
    match (upper.next(), upper.next()) {
        (Some(upper), None) => upper,
        _ => c,
    }
}

/// The modifiers of a mask that counts from 1.
fn modifiers_from_mask(mask: u16) -> KeyModifiers {
    // The order of the bits is the same in the protocol and in crossterm, but it is crossterm's own affair.
    let order = [
        KeyModifiers::SHIFT,
        KeyModifiers::ALT,
        KeyModifiers::CONTROL,
        KeyModifiers::SUPER,
        KeyModifiers::HYPER,
        KeyModifiers::META,
    ];
    let bits = mask.saturating_sub(1);
    (0..).zip(order).filter(|(bit, _)| bits >> bit & 1 == 1).map(|(_, modifier)| modifier).collect()
}

/// The locks of a mask that counts from 1.
fn state_from_mask(mask: u16) -> KeyEventState {
    let bits = mask.saturating_sub(1);
    let mut state = KeyEventState::NONE;
    state.set(KeyEventState::CAPS_LOCK, bits & 64 != 0);
    state.set(KeyEventState::NUM_LOCK, bits & 128 != 0);
    state
}

/// The keys of the keypad, by the kitty protocol's numbers.
fn keypad(code: u16) -> Option<KeyCode> {
    const NAMED: [KeyCode; 19] = [
        KeyCode::Char('.'),
        KeyCode::Char('/'),
        KeyCode::Char('*'),
        KeyCode::Char('-'),
        KeyCode::Char('+'),
        KeyCode::Enter,
        KeyCode::Char('='),
        KeyCode::Char(','),
        KeyCode::Left,
        KeyCode::Right,
        KeyCode::Up,
        KeyCode::Down,
        KeyCode::PageUp,
        KeyCode::PageDown,
        KeyCode::Home,
        KeyCode::End,
        KeyCode::Insert,
        KeyCode::Delete,
        KeyCode::KeypadBegin,
    ];
    match code {
        57399..=57408 => Some(KeyCode::Char((b'0' + (code - 57399) as u8).into())),
        57409..=57427 => Some(NAMED[usize::from(code - 57409)]),
        _ => None,
    }
}

/// The keys that write nothing, by the kitty protocol's numbers.
fn functional(code: u16) -> Option<KeyCode> {
    const LOCKS: [KeyCode; 6] =
        [KeyCode::CapsLock, KeyCode::ScrollLock, KeyCode::NumLock, KeyCode::PrintScreen, KeyCode::Pause, KeyCode::Menu];
    const MEDIA: [MediaKeyCode; 13] = [
        MediaKeyCode::Play,
        MediaKeyCode::Pause,
        MediaKeyCode::PlayPause,
        MediaKeyCode::Reverse,
        MediaKeyCode::Stop,
        MediaKeyCode::FastForward,
        MediaKeyCode::Rewind,
        MediaKeyCode::TrackNext,
        MediaKeyCode::TrackPrevious,
        MediaKeyCode::Record,
        MediaKeyCode::LowerVolume,
        MediaKeyCode::RaiseVolume,
        MediaKeyCode::MuteVolume,
    ];
    const MODIFIERS: [ModifierKeyCode; 14] = [
        ModifierKeyCode::LeftShift,
        ModifierKeyCode::LeftControl,
        ModifierKeyCode::LeftAlt,
        ModifierKeyCode::LeftSuper,
        ModifierKeyCode::LeftHyper,
        ModifierKeyCode::LeftMeta,
        ModifierKeyCode::RightShift,
        ModifierKeyCode::RightControl,
        ModifierKeyCode::RightAlt,
        ModifierKeyCode::RightSuper,
        ModifierKeyCode::RightHyper,
        ModifierKeyCode::RightMeta,
        ModifierKeyCode::IsoLevel3Shift,
        ModifierKeyCode::IsoLevel5Shift,
    ];
    match code {
        57358..=57363 => Some(LOCKS[usize::from(code - 57358)]),
        57376..=57398 => Some(KeyCode::F((code - 57376) as u8 + 13)),
        57428..=57440 => Some(KeyCode::Media(MEDIA[usize::from(code - 57428)])),
        57441..=57454 => Some(KeyCode::Modifier(MODIFIERS[usize::from(code - 57441)])),
        _ => None,
    }
}
