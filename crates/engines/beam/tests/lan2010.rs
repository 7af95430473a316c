//! The designs of Lan, Wang & Chen, "A Compliant Constant-Force Mechanism for Adaptive Robot End-Effector Operations", ICRA 2010,
//! against an independent solution of the same equations by shooting with an order-8 Runge–Kutta method (DOP853) and by a spectral Ritz method, which
//! agree to 4e-13 in force. The paper prints three or four digits; where it does, they are named.

#![allow(clippy::unreadable_literal, reason = "reference values as stored")]

mod common;

use common::{POM, add, elastica, exact, near, solve, table3_by_nodes, table3_by_shapes};
use forcewright_base::roots;
use forcewright_beam::{Drive, Network, Path, Section, Settings, Shape, Status, Support, Theory, trace};

struct Reference {
    displacement_cm: f64,
    force_n: f64,
    stress_mpa: [f64; 4],
    beam_force_n: [[f64; 2]; 4],
}
/// Table 3 with the printed shapes: displacement, force of both halves, largest bending stress of each beam, and (H, V) of each beam as the
/// force of the part before a section on the part beyond it: opposite to the engine's sign.
const TABLE3: [Reference; 11] = [
    Reference {
        displacement_cm: 0.1,
        force_n: 2.709222169006,
        stress_mpa: [1.655871861191, 3.333826146814, 7.486017380603, 7.486017380603],
        beam_force_n: [
            [-1.489669557573, -0.9203853015151],
            [-0.8468017625843, 2.274996386018],
            [-2.336471320158, 1.354611084503],
            [-2.336471320158, 1.354611084503],
        ],
    },
    Reference {
        displacement_cm: 0.3,
        force_n: 6.277431696027,
        stress_mpa: [4.454377990011, 8.822726120853, 19.75942345467, 19.75942345467],
        beam_force_n: [
            [-3.731869865323, -2.211552731281],
            [-2.163195805099, 5.350268579294],
            [-5.895065670422, 3.138715848013],
            [-5.895065670422, 3.138715848013],
        ],
    },
    Reference {
        displacement_cm: 0.5,
        force_n: 8.251160948678,
        stress_mpa: [6.850095891495, 13.18061657967, 29.03518279878, 29.03518279877],
        beam_force_n: [
            [-5.252681319973, -2.980969868889],
            [-3.153431302821, 7.106550343228],
            [-8.406112622794, 4.125580474339],
            [-8.406112622794, 4.125580474339],
        ],
    },
    Reference {
        displacement_cm: 0.7,
        force_n: 9.257786796259,
        stress_mpa: [9.034716837115, 16.73053437459, 35.76024796969, 35.76548314434],
        beam_force_n: [
            [-6.240260387558, -3.378549858328],
            [-3.936052177566, 8.007443256458],
            [-10.17631256512, 4.62889339813],
            [-10.17631256512, 4.62889339813],
        ],
    },
    Reference {
        displacement_cm: 0.88,
        force_n: 9.653948928139,
        stress_mpa: [10.92131996099, 19.40176964397, 39.84985640874, 40.33584289746],
        beam_force_n: [
            [-6.757794993758, -3.485405884766],
            [-4.51798755933, 8.312380348835],
            [-11.27578255309, 4.82697446407],
            [-11.27578255309, 4.82697446407],
        ],
    },
    Reference {
        displacement_cm: 1.0,
        force_n: 9.751461334794,
        stress_mpa: [12.17686210045, 20.96156343481, 41.60610847623, 42.82826506811],
        beam_force_n: [
            [-6.928027102438, -3.440873212802],
            [-4.85775799861, 8.316603880198],
            [-11.78578510105, 4.875730667397],
            [-11.78578510105, 4.875730667397],
        ],
    },
    Reference {
        displacement_cm: 1.2,
        force_n: 9.759861617916,
        stress_mpa: [14.34813204393, 23.24581379145, 43.64916886067, 46.14561376966],
        beam_force_n: [
            [-6.916878834887, -3.173506728887],
            [-5.359241759909, 8.053437537845],
            [-12.2761205948, 4.879930808958],
            [-12.2761205948, 4.879930808958],
        ],
    },
    Reference {
        displacement_cm: 1.36,
        force_n: 9.734796446526,
        stress_mpa: [16.26056015363, 25.38909293115, 48.19278082842, 48.22289646455],
        beam_force_n: [
            [-6.643985533548, -2.787052573181],
            [-5.716871656565, 7.654450796444],
            [-12.36085719011, 4.867398223263],
            [-12.36085719011, 4.867398223263],
        ],
    },
    Reference {
        displacement_cm: 1.5,
        force_n: 9.76613576011,
        stress_mpa: [18.19451048946, 27.59483529819, 51.94557335645, 49.78282248804],
        beam_force_n: [
            [-6.206716447352, -2.31846127233],
            [-6.008325481674, 7.201529152385],
            [-12.21504192903, 4.883067880055],
            [-12.21504192903, 4.883067880055],
        ],
    },
    Reference {
        displacement_cm: 1.68,
        force_n: 9.979511609475,
        stress_mpa: [20.9631484545, 30.6074358336, 56.52379278894, 51.70387002362],
        beam_force_n: [
            [-5.355569875345, -1.524047333248],
            [-6.367293281649, 6.513803137985],
            [-11.72286315699, 4.989755804737],
            [-11.72286315699, 4.989755804737],
        ],
    },
    Reference {
        displacement_cm: 1.9,
        force_n: 10.68366800756,
        stress_mpa: [24.5193777013, 34.72933216431, 62.04223699838, 54.53679792832],
        beam_force_n: [
            [-3.831254220652, -0.2267235039884],
            [-6.808015512019, 5.568557507767],
            [-10.63926973267, 5.341834003778],
            [-10.63926973267, 5.341834003778],
        ],
    },
];
/// Table 4, eight legs: displacement in cm, force in N, stress of each beam in units of `1e6 Pa`.
const TABLE4: [(f64, f64, [f64; 3]); 7] = [
    (0.05, 3.718193560449, [12.51569640622, 12.51569640622, 10.09718018757]),
    (0.15, 7.487079715778, [32.14996168977, 32.14996168977, 26.76715887835]),
    (0.25, 8.471900757561, [46.35540744331, 46.35540744331, 39.33581550982]),
    (0.35, 8.323167754087, [56.28093842731, 56.28093842731, 48.18735806063]),
    (0.45, 8.250695618838, [62.47572287834, 62.47572287834, 53.46854019075]),
    (0.55, 9.267340321677, [65.14643702731, 65.14643702731, 55.81977972021]),
    (0.65, 12.25693787513, [64.25240699249, 64.25240699249, 59.5628620255]),
];

/// Displacements, cm, as stations.
fn metres(cm: impl IntoIterator<Item = f64>) -> Vec<f64> {
    cm.into_iter().map(|d| d * 1e-2).collect()
}

/// Force of both halves at a displacement in cm.
fn both_halves(path: &Path, cm: f64) -> f64 {
    2.0 * path.at(cm * 1e-2).expect("on the path").force
}

/// A local extremum of the force of both halves: displacement in cm and force in N. The independent solution finds the place by
/// comparing forces, so to half of its digits only. `sign` is 1 for a maximum.
fn extremum(path: &Path, from_cm: f64, to_cm: f64, sign: f64) -> (f64, f64) {
    let stiffness = |cm: f64| path.at(cm * 1e-2).expect("on the path").stiffness;
    let cm = roots::root(stiffness, from_cm, to_cm, 1e-12).expect("the stiffness changes its sign");
    let (here, beside) = (both_halves(path, cm), both_halves(path, cm + 0.05));
    assert!(sign * (here - beside) > 0.0);
    (cm, here)
}

#[test]
fn table3_forces_stresses_and_beam_forces() {
    let path = solve(&table3_by_shapes(POM), &metres(TABLE3.iter().map(|r| r.displacement_cm)), &elastica());
    for (point, want) in path.points.iter().zip(&TABLE3) {
        near(2.0 * point.force, want.force_n, 1e-11, "force");
        for (beam, state) in point.beams.iter().enumerate() {
            let peak = state.peak_stress();
            let next_to_the_end = peak.u < 1.0 && peak.u > 0.999;
            // At 1.5 cm the shear force of beam 1 changes its sign at u = 0.9997, so that its stress is 4e-7 higher there than at its
            // end, where the independent solution took it.
            let compared_pa = if next_to_the_end { state.stress_pa(1.0)[0].abs() } else { peak.stress_pa };
            assert!(!next_to_the_end || (state.shear_force_n(0.999) * state.shear_force_n(1.0) < 0.0 && peak.stress_pa > compared_pa));
            near(compared_pa, want.stress_mpa[beam] * 1e6, 1e-9, "stress");
            for axis in 0..2 {
                near(-state.force_n[axis], want.beam_force_n[beam][axis], 1e-9, "beam force");
            }
        }
    }
    let (beam, peak) = path.points[7].peak_stress().unwrap();
    assert_eq!(beam, 3);
    assert!((peak.u - 0.259_855_312_5).abs() < 1e-5, "{}", peak.u);
    // Printed: F(1.36 cm) = 9.736 N and 48.10 MPa.
    near(2.0 * path.points[7].force, 9.736, 2e-4, "printed force");
    near(peak.stress_pa, 48.10e6, 3e-3, "printed stress");
}

#[test]
fn table3_landmarks_of_the_curve() {
    let path = solve(&table3_by_shapes(POM), &metres([0.5, 1.0, 1.36, 1.6]), &elastica());
    let (d, f) = extremum(&path, 0.9, 1.2, 1.0);
    near(d, 1.101_139_176_026, 1e-7, "place of the maximum");
    near(f, 9.770_908_902_529, 1e-12, "maximum");
    let (d, f) = extremum(&path, 1.2, 1.5, -1.0);
    near(d, 1.372_138_443_379, 1e-7, "place of the minimum");
    near(f, 9.734_586_159_704, 1e-12, "minimum");
    let preload = roots::root(|d| both_halves(&path, d) / 9.734_796_446_526 - 0.95, 0.5, 0.9, 1e-13).unwrap();
    near(preload, 0.697_081_543_859_3, 1e-11, "c, printed 0.70");
    let least = roots::minimise(|d| path.at(d * 1e-2).unwrap().stiffness, 1.15, 1.3, 1e-7);
    near(least.x, 1.235_86, 1e-5, "place of the least stiffness");
    near(2.0 * least.value / 100.0, -0.200_908, 3e-6, "least stiffness");
    // The independent value at rest is the secant to 1e-4 cm.
    near(both_halves(&path, 1e-4) / 1e-4, 31.140_665, 1e-7, "stiffness next to rest");
    near(both_halves(&path, 0.4), 7.416_388_663_981, 1e-11, "F(b)");
    let stress = |cm: f64| path.at(cm * 1e-2).unwrap().peak_stress().unwrap().1.stress_pa;
    let allowed = roots::root(|d| stress(d) - 76e6 / 1.58, 1.2, 1.5, 1e-12).unwrap();
    near(allowed, 1.349_753_336_444, 1e-8, "displacement at the allowed stress");
    // Eq. (6): F L²/EI of both halves at Δ/L_y = 0.34, with L_x = 3.2 cm.
    near(both_halves(&path, 1.36) * 0.032 * 0.032 / POM.bending_stiffness_n_m2(), 5.981_058_94, 1e-8, "invariant of eq. (6)");
}

#[test]
fn table3_with_nodes_given() {
    let network = table3_by_nodes(POM);
    let want = [
        (0.459_048_941_527_3, 3.403_778_949_834),
        (1.638_314_227_394, 1.986_624_206_217),
        (-4.080_807_385_905, 2.199_043_405_713),
        (2.393_524_714_408, 1.959_041_139_838),
    ];
    for (beam, (angle, length)) in network.beams.iter().zip(want) {
        let turns = (beam.shape.angle_at(0.0) - angle) / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-12);
        near(beam.shape.length_m(), length * 1e-2, 1e-12, "length");
    }
    let path = solve(&network, &metres([0.6, 1.2, 1.36, 1.5]), &elastica());
    near(2.0 * path.points[2].force, 9.739_693_156_99, 1e-11, "force");
    let (d, f) = extremum(&path, 0.9, 1.2, 1.0);
    near(d, 1.103_507_185_97, 1e-7, "place of the maximum");
    near(f, 9.774_129_063_92, 1e-11, "maximum");
    let (d, f) = extremum(&path, 1.2, 1.49, -1.0);
    near(d, 1.370_192_798_059, 1e-7, "place of the minimum");
    near(f, 9.739_546_711_775, 1e-12, "minimum");
    near(path.points[2].peak_stress().unwrap().1.stress_pa, 48.218_740_803_83e6, 1e-9, "stress");
    let preload = roots::root(|d| both_halves(&path, d) / 9.739_693_156_99 - 0.95, 0.5, 0.9, 1e-13).unwrap();
    near(preload, 0.698_374_887_727_5, 1e-10, "c");
}

#[test]
fn thin_and_deep_variant() {
    let section = Section { thickness_m: 0.85e-3, depth_m: 16.28e-3, ..POM };
    let path = solve(&table3_by_shapes(section), &metres([0.8, 1.68, 1.7]), &elastica());
    near(2.0 * path.points[1].force, 9.977_470_799_351, 1e-11, "force at 1.68 cm");
    let preload = roots::root(|d| both_halves(&path, d) / 9.977_470_799_351 - 0.95, 0.5, 0.9, 1e-13).unwrap();
    near(preload, 0.780_368_377_797_9, 1e-10, "c, printed 0.788");
    let stress = |cm: f64| path.at(cm * 1e-2).unwrap().peak_stress().unwrap().1.stress_pa;
    let allowed = roots::root(|d| stress(d) - 76e6 / 1.58, 1.5, 1.7, 1e-12).unwrap();
    near(allowed, 1.682_646_450_762, 1e-8, "displacement at the allowed stress, printed 1.68");
}

#[test]
fn with_stretching_and_shear() {
    let path = solve(&table3_by_shapes(POM), &metres([0.7, 1.36, 1.68]), &exact(Theory::Reissner));
    for (point, want) in path.points.iter().zip([9.172_182_400_764, 9.740_892_497_742, 10.016_156_742_84]) {
        near(2.0 * point.force, want, 1e-11, "force");
    }
}

#[test]
fn table4_chain() {
    let section = Section { thickness_m: 0.4e-3, depth_m: 6e-3, ..POM };
    let coefficients = [[1.6401, 0.9920, -1.5706], [3.2380, -0.8791, 0.7358], [2.4429, -1.1268, 0.2199]];
    let shapes: Vec<Shape> =
        coefficients.iter().zip([0.360, 0.849, 0.407]).map(|(c, l)| Shape::new(c.to_vec(), l * 1e-2).unwrap()).collect();
    let n4 = [0.0, 1e-2];
    let n3 = add(n4, shapes[2].chord_m(), -1.0);
    let n2 = add(n3, shapes[1].chord_m(), -1.0);
    let n1 = add(n2, shapes[0].chord_m(), -1.0);
    near(n1[0], 1.004_613_342_296e-2, 1e-12, "n1 x");
    let beams = shapes.into_iter().enumerate().map(|(i, s)| common::rigid(i, i + 1, s, section)).collect();
    let network = common::network(
        vec![
            common::node(n1, Support::Clamped),
            common::node(n2, Support::Free),
            common::node(n3, Support::Free),
            common::node(n4, common::VERTICAL_GUIDE),
        ],
        beams,
        Drive::Displacement { node: 3, direction: [0.0, -1.0] },
    );
    let path = solve(&network, &metres(TABLE4.iter().map(|r| r.0)), &elastica());
    for (point, (_, force, stress)) in path.points.iter().zip(&TABLE4) {
        near(8.0 * point.force, *force, 1e-11, "force");
        for (state, want) in point.beams.iter().zip(stress) {
            near(state.peak_stress().stress_pa, want * 1e6, 1e-9, "stress");
        }
    }
}

#[test]
fn a_dead_load_snaps_at_the_local_maximum() {
    let network = Network { drive: Drive::Force { node: 4, direction: [0.0, -1.0] }, ..table3_by_shapes(POM) };
    let path = trace(&network, &[2.0, 4.0, 4.88, 6.0], &elastica(), &mut |_| true).unwrap();
    assert_eq!(path.points.len(), 3);
    let Status::NoEquilibriumBeyond { control } = path.status else { panic!("{}", path.status) };
    near(control, 0.5 * 9.770_908_902_529, 1e-8, "limit load of one half");
}

#[test]
fn work_for_table3() {
    // A slower algorithm fails here without a clock: one or two iterations for each of 137 stations, and few for the comparison.
    let stations: Vec<f64> = (0..137).map(|i| f64::from(i) * 1e-4).collect();
    let path = solve(&table3_by_shapes(POM), &stations, &Settings { accuracy: 1e-8, ..elastica() });
    assert_eq!((path.degree, path.counters.rejected_steps), (16, 0));
    assert!(path.counters.newton_iterations <= 200 && path.counters.steps <= 165, "{:?}", path.counters);
}

#[test]
#[ignore = "a clock, run by hand in release"]
fn time_of_table3() {
    let network = table3_by_shapes(POM);
    let stations: Vec<f64> = (0..137).map(|i| f64::from(i) * 1e-4).collect();
    for accuracy in [1e-8, 1e-5] {
        for theory in [Theory::Inextensible, Theory::Reissner] {
            let settings = Settings { accuracy, theory, ..Default::default() };
            let start = std::time::Instant::now();
            for _ in 0..20 {
                let path = trace(&network, &stations, &settings, &mut |_| true).unwrap();
                assert!(path.status.is_complete());
            }
            let path = trace(&network, &stations, &settings, &mut |_| true).unwrap();
            println!(
                "{accuracy:.0e} {theory:?}: {:?} each, degree {}, estimate {:?}, {:?}",
                start.elapsed() / 20,
                path.degree,
                path.error_estimate,
                path.counters
            );
        }
    }
}
