//! Outputs at a point with all their derivatives, by the design and along the path.

use forcewright_base::maths;

use super::{Axis, GradientError, Gradients, Output, Parameter};
use crate::clearance::Reflection;
use crate::state::{Face, Point};

/// Some outputs at a state with their derivatives, SI.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Derivatives {
    /// The outputs.
    pub value: Vec<f64>,
    /// Their derivatives by the control along the path.
    pub by_control: Vec<f64>,
    /// Their derivatives by the parameters, the control held: a row per output, a column per parameter.
    pub by_parameter: Vec<f64>,
}

impl Derivatives {
    pub(crate) fn clear(&mut self) {
        self.value.clear();
        self.by_control.clear();
        self.by_parameter.clear();
    }
}

impl Gradients<'_> {
    /// Some outputs at a point of the path with their derivatives by the control and by some parameters; a parameter that names what
    /// the network does not have changes nothing.
    ///
    /// # Errors
    /// As [`Gradients::at`].
    pub fn derivatives(
        &mut self,
        point: &Point,
        outputs: &[Output],
        parameters: &[Parameter],
        into: &mut Derivatives,
    ) -> Result<(), GradientError> {
        into.clear();
        for ((gradient, rate), output) in self.with_rates(point, outputs)?.iter().zip(outputs) {
            into.value.push(value(point, *output));
            into.by_control.push(*rate);
            into.by_parameter.extend(parameters.iter().map(|p| gradient.by(*p).unwrap_or(0.0)));
        }
        Ok(())
    }
}

/// An output at a point that has it.
fn value(point: &Point, output: Output) -> f64 {
    let of = |[x, y]: [f64; 2], axis: Axis| if axis == Axis::X { x } else { y };
    match output {
        Output::Force => point.force,
        Output::Displacement => point.displacement,
        Output::Stiffness => point.stiffness,
        Output::Stress { beam, u, face } => point.beams[beam].stress_pa(u)[usize::from(face == Face::Right)],
        Output::PeakStress { beam: Some(beam) } => point.beams[beam].peak_stress().stress_pa,
        Output::PeakStress { beam: None } => point.peak_stress().map_or(0.0, |(_, peak)| peak.stress_pa),
        Output::FacePeakStress { beam, face } => point.beams[beam].peak_stress_of_face(face).stress_pa,
        Output::Position { beam, u, axis } => of(point.beams[beam].shape_m(u), axis),
        Output::Gap { first, second, reflection } => {
            let places = [first, second].map(|(beam, u)| point.beams[beam].shape_m(u));
            gap_m(places, [first, second].map(|(beam, u)| point.beams[beam].thickness_m(u)), reflection).0
        }
        Output::NodeDisplacement { node, axis } => of(point.nodes[node].displacement_m, axis),
        Output::NodeRotation { node } => point.nodes[node].rotation_rad,
    }
}

/// Distance between the surfaces at two places, the second mirrored, m, and the vector between the axes there.
pub(crate) fn gap_m([a, b]: [[f64; 2]; 2], thickness_m: [f64; 2], reflection: Option<Reflection>) -> (f64, [f64; 2]) {
    let b = reflection.map_or(b, |r| r.image(b));
    let apart = [b[0] - a[0], b[1] - a[1]];
    (maths::hypot(apart[0], apart[1]) - 0.5 * (thickness_m[0] + thickness_m[1]), apart)
}
