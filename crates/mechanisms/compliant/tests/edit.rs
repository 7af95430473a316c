//! Project files of the gallery with other numbers in them: read back they say what was written, and nothing else has changed.

use std::path::{Path, PathBuf};

use forcewright_compliant::Compliant;
use forcewright_contract::edit::with_values;
use forcewright_contract::family::{Entry, Family};
use forcewright_contract::numbers::Number;
use forcewright_contract::project::{Choices, DiskFiles, FileError, Files, Project};

/// Random edits of each file and variant.
const EDITS: u64 = 24;

fn gallery() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/compliant");
    let files = std::fs::read_dir(folder).expect("the gallery").map(|entry| entry.expect("a file").path());
    let mut all: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    all.sort();
    assert!(all.len() >= 7, "{all:?}");
    all
}

/// The files of the disk with another text in one place.
struct Changed<'a>(&'a Path, &'a str);

impl Files for Changed<'_> {
    fn read(&self, path: &Path) -> Result<String, FileError> {
        if path == self.0 { Ok(self.1.to_owned()) } else { DiskFiles.read(path) }
    }
}

/// The numbers of a project, its parameters as people see them, and its variants.
fn read(path: &Path, text: &str, variant: Option<&str>) -> (Vec<Number>, Vec<String>, Vec<String>) {
    let choices = Choices { variant: variant.map(str::to_owned), set: Vec::new() };
    let mut project = Project::load(&Changed(path, text), path, &choices);
    let understood = Entry::<Compliant>::new().understand(&mut project);
    let Some(understood) = understood else { panic!("{}\n{text}", project.diagnostics.render(&project.sources, false)) };
    let rows = understood.parameters().into_iter().map(|row| format!("{} = {}", row.path, row.value)).collect();
    (understood.numbers().to_vec(), rows, project.variants)
}

/// Numbers from 0 to 1 that look random: Knuth's linear congruential generator.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Some numbers with values a little off: every design stays one.
fn some(numbers: &[Number], seeded: &mut Seeded) -> Vec<(usize, f64)> {
    let part = seeded.next();
    let mut all = Vec::new();
    for (index, number) in numbers.iter().enumerate() {
        let si = number.si * (1.0 + 1e-2 * (seeded.next() - 0.5));
        let [lower, upper] = number.tolerance.and_then(|t| t.deviations_si(si)).unwrap_or_default();
        if seeded.next() < part && number.range.holds(si + lower) && number.range.holds(si + upper) && number.path.starts_with("design.") {
            all.push((index, si));
        }
    }
    all
}

#[test]
fn a_file_with_other_numbers_is_read_as_it_was_written() {
    let mut seeded = Seeded(11);
    let mut written = 0;
    for path in gallery() {
        let text = std::fs::read_to_string(&path).unwrap();
        let variants = read(&path, &text, None).2;
        for variant in std::iter::once(None).chain(variants.iter().map(|v| Some(v.as_str()))) {
            let (numbers, rows, _) = read(&path, &text, variant);
            for _ in 0..EDITS {
                let changed = some(&numbers, &mut seeded);
                let edited = with_values(&text, &numbers, &changed, variant).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                let (after, new_rows, _) = read(&path, &edited, variant);
                assert_eq!(numbers.len(), after.len());
                for (index, (old, new)) in numbers.iter().zip(&after).enumerate() {
                    assert_eq!((&old.path, &old.tolerance, old.part), (&new.path, &new.tolerance, new.part));
                    match changed.iter().find(|c| c.0 == index) {
                        // Seven digits.
                        Some((_, si)) => assert!((new.si - si).abs() <= 5.1e-7 * si.abs(), "{}: {} instead of {si}", old.path, new.si),
                        None => assert_eq!(old.si.to_bits(), new.si.to_bits(), "{}", old.path),
                    }
                }
                // What is no number stays too.
                assert_eq!(rows.len(), new_rows.len(), "{edited}");
                let is_number = |row: &str| {
                    let key = row.split(" = ").next().unwrap_or(row);
                    changed.iter().any(|(i, _)| numbers[*i].path == key || numbers[*i].path.starts_with(&format!("{key}.")))
                };
                assert!(rows.iter().zip(&new_rows).all(|(a, b)| a == b || is_number(a)), "{edited}");
                // Every comment is there, in its order.
                let comments = |text: &str| text.lines().filter_map(|l| l.split_once('#').map(|c| c.1.to_owned())).collect::<Vec<_>>();
                assert_eq!(comments(&text), comments(&edited));
                written += changed.len();
            }
        }
    }
    assert!(written > 1000, "only {written} numbers were written");
}

#[test]
fn a_file_in_which_nothing_changes_is_the_same() {
    for path in gallery() {
        let text = std::fs::read_to_string(&path).unwrap();
        let numbers = read(&path, &text, None).0;
        assert_eq!(with_values(&text, &numbers, &[], None).unwrap(), text);
    }
}
