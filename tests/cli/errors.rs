//! Each error is reported once, on standard error, with an exit code that tells whose fault it is.

use super::{BALL, Folder, shipped_scenes};

const COMMANDS: [&str; 4] = ["", "frame", "record", "check"];

#[test]
fn check_reports_faults_or_success() {
    let folder = Folder::new();
    assert_eq!(folder.run("check ball.ron").text(), "ball.ron: OK (2 objects, 1 light)\n");
    for scene in shipped_scenes() {
        let text = folder.run(&format!("check {}", scene.display())).text();
        assert!(text.starts_with(&format!("{}: OK", scene.display())), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
    }
}

/// Errors are reported as a compiler does: file, line, column, the line, a caret, all in one run.
#[test]
fn a_faulty_scene_is_reported_as_by_a_compiler() {
    let folder = Folder::new();
    folder.write("broken.ron", BALL.replace("radius", "radus").replace("intensity: 60", "intensity: -60"));
    let line = "        Sphere(center: (-0.6, 1, 0), radus: 1, material: Diffuse(\"#e04030\")),";
    for command in COMMANDS {
        let run = folder.run(&format!("{command} broken.ron"));
        run.fails(2, "broken.ron:7:38: unknown field \"radus\"; did you mean \"radius\"?\n");
        assert!(run.stderr.contains("broken.ron:5:"), "all faults are told: {}", run.stderr);
        let lines: Vec<_> = run.stderr.lines().collect();
        let at = lines.iter().position(|l| l.contains(line.trim())).expect("the line is shown");
        let caret = lines[at + 1].find('^').expect("a caret");
        assert_eq!(Some(caret), lines[at].find("radus"), "{}", run.stderr);
    }
}

#[test]
fn files_that_are_no_scenes_are_errors() {
    let folder = Folder::new();
    folder.write("empty.ron", "");
    folder.write("blank.ron", " \n\t\n");
    folder.write("binary.ron", b"\x7fELF\x02\x01\x01\0\0\0\xff\xfe");
    folder.write("latin.ron", b"// caf\xe9\n(camera: (eye: (0, 0, 5), target: (0, 0, 0)))");
    folder.write("deep.ron", "(".repeat(100_000));
    folder.write("lists.ron", "[".repeat(1 << 20));
    folder.write("huge.ron", vec![b' '; 17 << 20]);
    folder.write("line.ron", format!("(camera: {})", "x".repeat(1 << 20)));
    folder.write("controls.ron", "(camera: \x1b[2J\x07)");
    std::fs::create_dir(folder.path("folder.ron")).expect("a folder can be made");
    for command in COMMANDS {
        for (file, words) in [
            ("missing.ron", "no such file"),
            ("missing/ball.ron", "no such file"),
            ("folder.ron", "directory"),
            ("ball.ron/x", "ball.ron/x"),
            ("empty.ron", "empty"),
            ("blank.ron", "empty"),
            ("binary.ron", "not a text file"),
            ("latin.ron", "UTF-8"),
            ("deep.ron", "deep"),
            ("lists.ron", "deep"),
            ("huge.ron", "too large"),
            ("line.ron", "line.ron:1:10"),
            ("controls.ron", "controls.ron:1:10"),
        ] {
            let run = folder.run(&format!("{command} {file}"));
            run.fails(2, words);
            assert!(run.stderr.starts_with(&format!("error: {file}")), "{run:?}");
            assert!(run.stderr.len() < 2000, "{} bytes about {file}", run.stderr.len());
        }
    }
}

#[test]
fn formats_that_are_not_read_are_named() {
    let folder = Folder::new();
    folder.write("a.fbx", b"Kaydara FBX Binary  \0");
    folder.write("b.3mf", b"PK\x03\x04\0\0");
    folder.write("c.off", "OFF\n3 1 0\n");
    folder.write("blend", b"BLENDER-v300");
    folder.write("cow", "v 1 2 3\nf 1 1 1\n");
    for (file, told) in [
        ("a.fbx", "FBX: not a format termtrace reads; it reads RON, OBJ, STL, PLY, glTF and GLB"),
        ("b.3mf", "3MF: not a format"),
        ("c.off", "OFF: not a format"),
        ("blend", "Blender: not a format"),
        ("cow", "this looks like OBJ, which is read from files whose names end in .obj"),
    ] {
        folder.run(&format!("check {file}")).fails_in_a_line(2, told);
    }
    folder.write("scene.off", BALL);
    folder.run("check scene.off").done();
}

#[test]
fn the_start_of_a_name_is_enough_for_a_suggestion() {
    let folder = Folder::new();
    folder.write("a.ron", BALL.replace("position:", "pos:"));
    let run = folder.run("check a.ron");
    run.fails(2, "unknown field \"pos\"; did you mean \"position\"?");
    assert!(!run.stderr.contains("has no position") && run.stderr.lines().count() == 3, "one error: {}", run.stderr);
}

/// A file without permission to read is an error. Root may read every file, and cannot test this.
#[test]
fn files_without_read_permission_are_errors() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let path = folder.path("ball.ron");
    std::fs::set_permissions(&path, PermissionsExt::from_mode(0o000)).expect("it is our file");
    if std::fs::File::open(path).is_err() {
        for command in COMMANDS {
            folder.run(&format!("{command} ball.ron")).fails_in_a_line(2, "no permission");
        }
    }
}

#[test]
fn help_has_examples() {
    let folder = Folder::new();
    let help = folder.run("--help").text();
    for words in [
        "Usage:",
        "Camera:",
        "Picture:",
        "Cells:",
        "Link:",
        "Motion:",
        "Keys (",
        "Settings:",
        "Examples:",
        "Exit status:",
        "frame",
        "check",
        "--eye",
        "--threads",
        "--color",
        "--order",
        "cannot see whether",
    ] {
        assert!(help.contains(words), "{words}: {help}");
    }
    let example = |line: &str| line.trim_start().starts_with("termtrace ");
    assert!(help.lines().filter(|line| example(line)).count() >= 5, "{help}");
    for (command, flags) in [
        (
            "frame --help",
            &["--size", "--pixels", "--format", "--samples", "--cell-aspect", "--scale", "--output", "--check"][..],
        ),
        ("check --help", &["--eye", "--target", "--up", "--fov", "--threads"]),
    ] {
        let help = folder.run(command).text();
        assert!(flags.iter().all(|flag| help.contains(flag)), "{help}");
    }
    for help in [folder.run("--help").text(), folder.run("frame --help").text(), folder.run("check --help").text()] {
        assert!(!help.contains('\x1b'), "no colour in help");
        assert!(!help.contains("test-panic"), "what is for tests alone is hidden");
    }
}

/// Returns the names of all commands, as `--help` lists them.
fn commands(folder: &Folder) -> Vec<String> {
    let help = folder.run("--help").text();
    let listed = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("commands");
    let first = listed.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let commands: Vec<_> = first.filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect();
    assert!(commands.len() > 12, "{commands:?}");
    commands
}

/// Returns the help in a window of 80 columns.
fn help_in_80_columns(folder: &Folder, arguments: &str) -> String {
    super::finish(folder.command(arguments).env("COLUMNS", "80")).text()
}

/// A row is left for the prompt.
#[test]
fn short_help_fits_80_by_24_cells() {
    let folder = Folder::new();
    for command in commands(&folder).iter().map(String::as_str).chain([""]) {
        let help = help_in_80_columns(&folder, &format!("{command} -h"));
        let widest = help.lines().map(|line| line.chars().count()).max();
        assert!(help.lines().count() <= 23 && widest <= Some(80), "{widest:?}, {} rows:\n{help}", help.lines().count());
        assert!(help.contains("Usage:") && help.contains("--help"), "{help}");
        assert!(!help.contains("--no-config") || ["", "config", "doctor"].contains(&command), "{command}: {help}");
    }
}

/// Options that the short help names exist, and it names every command.
#[test]
fn short_help_names_commands_and_options_that_exist() {
    let folder = Folder::new();
    let (short, long) = (folder.run("-h").text(), folder.run("--help").text());
    let listed = short.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("commands");
    let names = listed.lines().flat_map(|line| line.trim().split("  ").next().unwrap_or_default().split(", "));
    let mut names: Vec<_> = names.map(str::to_owned).collect();
    let mut expected = commands(&folder);
    names.sort();
    expected.sort();
    assert_eq!(names, expected);
    let flags: Vec<_> = short.split_whitespace().filter(|word| word.starts_with("--")).collect();
    assert!(flags.len() >= 8 && short.contains("Keys:"), "{short}");
    for flag in flags.into_iter().map(|flag| flag.trim_end_matches(',')) {
        assert!(long.contains(flag), "{flag}");
    }
}

/// Nothing is cut by the window; a pipe gets at most 100 columns.
#[test]
fn long_help_wraps_at_the_width_of_the_window() {
    let folder = Folder::new();
    for command in commands(&folder).iter().map(String::as_str).chain([""]) {
        for (help, most) in [
            (help_in_80_columns(&folder, &format!("{command} --help")), 80),
            (folder.run(&format!("{command} --help")).text(), 100),
        ] {
            assert!(help.lines().all(|line| line.chars().count() <= most), "{most} columns:\n{help}");
        }
    }
}

#[test]
fn help_and_version_are_commands() {
    let folder = Folder::new();
    assert_eq!(folder.run("help").text(), folder.run("--help").text());
    for command in commands(&folder) {
        assert_eq!(folder.run(&format!("help {command}")).text(), folder.run(&format!("{command} --help")).text());
    }
    folder.run("help fram").fails_in_a_line(2, "there is no command \"fram\"; did you mean \"frame\"?");
    assert_eq!(folder.run("version").text(), folder.run("--version").text());
    folder.run("-v").is_misused("'-V'");
    // Files of these names are opened by their path.
    folder.write("help", BALL);
    assert!(folder.run("./help").done() == folder.run("ball.ron").done());
}

/// Returns the output of a command on a terminal of 80x24 cells.
fn on_a_terminal(folder: &Folder, arguments: &str) -> (String, Vec<String>) {
    let script = format!("cd '{}'; {arguments}", folder.path("").display());
    let mut session = crate::pty::Start::shell(&script.replace("termtrace", env!("CARGO_BIN_EXE_termtrace"))).spawn();
    session.wait_exit(std::time::Duration::from_secs(60));
    let seen = session.seen();
    (String::from_utf8_lossy(seen.bytes()).into_owned(), seen.screen().text())
}

/// One row is left for the prompt.
#[test]
fn a_frame_fills_a_terminal_in_color() {
    let folder = Folder::new();
    let (bytes, screen) = on_a_terminal(&folder, "termtrace frame ball.ron");
    assert!(bytes.contains("\x1b[38;2;") && bytes.matches('\n').count() == 23, "{bytes:?}");
    assert!(screen[22].contains('▄') && screen[23].trim().is_empty(), "{screen:?}");
    let (bytes, _) = on_a_terminal(&folder, "termtrace frame ball.ron --format text");
    assert!(!bytes.contains('\x1b'), "{bytes:?}");
    let (bytes, _) = on_a_terminal(&folder, "termtrace frame ball.ron | cat");
    assert!(!bytes.contains('\x1b'), "{bytes:?}");
}

#[test]
fn help_and_errors_are_colored_on_a_terminal_alone() {
    let folder = Folder::new();
    let red = "\x1b[1;31merror:\x1b[0m ";
    let (help, screen) = on_a_terminal(&folder, "termtrace frame -h");
    assert!(help.contains("\x1b[1;32mUsage:\x1b[0m"), "{help:?}");
    assert!(screen[0].starts_with("Print one frame"), "nothing scrolls away: {screen:?}");
    for (arguments, told) in [
        ("termtrace frame --sise 3", "unexpected argument"),
        ("termtrace fram", "there is no command"),
        ("termtrace check none.ron", "none.ron: there is no such file"),
    ] {
        let (said, _) = on_a_terminal(&folder, arguments);
        assert!(said.contains(&format!("{red}{told}")), "{said:?}");
        let (said, screen) = on_a_terminal(&folder, &format!("NO_COLOR=1 {arguments}"));
        assert!(!said.contains('\x1b') && screen[0].starts_with(&format!("error: {told}")), "{said:?}");
    }
    let (said, _) = on_a_terminal(&folder, "termtrace frame --sise 3");
    assert!(said.contains("\x1b[1;36mtip:\x1b[0m"), "{said:?}");
}

/// Each example of the help runs as it is printed.
#[test]
fn the_examples_of_the_help_run() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("scenes")).expect("a folder can be made");
    folder.write("scenes/three_spheres.ron", BALL);
    folder.write("my.ron", BALL);
    folder.run("frame my.ron --check my.txt --bless").done();
    let help = folder.run("--help").text();
    let (_, examples) = help.split_once("Examples:").expect("examples");
    for example in examples.lines().filter_map(|line| line.trim_start().strip_prefix("termtrace ")) {
        let arguments = example.split("  ").next().unwrap_or_default();
        folder.run(arguments).done();
    }
    assert!(folder.path("ball.png").exists());
}

#[test]
fn version_is_the_crates() {
    let folder = Folder::new();
    for flag in ["--version", "-V"] {
        assert_eq!(folder.run(flag).text(), format!("termtrace {}\n", env!("CARGO_PKG_VERSION")));
    }
}

#[test]
fn a_wrong_command_line_is_reported_with_help() {
    let folder = Folder::new();
    folder.run("check").is_misused("<SCENE>");
    folder.run("frame ball.ron --pixel 8x8").is_misused("'--pixels'");
    folder.run("frame ball.ron --sample 2").is_misused("'--samples'");
    folder.run("ball.ron --colour=always").is_misused("'--color");
    folder.run("ball.ron --samples good").is_misused("--samples");
    folder.run("ball.ron --order rows").is_misused("color, raster");
    folder.run("ball.ron --order color --compressed-link").is_misused("cannot be used with");
    folder.run("ball.ron --quality good").is_misused("exact, equal, fast");
    for rate in ["999", "0k", "1.5k", "k", "", "9999999M", "-5k", "50kB"] {
        folder.run(&format!("ball.ron --max-rate={rate}")).is_misused("bytes per second from 1000 on");
    }
    folder.run("check ball.ron --size 2x2").is_misused("--size");
    folder.run("ball.ron other.ron").fails_in_a_line(2, "only one scene can be printed");
    folder.run("fram ball.ron").fails_in_a_line(2, "did you mean \"frame\"?");
    folder.run("ball.ron --color=always other.ron").fails_in_a_line(2, "other.ron");
    folder.run("frame ball.ron --scale 2").fails_in_a_line(2, "--scale is for PNG");
    folder.run("frame ball.ron other.ron").is_misused("other.ron");
    folder.run("frame ball.ron --scale 0").is_misused("--scale");
    folder.run("frame ball.ron --format text --format png").is_misused("multiple times");
    assert_eq!(folder.run("frame ball.ron --size 8x4 --bless").code, Some(2));
}

/// A file's name may have any character but a slash; messages about it have no control characters.
#[test]
fn names_of_files_reach_the_terminal_without_their_control_characters() {
    let folder = Folder::new();
    let scene = std::fs::read(folder.path("ball.ron")).expect("the scene is there");
    folder.write("ball\x1b[2J.ron", scene);
    folder.write("gold\x1b[1m.txt", "no frame\x1b[2J\n");
    for arguments in [
        "check ball\x1b[2J.ron",
        "check no\x1b[2J.ron",
        "frame ball.ron -o \x1b[2Jxy",
        "frame ball.ron -o \x1b[2Jx/y.txt",
        "frame ball.ron --check gold\x1b[1m.txt",
        "frame ball.ron --check no\x1b[1m.txt",
        "ball.ron \x1b[2J",
    ] {
        let run = folder.run(arguments);
        let said = [run.stdout, run.stderr.into()].concat();
        assert!(!said.is_empty() && !said.contains(&0x1b), "{arguments:?}: {}", said.escape_ascii());
    }
}

/// Returns whether a message may not have this character.
///
/// It would control the terminal, or turn the direction of writing.
fn is_unprintable(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' | '\u{61c}');
    c != '\n' && c.is_control() || turns
}

/// A value that would set the title, clear the screen and turn what follows around.
const EVIL: &str = "\x1b]0;X\x07\x1b[2J\u{202e}\u{2066}\u{200f}\u{61c}\u{9b}1mx";

#[track_caller]
fn says_nothing_unprintable(folder: &Folder, arguments: &str) {
    let run = folder.run(arguments);
    let said = String::from_utf8_lossy(&run.stdout) + &*run.stderr;
    assert!(!said.contains(is_unprintable), "{arguments:?}: {said:?}");
}

/// The flags that take a value, as a command's help lists them.
fn flags_with_values(help: &str) -> Vec<String> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let flags = lines.filter_map(|line| line[line.find("--")?..].split_once(['<', '[']));
    flags.map(|(flag, _)| flag.trim_end_matches([' ', '=']).to_owned()).collect()
}

/// Every flag, command and argument is quoted without control characters, by clap or by the
/// program.
#[test]
fn no_argument_reaches_the_terminal_unquoted() {
    let folder = Folder::new();
    let commands = commands(&folder);
    let mut count = 0;
    for command in commands.iter().map(String::as_str).chain([""]) {
        // With the feature `serve`, a server that starts does not end. It refuses this address.
        let refused = if command == "serve" { " --listen=203.0.113.1:2222" } else { "" };
        for flag in flags_with_values(&folder.run(&format!("{command} --help")).text()) {
            // This holds beside a valid scene, too.
            says_nothing_unprintable(&folder, &format!("{command} {flag}={EVIL}{refused}"));
            says_nothing_unprintable(&folder, &format!("{command} ball.ron {flag}={EVIL}{refused}"));
            count += 1;
        }
        for arguments in [EVIL, &format!("ball.ron {EVIL}"), &format!("--{EVIL}"), &format!("-{EVIL}")] {
            says_nothing_unprintable(&folder, &format!("{command} {arguments}{refused}"));
        }
    }
    assert!(count > 60, "{count} flags were found");
}

/// A picture that does not fit in the memory is refused before it is begun.
#[cfg(target_os = "linux")]
#[test]
fn too_little_memory_is_an_error_message() {
    let folder = Folder::new();
    let count: u32 = 100_000;
    folder.write("big.stl", [&[0; 80][..], &count.to_le_bytes(), &vec![0; 50 * count as usize]].concat());
    folder.write("big.ron", BALL.replace("objects: [", &format!("objects: [{}", " ".repeat(3 << 20))));
    for name in ["big.stl", "big.ron"] {
        let script = format!("ulimit -v 70000; exec '{}' check {name}", env!("CARGO_BIN_EXE_termtrace"));
        let mut command = std::process::Command::new("sh");
        let run = super::finish(command.args(["-c", &script]).current_dir(folder.path("")));
        run.fails_in_a_line(2, "there is not enough memory");
    }
}

/// No system has room for a stack of 100 TB, which the environment asks for.
#[test]
fn threads_that_cannot_be_started_are_an_error_message() {
    let folder = Folder::new();
    folder.write("ball.ron", BALL);
    for line in
        ["frame ball.ron", "frame ball.ron --threads 2", "describe ball.ron", "check ball.ron", "bench ball.ron"]
    {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_termtrace"));
        command.args(line.split(' ')).env("RUST_MIN_STACK", "100000000000000").current_dir(folder.path(""));
        super::finish(&mut command).fails_in_a_line(1, "threads: no more can be started: ");
    }
}

/// As for the scene, `-` is the standard stream.
#[test]
fn a_dash_is_standard_output() {
    let folder = Folder::new();
    assert_eq!(folder.frame("ball.ron -o -"), folder.frame("ball.ron"));
    assert_eq!(folder.frame("ball.ron --format png -o -"), folder.frame("ball.ron --format png"));
}

/// The file of a scene or path, whatever its name, is not overwritten.
#[test]
fn the_inputs_of_a_picture_are_not_overwritten() {
    let folder = Folder::new();
    for name in ["scene.cast", "scene.gif", "scene.txt"] {
        folder.write(name, BALL);
    }
    for line in [
        "record scene.cast -o scene.cast",
        "record scene.gif -o ./scene.gif",
        "record ball.ron --path scene.gif -o scene.gif",
        "frame scene.txt -o scene.txt",
        "frame scene.txt --check scene.txt --bless",
    ] {
        folder.run(line).fails_in_a_line(2, "is an input file and would be overwritten");
    }
    for name in ["scene.cast", "scene.gif", "scene.txt"] {
        assert_eq!(folder.run(&format!("check {name}")).text(), format!("{name}: OK (2 objects, 1 light)\n"));
    }
}
