//! Writing: to standard output, to standard error, and to files that are never half written.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;

use forcewright::base::diagnostics::Explanation;

use crate::exit;

/// Prints to standard output. A closed pipe (`… | head`) is the reader's choice, not an error.
pub(crate) fn print(text: &str) {
    let mut out = io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
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

/// Writes a file whole or not at all: into a temporary file beside it, then renamed.
///
/// # Errors
/// The system's error.
pub(crate) fn write(path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".forcewright-").tempfile_in(folder)?;
    file.write_all(text.as_bytes())?;
    file.as_file().sync_all()?;
    readable_by_others(file.as_file())?;
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
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
pub(crate) fn write_failed(path: &Path, error: &io::Error) -> u8 {
    let way_out = match error.kind() {
        ErrorKind::PermissionDenied => "choose a folder that you may write to",
        ErrorKind::StorageFull => "free some space",
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => "a file is in the way; choose another folder",
        _ => "check the path",
    };
    narrate(&format!("error[E0120]: cannot write `{}`: {error}\n  = help: {way_out}\n", path.display()));
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
];
