use super::*;
use crate::hit::{self, Kernel};
use crate::ray::EightRays;
use crate::scene::Scene;

fn scene_of(object: &str) -> Result<Scene, crate::scene_text::SceneError> {
    let text = format!("(camera: (eye: (0, 0, 5), target: (0, 0, 0)),\n objects: [{object}])");
    Scene::from_ron("x.ron", &text)
}

fn scene(object: &str) -> Scene {
    scene_of(object).expect("the scene is valid")
}

const BALL: &str = r#"Implicit(f: "x^2 + y^2 + z^2 = a^2", params: {"a": 1.25},
    bounds: Box(min: (-2, -2, -2), max: (2, 2, 2)))"#;

fn rays(count: usize, from: f32) -> Vec<Ray> {
    let direction = |at: usize| Vec3::new((at % 40) as f32 * 0.03 - 0.6, (at / 40) as f32 * 0.05 - 0.4, -1.0);
    (0..count).map(|at| Ray { origin: Vec3::new(0.1, 0.2, from), direction: direction(at) }).collect()
}

/// Rays hit a sphere given by a formula where they hit the shape `Sphere`, with the same normal.
#[test]
fn a_sphere_is_a_sphere() {
    let (formula, sphere) = (scene(BALL), scene("Sphere(center: (0, 0, 0), radius: 1.25)"));
    let mut count = 0;
    for ray in rays(640, 4.0).iter().chain(&rays(640, 0.5)) {
        let [one, other] = [&formula, &sphere].map(|scene| hit::closest_hit(scene, ray));
        assert_eq!(one.is_some(), other.is_some(), "{ray:?}");
        let (Some(one), Some(other)) = (one, other) else { continue };
        assert!((one.t - other.t).abs() < 2e-5, "{one:?} {other:?}");
        let point = |scene: &Scene, t| scene.objects()[0].shape.primitive(0).at_crossing(ray, t);
        let [a, b] = [point(&formula, one.t), point(&sphere, other.t)];
        assert!((a.geometric_normal - b.geometric_normal).length() < 2e-5 && a.side == b.side, "{a:?} {b:?}");
        assert!((a.position.length() - 1.25).abs() < 1.5e-7 * 1.25, "{a:?} is on the surface");
        let away = Ray { origin: a.ray_origin(), direction: a.geometric_normal + Vec3::new(0.3, 0.2, 0.1) };
        let is_outside = ray.origin.z > 2.0;
        assert_eq!(hit::any_hit(&formula, &away, Interval::IN_FRONT), !is_outside, "{a:?}");
        count += 1;
    }
    assert!(count > 700, "{count} rays hit");
}

#[test]
fn all_kernels_see_the_same() {
    let all = format!("{BALL}, {}", (0..12).map(|at| format!(
        r#"Implicit(f: "x^2 + y^2 + z^2 + sin(9*x)/9 - 0.1", bounds: Sphere(center: ({at}, 0.5, -1), radius: 0.7)),"#
    )).collect::<Vec<_>>().concat());
    for scene in [scene(BALL), scene(&all)] {
        let rays: Vec<_> = rays(640, 4.0).chunks(8).map(EightRays::of).collect();
        let hits = |kernel| {
            let mut hits = Vec::new();
            hit::closest_hits(kernel, &scene, &rays, &mut hits);
            hits.iter().flat_map(|eight| (0..8).map(|lane| eight.hit(&scene, lane))).collect::<Vec<_>>()
        };
        let single = hits(Kernel::Single);
        assert!(single.iter().flatten().count() > 100, "rays hit");
        for kernel in [Kernel::Packet, Kernel::Scalar, Kernel::Auto] {
            assert_eq!(hits(kernel), single);
        }
    }
}

/// At the tip of a cone the gradient is 0, and the normal is that of a point in front.
#[test]
fn a_tip_has_a_normal() {
    let scene = scene(r#"Implicit(f: "x^2 + y^2 - z^2", bounds: Sphere(center: (0, 0, 0), radius: 1))"#);
    for origin in [Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.3, 0.1, 4.0)] {
        let ray = Ray { origin, direction: -origin };
        let point = scene.objects()[0].shape.primitive(0).at_crossing(&ray, 1.0);
        let normal = point.geometric_normal;
        assert!((normal.length() - 1.0).abs() < 1e-6 && normal.dot(ray.direction) <= 0.0, "{point:?}");
    }
}

#[test]
fn bounds_cut_the_surface_open() {
    let plane = |bounds: &str| scene(&format!(r#"Implicit(f: "z", bounds: {bounds})"#));
    let at = |x: f32| Ray { origin: Vec3::new(x, 0.0, 3.0), direction: Vec3::NEG_Z };
    let in_box = plane("Box(min: (-1, -1, -1), max: (1, 1, 1))");
    let in_ball = plane("Sphere(center: (0, 0, 0.5), radius: 1)");
    for (x, is_in_box, is_in_ball) in [(0.0, true, true), (0.86, true, true), (0.88, true, false), (1.01, false, false)]
    {
        assert_eq!(hit::closest_hit(&in_box, &at(x)).map(|hit| hit.t), is_in_box.then_some(3.0), "{x}");
        assert_eq!(hit::closest_hit(&in_ball, &at(x)).is_some(), is_in_ball, "{x}");
    }
}

#[test]
fn faults_point_into_the_string() {
    let message = |object: &str| scene_of(object).expect_err(object).to_string();
    let bounds = "bounds: Box(min: (-1, -1, -1), max: (1, 1, 1))";
    assert_eq!(
        message(&format!(r#"Implicit(f: "x^2 + fooor(y)", {bounds})"#)),
        r#"
x.ron:2:31: in this formula: unknown name `fooor`: did you mean `floor`?
  2 |  objects: [Implicit(f: "x^2 + fooor(y)", bounds: Box(min: (-1, -1, -1), max: (1, 1, 1)))])
    |                               ^^^^^
"#
        .trim()
    );
    assert!(
        message(&format!(r##"Implicit(f: r#"2x"#, {bounds})"##)).starts_with("x.ron:2:28: in this formula: expected")
    );
    assert!(message(r#"Implicit(f: "x")"#).contains("missing field \"bounds\"; an Implicit needs one"));
    assert!(message(r#"Implicit(f: "x", bounds: Box(min: (0, 0, 0), max: (1, 1, 0)))"#).contains("must be less than"));
    assert!(message(r#"Implicit(f: "x", bounds: Ball(radius: 1))"#).contains("Ball is not a bound"));
    let params = |params: &str| message(&format!(r#"Implicit(f: "x", {bounds}, params: {params})"#));
    assert!(params(r#"{"sin": 1}"#).contains("`sin` cannot be the name of a parameter"));
    assert!(params(r#"{"a": 1, "a": 2}"#).contains("duplicate parameter `a`"));
    assert!(params("{a: 1}").contains("the name of a parameter in quotes"));
}

#[test]
fn it_is_described_and_explained() {
    let scene = scene(BALL);
    let shape = &scene.objects()[0].shape;
    assert_eq!(shape.described("red"), "a red implicit surface, x^2 + y^2 + z^2 = a^2, 4 wide, 4 high, 4 deep");
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::NEG_Z };
    let equation = shape.primitive(0).equation(&ray);
    assert_eq!(equation.roots, [3.75, 6.25]);
    assert_eq!(equation.steps[0], EquationStep::Formula("x^2 + y^2 + z^2 = a^2".to_owned()));
    assert!(shape.encloses(Vec3::X) && !shape.encloses(Vec3::X * 1.3));
}

#[test]
fn formulas_without_a_surface_are_warned_of() {
    let scene = scene(&format!(r#"{BALL}, Implicit(f: "x - 5", bounds: Sphere(center: (0, 0, 0), radius: 1))"#));
    assert_eq!(scene.invisible_formula_warnings(), ["object 2: f has no zero inside the bounds: nothing is seen"]);
}
