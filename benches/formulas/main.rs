//! The time of finding the first roots of twelve formulas, against a march of 512 steps.
//!
//! Each formula is seen by five cameras.
//!
//! Run by hand: `cargo bench --bench formulas`. Times are CPU times of one thread, the best of five; the ratios are what
//! counts on a busy machine.

mod march;

use glam::Vec3;
use march::MarchedRays;
use rustix::time::{ClockId, clock_gettime};
use std::array::from_fn;
use termtrace::Scene;
use termtrace::internals::hit::{Kernel, closest_hits};
use termtrace::internals::lanes::{F32x8, LANES};
use termtrace::internals::ray::{EightRays, Ray};

/// The formulas, in the order of those written by hand, and half the side of the cube of each.
const FORMULAS: [(&str, &str, f32); 12] = [
    ("sphere", "x^2 + y^2 + z^2 - 1", 1.1),
    ("tanglecube", "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8", 2.5),
    ("heart", "(x^2 + 9/4*z^2 + y^2 - 1)^3 - x^2*y^3 - 9/80*z^2*y^3", 1.35),
    (
        "barth",
        "a = phi^2*x^2 - y^2; b = phi^2*y^2 - z^2; c = phi^2*z^2 - x^2;
         4*a*b*c - (1 + 2*phi)*(x^2 + y^2 + z^2 - 1)^2",
        1.75,
    ),
    ("cayley", "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1", 1.2),
    ("gyroid", "max(sin(6*x)*cos(6*y) + sin(6*y)*cos(6*z) + sin(6*z)*cos(6*x), x^2 + y^2 + z^2 - 1)", 1.1),
    (
        "metaballs",
        "0.5 - exp(-4*((x - 0.5)^2 + y^2 + z^2)) - exp(-4*((x + 0.5)^2 + y^2 + (z - 0.3)^2))
         - exp(-4*(x^2 + (y - 0.6)^2 + z^2)) - exp(-4*(x^2 + (y + 0.5)^2 + (z + 0.4)^2))",
        1.6,
    ),
    ("klein", "q = x^2 + y^2 + z^2; (q + 2*y - 1)*((q - 2*y - 1)^2 - 8*z^2) + 16*x*z*(q - 2*y - 1)", 3.0),
    ("chair", "(x^2 + y^2 + z^2 - 0.95)^2 - 0.8*((z - 1)^2 - 2*x^2)*((z + 1)^2 - 2*y^2)", 1.3),
    ("terrain", "y - 0.35*sin(1.7*x + 0.4)*cos(1.3*z) - 0.16*sin(3.1*x - 2.3*z) - 0.07*sin(6.3*z + 2*sin(2.7*x))", 2.0),
    ("thin torus", "(sqrt(x^2 + z^2) - 1)^2 + y^2 - 0.0001", 1.1),
    ("sheets", "(0.6*x + 0.8*y - 0.1*sin(3*z))^2 - 0.0015^2", 1.2),
];

/// Eye and target of each camera, relative to half the side of the cube.
///
/// They are in front, on an axis, grazing, below, and inside.
const CAMERAS: [[[f32; 3]; 2]; 5] = [
    [[0.3, 0.35, 2.9], [0.0; 3]],
    [[0.0, 0.0, 3.0], [0.0; 3]],
    [[2.9, 0.25, 0.4], [0.0, 0.2, 0.0]],
    [[0.5, -2.8, 0.6], [0.0; 3]],
    [[0.21, 0.17, 0.33], [-0.3, -0.2, -0.5]],
];

/// The size of the pictures in pixels: two for each of 200 x 60 cells.
const SIZE: [usize; 2] = [200, 120];

fn scene(formula: &str, size: f32) -> Scene {
    let text = format!(
        "(camera: (eye: (0, 0, 9), target: (0, 0, 0)), objects: [Implicit(f: r\"{formula}\", \
         bounds: Box(min: ({0}, {0}, {0}), max: ({size}, {size}, {size})))])",
        -size
    );
    Scene::from_ron("formula", &text).expect("the formulas are valid")
}

/// Returns the rays of a picture in tiles of 8 x 8 pixels, in groups of 4 x 2.
fn rays([eye, target]: [[f32; 3]; 2], size: f32) -> Vec<Ray> {
    let (eye, target) = (Vec3::from(eye) * size, Vec3::from(target) * size);
    let w = (eye - target).normalize();
    let u = Vec3::Y.cross(w).normalize();
    let (v, half) = (w.cross(u), 0.363_970_2);
    let place = |at: usize| {
        let (tile, group, lane) = (at / 64, at / LANES % LANES, at % LANES);
        let [x, y] = [tile % (SIZE[0] / 8), tile / (SIZE[0] / 8)].map(|tile| tile * 8);
        [x + group % 2 * 4 + lane % 4, y + group / 2 * 2 + lane / 4]
    };
    let share = |at: usize, count: usize| 2.0 * (at as f32 + 0.5) / count as f32 - 1.0;
    let ray = |at: usize| {
        let [x, y] = place(at);
        let across = share(x, SIZE[0]) * half * SIZE[0] as f32 / SIZE[1] as f32;
        Ray { origin: eye, direction: u * across - v * (share(y, SIZE[1]) * half) - w }
    };
    (0..SIZE[0] * SIZE[1]).map(ray).collect()
}

fn marched(rays: &[Ray], size: f32) -> MarchedRays {
    let range = |lane: usize| {
        let Ray { origin, direction } = rays[lane];
        let (one, other) = ((Vec3::splat(-size) - origin) / direction, (Vec3::splat(size) - origin) / direction);
        [one.min(other).max_element().max(0.0), one.max(other).min_element()]
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

fn main() {
    println!(
        "ms of the tracer, and how many times as long the march takes: with 8 lanes / one by one; roots that it loses"
    );
    let mut logarithms = [0.0; CAMERAS.len()];
    for (formula, &(name, text, size)) in FORMULAS.iter().enumerate() {
        let scene = scene(text, size);
        print!("{name:10}");
        for (camera, sum) in CAMERAS.into_iter().zip(&mut logarithms) {
            let rays = rays(camera, size);
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
}
