//! The time of finding the first roots of twelve formulas, against a march of 512 steps.
//!
//! Each formula is seen by five cameras.
//!
//! Run by hand: `cargo bench --bench formulas`. Times are CPU times of one thread, the best of five; the ratios are what
//! counts on a busy machine.

mod march;
mod pictures;

use glam::Vec3;
use march::MarchedRays;
use pictures::{CAMERAS, FORMULAS, range, rays};
use rustix::time::{ClockId, clock_gettime};
use std::array::from_fn;
use termtrace::Scene;
use termtrace::internals::hit::{EightHits, Kernel, any_hits, closest_hits};
use termtrace::internals::lanes::{F32x8, LANES};
use termtrace::internals::ray::{EightRays, Interval, Ray};
use termtrace::internals::shape::Surface;

fn scene(formula: &str, size: f32) -> Scene {
    let text = format!(
        "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), objects: [Implicit(f: r\"{formula}\", \
         bounds: Box(min: ({0}, {0}, {0}), max: ({size}, {size}, {size})))])",
        -size
    );
    Scene::from_ron("formula", &text).expect("the formulas are valid")
}

fn marched(rays: &[Ray], size: f32) -> MarchedRays {
    let range = |lane: usize| {
        let Ray { origin, direction } = rays[lane];
        range([origin, direction], size).unwrap_or([f32::INFINITY, f32::NEG_INFINITY])
    };
    MarchedRays {
        origin: from_fn(|axis| F32x8(from_fn(|lane| rays[lane].origin[axis]))),
        direction: from_fn(|axis| F32x8(from_fn(|lane| rays[lane].direction[axis]))),
        range: from_fn(|end| F32x8(from_fn(|lane| range(lane)[end]))),
    }
}

/// Returns the least CPU time of five runs, in milliseconds.
fn time(mut work: impl FnMut()) -> f64 {
    let now = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6
    };
    let run = |_| {
        let start = now();
        work();
        now() - start
    };
    (0..5).map(run).fold(f64::INFINITY, f64::min)
}

/// Returns the least of 64 balls in the cube, from a fixed sequence.
fn balls() -> String {
    let mut state = 12_345_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    };
    let ball = |_| {
        let [x, y, z] = from_fn(|_| next());
        format!("(x - ({x:.3}))^2 + (y - ({y:.3}))^2 + (z - ({z:.3}))^2 - {:.4}", 0.02 + 0.02 * next().abs())
    };
    format!("min({})", (0..64).map(ball).collect::<Vec<_>>().join(", "))
}

fn traced(scene: &Scene, camera: [[f32; 3]; 2], size: f32) -> (Vec<EightRays>, Vec<EightHits>, f64) {
    let rays: Vec<_> = rays(camera, size).map(|[origin, direction]| Ray { origin, direction }).collect();
    let (eights, mut hits) = (rays.chunks(LANES).map(EightRays::of).collect::<Vec<_>>(), Vec::new());
    let time = time(|| closest_hits(Kernel::Auto, scene, &eights, &mut hits));
    (eights, hits, time)
}

/// Returns the time of the shadow rays from all hits to a light.
fn shadows(scene: &Scene, (eights, hits, _): &(Vec<EightRays>, Vec<EightHits>, f64), size: f32) -> f64 {
    let light = Vec3::new(2.0, 3.0, 2.5) * size;
    let to_light = |(rays, hits): (&EightRays, &EightHits)| {
        let shadow = |lane| {
            let hit = hits.hit(scene, lane)?;
            let ray = rays.ray(lane);
            let origin = hit.surface(scene).at_crossing(&ray, hit.t).ray_origin();
            Some(Ray { origin, direction: light - origin })
        };
        (0..LANES).filter_map(shadow).collect::<Vec<_>>()
    };
    let rays: Vec<_> = eights.iter().zip(hits).flat_map(to_light).collect();
    let (eights, mut masks) = (rays.chunks(LANES).map(EightRays::of).collect::<Vec<_>>(), Vec::new());
    time(|| any_hits(Kernel::Auto, scene, &eights, Interval { min: 0.0, max: 1.0 }, &mut masks))
}

/// Prints the times of shadow rays, of many balls, and of a formula that moves.
fn print_others() {
    print!("shadow rays of one light, in ms:");
    for (name, text, size) in FORMULAS {
        let scene = scene(text, size);
        print!(" {name} {:.2}", shadows(&scene, &traced(&scene, CAMERAS[0], size), size));
    }
    let scene_of_balls = scene(&balls(), 1.2);
    let of_balls = CAMERAS.map(|camera| traced(&scene_of_balls, camera, 1.2).2);
    println!("\n64 balls, in ms: {of_balls:.2?}");
    let moving = scene("min(x + sin(time), y*exp(time/9), z^2 - cos(3*time) + x*y)", 1.0);
    let moved = time(|| (0..100).for_each(|at| drop(moving.clone().at_time(f64::from(at)))));
    println!("a moving parameter, in ms: {:.4}", moved / 100.0);
}

fn main() {
    println!(
        "ms of the tracer, and how many times as long the march takes: with 8 lanes / one by one; roots that it loses"
    );
    let mut logarithms = [0.0; CAMERAS.len()];
    for (formula, &(name, text, size)) in FORMULAS.iter().enumerate() {
        let scene = scene(text, size);
        print!("{name:10}");
        for (camera, sum) in CAMERAS.into_iter().zip(&mut logarithms) {
            let rays: Vec<_> = rays(camera, size).map(|[origin, direction]| Ray { origin, direction }).collect();
            let (eights, by_march): (Vec<_>, Vec<_>) =
                rays.chunks(LANES).map(|eight| (EightRays::of(eight), marched(eight, size))).unzip();
            let (mut hits, mut roots) = (Vec::new(), Vec::new());
            let traced = time(|| closest_hits(Kernel::Auto, &scene, &eights, &mut hits));
            let one_by_one = time(|| roots = march::one_by_one(formula, &by_march));
            let by_eight = time(|| roots = march::by_eight(formula, &by_march));
            let is_lost = |at: &usize| {
                let hit = hits[at / LANES].hit(&scene, at % LANES);
                hit.is_some_and(|hit| !((hit.t - roots[at / LANES].0[at % LANES]).abs() < 1e-3 * size))
            };
            let lost = (0..rays.len()).filter(is_lost).count();
            print!(" | {traced:6.2} {:5.2}/{:5.2} {lost:4}", by_eight / traced, one_by_one / traced);
            *sum += libm::log(by_eight / traced) / FORMULAS.len() as f64;
        }
        println!();
    }
    println!("geometric means with 8 lanes: {:.2?}", logarithms.map(libm::exp));
    print_others();
}
