//! Numbers and texts as files want them.

pub(crate) use forcewright_base::text::xml;
use forcewright_model::Part;

use crate::shape::MM_PER_M;

/// A length in mm: at most twelve decimals, none that say nothing.
pub(crate) fn length(mm: f64) -> String {
    decimals(mm, 12)
}

/// A number of the order of 1: at most fifteen decimals, none that say nothing.
pub(crate) fn ratio(value: f64) -> String {
    decimals(value, 15)
}

fn decimals(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// What people must know to make the part, a line each: title, material and depth, holes, notes.
pub(crate) fn remarks(part: &Part) -> Vec<String> {
    let material = part.material.as_deref().unwrap_or("not stated");
    let mut lines = vec![
        part.title.clone(),
        format!("Material: {material}. Depth: {} mm.", length(part.depth_m * MM_PER_M)),
        "All lengths in mm.".to_owned(),
    ];
    for hole in &part.holes {
        let [x, y] = hole.centre_m.map(|coordinate| length(coordinate * MM_PER_M));
        let diameter = length(hole.diameter_m * MM_PER_M);
        lines.push(format!("Hole of diameter {diameter} at ({x}, {y}): {}", hole.purpose));
    }
    lines.extend(part.notes.iter().cloned());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_no_rounding_noise() {
        for (value, want) in [(0.1 + 0.2, "0.3"), (-1e-13, "0"), (1e3, "1000"), (-12.5, "-12.5"), (0.0, "0")] {
            assert_eq!(length(value), want);
        }
        assert_eq!(ratio(1.0 / 3.0), "0.333333333333333");
    }
}
