//! `termtrace doctor` without a terminal: its findings from the environment.

use crate::{Folder, Run, finish};

/// Runs `doctor` in this environment and nothing else in it.
fn doctor(arguments: &str, environment: &[(&str, &str)]) -> Run {
    let mut command = Folder::new().command(&format!("doctor {arguments}"));
    finish(command.env_clear().envs(environment.iter().copied()).current_dir("/"))
}

#[test]
fn doctor_reports_findings_with_their_sources() {
    let environment = [("TERM", "some-terminal"), ("COLORTERM", "truecolor"), ("LANG", "en_US.UTF-8")];
    let said = doctor("", &environment).text();
    let (first, rest) = said.split_once('\n').expect("lines");
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(first, format!("What this terminal (TERM=some-terminal) can do, and who says so; termtrace {version}"));
    assert_eq!(
        rest,
        "\
it was asked          nothing: there is none here   -
colours               truecolor                     COLORTERM
locale                en_US.UTF-8                   LANG
cells                 half blocks                   LANG
cell, height/width    2.000                         assumed
half blocks meet      not known: no                 not asked
background            not known: dark               not asked
its 16 colours        not known                     not asked
synchronized output   not known: no                 not asked
kitty keyboard        not known: no                 not asked
mouse, by pixels      not known                     not asked
"
    );
}

#[test]
fn doctor_reports_other_environments_and_flags() {
    let environment = [("TERM", "dumb"), ("LC_ALL", "C"), ("LANG", "en_US.UTF-8"), ("NO_COLOR", "1")];
    let said = doctor("--cell-aspect 2.25", &environment).text();
    assert_eq!(
        said.lines().skip(2).take(3).collect::<Vec<_>>(),
        [
            "colours               none                          NO_COLOR",
            "locale                C                             LC_ALL",
            "cells                 characters by shape           NO_COLOR",
        ]
    );
    assert_eq!(said.lines().nth(5), Some("cell, height/width    2.250                         --cell-aspect"));
    let said = doctor("--color=16 --glyphs=ramp", &environment).text();
    assert!(said.contains("\ncolours               16                            --color\n"), "{said}");
    assert!(said.contains("\ncells                 characters by lightness       --glyphs\n"), "{said}");
    let said = doctor("", &[("TERM", "some-terminal")]).text();
    assert!(said.contains("\nlocale                none: taken for UTF-8         assumed\n"), "{said}");
    let said = doctor("", &[("TERM", "some-terminal"), ("LC_ALL", "C")]).text();
    assert!(said.contains("\ncolours               256                           TERM\n"), "{said}");
    assert!(said.contains("\ncells                 characters by shape           LC_ALL\n"), "{said}");
}

#[test]
fn no_escape_byte_goes_into_a_pipe() {
    for (arguments, term) in [("", "xterm"), ("--color=always", "xterm"), ("--color=truecolor", "a\x1b[31mb")] {
        let said = doctor(arguments, &[("TERM", term)]).text();
        assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
        assert_eq!(said.lines().count(), 12, "{said}");
    }
}
