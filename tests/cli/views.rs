//! `--view`: what of a scene is shown.

use super::Folder;
use termtrace::view::View;

#[test]
fn a_frame_or_a_film_is_of_the_view_asked_for() {
    let folder = Folder::new();
    let mut seen = vec![];
    for view in View::ALL {
        let name = view.name();
        let frame = folder.frame(&format!("ball.ron --size 30x10 --format ansi --view {name}"));
        assert!(!seen.contains(&frame), "{name} is no other view");
        seen.push(frame);
        folder
            .run(&format!("record ball.ron --size 30x10 --seconds 0.1 --fps 10 -o {name}-%d.png --view {name}"))
            .done();
        let png = folder.frame(&format!("ball.ron --size 30x10 --format png --view {name}"));
        assert!(folder.read(&format!("{name}-1.png")) == png, "{name}: the film begins with the frame");
    }
    assert!(folder.frame("ball.ron --size 30x10 --format ansi") == seen[0], "shaded unless asked");
    let print = folder.run("ball.ron --view depth").done();
    assert!(print == folder.frame("ball.ron --view depth"), "without a terminal too");
}

#[test]
fn what_a_view_makes_no_use_of_is_turned_away() {
    let folder = Folder::new();
    for command in ["frame ball.ron", "record ball.ron -o x.gif", "ball.ron"] {
        let run = folder.run(&format!("{command} --view depth --samples 4"));
        assert_eq!(run.code, Some(2), "{command}");
        assert!(run.stderr.contains("--samples is for the shaded view"), "{}", run.stderr);
    }
    let run = folder.run("frame ball.ron --view deep");
    assert!(run.code == Some(2) && run.stderr.contains("depth"), "{}", run.stderr);
}
