//! Text into markup, and markup from many items.

pub(crate) use forcewright_base::text::xml as escape;

/// Text as markup, where what stands between two backticks is code; a backtick without a partner stays.
pub(crate) fn prose(text: &str) -> String {
    let text = escape(text);
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once('`') {
        out.push_str(before);
        match after.split_once('`') {
            Some((code, more)) if !code.is_empty() => {
                out.push_str("<code>");
                out.push_str(&with_breaks(code));
                out.push_str("</code>");
                rest = more;
            }
            _ => {
                out.push('`');
                rest = after;
            }
        }
    }
    out.push_str(rest);
    out
}

/// A dotted path as markup that may break after its dots and underscores and nowhere else.
pub(crate) fn path(text: &str) -> String {
    with_breaks(&escape(text))
}

/// Markup without elements, with places to break after dots and underscores that join words; not after the points of numbers.
fn with_breaks(markup: &str) -> String {
    let mut out = String::with_capacity(markup.len());
    let mut chars = markup.chars().peekable();
    while let Some(c) = chars.next() {
        out.push(c);
        if matches!(c, '.' | '_') && chars.peek().is_some_and(|next| next.is_alphabetic()) {
            out.push_str("<wbr />");
        }
    }
    out
}

/// One text from all items, each written by the same function.
pub(crate) fn each<T>(items: impl IntoIterator<Item = T>, write: impl Fn(T) -> String) -> String {
    let mut out = String::new();
    for item in items {
        out.push_str(&write(item));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{path, prose};

    #[test]
    fn paired_backticks_become_code() {
        for (text, want) in [
            ("bend `b2` more", "bend <code>b2</code> more"),
            ("`design.safety_factor`", "<code>design.<wbr />safety_<wbr />factor</code>"),
            ("`a<b>` and `-0.05 N`", "<code>a&lt;b&gt;</code> and <code>-0.05 N</code>"),
            ("one ` alone", "one ` alone"),
            ("`x` and ` alone", "<code>x</code> and ` alone"),
            ("``", "``"),
        ] {
            assert_eq!(prose(text), want);
        }
        assert_eq!(path("design.nodes.n3.at"), "design.<wbr />nodes.<wbr />n3.<wbr />at");
    }
}
