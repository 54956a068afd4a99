use super::*;

#[test]
fn only_relative_paths_are_local() {
    let local = |written| local_path(Path::new("a"), written);
    assert_eq!(local("./b.mtl"), local("b.mtl"));
    assert_eq!(local("b.mtl"), Ok(PathBuf::from("a/b.mtl")));
    assert_eq!(local(r"..\textures\b c.png"), Ok(PathBuf::from("a/../textures/b c.png")));
    for written in [
        "",
        ".",
        "./",
        "a/..",
        "/etc/x",
        r"C:\x",
        "c:x",
        "http://x/y",
        "file:///x",
        "DATA:,x",
        "a\0b",
        &"a/".repeat(128),
        r"\\host\x",
    ] {
        assert!(local(written).is_err(), "{written}");
    }
}
