//! The new name of a flag or setting that had another one.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue};

/// Old and new names of settings. Their flags are the same words.
const RENAMED: [(&str, &str); 1] = [("view", "map")];

/// Returns the name that the setting `old` has now, if it was renamed.
pub(super) fn setting(old: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(name, _)| *name == old).map(|(_, new)| *new)
}

/// Adds the new name of a flag to the error about its old one.
pub(super) fn with_tip(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg)
        && let Some(new) = flag.strip_prefix("--").and_then(setting)
    {
        let tip = StyledStr::from(format!("the name is now '--{new}'"));
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}
