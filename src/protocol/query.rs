//! Queries at the end of a frame, whose replies show that the terminal has processed the frame.
//!
//! Every terminal replies to [`FENCE`] (DA1), but these replies are all equal and can only be counted. A terminal that
//! replies to queries of unknown modes (DECRQM) repeats the mode's number. So the number of a mode that does not exist
//! serves as a sequence number, which shows whether a reply is lost, late, duplicated or meant for another program.
//!
//! The numbers have three digits: each digit costs one byte a frame, and no terminal is known to use a private mode
//! from 200 to 999. (More terminals report the cursor position, CPR. But a distinct position for each query takes a
//! cursor move, 10 to 14 bytes a frame instead of 8, and fails in a window of a single row, where the reply equals
//! Shift+F3.)

use std::ops::RangeInclusive;

/// The query that every terminal replies to (DA1).
pub const FENCE: &[u8] = b"\x1b[c";

/// Private mode numbers that no terminal uses.
// DEC's numbers end at 117, and those of xterm and compatible terminals start at 1000.
const NUMBERS: RangeInclusive<u16> = 200..=999;

/// A numbered query: DECRQM of a private mode that does not exist, whose reply repeats the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag(u16);

impl Tag {
    /// The tag that is part of the initial queries.
    ///
    /// A terminal that replies to this tag replies to all tags.
    pub const FIRST: Self = Self(*NUMBERS.start());

    /// Returns the next tag, which is never [`FIRST`](Self::FIRST).
    ///
    /// The 799 other tags repeat after 13 s at 60 frames a second.
    pub fn next(self) -> Self {
        Self(if self.0 < *NUMBERS.end() { self.0 + 1 } else { Self::FIRST.0 + 1 })
    }

    /// Returns the tag whose number is `mode`; `None` if the number is not that of a tag.
    pub fn of_mode(mode: u16) -> Option<Self> {
        NUMBERS.contains(&mode).then_some(Self(mode))
    }

    /// Returns the bytes of the tag's query.
    pub fn query(self) -> [u8; 8] {
        let [hundreds, tens, ones] = [self.0 / 100, self.0 / 10 % 10, self.0 % 10].map(|digit| b'0' + digit as u8);
        [0x1b, b'[', b'?', hundreds, tens, ones, b'$', b'p']
    }

    /// Returns the tag whose query is at the end of `bytes`, if there is one.
    pub(super) fn at_end_of(bytes: &[u8]) -> Option<Self> {
        let &[hundreds, tens, ones] = bytes.strip_suffix(b"$p")?.last_chunk()?;
        let digits = [hundreds, tens, ones].map(|digit| u16::from(digit.wrapping_sub(b'0')));
        let number = digits.iter().try_fold(0, |number, &digit| (digit < 10).then_some(10 * number + digit))?;
        Self::of_mode(number).filter(|tag| bytes.ends_with(&tag.query()))
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
