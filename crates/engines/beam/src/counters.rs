//! Work counters.

/// Work done, the same on every machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of the equations of all beams.
    pub residual_evaluations: u64,
    /// Factorisations of the system of the network.
    pub factorisations: u64,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected and repeated with half the length.
    pub rejected_steps: u64,
}

impl std::ops::Add for Counters {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            newton_iterations: self.newton_iterations + other.newton_iterations,
            residual_evaluations: self.residual_evaluations + other.residual_evaluations,
            factorisations: self.factorisations + other.factorisations,
            steps: self.steps + other.steps,
            rejected_steps: self.rejected_steps + other.rejected_steps,
        }
    }
}
