//! The user's own files: where they are, and what is in them.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use termtrace::scene::LoadError;
use termtrace::scene_text::{MAX_BYTES, text_from};

/// A file of the user's that is there.
pub(in crate::cli) struct UserFile {
    pub(in crate::cli) path: PathBuf,
    pub(in crate::cli) text: String,
}

impl UserFile {
    /// The file of that name; `None` if there is none, or no place for one.
    pub(in crate::cli) fn read(name: &str) -> Result<Option<Self>, LoadError> {
        let Some(path) = path_of(name) else { return Ok(None) };
        match bytes_of(&path) {
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

/// One byte more than a file may have is read: then it is known to be too large.
fn bytes_of(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Where the file of that name is looked for: below `$XDG_CONFIG_HOME`, or else `$HOME/.config`. By the XDG Base Directory
/// Specification what is no absolute path counts as unset.
pub(in crate::cli) fn path_of(name: &str) -> Option<PathBuf> {
    let folder = |variable| std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
    Some(folder.join("termtrace").join(name))
}
