//! Decoders for mouse reports, in the SGR, rxvt and X10 encodings.

use crossterm::event::{Event, KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

const SHIFT: u16 = 4;
const ALT: u16 = 8;
const CONTROL: u16 = 16;
const MOTION: u16 = 32;
/// Offset of the three bytes of an X10 report and of the code in an rxvt report.
// In an X10 report the offset keeps the bytes from being control characters.
const OFFSET: u8 = 32;

/// Decodes the SGR encoding: `CSI < code ; column ; row M`, or `m` for a release.
///
/// Column and row are in cells or in pixels, counted from 1.
pub(super) fn from_sgr(code: u16, column: u16, row: u16, released: bool) -> Option<Event> {
    let kind = match (kind_from_code(code)?, released) {
        (MouseEventKind::Down(button) | MouseEventKind::Drag(button), true) => MouseEventKind::Up(button),
        // Releases are valid for buttons only, not for the wheel. Code 3, which means a release in the older encodings,
        // is not valid in the SGR encoding.
        (_, true) | (MouseEventKind::Up(_), false) => return None,
        (kind, false) => kind,
    };
    Some(event(kind, code, column, row))
}

/// Decodes the encoding of rxvt: `CSI code ; column ; row M`.
pub(super) fn from_rxvt(code: u16, column: u16, row: u16) -> Option<Event> {
    let code = code.checked_sub(u16::from(OFFSET))?;
    Some(event(kind_from_code(code)?, code, column, row))
}

/// Decodes the X10 encoding: the three bytes after `CSI M`.
pub(super) fn from_bytes(code: u8, column: u8, row: u8) -> Option<Event> {
    let code = u16::from(code.checked_sub(OFFSET)?);
    let column = u16::from(column.checked_sub(OFFSET)?);
    let row = u16::from(row.checked_sub(OFFSET)?);
    Some(event(kind_from_code(code)?, code, column, row))
}

// Subtraction saturates, because a terminal may report 0 for a position outside the window.
fn event(kind: MouseEventKind, code: u16, column: u16, row: u16) -> Event {
    Event::Mouse(MouseEvent {
        kind,
        column: column.saturating_sub(1),
        row: row.saturating_sub(1),
        modifiers: modifiers_from_code(code),
    })
}

/// Decodes the kind of event: bits 0, 1, 6 and 7 of `code` are the button, bit 5 is set for motion.
fn kind_from_code(code: u16) -> Option<MouseEventKind> {
    let button = (code & 0b11) | ((code & 0b1100_0000) >> 4);
    let moved = code & MOTION != 0;
    Some(match (button, moved) {
        // Bits beyond the eighth have no meaning in any encoding.
        _ if code > 0xff => return None,
        (0, false) => MouseEventKind::Down(MouseButton::Left),
        (1, false) => MouseEventKind::Down(MouseButton::Middle),
        (2, false) => MouseEventKind::Down(MouseButton::Right),
        (3, false) => MouseEventKind::Up(MouseButton::Left),
        (0, true) => MouseEventKind::Drag(MouseButton::Left),
        (1, true) => MouseEventKind::Drag(MouseButton::Middle),
        (2, true) => MouseEventKind::Drag(MouseButton::Right),
        (3, true) => MouseEventKind::Moved,
        (4, false) => MouseEventKind::ScrollUp,
        (5, false) => MouseEventKind::ScrollDown,
        (6, false) => MouseEventKind::ScrollLeft,
        (7, false) => MouseEventKind::ScrollRight,
        // The side buttons are ignored, because crossterm's `MouseButton` has no values for them.
        _ => return None,
    })
}

fn modifiers_from_code(code: u16) -> KeyModifiers {
    [(SHIFT, KeyModifiers::SHIFT), (ALT, KeyModifiers::ALT), (CONTROL, KeyModifiers::CONTROL)]
        .into_iter()
        .filter(|(bit, _)| code & bit != 0)
        .map(|(_, modifier)| modifier)
        .collect()
}
