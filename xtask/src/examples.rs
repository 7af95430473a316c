//! The gallery: every project file under `examples/` is run, without exclusions.

use std::path::{Path, PathBuf};

/// A project file and how its run must end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Example {
    /// Path from the workspace's root, with forward slashes.
    pub(crate) path: String,
    /// Exit code of `solve`.
    pub(crate) exit: i32,
}

impl Example {
    /// A folder name for its results: `compliant-lan-table3`.
    pub(crate) fn slug(&self) -> String {
        self.path.trim_start_matches("examples/").trim_end_matches(".toml").replace('/', "-")
    }

    /// Exit code of `check`: it reads and judges the file but knows no requirement.
    pub(crate) fn exit_of_check(&self) -> i32 {
        if self.exit == 2 { 2 } else { 0 }
    }
}

/// All project files under `examples/`, by path.
///
/// # Errors
/// When a file cannot be read, or its `# expect:` line cannot be understood.
pub(crate) fn all(root: &Path) -> Result<Vec<Example>, String> {
    let mut files = Vec::new();
    collect(&root.join("examples"), &mut files)?;
    files.sort();
    files.iter().map(|file| read(root, file)).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let cannot = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            files.push(path);
        }
    }
    Ok(())
}

fn read(root: &Path, file: &Path) -> Result<Example, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let path = file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/");
    let exit = expected_exit(&text).map_err(|error| format!("{path}: {error}"))?;
    Ok(Example { path, exit })
}

/// The exit code in a comment `# expect: exit 1` among the leading comments; 0 without one.
fn expected_exit(text: &str) -> Result<i32, String> {
    let comments = text.lines().take_while(|line| line.trim().is_empty() || line.starts_with('#'));
    let mut expected = comments.filter_map(|line| line.trim_start_matches('#').trim().strip_prefix("expect:"));
    let Some(line) = expected.next() else { return Ok(0) };
    let code = line.trim().strip_prefix("exit ").and_then(|code| code.trim().parse().ok());
    match (code, expected.next()) {
        (Some(code @ 0..=4), None) => Ok(code),
        (_, Some(_)) => Err("two lines `# expect:`".into()),
        _ => Err(format!("`# expect:{line}` is not understood; write `# expect: exit N` with N from 0 to 4")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expected_exit_code_stands_in_the_leading_comments() {
        assert_eq!(expected_exit("schema = 1\n"), Ok(0));
        assert_eq!(expected_exit("# A miss.\n\n# expect: exit 1\nschema = 1\n"), Ok(1));
        assert_eq!(expected_exit("schema = 1\n# expect: exit 1\n"), Ok(0));
        assert!(expected_exit("# expect: failure\n").is_err());
        assert!(expected_exit("# expect: exit 9\n").is_err());
        assert!(expected_exit("# expect: exit 1\n# expect: exit 2\n").is_err());
    }

    #[test]
    fn names_of_results_and_of_checks_follow_from_the_example() {
        let example = |exit| Example { path: "examples/compliant/lan-table3.toml".into(), exit };
        assert_eq!(example(0).slug(), "compliant-lan-table3");
        assert_eq!([example(0), example(1), example(2), example(3)].map(|example| example.exit_of_check()), [0, 0, 2, 0]);
    }
}
