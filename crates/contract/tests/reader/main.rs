//! The reader of project files, on a small family that exists only here.

mod data;
mod edit;
mod fits;
mod merging;
mod numbers;
mod places;
mod stages;
mod studies;
mod toy;
