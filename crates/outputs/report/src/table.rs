//! Tables of the report page.

use std::fmt::Write as _;

use crate::escape::escape;

/// Tables with at most so many rows are not split between pages.
const WHOLE: usize = 14;

/// Tables with more columns than these are wider than the page.
const WIDE: usize = 9;

/// How a column is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Column {
    /// Words, to the left.
    Text,
    /// Numbers, to the right, with figures of equal width.
    Number,
    /// Names that scripts use.
    Code,
}

impl Column {
    fn class(self) -> &'static str {
        match self {
            Self::Text => "",
            Self::Number => " class=\"number\"",
            Self::Code => " class=\"code\"",
        }
    }
}

/// A table being written. Cells are markup: whoever adds them escapes them.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    columns: Vec<Column>,
    titles: Vec<String>,
    label: String,
    head: String,
    body: String,
    rows: usize,
    class: &'static str,
}

impl Table {
    /// A table with a caption and headed columns.
    pub(crate) fn new(class: &'static str, caption: &str, columns: &[(&str, Column)]) -> Self {
        let mut head = format!("<caption>{}</caption>\n<thead><tr>", escape(caption));
        for (title, column) in columns {
            let _ = write!(head, "<th scope=\"col\"{}>{}</th>", column.class(), escape(title));
        }
        head.push_str("</tr></thead>\n");
        let titles = columns.iter().map(|c| escape(c.0)).collect();
        Self { columns: columns.iter().map(|c| c.1).collect(), titles, label: escape(caption), head, body: String::new(), rows: 0, class }
    }

    /// Adds a row; its first cell heads it.
    pub(crate) fn row(&mut self, cells: &[String]) {
        self.rows += 1;
        self.body.push_str("<tr>");
        for (i, ((cell, column), title)) in cells.iter().zip(&self.columns).zip(&self.titles).enumerate() {
            let class = column.class();
            if i == 0 {
                let _ = write!(self.body, "<th scope=\"row\"{class}>{cell}</th>");
            } else {
                let _ = write!(self.body, "<td{class} data-label=\"{title}\">{cell}</td>");
            }
        }
        self.body.push_str("</tr>\n");
    }

    /// Adds rows that are markup already.
    pub(crate) fn rows(&mut self, count: usize, markup: &str) {
        self.rows += count;
        self.body.push_str(markup);
    }

    /// The finished table, in a box that scrolls sideways on narrow screens.
    pub(crate) fn finish(self) -> String {
        // Short tables stay on one page of paper.
        let whole = if self.rows <= WHOLE { " whole" } else { "" };
        let wide = if self.columns.len() > WIDE { " wide" } else { "" };
        let Self { label, head, body, class, .. } = self;
        // The focus lets keyboards scroll.
        format!(
            "<div class=\"scroll{whole}\" role=\"group\" tabindex=\"0\" aria-label=\"{label}\"><table class=\"{class}{wide}\">\n\
             {head}<tbody>\n{body}</tbody>\n</table></div>\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables that are wider than the page keep their words whole, in a box that scrolls.
    #[test]
    fn wide_tables_are_marked() {
        let table = |columns: usize| {
            let columns: Vec<(&str, Column)> = (0..columns).map(|_| ("x", Column::Number)).collect();
            Table::new("data", "caption", &columns).finish()
        };
        assert!(table(WIDE).contains("<table class=\"data\">") && table(WIDE).starts_with("<div class=\"scroll"));
        assert!(table(WIDE + 1).contains("<table class=\"data wide\">"));
        let css = include_str!("report.css");
        assert!(css.contains(".scroll { overflow-x: auto;") && css.contains(".wide {"));
    }
}
