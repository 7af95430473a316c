//! Gradients with rigid bodies, varying thickness, rigid zones and load stages, against fourth-order differences of whole solutions.

mod common;

use common::{SplitMix, add, exact, random_network};
use forcewright_base::maths;
use forcewright_beam::{
    Axis, Beam, Drive, Face, Gradient, Joint, Joints, Network, Output, Parameter, Path, Point, Reflection, Settings, Shape, Stage, Support,
    Theory, trace,
};

fn parameters(network: &Network) -> Vec<Parameter> {
    let mut all: Vec<Parameter> = (0..network.nodes.len()).flat_map(|n| [Parameter::NodeX(n), Parameter::NodeY(n)]).collect();
    for (beam, b) in network.beams.iter().enumerate() {
        all.extend((1..b.shape.angle_rad().len()).map(|k| Parameter::Bend { beam, k }));
        all.extend([Parameter::Thickness(beam), Parameter::Depth(beam), Parameter::Young(beam), Parameter::Poisson(beam)]);
        all.extend((0..b.profile.len()).map(|place| Parameter::ThicknessAt { beam, place }));
        for end in (0..2).filter(|end| b.arms_m[*end].iter().any(|a| *a != 0.0)) {
            all.extend([Axis::X, Axis::Y].map(|axis| Parameter::Arm { beam, end, axis }));
        }
    }
    all
}

/// A step that changes results noticeably.
fn scale(network: &Network, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::NodeX(_) | Parameter::NodeY(_) | Parameter::Arm { .. } => 0.02,
        Parameter::Thickness(_) | Parameter::ThicknessAt { .. } => 1e-3,
        Parameter::Depth(_) => 1e-2,
        Parameter::Young(beam) => network.beams[beam].section.young_pa,
        _ => 1.0,
    }
}

fn changed(network: &Network, parameter: Parameter, amount: f64) -> Network {
    let mut new = network.clone();
    let mut bends: Vec<Vec<f64>> = network.beams.iter().map(|b| b.shape.angle_rad()[1..].to_vec()).collect();
    match parameter {
        Parameter::NodeX(n) => new.nodes[n].position_m[0] += amount,
        Parameter::NodeY(n) => new.nodes[n].position_m[1] += amount,
        Parameter::Bend { beam, k } => bends[beam][k - 1] += amount,
        Parameter::Thickness(beam) => {
            new.beams[beam].section.thickness_m += amount;
            new.beams[beam].profile.iter_mut().for_each(|p| p[1] += amount);
        }
        Parameter::ThicknessAt { beam, place } => new.beams[beam].profile[place][1] += amount,
        Parameter::Arm { beam, end, axis } => new.beams[beam].arms_m[end][usize::from(axis == Axis::Y)] += amount,
        Parameter::Depth(beam) => new.beams[beam].section.depth_m += amount,
        Parameter::Young(beam) => new.beams[beam].section.young_pa += amount,
        Parameter::Poisson(beam) => new.beams[beam].section.poisson = new.beams[beam].section.poisson.map(|nu| nu + amount),
        _ => unreachable!("one beam or node at a time"),
    }
    close(&mut new, &bends);
    new
}

/// Shapes that lead from the end of one arm to that of the other.
fn close(network: &mut Network, bends: &[Vec<f64>]) {
    for (beam, bend) in network.beams.iter_mut().zip(bends) {
        let at = |node: usize, end: usize| add(network.nodes[node].position_m, beam.arms_m[end], 1.0);
        beam.shape = Shape::from_chord(add(at(beam.end, 1), at(beam.start, 0), -1.0), bend).expect("a shape");
    }
}

fn value(point: &Point, output: Output) -> f64 {
    match output {
        Output::Force => point.force,
        Output::Displacement => point.displacement,
        Output::Stiffness => point.stiffness,
        Output::Stress { beam, u, face } => point.beams[beam].stress_pa(u)[usize::from(face == Face::Right)],
        Output::PeakStress { beam } => {
            beam.map_or_else(|| point.peak_stress().expect("there are beams").1, |b| point.beams[b].peak_stress()).stress_pa
        }
        Output::Position { beam, u, axis } => point.beams[beam].shape_m(u)[usize::from(axis == Axis::Y)],
        Output::Gap { first, second, reflection } => {
            let at = |(beam, u): (usize, f64)| point.beams[beam].shape_m(u);
            let (a, b) = (at(first), reflection.map_or(at(second), |r| r.image(at(second))));
            let half = |(beam, u): (usize, f64)| 0.5 * point.beams[beam].thickness_m(u);
            maths::hypot(b[0] - a[0], b[1] - a[1]) - half(first) - half(second)
        }
        Output::NodeDisplacement { node, axis } => point.nodes[node].displacement_m[usize::from(axis == Axis::Y)],
        Output::NodeRotation { node } => point.nodes[node].rotation_rad,
        _ => unreachable!(),
    }
}

const MIRROR: Reflection = Reflection { point_m: [0.0; 2], direction: [0.0, 1.0] };

const OUTPUTS: [Output; 13] = [
    // With rigid zones these are inside them.
    Output::Position { beam: 2, u: 0.005, axis: Axis::Y },
    Output::Gap { first: (3, 0.003), second: (0, 0.99), reflection: None },
    Output::Gap { first: (0, 0.4), second: (2, 0.7), reflection: None },
    Output::Gap { first: (3, 0.5), second: (2, 0.6), reflection: Some(MIRROR) },
    Output::Force,
    Output::Displacement,
    Output::Stiffness,
    Output::Stress { beam: 2, u: 0.4, face: Face::Left },
    Output::Stress { beam: 3, u: 0.8, face: Face::Right },
    Output::PeakStress { beam: Some(1) },
    Output::Position { beam: 3, u: 0.6, axis: Axis::X },
    Output::NodeDisplacement { node: 2, axis: Axis::Y },
    Output::NodeRotation { node: 3 },
];

/// Worst difference relative to the largest scaled gradient of its output, and the number of derivatives compared.
fn compare(network: &Network, stations: &[f64], settings: &Settings) -> Option<(f64, usize)> {
    let solved = |n: &Network| trace(n, stations, settings, &mut |_| true).expect("a sound network");
    let path = solved(network);
    let h = 2e-3;
    if !path.status.is_complete() {
        return None;
    }
    let all = parameters(network);
    let mut neighbours: Vec<[Path; 4]> = Vec::new();
    for parameter in &all {
        let four = [1.0, -1.0, 2.0, -2.0].map(|s| solved(&changed(network, *parameter, s * h * scale(network, *parameter))));
        if !four.iter().all(|p| p.status.is_complete()) {
            return None;
        }
        neighbours.push(four);
    }
    let (mut worst, mut compared) = (0.0_f64, 0);
    let mut gradients = path.gradients().expect("a sound network");
    for (station, point) in path.points.iter().enumerate() {
        let all_gradients: Vec<Gradient> = gradients.at(point, &OUTPUTS).expect("no limit point");
        for (gradient, output) in all_gradients.iter().zip(OUTPUTS) {
            let exact: Vec<f64> = all.iter().map(|p| gradient.by(*p).expect("it exists") * scale(network, *p)).collect();
            let largest = exact.iter().fold(1e-12_f64, |m, v| m.max(v.abs()));
            for (four, exact) in neighbours.iter().zip(&exact) {
                let [a, b, c, d] = [0, 1, 2, 3].map(|i: usize| value(&four[i].points[station], output));
                let error = (exact - (8.0 * (a - b) - (c - d)) / (12.0 * h)).abs() / largest;
                assert!(error.is_finite());
                if let Output::PeakStress { .. } = output
                    && error > 1e-4
                {
                    // Its place jumps.
                    continue;
                }
                if error > worst {
                    worst = error;
                }
                compared += 1;
            }
        }
    }
    Some((worst, compared))
}

/// Tests one kind of network over several random designs.
fn sweep(seed: u64, settings: &Settings, stations: &[f64], alter: impl Fn(&mut Network)) {
    let mut random = SplitMix(seed);
    let (mut worst, mut compared, mut designs) = (0.0_f64, 0, 0);
    while designs < 2 {
        let Ok(mut network) = random_network(&mut random, 1.0, 0.4) else { continue };
        alter(&mut network);
        let bends: Vec<Vec<f64>> = network.beams.iter().map(|b| b.shape.angle_rad()[1..].to_vec()).collect();
        close(&mut network, &bends);
        let Some((error, count)) = compare(&network, stations, settings) else { continue };
        (worst, compared, designs) = (worst.max(error), compared + count, designs + 1);
    }
    assert!(worst < 1e-6, "worst {worst:e} of {compared}");
    assert!(compared > 500, "{compared}");
}

fn tapers(network: &mut Network) {
    network.beams[2].profile = vec![[0.0, 1.2e-3], [0.35, 0.8e-3], [1.0, 1e-3]];
    network.beams[3].profile = vec![[0.0, 0.9e-3], [1.0, 1.1e-3]];
}

fn bodies(network: &mut Network) {
    network.beams[0].arms_m[1] = [-2e-3, -1e-3];
    network.beams[1].arms_m[1] = [2e-3, -1e-3];
    network.beams[2].arms_m = [[-1e-3, 2e-3], [1e-3, 1e-3]];
    network.beams[1].end_joint = Joint::Hinged;
    network.beams[3].arms_m[1] = [1e-3, 0.0];
}

const STATIONS: [f64; 2] = [0.003, 0.007];

#[test]
fn of_tapered_beams() {
    sweep(1, &exact(Theory::Reissner), &STATIONS, tapers);
    sweep(2, &exact(Theory::Inextensible), &STATIONS, tapers);
}

#[test]
fn of_rigid_bodies() {
    sweep(3, &exact(Theory::Reissner), &STATIONS, bodies);
    sweep(4, &exact(Theory::Inextensible), &STATIONS, |network| {
        bodies(network);
        network.nodes[4].support = Support::Parallel;
    });
}

#[test]
fn of_rigid_zones() {
    let overlap = Settings { joints: Joints::Overlap, ..exact(Theory::Reissner) };
    sweep(5, &overlap, &STATIONS, |_| {});
    sweep(6, &overlap, &STATIONS, |network| {
        tapers(network);
        network.beams[0].section.thickness_m = 1.4e-3;
    });
}

#[test]
fn after_load_stages() {
    let stage = |drive, to| Stage { drive, to };
    let free = |network: &mut Network| network.nodes[4].support = Support::Free;
    let down = Drive::Displacement { node: 4, direction: [0.0, -1.0] };
    sweep(7, &exact(Theory::Reissner), &STATIONS, |network| {
        free(network);
        network.before = vec![
            stage(Drive::Force { node: 2, direction: [0.6, 0.8] }, 0.2),
            stage(Drive::Displacement { node: 4, direction: [1.0, 0.0] }, -3e-4),
            stage(Drive::Rotation { node: 4 }, 0.05),
        ];
        network.drive = down;
    });
    // A force last: its displacement counts from where it began.
    sweep(8, &exact(Theory::Reissner), &[0.1, 0.2], |network| {
        free(network);
        tapers(network);
        network.before = vec![stage(down, 2e-3), stage(Drive::Moment { node: 3 }, 1e-3)];
        network.drive = Drive::Force { node: 3, direction: [-0.8, 0.6] };
    });
}

#[test]
fn of_everything_at_once() {
    let settings = Settings { joints: Joints::Overlap, ..exact(Theory::Reissner) };
    sweep(9, &settings, &STATIONS, |network| {
        tapers(network);
        network.beams[0].arms_m[0] = [1e-3, 0.0];
        network.beams[3].arms_m[1] = [1e-3, 0.0];
        network.nodes[1].support = Support::Pinned;
        network.before = vec![Stage { drive: Drive::Rotation { node: 1 }, to: 0.1 }];
        network.beams.push(Beam::new(0, 3, Shape::new(vec![0.0], 1.0).unwrap(), network.beams[0].section));
        let last = network.beams.len() - 1;
        network.beams[last].end_joint = Joint::Hinged;
        network.beams[last].shape = network.beams[0].shape.clone();
    });
}
