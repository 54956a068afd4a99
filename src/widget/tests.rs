//! Tests of panes, drawn into buffers, with a background thread that a test can halt between
//! pictures.

use super::state::SceneState;
use super::view::SceneView;
use crate::camera::Grip;
use crate::cell::{CellMode, Glyphs};
use crate::export::frame_grid;
use crate::framebuffer::Resolution;
use crate::grid::Size;
use crate::maps::Map;
use crate::render::Sampling;
use crate::scene::Scene;
use ratatui_core::backend::TestBackend;
use ratatui_core::buffer::{Buffer, Cell};
use ratatui_core::layout::{Position, Rect};
use ratatui_core::terminal::Terminal;
use ratatui_core::widgets::StatefulWidget;
use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};

const AREA: Rect = Rect::new(0, 0, 20, 8);

fn scene() -> Scene {
    let text = include_str!("../../scenes/three_spheres.ron");
    Scene::from_ron("three_spheres.ron", text).expect("the scene is fine")
}

/// Draws a view into a buffer of `AREA` that is filled with `x`, and returns the buffer.
fn drawn(view: &SceneView<'_>, area: Rect, state: &mut SceneState) -> Buffer {
    let mut buffer = Buffer::filled(AREA, Cell::new("x"));
    view.render(area, &mut buffer, state);
    buffer
}

/// Returns a buffer with the view from the state's camera, traced in the draw call.
fn traced_in_draw_call(view: &SceneView<'_>, state: &SceneState) -> Buffer {
    drawn(view, AREA, &mut SceneState::new(state.camera()))
}

#[test]
fn a_state_is_send_and_sync() {
    fn takes<T: Send + Sync>(_: T) {}
    takes(SceneState::new(scene().camera()).in_background(|| {}));
}

#[test]
fn a_pane_shows_the_cells_of_a_frame() {
    let scene = scene();
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).expect("a backend without errors");
    for (cells, aspect) in [(CellMode::HALF_BLOCK, 2.0), (CellMode::RAMP, 1.7)] {
        let view = SceneView::new(&scene).cells(cells).cell_aspect(aspect);
        let mut state = SceneState::new(scene.camera());
        assert!(!state.is_current());
        terminal.draw(|frame| frame.render_stateful_widget(view, frame.area(), &mut state)).expect("no errors");
        let grid = frame_grid(&scene, cells, Size::new(80, 24), aspect);
        terminal.backend().assert_buffer(&Buffer::from(&grid));
        assert!(state.is_current());
    }
}

#[test]
fn an_implausible_cell_aspect_is_replaced() {
    let scene = scene();
    let state = SceneState::new(scene.camera());
    let usual = traced_in_draw_call(&SceneView::new(&scene), &state);
    for aspect in [f32::NAN, 0.0, -2.0, f32::INFINITY, 1e-30] {
        assert_eq!(traced_in_draw_call(&SceneView::new(&scene).cell_aspect(aspect), &state), usual, "{aspect}");
    }
    assert_ne!(traced_in_draw_call(&SceneView::new(&scene).cell_aspect(1.0), &state), usual);
}

#[test]
fn a_pane_is_clipped_to_the_buffer() {
    let scene = scene();
    let view = SceneView::new(&scene);
    for (area, inside) in [
        (Rect::new(3, 2, 10, 4), Rect::new(3, 2, 10, 4)),
        (Rect::new(15, 5, 40, 40), Rect::new(15, 5, 5, 3)),
        (Rect::new(0, 0, 65_535, 65_535), AREA),
    ] {
        let mut state = SceneState::new(scene.camera());
        let buffer = drawn(&view, area, &mut state);
        let grid = frame_grid(&scene, CellMode::HALF_BLOCK, Size::new(inside.width, inside.height), 2.0);
        for at in AREA.positions() {
            let wanted = Buffer::from(&grid);
            let wanted = inside.contains(at).then(|| wanted[(at.x - inside.x, at.y - inside.y)].clone());
            assert_eq!(buffer[at], wanted.unwrap_or(Cell::new("x")), "{area} at {at}");
        }
    }
    // A buffer need not begin at (0, 0).
    let mut buffer = Buffer::filled(Rect::new(7, 5, 4, 3), Cell::new("x"));
    view.render(Rect::new(0, 0, 9, 7), &mut buffer, &mut SceneState::new(scene.camera()));
    let grid = Buffer::from(&frame_grid(&scene, CellMode::HALF_BLOCK, Size::new(2, 2), 2.0));
    assert_eq!((&buffer[(8, 6)], &buffer[(9, 6)]), (&grid[(1, 1)], &Cell::new("x")));
}

#[test]
fn without_cells_nothing_is_drawn_or_found() {
    let scene = scene();
    let mut state = SceneState::new(scene.camera());
    drawn(&SceneView::new(&scene), AREA, &mut state);
    for area in
        [Rect::ZERO, Rect::new(3, 3, 0, 5), Rect::new(3, 3, 5, 0), Rect::new(20, 0, 5, 5), Rect::new(0, 8, 5, 5)]
    {
        for mut state in [SceneState::new(scene.camera()), SceneState::new(scene.camera()).in_background(|| {})] {
            let buffer = drawn(&SceneView::new(&scene), area, &mut state);
            assert_eq!(buffer, Buffer::filled(AREA, Cell::new("x")));
            assert!(!state.is_current() && !state.press(Position::ORIGIN, Grip::Turn));
        }
        // A draw call with an empty area leaves a pane without cells, even if it had some in an earlier draw call.
        drawn(&SceneView::new(&scene), area, &mut state);
        assert_eq!(state.cell_of(scene.camera().pose().target), None);
        assert!(AREA.positions().all(|at| state.hit(&scene, at).is_none()));
    }
}

#[test]
fn a_pane_too_large_for_a_picture_is_not_drawn() {
    let scene = scene();
    let shape = CellMode { glyphs: Glyphs::Shape, ..CellMode::HALF_BLOCK };
    let (across, down) = shape.pixels_per_cell();
    let rows = Resolution::MAX_PIXELS / (1000 * across * down) + 1;
    let mut buffer = Buffer::filled(Rect::new(0, 0, 1000, rows as u16), Cell::new("x"));
    let mut state = SceneState::new(scene.camera());
    SceneView::new(&scene).cells(shape).render(buffer.area, &mut buffer, &mut state);
    assert!(buffer.content.iter().all(|cell| cell.symbol() == "x") && !state.is_current());
}

#[test]
fn a_shown_picture_is_not_traced_again() {
    let scene = scene();
    let mut state = SceneState::new(scene.camera());
    let view = SceneView::new(&scene);
    let smaller = Rect { width: 12, ..AREA };
    let brighter = scene.clone().with_exposure(2.0).expect("an exposure");
    drawn(&view, AREA, &mut state);
    let mut is_kept = |scene: &Scene, view: &SceneView<'_>, area, turn: f32| {
        state.mark_shown_picture("!");
        state.orbit(turn, 0.0);
        let buffer = drawn(&view.clone().of(scene), area, &mut state);
        buffer[(0, 0)].symbol() == "!"
    };
    assert!(is_kept(&scene, &view, AREA, 0.0));
    assert!(is_kept(&scene.clone(), &view, AREA, 0.0), "a copy of the scene is the same one");
    assert!(!is_kept(&scene, &view, AREA, 0.1));
    assert!(is_kept(&scene, &view, AREA, 0.0));
    assert!(!is_kept(&scene, &view, smaller, 0.0));
    assert!(!is_kept(&brighter, &view, smaller, 0.0));
    assert!(!is_kept(&brighter, &view.clone().map(Map::Depth), smaller, 0.0));
    assert!(!is_kept(&brighter, &view.clone().cells(CellMode::RAMP), smaller, 0.0));
    assert!(!is_kept(&brighter, &view.clone().cell_aspect(1.5), smaller, 0.0));
    assert!(!is_kept(&brighter, &view.clone().sampling(Sampling::BEST), smaller, 0.0));
    assert!(is_kept(&brighter, &view.clone().sampling(Sampling::BEST), smaller, 0.0));
}

/// A state whose background thread stops after each picture, until the test lets it continue.
struct Held {
    // Fields are dropped in this order: without `go_on` the thread is not halted, and `state`, when dropped, waits for
    // it.
    go_on: Sender<()>,
    state: SceneState,
    woken: Receiver<()>,
}

impl Held {
    fn new(scene: &Scene) -> Self {
        let (wake, woken) = channel();
        let (go_on, may_go_on) = channel();
        let state = SceneState::new(scene.camera()).in_background(move || {
            // Both calls fail if the test has ended.
            let _ = wake.send(());
            let _ = may_go_on.recv();
        });
        Self { go_on, state, woken }
    }

    fn wait(&self) {
        self.woken.recv().expect("the thread is there");
    }

    fn go_on(&self) {
        self.go_on.send(()).expect("the thread is there");
    }

    /// Ends the thread and returns the number of pictures that it has finished since the last
    /// `wait`.
    fn end(self) -> usize {
        drop(self.go_on);
        drop(self.state);
        self.woken.iter().count()
    }
}

#[test]
fn of_several_requests_only_the_newest_is_traced() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut held = Held::new(&scene);
    let blank = Buffer::filled(AREA, Cell::new("x"));
    assert_eq!(drawn(&view, AREA, &mut held.state), blank, "nothing is there yet");
    held.wait();
    let first = traced_in_draw_call(&view, &held.state);
    for _ in 0..5 {
        held.state.orbit(0.2, 0.0);
        assert_eq!(drawn(&view, AREA, &mut held.state), first, "the last picture stays");
        assert!(!held.state.is_current());
    }
    held.go_on();
    held.wait();
    assert_eq!(drawn(&view, AREA, &mut held.state), traced_in_draw_call(&view, &held.state));
    assert!(held.state.is_current());
    held.state.orbit(0.2, 0.0);
    assert!(!held.state.is_current(), "the camera has moved since");
    assert_eq!(held.end(), 0, "the others are never traced");
}

#[test]
fn refinement_follows_unless_the_view_has_changed() {
    let scene = scene();
    let (one, best) = (SceneView::new(&scene), SceneView::new(&scene).sampling(Sampling::BEST));
    let mut held = Held::new(&scene);
    drawn(&best, AREA, &mut held.state);
    held.wait();
    assert_eq!(drawn(&best, AREA, &mut held.state), traced_in_draw_call(&one, &held.state));
    assert!(!held.state.is_current());
    held.go_on();
    held.wait();
    assert_eq!(drawn(&best, AREA, &mut held.state), traced_in_draw_call(&best, &held.state));
    assert!(held.state.is_current());
    // The view changes after the first picture is finished, and again while it is being refined.
    held.state.orbit(0.2, 0.0);
    drawn(&best, AREA, &mut held.state);
    held.go_on();
    held.wait();
    held.state.orbit(0.2, 0.0);
    drawn(&best, AREA, &mut held.state);
    held.go_on();
    held.wait();
    assert_eq!(drawn(&best, AREA, &mut held.state), traced_in_draw_call(&one, &held.state), "of the newest view");
    held.go_on();
    held.wait();
    assert_eq!(drawn(&best, AREA, &mut held.state), traced_in_draw_call(&best, &held.state));
    assert_eq!(held.end(), 0);
}

#[test]
fn a_picture_of_another_size_stays_until_the_next_arrives() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut held = Held::new(&scene);
    let small = Rect::new(2, 1, 6, 3);
    drawn(&view, small, &mut held.state);
    held.wait();
    let old = drawn(&view, small, &mut held.state);
    let larger = drawn(&view, Rect::new(2, 1, 10, 5), &mut held.state);
    assert_eq!(larger, old, "its cells are where they were, and no others are drawn");
    assert!(
        held.state.hit(&scene, Position::new(7, 3)).is_some() && held.state.hit(&scene, Position::new(8, 3)).is_none()
    );
    let smaller = drawn(&view, Rect::new(2, 1, 3, 3), &mut held.state);
    assert_eq!((&smaller[(4, 3)], smaller[(5, 3)].symbol()), (&old[(4, 3)], "x"));
}

/// Dropping a state cancels the picture in progress, which here would take for ever.
#[test]
fn dropping_a_state_cancels_its_picture() {
    let scene = scene();
    let (wake, woken) = channel::<()>();
    let mut state = SceneState::new(scene.camera()).in_background(move || _ = wake.send(()));
    drawn(&SceneView::new(&scene).sampling(NonZeroU32::MAX), AREA, &mut state);
    while !state.has_taken_request() {
        std::thread::yield_now();
    }
    drop(state);
    assert!(woken.recv().is_err(), "the thread is gone, and has made no picture");
}

#[test]
fn a_panic_in_the_background_continues_in_a_draw_call() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut state = SceneState::new(scene.camera()).in_background(|| panic!("a test asked for it"));
    let panic = loop {
        match catch_unwind(AssertUnwindSafe(|| drawn(&view, AREA, &mut state))) {
            Ok(_) => std::thread::yield_now(),
            Err(panic) => break panic,
        }
    };
    assert_eq!(panic.downcast_ref(), Some(&"a test asked for it"));
}

#[test]
fn the_point_hit_through_a_cell_is_shown_in_this_cell() {
    let scene = scene();
    let view = SceneView::new(&scene).cell_aspect(1.7);
    let area = Rect::new(3, 1, 40, 6);
    let mut state = SceneState::new(&scene.camera().orbited(0.3, 0.1));
    drawn(&view, area, &mut state);
    let mut found = 0;
    for at in AREA.positions() {
        let hit = state.hit(&scene, at);
        assert!(hit.is_none() || area.intersection(AREA).contains(at), "{at}");
        if let (Some(hit), Some(ray)) = (hit, state.ray_through(at)) {
            assert_eq!(state.cell_of(ray.at(hit.t)), Some(at));
            found += 1;
        }
    }
    assert!(found > 30, "{found}");
    let pose = state.camera().pose();
    assert_eq!(state.cell_of(pose.eye + (pose.eye - pose.target)), None, "behind the eye");
    assert_eq!(state.cell_of(pose.target + 100.0 * state.camera().basis().u), None, "beside the picture");
}

#[test]
fn a_dragged_point_follows_the_pointer() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut state = SceneState::new(scene.camera());
    drawn(&view, Rect { x: 4, ..AREA }, &mut state);
    let before = *state.camera();
    state.drag(Position::new(9, 3));
    assert!(!state.press(Position::new(3, 3), Grip::Pan), "beside the pane");
    state.drag(Position::new(9, 3));
    assert_eq!(*state.camera(), before, "nothing is held");
    // The point is in the middle of a cell, so that rounding errors do not move it to another cell.
    let ray = state.ray_through(Position::new(12, 3)).expect("inside");
    let point = ray.at(before.target_distance());
    let start = Position::new(12, 3);
    assert!(state.press(start, Grip::Pan));
    state.drag(Position::new(start.x + 5, start.y - 2));
    state.drag(Position::new(start.x + 4, start.y - 2));
    drawn(&view, Rect { x: 4, ..AREA }, &mut state);
    assert_eq!(state.cell_of(point), Some(Position::new(start.x + 4, start.y - 2)));
    state.release();
    let after = *state.camera();
    state.drag(start);
    assert_eq!(*state.camera(), after, "it has been let go of");
    assert!(state.press(start, Grip::Turn));
    state.drag(Position::new(start.x + 4, start.y));
    let to_the_left = (state.camera().pose().eye - after.pose().eye).dot(after.basis().u);
    assert!(to_the_left < 0.0 && state.camera().pose().target == after.pose().target, "{to_the_left}");
}

#[test]
fn the_wheel_keeps_the_point_under_the_pointer() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut state = SceneState::new(scene.camera());
    assert!(!state.scroll(&scene, Position::new(5, 5), 1.0), "nothing is drawn yet");
    drawn(&view, AREA, &mut state);
    let at = Position::new(5, 5);
    let ray = state.ray_through(at).expect("inside");
    let point = ray.at(state.hit(&scene, at).expect("the floor").t);
    let distance = |state: &SceneState| state.camera().pose().eye.distance(point);
    let before = distance(&state);
    assert!(state.scroll(&scene, at, 3.0) && distance(&state) < 0.8 * before);
    drawn(&view, AREA, &mut state);
    assert_eq!(state.cell_of(point), Some(at));
    assert!(state.scroll(&scene, at, -3.0) && (distance(&state) - before).abs() < 1e-3 * before);
}

#[test]
fn keys_move_the_camera() {
    let scene = scene();
    let view = SceneView::new(&scene);
    let mut state = SceneState::new(scene.camera());
    state.frame(&scene);
    drawn(&view, AREA, &mut state);
    state.frame(&scene);
    drawn(&view, AREA, &mut state);
    let bounds = scene.bounds().expect("three spheres");
    assert!([bounds.min, bounds.max].iter().all(|&corner| state.cell_of(corner).is_some()));
    let ray = state.ray_through(Position::new(10, 4)).expect("inside");
    let point = ray.at(state.camera().target_distance());
    state.pan(0.25, 0.0);
    drawn(&view, AREA, &mut state);
    assert_eq!(state.cell_of(point), Some(Position::new(6, 4)), "a quarter of 16 pixels, which are a column wide");
    for factor in [0.5, 2.0] {
        (0..200).for_each(|_| state.nearer(factor));
        let distance = state.camera().target_distance();
        assert!(
            distance > 0.9e-3 * state.initial_target_distance() && distance < 1.1e4 * state.initial_target_distance(),
            "{distance}"
        );
    }
}

#[test]
fn a_moving_scene_is_shown_at_its_time() {
    let scene = Scene::from_ron(
        "ball",
        "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, \
         objects: [Implicit(f: \"x^2 + y^2 + z^2 = 1 + time\", bounds: Box(min: (-2, -2, -2), max: (2, 2, 2)))])",
    );
    let (scene, area) = (scene.unwrap(), AREA);
    let mut state = SceneState::new(scene.camera());
    let [first, second, again] = [0.0, 2.0, 0.0].map(|seconds| {
        let moved = scene.clone().at_time(seconds);
        drawn(&SceneView::new(&moved), area, &mut state)
    });
    assert_ne!(first, second, "the ball has grown");
    assert_eq!(first, again);
}
