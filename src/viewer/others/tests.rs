use super::*;
use crate::app::Tracer;
use crate::capabilities::CellMode;
use crate::cell;
use crate::control::{Command, Keymap};
use crate::grid::{Grid, Size};
use crate::progress::Cancellation;
use crate::render::Sampling;
use crate::scene::Scene;
use crate::viewer::layers::{Canvas, FrameStatistics, Layer};
use crate::viewer::view_layout::ViewLayout;
use crate::viewer::{Frame, Job, Shot};
use glam::Vec3;
use std::num::NonZeroU32;
use std::time::Duration;

/// Returns a frame of 80x24 cells of a ball, seen from (0, 0, 5).
fn frame() -> Frame {
    let text = "(camera: (eye: (0, 0, 5), target: (0, 0, 0)), ambient: 1, \
                objects: [Sphere(center: (0, 0, 0), radius: 0.5)])";
    let scene = Scene::from_ron("ball", text).expect("a scene");
    let shot = Shot {
        scene: 0,
        lights: 0,
        time: Duration::ZERO,
        camera: *scene.camera(),
        outside: None,
        resolution: cell::resolution(CellMode::HALF_BLOCK, Size::new(80, 24), 2.0).expect("a small screen"),
        layout: ViewLayout::default(),
        orders: false,
        geometry: false,
    };
    let job = Job { scene, shot, sampling: Sampling::Each(NonZeroU32::MIN), refines: false };
    Tracer::new(1).trace_for(0, &job, &Cancellation::default()).unwrap_or_else(|_| panic!("nothing cancels it"))
}

/// Returns the rows of text that a layer draws over a frame.
fn drawn(layer: &mut impl Layer, size: Size) -> Vec<String> {
    let (mut grid, keymap, frame) = (Grid::new(size), Keymap::default(), frame());
    grid.clear(size);
    layer.draw(&mut Canvas {
        grid: &mut grid,
        cell_mode: CellMode::HALF_BLOCK,
        keymap: &keymap,
        modes: &[],
        frame: Some(&frame),
        name: "",
        wipe: 0.5,
        figures: FrameStatistics::default(),
        status_rows: 0,
        note_rows: 1,
    });
    crate::export::text(&grid).lines().map(str::to_owned).collect()
}

fn other(number: u64, eye: Vec3) -> OtherViewer {
    let camera = Camera::look_at(eye, Vec3::new(0.0, 3.0, 0.0)).ok();
    OtherViewer { number, name: None, looks_at: LooksAt::Scene("ball".into()), camera }
}

fn viewers(others: Vec<OtherViewer>) -> OtherViewers {
    OtherViewers { own: (5, None), followers: 0, others }
}

#[test]
fn no_key_of_the_view_at_home_is_for_others() {
    let keymap = Keymap::default();
    let of_server = [Command::Tour, Command::Lead, Command::ListViewers, Command::MarkViewers];
    assert!(keymap.bindings().iter().all(|row| !of_server.contains(&row.command)));
}

#[test]
fn marks_are_at_cameras_in_the_picture_that_nothing_hides() {
    let named = OtherViewer { name: Some("anna".into()), ..other(9, Vec3::new(-2.0, 1.0, 0.0)) };
    let elsewhere = OtherViewer { camera: None, ..other(4, Vec3::ZERO) };
    let others = vec![
        other(1, Vec3::new(1.0, 1.0, 0.0)),
        // Behind the ball, behind the eye, at the eye itself and outside the picture.
        other(2, Vec3::new(0.0, 0.0, -3.0)),
        other(3, Vec3::new(0.0, 1.0, 9.0)),
        other(6, Vec3::new(0.0, 0.0, 5.0)),
        other(7, Vec3::new(0.0, 90.0, 0.0)),
        elsewhere,
        named,
    ];
    let mut marks = OtherEyes::new(viewers(others));
    let rows = drawn(&mut marks, Size::new(80, 24));
    let text = rows.join("\n");
    assert!(text.contains("(1)") && text.contains("(9 anna)"), "{text}");
    assert!([2, 3, 4, 6, 7].iter().all(|number| !text.contains(&format!("({number})"))), "{text}");
    // A line of dots leads from the eye in the direction of the camera, which is upwards.
    let row = rows.iter().position(|row| row.contains("(1)")).expect("a row");
    assert!(rows[row - 1].chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "{text}");
    assert!(rows[0].ends_with(" 8 watching") || rows[0].contains(" 8 watching "), "{text}");
    // A tiny screen has no room, and no mark goes beyond it.
    for size in [Size::new(1, 1), Size::new(5, 2), Size::new(40, 12)] {
        assert!(drawn(&mut marks, size).len() <= usize::from(size.rows));
    }
}

#[test]
fn the_list_has_nine_on_a_page_and_each_digit_is_that_of_its_row() {
    let others = |count| (0..count).map(|number| other(10 + number, Vec3::ONE)).collect();
    let (screen, size) = (theme::area(Size::new(80, 24)), Size::new(80, 24));
    let mut list = ViewerList::new(viewers(others(11)));
    let text = drawn(&mut list, size).join("\n");
    assert!(text.contains("12 watching, page 1 of 2") && text.contains("you are viewer 5"), "{text}");
    assert!(text.contains("1  viewer 10  ball") && text.contains("9  viewer 18  ball"), "{text}");
    assert_eq!([1, 9].map(|digit| list.number_of(digit, screen)), [Some(10), Some(18)]);
    let mut list = list.next_page(screen).expect("a second page");
    let text = drawn(&mut list, size).join("\n");
    assert!(text.contains("2  viewer 20  ball") && !text.contains("viewer 18"), "{text}");
    assert_eq!([0, 1, 2, 3].map(|digit| list.number_of(digit, screen)), [None, Some(19), Some(20), None]);
    // Some have left meanwhile: the last page that there is.
    list.set_viewers(viewers(others(3)));
    assert_eq!(list.number_of(1, screen), Some(10));
    assert!(list.next_page(screen).is_none());
    // A low screen has fewer on a page.
    let low = theme::area(Size::new(40, 12));
    let list = ViewerList::new(viewers(others(11)));
    assert_eq!([8, 9].map(|digit| list.number_of(digit, low)), [Some(17), None]);
    assert_eq!(list.next_page(low).expect("a second page").number_of(3, low), Some(20));
}
