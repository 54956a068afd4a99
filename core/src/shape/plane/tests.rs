use super::*;

#[test]
fn the_equation_is_the_lectures() {
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::new(0.0, 0.0, -2.0) };
    let equation = |normal| Plane::unchecked(Vec3::new(1.0, 2.0, 1.0), normal).equation(&ray);
    let values = |normal| {
        let value = |step| if let EquationStep::Value(_, value) = step { Some(value) } else { None };
        equation(normal).steps.into_iter().filter_map(value).collect::<Vec<_>>()
    };
    assert_eq!((values(Vec3::Z), equation(Vec3::Z).roots), (vec![-4.0, -2.0, 2.0], vec![2.0]));
    assert_eq!((values(Vec3::X), equation(Vec3::X).roots), (vec![1.0, 0.0, 0.0], vec![]));
}
