//! Numbers and names as people read them: true minus signs, a quantity over its unit.

use forcewright_base::units::Unit;

/// Text whose hyphens before numbers are true minus signs. Hyphens in words, ranges and units stay.
pub(crate) fn with_minus(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied();
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let sign = |i: usize| {
        let before = i.checked_sub(1).and_then(at);
        let number = digit(at(i + 1)) || (at(i + 1) == Some('.') && digit(at(i + 2))) || at(i + 1) == Some('∞');
        let starts = before.is_none_or(|c| c.is_whitespace() || matches!(c, '[' | '(' | ',' | '±' | '=' | '≤' | '≥'));
        let exponent = matches!(before, Some('e' | 'E')) && digit(i.checked_sub(2).and_then(at));
        number && (starts || exponent)
    };
    chars.iter().enumerate().map(|(i, c)| if *c == '-' && sign(i) { '−' } else { *c }).collect()
}

/// `Displacement Δ / mm`, as ISO 80000-1 writes it; `Stiffness / (N/mm)`; only the name for a pure number.
pub(crate) fn over_unit(name: &str, unit: &Unit) -> String {
    match unit.pretty() {
        unit if unit.is_empty() => name.to_owned(),
        unit if unit.contains('/') => format!("{name} / ({unit})"),
        unit => format!("{name} / {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use forcewright_base::units::Unit;

    use super::{over_unit, with_minus};

    #[test]
    fn only_signs_become_minus_signs() {
        for (text, want) in [
            ("-20.09 N/mm", "−20.09 N/mm"),
            ("[1.3, -1.57]", "[1.3, −1.57]"),
            ("3.1e-9", "3.1e−9"),
            ("-.5", "−.5"),
            ("POM-C, 2-3 parts", "POM-C, 2-3 parts"),
            ("kg*m^-1", "kg*m^-1"),
            ("shape-1 - 2", "shape-1 - 2"),
        ] {
            assert_eq!(with_minus(text), want);
        }
    }

    #[test]
    fn a_quantity_stands_over_its_unit() {
        let of = |symbol: &str| over_unit("Q", &Unit::parse(symbol).unwrap());
        assert_eq!((of("mm"), of("N/mm"), of("")), ("Q / mm".to_owned(), "Q / (N/mm)".to_owned(), "Q".to_owned()));
    }
}
