//! Traces a scene built in code into `balls.png` and prints the progress; then cancels a second render half-way.

use code::{balls, traced};
use std::error::Error;
use std::io::{Write, stdout};
use std::sync::Mutex;
use std::time::Instant;
use termtrace::{Resolution, export, tone};

fn main() -> Result<(), Box<dyn Error>> {
    let scene = balls(7)?;
    let resolution = Resolution::new(1600, 1000)?;
    let whole = traced(&scene, resolution, |share| {
        print!("\r{:3.0} %", 100.0 * share);
        let _ = stdout().flush();
        false
    });
    let light = whole.light.ok_or("the render was cancelled")?;
    std::fs::write("balls.png", export::png(&tone(&light, &scene), 1.0, 1)?)?;
    println!("\rballs.png, in {} steps", whole.shares.len());

    let asked = Mutex::new(None);
    let half = traced(&scene, resolution, |share| {
        let is_enough = share >= 0.5;
        if is_enough {
            asked.lock().expect("no thread panics with it").get_or_insert_with(Instant::now);
        }
        is_enough
    });
    let answered = asked.into_inner()?.ok_or("no report reached one half")?.elapsed();
    println!("cancelled at {:.0} %, stopped after {answered:.1?}", 100.0 * half.shares.last().unwrap_or(&0.0));
    Ok(())
}
