//! Gradients by implicit differentiation against closed forms, identities, an independent computation and differences.

mod common;

use common::{POM, SplitMix, add, cantilever, close, near, node, random_network, rigid, solve, table3_by_nodes};
use forcewright_beam::{
    Axis, Drive, Face, Gradient, GradientError, Joint, Network, Output, Parameter, Path, Point, Rotation, Section, Settings, Shape,
    Support, Theory, trace,
};

const THEORIES: [Theory; 2] = [Theory::Inextensible, Theory::Reissner];

fn fine(theory: Theory) -> Settings {
    Settings { theory, accuracy: 1e-10, ..Settings::default() }
}

fn gradient(path: &Path, point: &Point, output: Output) -> Gradient {
    path.gradients().expect("a sound network").at(point, &[output]).expect("a sound network").remove(0)
}

fn by(gradient: &Gradient, parameter: Parameter) -> f64 {
    gradient.by(parameter).expect("it exists")
}

fn value(point: &Point, output: Output) -> f64 {
    let of = |axis: Axis| usize::from(axis == Axis::Y);
    match output {
        Output::Force => point.force,
        Output::Displacement => point.displacement,
        Output::Stiffness => point.stiffness,
        Output::Stress { beam, u, face } => point.beams[beam].stress_pa(u)[usize::from(face == Face::Right)],
        Output::PeakStress { beam: Some(beam) } => point.beams[beam].peak_stress().stress_pa,
        Output::PeakStress { beam: None } => point.peak_stress().expect("there are beams").1.stress_pa,
        Output::Position { beam, u, axis } => point.beams[beam].shape_m(u)[of(axis)],
        Output::NodeDisplacement { node, axis } => point.nodes[node].displacement_m[of(axis)],
        Output::NodeRotation { node } => point.nodes[node].rotation_rad,
        _ => unreachable!("all outputs are above"),
    }
}

/// Every parameter of a network except the sums over beams.
fn parameters(network: &Network) -> Vec<Parameter> {
    let mut all: Vec<Parameter> = (0..network.nodes.len()).flat_map(|n| [Parameter::NodeX(n), Parameter::NodeY(n)]).collect();
    for (beam, b) in network.beams.iter().enumerate() {
        all.extend((1..b.shape.angle_rad().len()).map(|k| Parameter::Bend { beam, k }));
        all.extend([Parameter::Thickness(beam), Parameter::Depth(beam), Parameter::Young(beam)]);
        if b.section.poisson.is_some() {
            all.push(Parameter::Poisson(beam));
        }
    }
    all
}

/// What a parameter is measured by: 1 cm, 1 rad, or its own value (Poisson's ratio: 1).
fn scale(network: &Network, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::NodeX(_) | Parameter::NodeY(_) => 1e-2,
        Parameter::Thickness(beam) => network.beams[beam].section.thickness_m,
        Parameter::Depth(beam) => network.beams[beam].section.depth_m,
        Parameter::Young(beam) => network.beams[beam].section.young_pa,
        _ => 1.0,
    }
}

/// The network with one parameter changed; `c_0` and lengths follow from nodes and bends.
fn changed(network: &Network, parameter: Parameter, amount: f64) -> Network {
    let mut new = network.clone();
    let mut bends: Vec<Vec<f64>> = network.beams.iter().map(|b| b.shape.angle_rad()[1..].to_vec()).collect();
    match parameter {
        Parameter::NodeX(n) => new.nodes[n].position_m[0] += amount,
        Parameter::NodeY(n) => new.nodes[n].position_m[1] += amount,
        Parameter::Bend { beam, k } => bends[beam][k - 1] += amount,
        Parameter::Thickness(beam) => new.beams[beam].section.thickness_m += amount,
        Parameter::Depth(beam) => new.beams[beam].section.depth_m += amount,
        Parameter::Young(beam) => new.beams[beam].section.young_pa += amount,
        Parameter::Poisson(beam) => new.beams[beam].section.poisson = new.beams[beam].section.poisson.map(|nu| nu + amount),
        _ => unreachable!("one beam or node at a time"),
    }
    for (beam, bend) in new.beams.iter_mut().zip(&bends) {
        let chord = add(new.nodes[beam.end].position_m, new.nodes[beam.start].position_m, -1.0);
        beam.shape = Shape::from_chord(chord, bend).expect("a shape");
    }
    new
}

/// The paths at h, −h, 2h, −2h with h in units of [`scale`].
fn neighbours(network: &Network, parameter: Parameter, stations: &[f64], settings: &Settings, h: f64) -> Option<[Path; 4]> {
    let unit = scale(network, parameter);
    let at = |s: f64| trace(&changed(network, parameter, s * h * unit), stations, settings, &mut |_| true).expect("a sound network");
    let paths = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
    paths.iter().all(|p| p.status.is_complete()).then_some(paths)
}

/// Fourth-order central difference by the scaled parameter.
fn difference(paths: &[Path; 4], station: usize, output: Output, h: f64) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i: usize| value(&paths[i].points[station], output));
    (8.0 * (a - b) - (c - d)) / (12.0 * h)
}

/// Whether the largest stress stays at its place, so that it has a derivative.
fn peak_stays(points: &[&Point], beam: Option<usize>) -> bool {
    let place = |p: &Point| match beam {
        Some(beam) => (beam, p.beams[beam].peak_stress()),
        None => p.peak_stress().expect("there are beams"),
    };
    let (which, first) = place(points[0]);
    points.iter().all(|p| {
        let (b, peak) = place(p);
        let both_inside = (peak.u > 0.0 && peak.u < 1.0) == (first.u > 0.0 && first.u < 1.0);
        b == which && peak.face == first.face && peak.tension == first.tension && (peak.u - first.u).abs() < 0.05 && both_inside
    })
}

/// Worst difference between gradients and differences, relative to the largest scaled gradient of its output, and the number compared.
fn compare(network: &Network, stations: &[f64], settings: &Settings, outputs: &[Output], h: f64) -> Option<(f64, usize)> {
    let path = trace(network, stations, settings, &mut |_| true).expect("a sound network");
    if !path.status.is_complete() {
        return None;
    }
    let all = parameters(network);
    let mut differences = Vec::new();
    for parameter in &all {
        differences.push(neighbours(network, *parameter, stations, settings, h)?);
    }
    let mut gradients = path.gradients().expect("a sound network");
    let (mut worst, mut compared) = (0.0_f64, 0);
    for (station, point) in path.points.iter().enumerate() {
        for (gradient, output) in gradients.at(point, outputs).expect("a sound network").iter().zip(outputs) {
            let exact: Vec<f64> = all.iter().map(|p| by(gradient, *p) * scale(network, *p)).collect();
            let largest = exact.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (paths, exact) in differences.iter().zip(&exact) {
                if let Output::PeakStress { beam } = *output {
                    let mut points = vec![point];
                    points.extend(paths.iter().map(|p| &p.points[station]));
                    if !peak_stays(&points, beam) {
                        continue;
                    }
                }
                let error = (exact - difference(paths, station, *output, h)).abs() / largest;
                assert!(error.is_finite(), "{output:?}: {exact} of {largest}");
                worst = worst.max(error);
                compared += 1;
            }
        }
    }
    Some((worst, compared))
}

#[test]
#[allow(clippy::approx_constant, reason = "a gradient is 3.14 N/cm")]
fn values_of_table3() {
    // dF/dp at 1.36 cm from an independent spectral computation, N/cm and N/rad, of the half mechanism's parameters and the force
    // of both halves.
    let network = table3_by_nodes(POM);
    let path = solve(&network, &[13.6e-3], &fine(Theory::Inextensible));
    let force = gradient(&path, &path.points[0], Output::Force);
    let per_cm = |p: Parameter| 2.0 * by(&force, p) * 1e-2;
    close(per_cm(Parameter::NodeX(2)), -9.64, 0.005, "n3x");
    close(per_cm(Parameter::NodeY(2)), -3.30, 0.005, "n3y");
    close(per_cm(Parameter::NodeX(3)), 3.14, 0.005, "n4x");
    close(per_cm(Parameter::NodeY(3)), -1.22, 0.005, "n4y");
    for (beam, k, want) in [(3, 1, 2.22), (3, 2, 2.32), (2, 1, -1.57), (2, 2, -1.35)] {
        close(2.0 * by(&force, Parameter::Bend { beam, k }), want, 0.005, "bend");
    }
}

/// Forces, stresses and shapes of a half mechanism.
fn all_outputs() -> Vec<Output> {
    let mut all = vec![Output::Force, Output::PeakStress { beam: None }];
    for beam in 0..4 {
        let (u, axis) = ([0.0, 0.26, 0.7, 1.0][beam], [Axis::X, Axis::Y][beam % 2]);
        all.push(Output::PeakStress { beam: Some(beam) });
        all.push(Output::Stress { beam, u, face: Face::Left });
        all.push(Output::Stress { beam, u: 0.45, face: Face::Right });
        all.push(Output::Position { beam, u: 1.0 - 0.5 * u, axis });
    }
    for axis in [Axis::X, Axis::Y] {
        all.push(Output::NodeDisplacement { node: 2, axis });
    }
    all.push(Output::NodeRotation { node: 3 });
    all
}

/// Largest error over 25 random networks, relative to the largest gradient of the output with positions measured by 1 cm, bends and
/// Poisson's ratio by 1, and the rest by its value; and the number of derivatives compared.
fn random_networks(theory: Theory, seed: u64) -> (f64, usize) {
    let mut random = SplitMix(seed);
    let (mut designs, mut total, mut worst) = (0, 0, 0.0_f64);
    while designs < 25 {
        let network = random_network(&mut random, 3.0, 1.5).expect("mild shapes span their chords");
        let Some((error, compared)) = compare(&network, &[4e-3, 13.6e-3], &fine(theory), &all_outputs(), 1e-3) else { continue };
        designs += 1;
        total += compared;
        worst = worst.max(error);
    }
    (worst, total)
}

// Of 35 700 derivatives each, few may be left out for a largest stress that changes its place.

#[test]
fn random_networks_without_stretching() {
    let (worst, total) = random_networks(Theory::Inextensible, 31);
    println!("{total} derivatives, worst {worst:.1e}");
    assert!(worst <= 1e-7 && total > 35_000, "{worst:e} of {total}");
}

#[test]
fn random_networks_with_stretching() {
    let (worst, total) = random_networks(Theory::Reissner, 32);
    println!("{total} derivatives, worst {worst:.1e}");
    assert!(worst <= 1e-7 && total > 35_000, "{worst:e} of {total}");
}

/// Three beams with a hinge, a pinned support, and a guide that is neither parallel to an axis nor to the drive and may turn.
fn mixed(drive: Drive) -> Network {
    let places = [[0.0, 0.0], [0.03, 0.004], [0.055, -0.012], [0.06, 0.02]];
    let guide = Support::Slider { direction: [0.6, 0.8], rotation: Rotation::Free };
    let supports = [Support::Clamped, Support::Free, Support::Pinned, guide];
    let beam = |start: usize, end: usize, bend: &[f64]| {
        let shape = Shape::from_chord(add(places[end], places[start], -1.0), bend).expect("a sound network");
        let section = Section { thickness_m: 1e-3 + 2e-4 * end as f64, poisson: if end == 3 { None } else { Some(0.3) }, ..POM };
        rigid(start, end, shape, section)
    };
    let mut beams = vec![beam(0, 1, &[2.6, -0.7]), beam(2, 1, &[-2.4]), beam(1, 3, &[-2.2, 0.5, 0.3])];
    beams[1].end_joint = Joint::Hinged;
    common::network(places.iter().zip(supports).map(|(p, s)| node(*p, s)).collect(), beams, drive)
}

#[test]
fn every_kind_of_drive_and_support() {
    let drives = [
        (Drive::Displacement { node: 3, direction: [0.3, 1.0] }, 6e-3),
        (Drive::Displacement { node: 1, direction: [-0.2, 1.0] }, 4e-3),
        (Drive::Rotation { node: 1 }, 0.3),
        (Drive::Force { node: 3, direction: [0.0, 1.0] }, 1.5),
        (Drive::Force { node: 1, direction: [1.0, 0.5] }, 2.0),
        (Drive::Moment { node: 3 }, 0.02),
    ];
    let mut outputs = vec![Output::Force, Output::Displacement, Output::PeakStress { beam: Some(0) }, Output::NodeRotation { node: 1 }];
    outputs.extend([0, 1, 2].map(|beam| Output::Stress { beam, u: 0.3, face: Face::Right }));
    outputs.extend([0, 1, 2].map(|beam| Output::Position { beam, u: 0.8, axis: Axis::X }));
    outputs.push(Output::NodeDisplacement { node: 3, axis: Axis::Y });
    for (drive, control) in drives {
        for theory in THEORIES {
            let network = mixed(drive);
            let held = if drive.is_kinematic() { Output::Displacement } else { Output::Force };
            let path = solve(&network, &[control], &fine(theory));
            let constant = gradient(&path, &path.points[0], held);
            assert!(parameters(&network).iter().all(|p| by(&constant, *p) == 0.0), "the control is held");
            // Results that the drive prescribes.
            let fixed = |o: &Output| match drive {
                Drive::Displacement { node: 3, .. } => matches!(o, Output::NodeDisplacement { .. }),
                Drive::Rotation { .. } => matches!(o, Output::NodeRotation { .. }),
                _ => false,
            };
            let asked: Vec<Output> = outputs.iter().copied().filter(|o| *o != held && !fixed(o)).collect();
            let (worst, compared) = compare(&network, &[control], &fine(theory), &asked, 1e-3).expect("it has a path");
            println!("{drive:?} {theory:?}: {worst:.1e} of {compared}");
            assert!(worst <= 1e-9 && compared > 200, "{worst:e} {compared}");
        }
    }
}

#[test]
fn stiffness_is_the_slope_of_the_force_gradient() {
    for theory in THEORIES {
        for drive in [Drive::Displacement { node: 3, direction: [0.3, 1.0] }, Drive::Rotation { node: 1 }] {
            let network = mixed(drive);
            let (middle, h) = if matches!(drive, Drive::Rotation { .. }) { (0.3, 2e-3) } else { (6e-3, 2e-5) };
            let stations = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|s| middle + s * h);
            let path = solve(&network, &stations, &fine(theory));
            let mut gradients = path.gradients().unwrap();
            let forces: Vec<Gradient> = path.points.iter().map(|p| gradients.at(p, &[Output::Force]).unwrap().remove(0)).collect();
            let exact = gradients.at(&path.points[2], &[Output::Stiffness]).unwrap().remove(0);
            let scaled = |g: &Gradient, p: Parameter| by(g, p) * scale(&network, p);
            let all = parameters(&network);
            let largest = all.iter().fold(0.0_f64, |m, p| m.max(scaled(&exact, *p).abs()));
            for p in all {
                let f = |i: usize| scaled(&forces[i], p);
                let slope = (8.0 * (f(3) - f(1)) - (f(4) - f(0))) / (12.0 * h);
                close(slope, scaled(&exact, p), 1e-7 * largest, "dK/dp");
            }
        }
    }
}

#[test]
fn stiffness_under_a_force_drive() {
    // The same states under a force: dK at held force is dK at held displacement plus what the displacement changes.
    let kinematic = mixed(Drive::Displacement { node: 3, direction: [0.3, 1.0] });
    let path = solve(&kinematic, &[5.99e-3, 6e-3, 6.01e-3], &fine(Theory::Reissner));
    let point = &path.points[1];
    let forced = mixed(Drive::Force { node: 3, direction: [0.3, 1.0] });
    let other = solve(&forced, &[point.force], &fine(Theory::Reissner));
    let (by_force, by_displacement) = (gradient(&other, &other.points[0], Output::Stiffness), gradient(&path, point, Output::Stiffness));
    let (force, displacement) = (gradient(&path, point, Output::Force), gradient(&other, &other.points[0], Output::Displacement));
    let curvature = (path.points[2].stiffness - path.points[0].stiffness) / 2e-5;
    for p in parameters(&kinematic) {
        let size = scale(&kinematic, p);
        let moved = by(&displacement, p) * size;
        close(moved, -by(&force, p) * size / point.stiffness, 1e-9, "displacement at a held force");
        let want = by(&by_displacement, p) * size + curvature * moved;
        close(by(&by_force, p) * size, want, 2e-4 * point.stiffness, "stiffness at a held force");
    }
}

#[test]
fn laws_of_the_section() {
    for theory in THEORIES {
        let network = table3_by_nodes(POM);
        let path = solve(&network, &[5e-3, 13.6e-3], &fine(theory));
        for point in &path.points {
            let force = gradient(&path, point, Output::Force);
            let power = |p: Parameter, x: f64| by(&force, p) * x / point.force;
            near(power(Parameter::AllDepth, POM.depth_m), 1.0, 1e-10, "force is proportional to depth");
            near(power(Parameter::AllYoung, POM.young_pa), 1.0, 1e-10, "and to Young's modulus");
            if theory == Theory::Inextensible {
                near(power(Parameter::AllThickness, POM.thickness_m), 3.0, 1e-10, "and to the cube of the thickness");
                assert!(by(&force, Parameter::AllPoisson) == 0.0, "nothing shears");
            } else {
                assert!((power(Parameter::AllThickness, POM.thickness_m) - 3.0).abs() > 1e-4, "slenderness enters");
                assert!(by(&force, Parameter::AllPoisson) != 0.0);
            }
            // At a given displacement, stress does not depend on depth, and is proportional to E and, without stretching, to w.
            let stress = gradient(&path, point, Output::PeakStress { beam: None });
            let largest = point.peak_stress().unwrap().1.stress_pa;
            close(by(&stress, Parameter::AllDepth) * POM.depth_m / largest, 0.0, 1e-9, "stress and depth");
            near(by(&stress, Parameter::AllYoung) * POM.young_pa / largest, 1.0, 1e-9, "stress and modulus");
            if theory == Theory::Inextensible {
                near(by(&stress, Parameter::AllThickness) * POM.thickness_m / largest, 1.0, 1e-9, "stress and thickness");
            }
        }
    }
}

/// Derivative along a velocity of all nodes.
fn along(gradient: &Gradient, network: &Network, velocity: impl Fn([f64; 2]) -> [f64; 2]) -> f64 {
    let parts = gradient.nodes.iter().zip(&network.nodes).map(|(g, n)| {
        let v = velocity(n.position_m);
        g[0] * v[0] + g[1] * v[1]
    });
    parts.sum()
}

#[test]
fn moving_and_scaling_the_whole() {
    for theory in THEORIES {
        let network = table3_by_nodes(POM);
        let path = solve(&network, &[5e-3, 13.6e-3], &fine(theory));
        for point in &path.points {
            let force = gradient(&path, point, Output::Force);
            let size = force.nodes.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
            for v in [[1.0, 0.0], [0.0, 1.0]] {
                close(along(&force, &network, |_| v), 0.0, 1e-10 * size, "moving all nodes");
            }
            // F(s·shape, s·Δ) = s^n F(shape, Δ): n = −2 without stretching, 2 with thickness and depth scaled as well.
            let stretched = along(&force, &network, |p| p) + point.stiffness * point.displacement;
            if theory == Theory::Inextensible {
                close(stretched, -2.0 * point.force, 1e-6 * point.force, "F ∝ 1/size²");
            } else {
                let section = by(&force, Parameter::AllThickness) * POM.thickness_m + by(&force, Parameter::AllDepth) * POM.depth_m;
                close(stretched + section, 2.0 * point.force, 1e-6 * point.force, "F ∝ size²");
            }
            // The end of a beam is its node, and its position moves with it.
            let end = gradient(&path, point, Output::Position { beam: 2, u: 1.0, axis: Axis::X });
            let joint = gradient(&path, point, Output::NodeDisplacement { node: 3, axis: Axis::X });
            for p in parameters(&network) {
                let rest = if p == Parameter::NodeX(3) { 1.0 } else { 0.0 };
                close(by(&end, p) * scale(&network, p), (by(&joint, p) + rest) * scale(&network, p), 1e-10, "end of a beam");
            }
        }
    }
}

#[test]
fn turning_the_whole_does_nothing() {
    // A cantilever under a moment drive has no preferred direction.
    let mut network = cantilever(0.05, 0.4, POM, Support::Free, Drive::Rotation { node: 1 });
    network.beams[0].shape = Shape::from_chord(network.nodes[1].position_m, &[0.7, -1.1]).unwrap();
    let path = solve(&network, &[0.8], &fine(Theory::Reissner));
    let moment = gradient(&path, &path.points[0], Output::Force);
    let size = moment.nodes.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    close(along(&moment, &network, |p| [-p[1], p[0]]), 0.0, 1e-12 * size, "turning");
    // M = EI Δ/L, whatever the bend, and L ∝ chord.
    let m = path.points[0].force;
    near(along(&moment, &network, |p| p), -m, 1e-9, "M ∝ 1/L");
    near(moment.beams[0].length * network.beams[0].shape.length_m(), -m, 1e-9, "M ∝ 1/L");
    close(moment.beams[0].angle.iter().fold(0.0, |a: f64, b| a.max(b.abs())), 0.0, 1e-9 * m, "not on the shape");
}

#[test]
fn one_factorisation_per_station() {
    let network = table3_by_nodes(POM);
    let stations: Vec<f64> = (0..=16).map(|i| f64::from(i) * 0.85e-3).collect();
    let path = solve(&network, &stations, &fine(Theory::Reissner));
    let mut gradients = path.gradients().unwrap();
    for point in &path.points {
        assert_eq!(gradients.at(point, &all_outputs()).unwrap().len(), all_outputs().len());
    }
    assert_eq!(gradients.counters().factorisations, 17);
    assert_eq!(gradients.counters().residual_evaluations, 17);
    // At rest nothing depends on the design; between stations it works as well.
    let rest = gradients.at(&path.points[0], &[Output::Force]).unwrap().remove(0);
    assert!(parameters(&network).iter().all(|p| by(&rest, *p) == 0.0));
    let between = path.at(0.5 * (stations[7] + stations[8])).unwrap();
    let depth = by(&gradients.at(&between, &[Output::Force]).unwrap()[0], Parameter::AllDepth);
    near(depth * POM.depth_m, between.force, 1e-9, "between stations");
}

#[test]
fn what_cannot_be_differentiated_is_named() {
    let network = table3_by_nodes(POM);
    let path = solve(&network, &[5e-3], &fine(Theory::Reissner));
    let mut gradients = path.gradients().unwrap();
    let mut at = |output: Output| gradients.at(&path.points[0], &[output]).unwrap_err();
    assert_eq!(at(Output::PeakStress { beam: Some(4) }), GradientError::NoBeam { beam: 4 });
    assert_eq!(at(Output::NodeRotation { node: 5 }), GradientError::NoNode { node: 5 });
    assert_eq!(at(Output::Position { beam: 0, u: 1.5, axis: Axis::X }), GradientError::NotOnBeam { u: 1.5 });
    assert!(matches!(at(Output::Stress { beam: 0, u: f64::NAN, face: Face::Left }), GradientError::NotOnBeam { .. }));
    // A point of another design, of another mechanism, and of this design at another control than it says.
    let other = solve(&changed(&network, Parameter::NodeX(2), 1e-3), &[5e-3], &fine(Theory::Reissner));
    let turned = solve(&mixed(Drive::Rotation { node: 1 }), &[0.1], &fine(Theory::Reissner));
    for foreign in [&other, &turned] {
        assert_eq!(gradients.at(&foreign.points[0], &[Output::Force]), Err(GradientError::ForeignPoint));
        assert!(!GradientError::ForeignPoint.to_string().is_empty());
    }
    let force = gradients.at(&path.points[0], &[Output::Force]).unwrap().remove(0);
    assert_eq!(force.by(Parameter::Bend { beam: 0, k: 0 }), None);
    assert_eq!(force.by(Parameter::Bend { beam: 0, k: 3 }), None);
    assert_eq!(force.by(Parameter::NodeX(5)), None);
    assert_eq!(force.by(Parameter::Thickness(4)), None);
}

#[test]
#[ignore = "a clock"]
fn time_of_gradients() {
    let network = table3_by_nodes(POM);
    let stations: Vec<f64> = (1..=34).map(|i| 13.6e-3 * f64::from(i) / 34.0).collect();
    let best = |work: &mut dyn FnMut()| {
        (0..20).fold(f64::INFINITY, |best: f64, _| {
            let start = std::time::Instant::now();
            work();
            best.min(start.elapsed().as_secs_f64())
        })
    };
    for accuracy in [1e-3, 1e-5, 1e-8] {
        let settings = Settings { accuracy, ..Settings::default() };
        let path = solve(&network, &stations, &settings);
        let curve = best(&mut || drop(std::hint::black_box(trace(&network, &stations, &settings, &mut |_| true))));
        for outputs in [&[Output::Force][..], &[Output::Force, Output::PeakStress { beam: None }], &all_outputs()] {
            let time = best(&mut || {
                let mut gradients = path.gradients().unwrap();
                for point in &path.points {
                    std::hint::black_box(gradients.at(point, outputs).unwrap());
                }
            });
            println!(
                "accuracy {accuracy:e}, degree {}: curve {:.0} µs, {} outputs: {:.0} µs",
                path.degree,
                1e6 * curve,
                outputs.len(),
                1e6 * time
            );
        }
    }
}
