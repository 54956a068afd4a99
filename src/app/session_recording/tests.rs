use super::*;

const SIZE: Size = Size::new(40, 12);

fn lines(path: &Path) -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string(path).expect("the file is there");
    assert!(text.ends_with('\n'));
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn frames_are_events_with_their_times() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let seconds = Duration::from_secs;
    let mut recording = SessionRecording::start(folder.path(), "ball", SIZE, seconds(10)).expect("it starts");
    recording.add(b"one", SIZE, seconds(11)).expect("written");
    recording.add(b"", SIZE, seconds(12)).expect("written");
    // The two seconds in which another program had the terminal are left out.
    recording.skip(seconds(12), seconds(14));
    recording.add("\u{1b}[m▄".as_bytes(), Size::new(50, 20), seconds(16)).expect("written");
    assert_eq!(recording.finish(seconds(18)).expect("written"), "ball.cast");
    let expected = [
        serde_json::json!({"version": 2, "width": 40, "height": 12}),
        serde_json::json!([0.0, "o", BEGIN]),
        serde_json::json!([1.0, "o", "one"]),
        serde_json::json!([4.0, "r", "50x20"]),
        serde_json::json!([4.0, "o", "\u{1b}[m▄"]),
        serde_json::json!([6.0, "o", END]),
    ];
    assert_eq!(lines(&folder.path().join("ball.cast")), expected);
}

/// A recording that is dropped because of a signal or an error still gets its last event and name.
#[test]
fn a_dropped_recording_is_whole_and_replaces_nothing() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::write(folder.path().join("ball.cast"), "mine").expect("a file can be written");
    let mut recording = SessionRecording::start(folder.path(), "ball", SIZE, Duration::ZERO).expect("it starts");
    recording.add(b"one", SIZE, Duration::from_secs(1)).expect("written");
    drop(recording);
    assert_eq!(lines(&folder.path().join("ball-2.cast")).last(), Some(&serde_json::json!([1.0, "o", END])));
    assert_eq!(std::fs::read_to_string(folder.path().join("ball.cast")).expect("it is there"), "mine");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder is there").count(), 2, "no temporary file is left");
}
