//! Mixes of two palette colours, and the choice of the best one for a colour.
//!
//! The mean of a mix is taken in linear light, because the eye adds light. It is compared with the wanted colour in
//! OKLab. The best mix has a mean near the wanted colour, and two colours near to each other. A palette colour of
//! another hue than the wanted one is never used, and only greys show a grey.

use crate::color::{LinearRgb, Oklab, Srgb8};

/// A palette colour alone, or a mix of two.
#[derive(Clone, Copy)]
pub(super) struct Mix {
    mean: Oklab,
    /// The part of the cost that comes from the difference between the two colours.
    contrast: f32,
    /// The positions of the darker and the lighter colour in the palette.
    pub(super) colors: [u8; 2],
    /// The number of pixels, out of four, that show the lighter colour; 0 if the mix is the darker
    /// colour alone.
    pub(super) lighter_quarters: u8,
}

/// The mixes of a palette, in the order of their lightness.
pub(super) struct Mixes {
    colors: Vec<Oklab>,
    sorted: Vec<Mix>,
    rules: &'static Rules,
}

/// The rules of mixing, which depend on the number of palette colours.
///
/// Differences are in OKLab, and costs are their squares. The weights were chosen on the shipped scenes: of all weights
/// that keep the mean colours of the pictures (compared after a blur), these leave the least noise.
struct Rules {
    /// The shares of the lighter colour that are tried, in quarters.
    quarters: &'static [u8],
    /// The largest difference in lightness of two mixed colours.
    max_lightness: f32,
    /// The largest difference in chroma of two mixed colours.
    max_chroma: f32,
    /// The weight of the mean's error in chroma; that of the error in lightness is 1.
    chroma_error: f32,
    /// The weight of the difference in lightness of two mixed colours.
    lightness_contrast: f32,
    /// The weight of the difference in chroma of two mixed colours.
    chroma_contrast: f32,
    /// The cosine of the largest difference in hue between a palette colour and the wanted colour.
    hue_cosine: f32,
    /// The chroma below which a wanted colour is a grey.
    grey: f32,
    /// The chroma up to which a palette colour is a grey, which fits any hue.
    neutral: f32,
}

const MANY: Rules = Rules {
    // Only half and half: with quarters, dots of a near colour are more visible than the step in tone that they avoid.
    quarters: &[2],
    max_lightness: 0.19,
    max_chroma: 0.12,
    chroma_error: 0.8,
    lightness_contrast: 0.05,
    chroma_contrast: 0.2,
    hue_cosine: 0.838_67, // of 33 degrees
    grey: 0.02,
    neutral: 0.03,
};

const FEW: Rules = Rules {
    quarters: &[1, 2, 3],
    max_lightness: 0.8,
    max_chroma: f32::INFINITY,
    chroma_error: 1.5,
    lightness_contrast: 0.075,
    chroma_contrast: 0.4,
    hue_cosine: std::f32::consts::FRAC_1_SQRT_2, // of 45 degrees
    grey: 0.03,
    // Themes tint their blacks and whites. If these did not count as greys, a black would be shown by the theme's
    // middle grey.
    neutral: 0.07,
};

/// The cost of a wrong hue, which exceeds all other costs.
// Finite, so that a theme without any grey still has a best mix for a grey.
const WRONG_HUE: f32 = 9.0;
/// The cost of a mix that shows a colour with a distinct hue as grey.
const LOST_COLOR: f32 = 0.03;

impl Mixes {
    /// Returns the mixes of a palette of up to 256 colours.
    pub(super) fn new(palette: &[Srgb8]) -> Self {
        let rules = if palette.len() > 16 { &MANY } else { &FEW };
        let lights: Vec<_> = palette.iter().map(|&color| LinearRgb::from_srgb8(color)).collect();
        let colors: Vec<_> = lights.iter().map(|&light| Oklab::from_linear(light)).collect();
        let mut from_dark: Vec<usize> = (0..colors.len()).collect();
        from_dark.sort_by(|&a, &b| colors[a].l.total_cmp(&colors[b].l));
        let mut mixes = Vec::new();
        for (place, &darker) in from_dark.iter().enumerate() {
            mixes.push(Mix { mean: colors[darker], contrast: 0.0, colors: [darker as u8; 2], lighter_quarters: 0 });
            for &lighter in &from_dark[place + 1..] {
                let lightness = square(colors[lighter].l - colors[darker].l);
                // All colours after this one are lighter still.
                if lightness >= square(rules.max_lightness) {
                    break;
                }
                let chroma = squared_chroma_difference(colors[lighter], colors[darker]);
                if chroma < square(rules.max_chroma) {
                    let contrast = rules.lightness_contrast * lightness + rules.chroma_contrast * chroma;
                    mixes.extend(rules.quarters.iter().map(|&lighter_quarters| {
                        let share = 0.25 * f32::from(lighter_quarters);
                        let mean = Oklab::from_linear(lights[darker].lerp(lights[lighter], share));
                        // The pattern is most visible if both colours have equal shares.
                        let contrast = 4.0 * share * (1.0 - share) * contrast;
                        Mix { mean, contrast, colors: [darker as u8, lighter as u8], lighter_quarters }
                    }));
                }
            }
        }
        mixes.sort_by(|a, b| a.mean.l.total_cmp(&b.mean.l));
        Self { colors, sorted: mixes, rules }
    }

    /// Returns the mix with this number: its place in the order of lightness.
    pub(super) fn get(&self, number: usize) -> Mix {
        self.sorted[number]
    }

    /// Returns the numbers of the mixes that are a single palette colour, and its position in the
    /// palette.
    pub(super) fn single_colors(&self) -> impl Iterator<Item = (usize, usize)> {
        let single =
            |(number, mix): (usize, &Mix)| (mix.lighter_quarters == 0).then(|| (number, usize::from(mix.colors[0])));
        self.sorted.iter().enumerate().filter_map(single)
    }

    /// Returns the number of the mix with the least cost for a colour.
    // The search goes from the mixes of equal lightness to lighter and to darker ones, and ends where the difference in
    // lightness alone costs more than the best mix.
    pub(super) fn best(&self, color: Srgb8) -> usize {
        let wanted = Oklab::from_srgb8(color);
        let mut best = (f32::INFINITY, 0);
        let mut improves = |number: usize| {
            let mix = &self.sorted[number];
            let lightness = square(mix.mean.l - wanted.l);
            let mut cost =
                lightness + self.rules.chroma_error * squared_chroma_difference(mix.mean, wanted) + mix.contrast;
            if cost < best.0 {
                cost += self.penalty(mix, wanted);
            }
            if cost < best.0 {
                best = (cost, number);
            }
            lightness < best.0
        };
        let middle = self.sorted.partition_point(|mix| mix.mean.l < wanted.l);
        let _ = (middle..self.sorted.len()).all(&mut improves);
        let _ = (0..middle).rev().all(&mut improves);
        best.1
    }

    /// Returns the extra cost of a mix that has a wrong hue, or shows a colour with a distinct hue
    /// as grey.
    fn penalty(&self, mix: &Mix, wanted: Oklab) -> f32 {
        let is_wrong = mix.colors.iter().any(|&at| self.is_wrong_hue(self.colors[usize::from(at)], wanted));
        let is_clear = wanted.l > 0.3 && chroma(wanted) > 0.045;
        let is_lost = is_clear && chroma(mix.mean) < 0.6 * chroma(wanted);
        (if is_wrong { WRONG_HUE } else { 0.0 }) + (if is_lost { LOST_COLOR } else { 0.0 })
    }

    /// Returns whether a palette colour has another hue than the wanted one, or any hue for a grey.
    fn is_wrong_hue(&self, color: Oklab, wanted: Oklab) -> bool {
        let along = color.a * wanted.a + color.b * wanted.b;
        chroma(color) > self.rules.neutral
            && (chroma(wanted) < self.rules.grey || along < self.rules.hue_cosine * chroma(color) * chroma(wanted))
    }
}

fn square(x: f32) -> f32 {
    x * x
}

fn chroma(color: Oklab) -> f32 {
    (square(color.a) + square(color.b)).sqrt()
}

/// Returns the square of the difference of two colours without their lightness.
fn squared_chroma_difference(one: Oklab, other: Oklab) -> f32 {
    square(one.a - other.a) + square(one.b - other.b)
}

#[cfg(all(test, unit_tests))]
mod tests;
