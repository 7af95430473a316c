//! The reader of project files, on a small family that exists only here.

mod merging;
mod places;
mod stages;
mod toy;
