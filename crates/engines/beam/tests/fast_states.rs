//! States of the fast curve, their outputs and derivatives, against the general path, differences, symmetries and scaling laws.

mod common;

use common::{
    POM, SplitMix, add, cantilever, close, more_parameters, near, parameters, random_network, scale, table3_by_nodes, table3_by_shapes,
};
use forcewright_beam::{
    Axis, CurveSolver, CurveStates, Derivatives, Drive, Face, GradientError, Network, NetworkError, Node, Output, Parameter, Path, Point,
    Settings, Shape, Support, Theory, trace,
};

const THEORIES: [Theory; 2] = [Theory::Inextensible, Theory::Reissner];

/// Outputs of one kind, which are compared relative to the largest of them.
fn kinds() -> Vec<(&'static str, Vec<Output>)> {
    let beams = 0..4;
    let faces = [Face::Left, Face::Right];
    let at = |beam: usize| [0.0, 0.31, 0.77, 1.0].map(|u| (beam, u));
    let stress = beams.clone().flat_map(at).flat_map(|(beam, u)| faces.map(|face| Output::Stress { beam, u, face }));
    let place = beams.clone().flat_map(at).flat_map(|(beam, u)| [Axis::X, Axis::Y].map(|axis| Output::Position { beam, u, axis }));
    let peaks = beams.clone().map(|beam| Output::PeakStress { beam: Some(beam) }).chain([Output::PeakStress { beam: None }]);
    let face_peaks = beams.clone().flat_map(|beam| faces.map(|face| Output::FacePeakStress { beam, face }));
    let gaps = [((0, 0.6), (2, 0.4)), ((1, 0.2), (3, 0.9)), ((0, 0.1), (0, 0.8))];
    let motions = (0..5).flat_map(|node| [Axis::X, Axis::Y].map(|axis| Output::NodeDisplacement { node, axis }));
    vec![
        ("force", vec![Output::Force]),
        ("stiffness", vec![Output::Stiffness]),
        ("displacement", vec![Output::Displacement]),
        ("stress", stress.collect()),
        ("peak", peaks.collect()),
        ("face peak", face_peaks.collect()),
        ("position", place.collect()),
        ("gap", gaps.map(|(first, second)| Output::Gap { first, second, reflection: None }).to_vec()),
        ("node", motions.collect()),
        ("rotation", (0..5).map(|node| Output::NodeRotation { node }).collect()),
    ]
}

/// Largest values, derivatives by the displacement and by the parameters, the last scaled, of the difference of two results.
fn sizes(ours: &Derivatives, less: Option<&Derivatives>, parameters: &[Parameter]) -> [f64; 3] {
    let largest = |a: &[f64], b: Option<&[f64]>, scale: &dyn Fn(usize) -> f64| {
        assert!(b.is_none_or(|b| a.len() == b.len()));
        let differences = a.iter().enumerate().map(|(i, a)| ((a - b.map_or(0.0, |b| b[i])) * scale(i)).abs());
        differences.fold(0.0_f64, |m, d| if d > m || d.is_nan() { d } else { m })
    };
    [
        largest(&ours.value, less.map(|l| &l.value[..]), &|_| 1.0),
        largest(&ours.by_control, less.map(|l| &l.by_control[..]), &|_| 1.0),
        largest(&ours.by_parameter, less.map(|l| &l.by_parameter[..]), &|i| scale(parameters[i % parameters.len()])),
    ]
}

/// Outputs at a point of the general path, whose gradients and values have tests of their own.
fn general(path: &Path, point: &Point, outputs: &[Output], parameters: &[Parameter]) -> Derivatives {
    let (mut gradients, mut into) = (path.gradients().expect("a sound network"), Derivatives::default());
    gradients.derivatives(point, outputs, parameters, &mut into).expect("a sound network");
    for (row, exact) in into.by_parameter.chunks_exact(parameters.len()).zip(gradients.at(point, outputs).expect("a sound network")) {
        assert!(row.iter().zip(parameters).all(|(a, p)| a.to_bits() == exact.by(*p).unwrap_or(0.0).to_bits()));
    }
    into
}

/// Whether the largest stress that an output names is in the same place for both: where two places are stressed alike there is none.
fn is_where(output: Output, states: &CurveStates, state: usize, point: &Point) -> bool {
    let (beam, face) = match output {
        Output::PeakStress { beam } => (beam, None),
        Output::FacePeakStress { beam, face } => (Some(beam), Some(face)),
        _ => return true,
    };
    let of = |beam: usize| face.map_or_else(|| point.beams[beam].peak_stress(), |f| point.beams[beam].peak_stress_of_face(f));
    let largest = point.peak_stress().expect("a sound network").0;
    let rivals = (0..point.beams.len()).filter(|b| of(*b).stress_pa > 0.999 * of(largest).stress_pa).count();
    let (ours, exact) = (states.peak_stress(state, beam.unwrap_or(largest), face).expect("a sound network"), of(beam.unwrap_or(largest)));
    (beam.is_some() || rivals == 1) && (ours.u - exact.u).abs() < 0.01 && ours.face == exact.face && ours.tension == exact.tension
}

/// Largest errors of each kind of outputs relative to the largest at any of the states, and how many outputs were compared of how many.
fn compare(states: &mut CurveStates, exact: &[(Point, Vec<Derivatives>)], parameters: &[Parameter]) -> (Vec<[f64; 3]>, [usize; 2]) {
    let (mut into, mut counts, mut worst) = (Derivatives::default(), [0, 0], Vec::new());
    for (kind, (_, outputs)) in kinds().iter().enumerate() {
        let (mut errors, mut largest) = ([0.0_f64; 3], [f64::MIN_POSITIVE; 3]);
        for (i, (point, exact)) in exact.iter().enumerate() {
            states.derivatives(i, outputs, &mut into).expect("a sound network");
            let mut exact = exact[kind].clone();
            for (a, b) in largest.iter_mut().zip(sizes(&exact, None, parameters)) {
                *a = a.max(b);
            }
            for (row, output) in outputs.iter().enumerate() {
                counts[1] += 1;
                if is_where(*output, states, i, point) {
                    counts[0] += 1;
                    continue;
                }
                let columns = row * parameters.len()..(row + 1) * parameters.len();
                exact.by_control[row] = into.by_control[row];
                exact.by_parameter[columns.clone()].copy_from_slice(&into.by_parameter[columns]);
            }
            for (a, b) in errors.iter_mut().zip(sizes(&into, Some(&exact), parameters)) {
                *a = if b > *a || b.is_nan() { b } else { *a };
            }
        }
        worst.push([0, 1, 2].map(|i| errors[i] / largest[i]));
    }
    (worst, counts)
}

fn exactly(
    network: &Network,
    stations: &[f64],
    theory: Theory,
    states_m: &[f64],
    parameters: &[Parameter],
) -> Option<Vec<(Point, Vec<Derivatives>)>> {
    let path =
        trace(network, stations, &Settings { theory, accuracy: 1e-10, ..Settings::default() }, &mut |_| true).expect("a sound network");
    let of = |at: &f64| {
        let point = path.at(*at).expect("a sound network");
        let each = kinds().iter().map(|(_, outputs)| general(&path, &point, outputs, parameters)).collect();
        (point, each)
    };
    path.status.is_complete().then(|| states_m.iter().map(of).collect())
}

/// Derivatives of the force and of the shape may be ten times less accurate, as the solver says of the stress.
fn allowance(kind: &str) -> f64 {
    if matches!(kind, "stiffness" | "stress" | "peak" | "face peak") { 10.0 } else { 1.0 }
}

#[test]
fn states_of_table3() {
    let stations = stations(34, 13.6e-3);
    // In any order, at a station and between them.
    let at_m = [8e-3, 2.1e-3, 12.9e-3, 5.1e-3];
    let all = more_parameters();
    let mut solver = CurveSolver::new();
    for (network, theory) in [(table3_by_shapes(POM), Theory::Inextensible), (table3_by_nodes(POM), Theory::Reissner)] {
        let exact = exactly(&network, &stations, theory, &at_m, &all).unwrap();
        for accuracy in [1e-3, 1e-4, 1e-5, 1e-8] {
            let settings = Settings { theory, accuracy, ..Settings::default() };
            let mut states = solver.solve_with_states(&network, &stations, &settings, &all, &at_m).unwrap();
            assert!(!states.response().general && states.count() == at_m.len());
            let (worst, [compared, of]) = compare(&mut states, &exact, &all);
            assert!(compared + 4 >= of, "{compared} of {of}");
            for ((name, _), [value, by_control, by_parameter]) in kinds().iter().zip(worst) {
                println!("{theory:?} {accuracy:e} {name}: {value:.1e} {by_control:.1e} {by_parameter:.1e}");
                assert!(value <= allowance(name) * accuracy, "{theory:?} {accuracy:e} {name}: {value:e}");
                assert!(by_control.max(by_parameter) <= 10.0 * accuracy, "{theory:?} {accuracy:e} {name}: {by_control:e} {by_parameter:e}");
            }
        }
    }
}

#[test]
fn states_of_random_designs() {
    let stations = stations(34, 17e-3);
    let at_m = [3e-3, 9.1e-3, 17e-3];
    let all = more_parameters();
    let mut random = SplitMix(31);
    let mut solver = CurveSolver::new();
    let accuracies = [1e-4, 1e-5, 1e-8];
    let mut ratios = vec![vec![[const { Vec::new() }; 3]; kinds().len()]; accuracies.len()];
    for index in 0..32 {
        let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes span their chords");
        let theory = THEORIES[index % 2];
        let Some(exact) = exactly(&network, &stations, theory, &at_m, &all) else { continue };
        for (accuracy, ratios) in accuracies.iter().zip(&mut ratios) {
            let settings = Settings { theory, accuracy: *accuracy, ..Settings::default() };
            let mut states = solver.solve_with_states(&network, &stations, &settings, &all, &at_m).unwrap();
            let (worst, [compared, of]) = compare(&mut states, &exact, &all);
            assert!(compared + 12 >= of, "{index}: {compared} of {of}");
            for (ratios, worst) in ratios.iter_mut().zip(&worst) {
                for (all, own) in ratios.iter_mut().zip(worst) {
                    all.push(own / accuracy);
                }
            }
        }
    }
    for (accuracy, ratios) in accuracies.iter().zip(&mut ratios) {
        for ((name, _), ratios) in kinds().iter().zip(ratios) {
            let sorted = ratios.each_mut().map(|all| {
                all.sort_by(f64::total_cmp);
                assert!(all.len() >= 30);
                [all[all.len() / 2], all[all.len() * 9 / 10], all[all.len() - 1]]
            });
            println!("{accuracy:e} {name:10} over the accuracy: median, 90 %, largest {sorted:.2?}");
            let [value, by_control, by_parameter] = sorted;
            assert!(value[2] <= allowance(name), "{accuracy:e} {name}: {value:?}");
            for by in [by_control, by_parameter] {
                // At 1e-8 rounding and the last modes of the stress are felt.
                let most = if *accuracy < 1e-6 { [10.0, 50.0] } else { [5.0, 10.0] };
                assert!(by[1] <= most[0] && by[2] <= most[1], "{accuracy:e} {name}: {by:?}");
            }
        }
    }
}

/// A network with a node, the bend of a beam or a property changed; beams stay closed.
fn changed(network: &Network, parameter: Parameter, amount: f64) -> Network {
    let mut new = network.clone();
    let mut bends: Vec<Vec<f64>> = network.beams.iter().map(|b| b.shape.angle_rad()[1..].to_vec()).collect();
    match parameter {
        Parameter::NodeX(node) => new.nodes[node].position_m[0] += amount,
        Parameter::NodeY(node) => new.nodes[node].position_m[1] += amount,
        Parameter::Bend { beam, k } => bends[beam][k - 1] += amount,
        Parameter::Thickness(beam) => new.beams[beam].section.thickness_m += amount,
        Parameter::Depth(beam) => new.beams[beam].section.depth_m += amount,
        Parameter::Young(beam) => new.beams[beam].section.young_pa += amount,
        Parameter::Poisson(beam) => new.beams[beam].section.poisson = new.beams[beam].section.poisson.map(|nu| nu + amount),
        Parameter::AllThickness => new.beams.iter_mut().for_each(|b| b.section.thickness_m += amount),
        _ => unreachable!("not asked for"),
    }
    for (beam, bend) in new.beams.iter_mut().zip(&bends) {
        let chord = add(new.nodes[beam.end].position_m, new.nodes[beam.start].position_m, -1.0);
        beam.shape = Shape::from_chord(chord, bend).expect("a sound network");
    }
    new
}

/// Every output against differences of its values, independent of the formulas of both paths.
#[test]
fn derivatives_are_slopes_of_values() {
    let network = table3_by_nodes(POM);
    let stations = stations(10, 13.6e-3);
    let all = [
        Parameter::NodeX(2),
        Parameter::NodeY(0),
        Parameter::NodeY(4),
        Parameter::Bend { beam: 1, k: 2 },
        Parameter::Thickness(3),
        Parameter::Depth(2),
        Parameter::Young(0),
        Parameter::Poisson(1),
        Parameter::AllThickness,
    ];
    let outputs: Vec<Output> = kinds().into_iter().flat_map(|(_, outputs)| outputs).collect();
    let at_m = 9.3e-3;
    let (mut solver, mut into, mut other) = (CurveSolver::new(), Derivatives::default(), Derivatives::default());
    for theory in THEORIES {
        let settings = Settings { theory, accuracy: 1e-9, ..Settings::default() };
        solver.solve_with_states(&network, &stations, &settings, &all, &[at_m]).unwrap().derivatives(0, &outputs, &mut into).unwrap();
        let mut values = |network: &Network, at_m: f64| {
            let mut states = solver.solve_with_states(network, &stations, &settings, &[], &[at_m]).unwrap();
            assert!(!states.response().general);
            states.derivatives(0, &outputs, &mut other).unwrap();
            other.value.clone()
        };
        for (column, parameter) in all.iter().map(Some).chain([None]).enumerate() {
            let step = parameter.map_or(2e-5, |p| 2e-3 * scale(*p));
            let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|n| match parameter {
                Some(p) => values(&changed(&network, *p, n * step), at_m),
                None => values(&network, at_m + n * step),
            });
            let slope = |i: usize| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * step);
            let ours = |i: usize| if parameter.is_some() { into.by_parameter[i * all.len() + column] } else { into.by_control[i] };
            let mut first = 0;
            for (name, outputs) in kinds() {
                let largest = (first..first + outputs.len()).fold(0.0_f64, |m, i| m.max(slope(i).abs()));
                for (i, output) in (first..).zip(&outputs) {
                    let size = into.value[i].abs().max(largest * step);
                    let tolerance = 2e-6 * largest + 1e-9 * size / step;
                    assert!(
                        (ours(i) - slope(i)).abs() <= tolerance,
                        "{theory:?} {parameter:?} {name} {output:?}: {:e} {:e}",
                        ours(i),
                        slope(i)
                    );
                }
                first += outputs.len();
            }
        }
    }
}

/// All lengths in proportion at the same material: forces grow by the square, stiffness and places in proportion, stress not at all.
/// All depths or moduli: forces in proportion. By Euler's theorem these are sums of
/// derivatives, at any resolution; the tangents are as accurate as asked for.
#[test]
fn scaling_laws() {
    let network = table3_by_nodes(POM);
    let mut all: Vec<Parameter> = (0..5).flat_map(|n| [Parameter::NodeX(n), Parameter::NodeY(n)]).collect();
    all.extend([Parameter::AllThickness, Parameter::AllDepth, Parameter::AllYoung]);
    let at_m = 7e-3;
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    for theory in THEORIES {
        for accuracy in [1e-3, 1e-5, 1e-8] {
            let settings = Settings { theory, accuracy, ..Settings::default() };
            let mut states = solver.solve_with_states(&network, &stations(34, 13.6e-3), &settings, &all, &[at_m]).unwrap();
            for (name, outputs) in kinds() {
                states.derivatives(0, &outputs, &mut into).unwrap();
                // Degree in lengths, depth and modulus; the depth is a length too.
                let [lengths, depth, modulus] = match name {
                    "force" => [2.0, 1.0, 1.0],
                    "stiffness" => [1.0, 1.0, 1.0],
                    "stress" | "peak" | "face peak" => [0.0, 0.0, 1.0],
                    "rotation" => [0.0; 3],
                    "displacement" | "position" | "gap" | "node" => [1.0, 0.0, 0.0],
                    _ => unreachable!("all kinds are above"),
                };
                let largest = into.value.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                for (i, output) in outputs.iter().enumerate() {
                    let row = &into.by_parameter[i * all.len()..(i + 1) * all.len()];
                    let along = |(by, node): (&[f64], &Node)| by[0] * node.position_m[0] + by[1] * node.position_m[1];
                    let nodes: f64 = row.chunks_exact(2).zip(&network.nodes).map(along).sum();
                    let [thickness, by_depth, young] = [row[10] * POM.thickness_m, row[11] * POM.depth_m, row[12] * POM.young_pa];
                    let by_size = nodes + thickness + by_depth + into.by_control[i] * at_m;
                    for (got, degree) in [(by_size, lengths), (by_depth, depth), (young, modulus)] {
                        let error = (got - degree * into.value[i]).abs() / largest;
                        assert!(error < (3.0 * accuracy).min(1e-4), "{theory:?} {accuracy:e} {output:?}: {got:e} {degree} {error:e}");
                    }
                }
            }
        }
    }
}

/// A mirrored mechanism: faces and signs are exchanged, numbers stay. Moved as a whole, places move along and nothing else changes.
#[test]
fn mirrored_and_moved() {
    let network = table3_by_nodes(POM);
    let mut mirrored = network.clone();
    for node in &mut mirrored.nodes {
        node.position_m[0] *= -1.0;
    }
    for beam in &mut mirrored.beams {
        let chord = add(mirrored.nodes[beam.end].position_m, mirrored.nodes[beam.start].position_m, -1.0);
        let bends: Vec<f64> = beam.shape.angle_rad()[1..].iter().map(|c| -c).collect();
        beam.shape = Shape::from_chord(chord, &bends).unwrap();
    }
    let all = more_parameters();
    let odd = |p: Parameter| if matches!(p, Parameter::NodeX(_) | Parameter::Bend { .. }) { -1.0 } else { 1.0 };
    let across = |output: Output| match output {
        Output::Stress { beam, u, face } => (Output::Stress { beam, u, face: other(face) }, 1.0),
        Output::FacePeakStress { beam, face } => (Output::FacePeakStress { beam, face: other(face) }, 1.0),
        Output::Position { axis: Axis::X, .. } | Output::NodeDisplacement { axis: Axis::X, .. } | Output::NodeRotation { .. } => {
            (output, -1.0)
        }
        _ => (output, 1.0),
    };
    let (mut solver, mut second) = (CurveSolver::new(), CurveSolver::new());
    let settings = Settings { theory: Theory::Reissner, accuracy: 1e-6, ..Settings::default() };
    let stations = stations(20, 13.6e-3);
    let mut states = solver.solve_with_states(&network, &stations, &settings, &all, &[6e-3]).unwrap();
    let mut image = second.solve_with_states(&mirrored, &stations, &settings, &all, &[6e-3]).unwrap();
    let (mut ours, mut theirs) = (Derivatives::default(), Derivatives::default());
    for (name, outputs) in kinds() {
        states.derivatives(0, &outputs, &mut ours).unwrap();
        let (exchanged, signs): (Vec<Output>, Vec<f64>) = outputs.iter().map(|o| across(*o)).unzip();
        image.derivatives(0, &exchanged, &mut theirs).unwrap();
        for (row, sign) in signs.iter().enumerate() {
            theirs.value[row] *= sign;
            theirs.by_control[row] *= sign;
            for (value, parameter) in theirs.by_parameter[row * all.len()..(row + 1) * all.len()].iter_mut().zip(&all) {
                *value *= sign * odd(*parameter);
            }
        }
        let (errors, largest) = (sizes(&ours, Some(&theirs), &all), sizes(&ours, None, &all));
        assert!(errors.iter().zip(largest).all(|(e, l)| *e <= 1e-9 * l), "{name}: {errors:?} {largest:?}");
    }
    let nodes: Vec<Parameter> = (0..5).map(Parameter::NodeX).collect();
    let mut states = solver.solve_with_states(&network, &stations, &settings, &nodes, &[6e-3]).unwrap();
    for (name, outputs) in kinds() {
        states.derivatives(0, &outputs, &mut ours).unwrap();
        for (output, row) in outputs.iter().zip(ours.by_parameter.chunks_exact(5)) {
            let largest = row.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let expected = if matches!(output, Output::Position { axis: Axis::X, .. }) { 1.0 } else { 0.0 };
            assert!((row.iter().sum::<f64>() - expected).abs() <= 1e-9 * largest.max(1e-3), "{name} {output:?}: {row:?}");
        }
    }
}

fn other(face: Face) -> Face {
    if face == Face::Left { Face::Right } else { Face::Left }
}

/// At rest the places are those of the shapes, whatever the resolution.
#[test]
fn rest_is_the_drawn_shape() {
    let network = table3_by_nodes(POM);
    let all = parameters();
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    let settings = Settings { accuracy: 1e-4, ..Settings::default() };
    let outputs: Vec<Output> = (0..4).flat_map(|beam| [Axis::X, Axis::Y].map(|axis| Output::Position { beam, u: 0.37, axis })).collect();
    let mut states = solver.solve_with_states(&network, &[5e-3, 10e-3], &settings, &all, &[0.0]).unwrap();
    states.derivatives(0, &outputs, &mut into).unwrap();
    let place = |network: &Network, i: usize| {
        let beam = &network.beams[i / 2];
        add(network.nodes[beam.start].position_m, beam.shape.point_m(0.37), 1.0)[i % 2]
    };
    for i in 0..outputs.len() {
        close(into.value[i], place(&network, i), 1e-9, "place");
        for (column, parameter) in all.iter().enumerate() {
            let step = 1e-3 * scale(*parameter);
            let at = |n: f64| place(&changed(&network, *parameter, n * step), i);
            let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
            close(into.by_parameter[i * all.len() + column] * scale(*parameter), slope * scale(*parameter), 1e-8, "slope");
        }
    }
    states.derivatives(0, &[Output::Force, Output::PeakStress { beam: None }], &mut into).unwrap();
    assert!(into.value[0].abs() < 1e-12 && into.value[1].abs() < 1e-3, "{:?}", into.value);
}

/// What the fast path leaves to the general one answers in the same way.
#[test]
fn the_general_path_has_the_same_interface() {
    // A straight inextensible beam cannot be condensed at rest.
    let drive = Drive::Displacement { node: 1, direction: [0.0, 1.0] };
    let network = cantilever(0.1, 0.0, POM, Support::Free, drive);
    let settings = Settings { theory: Theory::Inextensible, accuracy: 1e-8, ..Settings::default() };
    let outputs = [
        Output::Force,
        Output::Stiffness,
        Output::PeakStress { beam: None },
        Output::FacePeakStress { beam: 0, face: Face::Right },
        Output::Position { beam: 0, u: 1.0, axis: Axis::X },
    ];
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    let mut states = solver.solve_with_states(&network, &[0.02], &settings, &[Parameter::Depth(0), Parameter::Depth(7)], &[0.01]).unwrap();
    assert!(states.response().general && states.count() == 1);
    states.derivatives(0, &outputs, &mut into).unwrap();
    // Forces are proportional to depth; there is no beam 7. Both faces of the clamp carry the largest stress.
    for (i, degree) in [1.0, 1.0, 0.0, 0.0, 0.0].into_iter().enumerate() {
        close(into.by_parameter[2 * i] * POM.depth_m, degree * into.value[i], 1e-8 * into.value[i].abs(), "depth");
        assert!(into.by_parameter[2 * i + 1] == 0.0);
    }
    near(into.value[2], into.value[3], 1e-9, "faces");
    let peak = states.peak_stress(0, 0, Some(Face::Right)).unwrap();
    assert!(peak.u < 1e-9 && peak.face == Face::Right);
    near(peak.stress_pa, into.value[3], 1e-12, "peak");
    // The same beam bent by next to nothing is left to the fast path, and the two agree.
    let mut bent = network.clone();
    bent.beams[0].shape = Shape::from_chord([0.1, 0.0], &[1e-3]).unwrap();
    let mut fast = Derivatives::default();
    let mut second = CurveSolver::new();
    let mut states = second.solve_with_states(&bent, &[0.02], &settings, &[Parameter::Depth(0), Parameter::Depth(7)], &[0.01]).unwrap();
    states.derivatives(0, &outputs, &mut fast).unwrap();
    for (a, b) in fast.value.iter().chain(&fast.by_control).zip(into.value.iter().chain(&into.by_control)) {
        near(*a, *b, 1e-2, "nearly straight");
    }
    // An arm that is not there has a derivative all the same.
    let arm = Parameter::Arm { beam: 3, end: 1, axis: Axis::X };
    let table = table3_by_nodes(POM);
    let mut states = second.solve_with_states(&table, &[5e-3], &Settings::default(), &[arm, Parameter::NodeX(4)], &[5e-3]).unwrap();
    assert!(states.response().general);
    states.derivatives(0, &[Output::Force], &mut into).unwrap();
    assert!(into.by_parameter[0].abs() > 1.0);
}

/// Derivatives along a path by its control, for drives that only the general path knows.
#[test]
fn along_paths_of_other_drives() {
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    let settings = Settings { accuracy: 1e-9, ..Settings::default() };
    let outputs = [
        Output::Force,
        Output::Displacement,
        Output::Stiffness,
        Output::Stress { beam: 0, u: 0.2, face: Face::Left },
        Output::Position { beam: 0, u: 1.0, axis: Axis::X },
        Output::NodeRotation { node: 1 },
    ];
    for (drive, at, step) in [
        (Drive::Rotation { node: 1 }, 0.7, 1e-2),
        (Drive::Force { node: 1, direction: [0.1, 1.0] }, 1.5, 2e-2),
        (Drive::Moment { node: 1 }, 0.05, 1e-3),
        (Drive::Displacement { node: 1, direction: [-0.2, 1.0] }, 0.03, 1e-3),
    ] {
        let network = cantilever(0.1, 0.3, POM, Support::Free, drive);
        let mut values = |at: f64| {
            let states = [at];
            let mut states = solver.solve_with_states(&network, &[0.5 * at, 1.2 * at], &settings, &[], &states).unwrap();
            states.derivatives(0, &outputs, &mut into).unwrap();
            into.clone()
        };
        let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|n| values(at + n * step).value);
        let exact = values(at);
        for i in 0..outputs.len() {
            let slope = (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * step);
            let size = exact.value[i].abs() / at;
            close(exact.by_control[i], slope, 1e-5 * slope.abs().max(1e-2 * size), &format!("{:?} {:?}", network.drive, outputs[i]));
        }
    }
}

#[test]
fn what_does_not_exist_is_named() {
    let network = table3_by_nodes(POM);
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    let settings = Settings { accuracy: 1e-8, ..Settings::default() };
    for (states, index) in [(&[5e-3, 11e-3][..], 1), (&[-1e-3], 0), (&[f64::NAN], 0)] {
        let refused = solver.solve_with_states(&network, &[10e-3], &settings, &[], states).unwrap_err();
        assert_eq!(refused, NetworkError::States { index });
    }
    let straight = cantilever(0.1, 0.0, POM, Support::Free, Drive::Displacement { node: 1, direction: [0.0, 1.0] });
    for network in [network, straight] {
        let settings = Settings { theory: Theory::Inextensible, ..settings };
        let mut states = solver.solve_with_states(&network, &[10e-3], &settings, &[], &[5e-3]).unwrap();
        assert_eq!(states.response().general, network.beams.len() == 1);
        let mut ask = |state: usize, output: Output| states.derivatives(state, &[output], &mut into).unwrap_err();
        assert_eq!(ask(1, Output::Force), GradientError::NoState { state: 1 });
        assert_eq!(ask(0, Output::PeakStress { beam: Some(9) }), GradientError::NoBeam { beam: 9 });
        assert_eq!(ask(0, Output::FacePeakStress { beam: 9, face: Face::Left }), GradientError::NoBeam { beam: 9 });
        assert_eq!(ask(0, Output::Position { beam: 0, u: 1.5, axis: Axis::X }), GradientError::NotOnBeam { u: 1.5 });
        assert_eq!(ask(0, Output::Stress { beam: 9, u: 1.5, face: Face::Left }), GradientError::NoBeam { beam: 9 });
        assert_eq!(ask(0, Output::Gap { first: (0, 0.5), second: (9, 0.5), reflection: None }), GradientError::NoBeam { beam: 9 });
        assert_eq!(ask(0, Output::NodeRotation { node: 9 }), GradientError::NoNode { node: 9 });
        assert_eq!(states.peak_stress(0, 9, None).unwrap_err(), GradientError::NoBeam { beam: 9 });
    }
    // The path of a beam pulled beyond its length ends before the second state.
    let network = cantilever(0.1, 0.0, POM, Support::Free, Drive::Displacement { node: 1, direction: [0.0, 1.0] });
    let settings = Settings { theory: Theory::Inextensible, ..settings };
    let mut states = solver.solve_with_states(&network, &[0.05, 0.15], &settings, &[], &[0.04, 0.14]).unwrap();
    assert!(!states.response().status.is_complete());
    states.derivatives(0, &[Output::Force], &mut into).unwrap();
    assert_eq!(states.derivatives(1, &[Output::Force], &mut into).unwrap_err(), GradientError::NoState { state: 1 });
}

/// States change nothing of the curve, do not depend on what was solved before or on each other, and cost one or two iterations each.
#[test]
fn states_stand_alone() {
    let (network, stations, all) = (table3_by_nodes(POM), stations(34, 13.6e-3), parameters());
    let outputs: Vec<Output> = kinds().into_iter().flat_map(|(_, outputs)| outputs).collect();
    let (mut used, mut random) = (CurveSolver::new(), SplitMix(9));
    let (mut first, mut second) = (Derivatives::default(), Derivatives::default());
    for accuracy in [1e-3, 1e-5, 1e-8] {
        let settings = Settings { accuracy, ..Settings::default() };
        for _ in 0..5 {
            let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes span their chords");
            used.solve_with_states(&network, &stations[..20], &settings, &all, &[3e-3, 1e-3, 2e-3, 4e-3, 5e-3]).unwrap();
        }
        let mut fresh = CurveSolver::new();
        let curve = fresh.solve_with_gradient(&network, &stations, &settings, &all).unwrap().clone();
        let mut alone = fresh.solve_with_states(&network, &stations, &settings, &all, &[8e-3]).unwrap();
        let mut among = used.solve_with_states(&network, &stations, &settings, &all, &[12e-3, 8e-3]).unwrap();
        alone.derivatives(0, &outputs, &mut first).unwrap();
        among.derivatives(1, &outputs, &mut second).unwrap();
        assert_eq!(first, second);
        for response in [alone.response(), among.response()] {
            assert_eq!(response.force_gradient, curve.force_gradient);
            assert_eq!(response.force_n, curve.force_n);
            assert_eq!(response.stress_pa, curve.stress_pa);
        }
        let more = among.response().counters.newton_iterations - curve.counters.newton_iterations;
        assert!((2..=4).contains(&more), "{accuracy:e}: {more}");
    }
}

fn stations(count: u32, last_m: f64) -> Vec<f64> {
    (1..=count).map(|i| last_m * f64::from(i) / f64::from(count)).collect()
}

/// `WHAT` is `curve`, `gradient`, `states` or `all`, for counting the instructions of one of them alone.
#[test]
#[ignore = "a clock"]
fn time_of_states() {
    let number = |name: &str| std::env::var(name).ok().and_then(|a| a.parse::<f64>().ok());
    let accuracy = number("ACCURACY").unwrap_or(1e-5);
    let rounds: u32 = std::env::var("ROUNDS").ok().and_then(|r| r.parse().ok()).unwrap_or(300);
    let only = std::env::var("WHAT").ok();
    let (network, stations, all) = (table3_by_shapes(POM), stations(34, 13.6e-3), parameters());
    let (mut solver, mut into) = (CurveSolver::new(), Derivatives::default());
    let mut outputs: Vec<Output> = vec![Output::Force, Output::Stiffness];
    outputs.extend((0..4).map(|beam| Output::PeakStress { beam: Some(beam) }));
    outputs.extend((0..4).flat_map(|beam| [Axis::X, Axis::Y].map(|axis| Output::Position { beam, u: 0.5, axis })));
    for theory in THEORIES.into_iter().filter(|t| number("SOFT").is_none_or(|soft| (soft > 0.0) == (*t == Theory::Reissner))) {
        let settings = Settings { theory, accuracy, ..Settings::default() };
        for what in ["curve", "gradient", "states", "all"].into_iter().filter(|w| only.as_deref().is_none_or(|o| o == *w)) {
            let mut best = f64::INFINITY;
            for _ in 0..rounds {
                let start = std::time::Instant::now();
                match what {
                    "curve" => solver.solve(&network, &stations, &settings).map(|_| ()).unwrap(),
                    "gradient" => solver.solve_with_gradient(&network, &stations, &settings, &all).map(|_| ()).unwrap(),
                    _ => {
                        let mut states = solver.solve_with_states(&network, &stations, &settings, &all, &[4e-3, 8e-3, 13e-3]).unwrap();
                        for i in 0..if what == "all" { 3 } else { 0 } {
                            states.derivatives(i, &outputs, &mut into).unwrap();
                        }
                    }
                }
                best = best.min(start.elapsed().as_secs_f64());
            }
            println!("{theory:?} {accuracy:e}, {what}: {:.1} µs", 1e6 * best);
        }
    }
}
