//! Writing: to standard output, to standard error, and to files that are never half written.

use std::fmt::Write as _;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

use forcewright::base::diagnostics::Explanation;
use forcewright::base::text::visible;
use serde_json::json;

use crate::exit;

/// Prints to standard output. A closed pipe (`… | head`) is the reader's choice, not an error.
pub(crate) fn print(text: &str) {
    let mut out = io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// A JSON document as text. What JSON allows raw in its texts but a terminal obeys is escaped, which means the same.
pub(crate) fn json_text(document: &serde_json::Value) -> String {
    let mut out = String::new();
    for c in format!("{document:#}\n").chars() {
        if matches!(c, '\u{7f}'..='\u{9f}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') {
            let _ = write!(out, "\\u{:04x}", u32::from(c));
        } else {
            out.push(c);
        }
    }
    out
}

/// Prints a result: its document for scripts, or a summary for people.
pub(crate) fn tell(as_json: bool, document: &str, summary: impl FnOnce() -> String) {
    if as_json {
        return print(document);
    }
    let shown: Vec<_> = summary().lines().map(|line| visible(line).into_owned()).collect();
    print(&(shown.join("\n") + "\n"));
}

/// Writes the files of a result and says so; the exit code where that fails.
pub(crate) fn deliver(folder: &Path, files: &[(String, String)]) -> Result<(), u8> {
    write_all(folder, files).map_err(|failed| write_failed(&failed, false))?;
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    narrate(&format!("{}\n", visible(&format!("wrote {} in {}", names.join(", "), folder.display()))));
    Ok(())
}

/// Prints to standard error.
pub(crate) fn narrate(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Whether standard error takes colour.
pub(crate) fn colour_on_stderr() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Whether standard output takes colour.
pub(crate) fn colour_on_stdout() -> bool {
    io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Reports an error of the call, and as a document where one was asked for.
pub(crate) fn complain(code: &'static str, message: &str, help: &str, json: bool) {
    if json {
        let diagnostics = json!([{ "code": code, "severity": "error", "message": message, "help": help }]);
        print(&json_text(&refusal(&diagnostics)));
    }
    // What was typed is shown, not obeyed.
    narrate(&format!("error[{code}]: {}\n  = help: {}\n", visible(message), visible(help)));
}

/// The document of a call that was refused.
pub(crate) fn refusal(diagnostics: &serde_json::Value) -> serde_json::Value {
    json!({ "schema": 1, "forcewright": forcewright::VERSION, "status": { "kind": "refused" }, "diagnostics": diagnostics })
}

/// Why files could not be written.
pub(crate) struct WriteError {
    path: PathBuf,
    error: io::Error,
}

/// Makes a folder and tries whether files can be written into it.
///
/// # Errors
/// [`WriteError`] names the folder.
pub(crate) fn prepare(folder: &Path) -> Result<(), WriteError> {
    std::fs::create_dir_all(folder)
        .and_then(|()| temporary(folder))
        .map(drop)
        .map_err(|error| WriteError { path: folder.to_owned(), error })
}

/// Writes files into a folder, each whole or not at all: all into temporary files beside their places, then all renamed.
///
/// # Errors
/// [`WriteError`] names the file.
pub(crate) fn write_all<T: AsRef<[u8]>>(folder: &Path, files: &[(String, T)]) -> Result<(), WriteError> {
    let at = |name: &String| folder.join(name);
    let mut staged = Vec::new();
    for (name, content) in files {
        let stage = || {
            if at(name).is_dir() {
                return Err(io::Error::from(ErrorKind::IsADirectory));
            }
            let mut file = temporary(folder)?;
            file.write_all(content.as_ref())?;
            file.as_file().sync_all()?;
            readable_by_others(file.as_file())?;
            Ok(file)
        };
        staged.push((at(name), stage().map_err(|error| WriteError { path: at(name), error })?));
    }
    for (path, file) in staged {
        file.persist(&path).map_err(|e| WriteError { path, error: e.error })?;
    }
    Ok(())
}

fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    tempfile::Builder::new().prefix(".forcewright-").tempfile_in(folder)
}

/// Temporary files are private; results are as readable as any file the user makes.
#[cfg(unix)]
fn readable_by_others(file: &std::fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_others(_: &std::fs::File) -> io::Result<()> {
    Ok(())
}

/// Says why a file could not be written; the exit code for it.
pub(crate) fn write_failed(failed: &WriteError, json: bool) -> u8 {
    file_failed(&failed.path, &failed.error, json)
}

/// Says why a file could not be written; the exit code for it.
pub(crate) fn file_failed(path: &Path, error: &io::Error, json: bool) -> u8 {
    let way_out = match error.kind() {
        ErrorKind::PermissionDenied => "choose a folder that you may write to",
        ErrorKind::StorageFull => "free some space",
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => "a file is in the way; choose another folder",
        ErrorKind::IsADirectory => "a folder is in the way; choose another place",
        _ => "check the path",
    };
    complain("E0120", &format!("cannot write `{}`: {error}", path.display()), way_out, json);
    exit::IO
}

/// Codes of the command line itself.
pub(crate) const CODES: &[Explanation] = &[
    Explanation {
        code: "E0120",
        title: "a result cannot be written",
        text: "The folder given with `--out` or `--dir` cannot be written to. Nothing is left half written. Exit code 4.",
    },
    Explanation { code: "E0121", title: "no such example", text: "`forcewright new --list` names the examples of the gallery." },
    Explanation {
        code: "E0122",
        title: "a file exists already",
        text: "`forcewright new` does not overwrite files unless `--force` is given.",
    },
    Explanation { code: "E0123", title: "no such code", text: "`forcewright explain --all` prints every code." },
    Explanation { code: "E0124", title: "several families", text: "Name the family whose schema is wanted." },
    Explanation {
        code: "E0125",
        title: "the call is not understood",
        text: "An unknown command or option, a missing file name, an option without its value. `forcewright --help` lists the commands, `forcewright COMMAND --help` the options of one. Exit code 2.",
    },
];
