//! Hashes of pictures: the same bits on any number of threads, in any build, on any machine.
//!
//! `tests/hashes.txt` has a hash of the light of every scene in `benches/scenes` (before tone and rounding, which would
//! hide a wrong last bit). `BLESS=1 cargo test --test pictures hashes` writes it anew. Both builds are held to this one file.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use termtrace::internals::render::{Executor, render_by};
use termtrace::{Framebuffer, LinearRgb, Resolution, Scene, render};

/// Width and height in pixels, samples per pixel. The last has tiles cut off at both edges.
const FRAMES: [(u32, u32, u32); 3] = [(80, 48, 1), (80, 48, 4), (200, 120, 1)];

const HEADER: &str =
    "# BLESS=1 cargo test --test pictures hashes writes this file: scene, pixels, samples, hash of the light.\n";

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Returns the scenes of `benches/scenes` by name, and as `shipped NAME` those that differ.
///
/// The copies never change, so that their hashes can be compared over the whole history. A shipped scene that differs
/// from its copy in more than comments is hashed as well.
fn scenes() -> BTreeMap<String, Scene> {
    let contents = |path: &PathBuf| -> Vec<String> {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        text.lines().filter(|line| !line.trim_start().starts_with("//")).map(str::to_owned).collect()
    };
    let copies = scene_files("benches/scenes");
    let shipped = scene_files("scenes").into_iter().filter(|(name, path)| {
        copies.iter().all(|(copy, copy_path)| copy != name || contents(copy_path) != contents(path))
    });
    let shipped = shipped.map(|(name, path)| (format!("shipped {name}"), path));
    let load = |(name, path): (String, PathBuf)| (name, Scene::load(&path).unwrap_or_else(|error| panic!("{error}")));
    copies.iter().cloned().chain(shipped).map(load).collect()
}

/// Returns name and path of the scene files in a folder.
fn scene_files(folder: &str) -> Vec<(String, PathBuf)> {
    std::fs::read_dir(path(folder))
        .expect("the folder is there")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "ron"))
        .map(|path| (path.file_stem().expect("it has an ending").to_string_lossy().into_owned(), path))
        .collect()
}

/// Returns the hashes of the file by `scene WIDTHxHEIGHT samples`.
fn expected() -> BTreeMap<String, String> {
    std::fs::read_to_string(path("tests/hashes.txt"))
        .unwrap_or_default()
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.rsplit_once(' '))
        .map(|(frame, hash)| (frame.to_owned(), hash.to_owned()))
        .collect()
}

#[test]
fn every_frame_has_the_same_bits_everywhere() {
    let pools = [1, 2, 7].map(|threads| {
        (threads, rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started"))
    });
    let mut found = BTreeMap::new();
    for (name, scene) in scenes() {
        for (width, height, samples) in FRAMES {
            let frame = format!("{name} {width}x{height} {samples}");
            let samples = NonZeroU32::new(samples).expect("at least one");
            let hash = || render(&scene, scene.camera(), Resolution::square(width, height), samples).hash();
            let hashes = pools.each_ref().map(|(threads, pool)| (*threads, pool.install(hash)));
            let [(_, first), ..] = hashes;
            let alone =
                render_by(Executor::CurrentThread, &scene, scene.camera(), Resolution::square(width, height), samples);
            assert_eq!(
                alone.expect("the render is not cancelled").framebuffer.hash(),
                hashes[0].1,
                "{frame}: without a pool"
            );
            for (threads, hash) in hashes {
                assert_eq!(hash, first, "{frame}: {threads} threads give other bits than one");
            }
            assert_eq!(pools[1].1.install(hash), first, "{frame}: the second time gives other bits than the first");
            found.insert(frame, format!("{first:016x}"));
        }
    }
    all_differ(&found);
    if std::env::var_os("BLESS").is_some() {
        let text = found.iter().fold(HEADER.to_owned(), |text, (frame, hash)| text + &format!("{frame} {hash}\n"));
        std::fs::write(path("tests/hashes.txt"), text).expect("the file can be written");
    }
    let wrong = differences(&expected(), &found);
    assert!(
        wrong.is_empty(),
        "other bits than in tests/hashes.txt:\n{wrong}\
        If the light was meant to change, BLESS=1 cargo test --test pictures hashes writes the file anew."
    );
}

/// Returns one line for each frame whose hash is not the expected one, or is on one side only.
fn differences(expected: &BTreeMap<String, String>, found: &BTreeMap<String, String>) -> String {
    let nothing = "nothing".to_owned();
    let mut frames: Vec<_> = expected.keys().chain(found.keys()).collect();
    frames.sort();
    frames.dedup();
    frames.into_iter().fold(String::new(), |mut lines, frame| {
        let hash = |hashes: &BTreeMap<String, String>| hashes.get(frame).unwrap_or(&nothing).clone();
        let (expected, found) = (hash(expected), hash(found));
        if expected != found {
            let _ = writeln!(lines, "  {frame}: expected {expected}, found {found}");
        }
        lines
    })
}

/// Asserts that no two frames are equal: a size or a number of samples without effect would be
/// seen.
fn all_differ(hashes: &BTreeMap<String, String>) {
    let mut frames = BTreeMap::new();
    for (frame, hash) in hashes {
        // A scene may have changed in ways that its first picture does not show.
        let is_copy = |other: &String| frame.strip_prefix("shipped ") == Some(other);
        if let Some(other) = frames.insert(hash, frame).filter(|other| !is_copy(other)) {
            panic!("{frame} has the hash of {other}");
        }
    }
}

fn picture(width: u32, height: u32, bits: &[u32]) -> Framebuffer {
    let mut framebuffer = Framebuffer::new(Resolution::square(width, height));
    for (pixel, bits) in framebuffer.pixels_mut().iter_mut().zip(bits.chunks_exact(3)) {
        *pixel = LinearRgb::new(f32::from_bits(bits[0]), f32::from_bits(bits[1]), f32::from_bits(bits[2]));
    }
    framebuffer
}

/// The expected hash was computed outside the crate, by a few lines of another language.
///
/// FNV-1a of the words 1, 1, 0x3f800000, 0x3f000000, 0x80000000.
#[test]
fn the_hash_is_fnv_1a() {
    assert_eq!(picture(1, 1, &[0x3f80_0000, 0x3f00_0000, 0x8000_0000]).hash(), 0xc8ec_a5a6_6acd_7755);
}

/// The hash depends on the last bit, the sign of zero, the order and the shape.
#[test]
fn the_hash_sees_every_bit() {
    let bits = [1, 2, 3, 4, 5, 6];
    let mut hashes = vec![picture(2, 1, &bits).hash(), picture(1, 2, &bits).hash()];
    for place in 0..6 {
        for bit in 0..32 {
            let mut other = bits;
            other[place] ^= 1 << bit;
            hashes.push(picture(2, 1, &other).hash());
        }
    }
    hashes.push(picture(2, 1, &[4, 5, 6, 1, 2, 3]).hash());
    let count = hashes.len();
    hashes.sort_unstable();
    hashes.dedup();
    assert_eq!(hashes.len(), count);
}
