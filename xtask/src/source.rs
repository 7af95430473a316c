//! Just enough of Rust's lexical rules to tell code, comments and strings apart.

/// A source text taken apart; both parts keep the length and the line breaks of the whole, with blanks for the rest.
#[derive(Debug)]
pub(crate) struct Parts {
    /// Code without comments and without the insides of strings and characters.
    pub(crate) code: String,
    /// Comments with their slashes.
    pub(crate) comments: String,
}

/// A function with a body.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Function {
    /// Its name.
    pub(crate) name: String,
    /// Line of `fn`, from 1.
    pub(crate) first_line: usize,
    /// Line of the closing brace, from 1.
    pub(crate) last_line: usize,
}

impl Parts {
    /// Takes a source text apart.
    pub(crate) fn of(text: &str) -> Self {
        let bytes = text.as_bytes();
        let blank: Vec<u8> = bytes.iter().map(|&byte| if byte == b'\n' { b'\n' } else { b' ' }).collect();
        let (mut code, mut comments) = (blank.clone(), blank);
        let mut at = 0;
        while at < bytes.len() {
            let end = token_end(bytes, at);
            match bytes[at] {
                b'/' if end > at + 1 => comments[at..end].copy_from_slice(&bytes[at..end]),
                b'"' => (code[at], code[end - 1]) = (b'"', b'"'),
                b'r' | b'\'' if end > at + 1 => {}
                _ => code[at..end].copy_from_slice(&bytes[at..end]),
            }
            at = end;
        }
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        Self { code: text(code), comments: text(comments) }
    }

    /// All functions that have a body.
    pub(crate) fn functions(&self) -> Vec<Function> {
        let bytes = self.code.as_bytes();
        let line = |at: usize| 1 + self.code[..at].matches('\n').count();
        let mut found = Vec::new();
        for (at, _) in self.code.match_indices("fn") {
            let is_word = !(at > 0 && is_word_byte(bytes[at - 1])) && bytes.get(at + 2).is_some_and(u8::is_ascii_whitespace);
            let name: String = self.code[at + 2..].trim_start().chars().take_while(|&c| c.is_alphanumeric() || c == '_').collect();
            if is_word
                && !name.is_empty()
                && let Some(end) = body_end(bytes, at)
            {
                found.push(Function { name, first_line: line(at), last_line: line(end) });
            }
        }
        found
    }
}

fn is_word_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || !byte.is_ascii()
}

/// The end of what begins at `at`: a comment, a string, a character, or one byte of anything else.
fn token_end(bytes: &[u8], at: usize) -> usize {
    let rest = &bytes[at..];
    let length = match rest[0] {
        b'/' if rest.starts_with(b"//") => rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len()),
        b'/' if rest.starts_with(b"/*") => block_comment_length(rest),
        b'"' => quoted_length(rest, b'"'),
        b'r' if at == 0 || !is_word_byte(bytes[at - 1]) || is_raw_prefix(bytes, at) => raw_string_length(rest).unwrap_or(1),
        b'\'' => character_length(rest).unwrap_or(1),
        _ => 1,
    };
    at + length
}

/// Whether the `r` at `at` belongs to `br"…"` or `cr"…"`.
fn is_raw_prefix(bytes: &[u8], at: usize) -> bool {
    matches!(bytes[at - 1], b'b' | b'c') && (at == 1 || !is_word_byte(bytes[at - 2]))
}

fn block_comment_length(rest: &[u8]) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < rest.len() {
        match &rest[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    rest.len()
}

fn quoted_length(rest: &[u8], quote: u8) -> usize {
    let mut at = 1;
    while at < rest.len() {
        match rest[at] {
            b'\\' => at += 2,
            byte if byte == quote => return at + 1,
            _ => at += 1,
        }
    }
    rest.len()
}

fn raw_string_length(rest: &[u8]) -> Option<usize> {
    let hashes = rest[1..].iter().take_while(|&&byte| byte == b'#').count();
    if rest.get(1 + hashes) != Some(&b'"') {
        return None;
    }
    let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
    let start = 2 + hashes;
    Some(rest[start..].windows(end.len()).position(|window| window == end).map_or(rest.len(), |at| start + at + end.len()))
}

/// The length of `'x'` or `'\n'`; `None` for a lifetime.
fn character_length(rest: &[u8]) -> Option<usize> {
    if rest.get(1) == Some(&b'\\') {
        return Some(quoted_length(rest, b'\''));
    }
    // A character has at most four bytes.
    let end = rest.iter().skip(2).take(4).position(|&byte| byte == b'\'')? + 2;
    std::str::from_utf8(&rest[1..end]).is_ok_and(|text| text.chars().count() == 1).then_some(end + 1)
}

/// Place of the brace that closes the body of the function at `at`; `None` for one without a body.
fn body_end(code: &[u8], at: usize) -> Option<usize> {
    let (mut brackets, mut braces) = (0_usize, 0_usize);
    for (offset, byte) in code[at..].iter().enumerate() {
        match byte {
            b'(' | b'[' => brackets += 1,
            b')' | b']' => brackets = brackets.saturating_sub(1),
            b';' if brackets == 0 && braces == 0 => return None,
            b'{' => braces += 1,
            b'}' => {
                braces = braces.checked_sub(1)?;
                if braces == 0 {
                    return Some(at + offset);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_characters_and_comments_are_not_code() {
        let text = r##"let a = "fn x() { // no"; // fn y() {
let b = r#"raw " fn z() {"#; let c = '{'; let d: &'static str = "\""; let e = '\''; let f = 'é'; let g = br"\"; /* fn /* q */ { */ end"##;
        let parts = Parts::of(text);
        assert_eq!(parts.code.len(), text.len());
        assert!(!parts.code.contains('{') && !parts.code.contains("fn"), "{}", parts.code);
        assert!(parts.code.contains("'static str") && parts.code.ends_with("end"), "{}", parts.code);
        assert!(parts.comments.contains("// fn y() {") && parts.comments.contains("/* fn /* q */ { */"), "{}", parts.comments);
        assert!(!parts.comments.contains("raw"), "{}", parts.comments);
    }

    #[test]
    fn functions_are_found_with_their_lines() {
        let text = "trait T {\n    fn without(&self) -> [u8; 3];\n    fn with(&self) -> u8 {\n        if true { 1 } else { 2 }\n    }\n}\ntype F = fn(u8);\nfn one() {}\n";
        let found = Parts::of(text).functions();
        let function = |name: &str, first_line, last_line| Function { name: name.into(), first_line, last_line };
        assert_eq!(found, [function("with", 3, 5), function("one", 8, 8)]);
    }

    #[test]
    fn unfinished_text_does_not_panic() {
        for text in ["\"", "'", "'a", "/*", "r#\"", "r#", "\"\\", "fn", "fn a", "fn a() {", "'\\", "b", "/"] {
            Parts::of(text).functions();
        }
    }
}
