//! Surfaces of formulas: their time, their colours, and `new --formula`.

use super::Folder;
use std::path::Path;

/// Returns a scene with one formula.
fn scene(fields: &str) -> String {
    let bounds = "bounds: Sphere(center: (0, 0, 0), radius: 2)";
    format!(
        "(camera: (eye: (1, 1, 5), target: (0, 0, 0)), lights: [Point(position: (2, 5, 5), intensity: 40)],
          objects: [Implicit({fields}, {bounds})])"
    )
}

#[test]
fn a_frame_shows_a_moving_scene_at_one_time() {
    let folder = Folder::new();
    folder.write("moving.ron", scene(r#"f: "x^2 + (y - time/4)^2 + z^2 - 1", color: ["time/4", "0.3", "z"]"#));
    for (time, y, red) in [("", "0", "0"), (" --time 2", "0.5", "0.5"), (" --time -1.5", "-0.375", "-0.375")] {
        let f = format!(r#"f: "x^2 + (y - ({y}))^2 + z^2 - 1", color: ["{red}", "0.3", "z"]"#);
        folder.write("still.ron", scene(&f));
        let [moving, still] = [format!("moving.ron{time}"), "still.ron".to_owned()]
            .map(|arguments| folder.run(&format!("frame {arguments} --format ansi --size 40x12")).text());
        assert!(moving == still, "{time}:\n{moving}\n{still}");
    }
    folder.run("frame moving.ron --time soon").is_misused("expected a number of seconds");
    folder.run("record moving.ron --seconds 1 --fps 2 --pixels 32x20 -o at-%02d.png").done();
    folder.run("record moving.ron --seconds 1 --fps 2 --pixels 32x20 --time 0.5 -o later-%02d.png").done();
    let at_orbits_half = folder.read("at-02.png");
    assert!(at_orbits_half != folder.read("at-01.png") && at_orbits_half != folder.read("later-02.png"));
    // Its first camera is the scene's own.
    folder.run("frame moving.ron --pixels 32x20 --time 0.5 -o frame.png").done();
    assert!(folder.read("later-01.png") == folder.read("frame.png"));
}

#[test]
fn a_formula_is_shown_at_once() {
    let folder = Folder::new();
    let printed = folder.run("new --formula x^4+y^4+z^4-1").text();
    assert!(printed.contains(r#"f: "x^4+y^4+z^4-1","#), "{printed}");
    assert_eq!(
        folder.run("new cube.ron --formula x^4+y^4+z^4-1").text(),
        "written: cube.ron; termtrace cube.ron opens it\n"
    );
    assert_eq!(folder.read("cube.ron"), printed.as_bytes());
    assert_eq!(folder.run("check cube.ron").text(), "cube.ron: OK (1 object, 2 lights)\n");
    assert!(folder.run("frame cube.ron").text().contains(['#', '%', '@']));
    let run = folder.run("new --formula x^2+1");
    assert_eq!(run.stderr, "warning: object 1: f has no zero inside the bounds: nothing is seen\n");
    let fault = folder.run("new faulty.ron --formula -x^2+fooor(y)");
    let message = r#"error: formula:17:22: in this formula: unknown name `fooor`: did you mean `floor`?
  17 |             f: "-x^2+fooor(y)",
     |                      ^^^^^
"#;
    assert_eq!((fault.code, &*fault.stderr), (Some(2), message));
    assert!(!folder.path("faulty.ron").exists());
    // Neither a quote nor a backslash leaves the string.
    folder.run(r#"new --formula x",f:"y"#).fails(2, r#"`"` is not part of a formula"#);
    folder.run(r"new --formula x\n").fails(2, r"`\` is not part of a formula");
    folder.run("new").fails(2, "<FILE>");
}

/// Each scene of formulas is valid and shows something.
#[test]
fn the_scenes_of_formulas_show_their_surfaces() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/formulas");
    let folder = Folder::new();
    let mut count = 0;
    for file in std::fs::read_dir(root).expect("the folder is there") {
        let path = file.expect("the folder can be read").path();
        let checked = folder.run(&format!("check {}", path.display())).text();
        assert!(checked.contains(": OK (") && !checked.contains("but"), "{checked}");
        let frame = folder.run(&format!("frame {} --size 40x12", path.display())).text();
        assert!(frame.split_whitespace().count() > 5, "{}:\n{frame}", path.display());
        count += 1;
    }
    assert!(count >= 10, "{count} scenes");
}
