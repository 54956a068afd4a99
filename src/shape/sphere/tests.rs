use super::*;

#[test]
fn the_quadratic_is_the_lectures() {
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::new(0.0, 0.0, -2.0) };
    let equation = |x| Sphere::unchecked(Vec3::new(x, 0.0, 0.0), 1.0).equation(&ray);
    let steps = |c, roots: &[f64]| {
        [
            Step::Value("a = d.d", 4.0),
            Step::Value("b = 2 (o-c).d", -20.0),
            Step::Value("c = (o-c).(o-c)-rr", c),
            Step::Text("t = (-b +- sqrt(bb - 4ac)) / 2a"),
            Step::Values("  = ", " or ", roots.to_vec()),
        ]
    };
    // 4 t^2 - 20 t + 24 = 0 has the roots 2 and 3.
    assert_eq!(equation(0.0).steps, steps(24.0, &[2.0, 3.0]));
    assert_eq!(equation(0.0).roots, [2.0, 3.0]);
    assert_eq!((equation(3.0).steps, equation(3.0).roots), (steps(33.0, &[]).to_vec(), vec![]));
}
