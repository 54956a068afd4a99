use super::*;

#[test]
fn only_exact_names_are_temporary() {
    for (name, expected) in [
        (".termtrace-1-0.tmp", true),
        (".termtrace-4194304-999.tmp", true),
        ("termtrace-1-0.tmp", false),
        (".termtrace-1-0.tmp~", false),
        (".termtrace-1.tmp", false),
        (".termtrace--0.tmp", false),
        (".termtrace-01-0.tmp", false),
        (".termtrace-+1-0.tmp", false),
        (".termtrace-1-0-0.tmp", false),
        (".termtrace-99999999999-0.tmp", false),
        (".termtrace-x-0.tmp", false),
    ] {
        assert_eq!(is_temporary_name(OsStr::new(name)), expected, "{name}");
    }
}

/// Simulates a process that locks or removes a new file, as a leftover, before its creator has
/// locked it.
#[test]
fn a_file_claimed_as_a_leftover_is_not_written() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join(".termtrace-1-0.tmp");
    let made = || File::create_new(&path).expect("the name is unused");
    let removed = made();
    fs::remove_file(&path).expect("it is there");
    assert!(Temporary::lock_new(path.clone(), removed).expect("it can be looked at").is_none());
    let (locked, other) = (made(), File::open(&path).expect("it is there"));
    other.lock().expect("no process has locked it");
    assert!(Temporary::lock_new(path.clone(), locked).expect("it can be looked at").is_none());
    assert!(path.exists(), "the process with the lock removes it");
}
