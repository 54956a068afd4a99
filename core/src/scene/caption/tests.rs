use super::*;
use crate::scene::Scene;

#[test]
fn the_lines_of_a_paragraph_are_joined() {
    assert_eq!(displayed_caption("One\n two.\n\n\n Three. \n").as_deref(), Some("One two.\nThree."));
    assert_eq!(displayed_caption("a\x1b[2Jb").as_deref(), Some("a\u{fffd}[2Jb"));
    assert_eq!(displayed_caption(" \n\n"), None);
}

#[test]
fn the_leading_comment_is_the_caption_unless_the_file_has_one() {
    let caption = |text: &str| Scene::from_ron("x.ron", text).expect("a scene").caption().map(ToString::to_string);
    let camera = "camera: (eye: (0, 0, 5), target: (0, 0, 0))";
    let comment = format!("\u{feff}\n// A ball\n// on a floor.\n//\n// Keys: W.\n\n// Not this.\n({camera})");
    assert_eq!(caption(&comment).as_deref(), Some("A ball on a floor.\nKeys: W."));
    assert_eq!(caption(&comment.replace(camera, &format!("caption: \"Mine\", {camera}"))).as_deref(), Some("Mine"));
    assert_eq!(caption(&format!("({camera})")), None);
}

#[test]
fn a_huge_caption_is_cut() {
    let caption = displayed_caption(&"word\n".repeat(1 << 20)).expect("a caption");
    assert!(caption.len() <= 2 * MAX_BYTES, "{}", caption.len());
}
