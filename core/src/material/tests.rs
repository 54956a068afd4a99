use super::*;
use crate::lanes::{F32x8, LANES, Lanes};
use crate::simd::{self, SimdKernel};

/// The places and footprints at which materials are compared, each for both surface coordinates.
type Places = [[F32x8; 2]; 2];

/// A kernel that returns the reflectances of materials at places.
struct Reflectances<'w>(&'w [Material], &'w [Places]);

impl SimdKernel for Reflectances<'_> {
    type Output = Vec<[F32x8; 3]>;

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let mut all = Vec::new();
        for material in self.0 {
            for [[u, v], [along_u, along_v]] in self.1 {
                let [r, g, b] = material.reflectance([N::load(u), N::load(v)], [N::load(along_u), N::load(along_v)]);
                all.push([r.store(), g.store(), b.store()]);
            }
        }
        all
    }
}

fn patterns() -> Vec<Material> {
    let (a, b) = (LinearRgb::new(0.9, 0.5, 0.0), LinearRgb::new(0.1, 0.7, 1.0));
    vec![
        Checker::new(a, b, 0.7).expect("a pattern").into(),
        Stripes::new(a, b, 0.7).expect("a pattern").into(),
        Gradient::new(a, b, 0.7).expect("a pattern").into(),
        Noise::new(a, b, 0.7).expect("a pattern").into(),
    ]
}

/// Returns places near and far, with footprints from a point to many periods.
fn places() -> Vec<Places> {
    let mut state = 1_u64;
    let mut number = |range: f32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((state >> 40) as f32 / 8_388_608.0 - 1.0) * range
    };
    let mut eight = |range: f32| F32x8(std::array::from_fn(|_| number(range)));
    let ranges = [(1.0, 0.0), (10.0, 0.1), (100.0, 1.0), (1e4, 10.0), (1e9, 1e7), (3.0, 0.5)];
    let mut places = Vec::new();
    for (range, footprint) in ranges.into_iter().cycle().take(120) {
        let uv = [eight(range), eight(range)];
        let footprint = [eight(footprint), eight(footprint)].map(Number::abs);
        places.push([uv, footprint]);
    }
    places
}

#[test]
fn all_lanes_have_the_bits_of_single_rays() {
    let (materials, places) = (patterns(), places());
    let arrays = simd::run_scalar(Reflectances(&materials, &places));
    let registers = simd::dispatch(Reflectances(&materials, &places));
    let bits = |[r, g, b]: &[F32x8; 3], lane: usize| [r, g, b].map(|channel| channel.0[lane].to_bits());
    for (at, (array, register)) in arrays.iter().zip(&registers).enumerate() {
        let (material, [uv, footprint]) = (&materials[at / places.len()], &places[at % places.len()]);
        for lane in 0..LANES {
            let [uv, footprint] = [uv, footprint].map(|pair| pair.map(|numbers| numbers.0[lane]));
            let alone = material.reflectance(uv, footprint).map(f32::to_bits);
            assert_eq!(bits(array, lane), alone, "{material:?} {uv:?} {footprint:?}");
            assert_eq!(bits(register, lane), alone, "{material:?} {uv:?} {footprint:?}");
        }
    }
}

/// Asserts that no reflectance leaves the range between the two of the pattern.
#[test]
fn reflectances_lie_between_those_of_the_pattern() {
    for material in patterns() {
        for [uv, footprint] in places() {
            for lane in 0..LANES {
                let [r, g, b] = material.reflectance(uv.map(|u| u.0[lane]), footprint.map(|width| width.0[lane]));
                let is_within = |channel: f32, least: f32, most: f32| (least - 1e-6..=most + 1e-6).contains(&channel);
                assert!(
                    is_within(r, 0.1, 0.9) && is_within(g, 0.5, 0.7) && is_within(b, 0.0, 1.0),
                    "{material:?} {uv:?} {footprint:?}: {r} {g} {b}"
                );
            }
        }
    }
}
