//! A measured record: read, filtered, and split by the direction in which it was run.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics};
use forcewright_base::maths::{log10, powi};
use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_study::calibrate::Filter;

use super::Measurement;
use crate::data::{Cell, Decimal, Named, Written, named_rows_with, report_few};
use crate::describe::{Located, Member};

/// Most rows of a record.
const MOST_ROWS: usize = 20_000;
/// Largest value, SI: sums of squares of larger ones could not be told.
const MOST_SI: f64 = 1e100;
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
    /// Rows of the file beyond these that are copies: they repeat the row before them, or all rows from the first on, to the last digit.
    /// Nothing was measured again where a logger wrote faster than it measured or a table was pasted twice; and where a display did not
    /// move, it shows the same error again.
    pub copies: usize,
}

impl Member<Measurement> {
    /// The record of a measurement of these quantities, of a design whose own abscissa grows if `ascending` is set; `curve` is what may be
    /// measured of it, for messages. What is wrong is reported at its place in the file or in the project.
    pub fn record(&self, [x, y]: [Dimension; 2], (ascending, curve): (bool, &str), diagnostics: &mut Diagnostics) -> Option<Record> {
        let own = &self.value;
        let (file, headers) = (own.file.as_ref()?, [own.x.as_ref()?, own.y.as_ref()?]);
        let decimal = if own.decimal.as_ref().is_some_and(|d| d.value == "comma") { Decimal::Comma } else { Decimal::Point };
        let columns = [Named { header: headers[0], key: "x", dimension: x }, Named { header: headers[1], key: "y", dimension: y }];
        let filter = self.filter(None, diagnostics).ok()?;
        let rows = named_rows_with(&file.value, &columns, MOST_ROWS, Some(Written { decimal, curve }), diagnostics)?;
        if !of_a_size(&rows, diagnostics) || (filter.is_some() && self.filter(Some(rows.len()), diagnostics).is_err()) {
            return None;
        }
        let [places, raw] = [0, 1].map(|k| rows.iter().map(|row| row[k].si).collect::<Vec<f64>>());
        let once = period(&rows.iter().map(bits).collect::<Vec<_>>());
        let run = |values: &[f64]| {
            let mut all = filter.as_ref().map_or_else(|| values.to_vec(), |f| f.run(values));
            all.truncate(once);
            all
        };
        let (places, y) = (run(&places), run(&raw));
        let directions = directions(&places, ascending);
        // The last row of the way there and the first of the way back are two.
        let same = |i: usize| i > 0 && bits(&rows[i]) == bits(&rows[i - 1]) && directions[i] == directions[i - 1];
        let kept: Vec<usize> = (0..once).filter(|i| !same(*i)).collect();
        let take = |values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        Some(Record {
            x: take(&places),
            y: take(&y),
            raw: take(&raw),
            directions: kept.iter().map(|i| directions[*i]).collect(),
            units: headers.map(unit_of),
            copies: rows.len() - kept.len(),
        })
    }

    /// The filter asked for, if any, for so many rows, if they are known; an error is reported.
    fn filter(&self, rows: Option<usize>, diagnostics: &mut Diagnostics) -> Result<Option<Filter>, ()> {
        let section = &self.value.filter;
        let Some(present) = &section.present else { return Ok(None) };
        let (Some(cut_off), Some(rate)) = (&section.cut_off, &section.rate) else { return Err(()) };
        let order = section.order.as_ref().map_or(4, |o| o.value);
        let part = cut_off.value.si / rate.value.si;
        let filter = Filter::new(order, part).map_err(|error| {
            let error = Diagnostic::error("E0905", present.span, error.to_string()).label("this filter");
            diagnostics.push(error.help("write a cut-off below half of `rate`, the number of rows per second"));
        })?;
        let Some(rows) = rows else { return Ok(Some(filter)) };
        let least = Filter::least(order, rows);
        if part < least {
            let hertz = Unit::parse("Hz").unwrap_or_else(|_| Unit::si(Dimension::Frequency));
            let show = |si: f64| format_si(si, &hertz, 3);
            let (rows, in_words) = (rows as f64, format!("{rows} {}", if rows == 1 { "row" } else { "rows" }));
            let periods = format_number(part * rows, 2);
            let count = if periods == "1" { "period" } else { "periods" };
            let message = format!("the cut-off of {} takes {periods} {count} of the record's {in_words} only", show(cut_off.value.si));
            let help = if least < 0.5 {
                // Rounded up, so that it will do.
                let digit = powi(10.0, 2 - floor_log10(least * rate.value.si));
                format!("write at least `cut_off = \"{}\"`", show((least * rate.value.si * digit).ceil() / digit))
            } else {
                "the record is too short for this filter: leave it out, or lower its order".to_owned()
            };
            diagnostics.push(Diagnostic::error("E0905", cut_off.span, message).label("slower than the record is long").help(help));
            return Err(());
        }
        Ok(Some(filter))
    }
}

/// Whether squares of all values can be summed; an error for those that are too large.
fn of_a_size(rows: &[[Cell; 2]], diagnostics: &mut Diagnostics) -> bool {
    let large: Vec<_> = rows.iter().flatten().filter(|cell| cell.si.abs() > MOST_SI).collect();
    let error = |cell: &&Cell| {
        let error = Diagnostic::error("E0204", cell.span, "this value is too large for its square").label("out of range");
        error.help("correct it, or leave the row out where nothing was measured")
    };
    report_few(large.iter().map(error).collect(), diagnostics);
    large.is_empty()
}

/// What stands in a row, to the last digit.
fn bits(row: &[Cell; 2]) -> [u64; 2] {
    row.map(|cell| cell.si.to_bits())
}

/// Rows after which all come again from the first on, at least once as a whole; all of them where they do not. By the longest beginning that
/// is an end too: D. E. Knuth, J. H. Morris & V. R. Pratt, "Fast pattern matching in strings", SIAM J. Computing 6(2), 323–350, 1977.
fn period(rows: &[[u64; 2]]) -> usize {
    let mut ends = vec![0_usize; rows.len()];
    for i in 1..rows.len() {
        let mut k = ends[i - 1];
        while k > 0 && rows[i] != rows[k] {
            k = ends[k - 1];
        }
        ends[i] = k + usize::from(rows[i] == rows[k]);
    }
    let length = rows.len() - ends.last().copied().unwrap_or(0);
    if 2 * length <= rows.len() { length } else { rows.len() }
}

/// The power of ten of a positive number's first digit.
#[allow(clippy::cast_possible_truncation, reason = "within the exponents of a number")]
fn floor_log10(value: f64) -> i32 {
    log10(value).floor().clamp(-300.0, 300.0) as i32
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

    /// A table pasted twice, and one that was cut short, come again; a record that comes back once does not.
    #[test]
    fn tables_that_come_again() {
        let of = |text: &str| period(&text.bytes().map(|b| [u64::from(b), 0]).collect::<Vec<_>>());
        for (text, rows) in
            [("", 0), ("a", 1), ("aa", 1), ("abcabc", 3), ("abcabca", 3), ("abcab", 5), ("abcdcba", 7), ("aabbaabb", 4), ("abcabd", 6)]
        {
            assert_eq!(of(text), rows, "{text}");
        }
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
