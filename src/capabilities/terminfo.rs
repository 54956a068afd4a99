//! The colours of a terminal according to the terminfo database.

use super::Colors;
use termini::{NumberCapability, TermInfo};

/// Returns the colours of a terminal name, if the terminfo database has an entry for it.
///
/// The extended capabilities `RGB` and `Tc` mean truecolor; otherwise the number of colours decides. The database is
/// searched in the folders of ncurses, which environment variables may set.
pub fn terminfo_colors(term: &str) -> Option<Colors> {
    // `TERM` may be any text, so a path is refused: only files of the database are read.
    if term.contains('/') {
        return None;
    }
    TermInfo::from_name(term).ok().map(|entry| entry_colors(&entry))
}

fn entry_colors(entry: &TermInfo) -> Colors {
    let has = |name| entry.extended_cap(name).is_some();
    match entry.number_cap(NumberCapability::MaxColors) {
        _ if has("RGB") || has("Tc") => Colors::Truecolor,
        Some(256..) => Colors::Indexed256,
        // A terminal with eight colours also has the eight bright ones, or shows them as the normal ones.
        Some(8..) => Colors::SIXTEEN,
        _ => Colors::None,
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
