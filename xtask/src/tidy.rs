//! Order in the tree: sizes, leftovers, paths of machines, citations, documentation, examples.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::Workspace;
use crate::examples;
use crate::metadata::Package;
use crate::source::Parts;
use crate::step::output_of;

const FILE_LINES: usize = 800;
const FUNCTION_LINES: usize = 80;
/// In a comment before a function: the reason why it may be long.
const LONG: &str = "long:";

/// The text files of the project: those that git tracks, and new ones that it does not ignore.
#[derive(Debug)]
pub(crate) struct Tree {
    files: Vec<File>,
}

#[derive(Debug)]
struct File {
    path: String,
    text: String,
}

impl File {
    fn is_rust(&self) -> bool {
        Path::new(&self.path).extension().is_some_and(|extension| extension == "rs")
    }
}

impl Tree {
    /// Reads the tree.
    ///
    /// # Errors
    /// When git cannot say which files belong to it.
    pub(crate) fn read(workspace: &Workspace) -> Result<Self, String> {
        let mut git = Command::new("git");
        git.current_dir(&workspace.root).args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
        let list = output_of(&mut git, Duration::from_mins(1))?;
        // What is tracked but deleted, and what is no text, has nothing to check.
        let file = |path: &str| Some(File { path: path.to_owned(), text: std::fs::read_to_string(workspace.root.join(path)).ok()? });
        let mut files: Vec<File> = list.split_terminator('\0').filter_map(file).collect();
        files.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(Self { files })
    }

    fn rust(&self) -> impl Iterator<Item = &File> {
        self.files.iter().filter(|file| file.is_rust())
    }

    fn find(&self, path: &str) -> Option<&File> {
        self.files.iter().find(|file| file.path == path)
    }

    /// Rust files that are too long to read at a sitting.
    pub(crate) fn long_files(&self) -> Vec<String> {
        let lines = |file: &File| file.text.lines().count();
        let long = self.rust().filter(|file| lines(file) > FILE_LINES);
        long.map(|file| format!("{}: {} lines, more than {FILE_LINES}", file.path, lines(file))).collect()
    }

    /// Functions that are too long, and do not say why.
    pub(crate) fn long_functions(&self) -> Vec<String> {
        let mut found = Vec::new();
        for file in self.rust() {
            for function in Parts::of(&file.text).functions() {
                let lines = function.last_line + 1 - function.first_line;
                if lines > FUNCTION_LINES && !says_why_long(&file.text, function.first_line) {
                    let (path, name, line) = (&file.path, function.name, function.first_line);
                    found.push(format!("{path}:{line}: fn {name} has {lines} lines, more than {FUNCTION_LINES}; split it, or say why above it: `// {LONG} …`"));
                }
            }
        }
        found
    }

    /// Code that says of itself that it is not finished.
    pub(crate) fn unfinished(&self) -> Vec<String> {
        // Taken apart so that this file does not name itself.
        let macros = [concat!("to", "do!("), concat!("unimp", "lemented!(")];
        let words = [concat!("FIX", "ME"), concat!("XX", "X")];
        let mut found = Vec::new();
        for file in &self.files {
            let parts = file.is_rust().then(|| Parts::of(&file.text));
            let (code, notes) = parts.as_ref().map_or(("", file.text.as_str()), |parts| (parts.code.as_str(), parts.comments.as_str()));
            let at = |text: &str, place: usize| format!("{}:{}", file.path, 1 + text[..place].matches('\n').count());
            for name in macros {
                found.extend(code.match_indices(name).map(|(place, _)| format!("{}: `{name}…)`", at(code, place))));
            }
            for word in words {
                found.extend(whole_words(notes, word).map(|place| format!("{}: {word}", at(notes, place))));
            }
        }
        found
    }

    /// Absolute paths that exist on one machine only.
    pub(crate) fn machine_paths(&self, root: &Path) -> Vec<String> {
        let places = machine_places(root);
        let mut found = Vec::new();
        for file in &self.files {
            for (number, line) in file.text.lines().enumerate() {
                if let Some(place) = places.iter().find(|place| has_path(line, place)) {
                    found.push(format!("{}:{}: path of a machine: `{place}`", file.path, number + 1));
                }
            }
        }
        found
    }

    /// Citations in the code without an entry in the bibliography.
    pub(crate) fn unknown_citations(&self) -> Vec<String> {
        let keys: Vec<&str> = self.find("REFERENCES.bib").map_or_else(Vec::new, |file| bibliography_keys(&file.text));
        let mut found = Vec::new();
        for file in self.rust() {
            for (line, key) in cited_keys(&file.text) {
                if !keys.contains(&key.as_str()) {
                    found.push(format!("{}:{line}: `{key}` is not in REFERENCES.bib", file.path));
                }
            }
        }
        found
    }

    /// Crates without a README and without documentation at the head of their library.
    pub(crate) fn undocumented_crates(&self, packages: &[Package]) -> Vec<String> {
        let documented = |package: &&Package| {
            let head = self.find(&format!("{}/src/lib.rs", package.folder)).map(|file| file.text.trim_start());
            self.find(&format!("{}/README.md", package.folder)).is_some() || head.is_some_and(|text| text.starts_with("//!"))
        };
        let crates = packages.iter().filter(|package| package.folder.starts_with("crates/"));
        crates
            .filter(|package| !documented(package))
            .map(|package| format!("{}: neither README.md nor `//!` in src/lib.rs", package.folder))
            .collect()
    }

    /// Project files of the gallery that the tests would not run.
    pub(crate) fn examples_not_run(&self, root: &Path) -> Vec<String> {
        let run: Vec<String> = match examples::all(root) {
            Ok(examples) => examples.into_iter().map(|example| example.path).collect(),
            Err(error) => return vec![error],
        };
        let in_gallery = |file: &&File| {
            file.path.starts_with("examples/") && Path::new(&file.path).extension().is_some_and(|extension| extension == "toml")
        };
        let here: Vec<&File> = self.files.iter().filter(in_gallery).collect();
        let mut found: Vec<String> =
            here.iter().filter(|file| !run.contains(&file.path)).map(|file| format!("{}: not run by the tests", file.path)).collect();
        let ignored = run.iter().filter(|path| self.find(path).is_none());
        found.extend(ignored.map(|path| format!("{path}: run here, but git ignores it")));
        if run.is_empty() {
            found.push("examples/: no project file".into());
        }
        found
    }
}

/// Whether the comments and attributes right above the line give a reason.
fn says_why_long(text: &str, first_line: usize) -> bool {
    let lines: Vec<&str> = text.lines().take(first_line - 1).collect();
    let above = lines.iter().rev().map(|line| line.trim()).take_while(|line| line.starts_with("//") || line.starts_with("#["));
    above.filter(|line| line.starts_with("//")).any(|line| line.split_once(LONG).is_some_and(|(_, reason)| !reason.trim().is_empty()))
}

fn whole_words<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word)
        .map(|(place, _)| place)
        .filter(move |&place| !text[..place].ends_with(is_word) && !text[place + word.len()..].starts_with(is_word))
}

/// Where people and services keep checkouts, and where this one lies.
fn machine_places(root: &Path) -> Vec<String> {
    let separator = "/";
    let mut places: Vec<String> =
        ["home", "root", "Users", "builds", "workspace"].iter().map(|name| [separator, name, separator].concat()).collect();
    places.push(["C:", "Users", ""].join("\\"));
    let standard = ["tmp", "usr", "opt", "var", "mnt", "srv", "src", "etc", "private"];
    for folder in root.ancestors().filter(|folder| folder.parent().is_some()) {
        let is_standard =
            folder.components().count() == 2 && folder.file_name().is_some_and(|name| standard.iter().any(|known| name == *known));
        let place = format!("{}{separator}", folder.display());
        if !is_standard && !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// Whether the path stands in the line as a beginning: in a web address or behind a dot it does not.
fn has_path(line: &str, place: &str) -> bool {
    line.match_indices(place).any(|(at, _)| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "_-./~*}>".contains(c)))
}

/// Keys of the entries of a `BibTeX` file.
fn bibliography_keys(text: &str) -> Vec<&str> {
    text.lines()
        .filter_map(|line| line.trim_start().strip_prefix('@')?.split_once('{')?.1.split_once(','))
        .map(|(key, _)| key.trim())
        .collect()
}

/// Line and key of each `Citation { key: "…"` in the code.
fn cited_keys(text: &str) -> Vec<(usize, String)> {
    let code = Parts::of(text).code;
    let mut found = Vec::new();
    for place in whole_words(&code, "Citation") {
        let rest = &text[place + "Citation".len()..];
        let key = rest
            .trim_start()
            .strip_prefix('{')
            .and_then(|rest| rest.trim_start().strip_prefix("key:"))
            .and_then(|rest| rest.trim_start().strip_prefix('"'));
        if let Some((key, _)) = key.and_then(|rest| rest.split_once('"')) {
            found.push((1 + text[..place].matches('\n').count(), key.to_owned()));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(path: &str, text: &str) -> Tree {
        Tree { files: vec![File { path: path.into(), text: text.into() }] }
    }

    #[test]
    fn long_files_and_functions_are_found_and_a_reason_is_accepted() {
        assert_eq!(tree("a.rs", &"\n".repeat(800)).long_files().len(), 0);
        assert_eq!(tree("a.rs", &"\n".repeat(801)).long_files().len(), 1);
        assert_eq!(tree("a.md", &"\n".repeat(801)).long_files().len(), 0);
        let function = |above: &str, lines: usize| format!("{above}fn a() {{\n{}}}\n", "    x();\n".repeat(lines - 2));
        let found = |above: &str, lines: usize| tree("a.rs", &function(above, lines)).long_functions().len();
        assert_eq!(found("", 80), 0);
        assert_eq!(found("", 81), 1);
        assert_eq!(found("/// A.\n// long: one table.\n#[inline]\n", 81), 0);
        assert_eq!(found("// long:\n", 81), 1);
        assert_eq!(found("// long: another one.\nfn b() {}\n\n", 81), 1);
    }

    #[test]
    fn unfinished_code_is_found_outside_strings() {
        let mac = concat!("to", "do!()");
        let word = concat!("FIX", "ME");
        assert_eq!(
            tree("a.rs", &format!("fn a() {{ {mac} }} // {word}\n")).unfinished(),
            [format!("a.rs:1: `{}…)`", &mac[..6]), format!("a.rs:1: {word}")]
        );
        assert!(tree("a.rs", &format!("let a = \"{mac} {word}\";\n")).unfinished().is_empty());
        assert_eq!(tree("a.md", &format!("x\n{word}: later\n")).unfinished(), [format!("a.md:2: {word}")]);
        assert!(tree("a.md", &format!("{word}D\n")).unfinished().is_empty());
    }

    #[test]
    fn paths_of_machines_are_found_and_addresses_are_not() {
        let home = ["", "home", "ada", "x"].join("/");
        let found = |text: &str| tree("a.md", text).machine_paths(Path::new("/data/checkout")).len();
        assert_eq!(found(&format!("see `{home}`")), 1);
        assert_eq!(found(&format!("https://example.org{home}")), 0);
        assert_eq!(found("open /data/checkout/a.toml"), 1);
        assert_eq!(found("open /tmp/a.toml, ./data/checkout/, docs/data/"), 0);
    }

    #[test]
    fn citations_must_be_in_the_bibliography() {
        let code = "const A: Citation = Citation { key: \"lan2010\", text: \"\" };\nlet b = Citation {\n    key: \"nobody1999\",\n};\nstruct Citation { key: u8 }\n";
        let mut tree = tree("a.rs", code);
        assert_eq!(tree.unknown_citations().len(), 2);
        tree.files.push(File { path: "REFERENCES.bib".into(), text: "% sources\n@article{lan2010,\n  title = {x},\n}\n".into() });
        assert_eq!(tree.unknown_citations(), ["a.rs:2: `nobody1999` is not in REFERENCES.bib"]);
    }

    #[test]
    fn a_crate_needs_a_readme_or_documentation() {
        let package = Package { name: "a".into(), description: String::new(), folder: "crates/a".into(), dependencies: vec![] };
        assert_eq!(tree("crates/a/src/lib.rs", "pub fn a() {}\n").undocumented_crates(std::slice::from_ref(&package)).len(), 1);
        assert!(tree("crates/a/src/lib.rs", "//! A.\n").undocumented_crates(std::slice::from_ref(&package)).is_empty());
        assert!(tree("crates/a/README.md", "# A\n").undocumented_crates(&[package]).is_empty());
    }
}
