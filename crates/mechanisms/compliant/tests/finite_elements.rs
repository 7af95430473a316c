//! Force curves of beams against those of plane finite elements of the same part, computed by another program from the exported mesh
//! (`reference/lan2010-finite-elements.csv`): the differences that `docs/theory/solid-check.md` states.

mod common;

use common::{NODES, close, solve};

const ELEMENTS: &str = include_str!("../../../../reference/lan2010-finite-elements.csv");

/// Displacements, m, and forces, N, of one column.
fn elements(column: usize) -> Vec<(f64, f64)> {
    let rows = ELEMENTS.lines().filter(|line| !line.starts_with('#')).skip(1);
    let number = |line: &str, k: usize| line.split(',').nth(k).and_then(|word| word.parse::<f64>().ok()).expect("a number");
    rows.map(|line| (1e-3 * number(line, 0), number(line, column))).collect()
}

/// Elements less beams: the largest difference at any station and that at the end, in % of the force at the end.
fn differences(column: usize, joints: &str) -> [f64; 2] {
    let beams = solve(NODES, &[&format!("model.joints={joints}")]);
    let curve = elements(column);
    assert!(curve.len() >= 15 && curve.last().is_some_and(|last| (last.0 - 13.6e-3).abs() < 1e-9));
    let end = curve[curve.len() - 1].1;
    let all: Vec<f64> = curve.iter().map(|(x, force)| 100.0 * (force - beams.force(*x)) / end).collect();
    let largest = all.iter().copied().fold(0.0, |most: f64, each| if each.abs() > most.abs() { each } else { most });
    [largest, all[all.len() - 1]]
}

#[test]
fn beams_differ_from_elements_as_documented() {
    let (fillets, sharp) = (1, 2);
    for (column, joints, want) in [
        (fillets, "point", [4.43, 3.32]),
        (fillets, "overlap", [-1.02, -0.31]),
        (sharp, "point", [1.84, 1.31]),
        (sharp, "overlap", [-3.70, -2.40]),
    ] {
        let found = differences(column, joints);
        for (found, want) in found.into_iter().zip(want) {
            close(found, want, 0.02, &format!("column {column}, joints in {joints}, %"));
        }
    }
}
