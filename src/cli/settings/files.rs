//! The user's own files: where they are, and what is in them.

use std::io;
use std::path::PathBuf;
use termtrace::LoadError;
use termtrace::internals::named_file::{self, Accepted};
use termtrace::internals::progress::Reporter;
use termtrace::internals::scene_text::text_from;

/// The most bytes that a file of the user's has: 64 KiB, more than ten times the whole table of keys with what each command
/// does, which is the longest of them (5 kB).
const MAX_USER_FILE_BYTES: usize = 64 << 10;

/// A file of the user's that is there.
pub(in crate::cli) struct UserFile {
    pub(in crate::cli) path: PathBuf,
    pub(in crate::cli) text: String,
}

impl UserFile {
    /// The file of that name; `None` if there is none, or no place for one.
    pub(in crate::cli) fn read(name: &str) -> Result<Option<Self>, LoadError> {
        let Some(path) = path_of(name) else { return Ok(None) };
        match named_file::read(&path, Accepted::FilesAndPipes, |_| MAX_USER_FILE_BYTES, &Reporter::silent()) {
            Ok(bytes) => {
                let text = text_from(&path.to_string_lossy(), &bytes)?.to_owned();
                Ok(Some(Self { path, text }))
            }
            // The folder may be a file, too: then there are no settings in it.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(None),
            Err(error) => Err(LoadError::CannotRead { path, error }),
        }
    }
}

/// Where the file of that name is looked for: below `$XDG_CONFIG_HOME`, or else `$HOME/.config`. By the XDG Base Directory
/// Specification what is no absolute path counts as unset.
pub(in crate::cli) fn path_of(name: &str) -> Option<PathBuf> {
    let folder = |variable| std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
    Some(folder.join("termtrace").join(name))
}
