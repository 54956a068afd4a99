//! The tour: followers get the same frames, leave by any key, and come back by one.

use crate::guest::Guest;
use crate::operator::{counts, folder_with, value};
use crate::program::{Program, termtrace};
use crate::{Hosting, run, scenes, until};
use std::path::Path;
use std::time::{Duration, Instant};
use termtrace::CameraPath;
use termtrace::internals::serve::Settings;

/// A path that moves for a second, and rests for another one.
const MOVES_AND_RESTS: &str = "(keyframes: [
    (time: 0, eye: (0, 2.1, 6.3), target: (0, 0.9, 0)),
    (time: 0.5, eye: (4, 2.1, 4.3), target: (0, 0.9, 0)),
    (time: 1, eye: (0, 2.1, 6.3), target: (0, 0.9, 0)),
    (time: 2, eye: (0, 2.1, 6.3), target: (0, 0.9, 0)),
])";

pub(crate) fn path() -> CameraPath {
    let scenes = scenes();
    let camera = scenes.first().map(|scene| scene.scene.camera()).expect("a scene");
    CameraPath::from_ron("tour.ron", MOVES_AND_RESTS, camera).expect("a path")
}

fn with_tour(change: impl FnOnce(&mut Settings)) -> Hosting {
    Hosting::start(|settings| {
        settings.tour = Some(path());
        settings.metrics = Some(([127, 0, 0, 1], 0).into());
        settings.max_per_address = 1000;
        change(settings);
    })
}

const LEFT: &str = "you have left the tour; T goes back to it";

#[test]
fn a_tour_is_left_by_any_key_and_entered_by_one() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_text("tour, 1 watching: any key leaves it").await;
        guest.see_picture().await;
        for key in ["w", "T", "\x1b[<0;10;10M"] {
            guest.send(key.as_bytes()).await;
            guest.see_text(LEFT).await;
            guest.see_picture().await;
            guest.send(b"T").await;
            guest.see_text("tour, 1 watching").await;
        }
        // A panel is not the tour's: it opens over a view of the viewer's own.
        guest.send(b"i").await;
        guest.see_text("q quit").await;
        guest.send(b"nT").await;
        guest.see_text("tour, 1 watching").await;
        guest.send(b"q").await;
        assert_eq!(guest.leave().await, Some(0));
        guest.assert_clean();
        assert!(guest.has("this view at home: termtrace three_spheres"), "the tour goes through the first scene");
    });
}

#[test]
fn a_scene_by_name_is_a_view_of_ones_own() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guest = Guest::enter_with(&hosting, (80, 24), Some("corridor")).await;
        guest.see_text("? all keys").await;
        guest.see_picture().await;
        assert_eq!(value(&counts(&hosting), "termtrace_followers"), Some(0.0));
        guest.send(b"T").await;
        guest.see_text("tour, 1 watching").await;
        assert_eq!(value(&counts(&hosting), "termtrace_followers"), Some(1.0));
    });
}

/// Reads until all show the same cells, with this text.
async fn see_the_same(guests: &mut [Guest], text: &str) {
    let end = Instant::now() + crate::PATIENCE;
    while Instant::now() < end {
        for guest in &mut *guests {
            guest.read_for(Duration::from_millis(20)).await;
        }
        let (first, others) = guests.split_first().expect("there are some");
        let cells = first.cells();
        if first.text().iter().any(|row| row.contains(text)) && others.iter().all(|other| other.cells() == cells) {
            return;
        }
    }
    let texts: Vec<_> = guests.iter().map(Guest::text).collect();
    panic!("no frame is the same for all: {texts:#?}");
}

#[test]
fn all_followers_see_the_same_however_they_came() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guests = vec![Guest::enter(&hosting).await];
        guests[0].see_text("tour, 1 watching").await;
        guests.push(Guest::enter(&hosting).await);
        guests[1].see_text("tour, 2 watching").await;
        let mut third = Guest::enter(&hosting).await;
        third.see_text("tour, 3 watching").await;
        third.send(b"w").await;
        third.see_text(LEFT).await;
        third.send(b"T").await;
        third.see_text("tour, 3 watching").await;
        guests.push(third);
        for _ in 0..3 {
            see_the_same(&mut guests, "tour, 3 watching").await;
            let before = guests[0].cells();
            guests[0].see("the next frame", |guest| guest.cells() != before).await;
        }
        // The frames have been drawn once for all three.
        let counts = counts(&hosting);
        let drawn = value(&counts, "termtrace_tour_frames_total{at=\"drawn\"}");
        let sent = value(&counts, "termtrace_tour_frames_total{at=\"sent\"}");
        assert!(drawn.zip(sent).is_some_and(|(drawn, sent)| sent > 1.5 * drawn), "{counts}");
    });
}

#[test]
fn each_window_and_colour_depth_has_an_audience() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guests = Vec::new();
        for (size, term) in [((80, 24), "xterm-256color"), ((100, 30), "xterm-256color"), ((80, 24), "xterm")] {
            let mut guest = Guest::without_terminal(&hosting, size).await;
            guest.channel.request_pty(true, term, size.0.into(), size.1.into(), 0, 0, &[]).await.expect("a terminal");
            guest.ask(None).await;
            guest.see_text("watching: any key leaves it").await;
            guest.see_picture().await;
            guests.push(guest);
        }
        let rows = counts(&hosting);
        assert_eq!(value(&rows, "termtrace_followers"), Some(3.0));
        // A new size of the window is another audience.
        guests[0].resize_screen(90, 30);
        guests[0].channel.window_change(90, 30, 0, 0).await.expect("it is sent");
        let is_lowest = |guest: &Guest| guest.text().get(29).is_some_and(|row| row.contains("tour, 3 watching"));
        guests[0].see("the tour in the new size", is_lowest).await;
    });
}

#[test]
fn row_27_a_follower_who_falls_behind_delays_no_other_one_and_catches_up() {
    let hosting = with_tour(|settings| settings.max_rate = None);
    run(async {
        let mut slow = Guest::enter_with_little_room(&hosting).await;
        slow.see_text("tour, 1 watching").await;
        let mut other = Guest::enter(&hosting).await;
        other.see_text("tour, 2 watching").await;
        let drawn = || value(&counts(&hosting), "termtrace_tour_frames_total{at=\"drawn\"}").unwrap_or(0.0);
        let sent = || value(&counts(&hosting), "termtrace_tour_frames_total{at=\"sent\"}").unwrap_or(0.0);
        // Until the slow one has missed frames, while the other one has got all of them.
        let before = drawn() - sent() / 2.0;
        while drawn() - sent() / 2.0 < before + 4.0 {
            other.read_for(Duration::from_millis(50)).await;
        }
        see_the_same(&mut [other, slow], "tour, 2 watching").await;
    });
}

#[test]
fn row_28_many_followers_press_a_key_at_once() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guests = Vec::new();
        for _ in 0..60 {
            guests.push(Guest::enter(&hosting).await);
        }
        for guest in &mut guests {
            guest.see_text("watching: any key leaves it").await;
        }
        for guest in &guests {
            guest.send(b"w").await;
        }
        for guest in &mut guests {
            guest.see_text(LEFT).await;
        }
        until("no audience is left", || value(&counts(&hosting), "termtrace_followers") == Some(0.0)).await;
        for guest in &guests {
            guest.send(b"T").await;
        }
        for guest in &mut guests {
            guest.see_text("tour, 60 watching").await;
        }
    });
}

#[test]
fn a_tour_ends_with_a_line_for_its_followers() {
    let hosting = with_tour(|_| {});
    run(async {
        let mut guest = Guest::enter(&hosting).await;
        guest.see_text("tour, 1 watching").await;
        let mut settings = Settings::new(hosting.key());
        settings.max_per_address = 1000;
        hosting.server.reload(scenes(), settings.clone());
        guest.see_text("the tour has ended").await;
        guest.see_picture().await;
        settings.tour = Some(path());
        hosting.server.reload(scenes(), settings);
        let mut other = Guest::enter(&hosting).await;
        other.see_text("tour, 2 watching").await;
        hosting.server.drain();
        other.see_text("the server restarts: you leave in").await;
        other.send(b"q").await;
        assert_eq!(other.leave().await, Some(0));
        other.assert_clean();
    });
}

#[test]
fn the_path_of_a_tour_is_a_file() {
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/paths/among_the_spheres.ron");
    assert!(Path::new(shipped).exists());
    let program = Program::start(&["three_spheres", "--tour", shipped]);
    run(async { Guest::enter(&program).await.see_text("tour, 1 watching").await });
    for (text, expected) in [("(", "tour.ron:1"), ("(keyframes: [])", "tour.ron")] {
        let (_folder, path) = folder_with("tour.ron", text);
        let output = termtrace(&["three_spheres", "--tour", &path]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {message}");
        assert!(message.contains(expected), "{text}: {message}");
    }
}
