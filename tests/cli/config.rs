//! The user's settings: their values, their sources, and faults in their file.

use super::{Folder, Run, finish};
use std::fs;
use std::path::Path;

/// Returns a folder with this text in the user's `config.ron`.
fn with_settings(text: &str) -> Folder {
    with_file("config.ron", text)
}

/// Returns a folder with a second file of the user's.
fn with_file(name: &str, text: &str) -> Folder {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("settings/termtrace")).expect("a folder can be made");
    folder.write(&format!("settings/termtrace/{name}"), text);
    folder
}

/// Returns the first block of RON in `docs/terminals.md` with these words.
fn in_the_docs(words: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/terminals.md");
    let page = fs::read_to_string(page).expect("it is there");
    let mut blocks = page.split("```ron\n").filter_map(|rest| rest.split("```").next());
    blocks.find(|text| text.contains(words)).expect("the page shows one").to_owned()
}

/// Returns the settings with their sources.
///
/// `~` stands for the folder; `NO_COLOR` and the like are not set.
#[track_caller]
fn held(folder: &Folder, arguments: &str, environment: &[(&str, &str)], setting: &str) -> String {
    let text = config(folder, arguments, environment).text();
    let line = text.lines().find(|line| line.split(' ').next() == Some(setting)).unwrap_or_else(|| panic!("{text}"));
    let words: Vec<_> = line.split_whitespace().skip(1).collect();
    words.join(" ").replace(&*folder.path("settings/termtrace").to_string_lossy(), "~")
}

fn config(folder: &Folder, arguments: &str, environment: &[(&str, &str)]) -> Run {
    let mut command = folder.command(&format!("config {arguments}"));
    for name in ["NO_COLOR", "CLICOLOR_FORCE", "FORCE_COLOR"] {
        command.env_remove(name);
    }
    finish(command.envs(environment.iter().copied()))
}

#[test]
fn a_flag_goes_before_the_environment_that_before_the_file_and_that_before_the_default() {
    let folder = with_settings("(\n    // slowly\n    fps: 30,\n    map: depth,\n)");
    let variable = [("TERMTRACE_FPS", "20")];
    assert_eq!(held(&folder, "--fps 10", &variable, "fps"), "10 --fps");
    assert_eq!(held(&folder, "", &variable, "fps"), "20 TERMTRACE_FPS");
    assert_eq!(held(&folder, "", &[("TERMTRACE_FPS", "")], "fps"), "30 ~/config.ron:3", "empty is unset");
    assert_eq!(held(&folder, "", &[], "map"), "depth ~/config.ron:4");
    assert_eq!(held(&folder, "--no-config", &[], "fps"), "60 default");
    assert_eq!(held(&folder, "--no-config", &variable, "fps"), "20 TERMTRACE_FPS");
    assert_eq!(held(&Folder::new(), "", &[], "map"), "shaded default");
}

/// For colours the common variables, such as `NO_COLOR`, count as environment, too.
#[test]
fn no_color_goes_before_the_file() {
    let folder = with_settings("(color: truecolor)");
    assert_eq!(held(&folder, "", &[], "color"), "truecolor ~/config.ron:1");
    for variable in [("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1"), ("FORCE_COLOR", "0")] {
        assert_eq!(held(&folder, "", &[variable], "color"), format!("auto {}", variable.0));
        assert_eq!(held(&folder, "--color 16", &[variable], "color"), "16 --color");
        assert_eq!(held(&folder, "", &[variable, ("TERMTRACE_COLOR", "256")], "color"), "256 TERMTRACE_COLOR");
    }
    assert_eq!(held(&folder, "", &[("NO_COLOR", ""), ("CLICOLOR_FORCE", "0")], "color"), "truecolor ~/config.ron:1");
    let doctor = finish(folder.command("doctor").env_remove("NO_COLOR").env_remove("FORCE_COLOR")).text();
    let line = doctor.lines().find(|line| line.starts_with("colours")).expect("a line");
    assert!(line.contains("truecolor") && line.ends_with("config.ron:1"), "{doctor}");
}

#[test]
fn a_flag_can_undo_what_the_file_turns_on() {
    let folder = with_settings("(reduced_motion: true)");
    assert_eq!(held(&folder, "", &[], "reduced_motion"), "true ~/config.ron:1");
    assert_eq!(held(&folder, "--reduced-motion=false", &[], "reduced_motion"), "false --reduced-motion");
    assert_eq!(held(&folder, "--no-config --reduced-motion", &[], "reduced_motion"), "true --reduced-motion");
}

/// The file in the documentation has every setting, and each takes effect.
#[test]
fn the_documented_file_has_every_setting() {
    let folder = with_settings(&in_the_docs("fps:"));
    let text = config(&folder, "", &[]).text();
    let (settings, place) = text.split_once("\n\n").expect("two parts");
    assert!(settings.lines().count() >= 9, "{text}");
    for line in settings.lines() {
        assert!(line.contains("config.ron:"), "the documentation's file lacks {line}");
    }
    assert!(place.contains("settings/termtrace/config.ron (read)\n"), "{place}");
    assert!(place.ends_with("settings/termtrace/keys.ron (does not exist)\n"), "{place}");
    let text = config(&folder, "--no-config", &[]).text();
    assert!(text.contains("settings/termtrace/config.ron (ignored: --no-config)\n"), "{text}");
}

#[test]
fn the_settings_file_is_searched_in_xdg_config_home_first() {
    let folder = with_settings("(fps: 30)");
    let place = |variables: &[(&str, &str)]| {
        let mut command = folder.command("config");
        command.env_remove("XDG_CONFIG_HOME").env_remove("HOME").envs(variables.iter().copied());
        let text = finish(&mut command).text();
        let line = text.lines().find(|line| line.starts_with("config.ron")).unwrap_or_default();
        line.split_whitespace().skip(1).collect::<Vec<_>>().join(" ")
    };
    let (settings, home) = (folder.path("settings"), folder.path("home"));
    let (settings, home) = (&*settings.to_string_lossy(), &*home.to_string_lossy());
    let there = format!("{settings}/termtrace/config.ron (read)");
    assert_eq!(place(&[("XDG_CONFIG_HOME", settings), ("HOME", home)]), there);
    let default = format!("{home}/.config/termtrace/config.ron (does not exist)");
    assert_eq!(place(&[("HOME", home)]), default);
    assert_eq!(place(&[("XDG_CONFIG_HOME", "settings"), ("HOME", home)]), default, "no absolute path");
    assert_eq!(place(&[]), "nowhere: neither XDG_CONFIG_HOME nor HOME is the path of a folder");
}

const WRONG: &str = "(
    colour: 256,
    map: dept,
    fps: 0,
    fps: 30,
    samples: (1, 2),
    reduced_motion: maybe,
)";

/// Maps were called views, which are camera positions now.
#[test]
fn the_old_setting_suggests_the_new_one() {
    let run = with_settings("(view: depth)").run("config");
    run.fails(2, "config.ron:1:2: unknown setting \"view\"; the name is now \"map\"\n");
}

/// All errors of a file are in one message, in its order, each with its position and a correction.
#[test]
fn all_faults_of_a_file_are_in_one_message() {
    let folder = with_settings(WRONG);
    for command in ["config", "doctor", "config --fps 30"] {
        let run = folder.run(command);
        let message = run.stderr.replace(&*folder.path("settings/termtrace").to_string_lossy(), "~");
        run.fails(2, "config.ron:2:5: unknown setting \"colour\"; did you mean \"color\"?\n");
        let heads: Vec<_> = message.lines().filter(|line| line.contains("~/config.ron")).collect();
        assert_eq!(
            heads,
            [
                "error: ~/config.ron:2:5: unknown setting \"colour\"; did you mean \"color\"?",
                "~/config.ron:3:10: expected one of shaded, lambert, depth, normal, object, shadow, cost, facing, \
                 contrast, wire; did you mean depth?",
                "~/config.ron:4:10: expected frames per second, from 0.01 to 1000",
                "~/config.ron:5:5: duplicate setting \"fps\"",
                "~/config.ron:6:14: expected one value: a word, a number, true or false",
                "~/config.ron:7:21: expected one of true, false",
            ]
        );
        assert!(message.contains("  3 |     map: dept,\n    |          ^^^^\n"), "{message}");
    }
    assert_eq!(folder.run("config --no-config").code, Some(0));
    for (text, words) in [
        ("", "the file is empty; the smallest file of settings is ()"),
        ("(fps: 30", "this `(` is never closed by a `)`"),
        ("[30]", "expected named settings"),
        ("(30)", "expected named settings"),
        ("\0", "not a text file"),
    ] {
        with_settings(text).run("config").fails(2, words);
    }
    with_settings("()").run("config").done();
    with_settings("(fps: None)").run("config").done();
    let folder = Folder::new();
    fs::create_dir_all(folder.path("settings/termtrace/config.ron")).expect("a folder can be made");
    folder.run("config").fails_in_a_line(2, "config.ron: this is a directory, not a file");
}

#[test]
fn a_wrong_variable_is_reported_by_its_name() {
    let run = config(&Folder::new(), "", &[("TERMTRACE_FPS", "many")]);
    run.fails_in_a_line(2, "TERMTRACE_FPS=\"many\": expected frames per second, from 0.01 to 1000");
    config(&Folder::new(), "--fps 3", &[("TERMTRACE_FPS", "many")]).done();
}

/// Golden frames depend on arguments alone.
#[test]
fn settings_do_not_affect_frames() {
    let plain = Folder::new();
    for text in ["(color: truecolor, glyphs: shape, map: depth, samples: 4)", WRONG] {
        let folder = with_settings(text);
        for command in ["ball.ron", "frame ball.ron", "frame ball.ron --format ansi --size 20x6", "describe ball.ron"] {
            let mut with_variable = folder.command(command);
            with_variable.env("TERMTRACE_MAP", "normal");
            assert!(finish(&mut with_variable).done() == plain.run(command).done(), "{command}");
        }
    }
}

#[test]
fn the_flag_goes_with_every_command() {
    let folder = Folder::new();
    assert!(folder.run("frame ball.ron --no-config").done() == folder.run("frame ball.ron").done());
    folder.run("--no-config frame ball.ron").fails_in_a_line(2, "it: termtrace frame ...");
}

/// The printed table has the form of the file: it can be the start of one's own.
#[test]
fn the_table_of_keys_is_a_file_of_keys() {
    let built_in = Folder::new().run("config --keys").text();
    assert!(built_in.contains("    orbit: {\n") && built_in.contains("\"w\": MoveForward,"), "{built_in}");
    assert_eq!(with_file("keys.ron", &built_in).run("config --keys").text(), built_in);
    let folder = with_file("keys.ron", &in_the_docs("fly:"));
    let own = folder.run("config --keys").text();
    for line in
        ["\"z\": MoveForward,", "[\"s\", \"u\", \"Home\"]: MoveBack,", "\"w\": None,", "[\"o\", \"Ctrl-P\"]: Export,"]
    {
        assert!(own.contains(&format!("\n        {line}")), "{line} is not in\n{own}");
    }
    assert_eq!(with_file("keys.ron", &own).run("config --keys").text(), own);
    assert_eq!(folder.run("config --keys --no-config").text(), built_in);
}

#[test]
fn all_faults_of_keys_are_in_one_message() {
    let folder =
        with_file("keys.ron", "(\n    fly: { \"8\": MovForward, \"Ctrl-I\": Reset },\n    always: { \"q\": None },\n)");
    for command in ["config", "config --keys"] {
        let run = folder.run(command);
        run.fails(2, "keys.ron:2:17: there is no command MovForward; did you mean MoveForward?\n");
        for (place, words) in [("2:29", "is not a key that every terminal sends"), ("3:15", "no key but Ctrl-C quits")]
        {
            assert!(run.stderr.contains(&format!("keys.ron:{place}: ")) && run.stderr.contains(words), "{run:?}");
        }
    }
    folder.run("config --no-config --keys").done();
    folder.run("frame ball.ron").done();
    folder.run("doctor").done();
}
