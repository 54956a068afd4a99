//! The laws of the crate's architecture (see the guide in `src/lib.rs`), tested on its source.

#[path = "laws/comments.rs"]
mod comments;
#[path = "laws/language.rs"]
mod language;
#[path = "laws/paths.rs"]
mod paths;

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// All Rust files below a folder, with their text.
fn rust_files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("the entry can be read").path();
        if path.is_dir() {
            // The fuzz targets and the bench against Embree are packages of their own, with build folders of their own.
            if !path.ends_with("target") {
                files.extend(rust_files(&path));
            }
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&path).expect("source is UTF-8");
            files.push((path, text));
        }
    }
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the folders of the library's source: the tracer's, and that of the crate around it.
fn source_folders() -> [PathBuf; 2] {
    ["core/src", "src"].map(|folder| root().join(folder))
}

/// Returns all Rust files of [`source_folders`], with their text.
fn source_files() -> Vec<(PathBuf, String)> {
    source_folders().iter().flat_map(|folder| rust_files(folder)).collect()
}

/// Returns a file's path below its folder of [`source_folders`].
fn path_in_crate(path: &Path) -> &Path {
    let [core, src] = source_folders();
    path.strip_prefix(core).or_else(|_| path.strip_prefix(src)).expect("below a folder of source")
}

/// Returns the library's files: all source but the binary's and that compiled for tests only.
fn library_files() -> Vec<(PathBuf, String)> {
    let binary = |path: &Path| {
        let first = path_in_crate(path).iter().next().expect("a name");
        ["main.rs", "cli.rs", "cli"].iter().any(|name| first == *name)
    };
    let files: Vec<_> = source_files().into_iter().filter(|(path, _)| !binary(path)).collect();
    let tests: Vec<_> = files.iter().flat_map(|(path, text)| test_files(path, text)).collect();
    files.into_iter().filter(|(path, _)| !tests.contains(path)).collect()
}

/// The attributes of items that only tests have.
///
/// The published package does not have those with `unit_tests`.
const TEST_ONLY: [&str; 2] = ["#[cfg(test)]", "#[cfg(all(test, unit_tests))]"];

/// The files of the modules that this one has for tests only.
fn test_files(path: &Path, text: &str) -> Vec<PathBuf> {
    let pairs = text.lines().zip(text.lines().skip(1)).filter(|(attribute, _)| TEST_ONLY.contains(attribute));
    let names =
        pairs.filter_map(|(_, module)| module.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'));
    names.map(|name| path.with_extension("").join(name).with_extension("rs")).collect()
}

/// The modules of both `lib.rs` in their order: those of the tracer go first.
fn route() -> Vec<String> {
    let libs = source_folders().map(|folder| fs::read_to_string(folder.join("lib.rs")).expect("lib.rs is there"));
    let lines = libs.iter().flat_map(|lib| lib.lines());
    let modules = lines.filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'));
    modules.map(str::to_owned).collect()
}

/// The top-level module that a file belongs to: `src/shape/plane.rs` to `shape`.
fn stage(path: &Path) -> String {
    let first = path_in_crate(path).iter().next().expect("a name").to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// Returns whether a path such as `super::x` in this file starts at the crate's root.
fn is_top_level(path: &Path) -> bool {
    source_folders().iter().any(|folder| path.parent() == Some(folder))
}

/// The text without comments and without what is compiled for tests only.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let trimmed = line.trim_start();
        if TEST_ONLY.iter().any(|attribute| trimmed.starts_with(attribute)) || trimmed.starts_with("#[cfg(doctest)]") {
            skip_item(&mut lines);
        } else if !trimmed.starts_with("//") {
            code.push_str(line.split(" // ").next().unwrap_or(line));
            code.push('\n');
        }
    }
    code
}

/// Passes over an item: to its semicolon, or to the brace that closes it.
fn skip_item<'a>(lines: &mut impl Iterator<Item = &'a str>) {
    let mut depth = 0;
    for line in lines {
        depth += line.matches('{').count();
        depth -= line.matches('}').count();
        if depth == 0 && (line.contains('}') || line.trim_end().ends_with(';')) {
            return;
        }
    }
}

/// The first names after each `prefix` (such as `crate::`): one, or those of a brace.
fn names_after(code: &str, prefix: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        // `super::` inside `super::super::` is found by its own prefix, and an identifier may end in "crate".
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        match rest.strip_prefix('{') {
            Some(group) => names.extend(first_names_of_group(group)),
            None if rest.starts_with('*') => drop(names.insert("*".to_owned())),
            None => names.extend(identifier(rest)),
        }
    }
    names
}

fn identifier(text: &str) -> Option<String> {
    let name: String = text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    (!name.is_empty()).then_some(name)
}

/// Returns the first names of a group: of `a::b, c::{d, e}, f}` the names a, c and f.
fn first_names_of_group(group: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut depth = 0;
    let mut at_start = true;
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => at_start = true,
            c if at_start && !c.is_whitespace() => {
                names.extend(identifier(&group[at..]).or((c == '*').then(|| c.to_string())));
                at_start = false;
            }
            _ => {}
        }
    }
    names
}

/// Everything of the crate's root that a file names.
fn named(path: &Path, text: &str) -> BTreeSet<String> {
    let code = code(text);
    let mut names = names_after(&code, "crate::");
    names.extend(names_after(&code, if is_top_level(path) { "super::" } else { "super::super::" }));
    names
}

/// The ways back in a set of files: (file's stage, what it names).
fn ways_back(route: &[String], files: &[(PathBuf, String)]) -> Vec<String> {
    let place = |name: &str| route.iter().position(|module| module == name);
    let mut back = Vec::new();
    for (path, text) in files {
        let Some(here) = place(&stage(path)) else { continue };
        for name in named(path, text) {
            match place(&name) {
                None if name == "*" => back.push(format!("{} takes everything at the root", path.display())),
                Some(there) if there <= here => {}
                Some(_) => back.push(format!("{} uses {name}, which comes after it", path.display())),
                None => back.push(format!("{} uses crate::{name}, which is no module of lib.rs", path.display())),
            }
        }
    }
    back
}

/// Law 1.
#[test]
fn a_module_uses_only_what_stands_above_it() {
    let route = route();
    assert!(route.len() > 20, "the route was read: {route:?}");
    let files = library_files();
    assert!(files.len() > 30, "the library was read");
    let back = ways_back(&route, &files);
    assert!(back.is_empty(), "{}", back.join("\n"));
}

/// The public modules of the route. `lib.rs` re-exports the promised names of all others.
const PUBLIC: [&str; 4] = ["export", "live", "prelude", "internals"];

/// The crates whose types are in promised signatures.
const REEXPORTED_CRATES: [&str; 2] = ["glam", "ratatui_core"];

/// The crate's root has the modules of the route, in which every file is, and names from them.
#[test]
fn the_root_holds_the_route_and_names_from_it() {
    let route: BTreeSet<_> = route().into_iter().collect();
    let stages: BTreeSet<_> =
        library_files().iter().map(|(path, _)| stage(path)).filter(|name| name != "lib").collect();
    assert_eq!(stages, route);
    let lib = fs::read_to_string(root().join("src/lib.rs")).expect("lib.rs is there");
    assert_eq!(strangers(&route, &code(&lib)), [""; 0], "lib.rs says more than its modules and the names it promises");
    let core = fs::read_to_string(root().join("core/src/lib.rs")).expect("the tracer's lib.rs is there");
    let is_module = |line: &&str| line.starts_with("mod ") || line.starts_with("pub mod ");
    let core = code(&core);
    let strangers: Vec<_> =
        core.lines().filter(|line| !line.is_empty() && !line.starts_with('#') && !is_module(line)).collect();
    assert_eq!(strangers, [""; 0], "the tracer's lib.rs says more than its modules");
}

/// Returns the items of `lib.rs` that are neither modules of the route nor names of one.
///
/// Modules are private but for those of [`PUBLIC`].
fn strangers(route: &BTreeSet<String>, lib: &str) -> Vec<String> {
    let is_module = |item: &str| match item.strip_prefix("pub mod ") {
        Some(name) => PUBLIC.contains(&name),
        None => item.strip_prefix("mod ").is_some_and(|name| !PUBLIC.contains(&name)),
    };
    let are_names = |item: &str| {
        item.strip_prefix("pub use ").is_some_and(|path| match path.split_once("::") {
            Some((module, names)) => route.contains(module) && module != "internals" && !names.contains(['*', ':']),
            None => REEXPORTED_CRATES.contains(&path),
        })
    };
    let is_tracer = |item: &str| item.starts_with("use termtrace_core::");
    let is_message = |item: &str| item.starts_with("compile_error!(");
    let is_attribute = |line: &&str| line.trim_start().starts_with("#[") || line.trim_start().starts_with("#![");
    let code: Vec<_> = lib.lines().filter(|line| !is_attribute(line)).collect();
    let code = code.join("\n");
    let items = code.split(';').map(str::trim).filter(|item| !item.is_empty());
    items
        .filter(|item| !is_module(item) && !are_names(item) && !is_tracer(item) && !is_message(item))
        .map(str::to_owned)
        .collect()
}

/// The test above can fail.
#[test]
fn strangers_at_the_root_are_found() {
    let route = ["color", "export", "internals"].map(str::to_owned).into();
    let found = |lib: &str| strangers(&route, lib).len();
    assert_eq!(found("#[doc(hidden)]\npub mod internals;\nmod color;\npub use color::{\n    A,\n    B,\n};\n"), 0);
    assert_eq!(found("#[cfg(not(unix))]\ncompile_error!(\"no\");\npub mod export;\npub use glam;\n"), 0);
    assert_eq!(found("pub mod color;\nmod export;\nmod internals;\n"), 3);
    assert_eq!(
        found("pub use color::*;\npub use internals::A;\npub use png;\npub use std::fmt;\npub use color::a::B;"),
        5
    );
    assert_eq!(found("use color::A;\nfn f() {}\npub use color::B;\nstruct C;"), 3);
}

/// The files of one folder form no cycle either: (file's folder and name, siblings that it names).
fn sibling_cycles(files: &[(PathBuf, String)]) -> Vec<String> {
    let key = |path: &Path| (path.parent().map(Path::to_owned), path.file_stem().map(OsStr::to_owned));
    let siblings: BTreeSet<_> = files.iter().map(|(path, _)| key(path)).collect();
    let uses = |path: &Path, text: &str| -> Vec<_> {
        let named = names_after(&code(text), "super::").into_iter().map(|name| (key(path).0, Some(name.into())));
        named.filter(|sibling| siblings.contains(sibling) && *sibling != key(path)).collect()
    };
    let nested = files.iter().filter(|(path, _)| !is_top_level(path));
    let uses: BTreeMap<_, Vec<_>> = nested.map(|(path, text)| (key(path), uses(path, text))).collect();
    let reaches = |from| {
        let (mut seen, mut left) = (BTreeSet::new(), vec![from]);
        while let Some(file) = left.pop() {
            left.extend(uses.get(file).into_iter().flatten().filter(|&next| seen.insert(next)));
        }
        seen
    };
    let cyclic = uses.keys().filter(|&file| reaches(file).contains(file));
    cyclic.map(|(folder, name)| format!("{folder:?} {name:?} is in a cycle of siblings")).collect()
}

#[test]
fn the_files_of_a_folder_form_no_cycle() {
    let cycles = sibling_cycles(&library_files());
    assert!(cycles.is_empty(), "{}", cycles.join("\n"));
}

/// The test above can fail.
#[test]
fn cycles_of_siblings_are_found() {
    let found = |files: &[(&str, &str)]| {
        let files = files.iter().map(|(file, text)| (root().join("src").join(file), (*text).to_owned()));
        sibling_cycles(&files.collect::<Vec<_>>()).len()
    };
    let [a, b, c] = ["encode/a.rs", "encode/b.rs", "encode/c.rs"];
    assert_eq!(found(&[(a, "use super::b;"), (b, "use super::a::{x, y};"), (c, "use super::a;")]), 2);
    assert_eq!(found(&[(a, "use super::b;"), (b, "use super::{c, x};"), (c, "fn f() { super::a::x() }")]), 3);
    assert_eq!(found(&[(a, "use super::{b, c};"), (b, "use super::c;"), (c, "use super::x;")]), 0);
    assert_eq!(found(&[(a, "use super::b;"), ("encode/d/b.rs", "use super::a;"), (b, "")]), 0);
}

/// Returns parents and children that both name more than types of each other.
///
/// As (parent's file, child's name). Neither could be understood before the other. A child may use the types of its
/// parent, or the parent those of the child.
fn knots(files: &[(PathBuf, String)]) -> Vec<String> {
    let codes: BTreeMap<_, _> = files.iter().map(|(path, text)| (path.as_path(), code(text))).collect();
    let children = codes.iter().filter_map(|(&path, code)| {
        let parent = path.parent()?.with_extension("rs");
        Some((codes.get_key_value(parent.as_path())?, path.file_stem()?.to_str()?, code))
    });
    let knotted = children.filter_map(|((parent, of_parent), child, of_child)| {
        let up = names_after(of_child, "super::").into_iter().any(|name| !is_type(&name) && defines(of_parent, &name));
        let (exports, body) = exports(of_parent);
        let inside = format!("{child}::");
        let exported = names_after(&exports, &inside);
        let used = |name: &String| body.split(|c: char| !is_part_of_name(c)).any(|word| word == name);
        let mut down = names_after(&body, &inside);
        down.extend(exported.into_iter().filter(used));
        (up && down.iter().any(|name| !is_type(name))).then(|| format!("{} and its {child}", parent.display()))
    });
    knotted.collect()
}

fn is_part_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Returns whether a name is written as those of types are.
fn is_type(name: &str) -> bool {
    name.starts_with(char::is_uppercase) && (name.len() == 1 || name.contains(char::is_lowercase))
}

/// Returns whether code has a top-level item of that name that is no type and no module.
fn defines(code: &str, name: &str) -> bool {
    let items = code.lines().filter(|line| !line.starts_with(char::is_whitespace));
    let mut names = items.filter_map(|item| {
        let kinds = ["fn ", "const ", "static ", "macro_rules! "];
        let (_, rest) = kinds.iter().find_map(|kind| item.split_once(kind))?;
        identifier(rest)
    });
    names.any(|defined| defined == name)
}

/// The re-exports of a file, and all the rest.
fn exports(code: &str) -> (String, String) {
    let (mut exports, mut rest, mut in_export) = (String::new(), String::new(), false);
    // The declaration of a module uses no function of its name.
    for line in code.lines().filter(|line| !line.starts_with("mod ")) {
        in_export |= line.starts_with("pub") && line.contains(" use ");
        let to = if in_export { &mut exports } else { &mut rest };
        to.push_str(line);
        to.push('\n');
        in_export &= !line.ends_with(';');
    }
    (exports, rest)
}

#[test]
fn between_parent_and_child_only_types_go_one_of_the_ways() {
    let knots = knots(&source_files());
    assert!(knots.is_empty(), "{}", knots.join("\n"));
}

/// The test above can fail.
#[test]
fn knots_of_parent_and_child_are_found() {
    let found = |parent: &str, child: &str| {
        let files = [("cell.rs", parent), ("cell/half.rs", child)];
        knots(&files.map(|(file, text)| (root().join("src").join(file), text.to_owned()))).len()
    };
    let parent = "mod half;\nfn f() { half::fill() }\nfn g() {}\nconst GAP: u8 = 1;\nstruct Pair;";
    assert_eq!(found(parent, "use super::g;"), 1);
    assert_eq!(found(parent, "use super::{Pair, GAP};"), 1);
    assert_eq!(found(parent, "fn fill() { super::g() }"), 1);
    assert_eq!(found("pub use half::fill;\nfn f() { fill() }\nfn g() {}", "use super::g;"), 1);
    assert_eq!(found("pub use half::fill;\nfn g() {}", "use super::g;"), 0);
    assert_eq!(found("mod half;\npub use half::half;\nfn g() {}", "use super::g;"), 0);
    assert_eq!(found(parent, "use super::Pair;"), 0);
    assert_eq!(found("mod half;\nimpl A {\n    fn g() { half::fill() }\n}", "use super::g;"), 0, "a sibling");
    assert_eq!(found("mod half;\nfn f() -> half::Half {}\nfn g() {}", "use super::g;"), 0);
    assert_eq!(found(parent, "#[cfg(test)]\nmod tests {\n    use super::g;\n}"), 0);
}

/// The test above can fail: planted ways back are found, and what only looks like one is not.
#[test]
fn ways_back_are_found() {
    let route = ["color", "shape", "scene", "app"].map(str::to_owned);
    let found =
        |file: &str, text: &str| !ways_back(&route, &[(root().join("src").join(file), text.to_owned())]).is_empty();
    assert!(found("shape.rs", "use crate::scene::Scene;"));
    assert!(found("shape.rs", "fn f() { crate::app::run() }"));
    assert!(found("shape.rs", "use super::scene;"));
    assert!(found("shape.rs", "use super::*;\nfn f(_: scene::Scene) {}"));
    assert!(found("shape.rs", "use crate::{color::Srgb8, *};"));
    assert!(found("shape/plane.rs", "use crate::*;"));
    assert!(found("shape/plane.rs", "use super::super::scene;"));
    assert!(found("shape/plane.rs", "use crate::{\n    color::{LinearRgb, Srgb8},\n    scene::Scene,\n};"));
    assert!(found("color.rs", "#[cfg(test)]\nmod tests { }\nuse crate::shape;"));
    assert!(!found("scene.rs", "use crate::{color::Srgb8, shape::{self, Shape}};"));
    assert!(!found("shape/plane.rs", "use super::Surface;"));
    let shape = root().join("src/shape.rs");
    for attribute in TEST_ONLY {
        let text = format!("mod a;\n{attribute}\nmod b;\nmod c;");
        assert_eq!(test_files(&shape, &text), [root().join("src/shape/b.rs")]);
    }
    assert!(!found(
        "shape.rs",
        "/// See [`crate::scene`].\n#[cfg(test)]\nmod tests {\n    use crate::scene::Scene;\n}"
    ));
}

/// The modules of rustix with which `named_file` opens files and waits for pipes.
const FOR_FILES: [&str; 3] = ["rustix::event::", "rustix::fs::", "rustix::io::"];

/// The parts of rustix with which `serve` uses sockets and waits for signals; it also reads CPU
/// times, and lowers the priority of threads.
const FOR_SOCKETS: [&str; 4] = ["rustix::event::", "rustix::net::", "rustix::process::nice(", "rustix::time::"];

/// Only the server uses its protocol and its runtime.
#[test]
fn only_the_server_names_its_crates() {
    for (path, text) in library_files().iter().filter(|(path, _)| stage(path) != "serve") {
        let code = code(text);
        assert!(!["tokio::", "russh::", "proxy_header::"].iter().any(|name| code.contains(name)), "{}", path.display());
    }
}

/// Laws 5 and 7: only `terminal` uses the terminal and signals; the library neither prints nor
/// exits.
#[test]
fn the_operating_systems_terminal_has_one_owner() {
    for (path, text) in library_files() {
        let mut code = code(&text);
        for word in ["println!", "eprint", "print!(", "process::exit", "process::abort", "std::env::"] {
            assert!(!code.contains(word), "{} has {word}", path.display());
        }
        if stage(&path) == "named_file" {
            code = FOR_FILES.iter().fold(code, |code, module| code.replace(module, ""));
        }
        if stage(&path) == "serve" {
            code = FOR_SOCKETS.iter().fold(code, |code, module| code.replace(module, ""));
        }
        if stage(&path) != "terminal" {
            // Locks of files and the right to write them are no terminal's.
            let code = if stage(&path) == "output_file" { without_file_calls(&code) } else { code };
            for word in ["rustix::", "signal_hook", "io::stdin", "io::stdout", "set_hook", "crossterm::terminal"] {
                assert!(!code.contains(word), "{} has {word}", path.display());
            }
        }
    }
}

/// Signs of code for some operating systems only.
const OF_A_SYSTEM: [&str; 7] =
    ["std::os::", "rustix::", "nix::", "signal_hook", "cfg(unix", "cfg(windows", "target_os"];

/// Returns whether a file is compiled with `live` only, or with a feature that implies it or is
/// implied by it alone: `serve` and the tracer's `posix`.
///
/// The attribute may be that of its module or of one around it.
fn is_live_only(path: &Path) -> bool {
    let folder = path.parent().expect("a file is in a folder");
    let is_top = is_top_level(path);
    let parent = if is_top { folder.join("lib.rs") } else { folder.with_extension("rs") };
    let name = path.file_stem().and_then(OsStr::to_str).expect("names are UTF-8");
    let declarations = [("live", "mod "), ("live", "pub mod "), ("serve", "mod "), ("posix", "mod ")]
        .map(|(feature, start)| format!("\n#[cfg(feature = \"{feature}\")]\n{start}{name};\n"));
    let text = fs::read_to_string(&parent).expect("the parent is there");
    declarations.iter().any(|declaration| text.contains(declaration)) || !is_top && is_live_only(&parent)
}

/// Without the feature `live` the library is for every system with Rust's standard library.
#[test]
fn only_the_live_view_is_tied_to_a_system() {
    let files = library_files();
    for (path, text) in files.iter().filter(|(path, _)| stage(path) != "lib" && !is_live_only(path)) {
        let code = code(text);
        for word in OF_A_SYSTEM {
            assert!(!code.contains(word), "{} has {word}, and does not stand behind `live`", path.display());
        }
    }
    let is_live_only = |file: &str| is_live_only(&root().join(file));
    assert!(["src/app.rs", "src/terminal/signals.rs", "core/src/named_file/posix.rs"].into_iter().all(is_live_only));
    let portable = ["src/grid.rs", "core/src/scene.rs", "core/src/named_file.rs", "core/src/named_file/plain.rs"];
    assert!(!portable.into_iter().any(is_live_only));
}

/// The modules of a session that need no terminal, file or clock.
///
/// They are told the time, and driven by a terminal, a server or a test alike.
const PURE: [&str; 5] = ["input", "protocol", "pace", "control", "viewer"];

#[test]
fn modules_of_a_session_use_no_system_and_no_clock() {
    let files = library_files();
    for module in PURE {
        assert!(files.iter().any(|(path, _)| stage(path) == module), "there is no {module}");
    }
    for (path, text) in files.iter().filter(|(path, _)| PURE.contains(&&*stage(path))) {
        let found = impure_words(&code(text));
        assert!(found.is_empty(), "{} names {found:?}", path.display());
    }
    assert_eq!(impure_words("use std::{fmt, fs};\nuse std::time::{Duration, Instant};"), ["fs", "Instant"]);
    assert_eq!(impure_words("std::thread::spawn(f); std::time::SystemTime::now()"), ["thread", "SystemTime"]);
}

/// The modules in which each piece of state has one owner.
const OWNED: [&str; 6] = ["input", "protocol", "pace", "control", "viewer", "app"];

/// A field is assigned in the file that defines its type only: its changes are to be read there.
#[test]
fn a_field_is_assigned_in_the_file_of_its_type() {
    let files = library_files();
    for (path, text) in files.iter().filter(|(path, _)| OWNED.contains(&&*stage(path))) {
        let code = code(text);
        let foreign = foreign_assignments(&code);
        assert!(foreign.is_empty(), "{} assigns {foreign:?}", path.display());
    }
    let own =
        "struct A {\n    b: u8,\n}\nimpl A {\n    fn f(&mut self) {\n        self.b = 1;\n        self.c.b |= 2;\n";
    assert_eq!(foreign_assignments(own), [""; 0]);
    let foreign = "impl A {\n    fn f(&mut self, b: u8) {\n        self.b = 1;\n        self.c.d |= self.e == 2;\n";
    assert_eq!(foreign_assignments(foreign), ["self.b", "self.c.d"]);
}

/// The fields of `self`, or of what it has, that code assigns and no type in it has.
fn foreign_assignments(code: &str) -> Vec<&str> {
    let is_name = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_');
    let (mut fields, mut in_struct) = (BTreeSet::new(), false);
    for line in code.lines() {
        if line.contains("struct ") && line.ends_with('{') {
            in_struct = true;
        } else if line == "}" {
            in_struct = false;
        }
        let name = line.split_once(": ").and_then(|(name, _)| name.rsplit(' ').next());
        fields.extend(name.filter(|name| in_struct && is_name(name)));
    }
    let assigned = code.lines().filter_map(|line| {
        let (place, value) = line.trim_start().split_once(' ')?;
        let operator = value.split(' ').next()?;
        let assigns = operator.ends_with('=') && !["==", "!=", "<=", ">="].contains(&operator);
        (assigns && place.starts_with("self.") && place.split('.').all(is_name)).then_some(place)
    });
    assigned.filter(|place| !place.rsplit('.').next().is_some_and(|field| fields.contains(field))).collect()
}

/// Returns the names of the operating system and its clocks in code.
fn impure_words(code: &str) -> Vec<&'static str> {
    let of_std = names_after(code, "std::");
    let modules = ["fs", "env", "thread", "net", "process", "io"].into_iter().filter(|&name| of_std.contains(name));
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let clocks =
        ["Instant", "SystemTime"].into_iter().filter(|&name| code.split(|c| !is_word(c)).any(|word| word == name));
    modules.chain(clocks).collect()
}

fn without_file_calls(code: &str) -> String {
    ["rustix::fs::", "rustix::io::"].iter().fold(code.to_owned(), |code, word| code.replace(word, ""))
}

/// Law 8: what one module promises holds for all files that are written.
#[test]
fn files_are_written_by_one_module() {
    let words = ["File::create", "fs::write", "create_new(", "create(true)", "truncate(true)", "fs::rename"];
    let files = source_files();
    let tests: Vec<_> = files.iter().flat_map(|(path, text)| test_files(path, text)).collect();
    for (path, text) in files.iter().filter(|(path, _)| !tests.contains(path)) {
        let code = code(text).replace("OutputFile::create", "");
        if stage(path) != "output_file" {
            for word in words {
                assert!(!code.contains(word), "{} has {word}", path.display());
            }
        }
    }
}

/// Only the modules of the CPU's instructions may allow unsafe code, which the manifest denies.
#[test]
fn only_simd_has_unsafe_code() {
    let allowed = concat!("allow(unsafe", "_code)");
    let folders = ["core/src", "src", "tests", "benches", "examples"].map(|folder| root().join(folder));
    for (path, text) in folders.iter().filter(|folder| folder.exists()).flat_map(|folder| rust_files(folder)) {
        let is_simd = path.ends_with("src/simd.rs") || path.parent().is_some_and(|folder| folder.ends_with("src/simd"));
        assert_eq!(text.contains(allowed), is_simd, "{} and {allowed}", path.display());
    }
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("the manifest is there");
    assert!(manifest.contains("unsafe_code = \"deny\""));
}
