//! Tables for the terminal.

/// How a column is aligned.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    /// Texts.
    Left,
    /// Numbers.
    Right,
}

/// Rows of cells as aligned columns, two spaces apart, no trailing blanks.
pub(crate) fn columns(rows: &[Vec<String>], align: &[Align]) -> String {
    let widths: Vec<usize> =
        (0..align.len()).map(|c| rows.iter().filter_map(|r| r.get(c)).map(|t| t.chars().count()).max().unwrap_or(0)).collect();
    let mut out = String::new();
    for row in rows {
        let cells: Vec<String> = row
            .iter()
            .zip(align)
            .zip(&widths)
            .map(|((text, align), width)| {
                let blank = " ".repeat(width - text.chars().count());
                if *align == Align::Left { format!("{text}{blank}") } else { format!("{blank}{text}") }
            })
            .collect();
        out.push_str(cells.join("  ").trim_end());
        out.push('\n');
    }
    out
}
