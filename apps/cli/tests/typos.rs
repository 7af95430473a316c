//! Misspelt keys and words get the right suggestion in most cases: a seeded list of typos over everything that a project can say.

mod common;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use common::Noise;
use forcewright::contract::family::Family;
use forcewright::{Choices, FAMILIES, Loaded};

/// Rows of a keyboard: a finger that slips hits a neighbour.
const KEYBOARD: [&str; 4] = ["1234567890", "qwertyuiop", "asdfghjkl", "zxcvbnm_-"];

fn neighbour(letter: char, noise: &mut Noise) -> char {
    for row in KEYBOARD {
        if let Some(at) = row.find(letter) {
            let near: Vec<char> = row.chars().skip(at.saturating_sub(1)).take(3).filter(|c| *c != letter).collect();
            return near[noise.below(near.len())];
        }
    }
    'x'
}

/// One of the mistakes that people make.
fn misspell(word: &str, kind: usize, noise: &mut Noise) -> String {
    let mut letters: Vec<char> = word.chars().collect();
    let at = noise.below(letters.len());
    match kind {
        0 => {
            letters.remove(at);
        }
        1 => letters.insert(at, letters[at]),
        2 if at > 0 => letters.swap(at - 1, at),
        3 => letters[at] = neighbour(letters[at], noise),
        4 => return word.to_uppercase(),
        5 => return word.replace('_', "-"),
        // Two slips at once, in words long enough to stay recognisable.
        8 if letters.len() >= 7 => {
            let once = misspell(word, noise.below(4), noise);
            return misspell(&once, noise.below(4), noise);
        }
        8 => return word.to_owned(),
        6 => return word.strip_suffix('s').map_or_else(|| format!("{word}s"), str::to_owned),
        _ => return format!("{}{}", word[..1].to_uppercase(), &word[1..]),
    }
    letters.into_iter().collect()
}
const KINDS: usize = 9;

/// A whole project of every family.
const PROJECTS: [(&str, &str); 4] = [
    ("compliant", common::EXAMPLE),
    ("cam", include_str!("../../../examples/cam/sanchez-2-springs.toml")),
    ("capstan", include_str!("../../../examples/capstan/longval.toml")),
    ("lavt", include_str!("../../../examples/lavt/butin-2.toml")),
];

fn families() -> impl Iterator<Item = (&'static dyn Family, &'static str)> {
    FAMILIES.iter().map(|family| {
        let (_, project) = PROJECTS.iter().find(|(id, _)| *id == family.id()).expect("a project of every family");
        (*family, *project)
    })
}

/// A place, a typo, and what was meant.
struct Typo {
    project: &'static str,
    setting: String,
    typed: String,
    meant: String,
}

/// Typos of the last key of every path; members are called by names that the example has.
fn key_typos(family: &dyn Family, project: &'static str, noise: &mut Noise) -> Vec<Typo> {
    let paths: BTreeSet<String> = family.parameter_paths().into_iter().collect();
    let mut typos = Vec::new();
    // Every metric has the same two bounds; one of them stands for all.
    let bounded = |p: &String| p.starts_with("requirements.limits.") && p.matches('.').count() >= 3;
    let metric = paths.iter().find(|p| bounded(p)).and_then(|p| p.split('.').nth(2)).unwrap_or_default().to_owned();
    let one_of_many = |p: &&String| !bounded(p) || p.split('.').nth(2) == Some(&metric);
    for path in paths.iter().filter(one_of_many) {
        let path = path.replace("nodes.*", "nodes.n5").replace("beams.*", "beams.b1");
        let (front, key) = path.rsplit_once('.').map_or(("", path.as_str()), |(front, key)| (front, key));
        let siblings: Vec<&str> = paths.iter().map(|p| p.rsplit('.').next().unwrap_or(p)).filter(|k| k.len() > 2 || *k == "at").collect();
        for kind in 0..KINDS {
            let typed = misspell(key, kind, noise);
            // A typo that is another word of the language is no typo; one letter alone says nothing.
            if typed == key || typed.len() < 2 || siblings.contains(&typed.as_str()) {
                continue;
            }
            let prefix = if front.is_empty() { String::new() } else { format!("{front}.") };
            typos.push(Typo { project, setting: format!("{prefix}{typed}=1"), typed, meant: key.to_owned() });
        }
    }
    typos
}

/// Every place in a schema with a closed set of words.
fn words_of(schema: &serde_json::Value, path: &str, found: &mut Vec<(String, Vec<String>)>) {
    if let Some(words) = schema["enum"].as_array() {
        found.push((path.to_owned(), words.iter().filter_map(|w| w.as_str().map(str::to_owned)).collect()));
    }
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        words_of(inner, &below(key), found);
    }
    if schema["additionalProperties"].is_object() {
        words_of(&schema["additionalProperties"], &below("n5"), found);
    }
}

fn word_typos(family: &dyn Family, project: &'static str, noise: &mut Noise) -> Vec<Typo> {
    let mut places = Vec::new();
    words_of(&family.json_schema(), "", &mut places);
    let mut typos = Vec::new();
    for (path, words) in &places {
        for word in words {
            for kind in 0..KINDS {
                let typed = misspell(word, kind, noise);
                if !words.contains(&typed) && typed.len() >= 2 {
                    typos.push(Typo { project, setting: format!("{path}=\"{typed}\""), typed, meant: word.clone() });
                }
            }
        }
    }
    typos
}

/// The first suggestion for a typo.
fn suggestion(typo: &Typo) -> Option<String> {
    let choices = Choices { variant: None, set: vec![typo.setting.clone()] };
    let refused = Loaded::from_text("a.toml", typo.project, &choices).err()?;
    let diagnostic = refused
        .diagnostics
        .in_file_order()
        .into_iter()
        .find(|d| matches!(d.code, "E0301" | "E0303") && d.message.contains(&format!("`{}`", typo.typed)))?;
    let help = diagnostic.help.as_deref()?.strip_prefix("did you mean ")?;
    help.split(['`', '"']).nth(1).map(str::to_owned)
}

fn assert_rate(typos: &[Typo], least: f64) {
    let mut wrong = String::new();
    let mut right = 0_usize;
    for typo in typos {
        match suggestion(typo) {
            Some(word) if word == typo.meant => right += 1,
            other => {
                let _ = writeln!(wrong, "{} → {}, meant {}", typo.setting, other.as_deref().unwrap_or("nothing"), typo.meant);
            }
        }
    }
    let rate = right as f64 / typos.len() as f64;
    assert!(rate >= least, "{right} of {} suggestions right ({:.1} %); wrong:\n{wrong}", typos.len(), 100.0 * rate);
}

#[test]
fn misspelt_keys_are_recognised() {
    for (family, project) in families() {
        let typos = key_typos(family, project, &mut Noise(2010));
        assert!(typos.len() > 300, "{}: only {} typos", family.id(), typos.len());
        assert_rate(&typos, 0.9);
    }
}

#[test]
fn misspelt_words_are_recognised() {
    for (family, project) in families() {
        let typos = word_typos(family, project, &mut Noise(2010));
        assert!(typos.len() > 40, "{}: only {} typos", family.id(), typos.len());
        assert_rate(&typos, 0.9);
    }
}
