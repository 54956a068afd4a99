//! The user's configuration files, `config.ron` and `keys.ron`: their location and contents.

use std::io;
use std::path::PathBuf;
use termtrace::LoadError;
use termtrace::internals::named_file::{self, Accepted};
use termtrace::internals::progress::Reporter;
use termtrace::internals::scene_text::text_from;

/// Limit on the size of a configuration file: 64 KiB, over ten times the table of all keys with
/// comments (5 kB), the longest that is useful.
const MAX_USER_FILE_BYTES: usize = 64 << 10;

/// The path and the text of a configuration file.
pub(in crate::cli) struct UserFile {
    pub(in crate::cli) path: PathBuf,
    pub(in crate::cli) text: String,
}

impl UserFile {
    /// Reads the configuration file `name`; `None` if it does not exist, or its folder is unknown.
    pub(in crate::cli) fn read(name: &str) -> Result<Option<Self>, LoadError> {
        let Some(path) = path_of(name) else { return Ok(None) };
        match Self::read_at(path) {
            // `NotADirectory` means that a folder of the path is a file, so there are no settings either. Other errors,
            // such as a missing permission, are reported.
            Err(LoadError::CannotRead { error, .. })
                if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) =>
            {
                Ok(None)
            }
            read => read.map(Some),
        }
    }

    /// Reads the configuration file at `path`.
    pub(in crate::cli) fn read_at(path: PathBuf) -> Result<Self, LoadError> {
        match named_file::read(&path, Accepted::FilesAndPipes, |_| MAX_USER_FILE_BYTES, &Reporter::silent()) {
            Ok(bytes) => {
                let text = text_from(&path.to_string_lossy(), &bytes)?.to_owned();
                Ok(Self { path, text })
            }
            Err(error) => Err(LoadError::CannotRead { path, error }),
        }
    }
}

/// Returns the path of the configuration file `name`: below `$XDG_CONFIG_HOME`, or else
/// `$HOME/.config`. By the XDG Base Directory Specification, a variable whose path is not absolute counts as unset.
pub(in crate::cli) fn path_of(name: &str) -> Option<PathBuf> {
    let folder = |variable| std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
    Some(folder.join("termtrace").join(name))
}
