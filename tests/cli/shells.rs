//! Completions for shells, the manual, and suggestions for misspelt words.

use super::{Folder, finish};
use crate::pty::{SOON, Size, Start};
use std::process::Command;

const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "powershell", "elvish"];
const COMMANDS: [&str; 11] =
    ["frame", "record", "check", "describe", "bench", "doctor", "config", "completions", "man", "help", "version"];

#[test]
fn every_shell_learns_of_every_command_and_flag() {
    let folder = Folder::new();
    for shell in SHELLS {
        let script = folder.run(&format!("completions {shell}")).text();
        for word in COMMANDS.into_iter().chain(["cell-aspect", "compressed-link", "threads"]) {
            assert!(script.contains(word), "{word} for {shell}");
        }
    }
    folder.run("completions tcsh").is_misused("bash, elvish, fish, powershell, zsh");
    folder.run("completions").is_misused("<SHELL>");
}

/// Returns whether a program is installed, and says which test is skipped otherwise.
fn is_installed(program: &str) -> bool {
    let is_there = Command::new(program).arg("--version").output().is_ok();
    if !is_there {
        eprintln!("skipped: there is no {program}");
    }
    is_there
}

/// Rows of a line to complete, a word that is offered at its end, and one that is not.
const COMPLETED: [(&str, &str, &str); 16] = [
    ("termtrace ", "frame", "--eye"),
    ("termtrace ", "three_spheres", "--eye"),
    ("termtrace b", "ball.ron", "corridor"),
    ("termtrace ball.ron --reduced", "--reduced-motion", "frame"),
    ("termtrace frame b", "ball.ron", "bench"),
    ("termtrace frame ", "mesh.obj", "notes.txt"),
    ("termtrace frame ", "corridor", "record"),
    ("termtrace frame --pix", "--pixels", "--size"),
    ("termtrace frame --format ", "svg", "ball.ron"),
    ("termtrace frame --glyphs ", "shape", "ball.ron"),
    ("termtrace frame ball.ron -o ", "notes.txt", "corridor"),
    ("termtrace record --path ", "orbit", "corridor"),
    ("termtrace record --samples b", "best", "ball.ron"),
    ("termtrace check ", "ball.ron", "notes.txt"),
    ("termtrace completions ", "zsh", "ball.ron"),
    ("termtrace help ", "record", "ball.ron"),
];

/// Returns a folder with the shell's completions, a scene, a mesh and a text.
fn completed_folder(shell: &str) -> Folder {
    let folder = Folder::new();
    folder.write(&format!("termtrace.{shell}"), folder.run(&format!("completions {shell}")).done());
    folder.write("mesh.obj", "");
    folder.write("notes.txt", "");
    folder
}

/// Asserts what the shell offers, one word per line.
#[track_caller]
fn offers(shell: &str, complete: impl Fn(&str) -> String) {
    for (line, offered, other) in COMPLETED {
        let words = complete(line);
        let has = |word: &str| words.lines().any(|line| line.split('\t').next() == Some(word));
        assert!(has(offered) && !has(other), "{shell}: {line:?} offers {words:?}");
    }
}

#[test]
fn bash_completes_files_options_and_values() {
    if !is_installed("bash") {
        return;
    }
    let folder = completed_folder("bash");
    offers("bash", |line| {
        let script = format!(
            "source ./termtrace.bash; IFS=' ' read -ra COMP_WORDS <<<'{line}'
             case '{line}' in *' ') COMP_WORDS+=('') ;; esac
             COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _termtrace; printf '%s\\n' \"${{COMPREPLY[@]}}\""
        );
        finish(Command::new("bash").args(["--norc", "-c", &script]).current_dir(folder.path("."))).text()
    });
}

#[test]
fn fish_completes_files_options_and_values() {
    if !is_installed("fish") {
        return;
    }
    let folder = completed_folder("fish");
    offers("fish", |line| {
        let script = format!("source ./termtrace.fish; complete -C '{line}'");
        let mut fish = Command::new("fish");
        fish.args(["--no-config", "-c", &script]).env("HOME", folder.path(".")).current_dir(folder.path("."));
        finish(&mut fish).text()
    });
}

/// zsh completes in its line editor alone: Ctrl-D lists what it offers.
#[test]
fn zsh_completes_files_options_and_values() {
    if !is_installed("zsh") {
        return;
    }
    let folder = completed_folder("zsh");
    let size = Size::cells(150, 50);
    let mut session = Start::new("zsh").arg("-f").env("PS1", "ready ").env("HOME", folder.path(".")).size(size).spawn();
    let start = format!(
        "cd '{}'; autoload -U compinit; compinit -u -D; source ./termtrace.zsh; LISTMAX=0; zstyle ':completion:*' verbose no",
        folder.path(".").display()
    );
    session.wait_for_text("ready");
    session.send(format!("{start}; clear; echo set up\r").as_bytes());
    // Until the prompt is back, the terminal's own line discipline would take Ctrl-U and Ctrl-D.
    session.wait_for("the prompt after the set-up", SOON, |seen| {
        let rows = seen.screen().text();
        rows[0].starts_with("set up") && rows[1].starts_with("ready")
    });
    for (line, offered, other) in COMPLETED {
        // Ctrl-U and Ctrl-L remove the line and list before.
        session.send(b"\x15\x0c");
        session.wait_for("an empty screen", SOON, |seen| seen.screen().text()[1].trim().is_empty());
        session.send(format!("{line}\x04").as_bytes());
        let has = |seen: &crate::pty::Seen, word: &str| {
            seen.screen()
                .text()
                .join(" ")
                .trim_start_matches(&format!("ready {line}"))
                .split_whitespace()
                .any(|shown| shown == word)
        };
        session.wait_for(&format!("{offered} after {line:?}"), SOON, |seen| has(seen, offered));
        assert!(!has(session.seen(), other), "{line:?}: {:?}", session.seen().screen().text());
    }
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let folder = Folder::new();
    let page = folder.run("man").text();
    assert!(page.contains(".TH termtrace 1"), "{page}");
    for section in ["OPTIONS", "CAMERA", "KEYS", "FILES", "ENVIRONMENT", "EXAMPLES", "EXIT STATUS"] {
        assert!(page.contains(&format!("\n.SH {section}\n")), "{section}: {page}");
    }
    for command in COMMANDS {
        assert!(page.contains(&format!("termtrace\\-{command}(1)")), "{command}: {page}");
        let page = folder.run(&format!("man {command}")).text();
        assert!(page.contains(".SH OPTIONS") && page.contains(command), "{page}");
    }
    folder.run("man fram").fails_in_a_line(2, "there is no command \"fram\"; did you mean \"frame\"?");
    folder.run("man nothing").fails_in_a_line(2, "there is no command \"nothing\"");
}

/// The pages have no fault that `man --warnings` reports.
#[test]
fn man_formats_each_page_without_warnings() {
    if !is_installed("man") {
        return;
    }
    let folder = Folder::new();
    for command in COMMANDS.into_iter().chain([""]) {
        let name = format!("termtrace{command}.1");
        folder.write(&name, folder.run(&format!("man {command}")).done());
        let mut man = Command::new("man");
        man.args(["--warnings", "-E", "UTF-8", "-Tutf8", "-Z", "-l", &name])
            .env("LC_ALL", "C.UTF-8")
            .env("MANWIDTH", "80");
        let run = finish(man.current_dir(folder.path(".")));
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{command}");
    }
}

/// A link that leads nowhere, or in a circle, is in its folder, but is no file to suggest.
#[test]
fn a_link_that_leads_nowhere_is_not_suggested() {
    let folder = Folder::new();
    for (name, target) in [("dangling.ron", "nowhere.ron"), ("circle.ron", "circle.ron"), ("bal.ron", "nowhere.ron")] {
        std::os::unix::fs::symlink(target, folder.path(name)).expect("a link can be made");
    }
    for command in ["", "frame", "check"] {
        for (name, reason) in [
            ("dangling.ron", "there is no such file"),
            ("./dangling.ron", "there is no such file"),
            ("circle.ron", "cannot be read: Too many levels of symbolic links (os error 40)"),
            // Nor are other such links.
            ("dangling", "there is no such file"),
            ("circel.ron", "there is no such file"),
            ("bal.ron", "there is no such file; did you mean ball.ron?"),
        ] {
            let run = folder.run(&format!("{command} {name}"));
            run.fails_in_a_line(2, &format!("error: {name}: {reason}\n"));
        }
    }
}

#[test]
fn misspelt_scenes_and_commands_get_suggestions() {
    let folder = Folder::new();
    folder.write("teapot.obj", "");
    std::fs::create_dir(folder.path("more")).expect("a folder can be made");
    folder.write("more/corridor.ron", "");
    for command in ["", "frame", "check", "record"] {
        for (name, meant) in [
            ("bal.ron", "ball.ron"),
            ("ball", "ball.ron"),
            ("Ball.RON", "ball.ron"),
            ("teapto.obj", "teapot.obj"),
            ("teapot.ply", "teapot.obj"),
            ("more/corider.ron", "more/corridor.ron"),
            ("./bal.ron", "./ball.ron"),
        ] {
            let run = folder.run(&format!("{command} {name}"));
            run.fails_in_a_line(2, &format!("{name}: there is no such file; did you mean {meant}?\n"));
        }
        for name in ["missing.ron", "more/ball.ron", "less/ball.ron", "tea.obj"] {
            let run = folder.run(&format!("{command} {name}"));
            run.fails_in_a_line(2, "there is no such file\n");
        }
    }
    for (name, meant) in [("fram", "frame"), ("chek", "check"), ("recrod", "record"), ("benhc", "bench")] {
        for rest in ["", "ball.ron", "--threads 2"] {
            let run = folder.run(&format!("{name} {rest}"));
            run.fails_in_a_line(2, &format!("there is no command \"{name}\"; did you mean \"{meant}\"?"));
        }
    }
    // A scene may have any name.
    folder.write("fram", super::BALL);
    assert!(folder.run("fram").done() == folder.run("ball.ron").done());
}
