//! Paths that lead elsewhere while their scene is shown.
//!
//! A file may be replaced for a while by something else, and any number of links and folders may lead to it: the next
//! scene at the path is shown.

use crate::pty::{SOON, Session};
use crate::scenes::{EYE, ball, leave, program, sees};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

fn red() -> String {
    ball("red", EYE)
}

fn lime() -> String {
    ball("lime", EYE)
}

/// Returns a folder whose `s.ron` is red, after `arrange` has changed it.
fn folder(arrange: impl FnOnce(&Path)) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    write(folder.path(), "s.ron", &red());
    arrange(folder.path());
    folder
}

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("a file can be written");
}

fn make(folder: &Path, name: &str) {
    fs::create_dir(folder.join(name)).expect("a folder can be made");
}

fn rename(folder: &Path, from: &str, to: &str) {
    fs::rename(folder.join(from), folder.join(to)).expect("it can be renamed");
}

/// Replaces a path by a link.
fn link(folder: &Path, to: &str, name: &str) {
    symlink(to, folder.join("new~")).expect("a link can be made");
    rename(folder, "new~", name);
}

/// Starts the view of a path in that folder, which is the current folder.
fn looking(folder: &TempDir, path: &str) -> Session {
    let program_path = env!("CARGO_BIN_EXE_termtrace");
    let script = format!("cd '{}' && exec '{program_path}' {path}", folder.path().display());
    let mut session = crate::pty::Start::shell(&script).spawn();
    sees(&mut session, &red());
    session
}

/// A replacement of the file: its name, how it is made, and the message about it, if any.
type Guest = (&'static str, fn(&Path), &'static str);

const GUESTS: [Guest; 8] = [
    (
        "a folder",
        |folder| {
            fs::remove_file(folder.join("s.ron")).expect("it can be removed");
            make(folder, "s.ron");
        },
        "this is a directory",
    ),
    (
        "a pipe",
        |folder| {
            let made = Command::new("mkfifo").arg(folder.join("new~")).status();
            assert!(made.is_ok_and(|status| status.success()), "a pipe with a name can be made");
            rename(folder, "new~", "s.ron");
        },
        "",
    ),
    ("a link to /dev/zero", |folder| link(folder, "/dev/zero", "s.ron"), "this is a device"),
    ("a link to /dev/null", |folder| link(folder, "/dev/null", "s.ron"), "the file is empty"),
    ("a link to itself", |folder| link(folder, "s.ron", "s.ron"), ""),
    ("a link to nothing", |folder| link(folder, "nothing", "s.ron"), ""),
    ("a link through a file", |folder| link(folder, "other/nothing", "s.ron"), ""),
    (
        "a link to a wrong file",
        |folder| {
            write(folder, "wrong", "(camera: oops");
            link(folder, "wrong", "s.ron");
        },
        "never closed",
    ),
];

#[test]
fn a_file_is_shown_after_anything_that_took_its_place() {
    for (what, come, said) in GUESTS {
        for is_renamed in [false, true] {
            let folder = folder(|folder| write(folder, "other", "no scene"));
            let mut session = looking(&folder, "s.ron");
            come(folder.path());
            println!("{what}, renamed {is_renamed}");
            if !said.is_empty() {
                session.wait_for_text(said);
            }
            let path = folder.path().join("s.ron");
            let gone = if path.is_dir() { fs::remove_dir(&path) } else { fs::remove_file(&path) };
            gone.expect("it can be removed");
            write(folder.path(), if is_renamed { "new~" } else { "s.ron" }, &lime());
            if is_renamed {
                rename(folder.path(), "new~", "s.ron");
            }
            sees(&mut session, &lime());
            leave(&mut session);
        }
    }
}

/// A case: its name, the path that is shown, the files at first, and the change.
type Case = (&'static str, &'static str, fn(&Path), fn(&Path));

/// Puts the scene into a folder of its own.
fn inside(folder: &Path) {
    make(folder, "in");
    rename(folder, "s.ron", "in/s.ron");
}

const CASES: [Case; 14] = [
    (
        "a dangling link gets its target",
        "s.ron",
        |_| {},
        |folder| {
            link(folder, "nowhere", "s.ron");
            write(folder, "nowhere", &lime());
        },
    ),
    (
        "a dangling link gets its target in another folder",
        "s.ron",
        |folder| make(folder, "other"),
        |folder| {
            link(folder, "other/nowhere", "s.ron");
            write(folder, "other/nowhere", &lime());
        },
    ),
    (
        "a dangling link gets folder and target",
        "s.ron",
        |_| {},
        |folder| {
            link(folder, "a/b/nowhere", "s.ron");
            make(folder, "a");
            make(folder, "a/b");
            write(folder, "a/b/nowhere", &lime());
        },
    ),
    (
        "of three links, the middle one is exchanged",
        "s.ron",
        |folder| {
            make(folder, "sub");
            rename(folder, "s.ron", "red.ron");
            write(folder, "lime.ron", &lime());
            link(folder, "../red.ron", "sub/l.ron");
            link(folder, "sub/l.ron", "s.ron");
        },
        |folder| link(folder, "../lime.ron", "sub/l.ron"),
    ),
    (
        "the file behind three links is written",
        "s.ron",
        |folder| {
            make(folder, "sub");
            rename(folder, "s.ron", "red.ron");
            link(folder, "../red.ron", "sub/l.ron");
            link(folder, "sub/l.ron", "s.ron");
        },
        |folder| write(folder, "red.ron", &lime()),
    ),
    (
        "a linked folder is exchanged, as Kubernetes does",
        "s.ron",
        |folder| {
            make(folder, "..1");
            make(folder, "..2");
            rename(folder, "s.ron", "..1/s.ron");
            write(folder, "..2/s.ron", &lime());
            link(folder, "..1", "..data");
            link(folder, "..data/s.ron", "s.ron");
        },
        |folder| link(folder, "..2", "..data"),
    ),
    ("the folder is replaced", "in/s.ron", inside, |folder| {
        make(folder, "new");
        write(folder, "new/s.ron", &lime());
        rename(folder, "in", "old");
        rename(folder, "new", "in");
    }),
    ("the folder is replaced, and the old file written", "in/s.ron", inside, |folder| {
        rename(folder, "in", "old");
        make(folder, "in");
        write(folder, "in/s.ron", &lime());
        write(folder, "old/s.ron", "(camera: oops");
    }),
    ("the folder is removed and made again", "in/s.ron", inside, |folder| {
        fs::remove_dir_all(folder.join("in")).expect("it can be removed");
        make(folder, "in");
        write(folder, "in/s.ron", &lime());
    }),
    (
        "the folder around the folder is replaced",
        "a/b/s.ron",
        |folder| {
            make(folder, "a");
            make(folder, "a/b");
            rename(folder, "s.ron", "a/b/s.ron");
        },
        |folder| {
            make(folder, "new");
            make(folder, "new/b");
            write(folder, "new/b/s.ron", &lime());
            rename(folder, "a", "old");
            rename(folder, "new", "a");
        },
    ),
    (
        "a folder and what is in it come back",
        "a/b/s.ron",
        |folder| {
            make(folder, "a");
            make(folder, "a/b");
            rename(folder, "s.ron", "a/b/s.ron");
        },
        |folder| {
            fs::remove_dir_all(folder.join("a")).expect("it can be removed");
            make(folder, "a");
            make(folder, "a/b");
            write(folder, "a/b/s.ron", &lime());
        },
    ),
    (
        "the file becomes a link",
        "s.ron",
        |_| {},
        |folder| {
            write(folder, "lime.ron", &lime());
            link(folder, "lime.ron", "s.ron");
        },
    ),
    (
        "a second name takes its place",
        "s.ron",
        |folder| write(folder, "lime.ron", &lime()),
        |folder| {
            fs::remove_file(folder.join("s.ron")).expect("it can be removed");
            fs::hard_link(folder.join("lime.ron"), folder.join("s.ron")).expect("a file has many names");
        },
    ),
    ("through its own folder and back", "in/../in/s.ron", inside, |folder| write(folder, "in/s.ron", &lime())),
];

#[test]
fn a_file_is_shown_through_any_links_and_folders() {
    for (what, path, arrange, act) in CASES {
        println!("{what}");
        let folder = folder(arrange);
        let mut session = looking(&folder, path);
        act(folder.path());
        sees(&mut session, &lime());
        leave(&mut session);
    }
}

/// The system does not report that a folder is removed while a process has it as current folder,
/// here the program itself.
#[test]
fn the_return_of_a_current_folder_is_noticed() {
    let folder = folder(inside);
    let path = folder.path().join("in/s.ron");
    let inner = folder.path().join("in");
    let program_path = env!("CARGO_BIN_EXE_termtrace");
    let script = format!("cd '{}' && exec '{program_path}' '{}'", inner.display(), path.display());
    let mut session = crate::pty::Start::shell(&script).spawn();
    sees(&mut session, &red());
    fs::remove_dir_all(&inner).expect("it can be removed");
    make(folder.path(), "in");
    write(folder.path(), "in/s.ron", &lime());
    sees(&mut session, &lime());
    leave(&mut session);
}

/// A mesh, too, may be replaced by a folder for a while.
#[test]
fn a_mesh_that_replaces_a_folder_is_shown() {
    let triangle = "mtllib m.mtl\nusemtl a\nv -2 -2 0\nv 2 -2 0\nv 0 2 0\nf 1 2 3\n";
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, objects: [Mesh(path: \"m.obj\")])";
    let folder = folder(|folder| {
        write(folder, "m.obj", triangle);
        write(folder, "m.mtl", "newmtl a\nKd 1 0 0\n");
        write(folder, "s.ron", text);
    });
    let mut session = program().arg(folder.path().join("s.ron")).spawn();
    session.wait_for("red", SOON, |seen| seen.has(b"8;2;255;0;0"));
    fs::remove_file(folder.path().join("m.obj")).expect("it can be removed");
    make(folder.path(), "m.obj");
    session.wait_for_text("this is a directory");
    fs::remove_dir(folder.path().join("m.obj")).expect("it can be removed");
    write(folder.path(), "m.mtl", "newmtl a\nKd 0 1 0\n");
    write(folder.path(), "m.obj", triangle);
    session.wait_for("green", SOON, |seen| seen.has(b"8;2;0;255;0"));
    leave(&mut session);
}
