//! Decoders for keys in their various encodings: legacy, rxvt, xterm and kitty.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, MediaKeyCode, ModifierKeyCode};

/// Returns the Escape key.
pub(super) fn escape_key() -> KeyEvent {
    KeyCode::Esc.into()
}

/// Returns function key `number`.
pub(super) fn function_key(number: u8) -> KeyEvent {
    KeyCode::F(number).into()
}

/// Returns the key of a typed character.
///
/// `None` for U+FFFD, which stands for invalid bytes, and for the C1 controls.
pub(super) fn from_char(c: char) -> Option<KeyEvent> {
    match c {
        '\u{7f}' => Some(KeyCode::Backspace.into()),
        '\u{fffd}' => None,
        c if c.is_control() => None,
        // crossterm's own parser reports capitals with Shift as well.
        c if c.is_uppercase() => Some(KeyEvent::new(KeyCode::Char(c), KeyModifiers::SHIFT)),
        c => Some(KeyCode::Char(c).into()),
    }
}

/// Returns the key of a control character: Backspace, Tab, Enter, or Ctrl with a letter.
///
/// A line feed is Ctrl+J, because the Enter key sends a carriage return in raw mode.
pub(super) fn from_control(byte: u8) -> Option<KeyEvent> {
    let letter = match byte {
        0x08 => return Some(KeyCode::Backspace.into()),
        b'\t' => return Some(KeyCode::Tab.into()),
        b'\r' => return Some(KeyCode::Enter.into()),
        // Ctrl with Space, @ or 2 sends the byte 0. It is reported as Space, the key that people use.
        0x00 => b' ',
        0x01..=0x1a => byte - 1 + b'a',
        // Ctrl with \ ] ^ or _ sends the same byte as Ctrl with 4 to 7, and crossterm reports the digits.
        0x1c..=0x1f => byte - 0x1c + b'4',
        _ => return None,
    };
    Some(KeyEvent::new(KeyCode::Char(letter.into()), KeyModifiers::CONTROL))
}

/// Decodes `ESC O numbers letter`. The optional `numbers` are `1 ; modifiers` or `modifiers`.
pub(super) fn from_ss3(numbers: &[u8], letter: u8) -> Option<KeyEvent> {
    let last = numbers.rsplit(|&byte| byte == b';').next().unwrap_or_default();
    let modifiers = match std::str::from_utf8(last).ok()? {
        "" => KeyModifiers::NONE,
        digits => modifiers_from_mask(digits.parse().ok()?),
    };
    match letter {
        // Arrow keys with Ctrl in rxvt.
        b'a'..=b'd' => {
            let letter = char::from(letter.to_ascii_uppercase());
            from_letter(letter, modifiers | KeyModifiers::CONTROL)
        }
        // F3. After `ESC O`, `R` is a key even with parameters; after CSI, `R` with parameters is a cursor report.
        b'R' => Some(KeyEvent::new(KeyCode::F(3), modifiers)),
        _ => from_letter(letter.into(), modifiers).or_else(|| from_keypad(letter, modifiers)),
    }
}

/// Returns the keypad key that sends `ESC O letter` in application keypad mode.
fn from_keypad(letter: u8, modifiers: KeyModifiers) -> Option<KeyEvent> {
    let code = match letter {
        // Each letter is the ASCII code of the key's character plus 0x40.
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

/// Returns the key that sends `letter` after `ESC [` or `ESC O`.
pub(super) fn from_letter(letter: char, modifiers: KeyModifiers) -> Option<KeyEvent> {
    let code = match letter {
        'A' => KeyCode::Up,
        'B' => KeyCode::Down,
        'C' => KeyCode::Right,
        'D' => KeyCode::Left,
        // Key 5 of the keypad without Num Lock.
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

/// Decodes `CSI 1 ; modifiers : kind letter`, or `CSI letter`.
pub(super) fn from_letter_with_modifiers(letter: char, params: &[&[u16]]) -> Option<KeyEvent> {
    let press = Press::from_params(params.get(1))?;
    // Other first parameters, as in an echoed cursor movement (`CSI 5 A`), are not keys.
    if params.len() > 2 || !matches!(params[0], [0 | 1]) {
        return None;
    }
    match letter {
        // Shift+Tab. The legacy form has no parameter for Shift.
        'Z' => Some(press.key_event(KeyCode::BackTab, KeyModifiers::SHIFT)),
        // F3, only without parameters: with them `CSI R` is a cursor report and is not passed to this function.
        'R' => Some(press.key_event(KeyCode::F(3), KeyModifiers::NONE)),
        _ => from_letter(letter, KeyModifiers::NONE).map(|key| press.key_event(key.code, KeyModifiers::NONE)),
    }
}

/// Decodes `CSI number ; modifiers : kind ~`.
///
/// `more_modifiers` are those that rxvt encodes by a final byte other than `~`.
pub(super) fn from_number(params: &[&[u16]], more_modifiers: KeyModifiers) -> Option<KeyEvent> {
    let press = Press::from_params(params.get(1))?;
    let [number] = *params[0] else {
        return None;
    };
    let code = match u8::try_from(number).ok()? {
        // The numbers have gaps (16, 22, 27, 30) from the groups of function keys on the VT220.
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
    // With more parameters the sequence is not a key, but another kind of report.
    (params.len() <= 2).then(|| press.key_event(code, more_modifiers))
}

/// Decodes `CSI 27 ; modifiers ; code ~`: xterm's `modifyOtherKeys`.
pub(super) fn from_other_keys(params: &[&[u16]]) -> Option<KeyEvent> {
    let [_, modifiers, code] = params else {
        return None;
    };
    let press = Press::from_params(Some(modifiers))?;
    key_from_code(code.first().copied()?, None, press)
}

/// Decodes `CSI code : shifted : base ; modifiers : kind ; text u`: the kitty keyboard protocol.
///
/// A key of a non-Latin layout is reported as the key at the same position of a Latin layout (`base`), if the terminal
/// sends that, because letters are commands here, not text.
///
/// Characters above U+FFFF are ignored: the tokeniser saturates parameters at 16 bits, so they cannot be told apart.
pub(super) fn from_kitty(params: &[&[u16]]) -> Option<KeyEvent> {
    let press = Press::from_params(params.get(1))?;
    let alternate = |at: usize| params[0].get(at).copied().filter(|&code| code != 0);
    let (code, shifted) = match (params[0][0], alternate(2)) {
        (LATIN_END.., Some(base @ 0x20..0x7f)) => (base, None),
        (code, _) => (code, alternate(1)),
    };
    // Further parameters are reserved: later versions of the protocol may change the meaning of the first three.
    if params.len() > 3 {
        return None;
    }
    if let Some(key) = functional_key(code) {
        return Some(press.key_event(key, KeyModifiers::NONE));
    }
    if let Some(key) = keypad_key(code) {
        let mut event = press.key_event(key, KeyModifiers::NONE);
        event.state |= KeyEventState::KEYPAD;
        return Some(event);
    }
    key_from_code(code, shifted, press)
}

/// The first code point after the Unicode blocks of Latin letters: the start of Greek.
// A key with this code point or a higher one belongs to a non-Latin layout.
const LATIN_END: u16 = 0x370;

/// Returns the key of a key code of the kitty protocol.
///
/// `shifted` is the code of the same key with Shift, if the terminal reports it.
fn key_from_code(code: u16, shifted: Option<u16>, press: Press) -> Option<KeyEvent> {
    let key = match code {
        0x08 | 0x7f => KeyCode::Backspace,
        // `BackTab`, as in the legacy encoding, so that the keymap needs one name for Shift+Tab.
        0x09 if press.modifiers.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        0x09 => KeyCode::Tab,
        0x0d => KeyCode::Enter,
        0x1b => KeyCode::Esc,
        _ => return Some(press.press_char(char_from_code(code)?, shifted.and_then(char_from_code))),
    };
    Some(press.key_event(key, KeyModifiers::NONE))
}

/// Returns the character of a code point; `None` if it cannot be typed.
///
/// Excluded are control characters, the private use area, where the kitty protocol has its functional keys, and
/// U+FFFF, at which the tokeniser saturates.
fn char_from_code(code: u16) -> Option<char> {
    char::from_u32(code.into()).filter(|c| !c.is_control() && !matches!(code, 0xe000..=0xf8ff | 0xfffd..))
}

/// The modifiers, the kind (press, repeat or release) and the locks of a key event.
#[derive(Clone, Copy)]
struct Press {
    modifiers: KeyModifiers,
    kind: KeyEventKind,
    state: KeyEventState,
}

impl Press {
    /// Decodes the parameter `modifiers : kind`; `None` for an unknown kind.
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
            // Other kinds may exist in later versions of the protocol.
            _ => return None,
        };
        Some(Self { modifiers: modifiers_from_mask(mask), kind, state: state_from_mask(mask) })
    }

    fn key_event(self, code: KeyCode, more_modifiers: KeyModifiers) -> KeyEvent {
        KeyEvent::new_with_kind_and_state(code, self.modifiers | more_modifiers, self.kind, self.state)
    }

    /// Returns the event of a character key, in the form that the legacy encoding would lead to.
    ///
    /// Shift and `w` become `W` with the modifier Shift. Shift and `/` become `?` without it, if the terminal reports
    /// the shifted character.
    fn press_char(self, c: char, shifted: Option<char>) -> KeyEvent {
        if !self.modifiers.contains(KeyModifiers::SHIFT) {
            return self.key_event(KeyCode::Char(c), KeyModifiers::NONE);
        }
        let shown = shifted.unwrap_or_else(|| upper_case(c));
        let mut event = self.key_event(KeyCode::Char(shown), KeyModifiers::NONE);
        // A shifted character already contains Shift. Only capitals keep the modifier, as crossterm reports them.
        if shifted.is_some() && !shown.is_uppercase() {
            event.modifiers.remove(KeyModifiers::SHIFT);
        }
        event
    }
}

/// Returns the upper case of a letter if it is a single character, otherwise the letter itself.
fn upper_case(c: char) -> char {
    // The upper case of the German sharp s is two letters, which no key types.
    let mut upper = c.to_uppercase();
    match (upper.next(), upper.next()) {
        (Some(upper), None) => upper,
        _ => c,
    }
}

/// Returns the modifiers encoded in a parameter `mask`, which is a bit mask plus 1.
fn modifiers_from_mask(mask: u16) -> KeyModifiers {
    // Converted bit by bit: crossterm has the protocol's order today, but does not guarantee it.
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

/// Returns the locks (Caps Lock, Num Lock) encoded in a parameter `mask`, which is a bit mask plus
/// 1.
fn state_from_mask(mask: u16) -> KeyEventState {
    let bits = mask.saturating_sub(1);
    let mut state = KeyEventState::NONE;
    state.set(KeyEventState::CAPS_LOCK, bits & 64 != 0);
    state.set(KeyEventState::NUM_LOCK, bits & 128 != 0);
    state
}

/// Returns the keypad key with a functional key code of the kitty protocol.
fn keypad_key(code: u16) -> Option<KeyCode> {
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

/// Returns the key with a functional key code of the kitty protocol, except those of the keypad.
///
/// It is a lock, function (F13 and up), media or modifier key, or `PrintScreen`, Pause or Menu.
fn functional_key(code: u16) -> Option<KeyCode> {
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
