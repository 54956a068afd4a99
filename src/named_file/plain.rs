//! Plain files, on any system.

use super::Accepted;
use super::refusal::refused;
use std::fs::{File, Metadata};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Returns the open file and its size. No way to wait for a pipe is the same on all systems: only files are accepted.
pub(super) fn open(path: &Path, _: Accepted) -> io::Result<(File, u64)> {
    // Looked at before it is opened, because opening a device can do something to it; and once more after that, because
    // something else may have taken the name.
    check(&path.metadata()?)?;
    let file = File::open(path)?;
    let data = file.metadata()?;
    check(&data)?;
    Ok((file, data.len()))
}

fn check(data: &Metadata) -> io::Result<()> {
    if data.is_file() {
        Ok(())
    } else if data.is_dir() {
        Err(ErrorKind::IsADirectory.into())
    } else {
        Err(refused(ErrorKind::InvalidInput, "this is not a plain file".to_owned()))
    }
}

/// Returns at once: there always is something to read in a plain file, or its end.
#[expect(clippy::unnecessary_wraps, reason = "a pipe may fail, where pipes are read")]
pub(super) fn wait(_: &File) -> io::Result<()> {
    Ok(())
}
