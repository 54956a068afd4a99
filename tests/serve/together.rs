//! Viewers who see one another: the list, marks at cameras, following a viewer, a led tour.

use crate::guest::{Guest, connect};
use crate::operator::{counts, key, value};
use crate::tour::path;
use crate::{Hosting, Place, run, until};
use russh::keys::PrivateKeyWithHashAlg;
use std::sync::Arc;
use std::time::{Duration, Instant};
use termtrace::internals::serve::Settings;

fn hosting(change: impl FnOnce(&mut Settings)) -> Hosting {
    Hosting::start(|settings| {
        settings.metrics = Some(([127, 0, 0, 1], 0).into());
        settings.max_per_address = 100;
        change(settings);
    })
}

/// Opens the first scene as a user, by a key if there is one.
async fn enter_as(place: &impl Place, user: &str, seed: Option<u8>) -> Guest {
    let mut session = connect(place).await;
    let auth = match seed {
        Some(seed) => {
            let key = PrivateKeyWithHashAlg::new(Arc::new(key(seed)), None);
            session.authenticate_publickey(user, key).await
        }
        None => session.authenticate_none(user).await,
    };
    assert!(auth.expect("an answer").success(), "{user} is let in");
    let mut guest = Guest::on(session, (80, 24)).await;
    guest.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await.expect("a terminal");
    guest.ask(None).await;
    guest
}

/// Returns the look of the cells that show the picture, without rows of text at the top and bottom.
fn picture(guest: &Guest) -> Vec<String> {
    guest.cells().lines().skip(80).take(80 * 20).map(str::to_owned).collect()
}

/// Reads for both until they show the same picture.
async fn see_the_same(first: &mut Guest, second: &mut Guest) {
    let end = Instant::now() + crate::PATIENCE;
    while picture(first) != picture(second) {
        assert!(Instant::now() < end, "the pictures differ: {:#?} {:#?}", first.text(), second.text());
        first.read_for(Duration::from_millis(10)).await;
        second.read_for(Duration::from_millis(10)).await;
    }
}

/// Returns the row and column of a text on the screen.
fn place_of(guest: &Guest, text: &str) -> Option<(usize, usize)> {
    guest.text().iter().enumerate().find_map(|(row, line)| Some((row, line.find(text)?)))
}

/// Reads until the server has made no picture for two seconds, for any of its viewers.
pub(crate) async fn rest_of_all(hosting: &Hosting, guests: &mut [&mut Guest]) {
    let made = || {
        let counts = counts(hosting);
        ["{from=\"tracer\"}", "{from=\"memory\"}"]
            .map(|from| value(&counts, &format!("termtrace_pictures_total{from}")))
    };
    let (mut before, mut since) = (made(), Instant::now());
    assert!(before.iter().all(Option::is_some), "{before:?}");
    while since.elapsed() < Duration::from_secs(2) {
        for guest in &mut *guests {
            guest.read_for(Duration::from_millis(50)).await;
        }
        let now = made();
        if now != before {
            (before, since) = (now, Instant::now());
        }
    }
}

/// Returns the flags of the command that shows the guest's view at home.
async fn camera_of(mut guest: Guest) -> String {
    guest.send(b"q").await;
    assert_eq!(guest.leave().await, Some(0));
    guest.assert_clean();
    let text = String::from_utf8_lossy(&guest.bytes).into_owned();
    let line = text.split("this view at home: termtrace three_spheres").nth(1).expect("a command");
    line.lines().next().expect("a line").trim().to_owned()
}

#[test]
fn the_list_has_the_others_and_a_digit_follows_one() {
    let hosting = hosting(|_| {});
    run(async {
        let mut first = Guest::enter(&hosting).await;
        first.see_picture().await;
        first.send(b"u").await;
        first.see_text("you are viewer 0, alone here").await;
        first.send(b"1").await;
        first.see_text("the list has no viewer 1").await;
        first.send(b"\x1b").await;
        first.see("the list closes", |guest| !guest.text().iter().any(|row| row.contains("viewer 0"))).await;

        let mut second = Guest::enter_with(&hosting, (80, 24), Some("corridor")).await;
        second.see_picture().await;
        second.send(b"u").await;
        second.see_text("1  viewer 0  three_spheres").await;
        second.see_text("2 watching").await;
        second.send(b"1").await;
        second.see_text("with viewer 0, 2 watching: any key leaves it").await;
        // The picture follows the first one, into whose list the second one comes.
        first.send(b"t").await;
        let before = picture(&second);
        second.see("the first one's turn", |guest| picture(guest) != before).await;
        first.send(b"t").await;
        see_the_same(&mut first, &mut second).await;
        first.send(b"u").await;
        first.see_text("1  viewer 1  with viewer 0").await;
        first.see_text("2 watching, 1 with you").await;
        first.send(b"1").await;
        first.see_text("the view you chose is your own").await;

        // The list closes in the view of the second one's own, which the key does not move.
        second.send(b"u").await;
        second.see_text("you no longer follow viewer 0; u lists the viewers").await;
        second.send(b"\x1b").await;
        second.see_picture().await;
        until("no viewer follows", || value(&counts(&hosting), "termtrace_followers") == Some(0.0)).await;
        // The view is the first one's.
        assert_eq!(camera_of(first).await, camera_of(second).await);
    });
}

#[test]
fn a_long_list_has_pages() {
    let hosting = hosting(|_| {});
    run(async {
        let mut guests = Vec::new();
        for _ in 0..12 {
            guests.push(Guest::enter(&hosting).await);
            guests.last_mut().expect("it is there").see_picture().await;
        }
        let first = &mut guests[0];
        first.send(b"u").await;
        first.see_text("9  viewer 9").await;
        first.see_text("12 watching, page 1 of 2").await;
        first.send(b"u").await;
        first.see_text("2  viewer 11").await;
        first.send(b"2").await;
        first.see_text("with viewer 11, 12 watching").await;
    });
}

#[test]
fn a_followed_viewer_may_resize() {
    let hosting = hosting(|_| {});
    run(async {
        let mut first = Guest::enter(&hosting).await;
        first.see_picture().await;
        let mut second = Guest::enter(&hosting).await;
        second.see_picture().await;
        second.send(b"u1").await;
        second.see_text("with viewer 0").await;
        rest_of_all(&hosting, &mut [&mut first, &mut second]).await;
        let before = second.cells();
        first.resize_screen(100, 40);
        first.channel.window_change(100, 40, 0, 0).await.expect("it is sent");
        first.see("the picture in the new size", |guest| guest.text()[35].contains(['▀', '▄'])).await;
        rest_of_all(&hosting, &mut [&mut first, &mut second]).await;
        assert_eq!(second.cells(), before, "the follower's window has not changed");
        // It follows on, in its own size, and the first one's move is the same for a terminal of that size.
        first.send(b"t").await;
        second.see("the first one's turn", |guest| guest.cells() != before).await;
        first.send(b"t").await;
        first.resize_screen(80, 24);
        first.channel.window_change(80, 24, 0, 0).await.expect("it is sent");
        see_the_same(&mut first, &mut second).await;
        // And the follower's own size may change.
        second.resize_screen(60, 20);
        second.channel.window_change(60, 20, 0, 0).await.expect("it is sent");
        let is_lowest = |guest: &Guest| guest.text().get(19).is_some_and(|row| row.contains("with viewer 0"));
        second.see("the first one's view in the new size", is_lowest).await;
    });
}

#[test]
fn a_followed_viewer_who_leaves_gives_followers_views_of_their_own() {
    let hosting = hosting(|settings| settings.idle = Duration::from_secs(3600));
    run(async {
        let mut first = Guest::enter(&hosting).await;
        first.see_picture().await;
        let mut others = Vec::new();
        for _ in 0..2 {
            let mut other = Guest::enter(&hosting).await;
            other.see_picture().await;
            other.send(b"u1").await;
            other.see_text("with viewer 0").await;
            others.push(other);
        }
        first.send(b"tt]").await;
        first.rest().await;
        let camera = camera_of(first).await;
        assert!(!camera.is_empty(), "it has moved");
        for other in &mut others {
            other.see_text("viewer 0 has left").await;
            other.see_picture().await;
        }
        for other in others {
            assert_eq!(camera_of(other).await, camera, "the view stays where it was");
        }
    });
}

#[test]
fn a_chain_of_followers_ends_at_one_who_moves() {
    let hosting = hosting(|settings| settings.tour = Some(path()));
    run(async {
        let mut guests = Vec::new();
        for _ in 0..3 {
            let mut guest = Guest::enter(&hosting).await;
            guest.see_text("tour, ").await;
            guests.push(guest);
        }
        let [mut first, mut second, mut third] = <[Guest; 3]>::try_from(guests).ok().expect("three");
        // The first one stays in the tour, the others look through their eyes.
        second.send(b"u1").await;
        second.see_text("with viewer 0").await;
        third.send(b"u2").await;
        third.see_text("with viewer 1").await;
        see_the_same(&mut first, &mut third).await;
        first.send(b"w").await;
        first.see_text("you have left the tour").await;
        first.rest().await;
        see_the_same(&mut first, &mut third).await;
        drop(second);
        third.see_text("viewer 1 has left").await;
    });
}

#[test]
fn row_31_no_viewer_is_redrawn_because_another_one_moves() {
    let hosting = hosting(|_| {});
    run(async {
        let mut first = Guest::enter(&hosting).await;
        first.see_picture().await;
        // Marks are off until a key asks for them.
        let mut second = Guest::enter(&hosting).await;
        second.see_picture().await;
        first.rest().await;
        assert!(!first.text().iter().any(|row| row.contains("watching") || row.contains("(1)")));
        // The second one goes ahead, into the first one's picture, and on and on.
        second.send(b"wwwwww").await;
        second.rest().await;
        first.send(b"U").await;
        first.see_text("2 watching").await;
        first.see_text("(1)").await;
        // Later bytes are for others only if the first one's own picture has all its samples.
        rest_of_all(&hosting, &mut [&mut first, &mut second]).await;
        let (before, mark) = (first.bytes.len(), place_of(&first, "(1)"));
        assert!(mark.is_some(), "{:#?}", first.text());
        let moving = second.cells();
        second.send(b"t").await;
        second.see("a turn", |guest| guest.cells() != moving).await;
        let mut third = Guest::enter(&hosting).await;
        third.see_picture().await;
        first.read_for(Duration::from_millis(500)).await;
        assert_eq!(first.bytes.len(), before, "no byte is sent for others: {:#?}", first.text());
        // The next frame for the first one's own reasons shows where they are now.
        first.send(b"i").await;
        first.see_text("3 watching").await;
        assert_ne!(place_of(&first, "(1)"), mark, "the second one has turned: {:#?}", first.text());
        first.send(b"U").await;
        first.see("no marks", |guest| !guest.text().iter().any(|row| row.contains("watching"))).await;
    });
}

#[test]
fn row_11_names_are_shown_only_where_asked_for_and_in_plain_letters() {
    const HOSTILE: &str = "\x1b[2J\u{202e}anna\x07 of the very long name";
    for shows in [false, true] {
        let hosting = hosting(|settings| settings.show_names = shows);
        run(async {
            let mut other = enter_as(&hosting, HOSTILE, None).await;
            other.see_picture().await;
            other.send(b"wwwwww").await;
            other.rest().await;
            let mut guest = enter_as(&hosting, "bert", None).await;
            guest.see_picture().await;
            guest.send(b"uU").await;
            guest.see_text("1  viewer 0").await;
            let text = guest.text().join("\n");
            assert_eq!(text.contains("1  viewer 0 (2Jannaoftheveryl)  three_spheres"), shows, "{text}");
            assert_eq!(text.contains("you are viewer 1 (bert)"), shows, "{text}");
            assert_eq!(guest.has("anna"), shows);
        });
        assert!(
            !hosting.log().iter().any(|line| line.contains("anna") || line.contains("bert")),
            "{:?}",
            hosting.log()
        );
    }
}

fn with_leaders(change: impl FnOnce(&mut Settings)) -> Hosting {
    hosting(|settings| {
        settings.leaders = Some(vec![key(1).public_key().clone(), key(2).public_key().clone()]);
        change(settings);
    })
}

#[test]
fn the_holder_of_a_key_leads_the_tour() {
    let hosting = with_leaders(|_| {});
    run(async {
        let mut leader = enter_as(&hosting, "leader", Some(1)).await;
        leader.see_picture().await;
        let mut guest = enter_as(&hosting, "anybody", None).await;
        guest.see_picture().await;
        // There is no leader yet, and this viewer may not lead.
        guest.send(b"G").await;
        guest.send(b"T").await;
        guest.see_text("there is no tour now").await;
        leader.send(b"G").await;
        leader.see_text("you lead the tour; G ends that").await;
        guest.send(b"T").await;
        guest.see_text("tour led by viewer 0, 2 watching: any key leaves it").await;
        // A new viewer starts in the tour.
        let mut late = enter_as(&hosting, "anybody", None).await;
        late.see_text("tour led by viewer 0, 3 watching").await;
        leader.send(b"nt").await;
        let before = picture(&late);
        late.see("the leader's scene", |guest| picture(guest) != before).await;
        leader.send(b"t").await;
        // A key leaves, where the leader is.
        guest.send(b"i").await;
        guest.see_text("you have left the tour; T goes back to it").await;
        guest.see("the leader's scene", |guest| guest.has("corridor")).await;
        // Another leader takes over; the first one is told.
        let mut other = enter_as(&hosting, "leader", Some(2)).await;
        other.see_text("tour led by viewer 0").await;
        other.send(b"G").await;
        other.see_text("you lead the tour; G ends that").await;
        leader.see_text("another viewer leads the tour now").await;
        late.see_text("tour led by viewer 3").await;
        other.send(b"G").await;
        other.see_text("you no longer lead the tour").await;
        late.see_text("the tour has ended").await;
        late.see_picture().await;
    });
}

#[test]
fn a_leader_who_disconnects_in_mid_tour_leaves_the_path_or_views_of_ones_own() {
    for has_path in [false, true] {
        let hosting = with_leaders(|settings| settings.tour = has_path.then(path));
        run(async {
            let mut leader = enter_as(&hosting, "leader", Some(1)).await;
            leader.see_picture().await;
            leader.send(b"G").await;
            leader.see_text("you lead the tour; G ends that").await;
            let mut guest = enter_as(&hosting, "anybody", None).await;
            guest.see_text("tour led by viewer 0").await;
            leader.send(b"ttwww").await;
            rest_of_all(&hosting, &mut [&mut leader, &mut guest]).await;
            see_the_same(&mut leader, &mut guest).await;
            let seen = picture(&leader);
            assert_eq!(picture(&guest), seen);
            // The connection breaks off, without a key.
            drop(leader);
            if has_path {
                guest.see_text(" tour, 1 watching: any key leaves it").await;
                guest.see("the path goes on", |guest| picture(guest) != seen).await;
            } else {
                guest.see_text("the tour has ended").await;
                guest.rest().await;
                assert!(!camera_of(guest).await.is_empty(), "the view is where the leader was");
            }
        });
    }
}

#[test]
fn row_32_only_the_key_of_a_leader_leads_and_no_visitor_is_turned_away() {
    let hosting = with_leaders(|_| {});
    run(async {
        // A key that is no leader's is refused, and no question follows.
        let mut session = connect(&hosting).await;
        let auth = session.authenticate_none("leader").await.expect("an answer");
        assert!(!auth.success(), "a leader's key is wanted");
        let stranger = PrivateKeyWithHashAlg::new(Arc::new(key(9)), None);
        assert!(!session.authenticate_publickey("leader", stranger).await.expect("an answer").success());
        let answer = session.authenticate_keyboard_interactive_start("leader", None).await.expect("an answer");
        assert!(matches!(answer, russh::client::KeyboardInteractiveAuthResponse::Success), "{answer:?}");
        let mut guest = Guest::on(session, (80, 24)).await;
        guest.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await.expect("a terminal");
        guest.ask(None).await;
        guest.see_picture().await;
        guest.send(b"G?").await;
        guest.see_text("list of viewers").await;
        assert!(!guest.text().iter().any(|row| row.contains("lead the tour")), "{:#?}", guest.text());
    });
}

#[test]
fn with_keys_for_all_a_leader_leads_by_a_leaders_key_only() {
    let hosting = with_leaders(|settings| settings.authorized_keys = Some(vec![key(3).public_key().clone()]));
    run(async {
        let mut session = connect(&hosting).await;
        let mut is_let_in = async |user: &str, seed| {
            let key = PrivateKeyWithHashAlg::new(Arc::new(key(seed)), None);
            session.authenticate_publickey(user, key).await.expect("an answer").success()
        };
        assert!(!is_let_in("anybody", 9).await && !is_let_in("leader", 9).await, "a stranger is refused");
        // The client of a leader may offer another key first, which lets in, but does not lead.
        assert!(!is_let_in("leader", 3).await, "a leader's key is wanted");
        assert!(is_let_in("leader", 1).await);
        let mut leader = Guest::on(session, (80, 24)).await;
        leader.channel.request_pty(true, "xterm-256color", 80, 24, 0, 0, &[]).await.expect("a terminal");
        leader.ask(None).await;
        leader.see_picture().await;
        let mut guest = enter_as(&hosting, "anybody", Some(3)).await;
        guest.see_picture().await;
        guest.send(b"G").await;
        guest.send(b"T").await;
        guest.see_text("there is no tour now").await;
        leader.send(b"G").await;
        leader.see_text("you lead the tour; G ends that").await;
        guest.send(b"T").await;
        guest.see_text("tour led by viewer 0").await;
    });
}
