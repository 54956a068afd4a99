//! Overwriting a file that cannot be replaced by renaming.

use rustix::fs::{FlockOperation, fcntl_lock};
use rustix::io::retry_on_intr;
use std::fs::File;
use std::io::{self, Read, Seek, Write};
use std::os::unix::fs::FileExt;
use std::path::Path;

/// Overwrites a file with the whole contents, and restores the old ones if that fails.
// The file is not truncated first, so that its space on a full disk stays reserved: a file that does not grow needs no
// more space, and if growing fails, the old bytes can be written back.
pub(super) fn write(path: &Path, contents: &[u8]) -> io::Result<()> {
    let file = open(path)?;
    // The lock is released when the file is closed. It is not a `flock`, because `flock FILE termtrace frame ... -o
    // FILE` would wait for itself. An error is ignored, because some file systems have no locks.
    let _ = retry_on_intr(|| fcntl_lock(&file, FlockOperation::LockExclusive));
    let old = OldContents::read_start(&file, contents.len())?;
    overwrite(&file, contents).map_err(|error| match old.restore(&file) {
        Ok(()) => error,
        Err(_) => io::Error::new(error.kind(), format!("its old contents are lost in part: {error}")),
    })
}

/// Opens the file for reading and writing, or only for writing if it may not be read.
// If a file may not be read, its old bytes cannot be restored after a failure.
fn open(path: &Path) -> io::Result<File> {
    File::options().read(true).write(true).open(path).or_else(|_| File::options().write(true).open(path))
}

fn overwrite(mut file: &File, contents: &[u8]) -> io::Result<()> {
    file.rewind()?;
    file.write_all(contents)?;
    file.set_len(contents.len() as u64)?;
    file.sync_all()
}

/// The old contents, to be restored if writing fails.
struct OldContents {
    /// The bytes at the start of the file that the new contents overwrite.
    start: io::Result<Vec<u8>>,
    length: u64,
}

impl OldContents {
    fn read_start(file: &File, max_len: usize) -> io::Result<Self> {
        let mut start = Vec::new();
        let read = file.take(max_len as u64).read_to_end(&mut start);
        Ok(Self { start: read.map(|_| start), length: file.metadata()?.len() })
    }

    /// Writes the overwritten bytes back and restores the length.
    // Only bytes up to the position of the failure are written: later ones are unchanged, and writing them would fail
    // again.
    fn restore(self, mut file: &File) -> io::Result<()> {
        let written = file.stream_position()? as usize;
        let start = self.start?;
        file.write_all_at(&start[..written.min(start.len())], 0)?;
        file.set_len(self.length)?;
        file.sync_all()
    }
}
