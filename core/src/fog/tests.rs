use super::*;

#[test]
fn a_part_of_one_over_e_is_left_after_the_distance() {
    let fog = Fog::new(LinearRgb::grey(0.5), 4.0).expect("valid");
    assert!((fog.transmittance(4.0) - 0.367_879_44).abs() < 1e-6);
    assert_eq!(fog.transmittance(0.0), 1.0);
    assert_eq!(fog.transmittance(f32::INFINITY), 0.0);
}

#[test]
fn two_ways_through_fog_weaken_light_as_their_sum_does() {
    let fog = Fog::new(LinearRgb::new(0.2, 0.4, 0.6), 7.0).expect("valid");
    let light = LinearRgb::new(3.0, 0.0, 1.0);
    let near = fog.dimmed(light, fog.transmittance(2.0));
    let twice = fog.dimmed(near, fog.transmittance(3.0));
    let once = fog.dimmed(light, fog.transmittance(5.0));
    for (twice, once) in [(twice.r, once.r), (twice.g, once.g), (twice.b, once.b)] {
        assert!((twice - once).abs() < 1e-6, "{twice} {once}");
    }
}

#[test]
fn a_distance_of_0_is_refused() {
    let error = Fog::new(LinearRgb::BLACK, 0.0).expect_err("invalid");
    assert_eq!(error.to_string(), "distance is 0: the distance of a fog must be greater than 0");
}
