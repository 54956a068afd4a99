//! The defaults of settings, as text for the help.

/// Each setting and its default as text for the help. It is text because some defaults depend on
/// the terminal.
const DEFAULTS: [(&str, &str); 14] = [
    ("color", "auto"),
    ("glyphs", "auto"),
    ("background", "auto: as the terminal reports, or dark"),
    ("map", "shaded"),
    ("quality", "exact; in casts, and live on a slow link, equal"),
    ("max_rate", "the measured rate of the link"),
    ("moves", "auto"),
    ("cell_aspect", "as detected, or 2"),
    ("samples", "as many as the time allows; best at rest"),
    ("fps", "60"),
    ("move_speed", "1"),
    ("turn_speed", "1"),
    ("reduced_motion", "false"),
    ("hint", "true"),
];

/// Returns the default of the setting with this name.
///
/// # Panics
/// If there is no such setting.
pub(in crate::cli) fn of_setting(setting: &str) -> &'static str {
    let found = DEFAULTS.iter().find(|(name, _)| *name == setting);
    found.map(|(_, default)| *default).expect("every setting has a default")
}

/// Returns the help of a setting: its purpose and its default.
pub(in crate::cli) fn help(setting: &str, what_for: &str) -> String {
    format!("{what_for} [default: {}]", of_setting(setting))
}
