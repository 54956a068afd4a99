//! Tests that the lanes of a packet do not depend on each other.

use super::*;

/// Asserts that eight searches find the same bits as each alone; returns the number of roots.
fn roots_found_alone(text: &str, lines: &[Line; LANES], range: [f32; 2]) -> u32 {
    let formula = formula(text);
    let mut searches = Searches::NONE;
    lines.iter().enumerate().for_each(|(lane, line)| searches.add(lane, line, range, range[1]));
    let (found, roots) = Solver::new(&formula).first_roots(&searches);
    for (lane, line) in lines.iter().enumerate() {
        let root = (found >> lane & 1 == 1).then_some(roots.0[lane]);
        let alone = Solver::new(&formula).first_root(line, range, range[1]);
        assert_eq!(root.map(f32::to_bits), alone.map(f32::to_bits), "{text}: {root:?}, {alone:?}, {line:?}");
    }
    found.count_ones()
}

impl Random {
    /// Returns a formula of which each lane needs some terms.
    ///
    /// Their functions are undefined for some operands.
    fn formula_with_partial_functions(&mut self) -> String {
        let terms = [(); 5].map(|()| {
            let (axis, size) = (["x", "y", "z"][self.below(3) as usize], self.between(0.5, 2.0));
            let inner = format!("{axis} + {:.2}*({})", self.between(-0.3, 0.3), self.formula(1));
            let term = match self.below(6) {
                0 => format!("sqrt(max({inner}, 0.1))"),
                1 => format!("ln(max({inner}, 0.1))"),
                2 => format!("1/max({inner}, 0.1)"),
                3 => format!("sqrt(abs({inner}))"),
                4 => format!("x*max({inner}, 0.1) + y"),
                _ => format!("({inner})^2"),
            };
            format!("{term} - {size:.2}")
        });
        let [a, b, c, d, e] = terms;
        match self.below(3) {
            0 => format!("min({a}, {b}, {c}, {d}, {e})"),
            1 => format!("max({a}, {b}, {c}, {d}, {e})"),
            _ => format!("max(min({a}, {b}), min({c}, {d}), {e})"),
        }
    }
}

#[test]
fn eight_searches_find_what_each_finds_alone() {
    let (mut random, mut counts) = (Random(0x5eed_0006), [0; 3]);
    for at in 0..900 {
        let kind = at % 3;
        let text = match kind {
            0 => random.formula(3),
            1 => random.formula_with_choices(),
            _ => random.formula_with_partial_functions(),
        };
        if Formula::parse(&text, &[]).is_ok() {
            let lines = from_fn(|_| Line { origin: random.point(2.0), direction: random.point(1.0) });
            counts[kind] += roots_found_alone(&text, &lines, [0.0, 4.0]);
        }
    }
    assert!(counts.iter().all(|&count| count > 200), "{counts:?} roots");
}

/// Only the second lane needs the function, and there its operand is `y`.
///
/// In the other lanes `y` is negative, which the function must not see.
#[test]
fn an_operation_is_undefined_only_in_the_lanes_that_need_it() {
    for function in ["sqrt(max(y, 1)) - 2", "ln(max(y, 1)) - 1.4", "asin(0.2*max(y, 1)) - 0.95"] {
        let text = format!("max(x^2 - 1, {function}, abs(x) - 9, abs(z) - 9)");
        let line =
            |y: f64, slope: f64| Line { origin: DVec3::new(-3.0, y, 0.0), direction: DVec3::new(1.0, slope, 0.0) };
        let lines = from_fn(|lane| if lane == 1 { line(3.9, 0.05) } else { line(-6.0, 0.0) });
        // The second lane has a root or not; the others cross x = -1.
        let count = roots_found_alone(&text, &lines, [0.0, 6.0]);
        assert!(count >= ALL.count_ones() - 1, "{text}: {count} roots");
    }
}

/// The models of a shorter tape have the same bits, in f32 and f64, whatever other lanes need.
#[test]
fn models_of_shorter_tapes_are_those_of_single_lanes() {
    const SEED: u64 = 0x5eed_000b;
    let (mut random, mut shorter, mut scratch, mut of_one) =
        (Random(SEED), ShorterTape::default(), Vec::new(), Vec::new());
    let mut count = 0;
    for _ in 0..1000 {
        let text = random.formula_with_partial_functions();
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let lines: [[DVec3; 2]; LANES] = from_fn(|_| [random.point(2.0), random.point(1.0)]);
        let by_axis = [0, 1].map(|end: usize| [0, 1, 2].map(|axis: usize| lines.map(|line| line[end][axis])));
        let (range, pieces) = ([[0.0; LANES], [1.0; LANES]], [[0.25; LANES], [0.375; LANES]]);
        let mut models = |lanes: u32| {
            let on_range = PacketModels { lanes, ..packet(&formula, &by_axis, &range, &mut scratch) };
            let certain = simd::dispatch(Shorten(&mut shorter, on_range));
            let steps = shorter.steps();
            let on_piece = PacketModels { steps, lanes, ..packet(&formula, &by_axis, &pieces, &mut scratch) };
            let (models, forecasts) = simd::dispatch(WithModels(on_piece));
            let of_lane = |lane: usize| {
                let [o, d] = lines[lane];
                let axes = [0, 1, 2].map(|axis| model::Model::coordinate(o[axis], d[axis], [0.25, 0.375]));
                let (in_f64, continuity) = formula.tape.model_of_steps(steps, lane, axes, &mut of_one);
                let bits = [model_of_lane(&models, lane), in_f64].map(|model| model_bits(&model));
                (bits, [forecasts.continuity(lane), continuity])
            };
            (certain, from_fn::<_, LANES, _>(of_lane))
        };
        let (certain, together) = models(ALL);
        for lane in 0..LANES {
            let (alone_certain, alone) = models(1 << lane);
            assert_eq!(certain >> lane & 1, alone_certain >> lane & 1, "{text}: {lines:?}, seed {SEED:#x}");
            if certain >> lane & 1 == 0 {
                assert_eq!(together[lane], alone[lane], "{text}: lane {lane} of {lines:?}, seed {SEED:#x}");
                count += 1;
            }
        }
    }
    assert!(count > 1000, "{count} models");
}

/// The kernel that returns the lower and upper bounds of models.
struct TightRange(StoredModels);

impl SimdKernel for TightRange {
    type Output = [[f32; LANES]; 2];

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        Models::<N>::load(&self.0).tight_range().map(|bounds| bounds.store().0)
    }
}

#[test]
fn tight_ranges_enclose_polynomials_of_any_size() {
    let mut random = Random(0x5eed_000a);
    for _ in 0..20_000 {
        let exponent = random.between(-44.0, 37.0);
        let mut c = [(); 3].map(|()| {
            let size = libm::pow(10.0, exponent + random.between(-1.0, 1.0));
            F32x8(from_fn(|_| (random.between(-1.0, 1.0) * size) as f32))
        });
        (c[0].0[0], c[1].0[0], c[2].0[0]) = (1e-24, 1e-23, 1e-23);
        // Each model of an operation has at least this error.
        let error = 16.0 * f32::MIN_POSITIVE;
        let [low, high] = simd::dispatch(TightRange([c[0], c[1], c[2], F32x8([error; LANES])]));
        for lane in 0..LANES {
            let [c0, c1, c2] = c.map(|numbers| f64::from(numbers.0[lane]));
            let extremum = if c2 == 0.0 { 0.0 } else { (-0.5 * c1 / c2).clamp(-1.0, 1.0) };
            for u in [-1.0, extremum, 1.0] {
                let value = c0 + u * (c1 + u * c2);
                let is_inside = f64::from(low[lane]) <= value && value <= f64::from(high[lane]);
                assert!(is_inside, "{value} at {u} of {c0} {c1} {c2} is not in {}..{}", low[lane], high[lane]);
            }
        }
    }
}
