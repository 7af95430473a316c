//! Closed forms and laws that every solution must obey.

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use common::{POM, VERTICAL_GUIDE, cantilever, close, elastica, exact, near, node, rigid, solve, table3_by_nodes, table3_by_shapes};
use forcewright_base::{maths, quadrature::GaussLegendre, roots};
use forcewright_beam::{Beam, Drive, Face, Joint, Network, Point, Rotation, Section, Shape, Status, Support, Theory, trace};

const UP: [f64; 2] = [0.0, 1.0];
const LENGTH: f64 = 0.1;

/// ∫ f over [a, b], accurate to rounding for the elliptic integrands below.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(20);
    let panels = 60;
    let width = (b - a) / f64::from(panels);
    (0..panels).map(|i| width * rule.integrate(|u| f(a + (f64::from(i) + u) * width))).sum()
}

/// Incomplete elliptic integrals F(π/2, k) − F(φ, k) and E(π/2, k) − E(φ, k).
fn elliptic_rest(phi: f64, k: f64) -> (f64, f64) {
    let root = |a: f64| (1.0 - k * k * maths::sin(a) * maths::sin(a)).sqrt();
    (integral(phi, FRAC_PI_2, |a| 1.0 / root(a)), integral(phi, FRAC_PI_2, root))
}

/// Cantilever of length 1 along x with a dead force across its end, p = P L²/(E I): (angle, x, y) of the end.
///
/// K. E. Bisshopp & D. C. Drucker, "Large deflection of cantilever beams", Q. Appl. Math. 3 (1945).
fn dead_force(p: f64) -> (f64, f64, f64) {
    let modulus = |angle: f64| (0.5 * (1.0 + maths::sin(angle))).sqrt();
    let start = |k: f64| maths::asin((1.0 / (k * 2.0_f64.sqrt())).min(1.0));
    let load = |angle: f64| elliptic_rest(start(modulus(angle)), modulus(angle)).0;
    let angle = roots::root(|a| load(a) - p.sqrt(), 1e-3, 1.56, 1e-15).expect("a sign change");
    let k = modulus(angle);
    let (_, e) = elliptic_rest(start(k), k);
    (angle, (2.0 * maths::sin(angle)).sqrt() / p.sqrt(), 1.0 - 2.0 * e / p.sqrt())
}

fn tip(point: &Point) -> (f64, f64, f64) {
    let n = point.nodes[1];
    (n.rotation_rad, 1.0 + n.displacement_m[0] / LENGTH, n.displacement_m[1] / LENGTH)
}

#[test]
fn cantilever_under_a_dead_force() {
    // Mattiasson 1981 prints 5 digits: checks the oracle itself.
    let (angle, x, y) = dead_force(10.0);
    assert!((angle - 1.43029).abs() < 1e-5 && (1.0 - x - 0.55500).abs() < 1e-5 && (y - 0.81061).abs() < 1e-5);

    let unit = POM.bending_stiffness_n_m2() / (LENGTH * LENGTH);
    let loads = [0.5, 1.0, 2.0, 5.0, 10.0];
    let drive = Drive::Force { node: 1, direction: UP };
    let stations = loads.map(|p| p * unit);
    let path = solve(&cantilever(LENGTH, 0.0, POM, Support::Free, drive), &stations, &elastica());
    for (point, p) in path.points.iter().zip(loads) {
        let (want, got) = (dead_force(p), tip(point));
        near(got.0, want.0, 1e-9, "angle by force");
        near(got.1, want.1, 1e-9, "x by force");
        near(got.2, want.2, 1e-9, "y by force");
        near(point.displacement, want.2 * LENGTH, 1e-9, "displacement");
        near(-point.beams[0].force_n[1], -p * unit, 1e-12, "force in the beam");
        // At the clamp: force times lever.
        near(point.beams[0].start_moment_nm, p * unit * want.1 * LENGTH, 1e-9, "moment at the clamp");
        close(point.beams[0].end_moment_nm, 0.0, 1e-9 * p * unit * LENGTH, "moment at the end");
    }
    let drive = Drive::Displacement { node: 1, direction: [0.0, 3.0] };
    let stations = loads.map(|p| dead_force(p).2 * LENGTH);
    let path = solve(&cantilever(LENGTH, 0.0, POM, Support::Free, drive), &stations, &elastica());
    for (point, p) in path.points.iter().zip(loads) {
        near(point.force, p * unit, 1e-9, "force by displacement");
        near(tip(point).1, dead_force(p).1, 1e-9, "x by displacement");
    }
}

#[test]
fn end_moment_makes_a_circle() {
    let unit = POM.bending_stiffness_n_m2() / LENGTH;
    let turns = [0.1, 0.5, 1.0].map(|t| t * TAU);
    for by_rotation in [true, false] {
        let drive = if by_rotation { Drive::Rotation { node: 1 } } else { Drive::Moment { node: 1 } };
        let network = cantilever(LENGTH, 0.0, POM, Support::Free, drive);
        let stations = if by_rotation { turns } else { turns.map(|t| t * unit) };
        let path = solve(&network, &stations, &elastica());
        for (point, turn) in path.points.iter().zip(turns) {
            let (angle, x, y) = tip(point);
            close(angle, turn, 1e-12, "angle");
            close(x, maths::sin(turn) / turn, 1e-12, "x");
            close(y, (1.0 - maths::cos(turn)) / turn, 1e-12, "y");
            near(point.force, turn * unit, 1e-12, "moment");
            near(point.stiffness, unit, 1e-10, "stiffness");
            near(point.energy_j, 0.5 * turn * turn * unit, 1e-12, "energy");
            let [px, py] = point.beams[0].shape_m(0.3);
            close(px, LENGTH * maths::sin(0.3 * turn) / turn, 1e-13, "x inside");
            close(py, LENGTH * (1.0 - maths::cos(0.3 * turn)) / turn, 1e-13, "y inside");
            // Counter-clockwise bending shortens the left face.
            let bending = turn * unit * POM.thickness_m / (2.0 * POM.bending_stiffness_n_m2() / POM.young_pa);
            let [left, right] = point.beams[0].stress_pa(0.7);
            near(left, -bending, 1e-11, "left face");
            near(right, bending, 1e-11, "right face");
            let peak = point.beams[0].peak_stress();
            near(peak.stress_pa, bending, 1e-11, "peak");
            assert!(peak.face == Face::Right && peak.tension);
        }
    }
}

#[test]
fn comp_1_moment_is_ei_over_length_times_the_slope() {
    // Half a turn needs the moment π EI/L: half as much in a beam of twice the length. Without the 1/L both would be equal.
    for length in [0.1, 0.2] {
        let network = cantilever(length, 0.0, POM, Support::Free, Drive::Rotation { node: 1 });
        let point = &solve(&network, &[PI], &elastica()).points[0];
        near(point.beams[0].moment_nm(0.5), PI * POM.bending_stiffness_n_m2() / length, 1e-12, "moment");
    }
}

#[test]
fn force_is_the_slope_of_energy_and_stiffness_that_of_force() {
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let path = solve(&table3_by_shapes(POM), &[0.006, 0.0136, 0.016], &exact(theory));
        let at = |d: f64| path.at(d).unwrap();
        let work = 0.0136 * GaussLegendre::new(24).integrate(|s| at(0.0136 * s).force);
        near(path.points[1].energy_j, work, 1e-11, "work");
        for d in [0.002, 0.009, 0.015] {
            let h = 2e-5;
            let slope = |f: &dyn Fn(&Point) -> f64| {
                let value = |n: f64| f(&at(d + n * h));
                (8.0 * (value(1.0) - value(-1.0)) - (value(2.0) - value(-2.0))) / (12.0 * h)
            };
            let here = at(d);
            near(slope(&|p| p.energy_j), here.force, 1e-8, "force");
            close(slope(&|p| p.force), here.stiffness, 1e-6 * 1500.0, "stiffness");
        }
    }
    // Under force control the stiffness is the inverse of the flexibility.
    let network = cantilever(LENGTH, 0.4, POM, Support::Free, Drive::Force { node: 1, direction: UP });
    let path = solve(&network, &[0.2, 0.8, 0.8001], &elastica());
    let (a, b) = (&path.points[1], &path.points[2]);
    near((b.force - a.force) / (b.displacement - a.displacement), 0.5 * (a.stiffness + b.stiffness), 1e-6, "stiffness");
}

/// A network with other units: lengths times `s`, bending stiffness times `k`.
fn scaled(network: &Network, s: f64, k: f64) -> Network {
    let mut out = network.clone();
    for n in &mut out.nodes {
        n.position_m = n.position_m.map(|x| s * x);
    }
    for b in &mut out.beams {
        b.shape = Shape::new(b.shape.angle_rad().to_vec(), s * b.shape.length_m()).expect("a shape");
        b.section.depth_m *= k;
    }
    out
}

#[test]
fn scaling_law_of_the_paper() {
    // Eq. (6): F L²/(E I) is a function of Δ/L alone.
    let network = table3_by_shapes(POM);
    let stations = [0.004, 0.009, 0.0136];
    let path = solve(&network, &stations, &elastica());
    for (s, k) in [(2.0, 1.0), (0.37, 5.3), (1e3, 1e-4)] {
        let other = solve(&scaled(&network, s, k), &stations.map(|d| s * d), &elastica());
        for (a, b) in path.points.iter().zip(&other.points) {
            near(b.force, a.force * k / (s * s), 1e-12, "scaled force");
        }
    }
}

fn turned(v: [f64; 2], angle: f64, mirror: bool) -> [f64; 2] {
    let (sin, cos) = maths::sin_cos(angle);
    let y = if mirror { -v[1] } else { v[1] };
    [cos * v[0] - sin * y, sin * v[0] + cos * y]
}

/// The same network seen from elsewhere, with its parts in another order.
fn moved(network: &Network, angle: f64, mirror: bool, shift: [f64; 2], reverse: bool) -> Network {
    let count = network.nodes.len();
    // Node i becomes node (2 i + 1) mod 5: every place changes.
    let place = |i: usize| if reverse { (2 * i + 1) % count } else { i };
    let mut nodes = network.nodes.clone();
    for (i, n) in network.nodes.iter().enumerate() {
        let support = match n.support {
            Support::Slider { direction, rotation } => Support::Slider { direction: turned(direction, angle, mirror), rotation },
            other => other,
        };
        let p = turned(n.position_m, angle, mirror);
        nodes[place(i)] = node([p[0] + shift[0], p[1] + shift[1]], support);
    }
    let mut beams = Vec::new();
    for b in &network.beams {
        let sign = if mirror { -1.0 } else { 1.0 };
        let mut c: Vec<f64> = b.shape.angle_rad().iter().map(|c| sign * c).collect();
        c[0] += angle;
        let shape = Shape::new(c, b.shape.length_m()).expect("a shape");
        beams.push(if reverse {
            rigid(place(b.end), place(b.start), shape.reversed(), b.section)
        } else {
            rigid(b.start, b.end, shape, b.section)
        });
    }
    if reverse {
        beams.swap(0, 2);
        beams.swap(1, 3);
    }
    let Drive::Displacement { node, direction } = network.drive else { panic!("another drive") };
    common::network(nodes, beams, Drive::Displacement { node: place(node), direction: turned(direction, angle, mirror) })
}

#[test]
fn the_same_curve_from_everywhere() {
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let network = table3_by_nodes(POM);
        let stations = [0.003, 0.009, 0.0136, 0.017];
        let path = solve(&network, &stations, &exact(theory));
        let views = [
            moved(&network, 0.0, true, [0.0, 0.0], false),
            moved(&network, 37.0_f64.to_radians(), false, [0.3, -0.2], false),
            moved(&network, 0.0, false, [0.0, 0.0], true),
            moved(&network, -2.5, true, [-0.1, 0.0], true),
        ];
        for (view, other) in views.iter().enumerate() {
            let other = solve(other, &stations, &exact(theory));
            for (a, b) in path.points.iter().zip(&other.points) {
                near(b.force, a.force, 1e-11, &format!("force in view {view}"));
                near(b.stiffness, a.stiffness, 1e-7, "stiffness");
                near(b.energy_j, a.energy_j, 1e-11, "energy");
                let (peak_a, peak_b) = (a.peak_stress().unwrap().1, b.peak_stress().unwrap().1);
                near(peak_b.stress_pa, peak_a.stress_pa, 1e-9, "stress");
            }
        }
    }
}

#[test]
fn the_same_bits_twice() {
    let network = table3_by_nodes(POM);
    let run = || trace(&network, &[0.004, 0.0136], &exact(Theory::Reissner), &mut |_| true).unwrap();
    let (a, b) = (run(), run());
    assert_eq!(a.counters, b.counters);
    for (a, b) in a.points.iter().zip(&b.points) {
        assert_eq!(a.force.to_bits(), b.force.to_bits());
        assert_eq!(a.stiffness.to_bits(), b.stiffness.to_bits());
        assert_eq!(a.beams[2].rotation_rad(0.3).to_bits(), b.beams[2].rotation_rad(0.3).to_bits());
    }
}

#[test]
fn a_station_does_not_depend_on_its_neighbours() {
    let network = table3_by_nodes(POM);
    let few = solve(&network, &[0.0136], &elastica());
    let many: Vec<f64> = (1..=136).map(|i| f64::from(i) * 1e-4).collect();
    let many = solve(&network, &many, &elastica());
    near(many.points[135].force, few.points[0].force, 1e-12, "force");
    near(few.at(0.007).unwrap().force, many.points[69].force, 1e-12, "force between stations");
}

/// Stiffness at rest of a straight beam from a clamp to a far end as given, across it.
fn rest_stiffness(section: Section, support: Support, joint: Joint, theory: Theory) -> f64 {
    let mut network = cantilever(LENGTH, 0.0, section, support, Drive::Displacement { node: 1, direction: UP });
    network.beams[0].end_joint = joint;
    solve(&network, &[0.0, 1e-7], &exact(theory)).points[0].stiffness
}

#[test]
fn small_deflections_of_straight_beams() {
    let (ei, cube) = (POM.bending_stiffness_n_m2(), LENGTH * LENGTH * LENGTH);
    let rigid_in_shear = Section { poisson: None, ..POM };
    let shear = LENGTH / POM.shear_stiffness_n();
    let guided = rest_stiffness(rigid_in_shear, VERTICAL_GUIDE, Joint::Rigid, Theory::Reissner);
    near(guided, 12.0 * ei / cube, 1e-12, "guided");
    let guided = rest_stiffness(POM, VERTICAL_GUIDE, Joint::Rigid, Theory::Reissner);
    near(guided, 1.0 / (cube / (12.0 * ei) + shear), 1e-12, "guided with shear");
    let free = rest_stiffness(POM, Support::Free, Joint::Rigid, Theory::Reissner);
    near(free, 1.0 / (cube / (3.0 * ei) + shear), 1e-12, "Timoshenko's cantilever");
    let free = rest_stiffness(POM, Support::Free, Joint::Rigid, Theory::Inextensible);
    near(free, 3.0 * ei / cube, 1e-12, "cantilever");
    let hinged = rest_stiffness(rigid_in_shear, VERTICAL_GUIDE, Joint::Hinged, Theory::Reissner);
    near(hinged, 3.0 * ei / cube, 1e-12, "hinged at the guide");
    let turning = Support::Slider { direction: UP, rotation: Rotation::Free };
    let turning = rest_stiffness(rigid_in_shear, turning, Joint::Rigid, Theory::Reissner);
    near(turning, 3.0 * ei / cube, 1e-12, "turning slider");
}

#[test]
fn stretched_bar() {
    let along = [1.0, 0.0];
    let guide = Support::Slider { direction: along, rotation: Rotation::Fixed };
    let network = cantilever(LENGTH, 0.0, POM, guide, Drive::Displacement { node: 1, direction: along });
    let path = solve(&network, &[1e-4, 2e-3], &exact(Theory::Reissner));
    for point in &path.points {
        let force = POM.axial_stiffness_n() * point.control / LENGTH;
        near(point.force, force, 1e-12, "force");
        near(point.stiffness, POM.axial_stiffness_n() / LENGTH, 1e-12, "stiffness");
        for stress in point.beams[0].stress_pa(0.4) {
            near(stress, force / POM.area_m2(), 1e-12, "stress");
        }
        assert!(point.beams[0].peak_stress().tension);
        near(point.beams[0].shape_m(0.5)[0], 0.5 * (LENGTH + point.control), 1e-12, "middle");
    }
}

/// Half span and rise of a truss of two bars, m. The rise is below that at which the bars would buckle.
const TRUSS: (f64, f64) = (0.1, 4e-4);

/// Force of the truss whose tip has come down: 2 EA (1 − l/L) (h − Δ)/l with l² = a² + (h − Δ)² and L = l at rest.
fn truss_force(down: f64) -> f64 {
    let (a, h) = TRUSS;
    let (rest, length) = (maths::hypot(a, h), maths::hypot(a, h - down));
    2.0 * POM.axial_stiffness_n() * (1.0 - length / rest) * (h - down) / length
}

/// The truss with hinges at its tip, node 2.
fn truss() -> Network {
    let (a, h) = TRUSS;
    let places = [[-a, 0.0], [a, 0.0], [0.0, h]];
    let beam = |start: usize| {
        let shape = Shape::from_chord([-places[start][0], h], &[]).expect("a bar");
        Beam { start_joint: Joint::Rigid, end_joint: Joint::Hinged, ..rigid(start, 2, shape, POM) }
    };
    common::network(
        vec![node(places[0], Support::Pinned), node(places[1], Support::Pinned), node(places[2], Support::Free)],
        vec![beam(0), beam(1)],
        Drive::Displacement { node: 2, direction: [0.0, -1.0] },
    )
}

#[test]
fn snap_through_of_a_shallow_truss() {
    let path = solve(&truss(), &[1e-4, 2e-4, 5e-4, 9e-4], &exact(Theory::Reissner));
    for point in &path.points {
        near(point.force, truss_force(point.control), 1e-9, "force");
        assert!(point.nodes[2].rotation_rad.abs() < 1e-300);
    }
    // A dead load cannot pass the largest force. Ten newtons are far beyond: the first step must not jump to the other side.
    let dead = Network { drive: Drive::Force { node: 2, direction: [0.0, -1.0] }, ..truss() };
    let path = trace(&dead, &[10.0], &exact(Theory::Reissner), &mut |_| true).unwrap();
    let Status::NoEquilibriumBeyond { control } = path.status else { panic!("{}", path.status) };
    let limit = -roots::minimise(|d| -truss_force(d), 0.0, TRUSS.1, 1e-9).value;
    near(control, limit, 1e-7, "limit load");
}

#[test]
fn snap_back_of_a_truss_behind_a_soft_bar() {
    // A soft bar below the tip in series with the truss: Δ = d + F(d)/k turns back where F'(d) = −k.
    let soft = Section { young_pa: 1e4, thickness_m: 1e-3, depth_m: 1e-2, poisson: None };
    let length = 0.1;
    let stiffness = soft.axial_stiffness_n() / length;
    let mut network = truss();
    network.nodes.push(node([0.0, TRUSS.1 - length], VERTICAL_GUIDE));
    network.beams.push(rigid(2, 3, Shape::new(vec![-FRAC_PI_2], length).unwrap(), soft));
    network.drive = Drive::Displacement { node: 3, direction: [0.0, -1.0] };
    let path = trace(&network, &[1e-4, 1e-2], &exact(Theory::Reissner), &mut |_| true).unwrap();
    let Status::NoEquilibriumBeyond { control } = path.status else { panic!("{}", path.status) };
    let total = |d: f64| d + truss_force(d) / stiffness;
    near(control, -roots::minimise(|d| -total(d), 0.0, TRUSS.1, 1e-10).value, 1e-7, "limit displacement");
    let tip = -path.points[0].nodes[2].displacement_m[1];
    near(total(tip), 1e-4, 1e-9, "displacement");
    near(path.points[0].force, truss_force(tip), 1e-9, "force");
}

#[test]
fn reissner_tends_to_the_elastica_as_the_square_of_the_thickness() {
    let station = [0.007];
    let thick = solve(&table3_by_shapes(POM), &station, &elastica()).points[0].force;
    let error = |factor: f64| {
        let section = Section { thickness_m: factor * POM.thickness_m, depth_m: POM.depth_m / (factor * factor * factor), ..POM };
        solve(&table3_by_shapes(section), &station, &exact(Theory::Reissner)).points[0].force - thick
    };
    let (one, tenth, hundredth) = (error(1.0), error(0.1), error(0.01));
    near(one / tenth, 100.0, 0.05, "order");
    near(tenth / hundredth, 100.0, 0.001, "order");
    assert!(hundredth.abs() < 1e-6 * thick);
}

#[test]
fn drive_across_a_guide_is_projected() {
    let along = table3_by_shapes(POM);
    let (sin, cos) = maths::sin_cos(0.6);
    let oblique = Network { drive: Drive::Displacement { node: 4, direction: [sin, -cos] }, ..along.clone() };
    let a = solve(&along, &[0.01], &elastica());
    let b = solve(&oblique, &[0.01 * cos], &elastica());
    near(b.points[0].force, a.points[0].force / cos, 1e-12, "force");
    near(b.points[0].stiffness, a.points[0].stiffness / (cos * cos), 1e-9, "stiffness");
    near(b.points[0].nodes[4].displacement_m[1], -0.01, 1e-12, "displacement");
    let pushed = Network { drive: Drive::Force { node: 4, direction: [sin, -cos] }, ..along.clone() };
    let before_snap = solve(&along, &[0.006], &elastica());
    let c = solve(&pushed, &[before_snap.points[0].force / cos], &elastica());
    near(c.points[0].displacement, 0.006 * cos, 1e-9, "displacement by force");
    near(c.points[0].stiffness, before_snap.points[0].stiffness / (cos * cos), 1e-7, "stiffness by force");
}

#[test]
fn nodes_and_beam_ends_are_in_equilibrium() {
    let network = table3_by_shapes(POM);
    let path = solve(&network, &[0.0136], &exact(Theory::Reissner));
    let point = &path.points[0];
    let [one, two, three, four] = [0, 1, 2, 3].map(|i| &point.beams[i]);
    for axis in 0..2 {
        close(one.force_n[axis] + two.force_n[axis], three.force_n[axis], 1e-11, "forces at n3");
    }
    close(one.end_moment_nm + two.end_moment_nm, three.start_moment_nm, 1e-12, "moments at n3");
    close(three.end_moment_nm, four.start_moment_nm, 1e-12, "moments at n4");
    near(point.force, -four.force_n[1], 1e-12, "reaction");
    for (beam, state) in network.beams.iter().zip(&point.beams) {
        let (from, to) = (point.nodes[beam.start], point.nodes[beam.end]);
        close(state.start_rotation_rad, from.rotation_rad, 1e-15, "rotation");
        close(state.end_rotation_rad, to.rotation_rad, 1e-15, "rotation");
        let [left, right] = state.stress_pa(0.4);
        near(0.5 * (left + right), state.axial_force_n(0.4) / beam.section.area_m2(), 1e-11, "axial stress");
        let largest = (0..=1000).flat_map(|i| state.stress_pa(f64::from(i) * 1e-3)).fold(0.0_f64, |m, s| m.max(s.abs()));
        let peak = state.peak_stress();
        assert!(peak.stress_pa >= largest && peak.stress_pa < largest * 1.00001, "{} {largest}", peak.stress_pa);
        // The ends of the deformed axis are at the nodes, and M changes by the force times the lever.
        let (start, end, middle) = (state.shape_m(0.0), state.shape_m(1.0), state.shape_m(0.4));
        let want = common::add(network.nodes[beam.end].position_m, to.displacement_m, 1.0);
        close(end[0], want[0], 1e-13, "end");
        close(end[1], want[1], 1e-13, "end");
        let lever = [middle[0] - start[0], middle[1] - start[1]];
        let moment = state.start_moment_nm - (lever[0] * state.force_n[1] - lever[1] * state.force_n[0]);
        close(state.moment_nm(0.4), moment, 1e-11, "moment inside");
    }
}

#[test]
fn closed_polygon_of_rigid_joints_is_solved() {
    // A square frame pulled at opposite corners; by symmetry all sides carry the same moment at rest: stiffness of a quarter.
    let s = 0.05;
    let corners = [[0.0, -s], [s, 0.0], [0.0, s], [-s, 0.0]];
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        rigid(i, (i + 1) % 4, Shape::from_chord([b[0] - a[0], b[1] - a[1]], &[]).unwrap(), POM)
    };
    let network = common::network(
        corners.iter().enumerate().map(|(i, p)| node(*p, if i == 0 { Support::Clamped } else { Support::Free })).collect(),
        (0..4).map(side).collect(),
        Drive::Displacement { node: 2, direction: UP },
    );
    let path = solve(&network, &[0.0, 0.01], &elastica());
    // Each side is guided at both ends (corners keep their angle) and bent by P/(2√2) across it: P/δ = 2·12 EI/L³.
    let length = s * 2.0_f64.sqrt();
    near(path.points[0].stiffness, 24.0 * POM.bending_stiffness_n_m2() / (length * length * length), 1e-11, "stiffness at rest");
    let [left, right] = [path.points[1].nodes[3].displacement_m, path.points[1].nodes[1].displacement_m];
    close(left[0], -right[0], 1e-14, "symmetry");
    close(path.points[1].nodes[2].rotation_rad, 0.0, 1e-12, "symmetry");
    assert!((1.0..PI).contains(&(path.points[1].force / (0.01 * path.points[0].stiffness))));
}
