//! What turning the drive costs: bearings under the load of the cables, and cables that are bent and straightened.
//!
//! A shaft needs the torque `μ_b F D/2` and its drag. A cable that is bent round a drum and straightened again loses the part c of its
//! tension on the input drum, and c r₁/r₂ on the output drum: friction between its wires gives a moment in proportion to the tension, which
//! works over the curvature. Tensions are those of the drive at rest.

use forcewright_base::maths;
use forcewright_elements::wrap::WrapError;

use crate::design::Built;
use crate::geometry::Drive;
use crate::statics::Statics;

/// Steps after which torque and tensions agree; each divides the error by some hundred.
const MOST_STEPS: usize = 60;

/// What is needed to know the losses.
#[derive(Clone, Debug)]
pub struct Losses<'a> {
    statics: &'a Statics,
    /// sin γ and cos γ.
    span: [f64; 2],
    /// `μ_b` D/2 of input and output, m.
    bearings_m: [f64; 2],
    drags_nm: [f64; 2],
    /// c of each cable.
    bending: Vec<f64>,
    /// r₁/r₂.
    slow: f64,
}

/// Torques at both shafts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torques {
    /// At the input, N·m.
    pub input_nm: f64,
    /// At the output, N·m.
    pub output_nm: f64,
}

/// What is not known of the losses, in the words of the project file.
pub(crate) fn unknown(built: &Built) -> Vec<&'static str> {
    let mut all = Vec::new();
    if built.bearings.friction.is_none() {
        all.push("design.bearings.friction");
    }
    for (bore, name) in built.bearings.bores_m.iter().zip(["design.bearings.input_bore", "design.bearings.output_bore"]) {
        if bore.is_none() && built.bearings.friction != Some(0.0) {
            all.push(name);
        }
    }
    if built.cables.iter().any(|c| c.bending_loss.is_none()) {
        all.push("bending_loss of the cables");
    }
    all
}

/// Load of a shaft by cables with these tensions at angle γ (its sine and cosine), N: `√(((T₀+T₁) sin γ)² + ((T₀−T₁) cos γ)²)`.
pub fn shaft_load_n(tensions_n: &[[f64; 2]], [sin, cos]: [f64; 2]) -> f64 {
    let sum: f64 = tensions_n.iter().map(|[a, b]| a + b).sum();
    let difference: f64 = tensions_n.iter().map(|[a, b]| a - b).sum();
    maths::hypot(sum * sin, difference * cos)
}

impl<'a> Losses<'a> {
    /// The losses of a drive; `None` where something is not known of them (`unknown`).
    pub fn of(built: &Built, geometry: &Drive, statics: &'a Statics) -> Option<Self> {
        let friction = built.bearings.friction?;
        let arm_m = |bore_m: Option<f64>| if friction == 0.0 { Some(0.0) } else { bore_m.map(|d| 0.5 * friction * d) };
        let [input, output] = built.bearings.bores_m;
        let (sin, cos) = maths::sin_cos(geometry.tangent_angle_rad());
        Some(Self {
            statics,
            span: [sin, cos],
            bearings_m: [arm_m(input)?, arm_m(output)?],
            drags_nm: built.bearings.drags_nm,
            bending: built.cables.iter().map(|c| c.bending_loss).collect::<Option<_>>()?,
            slow: 1.0 / built.ratio(),
        })
    }

    /// Torques that each shaft takes for itself with these tensions, N·m: of the input and of the output.
    fn taken_nm(&self, tensions_n: &[[f64; 2]]) -> [f64; 2] {
        let load_n = shaft_load_n(tensions_n, self.span);
        let bent_n: f64 = self.bending.iter().zip(tensions_n).map(|(c, [a, b])| 0.5 * c * (a + b)).sum();
        let [input_m, output_m] = self.statics.levers_m();
        [
            self.bearings_m[0] * load_n + self.drags_nm[0] + input_m * bent_n,
            self.bearings_m[1] * load_n + self.drags_nm[1] + output_m * bent_n * self.slow,
        ]
    }

    /// Torques once the force that the cables carry agrees with them; `force_n` gives it from what the shafts take.
    fn settled(&self, force_n: impl Fn([f64; 2]) -> f64) -> Result<(f64, [f64; 2]), WrapError> {
        let lever_m = self.statics.levers_m()[1];
        let mut carried_n = 0.0;
        let mut taken = [0.0; 2];
        for _ in 0..MOST_STEPS {
            taken = self.taken_nm(&self.statics.under(carried_n * lever_m)?.tensions_n);
            let next_n = force_n(taken);
            if (next_n - carried_n).abs() <= 1e-14 * next_n.abs() {
                break;
            }
            carried_n = next_n;
        }
        Ok((carried_n, taken))
    }

    /// The input drives the output against a torque, N·m.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] where the cables do not hold it.
    pub fn forward(&self, output_nm: f64) -> Result<Torques, WrapError> {
        let [input_m, output_m] = self.statics.levers_m();
        let (force_n, taken) = self.settled(|taken| (output_nm + taken[1]) / output_m)?;
        Ok(Torques { input_nm: force_n * input_m + taken[0], output_nm })
    }

    /// A torque at the output, N·m, drives the input; what is left there may be below zero: then the input must help.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] where the cables do not hold it.
    pub fn backward(&self, output_nm: f64) -> Result<Torques, WrapError> {
        let [input_m, output_m] = self.statics.levers_m();
        let (force_n, taken) = self.settled(|taken| (output_nm - taken[1]) / output_m)?;
        Ok(Torques { input_nm: force_n * input_m - taken[0], output_nm })
    }

    /// The torque at the output that turns the drive with nothing at the input, N·m.
    ///
    /// # Errors
    /// [`WrapError::GrossSlip`] where the cables do not turn the input.
    pub fn backdrive_nm(&self) -> Result<f64, WrapError> {
        let [input_m, output_m] = self.statics.levers_m();
        let (force_n, taken) = self.settled(|taken| taken[0] / input_m)?;
        Ok(force_n * output_m + taken[1])
    }
}
