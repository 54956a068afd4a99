//! Completions for shells, the manual, and suggestions for misspelt words.

use super::Folder;

const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "powershell", "elvish"];
const COMMANDS: [&str; 9] = ["frame", "record", "check", "describe", "bench", "doctor", "config", "completions", "man"];

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

/// The shell accepts the script.
#[test]
fn bash_takes_its_completions() {
    let folder = Folder::new();
    folder.write("termtrace.bash", folder.run("completions bash").done());
    let script = "source ./termtrace.bash && COMP_WORDS=(termtrace frame --pix) COMP_CWORD=2 && _termtrace termtrace --pix frame && echo ${COMPREPLY[@]}";
    let mut bash = std::process::Command::new("bash");
    let run = bash.args(["-c", script]).current_dir(folder.path(".")).output();
    // Not every system has this shell.
    let Ok(run) = run else { return };
    assert_eq!(String::from_utf8_lossy(&run.stdout).trim(), "--pixels", "{run:?}");
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let folder = Folder::new();
    let page = folder.run("man").text();
    assert!(page.contains(".TH termtrace 1") && page.contains("Exit codes"), "{page}");
    for command in COMMANDS {
        assert!(page.contains(&format!("termtrace\\-{command}(1)")), "{command}: {page}");
        let page = folder.run(&format!("man {command}")).text();
        assert!(page.contains(".SH OPTIONS") && page.contains(command), "{page}");
    }
    folder.run("man fram").fails_in_a_line(2, "there is no command \"fram\"; did you mean \"frame\"?");
    folder.run("man nothing").fails_in_a_line(2, "there is no command \"nothing\"");
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
            run.fails_in_a_line(2, &format!("termtrace: {name}: {reason}\n"));
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
