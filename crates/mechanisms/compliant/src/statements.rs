//! What a report says in words: model, limits, sources, warnings.

use std::fmt::Write as _;

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::{Beam, Drive, Joints, Theory};
use forcewright_model::{Citation, Statement, Warning};

use crate::analysis::{Behaviour, Measured, curvature_ratio, inner_face_factor};
use crate::bodies::Body;
use crate::crossing::first_crossing;
use crate::design::Design;
use crate::loads::Control;
use crate::room::gap_around_m;

/// Length over thickness below which beam theory is doubtful.
const SLENDER: f64 = 10.0;
/// Thickness times curvature above which the stress at the inner face is noticeably more than that of a straight beam.
const CURVED: f64 = 0.1;

fn statement(title: &str, text: impl Into<String>) -> Statement {
    Statement { title: title.to_owned(), text: text.into() }
}

/// Which equations were solved and how.
pub(crate) fn model(design: &Design) -> Vec<Statement> {
    let beams = match design.theory {
        Theory::Inextensible => statement(
            "Inextensible beams",
            "Every beam bends without stretching or shearing (elastica with an intrinsic angle). This is the model of Lan, Wang & Chen, with M = (EI/L)·d(ψ − η)/du.",
        ),
        Theory::Reissner => statement(
            "Geometrically exact beams",
            "Bending, stretching and shear without limit on rotation (Reissner 1972). As the axial and shear stiffness grow it becomes the paper's inextensible model, `model.beam = \"inextensible\"`.",
        ),
    };
    let copies = copies(design);
    let mut all = vec![
        beams,
        statement("Network", format!("{} {}{copies}", joints(design), bodies(design))),
        statement("Loads", loads(design)),
        statement(
            "Solution",
            "Rotations in integrated Legendre polynomials, forces as multipliers, Newton's method. The path starts at rest and is followed in displacement with adaptive steps; it never starts from another design's solution. Polynomial degree grows until forces and stresses of two degrees agree.",
        ),
        statement(
            "Stress",
            "Bending and, in the geometrically exact model, axial stress, on both faces, over the whole length; the largest over the travel.",
        ),
        statement("Material data", material_data(design)),
    ];
    all.extend(crate::scenario::model(design));
    all.extend(crate::scenario::lateral::model(design));
    all
}

/// What stands beside the drawn network, and what that does to the results.
fn copies(design: &Design) -> String {
    let layout = &design.layout;
    if !layout.repeats() {
        return if layout.mirror.is_some() {
            "The drawn network is solved; its mirrored half moves alike, and force, energy and stiffness count both.".to_owned()
        } else {
            "The drawn network is the whole mechanism.".to_owned()
        };
    }
    let mut text = format!(
        "The drawn network is solved; the mechanism is that network{}. All copies move alike. The force is {} times that of the drawn network",
        layout.words(),
        layout.copies()
    );
    if layout.layers > 1 {
        let _ = write!(text, ", the displacement {} times its displacement", layout.layers);
    }
    text.push('.');
    text
}

/// How beams meet.
fn joints(design: &Design) -> &'static str {
    match design.joints {
        Joints::Point => "Beams meet at points; rigid joints keep the angles between beams.",
        Joints::Overlap => {
            "Where beams of finite thickness meet in a rigid joint, each is rigid as far as it lies inside another one, up to the corner of their inner faces; rigid joints keep the angles between beams."
        }
    }
}

/// How far a load goes on the whole layout: `2 N`, `5 mm`, `3°`.
pub(crate) fn amount(design: &Design, drive: &Drive, to: f64) -> String {
    let (copies, layers, units) = (design.copies(), design.layers(), &design.units);
    let named = |symbol: &str, dimension| Unit::parse(symbol).unwrap_or_else(|_| Unit::si(dimension));
    match drive {
        Drive::Displacement { .. } => format_si(layers * to, &units.displacement, 4),
        Drive::Force { .. } => format_si(copies * to, &units.force, 4),
        Drive::Rotation { .. } => format_si(to, &named("deg", Dimension::Angle), 4),
        Drive::Moment { .. } => format_si(copies * to, &named("N*mm", Dimension::Torque), 4),
    }
}

/// What happens, in order.
fn loads(design: &Design) -> String {
    let toward = |d: [f64; 2]| format!("[{}, {}]", format_number(d[0], 4), format_number(d[1], 4));
    let one = |index: usize, drive: &Drive, to: f64| {
        let name = design.loaded.get(index).and_then(|d| design.drawn.get(*d)).map_or("?", |d| d.name.as_str());
        let amount = amount(design, drive, to);
        match *drive {
            Drive::Displacement { direction, .. } => format!("node {name} is moved by {amount} along {}", toward(direction)),
            Drive::Force { direction, .. } => format!("node {name} is loaded by {amount} along {}", toward(direction)),
            Drive::Rotation { .. } => format!("node {name} is turned by {amount}"),
            Drive::Moment { .. } => format!("node {name} is loaded by a moment of {amount}"),
        }
    };
    let before: Vec<String> = design.network.before.iter().enumerate().map(|(i, s)| one(i, &s.drive, s.to)).collect();
    let last = one(before.len(), &design.network.drive, design.load_end);
    match before.len() {
        0 => format!("From rest {last}."),
        1 => format!("After 1 load stage, held at its end ({}), {last}. Curves and metrics are those of this last load.", before.join("")),
        n => format!(
            "After {n} load stages, each held at its end ({}), {last}. Curves and metrics are those of this last load.",
            before.join("; ")
        ),
    }
}

/// The rigid bodies, in words.
fn bodies(design: &Design) -> String {
    let name = |n: &usize| design.drawn.get(*n).map_or("?", |d| d.name.as_str());
    let one = |body: &Body| {
        format!("Nodes {} are one rigid body, `{}`. ", body.members.iter().map(name).collect::<Vec<_>>().join(", "), body.name)
    };
    design.bodies.iter().map(one).collect()
}

/// Where the data of each material come from.
fn material_data(design: &Design) -> String {
    let all = design.materials.iter().enumerate().map(|(index, material)| {
        let beams = (0..design.beam_names.len()).filter(|b| design.beam_materials[*b] == index).map(|b| design.beam_names[b].as_str());
        let of = match &material.name {
            _ if design.materials.len() == 1 => String::new(),
            Some(name) => format!("{name} ({}): ", beams.collect::<Vec<_>>().join(", ")),
            None => format!("Beams {}: ", beams.collect::<Vec<_>>().join(", ")),
        };
        format!("{of}{}.{}", material.origin, material.note.map_or_else(String::new, |n| format!(" {}", n.trim())))
    });
    all.collect::<Vec<_>>().join(" ")
}

/// What is not modelled.
pub(crate) fn limits(design: &Design) -> Vec<Statement> {
    let mut all = vec![
        statement("Joints", joint_limits(design)),
        statement(
            "Material",
            "Linear elastic. No plasticity or temperature in the force; creep and fatigue are checks where they are asked for (COMP009, COMP010). Plastics lose force under lasting load.",
        ),
        statement("Tolerances", "Half widths after ± are recorded and shown; they do not enter this analysis."),
        statement(
            "Contact",
            "Beams pass through each other and through themselves. Crossings of their axes are found and named (W0508); their thickness, blocks and clamps are not looked at.",
        ),
        statement("Plane", "Motion in the plane only: no buckling or tilting out of it, no weight, no dynamics."),
        statement(
            "Slenderness",
            "Beam theory holds for beams about ten times longer than thick; the stress of strongly curved beams is that of straight ones.",
        ),
        statement(
            "Symmetry",
            if crate::sway::joins_halves(design) {
                "A mirrored mechanism is assumed to move symmetrically. Whether the whole would sway sideways without a guide is looked for (`lateral_stiffness_min`, W0510), at every fourth station; other modes that break the symmetry are not."
            } else {
                "A mirrored mechanism is assumed to move symmetrically; modes that break the symmetry are not looked for."
            },
        ),
    ];
    all.extend(crate::scenario::limits(design));
    all.extend(crate::scenario::lateral::limits(design));
    all
}

fn joint_limits(design: &Design) -> &'static str {
    match design.joints {
        Joints::Point => {
            "The extra stiffness where beams of finite thickness overlap, and of fillets, is not modelled; `model.joints = \"overlap\"` adds the former. For the paper's prototype both together explain up to about 0.75 N of the 0.9 N by which the bench lies above the beam model of 6 N."
        }
        Joints::Overlap => {
            "Fillets, which lengthen the rigid zones, are not modelled, nor are zones between a beam and the ground, a block or the mirrored half."
        }
    }
}

/// Works used.
pub(crate) fn sources(design: &Design) -> Vec<Citation> {
    let mut all = vec![Citation {
        key: "lan2010",
        text: "C.-C. Lan, J.-H. Wang, Y.-H. Chen: A Compliant Constant-Force Mechanism for Adaptive Robot End-Effector Operations. IEEE Int. Conf. on Robotics and Automation (ICRA), 2010.",
        used_for: "network of beams with intrinsic shapes, bending stress (5), operational range (Fig. 2), scaling law (6)",
    }];
    if design.theory == Theory::Reissner {
        all.push(Citation {
            key: "reissner1972",
            text: "E. Reissner: On one-dimensional finite-strain beam theory: the plane problem. Zeitschrift für angewandte Mathematik und Physik 23 (1972) 795–804.",
            used_for: "stretching and shear of beams under large rotation",
        });
    }
    all.extend(crate::scenario::sources(design));
    let mut keys: Vec<&'static str> = Vec::new();
    for key in design.materials.iter().flat_map(|m| &m.sources) {
        if !keys.contains(key) {
            keys.push(key);
        }
    }
    for key in keys {
        all.push(Citation { key, text: "Source of material data; see REFERENCES.bib.", used_for: "values of the material catalogue" });
    }
    all
}

/// Length over thickness, where that varies over its mean.
fn slenderness(beam: &Beam) -> f64 {
    let mean_m: f64 = beam.profile.windows(2).map(|p| (p[1][0] - p[0][0]) * f64::midpoint(p[0][1], p[1][1])).sum();
    beam.shape.length_m() / if beam.profile.is_empty() { beam.section.thickness_m } else { mean_m }
}

/// One warning about all strongly curved beams, with what it means for the largest stress.
fn curved_beams(design: &Design, measured: &Measured) -> Option<Warning> {
    let name = |i: usize| design.beam_names.get(i).map_or("?", String::as_str);
    let steepest = |b: &Beam| (0..=64).map(|i| curvature_ratio(b, f64::from(i) / 64.0)).fold(0.0, f64::max);
    let ratios: Vec<(usize, f64)> = design.network.beams.iter().map(steepest).enumerate().filter(|(_, r)| *r > CURVED).collect();
    let largest = ratios.iter().fold(0.0_f64, |m, (_, r)| m.max(*r));
    let beams = ratios.iter().map(|(i, _)| format!("`{}`", name(*i))).collect::<Vec<_>>().join(", ");
    let at_peak = measured.stress.and_then(|s| {
        let factor = inner_face_factor(design.network.beams.get(s.beam)?, s.peak.u);
        let corrected = factor * s.peak.stress_pa;
        let verdict = match design.allowable_pa(s.beam) {
            Some(allowed) if s.peak.stress_pa <= allowed && corrected > allowed => ", which is more than allowed",
            Some(allowed) if corrected <= allowed => ", still allowed",
            _ => "",
        };
        Some(format!(
            "; at the place of the largest stress (beam `{}`, u = {}) it is about {} % higher, {}{verdict}",
            name(s.beam),
            format_number(s.peak.u, 3),
            format_number(100.0 * (factor - 1.0), 2),
            format_si(corrected, &design.units.stress, 4)
        ))
    });
    let message = format!(
        "strongly curved: {beams} (thickness over radius up to {}); the stress at the inner face of a curved beam is higher than computed{}",
        format_number(largest, 2),
        at_peak.unwrap_or_default()
    );
    (!ratios.is_empty()).then_some(Warning { code: "W0502", message })
}

/// Where a real part leaves the computed path.
fn leaving(design: &Design, behaviour: &Behaviour) -> Vec<Warning> {
    let mut all = Vec::new();
    let show = |x: f64| format_si(x, &design.units.displacement, 4);
    if let Some((stage, part)) = behaviour.branching_load {
        all.push(Warning {
            code: "W0506",
            message: format!(
                "load {} becomes unstable at {} % of it: a real part leaves the computed shape there, and nothing after it holds",
                stage + 1,
                format_number(100.0 * part, 3)
            ),
        });
    }
    if let Some(from) = behaviour.unstable_from_m {
        all.push(Warning {
            code: "W0506",
            message: format!(
                "from Δ = {} on the computed shape is unstable even with the {} held: a real part leaves it, and the results hold only up to there",
                show(from),
                if design.control == Control::Travel { "displacement" } else { "force" }
            ),
        });
    }
    if let Some(from) = behaviour.stack.as_ref().and_then(|s| s.apart_from_m) {
        all.push(Warning {
            code: "W0514",
            message: format!(
                "from Δ = {} on the layers do not move alike: curves and metrics are those of layers that do, the figure of the layers shows what they do",
                show(from)
            ),
        });
    }
    if let Some(from) = behaviour.sway.and_then(|s| s.from_m) {
        all.push(Warning {
            code: "W0510",
            message: format!(
                "without a guide the block sways sideways from Δ = {} on: guided along the load it does what its curve says, free it leaves it",
                show(from)
            ),
        });
    }
    all
}

/// Copies that run into each other.
fn touching_copies(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Option<Warning> {
    let beside = measured.nearest.filter(|n| n.clearance.image.is_some()).map(|n| n.clearance.distance_m);
    let gap_m = [beside, gap_around_m(design, behaviour)].into_iter().flatten().reduce(f64::min).filter(|m| *m < 0.0)?;
    let by = format_si(-gap_m, &design.units.length, 4);
    let message = format!("copies run into each other by {by}: contact is not modelled, so the results hold only if they are moved apart");
    Some(Warning { code: "W0515", message })
}

/// Things to know about this result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let mut all: Vec<Warning> = touching_copies(design, behaviour, measured).into_iter().collect();
    let name = |i: usize| design.beam_names.get(i).map_or("?", String::as_str);
    for (index, beam) in design.network.beams.iter().enumerate() {
        let slenderness = slenderness(beam);
        if slenderness < SLENDER {
            all.push(Warning {
                code: "W0501",
                message: format!(
                    "beam `{}` is only {} times longer than thick; beam theory is doubtful below {SLENDER}",
                    name(index),
                    format_number(slenderness, 3)
                ),
            });
        }
    }
    all.extend(curved_beams(design, measured));
    let show = |x: f64| format_si(x, &design.units.displacement, 4);
    if let Some((from, to)) = behaviour.jump() {
        let stays = if behaviour.whole { "; driven by displacement it does not" } else { "" };
        let target = to.map_or_else(|| "to a place beyond the travel".to_owned(), |x| format!("to {}", show(x)));
        all.push(Warning {
            code: "W0503",
            message: format!("loaded by a growing force (a weight) the mechanism would jump from Δ = {} {target}{stays}", show(from)),
        });
    }
    if let Some((stress, yield_pa)) = measured.loaded.and_then(|s| Some((s, design.yield_pa(s.beam)?)))
        && stress.peak.stress_pa > yield_pa
    {
        let unit = Unit::clone(&design.units.stress);
        all.push(Warning {
            code: "W0504",
            message: format!(
                "the stress in beam `{}` exceeds the yield stress of {}{}: beyond that the curve is not that of the real part",
                name(stress.beam),
                format_si(yield_pa, &unit, 4),
                behaviour
                    .travel_at_stress(|beam| design.yield_pa(beam).unwrap_or(f64::INFINITY))
                    .map_or_else(String::new, |x| format!(" from Δ = {} on", show(x)))
            ),
        });
    }
    if let Some(crossing) = first_crossing(design, &behaviour.path) {
        let other = match crossing.second {
            None => "the mirror line, and so its own other half".to_owned(),
            Some(second) if second == crossing.first => "itself".to_owned(),
            Some(second) => format!("beam `{}`", name(second)),
        };
        all.push(Warning {
            code: "W0508",
            message: format!(
                "beam `{}` crosses {other} from Δ = {} on; contact is not modelled, so the results hold only up to there",
                name(crossing.first),
                show(crossing.displacement_m)
            ),
        });
    }
    all.extend(leaving(design, behaviour));
    all.extend(crate::scenario::warnings(design, behaviour, measured));
    all.extend(crate::scenario::lateral::warnings(design, behaviour));
    if behaviour.interpolation_error > 1e-6 {
        all.push(Warning {
            code: "W0505",
            message: format!(
                "the curve changes so quickly that values read between its stations are accurate to about {} of the largest force",
                format_si(behaviour.interpolation_error, &Unit::si(Dimension::Ratio), 2)
            ),
        });
    }
    all
}
