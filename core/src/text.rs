//! Text for messages: making untrusted text (names, arguments, files, environment variables)
//! printable, lists in prose, spelling suggestions, and errors in parts.

mod notice;
mod parse_error;
mod words;

pub use notice::Notice;
pub use parse_error::ParseError;
pub use parse_error::named;
pub use words::number;
pub use words::{any_of, closest, listed};

/// Returns the character to show in a message for `c`: a replacement if `c` moves the cursor,
/// starts an escape sequence, changes the direction of writing, or is invisible; otherwise `c`.
pub fn visible_char(c: char) -> char {
    match c {
        '\t' => ' ',
        // Zero-width characters, direction marks, line and paragraph separators; embeddings and overrides; the word
        // joiner, isolates and deprecated format characters; the Arabic letter mark; the byte order mark.
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{61c}' | '\u{feff}' => {
            char::REPLACEMENT_CHARACTER
        }
        // The control characters C0, DEL and C1. In C1, U+009B starts an escape sequence in some terminals.
        _ if c.is_control() => char::REPLACEMENT_CHARACTER,
        _ => c,
    }
}

/// Returns the text as one line, with control characters replaced.
pub fn visible(text: &str) -> String {
    text.chars().map(visible_char).collect()
}

/// Returns the text with all control characters but line feeds replaced.
pub fn visible_lines(text: &str) -> String {
    text.chars().map(|c| if c == '\n' { c } else { visible_char(c) }).collect()
}

#[cfg(all(test, unit_tests))]
mod tests;
