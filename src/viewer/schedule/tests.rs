use super::*;
use proptest::option;
use proptest::prelude::*;

const NOW: Duration = Duration::from_secs(10);
const LATER: Duration = Duration::from_secs(11);
const FRAME: Duration = Duration::from_millis(16);

/// Facts at rest: nothing moves, and the screen is up to date.
const AT_REST: Facts = Facts {
    busy: DriverState { sending: false, tracing: None },
    picture: PictureState::Finished,
    holds_first_back: false,
    begun: Some(Duration::from_secs(1)),
    advanced_to: None,
    min_frame_interval: FRAME,
    next_send_at: Duration::from_secs(2),
    is_changed: false,
    improvable_at: None,
};

fn tracing(tracing: Tracing) -> DriverState {
    DriverState { sending: false, tracing: Some(tracing) }
}

#[test]
fn at_rest_nothing_is_waited_for() {
    assert_eq!(decide(&AT_REST, NOW), Action::Wait(None));
}

#[test]
fn the_newest_picture_wins() {
    let stale = Facts { picture: PictureState::Stale, ..AT_REST };
    assert_eq!(decide(&stale, NOW), Action::Trace);
    let refining = Facts { busy: tracing(Tracing::Refinement), ..stale };
    assert_eq!(decide(&refining, NOW), Action::CancelRefinement);
    // A frame of a view that is no longer wanted is nevertheless finished and drawn before the next one is begun.
    let behind = Facts { busy: tracing(Tracing::NewView), ..stale };
    assert_eq!(decide(&behind, NOW), Action::Wait(None));
    assert_eq!(decide(&Facts { is_changed: true, ..behind }, NOW), Action::Draw);
}

#[test]
fn frames_keep_their_distance() {
    let stale = Facts { picture: PictureState::Stale, begun: Some(NOW), ..AT_REST };
    assert_eq!(decide(&stale, NOW), Action::Wait(Some(NOW + FRAME)));
    let moving = Facts { advanced_to: Some(NOW), ..AT_REST };
    assert_eq!(decide(&moving, NOW), Action::Wait(Some(NOW + FRAME)));
    let slow = Facts { next_send_at: LATER, ..stale };
    assert_eq!(decide(&slow, NOW), Action::Wait(Some(LATER)));
    assert_eq!(decide(&Facts { is_changed: true, ..slow }, NOW), Action::Wait(Some(LATER)));
}

#[test]
fn nothing_is_drawn_or_begun_that_cannot_be_sent() {
    for picture in [PictureState::Stale, PictureState::Refinable] {
        let busy = DriverState { sending: true, tracing: None };
        let facts = Facts { busy, picture, is_changed: true, improvable_at: Some(Duration::ZERO), ..AT_REST };
        assert_eq!(decide(&facts, NOW), Action::Wait(None), "the driver knows when all is sent");
    }
}

#[test]
fn a_picture_is_refined_only_while_it_is_current() {
    let improvable = Facts { improvable_at: Some(Duration::ZERO), ..AT_REST };
    assert_eq!(decide(&improvable, NOW), Action::Draw);
    assert_eq!(decide(&Facts { improvable_at: Some(LATER), ..AT_REST }, NOW), Action::Wait(Some(LATER)));
    let replaced = Facts { busy: tracing(Tracing::NewView), ..improvable };
    assert_eq!(decide(&replaced, NOW), Action::Wait(None));
    let refined = Facts { busy: tracing(Tracing::Refinement), ..improvable };
    assert_eq!(decide(&refined, NOW), Action::Draw);
}

#[test]
fn the_first_picture_is_held_back_only_for_a_refinement_that_soon_ends() {
    let first = Facts { picture: PictureState::Refinable, holds_first_back: true, is_changed: true, ..AT_REST };
    assert_eq!(decide(&first, NOW), Action::Refine);
    let refining = Facts { busy: tracing(Tracing::Refinement), ..first };
    assert_eq!(decide(&refining, NOW), Action::Wait(None));
    assert_eq!(decide(&Facts { holds_first_back: false, ..first }, NOW), Action::Draw);
    assert_eq!(decide(&Facts { picture: PictureState::Finished, ..first }, NOW), Action::Draw);
}

fn time() -> impl Strategy<Value = Duration> {
    (0_u64..20_000).prop_map(Duration::from_millis)
}

fn busy() -> impl Strategy<Value = DriverState> {
    let tracing = option::of(prop_oneof![Just(Tracing::NewView), Just(Tracing::Refinement)]);
    (any::<bool>(), tracing).prop_map(|(sending, tracing)| DriverState { sending, tracing })
}

fn picture() -> impl Strategy<Value = PictureState> {
    prop_oneof![Just(PictureState::Stale), Just(PictureState::Refinable), Just(PictureState::Finished)]
}

prop_compose! {
    fn facts()(
        busy in busy(),
        picture in picture(),
        [holds_first_back, is_changed, moves] in any::<[bool; 3]>(),
        begun in option::of(time()),
        next_send_at in time(),
        improvable_at in option::of(time()),
    ) -> Facts {
        let (advanced_to, min_frame_interval) = (moves.then_some(NOW), FRAME);
        Facts {
            busy, picture, holds_first_back, begun, advanced_to, min_frame_interval, next_send_at, is_changed,
            improvable_at,
        }
    }
}

proptest! {
    #[test]
    fn no_time_is_waited_for_that_has_passed(facts in facts()) {
        if let Action::Wait(Some(until)) = decide(&facts, NOW) {
            prop_assert!(until > NOW, "{until:?}");
        }
    }

    #[test]
    fn a_begun_frame_can_be_sent(facts in facts()) {
        match decide(&facts, NOW) {
            Action::Draw => prop_assert!(!facts.busy.sending),
            Action::Trace | Action::Refine => prop_assert_eq!(facts.busy, DriverState::default()),
            Action::CancelRefinement => prop_assert_eq!(facts.busy.tracing, Some(Tracing::Refinement)),
            Action::Wait(_) => {}
        }
    }

    /// Unless frames or bytes are in progress, whose ends wake the driver, a timer runs while work
    /// is left.
    #[test]
    fn no_work_is_forgotten(facts in facts()) {
        let is_idle = facts.busy == DriverState::default();
        let has_work = facts.is_changed || facts.picture != PictureState::Finished || facts.advanced_to.is_some();
        if is_idle && has_work {
            prop_assert_ne!(decide(&facts, NOW), Action::Wait(None));
        }
    }
}
