//! Problems whose fronts are known in closed form, and one that is small enough to compute every design.
#![allow(clippy::unwrap_used, reason = "helpers of tests: what is not there fails the test")]

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicU64, Ordering};

use forcewright_base::maths::{atan2, cos, sin};
use forcewright_study::pareto::{Assessment, Front, Kind, Malformed, Problem, Settings, Stop, Unassessed, hypervolume, search};

type Values<'a> = dyn Fn(&[f64]) -> Result<(Vec<f64>, Vec<f64>), Unassessed> + Sync + 'a;

/// A problem given by its functions.
struct Given<'a> {
    kinds: Vec<Kind>,
    goals: usize,
    values: &'a Values<'a>,
}

impl Problem for Given<'_> {
    fn variables(&self) -> &[Kind] {
        &self.kinds
    }
    fn goals(&self) -> usize {
        self.goals
    }
    fn assess(&self, x: &[f64]) -> Result<Assessment, Unassessed> {
        let (objectives, violations) = (self.values)(x)?;
        Ok(Assessment { objectives, violations })
    }
}

fn reals(n: usize, lower: f64, upper: f64) -> Vec<Kind> {
    vec![Kind::Real { lower, upper }; n]
}

fn found(problem: &dyn Problem, settings: &Settings) -> Front {
    search(problem, settings, &[], &|_| true).unwrap()
}

/// The settings of Deb et al. 2002: 100 designs, 250 generations.
fn of_the_paper() -> Settings {
    Settings { population: 100, generations: 250, ..Settings::default() }
}

/// Mean over the front of the distance to the nearest of some points of the true front: the measure Υ of Deb et al. 2002.
fn mean_distance(front: &Front, truth: &[Vec<f64>]) -> f64 {
    let nearest = |f: &[f64]| {
        let square = |t: &Vec<f64>| f.iter().zip(t).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        truth.iter().map(square).fold(f64::INFINITY, f64::min).sqrt()
    };
    front.front.iter().map(|m| nearest(&m.objectives)).sum::<f64>() / front.front.len() as f64
}

/// Mean over points of the true front of the distance to the nearest design found: whether all of it was found.
fn mean_gap(front: &Front, truth: &[Vec<f64>]) -> f64 {
    let turned = Front { front: Vec::new(), ..front.clone() };
    let as_members = |points: &[Vec<f64>]| {
        points.iter().map(|p| forcewright_study::pareto::Member { x: Vec::new(), objectives: p.clone(), violation: 0.0 }).collect()
    };
    let goals: Vec<Vec<f64>> = front.front.iter().map(|m| m.objectives.clone()).collect();
    mean_distance(&Front { front: as_members(truth), ..turned }, &goals)
}

/// The second goal over the first and g, as a part of g.
type Shape = fn(f64, f64) -> f64;

/// ZDT1, ZDT2 and ZDT3 (E. Zitzler, K. Deb, L. Thiele, "Comparison of multiobjective evolutionary algorithms: empirical results",
/// Evolutionary Computation 8(2) (2000) 173–195), 30 variables; their fronts have g = 1. Deb et al. 2002, table II, has for the
/// real-coded NSGA-II mean distances of 0.0335, 0.0724 and 0.1145 after 25 000 designs; ours must not be worse.
#[test]
fn zdt_fronts_are_found() {
    let g = |x: &[f64]| 1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
    let shapes: [(Shape, f64); 3] = [
        (|f, g| 1.0 - (f / g).sqrt(), 0.0335),
        (|f, g| 1.0 - (f / g) * (f / g), 0.0724),
        (|f, g| 1.0 - (f / g).sqrt() - f / g * sin(10.0 * PI * f), 0.1145),
    ];
    for (number, (shape, of_the_authors)) in shapes.into_iter().enumerate() {
        let values = move |x: &[f64]| Ok((vec![x[0], g(x) * shape(x[0], g(x))], Vec::new()));
        let front = found(&Given { kinds: reals(30, 0.0, 1.0), goals: 2, values: &values }, &of_the_paper());
        let curve: Vec<Vec<f64>> = (0..=1000).map(|i| f64::from(i) / 1000.0).map(|f| vec![f, shape(f, 1.0)]).collect();
        let beaten = |p: &Vec<f64>| curve.iter().any(|q| q[0] <= p[0] && q[1] < p[1]);
        let truth: Vec<Vec<f64>> = curve.iter().filter(|p| !beaten(p)).cloned().collect();
        let (distance, gap) = (mean_distance(&front, &truth), mean_gap(&front, &truth));
        println!("ZDT{}: distance {distance:.2e}, gap {gap:.2e}, {} designs", number + 1, front.front.len());
        assert!(distance < of_the_authors && distance < 5e-3, "ZDT{}: {distance}", number + 1);
        assert!(gap < 1e-2, "ZDT{}: {gap}", number + 1);
        assert_eq!((front.evaluations, front.stop), (25_100, Stop::Generations));
        assert!(front.front.len() == 100 && front.thinned);
    }
}

/// DTLZ2 with three goals (K. Deb, L. Thiele, M. Laumanns, E. Zitzler, "Scalable multi-objective optimization test problems", CEC 2002):
/// the front is the octant of the unit sphere. A front of 100 points cannot dominate more than the octant leaves of the cube, 1.1³ − π/6.
#[test]
fn dtlz2_ends_on_the_sphere() {
    let values = |x: &[f64]| {
        let g: f64 = x[2..].iter().map(|v| (v - 0.5) * (v - 0.5)).sum();
        let (a, b) = (x[0] * PI / 2.0, x[1] * PI / 2.0);
        Ok((vec![(1.0 + g) * cos(a) * cos(b), (1.0 + g) * cos(a) * sin(b), (1.0 + g) * sin(a)], Vec::new()))
    };
    let front = found(&Given { kinds: reals(12, 0.0, 1.0), goals: 3, values: &values }, &of_the_paper());
    let off = front.front.iter().map(|m| m.objectives.iter().map(|f| f * f).sum::<f64>().sqrt() - 1.0);
    let mean = off.sum::<f64>() / front.front.len() as f64;
    let goals: Vec<Vec<f64>> = front.front.iter().map(|m| m.objectives.clone()).collect();
    let (volume, most) = (hypervolume(&goals, &[1.1; 3]), 1.331 - PI / 6.0);
    println!("DTLZ2: mean distance {mean:.2e}, hypervolume {volume:.4} of at most {most:.4}");
    assert!((0.0..0.02).contains(&mean), "{mean}");
    assert!(volume < most && volume > 0.85 * most, "{volume} of {most}");
}

/// The problem of T. T. Binh and U. Korn (1997), as in Deb's "Multi-Objective Optimization Using Evolutionary Algorithms", Wiley 2001:
/// on the front x₁ = x₂ from 0 to 3, then x₂ = 3 and x₁ from 3 to 5.
#[test]
fn bnh_is_found_with_its_limits() {
    let values = |x: &[f64]| {
        let goals = vec![4.0 * (x[0] * x[0] + x[1] * x[1]), (x[0] - 5.0) * (x[0] - 5.0) + (x[1] - 5.0) * (x[1] - 5.0)];
        let one = ((x[0] - 5.0) * (x[0] - 5.0) + x[1] * x[1] - 25.0) / 25.0;
        let other = (7.7 - (x[0] - 8.0) * (x[0] - 8.0) - (x[1] + 3.0) * (x[1] + 3.0)) / 7.7;
        Ok((goals, vec![one, other]))
    };
    let kinds = vec![Kind::Real { lower: 0.0, upper: 5.0 }, Kind::Real { lower: 0.0, upper: 3.0 }];
    let front = found(&Given { kinds, goals: 2, values: &values }, &Settings { population: 100, generations: 100, ..Settings::default() });
    let of = |a: f64, b: f64| vec![4.0 * (a * a + b * b), (a - 5.0) * (a - 5.0) + (b - 5.0) * (b - 5.0)];
    let truth: Vec<Vec<f64>> = (0..=5000).map(|i| f64::from(i) / 1000.0).map(|t| of(t, t.min(3.0))).collect();
    let (distance, gap) = (mean_distance(&front, &truth), mean_gap(&front, &truth));
    println!("BNH: distance {distance:.3}, gap {gap:.3}, of widths 136 and 46");
    assert!(distance < 0.15 && gap < 1.0, "{distance} {gap}");
    assert!(front.front.iter().all(|m| m.feasible() && values(&m.x).unwrap().1.iter().all(|v| *v <= 0.0)));
}

/// The problem of M. Tanaka and others (1995), as in Deb et al. 2002, section VI: the front lies on the first limit, in pieces.
#[test]
fn tnk_ends_on_its_first_limit() {
    let values = |x: &[f64]| {
        let wave = x[0] * x[0] + x[1] * x[1] - 1.0 - 0.1 * cos(16.0 * atan2(x[0], x[1]));
        Ok((x.to_vec(), vec![-wave, (x[0] - 0.5) * (x[0] - 0.5) + (x[1] - 0.5) * (x[1] - 0.5) - 0.5]))
    };
    let front = found(&Given { kinds: reals(2, 0.0, PI), goals: 2, values: &values }, &of_the_paper());
    // Every point of the limit on a fine fan of angles that keeps the second one and is not dominated.
    let rays = (0..=20_000).map(|i| f64::from(i) / 20_000.0 * PI / 2.0).map(|a| {
        let radius = (1.0 + 0.1 * cos(16.0 * a)).sqrt();
        vec![radius * sin(a), radius * cos(a)]
    });
    let mut kept: Vec<Vec<f64>> = rays.filter(|p| values(p).unwrap().1[1] <= 0.0).collect();
    kept.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // From the left to the right the front falls.
    let (mut truth, mut least) = (Vec::new(), f64::INFINITY);
    for point in kept {
        if point[1] < least {
            least = point[1];
            truth.push(point);
        }
    }
    let (distance, gap) = (mean_distance(&front, &truth), mean_gap(&front, &truth));
    let pieces = |left: Vec<f64>| 1 + left.windows(2).filter(|w| w[1] - w[0] > 0.1).count();
    let wanted = pieces(truth.iter().map(|p| p[0]).collect());
    let pieces = pieces(front.front.iter().map(|m| m.x[0]).collect());
    println!("TNK: distance {distance:.2e}, gap {gap:.2e}, {pieces} pieces of {wanted}");
    assert!(distance < 2e-3 && gap < 1e-2, "{distance} {gap}");
    assert!(pieces == wanted && wanted > 1);
}

/// A rod in bending: one of five materials, a number of rods, a diameter of a list and a length in whole centimetres; mass against
/// compliance, with a limit of the price. 5 · 6 · 12 · 11 = 3960 designs, of which some cannot be made.
fn rods(x: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Unassessed> {
    let materials = [(7850.0, 210e9, 1.0), (2700.0, 70e9, 3.0), (1450.0, 3e9, 2.0), (1600.0, 120e9, 40.0), (8900.0, 118e9, 9.0)];
    let at = |v: f64| (0..64_usize).find(|i| (*i as f64 - v).abs() < 0.5).unwrap();
    let (density, modulus, price) = materials[at(x[0])];
    let diameter = [3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0, 40.0][at(x[2])] * 1e-3;
    let (count, length) = (x[1], x[3] / 100.0);
    if at(x[0]) == 2 && diameter > 0.02 {
        return Err(Unassessed::Failed("no such rod is sold".to_owned()));
    }
    let area = PI / 4.0 * diameter * diameter;
    let mass = density * count * area * length;
    let stiffness = 3.0 * modulus * count * area * diameter * diameter / 16.0 / (length * length * length);
    Ok((vec![mass, 1.0 / stiffness], vec![price * mass / 5.0 - 1.0, 0.25 - length]))
}

fn rod_kinds() -> Vec<Kind> {
    vec![Kind::Choice { count: 5 }, Kind::Whole { lower: 1, upper: 6 }, Kind::Choice { count: 12 }, Kind::Whole { lower: 20, upper: 30 }]
}

/// Every design of the problem that none dominates, by the definition.
fn enumerated() -> BTreeSet<Vec<u64>> {
    let mut all = Vec::new();
    for (a, b, c, d) in (0..5).flat_map(|a| (1..7).flat_map(move |b| (0..12).flat_map(move |c| (20..31).map(move |d| (a, b, c, d))))) {
        let x = [a, b, c, d].map(f64::from).to_vec();
        if let Ok((goals, limits)) = rods(&x)
            && limits.iter().all(|v| *v <= 0.0)
        {
            all.push((x, goals));
        }
    }
    let beats = |a: &[f64], b: &[f64]| a[0] <= b[0] && a[1] <= b[1] && (a[0] < b[0] || a[1] < b[1]);
    let best = all.iter().filter(|(_, f)| !all.iter().any(|(_, g)| beats(g, f)));
    best.map(|(x, _)| x.iter().map(|v| v.to_bits()).collect()).collect()
}

#[test]
fn a_problem_of_choices_gives_the_front_of_all_its_designs() {
    let truth = enumerated();
    let problem = Given { kinds: rod_kinds(), goals: 2, values: &rods };
    let settings = Settings { population: 60, generations: 25, capacity: 500, ..Settings::default() };
    for seed in 1..=5 {
        let front = found(&problem, &Settings { seed, ..settings.clone() });
        let own: BTreeSet<Vec<u64>> = front.front.iter().map(|m| m.x.iter().map(|v| v.to_bits()).collect()).collect();
        println!("{} of {} designs of the front, {} of 3960 computed, {} failed", own.len(), truth.len(), front.evaluations, front.failed);
        assert!(front.evaluations < 1600);
        assert_eq!(own, truth, "seed {seed}");
        assert!(!front.thinned);
    }
    // Asked for more than there are, every design is computed once.
    let computed = AtomicU64::new(0);
    let counted = |x: &[f64]| {
        computed.fetch_add(1, Ordering::Relaxed);
        rods(x)
    };
    let front = found(&Given { kinds: rod_kinds(), goals: 2, values: &counted }, &Settings { generations: 2000, ..settings });
    assert!(front.stop == Stop::Exhausted && computed.load(Ordering::Relaxed) == front.evaluations);
    assert!(front.evaluations > 3900 && front.evaluations <= 3960, "{}", front.evaluations);
    assert_eq!(front.reasons, [("no such rod is sold".to_owned(), front.failed)]);
}

#[test]
fn threads_change_nothing() {
    let problem = Given { kinds: rod_kinds(), goals: 2, values: &rods };
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| found(&problem, &Settings { generations: 12, ..Settings::default() }))
    };
    let one = of(1);
    // Gains are not numbers at first, which equal nothing.
    let told = |front: &Front| format!("{front:?}");
    assert!([2, 5].iter().all(|threads| told(&of(*threads)) == told(&one)));
    assert_ne!(told(&found(&problem, &Settings { generations: 12, seed: 2, ..Settings::default() })), told(&one));
}

/// The order of goals is the order of their names, nothing more: the same designs are found where the search does not depend on the order.
#[test]
fn the_order_of_goals_does_not_matter_for_the_front_of_all_designs() {
    let turned = |x: &[f64]| rods(x).map(|(f, v)| (vec![f[1], f[0]], v));
    let settings = Settings { generations: 40, capacity: 500, ..Settings::default() };
    let designs = |values: &Values<'_>| -> BTreeSet<Vec<u64>> {
        let front = found(&Given { kinds: rod_kinds(), goals: 2, values }, &settings);
        front.front.iter().map(|m| m.x.iter().map(|v| v.to_bits()).collect()).collect()
    };
    assert_eq!(designs(&rods), designs(&turned));
}

#[test]
fn searches_end_where_they_are_told_to() {
    let values = |x: &[f64]| Ok((vec![x[0], (1.0 - x[0]) * (1.0 - x[0]) + x[1]], Vec::new()));
    let problem = Given { kinds: reals(2, 0.0, 1.0), goals: 2, values: &values };
    let base = Settings { population: 20, generations: 1000, ..Settings::default() };
    let front = found(&problem, &Settings { evaluations: 333, ..base.clone() });
    assert_eq!((front.evaluations, front.stop), (333, Stop::Evaluations));
    let front = found(&problem, &Settings { patience: 5, least_gain: 1e-3, ..base.clone() });
    assert!(front.stop == Stop::Settled && front.history.len() < 400, "{:?} {}", front.stop, front.history.len());
    // What was found before stays.
    let front = search(&problem, &base, &[], &|p| p.evaluations < 100).unwrap();
    assert!(front.stop == Stop::Interrupted && (100..120).contains(&front.evaluations) && front.front.len() > 3);
    let asked = AtomicU64::new(0);
    let halting = |x: &[f64]| if asked.fetch_add(1, Ordering::Relaxed) < 50 { values(x) } else { Err(Unassessed::Interrupted) };
    let front = found(&Given { kinds: reals(2, 0.0, 1.0), goals: 2, values: &halting }, &base);
    assert_eq!((front.evaluations, front.failed, front.stop), (50, 0, Stop::Interrupted));
}

#[test]
fn where_nothing_keeps_the_limits_the_nearest_is_given() {
    let values = |x: &[f64]| Ok((vec![x[0], -x[0]], vec![x[0] * x[0] + 0.25]));
    let front = found(&Given { kinds: reals(1, -1.0, 1.0), goals: 2, values: &values }, &Settings::default());
    let nearest = front.nearest.unwrap();
    assert!(front.front.is_empty() && front.feasible == 0 && nearest.x[0].abs() < 1e-3 && nearest.violation < 0.2501);
    let nothing = |_: &[f64]| Ok((vec![f64::NAN, 1.0], Vec::new()));
    let front =
        found(&Given { kinds: reals(1, -1.0, 1.0), goals: 2, values: &nothing }, &Settings { generations: 3, ..Settings::default() });
    assert!(front.nearest.is_none() && front.failed == front.evaluations && front.reasons.len() == 1);
}

/// A design that is given is computed, and kept if none is better.
#[test]
fn first_designs_take_part() {
    let values = |x: &[f64]| {
        // One design in 10¹² is much better than all others.
        let rare = (x[0] - 0.123_456_789).abs() < 1e-12;
        Ok((vec![x[0] - f64::from(u8::from(rare)), 1.0 - x[0]], Vec::new()))
    };
    let problem = Given { kinds: reals(1, 0.0, 1.0), goals: 2, values: &values };
    let settings = Settings { generations: 2, ..Settings::default() };
    assert!(found(&problem, &settings).front[0].objectives[0] > -0.5);
    let front = search(&problem, &settings, &[vec![0.123_456_789], vec![7.0]], &|_| true).unwrap();
    assert!((front.front[0].objectives[0] + 0.876_543_211).abs() < 1e-12 && front.front.iter().any(|m| m.x[0] >= 1.0));
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let values = |_: &[f64]| Ok((vec![0.0, 0.0], Vec::new()));
    let refused = |kinds: Vec<Kind>, goals: usize, settings: Settings, starts: &[Vec<f64>]| {
        search(&Given { kinds, goals, values: &values }, &settings, starts, &|_| true).err()
    };
    let (one, usual) = (|| reals(1, 0.0, 1.0), Settings::default);
    assert_eq!(refused(Vec::new(), 2, usual(), &[]), Some(Malformed::Variable(0)));
    for kind in [
        Kind::Real { lower: 1.0, upper: 0.0 },
        Kind::Real { lower: f64::NAN, upper: 0.0 },
        Kind::Real { lower: 0.0, upper: f64::INFINITY },
        Kind::Whole { lower: 2, upper: 1 },
        Kind::Whole { lower: 0, upper: 1 << 53 },
        Kind::Choice { count: 0 },
    ] {
        assert_eq!(refused(vec![Kind::Choice { count: 1 }, kind], 2, usual(), &[]), Some(Malformed::Variable(1)));
    }
    assert_eq!(refused(one(), 0, usual(), &[]), Some(Malformed::Goals(0)));
    assert_eq!(refused(one(), 9, usual(), &[]), Some(Malformed::Goals(9)));
    for (settings, name) in [
        (Settings { population: 2, ..usual() }, "population"),
        (Settings { population: 7, ..usual() }, "population"),
        (Settings { capacity: 3, ..usual() }, "capacity"),
        (Settings { least_gain: f64::NAN, ..usual() }, "least_gain"),
        (Settings { crossover: 1.1, ..usual() }, "crossover"),
        (Settings { crossover_index: -1.0, ..usual() }, "crossover_index"),
        (Settings { mutation_index: f64::INFINITY, ..usual() }, "mutation_index"),
    ] {
        assert_eq!(refused(one(), 2, settings, &[]), Some(Malformed::Setting(name)));
    }
    assert_eq!(refused(one(), 2, usual(), &[vec![0.5], vec![]]), Some(Malformed::Start(1)));
    assert_eq!(refused(one(), 2, usual(), &[vec![f64::NAN]]), Some(Malformed::Start(0)));
}
