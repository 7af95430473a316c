//! The file of one array of `numpy`, format version 1.0 (`numpy.lib.format`): a header of text padded to 64 bytes, then the numbers.

use std::io::{self, Write};

/// Writes the header of a two-dimensional array of little-endian doubles, row after row.
pub(super) fn header(rows: u64, columns: usize, out: &mut dyn Write) -> io::Result<()> {
    let mut text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Magic, version, length: ten bytes; the whole header with its line end is a multiple of 64.
    let blank = (64 - (10 + text.len() + 1) % 64) % 64;
    text.push_str(&" ".repeat(blank));
    text.push('\n');
    let length = u16::try_from(text.len()).map_err(io::Error::other)?;
    out.write_all(b"\x93NUMPY\x01\x00")?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Writes a number.
pub(super) fn number(value: f64, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(&value.to_le_bytes())
}
