//! The terminal that a frame is printed on, so that it shows colours and fills the window.

use crate::cli::cells::CellArgs;
use rustix::termios::tcgetwinsize;
use std::io::{self, IsTerminal};
use termtrace::CellMode;
use termtrace::internals::capabilities::{self, CellShape, Findings, Replies};

/// The cell mode and the size in which a frame is printed on a terminal.
#[derive(Clone, Copy)]
pub(super) struct Screen {
    pub(super) mode: CellMode,
    /// The columns and rows of the window, less one row, which the shell's prompt takes.
    pub(super) cells: (u32, u32),
    pub(super) cell_aspect: f32,
}

impl Screen {
    /// Returns the terminal at standard output, if there is one.
    ///
    /// The terminal is not queried, because waiting for replies takes time: the flags, the environment and the window's
    /// size determine the result.
    pub(super) fn of_stdout(cells: &CellArgs) -> Option<Self> {
        let stdout = io::stdout();
        let window = stdout.is_terminal().then(|| tcgetwinsize(&stdout).ok())??;
        let (columns, rows) = (window.ws_col, window.ws_row);
        let aspect = capabilities::cell_aspect(columns, rows, window.ws_xpixel, window.ws_ypixel);
        let shape = CellShape { aspect, ..CellShape::default() };
        let found = Findings::new(&cells.detection_hints(None), shape, &Replies::default()).capabilities();
        // A terminal that does not know its size reports 0 columns and 0 rows.
        let cells = if columns == 0 || rows == 0 { (80, 23) } else { (columns.into(), u32::from(rows - 1).max(1)) };
        Some(Self { mode: found.cell_mode, cells, cell_aspect: found.cell_aspect })
    }
}
