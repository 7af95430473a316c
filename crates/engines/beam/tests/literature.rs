//! Classical problems of large deflections and snapping. Where a published number has few digits, the digits are tested and an
//! independent formulation, shooting along the beams, gives the rest.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{VERTICAL_GUIDE, cantilever, close, elastica, near, node, rigid, solve};
use forcewright_base::{dense::Lu, maths, quadrature::GaussLegendre, roots};
use forcewright_beam::{Beam, Drive, Follow, Network, Path, Point, Section, Settings, Shape, Status, Support, Theory, trace};

/// EI = 1 N·m².
const UNIT: Section = Section { young_pa: 12e6, thickness_m: 1e-2, depth_m: 1.0, poisson: None };
const DOWN: [f64; 2] = [0.0, -1.0];

fn followed(network: &Network, stations: &[f64], theory: Theory) -> Path {
    let settings = Settings { theory, accuracy: 1e-8, follow: Follow::ToEnd, ..Settings::default() };
    let path = trace(network, stations, &settings, &mut |_| true).expect("a sound network");
    assert_eq!(path.whole_status, Status::Complete, "{:?}", path.folds);
    path
}

/// Rotation, moment, x and y of a section.
type State = [f64; 4];

/// Shooting along one beam through Reissner's equations, by the classical Runge–Kutta method with Richardson's extrapolation.
fn shoot(beam: &Beam, theory: Theory, force: [f64; 2], start: State) -> State {
    let (shape, section, length) = (&beam.shape, &beam.section, beam.shape.length_m());
    let soft = |stiffness: f64| if theory == Theory::Reissner { 1.0 / stiffness } else { 0.0 };
    let (axial, shear) = (soft(section.axial_stiffness_n()), soft(section.shear_stiffness_n()));
    let slope = |u: f64, y: State| {
        let (sin, cos) = maths::sin_cos(shape.angle_at(u) + y[0]);
        let (n, v) = (force[0] * cos + force[1] * sin, force[1] * cos - force[0] * sin);
        let (stretch, slide) = (1.0 + axial * n, shear * v);
        let bend = y[1] * length / section.bending_stiffness_n_m2();
        [bend, -length * (v + n * v * (axial - shear)), length * (stretch * cos - slide * sin), length * (stretch * sin + slide * cos)]
    };
    let after = |y: State, k: State, h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
    let integrate = |steps: u32| {
        let h = 1.0 / f64::from(steps);
        (0..steps).fold(start, |y, i| {
            let u = f64::from(i) * h;
            let a = slope(u, y);
            let b = slope(u + 0.5 * h, after(y, a, 0.5 * h));
            let c = slope(u + 0.5 * h, after(y, b, 0.5 * h));
            let d = slope(u + h, after(y, c, h));
            [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
        })
    };
    let (coarse, fine) = (integrate(200), integrate(400));
    [0, 1, 2, 3].map(|i| fine[i] + (fine[i] - coarse[i]) / 15.0)
}

/// A chain of beams from a ground node to another, loaded at one node, by shooting.
struct Chain<'a> {
    network: &'a Network,
    theory: Theory,
    /// Load on the driven node, if it is inside the chain.
    load: [f64; 2],
    /// Where the last node is.
    end: [f64; 2],
    /// Rotation of the last section; `None` if free.
    rotation: Option<f64>,
}

impl Chain<'_> {
    /// States at the ends of the beams for unknown H, V and start moment (or rotation, if pinned).
    fn states(&self, x: [f64; 3]) -> Vec<State> {
        let first = self.network.nodes[0];
        let [px, py] = first.position_m;
        let mut state = if first.support == Support::Pinned { [x[2], 0.0, px, py] } else { [0.0, x[2], px, py] };
        let mut force = [x[0], x[1]];
        let mut out = Vec::new();
        for (i, beam) in self.network.beams.iter().enumerate() {
            if i > 0 && beam.start == self.network.drive.node() {
                force = [force[0] - self.load[0], force[1] - self.load[1]];
            }
            state = shoot(beam, self.theory, force, state);
            out.push(state);
        }
        out
    }

    fn misfit(&self, x: [f64; 3]) -> [f64; 3] {
        let last = self.states(x)[self.network.beams.len() - 1];
        [last[2] - self.end[0], last[3] - self.end[1], self.rotation.map_or(last[1], |r| last[0] - r)]
    }

    /// Newton's method with central differences, from a guess made from a point of a path and wrong by a millionth: shooting amplifies it.
    fn solve(&self, point: &Point) -> ([f64; 3], Vec<State>) {
        let first = &point.beams[0];
        let pinned = self.network.nodes[0].support == Support::Pinned;
        let third = if pinned { first.start_rotation_rad } else { first.start_moment_nm };
        let mut x = [first.force_n[0], first.force_n[1], third].map(|v| 1.000_001 * v);
        let size = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let mut lu = Lu::new();
        for _ in 0..12 {
            let mut r = self.misfit(x);
            let mut jacobian = [0.0; 9];
            for column in 0..3 {
                let step = 1e-7 * size;
                let moved = |sign: f64| {
                    let mut y = x;
                    y[column] += sign * step;
                    self.misfit(y)
                };
                let (above, below) = (moved(1.0), moved(-1.0));
                for row in 0..3 {
                    jacobian[row * 3 + column] = (above[row] - below[row]) / (2.0 * step);
                }
            }
            lu.factor(3, 3, &jacobian).expect("regular");
            lu.solve(&mut r);
            x = [0, 1, 2].map(|i| x[i] - r[i]);
        }
        (x, self.states(x))
    }
}

/// ∫ f over [a, b], accurate to rounding for smooth integrands.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(20);
    let width = (b - a) / 60.0;
    (0..60).map(|i| width * rule.integrate(|u| f(a + (f64::from(i) + u) * width))).sum()
}

/// Clamped column with a dead load that is turned by ε from its axis, p = P L²/(E I): (angle of the tip from the line of the load,
/// place of the tip along that line, across it), length 1.
///
/// The pendulum: EI θ″ = −P sin ψ with ψ = ε at the clamp and ψ′ = 0 at the tip, in elliptic integrals. A. E. H. Love, "A Treatise on
/// the Mathematical Theory of Elasticity", §262–263.
fn column(p: f64, turned: f64) -> (f64, f64, f64) {
    let start = |k: f64| maths::asin(maths::sin(0.5 * turned) / k);
    let root = |k: f64, a: f64| (1.0 - k * k * maths::sin(a) * maths::sin(a)).sqrt();
    let load = |tip: f64| {
        let k = maths::sin(0.5 * tip);
        integral(start(k), FRAC_PI_2, |a| 1.0 / root(k, a))
    };
    let tip = roots::root(|tip| load(tip) - p.sqrt(), turned * 1.000_001, 3.0, 1e-15).expect("a sign change");
    let k = maths::sin(0.5 * tip);
    let along = 2.0 * integral(start(k), FRAC_PI_2, |a| root(k, a)) / p.sqrt() - 1.0;
    (tip, along, 2.0 * k * maths::cos(start(k)) / p.sqrt())
}

#[test]
fn post_buckling_of_a_column() {
    // S. P. Timoshenko & J. M. Gere, "Theory of Elastic Stability", table 2-4: at a tip angle of 60° the load is 1.152 times the
    // critical one, the tip is at 0.741 along and 0.593 across. That checks the oracle itself.
    let critical = 0.25 * PI * PI;
    let (tip, along, across) = column(1.152 * critical, 1e-9);
    assert!((tip * 180.0 / PI - 60.0).abs() < 0.2 && (along - 0.741).abs() < 2e-3 && (across - 0.593).abs() < 2e-3);

    for turned in [1e-2, 1e-4] {
        let (sin, cos) = maths::sin_cos(turned);
        let drive = Drive::Force { node: 1, direction: [-cos, sin] };
        let loads = [0.5, 0.95, 1.05, 1.5, 3.0].map(|f| f * critical);
        let path = solve(&cantilever(1.0, 0.0, UNIT, Support::Free, drive), &loads, &elastica());
        for (point, load) in path.points.iter().zip(loads) {
            let (tip, along, across) = column(load, turned);
            let n = point.nodes[1];
            let place = [1.0 + n.displacement_m[0], n.displacement_m[1]];
            // Next to the critical load the deflection is the imperfection magnified, and so is every error.
            close(n.rotation_rad + turned, tip, 1e-8, "angle");
            close(cos * place[0] - sin * place[1], along, 1e-8, "along");
            close(sin * place[0] + cos * place[1], across, 1e-8, "across");
            assert_eq!(point.instability, 0);
        }
        assert!(path.bifurcations.is_empty() && path.folds.is_empty());
    }
}

#[test]
fn williams_toggle() {
    // F. W. Williams, "An approach to the non-linear behaviour of the members of a rigid jointed plane framework with finite
    // deflections", Q. J. Mech. Appl. Math. 17 (1964): two bars 0.243 × 0.753 in, E = 1.03e7 psi (EA = 1.885e6 lb, EI = 9.27e3 lb in²),
    // half span 12.943 in, rise 0.386 in, clamped. Inches and pounds here. His curve is a figure, so the numbers come from shooting.
    let bar = Section { young_pa: 1.03e7, thickness_m: 0.243, depth_m: 0.753, poisson: None };
    near(bar.axial_stiffness_n(), 1.885e6, 1e-3, "EA");
    near(bar.bending_stiffness_n_m2(), 9.27e3, 1e-3, "EI");
    let shape = Shape::from_chord([12.943, 0.386], &[]).unwrap();
    let network = Network {
        nodes: vec![node([0.0, 0.0], Support::Clamped), node(shape.chord_m(), VERTICAL_GUIDE)],
        beams: vec![rigid(0, 1, shape, bar)],
        drive: Drive::Force { node: 1, direction: DOWN },
        before: Vec::new(),
    };
    let path = followed(&network, &[5.0, 10.0, 15.0, 30.0], Theory::Reissner);
    let chain = |point: &Point| {
        let end = [12.943, 0.386 - point.displacement];
        Chain { network: &network, theory: Theory::Reissner, load: [0.0; 2], end, rotation: Some(0.0) }.solve(point).0
    };
    for point in path.whole.iter().filter(|p| p.displacement > 0.01) {
        near(point.force, -chain(point)[1], 1e-7, "force");
    }
    // Both halves carry the load.
    let limits = path.folds.iter().map(|f| 2.0 * f.force).collect::<Vec<_>>();
    println!("limit loads of Williams' toggle, lb: {limits:?} at {:?}", path.folds.iter().map(|f| f.displacement).collect::<Vec<_>>());
    assert!(limits.len() == 2 && limits[0] > limits[1]);
    for fold in &path.folds {
        // Stationary by shooting as well.
        let point = &path.whole[fold.index];
        let force = |offset: f64| {
            let end = [12.943, 0.386 - point.displacement - offset];
            -Chain { network: &network, theory: Theory::Reissner, load: [0.0; 2], end, rotation: Some(0.0) }.solve(point).0[1]
        };
        let (h, here) = (1e-3, force(0.0));
        close((force(h) - force(-h)) / (2.0 * h), 0.0, 1e-3, "stiffness");
        near(here, fold.force, 1e-7, "limit load");
    }
}

/// Checks every state of a chain with a load inside against shooting.
fn agrees_with_shooting(network: &Network, path: &Path, direction: [f64; 2]) -> usize {
    let node = network.drive.node();
    let mut compared = 0;
    for point in path.whole.iter().filter(|p| p.control.abs() > 0.05 && p.displacement > 0.01) {
        // Next to a limit point the load does not determine the state.
        if path.folds.iter().any(|f| (f.displacement - point.displacement).abs() < 2e-2) {
            continue;
        }
        let end = network.nodes[network.nodes.len() - 1].position_m;
        let chain = Chain { network, theory: Theory::Inextensible, load: direction.map(|d| d * point.control), end, rotation: None };
        let (_, states) = chain.solve(point);
        let inside = network.beams.iter().position(|b| b.end == node).expect("a chain");
        let place = [0, 1].map(|i| states[inside][2 + i] - network.nodes[node].position_m[i]);
        close(place[0] * direction[0] + place[1] * direction[1], point.displacement, 1e-6, "displacement");
        compared += 1;
    }
    compared
}

#[test]
fn lees_frame() {
    // S.-L. Lee, F. S. Manuel, E. C. Rossow, "Large deflections and stability of elastic frames", J. Eng. Mech. Div. ASCE 94 (1968): an
    // L of two equal members, hinged to the ground, loaded at a fifth of the beam. Members of length 1, EI = 1.
    let piece = |start: usize, angle: f64, length: f64| rigid(start, start + 1, Shape::new(vec![angle], length).unwrap(), UNIT);
    let network = Network {
        nodes: vec![
            node([0.0, 0.0], Support::Pinned),
            node([0.0, 1.0], Support::Free),
            node([0.2, 1.0], Support::Free),
            node([1.0, 1.0], Support::Pinned),
        ],
        beams: vec![piece(0, FRAC_PI_2, 1.0), piece(1, 0.0, 0.2), piece(2, 0.0, 0.8)],
        drive: Drive::Force { node: 2, direction: DOWN },
        before: Vec::new(),
    };
    let path = followed(&network, &[10.0, 30.0], Theory::Inextensible);
    let limits: Vec<f64> = path.folds.iter().map(|f| f.control).collect();
    println!("limit loads of Lee's frame, EI/L²: {limits:?}");
    assert_eq!(limits.len(), 2);
    // Commonly given as 1.85 and −0.95 with EI/L² = 0.1.
    assert!((limits[0] - 18.55).abs() < 0.1 && (limits[1] + 9.5).abs() < 0.5, "{limits:?}");
    let compared = agrees_with_shooting(&network, &path, DOWN);
    assert!(compared > 20, "{compared}");
    let stable = path.whole.iter().filter(|p| p.branch != 1).all(|p| p.instability == 0);
    assert!(stable && path.jumps.len() == 1);
}

#[test]
fn deep_circular_arch() {
    // D. A. DaDeppo & R. Schmidt, "Instability of clamped-hinged circular arches subjected to a point load", J. Appl. Mech. 42 (1975): an
    // inextensible arch of 215° collapses under a crown load of 8.97 EI/R².
    let half = 107.5 * PI / 180.0;
    let arc = |start: usize, from: f64| rigid(start, start + 1, Shape::new(vec![from, -half], half).unwrap(), UNIT);
    let beams = vec![arc(0, half), arc(1, 0.0)];
    let crown = beams[0].shape.chord_m();
    let foot = beams[1].shape.chord_m();
    let network = Network {
        nodes: vec![
            node([0.0, 0.0], Support::Clamped),
            node(crown, Support::Free),
            node([crown[0] + foot[0], crown[1] + foot[1]], Support::Pinned),
        ],
        beams,
        drive: Drive::Force { node: 1, direction: DOWN },
        before: Vec::new(),
    };
    let settings = Settings { accuracy: 1e-7, ..elastica() };
    let stopped = trace(&network, &[4.0, 12.0], &settings, &mut |_| true).unwrap();
    let Status::NoEquilibriumBeyond { control } = stopped.status else { panic!("{}", stopped.status) };
    println!("collapse of the arch: {control}");
    close(control, 8.97, 0.01, "collapse load");
    let path = trace(&network, &[4.0, 12.0], &Settings { follow: Follow::ToEnd, ..settings }, &mut |_| true).unwrap();
    println!("{} {:?}", path.whole_status, path.folds.iter().map(|f| (f.control, f.displacement)).collect::<Vec<_>>());
    near(path.folds[0].control, control, 1e-7, "both ways to the limit");
    let compared = agrees_with_shooting(&network, &path, DOWN);
    assert!(compared > 10, "{compared}");
}

#[test]
fn a_clamped_and_pinned_beam_turned_by_a_moment() {
    // A curved beam clamped at one end and turned by 1 rad at its pinned end.
    let shape = Shape::from_chord([1.0, 0.1], &[0.8]).unwrap();
    let network = Network {
        nodes: vec![node([0.0, 0.0], Support::Clamped), node([1.0, 0.1], Support::Pinned)],
        beams: vec![rigid(0, 1, shape, Section { thickness_m: 0.06, ..UNIT })],
        drive: Drive::Rotation { node: 1 },
        before: Vec::new(),
    };
    let settings = Settings { follow: Follow::ToEnd, ..Settings::default() };
    let path = trace(&network, &[0.3, 0.6, 1.0], &settings, &mut |_| true).unwrap();
    assert_eq!(path.whole_status, Status::Complete);
    for point in path.whole.iter().filter(|p| p.control > 0.05) {
        let (theory, rotation) = (Theory::Reissner, Some(point.control));
        let chain = Chain { network: &network, theory, load: [0.0; 2], end: [1.0, 0.1], rotation };
        let (x, states) = chain.solve(point);
        close(states[0][1], point.force, 1e-7 * path.whole[path.whole.len() - 1].force, "moment");
        // Axial stress is a tenth of the stress that the accuracy is measured by.
        near(x[0], point.beams[0].force_n[0], 1e-6, "axial force");
    }
}

#[test]
fn accuracy_asked_is_accuracy_got_and_pieces_do_not_matter() {
    // The column bent to a tip angle beyond a right angle, whole and in pieces: spectral convergence in the degree, and none needed in
    // the length of the pieces.
    let (load, turned) = (2.0 * 0.25 * PI * PI, 0.1);
    let (sin, cos) = maths::sin_cos(turned);
    let want = column(load, turned).0 - turned;
    let tip = |pieces: usize, accuracy: f64| {
        let length = 1.0 / pieces as f64;
        let place = |i: usize| [i as f64 * length, 0.0];
        let support = |i: usize| if i == 0 { Support::Clamped } else { Support::Free };
        let network = Network {
            nodes: (0..=pieces).map(|i| node(place(i), support(i))).collect(),
            beams: (0..pieces).map(|i| rigid(i, i + 1, Shape::new(vec![0.0], length).unwrap(), UNIT)).collect(),
            drive: Drive::Force { node: pieces, direction: [-cos, sin] },
            before: Vec::new(),
        };
        let settings = Settings { theory: Theory::Inextensible, accuracy, ..Settings::default() };
        let path = trace(&network, &[load], &settings, &mut |_| true).unwrap();
        assert!(path.status.is_complete());
        ((path.points[0].nodes[pieces].rotation_rad - want).abs(), path.degree)
    };
    let mut before = 0;
    for accuracy in [1e-3, 1e-5, 1e-8, 1e-11] {
        let (error, degree) = tip(1, accuracy);
        println!("accuracy {accuracy:.0e}: error {error:.1e} at degree {degree}");
        assert!(error < 10.0 * accuracy.max(1e-13) && degree >= before);
        before = degree;
    }
    for pieces in [2, 3, 5] {
        let (error, degree) = tip(pieces, 1e-8);
        println!("{pieces} pieces: error {error:.1e} at degree {degree}");
        assert!(error < 1e-9);
    }
}
