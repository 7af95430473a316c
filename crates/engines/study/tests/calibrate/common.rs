//! Explicit models, and noise that is the same in every run.

use forcewright_study::calibrate::{Fit, Limits, Measured, Model, Parameter, Plan, fit};
use forcewright_study::evaluator::{Evaluation, Failure, Workspace};
use forcewright_study::sampling::normal;
use num_dual::Dual64;

/// A formula of a place and parameters, with derivatives by dual numbers.
pub(crate) struct Formula<F> {
    pub(crate) x: Vec<f64>,
    pub(crate) of: F,
}

impl<F: Fn(f64, &[Dual64]) -> Dual64 + Sync> Model for Formula<F> {
    fn predict(&self, p: &[f64], _: bool, _: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure> {
        out.values.clear();
        out.jacobian.clear();
        for x in &self.x {
            for k in 0..p.len() {
                let dual: Vec<Dual64> = p.iter().enumerate().map(|(j, v)| Dual64::new(*v, f64::from(u8::from(j == k)))).collect();
                let value = (self.of)(*x, &dual);
                if k == 0 {
                    out.values.push(value.re);
                }
                out.jacobian.push(value.eps);
            }
        }
        Ok(())
    }
}

/// A parameter without bounds.
pub(crate) fn free(start: f64) -> Parameter {
    let limits = Limits { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    Parameter { name: "p".into(), start, limits, scale: start.abs().max(1e-3), prior: None }
}

/// A fit of one branch.
pub(crate) fn fitted(model: &dyn Model, parameters: &[Parameter], x: &[f64], y: &[f64], plan: &Plan) -> Fit {
    let measured = Measured { x, y, raw: y, branches: &[x.len()] };
    fit(model, parameters, measured, plan, &mut |_| true).expect("a fit")
}

/// Seeded noise (splitmix64).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 + 0.5 / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        normal::quantile(self.uniform())
    }
}
