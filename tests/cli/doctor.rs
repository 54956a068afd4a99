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
    let (verdict, said) = said.split_once('\n').expect("lines");
    assert_eq!(verdict, "Not a terminal: this is what the environment and flags say.");
    let (first, rest) = said.split_once('\n').expect("lines");
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(
        first,
        format!("This terminal (TERM=some-terminal): capabilities and their sources; termtrace {version}")
    );
    assert_eq!(
        rest,
        "\
queries sent          none: not a terminal          -
colours               truecolor                     COLORTERM
locale                en_US.UTF-8                   LANG
cells                 half blocks                   LANG
cell, height/width    2.000                         assumed
half blocks join      unknown (assumed no)          not queried
background            unknown (assumed dark)        not queried
palette               unknown                       not queried
synchronized output   unknown (assumed no)          not queried
kitty keyboard        unknown (assumed no)          not queried
mouse reports         unknown                       not queried
"
    );
}

#[test]
fn doctor_reports_other_environments_and_flags() {
    let environment = [("TERM", "dumb"), ("LC_ALL", "C"), ("LANG", "en_US.UTF-8"), ("NO_COLOR", "1")];
    let said = doctor("--cell-aspect 2.25", &environment).text();
    assert_eq!(
        said.lines().skip(3).take(3).collect::<Vec<_>>(),
        [
            "colours               none                          NO_COLOR",
            "locale                C                             LC_ALL",
            "cells                 characters with outlines      NO_COLOR",
        ]
    );
    assert_eq!(said.lines().nth(6), Some("cell, height/width    2.250                         --cell-aspect"));
    let said = doctor("--color=16 --glyphs=ramp", &environment).text();
    assert!(said.contains("\ncolours               16                            --color\n"), "{said}");
    assert!(said.contains("\ncells                 characters by lightness       --glyphs\n"), "{said}");
    let said = doctor("--background=light", &environment).text();
    assert!(said.contains("\nbackground            light                         --background\n"), "{said}");
    let said = doctor("", &[("TERM", "some-terminal")]).text();
    assert!(said.contains("\nlocale                not set: UTF-8 assumed        assumed\n"), "{said}");
    let said = doctor("", &[("TERM", "some-terminal"), ("LC_ALL", "C")]).text();
    assert!(said.contains("\ncolours               256                           TERM\n"), "{said}");
    assert!(said.contains("\ncells                 coloured spaces               LC_ALL\n"), "{said}");
}

#[test]
fn no_escape_byte_goes_into_a_pipe() {
    for (arguments, term) in [("", "xterm"), ("--color=always", "xterm"), ("--color=truecolor", "a\x1b[31mb")] {
        let said = doctor(arguments, &[("TERM", term)]).text();
        assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
        assert_eq!(said.lines().count(), 13, "{said}");
    }
}
