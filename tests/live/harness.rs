//! Tests of the harness on ordinary programs: it sees what they leave behind, and only that.

use std::{
    fs::File,
    io::{Read, Write},
    os::unix::process::ExitStatusExt,
    process::Command,
    time::{Duration, Instant},
};

use crate::pty::{Colour, Deadline, Modes, SOON, Session, Size, Start};
use nix::sys::signal::{SigSet, SigmaskHow};
use rustix::process::{Pid, Signal, test_kill_process};

/// Runs a script to its end.
fn run(script: &str) -> Session {
    let mut session = Start::shell(script).spawn();
    assert!(session.wait_exit(SOON).success());
    session
}

#[test]
fn a_program_that_only_prints_is_clean() {
    let mut session = run("printf 'hello\\n'");
    assert_eq!(session.seen().bytes(), b"hello\r\n");
    assert_eq!(session.seen().screen().text()[0], "hello");
    session.assert_clean();
}

#[test]
fn a_program_that_leaves_modes_on_is_reported() {
    let mut session = run("printf '\\033[?1049h\\033[?25l\\033[?1003;1006h\\033[>11u\\033[38;2;1;2;3m'");
    assert_eq!(
        session.left_behind(),
        [
            "cursor (25) left off",
            "mouse motion (1003) left on",
            "mouse in SGR (1006) left on",
            "alternate screen (1049) left on",
            "pen: foreground left by 38",
            "kitty keyboard pushed 1 times on the alternate screen",
        ]
    );
    assert_eq!(session.seen().screen().cursor(), None);
    assert!(session.seen().screen().is_alternate());
}

#[test]
fn a_program_that_restores_is_clean() {
    let on = "\\033[?1049h\\033[?25l\\033[?1003;1006h\\033[?2004h\\033[>11u\\033=\\033[1;31m";
    let off = "\\033[0m\\033>\\033[<u\\033[?2004l\\033[?1006;1003l\\033[?25h\\033[?1049l";
    run(&format!("printf '{on}'; printf '{off}'")).assert_clean();
}

#[test]
fn a_program_that_leaves_raw_mode_is_reported() {
    let mut session = run("stty raw -echo");
    let left = session.left_behind().join("; ");
    for flag in ["ICANON", "ECHO", "ISIG", "OPOST", "ICRNL"] {
        assert!(left.contains(flag), "{flag} is not in {left}");
    }
    let mut restored = run("saved=$(stty -g); stty raw -echo; stty \"$saved\"");
    restored.assert_clean();
}

#[test]
fn a_special_code_left_changed_is_reported() {
    let left = run("stty intr '^A'").left_behind();
    assert_eq!(left.len(), 1, "{left:?}");
    assert!(left[0].starts_with("VINTR was"), "{left:?}");
}

#[test]
fn a_stream_cut_inside_a_sequence_is_seen() {
    for torn in ["\\033", "\\033[", "\\033[38;2;1", "\\033]0;title", "\\033P1$r", "\\342\\226"] {
        let mut session = run(&format!("printf 'text{torn}'"));
        assert!(session.seen().modes().is_torn(), "{torn}");
        assert_eq!(session.left_behind().len(), 1, "{torn}");
    }
}

#[test]
fn modes_are_read_from_bytes() {
    let left = |bytes: &[u8]| Modes::after(bytes).left_on();
    for clean in [
        &b""[..],
        "▄".as_bytes(),
        b"\x1b[38;5;1;48;2;4;4;4m\x1b[39;49m",
        b"\x1b[38:2::1:2:3m\x1b[m",
        b"\x1b[4:3m\x1b[4:0m",
        b"\x1b[?1049h\x1b[?47l",
        b"\x1b[>1u\x1b[>3u\x1b[<2u",
        b"\x1b[=5;1u\x1b[=5;3u",
        b"\x1b[>1u\x1b[=5u\x1b[<u",
        b"\x1b]8;;x\x1b\\link\x1b]8;;\x1b\\",
        b"\x1b(0q\x1b(B",
        b"\x1b[5;10r\x1b[r",
        b"\x1b[4h\x1b=\x1b[?1;25l\x1b[31m\x1b[!p",
        b"\x1b[?1000h\x1b[?7l\x1b[>4;2m\x1b[2 q\x1bc",
        b"\x1b[?9999$p\x1b[1;2$}x\x1b[1?2x",
    ] {
        assert_eq!(left(clean), [""; 0], "{}", clean.escape_ascii());
    }
    for dirty in [
        &b"\x1b[?7l"[..],
        b"\x1b[?2026h",
        b"\x1b[?1234h",
        b"\x1b[38;5;0;7m\x1b[27m",
        b"\x1b[4:3m",
        b"\x1b[>1u\x1b[?1049h\x1b[<u\x1b[?1049l",
        b"\x1b[=1u",
        b"\x1b]8;;x\x1b\\",
        b"\x1b(0",
        b"\x0e",
        b"\x1b[5;10r",
        b"\x1b[4h",
        b"\x1b=",
        b"\x1b[>4;2m",
        b"\x1b[2 q",
        b"\x1b[?25",
        b"\x1b[38;2;1\x1b[0m",
        b"\x1b]0;title\x1b[m",
        b"\xe2\x96\x1b[0m",
    ] {
        assert_eq!(left(dirty).len(), 1, "{}: {:?}", dirty.escape_ascii(), left(dirty));
    }
}

#[test]
fn death_by_a_signal_is_seen() {
    for signal in [Signal::TERM, Signal::HUP, Signal::KILL] {
        let mut session = Start::shell("printf ready; exec sleep 100").spawn();
        session.wait_for_text("ready");
        session.signal(signal);
        assert_eq!(session.wait_exit(SOON).signal(), Some(signal.as_raw()));
    }
    let mut session = Start::shell("exit 7").spawn();
    assert_eq!(session.wait_exit(SOON).code(), Some(7));
}

#[test]
fn a_typed_interrupt_reaches_the_foreground() {
    let mut session = Start::shell("printf ready; exec sleep 100").spawn();
    session.wait_for_text("ready");
    session.send(b"\x03");
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::INT.as_raw()));
}

/// A shell without job control starts `cargo test &` like this, and `nohup` does so for SIGHUP.
#[test]
fn signals_that_the_tests_parent_ignores_are_not_ignored_by_their_children() {
    let tests = std::env::current_exe().expect("a process has a program");
    let name = module_path!().split_once("::").expect("this is a module of the test program").1;
    let output = Command::new("sh")
        .args(["-c", "trap '' HUP INT QUIT TERM TSTP; exec \"$@\"", "sh"])
        .arg(tests)
        .args(["--exact", "--test-threads", "1"])
        .args(
            ["death_by_a_signal_is_seen", "a_typed_interrupt_reaches_the_foreground"]
                .map(|test| format!("{name}::{test}")),
        )
        .output()
        .expect("there is a shell on every system");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("2 passed"), "{said}");
}

#[test]
fn signals_that_the_tests_block_are_not_blocked_in_their_children() {
    let before = SigSet::all().thread_swap_mask(SigmaskHow::SIG_BLOCK).expect("signals can be blocked");
    let mut session = Start::shell("printf ready; exec sleep 100").spawn();
    before.thread_set_mask().expect("signals can be unblocked");
    session.wait_for_text("ready");
    session.signal(Signal::TERM);
    assert_eq!(session.wait_exit(SOON).signal(), Some(Signal::TERM.as_raw()));
}

#[test]
fn typed_characters_reach_the_child() {
    let mut session = Start::shell("read line; printf 'got <%s>' \"$line\"").spawn();
    session.send(b"some words\n");
    session.wait_for_text("got <some words>");
    assert!(session.wait_exit(SOON).success());
}

#[test]
fn the_child_gets_the_size_and_a_resize() {
    let script = "trap 'stty size; exit' WINCH; stty size; printf ready; while :; do sleep 0.01; done";
    let mut session = Start::shell(script).size(Size::cells(30, 10)).spawn();
    session.wait_for_text("ready");
    assert_eq!(session.seen().screen().text()[0], "10 30");
    session.resize(Size::cells(40, 12));
    session.wait_for_text("12 40");
    assert!(session.wait_exit(SOON).success());
    assert_eq!(session.seen().screen().text().len(), 12);
}

#[test]
fn the_child_gets_the_size_in_pixels() {
    let mut session = Start::shell("read line").size(Size::cells(30, 10).of_pixels(9, 19)).spawn();
    let size = session.window_size();
    assert_eq!((size.ws_xpixel, size.ws_ypixel), (270, 190));
    session.resize(Size::cells(30, 10).of_pixels(0, 0));
    let size = session.window_size();
    assert_eq!((size.ws_xpixel, size.ws_ypixel), (0, 0));
}

#[test]
fn the_environment_is_the_one_given() {
    let mut session =
        Start::shell("env | cut -d= -f1 | sort | tr '\\n' ' '").env("TERM", "vt100").env("NO_COLOR", "1").spawn();
    session.wait_exit(SOON);
    let text = session.seen().screen().text().join(" ");
    for name in ["NO_COLOR", "TERM", "PATH"] {
        assert!(text.contains(name), "{name} is not in {text}");
    }
    assert!(!text.contains("CARGO"), "{text}");
}

#[test]
fn standard_output_and_input_may_be_something_else() {
    let (mut reader, writer) = std::io::pipe().expect("a pipe can be had");
    let null = File::open("/dev/null").expect("there is always /dev/null");
    let mut session =
        Start::shell("cat; test -t 1 || echo piped; echo seen >/dev/tty").stdin(null).stdout(writer).spawn();
    assert!(session.wait_exit(SOON).success());
    let mut piped = String::new();
    reader.read_to_string(&mut piped).expect("the child wrote text");
    assert_eq!(piped, "piped\n");
    assert_eq!(session.seen().bytes(), b"seen\r\n");
}

#[test]
fn standard_input_may_be_a_file() {
    let mut file = tempfile::tempfile().expect("a file can be had");
    file.write_all(b"from a file").expect("a file can be written");
    std::io::Seek::rewind(&mut file).expect("a file has a beginning");
    let mut session = Start::new("cat").stdin(file).spawn();
    assert!(session.wait_exit(SOON).success());
    assert_eq!(session.seen().bytes(), b"from a file");
}

#[test]
fn colours_of_a_cell_are_seen_by_both_models() {
    let mut session = run("printf '\\033[38;2;1;2;3;48;5;20m\\342\\226\\204\\033[0m'");
    let screen = session.seen().screen();
    let cell = screen.cell(0, 0);
    assert_eq!((cell.glyph, cell.foreground, cell.background), ('▄', Colour::Rgb(1, 2, 3), Colour::Indexed(20)));
    let second = screen.second_opinion().cell(0, 0).expect("the screen has a first cell");
    assert_eq!(second.contents(), "▄");
    assert_eq!(second.fgcolor(), vt100::Color::Rgb(1, 2, 3));
    assert_eq!(screen.cell(1, 0).background, Colour::Default);
}

#[test]
fn no_output_is_lost_at_the_exit() {
    for _ in 0..10 {
        let mut session = run("head -c 200000 /dev/zero | tr '\\0' x; printf end");
        assert_eq!(session.seen().bytes().len(), 200_003);
        assert!(session.seen().has(b"xend"));
    }
}

#[test]
fn a_child_that_leaves_a_writer_behind_is_waited_for() {
    let mut session = Start::shell("(trap '' HUP; while printf y; do :; done) & printf x").spawn();
    assert!(session.wait_exit(SOON).success());
    assert!(session.seen().has(b"x"));
}

#[test]
fn a_stopped_terminal_does_not_hold_the_harness() {
    let mut session = Start::shell("printf ready; read line; exit 3").spawn();
    session.wait_for_text("ready");
    session.stop_output();
    session.send(b"go\n");
    assert_eq!(session.wait_exit(SOON).code(), Some(3));
    assert!(!session.seen().has(b"go"));
}

#[test]
fn a_stop_is_seen_and_the_program_goes_on() {
    let mut session = Start::shell("printf ready; read line; printf done").spawn();
    session.wait_for_text("ready");
    session.signal(Signal::STOP);
    assert_eq!(session.wait_stopped(SOON), Signal::STOP.as_raw());
    session.signal(Signal::CONT);
    session.send(b"\n");
    session.wait_for_text("done");
}

#[test]
fn a_shell_with_job_control_sees_its_job_stopped() {
    let job = "printf ready; exec sleep 100";
    let script = format!("set -m; sh -c '{job}'; printf 'status <%s>' $?; kill %1");
    let mut session = Start::shell(&script).spawn();
    session.wait_for_text("ready");
    assert_ne!(session.foreground_group(), session.pid());
    session.send(b"\x1a");
    session.wait_for_text(&format!("status <{}>", 128 + Signal::TSTP.as_raw()));
}

#[test]
fn a_condition_that_never_comes_has_an_end() {
    let mut session = Start::shell("read line").spawn();
    let start = Instant::now();
    assert!(!session.sees(Duration::from_millis(50), |seen| seen.has(b"never")));
    assert!(start.elapsed() < SOON);
}

#[test]
fn a_dropped_session_leaves_no_process() {
    let stubborn = "trap '' HUP TERM INT; echo ready; while :; do sleep 1; done";
    let mut session = Start::shell(stubborn).spawn();
    session.wait_for_text("ready");
    let pid = session.pid();
    drop(session);
    assert_eq!(test_kill_process(pid), Err(rustix::io::Errno::SRCH));
}

#[test]
fn a_dropped_session_leaves_nothing_of_a_child_that_exited() {
    let mut session = run("trap '' HUP; sleep 100 & printf $!");
    let number = session.seen().screen().text()[0].parse().expect("the shell says the number");
    let left = Pid::from_raw(number).expect("no process has the number zero");
    assert_eq!(test_kill_process(left), Ok(()));
    drop(session);
    // The process that adopts orphans takes a moment to reap them, and in a container may never do so.
    let mut deadline = Deadline::after(SOON);
    while !is_gone(left) {
        assert!(!deadline.has_passed(), "{number} is still there");
    }
}

/// Returns whether a process has exited, reaped or not.
fn is_gone(pid: Pid) -> bool {
    let number = pid.as_raw_nonzero().to_string();
    let ps = Command::new("ps").args(["-o", "stat=", "-p", &number]).output();
    let state = ps.expect("there is ps on every system").stdout;
    matches!(state.trim_ascii_start().first(), None | Some(b'Z'))
}

#[test]
fn a_kitty_terminal_reports_its_flags_in_the_order_of_the_queries() {
    let script = "stty raw -echo; \
        printf '\\033[?u\\033[>15u\\033[?u\\033[?1049h\\033[?u\\033[?1049l\\033[<1u\\033[?u\\033[c'; \
        head -c 30 | tr '\\033' '^'";
    let mut session = Start::shell(script).kitty().spawn();
    session.wait_for_text("^[?0u^[?15u^[?0u^[?0u^[?62;22c");
}

/// A wait ends at its deadline even if the child never stops writing.
#[test]
fn a_wait_ends_at_its_deadline() {
    let mut session = Start::shell("while :; do echo more; done").spawn();
    assert!(!session.sees(Duration::from_millis(200), |_| false));
}
