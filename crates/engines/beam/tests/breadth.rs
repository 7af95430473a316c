//! Rigid bodies, beams of varying thickness, load stages, parallel guides, rigid joint zones, support reactions and the stiffness of the
//! output: closed forms, equivalent networks, balance of forces and differences.

mod common;

use common::shooting::Shooting;
use common::{POM, SplitMix, TABLE3_NODES, add, cantilever, close, elastica, exact, near, node, random_network, solve, table3_by_shapes};
use forcewright_base::maths;
use forcewright_beam::{
    Beam, Drive, Follow, GradientError, Joint, Joints, Network, NetworkError, Node, Output, Parameter, Path, Rotation, Section, Settings,
    Shape, Stage, Support, Theory, trace,
};

const DOWN: [f64; 2] = [0.0, -1.0];

fn tapered(length_m: f64, ends_m: [f64; 2], drive: Drive) -> Network {
    let mut network = cantilever(length_m, 0.0, POM, Support::Free, drive);
    network.beams[0].profile = vec![[0.0, ends_m[0]], [1.0, ends_m[1]]];
    network
}

/// δ = ∫ F x²/(E b w³/12) dx with w linear, in closed form; x from the tip, w = a + s x.
#[test]
fn a_tapered_cantilever_bends_as_the_closed_form_says() {
    let (l, thin, thick) = (0.1, 0.6e-3, 1.5e-3);
    let network = tapered(l, [thick, thin], Drive::Force { node: 1, direction: [0.0, 1.0] });
    let force = 1e-5;
    let point = &solve(&network, &[force], &elastica()).points[0];
    let s = (thick - thin) / l;
    // ∫ x²/(a + s x)³ dx = [ln w + 2a/w − a²/(2w²)]/s³ with w = a + s x.
    let primitive = |w: f64| (maths::ln(w) + 2.0 * thin / w - thin * thin / (2.0 * w * w)) / (s * s * s);
    let want = force * 12.0 / (POM.young_pa * POM.depth_m) * (primitive(thick) - primitive(thin));
    near(point.displacement, want, 1e-8, "tip of a tapered cantilever");
    // Bending stress F x 6/(b w²): largest where w = 2a, at x = a/s, which is inside if thick > 2 thin.
    let peak = point.beams[0].peak_stress();
    let x = thin / s;
    near(peak.stress_pa, force * x * 6.0 / (POM.depth_m * 4.0 * thin * thin), 1e-8, "largest stress of a taper");
    close(peak.u, 1.0 - x / l, 1e-5, "its place");
}

/// ΔL = F L ln(w₁/w₀)/(E b (w₁ − w₀)).
#[test]
fn a_tapered_bar_stretches_as_the_closed_form_says() {
    let (l, ends) = (0.1, [2e-3, 1e-3]);
    let network = tapered(l, ends, Drive::Force { node: 1, direction: [1.0, 0.0] });
    let point = &solve(&network, &[1e-2], &exact(Theory::Reissner)).points[0];
    let want = 1e-2 * l * maths::ln(ends[1] / ends[0]) / (POM.young_pa * POM.depth_m * (ends[1] - ends[0]));
    near(point.displacement, want, 1e-9, "tapered bar");
    near(point.beams[0].stress_pa(1.0)[0], 1e-2 / (POM.depth_m * ends[1]), 1e-9, "its stress at the thin end");
}

/// Places that change nothing: a constant profile, and a place on the straight line between two others.
#[test]
fn places_that_say_nothing_new_change_nothing() {
    let plain = table3_by_shapes(POM);
    let stations = [0.004, 0.009, 0.0136];
    let with = |profile: &[[f64; 2]], beam: usize| {
        let mut network = plain.clone();
        network.beams[beam].profile = profile.to_vec();
        solve(&network, &stations, &exact(Theory::Reissner))
    };
    let pairs = [
        (solve(&plain, &stations, &exact(Theory::Reissner)), with(&[[0.0, 1e-3], [1.0, 1e-3]], 3)),
        (with(&[[0.0, 0.8e-3], [1.0, 1.2e-3]], 2), with(&[[0.0, 0.8e-3], [0.3, 0.92e-3], [1.0, 1.2e-3]], 2)),
    ];
    for (a, b) in &pairs {
        for (a, b) in a.points.iter().zip(&b.points) {
            near(b.force, a.force, 1e-8, "force");
            near(b.stiffness, a.stiffness, 1e-6, "stiffness");
            near(b.energy_j, a.energy_j, 1e-8, "energy");
            near(b.peak_stress().unwrap().1.stress_pa, a.peak_stress().unwrap().1.stress_pa, 1e-7, "stress");
            for u in [0.1, 0.3, 0.8] {
                let (x, y) = (a.beams[2].shape_m(u), b.beams[2].shape_m(u));
                close(x[0], y[0], 1e-11, "x");
                close(x[1], y[1], 1e-11, "y");
            }
        }
    }
}

/// One beam of three thicknesses is three beams; and energy is work.
#[test]
fn kinked_tapers_are_beams_in_a_row() {
    let shape = Shape::new(vec![0.2, 1.1, -0.4], 0.08).unwrap();
    let guide = Support::Slider { direction: [0.0, 1.0], rotation: Rotation::Free };
    let drive = |node| Drive::Displacement { node, direction: DOWN };
    let profile = vec![[0.0, 1e-3], [0.25, 0.5e-3], [0.7, 0.5e-3], [1.0, 1.4e-3]];
    let mut beam = Beam::new(0, 1, shape.clone(), POM);
    beam.profile.clone_from(&profile);
    let whole = Network::new(vec![node([0.0; 2], Support::Clamped), node(shape.chord_m(), guide)], vec![beam], drive(1));
    let mut nodes = vec![node([0.0; 2], Support::Clamped)];
    let mut beams = Vec::new();
    for (i, pair) in profile.windows(2).enumerate() {
        let [from, to] = [pair[0][0], pair[1][0]];
        // η(u_a + (u_b − u_a) v), by hand.
        let c = shape.angle_rad();
        let w = to - from;
        let part = vec![c[0] + c[1] * from + c[2] * from * from, w * (c[1] + 2.0 * c[2] * from), c[2] * w * w];
        let mut piece = Beam::new(i, i + 1, Shape::new(part, 0.08 * w).unwrap(), POM);
        piece.profile = vec![[0.0, pair[0][1]], [1.0, pair[1][1]]];
        nodes.push(node(shape.point_m(to), if i == 2 { guide } else { Support::Free }));
        beams.push(piece);
    }
    let row = Network::new(nodes, beams, drive(3));
    let stations: Vec<f64> = (0..=500).map(|i| 0.03 * f64::from(i) / 500.0).collect();
    let (a, b) = (solve(&whole, &stations, &exact(Theory::Reissner)), solve(&row, &stations, &exact(Theory::Reissner)));
    for (a, b) in a.points.iter().zip(&b.points).skip(1) {
        near(a.force, b.force, 1e-8, "force");
        near(a.peak_stress().unwrap().1.stress_pa, b.peak_stress().unwrap().1.stress_pa, 1e-6, "stress");
        near(a.beams[0].moment_nm(0.25), b.beams[1].moment_nm(0.0), 1e-6, "moment at a kink");
    }
    // ∫ F dΔ by the corrected trapezoidal rule, which uses the stiffness too.
    let work: f64 = a
        .points
        .windows(2)
        .map(|p| {
            let h = p[1].control - p[0].control;
            0.5 * h * (p[0].force + p[1].force) + h * h / 12.0 * (p[0].stiffness - p[1].stiffness)
        })
        .sum();
    near(a.points[500].energy_j, work, 2e-9, "work");
}

/// Linear tapers and a parallel guide against shooting, which integrates the beams.
#[test]
fn tapers_agree_with_shooting() {
    let mut random = SplitMix(21);
    let mut seen = 0;
    for round in 0..24 {
        let Ok(mut network) = random_network(&mut random, 2.0, 1.0) else { continue };
        for beam in &mut network.beams {
            let [a, b] = [1e-3 + random.around(4e-4), 1e-3 + random.around(4e-4)];
            beam.profile = vec![[0.0, a], [1.0, b]];
        }
        if round % 2 == 0 {
            network.nodes[4].support = Support::Parallel;
        }
        let theory = if round % 3 == 0 { Theory::Inextensible } else { Theory::Reissner };
        let path = trace(&network, &[0.004, 0.009], &exact(theory), &mut |_| true).expect("a sound network");
        for point in &path.points {
            let Some(shot) = Shooting::new(&network, theory, point).solve(point) else { continue };
            near(point.force, shot.force, 1e-8, "force");
            for (state, moment) in point.beams.iter().zip(&shot.start_moment_nm) {
                close(state.start_moment_nm, *moment, 1e-7 * point.force.abs() * 0.04, "moment");
            }
            seen += 1;
        }
    }
    assert!(seen >= 30, "{seen}");
}

/// A rigid arm of length a on a cantilever of length L: δ = F (L³/3 + L² a + L a²)/EI.
#[test]
fn an_arm_lengthens_the_lever() {
    let (l, a) = (0.08, 0.03);
    let shape = Shape::new(vec![0.0], l).unwrap();
    let mut beam = Beam::new(0, 1, shape, POM);
    // The node is the tip of the arm; the beam ends before it.
    beam.arms_m[1] = [-a, 0.0];
    let nodes = vec![node([0.0; 2], Support::Clamped), node([l + a, 0.0], Support::Free)];
    let network = Network::new(nodes, vec![beam], Drive::Force { node: 1, direction: [0.0, 1.0] });
    let f = 1e-5;
    let point = &solve(&network, &[f], &elastica()).points[0];
    let want = f * (l * l * l / 3.0 + l * l * a + l * a * a) / POM.bending_stiffness_n_m2();
    near(point.displacement, want, 1e-9, "tip of the arm");
    near(point.beams[0].end_moment_nm, f * a, 1e-9, "moment at the end of the beam");
    near(point.nodes[0].moment_nm, -f * (l + a), 1e-9, "moment at the clamp");
}

/// The whole of a rigid body moves the same wherever its node is.
#[test]
fn a_body_does_not_depend_on_its_reference_point() {
    let network = |reference: [f64; 2], drive_node: usize| {
        let corners = [[0.0, 0.02], [0.02, 0.02], [0.01, 0.04]];
        let grounds = [[0.0, 0.0], [0.025, 0.0], [0.05, 0.045]];
        let mut nodes: Vec<Node> = grounds.iter().map(|g| node(*g, Support::Clamped)).collect();
        nodes[2].support = Support::Slider { direction: [1.0, 0.4], rotation: Rotation::Fixed };
        nodes.push(node(reference, Support::Free));
        let bends = [[0.7, -0.3], [-0.4, 0.9], [0.5, 0.2]];
        let beams = (0..3)
            .map(|i| {
                let shape = Shape::from_chord(add(corners[i], grounds[i], -1.0), &bends[i]).unwrap();
                let mut beam = Beam::new(i, 3, shape, POM);
                beam.arms_m[1] = add(corners[i], reference, -1.0);
                if i == 1 {
                    beam.end_joint = Joint::Hinged;
                }
                beam
            })
            .collect();
        Network::new(nodes, beams, Drive::Displacement { node: drive_node, direction: [1.0, 0.4] })
    };
    let stations = [0.002, 0.006, 0.01];
    for theory in [Theory::Reissner, Theory::Inextensible] {
        let first = solve(&network([0.0, 0.0], 2), &stations, &exact(theory));
        let second = solve(&network([0.013, 0.031], 2), &stations, &exact(theory));
        for (a, b) in first.points.iter().zip(&second.points) {
            near(a.force, b.force, 1e-9, "force");
            close(a.nodes[3].rotation_rad, b.nodes[3].rotation_rad, 1e-10, "rotation of the body");
            for beam in 0..3 {
                let (p, q) = (a.beams[beam].shape_m(1.0), b.beams[beam].shape_m(1.0));
                close(p[0], q[0], 1e-11, "x of a corner");
                close(p[1], q[1], 1e-11, "y of a corner");
            }
            let [k, m] = [(&first, a), (&second, b)].map(|(path, p)| path.output_stiffness(p).unwrap());
            near(k[0][0], m[0][0], 1e-7, "stiffness at the output");
        }
    }
}

/// A block of a stiff material in the place of a body: the difference falls in proportion to its softness.
#[test]
fn a_body_is_the_limit_of_stiff_beams() {
    let reach = 0.02;
    let shape = || Shape::new(vec![std::f64::consts::FRAC_PI_2, 0.6], 0.04).unwrap();
    let top = shape().chord_m();
    let guide = Support::Slider { direction: [0.0, 1.0], rotation: Rotation::Fixed };
    let with_body = |stiff: Option<f64>| {
        let tip = [top[0] + reach, top[1]];
        let last = Shape::from_chord([0.03, -0.01], &[0.4]).unwrap();
        let far = add(tip, last.chord_m(), 1.0);
        let mut nodes = vec![node([0.0; 2], Support::Clamped), node(top, Support::Free), node(far, guide)];
        let mut beams = vec![Beam::new(0, 1, shape(), POM), Beam::new(1, 2, last, POM)];
        match stiff {
            None => beams[1].arms_m[0] = [reach, 0.0],
            Some(times) => {
                nodes.push(node(tip, Support::Free));
                beams[1].start = 3;
                let section = Section { young_pa: times * POM.young_pa, ..POM };
                beams.push(Beam::new(1, 3, Shape::new(vec![0.0], reach).unwrap(), section));
            }
        }
        let network = Network::new(nodes, beams, Drive::Displacement { node: 2, direction: DOWN });
        solve(&network, &[0.008], &exact(Theory::Reissner)).points[0].force
    };
    let rigid = with_body(None);
    let gaps: Vec<f64> = [1e3, 1e4, 1e5].map(|times| (with_body(Some(times)) - rigid) / rigid).to_vec();
    near(gaps[0] / gaps[1], 10.0, 2e-2, "ratio of differences");
    near(gaps[1] / gaps[2], 10.0, 2e-2, "ratio of differences");
}

/// Elastic: the order of dead loads does not matter, and a motion prescribed as 0 is a support.
#[test]
fn the_order_of_loads_does_not_matter() {
    let mut base = table3_by_shapes(POM);
    base.nodes[4].support = Support::Free;
    let push = Drive::Force { node: 2, direction: [0.6, 0.8] };
    let moment = Drive::Moment { node: 3 };
    let down = Drive::Force { node: 4, direction: DOWN };
    let run = |before: Vec<Stage>, drive: Drive, to: f64| {
        let network = Network { before, drive, ..base.clone() };
        let path = solve(&network, &[to], &exact(Theory::Reissner));
        assert_eq!(path.before.len(), network.before.len());
        path.points[0].clone()
    };
    let stage = |drive, to| Stage { drive, to };
    let a = run(vec![stage(push, 0.3), stage(moment, -2e-3)], down, 0.4);
    let b = run(vec![stage(down, 0.4), stage(push, 0.3)], Drive::Moment { node: 3 }, 0.0);
    let b_turned = run(vec![stage(down, 0.4), stage(moment, -2e-3)], push, 0.3);
    assert!((a.energy_j - b.energy_j).abs() > 1e-6, "the moment does something");
    for (p, q) in a.nodes.iter().zip(&b_turned.nodes) {
        close(p.rotation_rad, q.rotation_rad, 1e-9, "rotation");
        for i in 0..2 {
            close(p.displacement_m[i], q.displacement_m[i], 1e-11, "displacement");
            close(p.force_n[i], q.force_n[i], 1e-8, "force from outside");
        }
        close(p.moment_nm, q.moment_nm, 1e-10, "moment from outside");
    }
    near(a.energy_j, b_turned.energy_j, 1e-9, "energy");
    close(a.nodes[4].force_n[1], -0.4, 1e-14, "a dead load");
    // Guided by two loads of 0, as by the slider of Table 3.
    let (x, y) = (Drive::Displacement { node: 4, direction: [1.0, 0.0] }, Drive::Displacement { node: 4, direction: DOWN });
    let guided = run(vec![stage(x, 0.0), stage(Drive::Rotation { node: 4 }, 0.0)], y, 0.0136);
    near(guided.force, solve(&table3_by_shapes(POM), &[0.0136], &exact(Theory::Reissner)).points[0].force, 1e-9, "guided");
    close(guided.force, -guided.nodes[4].force_n[1], 1e-12, "force of the drive");
    // A stage of the other sign.
    let sideways = |s: f64| run(vec![stage(Drive::Displacement { node: 4, direction: [s, 0.0] }, s * 1e-3)], y, 0.004).force;
    near(sideways(1.0), sideways(-1.0), 1e-10, "sign of a stage");
}

/// A displacement found by a force, prescribed: that force comes back; and stages that cannot be carried out say so.
#[test]
fn stages_start_where_the_one_before_ended() {
    let mut network = table3_by_shapes(POM);
    network.drive = Drive::Force { node: 4, direction: DOWN };
    network.before = vec![Stage { drive: Drive::Force { node: 4, direction: DOWN }, to: 2.0 }];
    let path = solve(&network, &[0.0, 1.0], &elastica());
    let direct = Network { before: Vec::new(), ..network.clone() };
    let direct = solve(&direct, &[2.0, 3.0], &elastica());
    close(path.points[0].displacement, 0.0, 1e-12, "displacement at the start");
    near(path.before[0].displacement, direct.points[0].displacement, 1e-9, "first load");
    near(path.points[1].displacement, direct.points[1].displacement - direct.points[0].displacement, 1e-8, "second load");
    network.before[0].to = 20.0;
    let failed = trace(&network, &[1.0], &elastica(), &mut |_| true).unwrap();
    assert!(failed.points.is_empty() && failed.before.is_empty() && !failed.status.is_complete());
    network.before[0].to = f64::NAN;
    assert!(trace(&network, &[1.0], &elastica(), &mut |_| true).is_err());
    network.before = vec![Stage { drive: Drive::Displacement { node: 4, direction: DOWN }, to: 1e-3 }];
    network.drive = Drive::Displacement { node: 4, direction: DOWN };
    assert!(trace(&network, &[1.0], &elastica(), &mut |_| true).is_err());
}

/// Departure COMP-4: the block free to move sideways, its rotation held, gives 9.87 N at 13.6 mm and no plateau.
#[test]
fn a_parallel_guide() {
    let mut network = table3_by_shapes(POM);
    network.nodes[4].support = Support::Parallel;
    let path = solve(&network, &[0.0136], &elastica());
    near(2.0 * path.points[0].force, 9.87, 5e-4, "force with n5 free in x");
    close(path.points[0].nodes[4].rotation_rad, 0.0, 0.0, "rotation");
    assert!(path.points[0].nodes[4].displacement_m[0].abs() > 1e-5);
}

/// Forces and moments from outside balance, whatever holds and loads the network.
#[test]
fn what_acts_from_outside_balances() {
    let mut random = SplitMix(11);
    let mut seen = 0;
    for round in 0..60 {
        let Ok(mut network) = random_network(&mut random, 3.0, 1.5) else { continue };
        network.beams[1].profile = vec![[0.0, 1e-3], [0.4, 0.8e-3], [1.0, 1.3e-3]];
        network.before = vec![Stage { drive: Drive::Force { node: 3, direction: [1.0, 0.3] }, to: 0.2 }];
        if round % 2 == 0 {
            network.nodes[1].support = Support::Pinned;
            network.before.push(Stage { drive: Drive::Moment { node: 2 }, to: -1e-3 });
        }
        let theory = if round % 3 == 0 { Theory::Inextensible } else { Theory::Reissner };
        let settings = Settings { joints: if round % 5 == 0 { Joints::Overlap } else { Joints::Point }, accuracy: 1e-6, ..exact(theory) };
        let Ok(path) = trace(&network, &[0.003, 0.006], &settings, &mut |_| true) else { continue };
        for point in &path.points {
            let (mut force, mut moment, mut largest) = ([0.0; 2], 0.0, 0.0_f64);
            for (n, state) in network.nodes.iter().zip(&point.nodes) {
                let at = add(n.position_m, state.displacement_m, 1.0);
                force = add(force, state.force_n, 1.0);
                moment += state.moment_nm + at[0] * state.force_n[1] - at[1] * state.force_n[0];
                largest = largest.max(state.force_n[0].abs()).max(state.force_n[1].abs());
            }
            close(force[0], 0.0, 1e-8 * largest, "sum of forces along x");
            close(force[1], 0.0, 1e-8 * largest, "sum of forces along y");
            close(moment, 0.0, 1e-9 * largest, "sum of moments");
            seen += 1;
        }
    }
    assert!(seen >= 80, "{seen}");
}

/// Against differences of the forces from outside: a dead load, then two motions of the output held and the third driven.
#[test]
fn stiffness_of_the_output() {
    let mut network = table3_by_shapes(POM);
    network.nodes[4].support = Support::Free;
    let push = Stage { drive: Drive::Force { node: 4, direction: [0.2, -1.0] }, to: 0.7 };
    let motions = [
        Drive::Displacement { node: 4, direction: [1.0, 0.0] },
        Drive::Displacement { node: 4, direction: [0.0, 1.0] },
        Drive::Rotation { node: 4 },
    ];
    for (column, step) in [2e-6, 2e-6, 1e-4].into_iter().enumerate() {
        let held = (0..3).filter(|m| *m != column).map(|m| Stage { drive: motions[m], to: 0.0 });
        let before: Vec<Stage> = std::iter::once(push).chain(held).collect();
        let at = |sign: f64| {
            let drive = match motions[column] {
                Drive::Displacement { node, direction } => Drive::Displacement { node, direction: direction.map(|d| sign * d) },
                other => other,
            };
            let network = Network { before: before.clone(), drive, ..network.clone() };
            let path = solve(&network, &[0.0, step, 2.0 * step], &exact(Theory::Reissner));
            let outside =
                |i: usize| [path.points[i].nodes[4].force_n[0], path.points[i].nodes[4].force_n[1], path.points[i].nodes[4].moment_nm];
            ([outside(0), outside(1), outside(2)], path.output_stiffness(&path.points[0]).unwrap())
        };
        let (forward, exact) = at(1.0);
        for row in 0..3 {
            let [f0, f1, f2] = forward.map(|f| f[row]);
            let difference = (4.0 * f1 - 3.0 * f0 - f2) / (2.0 * step);
            let size = (exact[row][row] * exact[column][column]).abs().sqrt();
            close(exact[row][column], difference, 2e-6 * size, "entry of the stiffness");
            close(exact[row][column], exact[column][row], 0.0, "symmetry");
        }
    }
}

/// A mirrored half with its output on the mirror line against the whole: the whole sways where the half's stiffness against sideways
/// motion and rotation of the output is not positive.
#[test]
fn the_half_knows_when_the_whole_sways() {
    let mut random = SplitMix(5);
    let (mut swaying, mut steady) = (0, 0);
    for _ in 0..90 {
        let Ok(half) = random_network(&mut random, 2.0, 0.8) else { continue };
        let whole = doubled(&half);
        let stations = [0.002, 0.005, 0.008];
        let settings = Settings { accuracy: 1e-6, ..exact(Theory::Reissner) };
        let (half_path, whole_path) =
            (trace(&half, &stations, &settings, &mut |_| true).unwrap(), trace(&whole, &stations, &settings, &mut |_| true).unwrap());
        for (a, b) in half_path.points.iter().zip(&whole_path.points) {
            if (b.force - 2.0 * a.force).abs() > 1e-5 * a.force.abs() {
                continue;
            }
            let k = half_path.output_stiffness(a).unwrap();
            // Negative eigenvalues of the block of sideways motion and rotation.
            let determinant = k[0][0] * k[2][2] - k[0][2] * k[0][2];
            let sway = if determinant < 0.0 {
                1
            } else if k[0][0] < 0.0 {
                2
            } else {
                0
            };
            // Every unstable motion of the guided half has a symmetric and an antisymmetric form.
            assert_eq!(b.instability, 2 * a.instability + sway, "{k:?}");
            if sway > 0 { swaying += 1 } else { steady += 1 }
        }
    }
    assert!(swaying > 5 && steady > 100, "{swaying} {steady}");
}

/// The half with its mirror image at x = 2.5 mm, the output free to sway.
fn doubled(half: &Network) -> Network {
    let axis = half.nodes[4].position_m[0];
    let image = |p: [f64; 2]| [2.0 * axis - p[0], p[1]];
    let mut nodes = half.nodes.clone();
    nodes[4].support = Support::Free;
    nodes.extend(half.nodes[..4].iter().map(|n| Node { position_m: image(n.position_m), ..*n }));
    let mut beams = half.beams.clone();
    for beam in &half.beams {
        let other = |i: usize| if i == 4 { 4 } else { i + 5 };
        // θ → π − θ.
        let mut angle: Vec<f64> = beam.shape.angle_rad().iter().map(|c| -c).collect();
        angle[0] += std::f64::consts::PI;
        let shape = Shape::new(angle, beam.shape.length_m()).expect("a mirrored shape");
        beams.push(Beam { start: other(beam.start), end: other(beam.end), shape, ..beam.clone() });
    }
    Network { nodes, beams, ..half.clone() }
}

/// Rigid zones are arms: the same network with the beams cut by hand.
#[test]
fn zones_are_arms() {
    let network = table3_by_shapes(POM);
    let stations = [0.005, 0.0136];
    let settings = Settings { joints: Joints::Overlap, ..exact(Theory::Reissner) };
    let path = solve(&network, &stations, &settings);
    let mut cut = network.clone();
    for (beam, state) in cut.beams.iter_mut().zip(&path.points[0].beams) {
        let [from, to] = state.flexible();
        let c = beam.shape.angle_rad();
        let w = to - from;
        let part = vec![c[0] + c[1] * from + c[2] * from * from, w * (c[1] + 2.0 * c[2] * from), c[2] * w * w];
        beam.arms_m = [beam.shape.point_m(from), add(beam.shape.point_m(to), beam.shape.chord_m(), -1.0)];
        beam.shape = Shape::new(part, w * beam.shape.length_m()).unwrap();
    }
    let by_hand = solve(&cut, &stations, &exact(Theory::Reissner));
    for (a, b) in path.points.iter().zip(&by_hand.points) {
        near(a.force, b.force, 1e-9, "force");
        near(a.peak_stress().unwrap().1.stress_pa, b.peak_stress().unwrap().1.stress_pa, 1e-7, "stress");
        // The rigid part moves with the node.
        let end = a.beams[0].shape_m(1.0);
        let want = add(network.nodes[2].position_m, a.nodes[2].displacement_m, 1.0);
        close(end[0], want[0], 1e-10, "x of a node");
        close(end[1], want[1], 1e-10, "y of a node");
    }
    // Clamped ends, and the one on the guide, meet no other beam.
    close(path.points[0].beams[0].flexible()[0], 0.0, 0.0, "clamped end");
    close(path.points[0].beams[3].flexible()[1], 1.0, 0.0, "guided end");
    assert!(path.points[0].beams[2].flexible()[0] > 0.01);
}

/// Zones belong to the place where beams meet: wherever the node of the body lies, they and their gradients are the same.
#[test]
fn zones_on_a_body_do_not_depend_on_its_node() {
    let plain = table3_by_shapes(POM);
    let mut moved = plain.clone();
    let away = [4e-3, -7e-3];
    moved.nodes[2].position_m = add(plain.nodes[2].position_m, away, -1.0);
    for beam in &mut moved.beams {
        for (end, node) in [beam.start, beam.end].into_iter().enumerate() {
            if node == 2 {
                beam.arms_m[end] = away;
            }
        }
    }
    let settings = Settings { joints: Joints::Overlap, ..exact(Theory::Reissner) };
    let [a, b] = [&plain, &moved].map(|n| solve(n, &[0.006, 0.0136], &settings));
    let (mut first, mut second) = (a.gradients().unwrap(), b.gradients().unwrap());
    for (p, q) in a.points.iter().zip(&b.points) {
        near(p.force, q.force, 1e-9, "force");
        for (x, y) in p.beams.iter().zip(&q.beams) {
            close(x.flexible()[0], y.flexible()[0], 1e-14, "zone at the start");
            close(x.flexible()[1], y.flexible()[1], 1e-14, "zone at the end");
        }
        let [f, g] = [&first.at(p, &[Output::Force]).unwrap()[0], &second.at(q, &[Output::Force]).unwrap()[0]];
        for beam in 0..4 {
            let by = Parameter::Thickness(beam);
            near(f.by(by).unwrap(), g.by(by).unwrap(), 1e-7, "force by thickness");
        }
    }
}

/// The bench prototype (w 0.85 mm, t 10 mm): zones raise the force of 5.99 N by some hundredths of it; measured was 0.9 N more, of which
/// fillets explain as much again. Zones up to the inner corners are the least that is rigid.
#[test]
fn zones_stiffen_the_prototype() {
    let network = table3_by_shapes(Section { thickness_m: 0.85e-3, ..POM });
    let with = |joints| 2.0 * solve(&network, &[0.0145], &Settings { joints, ..elastica() }).points[0].force;
    let (point, overlap) = (with(Joints::Point), with(Joints::Overlap));
    near(point, 5.99, 2e-3, "point joints");
    assert!(overlap - point > 0.15 && overlap - point < 0.25, "rigid zones: {}", overlap - point);
}

/// Thickness over 100 times, places out of order, beams inside their joints.
#[test]
fn impossible_profiles_and_zones_are_refused() {
    let mut network = table3_by_shapes(POM);
    for profile in [
        vec![[0.0, 1e-3]],
        vec![[0.0, 1e-3], [0.5, 1e-3]],
        vec![[0.0, 1e-3], [1.0, 0.0]],
        vec![[0.0, 1e-3], [0.7, 1e-3], [0.6, 1e-3], [1.0, 1e-3]],
        vec![[0.0, 1e-5], [1.0, 2e-3]],
    ] {
        network.beams[0].profile = profile;
        assert!(network.check().is_err());
    }
    let thick = table3_by_shapes(Section { thickness_m: 16e-3, ..POM });
    let settings = Settings { joints: Joints::Overlap, ..Settings::default() };
    assert!(trace(&thick, &[1e-3], &settings, &mut |_| true).is_err());
    assert_eq!(TABLE3_NODES.len(), 5);
    let mut arm = table3_by_shapes(POM);
    arm.beams[0].arms_m[0] = [f64::NAN, 0.0];
    assert!(arm.check().is_err());
    // Followed to the end with everything at once.
    let mut network = table3_by_shapes(POM);
    network.beams[3].profile = vec![[0.0, 1e-3], [0.5, 0.9e-3], [1.0, 1e-3]];
    network.before = vec![Stage { drive: Drive::Force { node: 2, direction: [1.0, 0.0] }, to: 0.1 }];
    network.drive = Drive::Force { node: 4, direction: DOWN };
    let settings = Settings { joints: Joints::Overlap, follow: Follow::ToEnd, accuracy: 1e-6, ..elastica() };
    let path = trace(&network, &[6.0], &settings, &mut |_| true).unwrap();
    assert!(path.whole_status.is_complete(), "{}", path.whole_status);
    assert!(!path.folds.is_empty() && !path.jumps.is_empty());
}

/// Progress grows through resolutions, load stages and limit points, and can stop each of them.
#[test]
fn progress_never_goes_back() {
    let mut network = table3_by_shapes(POM);
    network.before = vec![Stage { drive: Drive::Moment { node: 2 }, to: 1e-4 }];
    network.drive = Drive::Force { node: 4, direction: DOWN };
    let settings = Settings { follow: Follow::ToEnd, accuracy: 1e-6, ..elastica() };
    let mut seen: Vec<f64> = Vec::new();
    let path = trace(&network, &[6.0], &settings, &mut |fraction| {
        seen.push(fraction);
        true
    });
    assert!(path.expect("a sound network").whole_status.is_complete());
    assert!(seen.windows(2).all(|p| p[0] <= p[1]) && seen.iter().all(|f| (0.0..=1.0).contains(f)));
    for last in [0, seen.len() / 3, seen.len() - 2] {
        let mut count = 0;
        let stopped = trace(&network, &[6.0], &settings, &mut |_| {
            count += 1;
            count <= last
        });
        let stopped = stopped.expect("a sound network");
        let status = if stopped.status.is_complete() { stopped.whole_status } else { stopped.status };
        assert!(!status.is_complete(), "after {last} of {}", seen.len());
    }
}

/// Bars that do not buckle before the truss snaps.
const STOUT: Section = Section { thickness_m: 8e-3, ..POM };

fn truss(before: Vec<Stage>) -> Network {
    let nodes = vec![
        node([-0.05, 0.0], Support::Pinned),
        node([0.0, 0.01], Support::Slider { direction: [0.0, 1.0], rotation: Rotation::Fixed }),
        node([0.05, 0.0], Support::Pinned),
    ];
    let beam = |start: usize, chord: [f64; 2]| {
        let shape = Shape::from_chord(chord, &[]).expect("straight");
        Beam { start_joint: Joint::Hinged, end_joint: Joint::Hinged, ..Beam::new(start, 1, shape, STOUT) }
    };
    let beams = vec![beam(0, [0.05, 0.01]), beam(2, [-0.05, 0.01])];
    Network { before, ..Network::new(nodes, beams, Drive::Force { node: 1, direction: DOWN }) }
}

/// A dead load does work in a jump whether it came with the drive or before it.
#[test]
fn a_jump_sets_the_same_energy_free_in_stages() {
    let settings = Settings { follow: Follow::ToEnd, ..exact(Theory::Reissner) };
    let jump = |network: &Network, to: f64| {
        let path = trace(network, &[to], &settings, &mut |_| true).unwrap();
        assert!(path.whole_status.is_complete(), "{}", path.whole_status);
        path.jumps[0]
    };
    let at_once = jump(&truss(Vec::new()), 1500.0);
    let first = 0.5 * at_once.control;
    let staged = jump(&truss(vec![Stage { drive: Drive::Force { node: 1, direction: DOWN }, to: first }]), 1500.0 - first);
    near(staged.control + first, at_once.control, 1e-7, "limit load");
    near(staged.released_j, at_once.released_j, 1e-6, "energy set free");
}

/// Beyond a limit point gradients are those of the points there, against differences at the same control.
#[test]
fn gradients_go_on_beyond_limit_points() {
    let settings = Settings { follow: Follow::ToEnd, ..exact(Theory::Reissner) };
    let solved = |network: &Network| trace(network, &[1000.0, 1500.0], &settings, &mut |_| true).unwrap();
    let network = truss(Vec::new());
    let path = solved(&network);
    let mut gradients = path.gradients().unwrap();
    let thicker = |amount: f64| {
        let mut network = network.clone();
        network.beams[0].section.thickness_m += amount;
        solved(&network)
    };
    let h = 1e-6;
    let (more, less) = (thicker(h), thicker(-h));
    let mut beyond = 0;
    for point in path
        .whole
        .iter()
        .filter(|p| p.branch > 0 && (p.control.to_bits() == 1000_f64.to_bits() || p.control.to_bits() == 1500_f64.to_bits()))
    {
        let same = |path: &Path| {
            let found = path.whole.iter().find(|p| p.branch == point.branch && p.control.to_bits() == point.control.to_bits());
            found.expect("the same stretch").displacement
        };
        let gradient = &gradients.at(point, &[Output::Displacement]).unwrap()[0];
        let by = gradient.by(Parameter::Thickness(0)).unwrap();
        near(by, (same(&more) - same(&less)) / (2.0 * h), 1e-4, "displacement by thickness");
        assert!(path.output_stiffness(point).is_some());
        beyond += 1;
    }
    assert!(beyond >= 1, "{beyond}");
}

/// What has been held cannot be pushed; a branch that a load stage passes is named; points of another path are refused.
#[test]
fn stages_are_checked_and_watched() {
    let push = |drive, before| Network { before, ..cantilever(0.1, 0.0, POM, Support::Free, drive) };
    let (moment, turn) = (Drive::Moment { node: 1 }, Drive::Rotation { node: 1 });
    let (force, lift) = (Drive::Force { node: 1, direction: [0.0, 1.0] }, Drive::Displacement { node: 1, direction: [0.0, 2.0] });
    for (drive, held) in [(moment, turn), (force, lift)] {
        let blocked = push(drive, vec![Stage { drive: held, to: 0.01 }]);
        assert!(matches!(blocked.check(), Err(NetworkError::DriveBlocked { node: 1 })));
        assert!(push(held, vec![Stage { drive, to: 1e-3 }]).check().is_ok());
    }
    // Euler's load of a clamped–free column: π² EI/(4 L²).
    let euler = std::f64::consts::PI * std::f64::consts::PI * POM.bending_stiffness_n_m2() / (4.0 * 0.01);
    let along = Drive::Force { node: 1, direction: [-1.0, 0.0] };
    let column = push(turn, vec![Stage { drive: along, to: 1.5 * euler }]);
    let path = trace(&column, &[0.01], &exact(Theory::Inextensible), &mut |_| true).unwrap();
    let branch = path.bifurcations.first().expect("the column buckles in the stage");
    assert_eq!((branch.stage, branch.before, branch.after), (0, 0, 1));
    near(branch.force, euler, 1e-5, "Euler's load");
    let other = trace(&column, &[0.01], &exact(Theory::Inextensible), &mut |_| true).unwrap();
    let foreign = other.points.first().unwrap_or(&other.before[0]);
    assert!(path.output_stiffness(foreign).is_none());
    assert!(matches!(path.gradients().unwrap().at(foreign, &[Output::Force]), Err(GradientError::ForeignPoint)));
    let many = vec![[0.0, 1e-3], [0.1, 0.9e-3], [0.2, 1e-3], [1.0, 0.8e-3]];
    let mut pieces = table3_by_shapes(POM);
    pieces.beams = (0..60).map(|i| Beam { profile: many.clone(), ..pieces.beams[i % 4].clone() }).collect();
    assert!(matches!(pieces.check(), Err(NetworkError::TooManyPieces { count: 180 })));
}
