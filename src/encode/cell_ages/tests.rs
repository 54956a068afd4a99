use super::*;

fn shares(ages: &CellAges) -> [f32; 3] {
    [0, 1, 2].map(|at| ages.wrong_share(at))
}

fn recorded() -> CellAges {
    let mut ages = CellAges::default();
    ages.record(&Grid::new(Size::new(3, 1)), Duration::ZERO);
    ages
}

#[test]
fn wrong_cells_approach_their_deadline() {
    let mut ages = recorded();
    ages.record_wrong(&[0, 2], 0.03125);
    assert_eq!(shares(&ages), [0.03125, 0.0, 0.03125]);
    ages.record_wrong(&[1, 2], 0.03125);
    assert_eq!(shares(&ages), [0.0, 0.03125, 0.0625]);
}

#[test]
fn a_long_rest_before_a_cell_is_wrong_does_not_count() {
    let mut ages = recorded();
    ages.record_wrong(&[1], 0.5);
    assert_eq!(shares(&ages), [0.0, 0.0625, 0.0]);
    ages.record_wrong(&[1], 0.5);
    assert_eq!(shares(&ages), [0.0, 0.5625, 0.0]);
}

#[test]
fn frames_without_a_limit_and_other_sizes_leave_no_cell_wrong() {
    let mut ages = recorded();
    ages.record_wrong(&[0, 1, 2], 0.0625);
    ages.clear_wrong();
    assert_eq!(shares(&ages), [0.0; 3]);
    ages.record_wrong(&[0, 1, 2], 0.0625);
    ages.record(&Grid::new(Size::new(1, 3)), Duration::ZERO);
    assert_eq!(shares(&ages), [0.0; 3]);
}
