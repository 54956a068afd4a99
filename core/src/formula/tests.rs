use super::choices::ShorterTape;
use super::forecast::SignForecasts;
use super::models::{Models, StoredModels, model_of_lane};
use super::packet::{EightValues, Lines, PacketModels};
use super::values::PacketValues;
use super::*;
use crate::lanes::{ALL, F32x8, LANES, Lanes, SimdKernel};
use crate::simd;
use glam::DVec3;
use std::array::from_fn;

#[path = "../../../benches/formulas/pictures.rs"]
mod pictures;

mod forecasts;
mod lanes;

/// Random numbers (xorshift) from a seed that a failure prints.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, count: u64) -> u64 {
        (self.next() >> 11) % count
    }

    /// Returns a number in `low..high`.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn point(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    /// Returns a formula; each function of the grammar occurs.
    fn formula(&mut self, depth: u32) -> String {
        const UNARY: [&str; 18] = [
            "abs", "sqrt", "cbrt", "exp", "ln", "sin", "cos", "tan", "asin", "acos", "atan", "floor", "ceil", "fract",
            "sign", "sinh", "cosh", "tanh",
        ];
        const BINARY: [&str; 7] = ["min", "max", "mod", "atan2", "pow", "step", "length"];
        if depth == 0 {
            return match self.below(5) {
                0 => format!("{:.3}", self.between(-3.0, 3.0)).replace('-', "0-"),
                1 => "x".to_owned(),
                2 => "y".to_owned(),
                3 => "z".to_owned(),
                _ => "r".to_owned(),
            };
        }
        let a = self.formula(depth - 1);
        match self.below(12) {
            0 | 1 => format!("({a}) + ({})", self.formula(depth - 1)),
            2 => format!("({a}) - ({})", self.formula(depth - 1)),
            3 | 4 => format!("({a}) * ({})", self.formula(depth - 1)),
            5 => format!("({a}) / ({})", self.formula(depth - 1)),
            6 => format!("({a})^{}", self.below(5)),
            7 | 8 => format!("{}({a}, {})", BINARY[self.below(7) as usize], self.formula(depth - 1)),
            9 => format!("{}({a}, 0.3, 0.8)", ["smin", "clamp", "mix"][self.below(3) as usize]),
            _ => format!("{}({a})", UNARY[self.below(18) as usize]),
        }
    }
}

impl Random {
    /// Returns a formula with many minima and maxima, whose sign or value matters.
    fn formula_with_choices(&mut self) -> String {
        let mut terms = [(); 8].map(|()| format!("{} - {:.2}", self.formula(2), self.between(0.0, 2.0)));
        for at in [1, 3, 5] {
            terms[at] = format!("max({}, -({}))", terms[at - 1], terms[at]);
        }
        let [_, a, _, b, _, c, d, e] = terms;
        match self.below(3) {
            0 => format!("min({a}, {b}, {c}, {d}, {e})"),
            1 => format!("max(-min({a}, {b}), clamp({c}, -1, 1), |{d}| - 1)"),
            _ => format!("min({a}, {b}, {c} - 0.5) - 0.1*max({d}, {e}, |{d}|)"),
        }
    }
}

impl Random {
    /// Returns a formula that is the least or the greatest of a few values.
    fn formula_of_extremes(&mut self) -> String {
        let function = ["min", "max"][self.below(2) as usize];
        let [a, b] = [(); 2].map(|()| self.formula(2));
        if self.below(2) == 0 { format!("{function}({a}, {b})") } else { format!("{function}({a}, {b}, x - 0.5)") }
    }
}

fn formula(text: &str) -> Formula {
    Formula::parse(text, &[]).unwrap_or_else(|fault| panic!("{text}: {fault:?}"))
}

fn value(text: &str, [x, y, z]: [f64; 3]) -> f64 {
    formula(text).value(DVec3::new(x, y, z))
}

/// Returns the roots along the x axis from -4 to 4, as values of x.
fn roots(text: &str) -> Vec<f32> {
    roots_between(text, [-4.0, 4.0])
}

fn roots_between(text: &str, [low, high]: [f32; 2]) -> Vec<f32> {
    roots_of(&formula(text), [low, high])
}

fn roots_of(formula: &Formula, [low, high]: [f32; 2]) -> Vec<f32> {
    let line = Line { origin: DVec3::ZERO, direction: DVec3::X };
    let (solver, mut from, mut found) = (Solver::new(formula), low, Vec::new());
    while let Some(root) = solver.first_root(&line, [from, high], high) {
        found.push(root);
        from = root;
        assert!(found.len() < 100, "{found:?}");
    }
    found
}

fn fault(text: &str) -> (usize, String) {
    let fault = Formula::parse(text, &[]).expect_err(text);
    (fault.range.start, fault.message)
}

#[test]
fn values_follow_the_grammar() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("-x^2", -4.0),
        ("2^3^2", 512.0),
        ("x^-1", 0.5),
        ("8 - 3 - 2", 3.0),
        ("12/3/2", 2.0),
        ("|y - 5| * |-2|", 4.0),
        ("a = x + 1; b = a^2; b - y = 1", 5.0),
        ("clamp(7, 0, 5) + mix(1, 3, 0.25)", 6.5),
        ("step(1, x) + step(3, x) + sign(-x) + smoothstep(0, 4, x)", 0.5),
        ("mod(7.5, 2) + fract(2.25) + ceil(1.2) - floor(-0.5)", 4.75),
        ("max(1, x, y, 2.5) - min(x, y, z)", 1.0),
        ("length(y, 4) + cbrt(27) + pow(x, 3)", 16.0),
        ("log2(8) + ln(e) + acos(1) + tanh(0)", 4.0),
        ("4.5e1 + .5 - 1e-1", 45.4),
        ("smin(1, 9, 0.5)", 1.0),
    ] {
        assert!((value(text, [2.0, 3.0, 5.0]) - expected).abs() < 1e-12, "{text} is {}", value(text, [2.0, 3.0, 5.0]));
    }
    assert!((value("r", [2.0, 3.0, 6.0]) - 7.0).abs() < 1e-12);
    let with_params = Formula::parse("a*x", &[("a".to_owned(), 2.5)]).expect("`a` is a parameter");
    assert_eq!(with_params.value(DVec3::new(2.0, 0.0, 0.0)), 5.0);
}

#[test]
fn equal_terms_are_computed_once() {
    let length = |text: &str| formula(text).tape.operations().len();
    assert_eq!(length("(x + y)*(y + x)"), 2);
    assert_eq!(length("2*3 + x - 0*1"), 1);
    assert_eq!(length("a = sin(x); y"), 0);
    assert_eq!(length("x^8"), 3);
}

/// Constants take the most memory of all: 8 bytes each, beside operations of 6 bytes.
#[test]
fn the_longest_formula_takes_less_than_64_kib() {
    let terms = (0..2046).map(|at| format!(" + 1.{at:04}")).collect::<Vec<_>>().concat();
    let longest = formula(&format!("x + time{terms}"));
    assert!(longest.moves() && Formula::parse(&format!("x + time{terms} + 2"), &[]).is_err());
    let bytes = longest.tape.bytes() + longest.moving.as_ref().map_or(0, |moving| moving.bytes());
    assert!(bytes < 64 << 10, "{bytes} bytes");
}

#[test]
fn faults_name_the_place_and_what_would_be_right() {
    for (text, at, message) in [
        ("x + fooor(y)", 4, "unknown name `fooor`: did you mean `floor`?"),
        ("max(x)", 5, "`max` takes two arguments or more: expected `,`"),
        ("sin(x, y)", 5, "`sin` takes one argument: expected `)`"),
        ("clamp(x, 1)", 10, "`clamp` takes three arguments: expected `,`"),
        ("2x", 1, "expected an operator, found `x`: write 2*x"),
        ("(x)(y)", 3, "expected an operator, found `(`: write ...) * (...)"),
        ("x + ", 4, "the formula ends here: expected a number, a name or `(`"),
        ("", 0, "the formula ends here: expected a number, a name or `(`"),
        ("(x + 1", 6, "the formula ends here: expected `)`"),
        ("x + * y", 4, "expected a number, a name or `(`, found `*`"),
        ("x)", 1, "expected an operator, found `)`"),
        ("sqrt(-2) + x", 0, "`sqrt` of -2 is undefined"),
        ("x / (1 - 1)", 2, "a division by 0 is undefined"),
        ("x $ y", 2, "`$` is not part of a formula"),
        ("1.2.3", 0, "`1.2.3` is not a number"),
        ("1e999", 0, "this number is too large"),
        ("x^33", 1, "a whole exponent is at most 32, found 33"),
        ("x = 1; x", 0, "`x` has a meaning already: choose another name"),
        ("sin + 1", 0, "`sin` is a function: expected `(` after it"),
    ] {
        assert_eq!(fault(text), (at, message.to_owned()), "{text}");
    }
}

#[test]
fn a_formula_is_moved_by_the_time() {
    let formula = formula("x + 2*time*y + 0*sin(time)");
    let value = |formula: &Formula| formula.value(DVec3::new(1.0, 3.0, 0.0));
    assert!(formula.moves());
    assert_eq!([0.0, 0.5, 4.0].map(|seconds| value(&formula.at_time(seconds))), [1.0, 4.0, 25.0]);
    assert_eq!(formula.at_time(7.0).at_time(0.0), formula);
    let fixed = self::formula("x + r");
    assert!(!fixed.moves() && fixed.at_time(3.0) == fixed);
    // A formula that is undefined at some time has no surface at that time.
    let undefined = self::formula("x + 1/time + sqrt(time - 1)");
    assert!(roots_of(&undefined.at_time(0.0), [-4.0, 4.0]).is_empty());
    assert_eq!(roots_of(&undefined.at_time(1.0), [-4.0, 4.0]), [-1.0]);
}

#[test]
fn depth_and_length_are_limited() {
    let nested = |depth: usize| format!("{}x{}", "(".repeat(depth), ")".repeat(depth));
    assert!(Formula::parse(&nested(64), &[]).is_ok());
    for text in [nested(65), nested(10_000), "-".repeat(10_000) + "x", "x^".repeat(10_000) + "x", "|x+".repeat(9_999)] {
        assert_eq!(fault(&text).1, "brackets, signs and exponents may be 64 deep, not deeper");
    }
    let long = (0..5000).map(|n| format!("+ sin({n}*x)")).collect::<Vec<_>>().concat();
    assert_eq!(fault(&format!("x{long}")).1, "a formula has at most 4096 operations");
}

#[test]
fn roots_are_changes_of_sign_across_which_f_is_continuous() {
    for (text, expected) in [
        ("x - 0.5", &[0.5][..]),
        ("x^2 - 2.25", &[-1.5, 1.5]),
        ("x^3", &[0.0]),
        ("(x - 0.5)^5", &[0.5]),
        ("x^2", &[]),
        ("abs(x)", &[]),
        ("(x^2 - 1)^2", &[]),
        ("(x^2 - 1)^2*(x - 2)", &[2.0]),
        ("1/x", &[]),
        ("1/x - 1", &[1.0]),
        ("1/(x - 0.3)^3 + 8", &[-0.2]),
        ("floor(x) - 0.5", &[]),
        ("(x - 0.5)*floor(x + 10)", &[0.5]),
        ("x/x - 1", &[]),
        ("(x + 1.5)/(x + 1.5)*(x - 1)", &[1.0]),
        ("sqrt(x) - 0.5", &[0.25]),
        ("sqrt(x^2 - 1) - 0.75", &[-1.25, 1.25]),
        ("ln(x)", &[1.0]),
        ("x^0.3 - 0.5", &[0.099_212_565]),
        ("exp(50*x) - exp(1)", &[0.02]),
        ("cbrt(x) - 0.5", &[0.125]),
        ("0*x", &[]),
        ("max(x, 0) - 0*y", &[]),
        ("max(x - 1, 0)*(x - 2)", &[2.0]),
        ("max(|x| - 1, 0)*(x - 1.001)", &[1.001]),
        ("(x + 2)*(max(x, 0) + min(x + 1, 0))", &[-2.0]),
        ("min(x - 1, 2 - x)", &[1.0, 2.0]),
        ("abs(x) - 1", &[-1.0, 1.0]),
        ("sign(x) - 0.5", &[]),
        ("atan2(x - 1, 2)", &[1.0]),
        ("atan2(0.5, x) - 3", &[-3.507_626_3]),
        ("atan2(0*x, x) - 1.5", &[]),
        ("asin(x/4) - 0.1", &[0.399_333_67]),
        ("smin(x - 1, 9, 0.1)", &[1.0]),
    ] {
        let found = roots(text);
        let is_close = found.len() == expected.len()
            && found.iter().zip(expected).all(|(found, expected): (&f32, &f32)| (found - expected).abs() < 1e-6);
        assert!(is_close, "{text}: {found:?} instead of {expected:?}");
    }
    assert_eq!(roots_between("tan(x) - 0.5", [-1.5, 4.0]).len(), 2, "the poles are not roots");
    assert_eq!(roots("sin(20*x)").len(), 51);
}

/// Two parallel sheets are 2 d apart, down to 3e-7; the one in front is found.
#[test]
fn thin_sheets_are_not_lost() {
    for exponent in 3..7 {
        let d = 1.5 * libm::pow(10.0, -f64::from(exponent));
        let formula = formula(&format!("(x*0.6 + y*0.8 - 0.3)^2 - {:e}", d * d));
        for at in 0..500 {
            let line = Line {
                origin: DVec3::new(-2.0, 0.001 * f64::from(at) - 0.25, 0.3),
                direction: DVec3::new(1.0, 0.0003 * f64::from(at), -0.1),
            };
            let root = Solver::new(&formula).first_root(&line, [0.0, 4.0], 4.0).expect("both sheets are crossed");
            let speed = 0.6 * line.direction.x + 0.8 * line.direction.y;
            let front = (0.3 - d - (0.6 * line.origin.x + 0.8 * line.origin.y)) / speed;
            assert!((f64::from(root) - front).abs() < 2.4e-7, "{root} instead of {front}, d = {d}");
        }
    }
}

/// The root is the first f32 at which f has the other sign, wherever the range of the search ends.
#[test]
fn a_root_is_the_first_number_of_the_other_sign() {
    let formula = formula("x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8");
    let (mut random, mut count) = (Random(0x5eed_0001), 0);
    for _ in 0..2000 {
        let origin = random.point(1.0).normalize() * 6.0;
        let line = Line { origin, direction: random.point(2.0) - origin };
        let Some(root) = Solver::new(&formula).first_root(&line, [0.0, 2.0], 2.0) else { continue };
        let sign = |t: f32| formula.value(line.origin + line.direction * f64::from(t)) > 0.0;
        assert_ne!(sign(root), sign(root.next_down()), "{line:?}");
        assert_eq!(Solver::new(&formula).first_root(&line, [0.0, 2.0], root), Some(root), "{line:?}");
        count += 1;
    }
    assert!(count > 500, "{count} rays hit");
}

/// Compares roots of random formulas with dense samples in f64.
#[test]
fn dense_sampling_finds_no_nearer_root() {
    const SEED: u64 = 0x5eed_0002;
    let mut random = Random(SEED);
    let roots = (0..2000).filter(|_| has_nearest_root(&random.formula(3), &mut random, SEED)).count();
    assert!(roots > 300, "{roots} formulas have roots");
}

/// Shortening the tape changes no bit of a root.
#[test]
fn shorter_tapes_have_the_same_roots() {
    const SEED: u64 = 0x5eed_0009;
    let (mut random, mut count) = (Random(SEED), 0);
    for _ in 0..400 {
        let text = random.formula_with_choices();
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let whole = Formula { tape: formula.tape.never_shortened(), moving: None };
        assert!(formula.tape.has_many_choices() && !whole.tape.has_many_choices());
        let (o, d) = (random.point(2.0), random.point(1.0));
        let mut searches = Searches::NONE;
        for lane in 0..LANES {
            let line = Line { origin: o + random.point(0.1), direction: d + random.point(0.1) };
            searches.add(lane, &line, [0.0, 4.0], 4.0);
        }
        let [one, other] = [&formula, &whole].map(|formula| Solver::new(formula).first_roots(&searches));
        assert_eq!(one.0, other.0, "{text}, {searches:?}, seed {SEED:#x}");
        let is_same = |lane: usize| one.0 >> lane & 1 == 0 || one.1.0[lane] == other.1.0[lane];
        assert!((0..LANES).all(is_same), "{text}: {one:?}, {other:?}, {searches:?}, seed {SEED:#x}");
        count += one.0.count_ones();
    }
    assert!(count > 200, "{count} roots");
}

/// Returns whether a formula has a root on a random line, after a check that no root is nearer.
fn has_nearest_root(text: &str, random: &mut Random, seed: u64) -> bool {
    let steps = number("FORMULA_STEPS", 5000);
    let Ok(formula) = Formula::parse(text, &[]) else { return false };
    let line = Line { origin: random.point(2.0), direction: random.point(1.0) };
    let root = Solver::new(&formula).first_root(&line, [0.0, 4.0], 4.0);
    let value = |t: f64| formula.value(line.origin + line.direction * t);
    let end = root.map_or(4.0, f64::from);
    let samples = (0..=steps).map(|step| step as f64 * 4.0 / steps as f64).take_while(|&t| t < end - 1e-3);
    let samples: Vec<_> = samples.map(|t| (t, value(t))).collect();
    for pair in samples.windows(2) {
        let [(low, a), (high, b)] = [pair[0], pair[1]];
        if a * b < 0.0 {
            let at = line.origin + line.direction * change(&value, low, high);
            assert!(has_gap(&formula, at), "{text}: lost at {at}, {root:?}, {line:?}, seed {seed:#x}");
        }
    }
    if let Some(root) = root {
        let around = [value(f64::from(root)), value(f64::from(root.next_down()))];
        let is_change = around[0].signum() != around[1].signum() || around[0] == 0.0;
        assert!(is_change, "{text}: false root {root}, {around:?}, {line:?}, seed {seed:#x}");
    }
    root.is_some()
}

/// Of 64 balls, those that a ray passes at a distance are left out.
#[test]
fn distant_balls_are_left_out() {
    let ball = |at: usize| format!("(x - {})^2 + (y - {})^2 + z^2 - 0.1", at % 8, at / 8);
    let formula = formula(&format!("min({})", (0..64).map(ball).collect::<Vec<_>>().join(", ")));
    let (mut shorter, mut models) = (ShorterTape::default(), Vec::new());
    let mut shorten = |y: [f64; LANES], models: &mut Vec<StoredModels>| {
        let lines = [[[-1.0; LANES], y, [0.0; LANES]], [[1.0; LANES], [0.0; LANES], [0.0; LANES]]];
        let packet = packet(&formula, &lines, &[[0.0; LANES], [2.5; LANES]], models);
        let certain = simd::dispatch(Shorten(&mut shorter, packet));
        (certain, shorter.steps().operations.len())
    };
    assert_eq!(shorten([0.5; LANES], &mut models).0, ALL);
    let (certain, two_balls) = shorten([3.0; LANES], &mut models);
    assert!(certain == 0 && two_balls < 16, "{two_balls} operations");
    let (certain, four_balls) = shorten([3.0, 3.0, 3.5, 4.0, 4.0, 4.0, 4.0, 4.5], &mut models);
    assert!(certain == 0b1000_0100 && four_balls < 32, "{certain:b}, {four_balls} operations");
    let roots: Vec<_> = [3.0, 3.2, 3.5, 5.1]
        .into_iter()
        .map(|y| {
            let line = Line { origin: DVec3::new(-1.0, y, 0.0), direction: DVec3::X };
            Solver::new(&formula).first_root(&line, [0.0, 2.5], 2.5)
        })
        .collect();
    let expected = [Some(0.1_f64), Some(0.1 - 0.04), None, Some(0.1 - 0.01)];
    for (root, squared) in roots.iter().zip(expected) {
        let expected = squared.map(|squared| 1.0 - squared.sqrt() as f32);
        let is_close = root.zip(expected).is_none_or(|(root, expected)| (root - expected).abs() < 1e-6);
        assert!(root.is_some() == expected.is_some() && is_close, "{root:?} instead of {expected:?}");
    }
}

/// Returns the place of a sign change between two numbers, by bisection.
fn change(value: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let sign = value(low).signum();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if value(middle).signum() == sign { low = middle } else { high = middle }
    }
    high
}

/// Returns whether an operation of the formula jumps, or is undefined, at the point or next to it.
///
/// A sign change there is no root, also where the whole formula has a limit, as `x^2/x` has at 0.
fn has_gap(formula: &Formula, point: DVec3) -> bool {
    use operation::{Binary, Operation, Unary};
    const NEAR: f64 = 1e-7;
    let mut values = Vec::new();
    let result = formula.tape.value(point, &mut values);
    let is_gap = |&operation: &Operation| {
        let of = |index: u16| formula.tape.constant(index).unwrap_or_else(|| values[usize::from(index)]);
        match operation {
            Operation::Unary(Unary::Floor, a) => (of(a) - of(a).round()).abs() < NEAR * (1.0 + of(a).abs()),
            Operation::Unary(Unary::Step | Unary::Sqrt | Unary::SqrtOfNonNegative | Unary::Ln, a) => of(a).abs() < NEAR,
            Operation::Unary(Unary::Asin, a) => of(a).abs() > 1.0 - NEAR,
            Operation::Unary(Unary::Tan, a) => libm::tan(of(a)).abs() > 1.0 / NEAR,
            Operation::Binary(Binary::Divide, a, b) => of(b).abs() < NEAR || (of(a) / of(b)).abs() > 1.0 / NEAR,
            Operation::Binary(Binary::Atan2, y, x) => of(y).abs() < NEAR && of(x) < NEAR,
            _ => false,
        }
    };
    result.is_nan() || formula.tape.operations().iter().any(is_gap)
}

/// Compares the roots of the formulas of `benches/formulas`, from five cameras, with f64 samples.
///
/// `FORMULA_STEPS=20000 FORMULA_RAYS=20` takes 20,000 steps along each twentieth ray.
#[test]
fn dense_sampling_of_pictures_finds_the_same_roots() {
    let (steps, every) = (number("FORMULA_STEPS", 1000), number("FORMULA_RAYS", 1201) as usize);
    let (mut values, mut count) = (Vec::new(), 0);
    for (name, text, size) in pictures::FORMULAS {
        let formula = formula(text);
        for camera in pictures::CAMERAS {
            for [origin, direction] in pictures::rays(camera, size).step_by(every) {
                let Some([start, end]) = pictures::range([origin, direction], size) else { continue };
                let line = Line { origin: origin.as_dvec3(), direction: direction.as_dvec3() };
                let root = Solver::new(&formula).first_root(&line, [start, end], end);
                let mut value = |t: f64| formula.tape.value(line.origin + line.direction * t, &mut values);
                let (from, range) = (f64::from(start), f64::from(end) - f64::from(start));
                let until = root.map_or(f64::from(end), f64::from) - 2e-4 * range;
                let mut last = [from, value(from)];
                for step in 1..=steps {
                    let t = from + range * step as f64 / steps as f64;
                    if t >= until {
                        break;
                    }
                    let next = [t, value(t)];
                    assert!(last[1] * next[1] >= 0.0, "{name}, {camera:?}: lost at {t}, {root:?}, {line:?}");
                    last = next;
                }
                if let Some(root) = root {
                    let [at, before] = [root, root.next_down()].map(|t| value(f64::from(t)));
                    assert!(at * before <= 0.0, "{name}, {camera:?}: false root {root}, {line:?}");
                    count += 1;
                }
            }
        }
    }
    assert!(count > 300, "{count} roots");
}

/// Returns the number in an environment variable, or a default.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Compares models with f64 values at points of random pieces of random lines.
#[test]
fn models_enclose_all_values() {
    const SEED: u64 = 0x5eed_0003;
    let samples = number("FORMULA_SAMPLES", 1_000_000);
    let (mut random, mut checked) = (Random(SEED), 0);
    let (mut models, mut values) = (Vec::new(), Vec::new());
    while checked < samples {
        let text = random.formula(3);
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        for _ in 0..20 {
            let (o, d) = (random.point(2.0), random.point(1.0));
            let from = random.between(0.0, 4.0);
            let to = from + random.between(0.0, 1.0) * libm::pow(10.0, -(random.below(6) as f64));
            let axes = [0, 1, 2].map(|axis| model::Model::coordinate(o[axis], d[axis], [from, to]));
            let (model, continuity) = formula.tape.model(axes, &mut models);
            let [c0, c1, c2] = model.c;
            for _ in 0..10 {
                let t = random.between(from, to);
                let value = formula.tape.value(o + d * t, &mut values);
                let u = ((t - 0.5 * (from + to)) / (0.5 * (to - from))).clamp(-1.0, 1.0);
                let distance = (value - (c0 + u * (c1 + u * c2))).abs();
                // The slack allows for the rounding of the value itself and of u.
                let slack = 1e-11 * (1.0 + value.abs() + c1.abs() + c2.abs());
                let is_outside = distance > model.error + slack
                    || (value.is_nan() && model.error.is_finite() && !continuity.may_jump);
                assert!(!is_outside, "{text} at {t} in {from}..{to}: {value}, {model:?}, {o} + t {d}, seed {SEED:#x}");
                checked += 1;
            }
        }
    }
}

/// Compares models in f32, of every kernel, with f64 values at points of random pieces.
#[test]
fn models_of_eight_pieces_enclose_all_values() {
    const SEED: u64 = 0x5eed_0005;
    let samples = number("FORMULA_SAMPLES", 1_000_000);
    let (mut random, mut checked) = (Random(SEED), 0);
    let (mut scratch, mut values) = (Vec::new(), Vec::new());
    while checked < samples {
        let text = if random.below(3) > 0 { random.formula(3) } else { random.formula_of_extremes() };
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let lines: [[DVec3; 2]; LANES] = from_fn(|_| [random.point(2.0), random.point(1.0)]);
        let pieces = from_fn(|_| {
            let from = random.between(0.0, 4.0);
            [from, from + random.between(0.0, 1.0) * libm::pow(10.0, -(random.below(5) as f64))]
        });
        let by_axis = [0, 1].map(|end: usize| [0, 1, 2].map(|axis: usize| lines.map(|line| line[end][axis])));
        let ends = [0, 1].map(|end: usize| pieces.map(|piece: [f64; 2]| piece[end]));
        let (models, forecasts) = simd::dispatch(WithModels(packet(&formula, &by_axis, &ends, &mut scratch)));
        let (same_models, of_arrays) = simd::run_scalar(WithModels(packet(&formula, &by_axis, &ends, &mut scratch)));
        for lane in 0..LANES {
            let (model, [o, d], [from, to]) = (model_of_lane(&models, lane), lines[lane], pieces[lane]);
            let same = model_of_lane(&same_models, lane);
            let [c0, c1, c2] = model.c;
            let of_one = (model_bits(&model), forecasts.has_no_zero(lane));
            let is_same = of_one == (model_bits(&same), of_arrays.has_no_zero(lane));
            assert!(is_same, "{text}: {model:?}, {same:?}, seed {SEED:#x}");
            let (continuity, forecast) = (forecasts.continuity(lane), forecasts.forecast(lane));
            let has_shares =
                forecast.sign != 0.0 && !forecast.has_no_zero && continuity == model::Continuity::default();
            let signed = |t: f64, values: &mut Vec<f64>| forecast.sign * formula.tape.value(o + d * t, values);
            if has_shares && forecast.far <= 1.0 {
                let far = signed(from + forecast.far * (to - from), &mut values);
                assert!(far < 1e-11, "{text} in {from}..{to}: {far}, {forecast:?}, {o} + t {d}, seed {SEED:#x}");
            }
            for _ in 0..20 {
                let t = random.between(from, to);
                let value = formula.tape.value(o + d * t, &mut values);
                if has_shares && t <= from + forecast.near * (to - from) {
                    let near = forecast.sign * value;
                    assert!(
                        near > -1e-11,
                        "{text} at {t} in {from}..{to}: {near}, {forecast:?}, {o} + t {d}, {SEED:#x}"
                    );
                }
                let u = ((t - 0.5 * (from + to)) / (0.5 * (to - from))).clamp(-1.0, 1.0);
                let distance = (value - (c0 + u * (c1 + u * c2))).abs();
                // The slack allows for the rounding of the value itself and of u.
                let slack = 1e-11 * (1.0 + value.abs() + c1.abs() + c2.abs());
                let is_outside = distance > model.error + slack
                    || (value.is_nan() && model.error.is_finite() && !continuity.may_jump)
                    || (forecasts.has_no_zero(lane) && value * forecasts.sign_at_start(lane) < 0.0);
                assert!(!is_outside, "{text} at {t} in {from}..{to}: {value}, {model:?}, {o} + t {d}, seed {SEED:#x}");
                checked += 1;
            }
        }
    }
}

/// The kernel that returns the models of the formula besides the forecasts.
struct WithModels<'a>(PacketModels<'a>);

impl SimdKernel for WithModels<'_> {
    type Output = (StoredModels, SignForecasts);

    #[inline(always)]
    fn run<N: Lanes>(self) -> Self::Output {
        let PacketModels { tape, steps, lines, pieces, lanes, scratch } = self.0;
        let (models, _) = PacketModels { tape, steps, lines, pieces, lanes, scratch: &mut *scratch }.models::<N>();
        let model = Models::<N>::of_index(tape, models, steps.result).store();
        (model, PacketModels { tape, steps, lines, pieces, lanes, scratch }.run::<N>())
    }
}

fn packet<'a>(
    Formula { tape, .. }: &'a Formula,
    lines: &'a Lines,
    pieces: &'a [EightValues; 2],
    scratch: &'a mut Vec<StoredModels>,
) -> PacketModels<'a> {
    PacketModels { tape, steps: tape.steps(), lines, pieces, lanes: ALL, scratch }
}

/// Returns the bits of a model, which are the same for all NaN, and for 0 and -0.
fn model_bits(model: &model::Model) -> [u64; 4] {
    let bits = |number: f64| if number.is_nan() { u64::MAX } else { (number + 0.0).to_bits() };
    let [c0, c1, c2] = model.c;
    [c0, c1, c2, model.error].map(bits)
}

/// The kernel that evaluates a tape at two t on each of eight lines.
struct ValuesAt<'a>(PacketValues<'a>, [EightValues; 2]);

impl SimdKernel for ValuesAt<'_> {
    type Output = [EightValues; 2];

    #[inline(always)]
    fn run<N: Lanes>(mut self) -> Self::Output {
        self.0.at(&self.1)
    }
}

/// Values of a packet have the same bits as values computed one by one, with all instruction sets.
#[test]
fn values_of_packets_are_those_of_single_points() {
    const SEED: u64 = 0x5eed_0007;
    let (mut random, mut scratch, mut values) = (Random(SEED), Vec::new(), Vec::new());
    for _ in 0..1000 {
        let text = random.formula(3);
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let lines: [[DVec3; 2]; LANES] = from_fn(|_| [random.point(2.0), random.point(1.0)]);
        let by_axis = [0, 1].map(|end: usize| [0, 1, 2].map(|axis: usize| lines.map(|line| line[end][axis])));
        let t = from_fn(|_| from_fn(|_| random.between(0.0, 4.0)));
        let (tape, steps) = (&formula.tape, formula.tape.steps());
        let eight = simd::dispatch(ValuesAt(PacketValues { tape, steps, lines: &by_axis, scratch: &mut scratch }, t));
        let of_arrays =
            simd::run_scalar(ValuesAt(PacketValues { tape, steps, lines: &by_axis, scratch: &mut scratch }, t));
        for (at, lane) in (0..2).flat_map(|at| (0..LANES).map(move |lane| (at, lane))) {
            let alone = tape.value(lines[lane][0] + lines[lane][1] * t[at][lane], &mut values);
            let is_same = |value: f64| value.to_bits() == alone.to_bits() || value.is_nan() && alone.is_nan();
            let is_same = is_same(eight[at][lane]) && is_same(of_arrays[at][lane]);
            assert!(is_same, "{text}: {eight:?}, {alone}, seed {SEED:#x}");
        }
    }
}

/// The kernel that shortens a tape, and returns the lanes with a certain sign.
struct Shorten<'a>(&'a mut ShorterTape, PacketModels<'a>);

impl SimdKernel for Shorten<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<N: Lanes>(self) -> u32 {
        self.0.shorten::<N>(self.1)
    }
}

/// Within its range, a shorter tape has the sign of the whole one in each lane.
#[test]
fn shorter_tapes_have_the_same_signs() {
    const SEED: u64 = 0x5eed_0008;
    let (mut random, mut shorter, mut models, mut all) = (Random(SEED), ShorterTape::default(), Vec::new(), Vec::new());
    let (mut values, mut certain_count, mut kept, mut whole) = (Vec::new(), 0, 0, 0);
    for _ in 0..2000 {
        let text = random.formula_with_choices();
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let tape = &formula.tape;
        let (o, d, length) = (random.point(2.0), random.point(1.0), random.between(0.0, 1.0));
        let lines: [[DVec3; 2]; LANES] = from_fn(|_| [o + random.point(0.1), d + random.point(0.1)]);
        let by_axis = [0, 1].map(|end: usize| [0, 1, 2].map(|axis: usize| lines.map(|line| line[end][axis])));
        let pieces = [[0.0; LANES], [length; LANES]];
        let certain = simd::dispatch(Shorten(&mut shorter, packet(&formula, &by_axis, &pieces, &mut models)));
        (kept, whole) = (kept + shorter.steps().operations.len(), whole + tape.operations().len());
        let signs: Vec<[f64; LANES]> = (0..20)
            .flat_map(|_| {
                let t = from_fn(|_| from_fn(|_| random.between(0.0, length)));
                let packet = PacketValues { tape, steps: shorter.steps(), lines: &by_axis, scratch: &mut all };
                let of_shorter = simd::dispatch(ValuesAt(packet, t));
                (0..2).map(move |at| (t[at], of_shorter[at])).collect::<Vec<_>>()
            })
            .map(|(t, of_shorter)| {
                from_fn(|lane| {
                    let value = tape.value(lines[lane][0] + lines[lane][1] * t[lane], &mut values);
                    let is_same = of_shorter[lane].signum() == value.signum() || value.abs() < 1e-12;
                    let is_same = is_same || value.is_nan() && of_shorter[lane].is_nan();
                    assert!(certain >> lane & 1 == 1 || is_same, "{text} at {t:?}: {value}, {of_shorter:?}, {SEED:#x}");
                    value.signum()
                })
            })
            .collect();
        for lane in 0..LANES {
            let is_one_sign = signs.iter().all(|other| other[lane] == signs[0][lane]);
            assert!(certain >> lane & 1 == 0 || is_one_sign, "{text}: {signs:?}, seed {SEED:#x}");
            certain_count += certain >> lane & 1;
        }
    }
    assert!(certain_count > 1000 && 5 * kept < 4 * whole, "{certain_count} are certain, {kept} of {whole} are kept");
}

#[test]
fn gradients_agree_with_differences() {
    const SEED: u64 = 0x5eed_0004;
    let (mut random, mut checked) = (Random(SEED), 0);
    for _ in 0..3000 {
        let text = random.formula(2);
        let Ok(formula) = Formula::parse(&text, &[]) else { continue };
        let at = random.point(2.0);
        let (value, gradient) = formula.gradient(at);
        let difference = |step: f64| {
            DVec3::from_array(
                DVec3::AXES
                    .map(|axis| (formula.value(at + axis * step) - formula.value(at - axis * step)) / (2.0 * step)),
            )
        };
        let [fine, coarse] = [difference(1e-5), difference(2e-5)];
        let size = 1.0 + value.abs() + gradient.abs().max_element();
        // Points at which the two differences disagree are left out: f is not smooth there.
        if !(gradient.is_finite() && size < 1e4 && (fine - coarse).abs().max_element() < 1e-6 * size) {
            continue;
        }
        assert!((gradient - fine).abs().max_element() < 1e-4 * size, "{text} at {at}: {gradient}, {fine}, {SEED:#x}");
        checked += 1;
    }
    assert!(checked > 1500, "{checked} gradients");
}

#[test]
fn a_lack_of_a_surface_is_shown() {
    let lack = |text: &str| formula(text).lack_of_surface(DVec3::splat(-2.0), DVec3::splat(2.0));
    let no_zero = Some("f has no zero inside the bounds: nothing is seen");
    assert_eq!(lack("x^2 + y^2 + z^2 + 1"), no_zero);
    assert_eq!(lack("x - 5"), no_zero);
    assert_eq!(lack("sin(x) + cos(y) - 2.5"), no_zero);
    assert!(lack("(x^2 + y^2 + z^2 - 1)^2").is_some_and(|text| text.starts_with("f is never negative")));
    assert!(lack("-(x - 1)^2").is_some_and(|text| text.starts_with("f is never positive")));
    assert!(lack("-2*(x - 1)^2*|y|").is_some_and(|text| text.starts_with("f is never positive")));
    assert_eq!(lack("x - 5 + time"), None);
    assert_eq!(lack("x^2 + y^2 + z^2 - 1"), None);
    assert_eq!(lack("x - 1.999"), None);
}
