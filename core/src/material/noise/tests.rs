use super::*;
use crate::describe::describe;
use crate::framebuffer::Resolution;
use crate::scene::Scene;

/// Returns the noise at places of a square lattice around the origin, row by row.
fn samples(side: i32, step: f32, footprint: f32) -> Vec<f32> {
    let place = |at: i32| (at - side / 2) as f32 * step + 0.013;
    (0..side * side).map(|at| noise([place(at % side), place(at / side)], [footprint; 2])).collect()
}

fn mean(numbers: &[f32]) -> f32 {
    numbers.iter().sum::<f32>() / numbers.len() as f32
}

#[test]
fn it_fills_its_range_around_its_mean() {
    let samples = samples(300, 0.37, 0.0);
    assert!(samples.iter().all(|share| (0.0..=1.0).contains(share)));
    assert!((mean(&samples) - 0.5).abs() < 0.02, "{}", mean(&samples));
    let part = |is_part: fn(f32) -> bool| {
        samples.iter().filter(|&&share| is_part(share)).count() as f32 / samples.len() as f32
    };
    let (dark, light) = (part(|share| share < 0.2), part(|share| share > 0.8));
    assert!(dark > 0.05 && light > 0.05, "{dark} {light}");
}

/// The noise has no jump, neither inside cells nor at their edges.
#[test]
fn it_is_continuous() {
    let steps = (0..200_000).map(|at| at as f32 * 1e-4 - 10.0);
    for line in [|x: f32| [x, 0.3], |x: f32| [0.77, x], |x: f32| [x, -x]] {
        let along: Vec<f32> = steps.clone().map(|x| noise(line(x), [0.0; 2])).collect();
        let largest = along.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(largest < 2e-3, "{largest}");
    }
}

/// The edge of a cell has the same corners on both sides.
#[test]
fn neighbouring_cells_share_corners() {
    for (x, y) in [(0.0, 0.0), (-1.0, 5.0), (123.0, -4567.0)] {
        let [_, bottom_right, _, top_right] = corners([x, y]);
        let [bottom_left, _, top_left, _] = corners([x + 1.0, y]);
        assert_eq!([bottom_right, top_right], [bottom_left, top_left]);
        let [_, _, top_left, top_right] = corners([x, y]);
        let [bottom_left, bottom_right, _, _] = corners([x, y + 1.0]);
        assert_eq!([top_left, top_right], [bottom_left, bottom_right]);
    }
}

#[test]
fn octaves_below_the_footprint_are_their_mean() {
    let spread = |footprint: f32| {
        let samples = samples(100, 0.37, footprint);
        samples.iter().map(|share| (share - 0.5).abs()).sum::<f32>() / samples.len() as f32
    };
    let spreads = [0.0, 0.5, 1.0, 2.0, 3.5].map(spread);
    assert!(spreads.windows(2).all(|pair| pair[1] < pair[0]), "{spreads:?}");
    for footprint in [4.0, 1e9, f32::INFINITY, f32::NAN] {
        assert_eq!(samples(10, 0.37, footprint), [0.5; 100], "{footprint}");
    }
}

#[test]
fn far_places_have_finite_noise() {
    for x in [1e6, 3e9, -1e18, 4e18] {
        assert!((0.0..=1.0).contains(&noise([x, -x], [0.0; 2])), "{x}");
    }
}

#[test]
fn it_is_read_and_described() {
    let scene = |material: &str| {
        let plane = format!("Plane(point: (0, 0, 0), normal: (0, 1, 0), material: {material})");
        let text = format!("(camera: (eye: (0, 5, 0.01), target: (0, 0, 0)), ambient: 1.0, objects: [{plane}])");
        Scene::from_ron("x.ron", &text)
    };
    let marble = scene("Noise(a: \"red\", b: \"blue\", size: 2)").expect("a scene");
    let noise = Noise::new(LinearRgb::new(1.0, 0.0, 0.0), LinearRgb::new(0.0, 0.0, 1.0), 2.0);
    assert_eq!(marble.objects()[0].material, noise.expect("a pattern").into());
    let text = describe("x.ron", &marble, marble.camera(), Resolution::square(40, 40));
    assert!(text.contains("an endless red and blue mottled plane"), "{text}");
    let error = scene("Noise(size: -1)").expect_err("a fault").to_string();
    assert!(error.contains("the size of a spot must be greater than 0"), "{error}");
}
