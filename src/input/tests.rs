//! What bytes say, as a table; and that it does not depend on how they are split.

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers, MediaKeyCode, ModifierKeyCode, MouseButton,
    MouseEvent, MouseEventKind,
};
use proptest::prelude::*;

use super::{Input, PASTE_LIMIT, PASTE_PATIENCE, Parser, Reply};

const NONE: KeyModifiers = KeyModifiers::NONE;
const SHIFT: KeyModifiers = KeyModifiers::SHIFT;
const ALT: KeyModifiers = KeyModifiers::ALT;
const CONTROL: KeyModifiers = KeyModifiers::CONTROL;

type Row = (&'static [u8], Vec<Input>);

// -- how a test says what it expects ----------------------------------------------------------------------------------

fn key(code: KeyCode, modifiers: KeyModifiers) -> Input {
    KeyEvent::new(code, modifiers).into()
}

fn letter(c: char, modifiers: KeyModifiers) -> Input {
    key(KeyCode::Char(c), modifiers)
}

fn of_kind(code: KeyCode, modifiers: KeyModifiers, kind: KeyEventKind) -> Input {
    KeyEvent::new_with_kind(code, modifiers, kind).into()
}

fn with_state(code: KeyCode, state: KeyEventState) -> Input {
    KeyEvent::new_with_kind_and_state(code, NONE, KeyEventKind::Press, state).into()
}

fn mouse(kind: MouseEventKind, column: u16, row: u16, modifiers: KeyModifiers) -> Input {
    Input::Event(Event::Mouse(MouseEvent { kind, column, row, modifiers }))
}

fn paste(text: &str) -> Input {
    Input::Event(Event::Paste(text.to_owned()))
}

fn reply(reply: Reply) -> Input {
    Input::Reply(reply)
}

fn unknown(text: &[u8]) -> Input {
    Input::Reply(Reply::Unknown(text.to_vec()))
}

// -- the table --------------------------------------------------------------------------------------------------------

fn characters() -> Vec<Row> {
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

fn broken_characters() -> Vec<Row> {
    vec![
        (b"a\xffb\xc3c\x80\x9b\xe2\x82d", ['a', 'b', 'c', 'd'].map(|c| letter(c, NONE)).to_vec()),
        (b"\xe2\x82\x1b[A\xc3\xc3\xa9", vec![key(KeyCode::Up, NONE), letter('é', NONE)]),
        // A control of the second set, encoded; a surrogate; the character that stands for broken bytes.
        (b"\xc2\x9b\xed\xa0\x80\xef\xbf\xbd", vec![]),
        (b"\x1b\xc3x\x1b\xffy", vec![letter('x', NONE), letter('y', NONE)]),
    ]
}

fn keys_without_a_letter() -> Vec<Row> {
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

fn kitty_keys() -> Vec<Row> {
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
            // By the place on a Latin keyboard; letters of a Latin one are what they are.
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

fn mouse_reports() -> Vec<Row> {
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

fn pastes() -> Vec<Row> {
    vec![
        (b"\x1b[200~q\x03\x1b[A\x1b[201~x", vec![paste("q\x03\x1b[A"), letter('x', NONE)]),
        (b"\x1b[200~\x1b[201~", vec![paste("")]),
        (b"\x1b[200~\x1b[20\x1b\x1b[201~", vec![paste("\x1b[20\x1b")]),
        (b"\x1b[200~\x1b[200~\xff\xc3\xa9\x1b[201~", vec![paste("\x1b[200~\u{fffd}é")]),
        (b"\x1b\x1b[200~q\x1b[201~", vec![key(KeyCode::Esc, NONE), paste("q")]),
        (b"\x1b[201~x", vec![letter('x', NONE)]),
    ]
}

fn replies() -> Vec<Row> {
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

fn replies_in_strings_and_others() -> Vec<Row> {
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
        // The Escape key pressed while an answer was on its way.
        (b"\x1b\x1b[?62c", vec![key(KeyCode::Esc, NONE), reply(Reply::DeviceAttributes(vec![62]))]),
        (b"\x1b\x1b]11;?\x07", vec![key(KeyCode::Esc, NONE), reply(Reply::Osc(b"11;?".to_vec()))]),
    ]
}

fn broken_sequences() -> Vec<Row> {
    vec![
        // A second sequence cuts the first.
        (b"\x1b[1;\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1bO\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1b]11;\x1b[A", vec![key(KeyCode::Up, NONE)]),
        (b"\x1bP1$r\x1b]4;0;x\x07", vec![reply(Reply::Osc(b"4;0;x".to_vec()))]),
        // CAN and SUB end what was begun; they are Ctrl-X and Ctrl-Z of a person who waits no longer.
        (b"\x1b[1;\x18A", vec![letter('x', CONTROL), letter('A', SHIFT)]),
        (b"\x1b]11;\x1aA", vec![letter('z', CONTROL), letter('A', SHIFT)]),
        // A control letter inside a sequence is what it always is.
        (b"\x1b[1;\x035A", vec![letter('c', CONTROL), key(KeyCode::Up, CONTROL)]),
        // Strings in which nothing is answered.
        (b"\x1bXnoise\x1b\\\x1b^noise\x1b\\", vec![]),
        // Grammar of no terminal.
        (b"\x1b[1?5Ax\x1b[ 1Ay", vec![letter('x', NONE), letter('y', NONE)]),
        (b"\x1bO!x\x1bO9;9;9Zy", vec![letter('x', NONE), letter('y', NONE)]),
        (b"\x1b[1;2$%&'A", vec![unknown(b"1;2$%&'A")]),
        (b"\x1b[[zx", vec![letter('x', NONE)]),
        (b"\x1b[[\x03", vec![letter('c', CONTROL)]),
        (b"\x1b]\x1b\\\x1bP\x1b\\", vec![reply(Reply::Osc(vec![])), reply(Reply::Dcs(vec![]))]),
        (b"\x1b[\x80\xffA\x1b[\x7fB", vec![key(KeyCode::Up, NONE), key(KeyCode::Down, NONE)]),
    ]
}

fn table() -> Vec<Row> {
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

// -- the tests --------------------------------------------------------------------------------------------------------

fn parse(pieces: &[&[u8]]) -> Vec<Input> {
    parse_with(Parser::new(), pieces)
}

/// For a terminal that writes every key as a sequence.
fn of_sequences() -> Parser {
    let mut parser = Parser::new();
    parser.set_keys_are_sequences(true);
    parser
}

fn parse_with(mut parser: Parser, pieces: &[&[u8]]) -> Vec<Input> {
    let mut out = Vec::new();
    for piece in pieces {
        parser.feed(piece, &mut out);
    }
    out
}

fn is_key(input: &Input) -> bool {
    matches!(input, Input::Event(Event::Key(_)))
}

#[test]
fn bytes_say_what_the_table_says() {
    for (bytes, expected) in table() {
        assert_eq!(parse(&[bytes]), expected, "{}", bytes.escape_ascii());
    }
}

#[test]
fn nothing_is_waited_for_after_a_whole_sequence() {
    for (bytes, expected) in table() {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(bytes, &mut out);
        assert!(!parser.is_waiting(), "{}", bytes.escape_ascii());
        parser.give_up_waiting(&mut out);
        assert_eq!(out, expected, "{}", bytes.escape_ascii());
    }
}

#[test]
fn a_split_changes_nothing() {
    for (bytes, expected) in table() {
        for at in 0..=bytes.len() {
            let (first, second) = bytes.split_at(at);
            assert_eq!(parse(&[first, second]), expected, "{} at {at}", bytes.escape_ascii());
        }
        let single: Vec<&[u8]> = bytes.chunks(1).collect();
        assert_eq!(parse(&single), expected, "{} byte by byte", bytes.escape_ascii());
    }
}

#[test]
fn no_reply_becomes_a_key() {
    for (bytes, expected) in [replies(), replies_in_strings_and_others()].concat() {
        let wanted: Vec<&Input> = expected.iter().filter(|input| !is_key(input)).collect();
        let keys = expected.iter().filter(|input| is_key(input)).count();
        // The Escape key is the price of giving up after a lone ESC: the owner waits longer when an answer is due.
        for at in (0..=bytes.len()).filter(|&at| at == 0 || !bytes[..at].ends_with(b"\x1b")) {
            let (mut parser, mut out) = (Parser::new(), Vec::new());
            parser.feed(&bytes[..at], &mut out);
            parser.give_up_waiting(&mut out);
            parser.feed(&bytes[at..], &mut out);
            let (heard, rest): (Vec<&Input>, Vec<&Input>) = out.iter().partition(|i| !is_key(i));
            assert_eq!(heard, wanted, "{} late from {at}", bytes.escape_ascii());
            assert_eq!(rest.len(), keys, "{} late from {at}", bytes.escape_ascii());
        }
    }
}

#[test]
fn a_string_whose_very_end_is_late_is_still_a_reply() {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    parser.feed(b"\x1b]11;?\x1b", &mut out);
    parser.give_up_waiting(&mut out);
    parser.feed(b"\\x", &mut out);
    assert_eq!(out, [reply(Reply::Osc(b"11;?".to_vec())), letter('x', NONE)]);
}

/// What comes of `begun` when the wait is given up, and then of `later`.
fn given_up(begun: &[u8], later: &[u8]) -> (Vec<Input>, Vec<Input>) {
    let (mut parser, mut at_once, mut out) = (Parser::new(), Vec::new(), Vec::new());
    parser.feed(begun, &mut at_once);
    assert!(parser.is_waiting(), "{}", begun.escape_ascii());
    parser.give_up_waiting(&mut at_once);
    assert!(!parser.is_waiting(), "{}", begun.escape_ascii());
    parser.feed(later, &mut out);
    (at_once, out)
}

#[test]
fn a_lone_escape_is_the_escape_key() {
    let escape = || key(KeyCode::Esc, NONE);
    assert_eq!(given_up(b"\x1b", b"x"), (vec![escape()], vec![letter('x', NONE)]));
    assert_eq!(given_up(b"\x1b\x1b", b"x"), (vec![escape(), escape()], vec![letter('x', NONE)]));
    assert_eq!(given_up(b"\x1b\x1b[1", b"\x03"), (vec![escape()], vec![letter('c', CONTROL)]));
}

#[test]
fn half_a_sequence_is_dropped_with_its_rest() {
    for begun in [&b"\x1b["[..], b"\x1b[1;", b"\x1bO", b"\x1bO5"] {
        assert_eq!(given_up(begun, b"Ax"), (vec![], vec![letter('x', NONE)]));
    }
    for begun in [&b"\xc3"[..], b"\xf0\x9f", b"\x1b[[", b"\x1b[M #", b"\x1bX", b"\x1b]", b"\x1bP"] {
        assert_eq!(given_up(begun, b"x"), (vec![], vec![letter('x', NONE)]));
    }
}

#[test]
fn half_a_sequence_does_not_swallow_keys_for_ever() {
    let interrupt = vec![letter('c', CONTROL)];
    for begun in [&b"\x1b["[..], b"\x1b[1;", b"\x1bO", b"\x1b]11;", b"\x1bP1$", b"\x1b_G", b"\x1b]0\x1b"] {
        assert_eq!(given_up(begun, b"\x03").1, interrupt, "{}", begun.escape_ascii());
        assert_eq!(given_up(begun, b"\x1b[A").1, [key(KeyCode::Up, NONE)]);
        let typed = [b'1'; 400];
        assert!(given_up(begun, &typed).1.len() > 100, "{}", begun.escape_ascii());
    }
}

#[test]
fn an_escape_pressed_inside_a_string_given_up_is_the_end_of_it() {
    let (_, out) = given_up(b"\x1b]11;", b"abc\x1bOAx");
    assert_eq!(out, [key(KeyCode::Up, NONE), letter('x', NONE)]);
}

#[test]
fn an_unfinished_paste_does_not_hang_the_keys() {
    let (mut parser, mut out) = (Parser::new(), Vec::new());
    parser.feed(b"\x1b[200~ab", &mut out);
    for _ in 1..PASTE_PATIENCE {
        parser.give_up_waiting(&mut out);
        assert!(parser.is_waiting());
    }
    parser.feed(b"c", &mut out);
    for _ in 0..PASTE_PATIENCE {
        assert_eq!(out, []);
        parser.give_up_waiting(&mut out);
    }
    assert!(!parser.is_waiting());
    parser.feed(b"x", &mut out);
    assert_eq!(out, [paste("abc"), letter('x', NONE)]);
}

#[test]
fn a_paste_is_bounded() {
    let mut bytes = b"\x1b[200~".to_vec();
    bytes.resize(bytes.len() + 3 * PASTE_LIMIT, b'q');
    bytes.extend(b"\x1b[201~x");
    let out = parse(&[&bytes]);
    let [Input::Event(Event::Paste(text)), last] = &out[..] else {
        panic!("not a paste and a key: {} inputs", out.len());
    };
    assert_eq!((text.len(), last), (PASTE_LIMIT, &letter('x', NONE)));
}

#[test]
fn a_string_or_a_sequence_without_end_keeps_little() {
    for introducer in [&b"\x1b]0;"[..], b"\x1bP1$r", b"\x1b_G", b"\x1bX", b"\x1b[", b"\x1bO"] {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(introducer, &mut out);
        parser.feed(&vec![b'1'; 1 << 20], &mut out);
        assert!(parser.text.capacity() <= 2 * super::STRING_LIMIT);
        assert!(parser.is_waiting());
        parser.feed(b"\x1b\\\x1b[Ax", &mut out);
        let [.., up, x] = &out[..] else { panic!("{out:?}") };
        assert_eq!((up, x), (&key(KeyCode::Up, NONE), &letter('x', NONE)));
    }
}

#[test]
fn where_keys_are_sequences_they_say_the_same() {
    for (bytes, expected) in [kitty_keys(), keys_without_a_letter(), replies()].concat() {
        // But for the last of the keys of old, which are followed by a plain x.
        if !bytes.ends_with(b"x") {
            assert_eq!(parse_with(of_sequences(), &[bytes]), expected, "{}", bytes.escape_ascii());
        }
    }
}

#[test]
fn where_keys_are_sequences_a_character_is_pressed_and_let_go() {
    let typed = |code, modifiers| {
        [KeyEventKind::Press, KeyEventKind::Release].map(|kind| of_kind(code, modifiers, kind)).to_vec()
    };
    let (w, c) = (KeyCode::Char('w'), KeyCode::Char('c'));
    let out = parse_with(of_sequences(), &[b"w\x03\x1bw\x1b[1;\x035A"]);
    let mut expected = [typed(w, NONE), typed(c, CONTROL), typed(w, ALT), typed(c, CONTROL)].concat();
    expected.push(key(KeyCode::Up, CONTROL));
    assert_eq!(out, expected);
}

#[test]
fn where_keys_are_sequences_a_lone_escape_is_none() {
    let given_up = |begun: &[u8], later: &[u8]| {
        let (mut parser, mut out) = (of_sequences(), Vec::new());
        parser.feed(begun, &mut out);
        parser.give_up_waiting(&mut out);
        assert!(!parser.is_waiting());
        assert_eq!(out, [], "{}", begun.escape_ascii());
        parser.feed(later, &mut out);
        out
    };
    for begun in [&b"\x1b"[..], b"\x1b\x1b"] {
        assert_eq!(given_up(begun, b"\x1b[27u"), [key(KeyCode::Esc, NONE)]);
    }
    // What is late is dropped, but for what ends something.
    let released = || of_kind(KeyCode::Char('w'), NONE, KeyEventKind::Release);
    for at in 1..b"\x1b[119;1:3u".len() {
        let (begun, rest) = b"\x1b[119;1:3u".split_at(at);
        assert_eq!(given_up(begun, rest), [released()], "{at}");
        let (begun, rest) = b"\x1b[119;1:1u".split_at(at);
        assert_eq!(given_up(begun, rest), [], "{at}");
    }
    assert_eq!(given_up(b"\x1b", b"[?62c"), [reply(Reply::DeviceAttributes(vec![62]))]);
}

/// Bytes in which escape sequences are frequent.
fn noise() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![
        4 => prop::sample::select(b"\x1b\x1b\x1b[[O]P_<>?;:0123456789~uMmtcRA$\\\x07\x18".to_vec()),
        1 => any::<u8>(),
    ];
    prop::collection::vec(byte, 0..200)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn noise_says_the_same_in_any_split(bytes in noise(), at in any::<prop::sample::Index>()) {
        let (first, second) = bytes.split_at(at.index(bytes.len() + 1));
        prop_assert_eq!(parse(&[first, second]), parse(&[&bytes]));
        prop_assert_eq!(parse_with(of_sequences(), &[first, second]), parse_with(of_sequences(), &[&bytes]));
    }

    #[test]
    fn after_any_noise_keys_come_again(bytes in noise()) {
        let (mut parser, mut out) = (Parser::new(), Vec::new());
        parser.feed(&bytes, &mut out);
        for _ in 0..PASTE_PATIENCE {
            parser.give_up_waiting(&mut out);
        }
        prop_assert!(!parser.is_waiting());
        out.clear();
        parser.feed(b"\x03w", &mut out);
        prop_assert_eq!(out, vec![letter('c', CONTROL), letter('w', NONE)]);
    }

    /// Sequences of any letter and numbers: a key comes only of the letters that name keys.
    #[test]
    fn unknown_sequences_are_no_keys(
        mark in prop::sample::select(vec!["", "?", ">", "<", "="]),
        numbers in "[0-9;:]{0,12}",
        between in prop::sample::select(vec!["", "$", " ", "!", "'"]),
        last in 0x40_u8..0x7f,
    ) {
        let bytes = format!("\x1b[{mark}{numbers}{between}{}", char::from(last));
        let names_a_key = mark.is_empty() && between.is_empty()
            && b"ABCDEFHPQRSZabcd~^@u".contains(&last);
        let out = parse(&[bytes.as_bytes()]);
        prop_assert!(names_a_key || !out.iter().any(is_key), "{:?} {:?}", bytes, out);
    }
}

#[test]
fn a_megabyte_of_random_bytes_is_survived() {
    const SEED: u64 = 0x7465_726d_7472_6163;
    let mut state = SEED;
    let bytes: Vec<u8> = std::iter::repeat_with(|| {
        // xorshift64
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u8
    })
    .take(1 << 20)
    .collect();
    let whole = parse(&[&bytes]);
    let pieces: Vec<&[u8]> = bytes.chunks(7).collect();
    assert!(parse(&pieces) == whole, "split in sevens, seed {SEED:#x}");
    // Half of all bytes are ASCII or control letters: most of them are keys, if no string or paste hangs.
    assert!(whole.len() > 10_000, "{} inputs, seed {SEED:#x}", whole.len());
}
