//! General tolerances by name: `30 mm ISO 2768-m` is made between 29.8 mm and 30.2 mm.
//!
//! ISO 2768-1:1989, table 1: linear dimensions except broken edges. Its angles go by the length of their legs, and form and position (the
//! second letter of `ISO 2768-mK`, ISO 2768-2) are no deviation of a length: neither is here.

use std::fmt;

/// Nominal sizes up to which each column goes, mm, and the size from which the first begins.
const UP_TO_MM: [f64; 8] = [3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0];
const SMALLEST_MM: f64 = 0.5;
/// No tolerance.
const NONE: f64 = 0.0;
/// Letter, name, and half widths of each column, mm.
const CLASSES: [(char, &str, [f64; 8]); 4] = [
    ('f', "fine", [0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, NONE]),
    ('m', "medium", [0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0]),
    ('c', "coarse", [0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0]),
    ('v', "very coarse", [NONE, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0]),
];
/// How the standard is written before the letter of a class.
const STANDARD: &str = "ISO 2768";

/// A tolerance class of ISO 2768-1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct General {
    /// Place in [`CLASSES`], the finest first.
    class: usize,
}

/// Why there is no tolerance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum GeneralError {
    /// What stands where the letter of a class should.
    Class(String),
    /// The class has none for this length.
    Length(General),
    /// The quantity is no length.
    Quantity,
}

impl fmt::Display for GeneralError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Class(typed) => {
                let form = match typed.as_bytes() {
                    [b'f' | b'm' | b'c' | b'v', b'H' | b'K' | b'L'] => "; a second letter is of ISO 2768-2, form and position",
                    _ => "",
                };
                write!(f, "the classes of ISO 2768-1 are f (fine), m (medium), c (coarse) and v (very coarse){form}")
            }
            Self::Length(general) => {
                let [from_m, to_m] = general.lengths_m();
                let from = if general.begins_above() { "above" } else { "from" };
                write!(f, "`{general}` is given for lengths {from} {} mm to {} mm", from_m * 1e3, to_m * 1e3)
            }
            Self::Quantity => write!(f, "ISO 2768-1 is for lengths"),
        }
    }
}

impl std::error::Error for GeneralError {}

impl fmt::Display for General {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{STANDARD}-{}", CLASSES[self.class].0)
    }
}

impl General {
    /// Splits a text at the name of the standard, `ISO 2768` with or without a blank or hyphen, in capitals or not: what is before it, and
    /// what stands behind it without its hyphen.
    pub fn split(text: &str) -> Option<(&str, &str)> {
        let begins = |at: usize| text.get(at..at + 3).is_some_and(|word| word.eq_ignore_ascii_case("iso"));
        let (before, name) = text.split_at((0..text.len()).find(|at| begins(*at))?);
        let behind = name[3..].trim_start_matches([' ', '-']).strip_prefix("2768")?;
        // `ISO 2768-1-m` names the part as well.
        let behind = behind.strip_prefix("-1").filter(|rest| rest.starts_with(['-', ' '])).unwrap_or(behind);
        Some((before, behind.trim_start_matches(['-', ' ']).trim_end()))
    }

    /// Reads the letter of a class: `f`, `m`, `c`, `v`.
    ///
    /// # Errors
    /// [`GeneralError::Class`]: another text.
    pub fn parse(letter: &str) -> Result<Self, GeneralError> {
        let class = CLASSES.iter().position(|(known, ..)| letter.strip_prefix(*known) == Some(""));
        class.map(|class| Self { class }).ok_or_else(|| GeneralError::Class(letter.to_owned()))
    }

    /// Half width of the zone about a nominal length, both in m.
    ///
    /// ```
    /// use forcewright_base::general::General;
    ///
    /// assert_eq!(General::parse("m")?.half_width_m(30e-3)?, 0.2e-3);
    /// # Ok::<(), forcewright_base::general::GeneralError>(())
    /// ```
    ///
    /// # Errors
    /// [`GeneralError::Length`]: the class has no tolerance for this length.
    pub fn half_width_m(&self, length_m: f64) -> Result<f64, GeneralError> {
        // Written so that a length that is not a number has none.
        let place = UP_TO_MM.iter().position(|up_to| length_m <= up_to / 1e3).filter(|_| length_m >= SMALLEST_MM / 1e3);
        let half_mm = place.map_or(NONE, |place| CLASSES[self.class].2[place]);
        if half_mm > 0.0 { Ok(half_mm / 1e3) } else { Err(GeneralError::Length(*self)) }
    }

    /// The coarsest class whose half width (m) is no larger than this at a length; `None` if the finest is.
    pub fn coarsest(length_m: f64, half_width_m: f64) -> Option<Self> {
        let classes = (0..CLASSES.len()).rev().map(|class| Self { class });
        classes.into_iter().find(|general| general.half_width_m(length_m).is_ok_and(|half| half <= half_width_m))
    }

    /// The lengths for which it is given, m.
    pub fn lengths_m(&self) -> [f64; 2] {
        let widths = &CLASSES[self.class].2;
        let first = widths.iter().position(|w| *w > 0.0).unwrap_or_default();
        let last = widths.iter().rposition(|w| *w > 0.0).unwrap_or_default();
        let from = first.checked_sub(1).map_or(SMALLEST_MM, |before| UP_TO_MM[before]);
        [from / 1e3, UP_TO_MM[last] / 1e3]
    }

    /// Whether the first of its lengths belongs to the column before.
    pub fn begins_above(&self) -> bool {
        CLASSES[self.class].2[0] <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_mm(class: &str, mm: f64) -> Option<f64> {
        General::parse(class).expect("a class").half_width_m(mm / 1e3).ok().map(|m| m * 1e3)
    }

    /// Rows of table 1 of ISO 2768-1 at the ends of its columns.
    #[test]
    fn as_the_table_has_it() {
        for (class, mm, half) in [
            ("f", 0.5, 0.05),
            ("f", 6.0, 0.05),
            ("f", 6.001, 0.1),
            ("f", 2000.0, 0.5),
            ("m", 3.0, 0.1),
            ("m", 30.0, 0.2),
            ("m", 30.001, 0.3),
            ("m", 120.0, 0.3),
            ("m", 400.0, 0.5),
            ("m", 1000.0, 0.8),
            ("m", 4000.0, 2.0),
            ("c", 3.0, 0.2),
            ("c", 6.0, 0.3),
            ("c", 31.0, 0.8),
            ("v", 3.001, 0.5),
            ("v", 4000.0, 8.0),
        ] {
            assert!((half_mm(class, mm).expect("given") - half).abs() < 1e-12, "{class} {mm}");
        }
        for (class, mm) in [("f", 0.49), ("f", 2000.1), ("m", 4000.1), ("v", 3.0), ("m", f64::NAN), ("m", -10.0)] {
            assert_eq!(half_mm(class, mm), None, "{class} {mm}");
        }
    }

    /// Coarser is never narrower, longer is never narrower.
    #[test]
    fn wider_with_class_and_length() {
        for mm in [0.6, 4.0, 20.0, 100.0, 300.0, 900.0, 1500.0, 3000.0] {
            let all: Vec<f64> = ["f", "m", "c", "v"].iter().filter_map(|class| half_mm(class, mm)).collect();
            assert!(all.windows(2).all(|pair| pair[0] < pair[1]), "{mm}: {all:?}");
            let next: Vec<f64> = ["f", "m", "c", "v"].iter().filter_map(|class| half_mm(class, 3.0 * mm)).collect();
            assert!(all.iter().zip(&next).all(|(here, there)| here <= there) || all.len() != next.len());
        }
    }

    #[test]
    fn the_coarsest_that_will_do() {
        let found = |mm: f64, half: f64| General::coarsest(mm / 1e3, half / 1e3).map(|g| g.to_string());
        assert_eq!(found(30.0, 0.21).as_deref(), Some("ISO 2768-m"));
        assert_eq!(found(30.0, 1.5).as_deref(), Some("ISO 2768-v"));
        assert_eq!(found(30.0, 0.09), None);
        assert_eq!(found(5000.0, 100.0), None);
    }
}
