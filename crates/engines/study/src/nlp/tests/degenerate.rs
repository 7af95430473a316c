//! What goes wrong in the field: dependent constraints, no multipliers, no feasible point, no bound, regions that cannot be evaluated.

use num_dual::{Dual64, DualNum};

use super::super::{Progress, Settings, Stop, minimise};
use super::classic::{hs43, hs71, hs100, rosenbrock};
use super::{Given, close};

const INF: f64 = f64::INFINITY;

fn sum(x: &[Dual64]) -> Dual64 {
    x.iter().fold(Dual64::from(0.0), |s, v| s + *v)
}

#[test]
fn rosenbrock_free_and_bounded() {
    let free = rosenbrock().solve(&[-1.2, 1.0]);
    assert_eq!(free.stop, Stop::Converged);
    close(free.x[0], 1.0, 1e-6);
    // HS1 to HS4 neighbourhood: with x₀ ≤ 1/2 the optimum is (1/2, 1/4), f = 1/4, and df*/db = −1.
    let mut bounded = rosenbrock().within(&[-2.0, -2.0], &[0.5, 2.0]);
    let solution = bounded.solve(&[-1.2, 1.0]);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.objective, 0.25, 1e-10);
    close(solution.bound_multipliers[0], -1.0, 1e-6);
    assert_eq!(solution.x[0].to_bits(), 0.5_f64.to_bits());
    assert_eq!(solution.bound_multipliers[1].to_bits(), 0.0_f64.to_bits());
}

/// HS13: the gradients of the active constraints point against each other at (1, 0), there are no multipliers; f* = 1.
#[test]
fn without_multipliers() {
    let mut problem =
        Given::new(2, 1, |x| ((x[0] - 2.0).powi(2) + x[1].powi(2), vec![(-x[0] + 1.0).powi(3) - x[1]])).within(&[0.0, 0.0], &[INF, INF]);
    let solution = problem.solve(&[-2.0, -2.0]);
    assert!(matches!(solution.stop, Stop::Converged | Stop::Stalled), "{:?}", solution.stop);
    assert!(solution.violation < 1e-8);
    close(solution.objective, 1.0, 1e-2);
}

/// The same limit three times, once in other units: optimum and the sum of rates are those of one.
#[test]
fn duplicated_constraints() {
    let mut once = Given::new(3, 1, |x| (x.iter().map(|v| v * v).sum(), vec![sum(x) - 3.0]));
    let mut thrice = Given::new(3, 3, |x| {
        let c = sum(x) - 3.0;
        (x.iter().map(|v| v * v).sum(), vec![c, c, c * 1e3])
    });
    let mut equal = Given::new(3, 3, |x| {
        let c = sum(x) + x[0] * x[1];
        (x.iter().map(|v| v * v).sum(), vec![c, c, c * 2.0])
    })
    .rows(&[4.0, 4.0, 8.0], &[4.0, 4.0, 8.0]);
    let (a, b) = (once.solve(&[0.0, 0.0, 5.0]), thrice.solve(&[0.0, 0.0, 5.0]));
    assert_eq!((a.stop, b.stop), (Stop::Converged, Stop::Converged));
    close(a.objective, 3.0, 1e-10);
    close(b.objective, 3.0, 1e-10);
    close(a.multipliers[0], 2.0, 1e-7);
    close(b.multipliers[0] + b.multipliers[1] + 1e3 * b.multipliers[2], 2.0, 1e-7);
    let c = equal.solve(&[1.0, 2.0, 0.5]);
    assert_eq!(c.stop, Stop::Converged);
    assert!(c.violation < 1e-8);
}

/// More active constraints than variables: a pyramid with eight sides, apex at 1.
#[test]
fn degenerate_vertex() {
    let mut problem = Given::new(3, 8, |x| {
        let sides = (0..8).map(|k| {
            let angle = std::f64::consts::FRAC_PI_4 * f64::from(k);
            let (s, c) = forcewright_base::maths::sin_cos(angle);
            -x[2] + 1.0 - (x[0] * c + x[1] * s) * 2.0 - x[0].powi(2) * 0.1
        });
        (-x[2], sides.collect())
    });
    let solution = problem.solve(&[0.3, -0.2, -1.0]);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.objective, -1.0, 1e-9);
}

/// x² + y² + 1 ≤ 0 cannot hold; the least violation is 1, at the origin.
#[test]
fn infeasible_gives_least_violation() {
    let mut problem = Given::new(2, 2, |x| (sum(x), vec![x[0].powi(2) + x[1].powi(2) + 1.0, x[0] - x[1]]))
        .rows(&[-INF, -INF], &[0.0, 10.0])
        .within(&[-4.0, -4.0], &[5.0, 3.0]);
    let solution = problem.solve(&[2.0, -1.0]);
    assert_eq!(solution.stop, Stop::Infeasible);
    close(solution.violation, 1.0, 1e-6);
    // Two linear limits that contradict each other by 1, and a wide one.
    let mut linear = Given::new(2, 3, |x| (x[0].powi(2) * 300.0 + x[1] * 70.0, vec![x[0] + x[1], x[0] + x[1], x[1]]))
        .rows(&[2.0, -INF, -5.0], &[INF, 1.0, 5.0]);
    let solution = linear.solve(&[0.0, 0.0]);
    assert_eq!(solution.stop, Stop::Infeasible);
    // The sum is 1 anywhere between the two.
    close((2.0 - solution.constraints[0]) + (solution.constraints[1] - 1.0), 1.0, 1e-9);
    // Rates of the sum: 1 per unit of either limit, in the sense that worsens it.
    close(solution.multipliers[0], 1.0, 1e-9);
    close(solution.multipliers[1], -1.0, 1e-9);
}

/// The centre is the worst start for x² + y² = 1: every direction is as good as another. Least x + y on the circle: −√2.
#[test]
fn leaves_a_maximum_of_the_violation() {
    let mut problem = Given::new(2, 1, |x| (sum(x), vec![x[0].powi(2) + x[1].powi(2)])).rows(&[1.0], &[1.0]).within(&[-2.0; 2], &[2.0; 2]);
    let solution = problem.solve(&[0.0, 0.0]);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.objective, -std::f64::consts::SQRT_2, 1e-9);
}

#[test]
fn unbounded_is_said() {
    let mut line = Given::new(2, 1, |x| (x[0] - x[1], vec![x[1]]));
    assert_eq!(line.solve(&[0.0, 1.0]).stop, Stop::Unbounded);
    let mut cubic = Given::new(1, 0, |x| (x[0].powi(3), vec![]));
    let solution = cubic.solve(&[-1.0]);
    assert_eq!(solution.stop, Stop::Unbounded, "{solution:?}");
}

#[test]
fn start_that_cannot_be_evaluated() {
    let mut problem = hs43();
    problem.functions = Box::new(|_| None);
    let solution = problem.solve(&[0.0; 4]);
    assert_eq!(solution.stop, Stop::StartRejected);
    assert!(solution.objective.is_nan());
}

/// Long first steps end where nothing can be evaluated (x ≤ 0.1); the optimum 0.2 lies shortly before, x − 0.2·ln x.
#[test]
fn rejected_region_on_the_way() {
    let mut problem = Given::new(2, 1, |x| (x[0], vec![x[1]]));
    problem.functions = Box::new(|x| (x[0].re > 0.1).then(|| (x[0] - x[0].ln() * 0.2 + (x[1] - x[0]).powi(2), vec![x[0] * x[1]])));
    problem.row_lower = vec![0.01];
    let solution = problem.solve(&[9.0, 3.0]);
    assert_eq!(solution.stop, Stop::Converged);
    assert!(solution.counters.rejections > 0);
    close(solution.x[0], 0.2, 1e-6);
    // From the other side the limit draws the iterates into the edge of that region; they must slide along it.
    let solution = problem.solve(&[9.0, -3.0]);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.x[0], 0.2, 1e-6);
    // NaN is a rejection like any other.
    let mut root = Given::new(1, 0, |x| (x[0] - x[0].sqrt(), vec![]));
    let solution = root.solve(&[30.0]);
    assert_eq!(solution.stop, Stop::Converged);
    assert!(solution.counters.rejections > 0);
    close(solution.x[0], 0.25, 1e-6);
}

#[test]
fn interruption_keeps_the_best() {
    let mut problem = hs71();
    let mut seen = Vec::new();
    let solution = minimise(&mut problem, &[1.0, 5.0, 5.0, 1.0], &Settings::default(), &mut |p: &Progress<'_>| {
        seen.push((p.best.to_vec(), p.best_objective, p.best_violation));
        p.iteration < 3
    });
    assert_eq!(solution.stop, Stop::Interrupted);
    assert_eq!(seen.len(), 4);
    assert_eq!(solution.x, seen[3].0);
    assert!(seen.windows(2).all(|w| w[1].2 <= w[0].2 || w[1].2 <= 1e-8));
    let limited = problem.solve_with(&[1.0, 5.0, 5.0, 1.0], &Settings { iteration_limit: 3, ..Settings::default() });
    assert_eq!(limited.stop, Stop::IterationLimit);
    assert_eq!(limited.x, solution.x);
}

#[test]
fn malformed_problems_are_named() {
    let inf = f64::INFINITY;
    let stop = |problem: &mut Given, start: &[f64]| problem.solve(start).stop;
    assert_eq!(stop(&mut hs43(), &[0.0; 3]), Stop::Malformed);
    assert_eq!(stop(&mut hs43(), &[0.0, 0.0, f64::NAN, 0.0]), Stop::Malformed);
    assert_eq!(stop(&mut hs43().within(&[1.0; 4], &[0.0; 4]), &[0.0; 4]), Stop::Malformed);
    assert_eq!(stop(&mut hs43().rows(&[0.0; 3], &[inf, f64::NAN, inf]), &[0.0; 4]), Stop::Malformed);
    assert_eq!(stop(&mut hs43().rows(&[0.0; 3], &[inf, inf]), &[0.0; 4]), Stop::Malformed);
}

/// Fixed variables and starts outside of the bounds; the rate of a fixed variable is that of moving it.
#[test]
fn fixed_variables_and_projected_starts() {
    // HS43 with x₃ fixed at its optimal value −1: same optimum, and nothing to gain by moving it.
    let mut problem = hs43().within(&[-INF, -INF, -INF, -1.0], &[0.0, INF, INF, -1.0]);
    let solution = problem.solve(&[3.0, 0.0, 0.0, 7.0]);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.objective, -44.0, 1e-7);
    close(solution.bound_multipliers[3], 0.0, 1e-6);
    let shifted = |at: f64| hs43().within(&[-INF, -INF, -INF, at], &[0.0, INF, INF, at]).solve(&[0.0, 1.0, 1.0, at]);
    let (low, here, high) = (shifted(-0.501), shifted(-0.5), shifted(-0.499));
    close(here.bound_multipliers[3], (high.objective - low.objective) / 0.002, 1e-5);
    // All fixed: nothing to do but to look.
    let mut all = hs43().within(&[0.0; 4], &[0.0; 4]);
    let solution = all.solve(&[5.0; 4]);
    assert_eq!((solution.stop, solution.objective), (Stop::Converged, 0.0));
    let mut outside = hs43().within(&[9.0; 4], &[9.0; 4]);
    assert_eq!(outside.solve(&[5.0; 4]).stop, Stop::Infeasible);
}

/// The multiplier is the rate of the optimum with the bound: compared with differences of optima, for limits and bounds.
#[test]
fn multipliers_are_rates() {
    let at = |limit: f64, floor: f64| {
        hs71().within(&[floor, 1.0, 1.0, 1.0], &[5.0; 4]).rows(&[25.0, limit], &[INF, limit]).solve(&[1.0, 5.0, 5.0, 1.0])
    };
    let h = 1e-3;
    let here = at(40.0, 1.0);
    close(here.multipliers[1], (at(40.0 + h, 1.0).objective - at(40.0 - h, 1.0).objective) / (2.0 * h), 1e-6);
    close(here.bound_multipliers[0], (at(40.0, 1.0 + h).objective - at(40.0, 1.0 - h).objective) / (2.0 * h), 1e-5);
    assert!(here.multipliers[0] > 0.0, "raising a lower limit costs");
    assert!(here.bound_multipliers[0] > 0.0);
    // Stated the other way round the limit is an upper one and its rate negative.
    let upper = |limit: f64| {
        let mut turned = hs71().rows(&[-INF, 40.0], &[limit, 40.0]);
        let functions = std::mem::replace(&mut turned.functions, Box::new(|_| None));
        turned.functions = Box::new(move |x| functions(x).map(|(f, c)| (f, vec![-c[0], c[1]])));
        turned.solve(&[1.0, 5.0, 5.0, 1.0])
    };
    close(upper(-25.0).multipliers[0], -here.multipliers[0], 1e-7);
    close(upper(-25.0).multipliers[0], (upper(-25.0 + h).objective - upper(-25.0 - h).objective) / (2.0 * h), 1e-6);
}

/// Factors of 1e±6 on objective, constraints and bounded variables change neither the path nor the work.
#[test]
fn scale_does_not_matter() {
    let plain = hs71().solve(&[1.0, 5.0, 5.0, 1.0]);
    for (f, c, v) in [(1e6, 1e-6, 1.0), (1e-6, 1e6, 1.0), (1.0, 1.0, 1e6), (1.0, 1.0, 1e-6), (1e6, 1e6, 1e-6)] {
        let mut scaled = hs71();
        let functions = std::mem::replace(&mut scaled.functions, Box::new(|_| None));
        scaled.functions = Box::new(move |x| {
            let y = [x[0], x[1] * (1.0 / v), x[2], x[3] * v];
            functions(&y).map(|(value, rows)| (value * f, vec![rows[0] * c, rows[1]]))
        });
        let mut scaled = scaled.within(&[1.0, v, 1.0, 1.0 / v], &[5.0, 5.0 * v, 5.0, 5.0 / v]).rows(&[25.0 * c, 40.0], &[INF, 40.0]);
        let solution = scaled.solve(&[1.0, 5.0 * v, 5.0, 1.0 / v]);
        assert_eq!(solution.stop, Stop::Converged, "{f} {c} {v}");
        close(solution.objective / f, plain.objective, 1e-8);
        close(solution.multipliers[0] * c / f, plain.multipliers[0], 1e-7);
        assert_eq!(solution.counters.iterations, plain.counters.iterations, "{f} {c} {v}");
    }
    // Free variables follow their start or the scales given.
    let plain = hs100().solve(&[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0]);
    let factor = 1e6;
    let mut scaled = hs100();
    let functions = std::mem::replace(&mut scaled.functions, Box::new(|_| None));
    scaled.functions = Box::new(move |x| functions(&x.iter().map(|v| *v * (1.0 / factor)).collect::<Vec<_>>()));
    let settings = Settings { scales: vec![0.0, 0.0, factor, 0.0, factor, 0.0, 0.0], ..Settings::default() };
    let solution = scaled.solve_with(&[1.0, 2.0, 0.0, 4.0, 0.0, 1.0, 1.0].map(|v| v * factor), &settings);
    assert_eq!(solution.stop, Stop::Converged);
    close(solution.objective, plain.objective, 1e-7);
    assert!(solution.counters.iterations <= plain.counters.iterations + 2);
}
