//! The camera on the command line, on every command.

use super::{BALL, Folder};

const COMMANDS: [&str; 4] = ["frame ball.ron", "ball.ron", "record ball.ron --seconds 0.1", "check ball.ron"];

/// A camera given by flags is the camera given in the file.
#[test]
fn flags_stand_for_fields_of_the_scene() {
    let folder = Folder::new();
    let plain = folder.frame("ball.ron");
    for (flags, written, other) in [
        ("--eye -2,3,-5.5", "eye: (1, 1.5, 6)", "eye: (-2, 3, -5.5)"),
        ("--eye=-2,3,-5.5", "eye: (1, 1.5, 6)", "eye: (-2, 3, -5.5)"),
        ("--target -1,0,2", "target: (0, 0.7, 0)", "target: (-1, 0, 2)"),
        ("--target 1e0,+0.5,.25", "target: (0, 0.7, 0)", "target: (1, 0.5, 0.25)"),
        ("--up -0.5,-1,0", "up: (0, 1, 0)", "up: (-0.5, -1, 0)"),
        ("--fov 75.5", "vertical_fov: 40", "vertical_fov: 75.5"),
        ("--shift -0.25,0.1", "vertical_fov: 40", "vertical_fov: 40, shift: (-0.25, 0.1)"),
        ("--tilt 10,-21.5", "vertical_fov: 40", "vertical_fov: 40, tilt: (10, -21.5)"),
    ] {
        assert!(BALL.contains(written));
        folder.write("other.ron", BALL.replace(written, other));
        let expected = folder.frame("other.ron");
        assert_ne!(expected, plain, "{flags}");
        assert!(folder.frame(&format!("ball.ron {flags}")) == expected, "{flags}");
        assert!(folder.frame(&format!("{flags} ball.ron")) == expected, "{flags} before the scene");
        assert!(folder.run(&format!("ball.ron {flags}")).done() == expected, "{flags} of the live view");
        folder.run(&format!("check ball.ron {flags}")).done();
    }
}

#[test]
fn all_flags_at_once() {
    let folder = Folder::new();
    let camera = "eye: (-2, 3, -5), target: (0, 1, -1), up: (0.2, 1, 0), vertical_fov: 55";
    let written = "eye: (1, 1.5, 6), target: (0, 0.7, 0), up: (0, 1, 0), vertical_fov: 40";
    assert!(BALL.contains(written));
    folder.write("other.ron", BALL.replace(written, camera));
    let flags = "--fov 55 --up 0.2,1,0 --target 0,1,-1 --eye -2,3,-5";
    assert_eq!(folder.run(&format!("frame ball.ron {flags}")).text(), folder.run("frame other.ron").text());
}

/// A camera without a view is an error, not a picture.
#[test]
fn invalid_cameras_are_rejected() {
    let folder = Folder::new();
    for command in COMMANDS {
        for (flags, words) in [
            ("--eye 0,0.7,0", "the eye and the target are the same point"),
            ("--target 1,1.5,6", "the eye and the target are the same point"),
            ("--up 0,0,0", "the up vector must have a length"),
            ("--up 1,0.8,6", "up is parallel to the view"),
            ("--eye 0,9,0", "up is parallel to the view"),
            ("--fov 0", "field of view"),
            ("--fov 180", "field of view"),
            ("--fov -5", "field of view"),
            ("--fov=-5", "field of view"),
            ("--fov 1e9", "field of view"),
            ("--fov nan", "field of view"),
            ("--fov inf", "field of view"),
            ("--shift 0,2000", "at most 1000 of its heights"),
            ("--tilt 0,-90", "at 90 the view rectangle would contain the eye"),
            ("--tilt 0,60 --shift 0,2", "passes behind the eye"),
        ] {
            folder.run(&format!("{command} {flags}")).fails_in_a_line(2, words);
        }
    }
}

#[test]
fn invalid_numbers_are_rejected() {
    let folder = Folder::new();
    for command in COMMANDS {
        for flag in ["--eye", "--target", "--up"] {
            for value in ["1,2", "1,2,3,4", "a,b,c", "nan,0,0", "0,inf,0", "0,0,1e39", "1;2;3", "1,,3", ",,"] {
                folder.run(&format!("{command} {flag} {value}")).is_misused("such as 0,1.5,6");
            }
            folder.run(&format!("{command} {flag}")).is_misused(flag);
            folder.run(&format!("{command} {flag} 1,2,3 {flag} 1,2,3")).is_misused("multiple times");
        }
        folder.run(&format!("{command} --fov wide")).is_misused("--fov");
        for value in ["1", "1,2,3", "a,b", "nan,0", "0,inf"] {
            folder.run(&format!("{command} --tilt {value}")).is_misused("such as 0,-21.5");
        }
    }
}

/// The extreme values of f32 give a picture or a message.
#[test]
fn extreme_cameras_do_not_panic() {
    let folder = Folder::new();
    for flags in [
        "--eye 1e9,-1e9,1e9",
        "--eye 1e9,0,0 --target -1e9,0,1",
        "--eye 1e-40,0,0 --target 0,0,1e-40",
        "--up 1e9,1e9,1e9",
        "--up 1e-45,0,0",
        "--fov 1e-30",
        "--fov 179.99999",
        "--eye 0,0,0 --target 0,0,1e9",
        "--eye 0,0,1 --target 0,0,1.0000001",
    ] {
        let run = folder.run(&format!("frame ball.ron --size 9x4 {flags}"));
        match run.code {
            Some(0) => assert_eq!(run.stdout.len(), 40, "{flags}"),
            _ => run.fails_in_a_line(2, ""),
        }
    }
}

/// A scene file has the same limits, and the camera that is printed on leaving must load again.
#[test]
fn coordinates_beyond_a_scenes_limits_are_misuse() {
    let folder = Folder::new();
    for flags in ["--eye 3e38,0,0", "--target 0,0,-1.1e9", "--up inf,0,0", "--eye NaN,0,0"] {
        folder.run(&format!("frame ball.ron {flags}")).is_misused("from -1e9 to 1e9");
    }
}
