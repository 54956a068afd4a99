use super::*;
use crate::camera::Camera;
use crate::maps::Map;
use crate::scene::Scene;

fn view(name: &str, x: f32) -> GuideView {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)))";
    let scene = Scene::from_ron("x.ron", text).expect("a scene");
    let camera = Camera::look_at(glam::Vec3::new(x, 0.0, 5.0), glam::Vec3::ZERO).expect("a camera");
    GuideView { name: name.into(), scene, camera, map: Map::Shaded }
}

/// Returns a roster of viewers 0, 1, ... whose eyes are at their numbers.
fn roster(count: u8) -> Roster {
    let roster = Roster::default();
    for id in 0..count {
        roster.enter(id.into(), None, view("one", id.into()));
    }
    roster
}

/// Returns the number of the viewer whose view a guide shows.
fn shows(roster: &Roster, guide: Guide) -> Option<f32> {
    roster.view(guide, None, Duration::ZERO).map(|view| view.camera.pose().eye.x)
}

#[test]
fn a_guide_shows_what_its_viewer_sees_through_a_chain() {
    let roster = roster(4);
    assert_eq!(shows(&roster, Guide::Viewer(2)), Some(2.0));
    assert_eq!(roster.follow(2, Some(Guide::Viewer(1))), Ok(()));
    assert_eq!(roster.follow(3, Some(Guide::Viewer(2))), Ok(()));
    assert_eq!(shows(&roster, Guide::Viewer(2)), Some(1.0));
    assert!(roster.follow(1, Some(Guide::Viewer(3))).is_err(), "this is a ring");
    assert!(roster.follow(1, Some(Guide::Viewer(1))).is_err());
    assert!(roster.follow(1, Some(Guide::Viewer(9))).is_err());
    assert_eq!(shows(&roster, Guide::Tour), None);
    assert_eq!(roster.lead(3), None);
    assert_eq!(shows(&roster, Guide::Tour), Some(3.0), "who begins to lead leaves a guide");
    assert_eq!(roster.follow(3, Some(Guide::Viewer(2))), Ok(()));
    assert_eq!(shows(&roster, Guide::Tour), Some(1.0));
    assert!(roster.follow(1, Some(Guide::Tour)).is_err(), "the tour shows this viewer");
    assert_eq!(roster.title(Guide::Tour), "tour led by viewer 3");
}

#[test]
fn followers_are_told_and_have_the_last_view_until_they_leave_it() {
    let roster = roster(4);
    roster.follow(1, Some(Guide::Viewer(0))).expect("it is there");
    roster.follow(2, Some(Guide::Viewer(0))).expect("it is there");
    assert_eq!(roster.leave(0, false), [1, 2]);
    assert_eq!(shows(&roster, Guide::Viewer(0)), None);
    let last = |guide| roster.last_view(guide).map(|view| view.camera.pose().eye.x);
    assert_eq!(last(Guide::Viewer(0)), Some(0.0));
    // One who has left is in no list, and comes back no more.
    assert_eq!(roster.seen_by(3).others.len(), 2);
    roster.set_view(0, view("one", 9.0));
    roster.follow(1, None).expect("nothing is refused");
    assert_eq!(last(Guide::Viewer(0)), Some(0.0));
    assert!(roster.leave(2, false).is_empty());
    assert_eq!(last(Guide::Viewer(0)), None, "the last follower has left");
}

#[test]
fn the_lead_ends_with_the_leader_or_the_next_one() {
    let roster = roster(4);
    roster.lead(0);
    roster.follow(2, Some(Guide::Tour)).expect("there is a leader");
    assert_eq!((roster.lead(1), roster.lead(1)), (Some(0), None));
    assert_eq!((roster.leader(), roster.seen_by(1).followers), (Some(1), 1));
    assert!(roster.stop_leading(0, false).is_empty(), "another one leads");
    assert_eq!(roster.leave(1, false), [2]);
    assert_eq!((shows(&roster, Guide::Tour), roster.leader()), (None, None));
    assert_eq!(roster.last_view(Guide::Tour).map(|view| view.camera.pose().eye.x), Some(1.0));
    roster.lead(3);
    assert_eq!((roster.stop_leading(3, false), roster.leader()), (vec![2], None));
}

#[test]
fn a_viewer_sees_cameras_in_the_same_scene_and_who_is_with_them() {
    let roster = roster(3);
    roster.enter(3, shown_name("anna"), view("two", 3.0));
    roster.follow(1, Some(Guide::Viewer(0))).expect("it is there");
    roster.follow(2, Some(Guide::Tour)).expect("the tour needs no viewer");
    roster.lead(0);
    let seen = roster.seen_by(0);
    assert_eq!((seen.own.0, seen.followers), (0, 2));
    let looks: Vec<_> = seen.others.iter().map(|other| (other.number, other.looks_at.clone())).collect();
    assert_eq!(looks, [(1, LooksAt::Viewer(0)), (2, LooksAt::Tour), (3, LooksAt::Scene("two".into()))]);
    assert!(seen.others.iter().all(|other| other.camera.is_none()), "they follow, or are elsewhere");
    assert_eq!(seen.others[2].name.as_deref(), Some("anna"));
    assert_eq!(roster.seen_by(3).others[0].camera, None);
    roster.follow(1, None).expect("nothing is refused");
    assert!(roster.seen_by(0).others[0].camera.is_some());
    assert_eq!(roster.title(Guide::Viewer(3)), "with viewer 3 (anna)");
}

#[test]
fn names_are_short_and_plain() {
    let shown = |login: &str| shown_name(login).map(|name| name.to_string());
    assert_eq!(shown("anna.b-c_9"), Some("anna.b-c_9".to_owned()));
    assert_eq!(shown("\u{1b}[2J \u{202e}x\u{7f}"), Some("2Jx".to_owned()));
    assert_eq!(shown(&"x".repeat(10_000)), Some("x".repeat(16)));
    assert_eq!((shown(""), shown("\u{e4}\u{200b} ()")), (None, None));
}

#[test]
fn a_long_chain_shows_its_first_viewer_and_closes_no_ring() {
    let roster = roster(40);
    for id in 1..40 {
        roster.follow(id, Some(Guide::Viewer(id - 1))).expect("this is no ring");
    }
    assert_eq!(shows(&roster, Guide::Viewer(39)), Some(0.0));
    assert!(roster.follow(0, Some(Guide::Viewer(39))).is_err(), "this is a ring");
    // One in the middle, who follows another viewer already.
    assert!(roster.follow(20, Some(Guide::Viewer(39))).is_err(), "this is a ring");
    assert_eq!(shows(&roster, Guide::Viewer(39)), Some(0.0));
    assert_eq!(roster.follow(39, Some(Guide::Tour)), Ok(()));
    roster.lead(20);
    assert_eq!(shows(&roster, Guide::Viewer(39)), Some(20.0), "a leader follows no viewer");
}

#[test]
fn the_last_view_of_a_leader_is_kept_for_followers_without_a_path() {
    for (has_path, kept) in [(true, false), (false, true)] {
        let roster = roster(3);
        roster.follow(1, Some(Guide::Tour)).expect("the tour needs no viewer");
        roster.lead(0);
        assert_eq!(roster.stop_leading(0, has_path), [1]);
        assert_eq!(roster.last_view(Guide::Tour).is_some(), kept);
        roster.follow(1, None).expect("nothing is refused");
        assert_eq!(roster.last_view(Guide::Tour), None, "the last follower has left");
        roster.lead(2);
        assert!(roster.leave(2, has_path).is_empty());
        assert_eq!(roster.last_view(Guide::Tour), None, "the tour has no follower");
    }
}
