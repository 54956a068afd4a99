//! The difference between two states of a terminal's settings, in words.

use rustix::termios::{SpecialCodeIndex, Termios};

/// Returns one line for each difference.
pub(super) fn changes(before: &Termios, after: &Termios) -> Vec<String> {
    let mut changes = Vec::new();
    // The four sets of flags are four types: a macro does for them what a function cannot.
    macro_rules! compare {
        ($($field:ident),*) => {$(
            let (was, is) = (before.$field, after.$field);
            if !(was - is).is_empty() {
                changes.push(format!("{} turned off: {:?}", stringify!($field), was - is));
            }
            if !(is - was).is_empty() {
                changes.push(format!("{} turned on: {:?}", stringify!($field), is - was));
            }
        )*};
    }
    compare!(input_modes, output_modes, control_modes, local_modes);
    changes.extend(codes().into_iter().filter_map(|(name, index)| {
        let (was, is) = (before.special_codes[index], after.special_codes[index]);
        (was != is).then(|| format!("{name} was {was:?}, is {is:?}"))
    }));
    if before.output_speed() != after.output_speed() {
        changes.push(format!("speed was {}, is {}", before.output_speed(), after.output_speed()));
    }
    changes
}

fn codes() -> [(&'static str, SpecialCodeIndex); 13] {
    [
        ("VINTR", SpecialCodeIndex::VINTR),
        ("VQUIT", SpecialCodeIndex::VQUIT),
        ("VERASE", SpecialCodeIndex::VERASE),
        ("VKILL", SpecialCodeIndex::VKILL),
        ("VEOF", SpecialCodeIndex::VEOF),
        ("VTIME", SpecialCodeIndex::VTIME),
        ("VMIN", SpecialCodeIndex::VMIN),
        ("VSTART", SpecialCodeIndex::VSTART),
        ("VSTOP", SpecialCodeIndex::VSTOP),
        ("VSUSP", SpecialCodeIndex::VSUSP),
        ("VREPRINT", SpecialCodeIndex::VREPRINT),
        ("VWERASE", SpecialCodeIndex::VWERASE),
        ("VLNEXT", SpecialCodeIndex::VLNEXT),
    ]
}
