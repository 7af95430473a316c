//! The stories of `docs/book`: every command that a page tells its reader to type is run, in the page's order, in a folder of its own.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::Workspace;
use crate::generate::forcewright;
use crate::step::Steps;
use crate::test::{emptied, ending};

/// How commands of a story begin.
const CALL: &str = "cargo run --release -- ";
/// Folders that commands of a story read.
const SOURCES: [&str; 2] = ["docs/book", "examples"];

/// A command of a story.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Told {
    /// Arguments of `forcewright`.
    arguments: Vec<String>,
    /// Exit code that the page tells: `# exit 1`, or 0.
    exit: i32,
}

/// Runs all stories.
pub(crate) fn run(workspace: &Workspace, folder: &Path, binary: &Path, steps: &mut Steps) {
    let stories = match all(&workspace.root) {
        Ok(stories) => stories,
        Err(error) => {
            steps.run("book", || crate::step::Outcome::Failed(error));
            return;
        }
    };
    for (name, commands) in stories {
        let place = folder.join("book").join(&name);
        let prepared =
            emptied(&place).and_then(|()| SOURCES.iter().try_for_each(|from| copied(&workspace.root.join(from), &place.join(from))));
        if !steps.run(&format!("book {name}: {} commands", commands.len()), || {
            crate::step::Outcome::from_problems(&Vec::from_iter(prepared.err()))
        }) {
            continue;
        }
        for told in commands {
            let passed = steps.run(&format!("book {name}: {}", told.arguments.join(" ")), || {
                let arguments: Vec<&str> = told.arguments.iter().map(String::as_str).collect();
                let mut command = forcewright(workspace, binary, &arguments);
                ending(crate::step::captured(command.current_dir(&place), Duration::from_mins(10)), told.exit)
            });
            if !passed {
                // The commands that follow need what this one writes.
                break;
            }
        }
    }
}

/// The pages with their commands, by name.
fn all(root: &Path) -> Result<Vec<(String, Vec<Told>)>, String> {
    let folder = root.join("docs/book");
    let cannot = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut pages: Vec<PathBuf> = std::fs::read_dir(&folder).map_err(cannot)?.filter_map(|e| Some(e.ok()?.path())).collect();
    pages.retain(|path| path.extension().is_some_and(|e| e == "md"));
    pages.sort();
    pages
        .iter()
        .map(|path| {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
            let commands = told(&text).map_err(|error| format!("{}: {error}", path.display()))?;
            if commands.is_empty() { Err(format!("{}: no command", path.display())) } else { Ok((name, commands)) }
        })
        .collect()
}

/// The commands in the blocks of a page.
fn told(text: &str) -> Result<Vec<Told>, String> {
    let mut inside = false;
    let mut all = Vec::new();
    for line in text.lines() {
        if let Some(kind) = line.strip_prefix("```") {
            inside = kind.trim() == "sh";
        } else if inside && !line.trim().is_empty() {
            let call = line.strip_prefix(CALL).ok_or_else(|| format!("`{line}` does not begin with `{}`", CALL.trim_end()))?;
            all.push(words(call)?);
        }
    }
    Ok(all)
}

/// The words of a call as a shell splits them: quotes hold together, ` #` begins a remark.
fn words(call: &str) -> Result<Told, String> {
    let (mut arguments, mut word, mut quote) = (Vec::new(), None::<String>, None);
    let mut rest = call.chars().peekable();
    let mut remark = String::new();
    while let Some(c) = rest.next() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => remark = rest.by_ref().collect(),
            (None, c) if c.is_whitespace() => arguments.extend(word.take()),
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    if quote.is_some() {
        return Err(format!("`{call}` has an open quote"));
    }
    arguments.extend(word);
    let exit = remark.trim().strip_prefix("exit ").map(|text| text.chars().take_while(char::is_ascii_digit).collect::<String>());
    let exit = exit.map_or(Ok(0), |digits| digits.parse().map_err(|_| format!("`{remark}` names no exit code")))?;
    Ok(Told { arguments, exit })
}

fn copied(from: &Path, to: &Path) -> Result<(), String> {
    let cannot = |error: std::io::Error| format!("{}: {error}", from.display());
    std::fs::create_dir_all(to).map_err(cannot)?;
    for entry in std::fs::read_dir(from).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copied(&path, &target)?;
        } else {
            std::fs::copy(&path, &target).map_err(cannot)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_of_a_page_are_read_as_a_shell_does() {
        let page = "Text\n```toml\nx = 1\n```\n```sh\ncargo run --release -- solve a.toml --set b='[\"1 mm\", \"2 mm\"]'  # exit 1: too tight\n```\n";
        let wanted = Told { arguments: ["solve", "a.toml", "--set", "b=[\"1 mm\", \"2 mm\"]"].map(str::to_owned).into(), exit: 1 };
        assert_eq!(told(page).expect("understood"), [wanted]);
        assert_eq!(words("tolerance a.toml --set c=\"1 ± 0.1\" # slow").expect("understood").exit, 0);
        assert!(told("```sh\nls\n```\n").is_err() && words("solve 'a").is_err() && words("solve a # exit never").is_err());
    }
}
