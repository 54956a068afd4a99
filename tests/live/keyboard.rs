//! Keys on a terminal with the kitty keyboard protocol: in use, with late replies, and without it.

use crate::pty::{SOON, Seen, Session, Size, Start, until_in_time};
use rustix::process::Signal;
use std::time::{Duration, Instant};
use termtrace::internals::control::TAP_TIME;

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/ball.ron");
const PUSH: &[u8] = b"\x1b[>15u";
const POP: &[u8] = b"\x1b[<1u";
/// The last query at the start, and its last reply.
const FENCE: &[u8] = b"\x1b[16t\x1b[c";
const FENCE_REPLY: &[u8] = b"\x1b[?62;22c";
/// Time after the first part of a sequence by which its second part must be sent, and after `q` by
/// which the last reply must be: 1 s, with a margin.
const LONGEST_GAP: Duration = Duration::from_millis(700);
/// The distance that the eye of the scene moves in a second.
const EYE_SPEED: f32 = 2.5;

fn termtrace() -> Start {
    Start::new(env!("CARGO_BIN_EXE_termtrace")).arg(SCENE).says_when_it_rests()
}

/// Starts the view on a terminal that has the keyboard pushed, with the status line shown.
///
/// The screen is small, so that the test keeps up with it.
#[track_caller]
fn flying() -> Session {
    flying_of(Size::cells(80, 4))
}

#[track_caller]
fn flying_of(size: Size) -> Session {
    let mut session = termtrace().kitty().size(size).spawn();
    session.wait_for("the keyboard pushed", SOON, |seen| seen.modes().keyboard_flags() == 15);
    tap(&session, 'i');
    session.wait_for_text("eye 0.00 1.00 5.00");
    session.wait_for_rest();
    session
}

fn press(session: &Session, key: char) {
    session.send(format!("\x1b[{}u", key as u32).as_bytes());
}

fn repeat(session: &Session, key: char) {
    session.send(format!("\x1b[{};1:2u", key as u32).as_bytes());
}

fn release(session: &Session, key: char) {
    session.send(format!("\x1b[{};1:3u", key as u32).as_bytes());
}

fn tap(session: &Session, key: char) {
    press(session, key);
    release(session, key);
}

/// Returns the eye that the status line shows.
fn eye(session: &mut Session) -> [f32; 3] {
    eye_in(session.seen())
}

fn eye_in(seen: &Seen) -> [f32; 3] {
    let text = seen.screen().text().concat();
    let numbers = text.rsplit_once("eye").expect("the status line shows the eye").1;
    let numbers: Vec<f32> = numbers.split_whitespace().take(3).map(|n| n.parse().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

#[track_caller]
fn leave(session: &mut Session) {
    press(session, 'q');
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

fn count(seen: &Seen, bytes: &[u8]) -> usize {
    seen.bytes().windows(bytes.len()).filter(|window| *window == bytes).count()
}

#[test]
fn a_key_moves_from_its_press_to_its_release() {
    let mut session = flying();
    let start = Instant::now();
    press(&session, 'w');
    session.wait_for("a movement", SOON, |seen| !seen.screen().text().concat().contains("eye 0.00 1.00 5.00"));
    // The eye has moved farther than by any tap, without a repeat.
    let (tap, frame) = (EYE_SPEED * TAP_TIME.as_secs_f32(), EYE_SPEED / 60.0);
    session.wait_for("more than a tap", SOON, |seen| eye_in(seen)[2] < 5.0 - 5.0 * tap);
    release(&session, 'w');
    session.wait_for_rest();
    let moved = 5.0 - eye(&mut session)[2];
    let most = EYE_SPEED * start.elapsed().as_secs_f32() + frame;
    assert!((5.0 * tap..=most).contains(&moved), "moved {moved}, at most {most}");
    leave(&mut session);
}

#[test]
fn any_number_of_keys_are_held_together_and_released_one_by_one() {
    let mut session = flying();
    session.send(b"\x1b[119u\x1b[100u\x1b[101u");
    session.wait_for("a way to the right", SOON, |seen| eye_in(seen)[0] > 0.4);
    session.send(b"\x1b[100;1:3u\x1b[119;1:3u");
    // The third key has two frames of its own: all keys may share the first.
    let mut last = eye(&mut session);
    session.wait_for("a way straight up", SOON, |seen| {
        let (before, now) = (last, eye_in(seen));
        last = now;
        now[1] > before[1] && [now[0], now[2]] == [before[0], before[2]]
    });
    let between = last;
    session.wait_for("a way up", SOON, |seen| eye_in(seen)[1] > between[1] + 0.3);
    release(&session, 'e');
    session.wait_for_rest();
    let [x, y, z] = eye(&mut session);
    // The first key from rest has a frame of its own.
    assert!(x > 0.3 && z < 4.7 && (x + z - 5.0).abs() < 0.06, "ahead and to the right alike: {x} {z}");
    assert_eq!([x, z], [between[0], between[2]], "both are let go");
    assert!(y > between[1] + 0.3, "the third is not");
    // The eye turned to the left on the way.
    tap(&session, 'r');
    press(&session, 'w');
    session.send(b"\x1b[D");
    // The eye flies in a circle, and is on this half of it again if the test misses the first time.
    session.wait_for("a curve", SOON, |seen| eye_in(seen)[0] < -0.05 && eye_in(seen)[2] < 4.6);
    session.send(b"\x1b[1;1:3D");
    release(&session, 'w');
    session.wait_for_rest();
    leave(&mut session);
}

#[test]
fn opposite_keys_cancel_and_cost_nothing() {
    let mut session = flying();
    session.send(b"\x1b[97u\x1b[100u");
    session.wait_for_rest();
    let before = eye(&mut session);
    release(&session, 'a');
    session.wait_for("what the other does", SOON, |seen| eye_in(seen)[0] > before[0] + 0.1);
    release(&session, 'd');
    session.wait_for_rest();
    leave(&mut session);
}

#[test]
fn only_a_press_acts() {
    let mut session = flying_of(Size::cells(80, 24));
    press(&session, '?');
    session.wait_for_text("WASD");
    for _ in 0..5 {
        repeat(&session, '?');
    }
    release(&session, '?');
    // A release of a key never pressed, a modifier alone, an unbound key.
    session.send(b"\x1b[113;1:3u\x1b[99;5:3u\x1b[57441;2u\x1b[57441;1:3u\x1b[57376u");
    session.wait_for_rest();
    session.wait_for_text("WASD");
    press(&session, 'q');
    assert_eq!(eye(&mut session), [0.0, 1.0, 5.0]);
    leave(&mut session);
}

#[test]
fn every_binding_works_as_a_sequence() {
    let mut session = flying_of(Size::cells(80, 24));
    // The shifted character may be reported or not; Escape acts at once.
    for help in [&b"\x1b[47:63;2u"[..], b"\x1b[47;2u"] {
        session.send(help);
        session.wait_for_text("WASD");
        session.send(b"\x1b[27u\x1b[27;1:3u");
        session.wait_for("no help", SOON, |seen| !seen.screen().text().concat().contains("WASD"));
    }
    for (pressed, released) in [
        ("\x1b[A", "\x1b[1;1:3A"),
        ("\x1b[1;129:1B", "\x1b[1;129:3B"),
        ("\x1b[57417u", "\x1b[57417;1:3u"),
        ("\x1b[5~", "\x1b[5;1:3~"),
        ("\x1b[57422u", "\x1b[57422;1:3u"),
        ("\x1b[119:87;2u", "\x1b[119;1:3u"),
        ("\x1b[1094::119u", "\x1b[1094::119;1:3u"),
    ] {
        session.wait_for_rest();
        let bytes = session.seen().bytes().len();
        session.send(pressed.as_bytes());
        session.wait_for(&format!("a movement by {pressed:?}"), SOON, |seen| seen.bytes().len() > bytes + 500);
        session.send(released.as_bytes());
    }
    session.wait_for_rest();
    let bytes = session.seen().bytes().len();
    session.send(b"\x1b[108;5u");
    session.wait_for("all drawn again", SOON, |seen| seen.bytes().len() > bytes + 80 * 24);
    session.send(b"\x1b[99;5u");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
}

#[test]
fn no_key_is_stuck_when_the_focus_is_lost() {
    let mut session = flying();
    press(&session, 'w');
    press(&session, 'd');
    session.wait_for("a movement", SOON, |seen| eye_in(seen)[2] < 4.9);
    session.send(b"\x1b[O");
    session.wait_for_rest();
    let there = eye(&mut session);
    // The key is released in another window, or here once the focus is back.
    session.send(b"\x1b[I");
    release(&session, 'w');
    session.wait_for_rest();
    assert_eq!(eye(&mut session), there);
    leave(&mut session);
}

/// Typed text, such as an input method's, has no release.
#[test]
fn no_key_is_stuck_that_comes_as_a_character() {
    let mut session = flying();
    session.send(b"w\xd1\x86\xff\x1b[200~wasd\x1b[201~");
    session.wait_for_rest();
    let z = eye(&mut session)[2];
    assert!(z > 4.5, "{z}");
    leave(&mut session);
}

/// A sequence whose second half is late is no Escape key, and its release counts.
#[test]
fn a_release_in_two_pieces_presses_no_escape() {
    until_in_time(|| {
        let mut session = flying_of(Size::cells(80, 24));
        tap(&session, 'x');
        session.wait_for_text("╭");
        press(&session, 'w');
        session.wait_for("a movement", SOON, |seen| eye_in(seen)[2] < 5.0);
        let begun = Instant::now();
        session.send(b"\x1b");
        // No reply comes meanwhile: a terminal does not reply in the middle of a key.
        std::thread::sleep(Duration::from_millis(150));
        session.send(b"[119;1:3u");
        if begun.elapsed() > LONGEST_GAP {
            return false;
        }
        session.wait_for_rest();
        session.wait_for_text("╭");
        leave(&mut session);
        true
    });
}

#[test]
fn a_terminal_that_does_not_know_the_protocol_is_not_sent_it() {
    let mut session = termtrace().spawn();
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 5_000);
    session.wait_for_rest();
    session.send(b"q");
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    assert!(!session.seen().has(PUSH) && !session.seen().has(POP), "{}", session.seen().bytes().len());
    session.assert_clean();
}

/// Pushed flags count once the terminal reports that they are on; until then a press is a tap.
#[test]
fn flags_that_are_not_reported_are_not_used() {
    std::thread::scope(|scope| {
        for flags in ["0", "1", "9", "4"] {
            scope.spawn(move || assert_taps(flags));
        }
    });
}

/// Asserts that a press without a release is a tap, after the reply `flags` to the query for them.
fn assert_taps(flags: &str) {
    let mut session = termtrace().mute().spawn();
    session.wait_for("the questions", SOON, |seen| seen.has(FENCE));
    session.send(&[b"\x1b[?0u", FENCE_REPLY].concat());
    session.wait_for("the keyboard pushed", SOON, |seen| seen.has(PUSH) && seen.has(b"\x1b[>15u\x1b[?u"));
    session.send(format!("\x1b[?{flags}u").as_bytes());
    session.send(b"i");
    session.wait_for_text("eye 0.00 1.00 5.00");
    press(&session, 'w');
    session.wait_for("a movement", SOON, |seen| !seen.screen().text().concat().contains("eye 0.00 1.00 5.00"));
    session.wait_for_rest();
    let moved = 5.0 - eye(&mut session)[2];
    assert!((moved - EYE_SPEED * 0.167).abs() < 0.02, "flags {flags}: a tap is not {moved}");
    session.send(b"q");
    session.wait_for("the last question", SOON, |seen| seen.has(b"\x1b[?1049l\x1b[c"));
    session.send(FENCE_REPLY);
    session.wait_exit(SOON);
    session.assert_clean();
}

#[test]
fn a_late_reply_pushes_the_keyboard_once() {
    until_in_time(|| {
        let mut session = termtrace().mute().spawn();
        session.wait_for("the questions", SOON, |seen| seen.has(FENCE));
        // The picture is shown when the program has stopped waiting for the first replies.
        session.send(b"i");
        session.wait_for_text("eye 0.00 1.00 5.00");
        assert!(!session.seen().has(PUSH));
        session.send(&[b"\x1b[?0u", FENCE_REPLY].concat());
        session.wait_for("the keyboard pushed", SOON, |seen| seen.has(PUSH));
        session.send(b"\x1b[?15u\x1b[?15u");
        session.wait_for_rest();
        assert_eq!(count(session.seen(), PUSH), 1);
        let is_in_time = leave_answering(&mut session);
        assert_eq!(count(session.seen(), POP), 1);
        is_in_time
    });
}

/// Leaves, and replies to the last query; what comes before the reply is not left for the shell.
///
/// Returns false, and asserts nothing, if the reply was sent too late.
#[track_caller]
fn leave_answering(session: &mut Session) -> bool {
    let begun = Instant::now();
    press(session, 'q');
    session.wait_for("the last question", SOON, |seen| seen.has(b"\x1b[?1049l\x1b[c"));
    release(session, 'q');
    session.send(FENCE_REPLY);
    if begun.elapsed() > LONGEST_GAP {
        return false;
    }
    assert_eq!(session.wait_exit(SOON).code(), Some(0));
    session.assert_clean();
    assert_eq!(session.typed_ahead(), b"");
    // Nor echoed.
    assert!(!session.seen().has(b"113;1:3u"));
    true
}

#[test]
fn the_release_of_q_is_not_left_for_the_shell() {
    until_in_time(|| {
        let mut session = termtrace().mute().spawn();
        session.wait_for("the questions", SOON, |seen| seen.has(FENCE));
        session.send(&[b"\x1b[?0u", FENCE_REPLY].concat());
        session.wait_for("the keyboard pushed", SOON, |seen| seen.has(PUSH));
        session.send(b"\x1b[?15u");
        leave_answering(&mut session)
    });
}

/// Replies that come while the program is stopped may have had another reader: it asks again, and
/// pushes once.
#[test]
fn queries_whose_replies_come_during_a_stop_are_sent_again() {
    until_in_time(|| {
        let mut session = termtrace().mute().spawn();
        session.wait_for("the questions", SOON, |seen| seen.has(FENCE));
        session.signal(Signal::STOP);
        session.wait_stopped(SOON);
        session.send(&[b"\x1b[?0u", FENCE_REPLY].concat());
        session.signal(Signal::CONT);
        session.wait_for("the questions again", SOON, |seen| count(seen, FENCE) == 2);
        session.send(&[b"\x1b[?0u", FENCE_REPLY].concat());
        session.wait_for("the keyboard pushed", SOON, |seen| seen.has(PUSH));
        session.send(b"\x1b[?15u");
        session.wait_for_rest();
        assert_eq!(session.seen().modes().keyboard_flags(), 15);
        assert_eq!(count(session.seen(), PUSH), 1 + count(session.seen(), POP));
        leave_answering(&mut session)
    });
}

/// A stop releases held keys. It pops the keyboard protocol; after it the protocol is pushed, and
/// used once it is reported.
#[test]
fn a_stop_pops_the_keyboard_and_releases_all_keys() {
    let mut session = flying();
    press(&session, 'w');
    session.wait_for("a movement", SOON, |seen| eye_in(seen)[2] < 4.9);
    session.signal(Signal::STOP);
    session.wait_stopped(SOON);
    session.signal(Signal::CONT);
    session.wait_for("the keyboard pushed again", SOON, |seen| count(seen, PUSH) == 2);
    assert_eq!(count(session.seen(), POP), 1);
    session.wait_for_rest();
    let z = eye(&mut session)[2];
    // The repeat of a held key moves again.
    repeat(&session, 'w');
    session.wait_for("a movement", SOON, |seen| eye_in(seen)[2] < z - 1.5);
    release(&session, 'w');
    leave(&mut session);
}
