//! Terminals that are known to support truecolor, to show parts of blocks well, or to shift cells.
//!
//! They are recognized by the replies that identify them.
//!
//! Over ssh only `TERM` is passed on, whose value most terminals share. Not listed are: tmux and GNU screen, which
//! reply themselves, and whose configuration decides whether 24-bit colours reach the terminal; xterm, which replies to
//! the query about colours; Terminal.app and `PuTTY`, whose older versions had no truecolor.

/// Prefixes, in lower case, of the names that terminals with truecolor reply to XTVERSION.
const NAMES: [&str; 11] = [
    "alacritty",
    "contour",
    "foot",
    "ghostty",
    "iterm2",
    "kitty",
    "konsole",
    "mintty",
    "vte",
    "wezterm",
    "windows terminal",
];

/// Returns whether a terminal with this name and version (XTVERSION) supports truecolor.
pub(super) fn name_implies_truecolor(name: &str) -> bool {
    NAMES.iter().any(|known| is_named(name, known))
}

/// Returns whether a terminal with this name and version (XTVERSION) shifts cells by ICH, DCH, IL
/// and DL.
// The terminfo entries of all of them name these sequences. In xterm, kitty, alacritty and st, shifted pictures were
// compared with redrawn ones pixel by pixel.
pub(super) fn name_implies_shifts(name: &str) -> bool {
    name_implies_truecolor(name) || is_named(name, "xterm")
}

/// Returns whether a name and version begin with a name in lower case.
fn is_named(name: &str, known: &str) -> bool {
    name.to_lowercase().strip_prefix(known).is_some_and(|rest| !rest.starts_with(char::is_alphabetic))
}

/// Returns whether a terminal with these secondary device attributes (DA2) supports truecolor, and
/// shifts cells.
// For terminals that do not reply to XTVERSION. DA2 reports the type, the version and a third number.
pub(super) fn attributes_imply_truecolor(attributes: &[u16]) -> bool {
    match *attributes {
        // Alacritty from 0.5 on, and VTE (GNOME Terminal, Xfce Terminal, Tilix) from 0.36 on: 100 times the minor
        // version plus the patch.
        [0, version, 1] if version >= 500 => true,
        [61 | 65, version, 1] => version >= 3600,
        // Windows Terminal and the console of Windows 10; xterm.js, in Visual Studio Code and others; Konsole; mintty.
        [0, 10, 1] | [0, 276, 0] | [0 | 1, 115, 0] | [77, ..] => true,
        _ => false,
    }
}

/// Terminals in which quadrants and eighths of blocks are better than half blocks.
///
/// Each has its name in lower case, and the oldest version that was measured.
// Measured on screenshots against the picture in the pixels of the screen: docs/glyphs.md has the figures. st 0.9 shows
// them as well, but tells its name in `TERM` only.
const BLOCK_PARTS_SINCE: [(&str, [u32; 2]); 4] =
    [("alacritty", [0, 11]), ("foot", [1, 13]), ("kitty", [0, 26]), ("xterm", [379, 0])];

/// Returns whether a terminal with this name and version (XTVERSION) shows parts of blocks well.
pub(super) fn name_implies_block_parts(name: &str) -> bool {
    let name = name.to_lowercase();
    // The version follows in parentheses or after a space. `xterm.js` is another terminal.
    let version = |known| name.strip_prefix(known)?.strip_prefix(['(', ' ']).map(leading_version);
    BLOCK_PARTS_SINCE.iter().any(|&(known, oldest)| version(known).is_some_and(|version| version >= oldest))
}

/// Returns the first two numbers of a version; 0 for each that is missing.
fn leading_version(text: &str) -> [u32; 2] {
    let mut numbers = text.split(|character: char| !character.is_ascii_digit()).map(|digits| digits.parse().ok());
    [0; 2].map(|missing| numbers.next().flatten().unwrap_or(missing))
}

/// Returns whether a terminal with these secondary device attributes (DA2) shows parts of blocks
/// well.
pub(super) fn attributes_imply_block_parts(attributes: &[u16]) -> bool {
    // Alacritty from 0.11 on, whose name is reported from 0.14 on.
    matches!(*attributes, [0, version, 1] if version >= 1100)
}

#[cfg(all(test, unit_tests))]
mod tests;
