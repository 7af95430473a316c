//! What studies ask of a family.

use std::collections::BTreeSet;

use forcewright_base::diagnostics::{Diagnostics, Severity};
use forcewright_study::evaluator::{Evaluation, Evaluator};

use super::{explained, messages, project};
use crate::describe::Describe;
use crate::edit::with_values;
use crate::family::Mechanism;
use crate::numbers::{Number, numbers_of};
use crate::paths::rows_of;
use crate::read;
use crate::studies::{Free, Purpose};

/// Change of a number, relative to itself: small enough that every design stays one.
const CHANGE: f64 = 1e-3;

/// Numbers have paths of their own and can be written back; each can vary or is refused with a reason; what varies is a pure function.
pub(super) fn suite<M: Mechanism>(example: &str) {
    let mut project = project(example, &[]);
    let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    let Some(design) = M::resolve(&mut spec, &mut project.diagnostics) else { panic!("the example was refused") };
    let numbers = numbers_of(&mut spec);
    let paths: BTreeSet<&str> = numbers.iter().map(|n| n.path.as_str()).collect();
    assert!(paths.len() == numbers.len() && !numbers.is_empty(), "a path is that of two numbers");
    let mut able = Vec::new();
    for number in &numbers {
        let free = free(number);
        let mut said = Diagnostics::default();
        match M::evaluator(&spec, &design, std::slice::from_ref(&free), &mut said) {
            Some(evaluator) => {
                assert!(!said.has_errors(), "`{}` can vary and is refused: {:?}", number.path, messages(&said));
                vary(evaluator.as_ref(), &paths);
                able.push(free);
            }
            None => refused::<M>(&format!("`{}` cannot vary", number.path), &said),
        }
    }
    assert!(!able.is_empty(), "no number of the example can vary");
    let mut said = Diagnostics::default();
    let Some(evaluator) = M::evaluator(&spec, &design, &able, &mut said) else {
        panic!("what can vary alone cannot vary together: {:?}", messages(&said))
    };
    vary(evaluator.as_ref(), &paths);
    match M::task(&spec, &design, &able, Purpose::Search, &mut said) {
        Some(task) => vary(task.evaluator.as_ref(), &paths),
        None => refused::<M>("there is no search", &said),
    }
    written_back::<M>(example, &numbers);
}

fn free(number: &Number) -> Free {
    let width = CHANGE * number.si.abs();
    Free { number: number.clone(), lower: number.si - width, upper: number.si + width }
}

#[track_caller]
fn refused<M: Mechanism>(what: &str, said: &Diagnostics) {
    assert!(said.has_errors(), "{what}, and nobody says why");
    for diagnostic in said.in_file_order() {
        explained::<M>(diagnostic.code);
        assert!(diagnostic.help.is_some() || diagnostic.severity == Severity::Warning, "{what}: {diagnostic:?} has no way out");
    }
}

/// Asserts what every evaluator owes to studies, at its own design.
fn vary(evaluator: &dyn Evaluator, paths: &BTreeSet<&str>) {
    let variables = evaluator.variables();
    let x: Vec<f64> = variables.iter().map(|v| v.nominal).collect();
    assert!(variables.iter().all(|v| v.lower <= v.nominal && v.nominal <= v.upper), "a range does not hold its design: {variables:?}");
    for (path, si) in evaluator.numbers(&x) {
        assert!(paths.contains(path.as_str()) && si.is_finite(), "`{path}` is no number of the file");
    }
    let once = |derivatives| {
        let mut out = Evaluation::default();
        match evaluator.evaluate(&x, derivatives, &mut out, &mut evaluator.workspace()) {
            Ok(()) => out,
            Err(failure) => panic!("the example has no values: {}", failure.reason),
        }
    };
    let (plain, full) = (once(false), once(true));
    assert!(plain.jacobian.is_empty() && full.jacobian.len() == full.values.len() * x.len(), "a row per value, a column per variable");
    assert!(full.values.iter().chain(&full.jacobian).all(|v| v.is_finite()), "a value is not finite");
    let bits = |evaluation: &Evaluation| evaluation.values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&plain), bits(&full), "values depend on whether derivatives are wanted");
    some_rows(evaluator, &x, &full);
    let mut next = 0;
    for output in evaluator.outputs() {
        assert!(output.values.start == next && output.values.end >= next && !output.name.is_empty(), "{output:?}");
        next = output.values.end;
    }
    assert_eq!(next, full.values.len(), "values that no output names");
    let mut measured = Vec::new();
    evaluator.measure(&x, &full.values, &mut measured, &mut evaluator.workspace());
    assert_eq!(measured.len(), evaluator.measures().len(), "a value per measure");
    assert!(measured.iter().all(|v| v.is_finite() || v.is_nan()), "a measure is not finite: {measured:?}");
}

/// Derivatives of some values are those of all, and of the others nothing; whether the design was the last in the workspace or not.
fn some_rows(evaluator: &dyn Evaluator, x: &[f64], full: &Evaluation) {
    let rows: Vec<bool> = (0..full.values.len()).map(|i| i % 3 == 0).collect();
    let mut workspace = evaluator.workspace();
    for fresh in [true, false] {
        let mut some = Evaluation { values: full.values.clone(), jacobian: Vec::new() };
        assert!(evaluator.differentiate(x, &rows, &mut some, &mut workspace).is_ok(), "no derivatives, workspace fresh: {fresh}");
        let chunks = some.jacobian.chunks_exact(x.len().max(1)).zip(full.jacobian.chunks_exact(x.len().max(1)));
        for ((own, all), wanted) in chunks.zip(&rows) {
            let same = own.iter().zip(all).all(|(a, b)| a.to_bits() == if *wanted { b.to_bits() } else { 0.0_f64.to_bits() });
            assert!(same, "derivatives of some values differ from those of all, workspace fresh: {fresh}");
        }
    }
}

/// Every number can be written into the file, and is read from it.
fn written_back<M: Mechanism>(example: &str, numbers: &[Number]) {
    for (index, number) in numbers.iter().enumerate() {
        let si = number.si * (1.0 + CHANGE);
        let text = with_values(example, numbers, &[(index, si)], None).unwrap_or_else(|error| panic!("{error}"));
        let mut project = project(&text, &[]);
        let mut spec: M::Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
        // Catalogues fill in what is not typed.
        let _ = M::resolve(&mut spec, &mut project.diagnostics);
        let found = numbers_of(&mut spec as &mut dyn Describe);
        // A value beyond its range is refused, and not read: what was a default is then nowhere.
        let Some(new) = found.iter().find(|n| n.path == number.path).map(|n| n.si) else {
            assert!(!number.range.holds(si), "`{}` is lost", number.path);
            continue;
        };
        let near = (new - si).abs() <= 1e-6 * si.abs();
        assert!(near || !number.range.holds(si), "`{}`: {si} was written, {new} is read\n{text}", number.path);
        // What the catalogue gives may follow from the number: a cable's strength from its diameter.
        let rows = rows_of(&mut spec);
        let derived = |n: &Number| rows.iter().any(|r| r.path == n.path && r.origin.starts_with("catalogue"));
        let same = |n: &Number| {
            n.path == number.path || derived(n) || numbers.iter().any(|old| old.path == n.path && old.si.to_bits() == n.si.to_bits())
        };
        let kept = number.range.holds(si).then(|| found.iter().find(|n| !same(n))).flatten();
        assert!(kept.is_none(), "with `{}` another number changes: {kept:?}", number.path);
    }
}
