//! Renamed flags and settings: hints that give the new name.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue};

/// Old and new names of renamed settings. Each is also the name of a flag.
const RENAMED: [(&str, &str); 1] = [("view", "map")];

/// Returns the new name of the setting `old`, if it was renamed.
pub(super) fn setting(old: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(name, _)| *name == old).map(|(_, new)| *new)
}

/// Adds the new name of a renamed flag to clap's error about the old one.
pub(super) fn with_tip(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg)
        && let Some(new) = flag.strip_prefix("--").and_then(setting)
    {
        let tip = StyledStr::from(format!("the name is now '--{new}'"));
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}
