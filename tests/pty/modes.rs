//! The modes of a terminal that bytes turn on and do not turn off again.

use std::collections::{BTreeMap, BTreeSet};

use vte::{Params, Perform};

/// The private modes that have a name here; others are named by their numbers.
const NAMES: [(u16, &str); 21] = [
    (1, "application cursor keys"),
    (5, "reverse video"),
    (6, "origin"),
    (7, "autowrap"),
    (9, "mouse, X10"),
    (25, "cursor"),
    (47, "alternate screen"),
    (66, "application keypad"),
    (1000, "mouse buttons"),
    (1002, "mouse drag"),
    (1003, "mouse motion"),
    (1004, "focus"),
    (1005, "mouse in UTF-8"),
    (1006, "mouse in SGR"),
    (1015, "mouse as rxvt"),
    (1016, "mouse in pixels"),
    (1047, "alternate screen"),
    (1049, "alternate screen"),
    (2004, "bracketed paste"),
    (2026, "synchronized output"),
    (2048, "resize reports"),
];

/// The private modes that are on when a terminal starts: wrapping, the cursor.
const ON_AT_START: [u16; 2] = [7, 25];

const INSERT: &str = "insert mode left on";
const KEYPAD: &str = "application keypad left on";
const OTHER_KEYS: &str = "modifyOtherKeys left on";
const CURSOR_SHAPE: &str = "cursor shape left changed";
const SCROLL_REGION: &str = "scroll region left set";
const LINE_DRAWING: &str = "line drawing characters left on";
const SHIFTED_OUT: &str = "shifted out";
const CUT: &str = "a sequence or a character was cut off by the next";
const LINK: &str = "hyperlink left open";

/// The state in which bytes leave a terminal that was in its ground state before.
///
/// It is strict about the pen: a cursor restored (`ESC 8`, mode 1049) brings the pen of its saving with it in some
/// terminals only, so what counts is that the bytes themselves reset it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Modes {
    private: BTreeMap<u16, bool>,
    /// Attributes of the pen that are not reset, by the number that set them.
    pen: BTreeMap<&'static str, u16>,
    /// The flags of the kitty keyboard protocol that were pushed and not popped.
    ///
    /// The main screen and the alternate one keep their own.
    keyboard: [Vec<u16>; 2],
    /// Its flags below all that was pushed, which `CSI = flags u` may set.
    keyboard_flags: [u16; 2],
    /// Other changes that were not undone, in words.
    others: BTreeSet<&'static str>,
    torn: bool,
}

impl Modes {
    /// Returns the state after these bytes.
    pub(crate) fn after(bytes: &[u8]) -> Self {
        let mut modes = Self::default();
        let mut parser = vte::Parser::new();
        parser.advance(&mut modes, bytes);
        // A letter is printed as itself unless the bytes end inside a sequence or a character.
        let mut probe = Probe::default();
        parser.advance(&mut probe, b"x");
        modes.torn = probe.heard != ['x'];
        modes.set(CUT, is_cut(bytes));
        modes
    }

    /// Returns whether the bytes end inside an escape sequence, a string or a character.
    pub(crate) fn is_torn(&self) -> bool {
        self.torn
    }

    /// Returns whether a private mode is on.
    pub(crate) fn is_on(&self, mode: u16) -> bool {
        self.private.get(&mode).copied().unwrap_or(ON_AT_START.contains(&mode))
    }

    /// Returns the flags of the kitty keyboard protocol that are on.
    pub(crate) fn keyboard_flags(&self) -> u16 {
        let screen = self.screen();
        self.keyboard[screen].last().copied().unwrap_or(self.keyboard_flags[screen])
    }

    /// Returns the changes that were not undone, in words.
    pub(crate) fn left_on(&self) -> Vec<String> {
        let mut left: Vec<String> = self
            .private
            .iter()
            .filter(|(mode, on)| **on != ON_AT_START.contains(mode))
            .map(|(&mode, &on)| format!("{} ({mode}) left {}", name(mode), if on { "on" } else { "off" }))
            .collect();
        left.extend(self.pen.iter().map(|(what, by)| format!("pen: {what} left by {by}")));
        for (screen, depth) in ["main", "alternate"].iter().zip(self.keyboard.each_ref().map(Vec::len)) {
            if depth > 0 {
                left.push(format!("kitty keyboard pushed {depth} times on the {screen} screen"));
            }
        }
        for (screen, flags) in ["main", "alternate"].iter().zip(self.keyboard_flags) {
            if flags > 0 {
                left.push(format!("kitty keyboard flags {flags} set on the {screen} screen"));
            }
        }
        left.extend(self.others.iter().map(|&what| what.to_owned()));
        if self.torn {
            left.push("the bytes end inside an escape sequence or a character".to_owned());
        }
        left
    }

    fn set(&mut self, what: &'static str, on: bool) {
        if on {
            self.others.insert(what);
        } else {
            self.others.remove(what);
        }
    }

    /// Returns 0 on the main screen, 1 on the alternate one.
    fn screen(&self) -> usize {
        usize::from([47, 1047, 1049].iter().any(|&mode| self.is_on(mode)))
    }

    fn set_private(&mut self, params: &Params, on: bool) {
        for mode in params.iter().map(|param| param[0]) {
            if let 47 | 1047 | 1049 = mode {
                // These are three modes of one screen: resetting any of them leaves it.
                self.private.retain(|known, _| !matches!(known, 47 | 1047 | 1049));
            }
            self.private.insert(mode, on);
        }
    }

    fn keyboard(&mut self, mark: u8, params: &Params) {
        let screen = self.screen();
        let (pushed, base) = (&mut self.keyboard[screen], &mut self.keyboard_flags[screen]);
        let numbers: Vec<u16> = params.iter().map(|param| param[0]).collect();
        match mark {
            b'>' => pushed.push(numbers[0]),
            b'<' => {
                let count = usize::from(numbers[0].max(1));
                if count > pushed.len() {
                    // Popping more than was pushed resets all.
                    *base = 0;
                }
                pushed.truncate(pushed.len().saturating_sub(count));
            }
            b'=' => {
                let flags = pushed.last_mut().unwrap_or(base);
                *flags = match numbers.get(1) {
                    Some(2) => *flags | numbers[0],
                    Some(3) => *flags & !numbers[0],
                    _ => numbers[0],
                };
            }
            _ => {}
        }
    }

    fn draw_with(&mut self, params: &Params) {
        let mut params = params.iter();
        while let Some(param) = params.next() {
            match param {
                [0] => self.pen.clear(),
                // In this form the numbers of the colour follow as parameters of their own.
                [kind @ (38 | 48 | 58)] => {
                    match params.next() {
                        Some([2]) => params.by_ref().take(3).for_each(drop),
                        Some([5]) => params.by_ref().take(1).for_each(drop),
                        _ => {}
                    }
                    self.draw(*kind);
                }
                [4, 0] => self.draw(24),
                [number, ..] => self.draw(*number),
                [] => {}
            }
        }
    }

    fn draw(&mut self, number: u16) {
        let (what, on) = match number {
            1 | 2 => ("weight", true),
            22 => ("weight", false),
            3 | 20 => ("italic", true),
            23 => ("italic", false),
            4 | 21 => ("underline", true),
            24 => ("underline", false),
            5 | 6 => ("blink", true),
            25 => ("blink", false),
            7 => ("reverse", true),
            27 => ("reverse", false),
            8 => ("hidden", true),
            28 => ("hidden", false),
            9 => ("struck out", true),
            29 => ("struck out", false),
            30..=38 | 90..=97 => ("foreground", true),
            39 => ("foreground", false),
            40..=48 | 100..=107 => ("background", true),
            49 => ("background", false),
            53 => ("overline", true),
            55 => ("overline", false),
            58 => ("underline colour", true),
            59 => ("underline colour", false),
            _ => return,
        };
        if on {
            self.pen.insert(what, number);
        } else {
            self.pen.remove(what);
        }
    }

    /// Applies DECSTR, which resets neither the screen nor the mouse nor later extensions.
    fn soft_reset(&mut self) {
        for mode in [1, 6, 66] {
            self.private.remove(&mode);
        }
        self.private.insert(25, true);
        self.pen.clear();
        for what in [INSERT, KEYPAD, SCROLL_REGION, LINE_DRAWING] {
            self.set(what, false);
        }
    }
}

fn name(mode: u16) -> &'static str {
    NAMES.iter().find(|(number, _)| *number == mode).map_or("private mode", |(_, name)| name)
}

impl Perform for Modes {
    fn execute(&mut self, byte: u8) {
        match byte {
            0x0e => self.set(SHIFTED_OUT, true),
            0x0f => self.set(SHIFTED_OUT, false),
            _ => {}
        }
    }

    fn esc_dispatch(&mut self, marks: &[u8], _ignored: bool, last: u8) {
        match (marks, last) {
            (b"", b'c') => *self = Self::default(),
            (b"", b'=') => self.set(KEYPAD, true),
            (b"", b'>') => self.set(KEYPAD, false),
            (b"(", b'B') => self.set(LINE_DRAWING, false),
            (b"(", _) => self.set(LINE_DRAWING, true),
            _ => {}
        }
    }

    fn osc_dispatch(&mut self, params: &[&[u8]], _bell: bool) {
        if let [b"8", _, target, ..] = params {
            self.set(LINK, !target.is_empty());
        }
    }

    fn csi_dispatch(&mut self, params: &Params, marks: &[u8], ignored: bool, last: char) {
        let first = params.iter().next().map_or(0, |param| param[0]);
        match (marks, last) {
            _ if ignored => {}
            (b"?", 'h') => self.set_private(params, true),
            (b"?", 'l') => self.set_private(params, false),
            (b"", 'h' | 'l') if first == 4 => self.set(INSERT, last == 'h'),
            (b"", 'm') => self.draw_with(params),
            (b">", 'm') if first == 4 => {
                self.set(OTHER_KEYS, params.iter().nth(1).is_some_and(|param| param[0] != 0));
            }
            (&[mark], 'u') => self.keyboard(mark, params),
            (b"", 'r') => self.set(SCROLL_REGION, params.iter().any(|param| param[0] != 0)),
            (b" ", 'q') => self.set(CURSOR_SHAPE, first != 0),
            (b"!", 'p') => self.soft_reset(),
            _ => {}
        }
    }
}

/// Returns whether a sequence or a character was broken off by the next byte.
///
/// A terminal forgives it, but it was torn.
fn is_cut(bytes: &[u8]) -> bool {
    let broken_character = std::str::from_utf8(bytes).is_err_and(|error| error.error_len().is_some());
    let mut place = Place::Ground;
    let cut = bytes.iter().any(|&byte| match place.after(byte) {
        Some(next) => {
            place = next;
            false
        }
        None => true,
    });
    broken_character || cut
}

/// The state of a parser before a byte: outside of any sequence, or inside a kind of sequence.
#[derive(Clone, Copy)]
enum Place {
    Ground,
    Escape,
    Csi,
    Text,
    TextEscape,
}

impl Place {
    /// Returns the state after `byte`, or `None` where the byte is not allowed.
    fn after(self, byte: u8) -> Option<Self> {
        match (self, byte) {
            (Self::Ground, 0x1b) | (Self::Escape, 0x20..=0x2f) => Some(Self::Escape),
            (Self::Escape, b'[') | (Self::Csi, 0x20..=0x3f) => Some(Self::Csi),
            (Self::Escape, b']' | b'P' | b'X' | b'^' | b'_') => Some(Self::Text),
            (Self::Text, 0x1b) => Some(Self::TextEscape),
            (Self::Ground, _)
            | (Self::Escape, 0x30..=0x7e)
            | (Self::Csi, 0x40..=0x7e)
            | (Self::Text, 0x07)
            | (Self::TextEscape, b'\\') => Some(Self::Ground),
            (Self::Text, _) => Some(Self::Text),
            (Self::Escape | Self::Csi | Self::TextEscape, _) => None,
        }
    }
}

/// A listener that receives printed characters only.
#[derive(Default)]
struct Probe {
    heard: Vec<char>,
}

impl Perform for Probe {
    fn print(&mut self, c: char) {
        self.heard.push(c);
    }
}
