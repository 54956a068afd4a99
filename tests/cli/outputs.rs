//! Output files: however a command ends, a name has the old file or the whole new one.

use super::pty::SOON;
use super::{Folder, finish};
use rustix::process::{Pid, Signal, kill_process};
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread;
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");

/// Commands, and the file that each writes, of more bytes than the limit of [`in_a_small_space`].
const WRITERS: [(&str, &str); 9] = [
    ("frame ball.ron --size 400x200 -o x.txt", "x.txt"),
    ("frame ball.ron --size 300x100 -o x.ansi", "x.ansi"),
    ("frame ball.ron --size 100x40 -o x.svg", "x.svg"),
    ("frame ball.ron --size 100x40 -o x.html", "x.html"),
    ("frame ball.ron --pixels 600x400 --samples 4 -o x.png", "x.png"),
    ("frame ball.ron --size 400x200 --check x.txt --bless", "x.txt"),
    ("record ball.ron --seconds 2 --size 60x20 -o x.cast", "x.cast"),
    ("record ball.ron --seconds 1 --size 60x20 -o x.gif", "x.gif"),
    ("record ball.ron --seconds 0.1 --pixels 600x400 --samples 4 -o x-%d.png", "x-1.png"),
];

/// Runs the program where no file becomes larger than 8 blocks, of 512 bytes or 1 kB.
///
/// As on a full disk, an error comes in the middle.
fn in_a_small_space(folder: &Folder, program: &Path, arguments: &str) -> Command {
    let script = format!("trap '' XFSZ; ulimit -f 8; exec '{}' {arguments}", program.display());
    let mut command = Command::new("sh");
    command.args(["-c", &script]).current_dir(folder.path(".")).stdin(Stdio::null());
    command
}

fn names(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(folder.path(".")).expect("the folder is there").flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().into_string().expect("a plain name")).collect();
    names.sort();
    names
}

fn temporary(folder: &Folder) -> Option<String> {
    names(folder).into_iter().find(|name| name.starts_with(".termtrace-"))
}

#[test]
fn a_full_disk_leaves_the_old_file_or_none() {
    for (arguments, name) in WRITERS {
        for old in [None, Some("the old one")] {
            let folder = Folder::new();
            old.inspect(|old| folder.write(name, old));
            let before = names(&folder);
            finish(&mut in_a_small_space(&folder, Path::new(PROGRAM), arguments))
                .fails_in_a_line(1, &format!("{name}: File too large"));
            assert_eq!(names(&folder), before, "{arguments}");
            assert_eq!(fs::read_to_string(folder.path(name)).ok().as_deref(), old, "{arguments}");
        }
    }
}

/// Signals that end a program which does not catch them.
const DEADLY: [Signal; 12] = [
    Signal::INT,
    Signal::TERM,
    Signal::HUP,
    Signal::QUIT,
    Signal::USR1,
    Signal::USR2,
    Signal::ALARM,
    Signal::VTALARM,
    Signal::PROF,
    Signal::XCPU,
    Signal::SYS,
    Signal::TRAP,
];

/// Restores signals that the child would ignore because its parent does, as after `cargo test &`.
fn heed_signals() {
    for deadly in DEADLY {
        let dies = Arc::new(AtomicBool::new(true));
        signal_hook::flag::register_conditional_default(deadly.as_raw(), dies).expect("signals can be caught");
    }
}

/// Starts a film that takes very long, and waits until its file is begun.
fn endless(folder: &Folder, name: &str) -> Child {
    heed_signals();
    let mut command = folder.command(&format!("record ball.ron --seconds 1000 --size 60x20 -o {name}"));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts");
    let begun = format!(".termtrace-{}-0.tmp", child.id());
    until("the film is begun", || {
        assert!(child.try_wait().expect("a child can be waited for").is_none(), "it goes on");
        fs::metadata(folder.path(&begun)).is_ok_and(|data| data.len() > 0)
    });
    child
}

#[track_caller]
fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let deadline = Instant::now() + SOON;
    while !is_so() {
        assert!(Instant::now() < deadline, "not in time: {what}");
        thread::sleep(Duration::from_millis(2));
    }
}

fn signal(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).expect("the process takes signals");
}

#[test]
fn a_signal_leaves_the_old_film_or_none() {
    for name in ["x.cast", "x.gif"] {
        for (deadly, old) in DEADLY.into_iter().zip([true, true, false].into_iter().cycle()) {
            let folder = Folder::new();
            if old {
                folder.write(name, "the old one");
            }
            let before = names(&folder);
            let mut child = endless(&folder, name);
            signal(&child, deadly);
            let status = child.wait().expect("a child can be waited for");
            assert_eq!(status.signal(), Some(deadly.as_raw()), "{name}: {status}");
            assert_eq!(names(&folder), before, "{name}: {deadly:?}");
            assert!(!old || folder.read(name) == b"the old one", "{name}: {deadly:?}");
        }
    }
}

/// A signal ends a program that waits for a pipe's reader, or in the middle for room in the pipe.
#[test]
fn a_signal_ends_a_program_that_writes_to_a_pipe() {
    for is_read in [false, true] {
        let folder = Folder::new();
        let pipe = folder.path("x.cast");
        assert!(Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
        heed_signals();
        let mut child = folder.command("record ball.ron --seconds 1000 -o x.cast").spawn().expect("it starts");
        let reader = is_read.then(|| {
            let mut reader = File::open(&pipe).expect("there is a writer");
            reader.read_exact(&mut [0]).expect("there is a film");
            reader
        });
        // SIGTERM before the signals are caught ends it, too.
        signal(&child, Signal::TERM);
        assert_eq!(child.wait().expect("a child can be waited for").signal(), Some(Signal::TERM.as_raw()));
        assert_eq!(names(&folder), ["ball.ron", "x.cast"]);
        drop(reader);
    }
}

/// Three write at once: one is killed, one goes on, and one removes the first one's file.
#[test]
fn the_next_run_removes_what_a_killed_one_left_and_nothing_else() {
    let folder = Folder::new();
    let mut living = endless(&folder, "living.cast");
    let mut stopped = endless(&folder, "stopped.cast");
    signal(&stopped, Signal::STOP);
    let mut killed = endless(&folder, "killed.cast");
    killed.kill().and_then(|()| killed.wait().map(drop)).expect("it can be killed");
    let temporary = |child: &Child| format!(".termtrace-{}-0.tmp", child.id());
    assert!(names(&folder).contains(&temporary(&killed)), "SIGKILL cannot be caught");
    for (arguments, name) in WRITERS {
        folder.write(".termtrace-4194304-0.tmp", "left");
        folder.run(arguments).done();
        let names = names(&folder);
        assert!(names.iter().any(|known| known == name), "{arguments}: {names:?}");
        for (child, expected) in [(&living, true), (&stopped, true), (&killed, false)] {
            assert_eq!(names.contains(&temporary(child)), expected, "{arguments}: {names:?}");
        }
        assert!(!names.iter().any(|name| name == ".termtrace-4194304-0.tmp"), "{arguments}: {names:?}");
    }
    for child in [&mut living, &mut stopped] {
        child.kill().and_then(|()| child.wait().map(drop)).expect("it can be killed");
    }
}

#[test]
fn two_films_of_one_name_are_one_of_them() {
    let folder = Folder::new();
    let kinds = ["shaded", "normal"].map(|map| format!("record ball.ron --seconds 1 --size 60x20 --map {map} -o"));
    let whole = kinds.each_ref().map(|kind| {
        folder.run(&format!("{kind} whole.cast")).done();
        folder.read("whole.cast")
    });
    assert!(whole[0] != whole[1]);
    for _ in 0..3 {
        let children =
            kinds.each_ref().map(|kind| folder.command(&format!("{kind} x.cast")).spawn().expect("it starts"));
        for mut child in children {
            assert!(child.wait().expect("a child can be waited for").success());
        }
        assert!(whole.contains(&folder.read("x.cast")), "it is neither");
        assert_eq!(temporary(&folder), None);
    }
}

#[test]
fn a_descriptor_is_written_directly() {
    let folder = Folder::new();
    let expected = folder.frame("ball.ron");
    if !fs::exists("/dev/stdout").is_ok_and(|there| there) {
        return;
    }
    // A file that the shell has open.
    let script = format!("exec '{PROGRAM}' frame ball.ron --format text -o /dev/stdout >x.txt");
    assert!(Command::new("sh").args(["-c", &script]).current_dir(folder.path(".")).status().expect("sh").success());
    assert!(folder.read("x.txt") == expected);
    assert!(folder.run("frame ball.ron --format text -o /dev/stdout").done() == expected);
    assert_eq!(names(&folder), ["ball.ron", "x.txt"]);
}

/// The user `nobody`: the limits of permissions do not hold for root.
const NOBODY: u32 = 65534;

/// Returns the program, or a copy that the user `nobody` can read.
fn plain_users_program(folder: &Folder) -> PathBuf {
    if !is_root(folder) {
        return PROGRAM.into();
    }
    let copy = folder.path("settings/termtrace");
    if !copy.exists() {
        fs::create_dir(folder.path("settings")).expect("a folder can be made");
        // Another process copies: a child that another test forks while this one writes would keep the copy from
        // starting.
        assert!(Command::new("cp").arg(PROGRAM).arg(&copy).status().is_ok_and(|status| status.success()));
    }
    copy
}

/// Runs a command as a user without root's rights: the current user or `nobody`.
fn as_a_plain_user(folder: &Folder, mut command: Command) -> Command {
    if is_root(folder) {
        command.uid(NOBODY).gid(NOBODY);
    }
    command
}

fn is_root(folder: &Folder) -> bool {
    fs::metadata(folder.path(".")).expect("the folder is there").uid() == 0
}

fn plain_users(folder: &Folder, arguments: &str) -> Command {
    let mut command = Command::new(plain_users_program(folder));
    command.args(arguments.split_whitespace()).current_dir(folder.path(".")).stdin(Stdio::null());
    as_a_plain_user(folder, command)
}

fn set_mode(folder: &Folder, name: &str, mode: u32) {
    fs::set_permissions(folder.path(name), PermissionsExt::from_mode(mode)).expect("it is ours");
}

#[test]
fn a_read_only_file_is_refused_in_a_writable_folder() {
    let folder = Folder::new();
    set_mode(&folder, ".", 0o777);
    for (arguments, name) in WRITERS {
        folder.write(name, "the old one");
        set_mode(&folder, name, 0o444);
        finish(&mut plain_users(&folder, arguments)).fails_in_a_line(1, &format!("{name}: Permission denied"));
        assert_eq!(folder.read(name), b"the old one", "{arguments}");
        assert_eq!(temporary(&folder), None);
        set_mode(&folder, name, 0o644);
    }
}

/// In a folder that takes no new file, or if the owner cannot be kept, a file is written in place.
#[test]
fn where_it_cannot_be_replaced_a_file_is_written_in_place() {
    for folders_mode in [0o555, 0o1777, 0o777] {
        let folder = Folder::new();
        for (arguments, name) in WRITERS.into_iter().filter(|(arguments, _)| !arguments.contains('%')) {
            folder.write(name, "the old one, which is short");
            set_mode(&folder, name, 0o666);
            folder.run(&format!("{arguments} --threads 1")).done();
            let (whole, before) = (folder.read(name), fs::metadata(folder.path(name)).expect("it is there"));
            folder.write(name, "the old one".repeat(100_000));
            let mut command = plain_users(&folder, arguments);
            set_mode(&folder, ".", folders_mode);
            finish(&mut command).done();
            assert!(folder.read(name) == whole, "{arguments}: {folders_mode:o}");
            let after = fs::metadata(folder.path(name)).expect("it is there");
            assert_eq!((after.uid(), after.mode()), (before.uid(), before.mode()), "{arguments}: {folders_mode:o}");
            assert_eq!(temporary(&folder), None);
            set_mode(&folder, ".", 0o755);
        }
    }
}

/// A file that is written in place keeps its old bytes when the disk is full, for the part not
/// reached.
#[test]
fn a_full_disk_leaves_the_old_bytes_where_a_file_is_written_in_place() {
    let folder = Folder::new();
    let program = plain_users_program(&folder);
    // One is more than a file may have here, the other less.
    for old in ["the old one".repeat(10_000), "the old one".to_owned()] {
        for (arguments, name) in WRITERS.into_iter().filter(|(arguments, _)| !arguments.contains('%')) {
            folder.write(name, &old);
            set_mode(&folder, name, 0o666);
            set_mode(&folder, ".", 0o555);
            let mut command = as_a_plain_user(&folder, in_a_small_space(&folder, &program, arguments));
            let run = finish(&mut command);
            set_mode(&folder, ".", 0o755);
            run.fails_in_a_line(1, &format!("{name}: File too large"));
            assert!(folder.read(name) == old.as_bytes(), "{arguments}");
        }
    }
}
