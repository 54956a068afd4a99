//! Opening of plain files on any system; pipes are not supported.

use super::Accepted;
use super::refusal::refusal_error;
use std::fs::{File, Metadata};
use std::io::{self, ErrorKind};
use std::path::Path;

/// Opens a plain file and returns its size in bytes.
// Pipes are refused, because each system has another way to wait for them.
pub(super) fn open(path: &Path, _: Accepted) -> io::Result<(File, u64)> {
    // The file is checked before it is opened, because opening a device may have an effect, and again afterwards,
    // because another file may have got its name in between.
    check_kind(&path.metadata()?)?;
    let file = File::open(path)?;
    let data = file.metadata()?;
    check_kind(&data)?;
    Ok((file, data.len()))
}

fn check_kind(data: &Metadata) -> io::Result<()> {
    if data.is_file() {
        Ok(())
    } else if data.is_dir() {
        Err(ErrorKind::IsADirectory.into())
    } else {
        Err(refusal_error(ErrorKind::InvalidInput, "this is not a plain file".to_owned()))
    }
}

/// Returns at once, because reading a plain file never blocks.
#[expect(clippy::unnecessary_wraps, reason = "a pipe may fail, where pipes are read")]
pub(super) fn wait_until_readable(_: &File) -> io::Result<()> {
    Ok(())
}
