//! The paper's numbers beside ours. The printed ones are data (`reference/lan2010.toml`); ours are computed in the run.

mod beam_forces;
mod end_effector;

use forcewright_base::diagnostics::Span;
use forcewright_base::maths;
use forcewright_beam::Shape;
use forcewright_contract::family::Progress;
use forcewright_contract::project::{Choices, Project};
use forcewright_contract::read;
use forcewright_contract::reproduction::{Reproduction, ReproductionRow, rows};

use crate::analysis::{Behaviour, Measured, measure};
use crate::design::{self, Design};
use crate::force_curve::{ForceCurve, Interval};
use crate::spec::Spec;

use end_effector::EndEffector;

/// The papers of this family.
pub(crate) static ALL: &[Reproduction] =
    &[Reproduction { key: "lan2010", title: "Lan, Wang & Chen 2010: compliant constant-force mechanisms of Tables 3 and 4", run: lan2010 }];

const ROWS: &str = include_str!("../../../../../reference/lan2010.toml");
const SHAPES: &str = include_str!("../../../../../reference/lan2010-shapes.toml");
const NODES: &str = include_str!("../../../../../examples/compliant/lan-table3.toml");

/// The support of n5 in the shapes.
const GUIDED: &str = "support = \"slider\", direction = [0, 1]";

/// A design from a project text with settings; the texts are embedded and tested, so a failure gives rows that cannot agree.
fn design_of(text: &str, set: &[&str]) -> Option<Design> {
    let choices = Choices { variant: None, set: set.iter().map(|s| (*s).to_owned()).collect() };
    let project = Project::from_text("embedded", text, &choices);
    let mut diagnostics = project.diagnostics;
    let mut spec: Spec = read::read(&project.tree, Span::default(), &mut diagnostics);
    design::resolve(&mut spec, &mut diagnostics)
}

struct Solved {
    design: Design,
    behaviour: Behaviour,
    measured: Measured,
}

fn solve(text: &str, set: &[&str]) -> Option<Solved> {
    let design = design_of(text, set)?;
    let behaviour = Behaviour::of(&design, &mut |_| true).ok()?;
    let measured = measure(&design, &behaviour);
    Some(Solved { design, behaviour, measured })
}

impl Solved {
    fn get(&self, name: &str) -> f64 {
        self.measured.get(name).unwrap_or(f64::NAN)
    }

    fn force(&self, displacement_m: f64) -> f64 {
        self.behaviour.curve.as_ref().map_or(f64::NAN, |c| c.force(displacement_m))
    }

    /// Largest stress of one beam at the end of the path, Pa.
    fn beam_stress_at_end(&self, beam: usize) -> f64 {
        self.behaviour.path.points.last().and_then(|p| p.beams.get(beam)).map_or(f64::NAN, |b| b.peak_stress().stress_pa)
    }
}

/// Everything that several rows use, solved once.
struct Lan {
    shapes: Solved,
    nodes: Solved,
    /// The shapes beyond the paper's travel: local minimum, jump.
    longer: Solved,
    thin: Solved,
    scaled: Solved,
    turning: Solved,
    pinned: Solved,
    /// n5 free to move sideways, its angle held.
    sideways: Solved,
    /// Pairs of models beyond the paper's travel, w = 1 mm and 2 mm: inextensible is `longer` and `thick`.
    reissner: Solved,
    thick: Solved,
    thick_reissner: Solved,
    prototype: Solved,
    end_effector: EndEffector,
}

impl Lan {
    fn solve(progress: Progress<'_>) -> Option<Self> {
        let mut done = 0.0;
        let mut step = || {
            done += 1.0 / 13.0;
            progress(done)
        };
        let end_effector = EndEffector::solve().filter(|_| step())?;
        let mut run = |text: &str, set: &[&str]| solve(text, set).filter(|_| step());
        let inextensible = "model.beam=inextensible";
        let shapes = run(SHAPES, &[])?;
        let lengths = scaled_shapes(&shapes, 2.5);
        let mut scaled: Vec<&str> = vec!["design.thickness=1.3 mm", "design.depth=7 mm"];
        scaled.extend(lengths.iter().map(String::as_str));
        Some(Self {
            shapes,
            nodes: run(NODES, &[inextensible])?,
            longer: run(SHAPES, &["load.travel=17 mm"])?,
            thin: run(SHAPES, &["design.thickness=0.85 mm", "design.depth=16.28 mm", "load.travel=17 mm"])?,
            scaled: run(SHAPES, &scaled)?,
            turning: run(SHAPES, &["design.nodes.n5.rotation=free"])?,
            pinned: run(SHAPES, &["design.nodes.n1.support=pinned", "design.nodes.n2.support=pinned"])?,
            sideways: run(&SHAPES.replace(GUIDED, "support = \"parallel\""), &[])?,
            reissner: run(SHAPES, &["model.beam=reissner", "load.travel=17 mm"])?,
            thick: run(SHAPES, &["design.thickness=2 mm", "load.travel=17 mm"])?,
            thick_reissner: run(SHAPES, &["design.thickness=2 mm", "model.beam=reissner", "load.travel=17 mm"])?,
            prototype: run(SHAPES, &["design.thickness=0.85 mm", "load.travel=16 mm"])?,
            end_effector,
        })
    }

    /// The number of a row, in its unit.
    fn value(&self, id: &str) -> f64 {
        let (mm, mpa) = (1e3, 1e-6);
        let thin_end = self.thin.design.load_end.min(16.8e-3);
        let thin_start = || {
            // c of the paper's travel of 16.8 mm, on the path that goes on a little.
            let curve = self.thin.behaviour.curve.as_ref()?;
            let level = crate::analysis::RANGE_FRACTION * curve.force(thin_end);
            curve.crossings(level).into_iter().rfind(|x| *x < 0.999 * thin_end)
        };
        match id {
            "force_shapes" => self.shapes.get("force_at_end"),
            "force_nodes" => self.nodes.get("force_at_end"),
            "range_start" => mm * self.shapes.get("range_start"),
            "range_length" => mm * (self.shapes.design.load_end - self.shapes.get("range_start")),
            "range_ratio" => 100.0 * self.shapes.get("range_ratio"),
            "stress_max" => mpa * self.shapes.get("stress_max"),
            "stress_beam3" => mpa * self.shapes.beam_stress_at_end(2),
            "travel_at_allowable" => mm * self.shapes.get("travel_at_allowable_stress"),
            "sign_miss_printed" => mm * self.beam4_end(-1.0).0,
            "sign_miss_corrected" => mm * self.beam4_end(1.0).0,
            "sign_angle_printed" => self.beam4_end(-1.0).1.to_degrees(),
            "thin_travel" => mm * self.thin.get("travel_at_allowable_stress"),
            "thin_range_start" => mm * thin_start().unwrap_or(f64::NAN),
            "thin_range" => mm * (thin_end - thin_start().unwrap_or(f64::NAN)),
            "thin_stress_drop" => mpa * (stress_at(&self.longer, thin_end) - stress_at(&self.thin, thin_end)),
            "thin_range_ratio" => 100.0 * (1.0 - thin_start().unwrap_or(f64::NAN) / thin_end),
            "thin_depth" => 1.0 / (0.85 * 0.85 * 0.85),
            "thin_same" => 100.0 * (self.thin.force(TRAVEL_M) / self.longer.force(TRAVEL_M) - 1.0),
            "thin_force" => self.thin.force(thin_end),
            "box_beam_2" => mm * self.side_m(1, |[x, _]| LEFT_M + LX_M - x),
            "box_beam_4" => mm * self.side_m(3, |[x, _]| x - LEFT_M),
            "length_ratio" => self.nodes.get("length_ratio_max"),
            "invariance" => self.invariance(),
            "normalised_force" => normalised(&self.shapes),
            "objective" => self.shapes.force(8.8e-3) / self.shapes.force(4e-3) - 1.0,
            "local_max" => self.longer.get("force_local_max"),
            "local_max_at" => mm * self.longer.get("force_local_max_at"),
            "local_min" => self.longer.get("force_local_min"),
            "local_min_at" => mm * self.longer.get("force_local_min_at"),
            "jump_to" => mm * self.longer.behaviour.jump().and_then(|(_, to)| to).unwrap_or(f64::NAN),
            "least_stiffness" => 1e-2 * self.shapes.get("stiffness_min"),
            "slider_turns" => self.turning.get("force_at_end"),
            "ground_pinned" => self.pinned.get("force_at_end"),
            "n5_free_x" => self.sideways.get("force_at_end"),
            "reissner_force" => self.reissner.force(TRAVEL_M),
            "reissner_7" => softening(&self.reissner, &self.longer, 7e-3),
            "reissner_16_8" => softening(&self.reissner, &self.longer, 16.8e-3),
            "reissner_7_thick" => softening(&self.thick_reissner, &self.thick, 7e-3),
            "reissner_16_8_thick" => softening(&self.thick_reissner, &self.thick, 16.8e-3),
            "flat_2_5" => self.stroke(|c| c.longest_flat(0.025)),
            "flat_5" => self.stroke(|c| c.longest_flat(0.05)),
            "band_2_5" => self.stroke(|c| c.longest_within(0.975 * PRINTED_N, 1.025 * PRINTED_N)),
            "prototype_force" => self.prototype.force(14.5e-3),
            _ => match id.split_once('_') {
                Some(("t4", id)) => self.end_effector.value(id),
                Some(("v", id)) => beam_forces::value(&self.longer, self.shapes.get("range_start"), TRAVEL_M, id),
                _ => self.shape_value(id),
            },
        }
    }

    /// Least distance of the axis of a beam, by the printed nodes, to a side of the design box, m; negative outside.
    fn side_m(&self, beam: usize, distance_m: impl Fn([f64; 2]) -> f64) -> f64 {
        let network = &self.nodes.design.network;
        let beam = &network.beams[beam];
        let [x, y] = network.nodes[beam.start].position_m;
        let points = (0..=1024).map(|i| beam.shape.point_m(f64::from(i) / 1024.0));
        points.map(|p| distance_m([x + p[0], y + p[1]])).fold(f64::INFINITY, f64::min)
    }

    /// `length_1` … `angle_4`: shapes that follow from the printed nodes.
    fn shape_value(&self, id: &str) -> f64 {
        let Some((what, number)) = id.split_once('_') else { return f64::NAN };
        let beam = number.parse::<usize>().ok().and_then(|n| self.nodes.design.network.beams.get(n.checked_sub(1)?));
        match (what, beam) {
            ("length", Some(beam)) => 1e3 * beam.shape.length_m(),
            // The same direction in the turn that the paper prints.
            ("angle", Some(beam)) => {
                let angle = beam.shape.angle_rad()[0];
                let turn = std::f64::consts::TAU;
                if number == "3" && angle > 0.0 { angle - turn } else { angle }
            }
            _ => f64::NAN,
        }
    }

    /// An interval of the curve by the printed nodes over the travel, %.
    fn stroke(&self, interval: impl Fn(&ForceCurve) -> Option<Interval>) -> f64 {
        self.nodes.behaviour.curve.as_ref().and_then(interval).map_or(f64::NAN, |i| 100.0 * i.length() / TRAVEL_M)
    }

    /// How far beam 4 of Table 3, with c2 times `sign`, ends from n5, m, and the angle of its chord to the nodes' one, rad.
    fn beam4_end(&self, sign: f64) -> (f64, f64) {
        let nodes = &self.nodes.design.network.nodes;
        let (n4, n5) = (nodes[3].position_m, nodes[4].position_m);
        let wanted = [n5[0] - n4[0], n5[1] - n4[1]];
        let printed = &self.shapes.design.network.beams[3].shape;
        let mut angle = printed.angle_rad().to_vec();
        angle[2] *= sign;
        let Ok(shape) = Shape::new(angle, printed.length_m()) else { return (f64::NAN, f64::NAN) };
        let chord = shape.chord_m();
        let turn = maths::atan2(chord[1], chord[0]) - maths::atan2(wanted[1], wanted[0]);
        (maths::hypot(chord[0] - wanted[0], chord[1] - wanted[1]), turn.abs())
    }

    fn invariance(&self) -> f64 {
        normalised(&self.scaled) / normalised(&self.shapes) - 1.0
    }
}

/// Relative change of the force by stretching and shear, %.
fn softening(soft: &Solved, stiff: &Solved, displacement_m: f64) -> f64 {
    100.0 * (soft.force(displacement_m) / stiff.force(displacement_m) - 1.0)
}

/// The force that the paper prints for the end of the travel.
const PRINTED_N: f64 = 9.736;
/// Left side and width of the design box, and travel: Tables 1 and 2 of the paper.
const LEFT_M: f64 = 2.5e-3;
const LX_M: f64 = 3.2e-2;
const TRAVEL_M: f64 = 13.6e-3;

/// F·Lx²/EI with the distance of n1 and n2 for Lx, at the end of the path.
fn normalised(solved: &Solved) -> f64 {
    let nodes = &solved.design.network.nodes;
    // The paper's Lx = 3.2 cm spans from n1 to n2 in the printed design; here the scale of lengths is that of its depth of travel.
    let lx = LX_M * solved.design.load_end / TRAVEL_M;
    let ei = solved.design.network.beams.first().map_or(f64::NAN, |b| b.section.bending_stiffness_n_m2());
    debug_assert!(nodes.len() == 5);
    solved.get("force_at_end") * lx * lx / ei
}

fn stress_at(solved: &Solved, displacement_m: f64) -> f64 {
    solved.behaviour.path.at(displacement_m).ok().and_then(|p| p.peak_stress()).map_or(f64::NAN, |(_, s)| s.stress_pa)
}

/// Settings that scale every length of the printed shapes.
fn scaled_shapes(shapes: &Solved, scale: f64) -> Vec<String> {
    let network = &shapes.design.network;
    let beams = network.beams.iter().zip(&shapes.design.beam_names);
    let mut set: Vec<String> = beams.map(|(b, name)| format!("design.beams.{name}.length={:e} m", scale * b.shape.length_m())).collect();
    let [x, y] = network.nodes[0].position_m.map(|v| scale * v);
    set.push(format!("design.nodes.n1.at=[\"{x:e} m\", \"{y:e} m\"]"));
    set.push(format!("load.travel={:e} m", scale * shapes.design.load_end));
    set
}

fn lan2010(progress: Progress<'_>) -> Vec<ReproductionRow> {
    let lan = Lan::solve(progress);
    rows(ROWS, &mut |_| true, |id| lan.as_ref().map_or(f64::NAN, |lan| lan.value(id)))
}
