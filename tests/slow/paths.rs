//! Time until a scene is shown whose path leads to another file.

use crate::pty::{Colour, SOON, Seen, Start, best_of_three, within_limit};
use crate::{PROGRAM, scene_of_ball};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Limit on the time until a scene at the end of another path is shown.
const SEEN: Duration = Duration::from_millis(500);

/// Names of the cases, shown paths, and shell commands before the start and for the change.
///
/// `red` and `lime` are scenes.
const CASES: [[&str; 4]; 10] = [
    ["a new file under the name", "s.ron", "cp red s.ron", "cp lime new; mv new s.ron"],
    [
        "a folder in its place for a moment",
        "s.ron",
        "cp red s.ron",
        "rm s.ron; mkdir s.ron; rmdir s.ron; cp lime s.ron",
    ],
    [
        "a device in its place for a moment",
        "s.ron",
        "cp red s.ron",
        "ln -sf /dev/zero s.ron; cp lime new; mv new s.ron",
    ],
    ["the middle one of three links", "s.ron", "ln -s b s.ron; ln -s c b; ln -s red c", "ln -s lime n; mv -T n b"],
    ["a folder behind a link", "..data/s.ron", TWO_FOLDERS, "ln -s two n; mv -T n ..data"],
    ["a link into a folder behind a link", "s.ron", DATA, "ln -s two n; mv -T n ..data"],
    ["the folder replaced", "in/s.ron", "mkdir in two; cp red in/s.ron; cp lime two/s.ron", "mv in out; mv two in"],
    ["the folder made again", "in/s.ron", "mkdir in; cp red in/s.ron", "rm -r in; mkdir in; cp lime in/s.ron"],
    ["a dangling link gets its target", "s.ron", "cp red x; ln -s x s.ron", "rm x; ln -sf y s.ron; cp lime y"],
    ["a target in a folder that comes", "s.ron", "cp red s.ron", "ln -sf in/y s.ron; mkdir in; cp lime in/y"],
];

const TWO_FOLDERS: &str = "mkdir one two; cp red one/s.ron; cp lime two/s.ron; ln -s one ..data";
const DATA: &str = "mkdir one two; cp red one/s.ron; cp lime two/s.ron; ln -s one ..data; ln -s ..data/s.ron s.ron";

fn run(folder: &Path, script: &str) {
    let status = Command::new("sh").args(["-ec", script]).current_dir(folder).status();
    assert!(status.is_ok_and(|status| status.success()), "{script}");
}

/// Returns whether the ball in the middle of the screen has that colour, by red and green.
fn has_ball(seen: &Seen, is_colour: impl Fn(u8, u8) -> bool) -> bool {
    matches!(seen.screen().cell(40, 12).background, Colour::Rgb(red, green, _) if is_colour(red, green))
}

#[test]
fn a_path_that_leads_to_another_scene_is_soon_seen() {
    for [what, path, arrange, change] in CASES {
        best_of_three(|| {
            let folder = tempfile::tempdir().expect("a folder can be made");
            for color in ["red", "lime"] {
                std::fs::write(folder.path().join(color), scene_of_ball(color)).expect("a file can be written");
            }
            run(folder.path(), arrange);
            let mut session = Start::new(PROGRAM).arg(folder.path().join(path)).says_when_it_rests().spawn();
            session.wait_for("the red ball", SOON, |seen| has_ball(seen, |red, green| red > green));
            session.wait_for_rest();
            run(folder.path(), change);
            let start = Instant::now();
            session.wait_for(what, SOON, |seen| has_ball(seen, |red, green| green > red));
            let took = start.elapsed();
            println!("{what}: seen after {took:?}");
            within_limit(took < 3 * SEEN, format_args!("{what}: {took:?}"));
        });
    }
}
