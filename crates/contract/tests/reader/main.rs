//! The reader of project files, on a small family that exists only here.

mod edit;
mod merging;
mod numbers;
mod places;
mod stages;
mod studies;
mod toy;
