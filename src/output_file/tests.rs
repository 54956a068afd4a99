use super::*;
use std::os::unix::fs::{PermissionsExt, chown, symlink};
use tempfile::TempDir;

const OLD: &[u8] = b"the old contents";

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder can be made"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Creates a file with the contents [`OLD`], and returns its path.
    fn old(&self, name: &str) -> PathBuf {
        fs::write(self.path(name), OLD).expect("the file can be written");
        self.path(name)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("the file is there")
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder is there").flatten();
        let mut names: Vec<_> = entries.map(|entry| entry.file_name().into_string().expect("a plain name")).collect();
        names.sort();
        names
    }
}

fn begun(path: &Path, contents: &[u8]) -> OutputFile {
    let mut file = OutputFile::create(path).expect("the file can be begun");
    file.write_all(contents).expect("it can be written");
    file
}

fn write(path: &Path, contents: &[u8]) {
    begun(path, contents).finish().expect("it can be finished");
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).expect("the file is there").mode() & 0o7777
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, PermissionsExt::from_mode(mode)).expect("it is our file");
}

#[test]
fn the_old_file_stays_until_the_new_one_is_finished() {
    let folder = Folder::new();
    let old = folder.old("x");
    let file = begun(&old, b"new");
    assert_eq!((folder.read("x").as_slice(), folder.names().len()), (OLD, 2));
    file.finish().expect("it can be finished");
    assert_eq!((folder.read("x").as_slice(), folder.names().len()), (&b"new"[..], 1));
}

#[test]
fn an_unfinished_file_leaves_nothing() {
    let folder = Folder::new();
    for name in ["x", "new"] {
        folder.old("x");
        drop(begun(&folder.path(name), b"new"));
        drop(OutputFile::create_new(&folder.path("other")).expect("it can be begun"));
        assert_eq!((folder.read("x").as_slice(), folder.names()), (OLD, vec!["x".to_owned()]));
    }
}

#[test]
fn a_new_file_has_the_mode_of_the_umask() {
    let folder = Folder::new();
    let usual = folder.old("usual");
    write(&folder.path("x"), b"new");
    let mut file = OutputFile::create_new(&folder.path("y")).expect("it can be begun");
    file.write_all(b"new").and_then(|()| file.finish()).expect("it can be written");
    assert_eq!(["x", "y"].map(|name| mode(&folder.path(name))), [mode(&usual); 2]);
}

#[test]
fn an_existing_file_keeps_owner_and_mode() {
    let folder = Folder::new();
    let file = folder.old("x");
    // Changing the owner succeeds only if the test runs as root.
    let other_owner = chown(&file, Some(1234), Some(2345)).is_ok();
    for expected in [0o640, 0o600, 0o755, 0o4664] {
        set_mode(&file, expected);
        write(&file, b"new");
        let data = fs::metadata(&file).expect("it is there");
        assert_eq!(data.mode() & 0o7777, expected, "{expected:o}");
        assert!(!other_owner || (data.uid(), data.gid()) == (1234, 2345), "{data:?}");
    }
    assert_eq!(folder.names(), ["x"]);
}

#[test]
fn the_temporary_file_of_a_secret_file_is_secret() {
    let folder = Folder::new();
    let file = folder.old("x");
    set_mode(&file, 0o640);
    let _unfinished = begun(&file, b"new");
    let temporary = folder.names().into_iter().find(|name| name != "x").expect("there is one");
    assert_eq!(mode(&folder.path(&temporary)) & 0o077, 0);
}

#[test]
fn symbolic_links_are_followed_and_stay() {
    let folder = Folder::new();
    fs::create_dir(folder.path("below")).expect("a folder can be made");
    folder.old("below/x");
    for (target, link) in [("x", "below/link"), ("below/link", "chain"), ("below/new", "dangling"), ("chain", "longer")]
    {
        symlink(target, folder.path(link)).expect("a link can be made");
    }
    symlink(folder.path("below/x"), folder.path("absolute")).expect("a link can be made");
    for (link, target) in [("longer", "below/x"), ("absolute", "below/x"), ("dangling", "below/new")] {
        write(&folder.path(link), link.as_bytes());
        assert_eq!(folder.read(target), link.as_bytes());
        assert!(fs::symlink_metadata(folder.path(target)).is_ok_and(|data| data.is_file()), "{target}");
    }
    for link in ["below/link", "chain", "dangling", "longer", "absolute"] {
        assert!(fs::symlink_metadata(folder.path(link)).is_ok_and(|data| data.is_symlink()), "{link}");
    }
    assert_eq!(folder.names(), ["absolute", "below", "chain", "dangling", "longer"]);
}

#[test]
fn an_impossible_target_is_refused_at_once() {
    let folder = Folder::new();
    symlink("missing/x", folder.path("nowhere")).expect("a link can be made");
    symlink("loop", folder.path("loop")).expect("a link can be made");
    fs::create_dir(folder.path("folder")).expect("a folder can be made");
    folder.old("x");
    let long = "x".repeat(256);
    for name in ["nowhere", "loop", "folder", "missing/x", "new/", "new/.", "x/", "x/y", "", &long] {
        assert!(OutputFile::create(&folder.path(name)).is_err(), "{name}");
    }
    assert!(OutputFile::create(Path::new("")).is_err());
    assert_eq!(folder.names(), ["folder", "loop", "nowhere", "x"]);
}

/// Checks that a file name of 255 bytes works, to which no suffix for a temporary name could be
/// added.
#[test]
fn a_name_may_have_255_bytes() {
    let folder = Folder::new();
    let name = "x".repeat(255);
    write(&folder.path(&name), b"new");
    assert_eq!(folder.read(&name), b"new");
}

#[test]
fn a_hard_link_is_preserved() {
    let folder = Folder::new();
    let file = folder.old("x");
    fs::hard_link(&file, folder.path("y")).expect("a link can be made");
    for contents in [&b"short"[..], &b"longer than before ".repeat(1000)] {
        write(&file, contents);
        assert_eq!((folder.read("x").as_slice(), folder.read("y").as_slice()), (contents, contents));
    }
    assert_eq!(folder.names(), ["x", "y"]);
}

#[test]
fn streams_are_distinguished_from_files() {
    let folder = Folder::new();
    let is_stream = |path: &Path| open_stream(path).expect("it can be looked at").is_some();
    let file = folder.old("x");
    symlink("/dev/null", folder.path("null")).expect("a link can be made");
    symlink("x", folder.path("link")).expect("a link can be made");
    assert!(is_stream(Path::new("/dev/null")) && is_stream(&folder.path("null")));
    for name in ["x", "link", "new"] {
        assert!(!is_stream(&folder.path(name)), "{name}");
    }
    assert_eq!(folder.read("x"), OLD);
    // A descriptor such as `/dev/fd/3` is a stream even if it refers to a plain file: the process that has opened that
    // file would not see a replacement.
    if cfg!(target_os = "linux") {
        use std::os::fd::AsRawFd;
        let open = File::options().append(true).open(&file).expect("it is there");
        let descriptor = PathBuf::from(format!("/dev/fd/{}", open.as_raw_fd()));
        let mut stream = open_stream(&descriptor).expect("it can be opened").expect("it is a stream");
        stream.write_all(b"new").expect("it can be written");
        assert_eq!(folder.read("x"), b"new");
        assert!(OutputFile::create(&folder.path("null")).is_err(), "a device is not replaced");
    }
}

#[test]
fn a_used_name_is_not_overwritten() {
    let folder = Folder::new();
    folder.old("x");
    symlink("missing", folder.path("dangling")).expect("a link can be made");
    let is_used = |done: io::Result<()>| done.is_err_and(|error| error.kind() == io::ErrorKind::AlreadyExists);
    for name in ["x", "dangling"] {
        assert!(is_used(OutputFile::create_new(&folder.path(name)).map(drop)), "{name}");
    }
    // Another process may also use the name between `create_new` and `finish`.
    let file = OutputFile::create_new(&folder.path("y")).expect("it can be begun");
    folder.old("y");
    assert!(is_used(file.finish()));
    assert_eq!((folder.read("y").as_slice(), folder.names().len()), (OLD, 3));
}

#[test]
fn only_leftovers_of_dead_writers_are_removed() {
    let folder = Folder::new();
    let (first, second) = (begun(&folder.path("x"), b"first"), begun(&folder.path("y"), b"second"));
    let living = folder.names();
    assert_eq!(living.len(), 2);
    folder.old(".termtrace-4194304-0.tmp");
    let unlike = [".termtrace-4194304-00.tmp", ".termtrace-x-0.tmp", ".x.ron.1~", "termtrace-1-0.tmp"];
    for name in unlike {
        folder.old(name);
    }
    fs::create_dir(folder.path(".termtrace-4194304-1.tmp")).expect("a folder can be made");
    symlink("x", folder.path(".termtrace-4194304-2.tmp")).expect("a link can be made");
    // Changing the owner succeeds only if the test runs as root.
    let others = folder.old(".termtrace-4194304-3.tmp");
    let is_others = chown(&others, Some(1234), None).is_ok();
    first.remove_stale();
    second.remove_stale();
    let names = folder.names();
    assert!(living.iter().all(|name| names.contains(name)), "{names:?}");
    assert!(unlike.iter().all(|&name| names.iter().any(|known| known == name)), "{names:?}");
    let left = ["0", "1", "2", "3"].map(|number| names.contains(&format!(".termtrace-4194304-{number}.tmp")));
    assert_eq!(left, [false, true, true, is_others]);
    first.finish().and_then(|()| second.finish()).expect("both are finished");
    assert_eq!((folder.read("x"), folder.read("y")), (b"first".to_vec(), b"second".to_vec()));
}

#[test]
fn the_later_of_two_writers_gets_the_name() {
    let folder = Folder::new();
    for there in [false, true] {
        let file = folder.path("x");
        let (first, second) = (begun(&file, b"the first"), begun(&file, b"2nd"));
        second.finish().expect("it can be finished");
        assert_eq!(folder.read("x"), b"2nd");
        first.finish().expect("it can be finished");
        assert_eq!((folder.read("x"), folder.names().len()), (b"the first".to_vec(), 1), "{there}");
    }
}

/// Checks overwriting, which is used if the folder does not allow a new file.
#[test]
fn writing_in_place_replaces_all_old_bytes() {
    let folder = Folder::new();
    let file = folder.old("x");
    let inode = fs::metadata(&file).expect("it is there").ino();
    for contents in [&b"short"[..], b"", &OLD.repeat(1000)] {
        let mut output = OutputFile { target: file.clone(), destination: Destination::InPlace(Vec::new()) };
        output.write_all(contents).and_then(|()| output.finish()).expect("it can be written");
        assert_eq!(folder.read("x"), contents);
    }
    assert_eq!(fs::metadata(&file).expect("it is there").ino(), inode);
}

#[test]
fn a_secret_is_its_owners_alone() {
    let folder = Folder::new();
    let path = folder.path("secret");
    let mut file = OutputFile::create_new_private(&path).expect("it can be begun");
    file.write_all(b"x").expect("it can be written");
    file.finish().expect("it can be finished");
    assert_eq!(fs::metadata(&path).expect("it is there").permissions().mode() & 0o777, 0o600);
    let again = OutputFile::create_new_private(&path).map(drop).expect_err("the name is used");
    assert_eq!((again.kind(), folder.read("secret")), (io::ErrorKind::AlreadyExists, b"x".to_vec()));
}
