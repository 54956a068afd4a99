//! The terminal of a client, as its requests describe it: a window, and a few variables.

use crate::capabilities::{self, CellShape, Colors, Hints};
use crate::grid::{Size, Window};

/// The largest window that is drawn in; of a larger one the upper left part is used.
// The first frame of such a window takes an estimated 15 ms of one core, for which other viewers wait.
pub(super) const MAX_WINDOW: Size = Size::new(500, 200);

/// The environment variables that a client may set, for the detection of its terminal's
/// capabilities.
///
/// They are not set in the server's process, and none of them names a file.
const ACCEPTED: [&str; 6] = ["TERM", "COLORTERM", "NO_COLOR", "LC_ALL", "LC_CTYPE", "LANG"];

/// Limit on the characters of a variable's value; a variable with a longer one is ignored.
const MAX_VALUE: usize = 64;

/// The terminal of a client.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ClientTerminal {
    variables: Vec<(&'static str, String)>,
    /// The window; `None` if the client has not asked for a terminal.
    pub(super) window: Option<Window>,
}

impl ClientTerminal {
    /// Records a variable if its name is accepted and its value is short and harmless.
    ///
    /// A harmless value consists of ASCII letters, digits and `+-._:@`, and does not start with a dot.
    pub(super) fn set_variable(&mut self, name: &str, value: &str) {
        let Some(name) = ACCEPTED.into_iter().find(|&known| known == name) else { return };
        let is_usual = |c: char| c.is_ascii_alphanumeric() || "+-._:@".contains(c);
        // The value of `TERM` becomes part of the path of a terminfo file, so neither `/` nor a leading dot is
        // accepted.
        if value.len() > MAX_VALUE || !value.chars().all(is_usual) || value.starts_with('.') {
            return;
        }
        // The last value counts: the request for a terminal sets `TERM`, and the client may set the variable again.
        self.variables.retain(|(known, _)| *known != name);
        self.variables.push((name, value.to_owned()));
    }

    /// Returns the hints about the terminal; `terminfo` returns the colours of a terminal name.
    pub(super) fn hints(&self, terminfo: &dyn Fn(&str) -> Option<Colors>) -> Hints {
        let variable = |name: &str| {
            let found = self.variables.iter().find(|(known, _)| *known == name);
            found.map(|(_, value)| value.clone())
        };
        Hints::gather(&variable, terminfo)
    }
}

/// Returns the window of a size in cells and in pixels, as a client reports it.
///
/// A size of 0 means an unknown size, as on a serial line, and becomes 80x24.
pub(super) fn window([columns, rows, width, height]: [u32; 4]) -> Window {
    let short = |number: u32| u16::try_from(number).unwrap_or(0);
    let [given_columns, given_rows, width, height] = [columns, rows, width, height].map(short);
    let size = if columns == 0 || rows == 0 {
        Size::new(80, 24)
    } else {
        let within = |number: u32, most: u16| u16::try_from(number).unwrap_or(most).clamp(1, most);
        Size::new(within(columns, MAX_WINDOW.columns), within(rows, MAX_WINDOW.rows))
    };
    let aspect = capabilities::cell_aspect(given_columns, given_rows, width, height);
    let cell = CellShape { aspect, half_blocks: capabilities::half_blocks(given_rows, height) };
    let pixels = width.checked_div(given_columns).zip(height.checked_div(given_rows));
    let is_part = columns > MAX_WINDOW.columns.into() || rows > MAX_WINDOW.rows.into();
    Window { size, cell, cell_pixels: aspect.and(pixels), is_part }
}

#[cfg(all(test, unit_tests))]
mod tests;
