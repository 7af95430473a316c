//! Exit codes, as documented.

/// Requirements met, or nothing asked.
pub const MET: u8 = 0;
/// A requirement missed, or one that could not be assessed.
pub const MISSED: u8 = 1;
/// Error in the file or in the call.
pub const USAGE: u8 = 2;
/// Not converged, or the travel not reached.
pub const NOT_CONVERGED: u8 = 3;
/// A file could not be read or written.
pub const IO: u8 = 4;
/// Interrupted.
pub const INTERRUPTED: u8 = 130;
