//! What a report says in words: model, limits, sources, warnings.

use forcewright_base::units::{Dimension, Unit, format_number, format_si};
use forcewright_beam::Theory;
use forcewright_model::{Citation, Statement, Warning};

use crate::analysis::{Behaviour, Measured};
use crate::design::Design;

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
    let halves = if design.mirror.is_some() {
        "The drawn network is solved; its mirrored half moves alike, and force, energy and stiffness count both."
    } else {
        "The drawn network is the whole mechanism."
    };
    vec![
        beams,
        statement("Network", format!("Beams meet at points; rigid joints keep the angles between beams. {halves}")),
        statement(
            "Solution",
            "Rotations in integrated Legendre polynomials, forces as multipliers, Newton's method. The path starts at rest and is followed in displacement with adaptive steps; it never starts from another design's solution. Polynomial degree grows until forces and stresses of two degrees agree.",
        ),
        statement(
            "Stress",
            "Bending and, in the geometrically exact model, axial stress, on both faces, over the whole length; the largest over the travel.",
        ),
        statement("Material data", design.material_origin.clone()),
    ]
}

/// What is not modelled.
pub(crate) fn limits() -> Vec<Statement> {
    vec![
        statement(
            "Joints",
            "The extra stiffness where beams of finite thickness overlap, and of fillets, is not modelled. For the paper's prototype both together explain up to about 0.75 N of the 0.9 N by which the bench lies above the beam model of 6 N.",
        ),
        statement(
            "Material",
            "Linear elastic. No plasticity, creep, relaxation, temperature or fatigue; plastics lose force under lasting load.",
        ),
        statement("Contact", "Beams pass through each other and through themselves; look at the picture."),
        statement("Plane", "Motion in the plane only: no buckling or tilting out of it, no weight, no dynamics."),
        statement(
            "Slenderness",
            "Beam theory holds for beams about ten times longer than thick; the stress of strongly curved beams is that of straight ones.",
        ),
        statement("Symmetry", "A mirrored mechanism is assumed to move symmetrically; a sideways mode of the whole is not looked for."),
    ]
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
    all
}

/// Things to know about this result.
pub(crate) fn warnings(design: &Design, behaviour: &Behaviour, measured: &Measured) -> Vec<Warning> {
    let mut all = Vec::new();
    let name = |i: usize| design.beam_names.get(i).map_or("?", String::as_str);
    for (index, beam) in design.network.beams.iter().enumerate() {
        let slenderness = beam.shape.length_m() / beam.section.thickness_m;
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
        let steepest = (0..=64).map(|i| beam.shape.slope_at(f64::from(i) / 64.0).abs()).fold(0.0, f64::max);
        let curved = beam.section.thickness_m * steepest / beam.shape.length_m();
        if curved > CURVED {
            all.push(Warning {
                code: "W0502",
                message: format!(
                    "beam `{}` is strongly curved (thickness over radius {}): the stress at its inner face is about {} % higher than computed",
                    name(index),
                    format_number(curved, 2),
                    format_number(100.0 * curved / 3.0, 2)
                ),
            });
        }
    }
    let show = |x: f64| format_si(x, &design.units.displacement, 4);
    if let Some((from, to)) = behaviour.jump() {
        let target = to.map_or_else(|| "beyond the travel".to_owned(), |x| format!("to {}", show(x)));
        all.push(Warning {
            code: "W0503",
            message: format!(
                "under a growing dead force the mechanism would jump from Δ = {} {target}; driven by displacement it does not",
                show(from)
            ),
        });
    }
    if let (Some(stress), Some(yield_pa)) = (measured.stress, design.yield_pa)
        && stress.peak.stress_pa > yield_pa
    {
        let unit = Unit::clone(&design.units.stress);
        all.push(Warning {
            code: "W0504",
            message: format!(
                "the stress exceeds the yield stress of {}: beyond that the curve is not that of the real part",
                format_si(yield_pa, &unit, 4)
            ),
        });
    }
    if let Some(point) = behaviour.path.points.iter().find(|p| p.instability > 0) {
        let from = behaviour.path.bifurcations.first().map_or(point.displacement, |b| b.displacement);
        all.push(Warning {
            code: "W0506",
            message: format!(
                "from Δ = {} on the computed state is unstable even with the displacement held: a real part leaves it for another shape, and this curve no longer holds",
                show(from)
            ),
        });
    }
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
