//! Standard input and output that are no terminals.

use super::{BALL, Folder, finish};
use std::fs::OpenOptions;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

/// `termtrace SCENE` into a pipe or a file: one frame, and an end.
#[test]
fn without_a_terminal_one_frame_is_printed() {
    let folder = Folder::new();
    let text = folder.frame("ball.ron");
    let ansi = folder.frame("ball.ron --format ansi");
    assert!(ansi.starts_with(b"\x1b["));
    for (flags, expected) in [
        ("", &text),
        ("--color=auto", &text),
        ("--color never", &text),
        ("--color=always", &ansi),
        ("--color always --quiet", &ansi),
        ("--quiet", &text),
    ] {
        assert!(&folder.run(&format!("ball.ron {flags}")).done() == expected, "{flags}");
        // Flags about a terminal have no effect, either.
        let mut command = folder.command(&format!("ball.ron {flags}"));
        command.env_clear().envs([("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("COLUMNS", "10")]);
        assert!(&finish(&mut command).done() == expected, "{flags}, on a fine terminal");
        let mut command = folder.command(&format!("ball.ron {flags}"));
        command.env_clear().envs([("TERM", "dumb"), ("NO_COLOR", "1"), ("LC_ALL", "C")]);
        assert!(&finish(&mut command).done() == expected, "{flags}, on a poor terminal");
    }
    folder.run("ball.ron --color=perhaps").is_misused("auto, always, never");
}

/// There is no alternate screen, no hidden cursor and no query without a terminal.
#[test]
fn without_a_terminal_nothing_is_switched_on() {
    let folder = Folder::new();
    for flags in ["", "--color=always"] {
        let printed = folder.run(&format!("ball.ron {flags}")).text();
        for (at, _) in printed.match_indices('\x1b') {
            let sequence = &printed[at + 1..];
            let end = sequence.find(|c: char| c.is_ascii_alphabetic()).expect("it ends");
            assert!(sequence.starts_with('[') && sequence[end..].starts_with('m'), "{:?}", &sequence[..=end]);
            assert!(sequence[1..end].bytes().all(|byte| byte.is_ascii_digit() || byte == b';'), "{sequence:?}");
        }
        assert!(!printed.contains(['\r', '\x07', '\x08', '\x0e', '\u{9b}']));
    }
}

#[test]
fn a_minus_reads_the_scene_from_standard_input() {
    let folder = Folder::new();
    assert!(folder.run_on("-", BALL).done() == folder.run("ball.ron").done());
    assert!(folder.run_on("--fov 60 -", BALL).done() == folder.run("ball.ron --fov 60").done());
    assert!(folder.run_on("frame -", BALL).done() == folder.frame("ball.ron"));
    assert!(folder.run_on("frame - --format png", BALL).done() == folder.frame("ball.ron --format png"));
    assert!(folder.run_on("check -", BALL).text().contains(": OK"));
    let broken = BALL.replace("radius", "radus");
    for command in ["-", "frame -", "check -"] {
        folder.run_on(command, &broken).fails(2, "standard input:7:38: unknown field \"radus\"");
        folder.run_on(command, "").fails(2, "empty");
        folder.run_on(command, b"\x89PNG\r\n\x1a\n\0\0").fails(2, "not a text file");
        folder.run_on(command, vec![b' '; 17 << 20]).fails(2, "too large");
    }
}

/// A mesh on standard input is recognised, or read as the format that `--as` states.
#[test]
fn a_mesh_on_standard_input() {
    let folder = Folder::new();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("x.obj", triangle);
    let expected = folder.frame("x.obj");
    assert!(folder.run_on("frame -", triangle).done() == expected, "by its content");
    assert!(folder.run_on("-", triangle).done() == expected, "without a command");
    assert!(folder.run_on("frame - --as obj", triangle).done() == expected);
    // The content of this one does not tell the format.
    let unknown = format!("%%% exported\n{triangle}");
    folder.run_on("frame -", &unknown).fails(2, "standard input:1:1");
    folder.write("unknown.obj", &unknown);
    assert!(folder.run_on("frame - --as obj", &unknown).stdout == folder.run("frame unknown.obj").stdout);
    folder.run_on("frame - --as ply", triangle).fails(2, "standard input");
    folder.run_on("frame - --as fbx", triangle).is_misused("possible values: obj, stl, ply, gltf, glb");
    folder.run("frame ball.ron --as obj").fails_in_a_line(2, "--as is for a mesh on standard input");
}

/// A folder as standard input, or a closed one, is an error.
#[test]
fn standard_input_that_cannot_be_read() {
    let folder = Folder::new();
    let here = OpenOptions::new().read(true).open(folder.path(".")).expect("a folder can be opened");
    let run = finish(folder.command("frame -").stdin(here));
    run.fails_in_a_line(run.code.filter(|code| [1, 2].contains(code)).unwrap_or(-1), "standard input");
    let mut closed = Command::new("sh");
    closed.args(["-c", "exec \"$0\" frame - <&-", env!("CARGO_BIN_EXE_termtrace")]);
    finish(&mut closed).fails(2, "empty");
}

/// `| head -1`: a reader that closes the pipe is no error.
#[test]
fn a_closed_pipe_is_no_error() {
    let folder = Folder::new();
    for arguments in [
        "frame ball.ron --size 1000x100",
        "frame ball.ron --size 1000x40 --format ansi",
        "frame ball.ron --format png --scale 8",
        "ball.ron --color=always",
        "check ball.ron",
        "--help",
        "frame --help",
        "--version",
    ] {
        for lines in [0, 1] {
            let mut command = folder.command(arguments);
            let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
            let mut reader = BufReader::with_capacity(64, child.stdout.take().expect("a pipe"));
            for _ in 0..lines {
                reader.read_until(b'\n', &mut Vec::new()).expect("the pipe can be read");
            }
            drop(reader);
            let output = child.wait_with_output().expect("a child can be waited for");
            assert_eq!(output.status.code(), Some(0), "{arguments} after {lines} lines: {output:?}");
            assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments} after {lines} lines");
        }
    }
}

/// Without a standard error the exit code still reports the error.
#[test]
fn a_closed_standard_error_is_no_panic() {
    let folder = Folder::new();
    for (arguments, code) in [("frame missing.ron", 2), ("frame ball.ron -o missing/a.txt", 1), ("frame --no-such", 2)]
    {
        let (reader, writer) = std::io::pipe().expect("a pipe can be made");
        drop(reader);
        let status = folder.command(arguments).stdout(Stdio::null()).stderr(writer).status().expect("it starts");
        assert_eq!(status.code(), Some(code), "{arguments}");
    }
}

#[test]
fn outputs_that_take_no_bytes_are_errors() {
    let folder = Folder::new();
    for place in ["/nonexistent/x.txt", "missing/x.png", ".//x/y.ansi"] {
        folder.run(&format!("frame ball.ron -o {place}")).fails_in_a_line(1, place);
    }
    std::fs::create_dir(folder.path("folder.txt")).expect("a folder can be made");
    folder.run("frame ball.ron -o folder.txt").fails_in_a_line(1, "folder.txt");
    // Only Linux has a device that is always full.
    let full = Path::new("/dev/full");
    if full.exists() {
        folder.run("frame ball.ron --format text -o /dev/full").fails_in_a_line(1, "/dev/full");
        for arguments in ["frame ball.ron", "ball.ron", "check ball.ron", "frame ball.ron --format png"] {
            let full = OpenOptions::new().write(true).open(full).expect("it can be opened");
            let output = folder.command(arguments).stdout(full).output().expect("the program starts");
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{arguments}: {stderr}");
            assert!(stderr.starts_with("error: standard output: ") && stderr.lines().count() == 1, "{stderr}");
        }
    }
}
