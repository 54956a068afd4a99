//! Lists in prose, spelling suggestions, and short numbers.

/// Returns the words as a list in prose: `a`, `a and b`, `a, b and c`.
pub fn listed(words: &[impl AsRef<str>]) -> String {
    joined(words, "and")
}

/// Returns the words as alternatives in prose: `a`, `a or b`, `a, b or c`.
pub fn any_of(words: &[impl AsRef<str>]) -> String {
    joined(words, "or")
}

fn joined(words: &[impl AsRef<str>], conjunction: &str) -> String {
    match words {
        [] => String::new(),
        [only] => only.as_ref().to_owned(),
        [most @ .., last] => {
            let most: Vec<_> = most.iter().map(AsRef::as_ref).collect();
            format!("{} {conjunction} {}", most.join(", "), last.as_ref())
        }
    }
}

/// Returns the name in `among` that was probably meant by `word`: one with few different letters,
/// or one that contains the word as a part (`vertical_fov` for `fov`).
pub fn closest<'w>(word: &str, among: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    // Limits on the time: the distance takes time proportional to the product of the lengths. Longer words are not
    // misspelt names, and among more than a thousand names one would be close by chance.
    const MAX_WORD_BYTES: usize = 64;
    const MAX_CANDIDATES: usize = 1000;
    if word.len() > MAX_WORD_BYTES {
        return None;
    }
    let written = word.to_lowercase();
    among
        .into_iter()
        .take(MAX_CANDIDATES)
        .filter(|known| known.len() <= MAX_WORD_BYTES)
        .filter_map(|known| Some((misspelling_distance(&written, &known.to_lowercase())?, known)))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, known)| known)
}

/// Returns the edit distance of `written` from `known`, or `None` if they are too different.
///
/// They are too different if the distance is more than a third of the letters of `written`, unless `written` is one of
/// the parts between the underscores of `known`.
fn misspelling_distance(written: &str, known: &str) -> Option<usize> {
    let distance = edit_distance(written, known);
    // A `written` of one or two letters does not count as a part: too many names have such parts.
    let is_part = written.len() >= 3 && known.split('_').any(|part| part == written);
    let allowed = match written.chars().count() {
        // No differences are allowed in words of one or two letters: they would have too little in common.
        ..3 => 0,
        length => (length / 3).max(1),
    };
    (distance <= allowed || is_part).then_some(distance)
}

/// Returns the distance of two words by optimal string alignment: the least number of letters
/// added, removed, changed, or exchanged with their neighbours, where no letter is changed twice (Damerau, A technique
/// for computer detection and correction of spelling errors, 1964). The tests compare it with the crate `strsim`.
fn edit_distance(written: &str, known: &str) -> usize {
    let known: Vec<_> = known.chars().collect();
    // Three rows of the table of distances between prefixes, which dynamic programming fills: the current row, the one
    // before it, and the one before that.
    let mut earlier = vec![0; known.len() + 1];
    let mut before: Vec<_> = (0..=known.len()).collect();
    let mut row = before.clone();
    let mut last = None;
    for (i, letter) in written.chars().enumerate() {
        row[0] = i + 1;
        for (j, &wanted) in known.iter().enumerate() {
            let changed = before[j] + usize::from(letter != wanted);
            row[j + 1] = changed.min(before[j + 1] + 1).min(row[j] + 1);
            if j > 0 && last == Some(wanted) && known[j - 1] == letter {
                row[j + 1] = row[j + 1].min(earlier[j - 1] + 1);
            }
        }
        last = Some(letter);
        std::mem::swap(&mut earlier, &mut before);
        std::mem::swap(&mut before, &mut row);
    }
    before[known.len()]
}

/// Formats a number with about three significant digits.
///
/// All digits before the point are kept, zeros at the end of the digits after it are left out, and a magnitude below
/// 0.1 gets two digits and an exponent.
pub fn number(value: f32) -> String {
    let digits = match value.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        v if v >= 0.1 || v == 0.0 => 2,
        _ => return format!("{value:.1e}"),
    };
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(all(test, unit_tests))]
mod tests;
