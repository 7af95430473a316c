//! Limits of size behind a letter and a grade: `h7` on 17.6 mm is 0 and −0.018 mm.
//!
//! ISO 286-1 for diameters up to 500 mm. A fit is a position of the tolerance zone (letters; capitals for holes) and a width (grade).
//! The intermediate letters `cd`, `ef`, `fg` of fine mechanics are not tabulated here.

mod table;

use std::fmt;

use table::{DELTA, FINE_STEPS_MM, GRADES, HOLE_J, NONE, SHAFT_J, SHAFTS, STEPS_MM, TOLERANCE};

/// Places of grades in [`GRADES`].
const IT3: usize = 4;
const IT4: usize = 5;
const IT5: usize = 6;
const IT6: usize = 7;
const IT7: usize = 8;
const IT8: usize = 9;
const IT14: usize = 15;
/// Below this, as far as it, the widest grades and positions are not defined, mm.
const SMALLEST_MM: f64 = 1.0;
/// Deviations are whole multiples of 0.05 µm: half of the tenth in which the finest tolerances are given.
const PER_METRE: f64 = 2e7;
const PER_MICROMETRE: i32 = 20;
const PER_TENTH: i32 = 2;

/// A position and a width of a tolerance zone on a diameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fit {
    /// Of a hole, as opposed to a shaft.
    hole: bool,
    /// Place in [`SHAFTS`], or that many for `j`.
    letter: usize,
    /// Place in [`GRADES`].
    grade: usize,
}

/// Why there are no limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// Not the letters of a position.
    Letters,
    /// Not a grade.
    Grade,
    /// The position does not exist with this grade at any diameter.
    Never(Fit),
    /// It exists at other diameters only: above the first, up to the second, m.
    Diameter(Fit, [f64; 2]),
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Letters => write!(f, "ISO 286 has no position with these letters for diameters up to 500 mm"),
            Self::Grade => write!(f, "grades go from 01, 0 and 1 to 18"),
            Self::Never(fit) => write!(f, "`{fit}` is not tabulated in ISO 286"),
            Self::Diameter(fit, [from_m, to_m]) => {
                let mm = |m: &f64| (m * 1e6).round() / 1e3;
                write!(f, "`{fit}` is tabulated for diameters above {} mm up to {} mm", mm(from_m), mm(to_m))
            }
        }
    }
}

impl std::error::Error for FitError {}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letters = SHAFTS.get(self.letter).map_or("j", |s| s.0);
        let grade = GRADES[self.grade];
        if self.hole { write!(f, "{}{grade}", letters.to_ascii_uppercase()) } else { write!(f, "{letters}{grade}") }
    }
}

impl Fit {
    /// Whether a word is meant as a fit: one or two letters, then one or two digits.
    pub fn looks_like(word: &str) -> bool {
        let digits = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
        (1..=2).contains(&(word.len() - digits.len())) && (1..=2).contains(&digits.len()) && digits.bytes().all(|b| b.is_ascii_digit())
    }

    /// Reads `h7`, `JS6`, `h01`.
    ///
    /// # Errors
    /// Letters or a grade that do not exist.
    pub fn parse(text: &str) -> Result<Self, FitError> {
        let at = text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len());
        let (letters, grade) = text.split_at(at);
        let hole = letters.chars().all(|c| c.is_ascii_uppercase());
        let small = if hole { letters.to_ascii_lowercase() } else { letters.to_owned() };
        let letter = if small == "j" { Some(SHAFTS.len()) } else { SHAFTS.iter().position(|s| s.0 == small) };
        let letter = letter.ok_or(FitError::Letters)?;
        let grade = GRADES.iter().position(|g| *g == grade).ok_or(FitError::Grade)?;
        Ok(Self { hole, letter, grade })
    }

    /// Lower and upper deviation from a nominal diameter, both in m.
    ///
    /// ```
    /// use forcewright_base::fits::Fit;
    ///
    /// let shaft = Fit::parse("h7")?.deviations_m(17.6e-3)?;
    /// assert_eq!(shaft, [-18e-6, 0.0]);
    /// # Ok::<(), forcewright_base::fits::FitError>(())
    /// ```
    ///
    /// # Errors
    /// The fit is not defined for this diameter.
    pub fn deviations_m(&self, diameter_m: f64) -> Result<[f64; 2], FitError> {
        // Written so that a diameter that is not a number has none.
        let place = FINE_STEPS_MM.iter().position(|up_to| diameter_m <= up_to / 1e3).filter(|_| diameter_m > 0.0);
        let small = diameter_m <= SMALLEST_MM / 1e3;
        let Some(limits) = place.and_then(|place| self.limits(place, small)) else {
            return Err(self.diameters_m().map_or(FitError::Never(*self), |all| FitError::Diameter(*self, all)));
        };
        Ok(limits.map(|limit| f64::from(limit) / PER_METRE))
    }

    /// The same position with the coarsest grade whose zone is no wider than this (m) at a diameter; `None` if the finest is wider.
    ///
    /// ```
    /// use forcewright_base::fits::Fit;
    ///
    /// let found = Fit::parse("h7")?.coarsest(17.6e-3, 50e-6).map(|fit| fit.to_string());
    /// // h9 is 43 µm wide, h10 is 70 µm.
    /// assert_eq!(found.as_deref(), Some("h9"));
    /// # Ok::<(), forcewright_base::fits::FitError>(())
    /// ```
    pub fn coarsest(&self, diameter_m: f64, width_m: f64) -> Option<Self> {
        let grades = (0..GRADES.len()).rev().map(|grade| Self { grade, ..*self });
        grades.into_iter().find(|fit| fit.deviations_m(diameter_m).is_ok_and(|[low, high]| high - low <= width_m))
    }

    /// The diameters for which it is defined, m: above the first, up to and with the second. `None` if there are none.
    pub fn diameters_m(&self) -> Option<[f64; 2]> {
        let steps = [(0, SMALLEST_MM, true)].into_iter().chain(FINE_STEPS_MM.iter().enumerate().map(|(i, up_to)| (i, *up_to, false)));
        let (mut below, mut found) = (0.0, None);
        for (place, up_to, small) in steps {
            if self.limits(place, small).is_some() {
                found = Some([found.map_or(below, |[from, _]: [f64; 2]| from), up_to / 1e3]);
            }
            below = up_to / 1e3;
        }
        found
    }

    /// Lower and upper limit in an intermediate step, in multiples of 0.05 µm; `small` for diameters up to 1 mm.
    fn limits(&self, fine: usize, small: bool) -> Option<[i32; 2]> {
        let main = STEPS_MM.iter().position(|up_to| FINE_STEPS_MM[fine] <= *up_to)?;
        if small && self.grade >= IT14 {
            return None;
        }
        let width = PER_TENTH * TOLERANCE[self.grade][main];
        let letters = SHAFTS.get(self.letter).map_or("j", |s| s.0);
        if small && (letters == "a" || letters == "b") {
            return None;
        }
        let defined = |value: i32| (value != NONE).then(|| PER_MICROMETRE * value);
        // ISO 286-1 up to 1988 let makers round ±IT/2 of the grades 7 to 11 down to whole micrometres; here it is exact.
        if letters == "js" {
            return Some([-width / 2, width / 2]);
        }
        if letters == "j" {
            return if self.hole {
                let row = self.grade.checked_sub(IT6)?;
                let upper = defined(HOLE_J.get(row)?[main])?;
                Some([upper - width, upper])
            } else {
                let row = self.grade.checked_sub(IT5)?;
                let lower = -defined(SHAFT_J.get(row.saturating_sub(1))?[fine])?;
                Some([lower, lower + width])
            };
        }
        let values = SHAFTS[self.letter].1;
        let own = defined(*values.get(if values.len() == STEPS_MM.len() { main } else { fine })?)?;
        match (letters.as_bytes()[0], self.hole) {
            (b'a'..=b'h', false) => Some([-own - width, -own]),
            (b'k'..=b'z', true) => {
                let upper = self.upper_of_hole(letters, own, main, small)?;
                Some([upper - width, upper])
            }
            (b'k', false) if !(IT4..=IT7).contains(&self.grade) => Some([0, width]),
            _ => Some([own, own + width]),
        }
    }

    /// Upper limit of the holes `K` to `ZC` in a main step: the shaft's fundamental deviation with its sign turned, and for the finer
    /// grades Δ more, so that a hole with a shaft one grade finer fits as the shaft with a hole `H` does.
    fn upper_of_hole(&self, letters: &str, own: i32, main: usize, small: bool) -> Option<i32> {
        let first = main == 0;
        let with_delta = self.grade <= if matches!(letters, "k" | "m" | "n") { IT8 } else { IT7 };
        if with_delta {
            let row = DELTA.get(self.grade.checked_sub(IT3)?)?;
            // The exception of Table 3: M6 above 250 up to 315 mm.
            let rounding = if letters == "m" && self.grade == IT6 && main == 10 { 2 * PER_MICROMETRE } else { 0 };
            return Some(PER_TENTH * row[main] - own + rounding);
        }
        match letters {
            "k" => first.then_some(0),
            "n" if small => None,
            "n" if !first => Some(0),
            _ => Some(-own),
        }
    }
}

#[cfg(test)]
mod tests;
