//! Shifts of shown cells by the terminal itself, and whether a terminal is trusted with them.

use super::{Detected, Hints, Replies, SafeQueries, Source};

/// The way in which shifts of shown cells (ICH, DCH, IL and DL) reach the terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shifts {
    /// Shown cells are never shifted.
    #[default]
    Off,
    /// The terminal shifts cells as it is told.
    Direct,
    /// tmux passes shifts on to the terminal, each in several times as many bytes.
    ThroughTmux,
}

/// Returns whether and how the terminal shifts cells.
///
/// Only terminals that confirm synchronized output do, because without it the half-shifted screen is visible while the
/// frame arrives. The terminal must also identify itself as a known one, or be tmux.
// `TERM` identifies none: multiplexers that redraw their panes from a screen of their own (zellij) keep the outer
// terminal's value. GNU screen, mosh and the Linux console do not confirm synchronized output.
pub(super) fn shifts(hints: &Hints, replies: &Replies) -> Detected<Shifts> {
    if hints.refuses_shifts {
        return Detected { value: Shifts::Off, source: Source::User };
    }
    let Some(is_synchronized) = replies.synchronized_output else {
        return Detected { value: Shifts::Off, source: Source::Assumed };
    };
    let value = match hints.safe_queries() {
        SafeQueries::Tmux if is_synchronized => Shifts::ThroughTmux,
        SafeQueries::All if is_synchronized && replies.is_known_for_shifts() => Shifts::Direct,
        _ => Shifts::Off,
    };
    Detected { value, source: Source::Reply }
}

#[cfg(all(test, unit_tests))]
mod tests;
