//! Files for making parts.
