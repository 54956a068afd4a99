//! The tracer of termtrace and that of atanor 0.1.0 on atanor's default scene, on one thread.
//!
//! cargo run --release [-- WIDTH HEIGHT SAMPLES ROUNDS]
//!
//! Prints the median primary rays per second of each, and the ratio of the medians. The rounds alternate.

use atanor::render::{self, Camera, Framebuffer};
use glam_of_atanor::Vec3;
use std::error::Error;
use std::num::NonZeroU32;
use std::time::Instant;
use termtrace::{Render, Resolution, Sampling, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let numbers = std::env::args().skip(1).map(|argument| argument.parse()).collect::<Result<Vec<u16>, _>>()?;
    let number = |at: usize, default: u16| numbers.get(at).copied().unwrap_or(default);
    let [width, height, samples, rounds] = [number(0, 200), number(1, 120), number(2, 4), number(3, 9)];
    // atanor traces on the threads of the global pool.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;

    let theirs = render::Scene::demo();
    let camera = Camera::new(Vec3::new(0.0, 1.6, 5.0), 60.0);
    let mut framebuffer = Framebuffer::new(width, height);
    let ours = Scene::from_ron("scene.ron", include_str!("../scene.ron"))?;
    let resolution = Resolution::new(width.into(), height.into())?;
    let each = NonZeroU32::new(samples.into()).ok_or("at least one sample")?;

    let mut seconds = [const { Vec::new() }; 2];
    for _ in 0..rounds.max(1) {
        let start = Instant::now();
        render::render(&theirs, &camera, &mut framebuffer, samples.into());
        seconds[0].push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let picture = Render::new(&ours).resolution(resolution).sampling(Sampling::Each(each)).threads(1).run();
        seconds[1].push(start.elapsed().as_secs_f64());
        std::hint::black_box(picture.map_err(|_| "nothing cancels it")?);
    }
    let rays = f64::from(width) * f64::from(height) * f64::from(samples);
    let [theirs, ours] = seconds.map(|mut times| {
        times.sort_by(f64::total_cmp);
        rays / times[times.len() / 2] / 1e6
    });
    println!("primary rays, in millions a second: atanor {theirs:.2}, termtrace {ours:.2}, ratio {:.1}", ours / theirs);
    Ok(())
}
