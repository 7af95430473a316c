//! Our side of the comparison with other tools; called by `benchmarks/peers/run.py`. Everything printed is JSON in SI units.
//!
//! ```text
//! peer_curve problem                                the mechanism, and converged curves of all beam models
//! peer_curve METHOD MODEL ACCURACY SAMPLES          forces, the time of a first call, and SAMPLES times of further calls
//! ```
//!
//! METHOD is `general` (`trace`), `fast` (one `CurveSolver` for all calls), `fast-new` (made anew for each), or `gradient` (`trace` and
//! the derivatives of all forces).
//!
//! METHOD `motion-reduced` or `motion-multibody` with MODEL `motion` is the cam in motion (`motion.rs`); ACCURACY then says nothing: both
//! are exact at every instant.
//!
//! MODEL is `inextensible`, `EA` (bending and stretching) or `EA+GA` (shear as well). The mechanism is the example project of
//! Lan, Wang & Chen 2010, Table 3; forces are those of the drawn half.
#![allow(clippy::print_stdout, reason = "its output is its purpose")]

mod motion;

use std::hint::black_box;
use std::time::Instant;

use forcewright::compliant::{Compliant, Design, Spec};
use forcewright::contract::family::Mechanism;
use forcewright::contract::project::Project;
use forcewright::contract::read;
use forcewright::{Choices, gallery};
use forcewright_beam::{CurveSolver, Network, Output, Parameter, Path, Settings, Theory, trace};
use serde_json::{Map, Value, json};

const MODELS: [&str; 3] = ["inextensible", "EA", "EA+GA"];
const STATIONS: u32 = 34;
/// Of the converged curves.
const CONVERGED: f64 = 1e-10;
/// A sample repeats the work until this much time has passed, so that the clock does not matter, s.
const SAMPLE_S: f64 = 0.02;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let result = match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["problem"] => problem(),
        [method, "motion", _, samples] => {
            let samples = samples.parse().map_err(|_| format!("{samples} is not a number of samples"))?;
            measure_motion(method, samples)?
        }
        [method, model, accuracy, samples] => {
            let accuracy = accuracy.parse().map_err(|_| format!("{accuracy} is not an accuracy"))?;
            let samples = samples.parse().map_err(|_| format!("{samples} is not a number of samples"))?;
            measure(method, &Case::new(model, accuracy)?, samples)?
        }
        _ => return Err("use: peer_curve problem | peer_curve general|fast|fast-new|gradient MODEL ACCURACY SAMPLES".into()),
    };
    println!("{result}");
    Ok(())
}

fn design() -> Design {
    let text = gallery::find("compliant/lan-table3").expect("in the gallery").text;
    let mut project = Project::from_text("lan-table3.toml", text, &Choices::default());
    let mut spec: Spec = read::read(&project.tree, project.root, &mut project.diagnostics);
    Compliant::resolve(&mut spec, &mut project.diagnostics).expect("the example is understood")
}

/// Equal steps that end at the travel, the last station; rest is not one of them.
fn stations(design: &Design) -> Vec<f64> {
    (1..=STATIONS).map(|i| design.load_end * f64::from(i) / f64::from(STATIONS)).collect()
}

/// What is solved, and how well.
struct Case {
    network: Network,
    stations: Vec<f64>,
    settings: Settings,
}

impl Case {
    fn new(model: &str, accuracy: f64) -> Result<Self, String> {
        let design = design();
        let stations = stations(&design);
        let mut network = design.network;
        let theory = if model == "inextensible" { Theory::Inextensible } else { Theory::Reissner };
        match model {
            "inextensible" | "EA+GA" => {}
            // Without Poisson's ratio a section is rigid in shear.
            "EA" => network.beams.iter_mut().for_each(|beam| beam.section.poisson = None),
            _ => return Err(format!("{model} is not one of {MODELS:?}")),
        }
        Ok(Self { network, stations, settings: Settings { theory, accuracy, ..Settings::default() } })
    }

    fn trace(&self) -> Path {
        trace(black_box(&self.network), &self.stations, &self.settings, &mut |_| true).expect("a network")
    }
}

fn forces(path: &Path) -> Vec<f64> {
    path.points.iter().map(|point| point.force).collect()
}

/// Nodes, beams, stiffnesses, stations, converged curves and gradients.
fn problem() -> Value {
    let design = design();
    let names = &design.node_names;
    let nodes: Map<String, Value> =
        names.iter().zip(&design.network.nodes).map(|(name, node)| (name.clone(), json!(node.position_m))).collect();
    let beam = |beam: &forcewright_beam::Beam| {
        json!({
            "start": names[beam.start], "end": names[beam.end],
            "angle_rad": beam.shape.angle_rad(), "length_m": beam.shape.length_m(),
        })
    };
    let section = design.network.beams[0].section;
    let motion = motion::Case::new();
    let mut converged: Map<String, Value> = MODELS
        .iter()
        .map(|&model| {
            let case = Case::new(model, CONVERGED).expect("a model");
            let path = case.trace();
            (model.to_owned(), json!({ "force_n": forces(&path), "jacobian": jacobian(&path, &case.network) }))
        })
        .collect();
    converged.insert("motion".into(), json!({ "force_n": motion.reduced() }));
    json!({
        "motion": motion.problem(),
        "nodes_m": nodes,
        "beams": design.network.beams.iter().map(beam).collect::<Vec<_>>(),
        "load_node": names[design.load_node], "direction": design.direction, "stations_m": stations(&design),
        "thickness_m": section.thickness_m,
        "bending_n_m2": section.bending_stiffness_n_m2(), "axial_n": section.axial_stiffness_n(), "shear_n": section.shear_stiffness_n(),
        "converged": converged,
    })
}

/// Derivatives of the force at every station by 13 parameters: both free nodes, all bends, the thickness of all beams; SI units.
fn jacobian(path: &Path, network: &Network) -> Vec<Vec<f64>> {
    let free = |node: usize| matches!(network.nodes[node].support, forcewright_beam::Support::Free);
    let nodes = (0..network.nodes.len()).filter(|&node| free(node));
    let mut parameters: Vec<Parameter> = nodes.flat_map(|node| [Parameter::NodeX(node), Parameter::NodeY(node)]).collect();
    parameters.extend((0..network.beams.len()).flat_map(|beam| [1, 2].map(|k| Parameter::Bend { beam, k })));
    parameters.push(Parameter::AllThickness);
    let mut gradients = path.gradients().expect("open beams");
    let row = |point| {
        let gradient = gradients.at(point, &[Output::Force]).expect("a regular point").swap_remove(0);
        parameters.iter().map(|&parameter| gradient.by(parameter).expect("of this network")).collect()
    };
    path.points.iter().map(row).collect()
}

fn measure(method: &str, case: &Case, samples: usize) -> Result<Value, String> {
    let fast = |solver: &mut CurveSolver| {
        solver.solve(black_box(&case.network), &case.stations, &case.settings).expect("a network").force_n.clone()
    };
    let mut solver = CurveSolver::new();
    let mut result = match method {
        "general" => timed(samples, || black_box(case.trace())),
        "fast" => timed(samples, || black_box(fast(&mut solver))),
        "fast-new" => timed(samples, || black_box(fast(&mut CurveSolver::new()))),
        "gradient" => timed(samples, || black_box(jacobian(&case.trace(), &case.network))),
        _ => return Err(format!("{method} is not one of general, fast, fast-new, gradient")),
    };
    let force_n = if method.starts_with("fast") { fast(&mut solver) } else { forces(&case.trace()) };
    result.insert("force_n".into(), json!(force_n));
    if method == "gradient" {
        result.insert("jacobian".into(), json!(jacobian(&case.trace(), &case.network)));
    }
    result.insert("version".into(), json!(concat!("forcewright ", env!("CARGO_PKG_VERSION"))));
    Ok(result.into())
}

fn measure_motion(method: &str, samples: usize) -> Result<Value, String> {
    let case = motion::Case::new();
    let work: fn(&motion::Case) -> Vec<f64> = match method {
        "motion-reduced" => motion::Case::reduced,
        "motion-multibody" => motion::Case::multibody,
        _ => return Err(format!("{method} is not one of motion-reduced, motion-multibody")),
    };
    let mut result = timed(samples, || black_box(work(black_box(&case))));
    result.insert("force_n".into(), json!(work(&case)));
    result.insert("version".into(), json!(concat!("forcewright ", env!("CARGO_PKG_VERSION"))));
    Ok(result.into())
}

/// Processor time and elapsed time of one call, s: of the first, and in samples of several.
fn timed<T>(samples: usize, mut work: impl FnMut() -> T) -> Map<String, Value> {
    let start = Instant::now();
    work();
    let first = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut calls = 0_u32;
    while samples > 0 && (calls == 0 || start.elapsed().as_secs_f64() < SAMPLE_S) {
        work();
        calls += 1;
    }
    let mut times = (Vec::new(), Vec::new());
    for _ in 0..samples {
        let (start, processor) = (Instant::now(), processor_s());
        for _ in 0..calls {
            work();
        }
        times.0.push((processor_s() - processor) / f64::from(calls));
        times.1.push(start.elapsed().as_secs_f64() / f64::from(calls));
    }
    [("first_s".into(), json!(first)), ("cpu_s".into(), json!(times.0)), ("wall_s".into(), json!(times.1))].into_iter().collect()
}

/// Processor time of this process, s.
#[cfg(unix)]
fn processor_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Not known without that clock: printed as `null`.
#[cfg(not(unix))]
fn processor_s() -> f64 {
    f64::NAN
}
