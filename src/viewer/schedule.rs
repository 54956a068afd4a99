//! When to draw, to trace, to refine and to wait: one decision, made from one snapshot of facts.
//!
//! The newest picture wins. A frame of a new view is begun when the last one can be sent; what refines a picture is given
//! up when its view changes; what is on the screen is made better only while it lasts. When nothing changes, there is
//! nothing to wait for.

use std::time::Duration;

/// What is being traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tracing {
    /// A frame of a new view.
    NewView,
    /// The next step of the last frame.
    Refinement,
}

/// What a driver knows of its two outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Busy {
    /// Whether bytes that were sent have not been taken yet.
    pub(crate) sending: bool,
    /// What is being traced.
    pub(crate) tracing: Option<Tracing>,
}

/// How the picture that was last begun stands to the one that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    /// It is of something else.
    Stale,
    /// It is of the same, and can be refined.
    Refinable,
    /// It is the one that is wanted, or there is nothing to see.
    Finished,
}

/// What the decision depends on. Times are those of the viewer's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Facts {
    pub(super) busy: Busy,
    pub(super) picture: Picture,
    /// Whether nothing has been shown yet, and the refinement of the first picture would soon be at its end.
    pub(super) holds_first_back: bool,
    /// When a frame of a new view was last begun.
    pub(super) begun: Option<Duration>,
    /// Up to when the eye has moved; `None` at rest.
    pub(super) moved_until: Option<Duration>,
    /// How far apart frames are at least.
    pub(super) frame_time: Duration,
    /// When the link takes the next bytes.
    pub(super) link_free_at: Duration,
    /// Whether the screen shows something else than it should.
    pub(super) is_changed: bool,
    /// When what it shows can be made better, if it can be.
    pub(super) improvable_at: Option<Duration>,
}

/// What is to be done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    /// Give up what refines a view that has changed.
    GiveUp,
    /// Bring the screen up to date.
    Draw,
    /// Begin a frame of the new view.
    Trace,
    /// Begin the next step of the last frame.
    Refine,
    /// Nothing, until then or until something happens.
    Wait(Option<Duration>),
}

/// Decides what is to be done at a time, up to which the eye has been moved if it moves.
///
/// Never returns a time that has passed: a driver would not sleep.
pub(super) fn decide(facts: &Facts, now: Duration) -> Action {
    let Facts { busy, picture, .. } = *facts;
    if picture == Picture::Stale && busy.tracing == Some(Tracing::Refinement) {
        return Action::GiveUp;
    }
    let (draw_at, frame_at) = (facts.draw_at(), facts.frame_at());
    if !busy.sending && draw_at.is_some_and(|at| at <= now) {
        return Action::Draw;
    }
    // Nothing is traced that cannot be sent.
    if !busy.sending && busy.tracing.is_none() && frame_at <= now {
        match picture {
            Picture::Stale => return Action::Trace,
            Picture::Refinable => return Action::Refine,
            Picture::Finished => {}
        }
    }
    Action::Wait(facts.wake_at(draw_at, frame_at))
}

impl Facts {
    /// Whether the first picture is not shown yet because its end is near: to show it twice would take longer.
    fn perfects_first(&self) -> bool {
        self.holds_first_back && self.picture == Picture::Refinable && self.moved_until.is_none()
    }

    /// The earliest time to draw, if nothing else happens. What would make a picture better waits while one of a newer view
    /// is on its way.
    fn draw_at(&self) -> Option<Duration> {
        if self.perfects_first() {
            return None;
        }
        let lasts = self.picture != Picture::Stale && self.busy.tracing != Some(Tracing::NewView);
        let at = if self.is_changed { Some(Duration::ZERO) } else { self.improvable_at.filter(|_| lasts) };
        at.map(|at| at.max(self.link_free_at))
    }

    /// The earliest time for the next frame, and for the next look at what moves.
    fn frame_at(&self) -> Duration {
        if self.perfects_first() {
            return Duration::ZERO;
        }
        let next = |since: Option<Duration>| since.map_or(Duration::ZERO, |since| since + self.frame_time);
        let at = if self.picture == Picture::Stale {
            next(self.begun)
        } else {
            next(self.moved_until).max(next(self.begun))
        };
        at.max(self.link_free_at)
    }

    /// How long there is nothing to do: for ever when nothing moves and the picture is done, or while bytes are taken, of
    /// whose end the driver knows.
    fn wake_at(&self, draw_at: Option<Duration>, frame_at: Duration) -> Option<Duration> {
        let Busy { sending, tracing } = self.busy;
        let moves = self.picture == Picture::Stale || self.moved_until.is_some();
        let can_refine = self.picture == Picture::Refinable;
        let lacks_frame = moves && tracing != Some(Tracing::NewView) || tracing.is_none() && can_refine;
        [lacks_frame.then_some(frame_at), draw_at].into_iter().flatten().filter(|_| !sending).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::option;
    use proptest::prelude::*;

    const NOW: Duration = Duration::from_secs(10);
    const LATER: Duration = Duration::from_secs(11);
    const FRAME: Duration = Duration::from_millis(16);

    /// Nothing moves, and all is as it should be.
    const AT_REST: Facts = Facts {
        busy: Busy { sending: false, tracing: None },
        picture: Picture::Finished,
        holds_first_back: false,
        begun: Some(Duration::from_secs(1)),
        moved_until: None,
        frame_time: FRAME,
        link_free_at: Duration::from_secs(2),
        is_changed: false,
        improvable_at: None,
    };

    fn tracing(tracing: Tracing) -> Busy {
        Busy { sending: false, tracing: Some(tracing) }
    }

    #[test]
    fn at_rest_nothing_is_waited_for() {
        assert_eq!(decide(&AT_REST, NOW), Action::Wait(None));
    }

    #[test]
    fn the_newest_picture_wins() {
        let stale = Facts { picture: Picture::Stale, ..AT_REST };
        assert_eq!(decide(&stale, NOW), Action::Trace);
        let refining = Facts { busy: tracing(Tracing::Refinement), ..stale };
        assert_eq!(decide(&refining, NOW), Action::GiveUp);
        // One that is being traced is shown first, however old it is then.
        let behind = Facts { busy: tracing(Tracing::NewView), ..stale };
        assert_eq!(decide(&behind, NOW), Action::Wait(None));
        assert_eq!(decide(&Facts { is_changed: true, ..behind }, NOW), Action::Draw);
    }

    #[test]
    fn frames_keep_their_distance() {
        let stale = Facts { picture: Picture::Stale, begun: Some(NOW), ..AT_REST };
        assert_eq!(decide(&stale, NOW), Action::Wait(Some(NOW + FRAME)));
        let moving = Facts { moved_until: Some(NOW), ..AT_REST };
        assert_eq!(decide(&moving, NOW), Action::Wait(Some(NOW + FRAME)));
        let slow = Facts { link_free_at: LATER, ..stale };
        assert_eq!(decide(&slow, NOW), Action::Wait(Some(LATER)));
        assert_eq!(decide(&Facts { is_changed: true, ..slow }, NOW), Action::Wait(Some(LATER)));
    }

    #[test]
    fn nothing_is_drawn_or_begun_that_cannot_be_sent() {
        for picture in [Picture::Stale, Picture::Refinable] {
            let busy = Busy { sending: true, tracing: None };
            let facts = Facts { busy, picture, is_changed: true, improvable_at: Some(Duration::ZERO), ..AT_REST };
            assert_eq!(decide(&facts, NOW), Action::Wait(None), "the driver knows when all is sent");
        }
    }

    #[test]
    fn what_is_shown_is_made_better_only_while_it_lasts() {
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
        let first = Facts { picture: Picture::Refinable, holds_first_back: true, is_changed: true, ..AT_REST };
        assert_eq!(decide(&first, NOW), Action::Refine);
        let refining = Facts { busy: tracing(Tracing::Refinement), ..first };
        assert_eq!(decide(&refining, NOW), Action::Wait(None));
        assert_eq!(decide(&Facts { holds_first_back: false, ..first }, NOW), Action::Draw);
        assert_eq!(decide(&Facts { picture: Picture::Finished, ..first }, NOW), Action::Draw);
    }

    fn time() -> impl Strategy<Value = Duration> {
        (0_u64..20_000).prop_map(Duration::from_millis)
    }

    fn busy() -> impl Strategy<Value = Busy> {
        let tracing = option::of(prop_oneof![Just(Tracing::NewView), Just(Tracing::Refinement)]);
        (any::<bool>(), tracing).prop_map(|(sending, tracing)| Busy { sending, tracing })
    }

    fn picture() -> impl Strategy<Value = Picture> {
        prop_oneof![Just(Picture::Stale), Just(Picture::Refinable), Just(Picture::Finished)]
    }

    prop_compose! {
        fn facts()(
            busy in busy(),
            picture in picture(),
            [holds_first_back, is_changed, moves] in any::<[bool; 3]>(),
            begun in option::of(time()),
            link_free_at in time(),
            improvable_at in option::of(time()),
        ) -> Facts {
            let (moved_until, frame_time) = (moves.then_some(NOW), FRAME);
            Facts {
                busy, picture, holds_first_back, begun, moved_until, frame_time, link_free_at, is_changed, improvable_at,
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
        fn what_is_begun_can_be_sent(facts in facts()) {
            match decide(&facts, NOW) {
                Action::Draw => prop_assert!(!facts.busy.sending),
                Action::Trace | Action::Refine => prop_assert_eq!(facts.busy, Busy::default()),
                Action::GiveUp => prop_assert_eq!(facts.busy.tracing, Some(Tracing::Refinement)),
                Action::Wait(_) => {}
            }
        }

        /// What is to be seen is seen without any other event than the end of what is under way.
        #[test]
        fn no_work_is_forgotten(facts in facts()) {
            let is_idle = facts.busy == Busy::default();
            let has_work = facts.is_changed || facts.picture != Picture::Finished || facts.moved_until.is_some();
            if is_idle && has_work {
                prop_assert_ne!(decide(&facts, NOW), Action::Wait(None));
            }
        }
    }
}
