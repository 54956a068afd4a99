//! `--map`: the maps of a scene.

use super::Folder;
use termtrace::Map;

#[test]
fn a_frame_or_film_shows_the_chosen_map() {
    let folder = Folder::new();
    let mut seen = vec![];
    for map in Map::ALL {
        let name = map.name();
        let frame = folder.frame(&format!("ball.ron --size 30x10 --format ansi --map {name}"));
        assert!(!seen.contains(&frame), "{name} is no other map");
        seen.push(frame);
        folder
            .run(&format!("record ball.ron --size 30x10 --seconds 0.1 --fps 10 -o {name}-%d.png --map {name}"))
            .done();
        let png = folder.frame(&format!("ball.ron --size 30x10 --format png --map {name}"));
        assert!(folder.read(&format!("{name}-1.png")) == png, "{name}: the film begins with the frame");
    }
    assert!(folder.frame("ball.ron --size 30x10 --format ansi") == seen[0], "shaded unless asked");
    let print = folder.run("ball.ron --map depth").done();
    assert!(print == folder.frame("ball.ron --map depth"), "without a terminal too");
}

#[test]
fn flags_without_effect_on_a_map_are_rejected() {
    let folder = Folder::new();
    for command in ["frame ball.ron", "record ball.ron -o x.gif", "ball.ron"] {
        let run = folder.run(&format!("{command} --map depth --samples 4"));
        assert_eq!(run.code, Some(2), "{command}");
        assert!(run.stderr.contains("--samples is for the shaded picture"), "{}", run.stderr);
    }
    let run = folder.run("frame ball.ron --map deep");
    assert!(run.code == Some(2) && run.stderr.contains("depth"), "{}", run.stderr);
}

/// Maps were called views, which are camera positions now.
#[test]
fn the_old_flag_suggests_the_new_one() {
    let folder = Folder::new();
    for command in ["ball.ron --view depth", "frame ball.ron --view=depth", "record ball.ron --view depth -o x.gif"] {
        let run = folder.run(command);
        assert_eq!(run.code, Some(2), "{command}");
        assert!(run.stderr.contains("tip: the name is now '--map'\n"), "{command}: {}", run.stderr);
    }
}
