use super::*;
use crate::color::Srgb8;
use std::cell::Cell;

fn hints(environment: &[(&str, &str)]) -> Hints {
    let variable = |name: &str| environment.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned());
    Hints::gather(&variable, &|term| (term == "xterm-256color").then_some(Colors::Indexed256))
}

const XTERM: &[(&str, &str)] = &[("TERM", "xterm-256color"), ("LANG", "en_US.UTF-8")];

#[test]
fn terminfo_is_read_only_without_a_decisive_colorterm() {
    for (colorterm, is_asked) in [("truecolor", false), ("24bit", false), ("rxvt", true), ("", true)] {
        let asked = Cell::new(false);
        let variable = |name: &str| match name {
            "TERM" => Some("xterm".to_owned()),
            "COLORTERM" => Some(colorterm.to_owned()),
            _ => None,
        };
        let hints = Hints::gather(&variable, &|_| {
            asked.set(true);
            Some(Colors::Indexed256)
        });
        assert_eq!((asked.get(), hints.terminfo.is_some()), (is_asked, is_asked), "{colorterm:?}");
    }
}

#[test]
fn only_tolerated_queries_are_sent() {
    for (environment, expected) in [
        (&[("TERM", "xterm-256color")][..], SafeQueries::All),
        (&[("TERM", "xterm-kitty")], SafeQueries::All),
        (&[("TERM", "new-terminal")], SafeQueries::All),
        (&[("TERM", "tmux-256color")], SafeQueries::Tmux),
        (&[("TERM", "screen-256color"), ("TMUX", "/tmp/t,1,0")], SafeQueries::Tmux),
        (&[("TERM", "xterm-256color"), ("TMUX", "/tmp/t,1,0")], SafeQueries::Tmux),
        (&[("TERM", "screen.xterm-256color")], SafeQueries::Screen),
        (&[("TERM", "xterm"), ("STY", "1.pts")], SafeQueries::Screen),
        (&[("TERM", "linux")], SafeQueries::Console),
        (&[("TERM", "dumb")], SafeQueries::None),
        (&[("TERM", "dumb"), ("TMUX", "/tmp/t,1,0")], SafeQueries::None),
        (&[("TERM", "vt100")], SafeQueries::None),
        (&[("TERM", "eterm-color")], SafeQueries::None),
        (&[("TERM", "")], SafeQueries::None),
        (&[], SafeQueries::None),
    ] {
        assert_eq!(hints(environment).safe_queries(), expected, "{environment:?}");
    }
}

#[test]
fn decided_values_are_not_queried() {
    for (environment, color, truecolor, sixteen, blocks) in [
        (XTERM, ColorChoice::Auto, true, false, true),
        (&[("TERM", "xterm-256color"), ("LANG", "C")], ColorChoice::Auto, true, false, false),
        (&[("TERM", "xterm-256color"), ("COLORTERM", "truecolor")], ColorChoice::Auto, false, false, true),
        (&[("TERM", "xterm-256color"), ("NO_COLOR", "1")], ColorChoice::Auto, false, false, false),
        (XTERM, ColorChoice::Never, false, false, false),
        (XTERM, ColorChoice::Exactly(Colors::SIXTEEN), false, true, true),
        (&[("TERM", "linux")], ColorChoice::Auto, true, true, true),
        (&[("TERM", "alacritty")], ColorChoice::Auto, false, false, true),
    ] {
        let hints = Hints { color, ..hints(environment) };
        let asked = (hints.needs_truecolor_reply(), hints.needs_palette_reply(), hints.needs_block_width_reply());
        assert_eq!(asked, (truecolor, sixteen, blocks), "{environment:?} {color:?}");
    }
}

#[test]
fn replies_replace_assumptions() {
    let replies = Replies { truecolor: Some(true), block_width: Some(1), ..Replies::default() };
    let before = Findings::new(&hints(XTERM), CellShape::default(), &Replies::default());
    assert_eq!(before.colors, Detected { value: Colors::Indexed256, source: Source::Terminfo });
    let after = Findings::new(&hints(XTERM), CellShape::default(), &replies);
    assert_eq!(after.colors, Detected { value: Colors::Truecolor, source: Source::Reply });
    assert_eq!(after.glyphs, Detected { value: Glyphs::Half, source: Source::Variable("LANG") });
}

#[test]
fn broken_blocks_are_not_used_unless_the_user_says_so() {
    for (choice, width, expected) in [
        (None, Some(1), Detected { value: Glyphs::Half, source: Source::Variable("LANG") }),
        (None, Some(2), Detected { value: Glyphs::Spaces, source: Source::Reply }),
        (None, Some(3), Detected { value: Glyphs::Spaces, source: Source::Reply }),
        (None, None, Detected { value: Glyphs::Half, source: Source::Variable("LANG") }),
        (Some(Glyphs::Half), Some(2), Detected { value: Glyphs::Half, source: Source::User }),
        (Some(Glyphs::Ramp), Some(2), Detected { value: Glyphs::Ramp, source: Source::User }),
    ] {
        let hints = Hints { glyphs: choice, ..hints(XTERM) };
        let replies = Replies { block_width: width, ..Replies::default() };
        let findings = Findings::new(&hints, CellShape::default(), &replies);
        assert_eq!(findings.glyphs, expected, "{choice:?} {width:?}");
    }
}

#[test]
fn the_cell_shape_is_the_users_then_the_windows_then_the_replied() {
    let window = CellShape { aspect: Some(1.9), half_blocks: HalfBlocks::Either };
    let nothing = CellShape::default();
    let (flag, by_window, reply) = (Source::User, Source::Window, Source::Reply);
    for (flagged, window, pixels, aspect, meet) in [
        (Some(2.5), window, Some((8, 17)), (2.5, flag), (true, by_window)),
        (None, window, Some((8, 17)), (1.9, by_window), (true, by_window)),
        (None, nothing, Some((8, 18)), (2.25, reply), (true, reply)),
        (None, nothing, Some((8, 17)), (2.125, reply), (false, reply)),
        (None, nothing, Some((0, 18)), (2.0, Source::Assumed), (true, reply)),
        (None, nothing, None, (2.0, Source::Assumed), (false, Source::Assumed)),
    ] {
        let hints = Hints { cell_aspect: flagged, ..hints(XTERM) };
        let replies = Replies { cell_pixels: pixels, ..Replies::default() };
        let Findings { cell_aspect, half_blocks, .. } = Findings::new(&hints, window, &replies);
        let may_mix = half_blocks.value == HalfBlocks::Either;
        let found = ((cell_aspect.value, cell_aspect.source), (may_mix, half_blocks.source));
        assert_eq!(found, (aspect, meet), "{flagged:?} {window:?} {pixels:?}");
    }
}

#[test]
fn sixteen_colours_have_the_reported_values() {
    let mut replies = Replies::default();
    replies.sixteen[3] = Some(Srgb8::new(1, 2, 3));
    let hints = hints(&[("TERM", "linux")]);
    let Colors::Indexed16(values) = Findings::new(&hints, CellShape::default(), &replies).colors.value else {
        panic!("sixteen colours");
    };
    assert_eq!((values[3], values[1]), (Srgb8::new(1, 2, 3), Srgb8::new(205, 0, 0)));
}

#[test]
fn only_confirmed_capabilities_are_reported() {
    let all = Replies {
        synchronized_output: Some(true),
        kitty_keyboard: Some(true),
        sgr_mouse: Some(true),
        pixel_mouse: Some(true),
        background: Some(Srgb8::new(255, 255, 255)),
        ..Replies::default()
    };
    for (replies, expected) in [
        (all, Detected { value: true, source: Source::Reply }),
        (Replies::default(), Detected { value: false, source: Source::Assumed }),
    ] {
        let f = Findings::new(&hints(XTERM), CellShape::default(), &replies);
        let found = [f.synchronized_output, f.kitty_keyboard, f.sgr_mouse, f.pixel_mouse, f.light_background];
        assert_eq!(found, [expected; 5]);
        let capabilities = f.capabilities();
        assert_eq!(capabilities.synchronized_output, expected.value);
        assert_eq!(capabilities.light_background, expected.value);
    }
}

#[test]
fn exact_hints_give_exactly_their_mode() {
    let findings = Findings::new(&Hints::exactly(CellMode::RAMP), CellShape::default(), &Replies::default());
    assert_eq!(findings.capabilities().cell_mode, CellMode::RAMP);
}
