//! What the cam was cut for, and force profiles.

use std::sync::Arc;

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::units::{Dimension, Quantity, Unit};
use forcewright_contract::data::{Column, DataFile, rows};
use forcewright_contract::describe::{Located, Slot};

use super::springs::table_of;
use super::{cut_sides, exclude, missing, place_of, si};
use crate::cut::{Cut, Purpose};
use crate::law::{ForceLaw, LawError};
use crate::measured::{Measured, Points, measured};
use crate::spec::Spec;
use crate::springs::{Bank, Spring, SpringLaw};

/// Of a file.
const MOST_ROWS: usize = 500;

/// Words and quantities of a law: a force over a travel, or a torque over a turn.
pub(crate) struct LawWords {
    /// Columns of its file, with their quantities.
    travel: (&'static str, Dimension),
    level: (&'static str, Dimension),
    /// Unit of the travel in messages, and the start of a travel in it.
    unit: &'static str,
    start: &'static str,
    /// Keys: the level, the profile and its file, and an example of all.
    keys: [&'static str; 3],
    example: &'static str,
}

/// A force over the travel of a slider.
pub(crate) const FORCE: LawWords = LawWords {
    travel: ("travel", Dimension::Length),
    level: ("force", Dimension::Force),
    unit: "mm",
    start: "0 mm",
    keys: ["for_force", "for_profile", "for_profile_file"],
    example: "give `for_force = \"50 N\"`, `for_profile = [[\"0 mm\", \"40 N\"], [\"240 mm\", \"60 N\"]]` or `for_profile_file`",
};
/// A torque over the turn of a disc.
pub(crate) const TORQUE: LawWords = LawWords {
    travel: ("turn", Dimension::Angle),
    level: ("torque", Dimension::Torque),
    unit: "deg",
    start: "0 deg",
    keys: ["for_torque", "for_torque_profile", "for_torque_profile_file"],
    example: "give `for_torque = \"2 N*m\"`, `for_torque_profile = [[\"0 deg\", \"1 N*m\"], [\"120 deg\", \"3 N*m\"]]` or `for_torque_profile_file`",
};

/// The slots in which a law is typed: a level, points, or a file.
pub(crate) struct LawSlots<'a> {
    pub level: &'a Slot<Quantity>,
    pub typed: &'a Slot<Vec<Located<[Quantity; 2]>>>,
    pub file: &'a Slot<DataFile>,
}

/// What the cam was cut for; `None` after an error.
pub(super) fn purpose_of(spec: &Spec, extension: bool, diagnostics: &mut Diagnostics) -> Option<Purpose> {
    let profile = &spec.design.profile;
    let slots = LawSlots { level: &profile.for_force, typed: &profile.for_profile, file: &profile.for_profile_file };
    let (law, springs) = law_and_springs(spec, extension, (&slots, &FORCE), diagnostics);
    let start = si(&profile.for_start_length).or(si(&profile.for_rest_length));
    if let (Some(_), None) = (&profile.for_curve, start) {
        diagnostics.push(missing(
            place_of(profile),
            "`for_start_length`",
            "with `for_curve` give the length of the springs where the path starts",
        ));
    }
    Some(Purpose {
        law: law?,
        springs: springs?,
        start_length_m: start?,
        sides: cut_sides(spec)?,
        friction: compensated(spec, si(&profile.for_friction)?),
        stroke_m: si(&spec.design.stroke)?,
    })
}

/// Friction as it is compensated: below zero on the way down.
pub(crate) fn compensated(spec: &Spec, friction: f64) -> f64 {
    let down = spec.design.profile.compensate.as_ref().is_some_and(|c| c.value == "down");
    if down { -friction } else { friction }
}

/// The law that is wanted and the springs for which the cam was cut.
pub(crate) fn law_and_springs(
    spec: &Spec,
    extension: bool,
    (slots, words): (&LawSlots<'_>, &LawWords),
    diagnostics: &mut Diagnostics,
) -> (Option<ForceLaw>, Option<Bank>) {
    let profile = &spec.design.profile;
    let place = place_of(profile);
    // A value that was refused has been reported: it is not missing as well.
    let sound = !diagnostics.has_errors();
    let law = wanted(slots, words, place, diagnostics);
    exclude(&profile.for_rate, &profile.for_curve, ["for_rate", "for_curve"], diagnostics);
    let spring = if let Some(curve) = &profile.for_curve {
        table_of(curve, diagnostics).map(SpringLaw::Table)
    } else {
        let example = "give `for_rate = \"1.38 N/mm\"` and `for_rest_length = \"136 mm\"`";
        if profile.for_rate.is_none() && sound {
            diagnostics.push(missing(place, "`for_rate`", example));
        }
        if profile.for_rest_length.is_none() && sound {
            diagnostics.push(missing(place, "`for_rest_length`", example));
        }
        si(&profile.for_rate).zip(si(&profile.for_rest_length)).map(|(rate_n_per_m, rest_m)| SpringLaw::Linear { rate_n_per_m, rest_m })
    };
    (law, spring.map(|law| Bank::new(vec![Spring { law, stretch_m: 0.0, mass_kg: 0.0 }], extension)))
}

/// The force or torque that is wanted.
fn wanted(slots: &LawSlots<'_>, words: &LawWords, place: Span, diagnostics: &mut Diagnostics) -> Option<ForceLaw> {
    let [level, typed, file] = words.keys;
    exclude(slots.level, slots.typed, [level, typed], diagnostics);
    exclude(slots.level, slots.file, [level, file], diagnostics);
    exclude(slots.typed, slots.file, [typed, file], diagnostics);
    if let Some(level) = slots.level {
        return Some(ForceLaw::constant(level.value.si));
    }
    if slots.typed.is_none() && slots.file.is_none() && !diagnostics.has_errors() {
        diagnostics.push(missing(place, &format!("the {}", words.level.0), words.example));
    }
    law_of(slots.typed, slots.file, words, diagnostics)
}

/// Points of a measured cam.
const MOST_MEASURED: usize = 20_000;

/// What was measured of the cam; `None` if nothing was, or after an error.
pub(super) fn measured_of(spec: &Spec, cut: &Cut, roller_m: f64, diagnostics: &mut Diagnostics) -> Option<Arc<Measured>> {
    let section = &spec.errors.measured_profile;
    let file = section.file.as_ref()?;
    let column = |name| Column { name, dimension: Dimension::Length };
    let found = rows(&file.value, &[column("x"), column("y")], MOST_MEASURED, diagnostics)?;
    let mut points = Points { noise_m: si(&section.noise), ..Points::default() };
    let word = section.side.as_ref().map_or("both", |s| s.value);
    for [x, y] in found {
        let at = [x.si, y.si];
        match word {
            "right" => points.sides_m[0].push(at),
            "left" => points.sides_m[1].push(at),
            "mirrored" => {
                points.sides_m[0].push(at);
                points.sides_m[1].push([-x.si, y.si]);
            }
            _ => points.sides_m[usize::from(x.si < 0.0)].push(at),
        }
    }
    match measured(cut, roller_m, &points) {
        Ok(measured) => Some(Arc::new(measured)),
        Err(error) => {
            diagnostics.push(
                Diagnostic::error("E0632", file.span, format!("these points are not those of the cam: {error}"))
                    .label("measured here")
                    .help("points lie on the surface of the cam, in millimetres of the drawing's coordinates or nearly so, on more than a corner of it"),
            );
            None
        }
    }
}

/// A law, typed or from a file; `None` without one or after an error.
#[expect(clippy::ref_option, reason = "a slot as it stands in the description")]
pub(super) fn law_of(
    typed: &Slot<Vec<Located<[Quantity; 2]>>>,
    file: &Slot<DataFile>,
    words: &LawWords,
    diagnostics: &mut Diagnostics,
) -> Option<ForceLaw> {
    let ((travel, travel_dimension), (level, dimension)) = (words.travel, words.level);
    let points: Vec<([f64; 2], Span)> = if let Some(typed) = typed {
        typed.value.iter().map(|p| (p.value.each_ref().map(|q| q.si), p.span)).collect()
    } else {
        let columns = [Column { name: travel, dimension: travel_dimension }, Column { name: level, dimension }];
        let found = rows(&file.as_ref()?.value, &columns, MOST_ROWS, diagnostics)?;
        found.iter().map(|cells| (cells.map(|c| c.si), cells[0].span)).collect()
    };
    let plain: Vec<[f64; 2]> = points.iter().map(|p| p.0).collect();
    if let Some(([first, _], span)) = points.first().filter(|([first, _], _)| *first != 0.0) {
        let unit = Unit::parse(words.unit).unwrap_or_else(|_| Unit::si(travel_dimension));
        let shown = forcewright_base::units::format_si(*first, &unit, 4);
        diagnostics.push(
            Diagnostic::error("E0604", *span, format!("this profile begins at a {travel} of {shown}"))
                .label("the first point")
                .help(format!("{travel} is counted from the start of the path: begin with a {level} at `{}`", words.start)),
        );
        return None;
    }
    let error = match ForceLaw::through(&plain) {
        Ok(law) => return Some(law),
        Err(error) => error,
    };
    let (index, message, help) = match error {
        LawError::Empty => (0, "a profile needs a point".to_owned(), format!("give {travel} and {level}")),
        LawError::NotRising(i) => {
            (i, format!("this {travel} does not lie beyond the one before it"), format!("list the points in the order of their {travel}"))
        }
        LawError::NotPositive(i) => (
            i,
            format!("this {level} is not above zero"),
            format!("the springs can only be stretched on while the {level} does work: give a {level} above zero"),
        ),
    };
    let span = points.get(index).map(|p| p.1).or(typed.as_ref().map(|t| t.span)).unwrap_or_default();
    diagnostics.push(Diagnostic::error("E0604", span, message).label("this point").help(help));
    None
}
