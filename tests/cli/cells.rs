//! `--color` and `--glyphs`: the kinds of cells without a terminal.

use super::{Folder, finish};

/// Returns the numbers after each 38;5 and 48;5, and whether other sequences of colours follow.
fn indices(ansi: &[u8]) -> (Vec<u8>, bool) {
    let text = String::from_utf8_lossy(ansi).into_owned();
    let mut others = false;
    let mut indices = Vec::new();
    for sequence in text.split("\x1b[").skip(1) {
        let sequence = sequence.split('m').next().expect("it ends");
        match sequence.strip_prefix("38;5;").or(sequence.strip_prefix("48;5;")) {
            Some(index) => indices.push(index.parse().expect("a number of 8 bits")),
            None => others |= sequence != "0",
        }
    }
    (indices, others)
}

#[test]
fn an_ansi_frame_has_the_chosen_colours() {
    let folder = Folder::new();
    let frame = |flags: &str| folder.frame(&format!("ball.ron --format ansi --size 20x8 {flags}"));
    for flags in ["", "--color auto", "--color always", "--color truecolor --glyphs half"] {
        assert!(frame(flags) == frame("--color=truecolor"), "{flags}");
    }
    for glyphs in ["auto", "half", "shape", "ramp", "blocks", "octants", "sextants", "braille"] {
        let (found, others) = indices(&frame(&format!("--color 256 --glyphs {glyphs}")));
        assert!(!found.is_empty() && found.iter().all(|&index| index >= 16) && !others, "{glyphs}");
        let (found, others) = indices(&frame(&format!("--color 16 --glyphs {glyphs}")));
        assert!(!found.is_empty() && found.iter().all(|&index| index < 16) && !others, "{glyphs}");
        let (found, others) = indices(&frame(&format!("--color truecolor --glyphs {glyphs}")));
        assert!(found.is_empty() && others, "{glyphs}");
        assert!(!frame(&format!("--color never --glyphs {glyphs}")).contains(&0x1b), "{glyphs}: an escape");
    }
}

#[test]
fn a_text_frame_has_outlines_unless_asked() {
    let folder = Folder::new();
    let frame = |flags: &str| String::from_utf8(folder.frame(&format!("ball.ron --size 20x8 {flags}"))).expect("text");
    let ascii = frame("");
    assert!(ascii.contains('|') && ascii.contains('@'), "{ascii}");
    for flags in ["--color auto", "--color never", "--glyphs auto", "--glyphs ascii", "--format ansi --color never"] {
        assert_eq!(frame(flags), ascii, "{flags}");
    }
    let ramp = frame("--glyphs ramp");
    assert!(ramp.chars().all(|c| " .-:*+=%#@\n".contains(c)));
    let shape = frame("--glyphs shape");
    assert!(shape.is_ascii() && shape != ramp && shape != ascii);
    let half = frame("--glyphs half");
    assert!(half.chars().all(|c| " ▀▄█\n".contains(c)) && half.contains('▄'));
    for text in [shape, half] {
        assert!(text.lines().count() == 8 && text.lines().all(|line| line.chars().count() == 20));
    }
}

#[test]
fn the_background_decides_which_parts_are_dense() {
    let folder = Folder::new();
    let frame = |flags: &str| folder.frame(&format!("ball.ron --size 40x12 {flags}"));
    for glyphs in ["ascii", "ramp", "shape"] {
        let dark = frame(&format!("--glyphs {glyphs} --background dark"));
        assert!(
            dark == frame(&format!("--glyphs {glyphs}"))
                && dark == frame(&format!("--glyphs {glyphs} --background auto"))
        );
        assert!(dark != frame(&format!("--glyphs {glyphs} --background light")), "{glyphs}");
    }
    let printed = folder.run("ball.ron --background light").done();
    assert!(printed == folder.frame("ball.ron --background light"));
    folder.run("frame ball.ron -o ball.png --background light").fails_in_a_line(2, "a PNG consists of pixels");
    folder.run("frame ball.ron --background grey").is_misused("auto, light, dark");
}

#[test]
fn goldens_are_of_any_kind() {
    let folder = Folder::new();
    for (name, flags) in
        [("a.txt", "--glyphs shape"), ("b.ansi", "--color 256"), ("c.ansi", "--color 16 --glyphs shape")]
    {
        folder.run(&format!("frame ball.ron --check {name} --bless {flags}")).done();
        folder.run(&format!("frame ball.ron --check {name} {flags}")).done();
        assert_eq!(folder.run(&format!("frame ball.ron --check {name}")).code, Some(1), "{name} is of no other kind");
    }
}

/// Checks that a golden of the former default, a ramp with other steps, says how to go on.
#[test]
fn an_older_golden_names_the_glyphs_that_it_needs() {
    let folder = Folder::new();
    let said = |flags: &str| folder.run(&format!("frame ball.ron --check a.txt {flags}"));
    let differs = |flags: &str, hint: &str| {
        let said = said(flags);
        assert_eq!(said.code, Some(1));
        let diff = String::from_utf8(said.stdout).expect("text");
        assert!(diff.ends_with(&format!("{hint}\n")), "{flags}: {diff}");
    };
    for kind in ["shape", "half", "ramp"] {
        said(&format!("--bless --glyphs {kind}")).done();
        differs("", &format!("the golden frame has the characters of --glyphs {kind}: compare it with that flag"));
    }
    let now = String::from_utf8(folder.read("a.txt")).expect("text");
    // The steps were higher by 2 of 10, so that a character was at the same place in the ramp or at the one before.
    let places = now.chars().map(|c| " .-:*+=%#@".find(c));
    let before = |step: fn(usize, usize) -> usize| -> String {
        let of_before = |(k, at)| char::from(b" .:-=+*#%@"[step(k, at)]);
        (0..).zip(places.clone()).map(|(k, at)| at.map_or('\n', |at| of_before((k, at)))).collect()
    };
    folder.write("a.txt", before(|k, at| at.saturating_sub(k % 2)));
    differs("", "the golden frame has the characters of --glyphs ramp: compare it with that flag");
    let hint = "it seems that only the ramp's characters have changed; --bless writes the frame anew";
    differs("--glyphs ramp", hint);
    let others: [fn(usize, usize) -> usize; 2] = [|k, at| at.saturating_sub(k % 3), |k, at| (at + k % 2).min(9)];
    for other in others {
        folder.write("a.txt", before(other));
        let said = said("--glyphs ramp");
        assert_eq!(said.code, Some(1));
        let diff = String::from_utf8(said.stdout).expect("text");
        assert!(!diff.contains(hint), "another picture: {diff}");
    }
    said("--bless --glyphs ramp").done();
    said("--glyphs ramp").done();
}

#[test]
fn frames_do_not_depend_on_the_environment() {
    let folder = Folder::new();
    for flags in ["", "--format ansi", "--format ansi --color always", "--glyphs auto", "--format ansi --color auto"] {
        let expected = folder.frame(&format!("ball.ron --size 20x8 {flags}"));
        for environment in [
            [("TERM", "xterm-256color"), ("COLORTERM", ""), ("LC_ALL", "C.UTF-8")],
            [("TERM", "dumb"), ("NO_COLOR", "1"), ("LC_ALL", "C")],
            [("TERM", "linux"), ("FORCE_COLOR", "3"), ("CLICOLOR_FORCE", "1")],
        ] {
            let mut command = folder.command(&format!("frame ball.ron --size 20x8 {flags}"));
            command.env_clear().envs(environment);
            assert!(finish(&mut command).done() == expected, "{flags} with {environment:?}");
        }
    }
}

#[test]
fn without_a_terminal_the_flags_say_what_is_printed() {
    let folder = Folder::new();
    for (flags, same) in [
        ("--glyphs shape", "--glyphs shape"),
        ("--color 256", "--format ansi --color 256"),
        ("--color never --glyphs half", "--glyphs half"),
        ("--color always --glyphs shape", "--format ansi --glyphs shape"),
    ] {
        let printed = folder.run(&format!("ball.ron {flags}")).done();
        assert!(printed == folder.frame(&format!("ball.ron {same}")), "{flags}");
    }
}

#[test]
fn flags_without_effect_on_a_format_are_rejected() {
    let folder = Folder::new();
    for color in ["always", "truecolor", "256", "16"] {
        folder.run(&format!("frame ball.ron --color {color}")).fails_in_a_line(2, "text has no colours");
    }
    for flags in ["--color never", "--color 256", "--glyphs half"] {
        folder.run(&format!("frame ball.ron -o ball.png {flags}")).fails_in_a_line(2, "a PNG consists of pixels");
    }
    folder.run("ball.ron --color 88").is_misused("auto, always, never, truecolor, 256, 16");
    folder.run("frame ball.ron --glyphs octets").is_misused("blocks, octants, sextants, braille");
    folder.run("record ball.ron --glyphs blocks -o x.gif").fails_in_a_line(2, "name a file that ends in .cast");
}

/// A cell of shapes has two by four pixels.
#[test]
fn sizes_are_in_cells_of_the_mode() {
    let folder = Folder::new();
    let frame = |flags: &str| folder.frame(&format!("ball.ron {flags}"));
    assert!(frame("--glyphs shape --pixels 40x32") == frame("--glyphs shape --size 20x8"));
    assert!(frame("--glyphs ramp --pixels 20x16") == frame("--glyphs ramp --size 20x8"));
    assert!(frame("--glyphs sextants --pixels 80x48") == frame("--glyphs sextants --size 20x8"));
    assert!(frame("--glyphs blocks --pixels 80x64") == frame("--glyphs blocks --size 20x8"));
    assert!(frame("--glyphs blocks --size 20x8 --samples 1") != frame("--glyphs blocks --size 20x8"));
}
