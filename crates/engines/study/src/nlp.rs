//! Smooth constrained optimisation: sequential quadratic programming with exact gradients.
//!
//! [`minimise`] finds a local minimum of `f(x)` subject to `cl ≤ c(x) ≤ cu` and `xl ≤ x ≤ xu` (a [`Problem`]), meant for up to about
//! sixty variables and a few hundred constraints of which few are active, with values that cost far more than the method.
//!
//! ```
//! use forcewright_study::nlp::{Problem, Rejected, Settings, Stop, Values, minimise};
//!
//! /// Least x + y with x·y ≥ 4.
//! struct Hyperbola;
//! impl Problem for Hyperbola {
//!     fn lower(&self) -> &[f64] { &[0.1, 0.1] }
//!     fn upper(&self) -> &[f64] { &[10.0, 10.0] }
//!     fn constraint_lower(&self) -> &[f64] { &[4.0] }
//!     fn constraint_upper(&self) -> &[f64] { &[f64::INFINITY] }
//!     fn evaluate(&mut self, x: &[f64], _gradients: bool, out: &mut Values) -> Result<(), Rejected> {
//!         out.objective = x[0] + x[1];
//!         out.gradient.copy_from_slice(&[1.0, 1.0]);
//!         out.constraints[0] = x[0] * x[1];
//!         out.jacobian.copy_from_slice(&[x[1], x[0]]);
//!         Ok(())
//!     }
//! }
//!
//! let solution = minimise(&mut Hyperbola, &[1.0, 9.0], &Settings::default(), &mut |_| true);
//! assert_eq!(solution.stop, Stop::Converged);
//! assert!((solution.objective - 4.0).abs() < 1e-9);
//! // f* = 2·√b, so df*/db = 1/√b = 1/2: raising the 4 by 0.1 costs 0.05.
//! assert!((solution.multipliers[0] - 0.5).abs() < 1e-6);
//! ```
//!
//! # Method
//!
//! SQP with a trust region on the ℓ₁ merit function: J. Nocedal and S. J. Wright, "Numerical Optimization", 2nd ed., Springer 2006
//! (`nocedal2006`), chapter 18; S.-P. Han 1977 (`han1977`); M. J. D. Powell 1978 (`powell1978`).
//!
//! - *Scaling*: variables by their range, objective and constraints by their gradients at the start, so that units do not matter.
//! - *Curvature*: one dense matrix for the Lagrangian, damped BFGS (`powell1978`); it stays positive definite, which a vertex, an
//!   objective linear in some variable or a Lagrangian of negative curvature would not grant an exact Hessian.
//! - *Quadratic programme*: the active set of the last one, mended and checked, otherwise the dual active-set method of Goldfarb and
//!   Idnani (`goldfarb1983`), in elastic mode with multipliers that end at the price; where rounding defeats that, the interior-point
//!   method Clarabel (`goulart2024`). What either finds is taken to working precision by the equations of the active set it points at.
//!   Hence optimality is reached to 1e-10 and better, and near the end a programme costs one small linear system.
//! - *Globalisation*: a step is taken if the merit function, whose penalties follow the multipliers, falls below the worst of the last few
//!   points (L. Grippo, F. Lampariello and S. Lucidi 1986). Where the whole step fails a correction of second order is tried first
//!   (N. Maratos's effect; `nocedal2006`, sections 15.5, 15.6 and 18.3), then the programme is solved again within a shorter reach: with
//!   many kinks, as in a minimax problem, the best short step is not a part of the best long one. The first reach is the scale of the
//!   variables, for no linearisation is to be believed farther. A filter (R. Fletcher and
//!   S. Leyffer 2002, `fletcher2002`) would need a restoration phase of its own beside it; in elastic mode the merit function is the
//!   objective of the programme itself, so one mechanism serves both.
//! - *Contradictory linearisations*: elastic mode, an ℓ₁ price on violation that is raised until the step does a fair part of what can be
//!   done about it (R. H. Byrd, J. Nocedal and R. A. Waltz 2008, `byrd2008`). If nothing can be done, the point is left once, and if
//!   the search comes back the problem is said to be infeasible there.
//! - *Rejected points* shorten the step, and for some iterations a wall stands across it so that the iterates slide along the edge of the
//!   region rather than jam at it.
//! - *The end*: the conditions of optimality hold and the programme predicts no gain worth the name beside the objective. The second
//!   matters where the objective is far steeper at the start, which scales it, than at the end.
//!
//! Everything is deterministic: no clock, no threads, no random numbers.

mod active;
mod dual;
mod hessian;
mod interior;
mod kkt;
mod merit;
mod model;
mod outcome;
mod patience;
mod problem;
mod qp;
mod sqp;
mod subproblem;
#[cfg(test)]
mod tests;
mod walls;

pub use outcome::{Counters, KktResidual, Progress, Settings, Solution, Stop};
pub use problem::{Problem, Rejected, Values};
pub use sqp::minimise;
