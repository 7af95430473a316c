//! The contract between mechanism families and everything else. Layer 2: the project file (tree, merging, reading, schema) and the
//! traits that a family implements.

pub mod calibration;
pub mod catalogue;
pub mod codes;
#[cfg(feature = "conformance")]
pub mod conformance;
pub mod data;
pub mod describe;
pub mod edit;
pub mod family;
pub mod gears;
pub mod header;
pub mod judge;
pub mod measuring;
pub mod metrics;
pub mod numbers;
pub mod objective;
pub mod paths;
pub mod project;
pub mod read;
pub mod reproduction;
pub mod scatter;
pub mod schema;
pub mod studies;
pub mod synthesis;
pub mod tree;
