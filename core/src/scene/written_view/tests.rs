use super::*;
use crate::scene::Scene;

const VIEW: &str = "(eye: (3, 1, 2), target: (0, 0, 0))";

/// Adds a view to the scene `text`, in which `C` stands for a camera, `V` for a view, and `+` for
/// the added view.
fn with_added_view(text: &str) -> String {
    let camera = *Scene::from_ron("x", "(camera: (eye: (3, 1, 2), target: (0, 0, 0)))").expect("a scene").camera();
    let text = text
        .replace('C', "camera: (eye: (0, 0, 5), target: (0, 0, 0))")
        .replace('V', "(eye: (0, 1, 5), target: (0, 0, 0))");
    let before = Scene::from_ron("x", &text).expect("a scene");
    let written = with_view(&text, &camera).expect("it is a scene");
    let scene = Scene::from_ron("x", &written).expect("it still is");
    assert_eq!(scene.views().split_last(), Some((&camera, before.views())), "{written}");
    assert_eq!(scene.with_views(before.views().to_vec()), before);
    let short = written.replace("camera: (eye: (0, 0, 5), target: (0, 0, 0))", "C").replace(VIEW, "+");
    short.replace("(eye: (0, 1, 5), target: (0, 0, 0))", "V")
}

#[test]
fn all_else_stays_as_it_is() {
    for (text, wanted) in [
        ("(C)", "(C, views: [+])"),
        ("(C,)", "(C, views: [+],)"),
        ("(C, shadows: true)", "(C, views: [+], shadows: true)"),
        ("(C /* , */ , // so\n)", "(C /* , */ , // so\nviews: [\n    +,\n],\n)"),
        ("(\n    C // so\n)\n", "(\n    C, // so\n    views: [\n        +,\n    ],\n)\n"),
        ("(\r\n\tC,\r\n)", "(\r\n\tC,\r\n\tviews: [\r\n\t    +,\r\n\t],\r\n)"),
        ("(views: [], C)", "(views: [+], C)"),
        ("(C, views: [V])", "(C, views: [V, +])"),
        ("(C, views: (V, /* ] */ V, ))", "(C, views: (V, /* ] */ V, +, ))"),
        ("(C, views: [\n    V\n])", "(C, views: [\n    V,\n    +,\n])"),
        (
            "(C, views: [\n  V, // a\n  V, // b, c\n  // d\n])",
            "(C, views: [\n  V, // a\n  V, // b, c\n  // d\n  +,\n])",
        ),
        ("(C, views: [\n  V /* /* , */ */ // b\n])", "(C, views: [\n  V, /* /* , */ */ // b\n  +,\n])"),
        ("(C, views: [\n    // none yet\n])", "(C, views: [\n    // none yet\n    +,\n])"),
        ("// \"é\" ☃\nScene(C, ambient: 1)", "// \"é\" ☃\nScene(C, views: [+], ambient: 1)"),
    ] {
        assert_eq!(with_added_view(text), wanted, "{text}");
        // Checks that a second view can be added to the text in which the first was inserted.
        with_added_view(&wanted.replace('+', "V"));
    }
}

#[test]
fn text_that_is_no_scene_stays_as_it_is() {
    let camera = *Scene::from_ron("x", "(camera: (eye: (3, 1, 2), target: (0, 0, 0)))").expect("a scene").camera();
    for text in ["", "(", "5", "()", "(1, 2)", "(keyframes: [])", "(camera: 5, views: 5)", "(views: None)"] {
        assert_eq!(with_view(text, &camera), None, "{text}");
    }
}
