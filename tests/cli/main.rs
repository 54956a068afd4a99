//! The program from outside: arguments, files and pipes in; bytes and an exit code out.
//!
//! Only the progress of `record` needs a terminal here; the live view has tests of its own.

mod assets;
mod bench;
mod camera;
mod cells;
mod config;
mod describe;
mod doctor;
mod errors;
mod explain;
mod formats;
mod formulas;
mod glyphs;
mod golden;
mod inputs;
mod json;
mod maps;
mod meshes;
mod outputs;
mod pictures;
mod pipes;
#[path = "../pty/mod.rs"]
mod pty;
mod record;
mod reference;
mod shells;
mod shipped;
mod sizes;
mod starting;
mod web;

use std::fs::{self, File};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A ball on a chequered floor without symmetry: a picture that is turned or shifted is another
/// one.
pub(crate) const BALL: &str = r##"(
    camera: (eye: (1, 1.5, 6), target: (0, 0.7, 0), up: (0, 1, 0), vertical_fov: 40),
    background: "#87a6cc",
    ambient: 0.03,
    lights: [Point(position: (4, 6, 5), color: "#ffeedd", intensity: 60)],
    objects: [
        Sphere(center: (-0.6, 1, 0), radius: 1, material: Diffuse("#e04030")),
        Plane(point: (0, 0, 0), normal: (0, 1, 0), material: Checker(a: "#dddddd", b: "#333333", size: 1)),
    ],
)
"##;

/// A temporary folder with `ball.ron`, in which the program runs.
pub(crate) struct Folder {
    folder: TempDir,
}

impl Folder {
    pub(crate) fn new() -> Self {
        let folder = Self { folder: tempfile::tempdir().expect("a folder can be made") };
        folder.write("ball.ron", BALL);
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).expect("the file can be written");
    }

    #[track_caller]
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("the file was written")
    }

    /// Returns a command of the program, whose arguments have no blanks in them.
    ///
    /// The user's own settings have no effect: their folder is `settings` in this one.
    pub(crate) fn command(&self, arguments: &str) -> Command {
        pty::reset_for_children();
        let mut command = Command::new(env!("CARGO_BIN_EXE_termtrace"));
        for (name, _) in std::env::vars_os().filter(|(name, _)| name.as_encoded_bytes().starts_with(b"TERMTRACE_")) {
            command.env_remove(name);
        }
        command.env("XDG_CONFIG_HOME", self.path("settings"));
        command.args(arguments.split_whitespace()).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    #[track_caller]
    pub(crate) fn run(&self, arguments: &str) -> Run {
        finish(&mut self.command(arguments))
    }

    /// Runs the program with this standard input.
    #[track_caller]
    pub(crate) fn run_on(&self, arguments: &str, input: impl AsRef<[u8]>) -> Run {
        let mut file = scratch();
        file.write_all(input.as_ref()).and_then(|()| file.rewind()).expect("the file can be written");
        finish(self.command(arguments).stdin(file))
    }

    /// Returns the output of a frame without errors.
    #[track_caller]
    pub(crate) fn frame(&self, arguments: &str) -> Vec<u8> {
        self.run(&format!("frame {arguments}")).done()
    }
}

fn scratch() -> File {
    tempfile::tempfile().expect("a file can be made")
}

/// The result of a run.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

/// Runs the program to its end, which has to come: nothing here is a terminal.
#[track_caller]
pub(crate) fn finish(command: &mut Command) -> Run {
    let (mut stdout, mut stderr) = (scratch(), scratch());
    let for_child = |file: &File| file.try_clone().expect("a file can be shared");
    let mut child = command.stdout(for_child(&stdout)).stderr(for_child(&stderr)).spawn().expect("the program starts");
    let deadline = Instant::now() + Duration::from_secs(60);
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child can be waited for") {
            break status;
        }
        if Instant::now() > deadline {
            let _ = child.kill();
            panic!("{command:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let read = |file: &mut File| {
        let mut bytes = Vec::new();
        file.rewind().and_then(|()| file.read_to_end(&mut bytes)).expect("the file can be read");
        bytes
    };
    Run { code: status.code(), stdout: read(&mut stdout), stderr: String::from_utf8(read(&mut stderr)).expect("UTF-8") }
}

impl Run {
    /// Asserts success without a message, and returns the output.
    #[track_caller]
    pub(crate) fn done(self) -> Vec<u8> {
        assert_eq!((self.code, self.stderr.as_str()), (Some(0), ""));
        self.stdout
    }

    #[track_caller]
    pub(crate) fn text(self) -> String {
        String::from_utf8(self.done()).expect("text is UTF-8")
    }

    /// Asserts that the run failed with this exit code, without output, and with one message.
    ///
    /// The message begins with the program's name and has `words` in it.
    #[track_caller]
    pub(crate) fn fails(&self, code: i32, words: &str) {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.stdout.is_empty(), "{self:?}");
        assert!(self.stderr.starts_with("error: "), "{self:?}");
        assert!(self.stderr.contains(words), "not {words:?}: {self:?}");
        assert!(self.stderr.ends_with('\n') && !self.stderr.ends_with("\n\n"), "{self:?}");
        assert_eq!(self.stderr.matches("error: ").count(), 1, "{self:?}");
        for word in ["panicked", "RUST_BACKTRACE", "Os {", "Error {"] {
            assert!(!self.stderr.contains(word), "{self:?}");
        }
        assert!(self.stderr.chars().all(|c| c == '\n' || !c.is_control()), "{self:?}");
    }

    /// Asserts as [`Run::fails`], for a message of one line.
    #[track_caller]
    pub(crate) fn fails_in_a_line(&self, code: i32, words: &str) {
        self.fails(code, words);
        assert_eq!(self.stderr.lines().count(), 1, "{self:?}");
    }

    /// Asserts that the command line was refused with these words.
    #[track_caller]
    pub(crate) fn is_misused(&self, words: &str) {
        assert_eq!(self.code, Some(2), "{self:?}");
        assert!(self.stdout.is_empty(), "{self:?}");
        assert!(self.stderr.starts_with("error: "), "{self:?}");
        assert!(self.stderr.contains(words), "not {words:?}: {self:?}");
        assert!(!self.stderr.contains("panicked"), "{self:?}");
    }
}

/// Returns all shipped scenes.
pub(crate) fn shipped_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("the folder can be read").path());
    let scenes: Vec<_> = paths.filter(|path| path.extension().is_some_and(|ending| ending == "ron")).collect();
    assert!(scenes.len() >= 8, "only {} scenes", scenes.len());
    scenes
}
