use super::*;

#[test]
fn the_quadratic_is_the_lectures() {
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::new(0.0, 0.0, -2.0) };
    let equation = |x| Sphere::unchecked(Vec3::new(x, 0.0, 0.0), 1.0).equation(&ray);
    let steps = |c, roots: &[f64]| {
        [
            EquationStep::Text("|o + t d - c|^2 - r^2 = 0"),
            EquationStep::Text("A t^2 + 2 B t + C = 0"),
            EquationStep::Value("A = d.d", 4.0),
            EquationStep::Value("B = (o-c).d", -10.0),
            EquationStep::Value("C = (o-c).(o-c) - r^2", c),
            EquationStep::Text("t = (-B +- sqrt(B^2 - A C)) / A"),
            EquationStep::Values("  = ", " or ", roots.to_vec()),
        ]
    };
    // The ray through the center: 4 t^2 - 20 t + 24 = 0 has the roots 2 and 3. The explanation prints the `steps`.
    assert_eq!(equation(0.0).steps, steps(24.0, &[2.0, 3.0]));
    assert_eq!(equation(0.0).roots, [2.0, 3.0]);
    assert_eq!((equation(3.0).steps, equation(3.0).roots), (steps(33.0, &[]).to_vec(), vec![]));
}
