//! Stiffness of one node against all its motions.

use forcewright_base::dense::Lu;

use crate::assembly::System;

/// Forces per motion (x, y, rotation) of a node with all other unknowns in equilibrium, SI: the Schur complement of the tangent on
/// the motions of the node. `None` where the rest is singular.
pub(crate) fn stiffness(system: &System, node: usize) -> Option<[[f64; 3]; 3]> {
    let (model, m) = (system.model, system.model.unknowns);
    let freedom = &model.nodes[node];
    let own: Vec<usize> = freedom.translations.iter().map(|t| t.0).chain(freedom.rotation).collect();
    let others: Vec<usize> = (0..model.solved).filter(|i| !own.contains(i)).collect();
    let entry = |row: usize, column: usize| system.matrix[row * m + column];
    let n = others.len();
    let block: Vec<f64> = others.iter().flat_map(|&row| others.iter().map(move |&column| entry(row, column))).collect();
    let mut lu = Lu::new();
    lu.factor(n, n, &block).ok()?;
    // A column per own motion: how the others answer.
    let width = own.len();
    let mut answers: Vec<f64> = others.iter().flat_map(|&row| own.iter().map(move |&column| -entry(row, column))).collect();
    lu.solve_columns(&mut answers, width);
    let condensed = |i: usize, j: usize| {
        let sum: f64 = others.iter().zip(answers.chunks_exact(width)).map(|(&column, a)| entry(own[i], column) * a[j]).sum();
        entry(own[i], own[j]) + sum
    };
    // From the directions of the unknowns to x, y and rotation.
    let mut axes: Vec<[f64; 3]> = freedom.translations.iter().map(|(_, d)| [d[0], d[1], 0.0]).collect();
    axes.extend(freedom.rotation.map(|_| [0.0, 0.0, 1.0]));
    let unit = |axis: usize| if axis == 2 { model.length_m } else { 1.0 };
    let mut sum = [[0.0; 3]; 3];
    for (i, a) in axes.iter().enumerate() {
        for (j, b) in axes.iter().enumerate() {
            // Averaged with its mirror image: symmetric to the last bit.
            let value = 0.5 * (condensed(i, j) + condensed(j, i)) * model.force_n / model.length_m;
            for (row, target) in sum.iter_mut().enumerate() {
                for (column, target) in target.iter_mut().enumerate() {
                    *target += value * a[row] * b[column] * unit(row) * unit(column);
                }
            }
        }
    }
    sum.iter().flatten().all(|v| v.is_finite()).then_some(sum)
}
