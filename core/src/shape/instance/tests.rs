use super::CornerCells;
use crate::bounds::Bounds;
use crate::mesh_file::MeshFile;
use glam::Vec3;

/// The outermost corner in any direction is found, although only few cells are looked through.
#[test]
fn the_reach_of_corner_cells_is_that_of_all_corners() {
    let corner = |at: u32| Vec3::new((at * 37 % 101) as f32, (at * 53 % 97) as f32 * 0.01, (at * 29 % 89) as f32 - 1e3);
    let corners: Vec<_> = (0..500).map(corner).collect();
    let file = MeshFile::new(corners.clone(), vec![[0, 1, 2]]).expect("a mesh");
    let cells = CornerCells::of(&file);
    assert_eq!(cells.bounds(None), Bounds::of(corners.iter().copied()));
    for at in 0..200 {
        let direction = (corner(at * 3) - corner(at * 7 + 1)).as_dvec3();
        let all = corners.iter().map(|corner| corner.as_dvec3().dot(direction)).fold(f64::MIN, f64::max);
        assert_eq!(cells.reach(direction), all);
    }
}
