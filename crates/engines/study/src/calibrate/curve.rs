//! A curve of an evaluator at the places where it was measured, on a bench that shifts and gives way.
//!
//! Measured at `x`, the bench shows `y = F(ξ) + y₀` with `x = ξ + x₀ + c F(ξ)`: `x₀`, `y₀` are its zero, `c` its compliance.

use std::fmt;

use forcewright_base::roots;

use super::Model;
use super::stations::{Shape, Stations};
use crate::evaluator::{Evaluation, Evaluator, Failure, Workspace};

/// Zero and compliance of a bench.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bench {
    /// What it shows at rest: abscissa and ordinate, SI.
    pub offset: [f64; 2],
    /// How much of the abscissa it takes itself, per ordinate, SI: m/N.
    pub compliance: f64,
}

/// A number of the bench that is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchParameter {
    /// [`Bench::offset`], abscissa.
    OffsetX,
    /// [`Bench::offset`], ordinate.
    OffsetY,
    /// [`Bench::compliance`].
    Compliance,
}

impl Bench {
    /// Sets one of its numbers, SI.
    pub fn set(&mut self, which: BenchParameter, value: f64) {
        match which {
            BenchParameter::OffsetX => self.offset[0] = value,
            BenchParameter::OffsetY => self.offset[1] = value,
            BenchParameter::Compliance => self.compliance = value,
        }
    }
}

/// Points that one output of the evaluator describes.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// The output.
    pub output: usize,
    /// Where it was measured, SI.
    pub x: Vec<f64>,
}

/// Why a curve cannot be compared with points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CurveError {
    /// There is no such output, or it stands nowhere in particular.
    NoCurve {
        /// The output asked for.
        output: usize,
    },
    /// Stations that do not ascend or descend.
    Order {
        /// The output asked for.
        output: usize,
    },
}

impl fmt::Display for CurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCurve { output } => write!(f, "output {output} is no curve"),
            Self::Order { output } => write!(f, "the stations of output {output} are not in order"),
        }
    }
}

impl std::error::Error for CurveError {}

/// See the module. The parameters are the variables of the evaluator and, behind them, those of the bench.
pub struct Curve<'a> {
    evaluator: &'a dyn Evaluator,
    bench: Bench,
    free: Vec<BenchParameter>,
    branches: Vec<(Stations, Branch)>,
}

impl<'a> Curve<'a> {
    /// Curves at the places of `branches`, on a bench of which `free` is looked for.
    ///
    /// # Errors
    /// [`CurveError`] for an output that is no curve.
    pub fn new(evaluator: &'a dyn Evaluator, bench: Bench, free: Vec<BenchParameter>, branches: Vec<Branch>) -> Result<Self, CurveError> {
        let with = |branch: Branch| Ok((Stations::of(evaluator, branch.output)?, branch));
        let branches = branches.into_iter().map(with).collect::<Result<_, _>>()?;
        Ok(Self { evaluator, bench, free, branches })
    }
}

impl Model for Curve<'_> {
    fn room(&self) -> Workspace {
        self.evaluator.workspace()
    }

    fn predict(&self, x: &[f64], derivatives: bool, room: &mut Workspace, out: &mut Evaluation) -> Result<(), Failure> {
        let inner = self.evaluator.variables().len();
        let mut bench = self.bench;
        self.free.iter().zip(&x[inner..]).for_each(|(which, value)| bench.set(*which, *value));
        let mut own = Evaluation::default();
        self.evaluator.evaluate(&x[..inner], false, &mut own, room)?;
        if derivatives {
            // Of the curves that are compared, and of nothing else that the evaluator computes.
            let mut rows = vec![false; own.values.len()];
            for index in self.branches.iter().flat_map(|(stations, _)| stations.values()) {
                rows[*index] = true;
            }
            self.evaluator.differentiate(&x[..inner], &rows, &mut own, room)?;
        }
        out.values.clear();
        out.jacobian.clear();
        for (stations, branch) in &self.branches {
            let shape = stations.shape(&own.values);
            check(&shape, bench.compliance)?;
            for measured in &branch.x {
                let at = place(&shape, &bench, *measured)?;
                let (value, slope) = shape.weights(at);
                let of = |weights: &[(usize, f64)]| weights.iter().map(|(i, w)| w * own.values[*i]).sum::<f64>();
                let (force, rate) = (of(&value), of(&slope));
                out.values.push(force + bench.offset[1]);
                if derivatives {
                    // ξ moves with what changes: (1 + c F′) dξ = −dx₀ − F dc − c dF.
                    let give = 1.0 / (1.0 + bench.compliance * rate);
                    let column = |k: usize| value.iter().map(|(i, w)| w * own.jacobian[i * inner + k]).sum::<f64>() * give;
                    out.jacobian.extend((0..inner).map(column));
                    out.jacobian.extend(self.free.iter().map(|which| match which {
                        BenchParameter::OffsetX => -rate * give,
                        BenchParameter::OffsetY => 1.0,
                        BenchParameter::Compliance => -rate * force * give,
                    }));
                }
            }
        }
        Ok(())
    }
}

/// A bench that gives way more than the curve pushes back jumps: what it shows is no function of where it is.
fn check(shape: &Shape<'_>, compliance: f64) -> Result<(), Failure> {
    let least = shape.slopes().map(|slope| compliance * slope).fold(f64::INFINITY, f64::min);
    if 1.0 + least > 0.0 { Ok(()) } else { Err(Failure { reason: "a bench this soft snaps through with the mechanism".to_owned() }) }
}

/// Where the mechanism is when the bench shows a place.
fn place(shape: &Shape<'_>, bench: &Bench, shown: f64) -> Result<f64, Failure> {
    let straight = shown - bench.offset[0];
    if bench.compliance.abs() <= 0.0 {
        return Ok(straight);
    }
    let excess = |x: f64| x - straight + bench.compliance * shape.value(x);
    let mut width = excess(straight).abs().max(f64::EPSILON * straight.abs()).max(f64::MIN_POSITIVE);
    for _ in 0..60 {
        if let Ok(x) = roots::root(excess, straight - width, straight + width, 0.0) {
            return Ok(x);
        }
        width *= 2.0;
    }
    Err(Failure { reason: "the bench takes all of the way itself".to_owned() })
}

#[cfg(test)]
mod tests {
    use forcewright_base::maths::{cos, sin};

    use super::*;
    use crate::evaluator::{Measure, Output, Variable};

    /// `F = a sin(b x)` at stations that are not even.
    struct Wave {
        variables: Vec<Variable>,
        outputs: Vec<Output>,
        at: Vec<f64>,
    }

    impl Wave {
        fn new(n: usize, descending: bool) -> Self {
            let variable = |path: &str| Variable { path: path.into(), unit: "1", nominal: 1.0, lower: 0.1, upper: 9.0 };
            let mut at: Vec<f64> = (0..n).map(|i| 2.0 * i as f64 / (n - 1) as f64).map(|u| u + 0.05 * sin(3.0 * u)).collect();
            if descending {
                at.reverse();
            }
            Self {
                variables: vec![variable("a"), variable("b")],
                outputs: vec![Output { name: "force".into(), unit: "N", values: 0..n }],
                at,
            }
        }
    }

    impl Evaluator for Wave {
        fn variables(&self) -> &[Variable] {
            &self.variables
        }
        fn outputs(&self) -> &[Output] {
            &self.outputs
        }
        fn stations(&self, _: usize) -> Vec<f64> {
            self.at.clone()
        }
        fn measures(&self) -> &[Measure] {
            &[]
        }
        fn workspace(&self) -> Workspace {
            Workspace::new(())
        }
        fn evaluate(&self, x: &[f64], _: bool, out: &mut Evaluation, _: &mut Workspace) -> Result<(), Failure> {
            out.values = self.at.iter().map(|s| x[0] * sin(x[1] * s)).collect();
            out.jacobian = self.at.iter().flat_map(|s| [sin(x[1] * s), x[0] * s * cos(x[1] * s)]).collect();
            Ok(())
        }
        fn measure(&self, _: &[f64], _: &[f64], _: &mut Vec<f64>, _: &mut Workspace) {}
    }

    fn predicted(wave: &Wave, bench: Bench, places: &[f64], x: &[f64]) -> Evaluation {
        let free = vec![BenchParameter::OffsetX, BenchParameter::OffsetY, BenchParameter::Compliance];
        let curve = Curve::new(wave, bench, free, vec![Branch { output: 0, x: places.to_vec() }]).unwrap();
        let mut out = Evaluation::default();
        curve.predict(x, true, &mut curve.room(), &mut out).unwrap();
        out
    }

    /// The error falls with the fourth power of the distance of the stations, for values and, read backwards, all the same.
    #[test]
    fn between_stations_a_curve_is_of_fourth_order() {
        let places: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.0098 + 0.01).collect();
        let error = |n: usize, descending: bool| {
            let found = predicted(&Wave::new(n, descending), Bench::default(), &places, &[2.0, 1.3, 0.0, 0.0, 0.0]);
            found.values.iter().zip(&places).map(|(v, x)| (v - 2.0 * sin(1.3 * x)).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(21, false), error(41, false));
        assert!(fine < 1e-6 && (12.0..24.0).contains(&(coarse / fine)), "{coarse} {fine}");
        assert!((error(41, true) - fine).abs() < 1e-12);
    }

    /// What the bench shows is where it is: put into its own equations, nothing is left. Derivatives are those of the values.
    #[test]
    fn a_bench_that_shifts_and_gives_way() {
        let (wave, places) = (Wave::new(81, false), [0.1, 0.4, 0.9, 1.3, 1.8]);
        let x = [2.0, 1.3, 0.05, -0.2, 0.07];
        let found = predicted(&wave, Bench::default(), &places, &x);
        for (shown, y) in places.iter().zip(&found.values) {
            let force = y + 0.2;
            let true_place = shown - 0.05 - 0.07 * force;
            assert!((force - 2.0 * sin(1.3 * true_place)).abs() < 1e-7, "{shown}");
        }
        for k in 0..5 {
            let h = 1e-6;
            let moved = |by: f64| {
                let mut x = x;
                x[k] += by;
                predicted(&wave, Bench::default(), &places, &x).values
            };
            for (p, (up, down)) in moved(h).iter().zip(moved(-h)).enumerate() {
                assert!(((up - down) / (2.0 * h) - found.jacobian[5 * p + k]).abs() < 1e-5, "{k} {p}");
            }
        }
    }

    #[test]
    fn a_bench_too_soft_and_outputs_that_are_no_curves() {
        let wave = Wave::new(41, false);
        let curve =
            Curve::new(&wave, Bench { compliance: 0.9, ..Bench::default() }, vec![], vec![Branch { output: 0, x: vec![1.0] }]).unwrap();
        let failed = curve.predict(&[2.0, 1.3], false, &mut curve.room(), &mut Evaluation::default());
        assert!(failed.unwrap_err().reason.contains("snaps"));
        let none = Curve::new(&wave, Bench::default(), vec![], vec![Branch { output: 3, x: vec![1.0] }]);
        assert!(matches!(none, Err(CurveError::NoCurve { output: 3 })));
    }
}
