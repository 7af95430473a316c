//! Curves as a table (RFC 4180: comma, quotes where needed, CRLF), in the units in which people are shown them.
//!
//! The header names each column `name / unit`. Two layouts, told apart by the first column:
//!
//! - `branch, displacement / mm, force / N, stress / MPa` when all curves stand over the same abscissae, branch by branch: one row per
//!   abscissa.
//! - `curve, branch, displacement / mm, force / N, angle / deg, …` otherwise: one row per point of one curve, and cells of other
//!   curves' columns are empty.
//!
//! Numbers are the shortest decimals that give the same double again; one that is not finite is an empty cell, and a
//! zero has no sign.

use forcewright_model::{Axis, Branch, Curve, Outcome};

/// All curves of an outcome. Without curves there is only the header's first column.
pub fn curves(outcome: &Outcome) -> String {
    let mut out = String::new();
    if shares_abscissae(&outcome.curves) {
        wide(&outcome.curves, &mut out);
    } else {
        long(&outcome.curves, &mut out);
    }
    out
}

fn same_axis(a: &Axis, b: &Axis) -> bool {
    a.name == b.name && a.display == b.display
}

fn same_abscissae(a: &Branch, b: &Branch) -> bool {
    a.name == b.name && a.x.len() == b.x.len() && b.y.len() == b.x.len() && a.x.iter().zip(&b.x).all(|(p, q)| p.to_bits() == q.to_bits())
}

/// Whether one table with one row per abscissa holds all curves, under headers that differ.
fn shares_abscissae(curves: &[Curve]) -> bool {
    let Some(first) = curves.first() else { return true };
    let mut headers: Vec<String> = curves.iter().map(|c| header(&c.y)).chain([header(&first.x)]).collect();
    headers.sort();
    headers.windows(2).all(|w| w[0] != w[1])
        && curves.iter().all(|c| {
            same_axis(&c.x, &first.x)
                && c.branches.len() == first.branches.len()
                && c.branches.iter().zip(&first.branches).all(|(a, b)| same_abscissae(b, a))
        })
}

fn wide(curves: &[Curve], out: &mut String) {
    let mut heads = vec!["branch".to_owned()];
    heads.extend(curves.first().map(|c| header(&c.x)));
    heads.extend(curves.iter().map(|c| header(&c.y)));
    row(heads, out);
    let Some(first) = curves.first() else { return };
    for (b, branch) in first.branches.iter().enumerate() {
        for (i, x) in branch.x.iter().enumerate() {
            let mut cells = vec![branch.name.clone(), number(first.x.display.from_si(*x))];
            cells.extend(curves.iter().map(|c| {
                let y = c.branches.get(b).and_then(|branch| branch.y.get(i)).copied();
                y.map_or_else(String::new, |y| number(c.y.display.from_si(y)))
            }));
            row(cells, out);
        }
    }
}

fn long(curves: &[Curve], out: &mut String) {
    let mut columns: Vec<String> = Vec::new();
    let mut places = Vec::new();
    for curve in curves {
        let mut column = |mut head: String, other: Option<usize>| {
            // An ordinate named like its abscissa still gets a column of its own.
            while let Some(found) = columns.iter().position(|c| *c == head) {
                if Some(found) != other {
                    return found;
                }
                head.push_str(" (ordinate)");
            }
            columns.push(head);
            columns.len() - 1
        };
        let x = column(header(&curve.x), None);
        let y = column(header(&curve.y), Some(x));
        places.push((x, y));
    }
    row(["curve", "branch"].into_iter().map(str::to_owned).chain(columns.iter().cloned()), out);
    for (curve, (x, y)) in curves.iter().zip(places) {
        for branch in &curve.branches {
            for (a, b) in branch.x.iter().zip(&branch.y) {
                let mut cells = vec![String::new(); columns.len()];
                if let Some(cell) = cells.get_mut(x) {
                    *cell = number(curve.x.display.from_si(*a));
                }
                if let Some(cell) = cells.get_mut(y) {
                    *cell = number(curve.y.display.from_si(*b));
                }
                row([curve.name.to_owned(), branch.name.clone()].into_iter().chain(cells), out);
            }
        }
    }
}

/// `force / N`; only the name for a pure number.
fn header(axis: &Axis) -> String {
    match axis.display.pretty() {
        unit if unit.is_empty() => axis.name.to_owned(),
        unit => format!("{} / {unit}", axis.name),
    }
}

/// The shortest decimal that gives the same double again; nothing for one that is not finite, and no sign for a zero.
pub fn number(value: f64) -> String {
    // Adding zero takes the sign from a negative zero.
    let value = value + 0.0;
    let size = value.abs();
    if !value.is_finite() {
        String::new()
    } else if size > 0.0 && !(1e-5..1e16).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Adds a row of cells, quoted where they need it.
pub fn row(cells: impl IntoIterator<Item = String>, out: &mut String) {
    for (i, cell) in cells.into_iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        if cell.contains([',', '"', '\r', '\n']) {
            out.push('"');
            out.push_str(&cell.replace('"', "\"\""));
            out.push('"');
        } else {
            out.push_str(&cell);
        }
    }
    out.push_str("\r\n");
}
