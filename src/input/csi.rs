//! CSI sequences: `ESC [`, a private marker, parameters, intermediates and a final byte.

use crossterm::event::{Event, KeyEvent, KeyModifiers};
use vte::Params;

use super::{Reply, key, mouse};

/// The meaning of a CSI sequence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// A key.
    Key(KeyEvent),
    /// A mouse event or a change of focus.
    Event(Event),
    /// A reply of the terminal.
    Reply(Reply),
    /// The start of a paste.
    PasteStart,
    /// The start of an X10 mouse report; three bytes of it follow.
    OldMouse,
    /// The start of a function key of the Linux console; a letter of it follows.
    LinuxFunction,
    /// Any sequence that is ignored.
    Nothing,
}

/// Returns the meaning of a CSI sequence.
///
/// `marks` are the private marker and intermediates, `last` is the final byte, and `text` is everything after `ESC [`.
pub(super) fn meaning(params: &Params, marks: &[u8], ignored: bool, last: char, text: &[u8]) -> Meaning {
    let sequence = Sequence { params: params.iter().collect(), last, text };
    let meaning = match marks {
        // There were more parameters or intermediates than `vte` stores, so the meaning is unknown.
        _ if ignored => None,
        b"" => sequence.plain_meaning(),
        b"?" => sequence.private_reply().map(Meaning::Reply),
        b"?$" if last == 'y' => sequence.mode_reply().map(Meaning::Reply),
        b">" if last == 'c' => Some(Meaning::Reply(Reply::SecondaryAttributes(sequence.numbers()))),
        b"<" => sequence.sgr_mouse().map(Meaning::Event),
        _ => None,
    };
    meaning.unwrap_or_else(|| Meaning::Reply(Reply::Unknown(text.to_vec())))
}

struct Sequence<'a> {
    /// The parameters, each with its subparameters.
    params: Vec<&'a [u16]>,
    last: char,
    text: &'a [u8],
}

impl Sequence<'_> {
    /// Returns whether the sequence has a final byte only, without parameters.
    fn is_bare(&self) -> bool {
        self.text.len() == 1
    }

    /// Returns the parameters without their subparameters.
    fn numbers(&self) -> Vec<u16> {
        self.params.iter().map(|param| param[0]).collect()
    }

    /// Returns the parameters if there are exactly `N` and none has subparameters.
    fn exact_params<const N: usize>(&self) -> Option<[u16; N]> {
        let plain = self.params.iter().all(|param| param.len() == 1);
        plain.then(|| self.numbers().try_into().ok()).flatten()
    }

    fn plain_meaning(&self) -> Option<Meaning> {
        match self.last {
            '~' if self.params[0] == [200] => Some(Meaning::PasteStart),
            // The end of a paste whose start is missing or that has timed out.
            '~' if self.params[0] == [201] => Some(Meaning::Nothing),
            // `M` with parameters is rxvt's mouse report, handled below.
            'M' if self.is_bare() => Some(Meaning::OldMouse),
            '[' if self.is_bare() => Some(Meaning::LinuxFunction),
            // `CSI I` with parameters is not a report of the focus but an echoed cursor movement by tabs.
            'I' if self.is_bare() => Some(Meaning::Event(Event::FocusGained)),
            'O' if self.is_bare() => Some(Meaning::Event(Event::FocusLost)),
            'M' => {
                let [code, column, row] = self.exact_params()?;
                mouse::from_rxvt(code, column, row).map(Meaning::Event)
            }
            // `R` with parameters is a cursor report; without, it is F3.
            'R' if !self.is_bare() => self.cursor_position().map(Meaning::Reply),
            'n' => self.exact_params().map(|[status]| Meaning::Reply(Reply::Status(status))),
            't' => Some(Meaning::Reply(self.window_reply())),
            _ => self.key().map(Meaning::Key),
        }
    }

    fn key(&self) -> Option<KeyEvent> {
        match self.last {
            // Arrow keys with Shift in rxvt.
            'a'..='d' if self.is_bare() => key::from_letter(self.last.to_ascii_uppercase(), KeyModifiers::SHIFT),
            // The number 27 is not a key, but marks the encoding of xterm's modifyOtherKeys.
            '~' if self.params[0] == [27] => key::from_other_keys(&self.params),
            '~' => key::from_number(&self.params, KeyModifiers::NONE),
            // rxvt's final bytes: `^` for Ctrl, `@` for Ctrl with Shift.
            '^' => key::from_number(&self.params, KeyModifiers::CONTROL),
            '@' => key::from_number(&self.params, KeyModifiers::CONTROL | KeyModifiers::SHIFT),
            'u' => key::from_kitty(&self.params),
            letter => key::from_letter_with_modifiers(letter, &self.params),
        }
    }

    fn private_reply(&self) -> Option<Reply> {
        match self.last {
            'c' => Some(Reply::DeviceAttributes(self.numbers())),
            'u' => self.exact_params().map(|[flags]| Reply::KeyboardFlags(flags)),
            'R' => self.cursor_position(),
            _ => None,
        }
    }

    /// Returns the cursor position. Some terminals add a third parameter, the page.
    fn cursor_position(&self) -> Option<Reply> {
        let [row, column] =
            self.exact_params().or_else(|| self.exact_params().map(|[row, column, _page]| [row, column]))?;
        Some(Reply::CursorPosition { row, column })
    }

    fn mode_reply(&self) -> Option<Reply> {
        self.exact_params().map(|[mode, state]| Reply::Mode { mode, state })
    }

    fn window_reply(&self) -> Reply {
        match self.exact_params() {
            Some([4, height, width]) => Reply::TextPixels { width, height },
            Some([6, height, width]) => Reply::CellPixels { width, height },
            Some([8, rows, columns]) => Reply::TextCells { columns, rows },
            _ => Reply::Window(self.numbers()),
        }
    }

    fn sgr_mouse(&self) -> Option<Event> {
        let [code, column, row] = self.exact_params()?;
        match self.last {
            'M' => mouse::from_sgr(code, column, row, false),
            'm' => mouse::from_sgr(code, column, row, true),
            _ => None,
        }
    }
}
