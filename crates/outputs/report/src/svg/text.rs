//! How wide a text is, without a font: an upper bound for the common sans-serif faces.

/// Advances of U+0020 to U+007E in hundredths of the font size: the larger of `DejaVu` Sans (the widest of the usual screen faces) and
/// Liberation Sans (metrics of Arial and Helvetica), from their `hmtx` tables, rounded up.
const ADVANCES: [u8; 95] = [
    32, 41, 46, 84, 64, 96, 78, 28, 40, 40, 50, 84, 32, 37, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64, 64, 64, 34, 34, 84, 84, 84, 56, 102,
    69, 69, 73, 78, 67, 62, 78, 76, 30, 50, 67, 56, 87, 75, 79, 67, 79, 73, 67, 62, 74, 69, 99, 69, 67, 69, 40, 34, 40, 84, 56, 50, 62, 64,
    55, 64, 62, 36, 64, 64, 28, 28, 58, 28, 98, 64, 62, 64, 64, 42, 53, 40, 64, 60, 82, 60, 60, 53, 64, 34, 64, 84,
];

/// How much wider bold is.
const BOLD: f64 = 1.13;

fn advance(c: char) -> f64 {
    let code = c as usize;
    match c {
        ' '..='~' => f64::from(ADVANCES[code - 32]) / 100.0,
        // Latin letters with marks, Greek, Cyrillic, punctuation; the widest of them.
        '·' | '²' | '³' | '°' => 0.5,
        '\u{a0}'..='\u{52f}' => 0.8,
        '\u{2000}'..='\u{2fff}' => 1.0,
        // Ideographs and pictographs.
        _ => 1.3,
    }
}

/// Upper bound of the width of a text at a font size.
pub(super) fn width(text: &str, size: f64, bold: bool) -> f64 {
    let advances: f64 = text.chars().map(advance).sum();
    advances * size * if bold { BOLD } else { 1.0 }
}

/// The text, shortened with an ellipsis if it is wider than `max`.
pub(super) fn fit(text: &str, size: f64, bold: bool, max: f64) -> String {
    if width(text, size, bold) <= max {
        return text.to_owned();
    }
    let mut out = String::new();
    for c in text.chars() {
        out.push(c);
        if width(&out, size, bold) + width("…", size, bold) > max {
            out.pop();
            break;
        }
    }
    out.truncate(out.trim_end().len());
    out.push('…');
    out
}

/// The text in lines no wider than `max`; a word that is wider alone is broken.
pub(super) fn wrap(text: &str, size: f64, max: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let joined = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        if width(&joined, size, false) <= max {
            line = joined;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for c in word.chars() {
            line.push(c);
            if width(&line, size, false) > max && line.chars().count() > 1 {
                line.pop();
                lines.push(std::mem::take(&mut line));
                line.push(c);
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapped_lines_fit_and_keep_every_word() {
        let text = "c = 6.97 mm: the force reaches 95 % of its end value here, Unbrechbaresmesswertverarbeitungswort";
        let lines = wrap(text, 14.0, 120.0);
        assert!(lines.iter().all(|l| width(l, 14.0, false) <= 120.0));
        assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""));
        assert!(wrap("  ", 14.0, 50.0).is_empty());
    }

    #[test]
    fn a_long_text_is_shortened_and_a_short_one_kept() {
        assert_eq!(fit("abc", 10.0, false, 100.0), "abc");
        let short = fit("a long text that does not fit", 10.0, false, 60.0);
        assert!(short.ends_with('…') && width(&short, 10.0, false) <= 60.0);
    }
}
