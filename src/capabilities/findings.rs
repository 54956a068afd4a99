//! The properties of a terminal, combined from all sources: user, environment, window and replies.

use super::detection::{colorterm, is_utf8, locale, refused_or_forced};
use super::shifts::shifts;
use super::{CELL_ASPECT_RANGE, USUAL_CELL_ASPECT, colors, glyphs};
use super::{
    Capabilities, CellMode, Clues, ColorChoice, Colors, Detected, GlyphChoice, Glyphs, Replies, Shifts, Source,
};
use crate::grid::{CellShape, HalfBlocks};

/// The user's choices and environment variables, stored so that detection can be repeated when
/// replies arrive.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hints {
    /// The user's choice of colours.
    pub color: ColorChoice,
    /// The user's choice of glyphs.
    pub glyphs: GlyphChoice,
    /// The cell aspect, if the user gives it. A value outside [`CELL_ASPECT_RANGE`] is ignored.
    pub cell_aspect: Option<f32>,
    /// Whether the default background is light, if the user says so.
    pub light_background: Option<bool>,
    /// Whether the user refuses shifts of shown cells.
    pub refuses_shifts: bool,
    variables: Vec<(&'static str, String)>,
    terminfo: Option<Colors>,
}

/// The environment variables that detection reads.
pub const VARIABLES: [&str; 10] =
    ["TERM", "COLORTERM", "NO_COLOR", "CLICOLOR_FORCE", "FORCE_COLOR", "LC_ALL", "LC_CTYPE", "LANG", "TMUX", "STY"];

/// The set of queries that a terminal tolerates: they neither print garbage nor confuse a
/// multiplexer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeQueries {
    /// No queries: the terminal is dumb, or of a kind that may print unknown sequences.
    None,
    /// Queries of the cursor position, which the Linux console has always supported.
    Console,
    /// Queries that GNU screen answers itself.
    // GNU screen passes device control strings on to the outer terminal, which may print them.
    Screen,
    /// Queries that tmux answers itself: all except those about cell size and colours.
    Tmux,
    /// All queries that the program sends.
    All,
}

impl Hints {
    /// Returns hints from the environment alone, without choices of the user. `variable` returns an
    /// environment variable, `terminfo` the colours of a terminal name.
    pub fn gather(variable: &dyn Fn(&str) -> Option<String>, terminfo: &dyn Fn(&str) -> Option<Colors>) -> Self {
        let variables: Vec<_> = VARIABLES.into_iter().filter_map(|name| Some((name, variable(name)?))).collect();
        let mut hints = Self { variables, ..Self::default() };
        // If COLORTERM decides the colours, terminfo is not read: its 650 system calls took 0.45 of the 3.4 ms from
        // exec to the first query.
        if hints.with_clues(None, colorterm).is_none() {
            hints.terminfo = hints.variable("TERM").and_then(terminfo);
        }
        hints
    }

    /// Returns hints in which the user has chosen the colours and glyphs of `mode`, so that neither
    /// is detected.
    pub fn exactly(mode: CellMode) -> Self {
        Self { color: ColorChoice::Exactly(mode.colors), glyphs: Some(mode.glyphs), ..Self::default() }
    }

    /// Returns the value of one of [`VARIABLES`], if it is set and not empty.
    pub fn variable(&self, name: &str) -> Option<&str> {
        self.raw_variable(name).filter(|value| !value.is_empty())
    }

    /// Returns the environment variable that sets the locale, and the locale; `None` if none is
    /// set.
    pub fn locale(&self) -> Option<(&'static str, String)> {
        self.with_clues(None, locale)
    }

    /// Sets the user's choice of glyphs, and returns the choice before.
    #[cfg(feature = "live")]
    pub(crate) fn choose_glyphs(&mut self, choice: GlyphChoice) -> GlyphChoice {
        std::mem::replace(&mut self.glyphs, choice)
    }

    /// Returns whether the locale can encode the glyphs; without a locale, UTF-8 is assumed.
    pub fn can_encode(&self, glyphs: Glyphs) -> bool {
        !glyphs.has_blocks() || self.locale().is_none_or(|(_, locale)| is_utf8(&locale))
    }

    /// Returns the variable that requests or refuses colours, if one is set.
    ///
    /// The candidates are `NO_COLOR`, `CLICOLOR_FORCE` and `FORCE_COLOR`.
    pub fn color_variable(&self) -> Option<&'static str> {
        match self.with_clues(None, refused_or_forced)?.source {
            Source::Variable(name) => Some(name),
            _ => None,
        }
    }

    fn raw_variable(&self, name: &str) -> Option<&str> {
        self.variables.iter().find(|(known, _)| *known == name).map(|(_, value)| value.as_str())
    }

    /// Returns the detected colours for a given reply about truecolor.
    fn colors(&self, truecolor_reply: Option<bool>) -> Detected<Colors> {
        self.with_clues(truecolor_reply, |clues| colors(self.color, clues))
    }

    fn with_clues<T>(&self, truecolor_reply: Option<bool>, evaluate: impl FnOnce(&Clues<'_>) -> T) -> T {
        let variable = |name: &str| self.raw_variable(name).map(str::to_owned);
        evaluate(&Clues { variable: &variable, truecolor_reply, terminfo: &|_| self.terminfo })
    }

    /// Returns the queries that the terminal tolerates.
    pub fn safe_queries(&self) -> SafeQueries {
        let Some(term) = self.variable("TERM") else { return SafeQueries::None };
        // Within tmux and screen `TERM` may have any value, so that their own variables are looked at as well.
        let begins = |names: &[&str]| names.iter().any(|name| term.starts_with(name));
        if begins(&["dumb", "unknown", "vt", "ansi", "eterm", "emacs", "cons", "sun"]) {
            SafeQueries::None
        } else if self.variable("TMUX").is_some() || begins(&["tmux"]) {
            SafeQueries::Tmux
        } else if self.variable("STY").is_some() || begins(&["screen"]) {
            SafeQueries::Screen
        } else if begins(&["linux"]) {
            SafeQueries::Console
        } else {
            SafeQueries::All
        }
    }

    /// Returns whether a reply that confirms truecolor would change the detected colours.
    // Returns false if the user wants no colours: no sequence about colours is sent then, not even a query.
    pub fn needs_truecolor_reply(&self) -> bool {
        self.colors(Some(true)).value != self.colors(None).value
    }

    /// Returns whether `colors` are 256 by detection alone: the terminal may have truecolor.
    pub fn suspects_truecolor(&self, colors: Colors) -> bool {
        let is_chosen = self.color != ColorChoice::Auto || self.color_variable().is_some();
        colors == Colors::Indexed256 && !is_chosen
    }

    /// Returns whether colours would be used if the terminal confirmed truecolor.
    pub fn allows_color(&self) -> bool {
        self.colors(Some(true)).value != Colors::None
    }

    /// Returns whether the terminal's name is needed, which decides the glyphs of resting pictures.
    pub fn needs_name_reply(&self) -> bool {
        let colors = self.colors(None);
        self.glyphs.is_none() && colors.value == Colors::Truecolor && self.needs_block_width_reply()
    }

    /// Returns whether the values of the sixteen palette colours are needed.
    pub fn needs_palette_reply(&self) -> bool {
        matches!(self.colors(None).value, Colors::Indexed16(_))
    }

    /// Returns whether the terminal may shift cells, for which its name or type is needed.
    pub fn may_shift(&self) -> bool {
        self.allows_color() && !self.refuses_shifts
    }

    /// Returns whether the width of block characters is needed.
    pub fn needs_block_width_reply(&self) -> bool {
        self.glyphs.is_none()
            && self.with_clues(None, |clues| glyphs(None, colors(self.color, clues), clues)).value == Glyphs::Half
    }
}

/// The detected properties of a terminal, each with its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Findings {
    /// The colours.
    pub colors: Detected<Colors>,
    /// The glyphs.
    pub glyphs: Detected<Glyphs>,
    /// The finer glyphs for a picture at rest, if there are any.
    pub resting_glyphs: Option<Glyphs>,
    /// The cell aspect.
    pub cell_aspect: Detected<f32>,
    /// The half blocks that cells may use.
    pub half_blocks: Detected<HalfBlocks>,
    /// Whether the default background is light.
    pub light_background: Detected<bool>,
    /// Whether the terminal supports synchronized output.
    pub synchronized_output: Detected<bool>,
    /// Whether and how the terminal shifts shown cells.
    pub shifts: Detected<Shifts>,
    /// Whether the terminal supports the kitty keyboard protocol.
    pub kitty_keyboard: Detected<bool>,
    /// Whether the terminal supports SGR mouse reports.
    pub sgr_mouse: Detected<bool>,
    /// Whether the terminal supports mouse reports in pixels.
    pub pixel_mouse: Detected<bool>,
}

impl Findings {
    /// Combines the user's choices, the environment, the window and the replies.
    pub fn new(hints: &Hints, window: CellShape, replies: &Replies) -> Self {
        let colors = with_replied_palette(hints.colors(replies.supports_truecolor()), replies);
        let answered = |answer: Option<bool>| detected_or(answer, Source::Reply, false);
        let of_window = |value| Detected { value, source: Source::Window };
        let cell_aspect = hints
            .cell_aspect
            .filter(|aspect| CELL_ASPECT_RANGE.contains(aspect))
            .map(|value| Detected { value, source: Source::User });
        let by_pixels = window.aspect.map(of_window);
        let glyphs = with_replied_width(hints.with_clues(None, |clues| glyphs(hints.glyphs, colors, clues)), replies);
        // The user's choice stays, and few colours are mixed in half blocks only.
        let has_finer = glyphs.value == Glyphs::Half
            && glyphs.source != Source::User
            && colors.value == Colors::Truecolor
            && replies.is_known_for_block_parts;
        Self {
            colors,
            glyphs,
            resting_glyphs: has_finer.then_some(Glyphs::Blocks),
            cell_aspect: cell_aspect
                .or(by_pixels)
                .unwrap_or_else(|| detected_or(replied_aspect(replies), Source::Reply, USUAL_CELL_ASPECT)),
            // The window's size, if reported, is preferred because it is current, whereas the reply was received at the
            // start.
            half_blocks: if window.aspect.is_some() {
                Detected { value: window.half_blocks, source: Source::Window }
            } else {
                let replied = replies.cell_pixels.map(|(_, height)| HalfBlocks::of_cell_height(height));
                detected_or(replied, Source::Reply, HalfBlocks::Lower)
            },
            light_background: hints
                .light_background
                .map_or_else(|| answered(replies.light_background()), |value| Detected { value, source: Source::User }),
            synchronized_output: answered(replies.synchronized_output),
            shifts: shifts(hints, replies),
            kitty_keyboard: answered(replies.kitty_keyboard),
            sgr_mouse: answered(replies.sgr_mouse),
            pixel_mouse: answered(replies.pixel_mouse),
        }
    }

    /// Returns the capabilities that the picture depends on.
    pub fn capabilities(&self) -> Capabilities {
        Capabilities {
            cell_mode: CellMode { glyphs: self.glyphs.value, colors: self.colors.value },
            resting_glyphs: self.resting_glyphs,
            cell_aspect: self.cell_aspect.value,
            half_blocks: self.half_blocks.value,
            light_background: self.light_background.value,
            synchronized_output: self.synchronized_output.value,
            shifts: self.shifts.value,
        }
    }
}

fn detected_or<T>(answer: Option<T>, source: Source, otherwise: T) -> Detected<T> {
    match answer {
        Some(value) => Detected { value, source },
        None => Detected { value: otherwise, source: Source::Assumed },
    }
}

/// Replaces the assumed values of the sixteen colours by those that the terminal reported.
fn with_replied_palette(mut found: Detected<Colors>, replies: &Replies) -> Detected<Colors> {
    if let Colors::Indexed16(values) = &mut found.value {
        for (value, answer) in values.iter_mut().zip(replies.sixteen) {
            *value = answer.unwrap_or(*value);
        }
    }
    found
}

/// Replaces half blocks by spaces if the terminal shows them wider than one column, unless the user
/// chose them.
// In some East Asian locales blocks are two columns wide; a terminal without UTF-8 shows three characters for one.
fn with_replied_width(glyphs: Detected<Glyphs>, replies: &Replies) -> Detected<Glyphs> {
    let is_broken = glyphs.value == Glyphs::Half && replies.block_width.is_some_and(|width| width != 1);
    if is_broken && glyphs.source != Source::User {
        return Detected { value: Glyphs::Spaces, source: Source::Reply };
    }
    glyphs
}

fn replied_aspect(replies: &Replies) -> Option<f32> {
    let (width, height) = replies.cell_pixels?;
    super::cell_aspect(1, 1, width, height)
}

#[cfg(all(test, unit_tests))]
mod tests;
