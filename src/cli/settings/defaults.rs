//! What holds where nothing is said of a setting.

/// Each setting with its default, as a person reads it.
const DEFAULTS: [(&str, &str); 11] = [
    ("color", "auto"),
    ("glyphs", "auto"),
    ("map", "shaded"),
    ("quality", "exact; live, on a slow link, equal"),
    ("max_rate", "as many as the link takes"),
    ("cell_aspect", "as the terminal says, or 2"),
    ("samples", "as many as the time allows, at rest best"),
    ("fps", "60"),
    ("move_speed", "1"),
    ("turn_speed", "1"),
    ("reduced_motion", "false"),
];

/// The default of the setting of that name.
///
/// # Panics
/// If there is no such setting.
pub(in crate::cli) fn of(setting: &str) -> &'static str {
    let found = DEFAULTS.iter().find(|(name, _)| *name == setting);
    found.map(|(_, default)| *default).expect("every setting has a default")
}

/// The help of a setting: what it is for, and its default.
pub(in crate::cli) fn help(setting: &str, what_for: &str) -> String {
    format!("{what_for} [default: {}]", of(setting))
}
