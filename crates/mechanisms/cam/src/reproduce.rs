//! The paper's numbers beside ours.
use forcewright_contract::family::Reproduction;

/// The papers.
pub(crate) const ALL: &[Reproduction] = &[];
