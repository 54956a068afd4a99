//! `describe`: a scene in words.

use super::Folder;

#[test]
fn a_scene_is_described_in_words() {
    let folder = Folder::new();
    let text = folder.run("describe ball.ron").text();
    assert!(text.starts_with("ball.ron: 2 objects and 1 light, seen from (1, 1.5, 6) towards (0, 0.7, 0)"), "{text}");
    for words in ["a red sphere of radius 1", "an endless light grey and dark grey checkered plane", "Lights,"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert_eq!(folder.run("describe ball.ron --threads 1").text(), text);
    // The description is of the camera's view.
    let behind = folder.run("describe ball.ron --eye 0,1,-5 --target 0,1,-9").text();
    assert!(behind.contains("Not seen:\n- object 1, a red sphere of radius 1: behind the eye"), "{behind}");
    let narrow = folder.run("describe ball.ron --size 20x60").text();
    assert!(narrow != text, "the picture of another shape");
}

#[test]
fn invalid_sizes_and_scenes_are_rejected() {
    let folder = Folder::new();
    for flags in
        ["ball.ron --size 0x5", "ball.ron --size 60000x60000", "none.ron", "ball.ron --eye 0,0.7,0 --target 0,0.7,0"]
    {
        let run = folder.run(&format!("describe {flags}"));
        assert_eq!((run.code, run.stdout.len()), (Some(2), 0), "{flags}: {}", run.stderr);
    }
}
