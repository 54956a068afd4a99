//! Explanations as text: short lines in the lecture's symbols, for a panel or a file.

use super::{Equation, EquationStep, Explanation, LightContribution, ShadedHit, TestedSurface};
use crate::camera::Basis;
use crate::color::LinearRgb;
use crate::finish::Finish;
use crate::scene::{Scene, ToneCurve};
use crate::shape::{Shape, Side};
use glam::{Vec2, Vec3};
use std::fmt;

/// The largest width of a line in columns, unless a number has unusually many digits.
// With this width, the panel and its border cover less than half of a terminal of 80 columns.
pub const MAX_LINE_WIDTH: usize = 35;

/// The name of a surface: the number and kind of its object and, in a mesh, the number of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceName {
    /// The number of the object in the scene file, from 1.
    object: u32,
    kind: &'static str,
    /// The number of a mesh's face, from 1.
    face: Option<u32>,
}

impl SurfaceName {
    pub(super) fn of_primitive(scene: &Scene, object: u32, primitive: u32) -> Self {
        let (kind, face) = match &scene.objects()[object as usize].shape {
            Shape::Mesh(_) => ("face", Some(primitive + 1)),
            shape => (shape.kind(), None),
        };
        Self { object: object + 1, kind, face }
    }
}

/// Writes the name, such as `sphere #1`, or `face 5 of #2` in a mesh.
impl fmt::Display for SurfaceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { object, kind, face } = self;
        match face {
            Some(face) => write!(f, "{kind} {face} of #{object}"),
            None => write!(f, "{kind} #{object}"),
        }
    }
}

/// Writes all lines, each with a line feed.
impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines().iter().try_for_each(|line| writeln!(f, "{line}"))
    }
}

impl Explanation {
    /// Returns the explanation as lines of printable ASCII.
    #[doc(hidden)]
    pub fn lines(&self) -> Vec<String> {
        let [i, j] = self.pixel;
        let mut lines = vec![
            format!("(i, j) = ({i}, {j}) of {}x{}", self.resolution.width(), self.resolution.height()),
            // The result comes first, so that a small panel shows it without scrolling.
            match &self.hit {
                Some(shaded) => format!("closest hit: {}", shaded.name),
                None => "no hit: L = background".to_owned(),
            },
            format!("(q_u, q_v) = ({:.4}, {:.4})", self.q.x, self.q.y),
        ];
        self.add_camera(&mut lines);
        self.add_tests(&mut lines);
        match &self.hit {
            Some(shaded) => self.add_hit(shaded, &mut lines),
            None => lines.push(String::new()),
        }
        if let Some(transmittance) = self.transmittance {
            lines.push("fog of colour C leaves T".to_owned());
            lines.push(format!("T    {}", padded_number(transmittance)));
            lines.push("L = T L + (1 - T) C".to_owned());
        }
        lines.push(light_line("L", self.light));
        self.add_tone(&mut lines);
        lines
    }

    /// Adds lines with the basis, the view rectangle and the ray.
    // The rectangle's sides, w and h in the lecture, are printed as "width" and "height", because w is a basis vector
    // too.
    fn add_camera(&self, lines: &mut Vec<String>) {
        let (Basis { u, v, w }, rectangle) = (self.camera.basis(), self.camera.rectangle());
        let rays = self.camera.eye_rays(self.resolution.aspect_ratio());
        let corner = |qu, qv| rays.through(qu, qv).at(1.0);
        let [width, height] = [corner(1.0, 0.0), corner(0.0, 1.0)].map(|end| end.distance(corner(0.0, 0.0)));
        lines.extend([
            String::new(),
            "o = eye".to_owned(),
            vector_line("o", self.ray.origin),
            "w = (eye - target) / |eye - target|".to_owned(),
            vector_line("w", w),
            "u = up x w / |up x w|".to_owned(),
            vector_line("u", u),
            "v = w x u".to_owned(),
            vector_line("v", v),
            String::new(),
            "view rectangle at distance 1".to_owned(),
        ]);
        lines.extend(rectangle.offset_texts());
        let [mut along, mut up] = ["u", "v"];
        if rectangle.tilt() != Vec2::ZERO {
            // The sides have names of their own, as only the sides of an untilted rectangle are along u and v.
            [along, up] = ["a", "b"];
            let Basis { u, v, .. } = self.camera.rectangle_basis();
            let sides = "a, b = unit vectors of its sides".to_owned();
            lines.extend([sides, vector_line("a", u), vector_line("b", v)]);
        }
        lines.extend([
            format!("width {} height {}", padded_number(width), padded_number(height)),
            "q0 = its lower left corner".to_owned(),
            vector_line("q0", corner(0.0, 0.0)),
            format!("q = q0 + width q_u {along} + height q_v {up}"),
            vector_line("q", self.q_in_space()),
            "d = q - o".to_owned(),
            vector_line("d", self.ray.direction),
        ]);
    }

    /// Adds lines with the tested surfaces and their roots. The closest hit is marked.
    fn add_tests(&self, lines: &mut Vec<String>) {
        let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
        let nodes = count(self.nodes as usize, "node");
        lines.push(String::new());
        lines.push("t of o + t d on the surfaces".to_owned());
        lines.push(format!("tested: {}, {nodes}", count(self.tested.len(), "surface")));
        for (at, tested) in self.tested.iter().enumerate() {
            let mark = if at == 0 && tested.t.is_some() { '>' } else { ' ' };
            let line = |name: &str| format!("{mark} {name:<14} {}", root_values(tested));
            let name = tested.name.to_string();
            let full = line(&name);
            // A face's name that is too long for the line is shown without the word `face`.
            lines.push(if full.len() <= MAX_LINE_WIDTH { full } else { line(name.trim_start_matches("face ")) });
        }
    }

    fn add_hit(&self, shaded: &ShadedHit, lines: &mut Vec<String>) {
        lines.push(String::new());
        lines.push(format!("crossing with {}", shaded.name));
        if let Some(closest) = self.tested.first() {
            add_equation(&closest.equation, lines);
        }
        let side = match shaded.point.side {
            Side::Front => "front",
            Side::Back => "back",
        };
        lines.extend([
            "p = o + t d".to_owned(),
            vector_line("p", shaded.point.position),
            format!("n = unit normal, {side} side"),
            vector_line("n", shaded.point.shading_normal),
        ]);
        for (number, contribution) in (1..).zip(&shaded.lights) {
            add_light(number, contribution, lines);
        }
        lines.push(String::new());
        lines.extend([
            "E = ambient + all lights".to_owned(),
            light_line("ambient", shaded.ambient),
            light_line("E", shaded.arriving),
        ]);
        let (finish, mirrored) = shaded.finish;
        match finish {
            Finish::Matte => lines.push("L = R E with the reflectance R".to_owned()),
            Finish::Polished { .. } => lines.extend([
                "polished: mirrors F (Fresnel)".to_owned(),
                format!("F    {}", padded_number(mirrored)),
                "L = (1 - F) R E + F L'".to_owned(),
                "L' = light of the mirrored ray".to_owned(),
            ]),
            Finish::Shiny { exponent, strength } => lines.extend([
                "shiny: L = R E + s H".to_owned(),
                format!("H = sum of V I (n.h)^{exponent} / D^2"),
                format!("s    {}", padded_number(strength)),
            ]),
            Finish::Metal { roughness: 0.0 } => {
                lines.extend(["metal: L = R L'".to_owned(), "L' = light of the mirrored ray".to_owned()]);
            }
            Finish::Metal { .. } => {
                lines.extend(["rough metal: L = R L'".to_owned(), "L' = mean of mirrored rays".to_owned()]);
            }
            Finish::Glass { .. } => lines.extend([
                "glass: mirrors F (Fresnel)".to_owned(),
                format!("F    {}", padded_number(mirrored)),
                "L = F L' + (1 - F) R L''".to_owned(),
                "L' = light of the mirrored ray".to_owned(),
                "L'' = light of the refracted ray".to_owned(),
            ]),
            Finish::Glowing { strength } => {
                lines.extend(["glowing: L = s R".to_owned(), format!("s    {}", padded_number(strength))]);
            }
        }
        lines.push(light_line("R", shaded.reflectance));
        if shaded.emission != LinearRgb::BLACK {
            lines.push("and light of its own: L = L + L_o".to_owned());
            lines.push(light_line("L_o", shaded.emission));
        }
        if shaded.opacity < 1.0 {
            lines.push("of opacity a: L = a L + (1 - a) L_p".to_owned());
            lines.push(format!("a    {}", padded_number(shaded.opacity)));
            lines.push("L_p = light of the passing ray".to_owned());
        }
    }

    fn add_tone(&self, lines: &mut Vec<String>) {
        let curve = match self.tone_curve {
            ToneCurve::None => "no curve",
            ToneCurve::Reinhard => "Reinhard",
            ToneCurve::Filmic => "Filmic",
        };
        lines.push(format!("tone: exposure {}, {curve}", self.exposure));
        lines.push(light_line("shown", self.shown));
        let [r, g, b] = [self.bytes.r, self.bytes.g, self.bytes.b];
        lines.push(format!("sRGB {r} {g} {b}  #{r:02x}{g:02x}{b:02x}"));
    }
}

/// Formats the roots of a tested surface's equation, with the tracer's t in the place of the root
/// of the crossing.
// The equation is solved in f64, so its root may differ slightly from the t of the tracer, which the picture shows.
fn root_values(TestedSurface { t, is_hole, equation, .. }: &TestedSurface) -> String {
    let Equation { roots, without_root, is_outside, .. } = equation;
    if roots.is_empty() {
        return format!("  {without_root}");
    }
    let mut shown: Vec<_> = roots.iter().map(|&root| root as f32).collect();
    if let Some(t) = *t {
        // The crossing is the first root in front of the eye: from inside a sphere, the second root.
        let own = roots.iter().position(|&root| root >= 0.0).unwrap_or(roots.len() - 1);
        shown[own] = t;
    }
    let remark = match t {
        None if *is_hole => "  hole",
        None if *is_outside => "  outside",
        _ => "",
    };
    shown.into_iter().map(padded_number).collect::<String>() + remark
}

fn add_equation(equation: &Equation, lines: &mut Vec<String>) {
    lines.extend(equation.steps.iter().flat_map(|step| match step {
        EquationStep::Value(what, value) => vec![format!("  {what:<21}{}", padded_number(*value as f32))],
        EquationStep::Text(text) => vec![format!("  {text}")],
        EquationStep::Formula(formula) => formula_lines(formula),
        EquationStep::Values(before, between, values) => {
            let values: Vec<_> = values.iter().map(|&value| padded_number(value as f32)).collect();
            vec![format!("  {before}{}", values.join(between))]
        }
    }));
}

/// Breaks a formula, which is ASCII, into at most three lines.
fn formula_lines(formula: &str) -> Vec<String> {
    const MAX_LINES: usize = 3;
    let (width, mut lines) = (MAX_LINE_WIDTH - "  f = ".len(), Vec::new());
    for (at, part) in formula.as_bytes().chunks(width).take(MAX_LINES).enumerate() {
        let is_cut = at + 1 == MAX_LINES && formula.len() > MAX_LINES * width;
        let part = if is_cut { &part[..width - "...".len()] } else { part };
        let (start, end) = (if at == 0 { "  f = " } else { "      " }, if is_cut { "..." } else { "" });
        lines.push(format!("{start}{}{end}", String::from_utf8_lossy(part).trim_end()));
    }
    lines
}

fn add_light(at: usize, contribution: &LightContribution, lines: &mut Vec<String>) {
    let incidence = &contribution.incidence;
    lines.push(String::new());
    lines.push(format!("light {at}: {}", contribution.light.formula()));
    let (visibility, light) = (contribution.visibility(), &contribution.light);
    lines.push(match contribution.blocker {
        _ if 0.0 < visibility && visibility < 1.0 => format!("V = {visibility:.4}, partly lit"),
        _ if visibility > 0.0 => "V = 1, lit".to_owned(),
        _ if !contribution.faces() => "V = 0, faces away".to_owned(),
        Some((name, _)) => format!("V = 0, behind {name}"),
        None if light.cone_share(incidence.l) == Some(0.0) => "V = 1, outside the cone".to_owned(),
        None => "V = 0, in the shadow".to_owned(),
    });
    if light.has_size() {
        lines.push("mean of 16 parts; l, D: the middle".to_owned());
    }
    lines.push(light_line("I", contribution.light.color()));
    lines.push(vector_line("l", incidence.l));
    lines.push(format!("n.l  {}", padded_number(incidence.cosine)));
    lines.push(match incidence.distance {
        f32::INFINITY => "D         infinite".to_owned(),
        distance => format!("D    {}", padded_number(distance)),
    });
    if let Some(share) = contribution.light.cone_share(incidence.l) {
        lines.push(format!("S    {}", padded_number(share)));
    }
    lines.push(light_line("=", contribution.arriving()));
}

fn vector_line(name: &str, Vec3 { x, y, z }: Vec3) -> String {
    format!("{name:<5}{} {} {}", padded_number(x), padded_number(y), padded_number(z))
}

fn light_line(name: &str, LinearRgb { r, g, b }: LinearRgb) -> String {
    let [r, g, b] = [r, g, b].map(|channel| format!("{:>8}", padded_number(channel).trim_start()));
    format!("{name:<9}{r} {g} {b}")
}

/// Formats a number, right-aligned in nine columns.
fn padded_number(x: f32) -> String {
    // Four decimals would show a single digit below 1e-3, and take ten columns from 1e3 on, with a sign. Two decimals
    // would take ten columns from 1e5 on.
    let size = x.abs();
    match size {
        _ if size == 0.0 => format!("{:9.4}", 0.0),
        _ if !(1e-3..1e5).contains(&size) => format!("{x:>9.2e}"),
        _ if size < 999.5 => format!("{x:9.4}"),
        _ => format!("{x:9.2}"),
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
