//! The time of a frame, stage by stage: trace, tone, cells, bytes. Run by hand: `cargo bench`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use std::hint::black_box;
use std::num::NonZeroU32;
use std::path::Path;
use termtrace::internals::cell;
use termtrace::internals::grid::HalfBlocks;
use termtrace::{
    Camera, CellMode, Colors, Encoder, Glyphs, Grid, Order, Painter, Picture, Pose, Scene, Size, render, tone,
};

const SIZES: [Size; 2] = [Size::new(80, 24), Size::new(200, 60)];

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scenes").join(name);
    Scene::load(&path).expect("the scenes of the benches are valid")
}

fn picture(scene: &Scene, camera: &Camera, size: Size) -> Picture {
    let resolution = cell::resolution(CellMode::HALF_BLOCK, size, 2.0).expect("a size that pictures can have");
    tone(&render(scene, camera, resolution, NonZeroU32::MIN), scene)
}

/// Frames of a turn around the target, 1.5 degrees apart.
fn turn(scene: &Scene, size: Size, frames: usize) -> Vec<Grid> {
    let Pose { eye, target, up } = scene.camera().pose();
    let (sin, cos) = libm::sincosf(1.5_f32.to_radians());
    let mut arm = eye - target;
    (0..frames)
        .map(|_| {
            arm = Vec3::new(cos * arm.x + sin * arm.z, arm.y, cos * arm.z - sin * arm.x);
            let camera =
                scene.camera().with_pose(Pose { eye: target + arm, target, up }).expect("a pose all the way round");
            cell::grid_from_picture(CellMode::HALF_BLOCK, &picture(scene, &camera, size))
        })
        .collect()
}

fn trace(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("trace");
    for name in ["three_spheres.ron", "many_spheres.ron"] {
        let scene = scene(name);
        for size in SIZES {
            let resolution = cell::resolution(CellMode::HALF_BLOCK, size, 2.0).expect("a size that pictures can have");
            group.bench_with_input(BenchmarkId::new(name, format!("{size:?}")), &resolution, |bencher, &resolution| {
                bencher.iter(|| render(black_box(&scene), scene.camera(), resolution, NonZeroU32::MIN));
            });
        }
    }
}

fn light_to_cells(criterion: &mut Criterion) {
    let scene = scene("three_spheres.ron");
    let light = render(
        &scene,
        scene.camera(),
        cell::resolution(CellMode::HALF_BLOCK, SIZES[1], 2.0).expect("a size that pictures can have"),
        NonZeroU32::MIN,
    );
    criterion.bench_function("tone", |bencher| bencher.iter(|| tone(black_box(&light), &scene)));
    for (name, glyphs, colors) in [
        ("half blocks in truecolor", Glyphs::Half, Colors::Truecolor),
        ("half blocks in 256 colours", Glyphs::Half, Colors::Indexed256),
        ("half blocks in 16 colours", Glyphs::Half, Colors::SIXTEEN),
        ("shapes", Glyphs::Shape, Colors::None),
        ("coloured shapes", Glyphs::Shape, Colors::Truecolor),
        ("the ramp", Glyphs::Ramp, Colors::None),
    ] {
        let mode = CellMode { glyphs, colors };
        let resolution = cell::resolution(mode, SIZES[1], 2.0).expect("a size that pictures can have");
        let picture = tone(&render(&scene, scene.camera(), resolution, NonZeroU32::MIN), &scene);
        let mut painter = Painter::new(mode);
        criterion.bench_function(&format!("cells: {name}"), |bencher| {
            bencher.iter(|| painter.grid(black_box(&picture)));
        });
    }
}

fn encode(criterion: &mut Criterion) {
    let scene = scene("three_spheres.ron");
    for size in SIZES {
        let frames = turn(&scene, size, 20);
        criterion.bench_function(&format!("encode 20 frames of a turn at {size:?}"), |bencher| {
            let mut bytes = Vec::new();
            bencher.iter(|| {
                let mut encoder = Encoder::new().with_order(Order::Color).with_half_blocks(HalfBlocks::Either);
                for frame in &frames {
                    bytes.clear();
                    encoder.encode(black_box(frame), &mut bytes);
                }
            });
        });
    }
}

criterion_group!(benches, trace, light_to_cells, encode);
criterion_main!(benches);
