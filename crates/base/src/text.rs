//! Suggestions for misspelt words, and typed text made safe to show.

use std::borrow::Cow;

/// Text as it may be shown on a terminal: control characters, which would move the cursor or change colours, and characters that turn
/// the direction of writing become `·`.
pub fn visible(text: &str) -> Cow<'_, str> {
    let hidden =
        |c: char| c.is_control() && c != '\t' || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if text.contains(hidden) { Cow::Owned(text.replace(hidden, "·")) } else { Cow::Borrowed(text) }
}

/// The candidate nearest to `word`, if it is near enough to be worth suggesting.
///
/// Near is: equal but for case, or one is the beginning of the other (three letters or more), or a Damerau–Levenshtein similarity of at
/// least 0.6 without case. Ties go to the first candidate, so the answer does not depend on anything but the arguments.
pub fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Longer than any key: comparing it costs time and suggests nothing.
    if word.chars().count() > 64 {
        return None;
    }
    let plain = normalise(word);
    let mut best: Option<(f64, &str)> = None;
    for candidate in candidates {
        let score = similarity(&plain, &normalise(candidate));
        if score >= 0.6 && best.is_none_or(|(top, _)| score > top) {
            best = Some((score, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

fn normalise(word: &str) -> String {
    word.to_lowercase().replace(['-', ' '], "_")
}

fn similarity(word: &str, candidate: &str) -> f64 {
    if word == candidate {
        return 1.0;
    }
    let whole = strsim::normalized_damerau_levenshtein(word, candidate);
    // `thick` for `thickness`, `modulus` for `young_modulus`.
    let part = word.len() >= 3 && (candidate.starts_with(word) || candidate.split('_').any(|p| p == word));
    let reverse = candidate.len() >= 4 && word.starts_with(candidate);
    if part || reverse { whole.max(0.75) } else { whole }
}

/// Text for XML and HTML: the five characters that mean something there replaced, and control characters (which XML forbids) left out.
pub fn xml(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}

/// A number of things: `1 design`, `2 designs`; for nouns whose plural ends in `s`.
///
/// ```
/// assert_eq!([1_u32, 2].map(|n| forcewright_base::text::counted(n, "design")), ["1 design", "2 designs"]);
/// ```
pub fn counted<N: Copy + std::fmt::Display + PartialEq + From<u8>>(number: N, noun: &str) -> String {
    format!("{number} {noun}{}", if number == N::from(1) { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_found_and_far_ones_are_not() {
        let keys = ["thickness", "depth", "young_modulus", "yield_stress", "poisson_ratio", "density"];
        for (typed, meant) in [
            ("thicknes", "thickness"),
            ("Thickness", "thickness"),
            ("thick", "thickness"),
            ("yuong_modulus", "young_modulus"),
            ("modulus", "young_modulus"),
            ("yield-stress", "yield_stress"),
            ("poison_ratio", "poisson_ratio"),
            ("densty", "density"),
        ] {
            assert_eq!(closest(typed, keys), Some(meant), "{typed}");
        }
        assert_eq!(closest("colour", keys), None);
        assert_eq!(closest(&"x".repeat(100_000), keys), None);
    }

    #[test]
    fn markup_becomes_text() {
        assert_eq!(xml("<script>alert('a & \"b\"')</script>\u{0}"), "&lt;script&gt;alert(&#39;a &amp; &quot;b&quot;&#39;)&lt;/script&gt;");
    }
}
