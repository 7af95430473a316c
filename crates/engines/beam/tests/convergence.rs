//! How fast results converge: in the degree of the polynomials, in the length of the pieces, and towards the theories of less detail.

mod common;

use std::f64::consts::{FRAC_PI_2, PI};

use common::{POM, VERTICAL_GUIDE, cantilever, elastic, elastica, exact, near, network, node, rigid, solve, table3_by_shapes};
use forcewright_base::maths;
use forcewright_beam::{Drive, Network, Section, Settings, Shape, Support, Theory, trace};

const UP: [f64; 2] = [0.0, 1.0];

/// The part [a, b] of a shape: the polynomial of its angle, shifted and scaled (exact but for rounding).
fn part(shape: &Shape, a: f64, b: f64) -> Shape {
    let c = shape.angle_rad();
    let mut shifted = c.to_vec();
    for first in 0..c.len() {
        for k in (first..c.len() - 1).rev() {
            shifted[k] += a * shifted[k + 1];
        }
    }
    let mut scale = 1.0;
    for value in &mut shifted {
        *value *= scale;
        scale *= b - a;
    }
    Shape::new(shifted, shape.length_m() * (b - a)).expect("a part of a shape")
}

/// A beam of a given shape in pieces, clamped at one end and pushed along a guide at the other.
fn in_pieces(whole: &Shape, pieces: usize) -> Network {
    let mut nodes = vec![node([0.0, 0.0], Support::Clamped)];
    let mut beams = Vec::new();
    for i in 0..pieces {
        let shape = part(whole, i as f64 / pieces as f64, (i + 1) as f64 / pieces as f64);
        let to = common::add(nodes[i].position_m, shape.chord_m(), 1.0);
        nodes.push(node(to, if i + 1 == pieces { VERTICAL_GUIDE } else { Support::Free }));
        beams.push(rigid(i, i + 1, shape, POM));
    }
    network(nodes, beams, Drive::Displacement { node: pieces, direction: UP })
}

/// A beam that winds to and fro.
fn winding(pieces: usize) -> Network {
    in_pieces(&Shape::new(vec![0.3, 14.0, -42.0, 28.0], 0.1).expect("a shape"), pieces)
}

/// An arc of three turns.
fn spiral(pieces: usize) -> Network {
    in_pieces(&Shape::new(vec![0.3, 20.0], 0.1).expect("a shape"), pieces)
}

/// Force and degree at a given accuracy.
fn force(network: &Network, station: f64, theory: Theory, accuracy: f64) -> (f64, usize) {
    let settings = Settings { accuracy, ..exact(theory) };
    let path = trace(network, &[station], &settings, &mut |_| true).expect("a sound network");
    (path.points[0].force, path.degree)
}

#[test]
fn pieces_converge_with_twice_the_degree() {
    // A Ritz method with angles of degree p: slopes are wrong by h^p, energy and force by its square, h^2p (G. Strang & G. Fix, "An
    // Analysis of the Finite Element Method", theorem 3.7). An accuracy that is always met keeps the degree at 9: 18 orders for short
    // pieces, fewer while a piece makes half a turn. Without the square there would be 9 or 10.
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let (want, _) = force(&spiral(16), 4e-3, theory, 1e-13);
        let error = |pieces: usize| {
            let (got, degree) = force(&spiral(pieces), 4e-3, theory, 0.9);
            assert_eq!(degree, 9);
            (got / want - 1.0).abs()
        };
        let order = |pieces: usize| maths::ln(error(pieces) / error(2 * pieces)) / maths::ln(2.0);
        let orders = [2, 3, 4].map(order);
        println!("{theory:?}: orders from 2, 3, 4 pieces to twice as many {orders:.1?}; errors {:.1e} to {:.1e}", error(2), error(8));
        assert!(orders[0] > 11.0 && orders[1] > 15.0 && orders[2] > 15.0 && orders.iter().all(|o| *o < 18.5), "{orders:?}");
        assert!(error(6) < 1e-9);
    }
}

#[test]
fn the_degree_converges_exponentially() {
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let (want, _) = force(&winding(4), 4e-3, theory, 1e-13);
        let mut errors: Vec<(usize, f64)> = Vec::new();
        for accuracy in [0.9, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12] {
            let (got, degree) = force(&winding(1), 4e-3, theory, accuracy);
            let error = (got / want - 1.0).abs();
            if errors.last().is_none_or(|e| e.0 < degree) {
                errors.push((degree, error));
            }
        }
        println!("{theory:?}: degree and error {errors:?}");
        // Each further degree divides the error by four at least, until rounding; algebraic convergence would slow down.
        assert!(errors.len() >= 4 && errors[0].0 == 9 && errors[0].1 < 1e-5);
        let mut last = 0.0;
        for pair in errors.windows(2).filter(|pair| pair[1].1 > 1e-14) {
            let rate = maths::ln(pair[0].1 / pair[1].1) / (pair[1].0 - pair[0].0) as f64;
            assert!(rate > maths::ln(4.0) && rate > 0.95 * last, "{rate}");
            last = rate;
        }
        assert!(last > 0.0 && errors[errors.len() - 1].1 < 1e-14);
    }
}

#[test]
fn pieces_do_not_matter_where_the_degree_suffices() {
    for theory in [Theory::Inextensible, Theory::Reissner] {
        let (want, _) = force(&winding(1), 4e-3, theory, 1e-11);
        for pieces in [2, 3, 4, 7] {
            let (got, degree) = force(&winding(pieces), 4e-3, theory, 1e-10);
            println!("{theory:?} {pieces} pieces: {:.1e} at degree {degree}", got / want - 1.0);
            near(got, want, 1e-10, "force in pieces");
        }
    }
}

/// Slopes of log difference by log softness for thicknesses that shrink by half, the bending stiffness kept.
fn slopes(difference: impl Fn(Section) -> f64, poisson: Option<f64>) -> Vec<f64> {
    let at = |i: i32| {
        let factor = maths::powi(0.5, i);
        let depth = POM.depth_m / (factor * factor * factor);
        difference(elastic(POM.young_pa, factor * POM.thickness_m, depth, poisson)).abs()
    };
    // EI/(EA L²) and EI/(kGA L²) are both proportional to the square of the thickness.
    (0..5).map(|i| maths::ln(at(i) / at(i + 1)) / maths::ln(4.0)).collect()
}

#[test]
fn stretching_and_shear_vanish_in_proportion_to_their_softness() {
    let station = [7e-3];
    let force = |section: Section, theory: Theory| solve(&table3_by_shapes(section), &station, &exact(theory)).points[0].force;
    let bending = force(POM, Theory::Inextensible);
    let stretching = slopes(|s| force(s, Theory::Reissner) - bending, None);
    let both = slopes(|s| force(s, Theory::Reissner) - bending, Some(0.35));
    let shear =
        slopes(|s| force(s, Theory::Reissner) - force(elastic(s.young_pa, s.thickness_m, s.depth_m, None), Theory::Reissner), Some(0.35));
    println!("slopes: stretching {stretching:.4?}, shear {shear:.4?}, both {both:.4?}");
    for slopes in [stretching, shear, both] {
        assert!(slopes.iter().all(|s| (s - 1.0).abs() < 0.02) && (slopes[4] - 1.0).abs() < 1e-3, "{slopes:?}");
    }
}

/// Stiffness at rest of the free end of a network of one beam.
fn rest(network: &Network, theory: Theory) -> f64 {
    solve(network, &[0.0, 1e-6], &exact(theory)).points[0].stiffness
}

#[test]
fn small_loads_on_a_cantilever_give_timoshenko() {
    // `timoshenko1921`: bending 3 EI/L³ and shear kGA/L are springs in series. The shorter the beam, the more shear counts.
    for length in [0.1, 0.01, 3e-3, 1e-3] {
        let across =
            cantilever(length, 0.4, POM, Support::Free, Drive::Displacement { node: 1, direction: [-maths::sin(0.4), maths::cos(0.4)] });
        let (bending, shear) = (3.0 * POM.bending_stiffness_n_m2() / (length * length * length), POM.shear_stiffness_n() / length);
        near(rest(&across, Theory::Reissner), 1.0 / (1.0 / bending + 1.0 / shear), 1e-11, "Timoshenko");
        near(rest(&across, Theory::Inextensible), bending, 1e-11, "Euler and Bernoulli");
    }
}

#[test]
fn small_loads_on_a_curved_bar_give_castigliano() {
    // A quarter circle clamped at the origin, tangent to x, with its end at (R, R): ∫ (M m/EI + N n/EA + Q q/kGA) ds over it.
    let radius = 0.02;
    let shape = Shape::new(vec![0.0, FRAC_PI_2], FRAC_PI_2 * radius).expect("a quarter");
    let bar = |drive: Drive| {
        let nodes = vec![node([0.0, 0.0], Support::Clamped), node(shape.chord_m(), Support::Free)];
        network(nodes, vec![rigid(0, 1, shape.clone(), POM)], drive)
    };
    let ei = POM.bending_stiffness_n_m2();
    let direct = 0.25 * PI * radius * (1.0 / POM.axial_stiffness_n() + 1.0 / POM.shear_stiffness_n());
    let cube = radius * radius * radius / ei;
    // M = P R (1 − sin a) under a force across the clamp, P R cos a under one along it, constant under a moment.
    for (direction, bending) in [([0.0, 1.0], cube * (0.75 * PI - 2.0)), ([1.0, 0.0], cube * 0.25 * PI)] {
        let drive = Drive::Displacement { node: 1, direction };
        near(rest(&bar(drive), Theory::Inextensible), 1.0 / bending, 1e-11, "bending");
        near(rest(&bar(drive), Theory::Reissner), 1.0 / (bending + direct), 1e-11, "with stretching and shear");
    }
    near(rest(&bar(Drive::Rotation { node: 1 }), Theory::Reissner), ei / (FRAC_PI_2 * radius), 1e-11, "moment");
    // The end also moves across a force: ∫ (1 − sin a) cos a = 1/2, and of N n + Q q: sin cos (1/EA − 1/kGA), with ∫ sin cos = 1/2.
    let load = 1e-6;
    let path = solve(&bar(Drive::Force { node: 1, direction: UP }), &[load], &elastica());
    near(path.points[0].nodes[1].displacement_m[0], -0.5 * cube * load, 1e-6, "across");
}
