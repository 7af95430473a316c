//! Smooth constrained optimisation: sequential quadratic programming with exact gradients.
