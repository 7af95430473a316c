//! Exit codes, as documented.

/// Requirements met, or nothing asked.
pub(crate) const MET: u8 = 0;
/// A requirement missed, or one that could not be assessed.
pub(crate) const MISSED: u8 = 1;
/// Error in the file or in the call.
pub(crate) const USAGE: u8 = 2;
/// Not converged, or the travel not reached.
pub(crate) const NOT_CONVERGED: u8 = 3;
/// A file could not be read or written.
pub(crate) const IO: u8 = 4;
/// Interrupted.
pub(crate) const INTERRUPTED: u8 = 130;
