//! Every named input is read within bounds, or is an error of one line.

use super::{BALL, Folder, Run, finish};
use nix::sys::stat::Mode;
use nix::unistd::mkfifo;
use rustix::fs::OFlags;
use std::fs::{self, File, OpenOptions};
use std::io::{PipeWriter, Write, pipe};
use std::os::unix::fs::{OpenOptionsExt, symlink};
use std::os::unix::net::UnixListener;
use std::sync::mpsc::channel;
use std::thread;

/// A named input, and the command that reads it.
struct Named {
    file: &'static str,
    command: &'static str,
    /// The exit code if it cannot be read.
    code: i32,
    /// The most that is read.
    most: &'static str,
}

const NAMED: [Named; 9] = [
    Named { file: "golden.txt", command: "frame ball.ron --check golden.txt", code: 1, most: "16 MiB" },
    Named { file: "golden.png", command: "frame ball.ron --check golden.png", code: 1, most: "16 MiB" },
    Named { file: "path.ron", command: "record ball.ron --path path.ron -o x.cast", code: 2, most: "16 MiB" },
    Named { file: "settings/termtrace/config.ron", command: "config", code: 2, most: "64 KiB" },
    Named { file: "settings/termtrace/keys.ron", command: "config --keys", code: 2, most: "64 KiB" },
    Named { file: "scene.ron", command: "check scene.ron", code: 2, most: "16 MiB" },
    Named { file: "scene", command: "scene", code: 2, most: "16 MiB" },
    Named { file: "z.obj", command: "check z.obj", code: 2, most: "2 GiB" },
    Named { file: "z.ply", command: "frame z.ply", code: 2, most: "2 GiB" },
];

fn folder() -> Folder {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("settings/termtrace")).expect("a folder can be made");
    folder
}

/// Asserts that reading fails for each named input, made by `make`, all at once.
fn each_fails(make: impl Fn(&Folder, &Named) + Sync, words: impl Fn(&Named) -> String + Sync) {
    thread::scope(|scope| {
        for named in &NAMED {
            let (make, words) = (&make, &words);
            scope.spawn(move || {
                let folder = folder();
                make(&folder, named);
                let run = folder.run(named.command);
                run.fails_in_a_line(named.code, &format!("{}: {}\n", named.file, words(named)));
            });
        }
    });
}

fn make_fifo(folder: &Folder, name: &str) {
    mkfifo(&folder.path(name), Mode::S_IRWXU).expect("a pipe can be made");
}

#[test]
fn a_device_is_not_read() {
    for device in ["/dev/zero", "/dev/full", "/dev/random", "/dev/tty"] {
        let make = |folder: &Folder, named: &Named| symlink(device, folder.path(named.file)).expect("a link is made");
        each_fails(make, |_| "this is a device, not a file or a pipe".to_owned());
    }
}

#[test]
fn a_folder_or_a_socket_is_not_read() {
    let make = |folder: &Folder, named: &Named| fs::create_dir(folder.path(named.file)).expect("a folder is made");
    each_fails(make, |named| {
        // Where a scene is opened, a directory stands for the scenes in it.
        let is_opened = named.command == named.file;
        let none = "this is a directory without a scene (.ron) or mesh (.obj, .stl, .ply, .gltf, .glb)";
        if is_opened { none.to_owned() } else { "this is a directory, not a file".to_owned() }
    });
    let make = |folder: &Folder, named: &Named| drop(UnixListener::bind(folder.path(named.file)).expect("it is made"));
    each_fails(make, |_| "this is a socket, not a file or a pipe".to_owned());
}

#[test]
fn a_file_that_is_too_large_is_not_read() {
    let make = |folder: &Folder, named: &Named| {
        let file = File::create(folder.path(named.file)).expect("a file can be made");
        file.set_len(10 << 30).expect("a file can have holes");
    };
    each_fails(make, |named| format!("the file is larger than {}, too large to be read", named.most));
}

#[test]
fn a_pipe_without_a_writer_is_given_up() {
    each_fails(
        |folder, named| make_fifo(folder, named.file),
        |_| "this pipe delivered nothing for a second".to_owned(),
    );
}

/// The writer keeps the pipe open and writes no more.
#[test]
fn a_pipe_that_stops_is_given_up() {
    let make = |folder: &Folder, named: &Named| {
        make_fifo(folder, named.file);
        // Opening for reading too waits for no reader, and the pipe outlives this scope.
        let pipe = OpenOptions::new().read(true).write(true).open(folder.path(named.file));
        let mut pipe = pipe.expect("a pipe can be opened");
        pipe.write_all(b"( // and then").expect("there is room in a pipe");
        std::mem::forget(pipe);
    };
    each_fails(make, |_| "this pipe delivered nothing for a second".to_owned());
}

/// Input without an end is read up to the limit. A mesh's limit, 2 GiB, would take too long here.
#[test]
fn a_pipe_without_end_is_given_up() {
    for named in NAMED.iter().filter(|named| named.most != "2 GiB") {
        let folder = folder();
        make_fifo(&folder, named.file);
        let run = written(&folder, named, |mut pipe| while pipe.write_all(&[b' '; 4096]).is_ok() {});
        let words = format!("the file is larger than {}, too large to be read\n", named.most);
        run.fails_in_a_line(named.code, &words);
    }
    let folder = Folder::new();
    let mut command = folder.command("check -");
    let endless = File::open("/dev/zero").expect("it can be read");
    finish(command.stdin(endless)).fails(2, "standard input:1:1: the file is larger than 16 MiB");
}

/// Runs the command while its pipe is written, and again if the writer was not scheduled for a
/// second, after which a pipe is given up.
#[track_caller]
fn written(folder: &Folder, named: &Named, write: impl Fn(File) + Sync) -> Run {
    let (path, write) = (&folder.path(named.file), &write);
    let run = || {
        let (opened, is_opened) = channel();
        thread::scope(|scope| {
            scope.spawn(move || {
                let pipe = OpenOptions::new().write(true).open(path).expect("a pipe can be opened");
                opened.send(()).expect("it is waited for");
                write(pipe);
            });
            let run = folder.run(named.command);
            // A writer that is too late for the command waits for another reader.
            let flags = OFlags::NONBLOCK.bits().cast_signed();
            let reader = OpenOptions::new().read(true).custom_flags(flags).open(path).expect("a pipe can be opened");
            is_opened.recv().expect("the writer opens it");
            drop(reader);
            run
        })
    };
    let is_in_time = |run: &Run| !run.stderr.contains("this pipe delivered nothing for a second");
    (0..10).map(|_| run()).find(is_in_time).expect("one of ten writers is scheduled")
}

/// Returns contents that are no error under each name.
fn right(folder: &Folder, named: &Named) -> Vec<u8> {
    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                       element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                       0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    match named.file {
        "golden.txt" => folder.frame("ball.ron"),
        "golden.png" => folder.frame("ball.ron --size 80x24 --samples 1 --format png"),
        "path.ron" => b"(keyframes: [(time: 0, eye: (0, 1, 5), target: (0, 1, 0)), (time: 0.1, eye: (0, 2, 5), \
                       target: (0, 1, 0))])"
            .to_vec(),
        "scene.ron" => BALL.as_bytes().to_vec(),
        "settings/termtrace/config.ron" => b"(fps: 30)".to_vec(),
        "settings/termtrace/keys.ron" => folder.run("config --keys").done(),
        "z.obj" => TRIANGLE.as_bytes().to_vec(),
        // A mesh is recognised by its first bytes, too.
        "scene" | "z.ply" => PLY.as_bytes().to_vec(),
        other => panic!("what is right for {other}?"),
    }
}

#[test]
fn input_from_a_pipe_equals_a_file() {
    for named in &NAMED {
        let folder = folder();
        let right = right(&folder, named);
        make_fifo(&folder, named.file);
        let piped = written(&folder, named, |mut pipe| {
            for part in right.chunks(right.len() / 5 + 1) {
                // An error means that the reader has gone, with less than the whole.
                let _ = pipe.write_all(part);
                thread::yield_now();
            }
        });
        fs::remove_file(folder.path(named.file)).expect("it is there");
        folder.write(named.file, &right);
        assert!(piped.done() == folder.run(named.command).done(), "{}", named.file);
    }
}

/// A golden frame may come from a descriptor's number, as for a shell's `frame --check <(...)`.
#[test]
fn a_golden_frame_may_come_out_of_a_descriptor() {
    let folder = Folder::new();
    let golden = folder.frame("ball.ron");
    for (golden, code) in [(&golden[..], 0), (b"another", 1)] {
        for name in ["/dev/stdin", "/dev/fd/0"] {
            let (reader, mut writer): (_, PipeWriter) = pipe().expect("a pipe can be made");
            let mut command = folder.command(&format!("frame ball.ron --format text --check {name}"));
            let run = thread::scope(|scope| {
                scope.spawn(move || writer.write_all(golden).expect("it is read"));
                finish(command.stdin(reader))
            });
            assert_eq!(run.code, Some(code), "{name}: {run:?}");
        }
    }
}

/// The null device reads as an empty file.
#[test]
fn the_null_device_is_an_empty_file() {
    let folder = folder();
    folder.run("check /dev/null").fails(2, "the file is empty");
    assert_eq!(folder.run("frame ball.ron --format text --check /dev/null").code, Some(1));
    symlink("/dev/null", folder.path("settings/termtrace/config.ron")).expect("a link is made");
    folder.run("config").fails(2, "the file is empty");
}

/// A scene or a mesh may come from a stranger: the files that it names must be regular files.
#[test]
fn files_named_in_a_file_must_be_regular_files() {
    let folder = Folder::new();
    folder.write("mesh.ron", "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), objects: [Mesh(path: \"named\")])");
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    folder.write("mtl.obj", format!("{triangle}mtllib named\nf 1 2 3\n"));
    folder.write("texture.obj", format!("{triangle}mtllib x.mtl\nusemtl x\nf 1/1 2/1 3/1\n"));
    folder.write("x.mtl", "newmtl x\nmap_Kd named\n");
    folder.write(
        "x.gltf",
        r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "named", "byteLength": 9}],
        "bufferViews": [{"buffer": 0, "byteLength": 9}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}]}"#,
    );
    let check = |what: &str| {
        for name in ["mesh.ron", "mtl.obj", "texture.obj", "x.gltf"] {
            folder.run(&format!("check {name}")).fails(2, what);
        }
        fs::remove_file(folder.path("named")).expect("it is there");
    };
    make_fifo(&folder, "named");
    check("this is a pipe, not a plain file");
    for device in ["/dev/zero", "/dev/null"] {
        symlink(device, folder.path("named")).expect("a link is made");
        check("this is a device, not a plain file");
    }
    File::create(folder.path("named")).and_then(|file| file.set_len(10 << 30)).expect("a file can have holes");
    check("the file is larger than 2 GiB, too large to be read");
}
