//! The pen (a terminal's current colours and attributes), and the SGR sequences that change it.

use super::numbers::{channel_digit_count, digit_count, write_channels, write_number};
use crate::grid::{Attributes, Grid, Ink, PackedCell, PackedInk};
use std::mem;

/// The colours and attributes with which the terminal would write the next character.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pen {
    pub(super) fg: PackedInk,
    pub(super) bg: PackedInk,
    pub(super) underline: PackedInk,
    pub(super) attributes: Attributes,
}

impl Pen {
    /// Appends a reset to the default colours, even if the pen already has them.
    pub(crate) fn reset(&mut self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(b"\x1b[0m");
        *self = Self::default();
    }

    /// Appends a cell for an exported file: the sequences that change the pen, and the glyph.
    // Colours are always in the long form, so that savings for the screen do not change the bytes of exported files.
    pub(crate) fn write_cell(&mut self, grid: &Grid, cell: PackedCell, bytes: &mut Vec<u8>) {
        let wanted = self.plain_pen_for(cell);
        self.write_sgr(Self { fg: self.after_attributes(wanted.attributes).fg, ..wanted }, InkForm::Long, bytes);
        self.write_sgr(wanted, InkForm::Long, bytes);
        write_glyph(grid, cell, bytes);
    }

    /// Returns the cheapest pen with which to write a cell.
    // A space whose background is the pen's glyph colour is cheapest in reverse video: SGR 7 takes four bytes, setting
    // the background about nineteen. The result is the same, pixel by pixel, in xterm, kitty, alacritty, st and foot.
    #[inline]
    pub(super) fn pen_for(&self, cell: PackedCell) -> Self {
        // The common case first: nearly every cell of a picture is a block without attributes.
        if !cell.has_char(' ') && cell.attributes().is_empty() && self.attributes.is_empty() {
            return Self { fg: cell.fg, bg: cell.bg, ..*self };
        }
        self.pen_for_any(cell)
    }

    /// Returns the cheapest pen for any cell, with or without reverse video.
    // Separate from `pen_for`, so that only the test of the common case is inlined.
    fn pen_for_any(&self, cell: PackedCell) -> Self {
        if self.can_show_reversed(cell) { self.cheaper_pen_for_space(cell) } else { self.plain_pen_for(cell) }
    }

    /// Returns the cheaper of two pens for a space: plain, or in reverse video.
    fn cheaper_pen_for_space(&self, cell: PackedCell) -> Self {
        let plain = self.plain_pen_for(cell);
        let exchanged = Self { attributes: Attributes::REVERSED, ..*self };
        if self.switch_cost(&exchanged) < self.switch_cost(&plain) { exchanged } else { plain }
    }

    /// Returns whether a space in reverse video, in the pen's colours, looks like the cell.
    // The default glyph colour and the default background have the same value, but are different colours.
    fn can_show_reversed(&self, cell: PackedCell) -> bool {
        is_plain_space(cell)
            && self.fg == cell.bg
            && cell.bg != PackedInk::DEFAULT
            && Attributes::REVERSED.contains(self.attributes)
    }

    /// Returns the pen for a cell without reverse video.
    // Invisible colours keep the pen's value, which costs nothing: the glyph colour of a space, the colour of a missing
    // underline.
    fn plain_pen_for(&self, cell: PackedCell) -> Self {
        let mut pen = self.after_attributes(cell.attributes());
        pen.bg = cell.bg;
        if !is_plain_space(cell) {
            pen.fg = cell.fg;
        }
        if is_underlined(cell) {
            pen.underline = cell.underline;
        }
        pen
    }

    /// Returns the pen after its attributes are changed to `attributes`, before its colours are
    /// changed.
    // Adding attributes keeps the colours. Removing one resets everything first, colours included, because terminals
    // disagree on the codes that switch single attributes off. Only the code that ends reverse video (27) is known to
    // all.
    pub(super) fn after_attributes(self, attributes: Attributes) -> Self {
        let from = if self.needs_reset(attributes) { Self::default() } else { self };
        Self { attributes, ..from }
    }

    /// Returns whether a switch from the pen's attributes to `attributes` needs a reset.
    ///
    /// It does if an attribute is removed, or if one is added that acts differently without a reset before it.
    // In many terminals bold brightens one of the first eight colours if it was set by its short code (see
    // [`ink_len`]). Some treat bold and dim, or the two speeds of blinking, as one attribute, for which the last code
    // counts.
    fn needs_reset(&self, attributes: Attributes) -> bool {
        let (lost, gained) = (self.attributes.difference(attributes), attributes.difference(self.attributes));
        let comes_before = |first, second| gained.contains(first) && self.attributes.contains(second);
        !Attributes::REVERSED.contains(lost)
            || (gained.contains(Attributes::BOLD) && has_short_form(self.fg))
            || comes_before(Attributes::BOLD, Attributes::DIM)
            || comes_before(Attributes::SLOW_BLINK, Attributes::RAPID_BLINK)
    }

    /// Returns the SGR parameters of a switch from the pen's attributes to `attributes`.
    fn attribute_codes(&self, attributes: Attributes) -> impl Iterator<Item = &'static [u8]> {
        let needs_reset = self.needs_reset(attributes);
        let from = if needs_reset { Attributes::empty() } else { self.attributes };
        let off: Option<&[u8]> = match needs_reset {
            true => Some(b"0"),
            false if from.difference(attributes).is_empty() => None,
            false => Some(b"27"),
        };
        off.into_iter().chain(codes_of(attributes.difference(from)))
    }

    /// Returns the number of bytes that [`switch_to`](Self::switch_to) appends.
    pub(super) fn switch_cost(&self, wanted: &Self) -> usize {
        self.switch_cost_with_lens(wanted, wanted.ink_lens())
    }

    /// Returns the number of bytes of a switch to `wanted`, whose [`ink_lens`](Self::ink_lens) are
    /// `lens`.
    // Computing the lengths once per cell instead of up to eight times takes a quarter of a frame's instructions away:
    // 1.52 million instead of 2.00 for 80x24 cells that all change.
    // Always inlined, as `cost_of_colors` is: the innermost step of the choice of half blocks.
    #[inline(always)]
    pub(super) fn switch_cost_with_lens(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        // The background is compared first: it is never the default in a picture, whose pens have no attributes.
        if wanted.bg == PackedInk::DEFAULT || self.attributes != wanted.attributes {
            return self.general_switch_cost(wanted, lens);
        }
        self.cost_of_colors(0, wanted, lens)
    }

    /// Returns the number of bytes of a switch to `wanted`, a pen of any background and attributes.
    fn general_switch_cost(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        if *wanted == Self::default() {
            return if self == wanted { 0 } else { SGR_RESET.len() };
        }
        if self.attributes == wanted.attributes {
            self.cost_of_colors(0, wanted, lens)
        } else {
            self.cost_with_attributes(wanted, lens)
        }
    }

    /// Returns the number of bytes that set the pen's glyph and background colours, each with its
    /// separator.
    #[inline]
    pub(super) fn ink_lens(&self) -> [usize; 2] {
        if self.fg.is_rgb() && self.bg.is_rgb() {
            return [self.fg, self.bg].map(|ink| rgb_parameters_len(ink.channels()));
        }
        let [fg, bg] = self.ink_forms(InkForm::Short);
        [1 + ink_len(self.fg, fg), 1 + ink_len(self.bg, bg)]
    }

    /// Returns the number of bytes of the codes that change the attributes, each with its
    /// separator.
    pub(super) fn attributes_len(&self, attributes: Attributes) -> usize {
        self.attribute_codes(attributes).map(|code| 1 + code.len()).sum()
    }

    /// Returns the number of bytes of a switch to `wanted` if the attributes change.
    fn cost_with_attributes(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        let codes = self.attributes_len(wanted.attributes);
        let split = if self.is_split(wanted, InkForm::Short) { 2 } else { 0 };
        self.after_attributes(wanted.attributes).cost_of_colors(codes, wanted, lens) + split
    }

    /// Returns the number of bytes that set attributes with `code` bytes and the colours of
    /// `wanted`.
    // Always inlined, as the innermost step of the choice of half blocks: two to four calls per cell.
    #[inline(always)]
    fn cost_of_colors(&self, code: usize, wanted: &Self, [fg, bg]: [usize; 2]) -> usize {
        let fg = if self.fg == wanted.fg { 0 } else { fg };
        let bg = if self.bg == wanted.bg { 0 } else { bg };
        let underline = if self.underline == wanted.underline { 0 } else { underline_len(wanted.underline) };
        let codes = code + fg + bg;
        underline + if codes == 0 { 0 } else { 2 + codes }
    }

    /// Switches to the pen `wanted`: appends a reset if that is the default pen, else sequences for
    /// the differences.
    ///
    /// The colour of underlines is set by a sequence of its own.
    pub(super) fn switch_to(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if *self != wanted && wanted == Self::default() {
            bytes.extend_from_slice(SGR_RESET);
            *self = wanted;
        } else {
            self.write_sgr(wanted, InkForm::Short, bytes);
        }
    }

    /// Appends the sequences that switch to the pen `wanted`, with the first eight colours in
    /// `form`.
    fn write_sgr(&mut self, wanted: Self, form: InkForm, bytes: &mut Vec<u8>) {
        // Nearly all cells of a picture share their attributes: without this test the encoder takes 6 % more
        // instructions.
        let mut is_open = self.attributes != wanted.attributes && self.write_attributes(&wanted, form, bytes);
        let from = self.after_attributes(wanted.attributes);
        let [fg, bg] = wanted.ink_forms(form);
        for (from, to, tens, form) in [(from.fg, wanted.fg, b'3', fg), (from.bg, wanted.bg, b'4', bg)] {
            if from != to {
                lead_in(mem::replace(&mut is_open, true), bytes);
                write_ink(to, tens, form, bytes);
            }
        }
        if is_open {
            bytes.push(b'm');
        }
        if from.underline != wanted.underline {
            write_underline(wanted.underline, bytes);
        }
        *self = wanted;
    }

    /// Appends the parameters of a change of attributes.
    ///
    /// Returns whether the sequence is open for more.
    fn write_attributes(&self, wanted: &Self, form: InkForm, bytes: &mut Vec<u8>) -> bool {
        let mut is_open = false;
        for code in self.attribute_codes(wanted.attributes) {
            lead_in(mem::replace(&mut is_open, true), bytes);
            bytes.extend_from_slice(code);
        }
        if self.is_split(wanted, form) {
            bytes.push(b'm');
            is_open = false;
        }
        is_open
    }

    /// Returns whether a switch to `wanted` needs a sequence for attributes and another for
    /// colours, because one would have too many parameters.
    fn is_split(&self, wanted: &Self, form: InkForm) -> bool {
        let from = self.after_attributes(wanted.attributes);
        let [fg, bg] = wanted.ink_forms(form);
        let numbers = |from: PackedInk, to: PackedInk, form| if from == to { 0 } else { ink_parameter_count(to, form) };
        let colors = numbers(from.fg, wanted.fg, fg) + numbers(from.bg, wanted.bg, bg);
        let attributes = self.attribute_codes(wanted.attributes).count();
        attributes > 0 && colors > 0 && attributes + colors > MAX_SGR_PARAMETERS
    }

    /// Returns the forms for the glyph's and the background's colour.
    // A bold glyph's colour needs the long form: in the short one many terminals would show it brighter.
    fn ink_forms(&self, form: InkForm) -> [InkForm; 2] {
        let fg = if self.attributes.contains(Attributes::BOLD) { InkForm::Long } else { form };
        [fg, form]
    }
}

/// The shortest reset of all attributes and colours.
const SGR_RESET: &[u8] = b"\x1b[m";

/// Largest number of parameters in an SGR sequence.
// Some terminals ignore parameters after the sixteenth.
const MAX_SGR_PARAMETERS: usize = 16;

/// The form of the SGR codes for one of the first eight indexed colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InkForm {
    /// The short form: 30 to 37, or 40 to 47.
    Short,
    /// The long form: `38;5;N` or `48;5;N`.
    Long,
}

/// Returns whether a colour is one of the first eight indexed colours, which have a short form.
fn has_short_form(ink: PackedInk) -> bool {
    matches!(ink.ink(), Ink::Indexed(..8))
}

/// Returns whether two cells look the same in every terminal.
pub(super) fn look_alike(a: PackedCell, b: PackedCell) -> bool {
    (a.bg, a.glyph_and_attributes()) == (b.bg, b.glyph_and_attributes())
        && (a.fg == b.fg || is_plain_space(a))
        && (a.underline == b.underline || !is_underlined(a))
}

/// Returns whether a cell is a space without attributes, so that only its background is visible.
pub(super) fn is_plain_space(cell: PackedCell) -> bool {
    cell.glyph_and_attributes() == u32::from(' ')
}

/// Returns whether the underline of a cell is visible.
fn is_underlined(cell: PackedCell) -> bool {
    cell.attributes().contains(Attributes::UNDERLINED)
}

/// Appends the glyph's characters in UTF-8.
#[inline]
pub(super) fn write_glyph(grid: &Grid, cell: PackedCell, bytes: &mut Vec<u8>) {
    match (cell.character(), grid.cluster(cell)) {
        (Some(character), _) => write_char(character, bytes),
        (None, Some(text)) => bytes.extend_from_slice(text.as_bytes()),
        (None, None) if cell.is_covered() => {}
        (None, None) => bytes.push(b' '),
    }
}

/// Appends the character in UTF-8.
#[inline]
pub(super) fn write_char(character: char, bytes: &mut Vec<u8>) {
    // The characters of pictures first: bytes whose number is known are copied without a call.
    match character {
        '▄' => bytes.extend_from_slice("▄".as_bytes()),
        '▀' => bytes.extend_from_slice("▀".as_bytes()),
        '\0'..='\x7f' => bytes.push(character as u8),
        _ => bytes.extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes()),
    }
}

/// Begins a sequence or, if one is open, its next parameter.
#[inline]
fn lead_in(is_open: bool, bytes: &mut Vec<u8>) {
    if is_open {
        bytes.push(b';');
    } else {
        bytes.extend_from_slice(b"\x1b[");
    }
}

/// Appends the SGR parameters of a colour. Their first digit is `tens`: 3 for glyphs, 4 for
/// backgrounds.
fn write_ink(ink: PackedInk, tens: u8, form: InkForm, bytes: &mut Vec<u8>) {
    match ink.ink() {
        Ink::Default => bytes.extend_from_slice(&[tens, b'9']),
        Ink::Indexed(index) if has_short_form(ink) && form == InkForm::Short => {
            bytes.extend_from_slice(&[tens, b'0' + index]);
        }
        Ink::Indexed(index) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'5', b';']);
            write_number(index.into(), bytes);
        }
        Ink::Rgb(_) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'2']);
            write_channels(ink.channels(), bytes);
        }
    }
}

/// Returns the number of bytes that [`write_ink`] appends.
// Colours 8 to 15 have no short form, because not every terminal that supports `38;5` supports 90 to 97.
fn ink_len(ink: PackedInk, form: InkForm) -> usize {
    match ink.ink() {
        Ink::Default => 2,
        Ink::Indexed(_) if has_short_form(ink) && form == InkForm::Short => 2,
        Ink::Indexed(index) => 5 + digit_count(index.into()),
        Ink::Rgb(_) => rgb_parameters_len(ink.channels()) - 1,
    }
}

/// Returns the number of bytes that set a colour in truecolor, with its separator.
#[inline]
pub(super) fn rgb_parameters_len(channels: [u8; 3]) -> usize {
    8 + channels.into_iter().map(channel_digit_count).sum::<usize>()
}

/// Returns the number of SGR parameters that [`write_ink`] appends.
fn ink_parameter_count(ink: PackedInk, form: InkForm) -> usize {
    match ink.ink() {
        Ink::Default => 1,
        Ink::Indexed(_) if has_short_form(ink) && form == InkForm::Short => 1,
        Ink::Indexed(_) => 3,
        Ink::Rgb(_) => 5,
    }
}

/// Appends the sequence that sets the colour of the underline.
// A separate sequence, with colons: a terminal without this colour ignores it, whereas it would read the parameters of
// `58;2` as other codes, such as 2 as dim.
fn write_underline(ink: PackedInk, bytes: &mut Vec<u8>) {
    match ink.ink() {
        Ink::Default => bytes.extend_from_slice(b"\x1b[59"),
        Ink::Indexed(index) => {
            bytes.extend_from_slice(b"\x1b[58:5:");
            write_number(index.into(), bytes);
        }
        Ink::Rgb(color) => {
            // The empty parameter between the colons is the colour space.
            bytes.extend_from_slice(b"\x1b[58:2:");
            for channel in [color.r, color.g, color.b] {
                bytes.push(b':');
                write_number(channel.into(), bytes);
            }
        }
    }
    bytes.push(b'm');
}

/// Returns the number of bytes that [`write_underline`] appends.
fn underline_len(ink: PackedInk) -> usize {
    match ink.ink() {
        Ink::Default => 5,
        Ink::Indexed(_) => 3 + ink_len(ink, InkForm::Long),
        Ink::Rgb(_) => 4 + ink_len(ink, InkForm::Long),
    }
}

/// Returns the SGR codes of the attributes in ascending order.
fn codes_of(attributes: Attributes) -> impl Iterator<Item = &'static [u8]> {
    const CODES: [(Attributes, &[u8]); 9] = [
        (Attributes::BOLD, b"1"),
        (Attributes::DIM, b"2"),
        (Attributes::ITALIC, b"3"),
        (Attributes::UNDERLINED, b"4"),
        (Attributes::SLOW_BLINK, b"5"),
        (Attributes::RAPID_BLINK, b"6"),
        (Attributes::REVERSED, b"7"),
        (Attributes::HIDDEN, b"8"),
        (Attributes::CROSSED_OUT, b"9"),
    ];
    CODES.into_iter().filter(move |&(flag, _)| attributes.contains(flag)).map(|(_, code)| code)
}

#[cfg(all(test, unit_tests))]
mod tests;
