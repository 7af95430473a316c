//! Points, distributions and what is estimated from samples: quasi-Monte Carlo, yield, sensitivity.
//!
//! A study has three steps, of which the one in the middle is the caller's:
//!
//! 1. **Points.** [`Replicates`] (or a [`SensitivityPlan`]) writes the points of any range of samples, each a function of its index
//!    alone; [`Population::draw`] turns a point of the unit cube into parameters.
//! 2. **Evaluation**, in any order, on any number of threads.
//! 3. **Accumulation** of the outputs in the order of the samples: [`YieldTally`], [`SensitivityTally`], [`Fan`]. Then every bit of the
//!    result is the same for any number of threads.
//!
//! A [`LinearModel`] answers the same questions from a Jacobian, without evaluations, as well as the linearisation is good.

mod beta;
mod correlation;
mod distribution;
mod fan;
mod interval;
mod joe_kuo;
mod linear;
pub mod normal;
mod population;
mod scramble;
mod sensitivity;
mod sobol;
mod yields;

pub use correlation::{Correlation, CorrelationError};
pub use distribution::{Distribution, DistributionError, Form, SIGMAS_IN_TOLERANCE};
pub use fan::{Fan, Station};
pub use interval::{Confidence, Estimate, Interval, clopper_pearson, fisher, fisher_tail, student, wilson};
pub use linear::{Contribution, JointPlan, LinearError, LinearModel};
pub use population::{Population, PopulationError};
pub(crate) use scramble::mixed;
pub use sensitivity::{SensitivityError, SensitivityPlan, SensitivityTally, SobolIndices};
pub use sobol::{Replicates, Sobol, SobolError};
pub use yields::{Yield, YieldBasis, YieldTally};
