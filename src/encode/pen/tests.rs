use super::*;
use crate::color::Srgb8;

/// Checks that the switch cost from any pen to any other equals the number of bytes that the switch
/// appends.
#[test]
fn costs_are_true() {
    let inks = [Ink::Default, Ink::Indexed(7), Ink::Indexed(200), Ink::Rgb(Srgb8::new(0, 10, 100))];
    let inks = inks.map(PackedInk::from);
    let reversed = Attributes::REVERSED;
    let attributes = [Attributes::empty(), reversed, Attributes::BOLD, Attributes::BOLD | reversed, Attributes::all()];
    let colors = || inks.into_iter().flat_map(|fg| inks.map(|bg| (fg, bg)));
    let looks = || colors().flat_map(|colors| inks.map(|underline| (colors, underline)));
    let pens: Vec<Pen> = looks()
        .flat_map(|((fg, bg), underline)| attributes.map(|attributes| Pen { fg, bg, underline, attributes }))
        .collect();
    for from in &pens {
        for to in &pens {
            let mut bytes = Vec::new();
            let mut pen = *from;
            pen.switch_to(*to, &mut bytes);
            assert_eq!((pen, bytes.len()), (*to, from.switch_cost(to)), "{from:?} to {to:?}");
        }
    }
}
