//! `--json`: the fields that scripts rely on.

use super::Folder;
use serde_json::Value;

#[track_caller]
fn json(folder: &Folder, arguments: &str) -> Value {
    let text = folder.run(&format!("{arguments} --json")).text();
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[track_caller]
fn assert_fields(value: &Value, fields: &[&str]) {
    let object = value.as_object().expect("an object");
    let mut names: Vec<_> = object.keys().map(String::as_str).collect();
    let mut expected = fields.to_vec();
    names.sort_unstable();
    expected.sort_unstable();
    assert_eq!(names, expected);
}

#[test]
fn results_have_their_fields() {
    let folder = Folder::new();
    let described = json(&folder, "describe ball.ron");
    assert_fields(&described, &["scene", "camera", "objects", "lights", "lines"]);
    assert_eq!(described["camera"]["eye"], serde_json::json!([1.0, 1.5, 6.0]));
    assert_eq!((described["objects"].as_u64(), described["lights"].as_u64()), (Some(2), Some(1)));

    let pixel = json(&folder, "explain ball.ron --pixel 40,24");
    let fields = ["pixel", "resolution", "q", "origin", "direction", "hit", "light", "color", "lines"];
    assert_fields(&pixel, &fields);
    assert_fields(&pixel["hit"], &["t", "point", "normal"]);
    assert!(json(&folder, "explain ball.ron --pixel 0,0")["hit"].is_null(), "the background");

    let bench = json(&folder, "bench --pixels 64x64 --rounds 2");
    assert_fields(&bench, &["scene", "build_seconds", "tree_bytes", "rounds"]);
    assert_eq!(bench["rounds"].as_array().map(Vec::len), Some(2));
    assert_fields(&bench["rounds"][0], &["rays", "hits", "lit", "depths", "trace_seconds", "frame_seconds", "hash"]);

    let doctor = json(&folder, "doctor");
    assert_fields(&doctor, &["term", "version", "capabilities"]);
    assert_fields(&doctor["capabilities"][0], &["name", "value", "source"]);

    let config = json(&folder, "config --fps 30");
    assert_fields(&config, &["settings", "files"]);
    assert_eq!(config["settings"]["fps"], serde_json::json!({ "value": "30", "source": "--fps" }));
    assert_fields(&config["files"]["config.ron"], &["path", "status"]);
}
