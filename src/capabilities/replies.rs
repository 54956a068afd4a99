//! A terminal's replies to queries, as plain values.

use super::known_terminals::{
    attributes_imply_block_parts, attributes_imply_truecolor, name_implies_block_parts, name_implies_shifts,
    name_implies_truecolor,
};
use crate::color::{LinearRgb, Srgb8};

/// The replies received so far. A field is `None` or false until the terminal has replied.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Replies {
    /// Whether the terminal kept [`TEST_COLOR`] as the background colour (DECRQSS of SGR).
    pub truecolor: Option<bool>,
    /// Whether the terminal identified itself as one that supports truecolor (XTVERSION or DA2).
    pub is_known_for_truecolor: bool,
    /// Whether the terminal identified itself as one that shows parts of blocks well, by its name
    /// or DA2.
    pub is_known_for_block_parts: bool,
    /// Whether the name (XTVERSION) is that of a terminal that shifts cells.
    pub name_implies_shifts: Option<bool>,
    /// Whether the terminal's type (DA2) is that of a terminal that shifts cells.
    pub type_implies_shifts: bool,
    /// Whether the terminal supports synchronized output (DECRQM of mode 2026).
    pub synchronized_output: Option<bool>,
    /// Whether the terminal supports the kitty keyboard protocol.
    // Never `Some(false)`, because a terminal without the protocol does not reply.
    pub kitty_keyboard: Option<bool>,
    /// Whether the terminal supports SGR mouse reports (DECRQM of mode 1006).
    pub sgr_mouse: Option<bool>,
    /// Whether the terminal supports mouse reports in pixels (DECRQM of mode 1016).
    pub pixel_mouse: Option<bool>,
    /// A cell's width and height in pixels (`CSI 16 t`).
    pub cell_pixels: Option<(u16, u16)>,
    /// The colour of the background (OSC 11).
    pub background: Option<Srgb8>,
    /// The values of the first sixteen colours (OSC 4).
    pub sixteen: [Option<Srgb8>; 16],
    /// The width of a half block in columns, from a report of the cursor's position after printing
    /// one.
    pub block_width: Option<u16>,
}

/// The background colour that is set before the query of the current SGR attributes (DECRQSS).
// A colour that is not among the 256 of the palette, so that a terminal without truecolor replies with another one.
pub const TEST_COLOR: Srgb8 = Srgb8::new(1, 2, 3);

impl Replies {
    /// Records the state of a private mode as reported by DECRPM.
    pub fn take_mode(&mut self, mode: u16, state: u16) {
        // The states 1 to 3 (set, reset, permanently set) mean support; 0 is not recognised, 4 permanently reset.
        let known = Some(matches!(state, 1..=3));
        match mode {
            2026 => self.synchronized_output = known,
            1006 => self.sgr_mouse = known,
            1016 => self.pixel_mouse = known,
            _ => {}
        }
    }

    /// Records a colour from the contents of an OSC reply, such as `11;rgb:1e1e/1e1e/1e1e`.
    pub fn take_osc(&mut self, text: &[u8]) {
        let Ok(text) = std::str::from_utf8(text) else { return };
        if let Some(color) = text.strip_prefix("11;") {
            self.background = parse_color(color).or(self.background);
        } else if let Some((index, color)) = text.strip_prefix("4;").and_then(|rest| rest.split_once(';'))
            && let Some(slot) = index.parse().ok().and_then(|index: usize| self.sixteen.get_mut(index))
        {
            *slot = parse_color(color).or(*slot);
        }
    }

    /// Records what a device control string shows about colours, parts of blocks and shifts.
    ///
    /// The string is either the terminal's name, such as `>|kitty(0.26.5)`, or the reported SGR attributes, such as
    /// `1$r0;48:2::1:2:3m`. Attributes that contain [`TEST_COLOR`] show that 24-bit colours are kept.
    ///
    /// The string `0$r`, which rejects the query, records nothing.
    pub fn take_dcs(&mut self, text: &[u8]) {
        let Ok(text) = std::str::from_utf8(text) else { return };
        if let Some(name) = text.strip_prefix(">|") {
            self.is_known_for_truecolor |= name_implies_truecolor(name);
            self.is_known_for_block_parts |= name_implies_block_parts(name);
            self.name_implies_shifts = Some(name_implies_shifts(name));
        }
        let rendition = text.strip_prefix("1$r").and_then(|text| text.strip_suffix('m'));
        if let Some(rendition) = rendition {
            let Srgb8 { r, g, b } = TEST_COLOR;
            // Terminals separate numbers by semicolons or colons, and may insert an empty colour space, which is
            // skipped here.
            let numbers: Vec<u8> = rendition.split([';', ':']).filter_map(|number| number.parse().ok()).collect();
            self.truecolor = Some(numbers.windows(5).any(|numbers| numbers == [48, 2, r, g, b]));
        }
    }

    /// Records whether the terminal's type and version (DA2) imply truecolor, parts of blocks, or
    /// shifts of cells.
    pub fn take_secondary_attributes(&mut self, attributes: &[u16]) {
        let is_known = attributes_imply_truecolor(attributes);
        self.is_known_for_truecolor |= is_known;
        self.type_implies_shifts |= is_known;
        self.is_known_for_block_parts |= attributes_imply_block_parts(attributes);
    }

    /// Returns whether the terminal identified itself as one that shifts cells.
    // The name decides if there is one: a multiplexer may report the type of another terminal.
    pub fn is_known_for_shifts(&self) -> bool {
        self.name_implies_shifts.unwrap_or(self.type_implies_shifts)
    }

    /// Returns whether the terminal supports truecolor; `None` if no reply tells.
    // The name takes precedence over the reported SGR attributes, in which some terminals with truecolor report the
    // nearest palette colour.
    pub fn supports_truecolor(&self) -> Option<bool> {
        if self.is_known_for_truecolor { Some(true) } else { self.truecolor }
    }

    /// Records the width of a half block, given the cursor's column (from 1) after one is printed
    /// in the first column.
    pub fn take_cursor(&mut self, column: u16) {
        // A width of 0 is ignored: on a screen of one column the cursor cannot move past the block.
        self.block_width = column.checked_sub(1).filter(|&width| width > 0);
    }

    /// Returns whether the background is light; `None` if its colour is unknown.
    pub fn light_background(&self) -> Option<bool> {
        // The threshold is a luminance of 0.18: mid-grey, with a lightness L* of 50.
        self.background.map(|color| LinearRgb::from_srgb8(color).luminance() > 0.18)
    }
}

/// Parses X11's `rgb:R/G/B` or `rgba:R/G/B/A` (one to four hexadecimal digits each), or `#rrggbb`.
fn parse_color(text: &str) -> Option<Srgb8> {
    let [r, g, b] = if let Some(digits) = text.strip_prefix('#') {
        // `get`, because indexing would panic inside a character of several bytes.
        let pair = |at: usize| digits.get(at..at + 2).filter(|_| digits.len() == 6);
        [pair(0)?, pair(2)?, pair(4)?]
    } else {
        let channels = text.strip_prefix("rgb:").or_else(|| text.strip_prefix("rgba:"))?;
        let mut channels = channels.split('/');
        [channels.next()?, channels.next()?, channels.next()?]
    };
    Some(Srgb8::new(parse_channel(r)?, parse_channel(g)?, parse_channel(b)?))
}

/// Parses a channel of one to four hexadecimal digits, and scales it to 0..=255.
fn parse_channel(digits: &str) -> Option<u8> {
    let is_hex = matches!(digits.len(), 1..=4) && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| is_hex)?;
    let highest = (1 << (4 * digits.len())) - 1;
    u8::try_from((value * 255 + highest / 2) / highest).ok()
}

#[cfg(all(test, unit_tests))]
mod tests;
