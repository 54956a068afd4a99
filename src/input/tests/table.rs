//! The table of byte sequences and the inputs that they are parsed into.

use crate::input::{Input, Reply};
use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, MediaKeyCode, ModifierKeyCode, MouseButton,
    MouseEvent, MouseEventKind,
};

pub(super) const NONE: KeyModifiers = KeyModifiers::NONE;
const SHIFT: KeyModifiers = KeyModifiers::SHIFT;
pub(super) const ALT: KeyModifiers = KeyModifiers::ALT;
pub(super) const CONTROL: KeyModifiers = KeyModifiers::CONTROL;

type Case = (&'static [u8], Vec<Input>);

// -- shorthands for expected inputs -----------------------------------------------------------------------------------

pub(super) fn key(code: KeyCode, modifiers: KeyModifiers) -> Input {
    KeyEvent::new(code, modifiers).into()
}

pub(super) fn letter(c: char, modifiers: KeyModifiers) -> Input {
    key(KeyCode::Char(c), modifiers)
}

pub(super) fn of_kind(code: KeyCode, modifiers: KeyModifiers, kind: KeyEventKind) -> Input {
    KeyEvent::new_with_kind(code, modifiers, kind).into()
}

fn with_state(code: KeyCode, state: KeyEventState) -> Input {
    KeyEvent::new_with_kind_and_state(code, NONE, KeyEventKind::Press, state).into()
}

fn mouse(kind: MouseEventKind, column: u16, row: u16, modifiers: KeyModifiers) -> Input {
    Input::Event(Event::Mouse(MouseEvent { kind, column, row, modifiers }))
}

pub(super) fn paste(text: &str) -> Input {
    Input::Event(Event::Paste(text.to_owned()))
}

pub(super) fn reply(reply: Reply) -> Input {
    Input::Reply(reply)
}

fn unknown(text: &[u8]) -> Input {
    Input::Reply(Reply::Unknown(text.to_vec()))
}

// -- the table --------------------------------------------------------------------------------------------------------

fn characters() -> Vec<Case> {
    let up = KeyCode::Up;
    vec![
        (b"w", vec![letter('w', NONE)]),
        (b"W", vec![letter('W', SHIFT)]),
        (b"?/1 ", ['?', '/', '1', ' '].map(|c| letter(c, NONE)).to_vec()),
        ("é".as_bytes(), vec![letter('é', NONE)]),
        ("É€😀".as_bytes(), vec![letter('É', SHIFT), letter('€', NONE), letter('😀', NONE)]),
        (b"\r\t\x7f\x08", {
            let back = key(KeyCode::Backspace, NONE);
            vec![key(KeyCode::Enter, NONE), key(KeyCode::Tab, NONE), back.clone(), back]
        }),
        (b"\x01\x03\x0a\x0c\x1a", ['a', 'c', 'j', 'l', 'z'].map(|c| letter(c, CONTROL)).to_vec()),
        (b"\x00\x1c\x1f", [' ', '4', '7'].map(|c| letter(c, CONTROL)).to_vec()),
        (b"\x1bw\x1bW", vec![letter('w', ALT), letter('W', ALT | SHIFT)]),
        (b"\x1b\x03", vec![letter('c', ALT | CONTROL)]),
        (b"\x1b\r\x1b\x7fx", {
            let enter = key(KeyCode::Enter, ALT);
            vec![enter, key(KeyCode::Backspace, ALT), letter('x', NONE)]
        }),
        ("\x1béx".as_bytes(), vec![letter('é', ALT), letter('x', NONE)]),
        (b"\x1b\x1b[A", vec![key(up, ALT)]),
        (b"\x1b\x1bOA", vec![key(up, ALT)]),
        (b"\x1b\x1b\x1b[A", vec![key(KeyCode::Esc, NONE), key(up, ALT)]),
        (b"\x1b\x1bx", vec![key(KeyCode::Esc, NONE), letter('x', ALT)]),
    ]
}

fn broken_characters() -> Vec<Case> {
    vec![
        (b"a\xffb\xc3c\x80\x9b\xe2\x82d", ['a', 'b', 'c', 'd'].map(|c| letter(c, NONE)).to_vec()),
        (b"\xe2\x82\x1b[A\xc3\xc3\xa9", vec![key(KeyCode::Up, NONE), letter('é', NONE)]),
        // A C1 control in UTF-8, a surrogate, and U+FFFD, which is indistinguishable from invalid bytes.
        (b"\xc2\x9b\xed\xa0\x80\xef\xbf\xbd", vec![]),
        (b"\x1b\xc3x\x1b\xffy", vec![letter('x', NONE), letter('y', NONE)]),
    ]
}

pub(super) fn keys_without_a_letter() -> Vec<Case> {
    use KeyCode::{BackTab, Delete, Down, End, F, Home, Insert, KeypadBegin, Left, PageDown, PageUp, Right, Up};
    let keys =
        |codes: &[KeyCode], modifiers| -> Vec<Input> { codes.iter().map(|&code| key(code, modifiers)).collect() };
    let arrows = [Up, Down, Right, Left];
    vec![
        (b"\x1b[A\x1b[B\x1b[C\x1b[D", keys(&arrows, NONE)),
        (b"\x1bOA\x1bOB\x1bOC\x1bOD", keys(&arrows, NONE)),
        (b"\x1b[1;2A\x1b[1;2B\x1b[1;2C\x1b[1;2D", keys(&arrows, SHIFT)),
        (b"\x1b[a\x1b[b\x1b[c\x1b[d", keys(&arrows, SHIFT)),
        (b"\x1bOa\x1bOb\x1bOc\x1bOd", keys(&arrows, CONTROL)),
        (b"\x1b[1;8A", keys(&[Up], SHIFT | ALT | CONTROL)),
        (b"\x1bO5A\x1bO1;5A", keys(&[Up, Up], CONTROL)),
        (b"\x1b[H\x1b[F\x1bOH\x1bOF\x1b[E", keys(&[Home, End, Home, End, KeypadBegin], NONE)),
        (b"\x1b[1~\x1b[4~\x1b[7~\x1b[8~", keys(&[Home, End, Home, End], NONE)),
        (b"\x1b[2~\x1b[3~\x1b[5~\x1b[6~", keys(&[Insert, Delete, PageUp, PageDown], NONE)),
        (b"\x1b[5;2~\x1b[6;5~", vec![key(PageUp, SHIFT), key(PageDown, CONTROL)]),
        (b"\x1b[7^\x1b[8@", vec![key(Home, CONTROL), key(End, CONTROL | SHIFT)]),
        (b"\x1bOP\x1bOQ\x1bOR\x1bOS", keys(&[F(1), F(2), F(3), F(4)], NONE)),
        (b"\x1b[P\x1b[Q\x1b[R\x1b[S", keys(&[F(1), F(2), F(3), F(4)], NONE)),
        (b"\x1b[1;5P\x1b[15;5~", keys(&[F(1), F(5)], CONTROL)),
        (b"\x1b[11~\x1b[15~\x1b[17~\x1b[21~", keys(&[F(1), F(5), F(6), F(10)], NONE)),
        (b"\x1b[23~\x1b[24~\x1b[29~\x1b[34~", keys(&[F(11), F(12), F(16), F(20)], NONE)),
        (b"\x1b[[A\x1b[[Ex", vec![key(F(1), NONE), key(F(5), NONE), letter('x', NONE)]),
        (b"\x1b[Z\x1b[1;6Z", vec![key(BackTab, SHIFT), key(BackTab, SHIFT | CONTROL)]),
        (b"\x1bOp\x1bOk\x1bOM", {
            let pad = |code| with_state(code, KeyEventState::KEYPAD);
            vec![pad(KeyCode::Char('0')), pad(KeyCode::Char('+')), pad(KeyCode::Enter)]
        }),
        (b"\x1b[27;5;9~\x1b[27;6;9~", vec![key(KeyCode::Tab, CONTROL), key(BackTab, SHIFT | CONTROL)]),
    ]
}

pub(super) fn kitty_keys() -> Vec<Case> {
    use KeyEventKind::{Press, Release, Repeat};
    let w = KeyCode::Char('w');
    let shift = KeyCode::Modifier(ModifierKeyCode::LeftShift);
    vec![
        (b"\x1b[119u\x1b[119;1u\x1b[119;;119u", vec![key(w, NONE), key(w, NONE), key(w, NONE)]),
        (b"\x1b[119;1:1u\x1b[119;1:2u\x1b[119;1:3u", {
            [Press, Repeat, Release].map(|kind| of_kind(w, NONE, kind)).to_vec()
        }),
        (b"\x1b[99;5u", vec![letter('c', CONTROL)]),
        (b"\x1b[119;2u\x1b[119:87;2u\x1b[119:87:119;2:3u", {
            let upper = KeyCode::Char('W');
            vec![key(upper, SHIFT), key(upper, SHIFT), of_kind(upper, SHIFT, Release)]
        }),
        (b"\x1b[47:63;2u\x1b[47;2u", vec![letter('?', NONE), letter('/', SHIFT)]),
        (b"\x1b[1094::119;1u\x1b[1094:1062:119;2u\x1b[1089::99;5u", {
            // Non-Latin keys are reported by their position on a Latin keyboard, Latin keys by their letter.
            vec![letter('w', NONE), letter('W', SHIFT), letter('c', CONTROL)]
        }),
        (b"\x1b[1094;1u\x1b[122::119;1u\x1b[246::59;1u", ['ц', 'z', 'ö'].map(|c| letter(c, NONE)).to_vec()),
        (b"\x1b[27u\x1b[13u\x1b[127u\x1b[9u\x1b[9;2u", {
            let plain = [KeyCode::Esc, KeyCode::Enter, KeyCode::Backspace, KeyCode::Tab];
            let mut keys = plain.map(|code| key(code, NONE)).to_vec();
            keys.push(key(KeyCode::BackTab, SHIFT));
            keys
        }),
        (b"\x1b[119;65u\x1b[119;129u", {
            vec![with_state(w, KeyEventState::CAPS_LOCK), with_state(w, KeyEventState::NUM_LOCK)]
        }),
        (b"\x1b[119;9u\x1b[119;17u\x1b[119;33u", {
            [KeyModifiers::SUPER, KeyModifiers::HYPER, KeyModifiers::META]
                .map(|modifier| letter('w', modifier))
                .to_vec()
        }),
        (b"\x1b[1;1:3A\x1b[5;5:2~\x1b[13;1:3~", {
            vec![
                of_kind(KeyCode::Up, NONE, Release),
                of_kind(KeyCode::PageUp, CONTROL, Repeat),
                of_kind(KeyCode::F(3), NONE, Release),
            ]
        }),
        (b"\x1b[57441;2u\x1b[57441;1:3u", vec![key(shift, SHIFT), of_kind(shift, NONE, Release)]),
        (b"\x1b[57376u\x1b[57398u\x1b[57358u\x1b[57440u", {
            let mute = KeyCode::Media(MediaKeyCode::MuteVolume);
            [KeyCode::F(13), KeyCode::F(35), KeyCode::CapsLock, mute].map(|code| key(code, NONE)).to_vec()
        }),
        (b"\x1b[57399u\x1b[57408u\x1b[57414u\x1b[57427u", {
            let enter = KeyCode::Enter;
            [KeyCode::Char('0'), KeyCode::Char('9'), enter, KeyCode::KeypadBegin]
                .map(|code| with_state(code, KeyEventState::KEYPAD))
                .to_vec()
        }),
        (b"\x1b[65535u\x1b[128512u\x1b[57345u\x1b[0u\x1b[u\x1b[119;1:4u", {
            [&b"65535u"[..], b"128512u", b"57345u", b"0u", b"u", b"119;1:4u"].map(unknown).to_vec()
        }),
    ]
}

fn mouse_reports() -> Vec<Case> {
    use MouseButton::{Left, Middle, Right};
    use MouseEventKind::{Down, Drag, Moved, ScrollDown, ScrollLeft, ScrollRight, ScrollUp, Up};
    vec![
        (b"\x1b[<0;1;1M\x1b[<1;80;24M\x1b[<2;300;200M", {
            let at = |button, x, y| mouse(Down(button), x, y, NONE);
            vec![at(Left, 0, 0), at(Middle, 79, 23), at(Right, 299, 199)]
        }),
        (b"\x1b[<0;3;4m\x1b[<2;3;4m", vec![mouse(Up(Left), 2, 3, NONE), mouse(Up(Right), 2, 3, NONE)]),
        (b"\x1b[<32;3;4M\x1b[<35;3;4M", vec![mouse(Drag(Left), 2, 3, NONE), mouse(Moved, 2, 3, NONE)]),
        (b"\x1b[<64;1;1M\x1b[<65;1;1M\x1b[<66;1;1M\x1b[<67;1;1M", {
            [ScrollUp, ScrollDown, ScrollLeft, ScrollRight].map(|k| mouse(k, 0, 0, NONE)).to_vec()
        }),
        (b"\x1b[<28;1;1M", vec![mouse(Down(Left), 0, 0, SHIFT | ALT | CONTROL)]),
        (b"\x1b[<0;0;0M", vec![mouse(Down(Left), 0, 0, NONE)]),
        (b"\x1b[32;3;4M\x1b[35;3;4M", vec![mouse(Down(Left), 2, 3, NONE), mouse(Up(Left), 2, 3, NONE)]),
        (b"\x1b[M #$x", vec![mouse(Down(Left), 2, 3, NONE), letter('x', NONE)]),
        (b"\x1b[M #\x03", vec![letter('c', CONTROL)]),
        (b"\x1b[<0;1M\x1b[<128;1;1M\x1b[<64;1;1m\x1b[<0;-1;1M", {
            [&b"<0;1M"[..], b"<128;1;1M", b"<64;1;1m"].map(unknown).to_vec()
        }),
        (b"\x1b[I\x1b[O", vec![Input::Event(Event::FocusGained), Input::Event(Event::FocusLost)]),
    ]
}

fn pastes() -> Vec<Case> {
    vec![
        (b"\x1b[200~q\x03\x1b[A\x1b[201~x", vec![paste("q\x03\x1b[A"), letter('x', NONE)]),
        (b"\x1b[200~\x1b[201~", vec![paste("")]),
        (b"\x1b[200~\x1b[20\x1b\x1b[201~", vec![paste("\x1b[20\x1b")]),
        (b"\x1b[200~\x1b[200~\xff\xc3\xa9\x1b[201~", vec![paste("\x1b[200~\u{fffd}é")]),
        (b"\x1b\x1b[200~q\x1b[201~", vec![key(KeyCode::Esc, NONE), paste("q")]),
        (b"\x1b[201~x", vec![letter('x', NONE)]),
    ]
}

pub(super) fn replies() -> Vec<Case> {
    vec![
        (b"\x1b[?62;22c", vec![reply(Reply::DeviceAttributes(vec![62, 22]))]),
        (b"\x1b[>41;354;0c", vec![reply(Reply::SecondaryAttributes(vec![41, 354, 0]))]),
        (b"\x1b[12;40R", vec![reply(Reply::CursorPosition { row: 12, column: 40 })]),
        (b"\x1b[1;2R", vec![reply(Reply::CursorPosition { row: 1, column: 2 })]),
        (b"\x1b[?12;40;1R", vec![reply(Reply::CursorPosition { row: 12, column: 40 })]),
        (b"\x1b[0n\x1b[n", vec![reply(Reply::Status(0)), reply(Reply::Status(0))]),
        (b"\x1b[?2026;2$y", vec![reply(Reply::Mode { mode: 2026, state: 2 })]),
        (b"\x1b[6;19;10t", vec![reply(Reply::CellPixels { width: 10, height: 19 })]),
        (b"\x1b[4;456;800t", vec![reply(Reply::TextPixels { width: 800, height: 456 })]),
        (b"\x1b[8;24;80t", vec![reply(Reply::TextCells { columns: 80, rows: 24 })]),
        (b"\x1b[48;24;80;456;800t", vec![reply(Reply::Window(vec![48, 24, 80, 456, 800]))]),
        (b"\x1b[?11u\x1b[?u", [11, 0].map(|flags| reply(Reply::KeyboardFlags(flags))).to_vec()),
    ]
}

pub(super) fn replies_in_strings_and_others() -> Vec<Case> {
    vec![
        (b"\x1b]11;rgb:1e1e/1e1e/1e1e\x07", vec![reply(Reply::Osc(b"11;rgb:1e1e/1e1e/1e1e".to_vec()))]),
        (b"\x1b]4;1;rgb:cc/0/0\x1b\\x", vec![reply(Reply::Osc(b"4;1;rgb:cc/0/0".to_vec())), letter('x', NONE)]),
        (b"\x1bP1$r48;2;1;2;3m\x1b\\", vec![reply(Reply::Dcs(b"1$r48;2;1;2;3m".to_vec()))]),
        (b"\x1bP>|XTerm(380)\x1b\\", vec![reply(Reply::Dcs(b">|XTerm(380)".to_vec()))]),
        (b"\x1b_Gi=31;OK\x1b\\", vec![reply(Reply::Apc(b"Gi=31;OK".to_vec()))]),
        (b"\x1b[?997;1n", vec![unknown(b"?997;1n")]),
        (b"\x1b[?1;0;256S", vec![unknown(b"?1;0;256S")]),
        (b"\x1b[4;1$y", vec![unknown(b"4;1$y")]),
        (b"\x1b[7;5A\x1b[1;2;3A\x1b[99~", { [&b"7;5A"[..], b"1;2;3A", b"99~"].map(unknown).to_vec() }),
        // The Escape key pressed just before a reply arrives.
        (b"\x1b\x1b[?62c", vec![key(KeyCode::Esc, NONE), reply(Reply::DeviceAttributes(vec![62]))]),
        (b"\x1b\x1b]11;?\x07", vec![key(KeyCode::Esc, NONE), reply(Reply::Osc(b"11;?".to_vec()))]),
    ]
}

fn broken_sequences() -> Vec<Case> {
    vec![
        // A sequence that starts within another aborts it.
        (b"\x1b[1;\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1bO\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1b]11;\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1bP1$r\x1b]4;0;x\x07", vec![reply(Reply::Osc(b"4;0;x".to_vec()))]),
        // CAN and SUB abort a sequence, and are reported as Ctrl-X and Ctrl-Z.
        (b"\x1b[1;\x18A", vec![letter('x', CONTROL), letter('A', SHIFT)]),
        (b"\x1b]11;\x1aA", vec![letter('z', CONTROL), letter('A', SHIFT)]),
        // A control character inside a sequence is reported as a key, and the sequence goes on.
        (b"\x1b[1;\x035A", vec![letter('c', CONTROL), key(KeyCode::Up, CONTROL)]),
        // Strings of kinds that are never replies (SOS and PM).
        (b"\x1bXnoise\x1b\\\x1b^noise\x1b\\", vec![]),
        // Sequences that no terminal sends.
        (b"\x1b[1?5Ax\x1b[ 1Ay", vec![letter('x', NONE), letter('y', NONE)]),
        (b"\x1bO!x\x1bO9;9;9Zy", vec![letter('x', NONE), letter('y', NONE)]),
        (b"\x1b[1;2$%&'A", vec![unknown(b"1;2$%&'A")]),
        (b"\x1b[[zx", vec![letter('x', NONE)]),
        (b"\x1b[[\x03", vec![letter('c', CONTROL)]),
        (b"\x1b]\x1b\\\x1bP\x1b\\", vec![reply(Reply::Osc(vec![])), reply(Reply::Dcs(vec![]))]),
        (b"\x1b[\x80\xffA\x1b[\x7fB", vec![key(KeyCode::Up, NONE), key(KeyCode::Down, NONE)]),
    ]
}

pub(super) fn table() -> Vec<Case> {
    [
        characters(),
        broken_characters(),
        keys_without_a_letter(),
        kitty_keys(),
        mouse_reports(),
        pastes(),
        replies(),
        replies_in_strings_and_others(),
        broken_sequences(),
    ]
    .concat()
}
