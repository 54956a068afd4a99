use super::*;

#[test]
fn the_shares_show_whether_the_crossing_lies_inside() {
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::new(0.0, 0.0, -2.0) };
    let result = |corners| {
        let Equation { steps, roots, is_outside, .. } = Triangle::unchecked(corners).equation(&ray);
        let Some(EquationStep::Values(_, _, shares)) = steps.last().cloned() else { panic!("{steps:?}") };
        (shares, roots, is_outside)
    };
    let at = |x: f32| [Vec3::new(x - 1.0, -1.0, 1.0), Vec3::new(x + 3.0, -1.0, 1.0), Vec3::new(x - 1.0, 3.0, 1.0)];
    assert_eq!(result(at(0.0)), (vec![0.5, 0.25, 0.25], vec![2.0], false));
    assert_eq!(result(at(2.0)), (vec![1.0, -0.25, 0.25], vec![2.0], true));
    let flat = [Vec3::ZERO, Vec3::ONE, Vec3::splat(2.0)];
    assert_eq!(result(flat), (vec![0.0; 3], vec![], false));
}
