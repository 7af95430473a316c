//! Curves: one quantity over another, in named branches.

use forcewright_base::units::{Dimension, Unit};

/// What an axis carries.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Stable name for scripts: `displacement`.
    pub name: &'static str,
    /// Name for people, with the symbol: `Displacement Δ`.
    pub label: String,
    /// Quantity of the values, which are SI.
    pub dimension: Dimension,
    /// The unit in which people are shown it.
    pub display: Unit,
}

/// One connected piece of a curve, such as `loading`.
#[derive(Clone, Debug)]
pub struct Branch {
    /// Stable name for scripts.
    pub name: String,
    /// Abscissae, SI, in the order of the path.
    pub x: Vec<f64>,
    /// Ordinates, SI, as many as abscissae.
    pub y: Vec<f64>,
}

/// One quantity over another.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Stable name for scripts: `force`.
    pub name: &'static str,
    /// Abscissa.
    pub x: Axis,
    /// Ordinate.
    pub y: Axis,
    /// At least one.
    pub branches: Vec<Branch>,
}
