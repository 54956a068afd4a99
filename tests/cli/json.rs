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
    assert_fields(&described, &["scene", "camera", "objects", "lights", "background"]);
    assert_eq!(described["camera"]["eye"], serde_json::json!([1.0, 1.5, 6.0]));
    let [objects, lights] = ["objects", "lights"].map(|field| described[field].as_array().expect("a list"));
    assert_eq!((objects.len(), lights.len()), (2, 1));
    let of_all = ["number", "kind", "color", "name", "visible", "in_front_of", "behind", "eye_is_inside"];
    assert_fields(&objects[0], &[&of_all[..], &["position", "share", "nearest", "farthest"]].concat());
    assert_eq!((&objects[0]["number"], &objects[0]["kind"]), (&1.into(), &"sphere".into()));
    assert_fields(&lights[0], &["color", "direction", "position"]);
    assert_fields(&described["background"], &["color", "share"]);
    let away = json(&folder, "describe ball.ron --target 1,1.5,60");
    assert_fields(&away["objects"][0], &[&of_all[..], &["reason"]].concat());
    assert_eq!(away["objects"][0]["reason"], "behind the eye");

    let pixel = json(&folder, "explain ball.ron --pixel 40,24");
    let fields =
        ["pixel", "cell", "resolution", "camera", "q", "origin", "direction", "tested", "hit", "light", "color"];
    assert_fields(&pixel, &fields);
    let of_hit = ["name", "t", "point", "normal", "lights", "ambient", "arriving", "reflectance"];
    assert_fields(&pixel["hit"], &of_hit);
    assert_fields(&pixel["hit"]["lights"][0], &["direction", "cosine", "blocker", "arriving"]);
    assert_fields(&pixel["tested"][0], &["name", "t"]);
    assert!(json(&folder, "explain ball.ron --pixel 0,0")["hit"].is_null(), "the background");

    let bench = json(&folder, "bench --pixels 64x64 --rounds 2");
    assert_fields(&bench, &["scene", "build_seconds", "tree_bytes", "rounds"]);
    assert_eq!(bench["rounds"].as_array().map(Vec::len), Some(2));
    assert_fields(&bench["rounds"][0], &["rays", "hits", "lit", "depths", "trace_seconds", "frame_seconds", "hash"]);

    let doctor = json(&folder, "doctor");
    assert_fields(&doctor, &["verdict", "term", "version", "capabilities"]);
    assert_fields(&doctor["capabilities"][0], &["name", "value", "source"]);

    let config = json(&folder, "config --fps 30");
    assert_fields(&config, &["settings", "files"]);
    assert_eq!(config["settings"]["fps"], serde_json::json!({ "value": "30", "source": "--fps" }));
    assert_fields(&config["files"]["config.ron"], &["path", "status"]);
}
