//! Whatever is typed: no panic, an error with a code and a way out or a project, nothing raw on the terminal, and every digit kept.

mod common;

use common::EXAMPLE;
use forcewright::base::diagnostics::Severity;
use forcewright::base::units::{Dimension, Quantity};
use forcewright::{Choices, Loaded};
use proptest::prelude::*;

/// Reads a text as a project and checks what is promised of any text.
fn read(text: &str, set: &[String]) -> Result<(), TestCaseError> {
    let variant = text.len().is_multiple_of(3);
    let choices = Choices { variant: variant.then(|| "paper".to_owned()), set: set.to_vec() };
    let Err(refused) = Loaded::from_text("a.toml", text, &choices) else { return Ok(()) };
    prop_assert!(refused.errors() > 0);
    let mut before = None;
    for diagnostic in refused.diagnostics.in_file_order() {
        let known = forcewright::explanations().any(|e| e.code == diagnostic.code);
        prop_assert!(known, "{} is not explained", diagnostic.code);
        prop_assert!(diagnostic.help.as_ref().is_some_and(|h| !h.is_empty()), "{} has no help", diagnostic.code);
        prop_assert_eq!(diagnostic.severity == Severity::Warning, diagnostic.code.starts_with('W'));
        prop_assert!(before <= diagnostic.span);
        before = diagnostic.span;
    }
    let raw = |c: char| c.is_control() && c != '\n' && c != '\t';
    prop_assert!(!refused.render(false).contains(raw));
    let _ = refused.render(true);
    Ok(())
}

/// Words of the language, of TOML, and of nobody.
fn token() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("\"1 mm\"".to_owned()),
        Just("\"5 N*m\"".to_owned()),
        Just("\"1 mm ± 2 %\"".to_owned()),
        Just("nan".to_owned()),
        Just("1e400".to_owned()),
        Just("[[design.beams]]\n".to_owned()),
        Just("[load]\n".to_owned()),
        Just("\"\"\"".to_owned()),
        Just("design.beams.b1.bend = [1]\n".to_owned()),
        Just("{ at = [\"1 mm\", \"2 mm\"] }".to_owned()),
        Just("\u{1b}[31m".to_owned()),
        Just("0x1F".to_owned()),
        "[=.,{}\\[\\]#'\"\\\\\n\r\t ]{1,3}",
        any::<f64>().prop_map(|v| v.to_string()),
        any::<f64>().prop_map(|v| format!("\"{v} GPa\"")),
        any::<i64>().prop_map(|v| v.to_string()),
        "\\PC{1,8}",
    ]
}

#[derive(Clone, Debug)]
enum Edit {
    Delete(prop::sample::Index, usize),
    Double(prop::sample::Index, usize),
    Insert(prop::sample::Index, String),
    SwapLines(prop::sample::Index, prop::sample::Index),
    SwapWords(prop::sample::Index, prop::sample::Index),
}

fn edit() -> impl Strategy<Value = Edit> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        (at(), 1_usize..40).prop_map(|(a, n)| Edit::Delete(a, n)),
        (at(), 1_usize..200).prop_map(|(a, n)| Edit::Double(a, n)),
        (at(), token()).prop_map(|(a, t)| Edit::Insert(a, t)),
        (at(), at()).prop_map(|(a, b)| Edit::SwapLines(a, b)),
        (at(), at()).prop_map(|(a, b)| Edit::SwapWords(a, b)),
    ]
}

fn swap(parts: &mut [&str], a: prop::sample::Index, b: prop::sample::Index) -> String {
    if !parts.is_empty() {
        parts.swap(a.index(parts.len()), b.index(parts.len()));
    }
    parts.concat()
}

fn apply(text: &str, edit: &Edit) -> String {
    let letters: Vec<char> = text.chars().collect();
    let cut = |at: prop::sample::Index, n: usize| {
        let from = at.index(letters.len() + 1);
        (from, (from + n).min(letters.len()))
    };
    let join = |parts: &[&[char]]| parts.concat().into_iter().collect::<String>();
    match edit {
        Edit::Delete(at, n) => {
            let (from, to) = cut(*at, *n);
            join(&[&letters[..from], &letters[to..]])
        }
        Edit::Double(at, n) => {
            let (from, to) = cut(*at, *n);
            join(&[&letters[..to], &letters[from..]])
        }
        Edit::Insert(at, token) => {
            let (from, _) = cut(*at, 0);
            join(&[&letters[..from], &token.chars().collect::<Vec<_>>(), &letters[from..]])
        }
        Edit::SwapLines(a, b) => swap(&mut text.split_inclusive('\n').collect::<Vec<_>>(), *a, *b),
        Edit::SwapWords(a, b) => swap(&mut text.split_inclusive(' ').collect::<Vec<_>>(), *a, *b),
    }
}

/// A unit of a dimension, from those that messages recommend.
fn dimension_and_unit() -> impl Strategy<Value = (Dimension, String)> {
    let all: Vec<(Dimension, String)> = Dimension::all()
        .flat_map(|d| d.accepted().split(", ").map(move |unit| (d, unit.to_owned())).collect::<Vec<_>>())
        .map(|(d, unit)| (d, if unit.contains("bare") { String::new() } else { unit }))
        .collect();
    prop::sample::select(all)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*|(?s:.{0,300})", set in prop::collection::vec("(?s:.{0,40})", 0..2)) {
        read(&text, &set)?;
    }

    #[test]
    fn any_tokens_are_read_or_refused(tokens in prop::collection::vec(token(), 0..40)) {
        read(&format!("schema = 1\nmechanism = \"compliant\"\n{}", tokens.join(" ")), &[])?;
    }

    #[test]
    fn any_edit_of_a_project_is_read_or_refused(edits in prop::collection::vec(edit(), 1..6), value in token()) {
        let text = edits.iter().fold(EXAMPLE.to_owned(), |text, edit| apply(&text, edit));
        read(&text, &[format!("design.depth={value}")])?;
    }

    #[test]
    fn any_setting_is_read_or_refused(path in prop::sample::select(forcewright::FAMILIES[0].parameter_paths()), value in token()) {
        let path = path.replace("nodes.*", "nodes.n5").replace("beams.*", "beams.b1");
        read(EXAMPLE, &[format!("{path}={value}"), format!("{path}.{value}={value}")])?;
    }

    #[test]
    fn any_bytes_have_a_first_bad_one_or_are_read(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read(&String::from_utf8_lossy(&bytes), &[])?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_printed_reads_back_to_the_last_bit(head in -10.0..10.0_f64, power in -200_i32..200, (dimension, unit) in dimension_and_unit()) {
        let typed = format!("{head}e{power} {unit}");
        let quantity = Quantity::parse(&typed, dimension).map_err(|e| TestCaseError::fail(format!("{typed}: {e:?}")))?;
        let printed = quantity.to_string();
        let back = Quantity::parse(&printed, dimension).map_err(|e| TestCaseError::fail(format!("{printed}: {e:?}")))?;
        prop_assert_eq!(quantity.si.to_bits(), back.si.to_bits(), "{} printed as {}", typed, printed);
        prop_assert_eq!(printed.clone(), back.to_string());
        // In the unit typed.
        prop_assert!(printed.ends_with(&quantity.unit.pretty()));
    }

    #[test]
    fn what_people_type_is_printed_as_typed(digits in 1_i64..1_000_000, places in 0_usize..4, (dimension, unit) in dimension_and_unit()) {
        let text = format!("{:.places$}", digits as f64 / [1.0, 10.0, 100.0, 1000.0][places]);
        let plain = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text };
        let quantity = Quantity::parse(&format!("{plain} {unit}"), dimension).unwrap();
        let printed = quantity.to_string();
        prop_assert_eq!(printed.split(' ').next(), Some(plain.as_str()));
    }

    #[test]
    fn no_text_makes_a_quantity_panic(text in "\\PC{0,30}|[-+0-9.eE,±% µmNh7*/^²·]{0,24}", dimension in prop::sample::select(Dimension::all().collect::<Vec<_>>())) {
        if let Ok(quantity) = Quantity::parse(&text, dimension) {
            prop_assert!(quantity.si.is_finite());
            let printed = quantity.to_string();
            prop_assert!(Quantity::parse(&printed, dimension).is_ok(), "{} printed as {}", text, printed);
        }
    }
}
