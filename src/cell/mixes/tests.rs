use super::super::{Colors, xterm_color};
use super::*;

fn palettes() -> [(Mixes, f32, f32); 2] {
    let cube: Vec<_> = (16..=255).map(xterm_color).collect();
    let Colors::Indexed16(sixteen) = Colors::SIXTEEN else { unreachable!() };
    [(Mixes::new(&cube), 33.0, 0.02), (Mixes::new(&sixteen), 45.0, 0.03)]
}

#[test]
fn no_mix_has_a_hue_that_is_not_wanted() {
    for (mixes, max_turn, grey) in palettes() {
        for step in 0..1 << 15 {
            let wanted = [step >> 10, step >> 5 & 31, step & 31].map(|level: u32| (level * 255 / 31) as u8).into();
            let mix = mixes.get(mixes.best(wanted));
            let wanted = Oklab::from_srgb8(wanted);
            for color in mix.colors.map(|at| mixes.colors[usize::from(at)]) {
                let [hue, wanted_hue] = [color, wanted].map(|color| libm::atan2f(color.b, color.a).to_degrees());
                let turn = (hue - wanted_hue + 540.0).rem_euclid(360.0) - 180.0;
                let is_right = chroma(wanted) >= grey && turn.abs() < max_turn + 0.01;
                assert!(chroma(color) <= 0.03 || is_right, "{color:?} for {wanted:?}");
            }
        }
    }
}

#[test]
fn greys_are_mixed_from_greys() {
    for (mixes, ..) in palettes() {
        for code in 0..=255 {
            let grey = Srgb8::new(code, code, code);
            let mix = mixes.get(mixes.best(grey));
            assert!(mix.colors.iter().all(|&at| chroma(mixes.colors[usize::from(at)]) < 1e-3), "{code}");
            assert!((mix.mean.l - Oklab::from_srgb8(grey).l).abs() < 0.22, "{code}");
        }
    }
}

/// Checks that the search, which looks at few mixes, finds the one with the least cost of all.
#[test]
fn the_best_mix_has_the_least_cost_of_all() {
    for (mixes, ..) in palettes() {
        let cost = |mix: &Mix, wanted: Oklab| {
            let error =
                square(mix.mean.l - wanted.l) + mixes.rules.chroma_error * squared_chroma_difference(mix.mean, wanted);
            error + mix.contrast + mixes.penalty(mix, wanted)
        };
        for color in (0..=255).map(xterm_color).map(|color| Srgb8::new(color.b ^ 0x25, color.r ^ 0x5a, color.g ^ 0x0b))
        {
            let wanted = Oklab::from_srgb8(color);
            let best = cost(&mixes.get(mixes.best(color)), wanted);
            assert!(mixes.sorted.iter().all(|mix| best <= cost(mix, wanted)), "{color:?}");
        }
    }
}

/// A theme without greys still shows something.
#[test]
fn without_greys_a_grey_has_the_nearest_lightness() {
    let colors = [Srgb8::new(90, 0, 0), Srgb8::new(250, 200, 0)];
    let mixes = Mixes::new(&colors);
    let darkest = mixes.get(mixes.best(Srgb8::default()));
    assert_eq!((darkest.colors, darkest.lighter_quarters), ([0, 0], 0));
}
