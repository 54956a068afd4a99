use super::*;

#[test]
fn the_most_similar_name_is_suggested() {
    for (name, others, expected) in [
        ("three_shperes.ron", &["three_spheres.ron"][..], Some("three_spheres.ron")),
        ("three_spheres", &["three_spheres.ron"], Some("three_spheres.ron")),
        ("Three_Spheres.RON", &["three_spheres.obj", "three_spheres.ron"], Some("three_spheres.ron")),
        ("teapot.ply", &["ball.ply", "teapot.obj"], Some("teapot.obj")),
        ("spheres.ron", &["corridor.ron", "three_spheres.ron"], Some("three_spheres.ron")),
        ("missing.ron", &["ball.ron"], None),
        ("a.ron", &["b.ron"], None),
    ] {
        let others = others.iter().map(|&other| other.to_owned()).collect();
        assert_eq!(nearest(name, others).as_deref(), expected, "{name}");
    }
}
