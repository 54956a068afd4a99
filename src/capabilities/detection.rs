//! Detection of colours and glyphs: pure functions that return each value with its source.

use super::{ColorChoice, Colors, Glyphs};

/// A detected value and its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detected<T> {
    /// The detected value.
    pub value: T,
    /// The source that the value comes from.
    pub source: Source,
}

/// A source of values about a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The user, by a flag or a setting.
    User,
    /// The environment variable with this name.
    Variable(&'static str),
    /// The window: its size in cells and in pixels.
    Window,
    /// The terminal itself.
    Reply,
    /// The terminfo database.
    Terminfo,
    /// No source: a default that is right for nearly all terminals.
    Assumed,
}

/// The inputs of detection.
pub struct Clues<'a> {
    /// Returns the value of an environment variable.
    pub variable: &'a dyn Fn(&str) -> Option<String>,
    /// Whether the terminal supports truecolor, by its replies; `None` if no reply tells.
    pub truecolor_reply: Option<bool>,
    /// Returns the colours of a terminal name according to terminfo, if known.
    ///
    /// With the feature `live` this is `terminfo_colors`.
    pub terminfo: &'a dyn Fn(&str) -> Option<Colors>,
}

/// The user's choice of glyphs; `None` leaves it to detection.
pub type GlyphChoice = Option<Glyphs>;

/// Returns the colours to use.
///
/// The first source with a value decides: the user's choice; `NO_COLOR` or `FORCE_COLOR=0`; `COLORTERM`; the terminal's
/// replies; terminfo's truecolor flags; the name in `TERM`, if it implies truecolor; terminfo's number of colours; the
/// name. `CLICOLOR_FORCE`, other values of `FORCE_COLOR` and `--color=always` set a minimum.
// `COLORTERM` precedes the reply, because it is known before the first frame. The reply precedes terminfo, because many
// terminals with truecolor use the entry `xterm-256color`.
pub fn colors(choice: ColorChoice, clues: &Clues<'_>) -> Detected<Colors> {
    let least = match choice {
        ColorChoice::Never => return Detected { value: Colors::None, source: Source::User },
        ColorChoice::Exactly(value) => return Detected { value, source: Source::User },
        ColorChoice::Always => Some(Detected { value: Colors::SIXTEEN, source: Source::User }),
        ColorChoice::Auto => match refused_or_forced(clues) {
            Some(refused) if refused.value == Colors::None => return refused,
            forced => forced,
        },
    };
    let found = colorterm(clues).or_else(|| replied_truecolor(clues)).unwrap_or_else(|| colors_by_term(clues));
    least.filter(|least| least.value > found.value).unwrap_or(found)
}

/// Returns the glyphs to use: the user's choice, or else half blocks, spaces or ASCII.
///
/// Spaces are for locales that cannot encode half blocks, ASCII for terminals without colours.
pub fn glyphs(choice: GlyphChoice, colors: Detected<Colors>, clues: &Clues<'_>) -> Detected<Glyphs> {
    if let Some(value) = choice {
        return Detected { value, source: Source::User };
    }
    if colors.value == Colors::None {
        return Detected { value: Glyphs::Ascii, source: colors.source };
    }
    match locale(clues) {
        Some((name, locale)) => {
            let value = if is_utf8(&locale) { Glyphs::Half } else { Glyphs::Spaces };
            Detected { value, source: Source::Variable(name) }
        }
        // Without a locale, as in many containers and ssh sessions, UTF-8 is assumed, which all current terminals show.
        None => Detected { value: Glyphs::Half, source: Source::Assumed },
    }
}

/// Returns the variable's value, if it is set and not empty.
fn non_empty_variable(clues: &Clues<'_>, name: &str) -> Option<String> {
    (clues.variable)(name).filter(|value| !value.is_empty())
}

/// Returns the colours that `NO_COLOR`, `CLICOLOR_FORCE` or `FORCE_COLOR` requests.
///
/// [`Colors::None`] is final; other colours are a minimum.
pub(super) fn refused_or_forced(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    refused_by_variable(clues).or_else(|| forced_by_variable(clues))
}

/// Returns [`Colors::None`] if `NO_COLOR` is set and not empty, by the convention of no-color.org.
fn refused_by_variable(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    non_empty_variable(clues, "NO_COLOR")
        .map(|_| Detected { value: Colors::None, source: Source::Variable("NO_COLOR") })
}

/// Returns the colours that `CLICOLOR_FORCE` or `FORCE_COLOR` requests.
///
/// The first follows bixense.com/clicolors, where any value but 0 requests colour; the second follows Node, with levels
/// 0 to 3.
fn forced_by_variable(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    let found = |value, name| Some(Detected { value, source: Source::Variable(name) });
    if non_empty_variable(clues, "CLICOLOR_FORCE").is_some_and(|force| force != "0") {
        return found(Colors::SIXTEEN, "CLICOLOR_FORCE");
    }
    let value = match (clues.variable)("FORCE_COLOR")?.as_str() {
        "0" | "false" => Colors::None,
        "2" => Colors::Indexed256,
        "3" => Colors::Truecolor,
        _ => Colors::SIXTEEN,
    };
    found(value, "FORCE_COLOR")
}

/// Returns truecolor if `COLORTERM` is `truecolor` or `24bit`.
// Other values of `COLORTERM` announce colours, but not how many.
pub(super) fn colorterm(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    let colorterm = non_empty_variable(clues, "COLORTERM")?.to_ascii_lowercase();
    let is_truecolor = colorterm == "truecolor" || colorterm == "24bit";
    is_truecolor.then_some(Detected { value: Colors::Truecolor, source: Source::Variable("COLORTERM") })
}

/// Returns truecolor if the terminal's replies show that it supports truecolor.
// A terminal that did not keep the test colour may have any smaller number of colours, so other sources decide.
fn replied_truecolor(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    let kept = clues.truecolor_reply?;
    kept.then_some(Detected { value: Colors::Truecolor, source: Source::Reply })
}

/// Returns the colours by terminfo and the name in `TERM`.
// A name that implies truecolor precedes terminfo's number, which is 256 for such terminals (alacritty, st).
fn colors_by_term(clues: &Clues<'_>) -> Detected<Colors> {
    let (terminfo, name) = (colors_by_terminfo(clues), colors_by_name(clues));
    match terminfo {
        Some(terminfo) if terminfo.value == Colors::Truecolor || name.value != Colors::Truecolor => terminfo,
        _ => name,
    }
}

fn colors_by_terminfo(clues: &Clues<'_>) -> Option<Detected<Colors>> {
    let value = (clues.terminfo)(&non_empty_variable(clues, "TERM")?)?;
    Some(Detected { value, source: Source::Terminfo })
}

/// Returns the colours that the name in `TERM` implies.
// Unknown names imply 256 colours, which every emulator of the last twenty years has.
fn colors_by_name(clues: &Clues<'_>) -> Detected<Colors> {
    let Some(term) = non_empty_variable(clues, "TERM") else {
        return Detected { value: Colors::Indexed256, source: Source::Assumed };
    };
    let term = term.to_ascii_lowercase();
    let has = |parts: &[&str]| parts.iter().any(|part| term.contains(part));
    let value = if term == "dumb" || term.starts_with("vt") {
        Colors::None
    } else if term.starts_with("st-")
        || has(&["direct", "truecolor", "24bit", "kitty", "alacritty", "foot", "wezterm", "ghostty"])
    {
        Colors::Truecolor
    } else if term == "linux" || term == "ansi" || has(&["16color"]) {
        Colors::SIXTEEN
    } else {
        Colors::Indexed256
    };
    Detected { value, source: Source::Variable("TERM") }
}

/// Returns the environment variable that sets the locale's character set, and its value.
// The first of these variables that is set and not empty counts; their order is that of POSIX.
pub(super) fn locale(clues: &Clues<'_>) -> Option<(&'static str, String)> {
    ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(|name| Some((name, non_empty_variable(clues, name)?)))
}

pub(super) fn is_utf8(locale: &str) -> bool {
    let locale = locale.to_ascii_lowercase();
    locale.contains("utf-8") || locale.contains("utf8")
}

#[cfg(all(test, unit_tests))]
mod tests;
