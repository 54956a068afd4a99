//! The text of the comparison of image order with object order: progress, tests and times.

use super::pace::BuildPace;
use crate::control::Command;
use crate::rasterize::{Comparison, OrderTimes};
use crate::viewer::help::key_names;
use crate::viewer::layers::Canvas;
use crate::viewer::metadata::grouped;
use std::time::Duration;
use unicode_width::UnicodeWidthStr;

/// Least width in columns of each half of the text at which the orders' questions are shown.
// Each half has the question of its order. The longer one, "at what pixels is this object visible?", has 38 characters.
const MIN_QUESTION_COLUMNS: usize = 38;

/// Least height of the screen in rows at which the table of times is shown before the build ends.
///
/// In wide text it is also the least height at which the step is shown.
const MIN_PANEL_TEXT_ROWS: u16 = 20;

/// The width of a number in the table, in columns.
const NUMBER: usize = 7;

/// Returns the number of lines of text while the pictures are built, including the row of keys.
pub(super) fn height(columns: u16, rows: u16) -> u16 {
    let is_wide = half_width(columns) >= MIN_QUESTION_COLUMNS;
    let step = u16::from(is_wide && rows >= MIN_PANEL_TEXT_ROWS);
    let table = if rows >= MIN_PANEL_TEXT_ROWS { 3 } else { 0 };
    3 + step + table + 1
}

/// Returns the width in columns of the text below each picture.
fn half_width(columns: u16) -> usize {
    // Leaves a column for the line between the pictures, and one for the blank before each half.
    usize::from((columns - 1) / 2).saturating_sub(1)
}

/// Returns the lines of text to show after this number of tests. They call each object `name`:
/// "object" or "triangle".
pub(super) fn lines(comparison: &Comparison, name: &str, tests: u64, columns: u16, rows: u16) -> Vec<String> {
    let half = half_width(columns);
    let is_built = tests >= comparison.max_total_tests();
    let (pixels, objects) = (comparison.image_tests.len(), comparison.object_tests.len());
    let built = comparison.built_pixels(tests);
    let drawn = comparison.object_tests.partition_point(|&until| until <= tests);
    let is_wide = half >= MIN_QUESTION_COLUMNS;
    let mut pairs = vec![if is_wide {
        let image = tests_each(&comparison.image_tests).filter(|_| built == pixels).unwrap_or_default();
        let object = tests_each(&comparison.object_tests).filter(|_| drawn == objects).unwrap_or_default();
        let image = format!("Image order: {}{image}", progress("pixel", built, pixels));
        [image, format!("Object order: {}{object}", progress(name, drawn, objects))]
    } else {
        ["image order".to_owned(), "object order".to_owned()]
    }];
    if is_wide {
        let questions = ["what object is visible at this pixel?", "at what pixels is this object visible?"];
        pairs.push(questions.map(str::to_owned));
    } else if !is_built {
        pairs.push([progress("pixel", built, pixels), progress(name, drawn, objects)]);
    }
    let figures = |of: &[u64], time: Duration| {
        let all = of.last().copied().unwrap_or(0);
        let tests =
            if is_wide { format!("{} of {} tests; ", number(tests.min(all)), number(all)) } else { String::new() };
        format!("{tests}{} ms", milliseconds(time))
    };
    let OrderTimes { image, object } = comparison.times;
    pairs.push([figures(&comparison.image_tests, image), figures(&comparison.object_tests, object)]);
    let mut lines: Vec<_> = pairs.into_iter().map(|[left, right]| format!("{left:<half$}  {right}")).collect();
    if is_wide && rows >= MIN_PANEL_TEXT_ROWS {
        lines.push(STEP.to_owned());
    }
    if is_built || rows >= MIN_PANEL_TEXT_ROWS {
        lines.extend(times_table(comparison, is_wide));
    }
    lines
}

/// Returns the progress as text, such as `pixel 3 of 800`, or `800 pixels` at the end.
fn progress(name: &str, done: usize, all: usize) -> String {
    if done == all {
        format!("{} {name}s", grouped(all))
    } else {
        format!("{name} {} of {}", grouped(done + 1), grouped(all))
    }
}

/// Returns the mean number of tests of a pixel or object as text, such as ` x 2.5 tests`.
///
/// `until` has the number of tests up to and including each of them; `None` if there are none.
fn tests_each(until: &[u64]) -> Option<String> {
    let mean = *until.last()? as f64 / until.len() as f64;
    let text = if mean < 9.95 { format!("{mean:.1}") } else { number(mean.round() as u64) };
    Some(format!(" x {text} tests"))
}

/// The step by which both pictures advance, in words above the table of times, if there is room.
const STEP: &str = "A step is one test on each side: of a ray or pixel against an object or box.";

/// The meaning of the times, in words beside the table of times, if there is room.
const TIMES: [&str; 3] = ["times of whole pictures", "at full speed, without", "this slow build"];

/// Returns a table of the times of both orders for growing numbers of spheres.
fn times_table(comparison: &Comparison, is_wide: bool) -> [String; 3] {
    let names = if is_wide {
        ["spheres in a cube", "image order, ms", "object order, ms"]
    } else {
        ["spheres", "image ms", "object ms"]
    };
    // Wide enough for the longest name.
    let first = if is_wide { 20 } else { 9 };
    let rows: [Vec<String>; 3] = [
        comparison.growth.iter().map(|(number, _)| grouped(*number as usize)).collect(),
        comparison.growth.iter().map(|(_, times)| milliseconds(times.image)).collect(),
        comparison.growth.iter().map(|(_, times)| milliseconds(times.object)).collect(),
    ];
    let mut names = names.into_iter().zip(TIMES);
    rows.map(|row| {
        let (name, about) = names.next().unwrap_or_default();
        let line = row.iter().fold(format!("{name:<first$}"), |line, number| line + &format!("{number:>NUMBER$}"));
        if is_wide { format!("{line}    {about}") } else { line }
    })
}

/// Returns a time in milliseconds as text, with up to three decimals: 0.123, 1.23, 12.3, 1234.
fn milliseconds(time: Duration) -> String {
    let time = 1e3 * time.as_secs_f64();
    let decimals = [1.0, 10.0, 100.0].iter().filter(|&&limit| time < limit).count();
    format!("{time:.decimals$}")
}

fn number(tests: u64) -> String {
    grouped(tests as usize)
}

/// Returns the row that names the keys of the comparison.
pub(super) fn keys(canvas: &Canvas<'_>, pace: &BuildPace) -> String {
    let key = |commands: &[Command], does: &str| {
        key_names(canvas.keymap, canvas.modes, commands).map(|keys| format!("{keys} {does}"))
    };
    let pause = match (pace.is_by_steps(), pace.is_paused()) {
        (true, _) => "builds a step",
        (false, true) => "goes on",
        (false, false) => "pauses",
    };
    let speed = format!("speed {}", pace.factor_text());
    let mut parts: Vec<_> = [
        key(&[Command::BuildPause], pause),
        key(&[Command::BuildFaster, Command::BuildSlower], &speed).filter(|_| !pace.is_by_steps()),
        key(&[Command::BuildAgain], "again"),
        key(&[Command::Close], "leaves"),
    ]
    .into_iter()
    .flatten()
    .collect();
    let width = usize::from(canvas.screen().width).saturating_sub(2);
    // If the row is too long, the keys that are used least are left out first.
    while parts.len() > 2 && parts.join("; ").width() > width {
        parts.remove(parts.len() - 2);
    }
    parts.join("; ")
}
