//! Replies of a terminal to queries.

/// A terminal's reply to a query.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply {
    /// `CSI ? n ; ... c`: the device attributes (DA1).
    ///
    /// Every terminal sends this reply. Its query is the last one of a batch (the fence): the reply shows that no reply
    /// to an earlier query is still to come.
    DeviceAttributes(Vec<u16>),
    /// `CSI > n ; ... c`: the terminal's type and version (DA2).
    SecondaryAttributes(Vec<u16>),
    /// `CSI row ; column R`: the position of the cursor (CPR; also in the private form with `?`).
    CursorPosition {
        /// The row, from 1 at the top.
        row: u16,
        /// The column, from 1 at the left.
        column: u16,
    },
    /// `CSI status n`: the device status (DSR); 0 for ready, 3 for a malfunction.
    Status(u16),
    /// `CSI ? mode ; state $ y`: the state of a private mode (DECRPM).
    Mode {
        /// The number of the mode.
        mode: u16,
        /// The state: 0 not recognised, 1 set, 2 reset, 3 permanently set, 4 permanently reset.
        state: u16,
    },
    /// `CSI 6 ; height ; width t`: the size of a cell in pixels.
    CellPixels {
        /// The width of a cell in pixels.
        width: u16,
        /// The height of a cell in pixels.
        height: u16,
    },
    /// `CSI 4 ; height ; width t`: the size of the text area in pixels.
    TextPixels {
        /// The width of the text area in pixels.
        width: u16,
        /// The height of the text area in pixels.
        height: u16,
    },
    /// `CSI 8 ; rows ; columns t`: the size of the text area in cells. tmux 3.3a swaps the two.
    TextCells {
        /// The number of columns.
        columns: u16,
        /// The number of rows.
        rows: u16,
    },
    /// Any other `CSI n ; ... t`: a window report.
    Window(Vec<u16>),
    /// `CSI ? flags u`: the flags of the kitty keyboard protocol that are set.
    KeyboardFlags(u16),
    /// `ESC ] ... ST` (or BEL): the contents of an OSC string, such as `11;rgb:1e1e/1e1e/1e1e`.
    Osc(Vec<u8>),
    /// `ESC P ... ST`: the contents of a DCS string, such as `1$r48;2;1;2;3m`.
    Dcs(Vec<u8>),
    /// `ESC _ ... ST`: the contents of an APC string, such as `Gi=1;OK`.
    Apc(Vec<u8>),
    /// Any other CSI sequence: the bytes after `ESC [`, at most 256.
    Unknown(Vec<u8>),
}
