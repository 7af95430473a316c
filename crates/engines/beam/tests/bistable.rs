//! The curved beam of J. Qiu, J. H. Lang & A. H. Slocum, "A curved-beam bistable mechanism", J. Microelectromech. Syst. 13 (2004) 137–146,
//! clamped at both ends, in the shape of the first buckling mode, pushed in its middle.
//!
//! Their model is that of shallow arches: slopes small, the axial force constant. It is solved exactly here, mode by mode, and the engine
//! must agree in the limit of small rise h over span l; at a finite rise the difference is of order (h/l)².
//!
//! With amplitudes `A_j` of the modes `W_j` = 1 − cos `N_j` X (`N_j` = 2π, 6π, 10π, … are the symmetric modes that move the middle),
//! Δ = d/h, F = f l³/(EI h), axial force N² and Q = h/t:
//!
//! ```text
//! A_j (N_j² − N²) N_j²/2 = δ_1j N_1⁴/4 − 2 F,   Δ = 1 − 2 Σ A_j,   N² = 12 Q² (N_1²/16 − Σ A_j² N_j²/4)
//! ```

mod common;

use std::f64::consts::PI;

use common::{VERTICAL_GUIDE, close, elastic, near, network, node, rigid};
use forcewright_base::{maths, roots};
use forcewright_beam::{Drive, Network, Path, Section, Settings, Shape, Support, Theory, trace};

/// Modes that are summed; the rest falls off as the fifth power.
const MODES: i32 = 400;
const SPAN: f64 = 0.1;
const N1: f64 = 2.0 * PI;
const DOWN: [f64; 2] = [0.0, -1.0];

/// Number of waves of mode j of those that move the middle.
fn waves(j: i32) -> f64 {
    N1 * f64::from(2 * j + 1)
}

/// `A_j` at a force and an axial force.
fn amplitude(j: i32, force: f64, axial: f64) -> f64 {
    let n = waves(j);
    let rest = if j == 0 { 0.25 * N1 * N1 * N1 * N1 } else { 0.0 };
    2.0 * (rest - 2.0 * force) / (n * n * (n * n - axial))
}

fn displacement(force: f64, axial: f64) -> f64 {
    1.0 - 2.0 * (0..MODES).map(|j| amplitude(j, force, axial)).sum::<f64>()
}

/// The force at a displacement and an axial force: Δ is linear in it.
fn force_at(delta: f64, axial: f64) -> f64 {
    let (a, b) = (displacement(0.0, axial), displacement(1.0, axial));
    (delta - a) / (b - a)
}

/// What the change of length leaves of the axial force.
fn stretch_misfit(delta: f64, axial: f64, q: f64) -> f64 {
    let force = force_at(delta, axial);
    let shortening: f64 = (0..MODES).map(|j| maths::powi(amplitude(j, force, axial) * waves(j), 2)).sum::<f64>() * 0.25;
    12.0 * q * q * (N1 * N1 / 16.0 - shortening) - axial
}

/// Force on the path from rest that stays symmetric: the smallest axial force that fits.
fn symmetric(delta: f64, q: f64) -> f64 {
    // Between rest and the first pole of the amplitudes, or beyond it.
    let axial = roots::root(|n2| stretch_misfit(delta, n2, q), -40.0, 0.999 * N1 * N1, 1e-13)
        .or_else(|_| roots::root(|n2| stretch_misfit(delta, n2, q), 1.001 * N1 * N1, 0.999 * 36.0 * PI * PI, 1e-13))
        .expect("an axial force");
    force_at(delta, axial)
}

/// Displacements between which a mode with the given buckling load joins the symmetric path and leaves it.
fn range(axial: f64, q: f64) -> [f64; 2] {
    // A parabola in Δ; its top is inside.
    let misfit = |d: f64| stretch_misfit(d, axial, q);
    let (a, b, c) = (misfit(0.0), misfit(1.0), misfit(2.0));
    let top = 1.0 - 0.5 * (c - a) / (a - 2.0 * b + c);
    [top - 2.0, top + 2.0].map(|end| roots::root(misfit, top, end, 1e-13).expect("it is reached"))
}

/// Half the beam, or all of it, with slopes (π h/l) sin 2πX as a power series; `askew` adds a little of the second (whole) or third
/// (half) mode.
fn beam(rise: f64, q: f64, whole: bool, askew: f64) -> Network {
    let thickness = rise / q;
    let section: Section = elastic(2e9, thickness, 5e-3, None);
    let half = |sign: f64, start: usize| {
        // sin πu = cos π(u − ½), expanded at ½ and shifted to 0.
        let mut c = vec![0.0; 19];
        let mut term = sign * PI * rise / SPAN;
        for k in 0..=9 {
            c[2 * k] = term;
            term *= -PI * PI / ((2 * k + 1) as f64 * (2 * k + 2) as f64);
        }
        for first in 0..c.len() {
            for k in (first..c.len() - 1).rev() {
                c[k] -= 0.5 * c[k + 1];
            }
        }
        // A part with the symmetry of the second mode (of the whole) or of the third (in a half).
        let odd = if whole { [1.0, -1.0, 0.0] } else { [1.0, -3.0, 2.0] };
        for (c, part) in c[1..].iter_mut().zip(odd) {
            *c += askew * part * rise / SPAN;
        }
        rigid(start, start + 1, Shape::new(c, 0.5 * SPAN).expect("a shape"), section)
    };
    let mut beams = vec![half(1.0, 0)];
    let top = beams[0].shape.chord_m();
    let mut nodes = vec![node([0.0, 0.0], Support::Clamped), node(top, if whole { Support::Free } else { VERTICAL_GUIDE })];
    if whole {
        beams.push(half(-1.0, 1));
        nodes.push(node(common::add(top, beams[1].shape.chord_m(), 1.0), Support::Clamped));
    }
    network(nodes, beams, Drive::Displacement { node: 1, direction: DOWN })
}

/// Force of the whole beam, dimensionless.
fn dimensionless(force: f64, rise: f64, q: f64, whole: bool) -> f64 {
    let stiffness = elastic(2e9, rise / q, 5e-3, None).bending_stiffness_n_m2();
    let halves = if whole { 1.0 } else { 2.0 };
    halves * force * SPAN * SPAN * SPAN / (stiffness * rise)
}

fn pushed(network: &Network, rise: f64, deltas: &[f64]) -> Path {
    let stations: Vec<f64> = deltas.iter().map(|d| d * rise).collect();
    let settings = Settings { theory: Theory::Reissner, accuracy: 1e-9, ..Settings::default() };
    let path = trace(network, &stations, &settings, &mut |_| true).expect("a sound network");
    assert!(path.status.is_complete(), "{}", path.status);
    path
}

#[test]
fn the_model_is_that_of_the_paper() {
    // With the first mode alone, eq. (36): F = 3π⁴Q²/2 · Δ (Δ² − 3Δ + 2 + 4/(3Q²)). All modes change it little where Q is small.
    for (q, delta) in [(1.5, 0.4), (1.5, 1.2), (2.0, 0.1)] {
        let cubic = 1.5 * PI * PI * PI * PI * q * q * delta * (delta * delta - 3.0 * delta + 2.0 + 4.0 / (3.0 * q * q));
        near(symmetric(delta, q), cubic, 0.15, "eq. (36)");
    }
    // With the third mode, N² = 16π²: eq. (39), F = 8π⁴ − 6π⁴ Δ, without the higher modes, which do not move the place without force.
    let axial = 16.0 * PI * PI;
    let pi4 = PI * PI * PI * PI;
    for delta in [0.0, 0.7, 2.0] {
        close(force_at(delta, axial), 8.0 * pi4 - 6.0 * pi4 * delta, 0.12 * 8.0 * pi4, "eq. (39)");
    }
    near(displacement(0.0, axial), 4.0 / 3.0, 1e-12, "d_mid");
    // With them, and Q without limit, where the third mode joins and leaves: eqs. (43) and (44) print about 740 and 370 for these ends,
    // from fewer modes.
    let [top, bottom] = range(axial, 1e6);
    println!("third mode from {top}, F = {}, to {bottom}, F = {}", force_at(top, axial), force_at(bottom, axial));
    near(force_at(top, axial), 740.0, 0.03, "f_top");
    near(force_at(bottom, axial), -370.0, 0.04, "f_bot");
}

#[test]
fn low_beams_stay_symmetric_and_tend_to_the_model() {
    for q in [0.8, 1.2, 1.6] {
        let deltas = [0.2, 0.6, 1.0, 1.5, 2.1];
        let error = |rise: f64| {
            let path = pushed(&beam(rise, q, false, 0.0), rise, &deltas);
            let errors = path.points.iter().zip(deltas).map(|(p, d)| (dimensionless(p.force, rise, q, false) - symmetric(d, q)).abs());
            errors.fold(0.0, f64::max) / symmetric(0.2, q).abs().max(100.0)
        };
        let errors = [4e-3, 2e-3, 1e-3].map(error);
        println!("Q = {q}: {errors:?}");
        assert!(errors[0] < 2e-2, "{errors:?}");
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1] / 4.0 - 1.0).abs() < 0.1, "not of the second order: {errors:?}");
        }
    }
}

#[test]
fn modes_join_where_the_model_says() {
    // On the symmetric path a mode joins where the axial force is its buckling load: the third (N² = 16π²) if the middle cannot turn, the
    // second (N = 8.9868, tan N/2 = N/2) if it can.
    let second = 2.0 * roots::root(|x| maths::tan(x) - x, 4.4, 4.6, 1e-15).expect("4.4934");
    let q = 4.0;
    for (whole, axial) in [(false, 16.0 * PI * PI), (true, second * second)] {
        let joins = range(axial, q)[0];
        let error = |rise: f64| {
            let path = pushed(&beam(rise, q, whole, 0.0), rise, &[0.5, 1.0]);
            let first = path.bifurcations.first().expect("a mode joins");
            assert_eq!((first.before, first.after), (0, 1));
            let force = dimensionless(first.force, rise, q, whole);
            ((first.displacement / rise - joins).abs(), (force / force_at(joins, axial) - 1.0).abs())
        };
        let errors = [4e-3, 2e-3, 1e-3].map(error);
        println!("whole {whole}: joins at {joins}, F = {}: {errors:?}", force_at(joins, axial));
        assert!(errors[2].0 < 1e-3 && errors[2].1 < 1e-3, "{errors:?}");
        for pair in errors.windows(2) {
            assert!((pair[0].1 / pair[1].1 / 4.0 - 1.0).abs() < 0.15, "not of the second order: {errors:?}");
        }
    }
}

#[test]
fn high_beams_follow_the_joined_mode() {
    // A little askew, the beam leaves the symmetric path: with the third mode F falls in a straight line through 4/3 if the middle cannot
    // turn, and the mechanism is bistable; with the second, eq. (38), it is not.
    let second = 2.0 * roots::root(|x| maths::tan(x) - x, 4.4, 4.6, 1e-15).expect("4.4934");
    let (q, rise) = (6.0, 1e-3);
    for (whole, axial) in [(false, 16.0 * PI * PI), (true, second * second)] {
        // Away from where the mode joins and leaves: there a beam askew takes a short cut.
        let [from, to] = range(axial, q);
        let deltas: Vec<f64> = (0..7).map(|i| from + (0.3 + 0.08 * f64::from(i)) * (to - from)).collect();
        let followed = |askew: f64| {
            let path = pushed(&beam(rise, q, whole, askew), rise, &deltas);
            let forces: Vec<f64> = path.points.iter().map(|p| dimensionless(p.force, rise, q, whole)).collect();
            let gap = forces.iter().zip(&deltas).map(|(f, d)| (f - force_at(*d, axial)).abs()).fold(0.0, f64::max);
            (gap, forces, path)
        };
        let gaps = [4.0, 2.0, 1.0].map(|askew| followed(askew).0);
        println!("middle turns {whole}: {gaps:?}");
        assert!(gaps[2] < 0.03 * force_at(0.0, axial), "{gaps:?}");
        for pair in gaps.windows(2) {
            assert!((pair[0] / pair[1] - 2.0).abs() < 0.2, "not in proportion to the asymmetry: {gaps:?}");
        }
        let (_, forces, path) = followed(1.0);
        assert!(path.points.iter().all(|p| p.instability == 0));
        assert_eq!(forces.iter().any(|f| *f < 0.0), !whole, "bistable only if the middle cannot turn");
        // A thousandth of that: steps shrink where stability seems to change, and the path still turns with the mode.
        let (gap, _, path) = followed(1e-3);
        assert!(gap < 0.2 && path.points.iter().all(|p| p.instability == 0), "{gap}");
        // So little askew that even those lead across the gap between both paths: then the change of stability is reported.
        let (gap, _, path) = followed(1e-8);
        assert!(gap > 100.0 && path.bifurcations.first().is_some_and(|b| (b.before, b.after) == (0, 1)));
        assert!(path.points.iter().all(|p| p.instability > 0));
    }
}
