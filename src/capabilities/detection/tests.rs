use super::ColorChoice::{Always, Auto, Exactly, Never};
use super::Colors::{Indexed256, None as NoColors, Truecolor};
use super::*;

const SIXTEEN: Colors = Colors::SIXTEEN;

/// Stands in for the terminfo database: returns the colours of a few terminal names.
fn terminfo(term: &str) -> Option<Colors> {
    match term {
        "xterm-256color" | "alacritty" => Some(Indexed256),
        "xterm-direct" => Some(Truecolor),
        "vt100" | "dumb" => Some(NoColors),
        _ => None,
    }
}

fn with_clues<T>(environment: &[(&str, &str)], reply: Option<bool>, ask: impl Fn(&Clues<'_>) -> T) -> T {
    let variable = |name: &str| environment.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned());
    ask(&Clues { variable: &variable, truecolor_reply: reply, terminfo: &terminfo })
}

#[test]
fn the_first_source_with_a_value_decides_the_colours() {
    let variable = Source::Variable;
    let xterm = ("TERM", "xterm-256color");
    let truecolor = ("COLORTERM", "truecolor");
    let dumb = ("TERM", "dumb");
    for (choice, environment, reply, value, source) in [
        // The user's flag decides.
        (Never, &[truecolor][..], Some(true), NoColors, Source::User),
        (Exactly(Indexed256), &[truecolor, ("NO_COLOR", "1")], None, Indexed256, Source::User),
        (Always, &[dumb, ("NO_COLOR", "1")], None, SIXTEEN, Source::User),
        (Always, &[xterm, ("NO_COLOR", "1")], None, Indexed256, Source::Terminfo),
        // NO_COLOR decides.
        (Auto, &[truecolor, ("NO_COLOR", "1"), ("FORCE_COLOR", "3")], None, NoColors, variable("NO_COLOR")),
        (Auto, &[truecolor, ("NO_COLOR", "")], None, Truecolor, variable("COLORTERM")),
        // CLICOLOR_FORCE and FORCE_COLOR set a minimum.
        (Auto, &[dumb, ("CLICOLOR_FORCE", "1")], None, SIXTEEN, variable("CLICOLOR_FORCE")),
        (Auto, &[dumb, ("CLICOLOR_FORCE", "0")], None, NoColors, Source::Terminfo),
        (Auto, &[xterm, ("CLICOLOR_FORCE", "1")], None, Indexed256, Source::Terminfo),
        (Auto, &[xterm, ("FORCE_COLOR", "3")], None, Truecolor, variable("FORCE_COLOR")),
        (Auto, &[dumb, ("FORCE_COLOR", "2")], None, Indexed256, variable("FORCE_COLOR")),
        (Auto, &[dumb, ("FORCE_COLOR", "")], None, SIXTEEN, variable("FORCE_COLOR")),
        (Auto, &[dumb, ("FORCE_COLOR", "true")], None, SIXTEEN, variable("FORCE_COLOR")),
        (Auto, &[truecolor, ("FORCE_COLOR", "0")], None, NoColors, variable("FORCE_COLOR")),
        // COLORTERM decides.
        (Auto, &[xterm, truecolor], None, Truecolor, variable("COLORTERM")),
        (Auto, &[xterm, ("COLORTERM", "24bit")], None, Truecolor, variable("COLORTERM")),
        (Auto, &[xterm, ("COLORTERM", "rxvt")], None, Indexed256, Source::Terminfo),
        // The terminal's reply decides.
        (Auto, &[xterm], Some(true), Truecolor, Source::Reply),
        (Auto, &[xterm], Some(false), Indexed256, Source::Terminfo),
        // Terminfo decides.
        (Auto, &[("TERM", "xterm-direct")], None, Truecolor, Source::Terminfo),
        (Auto, &[("TERM", "vt100")], None, NoColors, Source::Terminfo),
        // A name in TERM that implies more colours than terminfo's number decides.
        (Auto, &[("TERM", "alacritty")], None, Truecolor, variable("TERM")),
        // The name in TERM decides.
        (Auto, &[("TERM", "st-256color")], None, Truecolor, variable("TERM")),
        (Auto, &[("TERM", "vt220")], None, NoColors, variable("TERM")),
        (Auto, &[("TERM", "xterm-kitty")], None, Truecolor, variable("TERM")),
        (Auto, &[("TERM", "linux")], None, SIXTEEN, variable("TERM")),
        (Auto, &[("TERM", "rxvt-16color")], None, SIXTEEN, variable("TERM")),
        (Auto, &[("TERM", "screen-256color")], None, Indexed256, variable("TERM")),
        (Auto, &[("TERM", "new-terminal")], None, Indexed256, variable("TERM")),
        (Auto, &[("TERM", "")], None, Indexed256, Source::Assumed),
        (Auto, &[], None, Indexed256, Source::Assumed),
    ] {
        let found = with_clues(environment, reply, |clues| colors(choice, clues));
        assert_eq!(found, Detected { value, source }, "{choice:?} {environment:?} {reply:?}");
    }
}

#[test]
fn half_blocks_need_colour_and_utf8() {
    use Glyphs::{Ascii, Half, Ramp, Spaces};
    let utf8 = ("LANG", "en_US.UTF-8");
    let variable = Source::Variable;
    for (choice, colors, environment, value, source) in [
        (None, Truecolor, &[utf8][..], Half, variable("LANG")),
        (None, SIXTEEN, &[utf8], Half, variable("LANG")),
        (None, NoColors, &[utf8], Ascii, Source::Terminfo),
        (None, Truecolor, &[], Half, Source::Assumed),
        (None, Truecolor, &[("LANG", "C.utf8")], Half, variable("LANG")),
        (None, Truecolor, &[("LANG", "C")], Spaces, variable("LANG")),
        (None, Truecolor, &[("LC_ALL", "POSIX"), utf8], Spaces, variable("LC_ALL")),
        (None, Truecolor, &[("LC_ALL", ""), utf8], Half, variable("LANG")),
        (None, Truecolor, &[("LC_CTYPE", "de_DE.ISO-8859-1"), utf8], Spaces, variable("LC_CTYPE")),
        (Some(Half), NoColors, &[("LC_ALL", "C")], Half, Source::User),
        (Some(Ramp), Truecolor, &[utf8], Ramp, Source::User),
    ] {
        let colors = Detected { value: colors, source: Source::Terminfo };
        let found = with_clues(environment, None, |clues| glyphs(choice, colors, clues));
        assert_eq!(found, Detected { value, source }, "{choice:?} {colors:?} {environment:?}");
    }
}
