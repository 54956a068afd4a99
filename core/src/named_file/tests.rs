use super::*;
use std::fs;
use std::ops::ControlFlow;

fn read_up_to(max_len: usize, path: &Path, accepted: Accepted) -> Result<Vec<u8>, String> {
    read(path, accepted, |_| max_len, &Reporter::silent()).map_err(|error| reason(&error))
}

#[test]
fn no_more_bytes_than_allowed_are_read() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("file");
    let size = 3 << 20;
    fs::write(&path, vec![7; size]).expect("written");
    let too_large = |size: &str| Err(format!("the file is larger than {size}, too large to be read"));
    assert_eq!(read_up_to(size, &path, Accepted::Files).map(|bytes| bytes.len()), Ok(size));
    assert_eq!(read_up_to(size - 1, &path, Accepted::Files), too_large("3145727 bytes"));
    assert_eq!(read_up_to(2 << 20, &path, Accepted::Files), too_large("2 MiB"));
    // The first bytes determine the limit.
    let max_len = |bytes: &[u8]| if bytes.starts_with(&[7]) { 64 << 10 } else { usize::MAX };
    let error = read(&path, Accepted::Files, max_len, &Reporter::silent()).expect_err("too large");
    assert_eq!(Err(reason(&error)), too_large("64 KiB"));
    // The size that the system reports is enough for the error, before anything is read.
    File::create(&path).and_then(|file| file.set_len(1 << 42)).expect("a sparse file can be made");
    assert_eq!(read_up_to(1 << 30, &path, Accepted::Files), too_large("1 GiB"));
}

/// Cancels a read at a progress report, which happens between two chunks.
#[test]
fn a_cancelled_read_ends() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("file");
    fs::write(&path, vec![7; 3 << 20]).expect("written");
    let on_progress = |progress: Progress| {
        if progress.done < 2 << 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let error = read(&path, Accepted::Files, |_| usize::MAX, &Reporter::new(&on_progress)).expect_err("given up");
    assert_eq!(error.kind(), ErrorKind::Interrupted);
}
