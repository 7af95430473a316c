//! A measured record: read, filtered, and split by the direction in which it was run.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::units::{Dimension, Unit};
use forcewright_study::calibrate::Filter;

use super::Measurement;
use crate::data::{Decimal, Named, named_rows_with};
use crate::describe::{Located, Member};

/// Most rows of a record.
const MOST_ROWS: usize = 20_000;
/// A record turns round where it goes back by more than this part of its width.
const TURN: f64 = 0.02;

/// Which way a record was run at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The abscissa grows in the direction of the design's own.
    Loading,
    /// It becomes smaller.
    Unloading,
}

/// A measured record, SI, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Abscissae, filtered where a filter was asked for.
    pub x: Vec<f64>,
    /// Ordinates, filtered.
    pub y: Vec<f64>,
    /// Ordinates as they were measured.
    pub raw: Vec<f64>,
    /// Which way it was run.
    pub directions: Vec<Direction>,
    /// The units of the header, in which people are shown it.
    pub units: [Unit; 2],
}

impl Member<Measurement> {
    /// The record of a measurement of these quantities, of a design whose own abscissa grows if `ascending` is set. What is wrong is
    /// reported at its place in the file or in the project.
    pub fn record(&self, [x, y]: [Dimension; 2], ascending: bool, diagnostics: &mut Diagnostics) -> Option<Record> {
        let own = &self.value;
        let (file, headers) = (own.file.as_ref()?, [own.x.as_ref()?, own.y.as_ref()?]);
        let decimal = if own.decimal.as_ref().is_some_and(|d| d.value == "comma") { Decimal::Comma } else { Decimal::Point };
        let columns = [Named { header: headers[0], key: "x", dimension: x }, Named { header: headers[1], key: "y", dimension: y }];
        let filter = self.filter(diagnostics).ok()?;
        let rows = named_rows_with(&file.value, &columns, MOST_ROWS, decimal, diagnostics)?;
        let [places, raw] = [0, 1].map(|k| rows.iter().map(|row| row[k].si).collect::<Vec<f64>>());
        let run = |values: &[f64]| filter.as_ref().map_or_else(|| values.to_vec(), |f| f.run(values));
        let (places, y) = (run(&places), run(&raw));
        let directions = directions(&places, ascending);
        Some(Record { x: places, y, raw, directions, units: headers.map(unit_of) })
    }

    /// The filter asked for, if any; an error is reported.
    fn filter(&self, diagnostics: &mut Diagnostics) -> Result<Option<Filter>, ()> {
        let section = &self.value.filter;
        let Some(present) = &section.present else { return Ok(None) };
        let (Some(cut_off), Some(rate)) = (&section.cut_off, &section.rate) else { return Err(()) };
        let order = section.order.as_ref().map_or(4, |o| o.value);
        Filter::new(order, cut_off.value.si / rate.value.si).map(Some).map_err(|error| {
            let error = Diagnostic::error("E0905", present.span, error.to_string()).label("this filter");
            diagnostics.push(error.help("write a cut-off below half of `rate`, the number of rows per second"));
        })
    }
}

/// The unit of a header that was understood.
fn unit_of(header: &Located<String>) -> Unit {
    let text = header.value.split_once('/').map_or("", |(_, unit)| unit);
    Unit::parse(text).unwrap_or_else(|_| Unit::si(Dimension::Ratio))
}

/// Which way each point was run: a record turns where it has gone back from its extreme by more than a part of its width, and has turned
/// at that extreme. So errors of the abscissa make no turns.
fn directions(x: &[f64], ascending: bool) -> Vec<Direction> {
    let [low, high] = x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
    let back = TURN * (high - low);
    let named = |up: bool| if up == ascending { Direction::Loading } else { Direction::Unloading };
    let mut all = Vec::with_capacity(x.len());
    // The first way is that in which it first goes far enough.
    let first = x.first().copied().unwrap_or(0.0);
    let mut up = x.iter().find(|v| (*v - first).abs() > back).is_none_or(|v| *v > first);
    // Rows that stand at an extreme, from the first to the last of them: the first half has come there, the second leaves.
    let (mut extreme, mut rest) = (first, [0, 0]);
    for (i, v) in x.iter().enumerate() {
        let [beyond, there] = if up { [*v > extreme, *v >= extreme] } else { [*v < extreme, *v <= extreme] };
        if beyond {
            (extreme, rest) = (*v, [i, i]);
        } else if there {
            rest[1] = i;
        } else if (v - extreme).abs() > back {
            // Since its extreme it has gone the other way.
            up = !up;
            all[usize::midpoint(rest[0], rest[1]) + 1..].iter_mut().for_each(|d| *d = named(up));
            (extreme, rest) = (*v, [i, i]);
        }
        all.push(named(up));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(x: &[f64], ascending: bool) -> String {
        directions(x, ascending).iter().map(|d| if *d == Direction::Loading { 'L' } else { 'u' }).collect()
    }

    #[test]
    fn a_record_turns_at_its_extremes_and_not_at_its_errors() {
        let there: Vec<f64> = (0..=50).map(f64::from).collect();
        let loop_of = |wobble: f64| -> Vec<f64> {
            let back = there.iter().rev().skip(1).copied();
            there.iter().copied().chain(back).enumerate().map(|(i, v)| v + if i % 2 == 0 { wobble } else { -wobble }).collect()
        };
        let want = format!("{}{}", "L".repeat(51), "u".repeat(50));
        assert_eq!(words(&loop_of(0.0), true), want);
        assert_eq!(words(&loop_of(0.0), false), want.replace('L', "x").replace('u', "L").replace('x', "u"));
        // A wobble of less than a hundredth of the width turns nothing, up to the extreme itself.
        let wobbly = words(&loop_of(0.2), true);
        assert!(wobbly.starts_with(&"L".repeat(50)) && wobbly.ends_with(&"u".repeat(49)), "{wobbly}");
        // Two loops, the second smaller.
        let two: Vec<f64> = [0, 10, 20, 10, 5, 15, 18, 2].map(f64::from).into();
        assert_eq!(words(&two, true), "LLLuuLLu");
        // The last row of the way there and the first of the way back at one place.
        let met: Vec<f64> = [0, 10, 20, 20, 10, 0, 0, 10].map(f64::from).into();
        assert_eq!(words(&met, true), "LLLuuuLL");
        assert_eq!(words(&[], true), "");
    }
}
