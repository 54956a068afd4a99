use super::*;
use crate::named_file::{read, reason};
use crate::progress::Reporter;
use nix::sys::stat::Mode;
use nix::unistd::mkfifo;
use std::fs;
use std::io::Write;
use std::os::unix::net::UnixListener;
use std::path::PathBuf;

fn read_up_to(most: usize, path: &Path, accepted: Accepted) -> Result<Vec<u8>, String> {
    read(path, accepted, |_| most, &Reporter::silent()).map_err(|error| reason(&error))
}

fn fifo(folder: &Path) -> PathBuf {
    let path = folder.join("fifo");
    mkfifo(&path, Mode::S_IRWXU).expect("a pipe can be made");
    path
}

#[test]
fn only_accepted_kinds_of_files_are_read() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let (file, socket) = (folder.path().join("file"), folder.path().join("socket"));
    fs::write(&file, "hello").expect("written");
    let _listener = UnixListener::bind(&socket).expect("a socket can be made");
    let fifo = fifo(folder.path());
    let [zero, null] = ["/dev/zero", "/dev/null"].map(Path::new);
    let refusal = |what: &str| Err(what.to_owned());
    for (path, for_user, for_file) in [
        (&*file, Ok(b"hello".to_vec()), Ok(b"hello".to_vec())),
        (null, Ok(Vec::new()), refusal("this is a device, not a plain file")),
        (zero, refusal("this is a device, not a file or a pipe"), refusal("this is a device, not a plain file")),
        (&socket, refusal("this is a socket, not a file or a pipe"), refusal("this is a socket, not a plain file")),
        (&fifo, refusal("this pipe delivered nothing for a second"), refusal("this is a pipe, not a plain file")),
        (folder.path(), refusal("this is a directory, not a file"), refusal("this is a directory, not a file")),
    ] {
        assert_eq!(read_up_to(9, path, Accepted::FilesAndPipes), for_user, "{}", path.display());
        assert_eq!(read_up_to(9, path, Accepted::Files), for_file, "{}", path.display());
    }
}

/// Reads a pipe of its own while `write` writes it, and again if the writer was not scheduled for a
/// second, after which a pipe is given up.
fn read_written(most: usize, write: fn(File)) -> Result<Vec<u8>, String> {
    let given_up: Result<Vec<u8>, String> = Err("this pipe delivered nothing for a second".to_owned());
    let attempt = || {
        let folder = tempfile::tempdir().expect("a folder can be made");
        let path = fifo(folder.path());
        let writer = path.clone();
        let writing = std::thread::spawn(move || {
            write(OpenOptions::new().write(true).open(writer).expect("the reader opens it"));
        });
        let read = read_up_to(most, &path, Accepted::FilesAndPipes);
        // A writer that came too late waits for a reader for ever.
        if read != given_up {
            writing.join().expect("the pipe is written until it is closed");
        }
        read
    };
    let in_time = (0..10).map(|_| attempt()).find(|read| *read != given_up);
    in_time.unwrap_or(given_up)
}

/// Reads a pipe whose writer yields after each part, so that the reader often finds the pipe empty.
#[test]
fn a_slow_pipe_is_read_to_its_end() {
    let read = read_written(4_000_000, |mut pipe| {
        for part in 0..40 {
            pipe.write_all(&vec![part; 100_000]).expect("the reader reads on");
            std::thread::yield_now();
        }
    });
    let whole: Vec<u8> = (0..40).flat_map(|part| vec![part; 100_000]).collect();
    assert!(read == Ok(whole), "all that was written");
}

#[test]
fn a_pipe_without_end_is_refused_at_the_limit() {
    let read = read_written(2 << 20, |mut pipe| while pipe.write_all(&[0; 4096]).is_ok() {});
    assert_eq!(read, Err("the file is larger than 2 MiB, too large to be read".to_owned()));
}
