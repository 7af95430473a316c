//! From numbers to counts: what lies beyond the range of a count becomes its end.

/// The whole number next to a value; 0 of what is not a number.
#[allow(clippy::cast_possible_truncation, reason = "a cast from float saturates")]
pub(crate) fn whole(x: f64) -> i64 {
    x.round() as i64
}

/// The same for small numbers with a sign.
pub(crate) fn small(x: f64) -> i32 {
    i32::try_from(whole(x)).unwrap_or(if x > 0.0 { i32::MAX } else { i32::MIN })
}

/// How many: at least 0.
pub(crate) fn count(x: f64) -> usize {
    usize::try_from(whole(x)).unwrap_or(if x > 0.0 { usize::MAX } else { 0 })
}

/// The same for small numbers.
pub(crate) fn few(x: f64) -> u32 {
    u32::try_from(whole(x)).unwrap_or(if x > 0.0 { u32::MAX } else { 0 })
}
