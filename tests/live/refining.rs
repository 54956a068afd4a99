//! Refinement: the picture of a resting view gets better in few steps, and ends.
//!
//! Moving does not wait for it.

#![cfg(feature = "test-hooks")]

use crate::gravel::gravel;
use crate::pty::{self, Phases, SOON, Seen, Session, Size, Start, shows};
use std::num::NonZeroU32;
use std::path::Path;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{CellMode, Encoder, Glyphs, Grid, Order, Sampling, Scene};

const PROGRAM: &str = env!("CARGO_BIN_EXE_termtrace");
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");

/// The query that ends each frame.
const FENCE: &[u8] = b"\x1b[c";

fn picture(sampling: Sampling, scene: &Path, size: Size) -> Grid {
    let scene = Scene::load(scene).unwrap_or_else(|error| panic!("{error}"));
    pty::picture_with(sampling, &scene, CellMode::HALF_BLOCK, termtrace::Size::new(size.columns, size.rows), 2.0)
}

/// Returns the bytes of a whole frame that shows this grid.
fn whole_frame(grid: &Grid) -> usize {
    let mut bytes = Vec::new();
    Encoder::new().with_order(Order::Raster).with_half_blocks(HalfBlocks::Either).encode(grid, &mut bytes);
    bytes.len()
}

/// The most sessions until one has no late replies.
const SESSIONS: usize = 5;

/// Asserts that the refinement of a scene ends in few steps, at the start and after a jump of the
/// camera.
///
/// On a busy machine replies are late, and the link may be taken for a slow one, which gets other frames.
fn assert_comes_to_its_end(scene: &Path, size: Size) {
    let wanted = picture(Sampling::BEST, scene, size);
    let faults: Vec<_> = (0..SESSIONS).map_while(|_| come_to_the_end(scene, size, &wanted).err()).collect();
    assert!(faults.len() < SESSIONS, "{faults:#?}");
}

/// Waits for both ends of the refinement in a session; an error tells what does not belong to few
/// steps.
fn come_to_the_end(scene: &Path, size: Size, wanted: &Grid) -> Result<(), String> {
    let mut phases = Phases::new();
    let start = Start::new(PROGRAM).arg(scene).size(size);
    let mut session = start.env("TERMTRACE_TEST_SOCKET", phases.path()).spawn();
    let what = format!("{} on {size:?}", scene.display());
    refine(&mut session, &mut phases, wanted, &format!("{what} at first"))?;
    session.send(b"d");
    phases.count_on("refinement", &mut session, SOON, |seen| !shows(seen.screen(), wanted));
    // The space bar stops the refinement, and its note goes with the next key.
    session.send(b" \x1b[24~");
    phases.count_until_rest("refinement", &mut session);
    // The space bar ends the jump at once.
    session.send(b"r \x1b[24~");
    refine(&mut session, &mut phases, wanted, &format!("{what} after a key"))
}

/// Waits for the picture, which three frames make up; then nothing more comes.
#[track_caller]
fn refine(session: &mut Session, phases: &mut Phases, wanted: &Grid, what: &str) -> Result<(), String> {
    let before = session.seen().bytes().len();
    let steps = phases.count_on("refinement", session, SOON, |seen| shows(seen.screen(), wanted));
    assert!(shows(session.seen().screen(), wanted), "{what}: not the end");
    let end = session.seen().bytes().len();
    let late = phases.count_until_rest("refinement", session);
    let more = session.seen().bytes().len() - end;
    let share = (end - before) as f64 / whole_frame(wanted) as f64;
    let told = format!("{what}: {steps} steps more, {share:.2} whole frames; then {late} steps, {more} bytes");
    println!("{told}");
    // Late replies cost steps and bytes, but nothing comes after the end.
    assert!(late == 0 && more <= FENCE.len(), "{told}");
    if (1..=2).contains(&steps) && share <= 2.5 { Ok(()) } else { Err(told) }
}

#[test]
fn a_resting_picture_is_refined_in_few_steps() {
    for name in ["three_spheres", "many_spheres", "corridor", "teapots"] {
        let scene = Path::new(SCENES).join(name).with_extension("ron");
        for size in [Size::cells(80, 24), Size::cells(150, 45)] {
            assert_comes_to_its_end(&scene, size);
        }
    }
}

/// A scene whose every cell has edges is refined to its end.
#[test]
fn a_picture_of_edges_is_refined_in_few_steps() {
    assert_comes_to_its_end(gravel().path(), LARGE);
}

/// The status line shows the number of samples of a pixel.
#[test]
fn samples_may_be_forced() {
    let scene = Path::new(SCENES).join("three_spheres.ron");
    let one = Sampling::Each(NonZeroU32::MIN);
    for (flag, sampling, told) in [("1", one, " 1 sample "), ("best", Sampling::BEST, " 64 samples ")] {
        let start = Start::new(PROGRAM).arg(&scene).arg("--samples").arg(flag);
        let mut session = start.says_when_it_rests().spawn();
        let wanted = picture(sampling, &scene, Size::cells(80, 24));
        session.wait_for("the picture", SOON, |seen| shows(seen.screen(), &wanted));
        let end = session.seen().bytes().len();
        session.wait_for_rest();
        assert!(session.seen().bytes().len() <= end + FENCE.len(), "{flag}: more is sent");
        // The number is fixed in motion, too.
        session.send(b"id");
        session.wait_for("a moving eye", SOON, |seen| {
            let status = seen.screen().text().pop().unwrap_or_default();
            assert!(!status.contains(" eye ") || status.contains(told), "{flag}: {status}");
            status.contains(" eye ") && !status.contains("eye 0.00")
        });
    }
    let mut session = Start::new(PROGRAM).arg(&scene).spawn();
    session.send(b"i");
    session.wait_for_text(" 64 samples ");
}

/// Starts the program in a terminal that calls itself kitty.
fn start_in_kitty(start: Start) -> Session {
    let mut session = start.mute().spawn();
    session.wait_for("the queries", SOON, |seen| seen.has(b"\x1b[>q") && seen.has(FENCE));
    let asked = session.seen().bytes().len();
    session.send(b"\x1bP>|kitty(0.26.5)\x1b\\\x1b[>1;4000;26c\x1b[?62c");
    session.answer_from(asked);
    session
}

/// Returns whether a screen shows a picture with glyphs finer than half blocks.
fn has_fine_glyphs(seen: &Seen) -> bool {
    seen.screen().text().concat().contains(['▘', '▝', '▖', '▗', '▌', '▐', '▂', '▆'])
}

/// Waits until the picture rests in finer glyphs: until `is_wanted` is true at rest.
///
/// On a busy machine replies are late, and the link may be taken for a slow one, on which half blocks stay. The frames
/// of further keys then show that it is not.
#[track_caller]
fn wait_for_finer_rest(session: &mut Session, is_wanted: impl Fn(&Seen) -> bool) {
    for _ in 0..20 {
        session.wait_for_rest();
        if is_wanted(session.seen()) {
            return;
        }
        session.send(b"d");
        session.wait_for_rest();
        session.send(b"r");
    }
    panic!("half blocks stay");
}

#[test]
fn a_terminal_known_for_its_blocks_gets_finer_glyphs_at_rest() {
    let path = Path::new(SCENES).join("three_spheres.ron");
    let start = Start::new(PROGRAM).arg(&path).arg("--reduced-motion").says_when_it_rests();
    let mut session = start_in_kitty(start);
    let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let fine = CellMode { glyphs: Glyphs::Blocks, ..CellMode::HALF_BLOCK };
    let wanted = pty::picture(&scene, fine, termtrace::Size::new(80, 24), 2.0);
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 10_000);
    wait_for_finer_rest(&mut session, |seen| shows(seen.screen(), &wanted));
    // A panel is drawn over the fine picture, and nothing is traced again.
    session.send(b"?");
    session.wait_for_text("Move");
    assert!(has_fine_glyphs(session.seen()));
    session.send(b"q");
    session.wait_for("the picture in blocks again", SOON, |seen| shows(seen.screen(), &wanted));
    session.send(b"d");
    session.wait_for("another view", SOON, |seen| !shows(seen.screen(), &wanted));
    session.send(b"r");
    wait_for_finer_rest(&mut session, |seen| shows(seen.screen(), &wanted));
    // Another window has the picture of its own size.
    let before = session.seen().bytes().len();
    session.resize(Size::cells(60, 20));
    session.wait_for("a smaller picture", SOON, |seen| seen.bytes().len() > before + 5_000);
    let wanted = pty::picture(&scene, fine, termtrace::Size::new(60, 20), 2.0);
    wait_for_finer_rest(&mut session, |seen| shows(seen.screen(), &wanted));
    // The key for other glyphs chooses once and for all.
    session.send(b"B");
    let has_octants = |seen: &Seen| seen.screen().text().concat().contains(|glyph| ('\u{1cd00}'..).contains(&glyph));
    session.wait_for("octants", SOON, has_octants);
    session.wait_for_rest();
    assert!(has_octants(session.seen()));
}

/// Half blocks take fewer rays.
#[test]
fn a_turning_view_has_half_blocks() {
    let start = Start::new(PROGRAM).arg(Path::new(SCENES).join("three_spheres.ron")).says_when_it_rests();
    let mut session = start_in_kitty(start);
    session.wait_for("a picture", SOON, |seen| seen.bytes().len() > 10_000);
    wait_for_finer_rest(&mut session, has_fine_glyphs);
    session.send(b"t");
    session.wait_for("half blocks of a turning view", SOON, |seen| !has_fine_glyphs(seen));
    let before = session.seen().bytes().len();
    // Several frames later there are still half blocks.
    session.wait_for("more frames", SOON, |seen| seen.bytes().len() > before + 100_000);
    assert!(!has_fine_glyphs(session.seen()));
}

#[test]
fn half_blocks_stay_at_rest_if_the_rate_or_the_glyphs_are_given() {
    for arguments in [["--max-rate", "100k"], ["--glyphs", "half"], ["--color", "256"]] {
        let start = Start::new(PROGRAM).arg(Path::new(SCENES).join("three_spheres.ron"));
        let start = arguments.iter().fold(start, Start::arg);
        let mut session = start.says_when_it_rests().mute().spawn();
        session.wait_for("the queries", SOON, |seen| seen.has(FENCE));
        let asked = session.seen().bytes().len();
        session.send(b"\x1bP>|kitty(0.26.5)\x1b\\\x1b[?62c");
        session.answer_from(asked);
        session.wait_for_text("▄");
        session.wait_for_rest();
        assert!(!has_fine_glyphs(session.seen()), "{arguments:?}");
    }
}

const LARGE: Size = Size { columns: 120, rows: 40, cell: (10, 20) };
