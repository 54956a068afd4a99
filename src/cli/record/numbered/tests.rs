use super::*;

fn files(name: &str) -> Option<[String; 3]> {
    let numbered = NumberedFiles::parse(Path::new(name)).ok()?;
    Some([1, 42, 123_456].map(|number| numbered.file(number).display().to_string()))
}

#[test]
fn the_number_goes_where_printf_would_write_it() {
    for (name, expected) in [
        ("frame-%04d.png", ["frame-0001.png", "frame-0042.png", "frame-123456.png"]),
        ("%d.png", ["1.png", "42.png", "123456.png"]),
        ("a/%03d/x.png", ["a/001/x.png", "a/042/x.png", "a/123456/x.png"]),
        ("100%%-%01d-%%d.png", ["100%-1-%d.png", "100%-42-%d.png", "100%-123456-%d.png"]),
    ] {
        assert_eq!(files(name), Some(expected.map(str::to_owned)), "{name}");
    }
}

#[test]
fn other_forms_are_turned_away() {
    for name in
        ["x.png", "%s.png", "%4d.png", "%-4d.png", "%0d.png", "%00d.png", "%099d.png", "%d%d.png", "%", "%d%", "%%d"]
    {
        assert_eq!(files(name), None, "{name}");
    }
}
