//! Tips in errors about flags that do not exist, and the new names of renamed settings.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue};

/// Old and new names of renamed settings. The flag of a setting has the same name.
const RENAMED: [(&str, &str); 1] = [("view", "map")];

/// Returns the new name of the setting `old`, if it was renamed.
pub(super) fn renamed_setting(old: &str) -> Option<&'static str> {
    RENAMED.iter().find(|(name, _)| *name == old).map(|(_, new)| *new)
}

/// Returns the tip for a flag that does not exist: which flag to write instead.
fn tip(flag: &str) -> Option<String> {
    match flag {
        "-v" => Some("the version is printed by '-V'".to_owned()),
        _ => flag.strip_prefix("--").and_then(renamed_setting).map(|new| format!("the name is now '--{new}'")),
    }
}

/// Adds the tip, if there is one, to the error about a flag that does not exist.
pub(super) fn with_tip(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg)
        && let Some(tip) = tip(flag)
    {
        let tip = StyledStr::from(tip);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}
