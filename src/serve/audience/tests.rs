use super::super::guide::Guide;
use super::*;
use crate::camera::Camera;
use crate::capabilities::{Capabilities, Shifts, USUAL_CELL_ASPECT};
use crate::grid::{HalfBlocks, Size};
use crate::maps::Map;
use crate::scene::Scene;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

const TICK: Duration = Duration::from_millis(100);

fn scene() -> Scene {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, \
                objects: [Sphere(center: (1, 0, 0), radius: 1)])";
    Scene::from_ron("x.ron", text).expect("a scene")
}

/// An audience with a clock, and the drawing of its frames.
struct Harness {
    audience: Audience,
    drawing: Drawing,
    scene: Scene,
    now: Duration,
}

impl Harness {
    fn new() -> Self {
        let capabilities = Capabilities {
            cell_mode: cell::CellMode::HALF_BLOCK,
            resting_glyphs: None,
            cell_aspect: USUAL_CELL_ASPECT,
            half_blocks: HalfBlocks::Lower,
            light_background: false,
            synchronized_output: false,
            shifts: Shifts::Off,
        };
        let class = AudienceClass { guide: Guide::Tour, size: Size::new(40, 12), capabilities };
        Self { audience: Audience::new(class), drawing: Drawing::new(&class), scene: scene(), now: TICK }
    }

    /// Draws the next tick's frame of a view from `x`, and returns whether there is one.
    fn draw(&mut self, x: f32) -> bool {
        self.draw_until(x, Some(&Cancellation::default()))
    }

    fn draw_until(&mut self, x: f32, refine: Option<&Cancellation>) -> bool {
        self.now += TICK;
        let camera = Camera::look_at(glam::Vec3::new(x, 0.0, 5.0), glam::Vec3::ZERO).expect("a camera");
        let view = GuideView { name: "x".into(), scene: self.scene.clone(), camera, map: Map::Shaded };
        let line = GuideLine { title: "tour".to_owned(), watching: 1 };
        self.drawing.draw(&self.audience, (view, line), (AudienceLimits::default(), self.now), refine).1
    }

    fn shown(&mut self) -> &mut Shown {
        self.drawing.shown.as_mut().expect("a frame")
    }
}

/// Returns the bytes that a follower would send now.
fn sent(follower: &mut Follower) -> Option<Bytes> {
    match pin!(follower.next_bytes()).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(bytes) => Some(bytes),
        Poll::Pending => None,
    }
}

#[test]
fn a_picture_at_rest_is_refined_once_and_kept_for_later_followers() {
    let mut harness = Harness::new();
    let mut first = harness.audience.follow();
    assert!(harness.draw(0.0) && sent(&mut first).is_some());
    assert!(!harness.shown().is_refined);
    assert!(harness.draw(0.0) && harness.shown().is_refined);
    assert!(sent(&mut first).is_some(), "the edges are smoother");
    assert!(!harness.draw(0.0), "it rests");
    // A picture that no trace would make shows that there is none.
    let other = Grid::new(Size::new(40, 12));
    harness.shown().picture = other.clone();
    let mut second = harness.audience.follow();
    assert!(harness.draw(0.0) && sent(&mut second).is_some());
    assert!(harness.shown().picture == other);
    assert!(harness.draw(1.0) && harness.shown().picture != other, "a new view is traced");
}

#[test]
fn a_picture_at_rest_is_refined_when_that_delays_no_viewer() {
    let mut harness = Harness::new();
    let mut follower = harness.audience.follow();
    assert!(harness.draw(0.0) && sent(&mut follower).is_some());
    let cancelled = Cancellation::default();
    cancelled.cancel();
    for refine in [None, Some(&cancelled)] {
        assert!(!harness.draw_until(0.0, refine) && !harness.shown().is_refined);
        assert_eq!(sent(&mut follower), None);
    }
    assert!(harness.draw(0.0) && harness.shown().is_refined);
    assert!(sent(&mut follower).is_some(), "the edges are smoother");
}

#[test]
fn followers_go_on_with_a_key_frame_after_a_panic() {
    let mut harness = Harness::new();
    let mut follower = harness.audience.follow();
    assert!(harness.draw(0.0) && sent(&mut follower).is_some());
    harness.drawing = Drawing::new(&harness.audience.class);
    harness.audience.start_again();
    assert!(sent(&mut follower).is_none(), "there is no frame yet");
    assert!(harness.draw(1.0));
    let key = harness.audience.frames.borrow().key.clone();
    assert!(key.is_some(), "a frame for any screen");
    assert_eq!(sent(&mut follower), key);
}
