//! The user's own keys.

use super::files::UserFile;
use crate::cli::outcome::{Failure, usage};
use termtrace::internals::control::Bindings;

/// The built-in bindings, changed as `keys.ron` says, unless the user wants none of his files.
pub(in crate::cli) fn bindings(no_config: bool) -> Result<Bindings, Failure> {
    let file = if no_config { None } else { UserFile::read("keys.ron").map_err(usage)? };
    let own = file.map(|file| Bindings::from_ron(&file.path.to_string_lossy(), &file.text));
    own.transpose().map(Option::unwrap_or_default).map_err(usage)
}
