//! The keymap, with the changes of the user's `keys.ron`.

use super::files::UserFile;
use crate::cli::outcome::{Failure, usage};
use termtrace::internals::control::Keymap;

/// Returns the built-in keys, changed by `keys.ron` unless `--no-config` is given.
pub(in crate::cli) fn keymap(no_config: bool) -> Result<Keymap, Failure> {
    let file = if no_config { None } else { UserFile::read("keys.ron").map_err(usage)? };
    let own = file.map(|file| Keymap::from_ron(&file.path.to_string_lossy(), &file.text));
    own.transpose().map(Option::unwrap_or_default).map_err(usage)
}
