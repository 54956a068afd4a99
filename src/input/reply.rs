//! What a terminal answers when it is asked.

/// An answer of the terminal. None of them is ever a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reply {
    /// `CSI ? n ; ... c`: what kind of terminal this is (DA1). The answer every terminal gives, and so the fence behind
    /// a batch of questions.
    DeviceAttributes(Vec<u16>),
    /// `CSI > n ; ... c`: kind and version (DA2).
    SecondaryAttributes(Vec<u16>),
    /// `CSI row ; column R`, both from 1 (CPR; also the private form with `?`).
    CursorPosition {
        /// From 1, the top line.
        row: u16,
        /// From 1, the leftmost column.
        column: u16,
    },
    /// `CSI 0 n`: the terminal is well (DSR); 3 for not.
    Status(u16),
    /// `CSI ? mode ; state $ y`: how a private mode stands (DECRPM).
    Mode {
        /// The number of the mode.
        mode: u16,
        /// 0 not known, 1 set, 2 reset, 3 set for good, 4 reset for good.
        state: u16,
    },
    /// `CSI 6 ; height ; width t`: the size of a cell in pixels.
    CellPixels {
        /// Pixels from left to right.
        width: u16,
        /// Pixels from top to bottom.
        height: u16,
    },
    /// `CSI 4 ; height ; width t`: the size of the text area in pixels.
    TextPixels {
        /// Pixels from left to right.
        width: u16,
        /// Pixels from top to bottom.
        height: u16,
    },
    /// `CSI 8 ; rows ; columns t`: the size of the text area in cells. tmux 3.3a swaps the two.
    TextCells {
        /// Cells from left to right.
        columns: u16,
        /// Cells from top to bottom.
        rows: u16,
    },
    /// Any other `CSI n ; ... t`: a report of the window.
    Window(Vec<u16>),
    /// `CSI ? flags u`: the flags of the kitty keyboard protocol that are on.
    KeyboardFlags(u16),
    /// `ESC ] ... ST` (or BEL): the bytes between, such as `11;rgb:1e1e/1e1e/1e1e`.
    Osc(Vec<u8>),
    /// `ESC P ... ST`: the bytes between, such as `1$r48;2;1;2;3m`.
    Dcs(Vec<u8>),
    /// `ESC _ ... ST`: the bytes between, such as `Gi=1;OK`.
    Apc(Vec<u8>),
    /// Any other CSI sequence: the bytes after `ESC [`, the first 256 of them.
    Unknown(Vec<u8>),
}
