use super::*;

#[test]
fn only_relative_paths_are_local() {
    let local = |reference| side_file_path(Path::new("a"), reference);
    assert_eq!(local("./b.mtl"), local("b.mtl"));
    assert_eq!(local("b.mtl"), Ok(PathBuf::from("a/b.mtl")));
    assert_eq!(local(r"..\textures\b c.png"), Ok(PathBuf::from("a/../textures/b c.png")));
    for absolute in ["/etc/x", r"C:\art\x", "c:x", r"\\host\x", "\"x\""] {
        assert_eq!(local(absolute), Ok(PathBuf::from("a/x")), "{absolute}");
    }
    for written in ["", ".", "./", "a/..", "http://x/y", "file:///x", "DATA:,x", "a\0b", "C:\\", &"a/".repeat(128)] {
        assert!(local(written).is_err(), "{written}");
    }
}
